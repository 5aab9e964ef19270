//! How long it takes to say how sure the poses of a survey are, beside nalgebra's own inverse (Cholesky, one processor) of a
//! matrix of as many rows, in one run.
//!
//! ```text
//! cargo bench -p fragscale-opening --bench covariance -- 100 300 1000
//! ```

#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::print_stdout,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

use std::hint::black_box;
use std::time::Instant;

use fragscale_core::camera::{Camera, Distortion, Pose};
use fragscale_core::jobs::Progress;
use fragscale_core::split_mix::SplitMix;
use fragscale_core::surface::Cloud;
use fragscale_formats::{Observation, PosedPhoto, Reconstruction};
use fragscale_opening::covariance::{Known, deviations, lens_deviations};
use glam::{DVec2, DVec3};
use nalgebra::DMatrix;

/// Photos in rows of twenty from 30 m, straight down, each over the next by three quarters, with 60 new points each.
fn survey(count: u32) -> Reconstruction {
    let mut random = SplitMix(16);
    let mut uniform = move || random.unit();
    let camera = Camera {
        name: "c".to_owned(),
        width: 4000,
        height: 3000,
        fx: 3000.0,
        fy: 3000.0,
        cx: 2000.0,
        cy: 1500.0,
        skew: 0.0,
        distortion: Distortion::None,
    };
    let photos = (0..count).map(|number| {
        let (column, row) = (f64::from(number % 20), f64::from(number / 20));
        let center = DVec3::new(10.0 * column, 7.5 * row, 30.0 + uniform());
        PosedPhoto {
            name: format!("{number}.jpg"),
            camera: 0,
            pose: Pose::from_tilt_pan(center, [90.0, 0.0]),
        }
    });
    let photos: Vec<PosedPhoto> = photos.collect();
    let points = photos.iter().flat_map(|photo| [photo.pose.center; 60]);
    let points: Vec<DVec3> = points
        .map(|at| {
            let across = DVec2::new(40.0 * uniform() - 20.0, 30.0 * uniform() - 15.0);
            DVec3::new(at.x + across.x, at.y + across.y, 3.0 * uniform())
        })
        .collect();
    let middle = DVec2::new(camera.cx, camera.cy);
    let mut observations = Vec::new();
    for (photo, posed) in (0..).zip(&photos) {
        for (point, &at) in (0..).zip(&points) {
            let pixel = camera.pixel_as_shot(posed.pose.camera_from_world(at));
            let seen = pixel.filter(|pixel| (pixel - middle).abs().cmple(middle).all());
            let off = DVec2::new(uniform() - 0.5, uniform() - 0.5);
            observations.extend(seen.map(|pixel| Observation {
                photo,
                point,
                pixel: pixel + off,
            }));
        }
    }
    Reconstruction {
        cameras: vec![camera],
        photos,
        cloud: Cloud {
            points,
            ..Cloud::default()
        },
        observations,
        ..Reconstruction::default()
    }
}

fn main() {
    let asked = std::env::args()
        .skip(1)
        .filter_map(|word| word.parse().ok());
    let asked: Vec<u32> = asked.collect();
    for count in if asked.is_empty() {
        vec![100, 300]
    } else {
        asked
    } {
        let model = survey(count);
        let known = Known {
            centers: vec![None; model.photos.len()],
            lenses: vec![lens_deviations(&model.cameras[0], 1.0)],
        };
        let start = Instant::now();
        let sure = deviations(&model, &known, &Progress::default()).unwrap();
        let own = start.elapsed().as_secs_f64();
        let sure = sure.expect("a survey that holds together");
        let rows = model.photos.len() * 6 + 8;
        let matrix = DMatrix::from_fn(rows, rows, |row, column| {
            (-0.1 * row.abs_diff(column) as f64).exp()
        });
        let start = Instant::now();
        black_box(matrix.cholesky().expect("positive definite").inverse());
        let library = start.elapsed().as_secs_f64();
        println!(
            "{count} photos, {} observations: {own:.2} s; nalgebra's inverse of {rows} rows {library:.2} s, {:.1} times as long; pixel {:.3}",
            model.observations.len(),
            library / own,
            sure.pixel,
        );
    }
}
