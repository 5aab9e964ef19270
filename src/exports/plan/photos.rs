//! Footprints, cameras and names within a frame, as shapes.

use super::inks::dash;
use super::{MapFrame, Plan, PlanInks, PlanPhoto, clip};
use crate::drawing::{Anchor, Dash, Marker, Pen, png};

/// Height of a name's line, units.
pub(super) const NAME: f64 = 13.5;
/// Of a footprint's outline.
const OUTLINE: f64 = 1.6;
const SHADE: f64 = 0.10;
/// Half the width of the mark of a camera.
pub(super) const CAMERA: f64 = 3.6;
/// Half the width of the mark of a photo's middle.
pub(super) const MIDDLE: f64 = 3.4;
/// What is behind a name.
const BEHIND: f64 = 0.72;
/// Longer names are cut.
const LONGEST: usize = 40;

pub(super) fn draw(plan: &Plan, frame: &MapFrame, inks: &PlanInks, pen: &mut Pen) {
    let ([left, top], [width, height]) = (frame.at, frame.size);
    let bounds = [[left, top], [left + width, top + height]];
    let outlines: Vec<Vec<[f64; 2]>> = plan
        .photos
        .iter()
        .map(|photo| outline(photo, frame))
        .collect();
    for (photo, outline) in plan.photos.iter().zip(&outlines) {
        let colour = inks.of(photo.verdict);
        let open = outline
            .get(..outline.len().saturating_sub(1))
            .unwrap_or_default();
        pen.area(&clip::area(open, bounds), colour, SHADE);
    }
    // Outlines over all the shades.
    for (photo, outline) in plan.photos.iter().zip(&outlines) {
        let colour = inks.of(photo.verdict);
        for part in clip::line(outline, bounds) {
            pen.line(&part, colour, OUTLINE, dash(photo.verdict));
        }
    }
    let inside = |[x, y]: [f64; 2], room: f64| {
        x >= left + room && x <= left + width - room && y >= top + room && y <= top + height - room
    };
    for outline in &plan.measured {
        let first = outline.points.first().filter(|_| outline.is_polygon);
        let points = outline.points.iter().chain(first);
        let points: Vec<[f64; 2]> = points.map(|point| frame.place(*point)).collect();
        for part in clip::line(&points, bounds) {
            measured_line(&part, inks, pen);
        }
    }
    let mut taken: Vec<clip::Box2> = Vec::new();
    for photo in &plan.photos {
        let colour = inks.of(photo.verdict);
        let camera = frame.place(photo.camera);
        if inside(camera, CAMERA) {
            camera_mark(camera, inks, pen);
        }
        let Some(middle) = photo.middle.map(|middle| frame.place(middle)) else {
            continue;
        };
        if inside(middle, MIDDLE) {
            middle_mark(middle, colour, pen);
        }
        let name = shortened(&photo.name);
        let long = png::text_width(NAME, &name) * 1.06;
        let [x, y] = [middle[0] + MIDDLE + 4.0, middle[1]];
        let place = [[x - 2.0, y - NAME / 2.0], [x + long + 2.0, y + NAME / 2.0]];
        let is_free = place.iter().all(|corner| inside(*corner, 0.0))
            && !taken.iter().any(|other| overlap(other, &place));
        if is_free {
            let [[a, b], [c, d]] = place;
            pen.area(&[[a, b], [c, b], [c, d], [a, d]], inks.paper, BEHIND);
            pen.text([x, y], NAME, &name, Anchor::Left, inks.ink);
            taken.push(place);
        }
    }
}

/// A line of what was measured: seen on any ground.
pub(super) fn measured_line(points: &[[f64; 2]], inks: &PlanInks, pen: &mut Pen) {
    for (width, colour) in [(4.4, inks.paper), (2.2, inks.ink)] {
        pen.line(points, colour, width, Dash::Solid);
    }
}

pub(super) fn camera_mark(at: [f64; 2], inks: &PlanInks, pen: &mut Pen) {
    let [x, y] = at;
    for (half, colour) in [(CAMERA + 1.2, inks.paper), (CAMERA, inks.ink)] {
        let outline = [
            [x, y + 1.2 * half],
            [x - 1.15 * half, y - 0.8 * half],
            [x + 1.15 * half, y - 0.8 * half],
        ];
        pen.area(&outline, colour, 1.0);
    }
}

pub(super) fn middle_mark(at: [f64; 2], colour: [u8; 3], pen: &mut Pen) {
    pen.marker(at, Marker::Cross, MIDDLE, colour);
}

/// A line of a footprint for the legend.
pub(super) fn sample(from: [f64; 2], to: [f64; 2], colour: [u8; 3], dash: Dash, pen: &mut Pen) {
    pen.area(
        &[from, [to[0], from[1]], to, [from[0], to[1]]],
        colour,
        SHADE,
    );
    let closed = [from, [to[0], from[1]], to, [from[0], to[1]], from];
    pen.line(&closed, colour, OUTLINE, dash);
}

/// Closed, on the drawing.
fn outline(photo: &PlanPhoto, frame: &MapFrame) -> Vec<[f64; 2]> {
    let points = photo.outline.iter().chain(photo.outline.first());
    points.map(|point| frame.place(*point)).collect()
}

fn overlap(a: &clip::Box2, b: &clip::Box2) -> bool {
    (0..2).all(|i| a[0][i] < b[1][i] && b[0][i] < a[1][i])
}

pub(super) fn shortened(name: &str) -> String {
    match name.chars().count() > LONGEST {
        true => name.chars().take(LONGEST - 1).chain(['…']).collect(),
        false => name.to_owned(),
    }
}
