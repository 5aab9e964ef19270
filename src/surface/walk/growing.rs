//! The triangulation of the sites near a trace, which grows by those that lie in the circles of its triangles.

use std::collections::HashSet;

use glam::{DVec2, DVec3};
use robust::{Coord, incircle};
use spade::handles::{DirectedEdgeHandle, FaceHandle, FixedVertexHandle, InnerTag};
use spade::{DelaunayTriangulation, Point2, PositionInTriangulation, Triangulation};

use crate::surface::SurfaceError;
use crate::surface::delaunay::{Site, load};
use crate::surface::sites::Sites;

/// How many of the sites found in a circle join at once: the nearest ones settle most circles.
const SITES_AT_ONCE: usize = 64;

/// With fewer sites than this, everything is built at the start: it takes a millisecond.
pub(in crate::surface) const FEW_SITES: usize = 1000;

pub(super) type Edge<'a> = DirectedEdgeHandle<'a, Site, (), (), ()>;
type Face<'a> = FaceHandle<'a, InnerTag, Site, (), (), ()>;
pub(super) type Triangle = [Site; 3];

/// As much of a Delaunay triangulation as rays have asked for.
#[derive(Debug)]
pub(super) struct Growing<'a> {
    pub(super) sites: &'a Sites,
    /// Of some of the sites, their whole hull among them.
    pub(super) triangulation: DelaunayTriangulation<Site>,
    /// The cells whose sites are all in it.
    joined: HashSet<usize>,
    /// Whether all sites are in it: then no circle needs a look.
    complete: bool,
    /// Where the next insertion begins its search.
    hint: Option<FixedVertexHandle>,
}

/// What became of the sites in circles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Joined {
    /// Some joined.
    Some,
    /// There were none.
    None,
    /// There were none inside, but others than the corners on them: there are several triangulations.
    NoneButOnCircles,
}

/// What lies in the circle of a triangle.
pub(super) struct InCircle {
    /// Sites inside it.
    pub(super) inside: Vec<DVec3>,
    /// Others than its corners on it.
    pub(super) on: Vec<DVec3>,
}

impl<'a> Growing<'a> {
    /// # Errors
    /// Where a coordinate is too large for exact predicates.
    pub(super) fn new(sites: &'a Sites) -> Result<Self, SurfaceError> {
        let complete = !sites.is_part() && sites.points().len() <= FEW_SITES;
        Ok(Self {
            sites,
            triangulation: load(if complete {
                sites.points()
            } else {
                sites.hull()
            })?,
            joined: HashSet::new(),
            complete,
            hint: None,
        })
    }

    /// The surface's height at a place, or `None` outside.
    pub(super) fn height_at(&self, place: DVec2) -> Option<f64> {
        match self.triangulation.locate(spade_point(place)) {
            PositionInTriangulation::OnFace(face) => {
                let [a, b, c] = corners(self.triangulation.face(face));
                let normal = (b - a).cross(c - a);
                let offset = place - a.truncate();
                Some(a.z - normal.truncate().dot(offset) / normal.z)
            }
            PositionInTriangulation::OnEdge(edge) => {
                let edge = self.triangulation.directed_edge(edge);
                let (a, b) = (edge.from().data().point(), edge.to().data().point());
                let (a, b) = match is_before(b, a) {
                    true => (b, a),
                    false => (a, b),
                };
                let way = (b - a).truncate();
                let share = (place - a.truncate()).dot(way) / way.length_squared();
                Some(a.z + (b.z - a.z) * share)
            }
            PositionInTriangulation::OnVertex(vertex) => {
                Some(self.triangulation.vertex(vertex).data().z)
            }
            _ => None,
        }
    }

    /// The triangle at a place; two on an edge; at a vertex all around it.
    pub(super) fn triangles_at(&self, place: DVec2) -> Vec<Triangle> {
        match self.triangulation.locate(spade_point(place)) {
            PositionInTriangulation::OnFace(face) => {
                let corners = self.triangulation.face(face).vertices();
                vec![first_first(corners.map(|vertex| *vertex.data()))]
            }
            PositionInTriangulation::OnEdge(edge) => {
                let edge = self.triangulation.directed_edge(edge);
                in_order([triangle(edge), triangle(edge.rev())].into_iter().flatten())
            }
            PositionInTriangulation::OnVertex(vertex) => in_order(
                self.triangulation
                    .vertex(vertex)
                    .out_edges()
                    .filter_map(triangle),
            ),
            _ => Vec::new(),
        }
    }

    /// Adds the sites of the cells along a segment.
    pub(super) fn join_cells(&mut self, from: DVec2, to: DVec2) {
        if self.complete {
            return;
        }
        for cell in self.sites.cells_along(from, to) {
            if self.joined.insert(cell) {
                for &point in self.sites.in_cell(cell) {
                    self.join(point);
                }
            }
        }
    }

