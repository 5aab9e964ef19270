//! The sweeps on the processor, rows of one colour side by side on all cores.

#![expect(
    clippy::needless_range_loop,
    clippy::cast_possible_wrap,
    reason = "iterators' closures are not inlined into code for another kind of processor; sides of images are small"
)]

use rayon::prelude::*;

use super::pair::project;
use super::plane::{Plane, Planes};
use super::random::Random;
use super::window::{Fours, Weights, Window};
use super::{
    BEST, Backend, EDGE, FAR_DEARER, FARTHEST, GATE, MOST_SOURCES, Problem, REACH, SAME, Source,
    Sweep, UNSEEN,
};
use crate::fault::Fault;
use crate::jobs::Progress;

/// The processor's cores, those of rayon's pool.
#[derive(Debug, Clone, Copy, Default)]
pub struct Cpu;

/// Where candidates come from.
const DIRECTIONS: [(isize, isize); 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];

/// A view as the inner loop reads it.
struct Prepared<'a> {
    source: &'a Source,
    fours: Fours,
}

/// The planes of one colour of the checkerboard: those of a row side by side.
struct Colour {
    /// Columns that a row of this colour has at most.
    columns: usize,
    planes: Vec<Plane>,
}

impl Colour {
    /// The pixels whose coordinates' sum is even (0) or odd (1); a column too many is filled up.
    fn of(planes: &Planes, parity: usize) -> Self {
        let columns = planes.width.div_ceil(2);
        let mut own = Vec::with_capacity(columns * planes.height);
        for (y, row) in planes.planes.chunks_exact(planes.width).enumerate() {
            let first = (y + parity) % 2;
            own.extend((0..columns).map(|i| row[(2 * i + first).min(planes.width - 1)]));
        }
        Self {
            columns,
            planes: own,
        }
    }

    fn give_back(&self, planes: &mut Planes, parity: usize) {
        let width = planes.width;
        let rows = planes.planes.chunks_exact_mut(width).enumerate();
        for ((y, row), own) in rows.zip(self.planes.chunks_exact(self.columns)) {
            let first = (y + parity) % 2;
            for (x, plane) in (first..width).step_by(2).zip(own) {
                row[x] = *plane;
            }
        }
    }
}

impl Backend for Cpu {
    fn name(&self) -> String {
        format!("processor, {} threads", rayon::current_num_threads())
    }

    fn sweep(
        &self,
        problem: &Problem,
        planes: &mut Planes,
        sweeps: &[Sweep],
        progress: &Progress,
    ) -> Result<(), Fault> {
        let sources: Vec<_> = problem
            .sources
            .iter()
            .map(|source| Prepared {
                source,
                fours: Fours::of(&source.luma),
            })
            .collect();
        let weights = Weights::new();
        let arch = pulp::Arch::new();
        let mut colours = [Colour::of(planes, 0), Colour::of(planes, 1)];
        for sweep in sweeps {
            for parity in 0..2 {
                let [even, odd] = &mut colours;
                let (own, other) = if parity == 0 {
                    (even, &*odd)
                } else {
                    (odd, &*even)
                };
                let half = Half {
                    problem,
                    sources: &sources,
                    weights: &weights,
                    sweep,
                    parity,
                    other,
                };
                own.planes
                    .par_chunks_exact_mut(own.columns)
                    .enumerate()
                    .try_for_each(|(y, row)| {
                        if progress.is_cancelled() {
                            return Err(());
                        }
                        arch.dispatch(Row {
                            half: &half,
                            y,
                            row,
                        });
                        Ok(())
                    })
                    .or_else(|()| progress.advance(0, 1))?;
            }
        }
        colours[0].give_back(planes, 0);
        colours[1].give_back(planes, 1);
        Ok(())
    }
}

/// Half a sweep: one colour, which reads the other.
struct Half<'a> {
    problem: &'a Problem,
    sources: &'a [Prepared<'a>],
    weights: &'a Weights,
    sweep: &'a Sweep,
    parity: usize,
    other: &'a Colour,
}

/// A row's work, compiled once for every kind of processor: all below is inlined into it.
struct Row<'a> {
    half: &'a Half<'a>,
    y: usize,
    row: &'a mut [Plane],
}

impl pulp::NullaryFnOnce for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.half.row(self.y, self.row);
    }
}

