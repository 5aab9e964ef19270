//! Lines and polygons that are drawn on the surface to measure there.

use glam::{DVec2, DVec3};

use super::measured::MEASURED;
use super::photo_lines::ink;
use crate::primitives::lines::{Pen, Stroke};
use crate::show::Show;
use crate::view::View;

/// The lines and their points, in pixels of the picture; over everything, wherever the points are.
pub(super) fn strokes(view: &View, show: &Show, size: DVec2) -> Vec<Stroke> {
    let place = |point: DVec3| Some(view.project(point, size)?.extend(0.0));
    let rim = ink(show).map(|channel| 255 - channel);
    let pens = [Pen::new(rim, 4.5).pale(0.55), Pen::new(MEASURED, 2.0)];
    let mut strokes = Vec::new();
    for line in show.planned_lines.iter() {
        for pen in [
            Pen::new(rim, line.width + 2.0).pale(0.45),
            Pen::new(line.color, line.width),
        ] {
            for ends in line.points.windows(2) {
                if let (Some(from), Some(to)) = (place(ends[0]), place(ends[1])) {
                    strokes.push(pen.line(from, to));
                }
            }
        }
    }
    for pen in pens {
        for line in &show.drawn_lines {
            for ends in line.windows(2) {
                // What is behind the eye has no place in the picture.
                if let (Some(from), Some(to)) = (place(ends[0]), place(ends[1])) {
                    strokes.push(pen.line(from, to));
                }
            }
        }
        let dot = Pen {
            width: pen.width + 6.0,
            ..pen
        };
        let dots = show.drawn_points.iter().filter_map(|&point| place(point));
        strokes.extend(dots.map(|place| dot.dot(place)));
    }
    strokes
}
