//! How sure poses and lenses are after the adjustment: the inverse of its normal equations (Triggs,
//! McLauchlan, Hartley & Fitzgibbon, "Bundle Adjustment - A Modern Synthesis", 2000, section 6), whatever
//! engine solved it.
//!
//! Unknown are each photo's rotation (about its camera axes, radians) and centre, each camera's fx, fy, cx,
//! cy and first four coefficients, and the points, which are eliminated one by one. Known are where photos
//! see the points, with one standard deviation for all that the residuals themselves give, where receivers say the
//! cameras were, and how lenses are stated. Receivers' errors count as independent of each other: those of
//! a base station in the wrong place move all alike and are not in it.
//!
//! The matrix is dense: 500 photos are 3000 rows, 70 MB and half a minute.

use glam::{DMat3, DVec2, DVec3};
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::camera::{Brown, Camera, Distortion, Pose};
use crate::formats::{Observation, Reconstruction};

/// What receivers and makers say.
pub(crate) struct Known {
    /// Of each photo of the reconstruction: standard deviations of its centre, units of the world.
    pub(crate) centers: Vec<Option<DVec3>>,
    /// Of each camera: standard deviations that its lens has without any photo, fx fy cx cy k1 k2 p1 p2.
    pub(crate) lenses: Vec<[f64; LENS]>,
}

/// Standard deviations.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Deviations {
    /// Of each photo: its centre, units of the world, and rotations about its camera axes, radians.
    pub(crate) poses: Vec<(DVec3, DVec3)>,
    /// Of each camera's focal length, a part of it.
    pub(crate) focal: Vec<f64>,
    /// Of where a photo sees a point, pixels along each axis.
    pub(crate) pixel: f64,
}

/// Photos beyond which the matrix is not made.
const MOST_PHOTOS: usize = 1000;
/// Points whose blocks lie in memory together.
const AT_ONCE: usize = 4096;
/// Numbers of a pose, and of a lens.
const POSE: usize = 6;
const LENS: usize = 8;
/// Of a reconstruction in the world; `None` where fewer than three centres are known, so that the world
/// is not determined, where nothing was observed, or where it has too many photos.
pub(crate) fn deviations(model: &Reconstruction, known: &Known) -> Option<Deviations> {
    let photos = model.photos.len();
    let stated = known.centers.iter().flatten().count();
    if stated < 3 || photos > MOST_PHOTOS || model.observations.is_empty() {
        return None;
    }
    let pixel = pixel_deviation(model)?;
    let size = photos * POSE + model.cameras.len() * LENS;
    let mut normal = DMatrix::<f64>::zeros(size, size);
    let points = by_point(model);
    for some in points.chunks(AT_ONCE) {
        let blocks = some.par_iter().filter_map(|seen| block(model, seen));
        for block in blocks.collect::<Vec<_>>() {
            let unknowns = &block.unknowns;
            for (row, &a) in unknowns.iter().enumerate() {
                for (column, &b) in unknowns.iter().enumerate() {
                    normal[(a, b)] += block.normal[(row, column)];
                }
            }
        }
    }
    normal /= pixel * pixel;
    for (photo, center) in known.centers.iter().enumerate() {
        let Some(center) = center else { continue };
        for axis in 0..3 {
            let at = photo * POSE + 3 + axis;
            normal[(at, at)] += center[axis].max(1e-9).powi(-2);
        }
    }
    for (number, lens) in known.lenses.iter().enumerate() {
        for (place, deviation) in lens.iter().enumerate() {
            let at = photos * POSE + number * LENS + place;
            normal[(at, at)] += deviation.powi(-2);
        }
    }
    let covariance = inverse(normal)?;
    let deviation = |at: usize| covariance[(at, at)].max(0.0).sqrt();
    let three = |at: usize| DVec3::new(deviation(at), deviation(at + 1), deviation(at + 2));
    let focal = |(number, camera): (usize, &Camera)| {
        let at = photos * POSE + number * LENS;
        // Of the mean of both: they go together.
        let both =
            covariance[(at, at)] + covariance[(at + 1, at + 1)] + 2.0 * covariance[(at, at + 1)];
        both.max(0.0).sqrt() / (camera.fx + camera.fy)
    };
    Some(Deviations {
        poses: (0..photos)
            .map(|photo| (three(photo * POSE + 3), three(photo * POSE)))
            .collect(),
        focal: model.cameras.iter().enumerate().map(focal).collect(),
        pixel,
    })
}

