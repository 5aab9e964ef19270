//! Commands that write files for single photos of a flight, for all of them, or of all together.

mod chosen_photos;
pub(super) mod delineate;
pub(super) mod length;
pub(super) mod map;
pub(super) mod rectify;
pub(super) mod scale_map;
