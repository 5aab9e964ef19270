//! The old way to a scale: an object of known size in the photo. Kept to be compared with.
//!
//! One scale for the whole photo follows from it, that of the plane through the object parallel to
//! the image. Beside it stands what the corner points say at the same place.

use glam::{DVec2, DVec3};

use super::{ImageKind, Sphere};
use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::geometry::{Ray, median};
use crate::surface::Caster;

/// Points of a drawn or masked outline.
const OUTLINE_POINTS: u32 = 96;

/// Half the width of a bar's region as a share of its length in pixels: only its ends are known.
const BAR_HALF_WIDTH: f64 = 0.06;

/// How much larger than an object the ring around it is on which its surroundings are looked at.
const RING: f64 = 1.5;

/// The distance, as a share of the depth, over which the image's scale is taken.
const STEP: f64 = 1e-5;

/// What was traced.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScaleObjectKind {
    /// A ball: points of its outline, and its diameter.
    Sphere,
    /// A bar or a board: its two ends, and its length.
    Bar,
}

impl ScaleObjectKind {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Sphere, Self::Bar];

    /// Its name in flight.toml.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Sphere => "sphere",
            Self::Bar => "bar",
        }
    }

    /// What its size is called.
    pub fn size_name(self) -> &'static str {
        match self {
            Self::Sphere => "diameter",
            Self::Bar => "length",
        }
    }

    /// How many points an outline has at least and at most.
    pub fn points(self) -> (usize, usize) {
        match self {
            Self::Sphere => (3, usize::MAX),
            Self::Bar => (2, 2),
        }
    }
}

/// A bar: the rays of its ends and its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bar {
    /// Directions of its ends, camera axes.
    pub ends: [DVec3; 2],
    /// World units.
    pub length: f64,
}

/// A traced object with where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Traced {
    /// Fitted to its outline.
    Sphere(Sphere),
    /// Between its ends.
    Bar(Bar),
}

/// What the point cloud says where a traced object is; `None` where it says nothing. Scales are in
/// pixels per world unit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PlaceScale {
    /// On the row of the object's middle, linear between the top and the bottom scale: what
    /// Split-Desktop takes there.
    pub between_edges: Option<f64>,
    /// Of the surface under the object's middle. Where the cloud shows the object, that is its near
    /// side.
    pub on_surface: Option<f64>,
    /// Of the surface around the object: the median over a ring half as large again.
    pub around: Option<f64>,
    /// The distance of the points where the rays of a bar's ends meet the surface, world units.
    pub length_on_surface: Option<f64>,
}

impl Traced {
    /// Finds where an object of this size is. `outline` is in pixels of the photo as shot.
    ///
    /// # Errors
    /// Those of [`Sphere::fit`]; for a bar without exactly two ends apart from each other, or with an
    /// end that has no ray.
    pub fn new(
        camera: &Camera,
        kind: ScaleObjectKind,
        size: f64,
        outline: &[DVec2],
    ) -> Result<Self, Fault> {
        if kind == ScaleObjectKind::Sphere {
            return Sphere::fit(camera, outline, size).map(Self::Sphere);
        }
        let &[from, to] = outline else {
            return Err(Fault::new(
                format!("the bar has {} ends", outline.len()),
                "mark its two ends",
            ));
        };
        if from == to || !(size > 0.0 && size.is_finite()) {
            return Err(Fault::new(
                "the bar has no length",
                "mark its two ends and give its length",
            ));
        }
        let ray = |pixel: DVec2| {
            camera.direction_as_shot(pixel).map_err(|not_invertible| {
                Fault::new(
                    format!("an end of the bar has no ray: {not_invertible}"),
                    "move it to where the lens sees something",
                )
            })
        };
        Ok(Self::Bar(Bar {
            ends: [ray(from)?, ray(to)?],
            length: size,
        }))
    }

    /// The one scale of the photo that follows, pixels per world unit.
    ///
    /// A sphere's is that of the plane through its centre parallel to the image, along the rows as
    /// the scales of the top and the bottom edge are: in the undistorted image the focal length over
    /// the centre's depth. A bar's is its length in pixels over its length, as if it lay in such a
    /// plane; a bar that is tilted to the image makes it too small.
    pub fn scale(&self, camera: &Camera, image: ImageKind) -> Option<f64> {
        match self {
            Self::Sphere(sphere) => scale_along_rows(camera, image, sphere.center),
            Self::Bar(bar) => {
                let [from, to] = bar.pixels(camera, image)?;
                let scale = (to - from).length() / bar.length;
                (scale > 0.0).then_some(scale)
            }
        }
    }

