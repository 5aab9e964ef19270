//! What a distribution reads at other sizes than it was measured at: those of a series of sieves, or any.

mod sizes;

use self::sizes::Sizes;
use super::{DistributionSet, LabelledDistribution, SieveSeries, SizeDistribution};
use crate::fault::Fault;

/// Sizes nearer to a sieve's than this share are of that sieve: inches that were converted.
const SAME_SIEVE: f64 = 1e-9;

/// A distribution at other sizes than it was measured at.
#[derive(Debug, Clone, PartialEq)]
pub struct Resampled {
    /// Interpolated as `SizeDistribution::percent_passing` does.
    pub distribution: SizeDistribution,
    /// The sizes at which the percent passing is not known, because they lie outside of what was
    /// measured.
    pub unknown: Vec<f64>,
}

/// The percent passing at other sizes, in any order, above 0 and in the distribution's unit.
///
/// Nothing is invented outside of what was measured: such a size is left out. Of the sizes above one
/// that everything passes, and below one that nothing passes, only the nearest is kept: more of them
/// would say the same and weigh in a fit.
///
/// # Errors
/// Where fewer than two sizes are left.
pub fn resample(distribution: &SizeDistribution, sizes: &[f64]) -> Result<Resampled, Fault> {
    // 11.2 mm are not 1.12 cm to the last bit, and yet the same sieve.
    let measured = || distribution.points().iter().map(|point| point[0]);
    let same = |size: &f64| {
        let own = measured().find(|own| (own / size - 1.0).abs() < SAME_SIEVE);
        own.unwrap_or(*size)
    };
    let mut sizes: Vec<f64> = sizes.iter().map(same).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.dedup();
    let mut unknown = Vec::new();
    let mut points: Vec<[f64; 2]> = Vec::new();
    for size in sizes {
        match distribution.percent_passing(size) {
            Some(percent) => points.push([size, percent]),
            None => unknown.push(size),
        }
    }
    keep_nearest_certain(&mut points);
    if points.len() < 2 {
        let measured = distribution.points();
        let (first, last) = (measured.first(), measured.last());
        let range = first
            .zip(last)
            .map(|(a, b)| format!("{} to {}", a[0], b[0]));
        let what = format!(
            "fewer than two of the sizes lie where the distribution was measured, {}",
            range.unwrap_or_default()
        );
        return Err(Fault::new(what, "choose a series with sieves there"));
    }
    let distribution = SizeDistribution::new(points)?;
    Ok(Resampled {
        distribution,
        unknown,
    })
}

/// Of ascending points [size, percent] drops those of 0 % but the last, and those of 100 % but the first.
pub(super) fn keep_nearest_certain(points: &mut Vec<[f64; 2]>) {
    let nothing_passes = points.partition_point(|point| point[1] <= 0.0);
    points.drain(..nothing_passes.saturating_sub(1));
    let not_all_pass = points.partition_point(|point| point[1] < 100.0);
    points.truncate(not_all_pass + 1);
}

