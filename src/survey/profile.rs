//! The surface over a line: where the vertical plane through it meets the triangles.

use glam::{DVec2, DVec3};

use super::SurveyError;
use super::bridges::long;
use super::envelope::{Piece, upper_envelope};
use crate::geometry::Bounds;
use crate::surface::Surface;

/// A place of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfilePoint {
    /// Along the line, in plan, world units.
    pub distance: f64,
    /// On the surface, in the world.
    pub point: DVec3,
}

/// The surface over a line.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// The parts between the holes, in the order of the line: each at least two points, one at every
    /// edge that the line crosses, straight between them. Two at one distance are an upright face.
    pub runs: Vec<Vec<ProfilePoint>>,
    /// How long the line is in plan, world units.
    pub length: f64,
    /// The part of the line, 0 to 1, on triangles of a cloud that it is on for more than [`BRIDGE`](super::BRIDGE) times the median way: no points
    /// lie there. 0 of a mesh.
    pub bridged: f64,
}

impl Profile {
    /// The surface over the line through these places (x, y in the world). Of a mesh that overhangs
    /// the highest counts.
    ///
    /// # Errors
    /// Where the line has no length, and where the triangulation fails.
    pub fn along(surface: &Surface, line: &[DVec2]) -> Result<Self, SurveyError> {
        if let Some(place) = line.iter().position(|place| !place.is_finite()) {
            return Err(SurveyError::NotFinite(place + 1));
        }
        let frame = surface.frame();
        let origin = frame.origin().truncate();
        let mut profile = Self {
            runs: Vec::new(),
            length: 0.0,
            bridged: 0.0,
        };
        for ends in line.windows(2) {
            let &[from, to] = ends else {
                continue;
            };
            let way = to - from;
            let length = way.length();
            if length == 0.0 {
                continue;
            }
            let leg = Leg {
                from: from - origin,
                along: way / length,
                length,
            };
            let pieces = upper_envelope(leg.pieces(surface)?);
            let start = profile.length;
            let place = |[along, height]: [f64; 2]| ProfilePoint {
                distance: start + along,
                // The ends are what was asked for, to the last bit.
                point: match along {
                    0.0 => from.extend(height + frame.origin().z),
                    _ if along == length => to.extend(height + frame.origin().z),
                    _ => frame.world_from_local((leg.from + leg.along * along).extend(height)),
                },
            };
            for piece in pieces {
                profile.add(place(piece.from), place(piece.to));
            }
            profile.length += length;
        }
        if profile.length > 0.0 {
            if surface.is_cloud() {
                profile.bridged = profile.long_ways() / profile.length;
            }
            Ok(profile)
        } else {
            Err(SurveyError::NoLength)
        }
    }

    fn add(&mut self, from: ProfilePoint, to: ProfilePoint) {
        match self.runs.last_mut() {
            Some(run) if run.last().is_some_and(|end| end.distance == from.distance) => {
                // Both ends of an edge's crossing were computed from the same numbers; where the line
                // bends, from those of another plane.
                let size = from.point.abs().max_element().max(1.0);
                let same = |end: &ProfilePoint| (end.point.z - from.point.z).abs() <= 1e-12 * size;
                if !run.last().is_some_and(same) {
                    run.push(from);
                }
                run.push(to);
            }
            _ => self.runs.push(vec![from, to]),
        }
    }

    /// The sum of its ways over single triangles that bridge a hole.
    fn long_ways(&self) -> f64 {
        let pairs = self.runs.iter().flat_map(|run| run.windows(2));
        long(pairs.map(|pair| pair[1].distance - pair[0].distance))
    }

    /// All its points.
    pub fn points(&self) -> impl Iterator<Item = &ProfilePoint> {
        self.runs.iter().flatten()
    }

    /// The share of the line that has a surface under it, 0 to 1.
    pub fn covered(&self) -> f64 {
        let lengths = self.runs.iter().filter_map(|run| {
            let (first, last) = (run.first()?, run.last()?);
            Some(last.distance - first.distance)
        });
        (lengths.sum::<f64>() / self.length).min(1.0)
    }