/// Of a symmetric positive definite matrix, scaled to a diagonal of ones first: metres and coefficients
/// are far apart.
fn inverse(mut matrix: DMatrix<f64>) -> Option<DMatrix<f64>> {
    let size = matrix.nrows();
    let scale: Vec<f64> = (0..size)
        .map(|at| matrix[(at, at)].max(1e-300).sqrt().recip())
        .collect();
    let both = |row: usize, column: usize| scale[row] * scale[column];
    for column in 0..size {
        for row in 0..size {
            matrix[(row, column)] *= both(row, column);
        }
    }
    let mut inverse = matrix.cholesky()?.inverse();
    for column in 0..size {
        for row in 0..size {
            inverse[(row, column)] *= both(row, column);
        }
    }
    Some(inverse)
}

/// Standard deviation of an observation along an axis: the root of the sum of squares over what is left of
/// the numbers when the unknowns are taken off. Engines take away what lies pixels off, so that it is a
/// sum over good matches, long tails and all: a median would say half of it.
fn pixel_deviation(model: &Reconstruction) -> Option<f64> {
    let squares: Vec<f64> = model
        .observations
        .iter()
        .filter_map(|seen| {
            let (camera, pose, point) = of(model, seen);
            let pixel = camera.pixel_as_shot(pose.camera_from_world(point))?;
            Some(pixel.distance_squared(seen.pixel))
        })
        .collect();
    let unknown = model.photos.len() * POSE + model.cloud.points.len() * 3;
    let free = (2 * squares.len())
        .checked_sub(unknown)
        .filter(|&free| free > 0)?;
    // Exact data of tests have none.
    Some((squares.iter().sum::<f64>() / free as f64).sqrt().max(1e-6))
}

fn of<'a>(model: &'a Reconstruction, seen: &Observation) -> (&'a Camera, &'a Pose, DVec3) {
    let photo = &model.photos[seen.photo as usize];
    let camera = &model.cameras[photo.camera];
    (camera, &photo.pose, model.cloud.points[seen.point as usize])
}

/// What is left of a point's observations when the point is eliminated.
struct Block {
    /// Which unknowns of the whole.
    unknowns: Vec<usize>,
    normal: DMatrix<f64>,
}

/// The observations of each point, in the points' order: sums are the same on every run.
fn by_point(model: &Reconstruction) -> Vec<Vec<&Observation>> {
    let mut points = vec![Vec::new(); model.cloud.points.len()];
    for seen in &model.observations {
        if let Some(point) = points.get_mut(seen.point as usize) {
            point.push(seen);
        }
    }
    points
}

fn block(model: &Reconstruction, seen: &[&Observation]) -> Option<Block> {
    let photos = model.photos.len();
    let mut unknowns: Vec<usize> = Vec::new();
    let mut rows = Vec::with_capacity(seen.len());
    for seen in seen {
        let photo = seen.photo as usize;
        let camera = model.photos[photo].camera;
        let pose = (0..POSE).map(|place| photo * POSE + place);
        let lens = (0..LENS).map(|place| photos * POSE + camera * LENS + place);
        let of_row: Vec<usize> = pose.chain(lens).collect();
        for unknown in &of_row {
            if !unknowns.contains(unknown) {
                unknowns.push(*unknown);
            }
        }
        rows.push((of_row, derivatives(model, seen)?));
    }
    let mut jacobian = DMatrix::<f64>::zeros(2 * rows.len(), unknowns.len());
    let mut of_point = DMatrix::<f64>::zeros(2 * rows.len(), 3);
    for (number, (of_row, derivatives)) in rows.iter().enumerate() {
        for (unknown, derivative) in of_row.iter().zip(&derivatives.unknowns) {
            let column = unknowns.iter().position(|known| known == unknown)?;
            jacobian[(2 * number, column)] = derivative.x;
            jacobian[(2 * number + 1, column)] = derivative.y;
        }
        for (column, derivative) in derivatives.point.iter().enumerate() {
            of_point[(2 * number, column)] = derivative.x;
            of_point[(2 * number + 1, column)] = derivative.y;
        }
    }
    let across = jacobian.tr_mul(&of_point);
    let own = of_point.tr_mul(&of_point).try_inverse()?;
    let normal = jacobian.tr_mul(&jacobian) - &across * own * across.transpose();
    Some(Block { unknowns, normal })
}

