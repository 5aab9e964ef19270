//! A simulated lab: photos of a pile of fragments whose every length is known.

pub mod light;
pub mod material;
pub mod noise;
pub mod sensor;

#[cfg(test)]
mod look;
