//! Where a network is asked for a fragment: at the place of each outline of another engine that lies furthest within it, and
//! on a grid where that engine outlined nothing.
//!
//! In a photo that is seen in several sizes a fragment is asked for where it is neither lost nor cut: in those sizes in
//! which it is at least [`LEAST_ACROSS`] wide and no wider than a third of what the network sees at once. The finest size
//! takes all that are smaller, the coarsest all that are larger.

use fragscale_core::fault::Fault;
use fragscale_core::jobs::Progress;
use glam::DVec2;
use image::RgbImage;

use crate::delineating::delineate;
use crate::engine::Engine;
use crate::labels::{FINES, LabelImage};
use crate::measures::distances_within;
use crate::network::Part;

/// SAM's masks have a fourth of its picture's pixels along a side: so wide a fragment is four of them.
const LEAST_ACROSS: f64 = 16.0;

/// A fragment that an engine outlined.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stone {
    /// The middle of the pixel that lies furthest within it, in the full photo.
    at: DVec2,
    /// The diameter of the circle of as many pixels.
    across: f64,
}

/// Where to ask in a photo.
pub(in crate::named) struct Places {
    stones: Vec<Stone>,
    labels: LabelImage,
    grid: usize,
}

/// A part of a photo that is seen in some of several sizes.
#[derive(Debug, Clone, Copy)]
pub(in crate::named) struct SeenAt<'a> {
    pub(in crate::named) part: &'a Part,
    /// Columns and rows of the smaller photo that the part is of.
    pub(in crate::named) size: [usize; 2],
    /// All sizes that are looked at, the finest first, and which this one is.
    pub(in crate::named) sizes: &'a [f64],
    pub(in crate::named) number: usize,
}

impl Places {
    /// By the outlines of an engine, and as many places along a side of a part on what it did not outline.
    ///
    /// # Errors
    /// Those of the engine.
    pub(super) fn of(
        engine: &dyn Engine,
        photo: &RgbImage,
        grid: usize,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let labels = delineate(engine, photo, &[], progress)?;
        Ok(Self::by(labels, grid))
    }

    pub(super) fn by(labels: LabelImage, grid: usize) -> Self {
        let within = distances_within(&labels);
        let mut deepest: Vec<Option<(f64, usize)>> = vec![None; labels.fragments()];
        for (place, (label, within)) in labels.labels.iter().zip(within).enumerate() {
            // Fines have no number, what is no rock one that no fragment has.
            let number = (*label as usize).checked_sub(1);
            let Some(own) = number.and_then(|number| deepest.get_mut(number)) else {
                continue;
            };
            if own.is_none_or(|(most, _)| within > most) {
                *own = Some((within, place));
            }
        }
        let areas = labels.areas();
        let stones = deepest.into_iter().zip(areas.into_iter().skip(1));
        let stones = stones.filter_map(|(deepest, area)| {
            let (_, place) = deepest?;
            let at = [place % labels.width, place / labels.width];
            Some(Stone {
                at: DVec2::from(at.map(|at| at as f64 + 0.5)),
                across: (4.0 * area as f64 / std::f64::consts::PI).sqrt(),
            })
        });
        Self {
            stones: stones.collect(),
            labels,
            grid,
        }
    }

    /// Those within what is kept of a part, in the part's pixels (the middle of the first is 0.5).
    pub(in crate::named) fn in_part(&self, seen: SeenAt<'_>) -> Vec<DVec2> {
        let SeenAt { part, size, .. } = seen;
        let full = DVec2::new(self.labels.width as f64, self.labels.height as f64);
        let smaller = DVec2::new(size[0] as f64, size[1] as f64) / full;
        let corner = DVec2::new(part.first as f64, part.above as f64);
        let stones = self.stones.iter();
        let stones = stones.filter(|stone| seen.shows(stone.across));
        let stones = stones.map(|stone| stone.at * smaller).filter(|at| {
            let [x, y] = [at.x as usize, at.y as usize];
            (part.left..part.right).contains(&x) && (part.top..part.bottom).contains(&y)
        });
        let mut places: Vec<DVec2> = stones.map(|at| at - corner).collect();
        let Some(step) = part.columns.min(part.rows).checked_div(self.grid) else {
            return places;
        };
        let step = step.max(1);
        for y in (part.top + step / 2..part.bottom).step_by(step) {
            for x in (part.left + step / 2..part.right).step_by(step) {
                let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let [column, row] = (at / smaller).to_array().map(|at| at as usize);
                let label = self.labels.labels.get(row * self.labels.width + column);
                if column < self.labels.width && label == Some(&FINES) {
                    places.push(at - corner);
                }
            }
        }
        places
    }
}

impl SeenAt<'_> {
    /// Whether a fragment so wide in the full photo is asked for in this size.
    fn shows(&self, across: f64) -> bool {
        let by = self.sizes.get(self.number).copied().unwrap_or(1.0);
        let most = self.part.columns.min(self.part.rows) as f64 / 3.0;
        let is_finest = self.number == 0;
        let is_coarsest = self.number + 1 >= self.sizes.len();
        (is_finest || across / by >= LEAST_ACROSS) && (is_coarsest || across / by <= most)
    }
}
