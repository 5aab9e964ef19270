//! How sure the scale of one pixel is: the field's value under the mouse.
//!
//! A pixel sees one place of a rough surface: what lies there is as unsure as the points around it are
//! badly predicted. What a wrong pose or focal length does is what it does to the plane through that
//! place that is parallel to the photo's best plane (`line.rs` has the derivatives: m·X = 1, turned by w
//! and moved by v the camera sees m + m × w + m (m·v)).
//!
//! Under a triangle that bridges what no photo saw it is deeper, and less sure (`bridges.rs`). What the line counts of holes in
//! the cloud (`holes.rs`) and of unusual noise is of the photo as a whole: here a hole's rim is as unsure as the points
//! around it, and no more.

use glam::{DVec2, DVec3};

use super::Interval;
use super::bridges::Bridges;
use super::draws::interval_of_scale;
use super::surface_error::{DepthError, DepthErrors, plane_of, root_mean_square};
use super::unseen::Unseen;
use crate::camera::Camera;
use crate::jobs::Progress;
use crate::scale::field::{FieldGrid, ScaleField};
use crate::scale::{ImageKind, StatedErrors};
use crate::surface::Surface;

/// Into how many squares the photo's width is divided, each of which has a roughness of its own.
const ACROSS: usize = 16;

/// How sure the scale is at each pixel of a photo.
#[derive(Debug, Clone)]
pub struct PixelErrors {
    stated: StatedErrors,
    /// Best through the field, in camera axes: m·X = 1.
    plane: DVec3,
    /// Root mean square of the depth errors, shares of the depth, square by square; `None` where the
    /// photo shows too few points.
    roughness: Option<Vec<f64>>,
    unseen: Unseen,
    /// Of a surface that came with its faces there are none.
    bridges: Option<Bridges>,
}

impl PixelErrors {
    /// Of a photo with this field. `None` where nothing is known of any source.
    pub fn new(field: &ScaleField, stated: &StatedErrors, surface: &Surface) -> Option<Self> {
        let plane = plane_of(field)?;
        let errors = DepthErrors::of(field, plane, surface);
        let (unseen, depths) = (Unseen::of(&errors.without_noise()), errors.each);
        let roughness = root_mean_square(&depths).map(|of_all| {
            let camera = field.camera();
            let mut squares = vec![Vec::new(); ACROSS * rows(camera)];
            for error in &depths {
                if let Some(within) = squares.get_mut(square(camera, error.pixel)) {
                    within.push(*error);
                }
            }
            let of_square = |within: &Vec<DepthError>| root_mean_square(within).unwrap_or(of_all);
            squares.iter().map(of_square).collect()
        });
        // Only a coarse field knows its triangles.
        let bridges = surface.is_cloud().then(|| {
            let (camera, pose, image) = (field.camera(), field.pose(), field.image());
            let grid = FieldGrid::of_fit(camera);
            let progress = Progress::default();
            let coarse = ScaleField::compute(camera, pose, image, grid, surface, &progress).ok()?;
            Some(Bridges::in_field(&coarse, plane))
        });
        let is_stated = *stated != StatedErrors::default();
        (is_stated || roughness.is_some()).then_some(Self {
            stated: *stated,
            plane,
            roughness,
            unseen,
            bridges: bridges.flatten(),
        })
    }

    /// The interval of the scale at a column and a row of a field of that photo, pixels per world unit;
    /// `None` where it has no scale.
    pub fn at(&self, field: &ScaleField, column: u32, row: u32) -> Option<Interval> {
        let scale = field.scale_at(column, row)?;
        let depth = field.depth_at(column, row)?;
        let direction = field.direction_at(column, row)?;
        // Through the place itself.
        let plane = self.plane / (self.plane.dot(direction) * depth);
        let stated = &self.stated;
        let by_angle = direction.cross(plane) * depth;
        let by_position = field.pose().rotation * plane;
        let of_pose = stated.pose.variance(by_angle, by_position);
        let of_focal = stated.focal.and_then(|focal| {
            let step = 1e-4;
            let more = with_focal(field, plane, column, row, 1.0 + step)?;
            let less = with_focal(field, plane, column, row, 1.0 - step)?;
            let by_focal = (more / less).ln() / (2.0 * step);
            Some((by_focal * focal / 100.0).powi(2))
        });
        let of_world = stated.world_scale.map(|percent| (percent / 100.0).powi(2));
        let pixel = field.grid.pixel(field.camera(), column, row);
        let roughness = self.roughness.as_ref();
        let roughness = roughness.and_then(|of| of.get(square(field.camera(), pixel)).copied());
        let size = DVec2::new(
            f64::from(field.camera().width),
            f64::from(field.camera().height),
        );
        let bridges = self.bridges.as_ref();
        let [bridged, of_bridge] = bridges.map_or([0.0; 2], |bridges| bridges.at(pixel / size));
        let is_known = roughness.is_some() || stated.surface.is_some();
        let of_surface = is_known.then(|| {
            let of_each = stated.surface.unwrap_or(0.0) / (depth * direction.length());
            let of_roughness = roughness.unwrap_or(0.0) * self.unseen.wider();
            of_roughness.powi(2) + of_each * of_each + of_bridge * of_bridge
        });
        let parts = [of_pose, of_focal, of_world, of_surface];
        let share = parts.iter().flatten().sum::<f64>().sqrt();
        let too_large = self.unseen.bias * roughness.unwrap_or(0.0) + bridged;
        Some(interval_of_scale(
            scale * (1.0 - too_large),
            scale * share,
            scale,
        ))
    }
}

/// How many rows of squares a photo has.
fn rows(camera: &Camera) -> usize {
    let (width, height) = (camera.width.max(1) as usize, camera.height as usize);
    // A scanner's line of a photo is no reason for millions.
    (ACROSS * height).div_ceil(width).clamp(1, 1024)
}

/// The square that a pixel lies in.
fn square(camera: &Camera, pixel: DVec2) -> usize {
    let place = |at: f64, size: u32, count: usize| {
        // `as` saturates.
        ((at / f64::from(size) * count as f64) as usize).min(count - 1)
    };
    let rows = rows(camera);
    place(pixel.y, camera.height, rows) * ACROSS + place(pixel.x, camera.width, ACROSS)
}

/// The scale at a pixel of a camera whose focal length is another, over a plane.
fn with_focal(field: &ScaleField, plane: DVec3, column: u32, row: u32, factor: f64) -> Option<f64> {
    let camera = Camera {
        fx: field.camera().fx * factor,
        fy: field.camera().fy * factor,
        ..field.camera().clone()
    };
    let pixel = field.grid.pixel(&camera, column, row);
    let direction = field.image().direction(&camera, pixel).ok()?;
    let lens = match field.image() {
        ImageKind::Undistorted => 1.0,
        ImageKind::AsShot => camera.lens_area(direction)?.sqrt(),
    };
    Some(factor * lens * plane.dot(direction / direction.z))
}
