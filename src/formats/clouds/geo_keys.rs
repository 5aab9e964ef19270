//! The keys of GeoTIFF's directory, which LAS has too (OGC 19-008r4): their numbers, and what they say of heights.

use crate::clouds::cloud_file::CloudFile;
use crate::geodesy::Crs;
use crate::units::LengthUnit;

pub(super) const MODEL_TYPE: u16 = 1024;
pub(super) const RASTER_TYPE: u16 = 1025;
pub(super) const GEODETIC_CRS: u16 = 2048;
pub(super) const PROJECTED_CRS: u16 = 3072;
const LINEAR_UNITS: u16 = 3076;
const VERTICAL_CRS: u16 = 4096;
const VERTICAL_UNITS: u16 = 4099;

/// A code of a key: defined by other keys.
pub(super) const USER_DEFINED: u16 = 32_767;

/// The code in place of a system, if it is one.
pub(super) fn code(value: Option<u16>) -> Option<u16> {
    value.filter(|&code| code != 0 && code != USER_DEFINED)
}

/// What a file says of its heights.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct StatedHeights {
    /// The code of the vertical system.
    pub(super) system: Option<u16>,
    /// Metres in the unit of heights.
    pub(super) unit: Option<f64>,
    /// Metres in the unit of x and y, where that stands beside their system.
    pub(super) flat_unit: Option<f64>,
}

impl StatedHeights {
    /// Of a directory that has this whole number for a key.
    pub(super) fn of(number: impl Fn(u16) -> Option<u16>) -> Self {
        let unit = |key| number(key).and_then(metres_of_code);
        Self {
            system: number(VERTICAL_CRS),
            unit: unit(VERTICAL_UNITS),
            flat_unit: unit(LINEAR_UNITS),
        }
    }

    /// Adds the vertical system to that of the file, and returns what heights are to be multiplied by so that they count in the
    /// unit that the file's system has for them, or, without one, in that of x and y. What it does is said among the file's warnings.
    pub(super) fn tell(self, file: &mut CloudFile) -> f64 {
        let understood = |text: &str| Crs::understand(text).ok();
        let mut crs = file.crs.as_deref().and_then(understood);
        // GeoTIFF 1.0 had codes of its own for ellipsoids and datums, which EPSG gave to others.
        let system = code(self.system).filter(|code| !(5001..=5106).contains(code));
        if let (Some(flat), Some(code)) = (&file.crs, system)
            && crs.as_ref().is_some_and(|crs| !crs.states_heights())
            && flat.starts_with("EPSG:")
        {
            let both = format!("{flat}+{code}");
            if let Some(found) = understood(&both) {
                crs = Some(found);
                file.crs = Some(both);
            }
        }
        let implied = crs.map(|crs| crs.vertical_unit_metres());
        let Some(stated) = self.unit else {
            return 1.0;
        };
        let Some(wanted) = implied.or(self.flat_unit) else {
            if stated != 1.0 {
                file.warnings.push(format!(
                    "its heights are in {}; in what x and y are, nothing says that is understood",
                    in_words(stated)
                ));
            }
            return 1.0;
        };
        let factor = stated / wanted;
        // Feet of the survey and others differ by two of a million.
        if (factor - 1.0).abs() < 1e-9 {
            return 1.0;
        }
        file.warnings.push(format!(
            "its heights are in {}, not in {} as its coordinate system has them: they are multiplied by {factor:.7}",
            in_words(stated),
            in_words(wanted)
        ));
        factor
    }
}

fn in_words(metres: f64) -> String {
    match LengthUnit::of_metres(metres) {
        Some(unit) => unit.symbol().to_owned(),
        None => format!("units of {metres} m"),
    }
}

