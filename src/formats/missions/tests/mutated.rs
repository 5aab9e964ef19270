//! Real files with numbers, tags and whole pieces changed, also inside their zips: read or refused in one line, never a
//! panic, and never a mission that no drone could be told. `FRAGSCALE_FUZZ_ROUNDS` says how often each file is changed.

use std::io::{Cursor, Read, Write};

use fragscale_core::split_mix::SplitMix;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use super::damaged::all;
use crate::areas::areas;
use crate::missions::read_bytes;

/// Numbers that readers stumble over.
const NUMBERS: [&str; 14] = [
    "",
    "-",
    "0",
    "-0",
    "1e309",
    "-1e309",
    "nan",
    "inf",
    "1e-320",
    "18446744073709551616",
    "-9223372036854775809",
    "4294967296",
    "360.0000000001",
    "90.0000001",
];

struct Random(SplitMix);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        usize::try_from(self.0.next() % limit.max(1) as u64).unwrap()
    }

    /// Where a piece of bytes begins and ends.
    fn piece(&mut self, bytes: &[u8]) -> std::ops::Range<usize> {
        let from = self.below(bytes.len());
        let most = [4, 60, 2000][self.below(3)];
        from..(from + 1 + self.below(most)).min(bytes.len())
    }
}

/// Where the numbers of a text stand.
fn numbers(bytes: &[u8]) -> Vec<std::ops::Range<usize>> {
    let is_of_number = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'e');
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let end = at
            + bytes[at..]
                .iter()
                .take_while(|byte| is_of_number(**byte))
                .count();
        if bytes[at..end].iter().any(u8::is_ascii_digit) {
            found.push(at..end);
        }
        at = end.max(at + 1);
    }
    found
}

fn changed(bytes: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(4) {
        let all = numbers(&bytes);
        match random.below(6) {
            0 | 1 if !all.is_empty() => {
                let number = NUMBERS[random.below(NUMBERS.len())];
                let at = all[random.below(all.len())].clone();
                bytes.splice(at, number.bytes());
            }
            2 => {
                let piece = random.piece(&bytes);
                bytes.drain(piece);
            }
            3 => {
                let piece = random.piece(&bytes);
                let copy = bytes[piece.clone()].to_vec();
                let times = [1, 2, 300][random.below(3)];
                bytes.splice(piece.start..piece.start, copy.repeat(times));
            }
            4 => {
                let piece = random.piece(other);
                let at = random.below(bytes.len() + 1);
                bytes.splice(at..at, other[piece].to_vec());
            }
            _ => {
                let at = random.below(bytes.len());
                if let Some(byte) = bytes.get_mut(at) {
                    *byte = u8::try_from(random.below(256)).unwrap();
                }
            }
        }
    }
    bytes
}

/// A zip with one of its files changed; `None` of what is none.
fn changed_inside(bytes: &[u8], other: &[u8], random: &mut Random) -> Option<Vec<u8>> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).ok()?;
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let chosen = random.below(archive.len());
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).ok()?;
        let mut text = Vec::new();
        file.read_to_end(&mut text).ok()?;
        if index == chosen {
            text = changed(&text, other, random);
        }
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        writer
            .start_file(file.name().ok()?.into_owned(), options)
            .ok()?;
        writer.write_all(&text).ok()?;
    }
    Some(writer.finish().ok()?.into_inner())
}

#[test]
#[ignore = "minutes: run it by name"]
fn changed_in_numbers_and_pieces() {
    let Some(files) = all() else { return };
    let rounds = std::env::var("FRAGSCALE_FUZZ_ROUNDS").ok();
    let rounds: usize = rounds.and_then(|rounds| rounds.parse().ok()).unwrap_or(60);
    let mut random = Random(SplitMix(11));
    for (_, bytes) in &files {
        // A reader needs seconds for a large one in a debug build.
        let rounds = rounds * 40_000 / bytes.len().max(40_000);
        for _ in 0..rounds.max(4) {
            let (_, other) = &files[random.below(files.len())];
            let inside = changed_inside(bytes, other, &mut random);
            let made = inside.unwrap_or_else(|| changed(bytes, other, &mut random));
            match read_bytes(&made) {
                // A reader leaves that to the check behind it.
                Ok(read) => drop(read.mission.check()),
                Err(fault) => assert!(!fault.to_string().contains('\n'), "{fault}"),
            }
            if let Err(fault) = areas(&made) {
                assert!(!fault.to_string().contains('\n'), "{fault}");
            }
        }
    }
}
