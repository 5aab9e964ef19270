//! The surface's part in a photo's error, from the cloud itself.
//!
//! How far the points of the cloud lie from what the points around them predict (`surface::LeftOut`) is,
//! seen by the photo, a draw from the error of the depth at its pixels. What lies deep between fragments has few points,
//! so the surface runs above it and scales are too large: `unseen`.
//!
//! Points of a dense cloud lie on one stone with those around them, which predict them ever better the more there
//! are, while what is between the stones stays as it is. So of a dense cloud so many points are looked at as a
//! sparse one has, as if there were no others: what is unseen then is the same share of the errors for
//! 15 000 points as for 800 000 (of simulated piles, 0.29 to 0.37).

use glam::{DMat3, DVec2, DVec3};

use super::LEAST_POINTS;
use super::point_noise::{MOST_TRIANGLES, PointNoise};
use crate::geometry::Bounds;
use crate::scale::field::ScaleField;
use crate::scale::pyramid::Pyramid;
use crate::surface::{LeftOut, Patch, Surface};

/// Of more points in a photo only so many tell of it.
pub(super) const MOST_POINTS: usize = 4000;

/// What is off by more than so many times what nine in ten points are off by at most is no surface: points that fly between
/// pile and camera would make it say nothing of the others.
pub(super) const FLYING: f64 = 5.0;

/// A piece of a mesh that stands across the photo's plane counts as one at this cosine does, at most.
const MOST_ACROSS: f64 = 0.1;

/// By how much of a cell the squares are shifted that points twice as far apart are chosen from.
pub(super) const SHIFTED: [DVec2; 4] = [
    DVec2::ZERO,
    DVec2::new(0.5, 0.0),
    DVec2::new(0.0, 0.5),
    DVec2::new(0.5, 0.5),
];

/// The root mean square of depth errors over what the photo shows; `None` where they are too few.
pub(super) fn root_mean_square(depths: &[DepthError]) -> Option<f64> {
    mean_of(depths, |error| error.relative.powi(2)).map(f64::sqrt)
}

/// The mean of depth errors over what the photo shows: where a sparse cloud cuts the tops of stones off, it is below 0.
pub(super) fn mean(depths: &[DepthError]) -> Option<f64> {
    mean_of(depths, |error| error.relative)
}

/// The mean over what the photo shows of something at each point.
fn mean_of(depths: &[DepthError], of: impl Fn(&DepthError) -> f64) -> Option<f64> {
    let all: f64 = depths.iter().map(|error| error.area).sum();
    let sum: f64 = depths.iter().map(|error| error.area * of(error)).sum();
    (depths.len() >= LEAST_POINTS && all > 0.0).then_some(sum / all)
}

/// As many points of equal areas would tell as much.
pub(super) fn effective_count(depths: &[DepthError]) -> f64 {
    let all: f64 = depths.iter().map(|error| error.area).sum();
    let squares: f64 = depths.iter().map(|error| error.area.powi(2)).sum();
    match squares > 0.0 {
        true => all * all / squares,
        false => 0.0,
    }
}

/// Depth errors, those of flying points moved to where they begin: for what is said of a whole photo. What a corner hangs on may
/// as well be the rim of a block.
pub(super) fn without_flying(errors: &[DepthError]) -> Vec<DepthError> {
    let mut sizes: Vec<f64> = errors.iter().map(|error| error.relative.abs()).collect();
    let mut errors = errors.to_vec();
    let place = sizes.len() * 9 / 10;
    if place < sizes.len() {
        let most = FLYING * *sizes.select_nth_unstable_by(place, f64::total_cmp).1;
        for error in errors.iter_mut().filter(|_| most > 0.0) {
            error.relative = error.relative.clamp(-most, most);
        }
    }
    errors
}

/// The surface's error at one place of a photo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DepthError {
    /// In the image.
    pub(super) pixel: DVec2,
    /// The true depth over the predicted one, less 1: by so much scales are too large.
    pub(super) relative: f64,
    /// How much of the photo the triangles at the point take: over the photo's plane, but for a factor of the whole photo.
    pub(super) area: f64,
}

/// The plane that lies best through a photo's field, in camera axes: m·X = 1, so that the inverse of the
/// depth along (x, y, 1) is m·(x, y, 1). `None` where the field has too few points.
pub(super) fn plane_of(field: &ScaleField) -> Option<DVec3> {
    let mut normal = DMat3::ZERO;
    let mut right = DVec3::ZERO;
    for row in 0..field.grid.rows {
        for column in 0..field.grid.columns {
            let depth = field.depth_at(column, row);
            if let (Some(depth), Some(d)) = (depth, field.direction_at(column, row)) {
                normal += DMat3::from_cols(d * d.x, d * d.y, d * d.z);
                right += d / depth;
            }
        }
    }
    let plane = normal.inverse() * right;
    (normal.determinant() > 0.0 && plane.is_finite()).then_some(plane)
}

