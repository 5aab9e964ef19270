//! What finds the borders of fragments in a photo, and how it errs.

mod habits;

pub use habits::Habits;
pub(crate) use habits::LEAST_PIXELS_ACROSS;

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

    /// What a score must exceed for its node to be a fragment. Lower finds more of them and more that are none.
    fn least_score(&self) -> f64;

    /// How it errs in a photo of that size.
    fn habits(&self, width: u32, height: u32) -> Habits;

    /// What tells fragments from other regions by its evidence.
    ///
    /// # Errors
    /// Where its numbers cannot be read.
    fn scorer(&self) -> Result<&Scorer, Fault>;
}
