#![no_main]
//! A recording of ROS 1.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fragscale_fuzz::read("a.bag", bytes));
