//! Rays on a triangulated cloud, without triangulating the cloud.
//!
//! A photo needs four rays, a flight a few dozen; each passes a few dozen triangles of the millions
//! that a cloud has. A triangle belongs to the Delaunay triangulation of all sites if and only if
//! its circumcircle holds none of them inside. So: triangulate the sites near the ray's trace
//! (together with the convex hull of all, which settles where the surface ends), walk along the
//! trace, and look into the circle of each triangle that the walk passes. A site found inside joins
//! the triangulation, and the walk begins anew. What the walk has passed in the end are triangles
//! of the whole triangulation, exactly (the predicates are), and the rest was never built. Where so
//! many sites have joined that building everything is cheaper, everything is built.
//!
//! On the walk the ray is no longer met with triangles one by one: between the stops (crossed
//! edges, touched vertices) the height of the ray above the surface is a continuous, piecewise
//! linear function, and where it changes its sign the ray meets the surface. So no ray can slip
//! through an edge or a vertex.
//!
//! What a ray meets does not depend on which rays were cast before: a triangle is read from its first corner in the
//! order of (x, y), and where four or more sites share the circle of a triangle that was passed (a lattice is made of
//! such), so that there are several triangulations, the ray meets the fan that the tiles have there (`tiles`), triangle
//! by triangle. Of a part of the sites (`sites::held`) only the last look into a circle needs all that it could
//! find: it asks for what is not here.
//!
//! Where long triangles do not count, the walk passes them like all others and meets nothing there,
//! unless a short one at the rim of the hole is near enough to be met.

use glam::{DVec2, DVec3};
use robust::{Coord, incircle, orient2d};
use spade::handles::{DirectedEdgeHandle, FaceHandle, InnerTag};
use spade::{
    DelaunayTriangulation, Intersection, LineIntersectionIterator, Point2, PositionInTriangulation,
    Triangulation,
};

use super::delaunay::{Site, load};
use super::mesh::Sheared;
use super::sites::Sites;
use super::{Met, SurfaceError, longest_edge};
use crate::geometry::Ray;
use std::collections::HashSet;

/// How many of the sites found in a circle join at once: the nearest ones settle most circles.
const SITES_AT_ONCE: usize = 64;

/// With fewer sites than this, everything is built at the start: it takes a millisecond.
pub(super) const FEW_SITES: usize = 1000;

type Edge<'a> = DirectedEdgeHandle<'a, Site, (), (), ()>;
type Face<'a> = FaceHandle<'a, InnerTag, Site, (), (), ()>;
type Triangle = [Site; 3];

/// Casts rays at sites, building as much of their triangulation as the rays ask for.
#[derive(Debug)]
pub(super) struct Walk<'a> {
    sites: &'a Sites,
    /// Triangles with a longer edge do not count.
    max_edge: f64,
    /// Delaunay, of some of the sites, their whole hull among them.
    built: DelaunayTriangulation<Site>,
    /// The cells whose sites are all in `built`.
    joined: HashSet<usize>,
    /// Whether all sites are in `built`: then no circle needs a look.
    complete: bool,
    /// Where the next insertion begins its search.
    hint: Option<spade::handles::FixedVertexHandle>,
}

/// A point of the trace at which the surface's height is known.
#[derive(Debug, Clone, Copy)]
struct Stop {
    /// Along the ray.
    t: f64,
    /// Height of the ray above the surface there.
    above: f64,
}

/// What became of the sites in circles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Joined {
    /// Some joined.
    Some,
    /// There were none.
    None,
    /// There were none inside, but others than the corners on them: there are several triangulations.
    NoneButOnCircles,
}

/// What lies in the circle of a triangle.
struct InCircle {
    /// Sites inside it.
    inside: Vec<DVec3>,
    /// Others than its corners on it.
    on: Vec<DVec3>,
}

/// The way between two neighbouring stops, inside one triangle or along an edge.
#[derive(Debug, Clone, Copy)]
struct Piece {
    from: Stop,
    to: Stop,
    /// The triangle, or the one or two at the edge.
    triangles: [Option<Triangle>; 2],
}

