#![no_main]
//! Bundler's model.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fragscale_fuzz::read("bundle.out", bytes));
