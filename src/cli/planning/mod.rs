//! The commands about flights that are to be flown.

pub(super) mod flown;
mod flying;
pub(super) mod mission;
mod notes_of_files;
mod pixel_scale;
pub(super) mod plan;
mod sheet;
mod stated;
mod survey;
