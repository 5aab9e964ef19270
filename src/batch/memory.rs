//! How much memory a flight takes, and how much there is.
//!
//! What a flight takes is estimated from the sizes of its files before it begins, and looked at while it runs, where
//! the system tells it (Linux): see `running`.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use crate::asked::{Asked, Step};
use crate::files;
use crate::flight::FlightFile;
use crate::formats::photos::photo_metadata;

const MIB: u64 = 1 << 20;
const GIB: u64 = 1 << 30;

/// What a flight takes before anything of it is read.
const PROGRAM: u64 = 64 * MIB;

/// Files below a flight's folder that are looked at.
const MOST_FILES: usize = 5000;

/// Photos whose size is read.
const MOST_HEADERS: usize = 3;

/// What a process holds, in bytes, where the system tells it.
pub(super) fn of_process(id: u32) -> Option<u64> {
    let text = fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    kilobytes_in(&text, "VmRSS:")
}

/// The number behind a name, in kB there.
fn kilobytes_in(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let number: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    number.checked_mul(1024)
}

/// What is known of a flight's files before it is opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct FileSizes {
    /// Of packed clouds: LAZ, COPC, E57.
    packed: u64,
    /// Of all other clouds and meshes.
    plain: u64,
    /// Of the largest photo that was looked at.
    pixels: u64,
}

/// The most that a flight takes while these steps are done, in bytes. Measured: 65 bytes a point that photos see, of
/// which LAZ has 10 in its file, PLY and LAS 24 and more; 60 bytes a pixel of a photo that is outlined, 18 of one that
/// is exported, of which four go at once, in at most 2 GB.
pub(super) fn estimate(sizes: FileSizes, asked: &Asked) -> u64 {
    let times = |bytes: u64, by: u64| bytes.saturating_mul(by);
    let surface = times(sizes.packed, 8).saturating_add(times(sizes.plain, 3));
    let of_step = |step: Step| match step {
        Step::Scales | Step::Psd => 0,
        Step::Check => times(sizes.pixels, 12),
        Step::Export => times(sizes.pixels, 18 * 4).min((2 * GIB).max(times(sizes.pixels, 18))),
        Step::ScaleMap => times(sizes.pixels, 40),
        Step::Delineate => times(sizes.pixels, 60),
    };
    let steps = asked.steps.iter().map(|asked| of_step(asked.step));
    let photos = steps.max().unwrap_or(0);
    PROGRAM.saturating_add(surface).saturating_add(photos)
}

/// The sizes of a flight's files: of those that its flight.toml names, or of all in its folder and the folders in it.
pub(super) fn file_sizes(
    flight: &Path,
    surface: Option<&Path>,
    photos: Option<&Path>,
) -> FileSizes {
    let folder = match flight.is_dir() {
        true => flight.to_owned(),
        false => flight.parent().map(Path::to_owned).unwrap_or_default(),
    };
    let file = match flight.is_dir() {
        true => flight.join("flight.toml"),
        false => flight.to_owned(),
    };
    let is_toml = file.extension() == Some(OsStr::new("toml"));
    let text = is_toml.then(|| files::read_text(&file).ok()).flatten();
    let parsed = text.and_then(|text| FlightFile::parse(&text).ok());
    let mut paths: Vec<PathBuf> = Vec::new();
    match parsed {
        Some(parsed) => {
            let named = [parsed.surface(), parsed.photo_folder()];
            paths.extend(named.into_iter().flatten().map(|name| folder.join(name)));
            if parsed.surface().is_none() {
                paths.push(folder);
            }
        }
        None => paths.push(folder),
    }
    paths.extend([surface, photos].into_iter().flatten().map(Path::to_owned));
    let mut sizes = FileSizes::default();
    let mut images: Vec<(u64, PathBuf)> = Vec::new();
    let mut looked_at = 0;
    while let Some(path) = paths.pop() {
        looked_at += 1;
        if looked_at > MOST_FILES {
            break;
        }
        let Ok(metadata) = fs::symlink_metadata(&path) else {
            continue;
        };
        if metadata.is_dir() {
            let entries = fs::read_dir(&path).into_iter().flatten().flatten();
            paths.extend(entries.map(|entry| entry.path()));
            continue;
        }
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let bytes = fs::metadata(&path).map_or(0, |metadata| metadata.len());
        match ending.to_ascii_lowercase().as_str() {
            "laz" | "e57" => sizes.packed = sizes.packed.saturating_add(bytes),
            "ply" | "las" | "pcd" | "pts" | "ptx" | "obj" | "stl" | "glb" | "xyz" => {
                sizes.plain = sizes.plain.saturating_add(bytes);
            }
            "jpg" | "jpeg" | "png" | "tif" | "tiff" => images.push((bytes, path)),
            _ => {}
        }
    }
    images.sort();
    for (_, path) in images.iter().rev().take(MOST_HEADERS) {
        if let Ok(metadata) = photo_metadata::read_file(path) {
            let (width, height) = metadata.size;
            sizes.pixels = sizes.pixels.max(u64::from(width) * u64::from(height));
        }
    }
    sizes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::opening::half_of_the_machines;

    #[test]
    fn what_a_process_holds_is_read() {
        assert_eq!(
            kilobytes_in("A: 1 kB\nVmRSS:\t  12 kB\n", "VmRSS:"),
            Some(12288)
        );
        assert_eq!(kilobytes_in("VmRSS: x\n", "VmRSS:"), None);
        #[cfg(target_os = "linux")]
        {
            let own = of_process(std::process::id()).unwrap();
            assert!(own > MIB && own < half_of_the_machines() * 2, "{own}");
        }
    }

    #[test]
    fn large_files_need_much() {
        let sizes = |packed, plain, pixels| FileSizes {
            packed,
            plain,
            pixels,
        };
        let scales = Asked::of(&[Step::Scales]);
        let outlines = Asked::of(&[Step::Scales, Step::Delineate, Step::Export]);
        // docs/speed.md: 100 M points in a LAZ of 1 GB take 6.5 GB.
        assert!(estimate(sizes(GIB, 0, 0), &scales) > 13 * GIB / 2);
        // docs/speed.md: a photo of 12 megapixels takes 0.7 GB to be outlined.
        let photo = estimate(sizes(0, 0, 12_000_000), &outlines);
        assert!((650 * MIB..1000 * MIB).contains(&photo), "{photo}");
        assert!(estimate(sizes(0, 0, 12_000_000), &scales) < 100 * MIB);
        assert_eq!(
            estimate(sizes(u64::MAX, u64::MAX, u64::MAX), &outlines),
            u64::MAX
        );
    }
}
