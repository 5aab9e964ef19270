//! Commands that write files for single photos of a flight, for all of them, or of all together.

mod chosen_engine;
mod chosen_photos;
pub(super) mod delineate;
pub(super) mod length;
pub(super) mod map;
mod masks_arguments;
mod mass_arguments;
mod page;
pub(super) mod rectify;
pub(super) mod scale_map;
mod sizes;
mod unfinished;
mod written_outlines;
