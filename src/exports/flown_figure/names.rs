//! Names beside marks, where they have room: none over another, or over the mark of another.

use super::style::{INK, MARK, NAME};
use crate::drawing::{Anchor, Pen, png};
use crate::plan::clip::Box2;
use crate::plan::photos::{overlap, shortened};

/// Fonts of viewers are wider than ours by no more.
pub(super) const WIDER: f64 = 1.06;
/// From a mark to its name.
const BESIDE: f64 = MARK + 4.0;
/// From the figure's side to a name.
const FROM_SIDE: f64 = 4.0;
/// Marks nearer than this are one.
const SAME: f64 = 0.01;

/// What is free for names, CSS pixels.
pub(super) struct NamesRoom {
    marks: Vec<[f64; 2]>,
    taken: Vec<Box2>,
    named: Vec<[f64; 2]>,
    /// The figure's width.
    wide: f64,
}

impl NamesRoom {
    /// All of a figure of this width beside its marks.
    pub(super) fn beside(marks: Vec<[f64; 2]>, wide: f64) -> Self {
        Self {
            marks,
            taken: Vec::new(),
            named: Vec::new(),
            wide,
        }
    }

    /// Leaves a place to something else.
    pub(super) fn take(&mut self, place: Box2) {
        self.taken.push(place);
    }

    /// Writes the name of a mark right of it, left of it, above or below; nowhere, where all of these are taken. Once:
    /// a mark that has its name is passed over.
    pub(super) fn name(&mut self, mark: [f64; 2], name: &str, pen: &mut Pen) {
        let is_it = |other: &[f64; 2]| (0..2).all(|axis| (other[axis] - mark[axis]).abs() < SAME);
        if self.named.iter().any(is_it) {
            return;
        }
        let name = shortened(name);
        let long = png::text_width(NAME, &name) * WIDER;
        let half = NAME / 2.0;
        let [x, y] = mark;
        let places = [
            [x + BESIDE, y],
            [x - BESIDE - long, y],
            [x - long / 2.0, y - BESIDE - half],
            [x - long / 2.0, y + BESIDE + half],
        ];
        let around = |[left, y]: [f64; 2]| [[left - 1.0, y - half], [left + long + 1.0, y + half]];
        let is_free = |place: &[f64; 2]| {
            let place = around(*place);
            let on_mark = |other: &[f64; 2]| {
                let low = other.map(|at| at - MARK);
                let high = other.map(|at| at + MARK);
                !is_it(other) && overlap(&place, &[low, high])
            };
            let inside = place[0][0] > FROM_SIDE && place[1][0] < self.wide - FROM_SIDE;
            inside
                && !self.marks.iter().any(on_mark)
                && !self.taken.iter().any(|taken| overlap(&place, taken))
        };
        if let Some(at) = places.into_iter().find(is_free) {
            let [[left, top], [right, bottom]] = around(at);
            let behind = [[left, top], [right, top], [right, bottom], [left, bottom]];
            pen.area(&behind, [255; 3], 0.7);
            pen.text(at, NAME, &name, Anchor::Left, INK);
            self.taken.push(around(at));
            self.named.push(mark);
        }
    }
}