/// The tangent of the angle between a ray and the normal of a plane m·X = 1: 0 of who looks straight down on it.
pub(super) fn tan_of_incidence(plane: DVec3, ray: DVec3) -> f64 {
    plane.cross(ray).length() / plane.dot(ray).abs().max(f64::MIN_POSITIVE)
}

/// How far the points that a photo shows lie from what the points around them predict.
#[derive(Debug, Clone, Default)]
pub(super) struct DepthErrors {
    /// At each of them; of more than twice [`MOST_POINTS`] of a cloud at each of about so many, spread evenly, as if there
    /// were no others.
    pub(super) each: Vec<DepthError>,
    /// The same with points twice as far apart, at each of which there are in [`SHIFTED`] choices of them; none of a
    /// surface that came with its faces.
    pub(super) sparser: Vec<DepthError>,
    /// How far points of one place lie apart; nothing of a surface that came with its faces.
    pub(super) noise: PointNoise,
}

impl DepthErrors {
    /// Of the photo of a field.
    pub(super) fn of(field: &ScaleField, plane: DVec3, surface: &Surface) -> Self {
        let (camera, pose) = (field.camera(), field.pose());
        let center = surface.frame().local_from_world(pose.center);
        let seen = Pyramid::of_image(camera, center, pose.rotation);
        let camera_from_local = pose.rotation.transpose();
        let up = camera_from_local * DVec3::Z;
        let seen_at = |point: DVec3| {
            let seen = camera_from_local * (point - center);
            let pixel = field.image().pixel(camera, seen)?;
            camera.contains(pixel).then_some((pixel, seen.z))
        };
        let error = |left_out: &LeftOut| {
            // m·(X - h up) = 1: moved up by h, the plane's depth along a ray grows by the share h m·up.
            let along_up = plane.dot(camera_from_local * left_out.up);
            let relative = -left_out.above * along_up;
            // A point high above its neighbours may lie where they predict nothing: at the camera.
            let predicted = (1.0 + relative).max(0.1);
            let (pixel, depth) = seen_at(left_out.point)?;
            Some(DepthError {
                pixel,
                relative: 1.0 / predicted - 1.0,
                // A piece of the plane n·X = D takes D / (|n·up| z³) of the image plane for each of its area across up.
                area: left_out.star * plane.length()
                    / along_up.abs().max(MOST_ACROSS * plane.length())
                    / depth.powi(3),
            })
        };
        // The field has triangulated what the photo sees, so nothing can fail here.
        let patches = surface.patches().seen(|bounds| seen.misses(bounds));
        let patches = patches.unwrap_or_default();
        let left_out = Patch::left_out(&patches);
        if !surface.is_cloud() {
            return Self {
                each: left_out.filter_map(|left_out| error(&left_out)).collect(),
                ..Self::default()
            };
        }
        let count: usize = patches.iter().map(Patch::len).sum();
        let misses = |bounds: &Bounds| seen.misses(bounds);
        let triangles = patches
            .iter()
            .flat_map(|patch| patch.triangles_seen(misses));
        let triangles = triangles.step_by((count / MOST_TRIANGLES).max(1));
        let in_photo = |corner: &DVec3| seen_at(*corner).is_some();
        let triangles: Vec<[DVec3; 3]> = triangles
            .filter(|corners| corners.iter().all(in_photo))
            .collect();
        let mut all: Vec<LeftOut> = left_out
            .filter(|left_out| seen_at(left_out.point).is_some())
            .collect();
        let area: f64 = all.iter().map(|left_out| left_out.star / 3.0).sum();
        let side = |count: usize| (area / count.max(1) as f64).sqrt();
        let spaced = |of: &[LeftOut], cell: f64, shift: DVec2| {
            let shift = (shift * cell).extend(0.0);
            let points = of.iter().map(|left_out| left_out.point + shift);
            let mut thinned = LeftOut::of_thinned(points.collect(), cell).unwrap_or_default();
            for left_out in &mut thinned {
                left_out.point -= shift;
            }
            thinned
        };
        if all.len() > 2 * MOST_POINTS {
            all = spaced(&all, side(MOST_POINTS), DVec2::ZERO);
        }
        let twice = 2.0 * side(all.len());
        let sparser = SHIFTED.iter().flat_map(|shift| spaced(&all, twice, *shift));
        Self {
            each: all.iter().filter_map(error).collect(),
            sparser: sparser.filter_map(|left_out| error(&left_out)).collect(),
            noise: PointNoise::of(&triangles, pose.rotation * plane, plane.dot(up)),
        }
    }

