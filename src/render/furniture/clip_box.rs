//! The edges of the clipping box.

use glam::DVec2;

use super::photo_lines::ink;
use crate::primitives::lines::{Pen, Stroke};
use crate::show::Show;
use crate::view::View;

/// Of the edges.
const COLOR: [u8; 3] = [240, 190, 40];

/// The edges that are before the eye, in pixels of the picture; over everything.
pub(super) fn strokes(view: &View, show: &Show, size: DVec2) -> Vec<Stroke> {
    let Some(clip) = show.clip else {
        return Vec::new();
    };
    let rim = ink(show).map(|channel| 255 - channel);
    let pens = [
        Pen::new(rim, 3.0).pale(0.35),
        Pen::new(COLOR, 1.2).pale(0.9),
    ];
    let ends = clip.edges().into_iter().filter_map(|edge| {
        let [from, to] = edge.map(|end| view.project(end, size));
        Some((from?.extend(0.0), to?.extend(0.0)))
    });
    let ends: Vec<_> = ends.collect();
    pens.iter()
        .flat_map(|pen| ends.iter().map(|&(from, to)| pen.line(from, to)))
        .collect()
}
