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
//! A scale hangs on where a camera stands to the pile, not on where both are in the world: what moves, turns and
//! stretches both alike is taken off (`datum.rs`; how sure the length of the world's unit is, is stated apart). And where a longer
//! focal length comes with a higher camera, the photos' scales stay: poses are stated as they are for a given
//! lens, and of the focal length besides how much of it is left in the scales.
//!
//! The matrix is dense: 1000 photos are 6000 rows of 290 MB, and 17 s on two processors (`benches/covariance.rs`).

mod datum;
mod inverse;

use std::f64::consts::SQRT_2;

use glam::{DMat3, DVec2, DVec3};
use nalgebra::DMatrix;
use rayon::prelude::*;

use self::datum::Shared;
use self::inverse::{inverse, small_inverse};
use crate::camera::{Brown, Camera, Distortion, Pose};
use crate::fault::Fault;
use crate::formats::{Observation, Reconstruction};
use crate::jobs::Progress;

/// What receivers and makers say.
pub struct Known {
    /// Of each photo of the reconstruction: standard deviations of its centre, units of the world.
    pub centers: Vec<Option<DVec3>>,
    /// Of each camera: standard deviations that its lens has without any photo, fx fy cx cy k1 k2 p1 p2.
    pub lenses: Vec<[f64; LENS]>,
}

/// Standard deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviations {
    /// Of each photo as it stands to the points, for a given lens: its centre, units of the world, and rotations about its
    /// camera axes, radians.
    pub poses: Vec<(DVec3, DVec3)>,
    /// Of each camera's focal length, a part of it.
    pub focal: Vec<f64>,
    /// How much of that is left in the scales of its photos, whose poses go with it, a part of them.
    pub focal_in_scales: Vec<f64>,
    /// Of where a photo sees a point, pixels along each axis.
    pub pixel: f64,
}

/// What a lens's fx, fy, cx, cy, k1, k2, p1, p2 may be off without any photo, standard deviations; of its `focal` length so large
/// a part.
///
/// A survey seen straight down says little of a focal length and less of the principal point, which turns with
/// the tangential coefficients: of four photos of a real survey all were free to go, 2 degrees off what the whole
/// survey says. So the principal point is within 1 % of the middle and the tangential coefficients within
/// 0.002, as those of drones are; the radial ones are free.
pub fn lens_deviations(camera: &Camera, focal: f64) -> [f64; LENS] {
    let middle = 0.005 * f64::from(camera.width.max(camera.height));
    // Two numbers that are wrong alike: of both together no more is known than of one.
    let [fx, fy] = [camera.fx, camera.fy].map(|length| focal * length * SQRT_2);
    [fx, fy, middle, middle, 0.3, 0.3, 0.001, 0.001]
}

/// Photos beyond which the matrix is not made.
pub(crate) const MOST_PHOTOS: usize = 1000;
/// So many points of a photo err each by itself: those of thousands err as their neighbours do (what the lens's formula leaves
/// over, a shutter that rolls, light), and say no more together. Four real photos of 1500 points each called their lens a sixth too
/// long and sure of it to 3 %; in simulated ones, which err each by itself, what is stated is too much by so much.
const INDEPENDENT: f64 = 200.0;
/// Points that are 10 000 times less sure along one direction than along another (here: its square) say nothing.
const LEAST_STRENGTH: f64 = 1e-8;
/// Points whose blocks lie in memory together.
const AT_ONCE: usize = 4096;
/// Numbers of a pose, and of a lens.
const POSE: usize = 6;
const LENS: usize = 8;
/// Fewer known centres do not say where the model is; then it is held for an inverse to be, which nothing is left of when the
/// datum is taken off.
const LEAST_KNOWN: usize = 3;

/// Of a reconstruction; `None` where nothing was observed, or where it has too many photos.
///
/// # Errors
/// Where it is cancelled.
pub fn deviations(
    model: &Reconstruction,
    known: &Known,
    progress: &Progress,
) -> Result<Option<Deviations>, Fault> {
    let photos = model.photos.len();
    if photos > MOST_PHOTOS || model.observations.is_empty() {
        return Ok(None);
    }
    let points = by_point(model);
    let Some(pixel) = pixel_deviation(model, &points) else {
        return Ok(None);
    };
    let counted = counted_deviation(pixel, model.observations.len(), photos);
    let (normal, shared) = normal_equations(model, known, &points, counted, progress)?;
    let Some(mut covariance) = inverse(normal, progress)? else {
        return Ok(None);
    };
    Ok(shared
        .take_off(&mut covariance, counted)
        .and_then(|()| of_covariance(model, &covariance, pixel)))
}

