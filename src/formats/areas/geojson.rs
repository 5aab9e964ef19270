//! GeoJSON (RFC 7946): the polygons of a geometry, a feature or a collection of them, however deep.
//!
//! RFC 7946 knows WGS 84 alone. What came before it (2008) named others in `crs`: those that are WGS 84 in degrees,
//! longitude first, are read, any other is refused.

use serde::Deserialize;
use serde_json::Value;

use super::ring::ring;
use super::{MapAreas, no_polygon};
use crate::fault::Fault;
use crate::geodesy::Geographic;
use crate::text::fields::shown;
use crate::text::json;

const WRONG: &str = "check that it is GeoJSON, or export it again";

/// Any object of GeoJSON; which of the members it has is said by its type.
#[derive(Deserialize)]
struct Object {
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    features: Vec<Object>,
    geometry: Option<Box<Object>>,
    #[serde(default)]
    geometries: Vec<Object>,
    #[serde(default)]
    coordinates: Value,
    #[serde(default)]
    crs: Value,
}

/// Names that end so are of WGS 84 in degrees.
const WGS_84: [&str; 3] = ["CRS84", "EPSG::4326", "EPSG:4326"];

/// The polygons of a text.
///
/// # Errors
/// As [`super::read_areas`].
pub(super) fn read(text: &str) -> Result<MapAreas, Fault> {
    let object: Object = json::parse(text.as_bytes())?;
    if let Some(name) = object.crs["properties"]["name"].as_str()
        && !WGS_84.iter().any(|known| name.ends_with(known))
    {
        let what = format!(
            "its coordinates are in {}, not in degrees of WGS 84",
            shown(name)
        );
        return Err(Fault::new(what, "export it in WGS 84 (EPSG:4326)"));
    }
    let mut found = MapAreas {
        polygons: Vec::new(),
        holes: Vec::new(),
        first_hole: None,
        points: 0,
        lines: 0,
    };
    found.add(&object)?;
    match found.polygons.is_empty() {
        true => Err(no_polygon(found.points, found.lines)),
        false => Ok(found),
    }
}

impl MapAreas {
    fn add(&mut self, object: &Object) -> Result<(), Fault> {
        match object.kind.as_str() {
            "FeatureCollection" => object.features.iter().try_for_each(|one| self.add(one)),
            // A feature may have no place: null.
            "Feature" => object.geometry.iter().try_for_each(|one| self.add(one)),
            "GeometryCollection" => object.geometries.iter().try_for_each(|one| self.add(one)),
            "Polygon" => self.polygon(&object.coordinates),
            "MultiPolygon" => {
                let polygons = list(&object.coordinates).ok_or_else(|| self.no_list())?;
                polygons.iter().try_for_each(|one| self.polygon(one))
            }
            "Point" | "MultiPoint" => {
                self.points += 1;
                Ok(())
            }
            "LineString" | "MultiLineString" => {
                self.lines += 1;
                Ok(())
            }
            other => {
                let what = format!("\"type\" is \"{}\", which GeoJSON has not", shown(other));
                Err(Fault::new(what, WRONG))
            }
        }
    }

    /// What the next polygon is called.
    fn at(&self) -> String {
        format!("polygon {}", self.polygons.len() + 1)
    }

    fn no_list(&self) -> Fault {
        let what = format!("{} has no list of corners", self.at());
        Fault::new(what, WRONG)
    }

    /// One of rings: the outline, then its holes.
    fn polygon(&mut self, rings: &Value) -> Result<(), Fault> {
        let at = self.at();
        let rings = list(rings).ok_or_else(|| self.no_list())?;
        let (outline, holes) = rings.split_first().ok_or_else(|| self.no_list())?;
        let outline = self.ring(outline, &at)?;
        if !holes.is_empty() && self.first_hole.is_none() {
            let what = format!("{at} has a hole");
            self.first_hole = Some(Fault::new(what, "draw it without, or as two polygons"));
        }
        for (hole, number) in holes.iter().zip(1..) {
            let hole = self.ring(hole, &format!("{at}, hole {number}"))?;
            self.holes.push(hole);
        }
        self.polygons.push(outline);
        Ok(())
    }

    /// The corners of one ring.
    fn ring(&self, corners: &Value, at: &str) -> Result<Vec<Geographic>, Fault> {
        let outline = list(corners).ok_or_else(|| self.no_list())?;
        let mut positions = Vec::with_capacity(outline.len());
        for (position, number) in outline.iter().zip(1..) {
            // A third number is a height.
            let numbers = list(position).and_then(|numbers| {
                let number = |place: usize| numbers.get(place)?.as_f64();
                Some([number(0)?, number(1)?])
            });
            positions.push(numbers.ok_or_else(|| {
                let what = format!("{at}, corner {number} is no longitude and latitude");
                Fault::new(what, WRONG)
            })?);
        }
        ring(&positions, at, None)
    }
}

fn list(value: &Value) -> Option<&[Value]> {
    value.as_array().map(Vec::as_slice)
}
