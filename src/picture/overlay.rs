//! The paper's figure of a photo's scale: bars of a round length at its top and bottom edge, and
//! marks that say what each corner's ray met.

use image::buffer::ConvertBuffer;
use image::{RgbImage, RgbaImage};

use super::canvas::{Canvas, Color, Halo};
use super::scale_bar::{BarEdge, scale_bars};
use super::text::{Anchor, Typeface, text_width};
use crate::scale::{Corner, CornerName, CornerOutcome, PhotoScale, ScaleEstimate};
use crate::units::LengthUnit;

const BAR: Color = [255, 255, 255, 255];
const SHADE: Color = [0, 0, 0, 200];
/// Told apart by shape, and by brightness for those who see no red and green.
const ON_SURFACE: Color = [64, 200, 110, 255];
const ON_GROUND: Color = [255, 176, 32, 255];
const NO_POINT: Color = [240, 60, 60, 255];

/// The photo with its scale drawn on it. `photo` shows the image that the scale is for (undistorted
/// or as shot), at the camera's size or reduced; bars and texts are sized for the picture as it is.
///
/// `pair` is the scale at the top and at the bottom, pixels per `unit`; the corners are those of `scale`.
pub fn overlay(
    photo: &RgbImage,
    scale: &PhotoScale,
    pair: [Option<ScaleEstimate>; 2],
    unit: LengthUnit,
) -> RgbImage {
    let mut picture: RgbaImage = photo.convert();
    let (width, height) = photo.dimensions();
    let longest = width.max(height) as f32;
    let pen = Pen {
        size: [width as f32, height as f32],
        // Small pictures get comparatively large letters.
        letters: (longest * 0.026).max(18.0),
        stroke: (longest * 0.0035).max(1.5),
    };
    let mut canvas = Canvas::new(&mut picture);
    canvas.set_halo(Some(Halo {
        color: SHADE,
        width: pen.stroke * 0.8,
    }));
    // The same share of the picture whatever its size, so the picture's own size will do once the
    // scale is in its pixels.
    let camera_width = scale.corners[2].pixel.x;
    let shrunk = if camera_width > 0.0 {
        f64::from(width) / camera_width
    } else {
        1.0
    };
    let camera_size = |side: u32| (f64::from(side) / shrunk).round() as u32;
    let bars = scale_bars(pair, camera_size(width), camera_size(height), unit);
    for edge in [BarEdge::Top, BarEdge::Bottom] {
        match bars.iter().find(|bar| bar.edge == edge) {
            Some(bar) => {
                let place = |p: glam::DVec2| [(p.x * shrunk) as f32, (p.y * shrunk) as f32];
                pen.bar(&mut canvas, edge, place(bar.from), place(bar.to), &bar.text);
            }
            None => pen.no_bar(&mut canvas, edge),
        }
    }
    for corner in &scale.corners {
        pen.corner(&mut canvas, corner);
    }
    drop(canvas);
    picture.convert()
}

/// Sizes in pixels of the picture.
struct Pen {
    size: [f32; 2],
    letters: f32,
    stroke: f32,
}

impl Pen {
    fn bar(
        &self,
        canvas: &mut Canvas<'_>,
        edge: BarEdge,
        from: [f32; 2],
        to: [f32; 2],
        text: &str,
    ) {
        let tick = self.letters * 0.45;
        let ends = [from, to].map(|[x, y]| [[x, y - tick], [x, y + tick]]);
        // One path, so that no halo cuts into a neighbour.
        let path = [ends[0][0], ends[0][1], from, to, ends[1][0], ends[1][1]];
        canvas.polyline(&path, self.stroke, BAR);
        let text = format!("{}  {text}", edge.as_str());
        self.label(
            canvas,
            edge,
            (from[0] + to[0]) / 2.0,
            from[1],
            tick,
            &text,
            BAR,
        );
    }

    fn no_bar(&self, canvas: &mut Canvas<'_>, edge: BarEdge) {
        let inset = self.size[1] * 0.05;
        let y = match edge {
            BarEdge::Top => inset,
            BarEdge::Bottom => self.size[1] - inset,
        };
        let text = format!("{}  no scale", edge.as_str());
        self.label(canvas, edge, self.size[0] / 2.0, y, 0.0, &text, NO_POINT);
    }