impl<'a> Walk<'a> {
    /// Makes ready for rays.
    ///
    /// # Errors
    /// Where a coordinate is too large for exact predicates.
    pub(super) fn new(sites: &'a Sites, max_edge: f64) -> Result<Self, SurfaceError> {
        let complete = !sites.is_part() && sites.points().len() <= FEW_SITES;
        Ok(Self {
            sites,
            max_edge,
            built: load(if complete {
                sites.points()
            } else {
                sites.hull()
            })?,
            joined: HashSet::new(),
            complete,
            hint: None,
        })
    }

    /// Where the ray (local frame) meets the surface first. `slack` is a distance in the order of
    /// the rounding of the coordinates: a ray that misses the surface's rim by less meets it.
    pub(super) fn cast(&mut self, ray: &Ray, slack: f64) -> Option<Met> {
        if let Some(met) = self.cast_once(ray, slack) {
            return Some(met);
        }
        // The surface is convex over (x, y): moved inward by the slack at the place where its trace
        // passes the rim, a ray that missed by less is met.
        let middle = self.sites.bounds().center().truncate();
        self.rim_places(ray, middle).into_iter().find_map(|place| {
            let inward = (middle - place).try_normalize()? * slack;
            let nudged = Ray {
                origin: ray.origin + inward.extend(0.0),
                ..*ray
            };
            self.cast_once(&nudged, slack)
        })
    }

    /// Where the ray's trace enters and leaves the hull, or comes nearest to its `middle` where it
    /// passes outside.
    fn rim_places(&self, ray: &Ray, middle: DVec2) -> Vec<DVec2> {
        let Some((start, end)) = self.span(ray) else {
            return Vec::new();
        };
        let (from, to) = (ray.at(start).truncate(), ray.at(end).truncate());
        let trace = to - from;
        let hull = self.sites.hull();
        let mut places: Vec<(f64, DVec2)> = Vec::new();
        for (&a, &b) in hull.iter().zip(hull.iter().cycle().skip(1)) {
            let [at_a, at_b] = [a, b].map(|corner| trace.perp_dot(corner.truncate() - from));
            if (at_a > 0.0 && at_b > 0.0) || (at_a < 0.0 && at_b < 0.0) {
                continue;
            }
            let ends = match at_a == at_b {
                true => vec![a, b],
                false => vec![a.lerp(b, (at_a / (at_a - at_b)).clamp(0.0, 1.0))],
            };
            for place in ends {
                let place = place.truncate();
                let share = (place - from).dot(trace) / trace.length_squared();
                if (0.0..=1.0).contains(&share) {
                    places.push((share, place));
                }
            }
        }
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (first, last) = (places.first(), places.last());
        let (first, last) = (first.map(|first| first.1), last.map(|last| last.1));
        match (first, last) {
            (Some(first), Some(last)) => vec![first, last],
            _ => {
                let share = (middle - from).dot(trace) / trace.length_squared();
                let share = if share.is_finite() {
                    share.clamp(0.0, 1.0)
                } else {
                    0.0
                };
                vec![from + trace * share]
            }
        }
    }

    fn cast_once(&mut self, ray: &Ray, slack: f64) -> Option<Met> {
        let (start, end) = self.span(ray)?;
        let (from, to) = (ray.at(start).truncate(), ray.at(end).truncate());
        if !self.sites.want_along(from, to) {
            return None;
        }
        if !self.complete {
            self.join_cells(from, to);
        }
        // Steeper than this, places along the trace say too little about places along the ray.
        let drop = (ray.at(end).z - ray.at(start).z).abs();
        let plumb = from.distance(to) <= 1e-7 * drop;
        let mut by_fans = false;
        loop {
            let (met, passed) = match (plumb, by_fans) {
                (true, false) => self.drop_down(ray, from, slack),
                (false, false) => self.walk_along(ray, start, end, slack),
                (true, true) => self.drop_on_fans(ray, from, slack),
                (false, true) => self.walk_on_fans(ray, start, end, slack),
            };
            match self.join_sites_inside(&passed) {
                Joined::Some => {}
                Joined::NoneButOnCircles if !by_fans => by_fans = true,
                Joined::NoneButOnCircles | Joined::None => return met,
            }
        }
    }

    /// As [`Self::drop_down`], on the fans.
    fn drop_on_fans(&self, ray: &Ray, at: DVec2, slack: f64) -> (Option<Met>, Vec<Triangle>) {
        // The ray may lean by 1e-7 of the heights that it passes: the place where it meets is near.
        let (_, mut passed) = self.drop_down(ray, at, slack);
        passed.extend(self.triangles_at(at));
        let met = self.meet_fans(&Sheared::new(ray), &passed, slack);
        (met, passed)
    }

