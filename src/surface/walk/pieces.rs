//! The trace of a ray on the surface, piece by piece: from one crossed edge or touched vertex to the next.

use glam::{DVec2, DVec3};
use spade::{Intersection, LineIntersectionIterator};

use super::growing::{Edge, Growing, Triangle, spade_point, triangle};
use crate::geometry::Ray;

/// A point of the trace at which the surface's height is known.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stop {
    /// Along the ray.
    pub(super) t: f64,
    /// Height of the ray above the surface there.
    pub(super) above: f64,
}

/// The way between two neighbouring stops, inside one triangle or along an edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Piece {
    pub(super) from: Stop,
    pub(super) to: Stop,
    /// The triangle, or the one or two at the edge.
    pub(super) triangles: [Option<Triangle>; 2],
}

impl Piece {
    /// Where the ray meets the surface on this piece, whose ends lie on different sides of it.
    pub(super) fn meet(&self, ray: &Ray) -> f64 {
        let (from, to) = (self.from, self.to);
        if from.above == to.above {
            return from.t;
        }
        let between = from.t + (to.t - from.t) * (from.above / (from.above - to.above));
        // Through the triangle's plane the rounding of the stops does not matter; where the ray
        // grazes the plane, the stops are what can be trusted.
        let Some([a, b, c]) = self.triangles.into_iter().flatten().next() else {
            return between;
        };
        let [a, b, c] = [a.point(), b.point(), c.point()];
        let normal = (b - a).cross(c - a);
        let through_plane = (a - ray.origin).dot(normal) / ray.direction.dot(normal);
        let room = (to.t - from.t) * 1e-6;
        if (from.t - room..=to.t + room).contains(&through_plane) {
            through_plane
        } else {
            between
        }
    }
}

/// The pieces of the trace that lie on the surface built so far, in order.
pub(super) fn pieces(built: &Growing<'_>, ray: &Ray, start: f64, end: f64) -> Vec<Piece> {
    let (from, to) = (ray.at(start).truncate(), ray.at(end).truncate());
    let trace = to - from;
    let stop = |place: DVec2, z: f64| {
        let share = (place - from).dot(trace) / trace.length_squared();
        let t = start + (end - start) * share;
        Stop {
            t,
            above: ray.at(t).z - z,
        }
    };
    let mut pieces: Vec<Piece> = Vec::new();
    let mut last: Option<(Stop, [Option<Triangle>; 2])> = None;
    let mut along_edge: Option<[Option<Triangle>; 2]> = None;
    let mut arrive = |stop: Stop,
                      before: [Option<Triangle>; 2],
                      after: [Option<Triangle>; 2],
                      along_edge: &mut Option<[Option<Triangle>; 2]>| {
        if let Some((from, from_after)) = last {
            let inside = if from_after[0].is_some() {
                from_after
            } else {
                before
            };
            pieces.push(Piece {
                from,
                to: stop,
                triangles: along_edge.take().unwrap_or(inside),
            });
        }
        last = Some((stop, after));
    };
    if let Some(z) = built.height_at(from) {
        let there = built.triangles_at(from);
        // Strictly inside one triangle the walk goes on in it; from an edge or a vertex the
        // next stop tells.
        let after = match there[..] {
            [one] => [Some(one), None],
            _ => [None; 2],
        };
        arrive(stop(from, z), [None; 2], after, &mut along_edge);
    }
    for event in
        LineIntersectionIterator::new(&built.triangulation, spade_point(from), spade_point(to))
    {
        match event {
            Intersection::EdgeIntersection(edge) => {
                let (place, z) = crossing(edge, from, trace);
                let before = [triangle(edge.rev()), None];
                let after = [triangle(edge), None];
                arrive(stop(place, z), before, after, &mut along_edge);
            }
            Intersection::VertexIntersection(vertex) => {
                let point = vertex.data().point();
                arrive(
                    stop(point.truncate(), point.z),
                    [None; 2],
                    [None; 2],
                    &mut along_edge,
                );
            }
            Intersection::EdgeOverlap(edge) => {
                along_edge = Some([triangle(edge), triangle(edge.rev())]);
            }
        }
    }
    if let Some(z) = built.height_at(to) {
        let before = match built.triangles_at(to)[..] {
            [one] => [Some(one), None],
            _ => [None; 2],
        };
        arrive(stop(to, z), before, [None; 2], &mut along_edge);
    }
    // From an edge to the opposite vertex no stop has told.
    for piece in &mut pieces {
        if piece.triangles[0].is_none() && piece.triangles[1].is_none() {
            let middle = ray.at(f64::midpoint(piece.from.t, piece.to.t));
            let there = built.triangles_at(middle.truncate());
            piece.triangles = [there.first().copied(), there.get(1).copied()];
        }
    }
    pieces
}

/// Where the trace crosses an edge, and the surface's height there.
fn crossing(edge: Edge<'_>, from: DVec2, trace: DVec2) -> (DVec2, f64) {
    let (a, b) = (edge.from().data().point(), edge.to().data().point());
    let side = |p: DVec3| trace.perp_dot(p.truncate() - from);
    let (at_a, at_b) = (side(a), side(b));
    let share = if at_a == at_b {
        0.5
    } else {
        (at_a / (at_a - at_b)).clamp(0.0, 1.0)
    };
    let place = a.lerp(b, share);
    (place.truncate(), place.z)
}
