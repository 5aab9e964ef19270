//! The label image: what each pixel of the undistorted photo belongs to.
//!
//! It lies this far down because all of the house speaks of it: files of other tools are read into one,
//! engines make one, editing changes it, and exports write it.
//!
//! [`Outlines`] are a label image and how sure each fragment is. A person's edit of them is a [`Change`]
//! (`editing.rs`), which is done and undone by [`Editing`] for ever.

mod changes;
mod editing;
mod outlines;
mod parts;
mod polygon;
mod strokes;

pub use changes::{Change, Painting};
pub use outlines::{Editing, Outlines};
pub use polygon::{spans_of_rings, spans_within};

/// Rock too fine to be a fragment of its own in this photo, and the ground between fragments.
pub const FINES: u32 = 0;

/// Sky, machines, scale objects, what the engineer left out.
pub const NOT_ROCK: u32 = u32::MAX;

/// A label for each pixel, row by row from the top left: [`FINES`], [`NOT_ROCK`], or a fragment's
/// number, from 1. An engine numbers without gaps; editing and other tools leave some.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LabelImage {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The labels.
    pub labels: Vec<u32>,
}

impl LabelImage {
    /// The greatest number of a fragment: how many there are where no number is left out.
    pub fn fragments(&self) -> usize {
        let labels = self.labels.iter().filter(|label| **label != NOT_ROCK);
        labels.max().map_or(0, |most| *most as usize)
    }

    /// Of fines, then of each fragment, the pixels.
    pub fn areas(&self) -> Vec<usize> {
        let mut areas = vec![0; self.fragments() + 1];
        for label in &self.labels {
            if let Some(area) = areas.get_mut(*label as usize) {
                *area += 1;
            }
        }
        areas
    }
}

#[cfg(test)]
mod tests;