    /// As [`Self::walk_along`], on the fans.
    fn walk_on_fans(
        &self,
        ray: &Ray,
        start: f64,
        end: f64,
        slack: f64,
    ) -> (Option<Met>, Vec<Triangle>) {
        let sheared = Sheared::new(ray);
        let (mut met, mut passed): (Option<Met>, Vec<Triangle>) = (None, Vec::new());
        for piece in self.pieces(ray, start, end) {
            let mut there: Vec<Triangle> = piece.triangles.into_iter().flatten().collect();
            if !self.counts(&there) {
                // A short one at the rim of a hole may be near enough.
                self.add_around(&mut there);
            }
            met = nearer(met, self.meet_fans(&sheared, &there, slack));
            passed.extend(there);
            if met.is_some_and(|met| met.t <= piece.to.t) {
                break;
            }
        }
        (met, passed)
    }

    /// Where a ray meets the fans of these triangles.
    fn meet_fans(&self, ray: &Sheared, triangles: &[Triangle], slack: f64) -> Option<Met> {
        let fans = triangles.iter().flat_map(|triangle| self.fan(triangle));
        let met = fans.filter_map(|corners| {
            let longest_edge = longest_edge(corners);
            let t = (longest_edge <= self.max_edge).then(|| ray.meet(corners, slack));
            Some(Met {
                t: t??,
                longest_edge,
            })
        });
        met.min_by(first)
    }

