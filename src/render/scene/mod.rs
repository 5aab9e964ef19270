//! World data made ready for the graphics card: THE place where f64 becomes f32, after the flight's
//! local origin is subtracted. Made on a worker thread, uploaded once.

pub(crate) mod ground;
pub(crate) mod photo_geometry;
pub(crate) mod photo_image;
mod tiles;

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec3, Mat4, Vec3};

use crate::geometry::LocalFrame;
use tiles::{shuffle, tiles};

/// Points or triangles in a tile: small enough to leave out what is not in sight, large enough that
/// ten million make few draw calls.
const TILE: usize = 1 << 16;
/// Of points without a colour: light rock.
const GREY: [u8; 3] = [184, 180, 172];

/// A local point for the graphics card.
pub(crate) fn narrow(local: DVec3) -> Vec3 {
    local.as_vec3()
}

/// A matrix for the graphics card; made of local coordinates.
pub(crate) fn narrow_matrix(matrix: DMat4) -> Mat4 {
    matrix.as_mat4()
}

/// A number for the graphics card: pixels, angles, and lengths that are no coordinates.
pub(crate) fn narrow_number(number: f64) -> f32 {
    number as f32
}

/// A point of the cloud or a vertex of the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Vertex {
    /// In the local frame.
    pub(crate) position: [f32; 3],
    pub(crate) color: [u8; 4],
    /// Times 127; zero where unknown.
    pub(crate) normal: [i8; 4],
}

/// Unit normals of points: what light and slope need. Empty where unknown.
#[derive(Debug, Clone, Default)]
pub struct Normals(Vec<[i8; 4]>);

impl Normals {
    /// The normals of a surface's vertices, to either side: the mean of the triangles around each,
    /// by area.
    pub fn of(
        frame: &LocalFrame,
        vertices: impl Iterator<Item = DVec3>,
        triangles: &[[u32; 3]],
    ) -> Self {
        let places: Vec<Vec3> = vertices
            .map(|vertex| narrow(frame.local_from_world(vertex)))
            .collect();
        let mut sums = vec![Vec3::ZERO; places.len()];
        for triangle in triangles {
            let [a, b, c] = triangle.map(|i| places.get(i as usize).copied());
            if let (Some(a), Some(b), Some(c)) = (a, b, c) {
                let normal = (b - a).cross(c - a);
                for &corner in triangle {
                    let sum = &mut sums[corner as usize];
                    // Files wind neighbours differently: opposite normals must not cancel out. Two
                    // that look up are right however steep the edge between them is.
                    *sum = match sum.dot(normal) < 0.0 {
                        true if normal.z < 0.0 => *sum - normal,
                        true if sum.z < 0.0 => normal - *sum,
                        _ => *sum + normal,
                    };
                }
            }
        }
        let packed = sums.into_iter().map(|sum| {
            // `as` saturates.
            let n = sum.normalize_or_zero() * 127.0;
            [n.x.round() as i8, n.y.round() as i8, n.z.round() as i8, 0]
        });
        Self(packed.collect())
    }

    fn get(&self, index: u32) -> [i8; 4] {
        self.0.get(index as usize).copied().unwrap_or_default()
    }
}

/// A box in the local frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extent {
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

impl Extent {
    pub(crate) fn of(points: impl Iterator<Item = Vec3>) -> Option<Self> {
        points.fold(None, |extent, p| {
            let Self { min, max } = extent.unwrap_or(Self { min: p, max: p });
            Some(Self {
                min: min.min(p),
                max: max.max(p),
            })
        })
    }

    /// Around both.
    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }
}

/// Points near each other, in shuffled order.
#[derive(Debug)]
pub(crate) struct CloudTile {
    pub(crate) points: Vec<Vertex>,
    pub(crate) extent: Extent,
}

/// A cloud made ready.
#[derive(Debug)]
pub struct CloudGeometry {
    pub(crate) tiles: Vec<CloudTile>,
    /// About how far neighbouring points are apart, world units.
    pub(crate) spacing: f64,
    /// Elevations in the world, without the extreme hundredths.
    pub(crate) elevation: [f64; 2],
}

impl CloudGeometry {
    /// From world points. `colors` and `normals` are in their order, or empty. Within each tile the
    /// points are shuffled, so that a prefix is a fair sample.
    pub fn new(
        frame: &LocalFrame,
        points: impl Iterator<Item = DVec3>,
        colors: &[[u8; 3]],
        normals: &Normals,
    ) -> Self {
        let places: Vec<Vec3> = points
            .map(|point| narrow(frame.local_from_world(point)))
            .collect();
        let mut order: Vec<u32> = indices(places.len());
        let place = |i: u32| places[i as usize];
        let runs = tiles(&mut order, TILE, &place);
        let mut spacings = Vec::new();
        let tiles = runs
            .into_iter()
            .filter_map(|run| {
                let members = &mut order[run];
                shuffle(members);
                let extent = Extent::of(members.iter().map(|&i| place(i)))?;
                let size = (extent.max - extent.min).as_dvec3();
                spacings.push((size.x * size.y / members.len() as f64).sqrt());
                let points = members.iter();
                let points = points.map(|&i| vertex(place(i), i, colors, normals));
                Some(CloudTile {
                    points: points.collect(),
                    extent,
                })
            })
            .collect();
        Self {
            tiles,
            spacing: crate::geometry::median(&mut spacings).unwrap_or_default(),
            elevation: elevation(frame, &places),
        }
    }
}

