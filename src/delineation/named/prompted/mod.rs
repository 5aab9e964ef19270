//! A network that is asked for one fragment at a time, as Segment Anything is (Kirillov et al. 2023).
//!
//! It comes in two files: an encoder sees a part of the photo once; a decoder is given what it saw and a place in the
//! part (a prompt), and answers with a few masks of what lies there (a whole, a part of it, a part of that) and how good it
//! takes each to be. The best one is a fragment; what the parts and sizes found is sorted out with all other instances
//! (`instances.rs`). Where to ask another engine says (`places.rs`).
//!
//! The decoder's inputs are known by the names of the usual exports: Meta's (also MobileSAM's and SAM 2's), which ask one
//! place at a time, and Hugging Face's, which ask many (`decoder.rs`).

mod decoder;
mod places;
#[cfg(test)]
mod tests;

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use image::RgbImage;
use rten::Model;

pub(super) use decoder::Decoder;
pub(super) use places::{Places, SeenAt};

use super::description::PromptsEntry;
use crate::engine::Engine;

/// What SAM's own generator of masks asks of one (`SamAutomaticMaskGenerator`, `pred_iou_thresh`).
pub(super) const LEAST_SCORE: f64 = 0.88;

/// The decoder, and where it is asked.
pub(super) struct Prompted {
    pub(super) decoder: Decoder,
    from: &'static dyn Engine,
    grid: usize,
}

impl Prompted {
    /// Of the decoder's bytes and the encoder that it belongs to.
    ///
    /// # Errors
    /// What of it cannot be run, or does not fit the encoder.
    pub(super) fn new(
        bytes: Vec<u8>,
        encoder: &Model,
        entry: &PromptsEntry,
    ) -> Result<Self, Fault> {
        Ok(Self {
            decoder: Decoder::new(bytes, encoder, entry)?,
            from: entry.engine()?,
            grid: entry.grid(),
        })
    }

    /// Where to ask in a photo.
    ///
    /// # Errors
    /// Those of the engine that says so.
    pub(super) fn places(&self, photo: &RgbImage, progress: &Progress) -> Result<Places, Fault> {
        Places::of(self.from, photo, self.grid, progress)
    }
}
