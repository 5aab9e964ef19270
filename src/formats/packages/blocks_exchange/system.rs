//! The definitions of coordinate systems.

use crate::geodesy::Geographic;

/// What a definition stands for.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum System {
    /// "EPSG:n", "EPSG:n+m" (m: heights), WKT, a PROJ string or "ECEF".
    Named(String),
    /// East, north, up at this place.
    EastNorthUp(Geographic),
    /// A frame of its own.
    Local,
    /// Something else.
    Unknown(String),
}

pub(super) fn read(definition: &str) -> System {
    let definition = definition.trim();
    let upper = definition.to_ascii_uppercase();
    if let Some(place) = upper.strip_prefix("ENU:") {
        let numbers: Option<Vec<f64>> = place
            .split(',')
            .map(|number| number.trim().parse().ok().filter(|n: &f64| n.is_finite()))
            .collect();
        return match numbers.as_deref() {
            Some(&[latitude, longitude]) => System::EastNorthUp(Geographic {
                longitude,
                latitude,
                height: 0.0,
            }),
            Some(&[latitude, longitude, height]) => System::EastNorthUp(Geographic {
                longitude,
                latitude,
                height,
            }),
            _ => System::Unknown(definition.to_owned()),
        };
    }
    if let Some(codes) = upper.strip_prefix("EPSG:") {
        let codes = codes.replace("EPSG:", "");
        let codes: Option<Vec<u32>> = codes
            .split('+')
            .map(|code| code.trim().parse().ok())
            .collect();
        return match codes.as_deref() {
            Some([4978]) => System::Named("ECEF".to_owned()),
            Some([code]) => System::Named(format!("EPSG:{code}")),
            Some([code, vertical]) => System::Named(format!("EPSG:{code}+{vertical}")),
            _ => System::Unknown(definition.to_owned()),
        };
    }
    if upper == "ECEF" {
        return System::Named(upper);
    }
    if upper == "WGS84" || upper == "WGS 84" {
        return System::Named("EPSG:4326".to_owned());
    }
    let is_wkt = upper.contains('[') && upper.ends_with(']');
    if is_wkt || definition.contains("+proj=") {
        return System::Named(definition.to_owned());
    }
    if upper.is_empty() || upper.starts_with("LOCAL") {
        return System::Local;
    }
    System::Unknown(definition.to_owned())
}
