//! Crest, toe and angle of repose of a profile.
//!
//! - The crest is the highest point of the profile; where a level stretch is highest, its end on the
//!   side of the face.
//! - A face is a side of the crest, before or after it, that falls by at least a tenth of the
//!   profile's whole relief.
//! - The toe of a face is the point furthest, by height, below the straight line from the crest to the
//!   end of the profile on that side: where the face meets the floor. Where no point lies below that
//!   line the face runs to the profile's end, and that is the toe.
//! - The angle of repose is the slope of the steepest line that least squares fit (over the length in
//!   plan) to a stretch between crest and toe in which the surface falls by half of the height between
//!   the two. So single rocks do not decide, nor do the round crest and the foot. Stretches of which
//!   more than a tenth has no surface do not count.

use super::profile::{Profile, ProfilePoint};

/// How much of the profile's relief a side must fall by to be a face.
const LEAST_FALL: f64 = 0.1;
/// The share of the face's height that a fitted stretch falls by.
const FITTED_FALL: f64 = 0.5;
/// The share of a stretch that must have a surface.
const LEAST_COVERED: f64 = 0.9;
/// Points in one block whose lowest is kept.
const BLOCK: usize = 256;

/// A side of a pile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Face {
    /// Its upper end.
    pub crest: ProfilePoint,
    /// Its lower end.
    pub toe: ProfilePoint,
    /// The slope from crest to toe, degrees from the horizontal.
    pub overall: f64,
    /// The angle of repose, degrees from the horizontal; `None` where too much of the face is a hole.
    pub repose: Option<f64>,
    /// Between which distances along the line the angle of repose was found.
    pub fitted: Option<[f64; 2]>,
}

impl Face {
    /// How high the crest lies over the toe, world units.
    pub fn height(&self) -> f64 {
        self.crest.point.z - self.toe.point.z
    }
}

impl Profile {
    /// The faces before and after its crest.
    pub fn faces(&self) -> [Option<Face>; 2] {
        let (Some(crest), Some(lowest)) = (self.crest(), self.lowest()) else {
            return [None, None];
        };
        let (top, relief) = (crest.point.z, crest.point.z - lowest.point.z);
        if relief <= 0.0 {
            return [None, None];
        }
        // Downhill from the crest, and the lengths without surface between two points.
        let mut after: Vec<Place> = Vec::new();
        for run in &self.runs {
            after.extend(run.iter().enumerate().map(|(place, &point)| Place {
                point,
                behind_hole: place == 0,
            }));
        }
        let mut before: Vec<Place> = Vec::new();
        for run in self.runs.iter().rev() {
            before.extend(run.iter().rev().enumerate().map(|(place, &point)| Place {
                point,
                behind_hole: place == 0,
            }));
        }
        [before, after].map(|places| {
            let start = places.iter().rposition(|p| p.point.point.z == top)?;
            face(&places[start..], relief)
        })
    }
}

/// A point on the way down.
#[derive(Clone, Copy)]
struct Place {
    point: ProfilePoint,
    /// Whether there is no surface between it and the one before.
    behind_hole: bool,
}

/// The face that begins at the first of these places.
fn face(places: &[Place], relief: f64) -> Option<Face> {
    let (first, last) = (places.first()?, places.last()?);
    let (crest, end) = (first.point, last.point);
    let along = |point: &ProfilePoint| (point.distance - crest.distance).abs();
    let length = along(&end);
    let below = |point: &ProfilePoint| {
        let share = if length > 0.0 {
            along(point) / length
        } else {
            1.0
        };
        crest.point.z + (end.point.z - crest.point.z) * share - point.point.z
    };
    // A rounding error is no toe.
    let mut toe = (places.len() - 1, 1e-9 * relief);
    for (place, at) in places.iter().enumerate() {
        let depth = below(&at.point);
        if depth > toe.1 {
            toe = (place, depth);
        }
    }
    let places = &places[..=toe.0];
    let toe = places.last()?.point;
    let fall = crest.point.z - toe.point.z;
    if fall < LEAST_FALL * relief {
        return None;
    }
    let steepest = steepest(places, FITTED_FALL * fall);
    let ends = |[from, to]: [f64; 2]| {
        let at = |along: f64| match toe.distance < crest.distance {
            true => crest.distance - along,
            false => crest.distance + along,
        };
        [at(from).min(at(to)), at(from).max(at(to))]
    };
    Some(Face {
        crest,
        toe,
        overall: fall.atan2(along(&toe)).to_degrees(),
        repose: steepest.map(|(slope, _)| slope.atan().to_degrees()),
        fitted: steepest.map(|(_, stretch)| ends(stretch)),
    })
}

