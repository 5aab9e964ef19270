//! What is computed of all photos of a flight: scales, how they look at the surface, scale fields.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use super::{Flight, FlightParts, Outcome, Photo};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::scale::{
    FieldError, FieldFacts, FieldGrid, GroundFinder, ImageKind, Onto, PhotoScale, PixelSize,
    Rectification, ScaleField, ViewFacts,
};
use crate::surface::SurfaceError;

/// Columns of the grid that says what a photo to be rectified shows: four times those of the fit.
const RECTIFIED_COLUMNS: u32 = 256;

impl Flight {
    /// The scales of all photos, in their order.
    ///
    /// # Errors
    /// Where the surface cannot be met, or the work was cancelled.
    pub fn scales(&self, progress: &Progress) -> Result<Vec<Outcome>, Fault> {
        let FlightParts {
            surface,
            ground,
            image,
            photos,
            ..
        } = &self.parts;
        let mut caster = surface.caster().map_err(unusable)?;
        let mut finder = GroundFinder::new(*ground, surface);
        let mut outcomes = Vec::with_capacity(photos.len());
        progress.stage("computing scales");
        for photo in photos {
            progress.advance(outcomes.len() as u64, photos.len() as u64)?;
            outcomes.push(match &photo.trouble {
                Some(trouble) => Outcome::Trouble(trouble.clone()),
                None => {
                    let camera = self.camera(photo);
                    let scale =
                        PhotoScale::compute(camera, &photo.pose, *image, &mut finder, &mut caster);
                    Outcome::Scale(Box::new(scale.map_err(unusable)?))
                }
            });
        }
        Ok(outcomes)
    }

    /// How each photo looks at the surface, in their order; `None` where `outcomes`, those of
    /// [`Self::scales`], have no scale to look at.
    ///
    /// # Errors
    /// Where the surface cannot be met, or the work was cancelled.
    pub fn views(
        &self,
        outcomes: &[Outcome],
        progress: &Progress,
    ) -> Result<Vec<Option<ViewFacts>>, Fault> {
        let FlightParts {
            surface,
            ground,
            image,
            ..
        } = &self.parts;
        progress.stage("draping footprints");
        let tools = || (surface.caster(), GroundFinder::new(*ground, surface));
        self.each_with_a_scale(outcomes, progress, tools, |tools, photo, scale| {
            let (caster, finder) = tools;
            let caster = caster.as_mut().map_err(|error| unusable(error.clone()))?;
            let (camera, pose) = (self.camera(photo), &photo.pose);
            let view = ViewFacts::compute(camera, pose, *image, scale, finder, caster, progress);
            view.map_err(no_field)
        })
    }

    /// What the scale field of each photo says, in their order; `None` where `outcomes`, those of
    /// [`Self::scales`], have no scale.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub fn fields(
        &self,
        outcomes: &[Outcome],
        progress: &Progress,
    ) -> Result<Vec<Option<FieldFacts>>, Fault> {
        let FlightParts { surface, image, .. } = &self.parts;
        progress.stage("computing scale fields");
        self.each_with_a_scale(
            outcomes,
            progress,
            || (),
            |_, photo, scale| {
                let (camera, pose, errors) = (self.camera(photo), &photo.pose, self.errors(photo));
                FieldFacts::compute(camera, pose, *image, scale, &errors, surface, progress)
                    .map_err(no_field)
            },
        )
    }

    /// What `compute` finds of each photo that has a scale, on all cores, in the photos' order; `tools` are
    /// made for each thread.
    fn each_with_a_scale<T: Send, Tools>(
        &self,
        outcomes: &[Outcome],
        progress: &Progress,
        tools: impl Fn() -> Tools + Send + Sync,
        compute: impl Fn(&mut Tools, &Photo, &PhotoScale) -> Result<T, Fault> + Send + Sync,
    ) -> Result<Vec<Option<T>>, Fault> {
        let photos = &self.parts.photos;
        let done = AtomicU64::new(0);
        let all = photos.par_iter().zip(outcomes);
        all.map_init(tools, |tools, (photo, outcome)| {
            let Some(scale) = outcome.scale() else {
                return Ok(None);
            };
            let found = compute(tools, photo, scale);
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress.advance(done, photos.len() as u64)?;
            found.map(Some)
        })
        .collect()
    }

    /// The scale field of one of its photos, of the image asked for, on a grid.
    ///
    /// # Errors
    /// Where the photo can have no scale, none of the grid's rays meets the surface, or the work was
    /// cancelled.
    pub fn field(
        &self,
        photo: &Photo,
        image: ImageKind,
        grid: FieldGrid,
        progress: &Progress,
    ) -> Result<ScaleField, Fault> {
        if let Some(trouble) = &photo.trouble {
            return Err(Fault::new(
                trouble.clone(),
                "correct it, or leave the photo out",
            ));
        }
        let surface = &self.parts.surface;
        let camera = self.camera(photo);
        let field = ScaleField::compute(camera, &photo.pose, image, grid, surface, progress);
        let field = field.map_err(no_field)?;
        match field.is_empty() {
            true => Err(Fault::new(
                "none of its pixels shows the surface",
                "check its pose, and that the surface is that of this flight",
            )),
            false => Ok(field),
        }
    }
}

impl Flight {
    /// One of its photos seen squarely, with one scale everywhere: which place of the picture comes from
    /// which pixel of the photo as shot.
    ///
    /// # Errors
    /// Where the photo can have no scale or shows no surface, the plane is seen along itself, the picture
    /// would be too large, or the work was cancelled.
    pub fn rectification(
        &self,
        photo: &Photo,
        onto: Onto,
        size: PixelSize,
        progress: &Progress,
    ) -> Result<Rectification, Fault> {
        let grid = FieldGrid::of_fit(self.camera(photo));
        let grid = FieldGrid {
            columns: RECTIFIED_COLUMNS,
            rows: (grid.rows).saturating_mul(RECTIFIED_COLUMNS / grid.columns.max(1)),
        };
        let field = self.field(photo, ImageKind::AsShot, grid, progress)?;
        Rectification::new(&field, onto, size, &self.parts.surface, progress)
    }
}

/// What a field that cannot be computed means for a flight.
fn no_field(error: FieldError) -> Fault {
    match error {
        FieldError::Surface(error) => unusable(error),
        FieldError::Cancelled => Fault::new("cancelled", "start it again when you want it"),
    }
}

/// What a surface that cannot be met means for a flight.
pub(super) fn unusable(error: SurfaceError) -> Fault {
    Fault::new(error.to_string(), "check the surface file")
}
