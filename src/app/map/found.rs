//! Which photos lie at a place of the plan: cells of a grid over it know the footprints that reach into them,
//! so that the mouse asks a few photos, not all.

use glam::DVec2;

use crate::exports::Plan;
use crate::geometry::surrounds;

/// Cells along the longer side.
const CELLS: f64 = 96.0;

/// Photos by their places.
#[derive(Debug, Default)]
pub struct PhotosAt {
    low: DVec2,
    cell: f64,
    cells: [usize; 2],
    /// Of each cell, row by row.
    inside: Vec<Vec<usize>>,
}

impl PhotosAt {
    /// Of a plan.
    pub fn new(plan: &Plan) -> Self {
        let [low, high] = plan.extent;
        let cell = ((high - low).max_element() / CELLS).max(f64::MIN_POSITIVE);
        let cells = (high - low) / cell;
        // At most CELLS + 1.
        let cells = [cells.x as usize + 1, cells.y as usize + 1];
        let mut found = Self {
            low,
            cell,
            cells,
            inside: vec![Vec::new(); cells[0] * cells[1]],
        };
        for (index, photo) in plan.photos.iter().enumerate() {
            let outline = photo.outline.iter().copied();
            let (Some(min), Some(max)) = (
                outline.clone().reduce(DVec2::min),
                outline.reduce(DVec2::max),
            ) else {
                continue;
            };
            if max.cmplt(low).any() || min.cmpgt(high).any() {
                continue;
            }
            let ([west, south], [east, north]) = (found.cell_of(min), found.cell_of(max));
            for row in south..=north {
                for column in west..=east {
                    found.inside[row * cells[0] + column].push(index);
                }
            }
        }
        found
    }

    /// The cell of a place, or the nearest.
    fn cell_of(&self, place: DVec2) -> [usize; 2] {
        let off = (place - self.low) / self.cell;
        // `as` saturates.
        [
            (off.x as usize).min(self.cells[0] - 1),
            (off.y as usize).min(self.cells[1] - 1),
        ]
    }

    /// Of the photos that show a place the one whose middle is nearest to it.
    pub fn at(&self, plan: &Plan, place: DVec2) -> Option<usize> {
        let [low, high] = plan.extent;
        if !(place.cmpge(low).all() && place.cmple(high).all()) || self.inside.is_empty() {
            return None;
        }
        let [column, row] = self.cell_of(place);
        let near = self.inside.get(row * self.cells[0] + column)?;
        let shows = near.iter().filter_map(|&index| {
            let photo = plan.photos.get(index)?;
            surrounds(&photo.outline, place).then(|| {
                let middle = photo.middle.unwrap_or(photo.camera);
                (index, middle.distance(place))
            })
        });
        shows
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(index, _)| index)
    }
}
