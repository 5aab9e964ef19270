//! The core: what knows neither files' formats nor windows. Its floors are in the map of
//! `src/lib.rs`, and `tests/floors.rs` holds them; the other members of the workspace are built on it.
//!
//! The root of this crate lies beside its modules, its manifest in `src/core/`.

pub mod camera;
pub mod control;
pub mod fault;
pub mod files;
pub mod flight;
pub mod geodesy;
pub mod geometry;
pub mod georeference;
pub mod jobs;
pub mod labels;
pub mod numbers;
pub mod picture;
pub mod plan;
pub mod raster;
pub mod scale;
pub mod split_mix;
pub mod surface;
pub mod survey;
pub mod toml_text;
pub mod units;
