//! reference.csv: what a sieve analysis of the pile would find, `size_mm,percent_passing`: the mass
//! that passes each sieve, in percent of all, from the smallest opening on. The sieves are those of
//! ISO 565 R20/3.

use crate::fragmentation::SieveSeries;
use crate::units::LengthUnit;

/// What follows the largest sieve of ISO 565 in the same series R20/3 of ISO 3:1973, in mm. No such
/// test sieve is standard, but blasted rock is larger than 125 mm.
const ISO_3_R20_3_ABOVE_MM: &[f64] = &[
    180.0, 250.0, 355.0, 500.0, 710.0, 1000.0, 1400.0, 2000.0, 2800.0,
];

/// The openings from `smallest` to `largest` mm, both included, from the smallest on; none where the
/// series has none between them.
pub fn openings_mm(smallest: f64, largest: f64) -> Vec<f64> {
    let standard = SieveSeries::Iso565.openings(LengthUnit::Millimetre);
    let all = standard
        .into_iter()
        .chain(ISO_3_R20_3_ABOVE_MM.iter().copied());
    all.filter(|size| (smallest..=largest).contains(size))
        .collect()
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
        let all = openings_mm(0.0, f64::INFINITY);
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

    #[test]
    fn only_what_lies_between() {
        assert_eq!(openings_mm(8.0, 22.4), [8.0, 11.2, 16.0, 22.4]);
        assert_eq!(openings_mm(100.0, 200.0), [125.0, 180.0]);
        assert!(openings_mm(3000.0, 4000.0).is_empty());
    }
}
