//! A scale as it is typed: pixels per a unit of length.

use std::str::FromStr;

use crate::units::LengthUnit;

/// Pixels per a unit of length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PixelScale {
    pixels: f64,
    /// Of length.
    pub(super) unit: LengthUnit,
}

impl FromStr for PixelScale {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || match text.contains(',') {
            true => "give pixels per a unit, decimals behind a point, as '0.5 px/cm'".to_owned(),
            false => "give pixels per a unit, as '20 px/cm'".to_owned(),
        };
        let (number, unit) = text.split_once('/').ok_or_else(wrong)?;
        let number = number.trim().trim_end_matches("px").trim();
        let pixels: f64 = number.parse().map_err(|_| wrong())?;
        let unit = unit.trim().parse().map_err(|_| wrong())?;
        let is_scale = pixels > 0.0 && pixels.is_finite();
        is_scale.then_some(Self { pixels, unit }).ok_or_else(wrong)
    }
}

impl PixelScale {
    /// Pixels per this unit.
    pub(super) fn per(self, unit: LengthUnit) -> f64 {
        self.pixels * unit.in_units_of(self.unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_have_a_unit() {
        let scale = |text: &str| {
            text.parse::<PixelScale>()
                .map(|scale| scale.per(LengthUnit::Metre))
        };
        assert_eq!(scale("20 px/cm"), Ok(2000.0));
        assert_eq!(scale("0.5px/mm"), Ok(500.0));
        assert_eq!(scale("30/m"), Ok(30.0));
        for wrong in ["20", "px/cm", "-1 px/cm", "20 px/km", "inf/m", ""] {
            assert!(scale(wrong).is_err(), "{wrong}");
        }
    }
}
