//! What the scale field of one photo says: its best line, and how sure its scales are.

use super::field::{FieldError, FieldGrid, ScaleField};
use super::{FittedScale, ImageKind, PhotoScale, StatedErrors, UncertainPhoto, Uncertainty};
use crate::camera::{Camera, Pose};
use crate::jobs::Progress;
use crate::surface::Surface;

/// What the scale field of one photo says.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldFacts {
    /// The best line; `None` where too little of the photo shows the surface.
    pub fitted: Option<FittedScale>,
    /// The share of the fit's grid that has a scale.
    pub covered: f64,
    /// How sure the photo's scales are; `None` where nothing of it shows the surface.
    pub uncertainty: Option<Uncertainty>,
}

impl FieldFacts {
    /// Looks at the field of a photo.
    ///
    /// # Errors
    /// Where the work was cancelled.
    pub fn compute(
        camera: &Camera,
        pose: &Pose,
        image: ImageKind,
        scale: &PhotoScale,
        errors: &StatedErrors,
        surface: &Surface,
        progress: &Progress,
    ) -> Result<Self, FieldError> {
        let grid = FieldGrid::of_fit(camera);
        let field = ScaleField::compute(camera, pose, image, grid, surface, progress)?;
        let fitted = FittedScale::of(&field);
        let photo = UncertainPhoto {
            field: &field,
            fitted: fitted.as_ref(),
            scale,
            errors: *errors,
        };
        Ok(Self {
            uncertainty: Uncertainty::compute(&photo, surface),
            fitted,
            covered: field.covered(),
        })
    }
}
