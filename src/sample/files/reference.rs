//! reference.csv: what a sieve analysis of the pile would find, `size_mm,percent_passing`: the mass
//! that passes each sieve, in percent of all, from the smallest opening on. And the sieves to choose
//! from: ISO 565 R20/3 and ASTM E11, openings in mm.

/// Nominal openings of ISO 565:1990, principal sizes R20/3, in mm from the smallest on: every third
/// of ISO 3's preferred numbers R20, a ratio of about 1.41. Down to 45 um, where its woven wire goes
/// over to another series.
pub const ISO_565_R20_3_MM: &[f64] = &[
    0.045, 0.063, 0.09, 0.125, 0.18, 0.25, 0.355, 0.5, 0.71, 1.0, 1.4, 2.0, 2.8, 4.0, 5.6, 8.0,
    11.2, 16.0, 22.4, 31.5, 45.0, 63.0, 90.0, 125.0,
];

/// What follows the largest sieve of ISO 565 in the same series R20/3 of ISO 3:1973, in mm. No such
/// test sieve is standard, but blasted rock is larger than 125 mm.
pub const ISO_3_R20_3_ABOVE_MM: &[f64] = &[
    180.0, 250.0, 355.0, 500.0, 710.0, 1000.0, 1400.0, 2000.0, 2800.0,
];

/// Openings of ASTM E11, table 1, standard designation, in mm from the smallest on: steps of the
/// fourth root of 2 from 125 mm, and the 100, 50, 25, 12.5 and 6.3 mm that the table adds because
/// they are in common use.
pub const ASTM_E11_MM: &[f64] = &[
    0.02, 0.025, 0.032, 0.038, 0.045, 0.053, 0.063, 0.075, 0.09, 0.106, 0.125, 0.15, 0.18, 0.212,
    0.25, 0.3, 0.355, 0.425, 0.5, 0.6, 0.71, 0.85, 1.0, 1.18, 1.4, 1.7, 2.0, 2.36, 2.8, 3.35, 4.0,
    4.75, 5.6, 6.3, 6.7, 8.0, 9.5, 11.2, 12.5, 13.2, 16.0, 19.0, 22.4, 25.0, 26.5, 31.5, 37.5,
    45.0, 50.0, 53.0, 63.0, 75.0, 90.0, 100.0, 106.0, 125.0,
];

/// A series of sieve openings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SieveSeries {
    /// [`ISO_565_R20_3_MM`], then [`ISO_3_R20_3_ABOVE_MM`].
    Iso565,
    /// [`ASTM_E11_MM`]; nothing above 125 mm.
    AstmE11,
}

impl SieveSeries {
    /// The openings from `smallest` to `largest` mm, both included, from the smallest on; none where
    /// the series has none between them.
    pub fn openings_mm(self, smallest: f64, largest: f64) -> Vec<f64> {
        let (table, above): (&[f64], &[f64]) = match self {
            Self::Iso565 => (ISO_565_R20_3_MM, ISO_3_R20_3_ABOVE_MM),
            Self::AstmE11 => (ASTM_E11_MM, &[]),
        };
        let all = table.iter().chain(above).copied();
        all.filter(|size| (smallest..=largest).contains(size))
            .collect()
    }
}

/// The text of a reference.csv, from pairs of an opening in mm and the percent of the mass that
/// passes it. Numbers read back to the same f64.
///
/// # Errors
/// Where it is no cumulative curve: there is no sieve, an opening is not larger than the one before
/// (and than 0), or a percentage is outside 0 to 100 or less than the one before.
pub fn reference_csv(passing: &[(f64, f64)]) -> Result<String, String> {
    if passing.is_empty() {
        return Err("there are no sieves".to_owned());
    }
    let mut text = String::from("size_mm,percent_passing\n");
    let (mut last_size, mut last_percent) = (0.0, 0.0);
    for &(size, percent) in passing {
        if !size.is_finite() || size <= last_size {
            return Err(format!(
                "a sieve of {size} mm follows one of {last_size} mm"
            ));
        }
        if !(last_percent..=100.0).contains(&percent) {
            return Err(format!(
                "{percent} % pass {size} mm; it must be from {last_percent} to 100"
            ));
        }
        text += &format!("{size},{percent}\n");
        (last_size, last_percent) = (size, percent);
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_back_exactly() {
        let curve = [(0.045, 0.0), (22.4, 100.0 / 3.0), (90.0, 100.0)];
        let text = reference_csv(&curve).unwrap();
        assert_eq!(reference_csv(&curve).unwrap(), text);
        assert!(text.starts_with("size_mm,percent_passing\n0.045,0\n22.4,"));
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let read: Vec<(f64, f64)> = reader.deserialize().map(Result::unwrap).collect();
        assert_eq!(read, curve);
    }

    #[test]
    fn what_is_no_cumulative_curve_is_refused() {
        let nan = f64::NAN;
        for curve in [
            &[][..],
            &[(0.0, 1.0)],
            &[(1.0, nan)],
            &[(nan, 1.0)],
            &[(f64::INFINITY, 1.0)],
            &[(1.0, -0.1)],
            &[(1.0, 100.1)],
            &[(2.0, 1.0), (1.0, 2.0)],
            &[(1.0, 2.0), (2.0, 1.0)],
        ] {
            assert!(reference_csv(curve).is_err(), "{curve:?}");
        }
    }

    /// ISO 3: the k-th R20/3 number is 10^(3k/20), rounded by up to 1.3 %; the series repeats after
    /// 20 numbers, at 1000 times the size.
    #[test]
    fn iso_565_is_r20_3() {
        let all = SieveSeries::Iso565.openings_mm(0.0, f64::INFINITY);
        assert_eq!(all.len(), 33);
        for (k, size) in (-9..).zip(&all) {
            // 1 mm is number 0 and stands at index 9.
            let exact = 10_f64.powf(f64::from(k) * 0.15);
            assert!((size / exact - 1.0).abs() < 0.0135, "{size} for {exact}");
        }
        for (small, large) in all.iter().zip(&all[20..]) {
            assert!((small * 1000.0 - large).abs() < 1e-9);
        }
    }

    /// E11: the ratio is the fourth root of 2, but for the five sizes that the table adds.
    #[test]
    fn astm_e11_steps_by_the_fourth_root_of_two() {
        let added = [100.0, 50.0, 25.0, 12.5, 6.3];
        let all = SieveSeries::AstmE11.openings_mm(0.02, 125.0);
        assert_eq!(all, ASTM_E11_MM);
        let regular: Vec<f64> = all.into_iter().filter(|s| !added.contains(s)).collect();
        // Rounding to preferred numbers and whole micrometres moves a step by up to 8 %.
        for pair in regular.windows(2) {
            let off = pair[1] / pair[0] / 2_f64.powf(0.25) - 1.0;
            assert!(off.abs() < 0.08, "{pair:?}");
        }
        assert!(ASTM_E11_MM.is_sorted() && added.iter().all(|s| ASTM_E11_MM.contains(s)));
    }

    #[test]
    fn openings_between_two_sizes() {
        let iso = SieveSeries::Iso565;
        assert_eq!(iso.openings_mm(63.0, 200.0), [63.0, 90.0, 125.0, 180.0]);
        assert_eq!(iso.openings_mm(64.0, 65.0), [0.0; 0]);
        assert_eq!(iso.openings_mm(f64::NAN, 65.0), [0.0; 0]);
        assert_eq!(
            SieveSeries::AstmE11.openings_mm(50.0, 1000.0),
            [50.0, 53.0, 63.0, 75.0, 90.0, 100.0, 106.0, 125.0]
        );
    }
}
