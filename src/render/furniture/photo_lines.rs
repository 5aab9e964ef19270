//! The lines that photos are drawn with: cameras, corner rays, outlines, the flight line.

use glam::DVec3;

use super::crowd::presence;
use crate::primitives::lines::{Pen, Stroke};
use crate::scene::photo_geometry::PhotoGeometry;
use crate::show::{Background, PhotoLook, Show};

/// Of the selected photo: no verdict has it.
pub const SELECTED: [u8; 3] = [178, 102, 255];
/// Of what fell back to the ground.
pub(crate) const GROUND: [u8; 3] = [226, 61, 61];
/// Dashes in the length of a ray; an outline has four times as many.
const DASHES: f64 = 24.0;

/// The strokes of all photos. `line` is the order that the flight line goes through them, `cameras` how deep
/// the image planes lie, world units; `looked_through` is the photo whose camera is the eye, which is not in
/// sight itself.
pub(crate) fn photo_lines(
    photos: &[PhotoGeometry],
    line: &[usize],
    looks: &[PhotoLook],
    show: &Show,
    cameras: f64,
    looked_through: Option<usize>,
) -> Vec<Stroke> {
    let mut strokes = Vec::new();
    if show.flight_line {
        let [r, g, b] = ink(show);
        let pen = Pen::new([r, g, b], 1.5).pale(0.6);
        let centers: Vec<DVec3> = line
            .iter()
            .filter_map(|&photo| Some(photos.get(photo)?.center))
            .collect();
        for pair in centers.windows(2) {
            strokes.push(pen.line(pair[0], pair[1]));
        }
    }
    // The selected photo last: over the others where they meet.
    let mut order: Vec<usize> = (0..photos.len()).collect();
    order.sort_by_key(|&index| (show.selected == Some(index), show.hovered == Some(index)));
    let presence = presence(photos, show);
    for index in order {
        let (photo, look, seen) = (&photos[index], looks[index], presence[index]);
        if !look.visible {
            continue;
        }
        let (color, weight) = if show.selected == Some(index) {
            (SELECTED, 1.6)
        } else if show.hovered == Some(index) {
            (toward(look.color, ink(show), 0.4), 1.5)
        } else {
            (look.color, 1.0)
        };
        let pen = Pen::new(color, 1.3 * weight).pale(seen);
        // The outline of the photo that one looks through is the picture's own edge.
        if looked_through == Some(index) {
            continue;
        }
        if show.outlines.holds(index, show) {
            outline(photo, pen, seen, &mut strokes);
        }
        if show.corner_rays.holds(index, show) {
            corner_rays(photo, pen, seen, show, &mut strokes);
        }
        if show.frusta.holds(index, show) {
            frustum(photo, pen, cameras, &mut strokes);
        }
    }
    strokes
}

/// A pyramid from the centre to the image plane, with a roof over the image's top edge.
fn frustum(photo: &PhotoGeometry, pen: Pen, depth: f64, strokes: &mut Vec<Stroke>) {
    let plane = photo.image_plane(depth);
    for i in 0..4 {
        strokes.push(pen.line(photo.center, plane[i]));
        strokes.push(pen.line(plane[i], plane[(i + 1) % 4]));
    }
    let [top_left, top_right, _, bottom_left] = plane;
    let roof = (top_left + top_right) * 0.5 + (top_left - bottom_left) * 0.22;
    let eaves = [
        top_left.lerp(top_right, 0.25),
        top_left.lerp(top_right, 0.75),
    ];
    strokes.push(pen.line(eaves[0], roof));
    strokes.push(pen.line(roof, eaves[1]));
}

