#![no_main]
//! Every page ends in a checksum, which is made right first: else nothing behind it is ever reached.

use fragscale::formats::{CloudFormat, read_cloud_bytes};
use fragscale::jobs::Progress;

/// Of a page, in bytes; the last four are its checksum.
const PAGE: usize = 1024;

/// CRC-32C (Castagnoli), bit by bit.
fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 {
                crc >> 1 ^ 0x82f6_3b78
            } else {
                crc >> 1
            };
        }
    }
    !crc
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut bytes = bytes.to_vec();
    for page in bytes.as_chunks_mut::<PAGE>().0 {
        let (data, end) = page.split_at_mut(PAGE - 4);
        end.copy_from_slice(&checksum(data).to_be_bytes());
    }
    let _ = read_cloud_bytes(CloudFormat::E57, bytes, &Progress::default());
});
