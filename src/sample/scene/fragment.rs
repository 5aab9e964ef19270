//! A fragment's shape: a random convex polyhedron, as rock breaks.
//!
//! Aspect ratios. The axes L >= I >= S of fragments from breaking rock in laboratories scatter
//! around L : I : S = 2 : sqrt(2) : 1, that is I/L = 0.7 and S/L = 0.5, over a wide range of sizes,
//! rocks and energies (Fujiwara, Kamimoto & Tsukamoto, Nature 272 (1978) 602; Michikami et al.,
//! Icarus 264 (2016) 316, from more than 12 700 basalt fragments). Kadono, Tanigawa & Mizutani
//! (JpGU 2015, PPS21-P01) find that a uniform density of (I/L, S/L) with no fragment of S/L below
//! k realises these means, with k about 0.2 in Fujiwara's data. That density is drawn here: (I/L,
//! S/L) uniform over the triangle 0.2 <= S/L <= I/L <= 1, with the means I/L = (2 + k) / 3 = 0.733
//! and S/L = (1 + 2 k) / 3 = 0.467. These are impacts in a laboratory; that blasted rock follows
//! them is an assumption. So is the roundness: 12 to 30 corners, all on one ellipsoid.

use glam::DVec3;
use parry3d_f64::math::Vector;
use parry3d_f64::transformation::try_convex_hull;

use crate::random::Random;
use crate::sieve::sieve_size;

/// No fragment has S/L below this (Kadono et al. 2015 on Fujiwara et al. 1978).
const LEAST_RATIO: f64 = 0.2;
/// The corners of a random body of broken rock, from and to (with both). More make it rounder: a hundred are a pebble.
pub(crate) const BROKEN: (u32, u32) = (12, 30);
/// Corners are at least this over the root of their number apart, in radians before stretching:
/// caps around them cover a quarter of the sphere, so that there are no needles among the faces.
const SPACING: f64 = 2.0;
/// Triangles whose unit normals differ by less lie in one face.
const SAME_NORMAL: f64 = 1e-6;
/// Corners nearer than this share of the size are one.
const SMALLEST: f64 = 1e-9;
/// Bodies thinner than this share of their size are flat. parry makes a hull of no volume of points
/// whose variance along one axis is below 1e-7 of their size; this keeps clear of that.
const THINNEST: f64 = 0.01;

/// The half space normal . x <= offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Unit vector out of the body.
    pub normal: DVec3,
    /// Distance of the plane from the body's origin, in the body's unit; positive.
    pub offset: f64,
}

/// A convex polyhedron about its centroid, in units of its sieve size: a fragment of sieve size s is
/// this body times s, its volume `volume` times s^3.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    vertices: Vec<DVec3>,
    planes: Vec<Plane>,
    triangles: Vec<[u32; 3]>,
    volume: f64,
    bounding_radius: f64,
    half_extents: DVec3,
}

/// Points that make no body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum BodyError {
    /// A coordinate is not a number.
    #[error("a point of the body has a coordinate that is not finite")]
    NotFinite,
    /// The points lie in a plane, on a line or in one place.
    #[error("the points enclose no volume; a body needs 4 points that are not in one plane")]
    Flat,
    /// The hull that came back is none.
    #[error("the hull of the points is not convex; move points that are nearly in one place apart")]
    NotConvex,
}

impl Body {
    /// A random fragment: L along x, I along y, S along z (its extents are the axes of the
    /// statistics in the head of this file), so many corners (from and to), sieve size 1. Equal states of
    /// `random` give equal bodies.
    pub fn random(corners: (u32, u32), random: &mut Random) -> Self {
        // Ends with the first try: corners so far apart make a hull (a test holds it). The loop
        // stands for what cannot be proven.
        loop {
            if let Ok(body) = Self::from_points(&random_corners(corners, random)) {
                return body;
            }
        }
    }

    /// The convex hull of the points, about its centroid, scaled to the sieve size 1.
    ///
    /// # Errors
    ///
    /// Points that are not finite or enclose no volume, and hulls that fail the check for
    /// convexity.
    pub fn from_points(points: &[DVec3]) -> Result<Self, BodyError> {
        let mut body = Self::hull(points)?;
        let scale = 1.0 / sieve_size(&body.vertices);
        for vertex in &mut body.vertices {
            *vertex *= scale;
        }
        body.measure();
        Ok(body)
    }

    /// The corners, about the centroid of the volume.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// The faces as planes; the body is where all of them hold. Triangles in one plane make one.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// The faces as triangles of `vertices`, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The volume, in cubes of the sieve size.
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// The radius of the ball about the centroid that holds the body, in sieve sizes.
    pub fn bounding_radius(&self) -> f64 {
        self.bounding_radius
    }

