//! What the heights of a coordinate system count from: EPSG's vertical systems that surveys name.

/// What stands for the ellipsoid where a vertical system has its code: "EPSG:32632+ellipsoid".
pub(super) const ELLIPSOID_WORD: &str = "ellipsoid";

/// A vertical system.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Heights {
    /// In words; `None` where nothing is said.
    pub(super) name: Option<String>,
    /// EPSG's code of the vertical system.
    pub(super) code: Option<u32>,
    /// The length of the unit in metres; `None` for that of the horizontal system.
    pub(super) unit_metres: Option<f64>,
}

impl Heights {
    /// Metres above the ellipsoid.
    pub(super) fn ellipsoidal() -> Self {
        Self {
            name: Some("the ellipsoid".to_owned()),
            code: None,
            unit_metres: Some(1.0),
        }
    }

    /// The vertical system of an EPSG code; of one that is not in the table the unit is taken to be
    /// that of x and y.
    pub(super) fn of_code(code: u32) -> Self {
        let known = TABLE.iter().find(|(known, ..)| *known == code);
        let (name, unit) = match known {
            Some((_, name, unit)) => ((*name).to_owned(), Some(*unit)),
            None => (format!("EPSG:{code}"), None),
        };
        Self {
            name: Some(name),
            code: Some(code),
            unit_metres: unit,
        }
    }
}

const FOOT: f64 = 0.3048;
const US_FOOT: f64 = 1200.0 / 3937.0;

/// Code, name, unit in metres (EPSG dataset v11).
const TABLE: [(u32, &str, f64); 31] = [
    (3855, "the geoid EGM2008", 1.0),
    (5773, "the geoid EGM96", 1.0),
    (5798, "the geoid EGM84", 1.0),
    (5714, "mean sea level", 1.0),
    (8050, "mean sea level", FOOT),
    (8052, "mean sea level", US_FOOT),
    (5703, "NAVD88", 1.0),
    (8228, "NAVD88", FOOT),
    (6360, "NAVD88", US_FOOT),
    (5702, "NGVD29", US_FOOT),
    (7968, "NGVD29", 1.0),
    (5713, "CGVD28", 1.0),
    (6647, "CGVD2013", 1.0),
    (5701, "ODN (Newlyn)", 1.0),
    (5709, "NAP", 1.0),
    (5710, "Ostend", 1.0),
    (5711, "AHD", 1.0),
    (5720, "NGF-IGN69", 1.0),
    (5730, "EVRF2000", 1.0),
    (5621, "EVRF2007", 1.0),
    (9389, "EVRF2019", 1.0),
    (5783, "DHHN92", 1.0),
    (7837, "DHHN2016", 1.0),
    (5613, "RH2000", 1.0),
    (5941, "NN2000", 1.0),
    (3900, "N2000", 1.0),
    (5728, "LN02", 1.0),
    (5729, "LHN95", 1.0),
    (7839, "NZVD2016", 1.0),
    (6695, "JGD2011 (vertical)", 1.0),
    (9651, "EVRF2007-PL", 1.0),
];

/// The horizontal and the vertical part of EPSG's compound systems that surveys use.
pub(super) fn parts_of_compound(code: u32) -> Option<(u32, u32)> {
    Some(match code {
        5498 => (4269, 5703),
        5554..=5556 => (25_831 + code - 5554, 5783),
        5698 => (2154, 5720),
        7405 => (27_700, 5701),
        7415 => (28_992, 5709),
        9518 => (4326, 3855),
        9707 => (4326, 5773),
        _ => return None,
    })
}
