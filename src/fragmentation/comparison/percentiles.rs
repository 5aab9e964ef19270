//! Shifts of the sizes that given percents pass, and whether they stay in the envelope.

use crate::Curve;
use crate::fault::Fault;

/// What an envelope of sizes hides.
pub const SCALE_WARNING: &str = "a wrong image scale moves every Pxx by the same percentage and hides inside of a 30 % envelope: \
     look at the shift, not only at whether the size is inside";

/// Smaller mean shifts, in percent, are not taken for an error of the scale: fits alone make them.
const SMALLEST_SCALE_ERROR: f64 = 2.0;

/// Shifts are alike where their spread is below this share of their mean.
const ALIKE: f64 = 0.25;

/// One percentile of a method against the reference's; both of the fitted functions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PercentileShift {
    /// Percent passing.
    pub percent: f64,
    /// The reference's size, in the set's unit.
    pub reference: f64,
    /// The method's size.
    pub size: f64,
    /// 100 (size - reference) / reference; above 0 the method says coarser.
    pub shift_percent: f64,
    /// The envelope [low, high] of the reference's size.
    pub envelope: [f64; 2],
    /// Whether the method's size is in the envelope.
    pub inside: bool,
    /// Whether both were measured there; else it is the functions' word, and does not count in the mean.
    pub measured: bool,
}

/// The shifts of all percentiles. See [`SCALE_WARNING`].
#[derive(Debug, Clone, PartialEq)]
pub struct Shift {
    /// In the order of the options.
    pub percentiles: Vec<PercentileShift>,
    /// Mean of the shifts, percent: of those at which both were measured; of all where none is.
    pub mean_percent: f64,
    /// Standard deviation of the same shifts (n - 1), percent; `None` with one percentile.
    pub spread_percent: Option<f64>,
    /// Whether the shifts are so much alike (spread below a quarter of the mean, which is 2 % or more)
    /// that they look like an error of the scale.
    pub looks_like_scale: bool,
}

impl Shift {
    /// Of a function's percentiles against the reference's. Between the percents `measured` both were measured.
    ///
    /// # Errors
    ///
    /// Where one of them has no size above 0 at a percent.
    pub(super) fn new(
        curve: &Curve,
        reference: &Curve,
        percents: &[f64],
        envelope_percent: f64,
        measured: [f64; 2],
    ) -> Result<Self, Fault> {
        let percentiles = percents
            .iter()
            .map(|&percent| {
                let [size, reference] = [curve, reference].map(|curve| curve.size_at(percent));
                if !(size > 0.0 && size.is_finite() && reference > 0.0 && reference.is_finite()) {
                    let what = format!("a fitted function has no size that {percent} % pass");
                    return Err(Fault::new(what, "leave out this percentile"));
                }
                let envelope = envelope(reference, envelope_percent);
                Ok(PercentileShift {
                    percent,
                    reference,
                    size,
                    shift_percent: 100.0 * (size - reference) / reference,
                    envelope,
                    inside: (envelope[0]..=envelope[1]).contains(&size),
                    measured: (measured[0]..=measured[1]).contains(&percent),
                })
            })
            .collect::<Result<Vec<_>, Fault>>()?;
        let none = percentiles.iter().all(|percentile| !percentile.measured);
        let counted = percentiles
            .iter()
            .filter(|percentile| none || percentile.measured);
        let shifts: Vec<f64> = counted.map(|percentile| percentile.shift_percent).collect();
        let count = shifts.len() as f64;
        let mean = shifts.iter().sum::<f64>() / count;
        let squares: f64 = shifts.iter().map(|shift| (shift - mean).powi(2)).sum();
        let spread_percent = (shifts.len() > 1).then(|| (squares / (count - 1.0)).sqrt());
        let alike = spread_percent.is_some_and(|spread| spread < ALIKE * mean.abs());
        Ok(Self {
            percentiles,
            mean_percent: mean,
            spread_percent,
            looks_like_scale: alike && mean.abs() >= SMALLEST_SCALE_ERROR,
        })
    }
}

/// The envelope [low, high] about a size.
pub(super) fn envelope(size: f64, percent: f64) -> [f64; 2] {
    let share = percent / 100.0;
    [size * (1.0 - share), size * (1.0 + share)]
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use crate::Swebrec;

    fn swebrec(x50: f64, xmax: f64, b: f64) -> Curve {
        Curve::Swebrec(Swebrec::new(x50, xmax, b).expect("a Swebrec"))
    }

    const ALL: [f64; 2] = [0.0, 100.0];
    const PERCENTS: [f64; 5] = [10.0, 20.0, 50.0, 80.0, 90.0];

    /// Both sizes of a Swebrec times 1.08: every percentile is 8 % larger, all inside of 30 %.
    #[test]
    fn a_scale_error_shifts_all_alike() {
        let (reference, curve) = (swebrec(40.0, 150.0, 2.2), swebrec(43.2, 162.0, 2.2));
        let shift = Shift::new(&curve, &reference, &PERCENTS, 30.0, ALL).expect("shifts");
        for percentile in &shift.percentiles {
            assert!((percentile.shift_percent - 8.0).abs() < 1e-9);
            assert!(percentile.inside);
        }
        assert!((shift.mean_percent - 8.0).abs() < 1e-9);
        assert!(shift.spread_percent.expect("five") < 1e-9);
        assert!(shift.looks_like_scale);
        let half = Shift::new(&curve, &reference, &PERCENTS, 7.0, ALL).expect("shifts");
        assert!(half.percentiles.iter().all(|percentile| !percentile.inside));
    }

    /// Another undulation with the same median turns the curve about it: P50 stays 0, P10 and P90 part.
    #[test]
    fn another_shape_does_not() {
        let (reference, curve) = (swebrec(40.0, 150.0, 2.0), swebrec(40.0, 150.0, 4.0));
        let shift = Shift::new(&curve, &reference, &PERCENTS, 30.0, ALL).expect("shifts");
        assert_eq!(shift.percentiles[2].shift_percent, 0.0);
        // ln(xmax / x) = ln(150 / 40) 9^(1/b): from 3 to sqrt(3) times the logarithm.
        let p10 = (150.0_f64 / 40.0).powf(3.0 - 3.0_f64.sqrt());
        assert!((shift.percentiles[0].shift_percent - 100.0 * (p10 - 1.0)).abs() < 1e-9);
        assert!(!shift.percentiles[0].inside);
        assert!(shift.percentiles[4].shift_percent < 0.0);
        assert!(!shift.looks_like_scale);
        // Of the same curves from 50 to 80 %: P50 and P80 alone count, P10, P20 and P90 are there.
        let part = Shift::new(&curve, &reference, &PERCENTS, 30.0, [50.0, 80.0]).expect("shifts");
        let [_, _, p50, p80, _] = &part.percentiles[..] else {
            panic!("five");
        };
        assert!((part.mean_percent - (p50.shift_percent + p80.shift_percent) / 2.0).abs() < 1e-12);
        let none = Shift::new(&curve, &reference, &PERCENTS, 30.0, [96.0, 97.0]).expect("shifts");
        assert_eq!(none.mean_percent, shift.mean_percent);
        let one = Shift::new(&curve, &reference, &[80.0], 30.0, ALL).expect("a shift");
        assert_eq!((one.spread_percent, one.looks_like_scale), (None, false));
    }
}
