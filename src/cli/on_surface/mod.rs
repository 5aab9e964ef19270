//! Commands that measure on a surface.

pub(super) mod places;
pub(super) mod profile;
pub(super) mod volume;
