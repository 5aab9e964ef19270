//! The pictures of one photo: the image that its scale is for, the same with the scale drawn on it,
//! and a small one for the sheet.

use std::path::Path;

use glam::DVec2;
use image::metadata::Orientation;
use serde_json::json;

use super::photo_names::PhotoNames;
use crate::camera::Camera;
use crate::fault::Fault;
use crate::files::sha256_of_bytes;
use crate::picture::{self, DecodedPhoto, PhotoFormat};
use crate::scale::{ImageKind, PhotoScale, ScaleEstimate};
use crate::units::LengthUnit;

/// Of the undistorted photos: beyond it files grow and no eye sees a difference.
const PHOTO_QUALITY: u8 = 96;

/// Of pictures to look at.
const OVERLAY_QUALITY: u8 = 88;

/// The longest side of an overlay, pixels.
const OVERLAY_SIDE: u32 = 1600;

/// The longest side of a picture in the sheet, pixels: 200 a printed inch.
const THUMBNAIL_SIDE: u32 = 480;

/// Raised when the same inputs are to give other pictures.
const PICTURES_VERSION: u32 = 7;

/// What the pictures of a photo depend on.
pub(super) struct PictureSource<'a> {
    pub file: &'a Path,
    pub camera: &'a Camera,
    pub image: ImageKind,
    pub scale: &'a PhotoScale,
    /// Top and bottom scale for Split-Desktop, pixels per `unit`.
    pub pair: [Option<ScaleEstimate>; 2],
    pub unit: LengthUnit,
    /// What else the rectified photo depends on, where there is one.
    pub rectified: Option<String>,
    pub names: &'a PhotoNames,
    /// What is painted over, pixels of the image that the scale is for.
    pub left_out: Vec<Vec<DVec2>>,
}

impl PictureSource<'_> {
    /// Stands for everything that the pictures depend on, with the checksum of the photo's `bytes`.
    pub(super) fn fingerprint(&self, bytes: &[u8]) -> String {
        let camera = self.camera;
        let on: Vec<bool> = self
            .scale
            .corners
            .iter()
            .map(|corner| corner.outcome.is_on_surface())
            .collect();
        let points: Vec<bool> = self
            .scale
            .corners
            .iter()
            .map(|corner| corner.point().is_some())
            .collect();
        let pair = self.pair.map(|estimate| {
            let estimate = estimate?;
            let ends = estimate.interval.map(|ends| [ends.low, ends.high]);
            Some((estimate.value, ends))
        });
        let left_out = |region: &Vec<DVec2>| region.iter().map(DVec2::to_array).collect::<Vec<_>>();
        let text = json!([
            PICTURES_VERSION,
            sha256_of_bytes(bytes),
            [camera.width, camera.height],
            [camera.fx, camera.fy, camera.cx, camera.cy, camera.skew],
            camera.distortion.name(),
            camera.distortion.coefficients(),
            self.image == ImageKind::AsShot,
            pair,
            on,
            points,
            self.unit.symbol(),
            self.left_out.iter().map(left_out).collect::<Vec<_>>(),
            self.rectified,
        ]);
        sha256_of_bytes(text.to_string().as_bytes())
    }

    /// The files, with their names below the exported folder, of a photo and its file's bytes. The photo as shot is the file as it
    /// is, where nothing is painted over; else it has, as an undistorted one has, the format, the EXIF and the colour profile of its file.
    /// None has EXIF's mark to turn it: top and bottom are those of the pixels as they lie.
    ///
    /// # Errors
    /// Where the photo is of another size than its camera.
    pub(super) fn make(
        &self,
        photo: DecodedPhoto,
        bytes: Vec<u8>,
    ) -> Result<Vec<(String, Vec<u8>)>, Fault> {
        let (width, height) = photo.image.dimensions();
        let camera = self.camera;
        picture::check_size_of(&photo.image, camera)?;
        let (image, file) = match self.image {
            ImageKind::AsShot if self.left_out.is_empty() => match unturned(bytes, &photo) {
                Some(bytes) => (photo.image, bytes),
                None => self.new_file(photo)?,
            },
            _ => {
                drop(bytes);
                self.new_file(photo)?
            }
        };
        let small = picture::reduced(&image, OVERLAY_SIDE);
        drop(image);
        let drawn = |side: u32| -> Result<Vec<u8>, Fault> {
            let image = picture::reduced(&small, side);
            let image = picture::overlay(&image, self.scale, self.pair, self.unit);
            picture::encode(&image, PhotoFormat::Jpeg, OVERLAY_QUALITY, None, None)
        };
        let mut files = vec![
            (self.names.photo.clone(), file),
            (self.names.overlay.clone(), drawn(OVERLAY_SIDE)?),
            (self.names.thumbnail.clone(), drawn(THUMBNAIL_SIDE)?),
        ];
        if let Some(name) = &self.names.mask {
            let mask = picture::mask_of_regions(width, height, &self.left_out);
            let mask = picture::encode(&mask, PhotoFormat::Png, PHOTO_QUALITY, None, None)?;
            files.push((name.clone(), mask));
        }
        Ok(files)
    }

    /// The image that the scale is for, and its file.
    fn new_file(&self, photo: DecodedPhoto) -> Result<(image::RgbImage, Vec<u8>), Fault> {
        let mut image = match self.image {
            ImageKind::AsShot => photo.image,
            ImageKind::Undistorted => picture::undistorted(&photo.image, self.camera, u32::MAX),
        };
        picture::paint_regions(&mut image, &self.left_out);
        let mut exif = photo.exif;
        if let Some(exif) = &mut exif {
            let _ = Orientation::remove_from_exif_chunk(exif);
        }
        let bytes = picture::encode(
            &image,
            photo.format,
            PHOTO_QUALITY,
            exif.as_deref(),
            photo.icc.as_deref(),
        )?;
        Ok((image, bytes))
    }
}

