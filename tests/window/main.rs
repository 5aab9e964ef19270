//! The window, driven as an engineer drives it: through the names of its parts, with mouse and keys.
//!
//! Most tests need no graphics device; those that look at pictures or write one say which package to
//! install where there is none.

#![cfg(feature = "app")]
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::unwrap_used,
    unreachable_pub,
    missing_docs,
    reason = "in a test a panic is the report"
)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/own_frame.rs"]
mod own_frame;
#[path = "../common/wrong_pile.rs"]
mod wrong_pile;

mod beside;
mod broken;
mod clip;
mod colors;
mod control_points;
mod corner_loupe;
mod decisions;
mod desk;
mod dropping;
mod everyday;
mod export;
mod fields;
mod fragments;
mod from_photos;
mod georeference;
mod health;
mod kept_aside;
mod keyboard;
mod large_clouds;
mod linked;
mod long_names;
mod looks;
mod map;
mod node_odm;
mod opening;
mod overwriting;
mod photo_view;
mod photos;
mod planning;
mod planning_files;
mod planning_saved;
mod points;
mod random;
mod reviewing;
mod rough_ground;
mod scale_object;
mod season;
mod settings;
mod side_by_side;
mod size_distributions;
mod survey;
mod viewport;