    /// Adds sites that lie inside the circumcircles of these triangles.
    pub(super) fn join_sites_inside(&mut self, triangles: &[Triangle]) -> Joined {
        if self.complete && self.sites.points().len() <= FEW_SITES {
            // One triangulation of all of them, made of nothing else.
            return Joined::None;
        }
        let (mut inside, mut on_circles) = (Vec::new(), false);
        for triangle in triangles {
            let found = self.in_circle(triangle);
            on_circles |= !found.on.is_empty();
            inside.extend(found.inside);
        }
        for &point in &inside {
            self.join(point);
        }
        if !self.complete
            && !self.sites.is_part()
            && self.triangulation.num_vertices() * 2 > self.sites.points().len()
            && let Ok(whole) = load(self.sites.points())
        {
            self.triangulation = whole;
            self.hint = None;
            self.complete = true;
            return Joined::Some;
        }
        match (inside.is_empty(), on_circles) {
            (false, _) => Joined::Some,
            (true, true) => Joined::NoneButOnCircles,
            (true, false) => Joined::None,
        }
    }

    /// The sites strictly inside the circumcircle of a triangle, of many those nearest to its
    /// middle; and those on it, its corners left out.
    pub(super) fn in_circle(&self, triangle: &Triangle) -> InCircle {
        let [a, b, c] = triangle.map(|site| site.point().truncate());
        let (ab, ac) = (b - a, c - a);
        let to_center = (ab.length_squared() * ac.perp() - ac.length_squared() * ab.perp())
            / (-2.0 * ab.perp_dot(ac));
        let (center, radius_squared) = (a + to_center, to_center.length_squared());
        let radius = radius_squared.sqrt();
        let coord = |p: DVec2| Coord { x: p.x, y: p.y };
        let (mut inside, mut on) = (Vec::new(), Vec::new());
        self.sites.near_disc(center, radius, |_, site| {
            let place = site.truncate();
            // Clearly outside; NaN, of a circle too large for f64, is left to the predicate.
            if place.distance_squared(center) > radius_squared * (1.0 + 1e-6)
                || [a, b, c].contains(&place)
            {
                return;
            }
            let found = incircle(coord(a), coord(b), coord(c), coord(place));
            if found > 0.0 {
                inside.push(*site);
            } else if found == 0.0 {
                on.push(*site);
            }
        });
        if inside.is_empty() {
            self.sites.want_disc(center, radius);
        }
        let middle = (a + b + c) / 3.0;
        if inside.len() > SITES_AT_ONCE {
            inside.select_nth_unstable_by(SITES_AT_ONCE, |p, q| {
                let distance = |p: &DVec3| p.truncate().distance_squared(middle);
                distance(p).total_cmp(&distance(q))
            });
            inside.truncate(SITES_AT_ONCE);
        }
        InCircle { inside, on }
    }

    /// How many sites have been triangulated so far.
    #[cfg(test)]
    pub(super) fn vertex_count(&self) -> usize {
        self.triangulation.num_vertices()
    }

    fn join(&mut self, point: DVec3) {
        let site = Site::new(point, 0);
        let inserted = match self.hint {
            Some(hint) => self.triangulation.insert_with_hint(site, hint),
            None => self.triangulation.insert(site),
        };
        // It cannot fail: the hull, which bounds every coordinate, went in before.
        self.hint = inserted.ok();
    }
}

/// A place as the triangulation takes it.
pub(super) fn spade_point(place: DVec2) -> Point2<f64> {
    Point2::new(
        spade::mitigate_underflow(Point2::new(place.x, 0.0)).x,
        spade::mitigate_underflow(Point2::new(0.0, place.y)).y,
    )
}

/// The triangle on the left of an edge, or `None` outside of the hull.
pub(super) fn triangle(edge: Edge<'_>) -> Option<Triangle> {
    let corners = edge.face().as_inner()?.vertices();
    Some(first_first(corners.map(|vertex| *vertex.data())))
}

fn corners(face: Face<'_>) -> [DVec3; 3] {
    first_first(face.vertices().map(|vertex| *vertex.data())).map(|site| site.point())
}

/// Whether a place comes before another one, by (x, y).
fn is_before(a: DVec3, b: DVec3) -> bool {
    (a.x, a.y) < (b.x, b.y)
}

/// The same triangle with its first corner, by (x, y), first: the same products whichever way it was found.
fn first_first([a, b, c]: Triangle) -> Triangle {
    let [at_a, at_b, at_c] = [a, b, c].map(|site| site.point());
    if is_before(at_a, at_b) && is_before(at_a, at_c) {
        [a, b, c]
    } else if is_before(at_b, at_c) {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Triangles sorted by their corners.
fn in_order(triangles: impl Iterator<Item = Triangle>) -> Vec<Triangle> {
    let mut triangles: Vec<Triangle> = triangles.collect();
    triangles.sort_by(|a, b| {
        let places = a.iter().zip(b).map(|(a, b)| {
            let (a, b) = (a.point(), b.point());
            a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
        });
        places
            .reduce(std::cmp::Ordering::then)
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    triangles
}
