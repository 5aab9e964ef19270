//! A sphere of known size from its outline in a photo.
//!
//! The rays of the outline touch the sphere, so they lie on a circular cone around the ray to its
//! centre. In unit rays d that is n · d = 1, where n points at the centre and 1/|n| is the cosine of
//! the cone's half angle; with the radius R the centre is R / sin(half angle) away. Nothing is
//! approximated by that: the outline in the picture is an ellipse, bent by the lens besides, and its
//! middle is not the picture of the centre.

use glam::{DMat3, DVec2, DVec3};

use super::ImageKind;
use crate::camera::Camera;
use crate::fault::Fault;

/// The fewest points that fix a cone.
const FEWEST_POINTS: usize = 3;

/// Across and along: outlines that are flatter lie on a line.
const FLATTEST: f64 = 1e-3;

/// Half the step, pixels, over which a ray's change with its pixel is taken.
const HALF_STEP_PX: f64 = 0.05;

/// Gauss and Newton need five or so.
const MOST_STEPS: usize = 50;

/// A step of this share of the cone's half angle changes nothing any more.
const LAST_STEP: f64 = 1e-11;

/// A sphere that was fitted to its outline. Camera axes, world units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Its centre.
    pub center: DVec3,
    /// Half of the diameter that was given.
    pub radius: f64,
    /// Root mean square distance of the outline's points from the fitted outline, pixels as shot.
    pub rms: f64,
    /// Standard error of the distance as a share of it, from the scatter of the points; `None` with
    /// three, which fit exactly.
    pub relative_error: Option<f64>,
    /// How far round the outline the points go, degrees: 360 less the largest gap between two.
    pub arc: f64,
}

/// A cone of rays: around `axis`, at `half_angle` to it.
struct Cone {
    axis: DVec3,
    half_angle: f64,
}

/// A unit ray and how it changes with its pixel.
struct OutlineRay {
    direction: DVec3,
    by_u: DVec3,
    by_v: DVec3,
}

/// The equations of a step: what the angles and pixels say about the three unknowns of a cone.
struct Equations {
    /// Of turning the axis towards two directions at right angles to it, and of opening the cone.
    normal: DMat3,
    right: DVec3,
    /// Sum of squared distances, square pixels.
    squares: f64,
    across: [DVec3; 2],
}

impl Sphere {
    /// Fits a sphere to points of its outline, pixels of the photo as shot: the squares of their
    /// distances from the outline are least, in pixels.
    ///
    /// # Errors
    /// With fewer than three points, points on a line, a pixel without a ray, or points that are no
    /// outline of a sphere in front of the camera.
    pub fn fit(camera: &Camera, outline: &[DVec2], diameter: f64) -> Result<Self, Fault> {
        if outline.len() < FEWEST_POINTS {
            return Err(Fault::new(
                format!("the outline has {} points", outline.len()),
                "mark at least three, better eight all around",
            ));
        }
        if !(diameter > 0.0 && diameter.is_finite()) {
            return Err(Fault::new(
                format!("the diameter is {diameter}"),
                "give a positive length",
            ));
        }
        let rays = outline.iter().map(|&pixel| OutlineRay::new(camera, pixel));
        let rays: Vec<OutlineRay> = rays.collect::<Result<_, _>>()?;
        let mut cone = Cone::near(&rays)?;
        let mut equations = cone.equations(&rays);
        let mut steps = 0;
        loop {
            let step = equations.normal.inverse() * -equations.right;
            let turned = equations.across[0] * step.x + equations.across[1] * step.y;
            cone = Cone {
                axis: (cone.axis + turned).normalize_or_zero(),
                half_angle: cone.half_angle + step.z,
            };
            if !(cone.half_angle > 0.0 && cone.half_angle < std::f64::consts::FRAC_PI_2)
                || cone.axis == DVec3::ZERO
            {
                return Err(no_outline());
            }
            equations = cone.equations(&rays);
            if step.length() <= LAST_STEP * cone.half_angle {
                break;
            }
            steps += 1;
            if steps == MOST_STEPS {
                return Err(no_outline());
            }
        }
        let radius = diameter / 2.0;
        let center = cone.axis * (radius / cone.half_angle.sin());
        let relative_error = equations.relative_error_of_depth(&cone, rays.len());
        let is_vague = relative_error.is_some_and(|error| error.is_nan() || error > 0.5);
        if center.z <= 0.0 || !center.is_finite() || is_vague {
            return Err(no_outline());
        }
        Ok(Self {
            center,
            radius,
            rms: (equations.squares / rays.len() as f64).sqrt(),
            relative_error,
            arc: arc(&rays, equations.across),
        })
    }

    /// Points of its outline in an image, evenly around the cone, `margin` pixels further out from
    /// the middle; empty where the lens does not see all of it.
    pub fn outline(
        &self,
        camera: &Camera,
        image: ImageKind,
        margin: f64,
        points: u32,
    ) -> Vec<DVec2> {
        let axis = self.center.normalize();
        let (along, across) = axis.any_orthonormal_pair();
        let sine = self.radius / self.center.length();
        let cosine = (1.0 - sine * sine).sqrt();
        let on_cone = |point: u32| {
            let turn = std::f64::consts::TAU * f64::from(point) / f64::from(points);
            axis * cosine + (along * turn.cos() + across * turn.sin()) * sine
        };
        let pixels = (0..points).map(|point| image.pixel(camera, on_cone(point)));
        let (Some(middle), Some(pixels)) = (
            image.pixel(camera, self.center),
            pixels.collect::<Option<Vec<DVec2>>>(),
        ) else {
            return Vec::new();
        };
        let moved = |pixel: DVec2| pixel + (pixel - middle).normalize_or_zero() * margin;
        pixels.into_iter().map(moved).collect()
    }
}

