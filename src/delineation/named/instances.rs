//! Fragments that a network gives one by one: masks, each with a score.
//!
//! A photo is seen in parts and sizes, and so a fragment more than once. One that reaches the edge of a part, where the
//! photo goes on, is left to a part or a size that shows it whole. Of two that share more than half (of both together) the
//! one with the greater score stays (non-maximum suppression). Where two still overlap, the smaller lies on top, as in
//! masks of other tools.

use std::ops::Range;

use super::outputs::Mask;
use crate::labels::{FINES, LabelImage};
use crate::network::Part;

/// Of both together.
const SAME: f64 = 0.5;

/// How often masks may cover a photo.
const MOST_COVERS: usize = 100;

/// A fragment in the photo at its full size.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Instance {
    pub(super) score: f64,
    columns: Range<usize>,
    rows: Range<usize>,
    /// Row by row of those.
    is_in: Vec<bool>,
    pixels: usize,
}

/// Where a part lies: in a photo of this size, which is the full one made smaller.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen<'a> {
    pub(super) part: &'a Part,
    /// Of the smaller photo.
    pub(super) size: [usize; 2],
    /// Of the full one.
    pub(super) full: [usize; 2],
}

impl Seen<'_> {
    /// The fragment of a mask. `None` where it is empty or cut by the part's edge.
    pub(super) fn instance(&self, mask: &Mask) -> Option<Instance> {
        let part = self.part;
        let [columns, rows] = mask.of;
        let is_in = |x: usize, y: usize| {
            let inside = mask.columns.contains(&x) && mask.rows.contains(&y);
            let place = || (y - mask.rows.start) * mask.columns.len() + x - mask.columns.start;
            inside && mask.chances.get(place()).is_some_and(|of| *of > 0.5)
        };
        // Its extent in the mask.
        let (mut left, mut right, mut top, mut bottom) = (columns, 0, rows, 0);
        for y in mask.rows.clone() {
            for x in mask.columns.clone().filter(|x| is_in(*x, y)) {
                (left, right) = (left.min(x), right.max(x + 1));
                (top, bottom) = (top.min(y), bottom.max(y + 1));
            }
        }
        if left >= right {
            return None;
        }
        let goes_on = [
            (left == 0, part.first > 0),
            (top == 0, part.above > 0),
            (right == columns, part.first + part.columns < self.size[0]),
            (bottom == rows, part.above + part.rows < self.size[1]),
        ];
        if goes_on
            .iter()
            .any(|(reaches, goes_on)| *reaches && *goes_on)
        {
            return None;
        }
        // From pixels of the full photo to those of the mask.
        let along = |at: usize, size: usize, full: usize, first: usize, seen: usize, own: usize| {
            let small = (at as f64 + 0.5) * size as f64 / full as f64 - first as f64;
            small * own as f64 / seen as f64
        };
        let x_of = |x| {
            along(
                x,
                self.size[0],
                self.full[0],
                part.first,
                part.columns,
                columns,
            )
        };
        let y_of = |y| along(y, self.size[1], self.full[1], part.above, part.rows, rows);
        let range = |of: &dyn Fn(usize) -> f64, full: usize, from: usize, to: usize| {
            // Places grow with pixels.
            let pixels: Vec<usize> = (0..full).collect();
            let first = pixels.partition_point(|at| of(*at) < from as f64);
            let last = pixels.partition_point(|at| of(*at) < to as f64);
            first..last
        };
        let across = range(&x_of, self.full[0], left, right);
        let down = range(&y_of, self.full[1], top, bottom);
        let mut bits = Vec::with_capacity(across.len() * down.len());
        for y in down.clone() {
            let row = y_of(y) as usize;
            bits.extend(across.clone().map(|x| is_in(x_of(x) as usize, row)));
        }
        let pixels = bits.iter().filter(|is_in| **is_in).count();
        (pixels > 0).then_some(Instance {
            score: mask.score,
            columns: across,
            rows: down,
            is_in: bits,
            pixels,
        })
    }
}

impl Instance {
    fn is_at(&self, x: usize, y: usize) -> bool {
        let place = (y - self.rows.start) * self.columns.len() + x - self.columns.start;
        self.is_in.get(place).copied().unwrap_or(false)
    }

    /// Whether it shares more than half of both together with another one.
    fn is_same(&self, other: &Self) -> bool {
        let shared = |a: &Range<usize>, b: &Range<usize>| a.start.max(b.start)..a.end.min(b.end);
        let columns = shared(&self.columns, &other.columns);
        let rows = shared(&self.rows, &other.rows);
        // No more than what both extents share.
        let most = columns.len() * rows.len();
        let is_enough =
            |both: usize| both as f64 > SAME * (self.pixels + other.pixels - both) as f64;
        if !is_enough(most.min(self.pixels).min(other.pixels)) {
            return false;
        }
        let both = rows.map(|y| {
            let columns = columns.clone();
            columns
                .filter(|x| self.is_at(*x, y) && other.is_at(*x, y))
                .count()
        });
        is_enough(both.sum())
    }
}

/// All fragments that were found, as long as they do not cover the photo too often.
#[derive(Debug, Default)]
pub(super) struct Instances {
    found: Vec<Instance>,
    bits: usize,
}

impl Instances {
    /// One more; `false` where there are too many.
    pub(super) fn add(&mut self, instance: Instance, pixels: usize) -> bool {
        self.bits += instance.is_in.len();
        self.found.push(instance);
        self.bits <= MOST_COVERS * pixels.max(1)
    }

    /// The label image, and the score of each fragment in the order of their numbers.
    pub(super) fn painted(mut self, width: usize, height: usize) -> (LabelImage, Vec<f64>) {
        self.found.sort_by(|a, b| b.score.total_cmp(&a.score));
        let mut kept: Vec<Instance> = Vec::new();
        for instance in self.found {
            if !kept.iter().any(|other| instance.is_same(other)) {
                kept.push(instance);
            }
        }
        kept.sort_by_key(|found| std::cmp::Reverse(found.pixels));
        let mut labels = vec![FINES; width * height];
        for (number, instance) in (1..).zip(&kept) {
            for y in instance.rows.clone() {
                for x in instance.columns.clone().filter(|x| instance.is_at(*x, y)) {
                    if let Some(label) = labels.get_mut(y * width + x) {
                        *label = number;
                    }
                }
            }
        }
        let labels = LabelImage {
            width,
            height,
            labels,
        };
        (labels, kept.iter().map(|of| of.score).collect())
    }
}
