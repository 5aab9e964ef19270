//! How sure the best line is: by derivatives.
//!
//! What a wrong pose does to it follows from the field itself (`moved`). Of a wrong focal length it is what it
//! does to the plane that lies best through the field: m·X = 1 in camera axes, with the inverse of depth m·d at
//! the ray d. To the first order; `tests.rs` compares with fields that are computed again.

use glam::DVec3;

use super::bridges::Bridged;
use super::draws::interval_of_scale;
use super::holes::of_holes;
use super::moved::of_moves;
use super::point_noise::PointNoise;
use super::surface_error::{DepthError, effective_count, mean, root_mean_square, tan_of_incidence};
use super::unseen::Unseen;
use super::{Interval, UncertainPhoto};
use crate::camera::Camera;
use crate::scale::field::ScaleField;
use crate::scale::{FittedScale, ImageKind};

/// How far the mean of the depth errors may be off itself: the points are left out, so it is that of a cloud with fewer.
const OF_CUT: f64 = 0.5;

/// How sure the top and the bottom of the best line are.
pub(super) struct LineErrors {
    ends: [LineEnd; 2],
}

/// One end of the line.
struct LineEnd {
    /// Pixels per world unit.
    scale: f64,
    /// Standard deviations that pose, lens, surface and world leave in it, shares of the scale; `None`
    /// where nobody states them.
    parts: [Option<f64>; 4],
    /// By what share the true scale is smaller, in the mean: what lies unseen between fragments.
    too_large: f64,
}

/// What the line through a field is, as a function of the plane: top = m·0th, bottom = m·1st.
type Ends = [DVec3; 2];

impl LineErrors {
    pub(super) fn new(
        photo: &UncertainPhoto<'_>,
        fitted: &FittedScale,
        plane: DVec3,
        depths: &[DepthError],
        (unseen, bridged, noise): (Unseen, Bridged, PointNoise),
    ) -> Self {
        let (field, errors) = (photo.field, &photo.errors);
        let ends = ends_by_plane(field, field.camera());
        // By the focal length, numerically: a lens is not linear in it.
        let step = 1e-4;
        let with_focal = |factor: f64| {
            let camera = Camera {
                fx: field.camera().fx * factor,
                fy: field.camera().fy * factor,
                ..field.camera().clone()
            };
            ends_by_plane(field, &camera)
        };
        let (more, less) = (with_focal(1.0 + step), with_focal(1.0 - step));
        let rotation = field.pose().rotation;
        let moved = of_moves(field, fitted, plane);
        let roughness = root_mean_square(depths);
        let of_cut = OF_CUT * mean(depths).unwrap_or(0.0);
        let counted = effective_count(depths).max(1.0);
        let holes = of_holes(field, fitted);
        let too_large = unseen.of_line(field, fitted, depths);
        let end = |index: usize, scale: f64| {
            let by_plane = ends[index];
            let flat = unseen.of_flat_look(tan_of_incidence(plane, by_plane));
            let looked_over = flat * roughness.unwrap_or(0.0);
            let share = 1.0 / plane.dot(by_plane);
            // In the world's axes, as positions are stated.
            let by_position = rotation * moved[index].by_position;
            let by_angle = moved[index].by_angle;
            let pose = errors.pose.variance(by_angle, by_position).map(f64::sqrt);
            let by_focal = plane.dot(more[index] - less[index]) / (2.0 * step) * share;
            let lens = errors.focal.map(|focal| (by_focal * focal / 100.0).abs());
            // Too few points say nothing of what lies between them; what is stated of each counts all the same.
            let is_known = roughness.is_some() || errors.surface.is_some();
            let surface = is_known.then(|| {
                let roughness = roughness.unwrap_or(0.0);
                // The end of a line through independent values has four times the variance of their mean.
                let seen = 2.0 * roughness / counted.sqrt();
                let of_unseen = unseen.spread() * roughness;
                // Each point has its stated error, and the line is the mean of many. Of few, or of a mesh, whose points tell nothing:
                // no more than where all are off by the same.
                let depth = 1.0 / plane.z.abs().max(f64::MIN_POSITIVE);
                let of_all = (2.0 / counted.sqrt()).min(1.0);
                let stated = errors.surface.unwrap_or(0.0) / depth * of_all;
                let parts = [
                    seen,
                    of_unseen,
                    of_cut,
                    stated,
                    holes[index],
                    bridged.spread,
                    noise.unusual(),
                ];
                parts.iter().map(|part| part * part).sum::<f64>().sqrt()
            });
            LineEnd {
                scale,
                parts: [
                    pose,
                    lens,
                    surface,
                    errors.world_scale.map(|percent| percent / 100.0),
                ],
                too_large: bridged.too_large[index] + too_large[index] - looked_over,
            }
        };
        Self {
            ends: [end(0, fitted.top), end(1, fitted.bottom)],
        }
    }

    /// Of the line's top.
    pub(super) fn top(&self) -> Interval {
        self.ends[0].interval()
    }

