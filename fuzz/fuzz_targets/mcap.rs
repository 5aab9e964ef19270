#![no_main]
//! A recording of ROS 2.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fragscale_fuzz::read("a.mcap", bytes));