    /// The lowest of its points, the first of equally low ones; `None` where there is no surface.
    pub fn lowest(&self) -> Option<&ProfilePoint> {
        self.points().min_by(|a, b| a.point.z.total_cmp(&b.point.z))
    }

    /// The highest of its points, its crest: the first of equally high ones; `None` where there is no
    /// surface.
    pub fn crest(&self) -> Option<&ProfilePoint> {
        // Of equal ones min_by takes the first.
        self.points().min_by(|a, b| b.point.z.total_cmp(&a.point.z))
    }
}

/// A straight part of the line, in the surface's local frame.
struct Leg {
    from: DVec2,
    along: DVec2,
    length: f64,
}

impl Leg {
    /// What the plane over it cuts out of the triangles.
    fn pieces(&self, surface: &Surface) -> Result<Vec<Piece>, SurveyError> {
        let misses = |bounds: &Bounds| self.misses(bounds);
        let mut pieces = Vec::new();
        for patch in surface.patches().seen(misses)? {
            pieces.extend(patch.triangles().filter_map(|corners| self.cut(corners)));
        }
        Ok(pieces)
    }

    /// On which side a place lies, and how far along.
    fn seen(&self, place: DVec2) -> (f64, f64) {
        let way = place - self.from;
        (self.along.perp_dot(way), self.along.dot(way))
    }

    /// Whether nothing in a box can be over the leg.
    fn misses(&self, bounds: &Bounds) -> bool {
        let (low, high) = (bounds.min.truncate(), bounds.max.truncate());
        let corners = [
            low,
            high,
            DVec2::new(low.x, high.y),
            DVec2::new(high.x, low.y),
        ];
        let seen = corners.map(|corner| self.seen(corner));
        seen.iter().all(|(side, _)| *side > 0.0)
            || seen.iter().all(|(side, _)| *side < 0.0)
            || seen.iter().all(|(_, along)| *along < 0.0)
            || seen.iter().all(|(_, along)| *along > self.length)
    }

    /// What the plane over the leg cuts out of a triangle; `None` where it meets no more than a corner.
    fn cut(&self, corners: [DVec3; 3]) -> Option<Piece> {
        let seen = corners.map(|corner| self.seen(corner.truncate()));
        if seen.iter().all(|(side, _)| *side > 0.0) || seen.iter().all(|(side, _)| *side < 0.0) {
            return None;
        }
        let mut ends: Option<[[f64; 2]; 2]> = None;
        let mut meet = |place: [f64; 2]| match &mut ends {
            None => ends = Some([place, place]),
            Some([low, high]) => {
                if place[0] < low[0] {
                    *low = place;
                }
                if place[0] > high[0] {
                    *high = place;
                }
            }
        };
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            // The triangle on the other side of the edge must find the same place, to the last bit.
            let order = |i: usize| (seen[i].0, seen[i].1, corners[i].z);
            let (a, b) = if order(a) <= order(b) { (a, b) } else { (b, a) };
            let ((side_a, along_a), (side_b, along_b)) = (seen[a], seen[b]);
            if side_a == 0.0 {
                meet([along_a, corners[a].z]);
            }
            if side_b == 0.0 {
                meet([along_b, corners[b].z]);
            }
            if side_a < 0.0 && side_b > 0.0 {
                let share = side_a / (side_a - side_b);
                let between = |a: f64, b: f64| a + (b - a) * share;
                meet([
                    between(along_a, along_b),
                    between(corners[a].z, corners[b].z),
                ]);
            }
        }
        let [low, high] = ends?;
        self.within(low, high)
    }

    /// The part of a piece that is over the leg, not over the line beyond its ends.
    fn within(&self, from: [f64; 2], to: [f64; 2]) -> Option<Piece> {
        let slope = (to[1] - from[1]) / (to[0] - from[0]);
        let at = |along: f64| [along, from[1] + slope * (along - from[0])];
        let low = if from[0] < 0.0 { at(0.0) } else { from };
        let high = if to[0] > self.length {
            at(self.length)
        } else {
            to
        };
        (low[0] < high[0]).then_some(Piece {
            from: low,
            to: high,
        })
    }
}
