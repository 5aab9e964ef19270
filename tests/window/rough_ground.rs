//! Photos of rough ground that overlap, made in a blink: a height in closed form, with a texture of all
//! sizes, seen from above by a pinhole whose receiver knows where it is.

use std::fs;
use std::path::Path;

use fragscale::sample::files::photo::jpeg;
use fragscale::sample::files::photo_metadata::{DjiGimbal, GpsPosition, PhotoMetadata};
use glam::{DVec2, DVec3};
use image::{Rgb, RgbImage};

/// The camera's focal length and image, pixels.
pub const FOCAL: f64 = 640.0;
const SIZE: [u32; 2] = [640, 480];

/// The cameras' height over the ground's mean, metres.
pub const HEIGHT: f64 = 10.0;

/// Writes six photos: two rows of three, 70 % of each on its neighbour.
pub fn photograph(folder: &Path) {
    fs::create_dir_all(folder).expect("a folder");
    for number in 0..6_u32 {
        let center = DVec2::new(f64::from(number % 3) * 3.0, f64::from(number / 3) * 2.3);
        let path = folder.join(format!("DJI_{:04}.jpg", number + 1));
        let bytes = jpeg(&seen_from(center), 95, &stated(center)).expect("a photo");
        fs::write(path, bytes).expect("written");
    }
}

fn seen_from(center: DVec2) -> RgbImage {
    let half = DVec2::new(f64::from(SIZE[0]), f64::from(SIZE[1])) / 2.0;
    RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        // North is up in the photo.
        let slope = (pixel - half) / FOCAL * DVec2::new(1.0, -1.0);
        let mut depth = HEIGHT;
        for _ in 0..20 {
            depth = HEIGHT - height(center + slope * depth);
        }
        Rgb([texture(center + slope * depth); 3])
    })
}

/// Of the ground, metres; its mean is zero.
fn height(at: DVec2) -> f64 {
    0.5 * (1.1 * at.x + 0.3).sin() * (0.9 * at.y).cos() + 0.4 * (0.7 * at.y + 0.4 * at.x).sin()
}

fn texture(at: DVec2) -> u8 {
    let octaves = [1.3, 0.5, 0.2, 0.08, 0.04];
    let sum: f64 = octaves.iter().map(|cell| noise(at / *cell)).sum();
    (127.0 + 110.0 * (sum / 5.0 - 0.5) * 2.2).clamp(0.0, 255.0) as u8
}

/// Random numbers 0 to 1 on a grid, and smooth between.
fn noise(at: DVec2) -> f64 {
    let corner = at.floor();
    let part = at - corner;
    let part = part * part * (DVec2::splat(3.0) - 2.0 * part);
    let of = |x: f64, y: f64| {
        let (x, y) = ((corner.x + x) as i64, (corner.y + y) as i64);
        let mut hash = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
            ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
        hash = (hash ^ (hash >> 31)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((hash ^ (hash >> 29)) % 1000) as f64 / 999.0
    };
    let row = |y: f64| of(0.0, y) * (1.0 - part.x) + of(1.0, y) * part.x;
    row(0.0) * (1.0 - part.y) + row(1.0) * part.y
}

/// With RTK, on the equator, where a metre is the same part of a degree both ways within 1 %.
fn stated(center: DVec2) -> PhotoMetadata {
    let at = DVec3::new(center.x, center.y, HEIGHT);
    // WGS 84: 6378137 m along the equator; north of it a degree is 110574 m.
    let longitude = 15.0 + at.x / 111_319.49;
    let latitude = at.y / 110_574.3;
    PhotoMetadata {
        make: Some("DJI".to_owned()),
        model: Some("FC6310R".to_owned()),
        focal_length_mm: Some(24.0),
        // The diagonal of 35 mm film is 43.27 mm, that of the photo 800 px.
        focal_length_35mm: Some(35),
        gps: Some(GpsPosition {
            latitude,
            longitude,
            altitude: at.z,
        }),
        rtk: Some([0.015, 0.015, 0.025]),
        dji: Some(DjiGimbal {
            roll: 0.0,
            yaw: 0.0,
            pitch: -90.0,
            relative_altitude: at.z,
        }),
        ..PhotoMetadata::default()
    }
}
