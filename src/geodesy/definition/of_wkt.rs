//! What the parts of a well-known text say of a coordinate system.

use super::Definition;
use crate::fault::Fault;
use crate::geodesy::heights::Heights;
use crate::geodesy::proj_text::ProjText;
use crate::geodesy::wkt::{Node, REMEDY};

impl Definition {
    pub(super) fn of_wkt(text: &str) -> Result<Self, Fault> {
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
    pub(super) fn length_unit(&self) -> Option<f64> {
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
pub(super) fn refuse_other_angles(horizontal: &Node) -> Result<(), Fault> {
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
