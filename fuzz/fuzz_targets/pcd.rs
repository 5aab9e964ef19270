#![no_main]

use fragscale::formats::{CloudFormat, read_cloud_bytes};
use fragscale::jobs::Progress;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = read_cloud_bytes(CloudFormat::Pcd, bytes.to_vec(), &Progress::default());
});
