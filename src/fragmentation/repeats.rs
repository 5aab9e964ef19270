//! Which curves are repeats of one measurement, and their mean with one after another left out: what confidence bands of means rest on.

use super::comparison::{MeasuredBy, whole_mean_of};
use super::{DistributionSet, LabelledDistribution, SizeDistribution, Weighting, merge};

/// Photos are left out in no more groups than these: of more the function would be fitted hundreds of times, and the band is no other.
const MOST_GROUPS: usize = 20;

/// Trials from which on they are left out whole; of fewer their photos are.
const ENOUGH_TRIALS: usize = 3;

/// What the mean of these curves, all of one method, is known by; `points` is how many were measured of a curve at most, before it was
/// brought to other sieves.
pub(super) fn measured_by(
    curves: &[&LabelledDistribution],
    merging: Weighting,
    points: Option<usize>,
) -> MeasuredBy {
    if curves.iter().all(|curve| curve.labels.photo.is_empty()) {
        return MeasuredBy::Points(points);
    }
    MeasuredBy::Repeats(left_out(curves, merging))
}

/// The mean of photos' curves with one trial or photo after another left out.
fn left_out(curves: &[&LabelledDistribution], merging: Weighting) -> Vec<SizeDistribution> {
    let mut trials: Vec<&str> = Vec::new();
    for curve in curves {
        if !trials.contains(&curve.labels.trial.as_str()) {
            trials.push(&curve.labels.trial);
        }
    }
    let group = |place: usize, curve: &LabelledDistribution| match trials.len() {
        ENOUGH_TRIALS.. => {
            let own = trials.iter().position(|trial| *trial == curve.labels.trial);
            own.unwrap_or(0) % MOST_GROUPS
        }
        _ => place % MOST_GROUPS,
    };
    let groups: Vec<usize> = curves
        .iter()
        .enumerate()
        .map(|(place, curve)| group(place, curve))
        .collect();
    let count = groups.iter().max().map_or(0, |most| most + 1);
    if count < 2 {
        return Vec::new();
    }
    let means = (0..count).map(|out| {
        let kept = curves
            .iter()
            .zip(&groups)
            .filter(|(_, group)| **group != out);
        let kept: Vec<&LabelledDistribution> = kept.map(|(curve, _)| *curve).collect();
        mean(&kept, &trials, merging)
    });
    // Where one is none, nobody knows how far they differ.
    means.collect::<Option<_>>().unwrap_or_default()
}

/// The mean of the trials, each of its photos.
fn mean(
    curves: &[&LabelledDistribution],
    trials: &[&str],
    merging: Weighting,
) -> Option<SizeDistribution> {
    let merged = trials.iter().filter_map(|trial| {
        let of_trial = curves.iter().filter(|curve| curve.labels.trial == *trial);
        let of_trial: Vec<&LabelledDistribution> = of_trial.copied().collect();
        let weighting = if of_trial.len() == 1 {
            Weighting::Equal
        } else {
            merging
        };
        (!of_trial.is_empty()).then(|| merge(&of_trial, weighting, None).ok())
    });
    let merged: Vec<SizeDistribution> = merged
        .map(|of| Some(of?.distribution))
        .collect::<Option<_>>()?;
    whole_mean_of(&merged.iter().collect::<Vec<_>>())
}

impl DistributionSet {
    /// The curves of a method, of one trial where one is named.
    pub(super) fn of(&self, method: &str, trial: Option<&str>) -> Vec<&LabelledDistribution> {
        let is = |curve: &&LabelledDistribution| {
            curve.labels.method == method && trial.is_none_or(|trial| curve.labels.trial == trial)
        };
        self.curves.iter().filter(is).collect()
    }
}
