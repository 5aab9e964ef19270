//! How far a photo's edges are spread: by lens, focus, motion and compression together.
//!
//! At a step edge that is spread by a bell of deviation s, smoothing by another of deviation a leaves a greatest slope as
//! 1 / sqrt(s^2 + a^2). So the ratio of the greatest slopes after smoothing by a and by b gives s (Zhuo and Sim, "Defocus map
//! estimation from a single image", Pattern Recognition 44 (2011) 1852-1858):
//!
//! ```text
//! R = slope_a / slope_b,    s^2 = (b^2 - R^2 a^2) / (R^2 - 1) - c
//! ```
//!
//! where c = 1/3 is the variance of the difference between a pixel's two neighbours, which stands for the slope. Three
//! smoothings give s twice. At a thin line, a corner or a slope in the light the two differ, and the edge does not count. Of the
//! strongest tenth of a photo's edges that count the median is taken, so it is what its clear edges show. The spread of the
//! pixel itself (variance 1/12) is in it. Sharpened photos come out as 0.
//!
//! Polygons and photos that were spread by a known bell come out to 0.08 pixels or 6 %, whichever is more, from half a pixel on;
//! those that are sharper, whose edges are a pixel's box and no bell, to 0.12 pixels; spread by 5 pixels, a tenth too small; see the
//! tests.

use image::RgbImage;
use rayon::prelude::*;

use super::brightness;

/// The three smoothings, pixels.
const SMOOTHINGS: [f64; 3] = [1.0, 1.6, 2.4];

/// The variance of a difference over two pixels: a box of that width.
const OF_DIFFERENCE: f64 = 1.0 / 3.0;

/// How far an edge reaches in the widest smoothing, pixels.
const REACH: usize = 10;

/// Both values of an edge's variance may differ by this share of their mean, and by this many square pixels besides.
const AGREE: (f64, f64) = (0.35, 0.3);

/// Edges weaker than this many gray values a pixel are noise.
const WEAKEST: f64 = 2.0;

/// The share of edges that are the strong ones.
const STRONG: f64 = 0.1;

/// So many edges must agree.
const FEWEST: usize = 30;

/// A large photo is looked at in strips of so many rows, of so many pixels together.
const STRIP: usize = 64;
const MOST_PIXELS: usize = 2_000_000;

/// Where edges are spread further, the photo at half its size tells how far.
const FAR: f64 = 1.5;

/// The deviation, in pixels, of the bell that spreads the clear edges of a photo; `None` of a photo without enough of them.
pub fn edge_spread(photo: &RgbImage) -> Option<f64> {
    let gray = photo.pixels().map(|pixel| brightness(pixel.0));
    let gray = Gray {
        values: gray.collect(),
        width: photo.width() as usize,
        height: photo.height() as usize,
    };
    gray.edge_spread()
}

/// The full width at half of the maximum of a bell of that deviation.
pub fn full_width(deviation: f64) -> f64 {
    2.0 * (2.0 * std::f64::consts::LN_2).sqrt() * deviation
}

struct Gray {
    values: Vec<f64>,
    width: usize,
    height: usize,
}

/// An edge: its slope, and its variance by the narrower and by the wider smoothings.
type Edge = (f64, [f64; 2]);

impl Gray {
    /// A smaller photo is asked first: where edges are spread far, noise makes narrow maxima of its own on them.
    fn edge_spread(&self) -> Option<f64> {
        let of_half = self.half().and_then(|half| half.edge_spread());
        // A pixel of the smaller photo is spread over four times the variance of one of the larger.
        let own = of_half.map(|spread| (4.0 * spread * spread - 3.0 / 12.0).max(0.0).sqrt());
        own.filter(|own| *own >= FAR)
            .or_else(|| self.median_spread())
    }

    /// Means of two by two pixels; `None` of what is too small for edges.
    fn half(&self) -> Option<Self> {
        let (width, height) = (self.width / 2, self.height / 2);
        if width < 4 * REACH || height < 4 * REACH {
            return None;
        }
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let mean = |(x, y): (usize, usize)| {
            let first = 2 * y * self.width + 2 * x;
            let second = first + self.width;
            let rows = [first, first + 1, second, second + 1];
            rows.iter().map(|place| self.values[*place]).sum::<f64>() / 4.0
        };
        Some(Self {
            values: places.map(mean).collect(),
            width,
            height,
        })
    }

