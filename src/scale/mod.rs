//! From a photo to its scale (contract, section 2; the paper's Algorithm 1 and equation 11).
//!
//! The ray of each image corner meets the surface, or else the ground; the scale of an image edge
//! is its length in pixels over the straight distance between its two corner points.
//!
//! The paper's equation 5 writes T (p, 1), which adds the camera centre to a direction; only the
//! rotation may act on a direction, and so it does here.

mod estimate;
mod facts;
mod field;
mod fitted;
mod footprint;
mod ground;
mod pyramid;
mod rectification;
mod scale_object;
mod sighting;
mod sights;
mod sphere;
mod stated_errors;
mod uncertainty;
mod view;

use std::fmt;

use glam::{DVec2, DVec3};

pub use estimate::ScaleEstimate;
pub use facts::FieldFacts;
pub use field::{FieldError, FieldGrid, FieldPoint, ScaleField};
pub use fitted::{FittedScale, LEAST_COVERED};
pub use footprint::{Footprint, FootprintDetail, FootprintPoint};
pub use ground::{Ground, GroundFinder};
pub use rectification::{Onto, PixelSize, PlaneFrame, PlaneRaster, Rectification};
pub use scale_object::{Bar, PlaceScale, ScaleObjectKind, Traced};
pub use sighting::{Sighting, sighting};
pub use sights::Sights;
pub use sphere::Sphere;
pub use stated_errors::{PoseErrors, ScalePair, StatedErrors};
pub use uncertainty::{
    Draws, ErrorSource, HalfAPose, Interval, PixelErrors, PointNoise, UncertainPhoto, Uncertainty,
};
pub use view::ViewFacts;

use crate::camera::{Camera, NotInvertible, Pose};
use crate::geometry::Ray;
use crate::surface::{Caster, SurfaceError};

/// Which image the scale is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ImageKind {
    /// The undistorted image with the same K and size, as in the paper.
    #[default]
    Undistorted,
    /// The photo as shot: corner rays go through the inverse of the distortion.
    AsShot,
}

impl ImageKind {
    /// The direction (camera axes, not normalised) of a pixel of this image.
    ///
    /// # Errors
    /// Where the lens shows nothing at that pixel.
    pub fn direction(self, camera: &Camera, pixel: DVec2) -> Result<DVec3, NotInvertible> {
        match self {
            Self::Undistorted => Ok(camera.direction_undistorted(pixel)),
            Self::AsShot => camera.direction_as_shot(pixel),
        }
    }

    /// The pixel in this image (also outside its edges) of a point in camera axes, or `None` where
    /// the lens does not see it.
    pub fn pixel(self, camera: &Camera, point: DVec3) -> Option<DVec2> {
        match self {
            Self::Undistorted => camera.pixel_undistorted(point),
            Self::AsShot => camera.pixel_as_shot(point),
        }
    }

    /// The pixel in this image of what the other one shows at `pixel`, or `None` where one of them does
    /// not show it.
    pub fn pixel_from(self, other: Self, camera: &Camera, pixel: DVec2) -> Option<DVec2> {
        if self == other {
            return Some(pixel);
        }
        self.pixel(camera, other.direction(camera, pixel).ok()?)
    }
}

/// An image corner, in the order of the contract: clockwise from the top left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CornerName {
    /// Pixel (0, 0).
    TopLeft,
    /// Pixel (W, 0).
    TopRight,
    /// Pixel (W, H).
    BottomRight,
    /// Pixel (0, H).
    BottomLeft,
}

impl CornerName {
    /// All four, in the contract's order.
    pub const ALL: [Self; 4] = [
        Self::TopLeft,
        Self::TopRight,
        Self::BottomRight,
        Self::BottomLeft,
    ];

    /// The corner's pixel in an image of this camera.
    pub fn pixel(self, camera: &Camera) -> DVec2 {
        let (w, h) = (f64::from(camera.width), f64::from(camera.height));
        match self {
            Self::TopLeft => DVec2::ZERO,
            Self::TopRight => DVec2::new(w, 0.0),
            Self::BottomRight => DVec2::new(w, h),
            Self::BottomLeft => DVec2::new(0.0, h),
        }
    }

