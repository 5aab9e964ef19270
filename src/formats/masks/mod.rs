//! Outlines of fragments that other tools made, as label images.
//!
//! ```text
//! label_image  PNG and TIFF whose pixels are numbers of fragments
//! json_file    JSON, told by its keys: coco, labelme, geojson
//! cvat         XML of CVAT for images
//! outline      what these come down to: masks, their meanings, their pieces
//! paint        from masks to a label image
//! drawn_smaller  whether they are of a smaller copy of the photo
//! regions      in how many pieces each fragment lies
//! rle  numbers  base64      how pixels, lists and bytes are packed
//! ```
//!
//! A file is told by its bytes, not by its name. What is mended or left out is said in [`Masks::notes`].
//!
//! - Corners are in pixels of the photo, (0, 0) at the outer corner of its top left one; a pixel belongs to an outline where
//!   its middle does.
//! - Where outlines overlap, the smaller lies on top, and a note says how many pixels that are. Holes are kept.
//! - A class whose name says so is fines (`fines`, `sand`, ...) or no rock (`background`, `sky`, ...; the lists stand in
//!   `outline.rs`); all others are fragments, and what nobody outlined is fines.

mod base64;
mod coco;
mod cvat;
mod drawn_smaller;
mod geojson;
mod json_file;
mod label_image;
mod labelme;
mod numbers;
mod outline;
mod paint;
mod regions;
mod rle;
#[cfg(test)]
mod tests;

use std::path::Path;

use crate::fault::Fault;
use crate::files::same_name::{is_same, is_same_stem};
use crate::files::{FileError, is_own_result, last_segment, read_small, text_from_bytes};
use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::text::notes::Notes;
use outline::OutlinedImage;

/// How large a file may be, in bytes: of JSON that is 100 photos with thousands of fragments each.
const LARGEST: u64 = 256 << 20;

const KNOWN: &str =
    "give a label image (PNG or TIFF), COCO, LabelMe, CVAT for images 1.1, or GeoJSON in pixels";

/// The photo whose fragments are wanted.
#[derive(Debug, Clone, Copy)]
pub struct OutlinedPhoto<'a> {
    /// As the flight names it: a path of any system, of which the last part counts.
    pub name: &'a str,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
}

/// The fragments of a photo as another tool outlined them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Masks {
    /// Of the photo's size. The numbers of fragments may leave some out.
    pub labels: LabelImage,
    /// What was mended or left out, a sentence each.
    pub notes: Vec<String>,
}

/// A file of outlines, of one photo or of many.
#[derive(Debug)]
pub struct MaskFile {
    contents: Contents,
    is_own: bool,
}

#[derive(Debug)]
enum Contents {
    /// The bytes of a picture: of one photo, which it does not name.
    Picture(Vec<u8>),
    /// Of one photo; the name is what it was called when it was outlined.
    One(OutlinedImage),
    /// Of photos by their names.
    Many(Vec<OutlinedImage>),
}

impl MaskFile {
    /// Reads a file.
    ///
    /// # Errors
    /// With the file and the place in it: what is no file of outlines, or is damaged.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let bytes = read_small(path, LARGEST, "outlines", KNOWN)?;
        Self::from_bytes(bytes).map_err(|fault| FileError::new(path, fault))
    }

    /// The same from the bytes of a file.
    ///
    /// # Errors
    /// As [`MaskFile::read`], without the file.
    pub fn from_bytes(bytes: Vec<u8>) -> Result<Self, Fault> {
        let is_own = is_own_result(&bytes);
        if label_image::is_picture(&bytes) {
            let contents = Contents::Picture(bytes);
            return Ok(Self { contents, is_own });
        }
        if bytes.starts_with(b"PK\x03\x04") {
            let remedy = "unzip it, and give the file of outlines that is in it";
            return Err(Fault::new("it is a zip", remedy));
        }
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
        let contents = match text.trim_ascii_start().first() {
            None => return Err(Fault::new("it is empty", "export it again")),
            Some(b'{') => match json_file::read(text, is_own)? {
                (mut images, true) => Contents::One(images.pop().unwrap_or_default()),
                (images, false) => Contents::Many(images),
            },
            Some(b'[') => {
                let what = "it is a list of JSON, without the images that its outlines are of";
                return Err(Fault::new(what, KNOWN));
            }
            Some(b'<') => Contents::Many(cvat::read(text_from_bytes(text)?, is_own)?),
            Some(_) => return Err(Fault::new("it is no file of outlines", KNOWN)),
        };
        Ok(Self { contents, is_own })
    }

    /// Whether fragscale wrote it: then it is of the undistorted photo.
    pub fn is_own(&self) -> bool {
        self.is_own
    }

    /// Whether it is of one photo: then the file's own name may tell which, where it names none.
    pub fn is_of_one(&self) -> bool {
        !matches!(self.contents, Contents::Many(_))
    }

    /// The photos that it names.
    pub fn photos(&self) -> impl Iterator<Item = &str> {
        let images = match &self.contents {
            Contents::Picture(_) => &[],
            Contents::One(image) => std::slice::from_ref(image),
            Contents::Many(images) => &images[..],
        };
        images.iter().filter_map(|image| image.name.as_deref())
    }

    /// The label image of a photo. A file of many is asked for the photo of that name: the whole of it, else of its last
    /// part, else without what is behind its last dot.
    ///
    /// # Errors
    /// Where the file is not of this photo or of another size, or is damaged.
    pub fn of_photo(&self, photo: &OutlinedPhoto<'_>) -> Result<Masks, Fault> {
        let mut masks = self.read_of_photo(photo)?;
        let apart = match self.is_own {
            true => 0,
            false => regions::far_apart(&masks.labels),
        };
        if apart > 0 {
            let fragments = match apart {
                1 => "1 fragment lies in pieces far from each other: it counts as one, as large as all of it".to_owned(),
                _ => format!("{apart} fragments lie in pieces far from each other: each counts as one, as large as all of it"),
            };
            masks.notes.push(fragments);
        }
        Ok(masks)
    }

    fn read_of_photo(&self, photo: &OutlinedPhoto<'_>) -> Result<Masks, Fault> {
        let image = match &self.contents {
            Contents::Picture(bytes) => return label_image::read(bytes, photo, self.is_own),
            Contents::Many(images) => named(images, photo.name)?,
            Contents::One(image) => image,
        };
        let mut masks = paint::painted(image, photo, self.is_own)?;
        let other = image
            .name
            .as_deref()
            .filter(|name| !is_same_stem(name, photo.name));
        if let (Contents::One(_), Some(other)) = (&self.contents, other) {
            let what = format!(
                "it says that its outlines are of {other}, not of {}",
                photo.name
            );
            masks.notes.push(crate::fault::one_line(&what));
        }
        Ok(masks)
    }
}

