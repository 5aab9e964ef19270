//! What finds the borders of fragments in a photo.

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use image::RgbImage;

use crate::choice::Scorer;
use crate::evidence::Evidence;
use crate::labels::LabelImage;

/// Fragments as an engine outlines them.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlined {
    /// Numbered without gaps.
    pub labels: LabelImage,
    /// How sure each is, 0 to 1, in the order of their numbers.
    pub sure: Vec<f64>,
}

/// Finds the borders of fragments in a photo, offline.
pub trait Engine: Send + Sync {
    /// As it is named on the command line and in files.
    fn name(&self) -> &str;

    /// What it sees in an undistorted photo.
    ///
    /// # Errors
    /// Where the photo is none that it can take, or on cancel.
    fn look(&self, photo: &RgbImage, progress: &Progress) -> Result<Evidence, Fault>;

    /// The fragments themselves, of an engine that gives them one by one and not borders; `None` of all others.
    ///
    /// # Errors
    /// As [`Engine::look`].
    fn outline(&self, _photo: &RgbImage, _progress: &Progress) -> Result<Option<Outlined>, Fault> {
        Ok(None)
    }

    /// How many pixels of a photo of that size, along a side, are one to the engine: of a large photo it may look
    /// at a smaller one.
    fn sees_every(&self, _width: u32, _height: u32) -> u32 {
        1
    }

    /// What a score must exceed for its node to be a fragment. Lower finds more of them and more that are none.
    fn least_score(&self) -> f64;

    /// How much of the area that it leaves without an outline is fines and not fragments that it did not find, as
    /// measured on simulated piles.
    fn fines_of_unfound(&self) -> f64;

    /// How many times the sieves' its sizes are, as measured on simulated piles: what it joins and what it does not find makes
    /// them too large.
    fn sizes_off(&self) -> f64 {
        1.0
    }

    /// The standard errors of all its sizes together, relative, and of [`Engine::fines_of_unfound`], as measured on
    /// simulated piles.
    fn doubts(&self) -> [f64; 2];

    /// What tells fragments from other regions by its evidence.
    ///
    /// # Errors
    /// Where its numbers cannot be read.
    fn scorer(&self) -> Result<&Scorer, Fault>;
}
