//! A flight's photo on its way to fragments: the same for the command and the window.

use std::collections::BTreeSet;
use std::sync::Arc;

use fragscale_core::camera::Camera;
use fragscale_core::fault::Fault;
use fragscale_core::flight::{
    Flight, FlightSettings, Limits, LookedUp, Photo, PhotoReview, Review,
};
use fragscale_core::jobs::Progress;
use fragscale_core::labels::LabelImage;
use fragscale_core::picture;
use fragscale_core::scale::{FieldGrid, ImageKind, Interval, ScaleField};
use fragscale_core::units::LengthUnit;
use image::RgbImage;

use crate::delineating::{LeftOut, leave_out};
use crate::engine::Habits;
use crate::mass::PhotoFragments;
use crate::measures::{SieveShape, measured};

/// The photo as fragments are outlined in it: undistorted, at its full size.
///
/// # Errors
/// Where the pixels are not as many as its camera's.
pub fn undistorted(pixels: &RgbImage, camera: &Camera) -> Result<RgbImage, Fault> {
    picture::check_size_of(pixels, camera)?;
    Ok(picture::undistorted(pixels, camera, u32::MAX))
}

/// Of each pixel of the undistorted photo whether it is no rock: a scale object that the flight masks. Empty where
/// there is none.
pub fn left_out(settings: &FlightSettings, photo: &Photo, camera: &Camera) -> Vec<bool> {
    let objects = settings.scale_objects.iter();
    let regions: Vec<_> = objects
        .filter(|object| object.photo == photo.name)
        .map(|object| object.left_out(camera, ImageKind::Undistorted))
        .filter(|region| !region.is_empty())
        .collect();
    if regions.is_empty() {
        return Vec::new();
    }
    let mask = picture::mask_of_regions(camera.width, camera.height, &regions);
    mask.pixels().map(|pixel| pixel.0 == [0; 3]).collect()
}

/// What scale objects take off outlines that were there before them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TakenOff {
    /// The fragments that lie on one with more than half of them: no rock altogether.
    pub gone: BTreeSet<u32>,
    /// What is to be said where fragments lay there.
    pub note: Option<String>,
}

/// What the scale objects cover that the flight masks is no rock in outlines that were there before them, and a fragment that lies on
/// one with more than half of it is none altogether.
pub fn take_off_objects(
    labels: &mut LabelImage,
    settings: &FlightSettings,
    photo: &Photo,
    camera: &Camera,
) -> TakenOff {
    let LeftOut { pixels, gone } = leave_out(labels, &left_out(settings, photo, camera));
    let covered = "what its scale objects cover is outlined as rock, and counts as none";
    TakenOff {
        gone,
        note: (pixels > 0).then(|| covered.to_owned()),
    }
}

/// The relative standard error of a photo's scale, the mean of both edges' best line; `None` where it is not known.
pub fn scale_error(photo: &PhotoReview<'_>) -> Option<f64> {
    // Of a ratio the unit does not matter.
    let uncertainty = photo.uncertainty(LengthUnit::Metre)?;
    let relative = |edge: Option<Interval>| {
        let edge = edge?;
        Some(2.0 * edge.standard_error / (edge.low + edge.high))
    };
    let [top, bottom] = [uncertainty.fitted_top, uncertainty.fitted_bottom].map(relative);
    Some((top? + bottom?) / 2.0)
}

/// The same of several photos of a flight, by their places in it.
///
/// # Errors
/// On cancel.
pub fn scale_errors(
    flight: &Arc<Flight>,
    looked_up: &LookedUp,
    photos: impl Iterator<Item = usize>,
    progress: &Progress,
) -> Result<Vec<Option<f64>>, Fault> {
    let (flight, looked_up) = (flight.clone(), looked_up.clone());
    let mut review = Review::of_scales(flight, looked_up, &Limits::default(), progress)?;
    review.compute_fields(progress)?;
    Ok(photos
        .map(|photo| scale_error(&review.photo(photo)?))
        .collect())
}

/// The scale of every pixel of the undistorted photo, by which fragments are measured.
///
/// # Errors
/// Where it has none, or on cancel.
pub fn field(flight: &Flight, photo: &Photo, progress: &Progress) -> Result<ScaleField, Fault> {
    let grid = FieldGrid::of_pixels(flight.camera(photo));
    flight.field(photo, ImageKind::Undistorted, grid, progress)
}

/// What a photo's fragments are in the world's `unit`. `habits` are those of the engine that outlined them, `None` of people and
/// other tools; the photo's edges are spread over `spread` pixels.
pub fn fragments(
    labels: &LabelImage,
    field: &ScaleField,
    shape: SieveShape,
    habits: Option<Habits>,
    spread: Option<f64>,
    unit: LengthUnit,
) -> PhotoFragments {
    let fragments = measured(labels, field, shape);
    let least = habits.map(|habits| habits.least_across(spread));
    PhotoFragments::new(labels, field, fragments, least, unit)
}
