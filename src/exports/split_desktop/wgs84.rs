//! From a flight's coordinates to longitude and latitude on WGS 84, for maps.
//!
//! Good to a metre or so: enough to find a photo on a map, and not used for any scale. Datums fixed to
//! a continent (ETRS89, NAD83, GDA) are taken as WGS 84, older ones go through the seven parameters
//! that EPSG's own table of definitions gives, and systems that need a grid file are refused.

use proj4rs::Proj;
use proj4rs::transform::transform;

use crate::fault::Fault;
use crate::units::LengthUnit;

/// How far, in units of the world, going there and back may be off before the projection is not
/// believed.
const THERE_AND_BACK: f64 = 1e-3;

/// A coordinate system that is understood.
pub(super) struct ToWgs84 {
    from: Proj,
    to: Proj,
}

impl ToWgs84 {
    /// Understands "EPSG:n", or WKT that names its EPSG code, of a projected system whose unit is the
    /// world's.
    ///
    /// # Errors
    /// Where it is not understood, with the reason.
    pub(super) fn new(crs: &str, world_unit: LengthUnit) -> Result<Self, Fault> {
        let refuse = |what: String| {
            Err(Fault::new(
                what,
                "the footprints stay in local coordinates, without KML",
            ))
        };
        let Some(code) = epsg_code(crs) else {
            return refuse("the coordinate system names no EPSG code".to_owned());
        };
        let Some(definition) = definition(code) else {
            return refuse(format!("EPSG:{code} is not in the table of definitions"));
        };
        let words: Vec<&str> = definition.split_whitespace().collect();
        if words.contains(&"+proj=longlat") || words.contains(&"+proj=geocent") {
            return refuse(format!("EPSG:{code} is no projected system"));
        }
        // Without them the datum is unknown, and with it hundreds of metres.
        let known = [
            "+datum=WGS84",
            "+datum=NAD83",
            "+towgs84=",
            "+ellps=GRS80",
            "+ellps=WGS84",
            "+nadgrids=@null",
        ];
        if !known.iter().any(|datum| definition.contains(datum)) {
            return refuse(format!("how EPSG:{code} relates to WGS 84 is not known"));
        }
        let metres = metres_of(&words);
        // A US survey foot and a foot differ by 2 parts in a million: a metre on a state's northing.
        if !metres.is_some_and(|m| (m / world_unit.metres() - 1.0).abs() < 1e-7) {
            return refuse(format!(
                "EPSG:{code} is not in {world_unit}, the unit of the flight"
            ));
        }
        let projections = Proj::from_proj_string(&definition)
            .and_then(|from| Ok((from, Proj::from_proj_string("+proj=longlat +datum=WGS84")?)));
        match projections {
            Ok((from, to)) => Ok(Self { from, to }),
            Err(e) => refuse(format!("EPSG:{code} cannot be projected ({e})")),
        }
    }

    /// Longitude and latitude in degrees of (x, y) in the world; `None` where the projection does not
    /// hold.
    pub(super) fn degrees(&self, x: f64, y: f64) -> Option<[f64; 2]> {
        let mut place = (x, y, 0.0);
        transform(&self.from, &self.to, &mut place).ok()?;
        let degrees = [place.0.to_degrees(), place.1.to_degrees()];
        transform(&self.to, &self.from, &mut place).ok()?;
        let off = (place.0 - x).hypot(place.1 - y);
        (off < THERE_AND_BACK).then_some(degrees)
    }
}

/// The proj text of a system.
fn definition(code: u16) -> Option<String> {
    if let zone @ 46..=59 = code.saturating_sub(7800) {
        // GDA2020 / MGA, which Australian mines are in, is younger than the table.
        return Some(format!(
            "+proj=utm +zone={zone} +south +ellps=GRS80 +units=m +no_defs"
        ));
    }
    Some(crs_definitions::from_code(code)?.proj4.to_owned())
}

