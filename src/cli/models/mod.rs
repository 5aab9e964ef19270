//! Commands that make models: from photos alone, or brought to the world.

pub(super) mod georeference;
pub(super) mod reconstruct;
