//! The words on a picture, as data: the window writes them with its own font, files with another.

use glam::DVec2;

use crate::picture::Anchor;

/// A short text on the picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// In viewport pixels.
    pub at: DVec2,
    /// What it says.
    pub text: String,
    /// Which place of it is at `at`.
    pub anchor: Anchor,
    /// Red, green, blue.
    pub color: [u8; 3],
}

/// What the colours of the surface mean: viridis from the first to the second value.
#[derive(Debug, Clone, PartialEq)]
pub struct Legend {
    /// What is coloured, with its unit.
    pub title: String,
    /// The values of the colour map's two ends.
    pub range: [f64; 2],
}

impl Legend {
    /// Three to seven round values within the range, ascending: where they are on the colour map, from 0
    /// to 1, and their text.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let [low, high] = self.range;
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
}

/// The scale bar of a view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScaleBar {
    /// In world units: 1, 2 or 5 times a power of ten.
    pub length: f64,
    /// In viewport pixels.
    pub pixels: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let texts = |range| -> Vec<String> {
            let title = String::new();
            let ticks = Legend { title, range }.ticks();
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
