//! LabelMe's JSON (github.com/wkentaro/labelme, versions 3 to 5), one file a photo.
//!
//! - `polygon`, `rectangle` (of two corners or four), `circle` (its middle and a place on it) and `mask` (a PNG within a
//!   box) are read; lines and points outline nothing and are left out. `imageData` is not looked at.
//! - Shapes of one `group_id` and label are one fragment.
//! - Corners count from the outer corner of the first pixel, as the program draws them; its `labelme_json_to_dataset` fills
//!   the pixels of the border, too.

use std::collections::HashMap;
use std::io::Cursor;

use glam::DVec2;
use image::{DynamicImage, ImageFormat, ImageReader};
use serde::Deserialize;
use serde_json::Value;

use super::base64;
use super::numbers::Numbers;
use super::outline::{Mask, Meaning, OutlinedImage, Piece, Runs};

/// An entry of `shapes`.
#[derive(Debug, Deserialize)]
pub(super) struct Shape {
    #[serde(default)]
    label: String,
    #[serde(default)]
    points: Numbers,
    #[serde(default)]
    group_id: Value,
    shape_type: Option<String>,
    mask: Option<String>,
}

/// The image of a file. `is_own`: the number of a group is that of its fragment.
pub(super) fn image(
    shapes: Vec<Shape>,
    name: Option<String>,
    size: Option<(u32, u32)>,
    is_own: bool,
) -> OutlinedImage {
    let mut image = OutlinedImage {
        name,
        size,
        ..OutlinedImage::default()
    };
    let mut groups: HashMap<(String, Meaning), usize> = HashMap::new();
    for (shape, count) in shapes.into_iter().zip(1..) {
        let place = format!("shape {count}");
        let meaning = Meaning::of_class(&shape.label);
        let piece = match piece(&shape, size) {
            Ok(piece) => piece,
            Err(why) => {
                image.notes.at(why, place);
                continue;
            }
        };
        let mask = Mask {
            meaning,
            class: shape.label.clone(),
            number: shape
                .group_id
                .as_u64()
                .filter(|_| is_own)
                .and_then(|number| u32::try_from(number).ok()),
            place,
            pieces: vec![piece],
        };
        if shape.group_id.is_null() {
            image.masks.push(mask);
            continue;
        }
        let group = groups.entry((shape.group_id.to_string() + &shape.label, meaning));
        match group {
            std::collections::hash_map::Entry::Occupied(group) => {
                image.masks[*group.get()].pieces.extend(mask.pieces);
            }
            std::collections::hash_map::Entry::Vacant(group) => {
                group.insert(image.masks.len());
                image.masks.push(mask);
            }
        }
    }
    image
}

/// What a shape outlines; else why it outlines nothing.
fn piece(shape: &Shape, size: Option<(u32, u32)>) -> Result<Piece, String> {
    let damaged = || "a shape whose points are no pairs is left out".to_owned();
    let corners = shape.points.corners().ok_or_else(damaged)?;
    match (
        shape.shape_type.as_deref().unwrap_or("polygon"),
        &corners[..],
    ) {
        ("polygon", _) => Ok(Piece::ring(corners)),
        ("rectangle", [a, b]) => Ok(Piece::rectangle(*a, *b, 0.0)),
        ("rectangle", [_, _, _, _]) => Ok(Piece::ring(corners)),
        ("circle", [middle, rim]) => {
            let half = DVec2::splat(middle.distance(*rim));
            Ok(Piece::ellipse(*middle, half, 0.0))
        }
        ("mask", [corner, ..]) => {
            let damaged = || "a mask that is damaged is left out".to_owned();
            let runs = shape
                .mask
                .as_deref()
                .and_then(|mask| runs(mask, *corner, size));
            runs.map(Piece::Runs).ok_or_else(damaged)
        }
        ("rectangle" | "circle" | "mask", _) => {
            Err("a shape with another number of points than its kind has is left out".to_owned())
        }
        (kind, _) => Err(format!(
            "a {} outlines nothing and is left out",
            crate::text::fields::shown(kind)
        )),
    }
}

/// The pixels of a PNG of which all but black ones are inside; the corner is that of its first pixel.
fn runs(mask: &str, corner: DVec2, size: Option<(u32, u32)>) -> Option<Runs> {
    let bytes = base64::decoded(mask)?;
    let reader = || ImageReader::with_format(Cursor::new(&bytes), ImageFormat::Png);
    let (width, height) = reader().into_dimensions().ok()?;
    // It lies in the image, so it is no larger; where nothing says how large that is, than any photo.
    let (most_wide, most_high) = size.unwrap_or((1 << 14, 1 << 14));
    if width > most_wide || height > most_high {
        return None;
    }
    let inside: Vec<bool> = match reader().decode().ok()? {
        DynamicImage::ImageLuma8(image) => image.pixels().map(|pixel| pixel[0] > 0).collect(),
        image => image
            .to_luma16()
            .pixels()
            .map(|pixel| pixel[0] > 0)
            .collect(),
    };
    let mut counts = vec![0];
    let mut is_inside = false;
    for pixel in inside {
        if pixel != is_inside {
            counts.push(0);
            is_inside = pixel;
        }
        *counts.last_mut()? += 1;
    }
    Some(Runs {
        // Casts of floats end at the limits of their type.
        left: corner.x.round() as i64,
        top: corner.y.round() as i64,
        width,
        height,
        by_columns: false,
        counts,
    })
}