/// Metres in EPSG's unit of that code, as far as heights are given in it; `None` for others.
fn metres_of_code(code: u16) -> Option<f64> {
    let unit = match code {
        9001 => LengthUnit::Metre,
        9002 => LengthUnit::Foot,
        9003 => LengthUnit::UsSurveyFoot,
        1025 => LengthUnit::Millimetre,
        1033 => LengthUnit::Centimetre,
        _ => return None,
    };
    Some(unit.metres())
}

/// The same of the words that GDAL writes and reads (`GDALRasterBand::GetUnitType`, `gdal_edit.py -units`).
pub(super) fn metres_of_words(words: &str) -> Option<f64> {
    let unit = match words.trim().to_lowercase().as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" => LengthUnit::Metre,
        "cm" | "centimetre" | "centimetres" | "centimeter" | "centimeters" => {
            LengthUnit::Centimetre
        }
        "mm" | "millimetre" | "millimetres" | "millimeter" | "millimeters" => {
            LengthUnit::Millimetre
        }
        "ft" | "foot" | "feet" | "international foot" => LengthUnit::Foot,
        "us-ft" | "sfoot" | "ftus" | "us survey foot" | "us survey feet" | "foot_us" => {
            LengthUnit::UsSurveyFoot
        }
        _ => return None,
    };
    Some(unit.metres())
}

#[cfg(test)]
mod tests {
    use super::*;

    const US_FOOT: f64 = 1200.0 / 3937.0;

    fn told(crs: Option<&str>, stated: StatedHeights) -> (Option<String>, f64, String) {
        let mut file = CloudFile {
            crs: crs.map(str::to_owned),
            ..CloudFile::default()
        };
        let factor = stated.tell(&mut file);
        (file.crs, factor, file.warnings.join("; "))
    }

    #[test]
    fn the_vertical_system_joins_the_other() {
        let of = |system| StatedHeights {
            system: Some(system),
            ..StatedHeights::default()
        };
        let (crs, factor, said) = told(Some("EPSG:2226"), of(5703));
        assert_eq!((crs.as_deref(), factor), (Some("EPSG:2226+5703"), 1.0));
        assert_eq!(said, "");
        // A compound system has its own, and no code is none.
        for (crs, code) in [
            ("EPSG:7415", 5703),
            ("EPSG:32633", 32_767),
            ("EPSG:32633", 0),
            ("EPSG:32633", 5030),
        ] {
            assert_eq!(told(Some(crs), of(code)).0.as_deref(), Some(crs));
        }
    }

    #[test]
    fn heights_come_in_the_unit_of_their_system() {
        let of = |unit| StatedHeights {
            unit: Some(unit),
            ..StatedHeights::default()
        };
        // In a system of metres feet are 0.3048 of them, and the other way round.
        let (_, factor, said) = told(Some("EPSG:32633"), of(0.3048));
        assert!((factor - 0.3048).abs() < 1e-15);
        assert!(said.contains("heights are in ft, not in m"), "{said}");
        let (_, factor, _) = told(Some("EPSG:2226"), of(1.0));
        assert!((factor - 3937.0 / 1200.0).abs() < 1e-9);
        assert_eq!(told(Some("EPSG:2226"), of(US_FOOT)).1, 1.0);
        // NAVD88 in metres, stated twice.
        let both = StatedHeights {
            system: Some(5703),
            ..of(1.0)
        };
        assert_eq!(told(Some("EPSG:2226"), both).1, 1.0);
        // Degrees go with metres.
        assert!((told(Some("EPSG:4326"), of(0.3048)).1 - 0.3048).abs() < 1e-15);
        // Without a system x and y's own unit counts; where nobody says it, that is said.
        let flat = StatedHeights {
            flat_unit: Some(US_FOOT),
            ..of(1.0)
        };
        assert!((told(None, flat).1 - 3937.0 / 1200.0).abs() < 1e-9);
        let (_, factor, said) = told(None, of(0.3048));
        assert_eq!(factor, 1.0);
        assert!(said.contains("in what x and y are"), "{said}");
        assert_eq!(told(None, of(1.0)).2, "");
    }
}
