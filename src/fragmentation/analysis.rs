//! What is done with the curves of a comparison before and beside holding them against each other:
//! sieves, merging of photos, the choice of the reference, trials that are alike. The command line and
//! the window both ask here, so that the same table has the same answers in both.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::comparison::{MeasuredBy, compare_known};
use super::reference_names::{IN_WORDS, called_reference};
use super::repeats::measured_by;
use super::{
    Comparison, ComparisonOptions, DistributionSet, Fit, FitOptions, LabelledDistribution, Model,
    Repeatability, SieveSeries, Weighting, fit, repeatability,
};
use crate::fault::Fault;
use crate::jobs::Progress;

/// Those of them that figures mark.
pub const MARKED_PERCENTILES: [f64; 2] = [50.0, 80.0];

/// The level of significance of analyses of variance where nobody chose another.
pub const SIGNIFICANCE: f64 = 0.05;

/// How to analyse.
#[derive(Debug, Clone, PartialEq)]
pub struct AnalysisOptions {
    /// The function fitted to every method's mean curve.
    pub model: Model,
    /// What the photos of a trial count by where they are merged.
    pub merging: Weighting,
    /// The sieves that every curve is brought to first; `None` leaves it as measured.
    pub sieves: Option<SieveSeries>,
    /// The method that the others are held against; `None` is the one that is called so, else the
    /// first.
    pub reference: Option<String>,
    /// Half the width of the envelope about the reference, percent of the size.
    pub envelope_percent: f64,
    /// Percents passing whose sizes are compared.
    pub percentiles: Vec<f64>,
    /// The level of significance of the analyses of variance.
    pub level: f64,
}

impl Default for AnalysisOptions {
    fn default() -> Self {
        let usual = ComparisonOptions::new("");
        Self {
            model: usual.model,
            merging: Weighting::default(),
            sieves: None,
            reference: None,
            envelope_percent: usual.envelope_percent,
            percentiles: usual.percentiles,
            level: SIGNIFICANCE,
        }
    }
}

/// What a set of curves says of its methods.
#[derive(Debug, Clone, PartialEq)]
pub struct Analysis {
    /// A curve a method, trial and photo, at the sieves.
    pub photos: DistributionSet,
    /// A curve a method and trial.
    pub trials: DistributionSet,
    /// How they came from what was read, a sentence each.
    pub steps: Vec<String>,
    /// What was left out on the way or is to be known, a sentence each.
    pub warnings: Vec<String>,
    /// In the order of the curves.
    pub methods: Vec<String>,
    /// The method that the others are held against; `None` without any curve.
    pub reference: Option<String>,
    /// Every method against the reference; why not, where there is one method only.
    pub comparison: Result<Comparison, Fault>,
    /// Of each method with more than one trial, the reference first.
    pub repeatability: Vec<(String, Result<Repeatability, Fault>)>,
    /// Of each curve that was read its method, and at how many sizes it was measured.
    measured: Vec<(String, usize)>,
}