    fn median_spread(&self) -> Option<f64> {
        if self.width <= 2 * REACH + 2 || self.height <= 2 * REACH + 2 {
            return None;
        }
        let rows = self.height - 2 * REACH;
        let strips = rows.div_ceil(STRIP);
        let wanted = (MOST_PIXELS / (STRIP * self.width)).clamp(1, strips);
        let strips = (0..wanted).into_par_iter().map(|number| {
            let first = REACH + number * strips / wanted * STRIP;
            self.edges(first, (first + STRIP).min(self.height - REACH))
        });
        let mut edges: Vec<Edge> = strips.flatten().collect();
        let strong = (edges.len() as f64 * STRONG) as usize;
        if strong < FEWEST {
            return None;
        }
        edges.select_nth_unstable_by(strong, |a, b| b.0.total_cmp(&a.0));
        let agree = |[near, wide]: [f64; 2]| {
            let (share, besides) = AGREE;
            let mean = (near.abs() + wide.abs()) / 2.0;
            (near - wide).abs() <= share * mean + besides
        };
        let strong = edges.iter().take(strong);
        let mut variances: Vec<f64> = strong
            .filter(|(slope, both)| *slope >= WEAKEST && agree(*both))
            .map(|(_, [near, _])| *near)
            .collect();
        if variances.len() < FEWEST {
            return None;
        }
        let middle = variances.len() / 2;
        let (_, median, _) = variances.select_nth_unstable_by(middle, f64::total_cmp);
        Some(median.max(0.0).sqrt())
    }

    /// The edges of some rows: where the slope is greatest across itself.
    fn edges(&self, first: usize, last: usize) -> Vec<Edge> {
        // A row of slopes about them, and one of values about these.
        let smooth = SMOOTHINGS.map(|deviation| self.smooth_rows(first - 2, last + 2, deviation));
        let width = self.width;
        let slopes = |of: &[f64]| -> Vec<[f64; 2]> {
            let rows = of.len() / width;
            let mut slopes = vec![[0.0; 2]; of.len()];
            for y in 1..rows - 1 {
                for x in 1..width - 1 {
                    let at = y * width + x;
                    let across = (of[at + 1] - of[at - 1]) / 2.0;
                    let along = (of[at + width] - of[at - width]) / 2.0;
                    slopes[at] = [across, along];
                }
            }
            slopes
        };
        let [near, middle, wide] = smooth.map(|of| slopes(&of));
        let strength = |[across, along]: [f64; 2]| across.hypot(along);
        let mut edges = Vec::new();
        for y in 2..last - first + 2 {
            for x in REACH..width - REACH {
                let at = y * width + x;
                let slope = strength(near[at]);
                if slope < WEAKEST {
                    continue;
                }
                // Across, along, or one of the diagonals, whichever is nearest.
                let [across, along] = near[at];
                let eighth = (along.atan2(across) / std::f64::consts::FRAC_PI_4).round() as i32;
                let steps = [1, width + 1, width, width - 1];
                let step = steps[eighth.rem_euclid(4) as usize];
                let beside = |place: Option<usize>| {
                    let of = place.and_then(|place| near.get(place));
                    of.map_or(0.0, |of| strength(*of))
                };
                if slope < beside(Some(at + step)) || slope <= beside(at.checked_sub(step)) {
                    continue;
                }
                let slopes = [slope, strength(middle[at]), strength(wide[at])];
                let variance = |place: usize| {
                    let ratio = (slopes[place] / slopes[place + 1]).powi(2);
                    let [a, b] = [SMOOTHINGS[place], SMOOTHINGS[place + 1]].map(|of| of * of);
                    (ratio > 1.0).then(|| (b - ratio * a) / (ratio - 1.0) - OF_DIFFERENCE)
                };
                // What does not become weaker by smoothing is no edge.
                let both = variance(0).zip(variance(1));
                edges.push((slope, both.map_or([f64::INFINITY, 0.0], |(a, b)| [a, b])));
            }
        }
        edges
    }

    /// Some rows, smoothed by a bell.
    fn smooth_rows(&self, first: usize, last: usize, deviation: f64) -> Vec<f64> {
        let reach = (3.4 * deviation).ceil() as isize;
        let bell = |off: isize| (-0.5 * (off as f64 / deviation).powi(2)).exp();
        let weights: Vec<f64> = (-reach..=reach).map(bell).collect();
        let sum: f64 = weights.iter().sum();
        let weights: Vec<f64> = weights.iter().map(|weight| weight / sum).collect();
        let width = self.width;
        let mut along = vec![0.0; (last - first) * width];
        for (row, y) in along.chunks_exact_mut(width).zip(first..) {
            for (weight, off) in weights.iter().zip(-reach..) {
                let y = y.saturating_add_signed(off).min(self.height - 1);
                let from = &self.values[y * width..][..width];
                for (value, from) in row.iter_mut().zip(from) {
                    *value += weight * from;
                }
            }
        }
        let mut smooth = vec![0.0; along.len()];
        let reach = reach as usize;
        for (row, from) in smooth
            .chunks_exact_mut(width)
            .zip(along.chunks_exact(width))
        {
            // What lies nearer to the edge than the bell reaches is not looked at.
            for (x, value) in row.iter_mut().enumerate().take(width - reach).skip(reach) {
                let part = &from[x - reach..=x + reach];
                *value = part
                    .iter()
                    .zip(&weights)
                    .map(|(from, weight)| from * weight)
                    .sum();
            }
        }
        smooth
    }
}

#[cfg(test)]
mod tests;
