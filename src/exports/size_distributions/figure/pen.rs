//! Strokes, areas, markers and words by plotters, in units of the figure.

use std::sync::LazyLock;

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, DrawingAreaErrorKind};
use plotters::element::{PathElement, Polygon};
use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color, FontStyle, FontTransform, IntoFont, RGBColor, TextStyle, register_font,
};

use super::{Dash, Marker};
use crate::fault::Fault;
use crate::markup::printable;

/// Plotters counts whole units only: with so many of them to a unit of the figure, a curve has no
/// steps, and a picture that is reduced by some of them has smooth edges.
pub(super) const FINE: u32 = 4;

/// The name under which plotters knows the font; an SVG asks its viewer for the same.
const FONT: &str = "sans-serif";

/// Whether the font that we are built with could be read.
static FONT_IS_THERE: LazyLock<bool> = LazyLock::new(|| {
    let bytes = epaint_default_fonts::UBUNTU_LIGHT;
    register_font(FONT, FontStyle::Normal, bytes).is_ok()
});

/// sRGB.
pub(super) type Colour = [u8; 3];

/// Which end of a text is meant; always at half the height of its letters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
}

/// Draws on one backend of plotters.
pub(super) struct Pen<'a, B: DrawingBackend> {
    area: &'a DrawingArea<B, Shift>,
    lower: f64,
}

impl<'a, B: DrawingBackend> Pen<'a, B> {
    /// A pen for an area of `FINE` times the figure's size. By `lower` heights of a line the backend
    /// puts the middle of digits and capitals too high.
    pub(super) fn new(area: &'a DrawingArea<B, Shift>, lower: f64) -> Result<Self, Fault> {
        match *FONT_IS_THERE {
            true => Ok(Self { area, lower }),
            false => Err(cannot_draw("the font cannot be read")),
        }
    }

    pub(super) fn ground(&self, colour: Colour) -> Result<(), Fault> {
        self.area.fill(&rgb(colour)).map_err(of_plotters)
    }

    /// A line through points; at least two.
    pub(super) fn line(
        &self,
        points: &[[f64; 2]],
        colour: Colour,
        width: f64,
        dash: Dash,
    ) -> Result<(), Fault> {
        let style = rgb(colour).stroke_width(fine(width).unsigned_abs());
        for stroke in strokes(points, dash.pattern(), width) {
            let stroke = whole(&stroke);
            if stroke.len() > 1 {
                self.area
                    .draw(&PathElement::new(stroke, style))
                    .map_err(of_plotters)?;
            }
        }
        Ok(())
    }

    /// A filled outline. `opacity` is 0 to 1.
    pub(super) fn area(
        &self,
        outline: &[[f64; 2]],
        colour: Colour,
        opacity: f64,
    ) -> Result<(), Fault> {
        let outline = whole(outline);
        if outline.len() < 3 {
            return Ok(());
        }
        let style = rgb(colour).mix(opacity).filled();
        self.area
            .draw(&Polygon::new(outline, style))
            .map_err(of_plotters)
    }

    /// A marker with a white rim, `radius` being half a circle's width.
    pub(super) fn marker(
        &self,
        at: [f64; 2],
        marker: Marker,
        radius: f64,
        colour: Colour,
    ) -> Result<(), Fault> {
        let white = [255; 3];
        if marker == Marker::Cross {
            for (width, colour) in [(4.4, white), (2.2, colour)] {
                let r = 0.9 * radius + 0.3 * (width - 2.2);
                for end in [[r, r], [r, -r]] {
                    let points = [
                        [at[0] - end[0], at[1] - end[1]],
                        [at[0] + end[0], at[1] + end[1]],
                    ];
                    self.line(&points, colour, width, Dash::Solid)?;
                }
            }
            return Ok(());
        }
        for (radius, colour) in [(radius + 1.2, white), (radius, colour)] {
            self.area(&outline(at, marker, radius), colour, 1.0)?;
        }
        Ok(())
    }

    /// A line of text; `size` is the height of a line.
    pub(super) fn text(
        &self,
        at: [f64; 2],
        size: f64,
        text: &str,
        anchor: Anchor,
        colour: Colour,
    ) -> Result<(), Fault> {
        self.write(at, size, text, anchor, false, colour)
    }

    /// A line of text that reads upwards, its middle at a point.
    pub(super) fn text_upwards(
        &self,
        at: [f64; 2],
        size: f64,
        text: &str,
        colour: Colour,
    ) -> Result<(), Fault> {
        self.write(at, size, text, Anchor::Middle, true, colour)
    }

    /// The width of a line of text, by the font of the PNG.
    pub(super) fn width(&self, size: f64, text: &str) -> f64 {
        let style = TextStyle::from((FONT, size * f64::from(FINE)).into_font());
        let measured = self.area.estimate_text_size(text, &style);
        measured.map_or(0.0, |(width, _)| f64::from(width) / f64::from(FINE))
    }

