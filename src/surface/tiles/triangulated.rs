//! The Delaunay triangulation of places, proven.
//!
//! Delaunator is the fastest that there is, but its test for circles is not exact. So what it makes is
//! checked with exact predicates: a triangulation whose triangles turn left, whose rim is convex and none
//! of whose edges can be flipped to advantage is Delaunay (Delaunay, 1934). Where the check fails (places
//! on lattices and on circles, or nearly so) spade makes it, which is exact and takes twice as long.

use delaunator::{EMPTY, Point, next_halfedge};
use glam::DVec2;
use robust::{Coord, incircle, orient2d};
use spade::{DelaunayTriangulation, Point2, Triangulation};

use crate::surface::SurfaceError;

/// Of an edge at the rim.
const NONE: u32 = u32::MAX;

/// Triangles over places. Edge `3 t + k` goes from corner k of triangle t to its next one.
#[derive(Debug, Default)]
pub(super) struct Triangulated {
    /// Indices of places, counter-clockwise, three a triangle.
    corners: Vec<u32>,
    /// The same edge of the neighbour, in the other direction; `NONE` at the rim.
    twins: Vec<u32>,
    /// Of each triangle: whether a neighbour has its circle.
    shares_circle: Vec<bool>,
}

impl Triangulated {
    /// The triangulation of places that differ. Of places on one line it is empty.
    ///
    /// # Errors
    /// Where a coordinate is too large for exact predicates.
    pub(super) fn new(places: &[DVec2]) -> Result<Self, SurfaceError> {
        let mut made = Self::fast(places);
        if !made.prove(places) {
            made = Self::exact(places)?;
            // Spade's needs no proof, but who shares a circle is found by it. (Of places on one line there
            // are no triangles, and nothing is proven.)
            made.prove(places);
        }
        Ok(made)
    }

    fn fast(places: &[DVec2]) -> Self {
        let points: Vec<Point> = (places.iter())
            .map(|place| Point {
                x: place.x,
                // Delaunator's y points down.
                y: -place.y,
            })
            .collect();
        let made = delaunator::triangulate(&points);
        // No more than `Sites` holds; it counts in u32.
        let narrow = |index: usize| u32::try_from(index).unwrap_or(NONE);
        let corners: Vec<u32> = made.triangles.iter().map(|&i| narrow(i)).collect();
        let twins = made.halfedges.iter().map(|&twin| match twin {
            EMPTY => NONE,
            twin => narrow(twin),
        });
        Self {
            twins: twins.collect(),
            shares_circle: vec![false; corners.len() / 3],
            corners,
        }
    }

    fn exact(places: &[DVec2]) -> Result<Self, SurfaceError> {
        let points = places.iter().map(|place| Point2::new(place.x, place.y));
        let made: DelaunayTriangulation<Point2<f64>> =
            DelaunayTriangulation::bulk_load_stable(points.collect())
                .map_err(|_| SurfaceError::TooFarOut)?;
        let narrow = |index: usize| u32::try_from(index).unwrap_or(NONE);
        let mut corners = Vec::with_capacity(made.num_inner_faces() * 3);
        let mut numbers = vec![NONE; made.num_directed_edges()];
        let mut edges = Vec::with_capacity(corners.capacity());
        for face in made.inner_faces() {
            for edge in face.adjacent_edges() {
                numbers[edge.fix().index()] = narrow(corners.len());
                corners.push(narrow(edge.from().fix().index()));
                edges.push(edge.fix());
            }
        }
        let twins = edges.iter().map(|edge| numbers[edge.rev().index()]);
        Ok(Self {
            twins: twins.collect(),
            shares_circle: vec![false; corners.len() / 3],
            corners,
        })
    }

    /// Finds out who shares a circle, and on the way whether it is the Delaunay triangulation of these
    /// places, all of them: says so.
    fn prove(&mut self, places: &[DVec2]) -> bool {
        let at = |edge: usize| coord(places[self.corners[edge] as usize]);
        let turns_left = |triangle: usize| {
            orient2d(at(3 * triangle), at(3 * triangle + 1), at(3 * triangle + 2)) > 0.0
        };
        if !(0..self.len()).all(turns_left) {
            return false;
        }
        let mut is_used = vec![false; places.len()];
        for &corner in &self.corners {
            is_used[corner as usize] = true;
        }
        // Where each corner at the rim goes to.
        let mut rim = vec![NONE; places.len()];
        let mut on_the_rim = 0;
        for (edge, &twin) in self.twins.iter().enumerate() {
            let next = next_halfedge(edge);
            if twin == NONE {
                rim[self.corners[edge] as usize] = self.corners[next];
                on_the_rim += 1;
                continue;
            }
            let twin = twin as usize;
            if twin < edge {
                continue;
            }
            let opposite = at(next_halfedge(next_halfedge(twin)));
            let inside = incircle(at(edge), at(next), at(next_halfedge(next)), opposite);
            if inside > 0.0 {
                return false;
            }
            if inside == 0.0 {
                self.shares_circle[edge / 3] = true;
                self.shares_circle[twin / 3] = true;
            }
        }
        // Euler: a disc without holes, of all places.
        let is_disc = self.len() + 2 + on_the_rim == 2 * places.len();
        let place = |index: u32| coord(places[index as usize]);
        let is_convex = (0..).zip(&rim).all(|(from, &to)| {
            to == NONE
                || rim[to as usize] != NONE && {
                    orient2d(place(from), place(to), place(rim[to as usize])) >= 0.0
                }
        });
        let rim_is_one_way = rim.iter().filter(|&&to| to != NONE).count() == on_the_rim;
        is_used.iter().all(|&used| used) && is_disc && rim_is_one_way && is_convex
    }

