//! Commands that measure on a surface.

mod places;
pub(super) mod profile;
pub(super) mod volume;
