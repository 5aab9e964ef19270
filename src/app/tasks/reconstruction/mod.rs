//! Flights made of reconstructions: of photos that are reconstructed here, or of a reconstruction that is
//! brought to the world.

pub mod from_photos;
pub mod georeferencing;