    /// The same of a cloud that is no noisier than usual: each error less by the noise's part in all.
    pub(super) fn without_noise(&self) -> Self {
        let without = |errors: &[DepthError]| -> Vec<DepthError> {
            let kept = without_flying(errors);
            let squares: f64 = kept.iter().map(|error| error.relative.powi(2)).sum();
            let factor = self
                .noise
                .factor_without(squares / kept.len().max(1) as f64);
            let less = |error: &DepthError| DepthError {
                relative: error.relative * factor,
                ..*error
            };
            errors.iter().map(less).collect()
        };
        Self {
            each: without(&self.each),
            sparser: without(&self.sparser),
            noise: PointNoise::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Distortion;
    use crate::jobs::Progress;
    use crate::scale::ImageKind;
    use crate::scale::field::FieldGrid;
    use crate::scale::uncertainty::tests::{camera, nadir};
    use crate::split_mix::SplitMix;
    use crate::surface::Cloud;

    fn errors(of: &[(f64, f64)]) -> Vec<DepthError> {
        let error = |&(relative, area): &(f64, f64)| DepthError {
            pixel: DVec2::ZERO,
            relative,
            area,
        };
        of.iter().map(error).collect()
    }

    /// A hundred points with 1 % on one part of the photo, fifty with 3 % on three: by hand.
    #[test]
    fn points_count_as_much_as_the_photo_shows_of_them() {
        let mut some = vec![(-0.01, 0.01); 100];
        some.extend([(0.03, 0.06); 50]);
        let some = errors(&some);
        assert!((mean(&some).unwrap() - 0.02).abs() < 1e-12);
        assert!((root_mean_square(&some).unwrap() - 7e-4_f64.sqrt()).abs() < 1e-12);
        assert!((effective_count(&some) - 16.0 / 0.19).abs() < 1e-9);
        assert_eq!(mean(&some[..LEAST_POINTS - 1]), None);
    }

    #[test]
    fn flying_points_are_brought_down() {
        let mut some = vec![(0.01, 1.0); 97];
        some.extend([(9.0, 1.0), (-0.9, 1.0), (-0.04, 1.0)]);
        let found = without_flying(&errors(&some));
        let last: Vec<f64> = found[96..].iter().map(|error| error.relative).collect();
        assert_eq!(last, [0.01, 0.05, -0.05, -0.04]);
        // Where nine in ten are sure, the tenth is no flying point.
        some[..97].fill((0.0, 1.0));
        assert_eq!(without_flying(&errors(&some)), errors(&some));
    }

    /// A plane seen from 10 above by a photo of 1.28 by 0.72 times its distance, its left half with a ninth of the points: each
    /// triangle has three corners, so their areas are three times what the photo shows, over z³, half of it on either side.
    #[test]
    fn areas_add_up_to_the_photo() {
        let mut random = SplitMix(3);
        let mut points: Vec<DVec3> = (0..40_000)
            .map(|_| {
                DVec3::new(
                    (random.unit() - 0.5) * 20.0,
                    (random.unit() - 0.5) * 14.0,
                    0.0,
                )
            })
            .collect();
        points.retain(|point| point.x > 0.0 || random.unit() < 1.0 / 9.0);
        let surface = Surface::new(Cloud {
            points,
            ..Cloud::default()
        })
        .unwrap();
        let (camera, pose) = (camera(Distortion::None), nadir(10.0));
        let grid = FieldGrid::of_fit(&camera);
        let image = ImageKind::Undistorted;
        let field =
            ScaleField::compute(&camera, &pose, image, grid, &surface, &Progress::default())
                .unwrap();
        let found = DepthErrors::of(&field, plane_of(&field).unwrap(), &surface).each;
        let sum = |left: bool| -> f64 {
            let of_side = found.iter().filter(|error| (error.pixel.x < 640.0) == left);
            of_side.map(|error| error.area).sum()
        };
        let half = 3.0 * 12.8 * 7.2 / 2.0 / 1000.0;
        for side in [sum(true), sum(false)] {
            assert!((side / half - 1.0).abs() < 0.06, "{side} is not {half}");
        }
    }
}
