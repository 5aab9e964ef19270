#![no_main]
//! Metashape's zip.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fragscale_fuzz::read("a.psz", bytes));