    fn write(
        &self,
        at: [f64; 2],
        size: f64,
        text: &str,
        anchor: Anchor,
        upwards: bool,
        colour: Colour,
    ) -> Result<(), Fault> {
        let across = match anchor {
            Anchor::Left => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        let lower = self.lower * size;
        let (transform, at) = match upwards {
            true => (FontTransform::Rotate270, [at[0] + lower, at[1]]),
            false => (FontTransform::None, [at[0], at[1] + lower]),
        };
        let colour = rgb(colour);
        let style = TextStyle::from((FONT, size * f64::from(FINE)).into_font())
            .transform(transform)
            .color(&colour)
            .pos(Pos::new(across, VPos::Center));
        self.area
            .draw_text(&printable(text), &style, (fine(at[0]), fine(at[1])))
            .map_err(of_plotters)
    }
}

fn rgb(colour: Colour) -> RGBColor {
    RGBColor(colour[0], colour[1], colour[2])
}

/// A length in whole units of plotters; far from what an i32 holds, by `Layout`.
fn fine(length: f64) -> i32 {
    (length * f64::from(FINE)).round() as i32
}

/// Without points that fall together, at which plotters finds no direction.
fn whole(points: &[[f64; 2]]) -> Vec<(i32, i32)> {
    let mut whole: Vec<(i32, i32)> = points.iter().map(|p| (fine(p[0]), fine(p[1]))).collect();
    whole.dedup();
    whole
}

fn outline([x, y]: [f64; 2], marker: Marker, r: f64) -> Vec<[f64; 2]> {
    let corners = |corners: &[[f64; 2]]| {
        corners
            .iter()
            .map(|c| [x + r * c[0], y + r * c[1]])
            .collect()
    };
    match marker {
        // As large as the circle to the eye.
        Marker::Square => corners(&[[-0.9, -0.9], [0.9, -0.9], [0.9, 0.9], [-0.9, 0.9]]),
        Marker::Diamond => corners(&[[0.0, -1.3], [1.3, 0.0], [0.0, 1.3], [-1.3, 0.0]]),
        Marker::Triangle => corners(&[[0.0, -1.25], [1.15, 0.8], [-1.15, 0.8]]),
        Marker::TriangleDown => corners(&[[0.0, 1.25], [-1.15, -0.8], [1.15, -0.8]]),
        Marker::Circle | Marker::Cross => (0..24)
            .map(|i| (f64::from(i) * 15.0).to_radians())
            .map(|angle| [x + r * angle.cos(), y + r * angle.sin()])
            .collect(),
    }
}

/// The strokes that a dash leaves of a line; the pattern's lengths are in widths of the line.
fn strokes(points: &[[f64; 2]], pattern: &[f64], width: f64) -> Vec<Vec<[f64; 2]>> {
    if pattern.is_empty() {
        return vec![points.to_vec()];
    }
    let mut lengths = pattern.iter().map(|length| length * width).cycle();
    let mut left = lengths.next().unwrap_or(f64::INFINITY);
    let mut drawing = true;
    let mut strokes = Vec::new();
    let mut stroke: Vec<[f64; 2]> = points.first().copied().into_iter().collect();
    for pair in points.windows(2) {
        let &[mut from, to] = pair else { continue };
        loop {
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            if length <= left {
                left -= length;
                break;
            }
            let share = left / length;
            from = [
                from[0] + share * (to[0] - from[0]),
                from[1] + share * (to[1] - from[1]),
            ];
            if drawing {
                stroke.push(from);
                strokes.push(std::mem::take(&mut stroke));
            } else {
                stroke.push(from);
            }
            drawing = !drawing;
            left = lengths.next().unwrap_or(f64::INFINITY);
        }
        if drawing {
            stroke.push(to);
        }
    }
    if stroke.len() > 1 {
        strokes.push(stroke);
    }
    strokes
}

pub(super) fn of_plotters<E: std::error::Error + Send + Sync>(
    error: DrawingAreaErrorKind<E>,
) -> Fault {
    cannot_draw(&error.to_string())
}

fn cannot_draw(why: &str) -> Fault {
    Fault::new(
        format!("the figure cannot be drawn ({why})"),
        "report it: this is a defect",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line of 10 around a corner at 4, strokes of 3 and gaps of 2: 0 to 3, 5 to 8.
    #[test]
    fn dashes_go_on_around_corners() {
        let line = [[0.0, 0.0], [4.0, 0.0], [4.0, 6.0]];
        let found = strokes(&line, &[3.0, 2.0], 1.0);
        assert_eq!(
            found,
            [vec![[0.0, 0.0], [3.0, 0.0]], vec![[4.0, 1.0], [4.0, 4.0]],]
        );
        assert_eq!(strokes(&line, &[], 1.0), [line.to_vec()]);
        assert!(strokes(&[[1.0, 1.0]; 2], &[1.0, 1.0], 1.0).len() < 2);
        assert!(strokes(&[], &[1.0, 1.0], 1.0).is_empty());
    }
}