    /// On the inner side of a bar.
    #[allow(
        clippy::too_many_arguments,
        reason = "one call a text, all of them different"
    )]
    fn label(
        &self,
        canvas: &mut Canvas<'_>,
        edge: BarEdge,
        x: f32,
        y: f32,
        tick: f32,
        text: &str,
        color: Color,
    ) {
        // Narrow pictures get smaller letters rather than a cut text.
        let fit =
            self.size[0] * 0.96 / text_width(Typeface::default(), self.letters, text).max(1.0);
        let letters = self.letters * fit.min(1.0);
        let gap = tick + self.letters * 0.5;
        let (y, anchor) = match edge {
            BarEdge::Top => (y + gap, Anchor::TopMiddle),
            BarEdge::Bottom => (y - gap, Anchor::BottomMiddle),
        };
        canvas.text([x, y], letters, color, text, anchor);
    }

    /// A disc for a corner on the surface, a triangle for one on the ground, a cross for none.
    fn corner(&self, canvas: &mut Canvas<'_>, corner: &Corner) {
        let radius = self.letters * 0.5;
        let inset = radius * 2.0;
        let [width, height] = self.size;
        let (left, top) = match corner.name {
            CornerName::TopLeft => (true, true),
            CornerName::TopRight => (false, true),
            CornerName::BottomRight => (false, false),
            CornerName::BottomLeft => (true, false),
        };
        let x = if left { inset } else { width - inset };
        let y = if top { inset } else { height - inset };
        let (color, word) = match corner.outcome {
            CornerOutcome::OnSurface { .. } => {
                canvas.disc([x, y], radius, ON_SURFACE);
                return;
            }
            CornerOutcome::OnGround { .. } => {
                let foot = radius * 0.9;
                canvas.polygon(
                    &[
                        [x, y - radius],
                        [x + radius, y + foot],
                        [x - radius, y + foot],
                    ],
                    ON_GROUND,
                );
                (ON_GROUND, "ground")
            }
            CornerOutcome::Nowhere | CornerOutcome::NoRay(_) => {
                let r = radius * 0.8;
                for sign in [-1.0, 1.0] {
                    let ends = [[x - r, y - sign * r], [x + r, y + sign * r]];
                    canvas.line(ends[0], ends[1], self.stroke * 1.5, NO_POINT);
                }
                (NO_POINT, "no point")
            }
        };
        let gap = radius * 1.6;
        let (x, anchor) = if left {
            (x + gap, Anchor::MiddleLeft)
        } else {
            (x - gap, Anchor::MiddleRight)
        };
        canvas.text([x, y], self.letters * 0.8, color, word, anchor);
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};
    use image::Rgb;

    use super::*;
    use crate::scale::EdgeScales;

    fn scale() -> PhotoScale {
        let point = DVec3::ZERO;
        let distance = 1.0;
        let on_surface = CornerOutcome::OnSurface {
            distance,
            point,
            longest_edge: 0.1,
        };
        let outcomes = [
            on_surface,
            CornerOutcome::OnGround { distance, point },
            CornerOutcome::Nowhere,
            on_surface,
        ];
        let pixels = [(0.0, 0.0), (1000.0, 0.0), (1000.0, 700.0), (0.0, 700.0)];
        PhotoScale {
            corners: std::array::from_fn(|index| Corner {
                name: CornerName::ALL[index],
                pixel: DVec2::from(pixels[index]),
                direction: Some(DVec3::NEG_Z),
                outcome: outcomes[index],
            }),
            // What the corners say has no part in the bars.
            scale: EdgeScales {
                top: Some(1234.0),
                ..EdgeScales::default()
            },
            ground: Some(0.0),
        }
    }

    fn pair() -> [Option<ScaleEstimate>; 2] {
        let top = ScaleEstimate {
            value: 25.6,
            interval: None,
        };
        [Some(top), None]
    }

    fn whitest(picture: &RgbImage, row: u32) -> (u32, u32) {
        let is_white = |x: &u32| picture.get_pixel(*x, row).0.iter().all(|c| *c > 240);
        let mut white = (0..picture.width()).filter(is_white);
        let first = white.next().unwrap();
        (first, white.next_back().unwrap())
    }

    /// The bar of 10 cm at 25.6 px/cm is 256 px long, and 128 px in a picture of half the size.
    #[test]
    fn the_bar_is_as_long_as_it_says() {
        for (width, height, length) in [(1000, 700, 256.0), (500, 350, 128.0)] {
            let grey = RgbImage::from_pixel(width, height, Rgb([90; 3]));
            let picture = overlay(&grey, &scale(), pair(), LengthUnit::Centimetre);
            let (left, right) = whitest(&picture, height / 20);
            let long = f64::from(right - left + 1);
            // The end ticks add half a stroke on each side.
            assert!((length - 1.0..length + 6.0).contains(&long), "{long}");
            assert!((f64::from(left + right + 1) / 2.0 - f64::from(width) / 2.0).abs() <= 1.0);
        }
    }

    #[test]
    fn corners_say_what_they_met() {
        let grey = RgbImage::from_pixel(1000, 700, Rgb([90; 3]));
        let picture = overlay(&grey, &scale(), pair(), LengthUnit::Centimetre);
        let at = |x, y| {
            let [r, g, b] = picture.get_pixel(x, y).0;
            [r, g, b, 255]
        };
        assert_eq!(at(26, 26), ON_SURFACE);
        assert_eq!(at(974, 28), ON_GROUND);
        assert_eq!(at(974, 674), NO_POINT);
        assert_eq!(at(26, 674), ON_SURFACE);
        // The bottom has no scale, and says so in red.
        let red = (400..600).any(|x| at(x, 650) == NO_POINT);
        assert!(red);
    }
}
