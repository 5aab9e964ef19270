//! Labels and legends written onto a picture, for files.

use glam::DVec2;
use image::RgbaImage;

use super::labels::{Label, Legend};
use super::photo_lines::ink;
use crate::picture::{Anchor, Canvas, Color, Halo, viridis};
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
        for (share, text) in legend.ticks() {
            let at = top_left + DVec2::new(-6.0 * self.point, height * (1.0 - share));
            self.text(at, self.ink, &text, Anchor::MiddleRight);
        }
    }
}

fn place(at: DVec2) -> [f32; 2] {
    [narrow_number(at.x), narrow_number(at.y)]
}

fn with_alpha([r, g, b]: [u8; 3]) -> Color {
    [r, g, b, 255]
}
