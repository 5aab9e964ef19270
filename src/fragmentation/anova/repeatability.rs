//! Whether a method gives the same distribution in every trial.
//!
//! Two layouts. Per size, the groups are the trials and the values are what the photos of a trial say
//! about this size: what varies within is the photos. Pooled, a trial's values at all sizes are one
//! group, as in the paper's Tables II and III: ten trials and thirty observations leave three values a
//! trial, and with one distribution a trial these are points of its curve. Then what varies within is
//! the curve itself, which is large and the same in all trials; F comes out near 0 whatever the trials
//! do, and `Anova::notes` says so. The pooled table is there to be held against the paper's, the sizes'
//! own tables are those to believe.

use super::Anova;
use crate::fault::Fault;
use crate::{DistributionSet, LabelledDistribution, SizeDistribution};

/// Whether a method gives the same distribution in every trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeatability {
    /// The method.
    pub method: String,
    /// The trials: the groups.
    pub trials: Vec<String>,
    /// The sizes whose percents passing are the values, ascending, in the set's unit.
    pub sizes: Vec<f64>,
    /// A table for each size, where some trial has several photos; an error says why a size has none.
    /// Empty with one curve a trial.
    pub per_size: Vec<Result<Anova, Fault>>,
    /// All values of a trial in one group, as in the paper's Tables II and III.
    pub pooled: Result<Anova, Fault>,
}

/// Analyses the trials of a method: are they alike? The values are percents passing at `sizes`; without
/// any given, at those measured sizes of the method's curves that all of them know.
///
/// # Errors
///
/// No such method, one trial only, a size that some curve does not know, no size that all know, a
/// level that is not between 0 and 1.
pub fn repeatability(
    set: &DistributionSet,
    method: &str,
    sizes: &[f64],
    level: f64,
) -> Result<Repeatability, Fault> {
    let curves: Vec<&LabelledDistribution> = set
        .curves
        .iter()
        .filter(|curve| curve.labels.method == method)
        .collect();
    if curves.is_empty() {
        let what = format!("no distribution of the method '{method}'");
        return Err(Fault::new(what, "name a method of the file"));
    }
    let mut trials: Vec<&str> = Vec::new();
    let mut groups: Vec<Vec<&SizeDistribution>> = Vec::new();
    for curve in &curves {
        let trial = curve.labels.trial.as_str();
        let at = trials.iter().position(|known| *known == trial);
        match at.and_then(|at| groups.get_mut(at)) {
            Some(group) => group.push(&curve.distribution),
            None => {
                trials.push(trial);
                groups.push(vec![&curve.distribution]);
            }
        }
    }
    if trials.len() < 2 {
        let what = format!("the method '{method}' has one trial only");
        return Err(Fault::new(what, "give two or more trials to be compared"));
    }
    let sizes = if sizes.is_empty() {
        common_sizes(&curves)?
    } else {
        checked_sizes(sizes, &curves)?
    };
    let values = |size: f64| -> Vec<Vec<f64>> {
        let at = |group: &Vec<&SizeDistribution>| {
            let percents = group.iter().filter_map(|curve| curve.percent_passing(size));
            percents.collect()
        };
        groups.iter().map(at).collect()
    };
    let mut pooled = vec![Vec::new(); groups.len()];
    let mut per_size = Vec::new();
    for size in &sizes {
        let at_size = values(*size);
        for (all, group) in pooled.iter_mut().zip(&at_size) {
            all.extend_from_slice(group);
        }
        if groups.len() < curves.len() {
            per_size.push(Anova::of_groups(&at_size, level));
        }
    }
    Ok(Repeatability {
        method: method.to_owned(),
        trials: trials.into_iter().map(str::to_owned).collect(),
        sizes,
        per_size,
        pooled: Anova::of_groups(&pooled, level),
    })
}

/// The measured sizes that every curve knows.
fn common_sizes(curves: &[&LabelledDistribution]) -> Result<Vec<f64>, Fault> {
    let mut sizes: Vec<f64> = curves
        .iter()
        .flat_map(|curve| curve.distribution.points())
        .map(|[size, _]| *size)
        .filter(|size| unknown_at(*size, curves).is_none())
        .collect();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    if sizes.is_empty() {
        let what = "no size is known to all distributions of the method";
        return Err(Fault::new(
            what,
            "give distributions that share sizes, or leave those out that do not",
        ));
    }
    Ok(sizes)
}

