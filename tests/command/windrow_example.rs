//! A windrow of broken rock whose surface is a formula, so that every scale is known in closed form.
//!
//! ```text
//! z(x, y) = profile(x) + 0.02 y
//! ```
//!
//! with a profile of straight pieces: floor, a flank of 3/4 (36.9 degrees, the angle of repose of
//! crushed rock), a crest, a steeper flank of 4/5, floor. The points lie on a lattice on whose lines
//! the profile bends, so any triangulation of it is the formula itself.
//!
//! `FRAGSCALE_REGENERATE=1 cargo test --test windrow` writes the files anew.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::common::{scale, scales_json};
use glam::DVec3;

/// Where the profile bends: (x, z), metres.
const PROFILE: [(f64, f64); 6] = [
    (-1.6, 0.0),
    (-0.64, 0.0),
    (-0.32, 0.24),
    (0.24, 0.24),
    (0.54, 0.0),
    (1.6, 0.0),
];
const SLOPE: f64 = 0.02;
/// Half the extent of the surface in y.
const HALF_LENGTH: f64 = 1.2;

/// Planned three by three above the windrow; the UAV was a little beside, as UAVs are.
const POSES: [(&str, [f64; 3], [f64; 2]); 9] = [
    ("IMG_0001.jpg", [-0.652, -0.413, 0.752], [83.0, 1.2]),
    ("IMG_0002.jpg", [-0.005, -0.398, 0.747], [82.7, -0.8]),
    ("IMG_0003.jpg", [0.661, -0.405, 0.751], [83.2, 0.4]),
    ("IMG_0004.jpg", [0.648, -0.003, 0.744], [83.1, 179.3]),
    ("IMG_0005.jpg", [0.004, 0.008, 0.756], [82.9, 181.1]),
    ("IMG_0006.jpg", [-0.655, -0.006, 0.749], [83.0, 180.2]),
    ("IMG_0007.jpg", [-0.643, 0.402, 0.753], [83.3, -1.5]),
    ("IMG_0008.jpg", [0.009, 0.396, 0.748], [82.8, 0.9]),
    ("IMG_0009.jpg", [0.657, 0.407, 0.750], [83.0, 0.0]),
];

const WIDTH: f64 = 1280.0;
const HEIGHT: f64 = 720.0;
const FX: f64 = 1012.5;
const FY: f64 = 1011.25;
/// From the centre of the first pixel, as ROS counts.
const CX: f64 = 637.25;
const CY: f64 = 361.75;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/windrow")
}

fn profile(x: f64) -> f64 {
    let piece = PROFILE.windows(2).find(|ends| x <= ends[1].0);
    let [(x0, z0), (x1, z1)] = *piece.expect("on the profile") else {
        unreachable!("windows of two");
    };
    z0 + (z1 - z0) * ((x - x0) / (x1 - x0))
}

/// The texts of the flight's files.
fn files() -> Vec<(&'static str, String)> {
    // Hundredths of a metre, so that every coordinate is a short decimal number; the bends are
    // among them.
    let mut xs: Vec<i32> = (-160..=160).step_by(4).chain([54]).collect();
    xs.sort_unstable();
    let mut points = String::new();
    let mut count = 0;
    for &x in &xs {
        for y in (-120..=120).step_by(4) {
            let (x, y) = (f64::from(x) / 100.0, f64::from(y) / 100.0);
            let z = profile(x) + SLOPE * y;
            let z = (z * 1e6).round() / 1e6;
            let gray = 110 + ((x * 37.0).sin() * (y * 41.0).cos() * 30.0) as i32;
            writeln!(points, "{x} {y} {z} {gray} {gray} {}", gray - 8).expect("a String");
            count += 1;
        }
    }
    let pile = format!(
        "ply\nformat ascii 1.0\ncomment a windrow: z = profile(x) + {SLOPE} y\n\
         element vertex {count}\nproperty double x\nproperty double y\nproperty double z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n{points}"
    );
    let mut poses = "# world_from_camera as the UAV wrote it: metres, degrees\n\
        photo,x,y,z,tilt,pan\n"
        .to_owned();
    for (photo, [x, y, z], [tilt, pan]) in POSES {
        writeln!(poses, "{photo},{x},{y},{z},{tilt},{pan}").expect("a String");
    }
    let camera = format!(
        "image_width: 1280\nimage_height: 720\ncamera_name: bebop\n\
         camera_matrix:\n  rows: 3\n  cols: 3\n  data: [{FX}, 0, {CX}, 0, {FY}, {CY}, 0, 0, 1]\n\
         distortion_model: plumb_bob\n\
         distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.021, 0.011, 0.0004, -0.0003, 0]\n"
    );
    let flight = "format = 1\nname = \"Windrow\"\n\n[world]\nunit = \"m\"\nground = \"auto\"\n\n\
        [surface]\nfile = \"pile.ply\"\n\n[[camera]]\nfile = \"ost.yaml\"\n\n\
        [photos]\nposes = \"poses.csv\"\n"
        .to_owned();
    vec![
        ("pile.ply", pile),
        ("poses.csv", poses),
        ("ost.yaml", camera),
        ("flight.toml", flight),
    ]
}

