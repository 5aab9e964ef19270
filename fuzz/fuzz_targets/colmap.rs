#![no_main]
//! A model's three files: the input's first four bytes say where the first ends, the next where the
//! second does.

use std::fs;

use fragscale::formats::read_project;
use fragscale::jobs::Progress;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Some((ends, bytes)) = bytes.split_at_checked(8) else {
        return;
    };
    let end = |four: &[u8]| {
        four.iter()
            .fold(0, |end, &byte| end << 8 | usize::from(byte))
    };
    let first = end(&ends[..4]).min(bytes.len());
    let second = end(&ends[4..]).clamp(first, bytes.len());
    let folder = tempfile::tempdir().expect("a folder to write to");
    for (name, part) in [
        ("cameras.bin", &bytes[..first]),
        ("images.bin", &bytes[first..second]),
        ("points3D.bin", &bytes[second..]),
    ] {
        fs::write(folder.path().join(name), part).expect("room to write");
    }
    let _ = read_project(folder.path(), &Progress::default());
});
