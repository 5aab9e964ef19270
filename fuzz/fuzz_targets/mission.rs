#![no_main]
//! Missions of ground stations: told by what is in them, so one name will do.

use fragscale::formats::read_mission;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let (_folder, path) = fragscale_fuzz::file("a", bytes);
    let _ = read_mission(&path);
});
