//! The sieve size of a convex body: the side of the smallest square opening that it passes, moved
//! straight through after any rotation.
//!
//! Seen along a direction, the body passes where its outline fits: the smallest square around the
//! outline. The sieve size is the smallest such square over all directions. In other words, with
//! w(u) the body's width along u, it is the minimum of max(w(u), w(v)) over all pairs of unit
//! vectors u and v at right angles.
//!
//! For one direction the square is exact: between the angles at which a side of the square or its
//! neighbour lies flush with an edge of the outline, both widths are arcs of cosines, concave where
//! they are positive, so their maximum is least at an end of the arc or where the two are equal.
//!
//! Over directions the minimum is searched: a grid over the half sphere, then a shrinking pattern
//! around the best few. What it returns is the side of a square that the body does pass, so it
//! errs upwards only. Accuracy: against a search with several times the effort, 25 random bodies
//! came out at most 1.3e-5 too large, 24 of them below 1e-8; the test allows 1e-4. Of 4000 random
//! bodies searched in two attitudes, half came out the same to 2e-9, 99 % to 6e-5, all but one to
//! 1e-3 (that one to 1.7e-3: its search ended in another dip); sieves are a factor of 1.4 apart.
//! Cubes, boxes and ellipsoids meet their closed forms to 1e-5 (apart from the points standing for a
//! smooth surface).

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DVec2, DVec3};

/// How hard to search.
struct Effort {
    /// Directions of the grid over the half sphere.
    grid: usize,
    /// The best places of the grid, from which a coarse search sets out.
    coarse: usize,
    /// The best of these, from which a fine search goes on.
    fine: usize,
    /// Rounds without a gain before the step halves.
    patience: u32,
}

/// Steps of the coarse and the fine search (radians): 0.15 is about half a cell of the grid.
const COARSE: (f64, f64) = (0.15, 0.01);
const FINE: (f64, f64) = (0.01, 1e-7);

const EFFORT: Effort = Effort {
    grid: 96,
    coarse: 16,
    fine: 4,
    patience: 3,
};

/// The sieve size of the convex hull of `points`, in their unit; see the head of this file. 0 for
/// no points and for points on one line.
pub(super) fn sieve_size(points: &[DVec3]) -> f64 {
    search(points, &EFFORT)
}

/// The smallest square over a grid of directions and around the best of them.
fn search(points: &[DVec3], effort: &Effort) -> f64 {
    let mut outline = Outline::default();
    let mut grid: Vec<Place> = starts(points, effort.grid)
        .map(|direction| (outline.square(points, direction), direction))
        .collect();
    grid.sort_by(|a, b| a.0.total_cmp(&b.0));
    let cell = (TAU / effort.grid as f64).sqrt();
    let mut best = apart(grid, 0.5 * cell, effort.coarse);
    for (steps, next) in [(COARSE, effort.fine), (FINE, 1)] {
        for place in &mut best {
            *place = refine(points, &mut outline, *place, steps, effort.patience);
        }
        best.sort_by(|a, b| a.0.total_cmp(&b.0));
        best = apart(best, 0.02, next);
    }
    best.first().map_or(0.0, |(side, _)| *side)
}

/// The side of the square around the body, seen along the direction.
type Place = (f64, DVec3);

/// The first places whose directions, to and fro being one, are `angle` (radians) apart.
fn apart(places: Vec<Place>, angle: f64, wanted: usize) -> Vec<Place> {
    let mut kept: Vec<Place> = Vec::new();
    for place in places {
        let new = |other: &Place| other.1.dot(place.1).abs() < angle.cos();
        if kept.len() < wanted && kept.iter().all(new) {
            kept.push(place);
        }
    }
    kept
}

/// A grid over the half sphere (a golden spiral), the axes and the direction to the farthest point.
fn starts(points: &[DVec3], grid: usize) -> impl Iterator<Item = DVec3> {
    let centre = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let farthest = points
        .iter()
        .map(|point| point - centre)
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let spiral = (0..grid).map(move |index| {
        let z = (index as f64 + 0.5) / grid as f64;
        let (sin, cos) = (index as f64 * GOLDEN_ANGLE).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cos, radius * sin, z)
    });
    farthest
        .and_then(DVec3::try_normalize)
        .into_iter()
        .chain(DVec3::AXES)
        .chain(spiral)
}

/// Turns by which no two of many directions are near each other.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// A pattern search: six directions around the best one, turned anew each round, because at a crease
/// of the side only few directions lead down. The step halves when `patience` rounds found nothing.
fn refine(
    points: &[DVec3],
    outline: &mut Outline,
    start: Place,
    (mut step, last): (f64, f64),
    patience: u32,
) -> Place {
    let (mut best, mut at) = start;
    let (mut turn, mut idle) = (0.0, 0);
    while step > last {
        let (right, up) = at.any_orthonormal_pair();
        idle += 1;
        for spoke in 0..6 {
            let (sin, cos) = (turn + f64::from(spoke) * TAU / 6.0).sin_cos();
            let candidate = (at + (right * cos + up * sin) * step).normalize();
            let side = outline.square(points, candidate);
            // A smaller gain is rounding, and could be gained for ever.
            if side < best * (1.0 - 1e-14) {
                (best, at, idle) = (side, candidate, 0);
                break;
            }
        }
        turn += GOLDEN_ANGLE;
        if idle == patience {
            (step, idle) = (0.5 * step, 0);
        }
    }
    (best, at)
}

