//! Image scales for blast fragmentation photos, from a drone flight's point cloud.
//!
//! Fragscale does what Bamford, Esmaeili & Schoellig, "Point-Cloud-Based Aerial Fragmentation
//! Analysis for Application in the Minerals Industry" (2017), "the paper", describes: the rays of a
//! photo's four corners meet the triangulated cloud of the rock pile, and the distances between
//! the corner points give the photo's scale (pixels per unit) at its edges. No scale object on the
//! pile, no assumption that the pile is flat.
//!
//! # The house
//!
//! A module may use its own folder and the floors below it, never one above (`tests/floors.rs`
//! holds that):
//!
//! ```text
//! F7  main.rs  cli/              the command line
//! F6  app/                       the window: state, commands, panels, dialogs
//! F5  render/                    wgpu: scene -> picture; knows no egui, reads no file
//!     sample/                    the paper's lab, simulated
//! F4  formats/  exports/         one file a format; what goes out
//! F3  flight/                    Flight, validated when made; verdicts; flight.toml
//!     picture/                   pixels of photos: undistorting, reducing, drawing on them
//! F2  scale/                     corner rays -> corner points -> scales; footprints
//! F1  camera/   surface/         intrinsics, distortion, pose | triangulation, ray casting
//!     fragmentation/             size distributions
//!     geodesy/  georeference/    coordinate systems | a frame of its own brought to the world
//! F0  geometry/ raster/ units.rs jobs.rs fault.rs files/
//! ```
//!
//! F0 to F3 take no paths (`files/` apart), write no log, know no clock and no f32: they return data and typed
//! errors. `picture/` alone counts in f32, because colours and strokes are no measurements.
//!
//! The features: `render` brings wgpu, `app` the window on top of it; without both the command line
//! needs no GPU library.
//!
//! # Conventions (everywhere)
//!
//! - World: right-handed, z up, one length unit per flight.
//! - Camera axes: x right, y down, z forward.
//! - Pose: `world_from_camera`, a rotation and the camera centre.
//! - Pixels: continuous, (0, 0) at the outer corner of the top-left pixel, (W, H) at the opposite
//!   one; the centre of the first pixel is (0.5, 0.5).

pub mod cli;

#[cfg(feature = "app")]
pub use fragscale_app as app;
pub use fragscale_core::{
    camera, fault, files, flight, geodesy, geometry, georeference, jobs, numbers, picture, raster,
    scale, split_mix, surface, units,
};
pub use fragscale_exports as exports;
pub use fragscale_formats as formats;
pub use fragscale_fragmentation as fragmentation;
pub use fragscale_opening as opening;
#[cfg(feature = "render")]
pub use fragscale_render as render;
pub use fragscale_sample as sample;
