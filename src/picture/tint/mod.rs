//! Values in colours: which colours, lines of equal value, and a picture with its legend.

mod legend;
mod viridis;

pub use legend::value_picture;
pub use viridis::{VIRIDIS_STOPS, viridis};

use crate::numbers::round_down;

/// The share of the values that lie below the first colour, and above the last: a stone at the rim may
/// not take all colours from the others.
const BEYOND: f64 = 0.005;

/// The least range of colours, as a share of the values: smaller differences are none.
const LEAST_RANGE: f64 = 1e-3;

/// How many steps there are at least from the first colour to the last.
const STEPS: f64 = 5.0;

/// Which value has which colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValueColors {
    /// The value of the first colour; lower ones have it as well.
    pub low: f64,
    /// The value of the last colour; higher ones have it as well.
    pub high: f64,
    /// Between two round values: 1, 2 or 5 times a power of ten.
    pub step: f64,
}

impl ValueColors {
    /// Colours for these values; what is not finite is left out. `None` where nothing is left.
    pub fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        let last = values.len().checked_sub(1)?;
        // `as` saturates.
        let beyond = ((last as f64 * BEYOND) as usize).min(last);
        let mut nth = |place: usize| *values.select_nth_unstable_by(place, f64::total_cmp).1;
        let (low, high) = (nth(beyond), nth(last - beyond));
        let middle = low + (high - low) / 2.0;
        let least = (middle.abs() * LEAST_RANGE).max(f64::MIN_POSITIVE);
        let (low, high) = match high - low < least {
            true => (middle - least / 2.0, middle + least / 2.0),
            false => (low, high),
        };
        let step = round_down((high - low) / STEPS)?;
        Some(Self { low, high, step })
    }

    /// The colour of a value: red, green, blue.
    pub fn color(&self, value: f64) -> [u8; 3] {
        viridis((value - self.low) / (self.high - self.low))
    }

    /// The round values between the first colour and the last.
    pub fn levels(&self) -> Vec<f64> {
        let (first, last) = (
            (self.low / self.step).ceil(),
            (self.high / self.step).floor(),
        );
        let count = (last - first).clamp(-1.0, 100.0);
        // `as` of a number from 0 to 101.
        let places = 0..(count + 1.0) as u32;
        places
            .map(|place| (first + f64::from(place)) * self.step)
            .collect()
    }

    /// A round value in words, with the decimals of the step.
    pub fn label(&self, level: f64) -> String {
        let decimals = (-self.step.log10().floor()).clamp(0.0, 12.0) as usize;
        format!("{level:.decimals$}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_round_and_inside() {
        let colors = ValueColors::of((0..=1000).map(|i| 19.0 + f64::from(i) * 0.005)).unwrap();
        // 5 of 1000 are beyond on each side.
        assert!((colors.low - 19.025).abs() < 1e-9 && (colors.high - 23.975).abs() < 1e-9);
        assert_eq!(colors.step, 0.5);
        let labels: Vec<String> = colors.levels().iter().map(|l| colors.label(*l)).collect();
        assert_eq!(
            labels.join(" "),
            "19.5 20.0 20.5 21.0 21.5 22.0 22.5 23.0 23.5"
        );
        assert_eq!(colors.color(0.0), VIRIDIS_STOPS[0]);
        assert_eq!(colors.color(99.0), VIRIDIS_STOPS[16]);
    }

    #[test]
    fn equal_values_are_no_trouble() {
        let colors = ValueColors::of([250.0, f64::NAN, 250.0].into_iter()).unwrap();
        assert!(colors.low < 250.0 && colors.high > 250.0);
        assert!(!colors.levels().is_empty());
        assert_eq!(ValueColors::of([f64::NAN].into_iter()), None);
    }
}
