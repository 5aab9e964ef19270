//! What turns photos into poses and points.

use std::path::Path;

use crate::card::Card;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::photo_set::{LeftOut, PhotoSet};

use cumulus3d_core::Reconstruction;

/// Structure from motion by some program or library.
pub trait Engine {
    /// Its name and version, for reports.
    fn name(&self) -> String;

    /// Finds poses of photos and points of what they show, in a frame of its own. `pairs` are the places in
    /// `photos` of photos that may show the same.
    ///
    /// # Errors
    /// Where no two photos show the same, or the work was cancelled.
    fn reconstruct(
        &self,
        photos: &PhotoSet,
        pairs: &[[usize; 2]],
        at: &Workplace,
        progress: &Progress,
    ) -> Result<Found, Fault>;
}

/// Where an engine works.
#[derive(Debug, Clone, Copy)]
pub struct Workplace<'a> {
    /// A folder for what it keeps: a second run goes on from there.
    pub folder: &'a Path,
    /// A graphics card that may be used.
    pub card: Option<&'a Card>,
}

/// What an engine found, in a frame of its own.
pub struct Found {
    /// The photos by their names, with poses, lenses (OpenCV's model: fx, fy, cx, cy, k1, k2, p1, p2) and points.
    pub(crate) model: Reconstruction,
    /// Photos that are not in it, where it is known why.
    pub(crate) left_out: Vec<LeftOut>,
}

/// The same, adjusted with the photos' places.
#[derive(Debug, Clone, PartialEq)]
pub struct Sparse {
    /// COLMAP's cameras.txt, images.txt and points3D.txt.
    pub files: [(&'static str, Vec<u8>); 3],
    /// Photos that are not in it.
    pub left_out: Vec<LeftOut>,
}
