#![no_main]

use fragscale::formats::{CloudFormat, read_cloud_bytes};
use fragscale::jobs::Progress;

libfuzzer_sys::fuzz_target!(
    // The decompressor asserts on damaged data, which the reader catches: only what gets past it counts.
    init: std::panic::set_hook(Box::new(|_| ())),
    |bytes: &[u8]| {
        let _ = read_cloud_bytes(CloudFormat::Las, bytes.to_vec(), &Progress::default());
    }
);
