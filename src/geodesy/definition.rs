//! From the texts that name a coordinate system to what it is made of.
//!
//! Understood are "EPSG:n" and "EPSG:n+m" (m the vertical system, or "ellipsoid"), also as URN or address of OGC,
//! "ECEF", WKT 1 and 2 (with an EPSG code, or what proj4wkt makes of it; compound, bound and 3D ones),
//! PROJ strings, "WGS84 UTM 17N" as OpenDroneMap writes it, and "WGS 84".

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

    fn of_wkt(text: &str) -> Result<Self, Fault> {
        let roots = Node::parse(text)?;
        let mut parts = Parts::default();
        roots.iter().for_each(|root| parts.collect(root));
        let Some(horizontal) = parts.horizontal else {
            let keyword = roots.first().map_or("", |root| &root.keyword);
            return Err(Fault::new(
                match keyword {
                    "LOCAL_CS" | "ENGCRS" | "ENGINEERINGCRS" => {
                        "the coordinate system is a local one that is tied to no place on the Earth"
                            .to_owned()
                    }
                    _ => format!("the well-known text ({keyword}) holds no horizontal system"),
                },
                REMEDY,
            ));
        };
        refuse_other_angles(horizontal)?;
        let of_code = horizontal.epsg_code().map(Self::of_code);
        let mut definition = match of_code {
            Some(Ok(definition)) if definition.proj.has_known_datum() => definition,
            _ => {
                let mut definition = Self::of_proj(proj_of(horizontal)?);
                if let Some(shift) = parts.shift {
                    definition.proj.set("towgs84", shift);
                }
                definition.code = horizontal.epsg_code().or(definition.code);
                definition
            }
        };
        if let Some(vertical) = parts.vertical {
            definition.heights = heights_of(vertical);
        } else if horizontal.is_three_dimensional() {
            definition.heights = Heights::ellipsoidal();
        }
        Ok(definition)
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

/// The parts of a WKT that matter here.
#[derive(Default)]
struct Parts<'t, 'a> {
    horizontal: Option<&'t Node<'a>>,
    vertical: Option<&'t Node<'a>>,
    /// Seven parameters to WGS 84 of a bound system.
    shift: Option<String>,
}

impl<'t, 'a> Parts<'t, 'a> {
    fn collect(&mut self, node: &'t Node<'a>) {
        match node.keyword.as_str() {
            "PROJCS" | "PROJCRS" | "PROJECTEDCRS" | "GEOGCS" | "GEOGCRS" | "GEOGRAPHICCRS"
            | "GEODCRS" | "GEODETICCRS" | "GEOCCS" => self.horizontal = Some(node),
            "VERT_CS" | "VERTCS" | "VERTCRS" | "VERTICALCRS" => self.vertical = Some(node),
            "COMPD_CS" | "COMPOUNDCRS" => node.nodes().for_each(|part| self.collect(part)),
            "BOUNDCRS" => {
                let source = node.child(&["SOURCECRS"]);
                source
                    .into_iter()
                    .flat_map(Node::nodes)
                    .for_each(|part| self.collect(part));
                self.shift = node
                    .child(&["ABRIDGEDTRANSFORMATION"])
                    .and_then(shift_of)
                    .or(self.shift.take());
            }
            _ => {}
        }
    }
}

impl Node<'_> {
    /// Whether it is a geographic or geocentric system with heights of its own.
    fn is_three_dimensional(&self) -> bool {
        let dimension = self.child(&["CS"]).and_then(|cs| cs.word(1));
        self.keyword == "GEOCCS" || dimension == Some("3")
    }

    /// Whether its coordinates are x, y, z from the Earth's centre: in WKT 2 only the axes of a
    /// geodetic system say that.
    fn is_geocentric(&self) -> bool {
        let axes = self.child(&["CS"]).and_then(|cs| cs.word(0));
        let is_geodetic = ["GEODCRS", "GEODETICCRS"].contains(&self.keyword.as_str());
        self.keyword == "GEOCCS"
            || (is_geodetic && axes.is_some_and(|axes| axes.eq_ignore_ascii_case("cartesian")))
    }

    /// The length of its unit in metres, where it says one: below itself or its first axis.
    fn length_unit(&self) -> Option<f64> {
        let unit = ["UNIT", "LENGTHUNIT"];
        let on_axis = || self.child(&["AXIS"])?.child(&unit);
        self.child(&unit).or_else(on_axis)?.number(1)
    }
}

