//! The Delaunay triangulation of places, proven.
//!
//! Delaunator is the fastest that there is, but its test for circles is not exact: of places that were
//! rounded, as those of LAZ files are, every tenth four lie nearly on one circle. So what it makes is
//! checked with exact predicates, and edges that can be flipped to advantage are (Lawson, 1977): a
//! triangulation whose triangles turn left, whose rim is convex and none of whose edges can be flipped is
//! Delaunay (Delaunay, 1934). Where its triangles are no triangulation at all (places on lattices and on
//! lines) spade makes it, which is exact and takes twice as long.

use delaunator::{EMPTY, Point, next_halfedge, prev_halfedge};
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
    /// Of each edge: whether the triangles to both sides have one circle.
    on_circle: Vec<bool>,
}

impl Triangulated {
    /// The triangulation of places that differ. Of places on one line it is empty.
    ///
    /// # Errors
    /// Where a coordinate is too large for exact predicates.
    pub(super) fn new(places: &[DVec2]) -> Result<Self, SurfaceError> {
        let mut made = Self::fast(places);
        if !made.is_triangulation(places) {
            made = Self::exact(places)?;
        }
        made.flip(places);
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
            on_circle: vec![false; corners.len()],
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
            on_circle: vec![false; corners.len()],
            corners,
        })
    }

    /// Whether it is a triangulation of these places, all of them.
    fn is_triangulation(&self, places: &[DVec2]) -> bool {
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
        for (edge, _) in self
            .twins
            .iter()
            .enumerate()
            .filter(|(_, twin)| **twin == NONE)
        {
            rim[self.corners[edge] as usize] = self.corners[next_halfedge(edge)];
            on_the_rim += 1;
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

    /// Flips edges of a triangulation until it is Delaunay, and finds out which triangles share a circle.
    fn flip(&mut self, places: &[DVec2]) {
        let mut pending = Vec::new();
        for edge in 0..self.twins.len() {
            let twin = self.twins[edge];
            if twin == NONE || (twin as usize) < edge {
                continue;
            }
            pending.push(edge);
            // Of exact tests there is an end to flipping.
            while let Some(edge) = pending.pop() {
                self.flip_edge(edge, places, &mut pending);
            }
        }
    }

    /// Flips an edge if that is to advantage; then those around it are `pending`.
    fn flip_edge(&mut self, edge: usize, places: &[DVec2], pending: &mut Vec<usize>) {
        let twin = self.twins[edge];
        if twin == NONE {
            self.on_circle[edge] = false;
            return;
        }
        let twin = twin as usize;
        let inside = self.in_circle(edge, twin, places);
        if inside <= 0.0 {
            self.on_circle[edge] = inside == 0.0;
            self.on_circle[twin] = inside == 0.0;
            return;
        }
        // Edges of both triangles, in turn: edge, after, before; twin, after_twin, before_twin. The edge
        // from one opposite corner to the other takes the places of before and before_twin; the outer
        // edges that were there move to edge and twin.
        let (before, before_twin) = (prev_halfedge(edge), prev_halfedge(twin));
        let (after, after_twin) = (next_halfedge(edge), next_halfedge(twin));
        let (corner, corner_of_twin) = (self.corners[before], self.corners[before_twin]);
        self.corners[edge] = corner_of_twin;
        self.corners[twin] = corner;
        self.link(edge, self.twins[before_twin]);
        self.link(twin, self.twins[before]);
        self.link(before, u32::try_from(before_twin).unwrap_or(NONE));
        self.on_circle[before] = false;
        self.on_circle[before_twin] = false;
        pending.extend([edge, after, twin, after_twin]);
    }

    fn link(&mut self, edge: usize, twin: u32) {
        self.twins[edge] = twin;
        if twin != NONE {
            self.twins[twin as usize] = u32::try_from(edge).unwrap_or(NONE);
        }
    }

    /// Positive where the corner opposite the twin of an edge lies in the circle of the edge's triangle, 0
    /// on it.
    fn in_circle(&self, edge: usize, twin: usize, places: &[DVec2]) -> f64 {
        let at = |edge: usize| coord(places[self.corners[edge] as usize]);
        let (next, before) = (next_halfedge(edge), prev_halfedge(edge));
        incircle(at(edge), at(next), at(before), at(prev_halfedge(twin)))
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

    /// The edges at the rim, indices of places, the triangles on their left.
    pub(super) fn rim(&self) -> impl Iterator<Item = [u32; 2]> {
        let edges = self.twins.iter().enumerate();
        let at_the_rim = edges.filter(|(_, twin)| **twin == NONE);
        at_the_rim.map(|(edge, _)| [self.corners[edge], self.corners[next_halfedge(edge)]])
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
    pub(super) fn on_its_circle(&self, triangle: usize) -> impl Iterator<Item = usize> {
        let edges = 3 * triangle..3 * triangle + 3;
        let on_circle = edges.filter(|&edge| self.on_circle[edge]);
        on_circle.map(|edge| self.twins[edge] as usize / 3)
    }

    /// Whether a neighbour lies on the circle of a triangle.
    pub(super) fn shares_circle(&self, triangle: usize) -> bool {
        self.on_its_circle(triangle).next().is_some()
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
        let mut uniform = || random.unit();
        (0..count)
            .map(|_| DVec2::new(uniform(), uniform()))
            .collect()
    }

    /// Else every cloud would take twice as long, and no test would say so: spade is for lattices.
    #[test]
    fn of_random_and_of_rounded_places_the_fast_way_is_right() {
        for places in [random(10_000), rounded(10_000)] {
            assert!(Triangulated::fast(&places).is_triangulation(&places));
        }
    }

    /// In the metres of UTM with three decimals, as LAZ files have them: 0.1 m from each other.
    fn rounded(count: usize) -> Vec<DVec2> {
        let side = (count as f64).sqrt() * 100.0;
        let places = random(count).into_iter();
        let mut places: Vec<[u64; 2]> = places
            .map(|p| [(p.x * side) as u64, (p.y * side) as u64])
            .collect();
        places.sort_unstable();
        places.dedup();
        let metres = |[x, y]: [u64; 2]| {
            DVec2::new(
                452_000.0 + x as f64 / 1000.0,
                5_411_000.0 + y as f64 / 1000.0,
            )
        };
        places.into_iter().map(metres).collect()
    }

    /// No corner of a neighbour in a circle, by the exact predicate, whatever triangulation one begins with:
    /// here that of the places stretched fourfold.
    #[test]
    fn wrong_edges_are_flipped() {
        let places = rounded(10_000);
        let stretched: Vec<DVec2> = places.iter().map(|p| DVec2::new(p.x, 4.0 * p.y)).collect();
        let wrong = |made: &Triangulated| {
            let edges = made
                .twins
                .iter()
                .enumerate()
                .filter(|(_, twin)| **twin != NONE);
            edges
                .filter(|&(edge, &twin)| made.in_circle(edge, twin as usize, &places) > 0.0)
                .count()
        };
        let mut made = Triangulated::fast(&stretched);
        assert!(made.is_triangulation(&places) && wrong(&made) > 5000);
        made.flip(&places);
        assert!(made.is_triangulation(&places));
        assert_eq!(wrong(&made), 0);
        for (edge, &twin) in made.twins.iter().enumerate() {
            let on_circle = twin != NONE && made.in_circle(edge, twin as usize, &places) == 0.0;
            assert_eq!(made.on_circle[edge], on_circle);
        }
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
        assert_eq!(sorted(Triangulated::new(&places).unwrap()), sorted(exact));
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
            assert_eq!(made.on_its_circle(triangle).count(), 1);
        }
    }

    /// Four places have two triangulations, one of them Delaunay: from either it is found. A triangle that
    /// is missing, one that turns right and a place that nobody uses are refused.
    #[test]
    fn from_every_triangulation_delaunays_is_found() {
        let places = [(0.0, 0.0), (1.0, 0.0), (1.2, 0.9), (0.0, 1.0)].map(DVec2::from);
        let square = |corners: [u32; 6], twins: [u32; 6]| Triangulated {
            corners: corners.to_vec(),
            twins: twins.to_vec(),
            on_circle: vec![false; 6],
        };
        const N: u32 = NONE;
        let exact = Triangulated::exact(&places).unwrap();
        let has_edge_0_2 = |made: &Triangulated| {
            (0..2).all(|t| made.corners(t).contains(&0) && made.corners(t).contains(&2))
        };
        for mut made in [
            square([0, 1, 3, 1, 2, 3], [N, 5, N, N, N, 1]),
            square([0, 1, 2, 0, 2, 3], [N, N, 3, 2, N, N]),
        ] {
            assert!(made.is_triangulation(&places));
            made.flip(&places);
            assert!(made.is_triangulation(&places));
            assert_eq!(has_edge_0_2(&made), has_edge_0_2(&exact));
        }
        let half = Triangulated {
            corners: vec![0, 1, 3],
            twins: vec![N; 3],
            on_circle: vec![false; 3],
        };
        assert!(!half.is_triangulation(&places), "a place is not used");
        assert!(!half.is_triangulation(&[places[0], places[1], places[3], places[3]]));
        let turned = square([0, 3, 1, 1, 2, 3], [N, 5, N, N, N, 1]);
        assert!(!turned.is_triangulation(&places));
    }
}