/// The outline of a body along a direction; kept between calls for its memory.
#[derive(Default)]
struct Outline {
    flat: Vec<DVec2>,
    hull: Vec<DVec2>,
    angles: Vec<f64>,
}

impl Outline {
    /// The side of the smallest square around the points seen along the unit vector `direction`.
    fn square(&mut self, points: &[DVec3], direction: DVec3) -> f64 {
        let (right, up) = direction.any_orthonormal_pair();
        self.flat.clear();
        self.flat.extend(
            points
                .iter()
                .map(|point| DVec2::new(point.dot(right), point.dot(up))),
        );
        self.find_hull();
        self.find_angles();
        let (Some(&first), Some(&last)) = (self.angles.first(), self.angles.last()) else {
            return 0.0;
        };
        let mut best = f64::INFINITY;
        let mut from = last - FRAC_PI_2;
        for &to in std::iter::once(&first).chain(self.angles.iter().skip(1)) {
            best = best.min(self.least_on_arc(from, to));
            from = to;
        }
        best
    }

    /// Andrew's monotone chain: the corners of the outline, counter-clockwise.
    fn find_hull(&mut self) {
        self.flat
            .sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        self.hull.clear();
        for &point in &self.flat {
            extend_chain(&mut self.hull, 0, point);
        }
        let lower = self.hull.len().saturating_sub(1);
        for &point in self.flat.iter().rev().skip(1) {
            extend_chain(&mut self.hull, lower, point);
        }
        if self.hull.len() > 1 {
            self.hull.pop();
        }
    }

    /// The angles in [0, pi/2) at which a square's side or its neighbour is flush with an edge.
    fn find_angles(&mut self) {
        self.angles.clear();
        let next = self.hull.iter().cycle().skip(1);
        self.angles.extend(
            self.hull
                .iter()
                .zip(next)
                .map(|(from, to)| to - from)
                .filter(|edge| *edge != DVec2::ZERO)
                .map(|edge| edge.to_angle().rem_euclid(FRAC_PI_2)),
        );
        self.angles.sort_unstable_by(f64::total_cmp);
        self.angles.dedup();
    }

    /// The least side of a square turned by `from` to `to`, between which no edge comes flush.
    fn least_on_arc(&self, from: f64, to: f64) -> f64 {
        let middle = DVec2::from_angle(0.5 * (from + to));
        // The two pairs of corners that touch the square all along the arc.
        let (p, q) = (self.reach(middle), self.reach(middle.perp()));
        let sides = |u: DVec2| (p.dot(u), q.dot(u.perp()));
        let (start, end) = (sides(DVec2::from_angle(from)), sides(DVec2::from_angle(to)));
        let ends = f64::min(start.0.max(start.1), end.0.max(end.1));
        // Equal sides: (p.x - q.y) cos + (p.y + q.x) sin = 0.
        if (start.0 - start.1) * (end.0 - end.1) >= 0.0 {
            return ends;
        }
        let across = DVec2::new(p.y + q.x, q.y - p.x);
        let across = if across.dot(middle) < 0.0 {
            -across
        } else {
            across
        };
        across
            .try_normalize()
            .map(sides)
            .map_or(ends, |(width, height)| ends.min(width.max(height)))
    }

    /// From the corner farthest back along `along` to the one farthest ahead.
    fn reach(&self, along: DVec2) -> DVec2 {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let (mut back, mut ahead) = (DVec2::ZERO, DVec2::ZERO);
        for &corner in &self.hull {
            let at = corner.dot(along);
            if at < least {
                (least, back) = (at, corner);
            }
            if at > most {
                (most, ahead) = (at, corner);
            }
        }
        ahead - back
    }
}

