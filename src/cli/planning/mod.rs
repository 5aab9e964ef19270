//! The commands about flights that are to be flown.

mod areas;
pub(super) mod flown;
pub(super) mod mission;
pub(super) mod plan;
mod sheet;
