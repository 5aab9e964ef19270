//! Where one looks from: pixels to rays and points to pixels, in f64.
//!
//! View axes are camera axes (x right, y down, z forward), so that a photo's pose is a view as it
//! is. Pixels of the viewport are continuous like those of photos: (0, 0) at the outer corner of the
//! top-left pixel.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

use crate::camera::{Camera, Pose};
use crate::geometry::Ray;

/// How view axes become pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Pinhole with square pixels and the axis in the middle.
    Perspective {
        /// Angle between the viewport's top and bottom edge, radians.
        fov_y: f64,
    },
    /// Parallel.
    Orthographic {
        /// World units between the viewport's top and bottom edge.
        height: f64,
    },
    /// The undistorted image of a photo, as large as fits into the viewport, in its middle.
    Photo {
        /// Image size in pixels.
        image: DVec2,
        /// fx and fy, pixels of the image.
        focal: DVec2,
        /// cx and cy, pixels of the image.
        center: DVec2,
        /// Pixels of the image.
        skew: f64,
    },
}

/// Where one looks from, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// In the world. In parallel projection what lies behind it is seen too.
    pub eye: DVec3,
    /// View axes in the world, as columns; a proper rotation.
    pub world_from_view: DMat3,
    /// How view axes become pixels.
    pub projection: Projection,
    /// At which distance along the axis the scale bar is true, world units. In parallel projection
    /// it is true everywhere.
    pub focus: f64,
}

/// `u = focal.x x + skew y + center.x z`, `v = focal.y y + center.y z`, over z or, in parallel
/// projection, over 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pinhole {
    focal: DVec2,
    center: DVec2,
    skew: f64,
    parallel: bool,
}

impl View {
    /// What an undistorted photo shows. `focus` as in [`Self::focus`].
    pub fn of_photo(camera: &Camera, pose: &Pose, focus: f64) -> Self {
        Self {
            eye: pose.center,
            world_from_view: pose.rotation,
            projection: Projection::Photo {
                image: DVec2::new(f64::from(camera.width), f64::from(camera.height)),
                focal: DVec2::new(camera.fx, camera.fy),
                center: DVec2::new(camera.cx, camera.cy),
                skew: camera.skew,
            },
            focus,
        }
    }

    /// The ray of a viewport pixel; its direction has unit length.
    pub fn ray(&self, pixel: DVec2, size: DVec2) -> Ray {
        let lens = self.pinhole(size);
        let y = (pixel.y - lens.center.y) / lens.focal.y;
        let x = (pixel.x - lens.center.x - lens.skew * y) / lens.focal.x;
        if lens.parallel {
            return Ray {
                origin: self.eye + self.world_from_view * DVec3::new(x, y, 0.0),
                direction: self.world_from_view.z_axis,
            };
        }
        Ray {
            origin: self.eye,
            direction: (self.world_from_view * DVec3::new(x, y, 1.0)).normalize(),
        }
    }

    /// The viewport pixel of a world point (also outside the edges), or `None` where it is not in
    /// front of the eye.
    pub fn project(&self, point: DVec3, size: DVec2) -> Option<DVec2> {
        let lens = self.pinhole(size);
        let p = self.world_from_view.transpose() * (point - self.eye);
        let depth = if lens.parallel { 1.0 } else { p.z };
        (depth > 0.0).then(|| {
            DVec2::new(lens.focal.x * p.x + lens.skew * p.y, lens.focal.y * p.y) / depth
                + lens.center
        })
    }

    /// Viewport pixels per world unit, across the axis at `distance` along it.
    pub fn pixels_per_unit(&self, size: DVec2, distance: f64) -> f64 {
        let lens = self.pinhole(size);
        if lens.parallel {
            lens.focal.y
        } else {
            lens.focal.y / distance
        }
    }

    /// Where the photo lies in a viewport that looks through its camera: its top left and bottom
    /// right pixel. `None` in the other projections.
    pub fn photo_rectangle(&self, size: DVec2) -> Option<[DVec2; 2]> {
        let Projection::Photo { image, .. } = self.projection else {
            return None;
        };
        let (scale, offset) = letterbox(image, size);
        Some([offset, offset + image * scale])
    }

    /// The projection as a pinhole of the viewport.
    pub(super) fn pinhole(&self, size: DVec2) -> Pinhole {
        let middle = size * 0.5;
        match self.projection {
            Projection::Perspective { fov_y } => Pinhole {
                focal: DVec2::splat(middle.y / (fov_y * 0.5).tan()),
                center: middle,
                skew: 0.0,
                parallel: false,
            },
            Projection::Orthographic { height } => Pinhole {
                focal: DVec2::splat(size.y / height),
                center: middle,
                skew: 0.0,
                parallel: true,
            },
            Projection::Photo {
                image,
                focal,
                center,
                skew,
            } => {
                let (scale, offset) = letterbox(image, size);
                Pinhole {
                    focal: focal * scale,
                    center: center * scale + offset,
                    skew: skew * scale,
                    parallel: false,
                }
            }
        }
    }

    /// Whether lines of sight are parallel.
    pub(super) fn is_parallel(&self) -> bool {
        matches!(self.projection, Projection::Orthographic { .. })
    }

    /// View axes to clip space, reverse-z: depth 1 at `near`; 0 at infinity, in parallel projection
    /// at `far`.
    pub(super) fn clip_from_view(&self, size: DVec2, near: f64, far: f64) -> DMat4 {
        let lens = self.pinhole(size);
        let scale = DVec2::new(2.0, -2.0) / size;
        // Where the axis is in normalised device coordinates.
        let axis = lens.center * scale + DVec2::new(-1.0, 1.0);
        let x = DVec4::new(lens.focal.x * scale.x, 0.0, 0.0, 0.0);
        let y = DVec4::new(lens.skew * scale.x, lens.focal.y * scale.y, 0.0, 0.0);
        if lens.parallel {
            let depth = 1.0 / (far - near);
            DMat4::from_cols(
                x,
                y,
                DVec4::new(0.0, 0.0, -depth, 0.0),
                DVec4::new(axis.x, axis.y, far * depth, 1.0),
            )
        } else {
            DMat4::from_cols(
                x,
                y,
                DVec4::new(axis.x, axis.y, 0.0, 1.0),
                DVec4::new(0.0, 0.0, near, 0.0),
            )
        }
    }
}

/// How an image fits into a viewport: its scale and the place of its corner.
fn letterbox(image: DVec2, size: DVec2) -> (f64, DVec2) {
    let scale = (size / image).min_element();
    (scale, (size - image * scale) * 0.5)
}
