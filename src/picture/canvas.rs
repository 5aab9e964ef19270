//! Drawing on pictures: antialiased strokes, filled shapes and text.

use image::RgbaImage;
use tiny_skia::{
    FillRule, FilterQuality, LineCap, LineJoin, Paint, Path, PathBuilder, PixmapMut, PixmapPaint,
    PixmapRef, Rect, Stroke, StrokeDash, Transform,
};

use super::text::{Anchor, Typeface, text_path};

/// Red, green, blue, opacity.
pub type Color = [u8; 4];

/// A contrasting border around strokes, shapes and letters, so that they read on any photo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Halo {
    /// Its colour.
    pub color: Color,
    /// How far it reaches beyond the stroke, in pixels.
    pub width: f32,
}

/// Draws on a picture. Places are continuous pixels, (0, 0) at the outer corner of the top left
/// pixel; what lies outside is cut off, and numbers that are not finite draw nothing.
///
/// The picture's own, not premultiplied, alpha is taken on [`Canvas::new`] and restored when the
/// canvas is dropped.
pub struct Canvas<'a> {
    /// Premultiplied while the canvas lives.
    image: &'a mut RgbaImage,
    halo: Option<Halo>,
    typeface: Typeface,
}

impl<'a> Canvas<'a> {
    /// A canvas on `image`, without a halo, for letters of one width.
    pub fn new(image: &'a mut RgbaImage) -> Self {
        for pixel in image.pixels_mut() {
            let [r, g, b, a] = pixel.0;
            if a != u8::MAX {
                pixel.0 = [times(r, a), times(g, a), times(b, a), a];
            }
        }
        Self {
            image,
            halo: None,
            typeface: Typeface::default(),
        }
    }

    /// What is drawn from now on gets this halo.
    pub fn set_halo(&mut self, halo: Option<Halo>) {
        self.halo = halo;
    }

    /// Words from now on are in this font.
    pub fn set_typeface(&mut self, typeface: Typeface) {
        self.typeface = typeface;
    }

    /// A straight stroke with round ends.
    pub fn line(&mut self, from: [f32; 2], to: [f32; 2], width: f32, color: Color) {
        self.polyline(&[from, to], width, color);
    }

    /// Strokes from point to point.
    pub fn polyline(&mut self, points: &[[f32; 2]], width: f32, color: Color) {
        if let Some(path) = path_through(points, false) {
            self.stroke(&path, width, color, None);
        }
    }

    /// Strokes from point to point and back to the first.
    pub fn outline(&mut self, points: &[[f32; 2]], width: f32, color: Color) {
        if let Some(path) = path_through(points, true) {
            self.stroke(&path, width, color, None);
        }
    }

    /// Strokes from point to point, interrupted: `pattern` is the lengths of stroke and gap in turn,
    /// pixels, an even number of them.
    pub fn dashed(&mut self, points: &[[f32; 2]], width: f32, pattern: &[f32], color: Color) {
        if let Some(path) = path_through(points, false) {
            let dash = StrokeDash::new(pattern.to_vec(), 0.0);
            self.stroke(&path, width, color, dash);
        }
    }

    /// A filled circle.
    pub fn disc(&mut self, middle: [f32; 2], radius: f32, color: Color) {
        if let Some(path) = PathBuilder::from_circle(middle[0], middle[1], radius) {
            self.fill(&path, color);
        }
    }

    /// A filled rectangle between two opposite corners.
    pub fn rect(&mut self, from: [f32; 2], to: [f32; 2], color: Color) {
        let (left, right) = (from[0].min(to[0]), from[0].max(to[0]));
        let (top, bottom) = (from[1].min(to[1]), from[1].max(to[1]));
        if let Some(rect) = Rect::from_ltrb(left, top, right, bottom) {
            self.fill(&PathBuilder::from_rect(rect), color);
        }
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: &[[f32; 2]], color: Color) {
        if let Some(path) = path_through(points, true) {
            self.fill(&path, color);
        }
    }

