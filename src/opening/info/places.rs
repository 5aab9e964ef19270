//! What is said of a list of known places.

use std::path::Path;

use glam::DVec2;
use serde_json::{Value, json};

use crate::formats::{ControlPoints, FileError, KnownPlaces, read_known_places};

/// A list of known places, or what is wrong with it; `None` of what is none.
pub(super) fn known_places_info(path: &Path) -> Option<Result<Value, FileError>> {
    let places = read_known_places(path)?;
    let places = places.map_err(|fault| FileError::new(path, fault));
    Some(places.map(|places| places_info(&places)))
}

/// Known places: control points with their marks, or where photos were taken; in the list's own system.
fn places_info(places: &KnownPlaces) -> Value {
    match places {
        KnownPlaces::ControlPoints(ControlPoints { list, warnings }) => {
            let mark = |(photo, pixel): &(String, DVec2)| json!({"photo": photo, "pixel": pixel.to_array()});
            let points = list.points.iter().map(|point| {
                json!({
                    "name": point.name,
                    "position": point.position.map(|position| position.to_array()),
                    "marks": point.marks.iter().map(mark).collect::<Vec<_>>(),
                })
            });
            let marks = list.points.iter().map(|point| point.marks.len());
            json!({
                "kind": "control-points",
                "crs": list.crs,
                "points": points.collect::<Vec<_>>(),
                "marks": marks.sum::<usize>(),
                "scale_bars": list.bars.len(),
                "warnings": warnings,
            })
        }
        KnownPlaces::OfPhotos(list) => {
            let positions = list.positions.iter().map(|of| {
                json!({
                    "photo": of.name,
                    "position": of.position.to_array(),
                    "accuracy": of.accuracy.map(|accuracy| accuracy.to_array()),
                })
            });
            json!({
                "kind": "positions",
                "crs": list.crs,
                "positions": positions.collect::<Vec<_>>(),
                "warnings": list.warnings,
            })
        }
    }
}