impl Analysis {
    /// Brings curves to the sieves, merges the photos of each trial, holds the methods against the
    /// reference and their trials against each other. No two curves have the same labels.
    ///
    /// # Errors
    ///
    /// Curves that have no place at the sieves, weights that are missing; "cancelled".
    pub fn of(
        set: DistributionSet,
        options: &AnalysisOptions,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let (mut steps, mut warnings) = (Vec::new(), Vec::new());
        // Between its own sieves nothing was measured.
        let measured: Vec<(String, usize)> = (set.curves.iter())
            .map(|curve| {
                (
                    curve.labels.method.clone(),
                    curve.distribution.points().len(),
                )
            })
            .collect();
        let mut photos = set;
        if let Some(series) = options.sieves {
            let (set, said) = photos.resampled(series)?;
            photos = set;
            warnings.extend(said);
            steps.push(format!(
                "All curves were taken at the sieves of {}.",
                series.name()
            ));
        }
        let (trials, merging_said) = photos.photos_merged(options.merging, None)?;
        warnings.extend(merging_said);
        if trials.curves.len() < photos.curves.len() {
            steps.push(format!(
                "The {} curves of photos became {} of trials: {}.",
                photos.curves.len(),
                trials.curves.len(),
                options.merging.sentence()
            ));
        }
        let methods = photos.methods();
        let (reference, guessed) = reference(&methods, options.reference.as_ref());
        if let (true, Some(first), true) = (guessed, &reference, methods.len() > 1) {
            warnings.push(format!(
                "no method is called {IN_WORDS}: the others are held against the first, '{first}'"
            ));
        }
        progress.stage("comparing");
        let known_by = |method: &str| {
            measured_by(
                &photos.of(method, None),
                options.merging,
                most_points(&measured, method),
            )
        };
        let comparison = compare_known(
            &trials,
            &ComparisonOptions {
                reference: reference.clone().unwrap_or_default(),
                model: options.model,
                envelope_percent: options.envelope_percent,
                percentiles: options.percentiles.clone(),
            },
            &known_by,
        );
        let repeatability = repeated(&photos, &trials, reference.as_ref(), options, progress)?;
        Ok(Self {
            photos,
            trials,
            steps,
            warnings,
            methods,
            reference,
            comparison,
            repeatability,
            measured,
        })
    }

    /// Why methods with several trials have no analysis of variance, a sentence each.
    pub fn not_analysed(&self) -> impl Iterator<Item = String> {
        let failed = self.repeatability.iter();
        let failed = failed.filter_map(|(_, found)| found.as_ref().err());
        failed.map(|fault| format!("no analysis of variance: {fault}"))
    }
}

/// How many points the curves of a method have at most.
fn most_points(measured: &[(String, usize)], method: &str) -> Option<usize> {
    let own = measured.iter().filter(|(name, _)| name == method);
    own.map(|(_, points)| *points).max()
}

impl DistributionSet {
    /// The methods, in the order of the curves.
    pub fn methods(&self) -> Vec<String> {
        let mut methods: Vec<String> = Vec::new();
        for curve in &self.curves {
            if !methods.contains(&curve.labels.method) {
                methods.push(curve.labels.method.clone());
            }
        }
        methods
    }
}

/// The method that the others are held against: the chosen one, else the one that is called so, else
/// the first, of which it is said that it was guessed.
fn reference(methods: &[String], chosen: Option<&String>) -> (Option<String>, bool) {
    match chosen.or_else(|| called_reference(methods)) {
        Some(known) => (Some(known.clone()), false),
        None => (methods.first().cloned(), true),
    }
}

/// A method with its analysis of variance, or why there is none.
type OfMethod = (String, Result<Repeatability, Fault>);

/// Whether the trials are alike, of each method with several.
fn repeated(
    photos: &DistributionSet,
    trials: &DistributionSet,
    reference: Option<&String>,
    options: &AnalysisOptions,
    progress: &Progress,
) -> Result<Vec<OfMethod>, Fault> {
    let mut methods = trials.methods();
    // The reference before the others, which keep their order.
    methods.sort_by_key(|method| Some(method) != reference);
    let total = methods.len() as u64;
    let mut found = Vec::new();
    for (done, method) in methods.into_iter().enumerate() {
        progress.advance(done as u64, total)?;
        let of_method = trials.curves.iter().filter(|c| c.labels.method == method);
        if of_method.count() > 1 {
            let table = repeatability(photos, &method, &[], options.level);
            found.push((method, table));
        }
    }
    Ok(found)
}

