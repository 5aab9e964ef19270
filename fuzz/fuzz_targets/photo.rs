#![no_main]
//! A photo's EXIF, XMP and makers' notes.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| fragscale_fuzz::read("a.jpg", bytes));