    /// One line of text, `size` pixels an em; `at` is the place of its `anchor`.
    pub fn text(&mut self, at: [f32; 2], size: f32, color: Color, text: &str, anchor: Anchor) {
        if let Some(path) = text_path(self.typeface, at, size, text, anchor) {
            self.fill(&path, color);
        }
    }

    /// The same, reading upwards: turned about `at`.
    pub fn text_upwards(
        &mut self,
        at: [f32; 2],
        size: f32,
        color: Color,
        text: &str,
        anchor: Anchor,
    ) {
        let turn = Transform::from_rotate_at(-90.0, at[0], at[1]);
        let path = text_path(self.typeface, at, size, text, anchor);
        if let Some(path) = path.and_then(|path| path.transform(turn)) {
            self.fill(&path, color);
        }
    }

    /// Another picture over a rectangle, stretched to it between its pixels; `at` is the rectangle's left
    /// upper corner. One that is much larger than the rectangle has to be reduced first.
    pub fn picture(&mut self, at: [f32; 2], size: [f32; 2], picture: &RgbaImage) {
        let mut premultiplied = picture.clone();
        for pixel in premultiplied.pixels_mut() {
            let [r, g, b, a] = pixel.0;
            pixel.0 = [times(r, a), times(g, a), times(b, a), a];
        }
        let (width, height) = picture.dimensions();
        let Some(source) = PixmapRef::from_bytes(&premultiplied, width, height) else {
            return;
        };
        let scale = [size[0] / width as f32, size[1] / height as f32];
        let place = Transform::from_row(scale[0], 0.0, 0.0, scale[1], at[0], at[1]);
        let is_exact = scale == [1.0, 1.0] && at.iter().all(|at| at.fract() == 0.0);
        let paint = PixmapPaint {
            quality: match is_exact {
                true => FilterQuality::Nearest,
                false => FilterQuality::Bilinear,
            },
            ..PixmapPaint::default()
        };
        self.on_pixels(|pixels| pixels.draw_pixmap(0, 0, source, &paint, place, None));
    }

    fn stroke(&mut self, path: &Path, width: f32, color: Color, dash: Option<StrokeDash>) {
        let mut stroke = Stroke {
            width,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            dash,
            ..Stroke::default()
        };
        if stroke.dash.is_some() {
            stroke.line_cap = LineCap::Butt;
        }
        if let Some(halo) = self.halo {
            let wide = Stroke {
                width: width + 2.0 * halo.width,
                ..stroke.clone()
            };
            self.on_pixels(|pixels| {
                pixels.stroke_path(path, &paint(halo.color), &wide, Transform::identity(), None);
            });
        }
        self.on_pixels(|pixels| {
            pixels.stroke_path(path, &paint(color), &stroke, Transform::identity(), None);
        });
    }

    fn fill(&mut self, path: &Path, color: Color) {
        if let Some(halo) = self.halo {
            let border = Stroke {
                width: 2.0 * halo.width,
                line_join: LineJoin::Round,
                ..Stroke::default()
            };
            self.on_pixels(|pixels| {
                pixels.stroke_path(
                    path,
                    &paint(halo.color),
                    &border,
                    Transform::identity(),
                    None,
                );
            });
        }
        self.on_pixels(|pixels| {
            pixels.fill_path(
                path,
                &paint(color),
                FillRule::Winding,
                Transform::identity(),
                None,
            );
        });
    }

    fn on_pixels(&mut self, draw: impl FnOnce(&mut PixmapMut<'_>)) {
        let (width, height) = self.image.dimensions();
        // An image without pixels has no pixmap, and nothing to draw on.
        if let Some(mut pixels) = PixmapMut::from_bytes(self.image, width, height) {
            draw(&mut pixels);
        }
    }
}

impl Drop for Canvas<'_> {
    fn drop(&mut self) {
        for pixel in self.image.pixels_mut() {
            let [r, g, b, a] = pixel.0;
            if a != u8::MAX && a != 0 {
                pixel.0 = [over(r, a), over(g, a), over(b, a), a];
            }
        }
    }
}

/// A colour times an opacity, 0 to 255 standing for 0 to 1.
fn times(color: u8, alpha: u8) -> u8 {
    ((u16::from(color) * u16::from(alpha) + 127) / 255) as u8
}