    /// Half the extents along x, y and z, in sieve sizes. The box that they span need not be
    /// centred on the centroid.
    pub fn half_extents(&self) -> DVec3 {
        self.half_extents
    }

    /// The hull of the points about its centroid, at their scale.
    fn hull(points: &[DVec3]) -> Result<Self, BodyError> {
        if !points.iter().all(|point| point.is_finite()) {
            return Err(BodyError::NotFinite);
        }
        let (least, most) = bounds(points);
        let size = 0.5 * (most - least).length();
        // From far away the volumes below would cancel.
        let near: Vec<_> = points.iter().map(|point| point - least).collect();
        let mut distinct = distinct(&near, SMALLEST * size);
        if is_flat(&distinct, THINNEST * size) {
            return Err(BodyError::Flat);
        }
        let points: Vec<_> = distinct
            .iter()
            .map(|point| Vector::new(point.x, point.y, point.z))
            .collect();
        let (corners, triangles) = try_convex_hull(&points).map_err(|_| BodyError::NotConvex)?;
        let mut body = Self {
            vertices: corners
                .iter()
                .map(|corner| DVec3::new(corner.x, corner.y, corner.z))
                .collect(),
            planes: Vec::new(),
            triangles,
            volume: 0.0,
            bounding_radius: 0.0,
            half_extents: DVec3::ZERO,
        };
        // The centroid twice: the second time from nearby, where nothing cancels.
        for _ in 0..2 {
            let centroid = body.centroid().ok_or(BodyError::Flat)?;
            for point in body.vertices.iter_mut().chain(&mut distinct) {
                *point -= centroid;
            }
        }
        body.measure();
        if body.is_convex() && body.holds(&distinct) {
            Ok(body)
        } else {
            Err(BodyError::NotConvex)
        }
    }

    /// The area of its surface, in units of its sieve size squared.
    pub fn surface(&self) -> f64 {
        self.corners()
            .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
            .sum()
    }

    /// The triangles as corner points.
    fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let at = |index: u32| self.vertices.get(index as usize).copied();
        self.triangles
            .iter()
            .filter_map(move |&[a, b, c]| Some([at(a)?, at(b)?, at(c)?]))
    }

    /// The centroid by the divergence theorem: tetrahedra from the origin to each triangle.
    fn centroid(&self) -> Option<DVec3> {
        let (mut volume, mut moment) = (0.0, DVec3::ZERO);
        for [a, b, c] in self.corners() {
            let part = a.dot(b.cross(c)) / 6.0;
            volume += part;
            moment += part * 0.25 * (a + b + c);
        }
        (volume > 0.0).then(|| moment / volume)
    }

    /// Everything that follows from vertices and triangles.
    fn measure(&mut self) {
        self.volume = self
            .corners()
            .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
            .sum();
        let radii = self.vertices.iter().map(|vertex| vertex.length());
        self.bounding_radius = radii.fold(0.0, f64::max);
        let (least, most) = bounds(&self.vertices);
        self.half_extents = 0.5 * (most - least);
        self.planes = self.faces();
    }

    /// One plane for all triangles that lie in it, touching the body where it reaches farthest.
    fn faces(&self) -> Vec<Plane> {
        // Twice the vector areas: the largest triangle of a face knows its normal best.
        let mut normals: Vec<DVec3> = self
            .corners()
            .map(|[a, b, c]| (b - a).cross(c - a))
            .collect();
        normals.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
        let mut planes: Vec<Plane> = Vec::new();
        // Of a sliver the normal is noise; its neighbours bound the body.
        let sliver = SMALLEST * self.bounding_radius * self.bounding_radius;
        for normal in normals {
            let unit = normal.normalize_or_zero();
            let known = |plane: &Plane| (plane.normal - unit).length() < SAME_NORMAL;
            if normal.length() < sliver || planes.iter().any(known) {
                continue;
            }
            let offsets = self.vertices.iter().map(|vertex| vertex.dot(unit));
            planes.push(Plane {
                normal: unit,
                offset: offsets.fold(f64::NEG_INFINITY, f64::max),
            });
        }
        planes
    }

    /// Whether the planes hold all the points that the hull was made of.
    fn holds(&self, points: &[DVec3]) -> bool {
        let limit = 10.0 * SAME_NORMAL * self.bounding_radius;
        let inside = |plane: &Plane, point: &DVec3| plane.normal.dot(*point) < plane.offset + limit;
        points
            .iter()
            .all(|point| self.planes.iter().all(|plane| inside(plane, point)))
    }

    /// Whether the triangles close (Euler: twice the corners less 4) and each lies on the hull.
    fn is_convex(&self) -> bool {
        let limit = 10.0 * SAME_NORMAL * self.bounding_radius;
        let touches = |corner: DVec3| {
            let gaps = self
                .planes
                .iter()
                .map(|plane| plane.offset - plane.normal.dot(corner));
            gaps.filter(|gap| *gap < limit).count() >= 3
        };
        self.triangles.len() + 4 == 2 * self.vertices.len()
            && self.vertices.iter().copied().all(touches)
            && self.corners().all(|[a, b, c]| {
                let middle = (a + b + c) / 3.0;
                let gaps = self
                    .planes
                    .iter()
                    .map(|plane| plane.offset - plane.normal.dot(middle));
                gaps.fold(f64::INFINITY, f64::min).abs() < limit
            })
    }
}

