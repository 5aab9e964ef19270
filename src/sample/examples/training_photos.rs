//! Photos of random piles with labels, for `training/train.py`:
//! `cargo run --release -p fragscale-sample --example training_photos -- FOLDER SEED PILES SIDE`

#![allow(clippy::print_stderr, reason = "a tool for developers, in a terminal")]

use std::path::Path;
use std::process::ExitCode;

use fragscale_core::jobs::Progress;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, seed, piles, side] = arguments.as_slice() else {
        eprintln!("training_photos FOLDER SEED PILES SIDE");
        return ExitCode::FAILURE;
    };
    let (Ok(seed), Ok(piles), Ok(side)) = (seed.parse(), piles.parse(), side.parse()) else {
        eprintln!("SEED, PILES and SIDE are whole numbers");
        return ExitCode::FAILURE;
    };
    let folder = Path::new(folder);
    match fragscale_sample::training_photos(folder, seed, piles, side, &Progress::default()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(fault) => {
            eprintln!("{fault}");
            ExitCode::FAILURE
        }
    }
}
