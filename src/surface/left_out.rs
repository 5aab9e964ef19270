//! How well a point of the surface is predicted by the points around it when it is left out: what the
//! cloud itself says of the error that lies between its points.
//!
//! A point of a random cloud is a place like any other for the cloud without it, so the difference
//! between its height and the height of the triangle that takes its place is a draw from the error of
//! the interpolation, its own noise added. The triangle is that of the Delaunay triangulation of the
//! points around it (the hole that it leaves is triangulated anew from no others).
//!
//! Of a cloud, and of a mesh that lies like one, all of this is over (x, y). A wall has no height over (x, y): pieces of a mesh
//! that stand steeper than 15 degrees are looked at along the way that they face ([`way_up`]), and so are those that look down.

use glam::{DMat3, DQuat, DVec3};

use super::SurfaceError;
use super::delaunay::triangulate;
use super::thinning::thin;

/// A point and what takes its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOut {
    /// In the surface's local frame.
    pub point: DVec3,
    /// How far the point lies above the triangle that takes its place, world units, along `up`.
    pub above: f64,
    /// The area across `up` that the triangles at the point cover, a third of which is its share.
    pub star: f64,
    /// The way that is up here, of length 1: z but for pieces of a mesh that do not face up.
    pub up: DVec3,
}

/// What is kept of a point that was left out: there may be a hundred million of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Kept {
    /// Which point.
    index: u32,
    above: f64,
    star: f64,
}

impl Kept {
    /// As it is told; `points` are those that it was made of, and up is that way.
    pub(super) fn of(self, points: &[DVec3], up: DVec3) -> LeftOut {
        LeftOut {
            point: points[self.index as usize],
            above: self.above,
            star: self.star,
            up,
        }
    }
}

impl LeftOut {
    /// Of these points (in the surface's local frame) one of each square cell of that side over (x, y), each left out in
    /// turn: what a cloud of no more points would say.
    ///
    /// # Errors
    /// Where the triangulation fails.
    pub fn of_thinned(mut points: Vec<DVec3>, cell: f64) -> Result<Vec<Self>, SurfaceError> {
        thin(&mut points, &mut Vec::new(), cell)?;
        let triangles = triangulate(&points)?;
        let kept = leave_out_each(&points, &triangles, DVec3::Z).into_iter();
        Ok(kept.map(|kept| kept.of(&points, DVec3::Z)).collect())
    }
}

/// The cosine of the steepest piece of a mesh that is looked at from above (15 degrees): on slopes the roughest places fold over
/// there, and intervals of a mesh tilted by 40 degrees were 0.6 as wide as of the same mesh level.
const LEVEL: f64 = 0.966;

/// Which way is up for a piece of a mesh: z where it is nearly level, else the mean of the ways that its faces look.
pub(super) fn way_up(points: &[DVec3], triangles: &[[u32; 3]]) -> DVec3 {
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|index| points[index as usize]);
        (b - a).cross(c - a)
    };
    let faces: DVec3 = triangles.iter().map(area).sum();
    let way = faces.normalize_or(DVec3::Z);
    match way.z > LEVEL {
        true => DVec3::Z,
        false => way,
    }
}

/// Every point of these triangles (indices into `points`) that they surround as one looks against `up`, left out in turn.
pub(super) fn leave_out_each(points: &[DVec3], triangles: &[[u32; 3]], up: DVec3) -> Vec<Kept> {
    let along_up = DMat3::from_quat(DQuat::from_rotation_arc(up, DVec3::Z));
    // To the bit as it is where nothing turns.
    let turned = |point: DVec3| match up == DVec3::Z {
        true => point,
        false => along_up * point,
    };
    // Each corner of each triangle, sorted by the point: in 64 bits, for sorting is half of the work.
    let corners = (0_u64..).zip(triangles.iter().flatten());
    let mut corners: Vec<u64> = corners
        .map(|(place, &point)| u64::from(point) << 32 | place)
        .collect();
    corners.sort_unstable();
    let mut edges: Vec<[u32; 2]> = Vec::new();
    let mut ring: Vec<DVec3> = Vec::new();
    let around = corners.chunk_by(|a, b| a >> 32 == b >> 32);
    let kept = around
        .filter_map(|around| {
            // The upper half, which came from a u32.
            let index = (around.first()? >> 32) as u32;
            let point = points[index as usize];
            edges.clear();
            // The edge opposite to the corner; `as` takes the lower half, the place.
            edges.extend(around.iter().map(|&corner| {
                let place = corner as u32 as usize;
                let triangle = triangles[place / 3];
                [triangle[(place + 1) % 3], triangle[(place + 2) % 3]]
            }));
            walk_around(points, &edges, &mut ring)?;
            for corner in &mut ring {
                *corner = turned(*corner - point);
            }
            let (above, star) = leave_out(&ring)?;
            Some(Kept { index, above, star })
        })
        .collect::<Vec<Kept>>();
    // Without the room that a growing list has.
    kept.into_boxed_slice().into_vec()
}

