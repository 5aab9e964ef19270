//! Fragments that a network gives one by one: masks, each with a score.
//!
//! A photo is seen in parts and sizes, and so a fragment more than once. One that reaches the edge of a part, where the
//! photo goes on, is left to a part or a size that shows it whole. Of two that share more than half (of both together) the
//! one with the greater score stays (non-maximum suppression). Where two still overlap, the smaller lies on top, as in
//! masks of other tools. What is asked place by place answers with heaps of fragments, too; those are left out.

use std::ops::Range;

use super::outputs::Mask;
use crate::labels::{FINES, LabelImage};
use crate::network::Part;

/// Of both together.
const SAME: f64 = 0.5;

/// So many fragments within another one make it a heap; two may be the faces of one stone.
const HEAP: usize = 3;

/// Of a fragment's pixels that lie within another one.
const WITHIN: f64 = 0.8;

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
        let columns = overlap(&self.columns, &other.columns);
        let rows = overlap(&self.rows, &other.rows);
        // No more than what both extents share.
        let most = columns.len() * rows.len();
        let is_enough =
            |both: usize| both as f64 > SAME * (self.pixels + other.pixels - both) as f64;
        if !is_enough(most.min(self.pixels).min(other.pixels)) {
            return false;
        }
        is_enough(self.shared(other))
    }

    /// The pixels that both have.
    fn shared(&self, other: &Self) -> usize {
        let columns = overlap(&self.columns, &other.columns);
        let both = overlap(&self.rows, &other.rows).map(|y| {
            let columns = columns.clone();
            columns
                .filter(|x| self.is_at(*x, y) && other.is_at(*x, y))
                .count()
        });
        both.sum()
    }
}

fn overlap(a: &Range<usize>, b: &Range<usize>) -> Range<usize> {
    a.start.max(b.start)..a.end.min(b.end)
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

    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// Whether it is there already, with at least its score.
    pub(super) fn has_surer(&self, instance: &Instance) -> bool {
        let mut found = self.found.iter();
        found.any(|other| other.score >= instance.score && instance.is_same(other))
    }

    /// Leaves out what is no fragment but a heap of them: of which others, [`HEAP`] at least, cover more than half.
    pub(super) fn leave_out_heaps(&mut self) {
        let is_heap = |heap: &Instance| {
            let others = self.found.iter();
            let within = others.filter(|other| {
                other.pixels < heap.pixels / 2
                    && heap.shared(other) as f64 > WITHIN * other.pixels as f64
            });
            let within: Vec<&Instance> = within.collect();
            let covered = |x: usize, y: usize| {
                within.iter().any(|other| {
                    other.columns.contains(&x) && other.rows.contains(&y) && other.is_at(x, y)
                })
            };
            within.len() >= HEAP && {
                let places = heap.rows.clone().flat_map(|y| {
                    let columns = heap.columns.clone();
                    columns.map(move |x| (x, y))
                });
                let own = places.filter(|(x, y)| heap.is_at(*x, *y));
                own.filter(|(x, y)| covered(*x, *y)).count() * 2 > heap.pixels
            }
        };
        let heaps: Vec<bool> = self.found.iter().map(is_heap).collect();
        let mut is_heap = heaps.into_iter();
        self.found.retain(|_| !is_heap.next().unwrap_or(false));
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A mask about three others that cover most of it is a heap; one about two, or about three that cover little, is none.
    #[test]
    fn heaps_are_left_out() {
        let part = Part {
            left: 0,
            top: 0,
            right: 64,
            bottom: 64,
            first: 0,
            above: 0,
            columns: 64,
            rows: 64,
        };
        let seen = Seen {
            part: &part,
            size: [64; 2],
            full: [64; 2],
        };
        let mut all = Instances::default();
        let mut add = |columns: std::ops::Range<usize>, rows: std::ops::Range<usize>| {
            let chances = vec![1.0; columns.len() * rows.len()];
            let mask = Mask {
                of: [64; 2],
                columns,
                rows,
                chances,
                score: 0.9,
            };
            let instance = seen.instance(&mask).unwrap();
            assert!(!all.has_surer(&instance));
            assert!(all.add(instance.clone(), 64 * 64));
            assert!(all.has_surer(&instance));
        };
        // A heap of three stones of 10 x 16, two faces in one, and three small stones on a large one.
        add(0..32, 0..16);
        [0..10, 11..21, 22..32]
            .into_iter()
            .for_each(|x| add(x, 0..16));
        add(0..30, 20..40);
        [0..14, 16..30].into_iter().for_each(|x| add(x, 20..40));
        add(0..40, 44..64);
        [0..10, 12..22, 24..34]
            .into_iter()
            .for_each(|x| add(x, 50..60));
        all.leave_out_heaps();
        let (labels, sure) = all.painted(64, 64);
        assert_eq!(sure.len(), 3 + 3 + 4);
        assert_eq!(labels.labels[10], FINES, "between the stones of the heap");
        assert_ne!(labels.labels[30 * 64 + 15], FINES, "between the faces");
        assert_ne!(labels.labels[62 * 64 + 2], FINES);
    }
}
