//! What figures and maps are drawn with: lines, areas, words and pictures, in units of the figure, x to the
//! right and y down; `svg`, `png` and `pdf` write them.

use std::sync::Arc;

use image::RgbaImage;

use super::strokes::{Dash, Marker};

/// sRGB.
pub(crate) type Colour = [u8; 3];

/// Which end of a text is meant; always at half the height of its capitals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Anchor {
    Left,
    Middle,
    Right,
}

/// One of them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Shape {
    /// From point to point.
    Line {
        points: Vec<[f64; 2]>,
        colour: Colour,
        width: f64,
        dash: Dash,
    },
    /// A filled outline; `opacity` is 0 to 1.
    Area {
        outline: Vec<[f64; 2]>,
        colour: Colour,
        opacity: f64,
    },
    /// A line of text; `size` is the height of a line. `upwards` it reads from below.
    Text {
        at: [f64; 2],
        size: f64,
        text: String,
        anchor: Anchor,
        upwards: bool,
        colour: Colour,
    },
    /// Pixels over a rectangle, stretched to it; `at` is its left upper corner.
    Picture {
        at: [f64; 2],
        size: [f64; 2],
        pixels: Arc<RgbaImage>,
    },
}

/// Collects shapes, the first at the back.
#[derive(Debug, Default)]
pub(crate) struct Pen {
    pub(crate) shapes: Vec<Shape>,
}

impl Pen {
    pub(crate) fn line(&mut self, points: &[[f64; 2]], colour: Colour, width: f64, dash: Dash) {
        if points.len() > 1 {
            self.shapes.push(Shape::Line {
                points: points.to_vec(),
                colour,
                width,
                dash,
            });
        }
    }

    /// A filled outline. `opacity` is 0 to 1.
    pub(crate) fn area(&mut self, outline: &[[f64; 2]], colour: Colour, opacity: f64) {
        if outline.len() > 2 {
            self.shapes.push(Shape::Area {
                outline: outline.to_vec(),
                colour,
                opacity,
            });
        }
    }

    /// A marker with a white rim, `radius` being half a circle's width.
    pub(crate) fn marker(&mut self, at: [f64; 2], marker: Marker, radius: f64, colour: Colour) {
        let white = [255; 3];
        if marker == Marker::Cross {
            for (width, colour) in [(4.4, white), (2.2, colour)] {
                let r = 0.9 * radius + 0.3 * (width - 2.2);
                for end in [[r, r], [r, -r]] {
                    let points = [
                        [at[0] - end[0], at[1] - end[1]],
                        [at[0] + end[0], at[1] + end[1]],
                    ];
                    self.line(&points, colour, width, Dash::Solid);
                }
            }
            return;
        }
        for (radius, colour) in [(radius + 1.2, white), (radius, colour)] {
            self.area(&outline(at, marker, radius), colour, 1.0);
        }
    }

    /// A line of text.
    pub(crate) fn text(
        &mut self,
        at: [f64; 2],
        size: f64,
        text: &str,
        anchor: Anchor,
        colour: Colour,
    ) {
        self.shapes.push(Shape::Text {
            at,
            size,
            text: text.to_owned(),
            anchor,
            upwards: false,
            colour,
        });
    }

    /// A line of text that reads upwards, its middle at a point.
    pub(crate) fn text_upwards(&mut self, at: [f64; 2], size: f64, text: &str, colour: Colour) {
        self.shapes.push(Shape::Text {
            at,
            size,
            text: text.to_owned(),
            anchor: Anchor::Middle,
            upwards: true,
            colour,
        });
    }
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