    /// How many triangles there are.
    pub(super) fn len(&self) -> usize {
        self.corners.len() / 3
    }

    /// Whether there are none: of places on one line.
    pub(super) fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    /// The places at the rim, in any order.
    pub(super) fn at_the_rim(&self) -> impl Iterator<Item = u32> {
        let edges = self.corners.iter().zip(&self.twins);
        edges
            .filter(|&(_, &twin)| twin == NONE)
            .map(|(&from, _)| from)
    }

    /// The corners of a triangle, indices of places.
    pub(super) fn corners(&self, triangle: usize) -> [u32; 3] {
        [0, 1, 2].map(|k| self.corners[3 * triangle + k])
    }

    /// The neighbour over the edge from corner k to the next one; `None` at the rim.
    pub(super) fn neighbour(&self, triangle: usize, k: usize) -> Option<usize> {
        let twin = self.twins[3 * triangle + k];
        (twin != NONE).then_some(twin as usize / 3)
    }

    /// The neighbours that lie on the circle of a triangle.
    pub(super) fn on_its_circle(
        &self,
        triangle: usize,
        places: &[DVec2],
    ) -> impl Iterator<Item = usize> {
        let [a, b, c] = self.corners(triangle).map(|i| coord(places[i as usize]));
        let shares = self.shares_circle[triangle];
        (0..3).filter(move |_| shares).filter_map(move |k| {
            let twin = self.twins[3 * triangle + k];
            if twin == NONE {
                return None;
            }
            let opposite = self.corners[next_halfedge(next_halfedge(twin as usize))];
            let opposite = coord(places[opposite as usize]);
            (incircle(a, b, c, opposite) == 0.0).then_some(twin as usize / 3)
        })
    }

    /// Whether a neighbour lies on the circle of a triangle.
    pub(super) fn shares_circle(&self, triangle: usize) -> bool {
        self.shares_circle[triangle]
    }
}

/// As the predicates want it.
pub(super) fn coord(place: DVec2) -> Coord<f64> {
    Coord {
        x: place.x,
        y: place.y,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(count: usize) -> Vec<DVec2> {
        let mut random = crate::split_mix::SplitMix(5);
        let mut uniform = || (random.next() >> 11) as f64 / (1_u64 << 53) as f64;
        (0..count)
            .map(|_| DVec2::new(uniform(), uniform()))
            .collect()
    }

    /// Else every cloud would take twice as long, and no test would say so.
    #[test]
    fn of_random_places_the_fast_way_is_right() {
        let places = random(10_000);
        assert!(Triangulated::fast(&places).prove(&places));
    }

    #[test]
    fn both_ways_make_the_same() {
        let places = random(2000);
        let sorted = |made: Triangulated| {
            let mut triangles: Vec<[u32; 3]> = (0..made.len())
                .map(|triangle| {
                    let mut corners = made.corners(triangle);
                    corners.sort_unstable();
                    corners
                })
                .collect();
            triangles.sort_unstable();
            triangles
        };
        let exact = Triangulated::exact(&places).unwrap();
        assert_eq!(sorted(Triangulated::fast(&places)), sorted(exact));
    }

    /// Of all squares of a lattice one knows that the four corners are on a circle.
    #[test]
    fn a_lattice_shares_its_circles() {
        let places: Vec<DVec2> = (0..400)
            .map(|i| DVec2::new(f64::from(i % 20), f64::from(i / 20)))
            .collect();
        let made = Triangulated::new(&places).unwrap();
        assert_eq!(made.len(), 19 * 19 * 2);
        for triangle in 0..made.len() {
            assert_eq!(made.on_its_circle(triangle, &places).count(), 1);
        }
    }

    /// Four places have two triangulations, one of them Delaunay. The other is refused, and so are a triangle
    /// that is missing, one that turns right and a place that nobody uses.
    #[test]
    fn what_is_not_delaunay_is_refused() {
        let places = [(0.0, 0.0), (1.0, 0.0), (1.2, 0.9), (0.0, 1.0)].map(DVec2::from);
        let square = |corners: [u32; 6], twins: [u32; 6]| Triangulated {
            corners: corners.to_vec(),
            twins: twins.to_vec(),
            shares_circle: vec![false; 2],
        };
        const N: u32 = NONE;
        let mut right = square([0, 1, 3, 1, 2, 3], [N, 5, N, N, N, 1]);
        let is_right = right.prove(&places);
        let mut other = square([0, 1, 2, 0, 2, 3], [N, N, 3, 2, N, N]);
        assert!(is_right != other.prove(&places));
        let exact = Triangulated::exact(&places).unwrap();
        let has_edge_0_2 =
            (0..2).all(|t| exact.corners(t).contains(&0) && exact.corners(t).contains(&2));
        assert_eq!(is_right, !has_edge_0_2);
        let mut half = Triangulated {
            corners: vec![0, 1, 3],
            twins: vec![N; 3],
            shares_circle: vec![false],
        };
        assert!(!half.prove(&places), "a place is not used");
        assert!(!half.prove(&[places[0], places[1], places[3], places[3]]));
        let mut turned = square([0, 3, 1, 1, 2, 3], [N, 5, N, N, N, 1]);
        assert!(!turned.prove(&places));
    }
}
