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
    /// The best line; `None` where less than half of the photo shows the surface.
    pub fitted: Option<FittedScale>,
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
        let places =
            (0..grid.rows).flat_map(|row| (0..grid.columns).map(move |column| (column, row)));
        let mut scales: Vec<f64> = places
            .filter_map(|(column, row)| field.scale_at(column, row))
            .collect();
        scales.sort_by(f64::total_cmp);
        let (Some(&least), Some(&greatest)) = (scales.first(), scales.last()) else {
            return Ok(None);
        };
        Ok(Some(Self {
            least,
            greatest,
            fitted: FittedScale::of(&field),
            covered: scales.len() as f64 / grid.len() as f64,
        }))
    }

    /// The middle between the least and the greatest scale.
    pub fn middle(&self) -> f64 {
        (self.least + self.greatest) / 2.0
    }
}
