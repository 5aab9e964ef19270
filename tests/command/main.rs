//! The command as a user runs it, file by file. One program, because each of its own would be linked
//! anew after every change.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::unwrap_used,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/own_frame.rs"]
mod own_frame;
#[path = "../common/wrong_pile.rs"]
mod wrong_pile;

mod anova;
mod batch;
mod clicked;
#[cfg(all(feature = "app", target_os = "linux"))]
mod clipboard;
mod contract;
mod coordinate_systems;
mod decisions;
mod delineate;
mod effort;
mod georeference;
mod geotiff;
mod in_part;
mod independent_answers;
mod intervals;
mod manual;
mod map;
mod masks;
mod mission;
mod node_odm;
mod on_surface;
mod overwriting;
mod photos_together;
mod plan;
mod plan_areas;
mod plan_surveys;
mod psd_compare;
mod real_data;
mod reconstruct;
mod said;
mod scale_maps;
mod scale_object;
mod scale_pair;
mod size_distribution_fits;
mod split_desktop;
mod tiff_photos;
mod true_scale;
mod trust;
#[cfg(unix)]
mod unfinished;
mod windrow_example;
