//! Standard series of test sieves.
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

#[cfg(test)]
mod tests {
    use super::*;

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
}