/// The function fitted to every curve of an analysis' trials, in their order, or why there is none; each known by how far its photos
/// differ, where it is of photos.
///
/// # Errors
///
/// "cancelled".
pub fn fit_trials(
    analysis: &Analysis,
    model: Model,
    merging: Weighting,
    progress: &Progress,
) -> Result<Vec<Result<Fit, Fault>>, Fault> {
    let plain = |_: &LabelledDistribution| Ok(FitOptions::default());
    let known_by = |curve: &LabelledDistribution| {
        let labels = &curve.labels;
        let photos = analysis.photos.of(&labels.method, Some(&labels.trial));
        measured_by(
            &photos,
            merging,
            most_points(&analysis.measured, &labels.method),
        )
    };
    fit_known(&analysis.trials, model, plain, known_by, progress)
}

/// The function fitted to every curve of a set, in their order, or why there is none. `options_of` says
/// how each is fitted. A curve of a photo has no confidence bands: nobody knows by it how far photos differ.
///
/// # Errors
///
/// "cancelled".
pub fn fit_each(
    set: &DistributionSet,
    model: Model,
    options_of: impl Fn(&LabelledDistribution) -> Result<FitOptions, Fault> + Sync,
    progress: &Progress,
) -> Result<Vec<Result<Fit, Fault>>, Fault> {
    let known_by = |curve: &LabelledDistribution| match curve.labels.photo.is_empty() {
        true => MeasuredBy::Points(None),
        false => MeasuredBy::Repeats(Vec::new()),
    };
    fit_known(set, model, options_of, known_by, progress)
}

