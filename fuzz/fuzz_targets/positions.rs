#![no_main]
//! Positions of photos and ground control points: the first byte chooses what the file is called.

use fragscale::formats::{read_control_points, read_positions};

const NAMES: [&str; 4] = ["a.csv", "geo.txt", "gcp_list.txt", "a_Timestamp.MRK"];

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((&chosen, bytes)) = bytes.split_first() else {
        return;
    };
    let name = NAMES[usize::from(chosen) % NAMES.len()];
    let (_folder, path) = fragscale_fuzz::file(name, bytes);
    let _ = read_positions(&path);
    let _ = read_control_points(&path);
});