/// Rays from the centre to the corner points, which get a dot; a ring on the ground.
fn corner_rays(photo: &PhotoGeometry, pen: Pen, seen: f64, show: &Show, strokes: &mut Vec<Stroke>) {
    for met in photo.corners.iter().flatten() {
        let length = met.point.distance(photo.center);
        let pen = if met.on_ground {
            Pen::new(GROUND, pen.width)
                .dashed(length / DASHES)
                .pale(seen)
        } else {
            pen
        };
        strokes.push(pen.pale(0.9).line(photo.center, met.point));
        let [r, g, b, _] = pen.color;
        let size = 4.0 + 2.0 * pen.width;
        strokes.push(Pen::new([r, g, b], size).pale(seen).dot(met.point));
        if met.on_ground {
            let inner = ink(show).map(|channel| 255 - channel);
            strokes.push(Pen::new(inner, size * 0.5).pale(seen).dot(met.point));
        }
    }
}

fn outline(photo: &PhotoGeometry, pen: Pen, seen: f64, strokes: &mut Vec<Stroke>) {
    let points = &photo.outline;
    let next = points.iter().cycle().skip(1);
    let stretches: Vec<(DVec3, DVec3, bool)> = points
        .iter()
        .zip(next)
        .filter_map(|(from, to)| {
            let (from, to) = ((*from)?, (*to)?);
            Some((from.point, to.point, from.on_ground || to.on_ground))
        })
        .collect();
    let length: f64 = stretches.iter().map(|(a, b, _)| a.distance(*b)).sum();
    let whole = Pen {
        width: pen.width * 1.25,
        ..pen
    };
    let fallen = Pen::new(GROUND, whole.width)
        .dashed(length / (4.0 * DASHES))
        .pale(seen);
    let mut along = 0.0;
    for (from, to, on_ground) in stretches {
        let pen = if on_ground { fallen } else { whole };
        strokes.push(pen.stroke(from, to, along));
        along += from.distance(to);
    }
}

/// How far the image planes lie from the centres so that cameras look well: neither do they touch
/// each other, nor do they reach far down to the surface. `extent` is the radius of everything.
pub(crate) fn camera_depth(photos: &[PhotoGeometry], extent: f64) -> f64 {
    let mut depths: Vec<f64> = photos
        .iter()
        .filter_map(|photo| photo.depth_of_share(0.0))
        .collect();
    let surface = crate::geometry::median(&mut depths).unwrap_or(extent * 0.5);
    // Hundreds of photos have millions of pairs: some are enough to know their distance.
    let step = (photos.len() / 64).max(1);
    let mut gaps: Vec<f64> = photos
        .iter()
        .enumerate()
        .step_by(step)
        .filter_map(|(i, photo)| {
            let others = photos.iter().enumerate().filter(|(j, _)| *j != i);
            others
                .map(|(_, other)| photo.center.distance(other.center))
                .min_by(f64::total_cmp)
        })
        .collect();
    let mut shapes: Vec<f64> = photos
        .iter()
        .map(|photo| f64::from(photo.camera.width) / photo.camera.fx)
        .collect();
    let shape = crate::geometry::median(&mut shapes).unwrap_or(1.0);
    let gap = crate::geometry::median(&mut gaps).unwrap_or(f64::INFINITY);
    (surface * 0.3).min(0.7 * gap / shape)
}

/// A colour that stands out from the background.
pub(crate) fn ink(show: &Show) -> [u8; 3] {
    match show.background {
        Background::Color([r, g, b])
            if 2 * u32::from(r) + 5 * u32::from(g) + u32::from(b) < 1024 =>
        {
            [226, 229, 233]
        }
        Background::Color(_) | Background::Transparent => [38, 42, 48],
    }
}

/// `share` of the way from one colour to another.
fn toward(from: [u8; 3], to: [u8; 3], share: f64) -> [u8; 3] {
    std::array::from_fn(|i| {
        let (a, b) = (f64::from(from[i]), f64::from(to[i]));
        // `as` saturates.
        (a + (b - a) * share).round() as u8
    })
}

/// The colour of a footprint's inside on the surface, and of its part on the ground.
pub(crate) fn fill_colors(look: PhotoLook, selected: bool) -> [[u8; 4]; 2] {
    let [r, g, b] = if selected { SELECTED } else { look.color };
    let [gr, gg, gb] = GROUND;
    let opacity = if selected { 64 } else { 40 };
    [[r, g, b, opacity], [gr, gg, gb, opacity / 2]]
}