/// The inverse of [`times`], as far as it has one.
fn over(color: u8, alpha: u8) -> u8 {
    let straight = (u16::from(color) * 255 + u16::from(alpha) / 2) / u16::from(alpha);
    straight.min(255) as u8
}

fn paint(color: Color) -> Paint<'static> {
    let [r, g, b, a] = color;
    let mut paint = Paint {
        anti_alias: true,
        ..Paint::default()
    };
    paint.set_color_rgba8(r, g, b, a);
    paint
}

fn path_through(points: &[[f32; 2]], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    let mut points = points.iter();
    let first = points.next()?;
    path.move_to(first[0], first[1]);
    for point in points {
        path.line_to(point[0], point[1]);
    }
    if closed {
        path.close();
    }
    path.finish()
}

#[cfg(test)]
mod tests {
    use image::Rgba;

    use super::*;

    const WHITE: Color = [255; 4];
    const RED: Color = [255, 0, 0, 255];

    fn black() -> RgbaImage {
        RgbaImage::from_pixel(40, 40, Rgba([0, 0, 0, 255]))
    }

    /// How much of the picture is white, in pixels.
    fn area(image: &RgbaImage) -> f64 {
        image.pixels().map(|p| f64::from(p[1]) / 255.0).sum()
    }

    /// tiny-skia looks at 4 x 4 places in a pixel, so an outline is off by up to an eighth of one.
    #[test]
    fn areas_are_those_of_geometry() {
        let mut image = black();
        Canvas::new(&mut image).disc([20.0, 20.0], 10.0, WHITE);
        assert!(
            (area(&image) - 314.16).abs() < 62.8 / 8.0,
            "{}",
            area(&image)
        );

        let mut image = black();
        Canvas::new(&mut image).rect([30.5, 25.0], [10.25, 15.0], WHITE);
        assert!(
            (area(&image) - 202.5).abs() < 60.5 / 8.0,
            "{}",
            area(&image)
        );

        // A stroke of 4 x 20 and two half discs of radius 2.
        let mut image = black();
        Canvas::new(&mut image).line([10.0, 20.0], [30.0, 20.0], 4.0, WHITE);
        let expected = 80.0 + std::f64::consts::PI * 4.0;
        assert!(
            (area(&image) - expected).abs() < 52.6 / 8.0,
            "{}",
            area(&image)
        );

        // Half of a stroke of 2 x 32.
        let mut image = black();
        Canvas::new(&mut image).dashed(&[[4.0, 20.0], [36.0, 20.0]], 2.0, &[4.0, 4.0], WHITE);
        assert!((area(&image) - 32.0).abs() < 2.0, "{}", area(&image));

        let mut image = black();
        Canvas::new(&mut image).polygon(&[[5.0, 5.0], [35.0, 5.0], [5.0, 25.0]], WHITE);
        assert!(
            (area(&image) - 300.0).abs() < 86.0 / 8.0,
            "{}",
            area(&image)
        );
    }

    #[test]
    fn places_are_continuous_pixels() {
        let mut image = black();
        Canvas::new(&mut image).rect([3.0, 5.0], [4.0, 6.0], RED);
        for (x, y, pixel) in image.enumerate_pixels() {
            let is_inside = (x, y) == (3, 5);
            assert_eq!(pixel.0 == RED, is_inside, "{x}, {y}");
        }
    }

    #[test]
    fn a_halo_surrounds() {
        let mut image = RgbaImage::from_pixel(40, 40, Rgba(WHITE));
        let mut canvas = Canvas::new(&mut image);
        canvas.set_halo(Some(Halo {
            color: [0, 0, 0, 255],
            width: 3.0,
        }));
        canvas.line([5.0, 20.0], [35.0, 20.0], 4.0, RED);
        drop(canvas);
        assert_eq!(image.get_pixel(20, 20).0, RED);
        assert_eq!(image.get_pixel(20, 16).0, [0, 0, 0, 255]);
        assert_eq!(image.get_pixel(20, 10).0, WHITE);
    }

