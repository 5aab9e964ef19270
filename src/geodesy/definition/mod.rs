//! From the texts that name a coordinate system to what it is made of.
//!
//! Understood are "EPSG:n" and "EPSG:n+m" (m the vertical system, or "ellipsoid"), also as URN or address of OGC,
//! "ECEF", WKT 1 and 2 (with an EPSG code, or what proj4wkt makes of it; compound, bound and 3D ones),
//! PROJ strings, "WGS84 UTM 17N" as OpenDroneMap writes it, and "WGS 84".

mod of_wkt;
mod stated_unit;
#[cfg(test)]
mod tests;

pub use stated_unit::stated_unit_metres;

use self::of_wkt::refuse_other_angles;
use super::heights::{ELLIPSOID_WORD, Heights, parts_of_compound};
use super::proj_text::ProjText;
use super::wkt::{Node, REMEDY};
use crate::fault::Fault;

/// What a coordinate system is made of.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Definition {
    /// EPSG's code of the horizontal system.
    pub(super) code: Option<u32>,
    pub(super) proj: ProjText,
    pub(super) heights: Heights,
}

impl Definition {
    /// Takes a text as one of the kinds above.
    pub(super) fn of(text: &str) -> Result<Self, Fault> {
        let text = text.trim_start_matches('\u{feff}').trim();
        let text = text.trim_matches(['\'', '"']).trim();
        if text.is_empty() {
            let remedy = "give it as \"EPSG:n\", or leave it out";
            return Err(Fault::new("the coordinate system is empty", remedy));
        }
        if let Some(code) = text_of_epsg(text) {
            return Self::of_epsg_text(code);
        }
        if text.starts_with('+') || text.starts_with("proj=") {
            return Ok(Self::of_proj(ProjText::parse(text)));
        }
        if text.contains(['[', '(']) {
            return Self::of_wkt(text);
        }
        Self::of_words(text).ok_or_else(|| {
            Fault::new(
                format!("the coordinate system '{text}' is not known"),
                REMEDY,
            )
        })
    }

    /// "n" or "n+m".
    fn of_epsg_text(text: &str) -> Result<Self, Fault> {
        let (horizontal, vertical) = match text.split_once('+') {
            // OPF names the authority twice.
            Some((horizontal, vertical)) => {
                let vertical = vertical.trim();
                (
                    horizontal,
                    Some(vertical.strip_prefix("EPSG:").unwrap_or(vertical)),
                )
            }
            None => (text, None),
        };
        let number = |text: &str| {
            let what = || Fault::new(format!("'{text}' is not a code of EPSG"), REMEDY);
            text.trim().parse().map_err(|_| what())
        };
        let definition = Self::of_code(number(horizontal)?)?;
        match vertical.map(str::trim) {
            Some(word) if word.eq_ignore_ascii_case(ELLIPSOID_WORD) => Ok(Self {
                heights: Heights::ellipsoidal(),
                ..definition
            }),
            Some(code) => Ok(Self {
                heights: Heights::of_code(number(code)?),
                ..definition
            }),
            None => Ok(definition),
        }
    }

    pub(super) fn of_code(code: u32) -> Result<Self, Fault> {
        if let Some((horizontal, vertical)) = parts_of_compound(code) {
            return Ok(Self {
                heights: Heights::of_code(vertical),
                ..Self::of_code(horizontal)?
            });
        }
        let (text, heights) = match code {
            // Geocentric: WGS 84, ETRS89, GDA2020, GDA94, NAD83(2011), ITRF2014.
            4978 | 4936 | 7842 | 4938 | 6317 | 7789 => (
                "+proj=geocent +ellps=WGS84".to_owned(),
                Heights::ellipsoidal(),
            ),
            // The same in longitude, latitude and height.
            4979 | 4937 | 7843 | 4939 | 6319 | 7912 => (
                "+proj=longlat +ellps=WGS84".to_owned(),
                Heights::ellipsoidal(),
            ),
            // GDA2020, which Australian mines are in, is younger than the table.
            7844 => ("+proj=longlat +ellps=GRS80".to_owned(), Heights::default()),
            7846..=7859 => (
                format!("+proj=utm +zone={} +south +ellps=GRS80", code - 7800),
                Heights::default(),
            ),
            _ => {
                let known = u16::try_from(code)
                    .ok()
                    .and_then(crs_definitions::from_code);
                let Some(known) = known else {
                    return Err(Fault::new(
                        format!("EPSG:{code} is not in the table of definitions"),
                        "give the system as WKT or as a PROJ string",
                    ));
                };
                if let Some(root) = Node::parse(known.wkt)
                    .ok()
                    .and_then(|r| r.into_iter().next())
                {
                    refuse_other_angles(&root)?;
                }
                (known.proj4.to_owned(), Heights::default())
            }
        };
        Ok(Self {
            code: Some(code),
            proj: ProjText::parse(&text),
            heights,
        })
    }

