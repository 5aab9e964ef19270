//! The triangles of a surface in patches of neighbours, each with a box around it: for whoever wants
//! those in some part of the world, and not the rest. A cloud is triangulated tile by tile; a mesh is
//! cut into runs of neighbouring faces.

use glam::DVec3;

use super::left_out::{Kept, LeftOut, leave_out_each, way_up};
use super::made_once::MadeOnce;
use super::mesh::Mesh;
use super::tiles::Tiles;
use super::triangle_blocks::{TriangleBlock, blocks_of};
use super::welded::welded_neighbours;
use super::{Shape, Surface, SurfaceError, longest_edge};
use crate::geometry::{Bounds, LocalFrame};

/// Faces of a mesh in one patch.
const FACES: usize = 4096;

/// Triangles near each other.
#[derive(Debug, Clone, Copy)]
pub struct Patch<'a> {
    points: &'a [DVec3],
    triangles: &'a [[u32; 3]],
    blocks: &'a [TriangleBlock],
    max_edge: f64,
    left_out: &'a MadeOnce<Vec<Kept>>,
    /// Which way points are left out along.
    up: DVec3,
    /// Around the triangles, in the surface's local frame.
    pub bounds: Bounds,
}

impl Patch<'_> {
    /// The corners of its triangles, in the surface's local frame ([`Surface::frame`]).
    pub fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> {
        self.triangles_seen(|_| false)
    }

    /// Those without the ones in boxes that `misses` misses: blocks of about 64 neighbours are looked at.
    pub fn triangles_seen(
        &self,
        misses: impl Fn(&Bounds) -> bool,
    ) -> impl Iterator<Item = [DVec3; 3]> {
        let corners = |triangle: &[u32; 3]| triangle.map(|index| self.points[index as usize]);
        let max_edge = self.max_edge;
        let blocks = self
            .blocks
            .iter()
            .filter(move |block| !misses(&block.bounds));
        blocks
            .flat_map(|block| &self.triangles[block.triangles.clone()])
            .map(corners)
            .filter(move |&corners| max_edge.is_infinite() || longest_edge(corners) <= max_edge)
    }

    /// The points of patches left out in turn, those that the triangles of their own patch surround; the
    /// first call does it, on all cores.
    pub fn left_out<'a>(patches: &'a [Patch<'a>]) -> impl Iterator<Item = LeftOut> {
        let make = |patch: &Patch<'_>| leave_out_each(patch.points, patch.triangles, patch.up);
        MadeOnce::make_all(patches, |patch| patch.left_out, make);
        patches.iter().flat_map(move |patch| {
            let kept = patch.left_out.get(|| make(patch)).iter();
            kept.map(|kept| kept.of(patch.points, patch.up))
        })
    }

    /// How many triangles it has, those among them that are too long to count.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether it has none.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }
}

/// All triangles of a surface, made where somebody looks.
#[derive(Debug, Clone, Copy)]
pub struct Patches<'a> {
    surface: &'a Surface,
}

impl<'a> Patches<'a> {
    /// The patches that may hold triangles in boxes (the surface's local frame) that `misses` does not
    /// miss: boxes only shrink the answer. What of a cloud is not triangulated yet is now, on all cores.
    ///
    /// # Errors
    /// Where the triangulation fails.
    pub fn seen(&self, misses: impl Fn(&Bounds) -> bool) -> Result<Vec<Patch<'a>>, SurfaceError> {
        let Surface { whole, max_edge } = self.surface;
        let (points, max_edge) = (self.surface.points(), *max_edge);
        let mut patches: Vec<Patch<'a>> = match &whole.shape {
            Shape::Cloud(sites) => {
                let tiles = whole.tiles.get_or_init(|| Tiles::new(sites));
                let made = tiles.seen(sites, &misses)?.into_iter();
                made.filter_map(|made| {
                    Some(Patch {
                        points,
                        triangles: &made.triangles,
                        blocks: &made.blocks,
                        max_edge,
                        left_out: &made.left_out,
                        up: DVec3::Z,
                        bounds: made.bounds?,
                    })
                })
                .collect()
            }
            Shape::Mesh(mesh) => {
                let runs = whole.runs.get_or_init(|| runs(mesh));
                runs.iter()
                    .map(|run| Patch {
                        points,
                        triangles: &run.triangles,
                        blocks: &run.blocks,
                        max_edge,
                        left_out: &run.left_out,
                        up: run.up,
                        bounds: run.bounds,
                    })
                    .collect()
            }
        };
        patches.retain(|patch| !misses(&patch.bounds));
        Ok(patches)
    }
}

impl Surface {
    /// All triangles in patches, none of them made yet.
    pub fn patches(&self) -> Patches<'_> {
        Patches { surface: self }
    }

    /// The frame in which patches count.
    pub fn frame(&self) -> &LocalFrame {
        &self.whole.frame
    }

    /// How far a ray from this world point may pass a triangle and still meet it: what the rounding of
    /// the input and of a few products can shift it by, sixteenfold. World units.
    pub fn slack(&self, origin: DVec3) -> f64 {
        let local = self.whole.frame.local_from_world(origin);
        16.0 * f64::EPSILON * (self.whole.magnitude + local.length())
    }
}

/// A run of neighbouring faces of a mesh.
#[derive(Debug)]
pub(super) struct Run {
    triangles: Vec<[u32; 3]>,
    bounds: Bounds,
    blocks: Vec<TriangleBlock>,
    left_out: MadeOnce<Vec<Kept>>,
    up: DVec3,
}

fn runs(mesh: &Mesh) -> Vec<Run> {
    let points = mesh.points();
    let neighbours = welded_neighbours(points, mesh.triangles());
    let runs = neighbours.chunks(FACES);
    runs.filter_map(|run| {
        let corners: Vec<DVec3> = run.iter().flatten().map(|&i| points[i as usize]).collect();
        Some(Run {
            bounds: Bounds::of(&corners)?,
            blocks: blocks_of(run, points),
            triangles: run.to_vec(),
            left_out: MadeOnce::default(),
            up: way_up(points, run),
        })
    })
    .collect()
}