/// Of poses and lenses, the points eliminated.
fn normal_equations(
    model: &Reconstruction,
    known: &Known,
    points: &[Vec<&Observation>],
    pixel: f64,
    progress: &Progress,
) -> Result<(DMatrix<f64>, Shared), Fault> {
    let photos = model.photos.len();
    let size = photos * POSE + model.cameras.len() * LENS;
    let mut normal = DMatrix::<f64>::zeros(size, size);
    let mut shared = Shared::new(model, size);
    for (number, some) in points.chunks(AT_ONCE).enumerate() {
        progress.advance((number * AT_ONCE) as u64, points.len() as u64)?;
        let blocks = some.par_iter().filter_map(|seen| block(model, seen));
        for block in blocks.collect::<Vec<_>>() {
            shared.count(&block);
            let unknowns = &block.unknowns;
            for (row, &a) in unknowns.iter().enumerate() {
                for (column, &b) in unknowns.iter().enumerate() {
                    normal[(a, b)] += block.normal[(row, column)];
                }
            }
        }
    }
    normal /= pixel * pixel;
    if known.centers.iter().flatten().count() < LEAST_KNOWN {
        shared.hold(&mut normal);
    } else {
        for (photo, center) in known.centers.iter().enumerate() {
            let axes = center.iter().flat_map(DVec3::to_array).enumerate();
            for (axis, deviation) in axes {
                let at = photo * POSE + 3 + axis;
                normal[(at, at)] += deviation.max(1e-9).powi(-2);
            }
        }
    }
    for (number, lens) in known.lenses.iter().enumerate() {
        for (place, deviation) in lens.iter().enumerate() {
            let at = photos * POSE + number * LENS + place;
            normal[(at, at)] += deviation.powi(-2);
        }
    }
    Ok((normal, shared))
}

/// What the covariance of all unknowns says; `None` where nothing is known of the lenses.
fn of_covariance(
    model: &Reconstruction,
    covariance: &DMatrix<f64>,
    pixel: f64,
) -> Option<Deviations> {
    let photos = model.photos.len();
    let lenses = photos * POSE..covariance.nrows();
    let lens = covariance.view_range(lenses.clone(), lenses.clone());
    let lens_inverse = small_inverse(lens.into_owned())?;
    let depths = depths(model);
    let mut poses = Vec::with_capacity(photos);
    // Of each camera: the sum over its photos of what is left in their scales, squared, and how many they are.
    let mut left = vec![(0.0, 0); model.cameras.len()];
    for (number, photo) in model.photos.iter().enumerate() {
        let own = number * POSE..(number + 1) * POSE;
        // How the pose goes with the lenses.
        let with = covariance.view_range(own.clone(), lenses.clone()) * &lens_inverse;
        let given = covariance.view_range(own.clone(), own.clone())
            - &with * covariance.view_range(lenses.clone(), own.clone());
        let deviation = |at: usize| given[(at, at)].max(0.0).sqrt();
        let three = |at: usize| DVec3::new(deviation(at), deviation(at + 1), deviation(at + 2));
        poses.push((three(3), three(0)));
        let Some(depth) = depths[number] else {
            continue;
        };
        // The logarithm of focal length over depth, by the lenses.
        let axis = photo.pose.rotation.z_axis / depth;
        let mut by_lens = with.rows(3, 3).transpose() * nalgebra::Vector3::from(axis.to_array());
        let camera = &model.cameras[photo.camera];
        for place in 0..2 {
            by_lens[photo.camera * LENS + place] += (camera.fx + camera.fy).recip();
        }
        let lens = covariance.view_range(lenses.clone(), lenses.clone());
        left[photo.camera].0 += (by_lens.transpose() * lens * &by_lens)[(0, 0)].max(0.0);
        left[photo.camera].1 += 1;
    }
    let focal = |(number, camera): (usize, &Camera)| {
        let at = photos * POSE + number * LENS;
        // Of the mean of both: they go together.
        let both =
            covariance[(at, at)] + covariance[(at + 1, at + 1)] + 2.0 * covariance[(at, at + 1)];
        both.max(0.0).sqrt() / (camera.fx + camera.fy)
    };
    let focal: Vec<f64> = model.cameras.iter().enumerate().map(focal).collect();
    let in_scales = left.iter().zip(&focal).map(|(&(sum, count), focal)| {
        // Of a camera without photos that see anything nothing is made up for.
        match count {
            0 => *focal,
            count => (sum / f64::from(count)).sqrt(),
        }
    });
    Some(Deviations {
        poses,
        focal_in_scales: in_scales.collect(),
        focal,
        pixel,
    })
}

