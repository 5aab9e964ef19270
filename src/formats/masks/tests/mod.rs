//! Outlines as others write them, and what is wrong with some.

mod damaged;
mod label_images;
mod texts;

use std::io::Cursor;

use image::{DynamicImage, ImageFormat};

use super::{MaskFile, Masks, OutlinedPhoto};
use crate::fault::Fault;

/// A photo of 4 x 3 pixels.
const PHOTO: OutlinedPhoto<'static> = OutlinedPhoto {
    name: "IMG_0005.jpg",
    width: 4,
    height: 3,
};

fn of_bytes(bytes: &[u8]) -> Result<Masks, Fault> {
    MaskFile::from_bytes(bytes.to_vec())?.of_photo(&PHOTO)
}

fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}
