//! The true scale of every part of a photo, and the best line through it (contract, section 7), by the
//! lab's own rays and by sums written out here: `scale` is to be tested against them.

use glam::{DMat2, DVec2};
use serde_json::{Value, json};

use super::Image;
use crate::camera::Camera;
use crate::geometry::Ray;
use crate::scene::SceneCaster;

/// Columns of the grid that the line is fitted to.
const COLUMNS: u32 = 64;

/// The step in pixels of the five-point derivative: its error is h^4 f'''''/30, under 1e-12 for lenses
/// that bend by some percent over a thousand pixels, as is the rounding of pixels / h.
const STEP: f64 = 1.0;

/// A place of the grid, and the scale there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    /// u / W and v / H.
    pub(super) place: DVec2,
    /// Pixels per metre; `None` where the ray misses.
    pub(super) scale: Option<f64>,
}

/// The best line through a photo's scale, pixels per metre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Fitted {
    pub(super) top: f64,
    pub(super) bottom: f64,
    /// Of line / scale - 1 over the samples.
    pub(super) rms_percent: f64,
    pub(super) worst_percent: f64,
    /// The share of the samples that have a scale.
    pub(super) covered: f64,
    /// How much the best plane changes from the left edge to the right, of the mean scale.
    pub(super) left_right_percent: f64,
}

impl Fitted {
    pub(super) fn to_json(self) -> Value {
        json!({
            "top": self.top,
            "bottom": self.bottom,
            "rms_percent": self.rms_percent,
            "worst_percent": self.worst_percent,
            "covered": self.covered,
            "left_right_percent": self.left_right_percent,
        })
    }
}

/// The scales over the grid of a photo, row by row. Ground and fragments are the surface here: both
/// are in the true mesh.
pub(super) fn samples(caster: &mut SceneCaster<'_>, image: &Image<'_>) -> Vec<Sample> {
    let camera = image.camera;
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    // `as` saturates; halves are rounded up.
    let rows = (f64::from(COLUMNS) * h / w + 0.5).floor().max(2.0) as u32;
    let mut samples = Vec::with_capacity((COLUMNS * rows) as usize);
    for row in 0..rows {
        for column in 0..COLUMNS {
            let place = DVec2::new(
                (f64::from(column) + 0.5) / f64::from(COLUMNS),
                (f64::from(row) + 0.5) / f64::from(rows),
            );
            let pixel = place * DVec2::new(w, h);
            let scale = scale_at(caster, image, pixel);
            samples.push(Sample { place, scale });
        }
    }
    samples
}

/// The scale at a pixel, pixels per metre: sqrt(fx fy) over the depth of what is seen there; of the
/// photo as shot, times by how much the lens stretches lengths there.
fn scale_at(caster: &mut SceneCaster<'_>, image: &Image<'_>, pixel: DVec2) -> Option<f64> {
    let camera = image.camera;
    let in_camera = image.direction(pixel)?;
    let stretched = match image.as_shot {
        true => area_stretched(camera, camera.pixel_undistorted(in_camera)?)?.sqrt(),
        false => 1.0,
    };
    let ray = Ray {
        origin: image.pose.center,
        direction: (image.pose.rotation * in_camera).normalize(),
    };
    let met = caster.cast_at_surface(&ray)?;
    let depth = met.t * in_camera.z / in_camera.length();
    Some((camera.fx * camera.fy).sqrt() / depth * stretched)
}

/// |det J| with J the derivative of the pixel as shot by the undistorted one. `None` where the lens
/// does not see two pixels to every side.
fn area_stretched(camera: &Camera, undistorted: DVec2) -> Option<f64> {
    let as_shot = |offset: DVec2| {
        let pixel = undistorted + offset * STEP;
        camera.pixel_as_shot(camera.direction_undistorted(pixel))
    };
    let derivative = |way: DVec2| {
        let near = as_shot(way)? - as_shot(-way)?;
        let far = as_shot(2.0 * way)? - as_shot(-2.0 * way)?;
        Some((8.0 * near - far) / (12.0 * STEP))
    };
    let jacobian = DMat2::from_cols(derivative(DVec2::X)?, derivative(DVec2::Y)?);
    Some(jacobian.determinant().abs())
}

