//! Footprints, cameras and names within a frame, as shapes.

use super::inks::dash;
use super::{MapFrame, Plan, PlanInks, PlanPhoto, clip};
use crate::drawing::{Anchor, Dash, Marker, Pen, png};

/// Height of a name's line, units.
pub(crate) const NAME: f64 = 13.5;
/// Of a footprint's outline.
const OUTLINE: f64 = 1.6;
const SHADE: f64 = 0.10;
/// Half the width of the mark of a camera.
pub(super) const CAMERA: f64 = 3.6;
/// Half the width of the mark of a photo's middle.
pub(super) const MIDDLE: f64 = 3.4;
/// From a photo's middle to its name.
const BESIDE: f64 = MIDDLE + 4.0;
/// What is left beside a name.
const AROUND: f64 = 2.0;
/// Fonts of viewers are wider than ours by no more.
const WIDER: f64 = 1.06;
/// What is behind a name.
const BEHIND: f64 = 0.72;
/// Longer names are cut.
const LONGEST: usize = 40;

/// Where names may stand, units of the drawing.
#[derive(Debug, Clone, PartialEq)]
pub struct RoomForNames {
    /// What is seen of the drawing: least and greatest x and y.
    pub sight: [[f64; 2]; 2],
    /// What lies over the map there, such as a scale bar.
    pub covered: Vec<[[f64; 2]; 2]>,
}

impl RoomForNames {
    /// All of a frame.
    pub(crate) fn all_of(frame: &MapFrame) -> Self {
        let ([left, top], [width, height]) = (frame.at, frame.size);
        Self {
            sight: [[left, top], [left + width, top + height]],
            covered: Vec::new(),
        }
    }

    fn has(&self, [min, max]: &clip::Box2) -> bool {
        let [least, greatest] = self.sight;
        let is_seen = (0..2).all(|i| min[i] >= least[i] && max[i] <= greatest[i]);
        is_seen && !self.covered.iter().any(|box2| overlap(box2, &[*min, *max]))
    }

    /// Where the name of a photo may stand whole: right of its middle, or else left of it, and no higher or lower
    /// than what is seen. Nowhere where the middle is not seen: a name that is cut is the name of another photo.
    fn places(&self, [x, y]: [f64; 2], long: f64) -> [Option<Place>; 2] {
        if !self.has(&[[x, y], [x, y]]) {
            return [None, None];
        }
        let half = NAME / 2.0;
        let ([_, top], [_, bottom]) = (self.sight[0], self.sight[1]);
        let y = y.min(bottom - half).max(top + half);
        [(Anchor::Left, 1.0), (Anchor::Right, -1.0)].map(|(anchor, side)| {
            let at = x + side * BESIDE;
            let ends = [at - side * AROUND, at + side * (long + AROUND)];
            let [left, right] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            let place = [[left, y - half], [right, y + half]];
            self.has(&place).then_some((anchor, [at, y], place))
        })
    }
}

/// Which end of a name is where, and what the name takes.
type Place = (Anchor, [f64; 2], clip::Box2);

fn around([x, y]: [f64; 2], half: f64) -> clip::Box2 {
    [[x - half, y - half], [x + half, y + half]]
}

/// Everything about photos, and what was measured.
pub(super) fn draw(
    plan: &Plan,
    frame: &MapFrame,
    room: &RoomForNames,
    inks: &PlanInks,
    pen: &mut Pen,
) {
    footprints(plan, frame, FootprintStyle::default(), inks, pen);
    for outline in &plan.measured {
        let first = outline.points.first().filter(|_| outline.is_polygon);
        let points = outline.points.iter().chain(first);
        let points: Vec<[f64; 2]> = points.map(|point| frame.place(*point)).collect();
        for part in clip::line(&points, bounds(frame)) {
            measured_line(&part, inks, pen);
        }
    }
    marks_and_names(plan, frame, room, inks, pen);
}

/// How strong footprints are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FootprintStyle {
    /// Width of an outline.
    pub(crate) outline: f64,
    /// Opacity of what is inside; 0 to 1.
    pub(crate) shade: f64,
}

impl Default for FootprintStyle {
    fn default() -> Self {
        Self {
            outline: OUTLINE,
            shade: SHADE,
        }
    }
}

fn bounds(frame: &MapFrame) -> clip::Box2 {
    let ([left, top], [width, height]) = (frame.at, frame.size);
    [[left, top], [left + width, top + height]]
}

/// What each photo shows, within a frame.
pub(crate) fn footprints(
    plan: &Plan,
    frame: &MapFrame,
    style: FootprintStyle,
    inks: &PlanInks,
    pen: &mut Pen,
) {
    let bounds = bounds(frame);
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
        if style.shade > 0.0 {
            pen.area(&clip::area(open, bounds), colour, style.shade);
        }
    }
    // Outlines over all the shades.
    for (photo, outline) in plan.photos.iter().zip(&outlines) {
        let colour = inks.of(photo.verdict);
        for part in clip::line(outline, bounds) {
            pen.line(&part, colour, style.outline, dash(photo.verdict));
        }
    }
}