/// Corners on an ellipsoid whose extents along x, y and z are in the ratios L : I : S.
fn random_corners((least, most): (u32, u32), random: &mut Random) -> Vec<DVec3> {
    // Two uniform numbers in order are uniform over the triangle.
    let (one, other) = (
        random.range(LEAST_RATIO, 1.0),
        random.range(LEAST_RATIO, 1.0),
    );
    let size = DVec3::new(1.0, one.max(other), one.min(other));
    let wanted = random
        .range(f64::from(least), f64::from(most + 1))
        .floor()
        .min(f64::from(most));
    let nearest = (SPACING / wanted.sqrt()).cos();
    let mut corners: Vec<DVec3> = Vec::new();
    while (corners.len() as f64) < wanted {
        let corner = random.direction();
        if corners.iter().all(|other| other.dot(corner) < nearest) {
            corners.push(corner);
        }
    }
    // Stretched so that the corners, and not only their ellipsoid, have these extents.
    let (low, high) = bounds(&corners);
    let stretch = size / (high - low);
    corners.iter().map(|corner| *corner * stretch).collect()
}

/// The least and the largest coordinates.
fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    points.iter().fold(
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
        |(least, most), point| (least.min(*point), most.max(*point)),
    )
}

/// The points without those within `limit` of an earlier one.
fn distinct(points: &[DVec3], limit: f64) -> Vec<DVec3> {
    let mut kept: Vec<DVec3> = Vec::new();
    for point in points {
        if kept.iter().all(|other| other.distance(*point) > limit) {
            kept.push(*point);
        }
    }
    kept
}

/// Whether all points are within `limit` of one plane: through the first, the one farthest from it,
/// and the one farthest from their line.
fn is_flat(points: &[DVec3], limit: f64) -> bool {
    let Some(&first) = points.first() else {
        return true;
    };
    let farthest = |reach: &dyn Fn(DVec3) -> f64| {
        let reaches = points.iter().map(|point| *point - first);
        reaches
            .max_by(|a, b| reach(*a).total_cmp(&reach(*b)))
            .unwrap_or_default()
    };
    let line = farthest(&|to| to.length()).normalize_or_zero();
    let normal = line
        .cross(farthest(&|to| line.cross(to).length()))
        .normalize_or_zero();
    let off = farthest(&|to| normal.dot(to).abs());
    normal.dot(off).abs() <= limit
}

