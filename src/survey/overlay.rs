//! Which triangles of another surface lie under one: cells of a grid over them.

use glam::{DVec2, DVec3};

use super::SurveyError;
use super::prism::{Corner, Sums, clip_to};
use crate::geometry::Bounds;
use crate::surface::Surface;

/// A triangle of the surface below.
#[derive(Debug, Clone, Copy)]
struct Under {
    /// Counter-clockwise in plan.
    plan: [DVec2; 3],
    /// Its height over the origin of (x, y) nearest to it, and how it rises.
    at: DVec3,
    rise: DVec2,
    /// -1 where it looks down.
    sign: f64,
}

/// The triangles of a surface over a box, to be found by place.
#[derive(Debug)]
pub(super) struct Overlay {
    triangles: Vec<Under>,
    /// The first cell's corner, and the size of a cell.
    low: DVec2,
    cell: f64,
    cells: [usize; 2],
    /// Where in `inside` each cell begins; one more at the end.
    begins: Vec<usize>,
    inside: Vec<u32>,
}

/// The box in plan around a triangle or piece.
pub(super) fn around(places: impl IntoIterator<Item = DVec2>) -> [DVec2; 2] {
    let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    let grow = |[low, high]: [DVec2; 2], place: DVec2| [low.min(place), high.max(place)];
    places.into_iter().fold(none, grow)
}

impl Overlay {
    /// Of the triangles that may lie over a box in plan, both in the frame at this origin of the world.
    pub(super) fn new(
        surface: &Surface,
        origin: DVec3,
        [low, high]: [DVec2; 2],
    ) -> Result<Self, SurveyError> {
        let shift = surface.frame().origin() - origin;
        let own = [low - shift.truncate(), high - shift.truncate()];
        let misses = |bounds: &Bounds| {
            bounds.max.truncate().cmplt(own[0]).any() || bounds.min.truncate().cmpgt(own[1]).any()
        };
        let mut triangles = Vec::new();
        for patch in surface.patches().seen(misses)? {
            let beside = |corners: &[DVec3; 3]| {
                let [low, high] = around(corners.map(DVec3::truncate));
                high.cmplt(own[0]).any() || low.cmpgt(own[1]).any()
            };
            let within = patch.triangles().filter(|corners| !beside(corners));
            triangles.extend(within.filter_map(|c| Under::new(c.map(|corner| corner + shift))));
        }
        // As many cells as triangles, about.
        let size = high - low;
        let count = triangles.len().max(1) as f64;
        let cell = (size.x * size.y / count)
            .sqrt()
            .max(size.max_element() / 4096.0);
        // `as` saturates.
        let cells = (size / cell)
            .to_array()
            .map(|cells| (cells as usize).max(1));
        let mut overlay = Self {
            triangles,
            low,
            cell,
            cells,
            begins: vec![0; cells[0] * cells[1] + 1],
            inside: Vec::new(),
        };
        let all = std::mem::take(&mut overlay.triangles);
        let mut filled = overlay.begins.clone();
        for triangle in &all {
            overlay.each_cell(around(triangle.plan), |cell| filled[cell + 1] += 1);
        }
        for cell in 1..filled.len() {
            filled[cell] += filled[cell - 1];
        }
        overlay.begins.clone_from(&filled);
        overlay.inside = vec![0; filled.last().copied().unwrap_or(0)];
        let mut inside = std::mem::take(&mut overlay.inside);
        for (index, triangle) in (0_u32..).zip(&all) {
            overlay.each_cell(around(triangle.plan), |cell| {
                inside[filled[cell]] = index;
                filled[cell] += 1;
            });
        }
        (overlay.inside, overlay.triangles) = (inside, all);
        Ok(overlay)
    }

    /// The column and row of a place, the nearest where it lies beside all.
    fn cell_of(&self, place: DVec2) -> [usize; 2] {
        let cell = ((place - self.low) / self.cell).to_array();
        // `as` saturates.
        [0, 1].map(|axis| (cell[axis] as usize).min(self.cells[axis] - 1))
    }

    fn each_cell(&self, [low, high]: [DVec2; 2], mut visit: impl FnMut(usize)) {
        let ([left, bottom], [right, top]) = (self.cell_of(low), self.cell_of(high));
        for row in bottom..=top {
            for column in left..=right {
                visit(row * self.cells[0] + column);
            }
        }
    }

    /// Adds what lies between a piece and the triangles under it.
    pub(super) fn add(&self, piece: &[Corner], sums: &mut Sums) {
        let [low, high] = around(piece.iter().map(|corner| corner.at.truncate()));
        self.each_cell([low, high], |cell| {
            for &index in &self.inside[self.begins[cell]..self.begins[cell + 1]] {
                let under = &self.triangles[index as usize];
                let [under_low, under_high] = around(under.plan);
                let common = low.max(under_low);
                if common.cmpgt(high.min(under_high)).any() {
                    continue;
                }
                // Both are in several cells: this pair is counted in the one of their common corner.
                let [column, row] = self.cell_of(common);
                if row * self.cells[0] + column == cell {
                    let mut part = Sums::default();
                    let mut over = clip_to(piece, &under.plan);
                    for corner in &mut over {
                        corner.above = corner.at.z - under.height(corner.at.truncate());
                    }
                    part.add(&over);
                    *sums = sums.and(part.times(under.sign));
                }
            }
        });
    }
}

impl Under {
    /// `None` for one that has no area in plan.
    fn new([a, b, c]: [DVec3; 3]) -> Option<Self> {
        let twice = (b - a).truncate().perp_dot((c - a).truncate());
        let normal = (b - a).cross(c - a);
        let [b, c] = if twice < 0.0 { [c, b] } else { [b, c] };
        (twice != 0.0).then(|| Self {
            plan: [a, b, c].map(DVec3::truncate),
            at: a,
            rise: -normal.truncate() / normal.z,
            sign: twice.signum(),
        })
    }

    fn height(&self, place: DVec2) -> f64 {
        self.at.z + self.rise.dot(place - self.at.truncate())
    }
}