    /// The fan of all sites on the circle of a triangle, as the tiles have it: around the first of them. Of three
    /// sites it is the triangle.
    fn fan(&self, triangle: &Triangle) -> Vec<[DVec3; 3]> {
        let corners = triangle.map(|site| site.point());
        let mut on_circle = corners.to_vec();
        on_circle.extend(self.in_circle(triangle).on);
        let order = |a: &DVec3, b: &DVec3| {
            let [cell_a, cell_b] = [a, b].map(|site| self.sites.cell_at(site.truncate()));
            let places = a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y));
            cell_a.cmp(&cell_b).then(places)
        };
        on_circle.sort_by(order);
        let Some((apex, rest)) = on_circle.split_first_mut() else {
            return Vec::new();
        };
        let apex = *apex;
        let coord = |p: DVec3| Coord { x: p.x, y: p.y };
        // Seen from one of them, the others of a circle lie within half a turn.
        rest.sort_by(|a, b| {
            let turn = orient2d(coord(apex), coord(*a), coord(*b));
            0.0_f64.total_cmp(&turn)
        });
        let edges = rest.windows(2);
        edges.map(|edge| [apex, edge[0], edge[1]]).collect()
    }

    /// The part of the ray (t >= 0) in the box around the sites, which is widened a little.
    fn span(&self, ray: &Ray) -> Option<(f64, f64)> {
        let bounds = self.sites.bounds();
        let room = bounds.size().max_element() * 1e-6;
        let (mut start, mut end) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            let (low, high) = (bounds.min[axis] - room, bounds.max[axis] + room);
            if direction == 0.0 {
                if origin < low || origin > high {
                    return None;
                }
            } else {
                let (a, b) = ((low - origin) / direction, (high - origin) / direction);
                start = start.max(a.min(b));
                end = end.min(a.max(b));
            }
        }
        (start <= end && end.is_finite()).then_some((start, end))
    }

    /// Meets a plumb ray at the surface's height at its place; returns the triangles there, too.
    fn drop_down(&self, ray: &Ray, at: DVec2, slack: f64) -> (Option<Met>, Vec<Triangle>) {
        let mut at = at;
        let mut passed = Vec::new();
        let mut hit = None;
        // The ray may lean by 1e-7: two corrections leave 1e-21.
        for _ in 0..3 {
            passed = self.triangles_at(at);
            let Some(z) = self.height_at(at) else {
                return (None, passed);
            };
            let t = (z - ray.origin.z) / ray.direction.z;
            hit = (t > 0.0).then_some(t);
            at = ray.at(t).truncate();
        }
        let met = if self.counts(&passed) {
            hit.map(|t| met(t, &passed))
        } else {
            self.meet_rim(ray, slack, &mut passed)
        };
        (met, passed)
    }

    /// Follows the ray's trace to the first change of sign; returns where that is, and the
    /// triangles up to there.
    fn walk_along(
        &self,
        ray: &Ray,
        start: f64,
        end: f64,
        slack: f64,
    ) -> (Option<Met>, Vec<Triangle>) {
        let mut passed = Vec::new();
        // A ray aimed exactly at a ridge that hides what lies behind touches it, or passes it by
        // less than the slack: that is a hit as well, unless the ray goes through next to it.
        let mut touched = None;
        // What is met at the rim of a hole may lie behind what the next pieces meet.
        let mut rim: Option<Met> = None;
        let touches = |stop: Stop| (stop.above.abs() <= slack && stop.t > 0.0).then_some(stop.t);
        for piece in self.pieces(ray, start, end) {
            let Piece { from, to, .. } = piece;
            if rim.is_some_and(|met| met.t < from.t) {
                break;
            }
            let there: Vec<Triangle> = piece.triangles.into_iter().flatten().collect();
            passed.extend(&there);
            let through =
                from.above == 0.0 || to.above == 0.0 || (from.above > 0.0) != (to.above > 0.0);
            if !self.counts(&there) {
                if touched.is_some() {
                    break;
                }
                if through || touches(from).is_some() || touches(to).is_some() {
                    let mut around = there;
                    rim = nearer(rim, self.meet_rim(ray, slack, &mut around));
                    passed.extend(around);
                }
                continue;
            }
            if touched.is_none() {
                touched = touches(from).map(|t| met(t, &there));
            }
            // A ray that lies in a triangle's plane meets it where it enters.
            let within = touched.is_some() && touches(to).is_some();
            if (within || !through) && touched.is_some() {
                break;
            }
            if through {
                let t = piece.meet(ray);
                if t > 0.0 {
                    touched = Some(met(t, &there));
                    break;
                }
            }
            touched = touches(to).map(|t| met(t, &there));
        }
        (nearer(rim, touched), passed)
    }

    /// Whether one of these triangles is short enough to belong to the surface.
    fn counts(&self, triangles: &[Triangle]) -> bool {
        self.max_edge == f64::INFINITY
            || triangles
                .iter()
                .any(|triangle| size_of(triangle) <= self.max_edge)
    }

    /// Where the ray meets a triangle that counts and shares a corner with one of those in the hole
    /// around it, which the other ones are added to.
    fn meet_rim(&self, ray: &Ray, slack: f64, hole: &mut Vec<Triangle>) -> Option<Met> {
        self.add_around(hole);
        let sheared = Sheared::new(ray);
        hole.iter()
            .filter(|triangle| size_of(triangle) <= self.max_edge)
            .filter_map(|triangle| {
                let t = sheared.meet(triangle.map(|site| site.point()), slack)?;
                Some(met(t, std::slice::from_ref(triangle)))
            })
            .min_by(first)
    }

    /// Adds the triangles at the corners of these.
    fn add_around(&self, triangles: &mut Vec<Triangle>) {
        let sites = triangles.iter().flatten();
        let corners: Vec<DVec2> = sites.map(|site| site.point().truncate()).collect();
        for corner in corners {
            triangles.extend(self.triangles_at(corner));
        }
    }

    /// The pieces of the trace that lie on the surface built so far, in order.
    fn pieces(&self, ray: &Ray, start: f64, end: f64) -> Vec<Piece> {
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
        if let Some(z) = self.height_at(from) {
            let there = self.triangles_at(from);
            // Strictly inside one triangle the walk goes on in it; from an edge or a vertex the
            // next stop tells.
            let after = match there[..] {
                [one] => [Some(one), None],
                _ => [None; 2],
            };
            arrive(stop(from, z), [None; 2], after, &mut along_edge);
        }
        for event in LineIntersectionIterator::new(&self.built, spade_point(from), spade_point(to))
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
        if let Some(z) = self.height_at(to) {
            let before = match self.triangles_at(to)[..] {
                [one] => [Some(one), None],
                _ => [None; 2],
            };
            arrive(stop(to, z), before, [None; 2], &mut along_edge);
        }
        // From an edge to the opposite vertex no stop has told.
        for piece in &mut pieces {
            if piece.triangles[0].is_none() && piece.triangles[1].is_none() {
                let middle = ray.at(f64::midpoint(piece.from.t, piece.to.t));
                let there = self.triangles_at(middle.truncate());
                piece.triangles = [there.first().copied(), there.get(1).copied()];
            }
        }
        pieces
    }

    /// The surface's height at a place, or `None` outside.
    fn height_at(&self, place: DVec2) -> Option<f64> {
        match self.built.locate(spade_point(place)) {
            PositionInTriangulation::OnFace(face) => {
                let [a, b, c] = corners(self.built.face(face));
                let normal = (b - a).cross(c - a);
                let offset = place - a.truncate();
                Some(a.z - normal.truncate().dot(offset) / normal.z)
            }
            PositionInTriangulation::OnEdge(edge) => {
                let edge = self.built.directed_edge(edge);
                let (a, b) = (edge.from().data().point(), edge.to().data().point());
                let (a, b) = match is_before(b, a) {
                    true => (b, a),
                    false => (a, b),
                };
                let way = (b - a).truncate();
                let share = (place - a.truncate()).dot(way) / way.length_squared();
                Some(a.z + (b.z - a.z) * share)
            }
            PositionInTriangulation::OnVertex(vertex) => Some(self.built.vertex(vertex).data().z),
            _ => None,
        }
    }

    /// The triangle at a place; two on an edge; at a vertex all around it.
    fn triangles_at(&self, place: DVec2) -> Vec<Triangle> {
        match self.built.locate(spade_point(place)) {
            PositionInTriangulation::OnFace(face) => {
                let corners = self.built.face(face).vertices();
                vec![first_first(corners.map(|vertex| *vertex.data()))]
            }
            PositionInTriangulation::OnEdge(edge) => {
                let edge = self.built.directed_edge(edge);
                in_order([triangle(edge), triangle(edge.rev())].into_iter().flatten())
            }
            PositionInTriangulation::OnVertex(vertex) => {
                in_order(self.built.vertex(vertex).out_edges().filter_map(triangle))
            }
            _ => Vec::new(),
        }
    }

    /// Adds the sites of the cells along a segment.
    fn join_cells(&mut self, from: DVec2, to: DVec2) {
        for cell in self.sites.cells_along(from, to) {
            if self.joined.insert(cell) {
                for &point in self.sites.in_cell(cell) {
                    self.join(point);
                }
            }
        }
    }

    /// Adds sites that lie inside the circumcircles of these triangles.
    fn join_sites_inside(&mut self, triangles: &[Triangle]) -> Joined {
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
            && self.built.num_vertices() * 2 > self.sites.points().len()
            && let Ok(whole) = load(self.sites.points())
        {
            self.built = whole;
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
    fn in_circle(&self, triangle: &Triangle) -> InCircle {
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
        self.built.num_vertices()
    }

    fn join(&mut self, point: DVec3) {
        let site = Site::new(point, 0);
        let inserted = match self.hint {
            Some(hint) => self.built.insert_with_hint(site, hint),
            None => self.built.insert(site),
        };
        // It cannot fail: the hull, which bounds every coordinate, went in before.
        self.hint = inserted.ok();
    }
}

impl Piece {
    /// Where the ray meets the surface on this piece, whose ends lie on different sides of it.
    fn meet(&self, ray: &Ray) -> f64 {
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

/// Meeting a place where these triangles are.
fn met(t: f64, there: &[Triangle]) -> Met {
    let sizes = there.iter().map(size_of);
    Met {
        t,
        longest_edge: sizes.min_by(f64::total_cmp).unwrap_or(0.0),
    }
}

fn nearer(a: Option<Met>, b: Option<Met>) -> Option<Met> {
    a.into_iter().chain(b).min_by(first)
}

/// Which of two is met first; on an edge, of two triangles the smaller one.
fn first(a: &Met, b: &Met) -> std::cmp::Ordering {
    (a.t.total_cmp(&b.t)).then(a.longest_edge.total_cmp(&b.longest_edge))
}

/// The longest edge of a triangle.
fn size_of(triangle: &Triangle) -> f64 {
    longest_edge(triangle.map(|site| site.point()))
}

fn spade_point(place: DVec2) -> Point2<f64> {
    Point2::new(
        spade::mitigate_underflow(Point2::new(place.x, 0.0)).x,
        spade::mitigate_underflow(Point2::new(0.0, place.y)).y,
    )
}

/// The triangle on the left of an edge, or `None` outside of the hull.
fn triangle(edge: Edge<'_>) -> Option<Triangle> {
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
