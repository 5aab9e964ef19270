//! Scale bars for the top and the bottom edge of a photo: what to draw, not how.

use glam::DVec2;

use crate::numbers::round_down;
use crate::scale::ScaleEstimate;
use crate::units::{LengthUnit, round_length_in_words};

/// A bar is at most this share of the image's width.
const LONGEST_SHARE: f64 = 0.35;

/// How far from its edge a bar is, as a share of the image's height.
const INSET_SHARE: f64 = 0.05;

/// The image edge that a bar belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BarEdge {
    /// The top edge.
    Top,
    /// The bottom edge.
    Bottom,
}

impl BarEdge {
    /// In capitals, for labels.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Top => "TOP",
            Self::Bottom => "BOTTOM",
        }
    }
}

/// A horizontal bar of a round length.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaleBar {
    /// Where it belongs.
    pub edge: BarEdge,
    /// Pixels per unit along that edge.
    pub scale: f64,
    /// 1, 2 or 5 times a power of ten.
    pub length_in_unit: f64,
    /// The same in pixels of the image.
    pub length_px: f64,
    /// Its left end, pixels of the image.
    pub from: DVec2,
    /// Its right end, pixels of the image.
    pub to: DVec2,
    /// Length and scale, such as "50 cm · 25.63 px/cm".
    pub text: String,
}

/// The bars of a photo's scale in an image of `width` x `height` pixels, the camera's size: centred
/// at the top and the bottom edge, each at the scale of its edge. An edge without a scale has no
/// bar. `pair` is the scale at the top and at the bottom, pixels per `unit`.
pub fn scale_bars(
    pair: [Option<ScaleEstimate>; 2],
    width: u32,
    height: u32,
    unit: LengthUnit,
) -> Vec<ScaleBar> {
    let (width, height) = (f64::from(width), f64::from(height));
    let inset = INSET_SHARE * height;
    let [top, bottom] = pair;
    let edges = [
        (BarEdge::Top, top, inset),
        (BarEdge::Bottom, bottom, height - inset),
    ];
    let bar = |(edge, estimate, y): (BarEdge, Option<ScaleEstimate>, f64)| {
        let estimate = estimate?;
        let scale = estimate.value;
        let length = round_down(LONGEST_SHARE * width / scale)?;
        let length_px = length * scale;
        let middle = DVec2::new(width / 2.0, y);
        let half = DVec2::new(length_px / 2.0, 0.0);
        Some(ScaleBar {
            edge,
            scale,
            length_in_unit: length,
            length_px,
            from: middle - half,
            to: middle + half,
            text: format!(
                "{} · {} px/{unit}",
                round_length_in_words(length, unit),
                estimate.text(4)
            ),
        })
    };
    edges.into_iter().filter_map(bar).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::Interval;

    fn pair(top: Option<f64>, bottom: Option<f64>) -> [Option<ScaleEstimate>; 2] {
        [top, bottom].map(|value| {
            let interval = None;
            Some(ScaleEstimate {
                value: value?,
                interval,
            })
        })
    }

    /// 2560 px/m are 25.6 px/cm; of 1000 px 350 may be bar, 13.67 cm, so 10 cm, 256 px.
    #[test]
    fn a_known_bar() {
        let cm = LengthUnit::Centimetre;
        let bars = scale_bars(pair(Some(25.6), Some(51.2)), 1000, 800, cm);
        let [top, bottom] = &bars[..] else {
            panic!("{bars:?}");
        };
        assert_eq!((top.edge, top.length_in_unit), (BarEdge::Top, 10.0));
        assert!((top.length_px - 256.0).abs() < 1e-9);
        assert!(
            (top.from - DVec2::new(372.0, 40.0)).length() < 1e-9,
            "{}",
            top.from
        );
        assert!((top.to - DVec2::new(628.0, 40.0)).length() < 1e-9);
        assert_eq!(top.text, "10 cm · 25.60 px/cm");
        assert_eq!((bottom.edge, bottom.length_in_unit), (BarEdge::Bottom, 5.0));
        assert_eq!(bottom.from.y, 760.0);
        // The same lengths for an engineer with feet: 2560 px/m are 780.288 px/ft exactly.
        let bars = scale_bars(pair(Some(780.288), None), 1000, 800, LengthUnit::Foot);
        assert_eq!(bars.len(), 1);
        assert_eq!(bars[0].text, "0.2 ft · 780.3 px/ft");
        assert!((bars[0].length_px - 156.0576).abs() < 1e-9);
        let sure = ScaleEstimate {
            value: 25.6,
            interval: Some(Interval {
                standard_error: 0.2,
                low: 25.2,
                high: 26.0,
            }),
        };
        let bars = scale_bars([None, Some(sure)], 1000, 800, cm);
        assert_eq!(bars[0].text, "10 cm · 25.6 ± 0.4 px/cm");
    }
}
