//! Clouds beside the surface: with colours of their own, whatever the surface's mean.

use glam::DVec3;
use wgpu::RenderPass;

use super::Renderer;
use crate::device::gpu::Gpu;
use crate::geometry::LocalFrame;
use crate::primitives::frame::{FrameBinding, FrameUniform, frame_layout};
use crate::primitives::points::CloudBuffers;
use crate::scene::{CloudGeometry, Extent, Normals, narrow_number};
use crate::show::Show;

/// A cloud beside the surface, on the graphics device. Uploading can be done on a worker thread; clones
/// share the buffers.
#[derive(Debug, Clone)]
pub struct BesideCloud(CloudBuffers);

impl BesideCloud {
    /// Uploads points of the world; `colors` are in their order, or empty. All geometry of a picture is
    /// made in the same frame.
    pub fn new(
        gpu: &Gpu,
        frame: &LocalFrame,
        points: impl Iterator<Item = DVec3>,
        colors: &[[u8; 3]],
    ) -> Self {
        let cloud = CloudGeometry::new(frame, points, colors, &Normals::default());
        Self(CloudBuffers::new(gpu, &cloud))
    }
}

/// The clouds beside the surface, each with a frame of its own.
#[derive(Debug, Default)]
pub(crate) struct Beside {
    clouds: Vec<(BesideCloud, FrameBinding)>,
    /// Counts what was set.
    pub(crate) version: u64,
}

impl Beside {
    pub(crate) fn extents(&self) -> impl Iterator<Item = Extent> {
        self.clouds.iter().filter_map(|(cloud, _)| cloud.0.extent())
    }
}

impl Renderer {
    /// The clouds that are drawn beside the surface where [`Show::beside`] says so.
    pub fn set_beside(&mut self, clouds: impl IntoIterator<Item = BesideCloud>) {
        let device = &self.gpu.device;
        let layout = frame_layout(device);
        let framed = |cloud| (cloud, FrameBinding::new(device, &layout));
        self.beside.clouds = clouds.into_iter().map(framed).collect();
        self.beside.version += 1;
    }

    /// What their shaders know of the frame: all of the surface's, but their own colours and size.
    pub(super) fn write_beside(&self, main: &FrameUniform, show: &Show) {
        for (cloud, frame) in &self.beside.clouds {
            let uniform = FrameUniform {
                color_by: 0,
                project: 0,
                // They are there whole.
                least: 0.0,
                radius: narrow_number(0.85 * cloud.0.spacing * show.point_size),
                ..*main
            };
            frame.write(&self.gpu.queue, &uniform);
        }
    }

    /// Draws them into the surface's own picture and depths.
    pub(super) fn draw_beside(
        &self,
        pass: &mut RenderPass<'_>,
        most: Option<usize>,
        in_sight: &impl Fn(&Extent) -> bool,
    ) {
        for (cloud, frame) in &self.beside.clouds {
            pass.set_bind_group(0, &frame.group, &[]);
            self.points.draw_cloud(&cloud.0, pass, most, in_sight);
        }
    }
}
