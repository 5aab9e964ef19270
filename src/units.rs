//! Units of length.

use std::fmt;
use std::str::FromStr;

/// A unit of length that a flight's world or a scale can be in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthUnit {
    /// Millimetre.
    Millimetre,
    /// Centimetre.
    Centimetre,
    /// Metre.
    Metre,
    /// International inch, 25.4 mm.
    Inch,
    /// International foot, 0.3048 m.
    Foot,
    /// US survey foot, 1200/3937 m; state plane coordinates are often in it.
    UsSurveyFoot,
}

impl LengthUnit {
    /// Every unit, in the order in which people are offered them.
    pub const ALL: [Self; 6] = [
        Self::Millimetre,
        Self::Centimetre,
        Self::Metre,
        Self::Inch,
        Self::Foot,
        Self::UsSurveyFoot,
    ];

    /// Those of the metre.
    pub const METRIC: [Self; 3] = [Self::Millimetre, Self::Centimetre, Self::Metre];

    /// Its length in metres.
    pub fn metres(self) -> f64 {
        match self {
            Self::Millimetre => 0.001,
            Self::Centimetre => 0.01,
            Self::Metre => 1.0,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
            Self::UsSurveyFoot => 1200.0 / 3937.0,
        }
    }

    /// The unit of this length in metres, if it is one of these.
    pub fn of_metres(metres: f64) -> Option<Self> {
        // A US survey foot and a foot differ by 2 parts in a million.
        let is_unit = |unit: &Self| (unit.metres() / metres - 1.0).abs() < 1e-7;
        Self::ALL.into_iter().find(is_unit)
    }

    /// How many of `other` are one of `self`; exactly 1 for the same unit.
    pub fn in_units_of(self, other: Self) -> f64 {
        if self == other {
            1.0
        } else {
            self.metres() / other.metres()
        }
    }

    /// The symbol used in flight.toml, on the command line and in column names.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::Inch => "in",
            Self::Foot => "ft",
            Self::UsSurveyFoot => "us-ft",
        }
    }
}

/// What is written beside lengths of the world: their unit, or that nobody states one.
pub fn in_words(unit: Option<LengthUnit>) -> &'static str {
    unit.map_or("units of the file", LengthUnit::symbol)
}

/// A round length as it is written at a scale bar: 2000 cm is 20 m.
pub fn round_length_in_words(length: f64, unit: LengthUnit) -> String {
    let metres = match unit {
        LengthUnit::Millimetre => length / 1000.0,
        LengthUnit::Centimetre => length / 100.0,
        _ => 0.0,
    };
    match metres >= 1.0 {
        true => format!("{metres} m"),
        false => format!("{length} {unit}"),
    }
}

impl fmt::Display for LengthUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.symbol())
    }
}

/// The text is no unit of length known here.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is not a unit of length; use mm, cm, m, in, ft or us-ft")]
pub struct UnknownUnit(pub String);

impl FromStr for LengthUnit {
    type Err = UnknownUnit;

    fn from_str(text: &str) -> Result<Self, UnknownUnit> {
        Self::ALL
            .into_iter()
            .find(|unit| unit.symbol() == text)
            .ok_or_else(|| UnknownUnit(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_read_back() {
        for unit in LengthUnit::ALL {
            assert_eq!(unit.symbol().parse(), Ok(unit));
        }
        assert!("furlong".parse::<LengthUnit>().is_err());
    }

    #[test]
    fn long_bars_are_in_metres() {
        for (length, unit, words) in [
            (2000.0, LengthUnit::Centimetre, "20 m"),
            (100.0, LengthUnit::Centimetre, "1 m"),
            (50.0, LengthUnit::Centimetre, "50 cm"),
            (500.0, LengthUnit::Millimetre, "500 mm"),
            (5000.0, LengthUnit::Millimetre, "5 m"),
            (0.5, LengthUnit::Metre, "0.5 m"),
            (200.0, LengthUnit::Foot, "200 ft"),
            (100.0, LengthUnit::Inch, "100 in"),
        ] {
            assert_eq!(round_length_in_words(length, unit), words);
        }
    }

    /// NIST Handbook 44, appendix C: 1 ft = 0.3048 m exactly, 1 US survey foot = 1200/3937 m.
    #[test]
    fn known_lengths() {
        assert!((LengthUnit::Foot.in_units_of(LengthUnit::Inch) - 12.0).abs() < 1e-14);
        assert_eq!(LengthUnit::Metre.in_units_of(LengthUnit::Metre), 1.0);
        let ppm = LengthUnit::UsSurveyFoot.in_units_of(LengthUnit::Foot) - 1.0;
        assert!((ppm - 2.000004e-6).abs() < 1e-12, "{ppm}");
    }
}
