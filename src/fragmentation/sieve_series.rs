//! Standard series of test sieves, and what a distribution reads at their openings.
//!
//! - ASTM E11, table 1: 125 mm to 20 um in steps of the fourth root of 2, with the sieves in between
//!   that the table adds because they are in common use; with their alternative designations.
//! - ISO 565:1990 and ISO 3310-1, principal series R20/3: 125 mm to 45 um, every third of ISO 3's
//!   preferred numbers R20.
//! - EN 933-2, the sieves of aggregates: the basic set (31.5 mm for 32 apart, a doubling from 63 um
//!   to 125 mm), and with it set 1 (of R20) or set 2 (of R10, and 14 mm) that EN 12620 and EN 13043
//!   name sizes of aggregates by.
//!
//! None has a sieve above 125 mm, and none is invented here: coarser rock keeps the sizes that it was
//! measured at.

use super::distribution::as_typed;
use super::{DistributionSet, LabelledDistribution, SizeDistribution};
use crate::fault::Fault;
use crate::units::LengthUnit;

/// A test sieve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sieve {
    /// The nominal opening, the side of its square, mm.
    pub opening_mm: f64,
    /// What the standard calls it beside its opening ("No. 4", "1/2 in."); empty where it does not.
    pub designation: &'static str,
}

/// A standard series of test sieves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SieveSeries {
    /// ASTM E11, all of table 1.
    AstmE11,
    /// ISO 565 and ISO 3310-1, principal series R20/3.
    Iso565,
    /// EN 933-2, basic set.
    En933Basic,
    /// EN 933-2, basic set plus set 1.
    En933Set1,
    /// EN 933-2, basic set plus set 2.
    En933Set2,
}

impl SieveSeries {
    /// All, in the order in which people are offered them.
    pub const ALL: [Self; 5] = [
        Self::AstmE11,
        Self::Iso565,
        Self::En933Basic,
        Self::En933Set1,
        Self::En933Set2,
    ];

    /// Its name on the command line and in JSON.
    pub fn key(self) -> &'static str {
        match self {
            Self::AstmE11 => "astm-e11",
            Self::Iso565 => "iso-565",
            Self::En933Basic => "en-933-2",
            Self::En933Set1 => "en-933-2-set1",
            Self::En933Set2 => "en-933-2-set2",
        }
    }

    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::AstmE11 => "ASTM E11",
            Self::Iso565 => "ISO 565 R20/3",
            Self::En933Basic => "EN 933-2 basic set",
            Self::En933Set1 => "EN 933-2 basic set plus set 1",
            Self::En933Set2 => "EN 933-2 basic set plus set 2",
        }
    }

    /// Its sieves, the smallest first.
    pub fn sieves(self) -> Vec<Sieve> {
        let plain = |openings: &[f64]| {
            let sieve = |&opening_mm| Sieve {
                opening_mm,
                designation: "",
            };
            openings.iter().map(sieve).collect()
        };
        let with_basic = |more: &[f64]| {
            let mut openings = [EN_933_2_BASIC, more].concat();
            openings.sort_by(f64::total_cmp);
            plain(&openings)
        };
        match self {
            Self::AstmE11 => (ASTM_E11.iter())
                .map(|&(opening_mm, designation)| Sieve {
                    opening_mm,
                    designation,
                })
                .collect(),
            Self::Iso565 => plain(ISO_565_R20_3),
            Self::En933Basic => plain(EN_933_2_BASIC),
            Self::En933Set1 => with_basic(EN_933_2_SET_1),
            Self::En933Set2 => with_basic(EN_933_2_SET_2),
        }
    }

    /// The openings of its sieves in a unit, the smallest first.
    pub fn openings(self, unit: LengthUnit) -> Vec<f64> {
        let of_mm = LengthUnit::Millimetre.in_units_of(unit);
        let sieves = self.sieves();
        sieves.iter().map(|s| s.opening_mm * of_mm).collect()
    }
}

