//! Merging the distributions of several photos or trials to one.
//!
//! ```text
//! P(x) = sum(w_i P_i(x)) / sum(w_i)
//! ```
//!
//! at every size x at which all P_i are known. With equal weights it is the mean of the curves; with
//! masses, the distribution of all the material together; with areas, the same where each photo's mass
//! grows with the area that it shows.

use super::resampling::keep_nearest_certain;
use super::{DistributionSet, LabelledDistribution, Labels, SizeDistribution};
use crate::fault::Fault;

/// What each distribution counts by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Weighting {
    /// All the same.
    #[default]
    Equal,
    /// By the area that it shows; `LabelledDistribution::weight`.
    Area,
    /// By the mass that it stands for; `LabelledDistribution::weight`.
    Mass,
}

impl Weighting {
    /// All, in the order in which people are offered them.
    pub const ALL: [Self; 3] = [Self::Equal, Self::Area, Self::Mass];

    /// Its name on the command line and in JSON.
    pub fn key(self) -> &'static str {
        match self {
            Self::Equal => "equal",
            Self::Area => "area",
            Self::Mass => "mass",
        }
    }

    /// How it merges, to be said beside every merged curve.
    pub fn sentence(self) -> &'static str {
        match self {
            Self::Equal => "merged with equal weights: the mean of the curves",
            Self::Area => "merged weighted by the area that each curve stands for",
            Self::Mass => "merged weighted by the mass that each curve stands for",
        }
    }
}

/// Several distributions as one.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// The weighted mean.
    pub distribution: SizeDistribution,
    /// The sum of the weights; `None` where they are equal.
    pub weight: Option<f64>,
    /// The sizes at which not every curve is known, which are left out.
    pub unknown: Vec<f64>,
}

/// Merges distributions at the union of their sizes, or at `sizes`, of which those are kept that
/// [`resample`](super::resample) keeps.
///
/// A curve of weight 0 stands for nothing and does not count.
///
/// # Errors
/// No curve; a weight that is missing, not finite or negative, or all 0; fewer than two sizes at which
/// every curve is known.
pub fn merge(
    curves: &[&LabelledDistribution],
    weighting: Weighting,
    sizes: Option<&[f64]>,
) -> Result<Merged, Fault> {
    let weighted: Vec<(f64, &SizeDistribution)> = (curves.iter())
        .map(|curve| Ok((weight(curve, weighting)?, &curve.distribution)))
        .collect::<Result<_, Fault>>()?;
    let total: f64 = weighted.iter().map(|(weight, _)| weight).sum();
    if weighted.is_empty() {
        return Err(Fault::new("there is no curve to merge", "name some"));
    }
    if !(total.is_finite() && total > 0.0) {
        let what = format!("the weights of the {} curves sum to {total}", curves.len());
        let remedy = "give areas or masses above 0, or merge with equal weights";
        return Err(Fault::new(what, remedy));
    }
    let counting: Vec<_> = weighted
        .iter()
        .filter(|(weight, _)| *weight > 0.0)
        .collect();
    let chosen = sizes.is_some();
    let mut sizes: Vec<f64> = match sizes {
        Some(sizes) => sizes.to_vec(),
        None => {
            let points = counting.iter().flat_map(|(_, d)| d.points());
            points.map(|point| point[0]).collect()
        }
    };
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    let mut unknown = Vec::new();
    let mut points: Vec<[f64; 2]> = Vec::new();
    for size in sizes {
        // From the first curve on: where all of them say 100 %, rounding must not make it less, which
        // would say that something was retained.
        let first = counting
            .first()
            .and_then(|(_, distribution)| distribution.percent_passing(size));
        let mean = first.and_then(|first| {
            counting
                .iter()
                .try_fold(first, |mean, (weight, distribution)| {
                    let percent = distribution.percent_passing(size)?;
                    Some(mean + weight / total * (percent - first))
                })
        });
        match mean {
            Some(percent) => {
                // A mean of curves that never fall does not fall, but for its rounding.
                let before = points.last().map_or(0.0, |point| point[1]);
                points.push([size, percent.clamp(before, 100.0)]);
            }
            None => unknown.push(size),
        }
    }
    if chosen {
        keep_nearest_certain(&mut points);
    }
    if points.len() < 2 {
        let what = format!(
            "the {} curves share fewer than two sizes at which all are known",
            curves.len()
        );
        return Err(Fault::new(what, "merge curves that cover the same sizes"));
    }
    Ok(Merged {
        distribution: SizeDistribution::new(points)?,
        weight: (weighting != Weighting::Equal).then_some(total),
        unknown,
    })
}

