//! Outlines of a photo's fragments in the world, as GeoJSON.
//!
//! Each corner of an outline lies on its own line of sight, at the depth of the fragment's pixel beside it: so an outline
//! is where the fragment is, not where the one behind it lies. Corners are drawn in by a 200th of a pixel, so that an
//! outline that touches itself, at a corner that two of its pixels share, is a valid polygon; its area loses 0.1 % by that
//! where the fragment is 20 pixels across.

use glam::DVec2;
use serde_json::{Map, Value, json};

use super::table::{heads, numbers};
use crate::delineation::measures::Fragment;
use crate::delineation::{FINES, LabelImage, NOT_ROCK};
use crate::map_places::{MapPlaces, closed_ring};
use crate::masks::parts;
use crate::scale::ScaleField;
use crate::units::LengthUnit;

/// How far corners are drawn in, pixels.
const DRAWN_IN: f64 = 0.005;

/// A photo's outlines on their way into the world.
#[derive(Debug, Clone, Copy)]
pub(super) struct WorldOutlines<'a> {
    /// As the flight names it.
    pub photo: &'a str,
    /// Of the undistorted photo.
    pub labels: &'a LabelImage,
    /// Of all its pixels.
    pub field: &'a ScaleField,
    /// What was measured.
    pub fragments: &'a [Fragment],
}

/// A feature for each fragment, with the numbers of `fragments.csv`; without a geometry where too little of it lies on the
/// surface. Lengths in `unit`, places as `places` has them.
pub(super) fn world_geojson(
    outlines: &WorldOutlines<'_>,
    places: &MapPlaces,
    world: LengthUnit,
    unit: LengthUnit,
) -> String {
    let WorldOutlines {
        photo,
        labels,
        fragments,
        ..
    } = *outlines;
    let mut polygons: Vec<Vec<Value>> = vec![Vec::new(); labels.fragments() + 1];
    for part in parts(labels).0 {
        if part.label == FINES || part.label == NOT_ROCK {
            continue;
        }
        let fragment = fragments.binary_search_by_key(&part.label, |of| of.number);
        let fragment = fragment.ok().and_then(|place| fragments.get(place));
        // What has no measures has no place either.
        let Some(depth) = fragment.and_then(|of| outlines.mean_depth(of)) else {
            continue;
        };
        let mut rings = part.rings.iter();
        let outer = rings.next().map(|ring| outlines.ring(ring, depth, places));
        let Some(outer) = outer.filter(|ring| !ring.is_empty()) else {
            continue;
        };
        let mut polygon = vec![outer];
        polygon.extend(rings.filter_map(|ring| {
            let mut hole = outlines.ring(ring, depth, places);
            hole.reverse();
            (!hole.is_empty()).then_some(hole)
        }));
        if let Some(own) = polygons.get_mut(part.label as usize) {
            own.push(json!(polygon));
        }
    }
    let names = heads(world, unit);
    let features = fragments.iter().map(|fragment| {
        let own = polygons.get_mut(fragment.number as usize);
        let mut own = own.map(std::mem::take).unwrap_or_default();
        let geometry = match own.len() {
            0 => Value::Null,
            1 => json!({"type": "Polygon", "coordinates": own.pop()}),
            _ => json!({"type": "MultiPolygon", "coordinates": own}),
        };
        let mut properties = Map::new();
        let first = [
            json!(photo),
            json!(fragment.number),
            json!(fragment.middle.x),
            json!(fragment.middle.y),
            json!(fragment.pixels),
            json!(fragment.is_cut),
        ];
        let numbers = numbers(fragment, world.in_units_of(unit));
        let rest = (0..names.len() - first.len()).map(|place| {
            numbers
                .as_ref()
                .and_then(|of| of.get(place))
                .map_or(Value::Null, |of| json!(of))
        });
        for (name, value) in names.iter().zip(first.into_iter().chain(rest)) {
            properties.insert(name.clone(), value);
        }
        json!({"type": "Feature", "geometry": geometry, "properties": properties}).to_string()
    });
    let features: Vec<String> = features.collect();
    format!(
        "{{\"type\":\"FeatureCollection\",\"fragscale\":\"fragments in the world\",\"photo\":{},\"coordinates\":{},\"features\":[\n{}\n]}}\n",
        Value::from(photo),
        Value::from(places.words()),
        features.join(",\n")
    )
}