    /// Of its bottom.
    pub(super) fn bottom(&self) -> Interval {
        self.ends[1].interval()
    }

    /// See `Uncertainty::parts_percent`.
    pub(super) fn parts_percent(&self) -> [Option<f64>; 4] {
        std::array::from_fn(|source| {
            let [top, bottom] = [&self.ends[0], &self.ends[1]].map(|end| end.parts[source]);
            Some(((top?.powi(2) + bottom?.powi(2)) / 2.0).sqrt() * 100.0)
        })
    }
}

impl LineEnd {
    fn interval(&self) -> Interval {
        let squares: f64 = self.parts.iter().flatten().map(|part| part * part).sum();
        let mean = self.scale * (1.0 - self.too_large);
        interval_of_scale(mean, self.scale.abs() * squares.sqrt(), self.scale)
    }
}

/// The line through a field of the plane m, top and bottom as m·T: by least squares of each of the rays'
/// three coordinates over the points that the field has.
fn ends_by_plane(field: &ScaleField, camera: &Camera) -> Ends {
    let grid = field.grid;
    let focal = (camera.fx * camera.fy).sqrt();
    let (mut count, mut v, mut vv) = (0.0, 0.0, 0.0);
    let (mut d, mut vd) = (DVec3::ZERO, DVec3::ZERO);
    for row in 0..grid.rows {
        let down = (f64::from(row) + 0.5) / f64::from(grid.rows);
        for column in 0..grid.columns {
            if field.depth_at(column, row).is_none() {
                continue;
            }
            let pixel = grid.pixel(camera, column, row);
            let Ok(direction) = field.image().direction(camera, pixel) else {
                continue;
            };
            let lens = match field.image() {
                ImageKind::Undistorted => 1.0,
                ImageKind::AsShot => camera.lens_area(direction).map_or(0.0, f64::sqrt),
            };
            let ray = direction / direction.z * (focal * lens);
            count += 1.0;
            v += down;
            vv += down * down;
            d += ray;
            vd += ray * down;
        }
    }
    let slope = (vd * count - d * v) / (vv * count - v * v);
    let top = (d - slope * v) / count;
    [top, top + slope]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Straight from above onto a plane, fx = fy: at the photo's upper edge rays meet it with half the height over the focal
    /// length as tangent. There the gaps count for as much less, and the true scale is as much larger.
    #[test]
    fn gaps_count_for_less_where_one_looks_flatly() {
        use crate::camera::Distortion;
        use crate::jobs::Progress;
        use crate::scale::field::FieldGrid;
        use crate::scale::uncertainty::tests::{camera, nadir};
        use crate::scale::{Ground, GroundFinder, PhotoScale, StatedErrors};
        use crate::surface::{Cloud, Surface};
        use glam::DVec2;

        let corners = [(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)];
        let plane = Surface::new(Cloud {
            points: corners.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec(),
            ..Cloud::default()
        })
        .unwrap();
        let (camera, pose) = (camera(Distortion::None), nadir(10.0));
        let (grid, image) = (FieldGrid::of_fit(&camera), ImageKind::Undistorted);
        let progress = Progress::default();
        let field = ScaleField::compute(&camera, &pose, image, grid, &plane, &progress).unwrap();
        let fitted = FittedScale::of(&field).unwrap();
        let mut ground = GroundFinder::new(Ground::Auto, &plane);
        let mut caster = plane.caster().unwrap();
        let scale = PhotoScale::compute(&camera, &pose, image, &mut ground, &mut caster).unwrap();
        let photo = UncertainPhoto {
            field: &field,
            fitted: Some(&fitted),
            scale: &scale,
            errors: StatedErrors::default(),
        };
        let depths: Vec<DepthError> = [-0.01, 0.01]
            .repeat(200)
            .into_iter()
            .map(|relative| DepthError {
                pixel: DVec2::new(640.0, 360.0),
                relative,
                area: 1.0,
            })
            .collect();
        let at_top = |bias: f64| {
            let plane = DVec3::Z / 10.0;
            let line = LineErrors::new(
                &photo,
                &fitted,
                plane,
                &depths,
                (Unseen { bias }, Bridged::default(), PointNoise::default()),
            );
            line.ends[0].too_large
        };
        let tan = 0.5 * f64::from(camera.height) / camera.fy;
        let wanted = 0.5 * 0.01 * (1.0 - 0.7 * tan);
        let found = at_top(0.5) - at_top(0.0);
        assert!((found - wanted).abs() < 0.02 * wanted, "{found} {wanted}");
    }

    #[test]
    fn incidence_is_from_the_normal() {
        let down = DVec3::new(0.0, 0.0, 0.1);
        for (ray, tan) in [
            (DVec3::Z, 0.0),
            (DVec3::new(0.0, 1.0, 1.0), 1.0),
            (DVec3::new(3.0, 4.0, -2.5), 2.0),
        ] {
            assert!((tan_of_incidence(down, ray) - tan).abs() < 1e-12, "{ray}");
        }
    }
}
