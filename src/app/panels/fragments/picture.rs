//! The outlines as pixels of the screen: as much work as the screen is large, however large the photo is.

use egui::{Color32, ColorImage};
use glam::DVec2;

use crate::labels::{FINES, NOT_ROCK, Outlines};

/// Of fragments that a person looked at.
const LOOKED_AT: Color32 = Color32::from_rgb(90, 230, 120);
/// Of the others.
const BY_ENGINE: Color32 = Color32::from_rgb(255, 214, 10);
/// Of those that are rather none.
const DOUBTFUL: Color32 = Color32::from_rgb(255, 120, 40);
/// Of the selected one.
const SELECTED: Color32 = Color32::from_rgb(70, 225, 255);
/// Over the selected one.
const SELECTED_FILL: Color32 = Color32::from_rgba_unmultiplied_const(70, 225, 255, 50);
/// Over what is no rock.
const EXCLUDED: Color32 = Color32::from_rgba_unmultiplied_const(30, 60, 255, 110);

/// Less sure than this is doubtful. An engine's score is what a region shares with a true fragment, in the mean: of half
/// of the right ones it is below 0.5.
const SURE: f64 = 0.35;

/// The outlines between two places of the photo, over so many pixels of the screen.
pub(super) fn picture(
    outlines: &Outlines,
    selected: Option<u32>,
    [from, to]: [DVec2; 2],
    [width, height]: [usize; 2],
) -> ColorImage {
    let labels = outlines.labels();
    let places = |from: f64, to: f64, count: usize, most: usize| -> Vec<usize> {
        // One more at each side, so that the first is half a step before: an outline is where the neighbour is
        // another.
        let at = |step: usize| {
            let place = from + (to - from) * (step as f64 - 0.5) / count as f64;
            (place.max(0.0) as usize).min(most.saturating_sub(1))
        };
        (0..count + 2).map(at).collect()
    };
    let columns = places(from.x, to.x, width, labels.width);
    let rows = places(from.y, to.y, height, labels.height);
    let row_of = |row: usize| -> Vec<u32> {
        let start = rows[row] * labels.width;
        columns
            .iter()
            .map(|column| labels.labels[start + column])
            .collect()
    };
    let mut pixels = vec![Color32::TRANSPARENT; width * height];
    if labels.labels.is_empty() {
        return ColorImage::new([width, height], pixels);
    }
    let color = |label: u32| match outlines.sure(label) {
        _ if selected == Some(label) => SELECTED,
        None => LOOKED_AT,
        Some(sure) if sure < SURE => DOUBTFUL,
        Some(_) => BY_ENGINE,
    };
    let (mut above, mut here) = (row_of(0), row_of(1));
    for y in 0..height {
        let below = row_of(y + 2);
        for x in 0..width {
            let label = here[x + 1];
            let pixel = &mut pixels[y * width + x];
            if label == NOT_ROCK {
                *pixel = EXCLUDED;
            } else if label != FINES {
                let beside = [here[x], here[x + 2], above[x + 1], below[x + 1]];
                if beside.iter().any(|other| *other != label) {
                    *pixel = color(label);
                } else if selected == Some(label) {
                    *pixel = SELECTED_FILL;
                }
            }
        }
        above = here;
        here = below;
    }
    ColorImage::new([width, height], pixels)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::labels::LabelImage;

    /// A square of four in an image of eight, a screen pixel each: twelve pixels of outline, four within.
    #[test]
    fn an_outline_is_where_a_fragment_ends() {
        let label = |place: usize| {
            let inside = (2..6).contains(&(place % 8)) && (2..6).contains(&(place / 8));
            u32::from(inside)
        };
        let labels = LabelImage {
            width: 8,
            height: 8,
            labels: (0..64).map(label).collect(),
        };
        let whole = [DVec2::ZERO, DVec2::splat(8.0)];
        let count = |outlines: &Outlines, selected, color| {
            let drawn = picture(outlines, selected, whole, [8, 8]);
            drawn.pixels.iter().filter(|pixel| **pixel == color).count()
        };
        let sure = Outlines::new(labels.clone(), BTreeMap::from([(1, 0.9)]));
        assert_eq!(count(&sure, None, BY_ENGINE), 12);
        assert_eq!(count(&sure, None, Color32::TRANSPARENT), 52);
        assert_eq!(count(&sure, Some(1), SELECTED_FILL), 4);
        let looked_at = Outlines::new(labels, BTreeMap::new());
        assert_eq!(count(&looked_at, None, LOOKED_AT), 12);
        // Twice as large the outline is as thin: 4 * (8 - 1) of 64.
        let large = picture(&looked_at, None, whole, [16, 16]);
        let drawn = large.pixels.iter().filter(|pixel| **pixel == LOOKED_AT);
        assert_eq!(drawn.count(), 28);
    }
}
