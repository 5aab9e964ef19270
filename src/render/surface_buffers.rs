//! A surface made ready and uploaded, for the window and for pictures alike.

use glam::DVec3;

use crate::device::gpu::Gpu;
use crate::fault::Fault;
use crate::geometry::LocalFrame;
use crate::jobs::Progress;
use crate::primitives::mesh::MeshBuffers;
use crate::primitives::points::CloudBuffers;
use crate::scene::{CloudGeometry, MeshGeometry, Normals};
use crate::streamed::StreamSource;
use crate::surface::{Levels, Surface};

/// A cloud of more points is not triangulated to be shown: its points are, by levels of detail. (So many have
/// 12 million triangles with 18 million edges: 0.4 GB on the card, and five seconds on two cores.)
pub const MOST_TRIANGULATED: usize = 6_000_000;

/// What of a surface is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shapes {
    /// Its points.
    pub cloud: bool,
    /// Its triangles.
    pub mesh: bool,
}

impl Shapes {
    /// Everything.
    pub const BOTH: Self = Self {
        cloud: true,
        mesh: true,
    };
}

/// A surface on the graphics device. Clones share the buffers.
#[derive(Debug, Clone, Default)]
pub struct SurfaceBuffers {
    pub(crate) cloud: Option<CloudBuffers>,
    pub(crate) mesh: Option<MeshBuffers>,
    /// How many points there are.
    pub points: usize,
}

impl SurfaceBuffers {
    /// Triangulates, makes ready and uploads: work for a thread other than the window's. All
    /// geometry of a picture is made in the same frame.
    ///
    /// # Errors
    /// Where the surface has no triangles, or where it was cancelled.
    pub fn new(
        gpu: &Gpu,
        frame: &LocalFrame,
        surface: &Surface,
        wanted: Shapes,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let points = surface.vertices().len();
        if surface.is_cloud() && points > MOST_TRIANGULATED {
            progress.stage("sorting the points into levels of detail");
            if let Some(levels) = Levels::new(surface, progress)? {
                return Ok(Self::streamed(levels, frame));
            }
        }
        progress.stage("triangulating the surface for the picture");
        let triangles = surface
            .triangles()
            .map_err(|error| Fault::new(error.to_string(), "check the surface file"))?;
        progress.advance(1, 4)?;
        let (vertices, colors) = (surface.vertices(), surface.colors());
        let normals = Normals::of(frame, vertices, &triangles);
        progress.advance(2, 4)?;
        let mesh = wanted.mesh.then(|| {
            let vertices = surface.vertices();
            MeshGeometry::new(frame, vertices, colors, &normals, &triangles)
        });
        drop(triangles);
        progress.advance(3, 4)?;
        let mesh = mesh.map(|mesh| MeshBuffers::new(gpu, &mesh));
        let cloud = wanted.cloud.then(|| {
            let cloud = CloudGeometry::new(frame, surface.vertices(), colors, &normals);
            CloudBuffers::new(gpu, &cloud)
        });
        progress.advance(4, 4)?;
        Ok(Self {
            cloud,
            mesh,
            points,
        })
    }

    /// Of points (world) with their colours or none, to be looked at alone.
    pub fn of_points(gpu: &Gpu, frame: &LocalFrame, points: &[DVec3], colors: &[[u8; 3]]) -> Self {
        let places = points.iter().copied();
        let cloud = CloudGeometry::new(frame, places, colors, &Normals::default());
        Self {
            cloud: Some(CloudBuffers::new(gpu, &cloud)),
            mesh: None,
            points: points.len(),
        }
    }

    /// Of a cloud that is shown by its levels of detail, however few they are.
    pub(crate) fn streamed(levels: Levels, frame: &LocalFrame) -> Self {
        let points = levels.surface().vertices().len();
        Self {
            points,
            cloud: Some(CloudBuffers::streamed(StreamSource::new(levels, frame))),
            mesh: None,
        }
    }
}
