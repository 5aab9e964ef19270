//! Label images: each pixel holds the number of its fragment, 0 where there is none. PNG (ISO/IEC 15948)
//! of gray, and TIFF of one number a pixel, as tifffile and scikit-image write it (ImageGrains'
//! `NAME_pred.tif`, Cellpose's `NAME_cp_masks.tif`, ours).
//!
//! - What is no rock: 65 535 where numbers have 16 bits, 4 294 967 295 where they have 32 or more, and
//!   negative numbers. In 8 bits every number is a fragment's.
//! - A picture of another program with one number alone is a mask: each of its regions that touch by sides is
//!   a fragment. So says a note.
//! - A number that reaches all four edges is that of what lies between the others: no fragment, which is said.
//! - Many more regions than numbers are refused: numbers that several fragments share are of no fragment.
//! - A picture of colours whose three parts are the same is one of gray. Others are refused: colours are no
//!   numbers. Of a PNG with a palette (Pascal VOC, QuPath) the indices are the numbers, which is said.

use std::collections::BTreeSet;
use std::io::Cursor;

use image::codecs::png::PngDecoder;
use image::{ColorType, DynamicImage, ExtendedColorType, ImageDecoder};

use super::regions::{regions, take_off_behind};
use super::{Masks, OutlinedPhoto, check_size, renumbered};
use crate::clouds::geotiff::Number;
use crate::fault::Fault;
use crate::labels::{FINES, LabelImage, NOT_ROCK};
use crate::raster::{Compression, TiffFile};
use crate::text::notes::Notes;

/// Fragments that lie behind others are in two pieces or more, and edges leave single pixels: of what people and other programs
/// outlined, and of simulated photos, there are up to 1.4 regions a number.
const MOST_PIECES: usize = 2;
const FEW_PIECES: usize = 20;

/// What Pascal VOC's masks, and labelme's, have between objects and where nobody says what is there.
const VOID: u32 = 255;

const REMEDY: &str = "export it again, as a label image of 16 bits";

/// Whether a file begins like PNG or TIFF.
pub(super) fn is_picture(bytes: &[u8]) -> bool {
    is_png(bytes)
        || [&b"II*\0"[..], b"MM\0*", b"II+\0", b"MM\0+"].contains(&&bytes[..bytes.len().min(4)])
}

fn is_png(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89PNG")
}

/// The label image in a PNG or TIFF. `is_own` says whether fragscale wrote it.
///
/// # Errors
/// Where it is damaged, of another size than the photo, or holds no numbers.
pub(super) fn read(bytes: &[u8], photo: &OutlinedPhoto<'_>, is_own: bool) -> Result<Masks, Fault> {
    let mut notes = Notes::default();
    let mut labels = match is_png(bytes) {
        true => png(bytes, photo, &mut notes)?,
        false => tiff(bytes, photo, &mut notes)?,
    };
    if !is_own {
        take_off_behind(&mut labels, &mut notes);
        let (found, parts) = regions(&labels);
        match numbers(&labels)[..] {
            [number] if parts > 1 => {
                notes.say(format!(
                    "it has one number alone ({number}): each of its {parts} regions that touch no other is taken for a fragment"
                ));
                labels.labels = found;
            }
            ref several if parts as usize > MOST_PIECES * several.len() + FEW_PIECES => {
                let what = format!(
                    "its {} numbers lie in {parts} separate regions, where each is to be one fragment's: fragments share them, as where \
                     they were cut to 8 bits, mixed by a smooth change of size, or say what a pixel is of",
                    several.len()
                );
                return Err(Fault::new(what, REMEDY));
            }
            _ => {}
        }
    }
    if labels.fragments() == 0 {
        notes.say("no fragment is outlined in it");
    }
    Ok(Masks {
        labels: renumbered(labels, &mut notes),
        notes: notes.sentences(),
    })
}

fn labels_of(photo: &OutlinedPhoto<'_>, labels: Vec<u32>) -> LabelImage {
    LabelImage {
        width: photo.width as usize,
        height: photo.height as usize,
        labels,
    }
}