/// The sizes asked for, ascending, each known to every curve.
fn checked_sizes(sizes: &[f64], curves: &[&LabelledDistribution]) -> Result<Vec<f64>, Fault> {
    for size in sizes {
        if !(size.is_finite() && *size > 0.0) {
            let what = format!("size {size} is not above 0");
            return Err(Fault::new(what, "give sizes above 0"));
        }
        if let Some(curve) = unknown_at(*size, curves) {
            let what = format!("'{}' says nothing about the size {size}", curve.labels);
            return Err(Fault::new(what, "choose sizes that all distributions know"));
        }
    }
    let mut sizes = sizes.to_vec();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    Ok(sizes)
}

/// The first curve that does not know a size.
fn unknown_at<'a>(
    size: f64,
    curves: &[&'a LabelledDistribution],
) -> Option<&'a LabelledDistribution> {
    curves
        .iter()
        .find(|curve| curve.distribution.percent_passing(size).is_none())
        .copied()
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use crate::Labels;
    use crate::units::LengthUnit;

    fn curve(trial: &str, photo: &str, points: &[[f64; 2]]) -> LabelledDistribution {
        LabelledDistribution {
            labels: Labels {
                method: "point cloud".to_owned(),
                trial: trial.to_owned(),
                photo: photo.to_owned(),
            },
            weight: None,
            distribution: SizeDistribution::new(points.to_vec()).expect("a distribution"),
        }
    }

    fn set(curves: Vec<LabelledDistribution>) -> DistributionSet {
        DistributionSet {
            unit: LengthUnit::Millimetre,
            curves,
        }
    }

    /// Two trials of two photos; at 10 mm [20, 22] and [30, 32]: between 100, within 4, F = 50. At
    /// 20 mm all say 50.
    #[test]
    fn per_size_and_pooled() {
        let set = set(vec![
            curve("1", "a", &[[10.0, 20.0], [20.0, 50.0]]),
            curve("1", "b", &[[10.0, 22.0], [20.0, 50.0]]),
            curve("2", "c", &[[10.0, 30.0], [20.0, 50.0], [40.0, 90.0]]),
            curve("2", "d", &[[10.0, 32.0], [20.0, 50.0]]),
        ]);
        let found = repeatability(&set, "point cloud", &[], 0.05).expect("tables");
        assert_eq!(found.trials, ["1", "2"]);
        assert_eq!(found.sizes, [10.0, 20.0], "not all know 40");
        let table = found.per_size[0].as_ref().expect("a table");
        assert!((table.f.expect("an F") - 50.0).abs() < 1e-10);
        assert_eq!(found.per_size[1].as_ref().expect("a table").f, None);
        // Means 35.5 and 40.5 of four: between 2 * 4 * 2.5^2; scipy.stats.f_oneway([20, 22, 50, 50],
        // [30, 32, 50, 50]).
        let pooled = found.pooled.expect("a table");
        assert!((pooled.between.sum_of_squares - 50.0).abs() < 1e-10);
        assert!((pooled.f.expect("an F") - 0.248_756_218_905_472_64).abs() < 1e-12);
        assert!((pooled.p.expect("a p") - 0.635_706_630_490_117).abs() < 1e-12);
    }

    /// Ten trials of one curve, looked at in three points: the paper's 9 and 20 degrees of freedom.
    #[test]
    fn the_papers_degrees_of_freedom() {
        let trials = (0..10).map(|trial| {
            let off = f64::from(trial) * 0.1;
            let points = [[10.0, 20.0 + off], [20.0, 50.0 - off], [40.0, 80.0 + off]];
            curve(&trial.to_string(), "", &points)
        });
        let set = set(trials.collect());
        let found = repeatability(&set, "point cloud", &[10.0, 20.0, 40.0], 0.05).expect("tables");
        assert!(found.per_size.is_empty());
        let table = found.pooled.expect("a table");
        assert_eq!(table.between.degrees_of_freedom, 9);
        assert_eq!(table.within.degrees_of_freedom, 20);
        assert!(table.notes[0].contains("each size on its own"));
    }

    #[test]
    fn refuses_in_a_sentence() {
        let one = set(vec![curve("1", "a", &[[10.0, 20.0], [20.0, 50.0]])]);
        let apart = set(vec![
            curve("1", "a", &[[10.0, 20.0], [20.0, 50.0]]),
            curve("2", "a", &[[30.0, 20.0], [40.0, 50.0]]),
        ]);
        for (result, sentence) in [
            (
                repeatability(&one, "sieve", &[], 0.05),
                "the method 'sieve'",
            ),
            (
                repeatability(&one, "point cloud", &[], 0.05),
                "one trial only",
            ),
            (
                repeatability(&apart, "point cloud", &[], 0.05),
                "no size is known to all",
            ),
            (
                repeatability(&apart, "point cloud", &[15.0], 0.05),
                "'point cloud / 2 / a' says nothing about the size 15",
            ),
        ] {
            let fault = result.expect_err(sentence).to_string();
            assert!(fault.contains(sentence), "{fault}");
        }
    }
}