/// A photo's file without EXIF's mark to turn it, else as it is; `None` where the mark is there and cannot be taken out in place:
/// in a JPEG no checksum counts its EXIF.
fn unturned(mut bytes: Vec<u8>, photo: &DecodedPhoto) -> Option<Vec<u8>> {
    if picture::turned_in_exif(&bytes).is_none() {
        return Some(bytes);
    }
    let is_jpeg = matches!(photo.format, PhotoFormat::Jpeg);
    let exif = photo
        .exif
        .as_ref()
        .filter(|exif| is_jpeg && !exif.is_empty())?;
    let place = bytes
        .windows(exif.len())
        .position(|part| part == exif.as_slice())?;
    let there = bytes.get_mut(place..place + exif.len())?;
    Orientation::remove_from_exif_chunk(there)?;
    Some(bytes)
}

/// That a program which follows a photo's EXIF shows another edge at the top than the sheet calls so.
pub(super) fn doubt_about_turning(bytes: &[u8]) -> Option<String> {
    let orientation = picture::turned_in_exif(bytes)?;
    Some(format!(
        "its EXIF says to show it turned (orientation {orientation}): top and bottom here are those of its pixels as they lie in the file, and \
         exported pictures are not turned"
    ))
}

/// What the photo's EXIF says against its size: `Ok` with a doubt where it was made smaller or turned.
///
/// # Errors
/// Where it says another shape: what is missing of the photo, and where, no one knows.
pub(super) fn doubt_about_size(bytes: &[u8], size: (u32, u32)) -> Result<Option<String>, Fault> {
    let Some(said) = picture::size_in_exif(bytes, size) else {
        return Ok(None);
    };
    let what = format!(
        "its EXIF says {} x {}, it has {} x {} pixels",
        said.width, said.height, size.0, size.1
    );
    match (said.same_shape, said.turned) {
        (true, _) => Ok(Some(format!(
            "{what}: it was made larger or smaller after it was taken"
        ))),
        (_, true) => Ok(Some(format!(
            "{what}: it was turned after it was taken; its pose is for the pixels as they are only if it was made from them"
        ))),
        _ => Err(Fault::new(
            format!("{what}: it was cropped or cut after it was taken"),
            "give the photo as the camera wrote it, or correct its EXIF",
        )),
    }
}
