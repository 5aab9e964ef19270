//! GeoJSON in pixels of a photo: column, then row, y down. A feature for each fragment: a polygon with its holes, or several.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::trace::{Part, parts};
use super::{FRAGMENT, NOT_ROCK_NAME};
use crate::delineation::{FINES, LabelImage, NOT_ROCK};

/// The features of a photo. What is no rock is a feature, too; fines are what none covers.
pub fn fragments_geojson(photo: &str, labels: &LabelImage) -> String {
    let mut fragments: BTreeMap<u32, (usize, Vec<Value>)> = BTreeMap::new();
    let (parts, part_of) = parts(labels);
    let mut pixels = vec![0_usize; parts.len()];
    for part in part_of {
        pixels[part as usize] += 1;
    }
    for (part, pixels) in parts.into_iter().zip(pixels) {
        if part.label != FINES {
            let fragment = fragments.entry(part.label).or_default();
            fragment.0 += pixels;
            fragment.1.push(polygon(part));
        }
    }
    let features = fragments
        .into_iter()
        .map(|(label, (pixels, mut polygons))| {
            let geometry = match polygons.len() {
                1 => json!({"type": "Polygon", "coordinates": polygons.pop()}),
                _ => json!({"type": "MultiPolygon", "coordinates": polygons}),
            };
            let properties = match label {
                NOT_ROCK => json!({"class": NOT_ROCK_NAME, "pixels": pixels}),
                label => json!({"class": FRAGMENT, "fragment": label, "pixels": pixels}),
            };
            json!({"type": "Feature", "properties": properties, "geometry": geometry}).to_string()
        });
    let features: Vec<String> = features.collect();
    format!(
        "{{\"type\":\"FeatureCollection\",\"fragscale\":\"fragments in pixels of the undistorted photo, y down\",\"photo\":{},\"features\":[\n{}\n]}}\n",
        Value::from(photo),
        features.join(",\n")
    )
}

/// The rings of a part, each of which ends where it began.
fn polygon(part: Part) -> Value {
    let rings = part.rings.into_iter().map(|mut ring| {
        ring.extend(ring.first().copied());
        ring
    });
    json!(rings.collect::<Vec<_>>())
}