impl WorldOutlines<'_> {
    /// Along the optical axis, of the fragment's mean place.
    fn mean_depth(&self, fragment: &Fragment) -> Option<f64> {
        let place = fragment.world?.place;
        Some(self.field.pose().camera_from_world(place).z)
    }

    /// A closed ring of positions; empty where it has none. The fragment lies at the right hand of `ring`; `mean` is its
    /// depth where its surface is not known.
    fn ring(&self, ring: &[[u32; 2]], mean: f64, places: &MapPlaces) -> Vec<Vec<f64>> {
        let corner = |place: usize| {
            let [x, y] = ring[place % ring.len()];
            DVec2::new(f64::from(x), f64::from(y))
        };
        let (camera, pose) = (self.field.camera(), self.field.pose());
        let positions = (0..ring.len()).map(|place| {
            let at = corner(place);
            let before = (at - corner(place + ring.len() - 1)).normalize_or_zero();
            let behind = (corner(place + 1) - at).normalize_or_zero();
            // At the right hand of a way (x, y), rows downwards, lies (-y, x).
            let inwards = before.perp() + behind.perp();
            let own = (at + 0.5 * inwards).floor().max(DVec2::ZERO);
            let depth = self.field.depth_at(own.x as u32, own.y as u32);
            let direction = camera.direction_undistorted(at + DRAWN_IN * inwards);
            let point = pose.center + pose.rotation * (direction * depth.unwrap_or(mean));
            let mut position = places.position(point)?;
            // A hundredth of a millimetre on the Earth, a millionth of a unit elsewhere.
            let digits = if places.are_on_maps() { 1e10 } else { 1e6 };
            for number in &mut position {
                *number = (*number * digits).round() / digits;
            }
            Some(position)
        });
        let positions: Option<Vec<Vec<f64>>> = positions.collect();
        closed_ring(positions.unwrap_or_default())
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::camera::{Camera, Distortion, Pose};
    use crate::delineation::measures::{SieveShape, measured};
    use crate::jobs::Progress;
    use crate::scale::{FieldGrid, ImageKind};
    use crate::surface::{Cloud, Surface};

    /// 100 by 80 pixels from 4 m straight above a plane: a pixel is 8 mm.
    fn field(origin: DVec3) -> ScaleField {
        let camera = Camera {
            name: String::new(),
            width: 100,
            height: 80,
            fx: 500.0,
            fy: 500.0,
            cx: 50.0,
            cy: 40.0,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let pose = Pose::from_tilt_pan(origin + DVec3::Z * 4.0, [90.0, 0.0]);
        let corners = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]];
        let points = corners.map(|[x, y]| origin + DVec3::new(x, y, 0.0));
        let cloud = Cloud {
            points: points.to_vec(),
            ..Cloud::default()
        };
        let surface = Surface::new(cloud).unwrap();
        let grid = FieldGrid::of_pixels(&camera);
        let progress = Progress::default();
        ScaleField::compute(
            &camera,
            &pose,
            ImageKind::Undistorted,
            grid,
            &surface,
            &progress,
        )
        .unwrap()
    }

    fn features(labels: &LabelImage, field: &ScaleField, places: &MapPlaces) -> Value {
        let outlines = WorldOutlines {
            photo: "a.jpg",
            labels,
            field,
            fragments: &measured(labels, field, SieveShape::Calibrated),
        };
        let metre = LengthUnit::Metre;
        serde_json::from_str(&world_geojson(
            &outlines,
            places,
            metre,
            LengthUnit::Centimetre,
        ))
        .unwrap()
    }

    fn labels(of: impl Fn(usize, usize) -> u32) -> LabelImage {
        let places = (0..80).flat_map(|y| (0..100).map(move |x| (x, y)));
        LabelImage {
            width: 100,
            height: 80,
            labels: places.map(|(x, y)| of(x, y)).collect(),
        }
    }

    fn ring_of(value: &Value) -> Vec<[f64; 3]> {
        let at = |of: &Value, place: usize| of[place].as_f64().unwrap_or(0.0);
        value
            .as_array()
            .unwrap()
            .iter()
            .map(|of| [at(of, 0), at(of, 1), at(of, 2)])
            .collect()
    }

    fn area(ring: &[[f64; 3]]) -> f64 {
        let pairs = ring
            .windows(2)
            .map(|pair| pair[0][0] * pair[1][1] - pair[1][0] * pair[0][1]);
        0.5 * pairs.sum::<f64>()
    }

    /// A frame of 40 by 30 pixels with a hole of 10 by 10: 0.32 by 0.24 m on the plane.
    #[test]
    fn a_frame_on_a_plane() {
        let labels = labels(|x, y| {
            let is_hole = (30..40).contains(&x) && (25..35).contains(&y);
            u32::from((20..60).contains(&x) && (15..45).contains(&y) && !is_hole)
        });
        let field = field(DVec3::ZERO);
        let places = MapPlaces::new(None, LengthUnit::Metre);
        let value = features(&labels, &field, &places);
        assert_eq!(value["coordinates"], "local, in m");
        let feature = &value["features"][0];
        assert_eq!(feature["geometry"]["type"], "Polygon");
        let rings: Vec<_> = feature["geometry"]["coordinates"]
            .as_array()
            .unwrap()
            .iter()
            .map(ring_of)
            .collect();
        assert_eq!((rings.len(), rings[0].len(), rings[1].len()), (2, 5, 5));
        // Drawn in by a 200th of a pixel, 0.04 mm; written to a thousandth of that.
        for [x, y, z] in &rings[0] {
            let near =
                |value: f64, ends: [f64; 2]| ends.iter().any(|end| (value - end).abs() < 5e-5);
            assert!(
                near(x.abs(), [0.24, 0.08]) || near(y.abs(), [0.24, 0.08]),
                "{x} {y}"
            );
            assert!(z.abs() < 1e-6);
        }
        assert!(
            (area(&rings[0]) - 0.32 * 0.24).abs() < 1e-4,
            "{}",
            area(&rings[0])
        );
        // Holes the other way round.
        assert!(
            (area(&rings[1]) + 0.08 * 0.08).abs() < 1e-4,
            "{}",
            area(&rings[1])
        );
        let own = &feature["properties"];
        assert_eq!(
            (&own["photo"], &own["fragment"], &own["pixels"]),
            (&json!("a.jpg"), &json!(1), &json!(1100))
        );
        assert!((own["area_cm2"].as_f64().unwrap() - 1100.0 * 0.64).abs() < 1e-6);
        assert_eq!(own["cut"], json!(false));
    }

    /// Two squares that share a corner and a bridge: their outline goes through that corner twice, and is drawn in there.
    #[test]
    fn an_outline_that_touches_itself() {
        let labels = labels(|x, y| {
            let one = (10..20).contains(&x) && (10..20).contains(&y);
            let other = (20..30).contains(&x) && (20..30).contains(&y);
            let bridge = (8..10).contains(&x) && (10..32).contains(&y)
                || (8..30).contains(&x) && (30..32).contains(&y);
            u32::from(one || other || bridge)
        });
        let places = MapPlaces::new(None, LengthUnit::Metre);
        let value = features(&labels, &field(DVec3::ZERO), &places);
        let geometry = &value["features"][0]["geometry"];
        let mut corners: Vec<String> = Vec::new();
        for ring in geometry["coordinates"].as_array().unwrap() {
            corners.extend(
                ring.as_array()
                    .unwrap()
                    .iter()
                    .skip(1)
                    .map(Value::to_string),
            );
        }
        let count = corners.len();
        corners.sort();
        corners.dedup();
        assert_eq!(corners.len(), count);
    }

    /// UTM zone 33 at its own meridian: 500 000 E is 15 degrees, and rings are counterclockwise there, too.
    #[test]
    fn on_maps() {
        let labels = labels(|x, y| u32::from((40..60).contains(&x) && (30..50).contains(&y)));
        let origin = DVec3::new(500_000.0, 5_400_000.0, 300.0);
        let places = MapPlaces::new(Some("EPSG:32633"), LengthUnit::Metre);
        let value = features(&labels, &field(origin), &places);
        assert_eq!(value["coordinates"], "WGS 84 longitude, latitude");
        let ring = &value["features"][0]["geometry"]["coordinates"][0];
        assert_eq!(ring[0].as_array().unwrap().len(), 2);
        let ring = ring_of(ring);
        // 0.16 m about 15 E, 48.75 N or so.
        assert!(
            ring.iter()
                .all(|[x, y, _]| (x - 15.0).abs() < 1.2e-6 && (y - 48.752).abs() < 0.01),
            "{ring:?}"
        );
        assert!(area(&ring) > 0.0);
    }
}
