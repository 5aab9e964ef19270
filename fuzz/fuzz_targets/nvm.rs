#![no_main]
//! VisualSFM's model.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fragscale_fuzz::read("a.nvm", bytes));
