//! What the bridges of a cloud do to a photo's line.
//!
//! A cloud has no points where fewer than three photos look, and its triangulation bridges that: from the
//! top of one block to the next, over what lies between. So the longer a triangle is than most of its
//! photo, the deeper is what it hides, and the more its pixels' scale is too large. Of simulated piles, whose
//! true surface is known, depths are short by [`HIDDEN`] of what a triangle's longest edge has over
//! [`USUAL`] times the median one's, in the lab, on the muckpile and on benches alike (0.33 to 0.48; flat views
//! over large blocks have most of it: 1.2 % in the mean of a photo's line and 3 % at its near edge). How far
//! lines are off around that was about as much again at both ends as at either: [`SPREAD`].
//!
//! Nothing is deeper than [`MOST`] times what is seen goes up and down (off the photo's plane): a level floor
//! with few points has long triangles, too, and hides nothing.
//!
//! The constants are fitted to 180 photos of five flights of each place (seeds 1000 to 1004); README's coverage is
//! of other piles (`benches/coverage.rs`).

use glam::DVec3;

use super::holes::Line;
use crate::scale::FittedScale;
use crate::scale::field::ScaleField;

/// Edges of so many times the median one are no bridges.
const USUAL: f64 = 2.0;

/// How deep it is under a bridge, over how far its longest edge is longer than that.
const HIDDEN: f64 = 0.43;

/// The standard deviation of the line's ends around that, over its root mean square at both ends.
const SPREAD: f64 = 0.5;

/// The most that is hidden, over the root mean square of what the field's depths are off the photo's plane: from
/// the crests of a wave to its troughs it is 2.8 times that.
const MOST: f64 = 2.8;

/// What bridges do to the ends of a line, shares of its scales there.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Bridged {
    /// By how much top and bottom are too large, in the mean.
    pub(super) too_large: [f64; 2],
    /// The standard deviation around it, of either.
    pub(super) spread: f64,
}

/// Of the line through a field over a cloud, with the photo's plane (`surface_error::plane_of`).
pub(super) fn of_bridges(field: &ScaleField, fitted: &FittedScale, plane: DVec3) -> Bridged {
    let rows = field.grid.rows;
    let places = field.grid.cells();
    let pixels = places.filter_map(|(column, row)| {
        Some(Pixel {
            down: (f64::from(row) + 0.5) / f64::from(rows),
            scale: field.scale_at(column, row)?,
            depth: field.depth_at(column, row)?,
            edge: field.longest_edge_at(column, row)?,
            off_plane: field.depth_at(column, row)? * plane.dot(field.direction_at(column, row)?)
                - 1.0,
        })
    });
    let pixels: Vec<Pixel> = pixels.collect();
    of_pixels(&pixels, [fitted.top, fitted.bottom])
}

/// A pixel with a scale.
#[derive(Debug, Clone, Copy)]
struct Pixel {
    /// From 0 at the photo's top to 1 at its bottom.
    down: f64,
    /// Pixels per world unit.
    scale: f64,
    /// Along the optical axis, world units.
    depth: f64,
    /// The longest one of the triangle that it shows, world units.
    edge: f64,
    /// Its depth over the plane's, less 1.
    off_plane: f64,
}

fn of_pixels(pixels: &[Pixel], line: [f64; 2]) -> Bridged {
    let mut edges: Vec<f64> = pixels.iter().map(|pixel| pixel.edge).collect();
    if edges.is_empty() {
        return Bridged::default();
    }
    let middle = edges.len() / 2;
    let median = *edges.select_nth_unstable_by(middle, f64::total_cmp).1;
    let squares: f64 = pixels.iter().map(|pixel| pixel.off_plane.powi(2)).sum();
    let most = MOST * (squares / pixels.len() as f64).sqrt();
    let mut hidden = Line::default();
    for pixel in pixels {
        let over = (pixel.edge - USUAL * median).max(0.0);
        let share = (HIDDEN * over / pixel.depth).min(most);
        hidden.add(pixel.down, share * pixel.scale);
    }
    let [top, bottom] = hidden.ends();
    let too_large = [top / line[0], bottom / line[1]];
    // Of one row there is no line, and no fitted scale either.
    if !too_large.iter().all(|share| share.is_finite()) {
        return Bridged::default();
    }
    let [top, bottom] = too_large;
    Bridged {
        too_large,
        spread: SPREAD / HIDDEN * ((top * top + bottom * bottom) / 2.0).sqrt(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The least squares line through a step of the height h at 3/5 of the photo, by hand: its slope is
    /// 12 h ∫(v - 1/2) over the step, 1.44 h, its mean 0.4 h.
    #[test]
    fn bridges_over_the_lower_part_tilt_the_line() {
        let rows = 400;
        let pixels: Vec<Pixel> = (0..rows)
            .map(|row| Pixel {
                down: (f64::from(row) + 0.5) / f64::from(rows),
                scale: 50.0,
                depth: 20.0,
                edge: if row < 240 { 1.0 } else { 4.0 },
                off_plane: 1.0,
            })
            .collect();
        let bridged = of_pixels(&pixels, [50.0, 50.0]);
        let height = HIDDEN * (4.0 - USUAL) / 20.0;
        let [top, bottom] = bridged.too_large;
        assert!((top / height + 0.32).abs() < 1e-4, "{top}");
        assert!((bottom / height - 1.12).abs() < 1e-4, "{bottom}");
        let both = ((0.32_f64.powi(2) + 1.12_f64.powi(2)) / 2.0).sqrt();
        // Of a plane nothing is hidden.
        let level: Vec<Pixel> = (pixels.iter())
            .map(|pixel| Pixel {
                off_plane: 0.0,
                ..*pixel
            })
            .collect();
        let smooth = of_pixels(&level, [50.0, 50.0]);
        assert_eq!((smooth.too_large, smooth.spread), ([0.0; 2], 0.0));
        let spread = bridged.spread / (SPREAD * (4.0 - USUAL) / 20.0);
        assert!((spread - both).abs() < 1e-4, "{spread}");
    }

    #[test]
    fn edges_of_a_kind_are_no_bridges() {
        let pixels = [0.1, 0.9].map(|down| Pixel {
            down,
            scale: 50.0,
            depth: 20.0,
            edge: 1.0 + down,
            off_plane: 1.0,
        });
        assert_eq!(of_pixels(&pixels, [50.0, 50.0]).too_large, [0.0; 2]);
        assert_eq!(of_pixels(&[], [50.0, 50.0]), Bridged::default());
    }
}