/// What a curve counts.
fn weight(curve: &LabelledDistribution, weighting: Weighting) -> Result<f64, Fault> {
    if weighting == Weighting::Equal {
        return Ok(1.0);
    }
    let name = weighting.key();
    let (what, remedy) = match curve.weight {
        Some(weight) if weight.is_finite() && weight >= 0.0 => return Ok(weight),
        Some(weight) => (
            format!("its {name} is {weight}"),
            "give one that is not negative",
        ),
        None => (
            format!("it has no {name}"),
            "give each curve one in a column, or merge with equal weights",
        ),
    };
    Err(Fault::new(
        format!("{}{what}", curve.labels.in_front()),
        remedy,
    ))
}

impl DistributionSet {
    /// The photos of each method's each trial as one curve, without a photo's name.
    ///
    /// # Errors
    /// As [`merge`], with the name of the group.
    pub fn photos_merged(
        &self,
        weighting: Weighting,
        sizes: Option<&[f64]>,
    ) -> Result<(Self, Vec<String>), Fault> {
        let without_photo = |labels: &Labels| Labels {
            photo: String::new(),
            ..labels.clone()
        };
        self.merged(without_photo, weighting, sizes)
    }

    /// The trials of each method as one curve, and with them their photos.
    ///
    /// # Errors
    /// As [`merge`], with the name of the group.
    pub fn trials_merged(
        &self,
        weighting: Weighting,
        sizes: Option<&[f64]>,
    ) -> Result<(Self, Vec<String>), Fault> {
        let method_alone = |labels: &Labels| Labels {
            method: labels.method.clone(),
            ..Labels::default()
        };
        self.merged(method_alone, weighting, sizes)
    }

