//! The commands about flights that are to be flown.

pub(super) mod flown;
pub(super) mod mission;
pub(super) mod plan;
mod sheet;
