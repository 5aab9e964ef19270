//! A scale object in the report of a flight's scales: what it says beside the point cloud.

use serde::Serialize;

use crate::fault::Fault;
use crate::flight::{ComparedObject, Review, ScaleObject};
use crate::scale::Traced;
use crate::units::LengthUnit;

/// A scale object on a photo. Scales are in pixels per the report's unit, lengths in the world's;
/// what is not known is `None`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ReportObject {
    /// "sphere" or "bar".
    pub kind: &'static str,
    /// Its diameter or length, as it was given.
    pub size: f64,
    /// Whether it is painted over in the exported photo.
    pub mask: bool,
    /// The one scale of the photo that follows from it.
    pub scale: Option<f64>,
    /// Standard error of that scale as a share of it.
    pub relative_error: Option<f64>,
    /// Root mean square distance of its points from the fitted outline, pixels as shot.
    pub rms_px: Option<f64>,
    /// The point cloud's scale there.
    pub point_cloud: PointCloudScale,
    /// A bar's length on the point cloud.
    pub length: Option<f64>,
    /// Why nothing is known.
    pub trouble: Option<String>,
}

/// The scale of the point cloud where a scale object is; see `scale::PlaceScale`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PointCloudScale {
    /// On its row, between the top and the bottom scale.
    pub on_row: Option<f64>,
    /// Of the surface around it.
    pub around: Option<f64>,
    /// Of the surface under it.
    pub under: Option<f64>,
}

impl ReportObject {
    /// The scale objects of each photo of a flight, in their order; scales in pixels per `unit`.
    ///
    /// # Errors
    /// Where the surface cannot be met.
    pub(super) fn of_photos(
        review: &Review,
        objects: &[ScaleObject],
        unit: LengthUnit,
    ) -> Result<Vec<Vec<Self>>, Fault> {
        let flight = review.flight();
        let factor = unit.in_units_of(flight.parts().unit);
        let compared = review.compare_objects(objects)?;
        let both: Vec<(&ScaleObject, ComparedObject)> = objects.iter().zip(compared).collect();
        let photos = flight.parts().photos.iter();
        let of_photo = |name: &str| {
            let its = both.iter().filter(|(object, _)| object.photo == name);
            its.map(|(object, compared)| Self::new(object, compared, factor))
                .collect()
        };
        Ok(photos.map(|photo| of_photo(&photo.name)).collect())
    }

    fn new(object: &ScaleObject, compared: &ComparedObject, factor: f64) -> Self {
        let in_unit = |scale: Option<f64>| scale.map(|scale| scale * factor);
        let place = compared.place;
        let sphere = match &compared.traced {
            Ok(Traced::Sphere(sphere)) => Some(sphere),
            Ok(Traced::Bar(_)) | Err(_) => None,
        };
        Self {
            kind: object.kind.as_str(),
            size: object.size,
            mask: object.mask,
            scale: in_unit(compared.scale),
            relative_error: sphere.and_then(|sphere| sphere.relative_error),
            rms_px: sphere.map(|sphere| sphere.rms),
            point_cloud: PointCloudScale {
                on_row: in_unit(place.between_edges),
                around: in_unit(place.around),
                under: in_unit(place.on_surface),
            },
            length: place.length_on_surface,
            trouble: compared.traced.as_ref().err().map(Fault::to_string),
        }
    }
}
