//! Dense stereo: undistorted photos with known poses -> a depth map each -> one coloured cloud with the
//! number of views and the standard error of every point.
//!
//! # Floors
//!
//! ```text
//! D4  fusion.rs      depth maps -> points
//! D3  depth_maps.rs  the schedule: coarse to fine, photos alone first, then with the other photos' depths
//! D2  found_maps.rs  the maps that were found, read from the shelf
//! D1  patch_match/   the search for a plane at every pixel; `cpu` and `gpu/` are its two back ends
//! D0  view.rs  neighbours.rs  options.rs  luma.rs  depth_map.rs  edges.rs  agreement.rs  shelf.rs
//! ```
//!
//! # Frames and numbers
//!
//! World and camera axes, poses and pixels are the house's (`src/lib.rs` of the root). What leaves a view
//! is f64. Within a pair of views the search counts in f32: everything there is in pixels of an image or in
//! inverse depths of its camera, so nothing is far from its origin, and what it finds is good to a
//! hundredth of a pixel at best, which f32 keeps with three digits to spare.
//!
//! # Sources
//!
//! Bleyer, Rhemann & Rother, "PatchMatch stereo" (BMVC 2011): slanted planes. Galliani, Lasinger &
//! Schindler, "Massively parallel multiview stereopsis by surface normal diffusion" (ICCV 2015, Gipuma):
//! the checkerboard. Schönberger, Zheng, Frahm & Pollefeys, "Pixelwise view selection for unstructured
//! multi-view stereo" (ECCV 2016, COLMAP): bilateral weights, geometric consistency. Xu & Tao, "Multi-scale
//! geometric consistency guided multi-view stereo" (CVPR 2019, ACMM): candidates by their cost, coarse to
//! fine.

mod agreement;
mod depth_map;
mod depth_maps;
mod edges;
mod found_maps;
mod fusion;
mod luma;
mod neighbours;
mod options;
mod patch_match;
mod shelf;
#[cfg(test)]
mod tests;
mod view;

use fragscale_core::{camera, fault, files, jobs};

pub use depth_map::DepthMap;
pub use depth_maps::depth_maps;
pub use found_maps::DepthMaps;
pub use fusion::{Fused, fuse};
pub use neighbours::choose_neighbours;
pub use options::{DenseOptions, Quality};
pub use patch_match::cpu::Cpu;
#[cfg(feature = "gpu")]
pub use patch_match::gpu::Gpu;
pub use patch_match::plane::Planes;
pub use patch_match::{Backend, Problem, Sweep};
pub use shelf::{InFolder, InMemory, Shelf};
pub use view::{Photos, View};