/// The least-squares line over the samples that have a scale. `None` where these are fewer than half,
/// or in fewer than two rows.
pub(super) fn fitted(samples: &[Sample]) -> Option<Fitted> {
    let seen: Vec<(DVec2, f64)> = samples
        .iter()
        .filter_map(|sample| Some((sample.place, sample.scale?)))
        .collect();
    let count = seen.len() as f64;
    let covered = count / samples.len() as f64;
    let (first, _) = seen.first()?;
    let one_row = seen.iter().all(|(place, _)| place.y == first.y);
    if covered < 0.5 || one_row {
        return None;
    }
    let mean_place = seen.iter().map(|(place, _)| *place).sum::<DVec2>() / count;
    let mean_scale = seen.iter().map(|(_, scale)| scale).sum::<f64>() / count;
    // Sums of products of what is left when the means are taken away.
    let (mut uu, mut uv, mut vv, mut us, mut vs) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (place, scale) in &seen {
        let (off, more) = (*place - mean_place, scale - mean_scale);
        uu += off.x * off.x;
        uv += off.x * off.y;
        vv += off.y * off.y;
        us += off.x * more;
        vs += off.y * more;
    }
    let slope = vs / vv;
    let top = mean_scale - slope * mean_place.y;
    // Half of the grid lies neither in one row nor in one column nor on one slanting line.
    let left_right = (us * vv - vs * uv) / (uu * vv - uv * uv);
    let off_line = |(place, scale): &(DVec2, f64)| (top + slope * place.y) / scale - 1.0;
    let squares: f64 = seen.iter().map(|sample| off_line(sample).powi(2)).sum();
    let worst = seen.iter().map(|sample| off_line(sample).abs());
    Some(Fitted {
        top,
        bottom: top + slope,
        rms_percent: 100.0 * (squares / count).sqrt(),
        worst_percent: 100.0 * worst.fold(0.0, f64::max),
        covered,
        left_right_percent: 100.0 * left_right / mean_scale,
    })
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3, EulerRot};

    use super::*;
    use crate::camera::{Brown, Distortion, Fisheye, Pose};
    use crate::scene::pile::Pile;
    use crate::scene::terrain::Terrain;
    use crate::{Lens, PilePlan, Preset, Scene};

    fn near(found: f64, expected: f64, tolerance: f64) {
        let off = (found / expected - 1.0).abs();
        assert!(off < tolerance, "{found}, not {expected}");
    }

    /// A floor without a pile, 40 m to either side; of a muckpile's grain, in which its heights are kept.
    fn flat_floor() -> Scene {
        let recipe = Preset::Muckpile.recipe(Lens::None).unwrap();
        let plan = PilePlan {
            terrain: Terrain::Cone {
                height: 0.0,
                slope: 1.0,
            },
            half_extent: DVec2::ONE,
            ..recipe.pile
        };
        let (bodies, fragments) = (Vec::new(), Vec::new());
        Scene::new(Pile { bodies, fragments }, &plan, DVec2::splat(40.0)).unwrap()
    }

    /// A camera that is not square, looking down at a slant and rolled.
    fn view() -> (Camera, Pose) {
        let mut camera = Preset::Lab.recipe(Lens::None).unwrap().camera;
        camera.fy *= 1.25;
        camera.skew = 7.0;
        let rotation = DMat3::from_euler(EulerRot::ZXY, 0.7, 2.8, 0.15);
        let center = DVec3::new(0.3, -0.2, 1.7);
        (camera, Pose { rotation, center })
    }

    /// Over the plane z = 0 a ray K^-1 p, turned by R, meets it at the depth -c_z / (R K^-1 p)_z: the
    /// scale is linear in u and v, so line and plane are those of its corners.
    #[test]
    fn over_a_plane_the_fit_is_the_scale() {
        let (scene, (camera, pose)) = (flat_floor(), view());
        let mut caster = scene.caster().unwrap();
        let image = Image {
            camera: &camera,
            pose,
            as_shot: false,
        };
        let samples = samples(&mut caster, &image);
        assert_eq!(samples.len(), 64 * 36);
        let (w, h) = (1280.0, 720.0);
        let scale = |u: f64, v: f64| {
            let y = (v - camera.cy) / camera.fy;
            let x = (u - camera.cx - camera.skew * y) / camera.fx;
            let down = -(pose.rotation * DVec3::new(x, y, 1.0)).z;
            (camera.fx * camera.fy).sqrt() * down / pose.center.z
        };
        let fitted = fitted(&samples).unwrap();
        // By symmetry the line is that of the middle column.
        near(fitted.top, scale(w / 2.0, 0.0), 1e-10);
        near(fitted.bottom, scale(w / 2.0, h), 1e-10);
        assert_eq!(fitted.covered, 1.0);
        let across = scale(w, h / 2.0) - scale(0.0, h / 2.0);
        let middle = scale(w / 2.0, h / 2.0);
        assert!(across.abs() > 0.05 * middle);
        near(fitted.left_right_percent, 100.0 * across / middle, 1e-9);
        let (mut squares, mut worst) = (0.0, 0.0_f64);
        for row in 0..36 {
            for column in 0..64 {
                let (u, v) = (
                    20.0 * f64::from(column) + 10.0,
                    20.0 * f64::from(row) + 10.0,
                );
                let off = scale(w / 2.0, v) / scale(u, v) - 1.0;
                squares += off * off;
                worst = worst.max(off.abs());
            }
        }
        near(
            fitted.rms_percent,
            100.0 * (squares / 2304.0_f64).sqrt(),
            1e-9,
        );
        near(fitted.worst_percent, 100.0 * worst, 1e-9);
    }

    /// A pinhole's photo as shot is the undistorted one.
    #[test]
    fn a_pinhole_stretches_nothing() {
        let (scene, (camera, pose)) = (flat_floor(), view());
        let mut caster = scene.caster().unwrap();
        let mut fit = |as_shot| {
            let image = Image {
                camera: &camera,
                pose,
                as_shot,
            };
            fitted(&samples(&mut caster, &image)).unwrap()
        };
        let (ideal, shot) = (fit(false), fit(true));
        near(shot.top, ideal.top, 1e-11);
        near(shot.left_right_percent, ideal.left_right_percent, 1e-9);
    }

    /// Where the rays over the horizon are more than half, there is no line.
    #[test]
    fn the_sky_has_no_scale() {
        let scene = flat_floor();
        let mut caster = scene.caster().unwrap();
        let camera = Preset::Lab.recipe(Lens::Brown).unwrap().camera;
        for (tilt, fits) in [(2.0, true), (-2.0, false)] {
            let pose = Pose::from_tilt_pan(DVec3::new(0.0, 0.0, 0.5), [tilt, 0.0]);
            for as_shot in [false, true] {
                let image = Image {
                    camera: &camera,
                    pose,
                    as_shot,
                };
                let samples = samples(&mut caster, &image);
                assert!(samples.iter().any(|sample| sample.scale.is_none()));
                let fitted = fitted(&samples);
                assert_eq!(fitted.is_some(), fits, "{tilt}: {fitted:?}");
            }
        }
    }

    /// The derivative of OpenCV's formula (k4 to k6 zero), by hand; fx, fy and skew cancel.
    #[test]
    fn brown_stretches_by_its_derivative() {
        let camera = Preset::Lab.recipe(Lens::Brown).unwrap().camera;
        let Distortion::Brown(lens) = &camera.distortion else {
            panic!("a brown lens");
        };
        let [k1, k2, p1, p2, k3, ..] = lens.coefficients();
        for pixel in [
            (640.0, 360.0),
            (10.0, 10.0),
            (1270.0, 350.0),
            (333.0, 710.0),
        ] {
            let pixel = DVec2::from(pixel);
            let at = camera.direction_undistorted(pixel);
            let (x, y) = (at.x, at.y);
            let r2 = x * x + y * y;
            let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
            let slope = k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3);
            let xx = radial + 2.0 * x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x;
            let xy = 2.0 * x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
            let yy = radial + 2.0 * y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
            let found = area_stretched(&camera, pixel).unwrap();
            near(found, xx * yy - xy * xy, 1e-11);
        }
    }

    /// Radially by d theta_d / d r, across by theta_d / r, with r = tan(theta).
    #[test]
    fn a_fisheye_stretches_by_its_derivative() {
        let k = [-0.021, 0.006, -0.002, 0.0004];
        let camera = Camera {
            distortion: Distortion::Fisheye(Fisheye::new(k)),
            ..view().0
        };
        for pixel in [(10.0, 10.0), (1270.0, 350.0), (333.0, 710.0)] {
            let pixel = DVec2::from(pixel);
            let r = camera.direction_undistorted(pixel).truncate().length();
            let theta = r.atan();
            let t2 = theta * theta;
            let bent = theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
            let slope =
                1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])));
            let expected = slope / (1.0 + r * r) * (bent / r);
            near(area_stretched(&camera, pixel).unwrap(), expected, 1e-11);
        }
    }

    /// Beyond its fold a lens shows nothing.
    #[test]
    fn beyond_the_fold_nothing_is_stretched() {
        let lens = Brown::new([-0.9, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let camera = Camera {
            distortion: Distortion::Brown(lens),
            ..view().0
        };
        assert_eq!(area_stretched(&camera, DVec2::new(1280.0, 0.0)), None);
    }

    fn grid(scale: impl Fn(DVec2) -> Option<f64>) -> Vec<Sample> {
        let place = |i: u32| {
            let at = DVec2::new(f64::from(i % 64), f64::from(i / 64)) + 0.5;
            at / DVec2::new(64.0, 36.0)
        };
        (0..64 * 36)
            .map(|i| Sample {
                place: place(i),
                scale: scale(place(i)),
            })
            .collect()
    }

    /// With a corner missing the line is no longer that of the middle column, but what is left of it
    /// still has no mean and no slope; the plane stays the plane.
    #[test]
    fn with_parts_missing_it_is_still_the_least_squares_line() {
        let seen = |at: DVec2| at.x + at.y > 0.7;
        let scale = |at: DVec2| 30.0 + 4.0 * at.y + 2.0 * at.x;
        let samples = grid(|at| seen(at).then(|| scale(at)));
        let fitted = fitted(&samples).unwrap();
        let (mut sum, mut moment, mut count, mut scales) = (0.0, 0.0, 0.0, 0.0);
        for sample in &samples {
            if seen(sample.place) {
                let v = sample.place.y;
                let off = scale(sample.place) - (fitted.top * (1.0 - v) + fitted.bottom * v);
                sum += off;
                moment += off * v;
                count += 1.0;
                scales += scale(sample.place);
            }
        }
        assert!((fitted.bottom - fitted.top - 4.0).abs() > 0.1);
        assert!(sum.abs() < 1e-9 && moment.abs() < 1e-9, "{sum} {moment}");
        assert_eq!(fitted.covered, count / 2304.0);
        near(fitted.left_right_percent, 200.0 / (scales / count), 1e-11);
    }

    #[test]
    fn half_a_photo_has_a_line_and_less_has_none() {
        let below = |v: f64| move |at: DVec2| (at.y < v).then_some(30.0);
        assert_eq!(fitted(&grid(below(0.48))), None);
        let half = fitted(&grid(below(0.5))).unwrap();
        assert_eq!((half.covered, half.rms_percent), (0.5, 0.0));
        assert_eq!(fitted(&grid(|_| None)), None);
        assert_eq!(fitted(&[]), None);
        // One row says nothing of the other edge.
        let two_rows = |i: u32| Sample {
            place: DVec2::new(
                (f64::from(i % 64) + 0.5) / 64.0,
                0.25 + f64::from(i / 64) / 2.0,
            ),
            scale: (i < 64).then_some(30.0),
        };
        let mut samples: Vec<Sample> = (0..128).map(two_rows).collect();
        assert_eq!(fitted(&samples), None);
        samples[127].scale = Some(31.0);
        assert!(fitted(&samples).unwrap().bottom > 30.9);
    }
}
