//! The rough pile that benchmarks work on, and flights over it, made up.

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;

/// Where the pile lies.
pub(crate) const ORIGIN: DVec3 = DVec3::new(500_000.0, 5_000_000.0, 300.0);

/// Numbers in 0..1: Knuth's MMIX.
fn random(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A rough pile of `count` points at 25 points a square metre, rounded to millimetres.
pub(crate) fn pile(count: usize) -> Vec<DVec3> {
    let side = (count as f64 / 25.0).sqrt();
    let mut random = random(1);
    let round = |x: f64| (x * 1000.0).round() / 1000.0;
    (0..count)
        .map(|_| {
            let (x, y) = (random() * side, random() * side);
            let heap = 6.0 * (1.0 - ((x / side - 0.5).hypot(y / side - 0.5) * 2.0).min(1.0));
            let z = heap + 0.4 * (x * 1.7).sin() * (y * 1.3).cos() + 0.2 * random();
            DVec3::new(round(x), round(y), round(z)) + ORIGIN
        })
        .collect()
}

/// Binary PLY with doubles.
pub(crate) fn write_ply(path: &Path, points: &[DVec3]) {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n\
         property double y\nproperty double z\nend_header\n",
        points.len()
    )
    .into_bytes();
    for point in points {
        for coordinate in point.to_array() {
            bytes.extend(coordinate.to_le_bytes());
        }
    }
    fs::write(path, bytes).expect("written");
}

/// A flight over a pile of `count` points in the file `surface`: a grid of photos of 9 megapixels from 40 m
/// above, none of whose footprints reaches beyond the pile where it has a million points.
#[allow(dead_code, reason = "not every benchmark flies")]
pub(crate) fn write_flight(folder: &Path, surface: &str, count: usize, photos: usize) -> PathBuf {
    let flight = folder.join("flight.toml");
    let text = format!(
        "format = 1\n[world]\nunit = \"m\"\n[surface]\nfile = \"{surface}\"\n[[camera]]\n\
         width = 4000\nheight = 2250\nfx = 2222.2\nfy = 2222.2\ncx = 2000\ncy = 1125\n\
         [photos]\nposes = \"poses.csv\"\n"
    );
    fs::write(&flight, text).expect("written");
    let side = (count as f64 / 25.0).sqrt();
    let columns = (photos as f64).sqrt().ceil() as usize;
    let at = |step: usize| side * (0.3 + 0.4 * step as f64 / (columns - 1) as f64);
    let mut poses = "photo,x,y,z,tilt,pan\n".to_owned();
    for i in 0..photos {
        let (x, y) = (ORIGIN.x + at(i % columns), ORIGIN.y + at(i / columns));
        let (z, pan) = (ORIGIN.z + 40.0, i * 40 % 360);
        poses.push_str(&format!("IMG_{i}.jpg,{x},{y},{z},83,{pan}\n"));
    }
    fs::write(folder.join("poses.csv"), poses).expect("written");
    flight
}
