//! A known rock, and photos of it.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use fragscale_core::split_mix::SplitMix;
use fragscale_sample::files::photo::jpeg;
use fragscale_sample::files::photo_metadata::{DjiGimbal, GpsPosition, PhotoMetadata};
use glam::{DVec2, DVec3};
use image::{Rgb, RgbImage};
use rayon::prelude::*;

use crate::camera::{Brown, Camera, Distortion, Pose};
use crate::geodesy::Crs;

pub(super) const ORIGIN: DVec3 = DVec3::new(452_300.0, 5_411_900.0, 300.0);

pub(super) fn camera() -> Camera {
    let lens = Brown::new([-0.05, 0.02, 3e-4, -2e-4, 0.0, 0.0, 0.0, 0.0]);
    Camera {
        name: "c".to_owned(),
        width: 640,
        height: 480,
        fx: 600.0,
        fy: 600.0,
        cx: 321.0,
        cy: 239.0,
        skew: 0.0,
        distortion: Distortion::Brown(lens),
    }
}

/// Nine photos from about 30 m, 3 by 3, that overlap by three quarters.
pub(super) fn poses() -> Vec<Pose> {
    let mut random = SplitMix(11);
    let mut uniform = move || random.unit() - 0.5;
    (0..9)
        .map(|number| {
            let (column, row) = (f64::from(number % 3) - 1.0, f64::from(number / 3) - 1.0);
            let center = DVec3::new(
                column * 8.0 + uniform(),
                row * 6.0 + uniform(),
                30.0 + 4.0 * uniform(),
            );
            Pose::from_tilt_pan(center, [80.0 + 8.0 * uniform(), 360.0 * uniform()])
        })
        .collect()
}

/// The rock, metres.
pub(super) fn height(at: DVec2) -> f64 {
    1.2 * (0.35 * at.x).sin() * (0.3 * at.y).cos() + 0.4 * (0.9 * at.x + 0.7 * at.y + 0.5).sin()
}

/// Where a ray meets it.
pub(super) fn met(center: DVec3, direction: DVec3) -> DVec3 {
    let mut t = -center.z / direction.z;
    for _ in 0..12 {
        let at = center + direction * t;
        t += (at.z - height(at.truncate())) / -direction.z;
    }
    center + direction * t
}

/// Gray between 0 and 1: noise of three widths.
pub(super) fn texture(at: DVec2, seed: u64) -> f64 {
    let noise = |width: f64, seed: u64| {
        let (cell, part) = ((at / width).floor(), (at / width).fract_gl());
        let value = |x: f64, y: f64| {
            let place =
                ((cell.x + x) as i64 as u64) << 32 ^ ((cell.y + y) as i64 as u64 & 0xffff_ffff);
            let mut random = SplitMix(place.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ seed);
            (random.next() >> 40) as f64 / (1_u64 << 24) as f64
        };
        let s = part * part * (3.0 - 2.0 * part);
        let low = value(0.0, 0.0) * (1.0 - s.x) + value(1.0, 0.0) * s.x;
        let high = value(0.0, 1.0) * (1.0 - s.x) + value(1.0, 1.0) * s.x;
        low * (1.0 - s.y) + high * s.y
    };
    0.4 * noise(0.26, seed) + 0.35 * noise(0.6, seed + 1) + 0.25 * noise(1.7, seed + 2)
}

pub(super) fn photo(pose: &Pose, seed: u64) -> RgbImage {
    let camera = camera();
    let rows: Vec<Vec<u8>> = (0..camera.height)
        .into_par_iter()
        .map(|row| {
            (0..camera.width)
                .flat_map(|column| {
                    let pixel = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                    let direction = pose.rotation * camera.direction_as_shot(pixel).unwrap();
                    let at = met(pose.center, direction).truncate();
                    let gray = (30.0 + 200.0 * texture(at, seed)) as u8;
                    [gray, gray / 2 + 40, gray / 2]
                })
                .collect()
        })
        .collect();
    RgbImage::from_raw(camera.width, camera.height, rows.concat()).unwrap()
}

pub(super) fn metadata(pose: Option<&Pose>) -> PhotoMetadata {
    let crs = Crs::understand("EPSG:32632").unwrap();
    let gps = pose.map(|pose| crs.to_geographic(ORIGIN + pose.center).unwrap());
    PhotoMetadata {
        make: Some("fragscale".to_owned()),
        model: Some("test".to_owned()),
        // 35 mm film: 600 px of a diagonal of 800 px, 1.3 % off.
        focal_length_35mm: Some(32),
        gps: gps.map(|place| GpsPosition {
            latitude: place.latitude,
            longitude: place.longitude,
            altitude: place.height,
        }),
        rtk: pose.map(|_| [0.01, 0.01, 0.02]),
        dji: pose.map(|_| DjiGimbal {
            roll: 0.0,
            yaw: 0.0,
            pitch: -80.0,
            relative_altitude: 30.0,
        }),
        ..PhotoMetadata::default()
    }
}

pub(super) fn write(folder: &Path, name: &str, image: &RgbImage, pose: Option<&Pose>) {
    let bytes = jpeg(image, 92, &metadata(pose)).unwrap();
    fs::write(folder.join(name), bytes).unwrap();
}

/// Photos `IMG_1.jpg` to `IMG_9.jpg` and five that are none: a blank one, an empty file, one of another place, a
/// copy, and one of which the second half is missing.
pub(super) fn photos() -> &'static Path {
    static PHOTOS: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = PHOTOS.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        for (number, pose) in (1..).zip(&poses()) {
            let name = format!("IMG_{number}.jpg");
            write(folder.path(), &name, &photo(pose, 1), Some(pose));
        }
        let pose = &poses()[4];
        let blank = RgbImage::from_pixel(640, 480, Rgb([120, 120, 120]));
        write(folder.path(), "blank.jpg", &blank, Some(pose));
        write(folder.path(), "other.jpg", &photo(pose, 99), Some(pose));
        fs::write(folder.path().join("empty.jpg"), []).unwrap();
        let whole = folder.path().join("IMG_5.jpg");
        fs::copy(&whole, folder.path().join("copy of 5.jpg")).unwrap();
        let bytes = fs::read(whole).unwrap();
        fs::write(folder.path().join("cut.jpg"), &bytes[..bytes.len() / 2]).unwrap();
        folder
    });
    folder.path()
}
