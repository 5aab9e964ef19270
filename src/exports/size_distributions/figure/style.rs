//! How a curve looks: never by its colour alone.

use crate::drawing::{Dash, Marker};

/// Colour, marker and dash of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FigureStyle {
    /// sRGB, on white.
    pub colour: [u8; 3],
    /// Of its points.
    pub marker: Marker,
    /// Of its line.
    pub dash: Dash,
}

/// Okabe and Ito, "Color Universal Design" (2008), without the yellow, which is too light on white,
/// and with the black for the reference; neighbours differ in lightness too, for a grey print.
const COLOURS: [[u8; 3]; 7] = [
    [0, 0, 0],
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [86, 180, 233],
    [230, 159, 0],
];

const MARKERS: [Marker; 6] = [
    Marker::Circle,
    Marker::Square,
    Marker::Triangle,
    Marker::Diamond,
    Marker::TriangleDown,
    Marker::Cross,
];

const DASHES: [Dash; 4] = [Dash::Solid, Dash::Long, Dash::Short, Dash::DashDot];

impl FigureStyle {
    /// The style of the reference: black, which a window on a dark ground shows in its text's colour.
    pub const REFERENCE: Self = Self {
        colour: COLOURS[0],
        marker: MARKERS[0],
        dash: DASHES[0],
    };

    /// The style of the series with this number; 0 is the reference. The first 84 are all different.
    pub fn of(number: usize) -> Self {
        // The three come round together after 84, the least common multiple of 7, 6 and 4.
        let of = |count: usize| number % count;
        Self {
            colour: COLOURS.get(of(COLOURS.len())).copied().unwrap_or([0; 3]),
            marker: MARKERS
                .get(of(MARKERS.len()))
                .copied()
                .unwrap_or(Marker::Circle),
            dash: DASHES.get(of(DASHES.len())).copied().unwrap_or(Dash::Solid),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_look_alike() {
        let styles: Vec<FigureStyle> = (0..84).map(FigureStyle::of).collect();
        for (index, style) in styles.iter().enumerate() {
            assert!(!styles[..index].contains(style), "{index}");
        }
        assert_eq!(FigureStyle::of(0), FigureStyle::REFERENCE);
        let white = |c: [u8; 3]| {
            // Relative luminance and contrast on white (WCAG 2.1).
            let linear = |v: u8| {
                let v = f64::from(v) / 255.0;
                if v <= 0.04045 {
                    v / 12.92
                } else {
                    ((v + 0.055) / 1.055).powf(2.4)
                }
            };
            1.05 / (0.2126 * linear(c[0]) + 0.7152 * linear(c[1]) + 0.0722 * linear(c[2]) + 0.05)
        };
        for colour in COLOURS {
            assert!(
                white(colour) > 2.0,
                "{colour:?} on white: {}",
                white(colour)
            );
        }
    }
}
