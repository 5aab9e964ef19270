//! A picture of values in colours, with lines at round values, and a legend beside it.

use glam::DVec2;
use image::buffer::ConvertBuffer;
use image::{Rgb, RgbImage, RgbaImage};
use rayon::prelude::*;

use super::ValueColors;
use crate::picture::canvas::{Canvas, Color};
use crate::picture::isolines::isolines;
use crate::picture::text::{Anchor, Typeface, text_width};

/// Where there is no value.
const NOTHING: [u8; 3] = [176; 3];
const LINE: Color = [0, 0, 0, 150];
const INK: Color = [20, 20, 20, 255];

/// The values, row by row and NaN where there is none, in their colours, with lines at the round values
/// and a legend to their right. `unit` stands over the legend; `without` in it, where values are
/// missing, says what that means.
pub fn value_picture(
    values: &[f64],
    columns: u32,
    colors: &ValueColors,
    unit: &str,
    without: &str,
) -> RgbImage {
    let rows = values.len().checked_div(columns as usize).unwrap_or(0) as u32;
    let letters = (columns.max(rows) as f32 * 0.018).max(13.0);
    let legend = Legend {
        colors,
        unit,
        without: values.iter().any(|value| value.is_nan()).then_some(without),
        letters,
        left: columns as f32 + letters,
        height: rows as f32,
    };
    let width = columns + legend.width().ceil() as u32;
    let height = rows.max(legend.least_height().ceil() as u32);
    let mut picture = RgbImage::from_pixel(width, height, Rgb([255; 3]));
    let pixels: &mut [u8] = &mut picture;
    pixels
        .par_chunks_mut(width as usize * 3)
        .zip(values.par_chunks(columns.max(1) as usize))
        .for_each(|(line, values)| {
            for (pixel, value) in line.chunks_exact_mut(3).zip(values) {
                pixel.copy_from_slice(&match value.is_nan() {
                    true => NOTHING,
                    false => colors.color(*value),
                });
            }
        });
    let mut picture: RgbaImage = picture.convert();
    let mut canvas = Canvas::new(&mut picture);
    let at = |column: u32, row: u32| {
        let value = values.get(row as usize * columns as usize + column as usize);
        value.copied().filter(|value| !value.is_nan())
    };
    let rows = u32::try_from(values.len() / columns.max(1) as usize).unwrap_or(u32::MAX);
    for line in isolines(columns, rows, at, &colors.levels()) {
        for piece in line.points.windows(2) {
            // A value belongs to the middle of its pixel.
            let on_picture = |end: DVec2| [end.x as f32 + 0.5, end.y as f32 + 0.5];
            let [from, to] = [on_picture(piece[0]), on_picture(piece[1])];
            canvas.line(from, to, letters * 0.06, LINE);
        }
    }
    legend.draw(&mut canvas);
    drop(canvas);
    picture.convert()
}

struct Legend<'a> {
    colors: &'a ValueColors,
    unit: &'a str,
    /// What stands beside the colour of no value, where there are such.
    without: Option<&'a str>,
    letters: f32,
    /// Where it begins.
    left: f32,
    height: f32,
}

impl Legend<'_> {
    /// Of the colours.
    fn bar_width(&self) -> f32 {
        self.letters * 1.5
    }

    /// With its margins.
    fn width(&self) -> f32 {
        let wide = |text: &str| text_width(Typeface::Proportional, self.letters, text);
        let labels = self.colors.levels();
        let labels = labels.iter().map(|level| wide(&self.colors.label(*level)));
        let beside = labels.chain(self.without.map(wide)).fold(0.0, f32::max);
        let below = self.bar_width() + self.letters * 0.8 + beside;
        below.max(wide(self.unit)) + self.letters * 2.0
    }

    fn least_height(&self) -> f32 {
        self.letters * 12.0
    }

    fn draw(&self, canvas: &mut Canvas<'_>) {
        let Self { letters, left, .. } = *self;
        let height = self.height.max(self.least_height());
        let right = left + self.bar_width();
        canvas.set_typeface(Typeface::Proportional);
        canvas.text([left, letters], letters, INK, self.unit, Anchor::TopLeft);
        // On whole pixels, so that no row is a mix of two.
        let top = (letters * 2.8).round();
        let below = if self.without.is_some() { 3.8 } else { 1.5 };
        let bottom = (height - letters * below).round();
        let steps = (bottom - top).max(1.0);
        let mut step = 0.0;
        while step < steps {
            let share = f64::from(1.0 - (step + 0.5) / steps);
            let value = self.colors.low + (self.colors.high - self.colors.low) * share;
            let [r, g, b] = self.colors.color(value);
            let (from, to) = (top + step, (top + step + 1.0).min(bottom));
            canvas.rect([left, from], [right, to], [r, g, b, 255]);
            step += 1.0;
        }
        for level in self.colors.levels() {
            let share = (level - self.colors.low) / (self.colors.high - self.colors.low);
            let y = bottom - (bottom - top) * share as f32;
            canvas.line([left, y], [right, y], letters * 0.06, LINE);
            canvas.line([right, y], [right + letters * 0.3, y], letters * 0.08, INK);
            let label = self.colors.label(level);
            let at = [right + letters * 0.6, y];
            canvas.text(at, letters, INK, &label, Anchor::MiddleLeft);
        }
        if let Some(without) = self.without {
            let (from, to) = (height - letters * 2.5, height - letters);
            let [r, g, b] = NOTHING;
            canvas.rect([left, from], [right, to], [r, g, b, 255]);
            let at = [right + letters * 0.6, (from + to) / 2.0];
            canvas.text(at, letters, INK, without, Anchor::MiddleLeft);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp from left to right: every pixel has the colour of its value, lines excepted; the legend
    /// has the colours of both ends.
    #[test]
    fn pixels_have_the_colours_of_their_values() {
        let (columns, rows) = (400_u32, 300_u32);
        let value = |i: u32| match i / columns {
            0..=9 => f64::NAN,
            _ => f64::from(i % columns),
        };
        let values: Vec<f64> = (0..columns * rows).map(value).collect();
        let colors = ValueColors::of(values.iter().copied()).unwrap();
        let picture = value_picture(&values, columns, &colors, "px/cm", "no surface");
        assert!(picture.width() > columns + 60 && picture.height() == rows);
        let (mut same, mut dark) = (0, 0);
        for y in 12..rows {
            for x in 0..columns {
                let expected = colors.color(f64::from(x));
                let found = picture.get_pixel(x, y).0;
                if found == expected {
                    same += 1;
                } else {
                    // A line at a round value passes: 50 apart.
                    let off = (f64::from(x) + 0.5 - 0.5) % 50.0;
                    assert!(off.min(50.0 - off) < 2.5, "{x}, {y}");
                    assert!(found[1] < expected[1].max(1));
                    dark += 1;
                }
            }
        }
        assert!(same > 100_000 && dark > 1000, "{same} {dark}");
        assert_eq!(picture.get_pixel(5, 3).0, NOTHING);
        // The ends of the bar are half a pixel inside.
        let near = |a: [u8; 3], b: [u8; 3]| a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 3);
        let has = |color: [u8; 3]| {
            let mut right = (columns..picture.width()).flat_map(|x| (0..rows).map(move |y| (x, y)));
            right.any(|(x, y)| near(picture.get_pixel(x, y).0, color))
        };
        assert!(has(NOTHING) && has(colors.color(colors.low)) && has(colors.color(colors.high)));
    }
}
