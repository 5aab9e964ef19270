//! COCO's `instances` JSON (cocodataset.org, "Data format"), as pycocotools, CVAT, Roboflow and Label Studio write it.
//!
//! - `segmentation` is polygons, which together are the region, or runs ([`super::rle`]). Polygons are filled at the
//!   middles of pixels; pycocotools takes up to a pixel more or less along slanting sides. Where there is a box alone,
//!   nothing is outlined, and the annotation is left out.
//! - `iscrowd`: a region of many things that nobody separated, so nothing is claimed of it: it is left out of the rock.
//!   Where all annotations of an image say so, it is the habit of the program (CVAT marks runs so), and they are fragments.
//! - What a network found may have a `score`: all are taken, whatever it is, and the least is said.
//! - The number of a fragment is `fragment` in files of ours.

use std::collections::HashMap;

use serde::Deserialize;
use serde_json::Value;

use super::numbers::Numbers;
use super::outline::{Mask, Meaning, OutlinedImage, Piece, Runs};
use super::rle::Segmentation;
use crate::fault::Fault;

/// An entry of `images`.
#[derive(Debug, Deserialize)]
pub(super) struct Image {
    id: Value,
    file_name: String,
    width: Option<u32>,
    height: Option<u32>,
}

/// An entry of `categories`.
#[derive(Debug, Deserialize)]
pub(super) struct Category {
    id: Value,
    #[serde(default)]
    name: String,
}

/// An entry of `annotations`.
#[derive(Debug, Deserialize)]
pub(super) struct Annotation {
    #[serde(default)]
    id: Value,
    image_id: Value,
    #[serde(default)]
    category_id: Value,
    #[serde(default)]
    segmentation: Segmentation,
    #[serde(default)]
    iscrowd: Value,
    fragment: Option<u32>,
    score: Option<f64>,
}

/// The images of a file.
///
/// # Errors
/// Where two images have the same number, or an annotation is of none.
pub(super) fn images(
    images: Vec<Image>,
    categories: Vec<Category>,
    annotations: Vec<Annotation>,
) -> Result<Vec<OutlinedImage>, Fault> {
    let categories = categories.into_iter();
    let classes: HashMap<String, String> = categories
        .map(|category| (category.id.to_string(), category.name))
        .collect();
    let mut places: HashMap<String, usize> = HashMap::new();
    let mut found: Vec<OutlinedImage> = Vec::new();
    let mut crowds: Vec<Vec<usize>> = Vec::new();
    // The least of each image.
    let mut scores: Vec<f64> = Vec::new();
    for image in images {
        if places.insert(image.id.to_string(), found.len()).is_some() {
            let what = format!("two of its images have the number {}", image.id);
            return Err(Fault::new(what, "export it again"));
        }
        found.push(OutlinedImage {
            name: Some(image.file_name),
            size: image.width.zip(image.height),
            ..OutlinedImage::default()
        });
        crowds.push(Vec::new());
        scores.push(f64::INFINITY);
    }
    for (annotation, count) in annotations.into_iter().zip(1..) {
        let place = match &annotation.id {
            Value::Null => format!("annotation {count} of the file"),
            id => format!("annotation {id}"),
        };
        let Some(&at) = places.get(&annotation.image_id.to_string()) else {
            let what = format!(
                "{place} is of image {}, which is not in the file",
                annotation.image_id
            );
            return Err(Fault::new(what, "export it again"));
        };
        let image = &mut found[at];
        let is_crowd = !matches!(&annotation.iscrowd, Value::Null | Value::Bool(false))
            && annotation.iscrowd.as_f64() != Some(0.0);
        let class = classes.get(&annotation.category_id.to_string());
        let class = class.cloned().unwrap_or_default();
        let pieces = match pieces(annotation.segmentation) {
            Ok(pieces) => pieces,
            Err(why) => {
                image.notes.at(why, &place);
                continue;
            }
        };
        scores[at] = scores[at].min(annotation.score.unwrap_or(f64::INFINITY));
        if is_crowd {
            crowds[at].push(image.masks.len());
        }
        image.masks.push(Mask {
            meaning: Meaning::of_class(&class),
            class,
            number: annotation.fragment,
            place,
            pieces,
        });
    }
    for (image, score) in found.iter_mut().zip(scores) {
        if score.is_finite() {
            let what = format!(
                "its outlines have scores, the least is {score}: all are taken, leave out which are none"
            );
            image.notes.say(what);
        }
    }
    for (image, crowds) in found.iter_mut().zip(crowds) {
        if crowds.len() == image.masks.len() {
            continue;
        }
        for at in crowds {
            let mask = &mut image.masks[at];
            mask.meaning = Meaning::NotRock;
            let what = "a region of many things (iscrowd) is left out of the rock";
            image.notes.at(what, &mask.place);
        }
    }
    Ok(found)
}

/// The pieces of a region; else why there are none.
fn pieces(segmentation: Segmentation) -> Result<Vec<Piece>, &'static str> {
    match segmentation {
        Segmentation::Nothing => Err("an annotation without an outline is left out"),
        Segmentation::Polygons(polygons) => {
            // One polygon may stand there without its list.
            let alone = [polygons];
            let several = match &alone[0] {
                Numbers::Lists(lists) if !matches!(lists.first(), Some(Numbers::Pair(_))) => lists,
                _ => &alone[..],
            };
            let ring = |polygon: &Numbers| polygon.corners().map(Piece::ring);
            let pieces: Option<Vec<Piece>> = several.iter().map(ring).collect();
            match pieces {
                None => Err("an outline whose numbers are no pairs is left out"),
                Some(pieces) => Ok(pieces),
            }
        }
        Segmentation::Runs { size, counts } => {
            const DAMAGED: &str = "an outline whose runs are damaged is left out";
            let Numbers::Pair(size) = size else {
                return Err(DAMAGED);
            };
            let counts = counts.unpacked().ok_or(DAMAGED)?;
            let runs = Runs {
                left: 0,
                top: 0,
                // Casts of floats end at the limits of their type.
                width: size.y as u32,
                height: size.x as u32,
                by_columns: true,
                counts,
            };
            match runs.are_whole() {
                true => Ok(vec![Piece::Runs(runs)]),
                false => Err(DAMAGED),
            }
        }
    }
}