/// The points around another one, in order; `None` where the triangles do not surround it.
fn walk_around(points: &[DVec3], edges: &[[u32; 2]], ring: &mut Vec<DVec3>) -> Option<()> {
    ring.clear();
    let first = edges.first()?[0];
    let mut at = first;
    loop {
        ring.push(points[at as usize]);
        at = edges.iter().find(|edge| edge[0] == at)?[1];
        if at == first {
            break;
        }
        if ring.len() > edges.len() {
            return None;
        }
    }
    (ring.len() == edges.len()).then_some(())
}

/// How far a point lies above the triangle of its ring that takes its place, and the area of its star; the ring is relative to
/// the point, with z up.
///
/// Of all triangles of the ring that hold the place, that of the Delaunay triangulation is the one whose
/// corners, lifted to the height x² + y², lie lowest over the place (Edelsbrunner and Seidel, "Voronoi
/// diagrams and arrangements", 1986).
fn leave_out(ring: &[DVec3]) -> Option<(f64, f64)> {
    let doubled = |a: DVec3, b: DVec3| a.truncate().perp_dot(b.truncate());
    let around = ring.iter().zip(ring.iter().cycle().skip(1));
    let star = around.map(|(&a, &b)| doubled(a, b)).sum::<f64>() / 2.0;
    // A piece of a mesh may stand on end, or look away from the rest.
    if star <= 0.0 || star.is_nan() {
        return None;
    }
    let mut lowest: Option<(f64, f64)> = None;
    for (i, &a) in ring.iter().enumerate() {
        for (j, &b) in ring.iter().enumerate().skip(i + 1) {
            let from_a_to_b = doubled(a, b);
            if from_a_to_b < 0.0 {
                continue;
            }
            for &c in &ring[j + 1..] {
                let (from_b_to_c, from_c_to_a) = (doubled(b, c), doubled(c, a));
                let area = from_a_to_b + from_b_to_c + from_c_to_a;
                if from_b_to_c < 0.0 || from_c_to_a < 0.0 || area <= 0.0 {
                    continue;
                }
                let over_the_place = |of: &dyn Fn(DVec3) -> f64| -> f64 {
                    (of(a) * from_b_to_c + of(b) * from_c_to_a + of(c) * from_a_to_b) / area
                };
                let lifted = over_the_place(&|corner| corner.truncate().length_squared());
                if lowest.is_none_or(|(other, _)| lifted < other) {
                    lowest = Some((lifted, over_the_place(&|corner| corner.z)));
                }
            }
        }
    }
    let (_, height) = lowest?;
    Some((-height, star))
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;

    fn each(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<LeftOut> {
        let kept = leave_out_each(points, triangles, DVec3::Z).into_iter();
        kept.map(|kept| kept.of(points, DVec3::Z)).collect()
    }

    fn lattice(height: impl Fn(f64, f64) -> f64) -> Vec<DVec3> {
        // Every second row is shifted: six neighbours each, at a distance of 1.
        let rows = (0..20).flat_map(|row| (0..20).map(move |column| (row, column)));
        rows.map(|(row, column)| {
            let x = f64::from(column) + if row % 2 == 0 { 0.0 } else { 0.5 };
            let y = f64::from(row) * 0.75_f64.sqrt();
            DVec3::new(x, y, height(x, y))
        })
        .collect()
    }

    /// On z = x² + y² a square lattice's points lie below what four neighbours at the distance d predict by d²: every
    /// other one of a lattice of 1, those in the middles of cells of 2, by 4.
    #[test]
    fn thinned_points_know_of_no_others() {
        let lattice = (0..8).flat_map(|x| (0..8).map(move |y| DVec2::new(x.into(), y.into())));
        let points: Vec<DVec3> = lattice.map(|at| at.extend(at.length_squared())).collect();
        for (cell, count, below) in [(1.0, 36, 1.0), (2.0, 4, 4.0)] {
            let thinned = LeftOut::of_thinned(points.clone(), cell).unwrap();
            // Those on the rim are not surrounded.
            assert_eq!(thinned.len(), count, "{cell}");
            assert!(thinned.iter().all(|left_out| left_out.above == -below));
        }
    }

    #[test]
    fn a_plane_predicts_its_points() {
        let points = lattice(|x, y| 3.0 + 0.5 * x - 0.25 * y);
        let triangles = triangulate(&points).unwrap();
        let left_out = each(&points, &triangles);
        // Of the rows that are shifted outward neither end is surrounded.
        assert_eq!(left_out.len(), 18 * 19);
        for found in left_out {
            assert!(found.above.abs() < 1e-12);
            // Six triangles of the side 1; fewer at the ends of rows.
            if (1.0..18.5).contains(&found.point.x) {
                assert!((found.star - 1.5 * 3_f64.sqrt()).abs() < 1e-9);
            }
        }
    }

    /// Of a paraboloid r² / 2: the hexagon's corners are all half a unit above its middle.
    #[test]
    fn a_bowl_is_predicted_too_high() {
        let points = lattice(|x, y| (x * x + y * y) / 2.0);
        let triangles = triangulate(&points).unwrap();
        for found in each(&points, &triangles) {
            assert!((found.above + 0.5).abs() < 1e-9, "{found:?}");
        }
    }

    /// The triangle is that of the triangulation of all other points.
    #[test]
    fn the_triangle_is_that_of_the_others() {
        let mut random = crate::split_mix::SplitMix(3);
        let mut uniform = || random.unit();
        let points: Vec<DVec3> = (0..300)
            .map(|_| DVec3::new(uniform() * 9.0, uniform() * 9.0, uniform()))
            .collect();
        let left_out = each(&points, &triangulate(&points).unwrap());
        assert!(left_out.len() > 250);
        for found in left_out {
            let others: Vec<DVec3> = points
                .iter()
                .copied()
                .filter(|p| *p != found.point)
                .collect();
            let surface = crate::surface::Surface::new(crate::surface::Cloud {
                points: others,
                ..Default::default()
            });
            let ray = crate::geometry::Ray {
                origin: found.point.with_z(50.0),
                direction: DVec3::NEG_Z,
            };
            let hit = surface.unwrap().caster().unwrap().cast(&ray).unwrap();
            assert!((found.point.z - found.above - hit.point.z).abs() < 1e-9);
        }
    }

    /// The same hills as a wall that looks any way, or lie upside down, say the same along the way that they face; and hills that
    /// lie as the ground does are looked at from above, to the bit.
    #[test]
    fn walls_are_looked_at_along_the_way_that_they_face() {
        let mut hills = lattice(|x, y| 0.3 * (1.3 * x).sin() * (0.9 * y).cos());
        // On a circle points have no one triangulation.
        for (place, point) in (0..).map(f64::from).zip(&mut hills) {
            *point += DVec3::new((3.1 * place).sin(), (2.3 * place).cos(), 0.0) * 0.1;
        }
        let triangles = triangulate(&hills).unwrap();
        assert_eq!(way_up(&hills, &triangles), DVec3::Z);
        let above = each(&hills, &triangles);
        for way in [
            DVec3::NEG_Y,
            DVec3::NEG_Z,
            DVec3::new(2.0, 1.0, 0.5).normalize(),
        ] {
            let turn = DMat3::from_quat(DQuat::from_rotation_arc(DVec3::Z, way));
            let wall: Vec<DVec3> = hills.iter().map(|point| turn * *point).collect();
            // The mean of the ways that they face is not quite theirs: they go up and down at the rim.
            let up = way_up(&wall, &triangles);
            assert!(up.angle_between(way) < 0.02, "{up} for {way}");
            let kept = leave_out_each(&wall, &triangles, way).into_iter();
            let found: Vec<LeftOut> = kept.map(|kept| kept.of(&wall, way)).collect();
            assert_eq!(found.len(), above.len());
            for (found, above) in found.iter().zip(&above) {
                let off = [found.above - above.above, found.star - above.star];
                assert!(
                    off.iter().all(|off| off.abs() < 1e-9),
                    "{found:?} {above:?}"
                );
            }
        }
    }
}
