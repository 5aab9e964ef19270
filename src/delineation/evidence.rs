//! What an engine says of a photo, and what the tree is grown from.

use image::RgbImage;
use rayon::prelude::*;

use crate::labels::{FINES, LabelImage};
use crate::votes::Votes;

/// What an engine says of every pixel of a photo, row by row from the top left, each 0 to 255.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Evidence {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// How sure it is a border: of two fragments, or of a fragment and what is none.
    pub border: Vec<u8>,
    /// How sure it is a fragment rather than fines or anything else; 255 where the engine cannot tell.
    pub rock: Vec<u8>,
    /// How far within a fragment: 0 at its border, 255 in its middle; 0 where the engine cannot tell.
    pub middle: Vec<u8>,
    /// How bright the photo is.
    pub gray: Vec<u8>,
    /// How large the fragment is and where its middle, where the engine can tell.
    pub votes: Option<Votes>,
}

impl Evidence {
    /// Of outlines that stand already, for who looks for another region by hand.
    pub(crate) fn of_outlines(labels: &LabelImage, photo: &RgbImage) -> Self {
        let (width, height) = (labels.width, labels.height);
        let at = |x: usize, y: usize| labels.labels[y * width + x];
        let mut border = vec![0; width * height];
        for y in 0..height {
            for x in 0..width {
                let differs = (x + 1 < width && at(x, y) != at(x + 1, y))
                    || (y + 1 < height && at(x, y) != at(x, y + 1));
                if differs {
                    border[y * width + x] = 255;
                }
            }
        }
        let rock = labels.labels.iter();
        let rock = rock.map(|label| if *label == FINES { 0 } else { 255 });
        Self {
            width,
            height,
            border,
            rock: rock.collect(),
            middle: vec![0; width * height],
            gray: gray(photo),
            votes: None,
        }
    }
}

/// The brightness (ITU-R BT.601's weights).
pub(crate) fn gray(photo: &RgbImage) -> Vec<u8> {
    let pixels = photo.as_raw().par_chunks_exact(3);
    pixels
        .map(|rgb| {
            let [r, g, b] = [rgb[0], rgb[1], rgb[2]].map(u32::from);
            ((299 * r + 587 * g + 114 * b + 500) / 1000) as u8
        })
        .collect()
}
