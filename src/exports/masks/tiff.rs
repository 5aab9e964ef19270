//! A label image of 32 bits: where there are more fragments than 16 bits can number, and for programs that want TIFF.

use std::borrow::Cow;

use crate::delineation::LabelImage;
use crate::fault::Fault;
use crate::tiff_pages::{Page, Pixels, tiff_of};

/// A TIFF of one number a pixel: 0 is fines, 4 294 967 295 what is no rock, else the fragment's number.
///
/// # Errors
/// Where it would be larger than a TIFF can be.
pub fn labels_tiff(labels: &LabelImage) -> Result<Vec<u8>, Fault> {
    // The sides of photos are in u32.
    let page = Page {
        width: labels.width as u32,
        height: labels.height as u32,
        pixels: Pixels::Numbers(Cow::Borrowed(&labels.labels)),
        description: "{\"labels\":\"fragments in pixels of the undistorted photo\"}".to_owned(),
        resolution: None,
        georeference: None,
    };
    tiff_of(std::iter::once(Ok(page)))
}
