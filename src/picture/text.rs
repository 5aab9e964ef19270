//! Letters as outlines, in the fonts that the window uses.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, OutlineCurve, Point};
use tiny_skia::{Path, PathBuilder};

/// A font that this program brings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Typeface {
    /// Hack: letters and digits of one width, for words on photos.
    #[default]
    FixedWidth,
    /// Ubuntu Light, for figures.
    Proportional,
}

/// `None` only if a font that we are built with were broken.
type Loaded = LazyLock<Option<FontRef<'static>>>;

static FIXED_WIDTH: Loaded =
    LazyLock::new(|| FontRef::try_from_slice(epaint_default_fonts::HACK_REGULAR).ok());
static PROPORTIONAL: Loaded =
    LazyLock::new(|| FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok());

impl Typeface {
    fn font(self) -> Option<&'static FontRef<'static>> {
        match self {
            Self::FixedWidth => FIXED_WIDTH.as_ref(),
            Self::Proportional => PROPORTIONAL.as_ref(),
        }
    }
}

/// Which place of a text is meant: across its width, and from the top of its capitals to the line
/// that it stands on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Left, at the top of the capitals.
    TopLeft,
    /// Middle of the width, at the top of the capitals.
    TopMiddle,
    /// Right, at the top of the capitals.
    TopRight,
    /// Left, at half the height of the capitals.
    MiddleLeft,
    /// The middle of both.
    Middle,
    /// Right, at half the height of the capitals.
    MiddleRight,
    /// Left, on the base line.
    BottomLeft,
    /// Middle of the width, on the base line.
    BottomMiddle,
    /// Right, on the base line.
    BottomRight,
}

impl Anchor {
    /// Shares of the width from the left and of the height from the top.
    fn shares(self) -> (f32, f32) {
        match self {
            Self::TopLeft => (0.0, 0.0),
            Self::TopMiddle => (0.5, 0.0),
            Self::TopRight => (1.0, 0.0),
            Self::MiddleLeft => (0.0, 0.5),
            Self::Middle => (0.5, 0.5),
            Self::MiddleRight => (1.0, 0.5),
            Self::BottomLeft => (0.0, 1.0),
            Self::BottomMiddle => (0.5, 1.0),
            Self::BottomRight => (1.0, 1.0),
        }
    }
}

/// The outlines of one line of text; `None` where there is nothing to draw. Characters that the font
/// does not have become a question mark.
pub(super) fn text_path(
    typeface: Typeface,
    at: [f32; 2],
    size: f32,
    text: &str,
    anchor: Anchor,
) -> Option<Path> {
    let font = typeface.font()?;
    let scale = size / font.units_per_em()?;
    if !scale.is_finite() || scale <= 0.0 {
        return None;
    }
    let (left, down) = anchor.shares();
    let mut pen = at[0] - left * text_width(typeface, size, text);
    let base = at[1] + (1.0 - down) * capital_height(font) * scale;
    let mut path = PathBuilder::new();
    for glyph in glyphs(font, text) {
        let place = |p: Point| (pen + p.x * scale, base - p.y * scale);
        let curves = font.outline(glyph).map(|outline| outline.curves);
        let mut end = None;
        for curve in curves.into_iter().flatten() {
            let (start, next) = match curve {
                OutlineCurve::Line(start, next)
                | OutlineCurve::Quad(start, _, next)
                | OutlineCurve::Cubic(start, _, _, next) => (start, next),
            };
            if end != Some(start) {
                let (x, y) = place(start);
                path.close();
                path.move_to(x, y);
            }
            end = Some(next);
            let (x, y) = place(next);
            match curve {
                OutlineCurve::Line(..) => path.line_to(x, y),
                OutlineCurve::Quad(_, a, _) => path.quad_to(place(a).0, place(a).1, x, y),
                OutlineCurve::Cubic(_, a, b, _) => {
                    path.cubic_to(place(a).0, place(a).1, place(b).0, place(b).1, x, y);
                }
            }
        }
        path.close();
        pen += font.h_advance_unscaled(glyph) * scale;
    }
    path.finish()
}

/// The width of a line of text in pixels, `size` pixels an em.
pub fn text_width(typeface: Typeface, size: f32, text: &str) -> f32 {
    let Some((font, units)) = typeface.font().and_then(|f| Some((f, f.units_per_em()?))) else {
        return 0.0;
    };
    let advances = glyphs(font, text).map(|glyph| font.h_advance_unscaled(glyph));
    advances.sum::<f32>() * size / units
}

fn glyphs(font: &FontRef<'_>, text: &str) -> impl Iterator<Item = ab_glyph::GlyphId> {
    text.chars().map(|c| match font.glyph_id(c) {
        ab_glyph::GlyphId(0) => font.glyph_id('?'),
        known => known,
    })
}

fn capital_height(font: &FontRef<'_>) -> f32 {
    let outline = font.outline(font.glyph_id('H'));
    outline.map_or(0.0, |outline| {
        outline.bounds.max.y.abs().max(outline.bounds.min.y.abs())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn anchors_place_the_capitals() {
        let bounds = |anchor| {
            text_path(Typeface::FixedWidth, [100.0, 50.0], 20.0, "HH", anchor)
                .unwrap()
                .bounds()
        };
        assert!((bounds(Anchor::BottomLeft).bottom() - 50.0).abs() < 0.01);
        assert!((bounds(Anchor::TopLeft).top() - 50.0).abs() < 0.01);
        let middle = bounds(Anchor::Middle);
        assert!((middle.top() + middle.bottom() - 100.0).abs() < 0.01);
        assert!((middle.left() + middle.right() - 200.0).abs() < 0.1);
        assert!(bounds(Anchor::TopRight).right() < 100.0);
        // Hack's capitals are 1493 of 2048 units high, its letters 1233 wide (its OS/2 and hmtx).
        assert!(
            (middle.height() - 20.0 * 1493.0 / 2048.0).abs() < 0.1,
            "{}",
            middle.height()
        );
        assert!(
            (text_width(Typeface::FixedWidth, 20.0, "HH") - 2.0 * 20.0 * 1233.0 / 2048.0).abs()
                < 0.1
        );
    }

    #[test]
    fn every_sign_that_we_write_is_in_the_font() {
        let font = Typeface::FixedWidth.font().unwrap();
        for c in "TOP BOTTOM 0123456789 cm·px/°×µ—′"
            .chars()
            .filter(|c| *c != ' ')
        {
            assert_ne!(font.glyph_id(c).0, 0, "{c}");
        }
        assert!(
            text_path(
                Typeface::FixedWidth,
                [0.0, 0.0],
                10.0,
                "岩",
                Anchor::TopLeft
            )
            .is_some()
        );
        assert!(
            text_path(
                Typeface::FixedWidth,
                [0.0, 0.0],
                10.0,
                "  ",
                Anchor::TopLeft
            )
            .is_none()
        );
    }
}
