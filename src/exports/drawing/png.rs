//! Shapes in the pixels of a PNG, or of any picture.

use image::codecs::png::PngEncoder;
use image::{DynamicImage, ExtendedColorType, ImageEncoder, Rgba, RgbaImage};

use super::shapes::{Anchor, Shape};
use crate::fault::Fault;
use crate::files::marked_png;
use crate::markup::printable;
use crate::picture::{self, Canvas, Typeface};

/// Pixels to a unit of the figure: 1800 across, which are 300 dpi at 15 cm.
pub(crate) const PIXELS: f64 = 2.0;

/// Heights of a line to an em of the font.
const LINE: f64 = 1.121;

/// The font, which this program brings.
const TYPEFACE: Typeface = Typeface::Proportional;

/// The width of a line of text, units of the figure.
pub(crate) fn text_width(size: f64, text: &str) -> f64 {
    f64::from(picture::text_width(TYPEFACE, (size / LINE) as f32, text))
}

/// The bytes of a picture of this size.
///
/// # Errors
///
/// Only where the encoder fails.
pub(crate) fn bytes(shapes: &[Shape], size: [f64; 2]) -> Result<Vec<u8>, Fault> {
    let [width, height] = size.map(|length| (length * PIXELS) as u32);
    let mut pixels = RgbaImage::from_pixel(width, height, Rgba([255; 4]));
    draw_all(&mut pixels, shapes, PIXELS);
    let picture = DynamicImage::from(pixels).into_rgb8();
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(&picture, width, height, ExtendedColorType::Rgb8)
        .map_err(not_encoded)?;
    Ok(marked_png(bytes))
}

/// A picture with its opacity, for the inside of a document.
///
/// # Errors
/// Only where the encoder fails.
pub(super) fn picture_bytes(pixels: &RgbaImage) -> Result<Vec<u8>, Fault> {
    let (width, height) = pixels.dimensions();
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(pixels, width, height, ExtendedColorType::Rgba8)
        .map_err(not_encoded)?;
    Ok(bytes)
}

fn not_encoded(error: image::ImageError) -> Fault {
    let what = format!("the figure cannot be encoded ({error})");
    Fault::new(what, "report it: this is a defect")
}

/// Draws shapes over a picture, with so many of its pixels to a unit.
pub(crate) fn draw_all(picture: &mut RgbaImage, shapes: &[Shape], pixels: f64) {
    let mut canvas = Canvas::new(picture);
    canvas.set_typeface(TYPEFACE);
    for shape in shapes {
        draw(&mut canvas, shape, pixels);
    }
}

fn draw(canvas: &mut Canvas<'_>, shape: &Shape, to_a_unit: f64) {
    let pixels = |length: f64| (length * to_a_unit) as f32;
    let place = |point: &[f64; 2]| point.map(pixels);
    let opaque = |[red, green, blue]: [u8; 3]| [red, green, blue, u8::MAX];
    match shape {
        Shape::Line {
            points,
            colour,
            width,
            dash,
        } => {
            let points: Vec<[f32; 2]> = points.iter().map(place).collect();
            let lengths = dash.pattern().iter().map(|length| pixels(length * width));
            let lengths: Vec<f32> = lengths.collect();
            match lengths[..] {
                [] => canvas.polyline(&points, pixels(*width), opaque(*colour)),
                _ => canvas.dashed(&points, pixels(*width), &lengths, opaque(*colour)),
            }
        }
        Shape::Area {
            outline,
            colour,
            opacity,
        } => {
            let outline: Vec<[f32; 2]> = outline.iter().map(place).collect();
            let [red, green, blue] = *colour;
            let colour = [red, green, blue, (opacity * 255.0).round() as u8];
            canvas.polygon(&outline, colour);
        }
        Shape::Text {
            at,
            size,
            text,
            anchor,
            upwards,
            colour,
        } => {
            let anchor = match anchor {
                Anchor::Left => picture::Anchor::MiddleLeft,
                Anchor::Middle => picture::Anchor::Middle,
                Anchor::Right => picture::Anchor::MiddleRight,
            };
            let (at, em, text) = (place(at), pixels(size / LINE), printable(text));
            match upwards {
                true => canvas.text_upwards(at, em, opaque(*colour), &text, anchor),
                false => canvas.text(at, em, opaque(*colour), &text, anchor),
            }
        }
        Shape::Picture {
            at,
            size,
            pixels: picture,
        } => canvas.picture(place(at), place(size), picture),
    }
}
