//! What a planned photo will show: its field of scales on the surface, before take-off.

use glam::{DVec2, DVec3};

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::geometry::Ray;
use crate::jobs::Progress;
use crate::scale::{FieldGrid, FittedScale, ImageKind, ScaleField};
use crate::surface::Surface;

/// Points of an outline along each edge of the image.
const PER_EDGE: u32 = 8;

/// What a photo will show (contract, section 7), of the undistorted image. Scales are in pixels per world unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forecast {
    /// The least scale on the grid of the fit.
    pub least: f64,
    /// The greatest.
    pub greatest: f64,
    /// Between these lie 98 of 100 of its scales: a stray point of the cloud, or the top of one stone, decides the
    /// least and the greatest.
    pub bulk: [f64; 2],
    /// The best line; `None` where less than half of the photo shows the surface.
    pub fitted: Option<FittedScale>,
    /// From the camera to what its middle shows, along the axis, world units; `None` where that is nothing.
    pub depth: Option<f64>,
    /// The share of the photo that shows the surface.
    pub covered: f64,
}

impl Forecast {
    /// Of a photo from this pose; `None` where it shows nothing of the surface.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub fn of(
        camera: &Camera,
        pose: &Pose,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<Option<Self>, Fault> {
        let grid = FieldGrid::of_fit(camera);
        let image = ImageKind::Undistorted;
        let field = ScaleField::compute(camera, pose, image, grid, surface, progress)
            .map_err(|error| Fault::new(error.to_string(), "check the surface file"))?;
        let mut scales: Vec<f64> = (grid.cells())
            .filter_map(|(column, row)| field.scale_at(column, row))
            .collect();
        let bulk = bulk_of(&mut scales);
        let (Some(&least), Some(&greatest), Some(bulk)) = (scales.first(), scales.last(), bulk)
        else {
            return Ok(None);
        };
        Ok(Some(Self {
            least,
            greatest,
            bulk,
            fitted: FittedScale::of(&field),
            depth: field.depth_at(grid.columns / 2, grid.rows / 2),
            covered: scales.len() as f64 / grid.len() as f64,
        }))
    }
}

/// Where the edges of an undistorted photo lie on the surface, clockwise from the top left corner; without what looks beyond
/// the surface.
pub(super) fn outline(
    camera: &Camera,
    pose: &Pose,
    surface: &Surface,
) -> Result<Vec<DVec3>, Fault> {
    let mut caster = (surface.caster())
        .map_err(|error| Fault::new(error.to_string(), "check the surface file"))?;
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let corners = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].map(|corner| corner * size);
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let pixels = edges.flat_map(|(from, to)| {
        let step = |step: u32| from.lerp(*to, f64::from(step) / f64::from(PER_EDGE));
        (0..PER_EDGE).map(step)
    });
    let points = pixels.filter_map(|pixel| {
        let direction = pose.rotation * camera.direction_undistorted(pixel);
        let ray = Ray {
            origin: pose.center,
            direction: direction.normalize(),
        };
        Some(caster.cast(&ray)?.point)
    });
    Ok(points.collect())
}

/// The limits between which 98 of 100 numbers lie; sorts them. `None` without numbers.
pub(super) fn bulk_of(numbers: &mut [f64]) -> Option<[f64; 2]> {
    numbers.sort_by(f64::total_cmp);
    let last = numbers.len().checked_sub(1)?;
    let tail = numbers.len() / 100;
    Some([numbers[tail], numbers[last - tail]])
}