/// Triangles near each other, with their own vertices.
#[derive(Debug)]
pub(crate) struct MeshTile {
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Of the triangles, each once.
    pub(crate) edges: Vec<[u32; 2]>,
    pub(crate) extent: Extent,
}

/// A mesh made ready.
#[derive(Debug)]
pub struct MeshGeometry {
    pub(crate) tiles: Vec<MeshTile>,
    /// Elevations in the world, without the extreme hundredths.
    pub(crate) elevation: [f64; 2],
}

impl MeshGeometry {
    /// From world vertices. `colors` and `normals` are in their order, or empty. Triangles that
    /// name a vertex that is not there are left out.
    pub fn new(
        frame: &LocalFrame,
        vertices: impl Iterator<Item = DVec3>,
        colors: &[[u8; 3]],
        normals: &Normals,
        triangles: &[[u32; 3]],
    ) -> Self {
        let places: Vec<Vec3> = vertices
            .map(|vertex| narrow(frame.local_from_world(vertex)))
            .collect();
        let mut order: Vec<u32> = indices(triangles.len());
        order.retain(|&t| {
            let corners = triangles[t as usize];
            corners.iter().all(|&i| (i as usize) < places.len())
        });
        let runs = tiles(&mut order, TILE, &|t| {
            places[triangles[t as usize][0] as usize]
        });
        // The number of each vertex in the tile at hand; the tile that it was given in.
        let mut numbers = vec![(u32::MAX, 0_u32); places.len()];
        let mut made = Vec::with_capacity(runs.len());
        for (run, tile) in runs.into_iter().zip(0_u32..) {
            let mut own = Vec::new();
            let mut renumbered = Vec::with_capacity(run.len());
            for &t in &order[run] {
                renumbered.push(triangles[t as usize].map(|i| {
                    let (given_in, number) = &mut numbers[i as usize];
                    if *given_in != tile {
                        (*given_in, *number) = (tile, own.len() as u32);
                        own.push(vertex(places[i as usize], i, colors, normals));
                    }
                    *number
                }));
            }
            if let Some(extent) = Extent::of(own.iter().map(|v| Vec3::from(v.position))) {
                made.push(MeshTile {
                    vertices: own,
                    edges: edges(&renumbered),
                    triangles: renumbered,
                    extent,
                });
            }
        }
        Self {
            tiles: made,
            elevation: elevation(frame, &places),
        }
    }
}

/// The edges of triangles, each once.
fn edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let mut edges: Vec<[u32; 2]> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Numbers from 0; clouds have under 2^32 points (`surface::SurfaceError::TooManyPoints`).
fn indices(count: usize) -> Vec<u32> {
    (0..u32::try_from(count).unwrap_or(u32::MAX)).collect()
}

pub(crate) fn vertex(place: Vec3, index: u32, colors: &[[u8; 3]], normals: &Normals) -> Vertex {
    let [r, g, b] = colors.get(index as usize).copied().unwrap_or(GREY);
    Vertex {
        position: place.to_array(),
        color: [r, g, b, 255],
        normal: normals.get(index),
    }
}

/// The hundredth and the ninety-ninth hundredth of the elevations, in the world: single outliers
/// would take all the colours.
pub(crate) fn elevation(frame: &LocalFrame, places: &[Vec3]) -> [f64; 2] {
    // Every so many-th is enough for a colour map.
    let step = (places.len() / 100_000).max(1);
    let mut z: Vec<f32> = places.iter().step_by(step).map(|p| p.z).collect();
    if z.is_empty() {
        return [0.0, 1.0];
    }
    z.sort_unstable_by(f32::total_cmp);
    let last = z.len() - 1;
    let at = |share: usize| f64::from(z[last * share / 100]) + frame.origin().z;
    [at(1), at(99)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Bounds;

    /// A slope of 45 degrees as two triangles, wound alike or against each other: one normal, to
    /// either side.
    #[test]
    fn normals_do_not_depend_on_the_winding() {
        let vertices = [
            DVec3::ZERO,
            DVec3::X,
            DVec3::new(1.0, 1.0, 1.0),
            DVec3::new(0.0, 1.0, 1.0),
        ];
        let frame = LocalFrame::near(&Bounds::of(&vertices).unwrap());
        for triangles in [
            [[0, 1, 2], [0, 2, 3]],
            [[0, 2, 1], [0, 2, 3]],
            [[0, 1, 2], [0, 3, 2]],
            [[0, 2, 1], [0, 3, 2]],
        ] {
            let normals = Normals::of(&frame, vertices.iter().copied(), &triangles);
            for index in 0..4 {
                // 127 / sqrt(2) is 89.8.
                let [x, y, z, _] = normals.get(index);
                assert!(x == 0 && y == -z && z.abs() == 90, "{x} {y} {z}");
            }
        }
    }
}