    /// The pixel of its middle: of the sphere's centre, or half-way between the bar's ends.
    pub fn middle(&self, camera: &Camera, image: ImageKind) -> Option<DVec2> {
        match self {
            Self::Sphere(sphere) => image.pixel(camera, sphere.center),
            Self::Bar(bar) => {
                let [from, to] = bar.pixels(camera, image)?;
                Some(from.midpoint(to))
            }
        }
    }

    /// Its region in the image, `margin` pixels wider: the sphere's outline, or a box around the bar,
    /// whose width is not known. Empty where the lens does not see all of it.
    pub fn region(&self, camera: &Camera, image: ImageKind, margin: f64) -> Vec<DVec2> {
        match self {
            Self::Sphere(sphere) => sphere.outline(camera, image, margin, OUTLINE_POINTS),
            Self::Bar(bar) => bar
                .pixels(camera, image)
                .map_or_else(Vec::new, |[from, to]| {
                    let along = (to - from).normalize_or_zero();
                    let half = (to - from).length() * BAR_HALF_WIDTH + margin;
                    let across = along.perp() * half;
                    let (from, to) = (from - along * margin, to + along * margin);
                    vec![from + across, to + across, to - across, from - across]
                }),
        }
    }

    /// What the point cloud says at this place. `scale` is the photo's.
    pub fn place(
        &self,
        camera: &Camera,
        pose: &Pose,
        image: ImageKind,
        [top, bottom]: [Option<f64>; 2],
        caster: &mut Caster<'_>,
    ) -> PlaceScale {
        let Some(middle) = self.middle(camera, image) else {
            return PlaceScale::default();
        };
        // Seen from the camera: large coordinates would cost digits.
        let mut met = |in_camera: DVec3| {
            let direction = (pose.rotation * in_camera).normalize();
            let ray = Ray {
                origin: pose.center,
                direction,
            };
            Some(in_camera.normalize() * caster.cast(&ray)?.t)
        };
        let under = match self {
            Self::Sphere(sphere) => Some(sphere.center),
            Self::Bar(_) => image.direction(camera, middle).ok(),
        };
        let under = under.and_then(&mut met);
        let length_on_surface = match self {
            Self::Sphere(_) => None,
            Self::Bar(bar) => match bar.ends.map(&mut met) {
                [Some(from), Some(to)] => Some((to - from).length()),
                _ => None,
            },
        };
        let mut scale_at = |direction: DVec3| scale_along_rows(camera, image, met(direction)?);
        let ring = self.region(camera, image, 0.0).into_iter();
        let mut ring: Vec<f64> = ring
            .filter_map(|pixel| {
                let pixel = middle + (pixel - middle) * RING;
                scale_at(image.direction(camera, pixel).ok()?)
            })
            .collect();
        PlaceScale {
            around: median(&mut ring),
            between_edges: top
                .zip(bottom)
                .map(|(top, bottom)| top + (bottom - top) * (middle.y / f64::from(camera.height))),
            on_surface: under.and_then(|point| scale_along_rows(camera, image, point)),
            length_on_surface,
        }
    }
}

impl Bar {
    fn pixels(&self, camera: &Camera, image: ImageKind) -> Option<[DVec2; 2]> {
        let [from, to] = self.ends.map(|end| image.pixel(camera, end));
        Some([from?, to?])
    }
}

/// Pixels per world unit at a point (camera axes) along a line parallel to the image's rows.
fn scale_along_rows(camera: &Camera, image: ImageKind, point: DVec3) -> Option<f64> {
    if point.z <= 0.0 {
        return None;
    }
    let scale = match image {
        ImageKind::Undistorted => camera.fx / point.z,
        ImageKind::AsShot => {
            let step = DVec3::X * (STEP * point.z);
            let to = camera.pixel_as_shot(point + step)?;
            (to - camera.pixel_as_shot(point - step)?).length() / (2.0 * step.x)
        }
    };
    scale.is_finite().then_some(scale)
}

#[cfg(test)]
mod tests;