/// Adds a point to a chain that turns left only, from its place `start` on.
fn extend_chain(chain: &mut Vec<DVec2>, start: usize, point: DVec2) {
    while let Some([before, last]) = chain.get(start..).and_then(|part| part.last_chunk()) {
        if (last - before).perp_dot(point - last) > 0.0 {
            break;
        }
        chain.pop();
    }
    chain.push(point);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::scene::fragment::{BROKEN, Body};

    fn cuboid(size: DVec3) -> Vec<DVec3> {
        let signs = [-0.5, 0.5];
        let mut corners = Vec::new();
        for x in signs {
            for y in signs {
                corners.extend(signs.map(|z| DVec3::new(x, y, z) * size));
            }
        }
        corners
    }

    /// Points on an ellipsoid, a golden spiral before it is stretched.
    fn ellipsoid(size: DVec3, count: usize) -> Vec<DVec3> {
        (0..count)
            .map(|index| {
                let z = 1.0 - (2.0 * index as f64 + 1.0) / count as f64;
                let (sin, cos) = (index as f64 * GOLDEN_ANGLE).sin_cos();
                let radius = (1.0 - z * z).sqrt();
                0.5 * size * DVec3::new(radius * cos, radius * sin, z)
            })
            .collect()
    }

    #[test]
    fn nothing() {
        assert_eq!(sieve_size(&[]), 0.0);
        assert_eq!(sieve_size(&[DVec3::ONE]), 0.0);
    }

    /// Inscribed points: below the diameter, by no more than 1 - cos of their spacing (0.08 rad).
    #[test]
    fn sphere() {
        let side = sieve_size(&ellipsoid(DVec3::splat(2.0), 2000));
        assert!(side < 2.0 && side > 2.0 * 0.08f64.cos(), "{side}");
    }

    #[test]
    fn cube() {
        let turned = Random::new(5).rotation();
        let corners: Vec<_> = cuboid(DVec3::splat(3.0))
            .into_iter()
            .map(|corner| turned * corner)
            .collect();
        let side = sieve_size(&corners);
        assert!((3.0 - 1e-12..3.0 + 3e-5).contains(&side), "{side}");
    }

    /// The width of a box along u is a |u.x| + b |u.y| + c |u.z|. Against all pairs on a grid: the
    /// search is never above, and below by no more than the grid is coarse (a side changes by at
    /// most the diagonal times the angle, half a grid cell each way).
    #[test]
    fn boxes_against_all_directions() {
        for size in [
            DVec3::new(3.0, 2.0, 1.0),
            DVec3::new(2.0, 2.0, 0.5),
            DVec3::new(1.5, 1.2, 1.0),
            DVec3::new(4.0, 1.0, 0.9),
        ] {
            let width = |u: DVec3| u.abs().dot(size);
            let cell = 1.5f64.to_radians();
            let mut grid = f64::INFINITY;
            for i in 0..=60 {
                for j in 0..=60 {
                    let (sin, cos) = (f64::from(i) * cell).sin_cos();
                    let across = DVec2::from_angle(f64::from(j) * cell);
                    let direction = DVec3::new(across.x * sin, across.y * sin, cos);
                    let (right, up) = direction.any_orthonormal_pair();
                    for k in 0..60 {
                        let turn = DVec2::from_angle(f64::from(k) * cell);
                        let u = right * turn.x + up * turn.y;
                        let v = up * turn.x - right * turn.y;
                        grid = grid.min(width(u).max(width(v)));
                    }
                }
            }
            let side = sieve_size(&cuboid(size));
            let coarse = size.length() * cell;
            assert!(side < grid + 1e-5 * side, "{size}: {side} above {grid}");
            assert!(side > grid - coarse, "{size}: {side} far below {grid}");
            // Seen along its longest axis: flat, or a thin slab put in from corner to corner.
            let along = size.y.min((size.y + size.z) / 2f64.sqrt());
            assert!(side < along * (1.0 + 1e-5), "{size}: {side} above {along}");
        }
    }

    /// w(u)^2 + w(v)^2 is at least I^2 + S^2 for an ellipsoid, so no direction beats the one along
    /// L with the square turned by 45 degrees: sqrt((I^2 + S^2) / 2).
    #[test]
    fn ellipsoids() {
        for (long, middle, short) in [(3.0, 2.0, 1.0), (2.0, 1.4, 1.0), (1.0, 0.9, 0.3)] {
            let side = sieve_size(&ellipsoid(DVec3::new(long, middle, short), 1500));
            let closed = f64::sqrt(0.5 * (middle * middle + short * short));
            assert!(side < closed, "{side} above {closed}");
            assert!(side > closed * (1.0 - 5e-3), "{side} below {closed}");
        }
    }

    /// Four times the directions, twice the places and patience find no smaller square.
    #[test]
    fn more_search_finds_no_more() {
        let hard = Effort {
            grid: 400,
            coarse: 32,
            fine: 8,
            patience: 6,
        };
        let gaps: Vec<f64> = (0..25)
            .map(|seed| {
                let body = Body::random(BROKEN, &mut Random::new(seed));
                1.0 - search(body.vertices(), &hard)
            })
            .collect();
        let worst = gaps.iter().copied().fold(0.0, f64::max);
        assert!(worst < 1e-4, "{gaps:?}");
    }

    /// A turned body is the same body. Its search runs on another grid and may end in another dip,
    /// in about one of a hundred by more than 6e-5 (the head of this file): fixed seeds, so that what
    /// is rare does not fail a run now and then. No square is larger than one around the ball.
    #[test]
    fn turns_with_the_body() {
        let mut gaps = Vec::new();
        for seed in 0..100 {
            let mut random = Random::new(seed);
            let body = Body::random(BROKEN, &mut random);
            let rotation = random.rotation();
            let turned: Vec<_> = body.vertices().iter().map(|v| rotation * *v).collect();
            let side = sieve_size(&turned);
            assert!(side <= 2.0 * body.bounding_radius());
            gaps.push((side - 1.0).abs());
        }
        gaps.sort_by(f64::total_cmp);
        assert!(
            gaps[50] < 1e-8 && gaps[95] < 1e-4 && gaps[99] < 2e-3,
            "{gaps:?}"
        );
    }
}
