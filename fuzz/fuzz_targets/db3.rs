#![no_main]
//! A recording of ROS 2 in SQLite.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fragscale_fuzz::read("a.db3", bytes));