    /// Its name in exports.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::TopLeft => "top_left",
            Self::TopRight => "top_right",
            Self::BottomRight => "bottom_right",
            Self::BottomLeft => "bottom_left",
        }
    }
}

impl fmt::Display for CornerName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// What a corner's ray met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CornerOutcome {
    /// The surface, at this distance from the camera centre and this place in the world.
    OnSurface {
        /// Distance from the camera centre, world units.
        distance: f64,
        /// In the world.
        point: DVec3,
        /// The longest edge of the triangle there, world units: what is long bridges what no photo saw.
        longest_edge: f64,
    },
    /// It missed the surface and met the plane z = ground.
    OnGround {
        /// Distance from the camera centre, world units.
        distance: f64,
        /// In the world.
        point: DVec3,
    },
    /// It missed the surface, and does not meet the ground in front of the camera.
    Nowhere,
    /// There is no ray: the lens shows nothing at this pixel.
    NoRay(NotInvertible),
}

/// A corner of a photo with its ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Which one.
    pub name: CornerName,
    /// In the image.
    pub pixel: DVec2,
    /// Unit vector in the world; `None` where the pixel has no ray.
    pub direction: Option<DVec3>,
    /// What the ray met.
    pub outcome: CornerOutcome,
}

impl CornerOutcome {
    /// The place in the world, where there is one.
    pub fn point(&self) -> Option<DVec3> {
        match *self {
            Self::OnSurface { point, .. } | Self::OnGround { point, .. } => Some(point),
            Self::Nowhere | Self::NoRay(_) => None,
        }
    }

    /// Whether the ray met the surface.
    pub fn is_on_surface(&self) -> bool {
        matches!(self, Self::OnSurface { .. })
    }
}

impl Corner {
    /// The corner point in the world, where there is one.
    pub fn point(&self) -> Option<DVec3> {
        self.outcome.point()
    }

    /// The corner point seen from the camera centre, which loses no digit to large coordinates.
    fn offset(&self) -> Option<DVec3> {
        match self.outcome {
            CornerOutcome::OnSurface { distance, .. }
            | CornerOutcome::OnGround { distance, .. } => Some(self.direction? * distance),
            CornerOutcome::Nowhere | CornerOutcome::NoRay(_) => None,
        }
    }
}

/// Pixels per world unit along the four edges of the image; `None` where a corner point is missing
/// or the two coincide.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EdgeScales {
    /// Along the top edge.
    pub top: Option<f64>,
    /// Along the right edge.
    pub right: Option<f64>,
    /// Along the bottom edge.
    pub bottom: Option<f64>,
    /// Along the left edge.
    pub left: Option<f64>,
}

impl EdgeScales {
    /// The same scales, each times `factor`.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        let times = |scale: Option<f64>| scale.map(|s| s * factor);
        Self {
            top: times(self.top),
            right: times(self.right),
            bottom: times(self.bottom),
            left: times(self.left),
        }
    }
}

/// The scale of one photo, and how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotoScale {
    /// The corners in the contract's order.
    pub corners: [Corner; 4],
    /// Pixels per world unit.
    pub scale: EdgeScales,
    /// The elevation of the ground, where a ray missed the surface.
    pub ground: Option<f64>,
}