/// Opening in mm and alternative designation.
const ASTM_E11: &[(f64, &str)] = &[
    (0.02, "No. 635"),
    (0.025, "No. 500"),
    (0.032, "No. 450"),
    (0.038, "No. 400"),
    (0.045, "No. 325"),
    (0.053, "No. 270"),
    (0.063, "No. 230"),
    (0.075, "No. 200"),
    (0.09, "No. 170"),
    (0.106, "No. 140"),
    (0.125, "No. 120"),
    (0.15, "No. 100"),
    (0.18, "No. 80"),
    (0.212, "No. 70"),
    (0.25, "No. 60"),
    (0.3, "No. 50"),
    (0.355, "No. 45"),
    (0.425, "No. 40"),
    (0.5, "No. 35"),
    (0.6, "No. 30"),
    (0.71, "No. 25"),
    (0.85, "No. 20"),
    (1.0, "No. 18"),
    (1.18, "No. 16"),
    (1.4, "No. 14"),
    (1.7, "No. 12"),
    (2.0, "No. 10"),
    (2.36, "No. 8"),
    (2.8, "No. 7"),
    (3.35, "No. 6"),
    (4.0, "No. 5"),
    (4.75, "No. 4"),
    (5.6, "No. 3 1/2"),
    (6.3, "1/4 in."),
    (6.7, "0.265 in."),
    (8.0, "5/16 in."),
    (9.5, "3/8 in."),
    (11.2, "7/16 in."),
    (12.5, "1/2 in."),
    (13.2, "0.530 in."),
    (16.0, "5/8 in."),
    (19.0, "3/4 in."),
    (22.4, "7/8 in."),
    (25.0, "1 in."),
    (26.5, "1.06 in."),
    (31.5, "1 1/4 in."),
    (37.5, "1 1/2 in."),
    (45.0, "1 3/4 in."),
    (50.0, "2 in."),
    (53.0, "2.12 in."),
    (63.0, "2 1/2 in."),
    (75.0, "3 in."),
    (90.0, "3 1/2 in."),
    (100.0, "4 in."),
    (106.0, "4.24 in."),
    (125.0, "5 in."),
];

const ISO_565_R20_3: &[f64] = &[
    0.045, 0.063, 0.09, 0.125, 0.18, 0.25, 0.355, 0.5, 0.71, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0,
    11.2, 16.0, 22.4, 31.5, 45.0, 63.0, 90.0, 125.0,
];

const EN_933_2_BASIC: &[f64] = &[
    0.063, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 31.5, 63.0, 125.0,
];

const EN_933_2_SET_1: &[f64] = &[5.6, 11.2, 22.4, 45.0];

const EN_933_2_SET_2: &[f64] = &[6.3, 10.0, 12.5, 14.0, 20.0, 40.0];

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

/// Sizes of one curve after another, which are told in one sentence.
#[derive(Default)]
struct Sizes {
    /// Of how many curves there are some, how many at least and at most, and the least and the greatest.
    curves: usize,
    counts: [usize; 2],
    ends: [f64; 2],
    /// What stands in front of a sentence of the first of the curves.
    first: String,
}

/// The parts of such a sentence.
struct ToldSizes {
    in_front: String,
    count: String,
    range: String,
    of_curves: String,
}

impl Sizes {
    /// Adds those of a curve, which ascend.
    fn add(&mut self, curve: &LabelledDistribution, sizes: &[f64]) {
        let (Some(least), Some(most)) = (sizes.first(), sizes.last()) else {
            return;
        };
        let count = sizes.len();
        if self.curves == 0 {
            self.counts = [count; 2];
            self.ends = [*least, *most];
            self.first = curve.labels.in_front();
        }
        self.curves += 1;
        self.counts = [self.counts[0].min(count), self.counts[1].max(count)];
        self.ends = [self.ends[0].min(*least), self.ends[1].max(*most)];
    }