/// Where each photo was taken from, the middle of what it shows, and its name where that has room.
pub(crate) fn marks_and_names(
    plan: &Plan,
    frame: &MapFrame,
    room: &RoomForNames,
    inks: &PlanInks,
    pen: &mut Pen,
) {
    let [[left, top], [right, bottom]] = bounds(frame);
    let inside = |[x, y]: [f64; 2], room: f64| {
        x >= left + room && x <= right - room && y >= top + room && y <= bottom - room
    };
    let mut marks: Vec<(usize, clip::Box2)> = Vec::new();
    for (index, photo) in plan.photos.iter().enumerate() {
        let camera = frame.place(photo.camera);
        if inside(camera, CAMERA) {
            camera_mark(camera, inks, pen);
            marks.push((index, around(camera, CAMERA)));
        }
        let middle = photo.middle.map(|middle| frame.place(middle));
        if let Some(middle) = middle.filter(|middle| inside(*middle, MIDDLE)) {
            middle_mark(middle, inks.of(photo.verdict), pen);
            marks.push((index, around(middle, MIDDLE)));
        }
    }
    // Names over all marks, and on none but their own photo's.
    let mut taken: Vec<clip::Box2> = Vec::new();
    for (index, photo) in plan.photos.iter().enumerate() {
        let Some(middle) = photo.middle.map(|middle| frame.place(middle)) else {
            continue;
        };
        let name = shortened(&photo.name);
        let long = png::text_width(NAME, &name) * WIDER;
        let others = marks.iter().filter(|(of, _)| *of != index);
        let others: Vec<&clip::Box2> = others.map(|(_, mark)| mark).chain(&taken).collect();
        let is_free = |place: &clip::Box2| !others.iter().any(|other| overlap(other, place));
        let places = room.places(middle, long).into_iter().flatten();
        let free = places.into_iter().find(|(.., place)| is_free(place));
        if let Some((anchor, at, place)) = free {
            let [[a, b], [c, d]] = place;
            pen.area(&[[a, b], [c, b], [c, d], [a, d]], inks.paper, BEHIND);
            pen.text(at, NAME, &name, anchor, inks.ink);
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

pub(crate) fn camera_mark(at: [f64; 2], inks: &PlanInks, pen: &mut Pen) {
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

pub(crate) fn middle_mark(at: [f64; 2], colour: [u8; 3], pen: &mut Pen) {
    pen.marker(at, Marker::Cross, MIDDLE, colour);
}

/// A line of a footprint for the legend.
pub(crate) fn sample(from: [f64; 2], to: [f64; 2], colour: [u8; 3], dash: Dash, pen: &mut Pen) {
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

/// Whether two rectangles have a part in common.
pub(crate) fn overlap(a: &clip::Box2, b: &clip::Box2) -> bool {
    (0..2).all(|i| a[0][i] < b[1][i] && b[0][i] < a[1][i])
}

pub(crate) fn shortened(name: &str) -> String {
    match name.chars().count() > LONGEST {
        true => name.chars().take(LONGEST - 1).chain(['…']).collect(),
        false => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::drawing::Shape;
    use crate::plan::tests::{MIDDLE, plan};

    /// Wherever photos lie in what is seen, their names stand whole in it and beside what covers the map, within a
    /// line's height of their middles; a photo out of sight has none.
    #[test]
    fn names_are_whole_or_not_there() {
        let mut plan = plan(0.0, None);
        let frame = MapFrame::around(MIDDLE, [0.0, 0.0], [520.0, 390.0], 10.0);
        let room = RoomForNames {
            sight: [[60.0, 45.0], [460.0, 345.0]],
            covered: vec![[[380.0, 300.0], [460.0, 345.0]]],
        };
        let mut photo = plan.photos[0].clone();
        photo.outline.clear();
        let inside = |[x, y]: [f64; 2], [min, max]: [[f64; 2]; 2]| {
            x >= min[0] && x <= max[0] && y >= min[1] && y <= max[1]
        };
        let mut sides = [0, 0];
        for step in 0..600 {
            // All over the drawing, and beside it.
            let [x, y] = [
                f64::from(step % 30) * 19.0 - 10.0,
                f64::from(step / 30) * 21.0 - 10.0,
            ];
            let middle = frame.point([x, y]);
            photo.middle = Some(middle);
            photo.camera = middle + DVec2::splat(1e6);
            plan.photos = vec![photo.clone()];
            let mut pen = Pen::default();
            draw(&plan, &frame, &room, &PlanInks::PAPER, &mut pen);
            let name = pen.shapes.iter().find_map(|shape| match shape {
                Shape::Text {
                    at,
                    anchor,
                    text,
                    size,
                    ..
                } => {
                    let long = png::text_width(*size, text);
                    let right = *anchor == Anchor::Left;
                    let left = if right { at[0] } else { at[0] - long };
                    let (top, bottom) = (at[1] - size / 2.0, at[1] + size / 2.0);
                    Some((right, [[left, top], [left + long, bottom]]))
                }
                _ => None,
            });
            let seen = inside([x, y], room.sight) && !inside([x, y], room.covered[0]);
            let Some((right, [min, max])) = name else {
                assert!(!seen, "the photo at {x}, {y} has no name");
                continue;
            };
            assert!(seen, "{x}, {y} is not seen, its name is");
            for corner in [min, max, [min[0], max[1]], [max[0], min[1]]] {
                assert!(
                    inside(corner, room.sight),
                    "{corner:?} of the name of {x}, {y}"
                );
                assert!(
                    !inside(corner, room.covered[0]),
                    "{corner:?} of {x}, {y} is covered"
                );
            }
            assert!(((min[1] + max[1]) / 2.0 - y).abs() <= 14.0 / 2.0);
            sides[usize::from(right)] += 1;
        }
        assert!(sides[0] > 20 && sides[1] > 100, "{sides:?}");
    }
}
