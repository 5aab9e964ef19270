#![no_main]
//! Poses, trajectories and RealityCapture's cameras as tables.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fragscale_fuzz::read("a.csv", bytes));
