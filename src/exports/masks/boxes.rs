//! The least rectangle about each fragment.

use std::collections::BTreeMap;

use super::trace::runs;
use crate::delineation::{FINES, LabelImage};

/// Where the pixels of a label lie.
#[derive(Debug, Clone, Copy)]
pub(super) struct Box {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) width: usize,
    pub(super) height: usize,
    /// How many pixels of it have the label.
    pub(super) pixels: usize,
}

/// Of each label but fines its box, by label; what is no rock comes last.
pub(super) fn boxes(image: &LabelImage) -> BTreeMap<u32, Box> {
    let mut boxes: BTreeMap<u32, Box> = BTreeMap::new();
    for (y, row) in image.labels.chunks_exact(image.width.max(1)).enumerate() {
        for (label, columns) in runs(row) {
            if label == FINES {
                continue;
            }
            let known = boxes.entry(label).or_insert(Box {
                left: columns.start,
                top: y,
                width: 0,
                height: 0,
                pixels: 0,
            });
            let right = columns.end.max(known.left + known.width);
            known.left = known.left.min(columns.start);
            known.width = right - known.left;
            known.height = y + 1 - known.top;
            known.pixels += columns.len();
        }
    }
    boxes
}

/// How many pixels are of other labels and how many of this one, in turns, others first. `places` goes through the pixels.
pub(super) fn counts(
    image: &LabelImage,
    label: u32,
    places: impl Iterator<Item = usize>,
) -> Vec<u32> {
    let mut counts = vec![0];
    let mut is_inside = false;
    for place in places {
        if (image.labels[place] == label) != is_inside {
            counts.push(0);
            is_inside = !is_inside;
        }
        if let Some(last) = counts.last_mut() {
            *last += 1;
        }
    }
    counts
}
