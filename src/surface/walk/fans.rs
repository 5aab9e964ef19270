//! Where four or more sites share a circle there are several triangulations: there a ray meets the fan that the tiles
//! have (`tiles`), triangle by triangle.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

use super::growing::Triangle;
use super::pieces::pieces;
use super::{Walk, first, nearer};
use crate::geometry::Ray;
use crate::surface::mesh::Sheared;
use crate::surface::{Met, longest_edge};

impl Walk<'_> {
    /// As [`Self::drop_down`], on the fans.
    pub(super) fn drop_on_fans(
        &self,
        ray: &Ray,
        at: DVec2,
        slack: f64,
    ) -> (Option<Met>, Vec<Triangle>) {
        // The ray may lean by 1e-7 of the heights that it passes: the place where it meets is near.
        let (_, mut passed) = self.drop_down(ray, at, slack);
        passed.extend(self.built.triangles_at(at));
        let met = self.meet_fans(&Sheared::new(ray), &passed, slack);
        (met, passed)
    }

    /// As [`Self::walk_along`], on the fans.
    pub(super) fn walk_on_fans(
        &self,
        ray: &Ray,
        start: f64,
        end: f64,
        slack: f64,
    ) -> (Option<Met>, Vec<Triangle>) {
        let sheared = Sheared::new(ray);
        let (mut met, mut passed): (Option<Met>, Vec<Triangle>) = (None, Vec::new());
        for piece in pieces(&self.built, ray, start, end) {
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
                is_from_behind: false,
            })
        });
        met.min_by(first)
    }

    /// The fan of all sites on the circle of a triangle, as the tiles have it: around the first of them. Of three
    /// sites it is the triangle.
    fn fan(&self, triangle: &Triangle) -> Vec<[DVec3; 3]> {
        let corners = triangle.map(|site| site.point());
        let mut on_circle = corners.to_vec();
        on_circle.extend(self.built.in_circle(triangle).on);
        let order = |a: &DVec3, b: &DVec3| {
            let [cell_a, cell_b] = [a, b].map(|site| self.built.sites.cell_at(site.truncate()));
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
}
