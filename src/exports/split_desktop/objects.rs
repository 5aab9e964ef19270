//! Scale objects of the exported photos: what they say beside the point cloud, and what of the photo
//! they cover.

use glam::DVec2;

use super::ExportRequest;
use crate::fault::Fault;
use crate::flight::{ComparedObject, ScaleObject};
use crate::markup::escaped;
use crate::numbers::significant_digits;
use crate::scale::{ImageKind, Traced};
use crate::units::LengthUnit;

/// A scale object on one of the photos.
pub(super) struct PhotoObject<'a> {
    object: &'a ScaleObject,
    compared: ComparedObject,
    /// What it covers in the exported photo, pixels; empty where it is not masked.
    region: Vec<DVec2>,
    /// The same in the photo as shot.
    region_as_shot: Vec<DVec2>,
}

/// For each photo of the flight the scale objects on it, of those that are exported.
///
/// # Errors
/// Where the surface cannot be met.
pub(super) fn of_photos<'a>(
    request: &ExportRequest<'a>,
) -> Result<Vec<Vec<PhotoObject<'a>>>, Fault> {
    let flight = request.review.flight();
    let objects = &request.from.settings.scale_objects;
    let compared = request.review.compare_objects(objects)?;
    let photos = &flight.parts().photos;
    let mut of_photos: Vec<Vec<PhotoObject<'a>>> = photos.iter().map(|_| Vec::new()).collect();
    for (object, compared) in objects.iter().zip(compared) {
        let place = photos.iter().position(|photo| photo.name == object.photo);
        let Some(place) = place.filter(|&place| request.selected.get(place) == Some(&true)) else {
            continue;
        };
        let camera = flight.camera(&photos[place]);
        let region = object.left_out(camera, flight.parts().image);
        let region_as_shot = object.left_out(camera, ImageKind::AsShot);
        of_photos[place].push(PhotoObject {
            object,
            compared,
            region,
            region_as_shot,
        });
    }
    Ok(of_photos)
}

impl PhotoObject<'_> {
    /// Whether a part of the photo is painted over for it.
    pub(super) fn is_masked(&self) -> bool {
        !self.region.is_empty()
    }

    /// The part of the photo that is painted over, pixels.
    pub(super) fn region(&self) -> &Vec<DVec2> {
        &self.region
    }

    /// The same of the photo as shot.
    pub(super) fn region_as_shot(&self) -> &Vec<DVec2> {
        &self.region_as_shot
    }

    /// That it should be masked and is not, and why.
    pub(super) fn warning(&self) -> Option<String> {
        let object = self.object;
        if !object.mask || self.is_masked() {
            return None;
        }
        let why = match &self.compared.traced {
            Err(fault) => fault.to_string(),
            Ok(_) => "the lens does not see all of it".to_owned(),
        };
        Some(format!(
            "{}: its scale object, a {}, is not masked: {why}",
            object.photo,
            object.kind.as_str()
        ))
    }

    /// For the sheet, as HTML: its scale in `unit` beside that of the point cloud.
    pub(super) fn sentence(&self, unit: LengthUnit, world_unit: LengthUnit) -> String {
        let object = self.object;
        let factor = unit.in_units_of(world_unit);
        let scale = |scale: f64| format!("{} px/{unit}", significant_digits(scale * factor, 4));
        let percent = |share: f64| format!("{:+.1} %", share * 100.0);
        let mut text = format!(
            "scale object: {}, {} {} {world_unit}: ",
            object.kind.as_str(),
            object.kind.size_name(),
            object.size
        );
        let compared = &self.compared;
        match (&compared.traced, compared.scale) {
            (Err(fault), _) => text += &fault.to_string(),
            (Ok(_), None) => text += "no scale, the lens does not see it",
            (Ok(traced), Some(its)) => {
                text += &format!("<b>{}</b>", scale(its));
                if let Traced::Sphere(sphere) = traced
                    && let Some(error) = sphere.relative_error
                {
                    text += &format!(" ± {:.1} %", error * 100.0);
                }
                let place = compared.place;
                if let (Some(edges), Some(off)) = (place.between_edges, compared.beyond_edges()) {
                    text += &format!("; the point cloud has {} on its row", scale(edges));
                    text += &format!(" (the object {})", percent(off));
                }
                if let (Some(around), Some(off)) = (place.around, compared.beyond_surroundings()) {
                    text += &format!(", {} on the surface around it", scale(around));
                    text += &format!(" (the object {})", percent(off));
                }
                if let Some(off) = compared.beyond_length() {
                    text += &format!("; its length on the point cloud {}", percent(off));
                }
            }
        }
        if self.is_masked() {
            text += "; painted blue in the photo";
        }
        // Numbers and words of ours but for the fault, which may quote what a file holds.
        match compared.traced {
            Err(_) => escaped(&text),
            Ok(_) => text,
        }
    }
}
