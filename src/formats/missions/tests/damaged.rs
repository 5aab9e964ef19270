//! Real files, cut off anywhere and with bytes changed anywhere: read or refused in one line, never a panic.

use std::path::PathBuf;

use fragscale_core::split_mix::SplitMix;

use super::*;
use crate::missions::read_bytes;

pub(super) fn all() -> Option<Vec<(PathBuf, Vec<u8>)>> {
    let root = shared_data("missions")?;
    let mut folders = vec![root];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let bytes = std::fs::read(&path).unwrap();
                files.push((path, bytes));
            }
        }
    }
    files.sort();
    assert!(files.len() > 20);
    Some(files)
}

fn try_to_read(bytes: &[u8]) {
    if let Err(fault) = read_bytes(bytes) {
        assert!(!fault.to_string().contains('\n'));
    }
}

#[test]
fn cut_off_anywhere() {
    let Some(files) = all() else { return };
    for (_, bytes) in files {
        let step = (bytes.len() / 150).max(1);
        for end in (0..bytes.len()).step_by(step) {
            try_to_read(&bytes[..end]);
        }
    }
}

#[test]
fn changed_anywhere() {
    let Some(files) = all() else { return };
    let mut random = SplitMix(17);
    let mut below = |limit: usize| usize::try_from(random.next() % limit as u64).unwrap();
    for (_, bytes) in files {
        for _ in 0..150 {
            let mut changed = bytes.clone();
            for _ in 0..=below(4) {
                let at = below(changed.len());
                changed[at] = match below(3) {
                    0 => b"0123456789-.,<>{}[]\"e"[below(21)],
                    1 => u8::try_from(below(256)).unwrap(),
                    _ => changed[below(changed.len())],
                };
            }
            try_to_read(&changed);
        }
    }
}
