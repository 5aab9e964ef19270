#![no_main]
//! The packages that write XML, and cameras.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fragscale_fuzz::read("a.xml", bytes));