/// The length of a system's unit in metres.
fn metres_of(words: &[&str]) -> Option<f64> {
    let value = |key: &str| words.iter().find_map(|word| word.strip_prefix(key));
    if let Some(metres) = value("+to_meter=") {
        return metres.parse().ok();
    }
    match value("+units=") {
        None | Some("m") => Some(1.0),
        Some("us-ft") => Some(LengthUnit::UsSurveyFoot.metres()),
        Some("ft") => Some(LengthUnit::Foot.metres()),
        Some(_) => None,
    }
}

/// The code of "EPSG:n", or the one that a WKT 1 or 2 gives its projected system.
fn epsg_code(crs: &str) -> Option<u16> {
    if let Some((authority, code)) = crs.split_once(':')
        && authority.trim().eq_ignore_ascii_case("EPSG")
    {
        return code.trim().parse().ok();
    }
    let start = ["PROJCS[", "PROJCRS[", "PROJECTEDCRS["]
        .iter()
        .filter_map(|word| Some(crs.find(word)? + word.len()))
        .min()?;
    // Its own identifier stands directly inside its brackets; those of its parts stand deeper.
    parts_of_wkt(&crs[start..]).into_iter().find_map(|part| {
        let (word, inside) = part.split_once('[')?;
        if !["AUTHORITY", "ID"].contains(&word.trim()) {
            return None;
        }
        let mut values = inside
            .split([',', ']'])
            .map(|value| value.trim().trim_matches('"'));
        let is_epsg = values.next()?.eq_ignore_ascii_case("EPSG");
        is_epsg.then(|| values.next()?.parse().ok())?
    })
}