    #[test]
    fn a_transparent_picture_stays_transparent_elsewhere() {
        let mut image = RgbaImage::from_pixel(40, 40, Rgba([200, 100, 50, 128]));
        Canvas::new(&mut image).disc([20.0, 20.0], 5.0, RED);
        assert_eq!(image.get_pixel(20, 20).0, RED);
        let corner = image.get_pixel(0, 0).0;
        assert_eq!(corner[3], 128);
        for (now, before) in corner.into_iter().zip([200, 100, 50, 128]) {
            assert!(now.abs_diff(before) <= 1, "{corner:?}");
        }
        let mut empty = RgbaImage::new(4, 4);
        Canvas::new(&mut empty).line([0.0, 0.0], [4.0, 0.0], 1.0, RED);
        assert_eq!(empty.get_pixel(2, 3).0, [0; 4]);
    }

    /// A picture of 2 x 1 over 8 x 4: in the middle of each half its colour, and nothing beside it.
    #[test]
    fn a_picture_is_stretched_over_its_rectangle() {
        let mut image = black();
        let mut two = RgbaImage::from_pixel(2, 1, Rgba(WHITE));
        two.put_pixel(1, 0, Rgba(RED));
        Canvas::new(&mut image).picture([10.0, 20.0], [8.0, 4.0], &two);
        assert_eq!(image.get_pixel(10, 22).0, WHITE);
        assert_eq!(image.get_pixel(17, 22).0, RED);
        for beside in [(9, 22), (18, 22), (14, 19), (14, 24)] {
            assert_eq!(image.get_pixel(beside.0, beside.1).0, [0, 0, 0, 255]);
        }
        let mut same = black();
        Canvas::new(&mut same).picture([3.0, 5.0], [2.0, 1.0], &two);
        assert_eq!(same.get_pixel(3, 5).0, WHITE);
        assert_eq!(same.get_pixel(4, 5).0, RED);
        assert!((area(&same) - 1.0).abs() < 1e-9);
    }

    /// The picture of words that read upwards, turned by a quarter to the right, is that of the words.
    #[test]
    fn words_read_upwards() {
        let mut across = black();
        let mut canvas = Canvas::new(&mut across);
        canvas.set_typeface(Typeface::Proportional);
        canvas.text([20.0, 20.0], 16.0, WHITE, "Fig", Anchor::Middle);
        drop(canvas);
        let mut upwards = black();
        let mut canvas = Canvas::new(&mut upwards);
        canvas.set_typeface(Typeface::Proportional);
        canvas.text_upwards([20.0, 20.0], 16.0, WHITE, "Fig", Anchor::Middle);
        drop(canvas);
        assert!(area(&across) > 20.0);
        let turned = image::imageops::rotate90(&upwards);
        // The rasteriser knows four rows in a pixel, and many columns: an edge along them is good to a
        // quarter, all edges together to much less.
        for (a, b) in across.pixels().zip(turned.pixels()) {
            assert!(a[1].abs_diff(b[1]) < 64, "{a:?} {b:?}");
        }
        let (a, b) = (area(&across), area(&turned));
        assert!((a - b).abs() < 0.02 * a, "{a} {b}");
    }

    #[test]
    fn nonsense_draws_nothing() {
        let mut image = black();
        let mut canvas = Canvas::new(&mut image);
        canvas.line([f32::NAN, 0.0], [10.0, f32::INFINITY], 2.0, WHITE);
        canvas.disc([20.0, 20.0], -1.0, WHITE);
        canvas.rect([f32::NAN, 0.0], [5.0, 5.0], WHITE);
        canvas.polyline(&[], 2.0, WHITE);
        canvas.text([20.0, 20.0], f32::NAN, WHITE, "x", Anchor::Middle);
        canvas.line([-1e9, 500.0], [1e9, 600.0], 2.0, WHITE);
        drop(canvas);
        assert_eq!(area(&image), 0.0);
        Canvas::new(&mut RgbaImage::new(0, 0)).disc([0.0, 0.0], 5.0, WHITE);
    }
}
