//! The analysis of everything that was added, and the fit of every trial: a job, whenever data or
//! settings change.

use super::Edit;
use super::drawing::Drawing;
use super::fitted_curve::FittedCurve;
use crate::fault::Fault;
use crate::fragmentation::{Analysis, AnalysisOptions, DistributionSet, PERCENTILES, fit_trials};
use crate::jobs::Progress;

/// What was computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Computed {
    /// Of which edition of data and settings.
    pub edition: u64,
    /// Those.
    pub edit: Edit,
    /// Of all curves, in the settings' unit.
    pub analysis: Analysis,
    /// The function fitted to each curve of the analysis's trials, in their order.
    pub fits: Vec<FittedCurve>,
    /// What the plot draws.
    pub drawing: Drawing,
}

/// Computes everything.
///
/// # Errors
/// Where the curves cannot be brought together, or where it was cancelled.
pub(crate) fn compute(edition: u64, edit: Edit, progress: &Progress) -> Result<Computed, Fault> {
    let settings = &edit.settings;
    let sets = edit.sources.iter().map(|source| &source.set);
    let set = DistributionSet::joined(settings.unit, sets)?;
    // Its file may have been taken away since it was chosen.
    let chosen = settings.reference.clone();
    let options = AnalysisOptions {
        model: settings.model,
        merging: settings.merging,
        sieves: settings.sieves,
        reference: chosen.filter(|chosen| set.methods().contains(chosen)),
        envelope_percent: settings.envelope_percent,
        percentiles: PERCENTILES.to_vec(),
        level: settings.level,
    };
    let analysis = Analysis::of(set, &options, progress)?;
    let fits = fit_trials(&analysis, settings.model, options.merging, progress)?;
    let fits = analysis.trials.curves.iter().zip(fits).map(|(curve, fit)| {
        let percentiles = fit.iter().flat_map(|fit| {
            PERCENTILES.map(|percent| fit.percentile(percent, 1.0 - settings.level))
        });
        FittedCurve {
            labels: curve.labels.clone(),
            percentiles: percentiles.collect(),
            fit,
        }
    });
    let fits: Vec<FittedCurve> = fits.collect();
    Ok(Computed {
        edition,
        drawing: Drawing::of(&analysis, &fits),
        fits,
        analysis,
        edit,
    })
}
