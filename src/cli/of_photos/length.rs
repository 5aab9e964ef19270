//! Lengths on the command line.

use std::str::FromStr;

use crate::units::LengthUnit;

/// A length with its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::cli) struct Length {
    value: f64,
    unit: LengthUnit,
}

impl FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let digits = text.find(|c: char| c.is_alphabetic()).unwrap_or(text.len());
        // "1e-3m" has a letter in its number.
        let digits = match text[digits..].strip_prefix(['e', 'E']) {
            Some(rest) if rest.starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c)) => {
                let unit = rest.find(|c: char| c.is_alphabetic());
                text.len() - rest.len() + unit.unwrap_or(rest.len())
            }
            _ => digits,
        };
        let (number, unit) = text.split_at(digits);
        let value: Option<f64> = number.trim().parse().ok();
        let value = value.filter(|value| *value > 0.0 && value.is_finite());
        match (value, unit.trim().parse()) {
            (Some(value), Ok(unit)) => Ok(Self { value, unit }),
            _ => Err("give a positive length with its unit, as 2mm".to_owned()),
        }
    }
}

impl Length {
    /// How many of these units it is.
    pub(in crate::cli) fn in_units_of(self, unit: LengthUnit) -> f64 {
        self.value * self.unit.in_units_of(unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_a_unit() {
        let length = |value, unit| Ok(Length { value, unit });
        assert_eq!("2mm".parse(), length(2.0, LengthUnit::Millimetre));
        assert_eq!(" 0.5 in ".parse(), length(0.5, LengthUnit::Inch));
        assert_eq!("1e-3m".parse(), length(0.001, LengthUnit::Metre));
        assert_eq!("2us-ft".parse(), length(2.0, LengthUnit::UsSurveyFoot));
        for wrong in ["2", "mm", "", "-2mm", "0mm", "2 km", "infmm", "1e", "2mm3"] {
            assert!(wrong.parse::<Length>().is_err(), "{wrong}");
        }
    }
}