/// The image of a photo's name.
fn named<'a>(images: &'a [OutlinedImage], photo: &str) -> Result<&'a OutlinedImage, Fault> {
    let all = |is_it: &dyn Fn(&str) -> bool| -> Vec<&'a OutlinedImage> {
        let named = images
            .iter()
            .filter(|image| image.name.as_deref().is_some_and(is_it));
        named.collect()
    };
    let ways: [&dyn Fn(&str) -> bool; 3] = [
        &|name| name == photo,
        &|name| is_same(last_segment(name), last_segment(photo)),
        &|name| is_same_stem(name, photo),
    ];
    for way in ways {
        match all(way)[..] {
            [] => {}
            [image] => return Ok(image),
            [one, other, ..] => {
                let name = |image: &OutlinedImage| image.name.clone().unwrap_or_default();
                let what = match name(one) == name(other) {
                    true => format!("two of its images are called {}", name(one)),
                    false => format!("{photo} may be {} or {} in it", name(one), name(other)),
                };
                return Err(Fault::new(
                    what,
                    "give the outlines of this photo in a file of its own",
                ));
            }
        }
    }
    let names = images.iter().filter_map(|image| image.name.as_deref());
    let what = match images.is_empty() {
        true => "it has outlines of no photo".to_owned(),
        false => format!(
            "it has no outlines of {photo}, but of {}",
            crate::fault::first_names(names)
        ),
    };
    Err(Fault::new(what, "give the outlines of this photo"))
}

/// The label image of a photo from a file.
///
/// # Errors
/// As [`MaskFile::read`] and [`MaskFile::of_photo`].
pub fn read_masks(path: &Path, photo: &OutlinedPhoto<'_>) -> Result<Masks, FileError> {
    let masks = MaskFile::read(path)?.of_photo(photo);
    masks.map_err(|fault| FileError::new(path, fault))
}

/// Refuses outlines of another size than the photo's.
fn check_size(width: u32, height: u32, photo: &OutlinedPhoto<'_>) -> Result<(), Fault> {
    if (width, height) == (photo.width, photo.height) {
        return Ok(());
    }
    let OutlinedPhoto {
        name,
        width: w,
        height: h,
    } = photo;
    Err(Fault::new(
        format!("its outlines are of {width} x {height} pixels, the photo {name} is of {w} x {h}"),
        "give the outlines of this photo at its full size",
    ))
}

/// Numbers beyond those of a label image are given anew: it holds no greater ones, and what is counted by number takes memory for the
/// greatest.
fn renumbered(mut labels: LabelImage, notes: &mut Notes) -> LabelImage {
    let most = usize::from(u16::MAX) - 1;
    if labels.fragments() <= most {
        return labels;
    }
    let is_fragment = |label: &u32| *label != FINES && *label != NOT_ROCK;
    let mut known: Vec<u32> = labels.labels.iter().copied().filter(is_fragment).collect();
    known.sort_unstable();
    known.dedup();
    for label in labels.labels.iter_mut().filter(|label| is_fragment(label)) {
        // There are no more of them than pixels.
        *label = known.partition_point(|other| other < label) as u32 + 1;
    }
    notes.say(format!(
        "numbers of fragments beyond {most} are given anew, from 1"
    ));
    labels
}