    /// A UTM zone, 1 to 60, on WGS 84.
    pub(super) fn utm(zone: u32, south: bool) -> Self {
        let hemisphere = if south { "+south " } else { "" };
        let text = format!("+proj=utm +zone={zone} {hemisphere}+datum=WGS84 +units=m");
        Self {
            code: Some(utm_code(zone, south)),
            proj: ProjText::parse(&text),
            heights: Heights::default(),
        }
    }

    fn of_proj(proj: ProjText) -> Self {
        let init = proj.get("init").and_then(text_of_epsg);
        if let Some(definition) = init.and_then(|code| Self::of_epsg_text(code).ok()) {
            return definition;
        }
        let is_wgs84 = [proj.get("datum"), proj.get("ellps")].contains(&Some("WGS84"));
        let mut heights = proj.heights();
        let code = match (proj.get("proj"), proj.utm_wgs84()) {
            (_, Some((zone @ 1..=60, south))) => Some(utm_code(zone, south)),
            (Some("geocent"), _) if is_wgs84 => {
                heights = Heights::ellipsoidal();
                Some(4978)
            }
            _ => None,
        };
        Self {
            code,
            heights,
            proj,
        }
    }

    /// "WGS84 UTM 17N", "WGS 84 / UTM zone 17N", "WGS 84", "ECEF".
    fn of_words(text: &str) -> Option<Self> {
        let letters = text.chars().filter(char::is_ascii_alphanumeric);
        let plain = letters.collect::<String>().to_ascii_lowercase();
        let code = match plain.as_str() {
            "ecef" => 4978,
            "wgs84" | "wgs1984" | "crs84" | "ogccrs84" | "lonlat" | "longlat" => 4326,
            _ => {
                let zone = (plain
                    .strip_prefix("wgs84")
                    .or(plain.strip_prefix("wgs1984")))?;
                let zone = zone.strip_prefix("utm")?;
                let zone = zone.strip_prefix("zone").unwrap_or(zone);
                let (number, south) = match zone.strip_suffix('n') {
                    Some(number) => (number, false),
                    None => (zone.strip_suffix('s')?, true),
                };
                match number.parse().ok()? {
                    number @ 1..=60 => utm_code(number, south),
                    _ => return None,
                }
            }
        };
        Self::of_code(code).ok()
    }
}

/// EPSG's code of a UTM zone on WGS 84.
pub(super) fn utm_code(zone: u32, south: bool) -> u32 {
    zone + if south { 32_700 } else { 32_600 }
}

/// What stands behind "EPSG:", "urn:ogc:def:crs:EPSG::" or ".../def/crs/EPSG/0/".
fn text_of_epsg(text: &str) -> Option<&str> {
    if let Some((authority, code)) = text.split_once(':')
        && authority.trim().eq_ignore_ascii_case("EPSG")
    {
        return Some(code.trim());
    }
    let plain = text.to_ascii_lowercase();
    if plain.starts_with("urn:ogc:def:crs:epsg:") {
        return text.rsplit(':').next();
    }
    let is_address = plain.starts_with("http") && plain.contains("/def/crs/epsg/");
    is_address.then(|| text.rsplit('/').next())?
}