impl PhotoScale {
    /// Computes the scale of a photo.
    ///
    /// # Errors
    /// Where no ground can be found although it is needed.
    pub fn compute(
        camera: &Camera,
        pose: &Pose,
        image: ImageKind,
        ground: &mut GroundFinder<'_>,
        caster: &mut Caster<'_>,
    ) -> Result<Self, SurfaceError> {
        let mut used_ground = None;
        let mut corners = CornerName::ALL.map(|name| {
            let pixel = name.pixel(camera);
            let direction = world_direction(camera, pose, image, pixel);
            Corner {
                name,
                pixel,
                direction: direction.ok(),
                outcome: match direction {
                    Ok(_) => CornerOutcome::Nowhere,
                    Err(not_invertible) => CornerOutcome::NoRay(not_invertible),
                },
            }
        });
        for corner in &mut corners {
            let Some(direction) = corner.direction else {
                continue;
            };
            let ray = Ray {
                origin: pose.center,
                direction,
            };
            corner.outcome = match caster.cast(&ray) {
                Some(hit) => CornerOutcome::OnSurface {
                    distance: hit.t,
                    point: hit.point,
                    longest_edge: hit.longest_edge,
                },
                None => {
                    let z = ground.under(camera, pose)?;
                    used_ground = Some(z);
                    meet_ground(&ray, z)
                }
            };
        }
        Ok(Self {
            scale: edge_scales(camera, &corners),
            corners,
            ground: used_ground,
        })
    }

    /// How many corners lie on the surface.
    pub fn corners_on_surface(&self) -> usize {
        let on_surface = |corner: &&Corner| corner.outcome.is_on_surface();
        self.corners.iter().filter(on_surface).count()
    }

    /// What fell back or failed, in words; empty where all is well. `unit` is the world's.
    pub fn notes(&self, unit: &str) -> Vec<String> {
        let named = |wanted: fn(&CornerOutcome) -> bool| {
            let names: Vec<_> = self
                .corners
                .iter()
                .filter(|corner| wanted(&corner.outcome))
                .map(|corner| corner.name.as_str())
                .collect();
            (!names.is_empty()).then(|| names.join(", "))
        };
        let mut notes = Vec::new();
        if let Some(names) = named(|o| matches!(o, CornerOutcome::OnGround { .. }))
            && let Some(z) = self.ground
        {
            notes.push(format!(
                "{names}: off the surface, taken on the ground at z = {z:.3} {unit}"
            ));
        }
        if let Some(names) = named(|o| matches!(o, CornerOutcome::Nowhere)) {
            let up = |corner: &Corner| corner.direction.is_some_and(|way| way.z > 0.0);
            let sky = match self.corners.iter().all(up) {
                true => {
                    "; all look above the horizon: look whether tilt or pitch has the other sign"
                }
                false => "",
            };
            notes.push(format!(
                "{names}: no point, the ray meets neither the surface nor the ground{sky}"
            ));
        }
        for corner in &self.corners {
            if let CornerOutcome::NoRay(not_invertible) = corner.outcome {
                notes.push(format!("{}: no ray, {not_invertible}", corner.name));
            }
        }
        notes
    }
}

/// The unit direction in the world of a pixel's ray.
fn world_direction(
    camera: &Camera,
    pose: &Pose,
    image: ImageKind,
    pixel: DVec2,
) -> Result<DVec3, NotInvertible> {
    let in_camera = image.direction(camera, pixel)?;
    Ok((pose.rotation * in_camera).normalize())
}

fn meet_ground(ray: &Ray, z: f64) -> CornerOutcome {
    let distance = (z - ray.origin.z) / ray.direction.z;
    if distance > 0.0 && distance.is_finite() {
        // On the plane to the last bit.
        let point = ray.at(distance).with_z(z);
        CornerOutcome::OnGround { distance, point }
    } else {
        CornerOutcome::Nowhere
    }
}

fn edge_scales(camera: &Camera, corners: &[Corner; 4]) -> EdgeScales {
    let [top_left, top_right, bottom_right, bottom_left] = corners;
    let scale = |pixels: u32, a: &Corner, b: &Corner| {
        let scale = f64::from(pixels) / (a.offset()? - b.offset()?).length();
        scale.is_finite().then_some(scale)
    };
    EdgeScales {
        top: scale(camera.width, top_left, top_right),
        right: scale(camera.height, top_right, bottom_right),
        bottom: scale(camera.width, bottom_left, bottom_right),
        left: scale(camera.height, top_left, bottom_left),
    }
}

#[cfg(test)]
mod tests;
