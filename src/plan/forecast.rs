//! What a planned photo will show: its field of scales on the surface, before take-off.

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::scale::{FieldGrid, FittedScale, ImageKind, ScaleField};
use crate::surface::Surface;

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

/// The limits between which 98 of 100 numbers lie; sorts them. `None` without numbers.
pub(super) fn bulk_of(numbers: &mut [f64]) -> Option<[f64; 2]> {
    numbers.sort_by(f64::total_cmp);
    let last = numbers.len().checked_sub(1)?;
    let tail = numbers.len() / 100;
    Some([numbers[tail], numbers[last - tail]])
}
