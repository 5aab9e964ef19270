//! Fits, comparison and repeatability of everything that was added: a job, whenever data or settings
//! change.

use super::Edit;
use super::drawing::Drawing;
use super::source::joined;
use crate::fault::Fault;
use crate::fragmentation::{
    Comparison, ComparisonOptions, DistributionSet, Fit, FitOptions, Labels, Percentile,
    Repeatability, compare, fit, repeatability,
};
use crate::jobs::Progress;

/// How the reference is called where nobody has chosen one.
const REFERENCES: [&str; 4] = ["sieve", "sieving", "reference", "known fragments"];

/// What was computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Computed {
    /// Of which edition of data and settings.
    pub edition: u64,
    /// Those.
    pub edit: Edit,
    /// All curves, in the settings' unit.
    pub set: DistributionSet,
    /// The same with the photos of a trial merged.
    pub trials: DistributionSet,
    /// How they were merged, a sentence each.
    pub notes: Vec<String>,
    /// The methods, in the order of the curves.
    pub methods: Vec<String>,
    /// The method that the others are held against.
    pub reference: Option<String>,
    /// The function fitted to each curve of `trials`, in their order.
    pub fits: Vec<FittedCurve>,
    /// Every method against the reference; `None` without one.
    pub comparison: Option<Result<Comparison, Fault>>,
    /// Of each method with more than one trial.
    pub repeatability: Vec<(String, Result<Repeatability, Fault>)>,
    /// What the plot draws.
    pub drawing: Drawing,
}

/// The function fitted to a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedCurve {
    /// What the curve is of.
    pub labels: Labels,
    /// The fit, or why there is none.
    pub fit: Result<Fit, Fault>,
    /// Of `PERCENTILES`, with their bands; empty without a fit.
    pub percentiles: Vec<Percentile>,
}

/// The percents passing whose sizes are told.
pub const PERCENTILES: [f64; 5] = [10.0, 20.0, 50.0, 80.0, 90.0];

/// The methods of a set, in the order of its curves.
pub fn methods(set: &DistributionSet) -> Vec<String> {
    let mut methods: Vec<String> = Vec::new();
    for curve in &set.curves {
        if !methods.contains(&curve.labels.method) {
            methods.push(curve.labels.method.clone());
        }
    }
    methods
}

/// The method that the others are held against: the chosen one, else the one that is called so, else
/// the first.
fn reference(methods: &[String], chosen: Option<&String>) -> Option<String> {
    let chosen = chosen.filter(|chosen| methods.contains(chosen));
    let called = || {
        let names = |name: &&str| methods.iter().find(|m| m.to_lowercase() == **name);
        REFERENCES.iter().find_map(names)
    };
    chosen.or_else(called).or(methods.first()).cloned()
}

/// Computes everything.
///
/// # Errors
/// Where the curves cannot be brought together, or where it was cancelled.
pub(crate) fn compute(edition: u64, edit: Edit, progress: &Progress) -> Result<Computed, Fault> {
    let settings = &edit.settings;
    let mut set = joined(&edit.sources, settings.unit)?;
    let mut notes = Vec::new();
    if let Some(series) = settings.sieves {
        let (resampled, left_out) = set.resampled(series)?;
        set = resampled;
        notes.push(format!("at the sieves of {}", series.name()));
        notes.extend(left_out);
    }
    let sieves = settings.sieves.map(|series| series.openings(settings.unit));
    let (trials, left_out) = set.photos_merged(settings.merging, sieves.as_deref())?;
    if trials.curves.len() < set.curves.len() {
        notes.push(format!("photos {}", settings.merging.sentence()));
    }
    notes.extend(left_out);
    progress.stage("fitting");
    let options = FitOptions::default();
    let total = trials.curves.len() as u64;
    let mut fits = Vec::new();
    for (done, curve) in trials.curves.iter().enumerate() {
        progress.advance(done as u64, total)?;
        let fit = fit(&curve.distribution, settings.model, &options);
        let percentiles = fit.iter().flat_map(|fit| {
            PERCENTILES.map(|percent| fit.percentile(percent, 1.0 - settings.level))
        });
        fits.push(FittedCurve {
            labels: curve.labels.clone(),
            percentiles: percentiles.collect(),
            fit,
        });
    }
    progress.stage("comparing");
    let methods = methods(&set);
    let reference = reference(&methods, settings.reference.as_ref());
    let comparison = reference.as_ref().filter(|_| methods.len() > 1);
    let comparison = comparison.map(|reference| {
        let options = ComparisonOptions {
            model: settings.model,
            envelope_percent: settings.envelope_percent,
            percentiles: PERCENTILES.to_vec(),
            ..ComparisonOptions::new(reference)
        };
        compare(&trials, &options)
    });
    let trials_of = |method: &str| {
        let labels = trials.curves.iter().map(|curve| &curve.labels);
        labels.filter(|labels| labels.method == method).count()
    };
    let mut repeated = Vec::new();
    for (done, method) in methods.iter().enumerate() {
        progress.advance(done as u64, methods.len() as u64)?;
        if trials_of(method) > 1 {
            let table = repeatability(&set, method, &[], settings.level);
            repeated.push((method.clone(), table));
        }
    }
    let mut computed = Computed {
        edition,
        set,
        trials,
        notes,
        methods,
        reference,
        fits,
        comparison,
        repeatability: repeated,
        drawing: Drawing::default(),
        edit,
    };
    computed.drawing = Drawing::of(&computed);
    Ok(computed)
}
