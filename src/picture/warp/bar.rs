//! A bar of known length below a picture that has one scale everywhere.

use image::{Rgba, RgbaImage};

use crate::numbers::{round_down, significant_digits};
use crate::picture::canvas::{Canvas, Color};
use crate::picture::text::{Anchor, Typeface, text_width};
use crate::units::{LengthUnit, round_length_in_words};

/// A bar is at most this share of the picture's width.
const LONGEST_SHARE: f64 = 0.35;

const INK: Color = [0, 0, 0, 255];

/// The picture with a white strip below it, in which stand a bar of a round length and its words. `pixel`
/// is the side of a pixel in `unit`. What was there before keeps its place.
pub fn bar_below(picture: &RgbaImage, pixel: f64, unit: LengthUnit) -> RgbaImage {
    let (width, height) = picture.dimensions();
    let letters = (width.max(height) as f32 * 0.022).max(14.0);
    let strip = (letters * 2.6).ceil() as u32;
    let below = strip_with_bar(width, strip, letters, pixel, unit);
    let mut out = RgbaImage::new(width, height + strip);
    let pixels: &mut [u8] = &mut out;
    let (above, rest) = pixels.split_at_mut(picture.as_raw().len());
    above.copy_from_slice(picture);
    rest.copy_from_slice(&below);
    out
}

fn strip_with_bar(
    width: u32,
    height: u32,
    letters: f32,
    pixel: f64,
    unit: LengthUnit,
) -> RgbaImage {
    let mut strip = RgbaImage::from_pixel(width, height, Rgba([255; 4]));
    let Some(length) = round_down(LONGEST_SHARE * f64::from(width) * pixel) else {
        return strip;
    };
    let words = round_length_in_words(length, unit);
    let text = format!("{words} · a pixel is {} {unit}", shortest(pixel));
    let long = (length / pixel) as f32;
    let thick = (letters * 0.3).round().max(2.0);
    let middle = height as f32 / 2.0;
    // From whole pixels, or its ends would be a mix.
    let left = letters.min((width as f32 - long) / 4.0).round();
    let top = (middle - thick / 2.0).round();
    let mut canvas = Canvas::new(&mut strip);
    canvas.set_typeface(Typeface::Proportional);
    canvas.rect([left, top], [left + long, top + thick], INK);
    let from = left + long + letters * 0.7;
    let room = width as f32 - from - letters * 0.3;
    let fit = room / text_width(Typeface::Proportional, letters, &text).max(1.0);
    let letters = letters * fit.min(1.0);
    canvas.text([from, middle], letters, INK, &text, Anchor::MiddleLeft);
    drop(canvas);
    strip
}

/// A round number as it is; another one to four digits.
fn shortest(number: f64) -> String {
    let whole = number.to_string();
    match whole.len() <= 8 {
        true => whole,
        false => significant_digits(number, 4),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 1000 pixels of 0.2 cm 350 may be bar, 70 cm: so 50 cm, 250 pixels.
    #[test]
    fn the_bar_is_as_long_as_it_says() {
        let picture = RgbaImage::from_fn(1000, 600, |x, y| {
            Rgba([x as u8, y as u8, 9, if x < 9 { 0 } else { 255 }])
        });
        let out = bar_below(&picture, 0.2, LengthUnit::Centimetre);
        assert_eq!(out.width(), 1000);
        assert!((630..700).contains(&out.height()), "{}", out.height());
        for (x, y, pixel) in picture.enumerate_pixels() {
            assert_eq!(out.get_pixel(x, y), pixel);
        }
        // The longest run of black in the strip.
        let mut longest = 0;
        for y in 600..out.height() {
            let mut run = 0;
            for x in 0..1000 {
                run = if out.get_pixel(x, y).0 == INK {
                    run + 1
                } else {
                    0
                };
                longest = longest.max(run);
            }
        }
        assert_eq!(longest, 250);
        assert_eq!(
            (shortest(0.2), shortest(1.0 / 3.0)),
            ("0.2".into(), "0.3333".into())
        );
    }
}
