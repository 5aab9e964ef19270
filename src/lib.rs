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
//! A workspace whose members lie inside `src/`, so that a changed reader or panel compiles alone: the
//! core, `fragmentation/`, `delineation/`, `formats/`, `opening/`, `exports/`, `render/`, `dense/`, `reconstruct/`,
//! `node_odm/`, `batch/`, `sample/`, `app/`,
//! and here `cli/`. This crate re-exports all of them. The compiler holds who may use whom
//! between members, `tests/floors.rs` the floors within the core, that no files use each other in a
//! circle, and that no folder has more than 15 files lying flat.
//!
//! ```text
//! F7  main.rs  cli/              the command line: parses, calls, prints
//! F6  app/                       the window: state, commands, panels, jobs
//! F5  opening/                   files -> a flight in one world; what is looked up of its photos
//!     render/                    wgpu: scene -> picture; knows no egui, reads no file
//!     reconstruct/               photos alone -> a flight: engines behind a trait
//!     node_odm/                  the same on a NodeODM or ClusterODM: sent, watched, fetched; nothing trusted
//!     dense/                     photos with known poses -> depth maps -> a cloud with standard errors
//!     batch/                     many flights: which, in what order, within what memory, what is done again
//!     sample/                    the paper's lab, simulated
//! F4  formats/                   bytes -> types: clouds cameras packages poses photos tables missions areas text
//!     exports/                   what goes out: table, CSV, JSON, sheet, Split-Desktop, figures, maps, missions
//!     delineation/               the fragments of a photo outlined, measured, as a size distribution
//!     --- the core (core.rs) and fragmentation/ ---
//! F3  flight/                    Flight, validated when made; review: doubts, verdicts; flight.toml
//!     plan/                      where to fly over a surface: photos, their scales beforehand, missions
//!     picture/                   pixels of photos: undistorting, reducing, drawing on them
//! F2  scale/                     corner rays -> corner points -> scales; footprints
//!     survey/                    profiles, areas and volumes on the surface
//!     control/                   control points: marks in photos, their places, epipolar lines
//! F1  camera/   surface/         intrinsics, distortion, pose | triangulation, ray casting
//!     labels/                    what pixels belong to, and edits of that by hand
//!     fragmentation/             size distributions: functions, fits, analysis
//!     geodesy/  georeference/    coordinate systems | a frame of its own brought to the world
//! F0  geometry/ raster/ files/   units.rs numbers.rs jobs.rs fault.rs split_mix.rs toml_text.rs
//!     test_data/                 for tests alone: where data lie, fixtures that two members write
//! ```
//!
//! F0 to F3 take no paths (`files/` apart), write no log, know no clock and no f32: they return data and
//! typed errors. `picture/` alone counts in f32, because colours and strokes are no measurements.
//!
//! The features: `render` brings wgpu, `app` the window on top of it, `ros` the libraries in C that
//! compressed recordings need, `tls` the cryptography for nodes with https, in C as well; without them the command line
//! needs no GPU library and no C compiler.
//!
//! The manual, for those who use it, is `docs/`; `tests/command/manual.rs` holds that its links and examples are understood.
//!
//! # To add ... touch ...
//!
//! | to add | begin at | which leads to |
//! |---|---|---|
//! | a camera model | `src/camera/distortion.rs` | the enum of lens models; the model itself is a file beside it |
//! | a package | `src/formats/packages/mod.rs` | a row of `packages!`; the reader is a folder or a file beside it; `formats/candidates/mod.rs` says what of a folder is its, `docs/flights.md` has a line |
//! | a column of the photo table | `src/exports/photo_columns.rs` | one row for window, CSV, text and sheet; the contract names those of the CSV |
//! | an undoable setting of the flight | `src/flight/mod.rs` | `FlightSettings`: undo goes by it; `flight/file/` keeps it, `app/panels/flight_settings/` shows it |
//! | a reason for doubt | `src/flight/doubt/mod.rs` | a variant, its sentence, its word (`kind.rs`) and what shows it (`review/sight.rs`); found in `flight/verdict/`, `flight/placement.rs`, and in `opening/`: `evidence.rs`, `photo_checks.rs`, `photo_files.rs`, `photo_places.rs`, `open/image_points.rs`, `pixels/`; `opening/health/` says under which word of the strip it counts (`item.rs`) and what mends it (`remedy.rs`) |
//! | a shader primitive | `src/render/primitives/mod.rs` | a file and a WGSL file of one name; `renderer/` calls it |
//! | a subcommand with progress | `src/cli/mod.rs` | a variant; its work is a file beside it |
//! | a JSON key of a photo | `src/exports/scales_json.rs` | a field and its value; the contract |
//! | a distribution function | `src/fragmentation/functions/mod.rs` | the enum of models; the function is a file beside it, its coordinates for fitting in `fit/family.rs` |
//! | a pattern of planned photos | `src/plan/wish/pattern.rs` | a variant; `patterns/` beside it says where its photos lie; `src/cli/planning/plan.rs` offers it |
//! | a drone | `src/plan/drones.rs` | one row: camera, gimbal, DJI's numbers, each with its source |
//! | a ground station's missions | `src/formats/missions/mod.rs`, `src/exports/missions/format.rs` | what reads and what writes it, a file each beside them; `exports/missions/tests/round_trip.rs` holds that all say the same |
//! | a reconstruction engine | `src/reconstruct/engine.rs` | the trait; the engine is a folder beside it, and leaves COLMAP's text files |
//! | an engine that outlines fragments | `src/delineation/engine/mod.rs` | the trait; the engine is a folder beside it and a row of `delineation/engines.rs`, its score is learned by `delineation/training/train_score.py`; `src/cli/of_photos/delineate/mod.rs` offers it |
//! | a step or option of a batch | `src/batch/asked.rs` | its words; `src/cli/batch/steps.rs` does it by the single command's function, `src/batch/season/file.rs` has its keys |
//! | a format of outlines | `src/formats/masks/mod.rs`, `src/exports/masks/mod.rs` | what reads and what writes it, a file each beside them; `exports/masks/tests.rs` holds that all read back to the pixel; `src/cli/of_photos/delineate/written_outlines.rs` offers it |
//! | a job with a panel | `src/app/tasks/mod.rs` | the job with its task and its ending is a file beside it, the panel one in `panels/`; `command/mod.rs` and `apply.rs` start it |
//!
//! "The contract" is the team's own paper on formats, conventions, mathematics and the command line, against which others test; it is kept
//! beside the project (`../shared/contract.md`), and `docs/` says the same to users.
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
pub use fragscale_batch as batch;
pub use fragscale_core::{
    camera, control, fault, files, flight, geodesy, geometry, georeference, jobs, labels, numbers,
    picture, plan, raster, scale, split_mix, surface, survey, toml_text, units,
};
pub use fragscale_delineation as delineation;
pub use fragscale_exports as exports;
pub use fragscale_formats as formats;
pub use fragscale_fragmentation as fragmentation;
pub use fragscale_node_odm as node_odm;
pub use fragscale_opening as opening;
pub use fragscale_reconstruct as reconstruct;
#[cfg(feature = "render")]
pub use fragscale_render as render;
pub use fragscale_sample as sample;