impl Half<'_> {
    #[inline(always)]
    fn row(&self, y: usize, row: &mut [Plane]) {
        let first = (y + self.parity) % 2;
        for (x, plane) in (first..self.problem.luma.width).step_by(2).zip(row) {
            *plane = self.pixel(x, y, *plane);
        }
    }

    /// The best plane that one sweep finds at a pixel.
    #[inline(always)]
    fn pixel(&self, x: usize, y: usize, mut best: Plane) -> Plane {
        let problem = self.problem;
        let window = Window::at(&problem.luma, self.weights, x, y);
        let place = [x as f32 + 0.5, y as f32 + 0.5];
        let (cost, order) = self.costs(&window, place, best);
        best.cost = cost;
        let mut random = Random::at(x as u32, y as u32, self.sweep.salt);
        let reach = self.sweep.amplitude * problem.per_pixel;
        // One place where planes are tried, so that it can be inlined.
        for trial in 0..if self.sweep.anywhere { 8 } else { 7 } {
            let tried = match trial {
                0..4 => {
                    let (right, down) = DIRECTIONS[trial];
                    let Some(candidate) = self.candidate(x, y, right, down) else {
                        continue;
                    };
                    candidate
                }
                4 => best.near(reach, reach, &mut random),
                5 => best.near(0.5 * reach, 0.0, &mut random),
                6 => best.near(0.0, 0.5 * reach, &mut random),
                _ => Plane::anywhere(problem, &mut random),
            };
            self.consider(&window, place, tried, &order, &mut best);
        }
        best
    }

    /// The cheapest of the other colour's planes in a direction, brought here.
    #[inline(always)]
    fn candidate(&self, x: usize, y: usize, right: isize, down: isize) -> Option<Plane> {
        let mut found: Option<Plane> = None;
        let mut cheapest = f32::MAX;
        for reach in REACH {
            let (dx, dy) = (right * reach as isize, down * reach as isize);
            let (column, row) = (x as isize + dx, y as isize + dy);
            if column < 0 || row < 0 {
                break;
            }
            let (column, row) = (column as usize, row as usize);
            if column >= self.problem.luma.width || row >= self.problem.luma.height {
                break;
            }
            let plane = self.other.planes[row * self.other.columns + column / 2];
            // The first also where its cost is not counted yet.
            if found.is_none() || plane.cost < cheapest {
                cheapest = if plane.cost.is_nan() {
                    f32::MAX
                } else {
                    plane.cost
                };
                found = Some(plane.moved(-dx as f32, -dy as f32));
            }
        }
        found
    }

    #[inline(always)]
    fn consider(
        &self,
        window: &Window,
        place: [f32; 2],
        tried: Plane,
        order: &[usize; MOST_SOURCES],
        best: &mut Plane,
    ) {
        let least = SAME * self.problem.per_pixel;
        let is_same = (tried.inverse_depth - best.inverse_depth).abs() < least
            && (tried.slope[0] - best.slope[0]).abs() * EDGE < least
            && (tried.slope[1] - best.slope[1]).abs() * EDGE < least;
        if is_same || !tried.is_possible(self.problem) {
            return;
        }
        let cost = self.cost(window, place, tried, best.cost, order);
        if cost < best.cost {
            *best = Plane { cost, ..tried };
        }
    }

    /// The mean cost of the best views; with the views in the order of their costs.
    #[inline(always)]
    fn costs(
        &self,
        window: &Window,
        place: [f32; 2],
        plane: Plane,
    ) -> (f32, [usize; MOST_SOURCES]) {
        let mut costs = [UNSEEN; MOST_SOURCES];
        let mut order = [0, 1, 2, 3, 4, 5, 6, 7];
        let count = self.sources.len().min(MOST_SOURCES);
        let mut i = 0;
        while i < count {
            costs[i] = self.cost_in(i, window, place, plane);
            i += 1;
        }
        // The next cheapest to the front.
        for i in 0..count {
            for j in i + 1..count {
                if costs[order[j]] < costs[order[i]] {
                    order.swap(i, j);
                }
            }
        }
        let wanted = BEST.min(count);
        let mut sum = 0.0;
        for i in 0..wanted {
            sum += costs[order[i]];
        }
        (sum / wanted.max(1) as f32, order)
    }

    /// The mean cost of the best views where it is below `bound`. Whether the others are looked at is
    /// decided by those that were the best so far.
    #[inline(always)]
    fn cost(
        &self,
        window: &Window,
        place: [f32; 2],
        plane: Plane,
        bound: f32,
        order: &[usize; MOST_SOURCES],
    ) -> f32 {
        let count = self.sources.len().min(MOST_SOURCES);
        let wanted = BEST.min(count);
        // The cheapest, in order.
        let mut cheapest = [f32::MAX; BEST];
        for looked in 0..count {
            let gate = if looked < wanted { FAR_DEARER } else { GATE };
            if looked > 0 && looked <= wanted && cheapest[0] > bound + gate {
                break;
            }
            let mut cost = self.cost_in(order[looked], window, place, plane);
            for i in 0..BEST {
                if cost < cheapest[i] {
                    (cheapest[i], cost) = (cost, cheapest[i]);
                }
            }
        }
        let mut sum = 0.0;
        for i in 0..wanted {
            sum += cheapest[i];
        }
        sum / wanted.max(1) as f32
    }

    #[inline(always)]
    fn cost_in(&self, i: usize, window: &Window, place: [f32; 2], plane: Plane) -> f32 {
        let view = &self.sources[i];
        let cost = window.cost(
            &view.fours,
            &view.source.pair.there,
            place,
            plane.inverse_depth,
            plane.slope,
        );
        if self.sweep.geometric > 0.0 {
            return cost + self.sweep.geometric * miss(view.source, place, plane.inverse_depth);
        }
        cost
    }
}

/// How far from the pixel one comes back to, in pixels, by way of the other view's own depth.
fn miss(source: &Source, place: [f32; 2], inverse_depth: f32) -> f32 {
    let Some(depths) = &source.inverse_depths else {
        return 0.0;
    };
    let m = project(&source.pair.there, place, inverse_depth);
    if m[2] < 1e-6 {
        return FARTHEST;
    }
    let (u, v) = (m[0] / m[2], m[1] / m[2]);
    let (width, height) = (source.luma.width, source.luma.height);
    let is_inside = u >= 0.0 && v >= 0.0 && u < width as f32 && v < height as f32;
    if !is_inside {
        return FARTHEST;
    }
    // The depth at the pixel's centre stands for the pixel.
    let (column, row) = (u as usize, v as usize);
    let theirs = depths[row * width + column];
    if theirs <= 0.0 {
        return FARTHEST;
    }
    let back = project(&source.pair.back, [u, v], theirs);
    if back[2] < 1e-6 {
        return FARTHEST;
    }
    let (x, y) = (back[0] / back[2] - place[0], back[1] / back[2] - place[1]);
    (x * x + y * y).sqrt().min(FARTHEST)
}