/// The indices of a PNG with a palette; `None` where it has none, or is broken, which is said elsewhere.
fn indices(bytes: &[u8]) -> Option<Vec<u32>> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::IDENTITY);
    let mut reader = decoder.read_info().ok()?;
    let info = reader.info();
    if info.color_type != png::ColorType::Indexed {
        return None;
    }
    let (width, bits) = (info.width as usize, info.bit_depth as usize);
    let mut pixels = vec![0; reader.output_buffer_size()?];
    let frame = reader.next_frame(&mut pixels).ok()?;
    let rows = pixels.chunks_exact(frame.line_size.max(1));
    let labels = rows.flat_map(|row| {
        (0..width).map(move |x| {
            // The first pixel has the highest bits of a byte.
            let (byte, within) = (x * bits / 8, x * bits % 8);
            let byte = row.get(byte).copied().unwrap_or(0);
            u32::from(byte << within >> (8 - bits))
        })
    });
    Some(labels.collect())
}

/// That of a PNG.
fn png(bytes: &[u8], photo: &OutlinedPhoto<'_>, notes: &mut Notes) -> Result<LabelImage, Fault> {
    let broken = |error: image::ImageError| {
        let what = format!("it cannot be read as PNG ({error})");
        Fault::new(what, "the file is cut off or damaged: export it again")
    };
    let decoder = PngDecoder::new(Cursor::new(bytes)).map_err(broken)?;
    let (width, height) = decoder.dimensions();
    // What the header claims takes no memory before it is the photo's size.
    check_size(width, height, photo)?;
    if let Some(mut labels) = indices(bytes) {
        notes.say("it has a palette: the numbers of its colours are taken for those of fragments");
        // Of 254 fragments and more 255 is one of them.
        let is_void = labels.contains(&VOID) && !labels.contains(&(VOID - 1));
        if is_void && labels.iter().any(|label| *label != 0 && *label != VOID) {
            notes.say("255 in its palette is no fragment, as in Pascal VOC's masks (void, between objects)");
            labels
                .iter_mut()
                .filter(|label| **label == VOID)
                .for_each(|label| *label = 0);
        }
        return Ok(labels_of(photo, labels));
    }
    let stored = decoder.original_color_type();
    let image = DynamicImage::from_decoder(decoder).map_err(broken)?;
    // Numbers of less than 8 bits are decoded as shades from 0 to 255.
    let step = match stored {
        ExtendedColorType::L1 => 255,
        ExtendedColorType::L2 => 85,
        ExtendedColorType::L4 => 17,
        _ => 1,
    };
    let labels = match &image {
        DynamicImage::ImageLuma8(image) => image
            .pixels()
            .map(|pixel| u32::from(pixel[0]) / step)
            .collect(),
        DynamicImage::ImageLumaA8(image) => image.pixels().map(|pixel| pixel[0].into()).collect(),
        DynamicImage::ImageLuma16(image) => {
            image.pixels().map(|pixel| of_16_bits(pixel[0])).collect()
        }
        DynamicImage::ImageLumaA16(image) => {
            image.pixels().map(|pixel| of_16_bits(pixel[0])).collect()
        }
        image if matches!(image.color(), ColorType::Rgb16 | ColorType::Rgba16) => {
            let image = image.to_rgb16();
            let pixels: Option<Vec<u32>> = image
                .pixels()
                .map(|pixel| same(pixel.0).map(of_16_bits))
                .collect();
            pixels.ok_or_else(colored)?
        }
        image => {
            let image = image.to_rgb8();
            let pixels: Option<Vec<u32>> = image
                .pixels()
                .map(|pixel| same(pixel.0).map(u32::from))
                .collect();
            pixels.ok_or_else(colored)?
        }
    };
    Ok(labels_of(photo, labels))
}

/// The part that red, green and blue have in common.
fn same<T: Copy + PartialEq>([red, green, blue]: [T; 3]) -> Option<T> {
    (red == green && green == blue).then_some(red)
}