    /// What is told of them, of `all` curves; `None` where there are none.
    fn told(self, unit: LengthUnit, all: usize) -> Option<ToldSizes> {
        let [least, most] = self.ends.map(as_typed);
        let count = match self.counts {
            [fewest, most] if fewest == most => most.to_string(),
            [fewest, most] => format!("{fewest} to {most}"),
        };
        let (in_front, of_curves) = match self.curves {
            0 => return None,
            1 => (self.first, String::new()),
            some if some == all => (String::new(), format!(" of each of the {all} curves")),
            some => (
                String::new(),
                format!(" of each of {some} of the {all} curves"),
            ),
        };
        Some(ToldSizes {
            in_front,
            count,
            range: format!("{least} to {most} {unit}"),
            of_curves,
        })
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use crate::Labels;

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

    /// ASTM E11, table 1: the sieves without those in common use in between are powers of the fourth root
    /// of 2 in mm, rounded, from 2^7 down; every third of R20 is 10^(3 k / 20), rounded; EN 933-2's basic
    /// set doubles, with 31.5 for 32.
    #[test]
    fn series_follow_their_ratios() {
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 0.035;
        let in_between = [6.3, 12.5, 25.0, 50.0, 100.0];
        let e11 = SieveSeries::AstmE11.sieves();
        let steps: Vec<f64> = (e11.iter().rev())
            .map(|sieve| sieve.opening_mm)
            .filter(|opening| !in_between.contains(opening))
            .collect();
        // From 38 um on every second step only.
        for (step, opening) in steps.iter().enumerate().take(47) {
            let exact = 2_f64.powf(7.0 - step as f64 / 4.0);
            assert!(near(*opening, exact), "{opening} {exact}");
        }
        assert_eq!((e11.len(), steps.len()), (56, 51));
        let iso = SieveSeries::Iso565.sieves();
        assert_eq!(iso.len(), 24);
        for (step, sieve) in iso.iter().enumerate() {
            let exact = 0.045 * 10_f64.powf(3.0 * step as f64 / 20.0);
            assert!(near(sieve.opening_mm, exact), "{sieve:?} {exact}");
        }
        let basic = SieveSeries::En933Basic.sieves();
        for (step, sieve) in basic.iter().enumerate() {
            assert!(
                near(sieve.opening_mm, 0.0625 * 2_f64.powf(step as f64)),
                "{sieve:?}"
            );
        }
        assert_eq!(basic.len(), 12);
    }

    /// Single values that labs know by heart, from ASTM E11-01, table 1, as printed there.
    #[test]
    fn designations() {
        let sieves = SieveSeries::AstmE11.sieves();
        for (designation, opening) in [
            ("3 in.", 75.0),
            ("1 1/2 in.", 37.5),
            ("3/4 in.", 19.0),
            ("1/2 in.", 12.5),
            ("3/8 in.", 9.5),
            ("1/4 in.", 6.3),
            ("No. 3 1/2", 5.6),
            ("No. 4", 4.75),
            ("No. 8", 2.36),
            ("No. 10", 2.0),
            ("No. 16", 1.18),
            ("No. 40", 0.425),
            ("No. 100", 0.15),
            ("No. 200", 0.075),
            ("No. 325", 0.045),
            ("No. 635", 0.02),
        ] {
            let sieve = sieves.iter().find(|sieve| sieve.designation == designation);
            assert_eq!(
                sieve.map(|sieve| sieve.opening_mm),
                Some(opening),
                "{designation}"
            );
        }
    }

    /// EN 12620 names aggregates by these: set 1 is R20/3 with the basic set from 4 mm on, set 2 has 6.3,
    /// 10, 12.5, 14, 20 and 40 mm.
    #[test]
    fn sets_of_aggregates() {
        let from_1_to_63 = |series: SieveSeries| {
            let openings = series.openings(LengthUnit::Millimetre).into_iter();
            openings
                .filter(|opening| (1.0..=63.0).contains(opening))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            from_1_to_63(SieveSeries::En933Set1),
            [1.0, 2.0, 4.0, 5.6, 8.0, 11.2, 16.0, 22.4, 31.5, 45.0, 63.0]
        );
        assert_eq!(
            from_1_to_63(SieveSeries::En933Set2),
            [
                1.0, 2.0, 4.0, 6.3, 8.0, 10.0, 12.5, 14.0, 16.0, 20.0, 31.5, 40.0, 63.0
            ]
        );
        for series in SieveSeries::ALL {
            let openings = series.openings(LengthUnit::Millimetre);
            assert!(openings.is_sorted_by(|a, b| a < b), "{}", series.name());
            assert_eq!(openings.last(), Some(&125.0));
        }
        assert_eq!(
            SieveSeries::En933Basic.openings(LengthUnit::Metre)[11],
            0.125
        );
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