#[cfg(test)]
#[allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "in a test a panic is the report"
)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cube(edge: f64) -> Vec<DVec3> {
        (0..8u32)
            .map(|corner| {
                let bit = |axis: u32| f64::from((corner >> axis) & 1);
                DVec3::new(bit(0), bit(1), bit(2)) * edge
            })
            .collect()
    }

    #[test]
    fn cube_with_points_inside_and_on_a_face() {
        let mut points = cube(2.0);
        points.extend([
            DVec3::ONE,
            DVec3::new(0.3, 0.4, 1.0),
            DVec3::new(0.0, 0.0, 1e-12),
        ]);
        let body = Body::hull(&points).expect("a body");
        assert!((body.volume() - 8.0).abs() < 1e-12);
        assert_eq!(body.planes().len(), 6);
        assert_eq!((body.vertices().len(), body.triangles().len()), (8, 12));
        assert!((body.bounding_radius() - 3f64.sqrt()).abs() < 1e-12);
        assert!(body.half_extents().abs_diff_eq(DVec3::ONE, 1e-12));
        assert!(body.planes().iter().all(|p| (p.offset - 1.0).abs() < 1e-12));
        let unit = Body::from_points(&points).expect("a body");
        assert!((unit.volume() - 1.0).abs() < 1e-4);
    }

    /// A regular tetrahedron in a cube of edge 1: a third of it.
    #[test]
    fn tetrahedron() {
        let corners = [
            DVec3::ZERO,
            DVec3::new(1.0, 1.0, 0.0),
            DVec3::new(1.0, 0.0, 1.0),
        ];
        let corners = [corners.as_slice(), &[DVec3::new(0.0, 1.0, 1.0)]].concat();
        let far = DVec3::new(1e3, -2e3, 5e2);
        let moved: Vec<_> = corners.iter().map(|corner| corner + far).collect();
        for points in [corners, moved] {
            let body = Body::hull(&points).expect("a body");
            assert!((body.volume() - 1.0 / 3.0).abs() < 1e-11);
            assert_eq!(body.planes().len(), 4);
            assert!(body.vertices().iter().sum::<DVec3>().length() < 1e-11);
        }
    }

    #[test]
    fn refuses_what_is_no_body() {
        let flat: Vec<_> = cube(1.0)
            .iter()
            .map(|corner| corner * DVec3::new(1.0, 1.0, 1e-12))
            .collect();
        assert_eq!(Body::from_points(&flat), Err(BodyError::Flat));
        assert_eq!(Body::from_points(&[]), Err(BodyError::Flat));
        assert_eq!(Body::from_points(&[DVec3::ONE; 9]), Err(BodyError::Flat));
        let line: Vec<_> = (0..9).map(|i| DVec3::ONE * f64::from(i)).collect();
        assert_eq!(Body::from_points(&line), Err(BodyError::Flat));
        let mut broken = cube(1.0);
        broken.push(DVec3::NAN);
        assert_eq!(Body::from_points(&broken), Err(BodyError::NotFinite));
    }

    /// Thin slabs, turned so that no coordinate is exact: a right hull or a refusal, no panic.
    #[test]
    fn nearly_flat_points_end_well() {
        for thin in 1..12 {
            let height = 0.1f64.powi(thin);
            let turn = Random::new(3).rotation();
            let slab: Vec<_> = cube(1.0)
                .iter()
                .map(|corner| turn * (corner * DVec3::new(1.0, 1.0, height)))
                .collect();
            match Body::hull(&slab) {
                Ok(body) => assert!((body.volume() / height - 1.0).abs() < 1e-4, "{height:e}"),
                Err(error) => assert!(thin > 1, "{height:e}: {error}"),
            }
        }
    }

    /// The head of this file: uniform over the triangle, so I/L has the mean (2 + k) / 3, S/L
    /// (1 + 2 k) / 3, and both the deviation (1 - k) / sqrt(18). 5 standard errors of 1000 bodies.
    #[test]
    fn aspect_ratios_as_the_source_says() {
        const BODIES: u64 = 1000;
        let seed = Random::new(2015);
        let (mut middle, mut short, mut tries) = (0.0, 0.0, 0);
        for id in 0..BODIES {
            let corners = random_corners(BROKEN, &mut seed.fork(id));
            tries += usize::from(Body::hull(&corners).is_err());
            let body = Body::hull(&corners).expect("a body");
            assert_eq!(body.vertices().len(), corners.len());
            assert!((12..=30).contains(&corners.len()));
            let half = body.half_extents();
            middle += half.y / half.x;
            short += half.z / half.x;
        }
        let limit = 5.0 * (1.0 - LEAST_RATIO) / (18.0 * BODIES as f64).sqrt();
        let mean = |sum: f64| sum / BODIES as f64;
        assert_eq!(tries, 0);
        assert!((mean(middle) - 2.2 / 3.0).abs() < limit);
        assert!((mean(short) - 1.4 / 3.0).abs() < limit);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn random_bodies_are_whole(seed: u64) {
            let body = Body::random(BROKEN, &mut Random::new(seed));
            prop_assert_eq!(&body, &Body::random(BROKEN, &mut Random::new(seed)));
            prop_assert!((sieve_size(body.vertices()) - 1.0).abs() < 1e-9);
            for plane in body.planes() {
                prop_assert!(plane.normal.is_normalized() && plane.offset > 0.0);
                let gaps: Vec<_> = body.vertices().iter()
                    .map(|vertex| plane.offset - plane.normal.dot(*vertex)).collect();
                prop_assert!(gaps.iter().all(|gap| *gap >= -1e-12));
                // A face has three corners at least.
                prop_assert!(gaps.iter().filter(|gap| **gap < 1e-9).count() >= 3);
            }
            // Each triangle lies in a plane, as near as planes with one normal are made one, and its
            // normal points out.
            let near = 10.0 * SAME_NORMAL * body.bounding_radius();
            for [a, b, c] in body.corners() {
                let inside = |plane: &&Plane| [a, b, c].iter()
                    .all(|v| (plane.offset - plane.normal.dot(*v)).abs() < near);
                let area = (b - a).cross(c - a);
                let mut planes = body.planes().iter().filter(inside);
                prop_assert!(planes.any(|p| area.dot(p.normal) > 0.0));
            }
            let centroid = body.centroid().unwrap_or(DVec3::ONE);
            prop_assert!(centroid.length() < 1e-14);
            let half = body.half_extents();
            prop_assert!(half.x >= half.y && half.y >= half.z && half.z > 0.0);
            prop_assert!(body.volume() < 8.0 * half.element_product());
            prop_assert!(half.x <= body.bounding_radius());
        }
    }
}
