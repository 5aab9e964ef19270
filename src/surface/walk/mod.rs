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

mod fans;
mod growing;
mod pieces;

pub(super) use self::growing::FEW_SITES;

use glam::DVec2;

use self::growing::{Growing, Joined, Triangle};
use self::pieces::{Piece, Stop, pieces};
use super::mesh::Sheared;
use super::sites::Sites;
use super::{Met, SurfaceError, longest_edge};
use crate::geometry::Ray;

/// Casts rays at sites, building as much of their triangulation as the rays ask for.
#[derive(Debug)]
pub(super) struct Walk<'a> {
    built: Growing<'a>,
    /// Triangles with a longer edge do not count.
    max_edge: f64,
}

impl<'a> Walk<'a> {
    /// Makes ready for rays.
    ///
    /// # Errors
    /// Where a coordinate is too large for exact predicates.
    pub(super) fn new(sites: &'a Sites, max_edge: f64) -> Result<Self, SurfaceError> {
        Ok(Self {
            built: Growing::new(sites)?,
            max_edge,
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
        let middle = self.built.sites.bounds().center().truncate();
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
        let hull = self.built.sites.hull();
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
        if !self.built.sites.want_along(from, to) {
            return None;
        }
        self.built.join_cells(from, to);
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
            match self.built.join_sites_inside(&passed) {
                Joined::Some => {}
                Joined::NoneButOnCircles if !by_fans => by_fans = true,
                Joined::NoneButOnCircles | Joined::None => return met,
            }
        }
    }

    /// The part of the ray (t >= 0) in the box around the sites, which is widened a little.
    fn span(&self, ray: &Ray) -> Option<(f64, f64)> {
        let bounds = self.built.sites.bounds();
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
            passed = self.built.triangles_at(at);
            let Some(z) = self.built.height_at(at) else {
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
        for piece in pieces(&self.built, ray, start, end) {
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
            triangles.extend(self.built.triangles_at(corner));
        }
    }

    /// How many sites have been triangulated so far.
    #[cfg(test)]
    pub(super) fn vertex_count(&self) -> usize {
        self.built.vertex_count()
    }
}

/// Meeting a place where these triangles are.
fn met(t: f64, there: &[Triangle]) -> Met {
    let sizes = there.iter().map(size_of);
    Met {
        t,
        longest_edge: sizes.min_by(f64::total_cmp).unwrap_or(0.0),
        is_from_behind: false,
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