#[test]
fn the_files_are_what_this_test_makes() {
    for (name, text) in files() {
        let path = folder().join(name);
        if std::env::var_os("FRAGSCALE_REGENERATE").is_some() {
            std::fs::create_dir_all(folder()).expect("the folder");
            std::fs::write(&path, &text).expect("the file");
        }
        let stored = std::fs::read_to_string(&path).expect("the stored file");
        assert!(stored == text, "{name} differs; regenerate it");
    }
}

/// The corner point by formula: the nearest of the ray's intersections with the six pieces.
fn corner_point(origin: DVec3, direction: DVec3) -> DVec3 {
    let mut nearest = f64::INFINITY;
    for ends in PROFILE.windows(2) {
        let ((x0, z0), (x1, z1)) = (ends[0], ends[1]);
        let rise = (z1 - z0) / (x1 - x0);
        // z0 + rise (x - x0) + SLOPE y = z along the ray.
        let above = origin.z - (z0 + rise * (origin.x - x0) + SLOPE * origin.y);
        let t = above / (rise * direction.x + SLOPE * direction.y - direction.z);
        let p = origin + direction * t;
        if t > 0.0 && (x0..=x1).contains(&p.x) && p.y.abs() <= HALF_LENGTH {
            nearest = nearest.min(t);
        }
    }
    assert!(nearest.is_finite(), "every corner is on the surface");
    origin + direction * nearest
}

/// Every scale agrees with its closed form to 1e-9, through the command and all of its readers.
#[test]
fn the_scales_are_known_in_closed_form() {
    let report = scales_json(&folder().join("flight.toml"), &["--unit", "m"]);
    assert_eq!(report["flight"], "Windrow");
    let photos = report["photos"].as_array().expect("photos");
    assert_eq!(photos.len(), POSES.len());
    for (photo, (name, center, [tilt, pan])) in photos.iter().zip(POSES) {
        assert_eq!(photo["photo"], name);
        let (sin_tilt, cos_tilt) = tilt.to_radians().sin_cos();
        let (sin_pan, cos_pan) = pan.to_radians().sin_cos();
        let forward = DVec3::new(sin_pan * cos_tilt, cos_pan * cos_tilt, -sin_tilt);
        let right = DVec3::new(cos_pan, -sin_pan, 0.0);
        let down = forward.cross(right);
        let corner = |u: f64, v: f64| {
            let (x, y) = ((u - CX - 0.5) / FX, (v - CY - 0.5) / FY);
            corner_point(DVec3::from_array(center), right * x + down * y + forward)
        };
        let (top_left, top_right) = (corner(0.0, 0.0), corner(WIDTH, 0.0));
        let (bottom_left, bottom_right) = (corner(0.0, HEIGHT), corner(WIDTH, HEIGHT));
        for (edge, pixels, from, to) in [
            ("top", WIDTH, top_left, top_right),
            ("bottom", WIDTH, bottom_left, bottom_right),
            ("left", HEIGHT, top_left, bottom_left),
            ("right", HEIGHT, top_right, bottom_right),
        ] {
            let expected = pixels / (to - from).length();
            let computed = scale(photo, edge).expect("a scale");
            assert!(
                (computed / expected - 1.0).abs() < 1e-9,
                "{name} {edge}: {computed} is not {expected}"
            );
        }
        assert!(
            photo["corners"]
                .as_array()
                .expect("corners")
                .iter()
                .all(|c| c["on"] == "surface")
        );
    }
}
