//! JSON of outlines, told by its keys: COCO has `images` and `annotations`, LabelMe `shapes`, GeoJSON `features`.

use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;

use super::outline::OutlinedImage;
use super::{KNOWN, coco, geojson, labelme};
use crate::fault::Fault;
use crate::text::json;

/// The keys of all three.
#[derive(Deserialize)]
struct Document {
    images: Option<Vec<coco::Image>>,
    annotations: Option<Vec<coco::Annotation>>,
    #[serde(default)]
    categories: Vec<coco::Category>,
    shapes: Option<Vec<labelme::Shape>>,
    #[serde(rename = "imagePath")]
    image_path: Option<String>,
    #[serde(rename = "imageWidth")]
    image_width: Option<u32>,
    #[serde(rename = "imageHeight")]
    image_height: Option<u32>,
    features: Option<Vec<geojson::Object>>,
    #[serde(default)]
    crs: Value,
    /// The photo of a GeoJSON of ours.
    photo: Option<String>,
    /// The size of the photo that a GeoJSON is of, where somebody states it.
    width: Option<Value>,
    height: Option<Value>,
    /// What the positions of a GeoJSON of ours are, where they are not pixels; or those of a geometry alone.
    coordinates: Option<Coordinates>,
    /// Of a feature alone.
    geometry: Option<IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Coordinates {
    Words(String),
    Numbers(IgnoredAny),
}

/// The images of a text; whether it is of one image, which need not be named.
///
/// # Errors
/// Where it is no JSON, or none of these.
pub(super) fn read(text: &[u8], is_own: bool) -> Result<(Vec<OutlinedImage>, bool), Fault> {
    let document: Document = json::parse(text)?;
    if let Some(shapes) = document.shapes {
        let size = document.image_width.zip(document.image_height);
        let image = labelme::image(shapes, document.image_path, size, is_own);
        return Ok((vec![image], true));
    }
    if let Some(features) = document.features {
        if let Some(Coordinates::Words(coordinates)) = document.coordinates.filter(|_| is_own) {
            let what = format!("its places are {coordinates}");
            let remedy =
                "give the label image beside it, or outlines in pixels (delineate --also geojson)";
            return Err(Fault::new(what, remedy));
        }
        let mut image = geojson::image(features, &document.crs, document.photo, is_own)?;
        // "1280", 1280.0 and what is no size of anything.
        let side = |value: Option<Value>| {
            let value = value?;
            let number = value
                .as_f64()
                .or_else(|| value.as_str()?.trim().parse().ok())?;
            let is_side = number.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(&number);
            is_side.then_some(number as u32)
        };
        image.size = side(document.width).zip(side(document.height));
        return Ok((vec![image], true));
    }
    match (document.images, document.annotations) {
        (Some(images), Some(annotations)) => {
            let images = coco::images(images, document.categories, annotations)?;
            Ok((images, false))
        }
        (None, None) if document.geometry.is_some() || is_geometry(&document.coordinates) => {
            let what = "it is one feature or geometry of GeoJSON alone, in no list of features";
            Err(Fault::new(what, "export it as a FeatureCollection"))
        }
        (None, None) => Err(Fault::new("it is JSON without outlines", KNOWN)),
        (None, Some(_)) => Err(Fault::new(
            "it is COCO without \"images\"",
            "export it with its images",
        )),
        (Some(_), None) => Err(Fault::new(
            "it is COCO without \"annotations\"",
            "export it with its annotations",
        )),
    }
}

fn is_geometry(coordinates: &Option<Coordinates>) -> bool {
    matches!(coordinates, Some(Coordinates::Numbers(_)))
}