/// Of a pixel, by ...
struct Derivatives {
    /// ... the numbers of its photo's pose and of its lens,
    unknowns: Vec<DVec2>,
    /// ... the coordinates of its point.
    point: [DVec2; 3],
}

fn derivatives(model: &Reconstruction, seen: &Observation) -> Option<Derivatives> {
    let (camera, pose, point) = of(model, seen);
    let at = pose.camera_from_world(point);
    // Central differences of a smooth function: exact to nine digits.
    let step = 1e-5 * at.length();
    let along = |axis: DVec3| {
        let ahead = camera.pixel_as_shot(at + axis * step)?;
        let behind = camera.pixel_as_shot(at - axis * step)?;
        Some((ahead - behind) / (2.0 * step))
    };
    let by_camera = [along(DVec3::X)?, along(DVec3::Y)?, along(DVec3::Z)?];
    let by = |way: DVec3| by_camera[0] * way.x + by_camera[1] * way.y + by_camera[2] * way.z;
    let camera_from_world: DMat3 = pose.rotation.transpose();
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    // Turning the camera by ω turns what it sees by -ω.
    let turned = axes.map(|axis| by(at.cross(axis)));
    let of_point = axes.map(|axis| by(camera_from_world * axis));
    let moved = of_point.map(|derivative| -derivative);
    let lens = by_lens(camera, at)?;
    Some(Derivatives {
        unknowns: turned.into_iter().chain(moved).chain(lens).collect(),
        point: of_point,
    })
}

/// By fx, fy, cx, cy, k1, k2, p1, p2.
fn by_lens(camera: &Camera, at: DVec3) -> Option<[DVec2; LENS]> {
    let mut all = [DVec2::ZERO; LENS];
    let steps = [1e-4 * camera.fx, 1e-4 * camera.fy, 1e-2, 1e-2];
    let steps = steps.into_iter().chain([1e-5; 4]).enumerate();
    for (place, step) in steps {
        let pixel = |step: f64| changed(camera, place, step).pixel_as_shot(at);
        all[place] = (pixel(step)? - pixel(-step)?) / (2.0 * step);
    }
    Some(all)
}

