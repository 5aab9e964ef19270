//! A scale with how sure it is, and how both are written.

use super::Interval;
use crate::numbers::{interval_percent, significant_digits, with_interval};

/// A scale, pixels per some unit, and how sure it is in the same unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaleEstimate {
    /// The scale.
    pub value: f64,
    /// `None` where nobody knows how sure it is.
    pub interval: Option<Interval>,
}

impl ScaleEstimate {
    /// The scale with the digits that its interval allows, "19.9 ± 0.4"; with `digits` significant ones
    /// where it has no interval.
    pub fn text(&self, digits: u8) -> String {
        match self.interval {
            Some(Interval { low, high, .. }) => with_interval(self.value, low, high),
            None => significant_digits(self.value, digits),
        }
    }

    /// How far the farther end of its interval is, such as "2 %".
    pub fn percent(&self) -> Option<String> {
        let Interval { low, high, .. } = self.interval?;
        interval_percent(self.value, low, high)
    }

    /// What its error does to a size that is measured by it, the P80 among them: how far the size may be off,
    /// from the lower to the upper end, percent. A length is pixels over scale, so that it is the largest
    /// where the scale is the lowest. `None` where nobody knows how sure it is, or its interval takes in no
    /// scale at all.
    ///
    /// It assumes that one error of the scale is in all fragments of the photo alike: then every percentile
    /// is off by the same share, whatever the distribution. It counts nothing else: neither how well fragments
    /// are outlined, nor that some are hidden, nor that a photo is a sample of the pile; and the mean of photos
    /// whose scales err apart from each other is surer than one photo.
    pub fn size_error_percent(&self) -> Option<[f64; 2]> {
        let Interval { low, high, .. } = self.interval?;
        let off = |scale: f64| (self.value / scale - 1.0) * 100.0;
        (low > 0.0 && high >= low).then(|| [off(high), off(low)])
    }

    /// The same by the farther end, such as "± 2 %".
    pub fn size_error(&self) -> Option<String> {
        let [from, to] = self
            .size_error_percent()?
            .map(|percent| 1.0 + percent / 100.0);
        Some(format!("± {}", interval_percent(1.0, from, to)?))
    }

    /// The same times `factor`.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self {
            value: self.value * factor,
            interval: self.interval.map(|interval| interval.times(factor)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_those_of_the_interval() {
        let sure = ScaleEstimate {
            value: 19.9132,
            interval: None,
        };
        assert_eq!((sure.text(5), sure.percent()), ("19.913".to_owned(), None));
        let unsure = ScaleEstimate {
            interval: Some(Interval {
                standard_error: 0.2,
                low: 19.5132,
                high: 20.3132,
            }),
            ..sure
        };
        assert_eq!(unsure.text(5), "19.9 ± 0.4");
        assert_eq!(unsure.percent().as_deref(), Some("2 %"));
        assert_eq!(unsure.times(100.0).text(5), "1990 ± 40");
    }

    /// Of a scale of 20 in [16, 25] px/cm: a fragment of 100 px is 5 cm, but 4 to 6.25 cm at its ends, which
    /// is 20 % less to 25 % more. A small error is that of the scale: 2 % of 50.
    #[test]
    fn what_its_error_does_to_a_size() {
        let of = |value, low, high| ScaleEstimate {
            value,
            interval: Some(Interval {
                standard_error: 0.0,
                low,
                high,
            }),
        };
        let [less, more] = of(20.0, 16.0, 25.0).size_error_percent().unwrap();
        assert!((less + 20.0).abs() < 1e-12 && (more - 25.0).abs() < 1e-12);
        assert_eq!(of(20.0, 16.0, 25.0).size_error().as_deref(), Some("± 25 %"));
        assert_eq!(of(50.0, 49.0, 51.0).size_error().as_deref(), Some("± 2 %"));
        // Whatever unit the scale is in.
        let other = of(50.0, 49.0, 51.0).times(100.0);
        assert_eq!(other.size_error().as_deref(), Some("± 2 %"));
        assert_eq!(of(20.0, 0.0, 25.0).size_error(), None);
        let unknown = ScaleEstimate {
            value: 20.0,
            interval: None,
        };
        assert_eq!(unknown.size_error(), None);
    }
}
