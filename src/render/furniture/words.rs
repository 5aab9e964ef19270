//! Labels and legends written onto a picture, for files.

use glam::DVec2;
use image::RgbaImage;

use super::colormap::viridis;
use super::labels::{Label, Legend};
use super::photo_lines::ink;
use crate::picture::{Anchor, Canvas, Color, Halo};
use crate::scene::narrow_number;
use crate::show::{Background, Show};

/// Size of letters in points of the user interface.
const LETTERS: f64 = 13.0;
/// Width and height of the legend's bar in points.
const BAR: [f64; 2] = [14.0, 150.0];

pub(crate) fn write_words(
    picture: &mut RgbaImage,
    labels: &[Label],
    legend: Option<&Legend>,
    show: &Show,
) {
    let size = DVec2::new(f64::from(picture.width()), f64::from(picture.height()));
    let mut writer = Writer {
        canvas: Canvas::new(picture),
        point: show.pixels_per_point,
        ink: with_alpha(ink(show)),
        halo: Halo {
            color: match show.background {
                Background::Color(color) => with_alpha(color),
                Background::Transparent => [255; 4],
            },
            width: narrow_number(1.5 * show.pixels_per_point),
        },
    };
    writer.canvas.set_halo(Some(writer.halo));
    for label in labels {
        writer.text(label.at, with_alpha(label.color), &label.text, label.anchor);
    }
    if let Some(legend) = legend {
        writer.legend(legend, size);
    }
}

struct Writer<'a> {
    canvas: Canvas<'a>,
    point: f64,
    ink: Color,
    halo: Halo,
}

impl Writer<'_> {
    fn text(&mut self, at: DVec2, color: Color, text: &str, anchor: Anchor) {
        let size = narrow_number(LETTERS * self.point);
        self.canvas.text(place(at), size, color, text, anchor);
    }

    /// A bar of the colour map at the right edge, with round values beside it and its title above.
    fn legend(&mut self, legend: &Legend, size: DVec2) {
        let [width, height] = BAR.map(|length| length * self.point);
        let height = height.min(size.y * 0.5).round();
        let margin = 18.0 * self.point;
        let top = margin + LETTERS * 1.8 * self.point;
        let top_left = DVec2::new(size.x - margin - width, top).round();
        let bottom_right = top_left + DVec2::new(width, height);
        self.canvas
            .rect(place(top_left), place(bottom_right), self.ink);
        self.canvas.set_halo(None);
        // Whole rows of pixels have no seams.
        let mut y = top_left.y;
        while y < bottom_right.y {
            let share = (bottom_right.y - y - 0.5) / height;
            self.canvas.rect(
                place(top_left.with_y(y)),
                place(DVec2::new(bottom_right.x, y + 1.0)),
                with_alpha(viridis(share)),
            );
            y += 1.0;
        }
        self.canvas.set_halo(Some(self.halo));
        let title = DVec2::new(bottom_right.x, margin);
        self.text(title, self.ink, &legend.title, Anchor::TopRight);
        for (share, text) in ticks(legend.range) {
            let at = top_left + DVec2::new(-6.0 * self.point, height * (1.0 - share));
            self.text(at, self.ink, &text, Anchor::MiddleRight);
        }
    }
}

/// Three to seven round values within a range: where they are on it, from 0 to 1, and their text.
fn ticks([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    let span = high - low;
    let power = 10_f64.powf((span / 3.0).log10().floor());
    let fits = |step: &f64| span / *step >= 3.0;
    let steps = [5.0, 2.0, 1.0].map(|step| step * power);
    let Some(step) = steps.into_iter().find(fits) else {
        return Vec::new();
    };
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    let first = (low / step).ceil();
    (0..8)
        .map(|i| (first + f64::from(i)) * step)
        .take_while(|value| *value <= high)
        .map(|value| ((value - low) / span, format!("{value:.decimals$}")))
        .collect()
}

fn place(at: DVec2) -> [f32; 2] {
    [narrow_number(at.x), narrow_number(at.y)]
}

fn with_alpha([r, g, b]: [u8; 3]) -> Color {
    [r, g, b, 255]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let texts = |range| -> Vec<String> {
            let ticks = ticks(range);
            assert!(ticks.iter().all(|(share, _)| (0.0..=1.0).contains(share)));
            ticks.into_iter().map(|(_, text)| text).collect()
        };
        assert_eq!(texts([0.0, 90.0]), ["0", "20", "40", "60", "80"]);
        assert_eq!(texts([160.3, 161.1]), ["160.4", "160.6", "160.8", "161.0"]);
        assert_eq!(
            texts([1750.0, 2260.0]),
            ["1800", "1900", "2000", "2100", "2200"]
        );
        assert!(texts([1.0, 1.0]).is_empty());
    }
}