/// Integrals over the surface's length, of what is under the way down from the crest.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    length: f64,
    x: f64,
    z: f64,
    xx: f64,
    xz: f64,
}

impl Moments {
    /// With the straight piece between two places.
    fn with(mut self, from: [f64; 2], to: [f64; 2]) -> Self {
        let length = to[0] - from[0];
        let mean = |f: fn([f64; 2]) -> f64| {
            // Simpson's rule is exact for squares.
            let middle = [(from[0] + to[0]) / 2.0, (from[1] + to[1]) / 2.0];
            (f(from) + 4.0 * f(middle) + f(to)) / 6.0
        };
        self.length += length;
        self.x += length * mean(|[x, _]| x);
        self.z += length * mean(|[_, z]| z);
        self.xx += length * mean(|[x, _]| x * x);
        self.xz += length * mean(|[x, z]| x * z);
        self
    }

    fn without(&self, other: &Self) -> Self {
        Self {
            length: self.length - other.length,
            x: self.x - other.x,
            z: self.z - other.z,
            xx: self.xx - other.xx,
            xz: self.xz - other.xz,
        }
    }

    /// How steeply the line falls that fits best.
    fn fall(&self) -> f64 {
        let spread = self.xx - self.x * self.x / self.length;
        let together = self.xz - self.x * self.z / self.length;
        -together / spread
    }
}

/// The steepest fitted line over stretches that fall by so much, as fall over length, and where it is,
/// both ends as lengths from the crest.
fn steepest(places: &[Place], fall: f64) -> Option<(f64, [f64; 2])> {
    let crest = places.first()?.point;
    let down: Vec<[f64; 2]> = (places.iter())
        .map(|place| {
            let ProfilePoint { distance, point } = place.point;
            [(distance - crest.distance).abs(), point.z - crest.point.z]
        })
        .collect();
    let mut sums = vec![Moments::default()];
    for (place, ends) in down.windows(2).enumerate() {
        let sum = sums[place];
        let hole = places[place + 1].behind_hole;
        sums.push(if hole {
            sum
        } else {
            sum.with(ends[0], ends[1])
        });
    }
    let lowest: Vec<f64> = (down.chunks(BLOCK))
        .map(|block| block.iter().fold(f64::INFINITY, |low, p| low.min(p[1])))
        .collect();
    let mut best: Option<(f64, [f64; 2])> = None;
    for (start, &from) in down.iter().enumerate() {
        let level = from[1] - fall;
        let Some(end) = first_at(&down, &lowest, start + 1, level) else {
            continue;
        };
        let (above, under) = (down[end - 1], down[end]);
        let share = ((level - above[1]) / (under[1] - above[1])).clamp(0.0, 1.0);
        let to = [above[0] + (under[0] - above[0]) * share, level];
        let mut moments = sums[end - 1].without(&sums[start]);
        if !places[end].behind_hole {
            moments = moments.with(above, to);
        }
        let length = to[0] - from[0];
        if moments.length < LEAST_COVERED * length {
            continue;
        }
        // An upright face has no length.
        let slope = match length > 0.0 {
            true => moments.fall(),
            false => f64::INFINITY,
        };
        if slope > best.map_or(0.0, |(slope, _)| slope) {
            best = Some((slope, [from[0], to[0]]));
        }
    }
    best
}

/// The first place from `start` on that is at this level or under it.
fn first_at(down: &[[f64; 2]], lowest: &[f64], start: usize, level: f64) -> Option<usize> {
    // The toe is at twice the fall but for rounding.
    let level = level + 1e-12 * level.abs();
    let mut place = start;
    while place < down.len() {
        if place.is_multiple_of(BLOCK) && lowest[place / BLOCK] > level {
            place += BLOCK;
        } else if down[place][1] <= level {
            return Some(place);
        } else {
            place += 1;
        }
    }
    None
}
