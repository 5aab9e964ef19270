//! What the outlines of a photo come to.

use crate::delineation::intervals::SizeInterval;
use crate::delineation::mass::{ByMass, PhotoFragments};
use crate::delineation::measures::Fragment;
use crate::fault::Fault;
use crate::flight::ScaleObject;

/// What outlines come to.
#[derive(Debug)]
pub struct MeasuredFragments {
    /// The fragments with their measures.
    pub photo: PhotoFragments,
    /// Their size distribution; or why there is none.
    pub by_mass: Result<ByMass, Fault>,
    /// The 95 % intervals of its P20, P50 and P80.
    pub intervals: Vec<SizeInterval>,
    /// What is to be said of the outlines, one sentence each.
    pub notes: Vec<String>,
    /// The scale objects that were taken off the outlines.
    pub without: Vec<ScaleObject>,
}

impl MeasuredFragments {
    /// What was measured of a fragment.
    pub fn fragment(&self, number: u32) -> Option<&Fragment> {
        let fragments = self.photo.fragments.iter();
        fragments
            .into_iter()
            .find(|fragment| fragment.number == number)
    }
}
