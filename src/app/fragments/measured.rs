//! What the outlines of a photo come to, and those of all photos.

use std::collections::BTreeSet;

use crate::delineation::intervals::SizeInterval;
use crate::delineation::mass::{ByMass, PhotoFragments};
use crate::delineation::measures::Fragment;
use crate::fault::Fault;
use crate::flight::ScaleObject;
use crate::size_distributions::MadeOf;

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
    /// The fragments that lie on them, by number: no rock, and not measured.
    pub on_objects: BTreeSet<u32>,
}

/// What the outlines of all photos come to.
#[derive(Debug)]
pub struct AllMeasured {
    /// Of which outlines.
    pub made_of: MadeOf,
    /// How many photos have a part in it, and how many the flight has.
    pub photos: [usize; 2],
    /// The distribution of all together, with the 95 % intervals of its P20, P50 and P80; `None` where none of them has any.
    pub sizes: Option<(ByMass, Vec<SizeInterval>)>,
    /// What is to be said of it, one sentence each.
    pub notes: Vec<String>,
    /// The curves of the photos, as the export writes them.
    pub(super) curves: String,
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
