//! The faces of a mesh as neighbours. In its file they may stand in any order, and each with corners of its own (STL, meshes with
//! a texture): who asks which faces surround a point, or lie in a box, wants them welded and near each other.

use glam::DVec3;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

use super::mesh::has_inside;
use crate::geometry::Bounds;

/// Steps of the curve along each axis, as a power of two: three of them fill 63 bits.
const BITS: u32 = 21;

/// The same faces with one index for each place, without those that lose a corner by it, along a Z-order curve through their middles (Morton, "A computer oriented
/// geodetic data base", 1966).
pub(super) fn welded_neighbours(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut first_at: FxHashMap<[u64; 3], u32> = FxHashMap::default();
    // -0 is the place that 0 is.
    let place = |index: u32| (points[index as usize] + 0.0).to_array().map(f64::to_bits);
    let weld = |index: u32| *first_at.entry(place(index)).or_insert(index);
    let corners = triangles.as_flattened().iter().copied();
    let welded: Vec<u32> = corners.map(weld).collect();
    let (faces, _) = welded.as_chunks::<3>();
    let Some(bounds) = Bounds::of(points) else {
        return Vec::new();
    };
    let most = f64::from((1_u32 << BITS) - 1);
    // The same along each axis, or a nearly level mesh would be cut by its heights.
    let steps = most
        / (bounds.max - bounds.min)
            .max_element()
            .max(f64::MIN_POSITIVE);
    let along_curve = |face: &[u32; 3]| {
        let middle = face
            .map(|index| points[index as usize])
            .iter()
            .sum::<DVec3>()
            / 3.0;
        // `as` saturates.
        let at = ((middle - bounds.min) * steps)
            .to_array()
            .map(|at| at as u64);
        spread(at[0]) | spread(at[1]) << 1 | spread(at[2]) << 2
    };
    let mut ordered: Vec<(u64, [u32; 3])> = faces
        .par_iter()
        .filter(|face| has_inside(face))
        .map(|face| (along_curve(face), *face))
        .collect();
    // The faces tell ties apart, so the same file gives the same order on every run.
    ordered.par_sort_unstable();
    ordered.into_iter().map(|(_, face)| face).collect()
}

/// The lowest 21 bits with two zeros between each two of them.
fn spread(bits: u64) -> u64 {
    let bits = bits & 0x1f_ffff;
    let bits = (bits | bits << 32) & 0x1f_0000_0000_ffff;
    let bits = (bits | bits << 16) & 0x1f_0000_ff00_00ff;
    let bits = (bits | bits << 8) & 0x100f_00f0_0f00_f00f;
    let bits = (bits | bits << 4) & 0x10c3_0c30_c30c_30c3;
    (bits | bits << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread_by_two_zeros() {
        for bit in 0..21 {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(spread(0x1f_ffff), 0x1249_2492_4924_9249);
    }

    /// Four faces of a square pyramid, each with corners of its own and far from its neighbours in the file.
    #[test]
    fn corners_of_one_place_are_one_point() {
        let tip = DVec3::new(0.5, 0.5, 1.0);
        let base = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let base = base.map(|[x, y]| DVec3::new(x, y, -0.0));
        let points: Vec<DVec3> = (0..4)
            .flat_map(|side| [base[side], base[(side + 1) % 4].abs(), tip])
            .collect();
        let triangles: Vec<[u32; 3]> = (0..4)
            .map(|face| [3 * face, 3 * face + 1, 3 * face + 2])
            .collect();
        let welded = welded_neighbours(&points, &triangles);
        let mut used: Vec<u32> = welded.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        assert_eq!((welded.len(), used.len()), (4, 5), "{welded:?}");
        let turned: Vec<[u32; 3]> = triangles.iter().rev().copied().collect();
        assert_eq!(welded_neighbours(&points, &turned).len(), 4);
        // A sliver with two corners at one place.
        let (mut points, mut triangles) = (points, triangles);
        points.extend([tip, tip, base[0]]);
        triangles.push([12, 13, 14]);
        assert_eq!(welded_neighbours(&points, &triangles), welded);
    }
}