fn changed(camera: &Camera, place: usize, step: f64) -> Camera {
    let mut camera = camera.clone();
    match place {
        0 => camera.fx += step,
        1 => camera.fy += step,
        2 => camera.cx += step,
        3 => camera.cy += step,
        _ => {
            let mut coefficients = match &camera.distortion {
                Distortion::Brown(brown) => brown.coefficients(),
                _ => [0.0; 8],
            };
            coefficients[place - 4] += step;
            camera.distortion = Distortion::Brown(Brown::new(coefficients));
        }
    }
    camera
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::PosedPhoto;
    use crate::surface::Cloud;
    use fragscale_core::split_mix::SplitMix;

    fn model() -> Reconstruction {
        let mut random = SplitMix(5);
        let mut uniform = move || (random.next() >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        let lens = Brown::new([-0.05, 0.02, 1e-3, -5e-4, 0.0, 0.0, 0.0, 0.0]);
        let camera = Camera {
            name: "c".to_owned(),
            width: 1280,
            height: 720,
            fx: 1000.0,
            fy: 1001.0,
            cx: 640.0,
            cy: 360.0,
            skew: 0.0,
            distortion: Distortion::Brown(lens),
        };
        let photos = (0..5).map(|number| {
            let center = DVec3::new(
                f64::from(number) * 4.0 - 8.0,
                uniform() * 6.0,
                30.0 + uniform(),
            );
            let pose =
                Pose::from_tilt_pan(center, [80.0 + 10.0 * uniform(), 90.0 * f64::from(number)]);
            PosedPhoto {
                name: format!("{number}.jpg"),
                camera: 0,
                pose,
            }
        });
        let photos: Vec<PosedPhoto> = photos.collect();
        let points: Vec<DVec3> = (0..40)
            .map(|_| DVec3::new(uniform() * 16.0, uniform() * 10.0, uniform() * 4.0))
            .collect();
        let mut observations = Vec::new();
        for (photo, posed) in (0..).zip(&photos) {
            for (point, &at) in (0..).zip(&points) {
                let pixel = camera.pixel_as_shot(posed.pose.camera_from_world(at));
                // Off by a known length: that is what the deviation is found from.
                let off = DVec2::from_angle(uniform() * 6.0) * 0.8;
                observations.extend(pixel.map(|pixel| Observation {
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

    /// What the whole matrix gives, points and all, with derivatives by moving each number.
    #[test]
    fn deviations_are_those_of_the_whole_matrix() {
        let model = model();
        let lens = [30.0, 30.03, 6.4, 6.4, 1.0, 1.0, 0.01, 0.01_f64];
        let known = Known {
            centers: vec![Some(DVec3::new(0.02, 0.02, 0.04)); 5],
            lenses: vec![lens],
        };
        let found = deviations(&model, &known).unwrap();
        let (photos, points) = (model.photos.len(), model.cloud.points.len());
        let count = photos * 6 + 8 + points * 3;
        let pixels = |moved: Option<(usize, f64)>| -> Vec<DVec2> {
            let mut model = model.clone();
            let axis = |at: usize| DVec3::AXES[at % 3];
            match moved {
                Some((at, step)) if at < photos * 6 => {
                    let pose = &mut model.photos[at / 6].pose;
                    if at % 6 < 3 {
                        pose.rotation *= DMat3::from_axis_angle(axis(at % 6), step);
                    } else {
                        pose.center += axis(at % 6) * step;
                    }
                }
                Some((at, step)) if at < photos * 6 + 8 => {
                    model.cameras[0] = changed(&model.cameras[0], at - photos * 6, step);
                }
                Some((at, step)) => {
                    let at = at - photos * 6 - 8;
                    model.cloud.points[at / 3] += axis(at) * step;
                }
                None => {}
            }
            let seen = model.observations.iter().map(|seen| {
                let (camera, pose, point) = of(&model, seen);
                camera.pixel_as_shot(pose.camera_from_world(point)).unwrap()
            });
            seen.collect()
        };
        let rows = model.observations.len() * 2;
        let mut jacobian = DMatrix::<f64>::zeros(rows, count);
        for at in 0..count {
            let step = 1e-5;
            let (ahead, behind) = (pixels(Some((at, step))), pixels(Some((at, -step))));
            for (row, (a, b)) in ahead.iter().zip(&behind).enumerate() {
                jacobian[(2 * row, at)] = (a.x - b.x) / (2.0 * step);
                jacobian[(2 * row + 1, at)] = (a.y - b.y) / (2.0 * step);
            }
        }
        let mut normal = jacobian.tr_mul(&jacobian) / found.pixel.powi(2);
        for photo in 0..photos {
            for (axis, deviation) in [0.02_f64, 0.02, 0.04].into_iter().enumerate() {
                let at = photo * 6 + 3 + axis;
                normal[(at, at)] += deviation.powi(-2);
            }
        }
        for (place, deviation) in lens.into_iter().enumerate() {
            let at = photos * 6 + place;
            normal[(at, at)] += deviation.powi(-2);
        }
        let covariance = normal.try_inverse().unwrap();
        for (photo, (center, turn)) in found.poses.iter().enumerate() {
            for axis in 0..3 {
                for (part, at) in [(turn[axis], photo * 6), (center[axis], photo * 6 + 3)] {
                    let expected = covariance[(at + axis, at + axis)].sqrt();
                    assert!((part / expected - 1.0).abs() < 1e-4, "{part} {expected}");
                }
            }
        }
        // All residuals are 0.8 px long.
        let free = rows - photos * 6 - points * 3;
        let expected = (0.64 * model.observations.len() as f64 / free as f64).sqrt();
        assert!((found.pixel - expected).abs() < 1e-9, "{}", found.pixel);
        let lens = photos * 6;
        let both = covariance[(lens, lens)]
            + covariance[(lens + 1, lens + 1)]
            + 2.0 * covariance[(lens, lens + 1)];
        let expected = both.sqrt() / 2001.0;
        assert!((found.focal[0] / expected - 1.0).abs() < 1e-4, "{expected}");
        assert!(found.focal[0] < 0.03);
    }

    /// Without known centres there is no world to be sure in.
    #[test]
    fn two_centres_are_too_few() {
        let centers = [Some(DVec3::ONE), Some(DVec3::ONE), None, None, None].to_vec();
        let lenses = vec![[1.0; LENS]];
        assert_eq!(deviations(&model(), &Known { centers, lenses }), None);
    }
}