/// Of each photo the mean depth of what it sees.
fn depths(model: &Reconstruction) -> Vec<Option<f64>> {
    let mut sums = vec![(0.0, 0); model.photos.len()];
    for seen in &model.observations {
        let (_, pose, point) = of(model, seen);
        let sum = &mut sums[seen.photo as usize];
        sum.0 += pose.camera_from_world(point).z;
        sum.1 += 1;
    }
    let mean = |(sum, count): (f64, i32)| (count > 0).then(|| sum / f64::from(count));
    sums.into_iter().map(mean).collect()
}

/// Standard deviation of an observation along an axis: the root of the sum of squares over what is left of
/// the numbers when the unknowns are taken off. Engines take away what lies pixels off, so that it is a
/// sum over good matches, long tails and all: a median would say half of it.
fn pixel_deviation(model: &Reconstruction, points: &[Vec<&Observation>]) -> Option<f64> {
    let off = points.iter().flatten();
    let off = off.filter_map(|seen| model.reprojection_px(seen));
    deviation_of_pixels(off, model.photos.len(), points.len())
}

/// The same of how far observations lie `off`, pixels, when so many photos' poses and points were fitted to them; `None`
/// where nothing is left over.
pub fn deviation_of_pixels(
    off: impl Iterator<Item = f64>,
    photos: usize,
    points: usize,
) -> Option<f64> {
    let (squares, count) = off.fold((0.0, 0_usize), |(sum, count), off| {
        (sum + off * off, count + 1)
    });
    let free = (2 * count)
        .checked_sub(photos * POSE + points * 3)
        .filter(|&free| free > 0)?;
    // Exact data of tests have none.
    Some((squares / free as f64).sqrt().max(1e-6))
}

/// As what a deviation of a pixel counts beside what else is known, where so many observations are of so many photos: of a photo's
/// 200 err each by itself, and more say no more.
pub fn counted_deviation(pixel: f64, observations: usize, photos: usize) -> f64 {
    let each = observations as f64 / photos.max(1) as f64;
    pixel * (each / INDEPENDENT).max(1.0).sqrt()
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
    /// Where the point is, ...
    at: DVec3,
    /// ... how it moves with the unknowns, ...
    by_unknowns: DMatrix<f64>,
    /// ... and its own covariance where they are known, for a deviation of a pixel of 1.
    own: DMatrix<f64>,
}

/// The observations of each point that is seen more than once, in the points' order: sums are the same on every run. What
/// is seen once is nowhere, and its residual says nothing.
fn by_point(model: &Reconstruction) -> Vec<Vec<&Observation>> {
    let mut points = vec![Vec::new(); model.cloud.points.len()];
    for seen in &model.observations {
        if let Some(point) = points.get_mut(seen.point as usize) {
            point.push(seen);
        }
    }
    points.retain(|seen| seen.len() > 1);
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
    let normal_of_point = of_point.tr_mul(&of_point);
    let strengths = normal_of_point.symmetric_eigenvalues();
    // Photos that look along one line, or one that shows the point twice.
    if strengths.min() < LEAST_STRENGTH * strengths.max() {
        return None;
    }
    let own = normal_of_point.try_inverse()?;
    let by_unknowns = -&own * across.transpose();
    let normal = jacobian.tr_mul(&jacobian) + across * &by_unknowns;
    let (_, _, at) = of(model, seen.first()?);
    Some(Block {
        unknowns,
        normal,
        at,
        by_unknowns,
        own,
    })
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
    if !matches!(camera.distortion, Distortion::None | Distortion::Brown(_)) {
        // Another model's lens is off by the same terms.
        let focal = DVec2::new(camera.fx, camera.fy);
        let plane = (camera.pixel_as_shot(at)? - DVec2::new(camera.cx, camera.cy)) / focal;
        let (far, across) = (plane.length_squared(), 2.0 * plane.x * plane.y);
        let tangential = |along: f64| far + 2.0 * along * along;
        let terms = [
            plane * far,
            plane * far * far,
            DVec2::new(across, tangential(plane.y)),
            DVec2::new(tangential(plane.x), across),
        ];
        for (by, term) in all.iter_mut().skip(4).zip(terms) {
            *by = term * focal;
        }
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
pub(crate) mod tests;