/// The comma-separated parts of a WKT, from behind an opening bracket to the one that closes it.
fn parts_of_wkt(text: &str) -> Vec<&str> {
    let (mut depth, mut quoted, mut start) = (0_u32, false, 0);
    let mut parts = Vec::new();
    for (at, c) in text.char_indices() {
        match c {
            '"' => quoted = !quoted,
            _ if quoted => {}
            '[' => depth += 1,
            ',' if depth == 0 => {
                parts.push(&text[start..at]);
                start = at + 1;
            }
            ']' if depth == 0 => {
                parts.push(&text[start..at]);
                break;
            }
            ']' => depth -= 1,
            _ => {}
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Answers of PROJ through pyproj 3.
    #[test]
    fn known_places() {
        // (system, unit, x, y, longitude, latitude, tolerance in degrees)
        let metre = LengthUnit::Metre;
        for (crs, unit, x, y, lon, lat, tolerance) in [
            (
                "EPSG:32633",
                metre,
                500_000.0,
                5_000_000.0,
                15.0,
                45.153_477_183_4,
                1e-9,
            ),
            (
                "EPSG:32633",
                metre,
                450_123.456,
                5_123_456.789,
                14.352_796_991_7,
                46.262_855_832_7,
                1e-9,
            ),
            (
                "EPSG:32719",
                metre,
                496_523.2,
                7_321_456.7,
                -69.034_241_463_4,
                -24.219_628_998_0,
                1e-9,
            ),
            (
                "EPSG:2154",
                metre,
                652_469.0,
                6_862_035.0,
                2.352_199_719_5,
                48.856_597_665_4,
                1e-9,
            ),
            (
                "EPSG:26910",
                metre,
                491_000.0,
                5_459_000.0,
                -123.123_751_799_3,
                49.283_686_421_4,
                1e-8,
            ),
            (
                "EPSG:2193",
                metre,
                1_749_000.0,
                5_428_000.0,
                174.779_336_132_3,
                -41.285_699_262_1,
                1e-8,
            ),
            (
                "EPSG:28350",
                metre,
                400_000.0,
                6_450_000.0,
                115.940_382_706_2,
                -32.081_855_662_8,
                1e-8,
            ),
            (
                "EPSG:7850",
                metre,
                400_000.0,
                6_450_000.0,
                115.940_382_706_2,
                -32.081_855_662_8,
                1e-8,
            ),
            (
                "EPSG:3857",
                metre,
                1_000_000.0,
                6_000_000.0,
                8.983_152_841_2,
                47.353_704_702_4,
                1e-8,
            ),
            (
                "EPSG:2285",
                LengthUnit::UsSurveyFoot,
                1_277_000.0,
                232_000.0,
                -122.307_191_116_4,
                47.626_477_520_8,
                1e-8,
            ),
            // PROJ uses grids or newer parameters here: some metres.
            (
                "EPSG:28992",
                metre,
                121_687.0,
                487_484.0,
                4.898_009_893_4,
                52.374_218_164_1,
                5e-5,
            ),
            (
                "EPSG:27700",
                metre,
                530_000.0,
                180_000.0,
                -0.128_353_940_5,
                51.503_990_827_6,
                5e-5,
            ),
        ] {
            let system = ToWgs84::new(crs, unit).unwrap();
            let [found_lon, found_lat] = system.degrees(x, y).unwrap();
            assert!(
                (found_lon - lon).abs() < tolerance,
                "{crs}: {found_lon} for {lon}"
            );
            assert!(
                (found_lat - lat).abs() < tolerance,
                "{crs}: {found_lat} for {lat}"
            );
        }
    }

    #[test]
    fn the_code_of_a_wkt_is_that_of_its_projected_part() {
        let of_table = crs_definitions::from_code(32_633).unwrap().wkt;
        assert_eq!(epsg_code(of_table), Some(32_633));
        let compound = format!(
            "COMPD_CS[\"a\",{of_table},VERT_CS[\"h\",AUTHORITY[\"EPSG\",\"5773\"]],AUTHORITY[\"EPSG\",\"9999\"]]"
        );
        assert_eq!(epsg_code(&compound), Some(32_633));
        let wkt2 = r#"PROJCRS["WGS 84 / UTM zone 11N",BASEGEOGCRS["WGS 84",ID["EPSG",4326]],CONVERSION["UTM zone 11N",METHOD["Transverse Mercator",ID["EPSG",9807]]],CS[Cartesian,2],LENGTHUNIT["metre",1],ID["EPSG",32611]]"#;
        assert_eq!(epsg_code(wkt2), Some(32_611));
        // A code only of its parts says nothing about the whole.
        let nameless = r#"PROJCS["mine grid, [ID] \"x\"",GEOGCS["WGS 84",AUTHORITY["EPSG","4326"]],PROJECTION["Transverse_Mercator"]]"#;
        assert_eq!(epsg_code(nameless), None);
        assert_eq!(epsg_code("EPSG:2193"), Some(2193));
        assert_eq!(epsg_code("ECEF"), None);
        assert_eq!(epsg_code("PROJCS[\"cut"), None);
    }

    #[test]
    fn what_is_not_understood_says_why() {
        let why = |crs, unit| ToWgs84::new(crs, unit).err().unwrap().what;
        assert!(why("EPSG:4326", LengthUnit::Metre).contains("no projected system"));
        assert!(why("EPSG:32633", LengthUnit::Foot).contains("not in ft"));
        assert!(why("EPSG:2285", LengthUnit::Foot).contains("not in ft"));
        assert!(why("ECEF", LengthUnit::Metre).contains("no EPSG code"));
        assert!(why("EPSG:65000", LengthUnit::Metre).contains("65000"));
        // NAD27 needs a grid.
        assert!(ToWgs84::new("EPSG:26710", LengthUnit::Metre).is_err());
        // Far outside, the projection has no answer rather than a wrong one.
        let utm = ToWgs84::new("EPSG:32633", LengthUnit::Metre).unwrap();
        assert_eq!(utm.degrees(1e9, 1e9), None);
        assert_eq!(utm.degrees(f64::NAN, 0.0), None);
    }
}