fn colored() -> Fault {
    Fault::new("it is a picture in colours, no label image", REMEDY)
}

fn of_16_bits(number: u16) -> u32 {
    match number {
        u16::MAX => NOT_ROCK,
        number => number.into(),
    }
}

/// That of a TIFF: of several samples a pixel the first.
fn tiff(bytes: &[u8], photo: &OutlinedPhoto<'_>, notes: &mut Notes) -> Result<LabelImage, Fault> {
    let mut file = TiffFile::open(Cursor::new(bytes), bytes.len() as u64)?;
    let layout = file.layout()?;
    check_size(layout.width, layout.height, photo)?;
    if layout.compression == Compression::Jpeg {
        let what = "its numbers are compressed as JPEG, which changes them";
        return Err(Fault::new(what, REMEDY));
    }
    let (count, is_all) = file.images_alike(&layout);
    if count > 1 {
        let or_more = if is_all { "" } else { " or more" };
        let (width, height) = (layout.width, layout.height);
        let what = format!(
            "it is a stack of images, {count}{or_more} of {width} x {height} pixels, where one is to have the numbers of all fragments"
        );
        let remedy = "save one label image (in ImageJ the ROIs as labels), or the outlines as COCO or GeoJSON";
        return Err(Fault::new(what, remedy));
    }
    let numbers = Number::of(&layout)?;
    let samples = layout.samples_a_chunk();
    if layout.samples > 1 {
        if matches!(layout.photometric, 2 | 6) {
            return Err(colored());
        }
        notes.say(format!(
            "of its {} numbers a pixel the first is taken",
            layout.samples
        ));
    }
    let (width, height) = (layout.width as usize, layout.height as usize);
    let mut labels = vec![FINES; width * height];
    let mut has_negative = false;
    for index in 0..layout.across() * layout.down() {
        // A tile that is not stored is nothing but zeros.
        let Some(chunk) = file.chunk(&layout, index)? else {
            continue;
        };
        let ((left, top), (across, _)) = layout.extent(index);
        let row_bytes = layout.chunk.0 as usize * samples * numbers.bytes();
        let rows = chunk.chunks_exact(row_bytes.max(1));
        for (row, line) in labels.chunks_exact_mut(width).skip(top as usize).zip(rows) {
            let pixels = row.iter_mut().skip(left as usize).take(across as usize);
            for (label, stored) in pixels.zip(line.chunks_exact(samples * numbers.bytes())) {
                let value = numbers.read(stored).unwrap_or(0.0);
                has_negative |= value < 0.0;
                *label = of_number(value, layout.bits).ok_or_else(|| {
                    Fault::new(format!("{value} is no number of a fragment"), REMEDY)
                })?;
            }
        }
    }
    if has_negative && labels.contains(&FINES) {
        notes.say(
            "its negative numbers are taken for no rock, and 0 for what is no fragment: if 0 is one of the fragments, number them from 1",
        );
    }
    Ok(labels_of(photo, labels))
}

/// The label that a number of so many bits is.
fn of_number(value: f64, bits: u16) -> Option<u32> {
    let numbers = 0.0..=f64::from(u32::MAX);
    match bits {
        _ if value < 0.0 => Some(NOT_ROCK),
        _ if value.fract() != 0.0 || !numbers.contains(&value) => None,
        16 if value == f64::from(u16::MAX) => Some(NOT_ROCK),
        // Whole, and not beyond u32::MAX.
        _ => Some(value as u32),
    }
}

/// The numbers of fragments, each once.
fn numbers(labels: &LabelImage) -> Vec<u32> {
    let mut numbers = BTreeSet::new();
    let mut before = FINES;
    for label in &labels.labels {
        // Most pixels are of the same as the one before.
        if *label != before {
            before = *label;
            numbers.insert(before);
        }
    }
    let is_fragment = |label: &u32| *label != FINES && *label != NOT_ROCK;
    numbers.into_iter().filter(is_fragment).collect()
}
