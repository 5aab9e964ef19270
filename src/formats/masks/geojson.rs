//! GeoJSON (RFC 7946 in form) of polygons in pixels of a photo, one file a photo: column, then row, y down as in images. So
//! does segmenteverygrain write them (`save_polygons`), QuPath, and we.
//!
//! - segmenteverygrain traces with scikit-image's `find_contours`, which counts from the MIDDLE of the first pixel: its
//!   corners lie half way between two middles. Where most corners do (one coordinate whole, the other at a half), all are
//!   moved by half a pixel, and a note says so.
//! - Where no row is above 0 and some are below -1, rows were counted upwards (QGIS over a photo without a place): they are
//!   turned, and a note says so.
//! - The class is `class`, `label`, `category`, `type` or `name` of the properties, in small letters or capitals, or QuPath's
//!   `classification`; the number of a fragment is `fragment` in files of ours.

use glam::DVec2;
use serde::Deserialize;
use serde_json::{Map, Value};

use super::numbers::Numbers;
use super::outline::{Mask, Meaning, OutlinedImage, Piece};
use crate::fault::Fault;
use crate::text::fields::shown;

/// An object of GeoJSON that stands inside another.
#[derive(Debug, Deserialize)]
pub(super) struct Object {
    #[serde(rename = "type")]
    kind: String,
    #[serde(default)]
    properties: Option<Properties>,
    geometry: Option<Box<Object>>,
    #[serde(default)]
    geometries: Vec<Object>,
    #[serde(default)]
    coordinates: Numbers,
}

/// The keys of a class, in small letters, the first that is there counts.
const CLASS_KEYS: [&str; 6] = [
    "class",
    "label",
    "category",
    "classification",
    "type",
    "name",
];

/// What a feature says of itself.
#[derive(Debug, Default, Deserialize)]
#[serde(transparent)]
struct Properties(Map<String, Value>);

impl Properties {
    /// The name of its class; empty where it has none. Programs of maps write keys in capitals as they like.
    fn class(&self) -> &str {
        let of = |key: &&str| {
            let is_it = |(name, _): &(&String, &Value)| name.eq_ignore_ascii_case(key);
            let (_, value) = self.0.iter().find(is_it)?;
            value.as_str().or_else(|| value["name"].as_str())
        };
        CLASS_KEYS.iter().find_map(of).unwrap_or_default()
    }

    fn fragment(&self) -> Option<u64> {
        self.0.get("fragment")?.as_u64()
    }
}

/// Coordinate systems of the Earth are not pixels.
const PIXELS: &str = "give polygons in pixels of the photo, counted from its top left corner";

/// The image of a file's features. `crs` is the member of old files that says the coordinate system. `is_own`: corners are
/// where they are.
///
/// # Errors
/// Where coordinates are on the Earth.
pub(super) fn image(
    features: Vec<Object>,
    crs: &Value,
    photo: Option<String>,
    is_own: bool,
) -> Result<OutlinedImage, Fault> {
    if let Some(name) = crs["properties"]["name"].as_str() {
        let what = format!("its coordinates are in {}, on the Earth", shown(name));
        return Err(Fault::new(what, PIXELS));
    }
    let mut image = OutlinedImage {
        name: photo,
        ..OutlinedImage::default()
    };
    for (feature, count) in features.iter().zip(1..) {
        let place = format!("feature {count}");
        let mut pieces = Vec::new();
        if let Err(why) = add(feature, &mut pieces) {
            image.notes.at(why, &place);
        }
        if pieces.is_empty() {
            continue;
        }
        let properties = feature.properties.as_ref();
        let number = properties.and_then(Properties::fragment);
        let class = properties.map(Properties::class).unwrap_or_default();
        image.masks.push(Mask {
            meaning: Meaning::of_class(class),
            class: class.to_owned(),
            number: number
                .filter(|_| is_own)
                .and_then(|number| u32::try_from(number).ok()),
            place,
            pieces,
        });
    }
    if !is_own {
        place_in_photo(&mut image);
    }
    Ok(image)
}

/// Adds the polygons of an object; says what is none.
fn add(object: &Object, pieces: &mut Vec<Piece>) -> Result<(), String> {
    match object.kind.as_str() {
        "Feature" => object.geometry.iter().try_for_each(|one| add(one, pieces)),
        "GeometryCollection" => object
            .geometries
            .iter()
            .try_for_each(|one| add(one, pieces)),
        "Polygon" => polygon(&object.coordinates, pieces),
        "MultiPolygon" => {
            let mut polygons = object.coordinates.lists().iter();
            polygons.try_for_each(|one| polygon(one, pieces))
        }
        kind => Err(format!(
            "a {} outlines nothing and is left out",
            shown(kind)
        )),
    }
}

/// An outline, then its holes.
fn polygon(rings: &Numbers, pieces: &mut Vec<Piece>) -> Result<(), String> {
    let rings: Option<Vec<Vec<DVec2>>> = rings.lists().iter().map(Numbers::corners).collect();
    match rings.filter(|rings| !rings.is_empty()) {
        Some(rings) => pieces.push(Piece::Rings(rings)),
        None => return Err("a polygon without corners is left out".to_owned()),
    }
    Ok(())
}

/// Corners from where other programs count them to where we do.
fn place_in_photo(image: &mut OutlinedImage) {
    let corners = || {
        image
            .masks
            .iter()
            .flat_map(|mask| &mask.pieces)
            .flat_map(|piece| match piece {
                Piece::Rings(rings) => rings.iter().flatten(),
                Piece::Runs(_) => [].iter().flatten(),
            })
    };
    let (mut count, mut between) = (0_usize, 0_usize);
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    for corner in corners() {
        let [x, y] = [corner.x, corner.y].map(|at| at.rem_euclid(1.0));
        count += 1;
        between += usize::from(x == 0.5 && y == 0.0 || x == 0.0 && y == 0.5);
        lowest = lowest.min(corner.y);
        highest = highest.max(corner.y);
    }
    let is_turned = highest <= 0.0 && lowest < -1.0;
    let is_moved = between * 2 > count;
    if is_turned {
        image
            .notes
            .say("rows are counted upwards in it: they are turned");
    }
    if is_moved {
        image.notes.say(
            "its corners count from the middle of the first pixel (as segmenteverygrain's do): they are moved by half a pixel",
        );
    }
    if !is_turned && !is_moved {
        return;
    }
    for piece in image.masks.iter_mut().flat_map(|mask| &mut mask.pieces) {
        if let Piece::Rings(rings) = piece {
            for corner in rings.iter_mut().flatten() {
                if is_turned {
                    corner.y = -corner.y;
                }
                if is_moved {
                    *corner += 0.5;
                }
            }
        }
    }
}