    /// The curves that have the same labels once `labels_of` took some off, as one each, in the order of
    /// the first of each; with a sentence for each group of several on what was left out. A curve alone
    /// stays as it is, at its own sizes or at `sizes`, and needs no weight.
    fn merged(
        &self,
        labels_of: impl Fn(&Labels) -> Labels,
        weighting: Weighting,
        sizes: Option<&[f64]>,
    ) -> Result<(Self, Vec<String>), Fault> {
        let mut groups: Vec<(Labels, Vec<&LabelledDistribution>)> = Vec::new();
        for curve in &self.curves {
            let labels = labels_of(&curve.labels);
            match groups.iter_mut().find(|(known, _)| *known == labels) {
                Some((_, curves)) => curves.push(curve),
                None => groups.push((labels, vec![curve])),
            }
        }
        let mut set = Self {
            unit: self.unit,
            curves: Vec::new(),
        };
        let mut warnings = Vec::new();
        for (labels, curves) in groups {
            let found = match curves[..] {
                [curve] => merge(&[curve], Weighting::Equal, sizes).map(|merged| Merged {
                    weight: curve.weight,
                    ..merged
                }),
                _ => merge(&curves, weighting, sizes),
            };
            let name = labels.in_front();
            let found =
                found.map_err(|fault| Fault::new(format!("{name}{}", fault.what), fault.remedy))?;
            if !found.unknown.is_empty() {
                warnings.push(format!(
                    "{name}{} of {} sizes are left out, because not every one of its {} curves is \
                     known there",
                    found.unknown.len(),
                    found.unknown.len() + found.distribution.points().len(),
                    curves.len()
                ));
            }
            set.curves.push(LabelledDistribution {
                labels,
                weight: found.weight,
                distribution: found.distribution,
            });
        }
        Ok((set, warnings))
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use crate::units::LengthUnit;

    fn curve(name: [&str; 3], weight: Option<f64>, points: &[[f64; 2]]) -> LabelledDistribution {
        let [method, trial, photo] = name.map(str::to_owned);
        LabelledDistribution {
            labels: Labels {
                method,
                trial,
                photo,
            },
            weight,
            distribution: SizeDistribution::new(points.to_vec()).expect("a distribution"),
        }
    }

    fn set(curves: Vec<LabelledDistribution>) -> DistributionSet {
        DistributionSet {
            unit: LengthUnit::Millimetre,
            curves,
        }
    }

    fn assert_points(found: &SizeDistribution, wanted: &[[f64; 2]]) {
        assert_eq!(found.points().len(), wanted.len(), "{found:?}");
        for (point, wanted) in found.points().iter().zip(wanted) {
            assert_eq!(point[0], wanted[0]);
            assert!((point[1] - wanted[1]).abs() < 1e-12, "{point:?} {wanted:?}");
        }
    }

    /// By hand: at 10 (20 + 40) / 2 = 30; at 100 the first is 50 (the middle of 20 and 80 on a
    /// logarithmic axis) and the second 80. With weights 1 and 3: (20 + 120) / 4 = 35, and so on.
    #[test]
    fn two_curves_by_hand() {
        let first = curve(
            ["a", "", ""],
            Some(1.0),
            &[[1.0, 5.0], [10.0, 20.0], [1000.0, 80.0]],
        );
        let second = curve(
            ["b", "", ""],
            Some(3.0),
            &[[10.0, 40.0], [100.0, 80.0], [1000.0, 100.0]],
        );
        let merged = merge(&[&first, &second], Weighting::Equal, None).expect("merged");
        assert_points(
            &merged.distribution,
            &[[10.0, 30.0], [100.0, 65.0], [1000.0, 90.0]],
        );
        assert_eq!((merged.weight, merged.unknown), (None, vec![1.0]));
        for weighting in [Weighting::Area, Weighting::Mass] {
            let merged = merge(&[&first, &second], weighting, None).expect("merged");
            assert_points(
                &merged.distribution,
                &[[10.0, 35.0], [100.0, 72.5], [1000.0, 95.0]],
            );
            assert_eq!(merged.weight, Some(4.0));
        }
        let at = [100.0, 1000.0, 5000.0];
        let merged = merge(&[&first, &second], Weighting::Equal, Some(&at)).expect("merged");
        assert_points(&merged.distribution, &[[100.0, 65.0], [1000.0, 90.0]]);
        assert_eq!(merged.unknown, [5000.0]);
    }

    /// Masses: 1 t of which 30 % pass 10 mm and 3 t of which 50 % do are 4 t of which 1.8 t pass.
    #[test]
    fn a_curve_of_weight_0_does_not_count() {
        let one = curve(["a", "", ""], Some(1.0), &[[10.0, 30.0], [20.0, 60.0]]);
        let three = curve(["b", "", ""], Some(3.0), &[[10.0, 50.0], [20.0, 80.0]]);
        let none = curve(["c", "", ""], Some(0.0), &[[15.0, 0.0], [16.0, 1.0]]);
        let merged = merge(&[&one, &three, &none], Weighting::Mass, None).expect("merged");
        assert_points(&merged.distribution, &[[10.0, 45.0], [20.0, 75.0]]);
    }

    #[test]
    fn photos_then_trials() {
        let photo = |trial: &str, photo: &str, area: f64, first: f64| {
            curve(
                ["point cloud", trial, photo],
                Some(area),
                &[[10.0, first], [20.0, 100.0]],
            )
        };
        let all = set(vec![
            photo("1", "a", 1.0, 10.0),
            curve(["sieve", "", ""], None, &[[10.0, 50.0], [30.0, 100.0]]),
            photo("2", "a", 1.0, 30.0),
            photo("1", "b", 3.0, 30.0),
        ]);
        let (photos, said) = all.photos_merged(Weighting::Area, None).expect("merged");
        assert!(said.is_empty(), "{said:?}");
        let names: Vec<String> = photos.curves.iter().map(|c| c.labels.to_string()).collect();
        assert_eq!(names, ["point cloud / 1", "sieve", "point cloud / 2"]);
        assert_points(
            &photos.curves[0].distribution,
            &[[10.0, 25.0], [20.0, 100.0]],
        );
        assert_eq!(photos.curves[0].weight, Some(4.0));
        assert_eq!(photos.curves[1].distribution, all.curves[1].distribution);
        let (methods, _) = photos
            .trials_merged(Weighting::Equal, None)
            .expect("merged");
        assert_eq!(methods.curves.len(), 2);
        assert_points(
            &methods.curves[0].distribution,
            &[[10.0, 27.5], [20.0, 100.0]],
        );
    }

    #[test]
    fn weights_that_cannot_be() {
        let with = |weight| curve(["m", "1", "a.jpg"], weight, &[[10.0, 30.0], [20.0, 60.0]]);
        let good = curve(
            ["m", "1", "b.jpg"],
            Some(1.0),
            &[[10.0, 30.0], [20.0, 60.0]],
        );
        for (weight, wanted) in [
            (
                None,
                "m / 1 / a.jpg: it has no area; give each curve one in a column, or merge with equal weights",
            ),
            (
                Some(-1.0),
                "m / 1 / a.jpg: its area is -1; give one that is not negative",
            ),
            (
                Some(f64::NAN),
                "m / 1 / a.jpg: its area is NaN; give one that is not negative",
            ),
        ] {
            let fault =
                merge(&[&good, &with(weight)], Weighting::Area, None).expect_err("no weight");
            assert_eq!(fault.to_string(), wanted);
            assert!(merge(&[&good, &with(weight)], Weighting::Equal, None).is_ok());
        }
        let zero = with(Some(0.0));
        let fault = merge(&[&zero, &zero], Weighting::Mass, None).expect_err("weights of 0");
        assert!(fault.what.contains("sum to 0"), "{fault}");
        assert!(merge(&[], Weighting::Equal, None).is_err());
        let fine = curve(["m", "1", "c"], None, &[[1.0, 30.0], [2.0, 60.0]]);
        let fault = set(vec![good, fine])
            .photos_merged(Weighting::Equal, None)
            .expect_err("apart");
        assert!(
            fault.what.starts_with("m / 1: the 2 curves share fewer"),
            "{fault}"
        );
    }

    /// Weights whose shares are no binary fractions: 100 % stays 100 %, 0 stays 0.
    #[test]
    fn where_all_passes_all_passes_merged() {
        let photo = |name: &str, weight: f64, middle: f64| {
            let points = [[1.0, 0.0], [2.0, middle], [3.0, 100.0]];
            curve(["", "", name], Some(weight), &points)
        };
        let photos = [
            photo("a", 0.195, 30.0),
            photo("b", 0.1934, 40.0),
            photo("c", 0.2159, 50.0),
        ];
        let photos: Vec<_> = photos.iter().collect();
        let by_area = (0.195 * 30.0 + 0.1934 * 40.0 + 0.2159 * 50.0) / (0.195 + 0.1934 + 0.2159);
        for (weighting, wanted) in [(Weighting::Equal, 40.0), (Weighting::Area, by_area)] {
            let merged = merge(&photos, weighting, None).expect("merged");
            assert_points(
                &merged.distribution,
                &[[1.0, 0.0], [2.0, wanted], [3.0, 100.0]],
            );
            assert_eq!(merged.distribution.points()[2][1], 100.0);
        }
    }
}