impl DistributionSet {
    /// Every curve at the sieves of a series, with what is not known there and what was measured beyond them, a sentence each of all
    /// curves. Where a curve was measured at sizes beyond the series' ends (blasted rock above 125 mm) it keeps them: left out, they
    /// would seem never to have been measured, and a function fitted to the rest would guess them.
    ///
    /// # Errors
    /// Where a curve has fewer than two of them where it was measured.
    pub fn resampled(&self, series: SieveSeries) -> Result<(Self, Vec<String>), Fault> {
        let openings = series.openings(self.unit);
        let mut set = Self {
            unit: self.unit,
            curves: Vec::new(),
        };
        let [mut kept_as_measured, mut left_out] = [Sizes::default(), Sizes::default()];
        for curve in &self.curves {
            let named = |fault: Fault| {
                Fault::new(
                    format!("{}{}", curve.labels.in_front(), fault.what),
                    fault.remedy,
                )
            };
            let measured = curve.distribution.points().iter().map(|point| point[0]);
            let is_beyond = |size: &f64| {
                openings
                    .first()
                    .is_some_and(|least| *size < least * (1.0 - SAME_SIEVE))
                    || openings
                        .last()
                        .is_some_and(|most| *size > most * (1.0 + SAME_SIEVE))
            };
            let beyond: Vec<f64> = measured.filter(is_beyond).collect();
            let sizes = [&openings[..], &beyond].concat();
            let found = resample(&curve.distribution, &sizes).map_err(named)?;
            let kept = beyond.iter().filter(|size| {
                let mut points = found.distribution.points().iter();
                points.any(|point| point[0] == **size)
            });
            let kept: Vec<f64> = kept.copied().collect();
            kept_as_measured.add(curve, &kept);
            left_out.add(curve, &found.unknown);
            set.curves.push(LabelledDistribution {
                distribution: found.distribution,
                ..curve.clone()
            });
        }
        let all = self.curves.len();
        let kept = kept_as_measured.told(self.unit, all).map(|told| {
            format!(
                "{}{} has no sieve for what was measured at {} sizes{} ({}): they are kept as they are",
                told.in_front,
                series.name(),
                told.count,
                told.of_curves,
                told.range
            )
        });
        let left_out = left_out.told(self.unit, all).map(|told| {
            format!(
                "{}{} of the {} sieves of {} ({}) lie outside of what was measured{} and are left out",
                told.in_front,
                told.count,
                openings.len(),
                series.name(),
                told.range,
                told.of_curves
            )
        });
        Ok((set, kept.into_iter().chain(left_out).collect()))
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use crate::Labels;
    use crate::units::LengthUnit;

    /// The same sieves in another unit: what was measured at its ends is kept, whatever rounding says.
    #[test]
    fn sieves_are_the_same_in_every_unit() {
        let in_mm = [1.4, 2.8, 11.2, 31.5, 63.0, 106.0];
        let passing = [5.0, 12.0, 30.0, 55.0, 80.0, 97.0];
        let mut counts = Vec::new();
        for unit in LengthUnit::ALL {
            let factor = LengthUnit::Millimetre.in_units_of(unit);
            for last in [3, 5] {
                let points = in_mm.iter().zip(passing).take(last + 1).skip(last - 3);
                let points = points.map(|(size, percent)| [size * factor, percent]);
                let curve = SizeDistribution::new(points.collect()).expect("a curve");
                let found = resample(&curve, &SieveSeries::AstmE11.openings(unit)).expect("sieves");
                let ends = [
                    found.distribution.points().first(),
                    found.distribution.points().last(),
                ];
                let own = [curve.points().first(), curve.points().last()];
                assert_eq!(ends, own, "{unit}");
                counts.push((last, found.distribution.points().len()));
            }
        }
        counts.sort_unstable();
        counts.dedup();
        assert_eq!(counts.len(), 2, "{counts:?}");
    }

    /// Between 10 and 1000 the middle on a logarithmic axis is 100.
    #[test]
    fn resampling_interpolates_and_invents_nothing() {
        let open =
            SizeDistribution::new(vec![[10.0, 20.0], [1000.0, 80.0]]).expect("a distribution");
        let found = resample(&open, &[1000.0, 1.0, 100.0, 2000.0]).expect("two inside");
        assert_eq!(found.unknown, [1.0, 2000.0]);
        let points = found.distribution.points();
        assert_eq!(points.len(), 2);
        assert!((points[0][1] - 50.0).abs() < 1e-12 && points[1] == [1000.0, 80.0]);
        // Where everything or nothing passes that is known, and said once.
        let closed =
            SizeDistribution::new(vec![[10.0, 0.0], [1000.0, 100.0]]).expect("a distribution");
        let found = resample(&closed, &[1.0, 5.0, 100.0, 2000.0, 3000.0]).expect("three known");
        let wanted = [[5.0, 0.0], [100.0, 50.0], [2000.0, 100.0]];
        for (point, wanted) in found.distribution.points().iter().zip(wanted) {
            assert!(
                point[0] == wanted[0] && (point[1] - wanted[1]).abs() < 1e-12,
                "{point:?}"
            );
        }
        assert!(found.unknown.is_empty() && found.distribution.points().len() == 3);
        let fault = resample(&open, &[1.0, 100.0]).expect_err("one inside");
        assert!(fault.what.contains("10 to 1000"), "{fault}");
        assert!(resample(&closed, &[1.0, 2.0]).is_err());
        assert!(resample(&closed, &[]).is_err());
    }

    /// As a finder's file: ASTM E11 ends at 125 mm, and half of the rock was measured above.
    #[test]
    fn what_is_coarser_than_the_series_is_kept() {
        let points = [
            [63.0, 30.5821],
            [90.0, 40.035],
            [125.0, 51.5956],
            [180.0, 67.5971],
            [250.0, 83.0443],
            [355.0, 95.8504],
            [500.0, 100.0],
        ];
        let set = DistributionSet {
            unit: LengthUnit::Millimetre,
            curves: vec![LabelledDistribution {
                labels: Labels::default(),
                weight: None,
                distribution: SizeDistribution::new(points.to_vec()).expect("a distribution"),
            }],
        };
        let (found, said) = set.resampled(SieveSeries::AstmE11).expect("sieves");
        let kept = &found.curves[0].distribution;
        assert!(kept.points().ends_with(&points[3..]), "{:?}", kept.points());
        // What was measured of P80 stays what it is.
        let p80 = set.curves[0].distribution.size_at(80.0);
        assert_eq!(kept.size_at(80.0), p80);
        assert!(
            said[0].contains("has no sieve for what was measured at 4 sizes (180 to 500 mm)"),
            "{said:?}"
        );
    }

    /// The basic set from 63 um to 125 mm has 12 sieves: of 1 to 8 mm 8 lie outside, of 1 to 4 mm 9; 200 and 250 mm lie beyond it.
    #[test]
    fn what_lies_outside_is_said_once_for_all_curves() {
        let curve = |photo: &str, points: &[[f64; 2]]| LabelledDistribution {
            labels: Labels {
                photo: photo.to_owned(),
                ..Labels::default()
            },
            weight: None,
            distribution: SizeDistribution::new(points.to_vec()).expect("a distribution"),
        };
        let mut set = DistributionSet {
            unit: LengthUnit::Millimetre,
            curves: vec![
                curve("a", &[[1.0, 10.0], [8.0, 90.0]]),
                curve("b", &[[1.0, 10.0], [4.0, 90.0]]),
            ],
        };
        let said =
            |set: &DistributionSet| set.resampled(SieveSeries::En933Basic).expect("sieves").1;
        assert_eq!(
            said(&set),
            [
                "8 to 9 of the 12 sieves of EN 933-2 basic set (0.063 to 125 mm) lie outside of what was measured of each of the 2 curves and are left out"
            ]
        );
        set.curves.push(curve(
            "c",
            &[
                [0.063, 1.0],
                [1.0, 10.0],
                [125.0, 70.0],
                [200.0, 90.0],
                [250.0, 99.0],
            ],
        ));
        assert_eq!(
            said(&set),
            [
                "c: EN 933-2 basic set has no sieve for what was measured at 2 sizes (200 to 250 mm): they are kept as they are",
                "8 to 9 of the 12 sieves of EN 933-2 basic set (0.063 to 125 mm) lie outside of what was measured of each of 2 of the 3 curves and are left out",
            ]
        );
    }

    #[test]
    fn a_set_in_inches_at_sieves_in_millimetres() {
        let distribution =
            SizeDistribution::new(vec![[1.0, 10.0], [4.0, 90.0]]).expect("a distribution");
        let set = DistributionSet {
            unit: LengthUnit::Inch,
            curves: vec![LabelledDistribution {
                labels: Labels::default(),
                weight: Some(2.0),
                distribution,
            }],
        };
        let (found, said) = set.resampled(SieveSeries::En933Basic).expect("two inside");
        let sizes: Vec<f64> = found.curves[0]
            .distribution
            .points()
            .iter()
            .map(|p| p[0] * 25.4)
            .collect();
        assert!(
            (sizes[0] - 31.5).abs() < 1e-12 && (sizes[1] - 63.0).abs() < 1e-12,
            "{sizes:?}"
        );
        assert_eq!((sizes.len(), found.curves[0].weight), (2, Some(2.0)));
        assert_eq!(said.len(), 1);
        assert!(
            said[0].contains("10 of the 12 sieves of EN 933-2 basic set"),
            "{said:?}"
        );
    }
}