/// The seven parameters of an abridged transformation, in the order and units of TOWGS84; `None`
/// where it is of another kind (a grid, a geoid).
fn shift_of(transformation: &Node) -> Option<String> {
    let method = transformation
        .child(&["METHOD"])?
        .word(0)?
        .to_ascii_lowercase();
    // A rotation of the frame is the rotation of the position backwards (EPSG guidance note 7-2).
    let sense = if method.contains("coordinate frame") {
        -1.0
    } else {
        1.0
    };
    let parameter = |name: &str| {
        let named = |node: &&Node| node.word(0).is_some_and(|n| n.eq_ignore_ascii_case(name));
        transformation
            .nodes()
            .find(named)
            .map(|node| node.number(1))
    };
    let x = parameter("X-axis translation")??;
    let y = parameter("Y-axis translation")??;
    let z = parameter("Z-axis translation")??;
    let turn = |name: &str| Some(parameter(name).unwrap_or(Some(0.0))? * sense);
    // WKT 2 writes 1.0000012 for 1.2 parts in a million.
    let scale = parameter("Scale difference").unwrap_or(Some(1.0))?;
    let ppm = if (scale - 1.0).abs() < 0.1 {
        (scale - 1.0) * 1e6
    } else {
        scale
    };
    Some(format!(
        "{x},{y},{z},{},{},{},{ppm}",
        turn("X-axis rotation")?,
        turn("Y-axis rotation")?,
        turn("Z-axis rotation")?
    ))
}

/// A vertical system of a WKT.
fn heights_of(node: &Node) -> Heights {
    let code = node.epsg_code();
    let mut heights = code.map(Heights::of_code).unwrap_or_default();
    if code.is_none() {
        let name = node.word(0).filter(|name| !name.is_empty());
        heights.name = name.map(|name| match name.to_ascii_lowercase() {
            plain if plain.contains("ellipsoid") => "the ellipsoid".to_owned(),
            _ => name.to_owned(),
        });
    }
    // In WKT 2 the unit may stand on the axis.
    let unit = ["UNIT", "LENGTHUNIT"];
    let on_axis = || node.child(&["AXIS"])?.child(&unit)?.number(1);
    let written = node
        .child(&unit)
        .and_then(|unit| unit.number(1))
        .or_else(on_axis);
    heights.unit_metres = written.or(heights.unit_metres);
    heights
}

/// proj4wkt forgets the unit of longitude and latitude: anything but degrees would be 10 % off.
fn refuse_other_angles(horizontal: &Node) -> Result<(), Fault> {
    if !horizontal.keyword.starts_with("GEO") {
        return Ok(());
    }
    let unit = ["UNIT", "ANGLEUNIT"];
    let on_axis = horizontal
        .child(&["AXIS"])
        .and_then(|axis| axis.child(&unit));
    let factor = (horizontal.child(&unit).or(on_axis)).and_then(|unit| unit.number(1));
    let is_degree = |factor: f64| (factor / 1_f64.to_radians() - 1.0).abs() < 1e-9;
    if horizontal.is_geocentric() || factor.is_none_or(is_degree) {
        return Ok(());
    }
    Err(Fault::new(
        "the longitudes and latitudes of the coordinate system are not in degrees",
        "convert them to degrees",
    ))
}

/// The PROJ string of a horizontal system.
fn proj_of(horizontal: &Node) -> Result<ProjText, Fault> {
    if horizontal.is_geocentric() {
        return geocentric_proj_of(horizontal);
    }
    let text = proj4wkt::wkt_to_projstring(&horizontal.to_text()).map_err(|e| {
        let name = horizontal.word(0).unwrap_or_default();
        Fault::new(
            format!("the coordinate system '{name}' is not understood ({e})"),
            REMEDY,
        )
    })?;
    Ok(ProjText::parse(&text))
}

/// The length in metres of the unit that a WKT states for a plane system, also for one that is tied to
/// no place on the Earth (LOCAL_CS, ENGCRS) or not understood. `None` for other texts.
pub fn stated_unit_metres(text: &str) -> Option<f64> {
    fn of(node: &Node) -> Option<f64> {
        match node.keyword.as_str() {
            "LOCAL_CS" | "ENGCRS" | "ENGINEERINGCRS" | "PROJCS" | "PROJCRS" | "PROJECTEDCRS" => {
                node.length_unit()
            }
            "COMPD_CS" | "COMPOUNDCRS" => node.nodes().find_map(of),
            "BOUNDCRS" => node.child(&["SOURCECRS"])?.nodes().find_map(of),
            _ => None,
        }
    }
    let roots = Node::parse(text.trim()).ok()?;
    let unit = roots.iter().find_map(of)?;
    (unit.is_finite() && unit > 0.0).then_some(unit)
}