/// The same, with what the bands of each rest on.
fn fit_known(
    set: &DistributionSet,
    model: Model,
    options_of: impl Fn(&LabelledDistribution) -> Result<FitOptions, Fault> + Sync,
    known_by: impl Fn(&LabelledDistribution) -> MeasuredBy + Sync,
    progress: &Progress,
) -> Result<Vec<Result<Fit, Fault>>, Fault> {
    progress.stage("fitting");
    let done = AtomicU64::new(0);
    let total = set.curves.len() as u64;
    let one = |curve: &LabelledDistribution| {
        progress.advance(done.fetch_add(1, Ordering::Relaxed), total)?;
        let found = options_of(curve).and_then(|options| fit(&curve.distribution, model, &options));
        Ok(found.map(|fit| match known_by(curve) {
            MeasuredBy::Repeats(left_out) => fit.of_repeats(&left_out),
            MeasuredBy::Points(measured) => {
                let all = curve.distribution.points().len();
                fit.of_fewer_points(all, measured.unwrap_or(all).min(all))
            }
        }))
    };
    set.curves.par_iter().map(one).collect()
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use crate::units::LengthUnit;
    use crate::{Labels, SizeDistribution, Swebrec};

    /// A Swebrec's points, all sizes `scale` times as large.
    fn curve([method, trial, photo]: [&str; 3], scale: f64) -> LabelledDistribution {
        let swebrec = Swebrec::new(50.0 * scale, 200.0 * scale, 2.0).expect("a curve");
        let sizes = [8.0, 16.0, 31.5, 63.0, 125.0];
        let points = sizes.map(|size| [size, 100.0 * swebrec.passing(size)]);
        LabelledDistribution {
            labels: Labels {
                method: method.to_owned(),
                trial: trial.to_owned(),
                photo: photo.to_owned(),
            },
            weight: None,
            distribution: SizeDistribution::new(points.to_vec()).expect("points"),
        }
    }

    fn analysed(curves: Vec<LabelledDistribution>, options: &AnalysisOptions) -> Analysis {
        let set = DistributionSet {
            unit: LengthUnit::Millimetre,
            curves,
        };
        Analysis::of(set, options, &Progress::default()).expect("an analysis")
    }

    #[test]
    fn the_reference_is_who_is_called_so() {
        for (methods, chosen, reference, warnings) in [
            (["cloud", "Sieve"], None, "Sieve", 0),
            (["known fragments", "sieving"], None, "sieving", 0),
            (["cloud", "sieve"], Some("cloud"), "cloud", 0),
            (["Kamera", "Sieb"], None, "Sieb", 0),
            (["Referenz", "Siebanalyse"], None, "Siebanalyse", 0),
            (["caméra", "Tamisage"], None, "Tamisage", 0),
            (["cámara", "cribado"], None, "cribado", 0),
            (["cloud", "belt"], None, "cloud", 1),
        ] {
            let options = AnalysisOptions {
                reference: chosen.map(str::to_owned),
                ..AnalysisOptions::default()
            };
            let curves = methods.map(|method| curve([method, "", ""], 1.0));
            let found = analysed(curves.to_vec(), &options);
            assert_eq!(found.reference.as_deref(), Some(reference), "{methods:?}");
            assert_eq!(found.warnings.len(), warnings, "{methods:?}");
            let comparison = found.comparison.expect("compared");
            assert_eq!(comparison.reference.method, reference);
        }
    }

    /// A chosen reference that is not there is an error, not another reference.
    #[test]
    fn without_two_methods_nothing_is_compared() {
        let options = AnalysisOptions {
            reference: Some("gone".to_owned()),
            ..AnalysisOptions::default()
        };
        let two = ["cloud", "sieve"].map(|method| curve([method, "", ""], 1.0));
        let fault = analysed(two.to_vec(), &options).comparison.expect_err("no");
        assert!(fault.what.contains("'gone'"), "{fault}");
        let one = analysed(
            vec![curve(["sieve", "", ""], 1.0)],
            &AnalysisOptions::default(),
        );
        assert!(one.comparison.is_err() && one.warnings.is_empty());
        let none = analysed(Vec::new(), &AnalysisOptions::default());
        assert_eq!(none.reference, None);
    }

    #[test]
    fn photos_become_trials_and_that_is_said() {
        let curves = vec![
            curve(["cloud", "1", "a"], 1.0),
            curve(["cloud", "1", "b"], 1.1),
            curve(["cloud", "2", "c"], 1.2),
            curve(["cloud", "2", "d"], 1.3),
            curve(["sieve", "1", ""], 1.0),
            curve(["sieve", "2", ""], 1.1),
        ];
        let options = AnalysisOptions {
            sieves: Some(SieveSeries::Iso565),
            ..AnalysisOptions::default()
        };
        let found = analysed(curves, &options);
        assert_eq!(
            (found.photos.curves.len(), found.trials.curves.len()),
            (6, 4)
        );
        assert_eq!(found.steps.len(), 2, "{:?}", found.steps);
        assert_eq!(found.methods, ["cloud", "sieve"]);
        // Of all curves those sieves of 45 um to 125 mm that lie outside of 8 to 125 mm, once.
        assert_eq!(found.warnings.len(), 1, "{:?}", found.warnings);
        let repeated: Vec<&str> = found
            .repeatability
            .iter()
            .map(|(m, _)| m.as_str())
            .collect();
        assert_eq!(repeated, ["sieve", "cloud"]);
        assert_eq!(found.not_analysed().count(), 0);
    }

    /// A curve that cannot be fitted does not stop the others; the order is theirs.
    #[test]
    fn each_has_its_fit() {
        let mut short = curve(["c", "", ""], 1.0);
        short.distribution = SizeDistribution::new(vec![[1.0, 5.0], [2.0, 9.0]]).expect("points");
        let curves = vec![curve(["a", "", ""], 1.0), short, curve(["b", "", ""], 1.5)];
        let set = DistributionSet {
            unit: LengthUnit::Millimetre,
            curves,
        };
        let progress = Progress::default();
        let plain = |_: &LabelledDistribution| Ok(FitOptions::default());
        let fits = fit_each(&set, Model::Swebrec, plain, &progress).expect("not cancelled");
        let p50 = |at: usize| fits[at].as_ref().map(|fit| fit.curve.size_at(50.0));
        assert!((p50(0).expect("a fit") - 50.0).abs() < 1e-3);
        assert!(fits[1].is_err());
        assert!((p50(2).expect("a fit") - 75.0).abs() < 1e-3);
        progress.cancel();
        assert!(fit_each(&set, Model::Swebrec, plain, &progress).is_err());
    }
}
