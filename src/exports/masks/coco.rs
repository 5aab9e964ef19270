//! COCO's `instances` JSON for all photos (cocodataset.org, "Data format").
//!
//! A fragment without holes is polygons, one of each of its parts: pycocotools fills them to the very pixel, because their
//! corners are corners of pixels. One with holes is packed runs, which polygons of COCO cannot say. What is no rock
//! is of a category of its own; fines are what no annotation covers.

use std::collections::BTreeMap;

use serde::Serialize;

use super::boxes::{Box, boxes, counts};
use super::trace::{Part, parts};
use super::{DESCRIPTION, FRAGMENT, NOT_ROCK_NAME};
use crate::delineation::{FINES, LabelImage, NOT_ROCK};

const FRAGMENTS: u32 = 1;
const OTHERS: u32 = 2;

/// The outlines of photos, one photo after the other.
#[derive(Debug)]
pub struct CocoFile {
    document: Document,
}

#[derive(Debug, Serialize)]
struct Document {
    info: Info,
    licenses: [u8; 0],
    categories: [Category; 2],
    images: Vec<Image>,
    annotations: Vec<Annotation>,
}

#[derive(Debug, Serialize)]
struct Info {
    description: &'static str,
}

#[derive(Debug, Serialize)]
struct Category {
    id: u32,
    name: &'static str,
    supercategory: &'static str,
}

#[derive(Debug, Serialize)]
struct Image {
    id: usize,
    file_name: String,
    width: usize,
    height: usize,
}

#[derive(Debug, Serialize)]
struct Annotation {
    id: usize,
    image_id: usize,
    category_id: u32,
    iscrowd: u8,
    #[serde(skip_serializing_if = "Option::is_none")]
    fragment: Option<u32>,
    area: usize,
    bbox: [usize; 4],
    segmentation: Segmentation,
}

#[derive(Debug, Serialize)]
#[serde(untagged)]
enum Segmentation {
    Polygons(Vec<Vec<u32>>),
    Runs { size: [usize; 2], counts: String },
}

impl Default for CocoFile {
    fn default() -> Self {
        let category = |id, name| Category {
            id,
            name,
            supercategory: "",
        };
        Self {
            document: Document {
                info: Info {
                    description: DESCRIPTION,
                },
                licenses: [],
                categories: [
                    category(FRAGMENTS, FRAGMENT),
                    category(OTHERS, NOT_ROCK_NAME),
                ],
                images: Vec::new(),
                annotations: Vec::new(),
            },
        }
    }
}

impl CocoFile {
    /// Adds a photo, by its file name.
    pub fn add(&mut self, photo: &str, labels: &LabelImage) {
        let image_id = self.document.images.len() + 1;
        self.document.images.push(Image {
            id: image_id,
            file_name: photo.to_owned(),
            width: labels.width,
            height: labels.height,
        });
        let mut parts_of: BTreeMap<u32, Vec<Part>> = BTreeMap::new();
        for part in parts(labels).0 {
            if part.label != FINES {
                parts_of.entry(part.label).or_default().push(part);
            }
        }
        let boxes = boxes(labels);
        for ((label, parts), of) in parts_of.into_iter().zip(boxes.into_values()) {
            let has_holes = parts.iter().any(|part| part.rings.len() > 1);
            let segmentation = match has_holes {
                true => runs(labels, label, of),
                false => Segmentation::Polygons(
                    parts
                        .into_iter()
                        .flat_map(|part| part.rings)
                        .map(|ring| ring.concat())
                        .collect(),
                ),
            };
            self.document.annotations.push(Annotation {
                id: self.document.annotations.len() + 1,
                image_id,
                category_id: if label == NOT_ROCK { OTHERS } else { FRAGMENTS },
                iscrowd: 0,
                fragment: (label != NOT_ROCK).then_some(label),
                area: of.pixels,
                bbox: [of.left, of.top, of.width, of.height],
                segmentation,
            });
        }
    }

    /// The text of the file.
    ///
    /// # Errors
    /// Where memory runs out.
    pub fn text(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(&self.document)
    }
}

/// The runs of a label, column by column, packed as pycocotools does it.
fn runs(image: &LabelImage, label: u32, of: Box) -> Segmentation {
    let (width, height) = (image.width, image.height);
    let columns = of.left..of.left + of.width;
    let places = columns.flat_map(|x| (0..height).map(move |y| y * width + x));
    let mut counts = counts(image, label, places);
    // What lies left and right of its box. Photos have less than 2^32 pixels.
    counts[0] += (of.left * height) as u32;
    let rest = ((width - of.left - of.width) * height) as u32;
    let last = counts.len() - 1;
    match last % 2 {
        // The last are outside, too.
        0 => counts[last] += rest,
        _ if rest > 0 => counts.push(rest),
        _ => {}
    }
    Segmentation::Runs {
        size: [height, width],
        counts: packed(&counts),
    }
}

/// Counts as a text (`maskApi.c` of pycocotools, `rleToString`): each, from the fourth on less the one two before, in digits
/// of five bits, lowest first, as letters from '0'; a sixth bit says that more follow.
fn packed(counts: &[u32]) -> String {
    let mut text = String::new();
    for (index, count) in counts.iter().enumerate() {
        let before = if index > 2 { counts[index - 2] } else { 0 };
        let mut rest = i64::from(*count) - i64::from(before);
        loop {
            let digit = (rest & 0x1f) as u8;
            rest >>= 5;
            let is_last = if digit & 0x10 != 0 {
                rest == -1
            } else {
                rest == 0
            };
            text.push(char::from(b'0' + digit + if is_last { 0 } else { 0x20 }));
            if is_last {
                break;
            }
        }
    }
    text
}
