#![no_main]
//! Areas of maps: GeoJSON, KML and KMZ, told by how they begin.

use fragscale::formats::areas;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = areas(bytes);
});
