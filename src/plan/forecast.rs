//! What a planned photo will show: its field of scales on the surface, before take-off.

use glam::{DVec2, DVec3};

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::scale::{FieldGrid, FittedScale, ImageKind, ScaleField};
use crate::surface::Surface;

/// The outline has a point at every so many cells along the edges: 16 and some to a side are enough to see it by.
const EVERY: usize = 4;

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
    /// Of a photo from this pose, and where its edges lie on the surface, clockwise from the top left corner; `None`
    /// where it shows nothing of it.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub fn of(
        camera: &Camera,
        pose: &Pose,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<Option<(Self, Vec<DVec3>)>, Fault> {
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
        let forecast = Self {
            least,
            greatest,
            bulk,
            fitted: FittedScale::of(&field),
            depth: field.depth_at(grid.columns / 2, grid.rows / 2),
            covered: scales.len() as f64 / grid.len() as f64,
        };
        Ok(Some((forecast, outline(&field))))
    }
}

/// Where the edges of a photo lie on the surface, clockwise from the top left corner: at the depths of the cells along them. What
/// looks beyond the surface is missing.
fn outline(field: &ScaleField) -> Vec<DVec3> {
    let (camera, pose, grid) = (field.camera(), field.pose(), field.grid);
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let cells = DVec2::new(f64::from(grid.columns), f64::from(grid.rows));
    let point = |[column, row]: [u32; 2], onto: DVec2| {
        let depth = field.depth_at(column, row)?;
        let cell = DVec2::new(f64::from(column), f64::from(row)) + 0.5;
        // The middle of the cell, moved out to the edge.
        let pixel = (cell / cells + onto * (0.5 / cells)) * size;
        Some(pose.center + pose.rotation * camera.direction_undistorted(pixel) * depth)
    };
    let (last_column, last_row) = (grid.columns - 1, grid.rows - 1);
    let every = |last: u32| (0..=last).step_by(EVERY);
    let top = every(last_column).map(|column| ([column, 0], DVec2::NEG_Y));
    let right = every(last_row).map(|row| ([last_column, row], DVec2::X));
    let bottom = every(last_column).map(|from| ([last_column - from, last_row], DVec2::Y));
    let left = every(last_row).map(|from| ([0, last_row - from], DVec2::NEG_X));
    let around = top.chain(right).chain(bottom).chain(left);
    around
        .filter_map(|(cell, onto)| point(cell, onto))
        .collect()
}

/// The limits between which 98 of 100 numbers lie; sorts them. `None` without numbers.
pub(super) fn bulk_of(numbers: &mut [f64]) -> Option<[f64; 2]> {
    numbers.sort_by(f64::total_cmp);
    let last = numbers.len().checked_sub(1)?;
    let tail = numbers.len() / 100;
    Some([numbers[tail], numbers[last - tail]])
}