/// The datums that coincide with WGS 84 to what a survey can tell; letters and digits of their names.
const GEOCENTRIC_DATUMS: [&str; 9] = [
    "wgs84",
    "wgs1984",
    "worldgeodeticsystem1984",
    "etrs89",
    "europeanterrestrialreferencesystem1989",
    "gda",
    "geocentricdatumofaustralia",
    "itrf",
    "internationalterrestrialreferenceframe",
];

/// The PROJ string of a system that counts from the Earth's centre. proj4wkt takes those of WKT 2
/// for longitudes and latitudes.
fn geocentric_proj_of(system: &Node) -> Result<ProjText, Fault> {
    let datum = system.child(&["DATUM", "ENSEMBLE", "GEODETICDATUM", "TRF"]);
    let datum = datum.and_then(|datum| datum.word(0)).unwrap_or_default();
    let letters = datum.chars().filter(char::is_ascii_alphanumeric);
    let plain = letters.collect::<String>().to_ascii_lowercase();
    let plain = plain.strip_prefix('d').unwrap_or(&plain);
    if !GEOCENTRIC_DATUMS.iter().any(|name| plain.starts_with(name)) {
        return Err(Fault::new(
            format!("a geocentric system whose datum ('{datum}') is not known to be WGS 84"),
            REMEDY,
        ));
    }
    let unit = system.length_unit().unwrap_or(1.0);
    let text = match unit == 1.0 {
        true => "+proj=geocent +datum=WGS84 +units=m".to_owned(),
        // Not by the datum's name, whose code says metres.
        false => format!("+proj=geocent +ellps=GRS80 +to_meter={unit}"),
    };
    Ok(ProjText::parse(&text))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::stated_unit_metres;
    use crate::geodesy::{Crs, CrsKind};

    const UTM33: &str = r#"PROJCS["WGS 84 / UTM zone 33N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",15],PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1],AXIS["Easting",EAST],AXIS["Northing",NORTH],AUTHORITY["EPSG","32633"]]"#;

    /// ESRI's, GDAL's and ISO's texts without a single code.
    #[test]
    fn wkt_without_codes_agrees_with_proj() {
        let mut failed = String::new();
        let lines = include_str!("pyproj_answers.tsv").lines();
        let mut compared = 0;
        for line in lines.filter(|line| !line.starts_with('#')) {
            let fields: Vec<&str> = line.split('\t').collect();
            let [name, x, y, longitude, latitude, wkt] = fields[..] else {
                panic!("{line}");
            };
            let number = |text: &str| text.parse::<f64>().unwrap();
            let point = DVec3::new(number(x), number(y), 0.0);
            match Crs::understand(wkt).map(|crs| crs.to_geographic(point)) {
                Ok(Some(place)) => {
                    let east = (place.longitude - number(longitude)).abs();
                    let north = (place.latitude - number(latitude)).abs();
                    if east.max(north) > 1e-8 {
                        failed += &format!("{name}: {place:?}\n");
                    }
                }
                other => failed += &format!("{name}: {other:?}\n"),
            }
            compared += 1;
        }
        assert!(compared > 20 && failed.is_empty(), "\n{failed}");
    }

    #[test]
    fn the_code_of_a_wkt_is_that_of_its_projected_part() {
        let name = |text: &str| Crs::understand(text).unwrap().name().to_owned();
        assert_eq!(name(UTM33), "EPSG:32633");
        let compound = format!(
            "COMPD_CS[\"a\",{UTM33},VERT_CS[\"EGM96 height\",VERT_DATUM[\"EGM96 geoid\",2005],UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"5773\"]],AUTHORITY[\"EPSG\",\"9999\"]]"
        );
        assert_eq!(name(&compound), "EPSG:32633+5773");
        let wkt2 = r#"PROJCRS["WGS 84 / UTM zone 11N",BASEGEOGCRS["WGS 84",ID["EPSG",4326]],CONVERSION["UTM zone 11N",METHOD["Transverse Mercator",ID["EPSG",9807]]],CS[Cartesian,2],LENGTHUNIT["metre",1],ID["EPSG",32611]]"#;
        assert_eq!(name(wkt2), "EPSG:32611");
        // A code only of its parts says nothing about the whole; UTM on WGS 84 is known by its numbers.
        let nameless = UTM33.replace(r#",AUTHORITY["EPSG","32633"]"#, "");
        assert_eq!(name(&nameless), "EPSG:32633");
        let shifted = nameless.replace("500000", "500001");
        assert_eq!(name(&shifted), shifted);
        assert!(
            !Crs::understand(&shifted)
                .unwrap()
                .same_as(&Crs::understand(UTM33).unwrap())
        );
    }

    #[test]
    fn vertical_parts() {
        let with = |vertical: &str| {
            let crs = Crs::understand(&format!("COMPD_CS[\"a\",{UTM33},{vertical}]")).unwrap();
            (crs.heights().to_owned(), crs.vertical_unit_metres())
        };
        assert_eq!(
            with(
                r#"VERT_CS["NAVD88 height (ftUS)",VERT_DATUM["x",2005],UNIT["US survey foot",0.304800609601219],AXIS["Up",UP],AUTHORITY["EPSG","6360"]]"#
            ),
            ("NAVD88".to_owned(), 0.304_800_609_601_219)
        );
        assert_eq!(
            with(
                r#"VERTCRS["pit datum",VDATUM["x"],CS[vertical,1],AXIS["up",up,LENGTHUNIT["foot",0.3048]]]"#
            ),
            ("pit datum".to_owned(), 0.3048)
        );
        assert_eq!(
            with(r#"VERT_CS["Ellipsoid (metre)",VERT_DATUM["Ellipsoid",2002],UNIT["metre",1]]"#),
            ("the ellipsoid".to_owned(), 1.0)
        );
        // A map's system with heights above its ellipsoid keeps them in its name, as it is written into a flight's file.
        let three = UTM33.replace("PROJECTION[", "CS[Cartesian,3],PROJECTION[");
        for text in [
            format!(
                r#"COMPD_CS["a",{UTM33},VERT_CS["Ellipsoid",VERT_DATUM["Ellipsoid",2002],UNIT["metre",1]]]"#
            ),
            three,
        ] {
            let crs = Crs::understand(&text).unwrap();
            assert_eq!(crs.name(), "EPSG:32633+ellipsoid");
            let again = Crs::understand(crs.name()).unwrap();
            assert_eq!(
                (again.name(), again.heights()),
                (crs.name(), "the ellipsoid")
            );
        }
        assert_eq!(Crs::understand("EPSG:4979").unwrap().name(), "EPSG:4979");
        // ESRI appends it.
        let esri = format!(
            "{UTM33},VERTCS[\"EGM96_Geoid\",VDATUM[\"EGM96_Geoid\"],PARAMETER[\"Vertical_Shift\",0.0],PARAMETER[\"Direction\",1.0],UNIT[\"Meter\",1.0]]"
        );
        assert_eq!(Crs::understand(&esri).unwrap().heights(), "EGM96_Geoid");
        let three = r#"GEOGCRS["WGS 84",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563,LENGTHUNIT["metre",1]]],CS[ellipsoidal,3],AXIS["latitude",north,ORDER[1],ANGLEUNIT["degree",0.0174532925199433]],AXIS["longitude",east,ORDER[2],ANGLEUNIT["degree",0.0174532925199433]],AXIS["height",up,ORDER[3],LENGTHUNIT["metre",1]]]"#;
        let crs = Crs::understand(three).unwrap();
        assert_eq!(
            (crs.kind(), crs.heights()),
            (CrsKind::Geographic, "the ellipsoid")
        );
        let geocentric = r#"GEOCCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],UNIT["metre",1],AXIS["Geocentric X",OTHER],AXIS["Geocentric Y",OTHER],AXIS["Geocentric Z",NORTH]]"#;
        let crs = Crs::understand(geocentric).unwrap();
        assert_eq!(
            (crs.kind(), crs.heights()),
            (CrsKind::Geocentric, "the ellipsoid")
        );
        assert!(crs.same_as(&Crs::understand("ECEF").unwrap()));
    }

    #[test]
    fn units_of_systems_without_a_place() {
        let local = r#"LOCAL_CS["Local Coordinates (m)",LOCAL_DATUM["Local Datum",0],UNIT["metre",1,AUTHORITY["EPSG","9001"]]]"#;
        assert_eq!(stated_unit_metres(local), Some(1.0));
        let compound = format!(
            r#"COMPD_CS["a",{},VERT_CS["h",VERT_DATUM["x",2005],UNIT["metre",1]]]"#,
            local.replace("\"metre\",1,", "\"US survey foot\",0.304800609601219,")
        );
        assert_eq!(stated_unit_metres(&compound), Some(0.304_800_609_601_219));
        let wkt2 = r#"ENGCRS["pit",EDATUM["pit"],CS[Cartesian,2],AXIS["x",east,ORDER[1],LENGTHUNIT["foot",0.3048]],AXIS["y",north,ORDER[2],LENGTHUNIT["foot",0.3048]]]"#;
        assert_eq!(stated_unit_metres(wkt2), Some(0.3048));
        assert_eq!(stated_unit_metres(UTM33), Some(1.0));
        let silent = r#"LOCAL_CS["a",LOCAL_DATUM["b",0]]"#;
        let degrees = r#"GEOGCS["WGS 84",DATUM["a",SPHEROID["b",1,2]],UNIT["degree",0.0174]]"#;
        for none in [
            silent,
            degrees,
            "",
            "EPSG:32633",
            "LOCAL_CS[\"a\",UNIT[\"m\",0]]",
        ] {
            assert_eq!(stated_unit_metres(none), None, "{none}");
        }
    }

    /// The German shift of seven parameters, as TOWGS84 and as PROJ 9.5.1 writes it in WKT 2; the place
    /// is PROJ's. WKT 2's coordinate frame rotation turns the other way.
    #[test]
    fn bound_systems() {
        let source = |towgs84: &str| {
            format!(
                r#"PROJCS["unknown",GEOGCS["unknown",DATUM["Unknown",SPHEROID["Bessel 1841",6377397.155,299.1528128]{towgs84}],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["scale_factor",1],PARAMETER["false_easting",3500000],PARAMETER["false_northing",0],UNIT["metre",1]]"#
            )
        };
        let shift = ",TOWGS84[598.1,73.7,418.2,0.202,0.045,-2.455,6.7]";
        let bound = |method: &str, sign: f64| {
            format!(
                r#"BOUNDCRS[SOURCECRS[{}],TARGETCRS[GEOGCRS["WGS 84",DATUM["World Geodetic System 1984",ELLIPSOID["WGS 84",6378137,298.257223563]]]],ABRIDGEDTRANSFORMATION["t",METHOD["{method}",ID["EPSG",9606]],PARAMETER["X-axis translation",598.1,ID["EPSG",8605]],PARAMETER["Y-axis translation",73.7],PARAMETER["Z-axis translation",418.2],PARAMETER["X-axis rotation",{}],PARAMETER["Y-axis rotation",{}],PARAMETER["Z-axis rotation",{}],PARAMETER["Scale difference",1.0000067]]]"#,
                source(""),
                0.202 * sign,
                0.045 * sign,
                -2.455 * sign
            )
        };
        for text in [
            source(shift),
            bound("Position Vector transformation (geog2D domain)", 1.0),
            bound("Coordinate Frame rotation (geog2D domain)", -1.0),
        ] {
            let crs = Crs::understand(&text).unwrap();
            let place = crs
                .to_geographic(DVec3::new(3_500_123.4, 5_500_567.8, 7.0))
                .unwrap();
            assert!(
                (place.longitude - 9.000_672_022_224).abs() < 1e-8,
                "{place:?}"
            );
            assert!(
                (place.latitude - 49.641_815_730_042).abs() < 1e-8,
                "{place:?}"
            );
            assert_eq!(place.height, 7.0);
        }
        // Without it, where the place is is not known.
        let fault = Crs::understand(&source("")).unwrap_err();
        assert_eq!(fault.what, "how unknown relates to WGS 84 is not known");
    }

    proptest::proptest! {
        /// Whatever a file holds, it ends in an answer or a sentence.
        #[test]
        fn nothing_panics(cut in 0..900_usize, with in "[\\[\\]\"+=,a-z0-9. ]{0,6}") {
            let end = cut.min(UTM33.len());
            let text = format!("{}{with}{}", &UTM33[..end], &UTM33[(end + with.len()).min(UTM33.len())..]);
            if let Ok(crs) = Crs::understand(&text) {
                crs.to_geographic(DVec3::new(5e5, 5e6, 0.0));
            }
            let proj = "+proj=utm +zone=33 +datum=WGS84 +units=m";
            let end = cut.min(proj.len());
            let text = format!("{}{with}{}", &proj[..end], &proj[(end + with.len()).min(proj.len())..]);
            if let Ok(crs) = Crs::understand(&text) {
                crs.to_geographic(DVec3::new(5e5, 5e6, 0.0));
            }
            let _ = Crs::understand(&with);
        }
    }
}
