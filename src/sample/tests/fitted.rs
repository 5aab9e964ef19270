//! The truth's best lines against sums over the written mesh, by the program's rays.

use glam::DMat3;

use super::*;
use crate::surface::Surface;

/// A photo's line by its normal equations over the contract's grid, with what the program reads back;
/// as [top, bottom, rms, worst, covered, left to right].
fn line(surface: &Surface, camera: &Camera, pose: &camera::Pose, as_shot: bool) -> [f64; 6] {
    let mut caster = surface.caster_for(64 * 36).unwrap();
    let mut seen = Vec::new();
    for j in 0..36 {
        for i in 0..64 {
            let place = DVec2::new((f64::from(i) + 0.5) / 64.0, (f64::from(j) + 0.5) / 36.0);
            let pixel = place * DVec2::new(1280.0, 720.0);
            let along = match as_shot {
                true => camera.direction_as_shot(pixel).unwrap(),
                false => camera.direction_undistorted(pixel),
            };
            let ray = Ray {
                origin: pose.center,
                direction: pose.rotation * along,
            };
            let Some(hit) = caster.cast(&ray) else {
                continue;
            };
            let depth = pose.camera_from_world(hit.point).z;
            let mut scale = (camera.fx * camera.fy).sqrt() / depth;
            if as_shot {
                // How small a square of a pixel as shot is without its lens, whose inverse is good to
                // 1e-9 px: steps of some pixels, and of fourth order.
                let ideal = |offset: DVec2| {
                    let direction = camera.direction_as_shot(pixel + offset).unwrap();
                    camera.pixel_undistorted(direction).unwrap()
                };
                let along = |way: DVec2| {
                    let near = ideal(way) - ideal(-way);
                    let far = ideal(way * 2.0) - ideal(way * -2.0);
                    (near * 8.0 - far) / 12.0
                };
                let (across, down) = (along(DVec2::X * 2.0) / 2.0, along(DVec2::Y * 2.0) / 2.0);
                scale /= across.perp_dot(down).sqrt();
            }
            seen.push((place, scale));
        }
    }
    let count = seen.len() as f64;
    let mut normal = DMat3::ZERO;
    let mut right = DVec3::ZERO;
    for (place, scale) in &seen {
        let row = DVec3::new(1.0, place.y, place.x);
        normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
        right += row * *scale;
    }
    let plane = normal.inverse() * right;
    let (n, v, vv) = (normal.x_axis.x, normal.x_axis.y, normal.y_axis.y);
    let top = (vv * right.x - v * right.y) / (n * vv - v * v);
    let slope = (n * right.y - v * right.x) / (n * vv - v * v);
    let (mut squares, mut worst) = (0.0, 0.0_f64);
    for (place, scale) in &seen {
        let off = 100.0 * ((top + slope * place.y) / scale - 1.0);
        squares += off * off;
        worst = worst.max(off.abs());
    }
    [
        top,
        top + slope,
        (squares / count).sqrt(),
        worst,
        count / 2304.0,
        100.0 * plane.z * count / right.x,
    ]
}

/// The true mesh as it was written and is read back has the lines of truth.json.
pub(super) fn assert_truth_is_that_of_the_written_mesh(folder: &Path) {
    let opened = open_flight(folder, &OpenOptions::default(), &Progress::default()).unwrap();
    let parts = opened.flight.parts();
    let truth = truth_of(folder);
    for (index, photo) in parts.photos.iter().enumerate() {
        let camera = &parts.cameras[photo.camera];
        for (image, as_shot) in [("undistorted", false), ("as_shot", true)] {
            let found = line(&parts.surface, camera, &photo.pose, as_shot);
            let fitted = &truth["photos"][index][image]["fitted"];
            let keys = [
                "top",
                "bottom",
                "rms_percent",
                "worst_percent",
                "covered",
                "left_right_percent",
            ];
            for (key, found) in keys.into_iter().zip(found) {
                let expected = fitted[key].as_f64().unwrap();
                // Of percents the ninth digit of the scale.
                let of = if key.ends_with("percent") {
                    100.0
                } else {
                    expected
                };
                assert!(
                    (found - expected).abs() < 1e-9 * of,
                    "{} {image} {key}: {found}, not {expected}",
                    photo.name
                );
            }
        }
    }
}
