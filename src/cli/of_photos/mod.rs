//! Commands that write files for single photos of a flight, or for all of them.

mod chosen_photos;
pub(super) mod rectify;
pub(super) mod scale_map;