fn no_outline() -> Fault {
    Fault::new(
        "the points are no outline of a sphere",
        "mark points all around its edge",
    )
}

impl OutlineRay {
    fn new(camera: &Camera, pixel: DVec2) -> Result<Self, Fault> {
        let ray = |pixel: DVec2| match camera.direction_as_shot(pixel) {
            Ok(direction) => Ok(direction.normalize()),
            Err(not_invertible) => Err(Fault::new(
                format!("an outline point has no ray: {not_invertible}"),
                "move it to where the lens sees something",
            )),
        };
        let change = |step: DVec2| -> Result<DVec3, Fault> {
            Ok((ray(pixel + step)? - ray(pixel - step)?) / (2.0 * HALF_STEP_PX))
        };
        Ok(Self {
            direction: ray(pixel)?,
            by_u: change(DVec2::X * HALF_STEP_PX)?,
            by_v: change(DVec2::Y * HALF_STEP_PX)?,
        })
    }
}

impl Cone {
    /// The cone of least squares of n · d - 1: where to begin.
    fn near(rays: &[OutlineRay]) -> Result<Self, Fault> {
        let sum: DVec3 = rays.iter().map(|ray| ray.direction).sum();
        let middle = sum.normalize_or_zero();
        let (along, across) = middle.any_orthonormal_pair();
        // On the plane one ahead of the middle: x p + y q + w = |(x, y, 1)| with n = (p, q, w).
        let plane = |ray: &OutlineRay| {
            let d = ray.direction;
            let ahead = d.dot(middle);
            (ahead > 0.0).then(|| DVec2::new(d.dot(along), d.dot(across)) / ahead)
        };
        let places: Option<Vec<DVec2>> = rays.iter().map(plane).collect();
        let places = places.ok_or_else(no_outline)?;
        let size = places
            .iter()
            .map(|place| place.length())
            .fold(0.0, f64::max);
        let count = places.len() as f64;
        let mean = places.iter().sum::<DVec2>() / count;
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for place in &places {
            let off = *place - mean;
            xx += off.x * off.x;
            xy += off.x * off.y;
            yy += off.y * off.y;
        }
        // Half the sum and half the difference of the scatter's two eigenvalues.
        let (half_sum, half_difference) = ((xx + yy) / 2.0, ((xx - yy) / 2.0).hypot(xy));
        let (least, most) = (half_sum - half_difference, half_sum + half_difference);
        if !(least > FLATTEST * FLATTEST * most) {
            return Err(Fault::new(
                "the points lie on a line",
                "mark points all around the edge",
            ));
        }
        let (mut normal, mut right) = (DMat3::ZERO, DVec3::ZERO);
        for place in &places {
            let row = DVec3::new(place.x / size, place.y / size, 1.0);
            // |(x, y, 1)| - 1, without the loss of digits.
            let squares = place.length_squared();
            let beyond = squares / (1.0 + (1.0 + squares).sqrt());
            normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
            right += row * beyond;
        }
        let solved = normal.inverse() * right;
        let (p, q, beyond) = (solved.x / size, solved.y / size, solved.z);
        let tangent_squared = beyond * (2.0 + beyond) + p * p + q * q;
        if !(tangent_squared > 0.0 && tangent_squared.is_finite()) {
            return Err(no_outline());
        }
        Ok(Self {
            axis: (along * p + across * q + middle * (1.0 + beyond)).normalize_or_zero(),
            half_angle: tangent_squared.sqrt().atan(),
        })
    }

    fn equations(&self, rays: &[OutlineRay]) -> Equations {
        let (along, across) = self.axis.any_orthonormal_pair();
        let mut equations = Equations {
            normal: DMat3::ZERO,
            right: DVec3::ZERO,
            squares: 0.0,
            across: [along, across],
        };
        for ray in rays {
            let d = ray.direction;
            let sine = self.axis.cross(d).length();
            let angle = sine.atan2(self.axis.dot(d));
            // Radians a pixel, at right angles to the outline.
            let steepness = self.axis.dot(ray.by_u).hypot(self.axis.dot(ray.by_v)) / sine;
            let off = (angle - self.half_angle) / steepness;
            let row = DVec3::new(-d.dot(along) / sine, -d.dot(across) / sine, -1.0) / steepness;
            equations.normal += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
            equations.right += row * off;
            equations.squares += off * off;
        }
        equations
    }
}

impl Equations {
    /// The depth is radius / sin(half angle) times the axis' z: how sure the scatter leaves it.
    fn relative_error_of_depth(&self, cone: &Cone, points: usize) -> Option<f64> {
        let free = points.checked_sub(FEWEST_POINTS).filter(|&free| free > 0)?;
        let by_unknown = DVec3::new(
            self.across[0].z / cone.axis.z,
            self.across[1].z / cone.axis.z,
            -1.0 / cone.half_angle.tan(),
        );
        let variance = self.squares / free as f64;
        let spread = by_unknown.dot(self.normal.inverse() * by_unknown);
        Some((variance * spread).sqrt())
    }
}

/// Degrees around the cone less the largest gap between two rays.
fn arc(rays: &[OutlineRay], [along, across]: [DVec3; 2]) -> f64 {
    let turn = |ray: &OutlineRay| ray.direction.dot(across).atan2(ray.direction.dot(along));
    let mut turns: Vec<f64> = rays.iter().map(turn).collect();
    turns.sort_by(f64::total_cmp);
    let around = turns.first().map(|first| first + std::f64::consts::TAU);
    let next = turns.iter().skip(1).copied().chain(around);
    let gaps = turns.iter().zip(next).map(|(from, to)| to - from);
    360.0 - gaps.fold(0.0, f64::max).to_degrees()
}

#[cfg(test)]
mod tests;
