//! LabelMe's JSON of a photo (version 5). Its polygons have no holes: what lies in a hole is a polygon of its own, which is
//! smaller and so lies on top; fines in a hole are one named so. The parts of a fragment have its number as their group.

use std::collections::HashSet;

use glam::DVec2;
use serde_json::{Value, json};

use super::trace::{Part, parts};
use super::{FINES_NAME, FRAGMENT, NOT_ROCK_NAME};
use crate::delineation::labels::spans_within;
use crate::delineation::{FINES, LabelImage, NOT_ROCK};

/// The text of a photo's file. `photo` is where LabelMe finds it, from the file's folder.
pub fn labelme_json(photo: &str, labels: &LabelImage) -> String {
    let (parts, part_of) = parts(labels);
    let in_holes = in_holes(labels, &parts, &part_of);
    let shapes = parts.iter().enumerate().filter_map(|(index, part)| {
        let (label, group) = match part.label {
            // Where nothing is outlined, nothing need be drawn.
            FINES if !in_holes.contains(&(index as u32)) => return None,
            FINES => (FINES_NAME, Value::Null),
            NOT_ROCK => (NOT_ROCK_NAME, Value::Null),
            label => (FRAGMENT, label.into()),
        };
        let shape = json!({
            "label": label,
            "points": part.rings.first(),
            "group_id": group,
            "description": "",
            "shape_type": "polygon",
            "flags": {},
            "mask": null,
        });
        Some(shape.to_string())
    });
    let shapes: Vec<String> = shapes.collect();
    format!(
        "{{\"version\":\"5.5.0\",\"fragscale\":\"fragments in pixels of the undistorted photo\",\"flags\":{{}},\"shapes\":[\n{}\n],\"imagePath\":{},\"imageData\":null,\"imageHeight\":{},\"imageWidth\":{}}}\n",
        shapes.join(",\n"),
        Value::from(photo),
        labels.height,
        labels.width
    )
}

/// The parts of fines that lie in holes.
fn in_holes(labels: &LabelImage, parts: &[Part], part_of: &[u32]) -> HashSet<u32> {
    let mut found = HashSet::new();
    for part in parts.iter().filter(|part| part.label != FINES) {
        for hole in part.rings.iter().skip(1) {
            let corners: Vec<DVec2> = hole
                .iter()
                .map(|[x, y]| DVec2::new((*x).into(), (*y).into()))
                .collect();
            // The sides of photos are in u32.
            let (width, height) = (labels.width as u32, labels.height as u32);
            spans_within(&corners, width, height, |row, columns| {
                let begin = row as usize * labels.width;
                let inside = &part_of[begin + columns.start as usize..begin + columns.end as usize];
                let fines = inside
                    .iter()
                    .filter(|part| parts[**part as usize].label == FINES);
                found.extend(fines);
            });
        }
    }
    found
}
