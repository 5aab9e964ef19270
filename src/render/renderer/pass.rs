//! Render passes, and what is left out of them.

use glam::{Mat4, Vec3};
use wgpu::{
    CommandEncoder, RenderPassColorAttachment, RenderPassDepthStencilAttachment, TextureView,
};

use crate::scene::Extent;

/// An opaque colour for the graphics card.
pub(super) fn opaque([r, g, b]: [u8; 3]) -> [f32; 4] {
    [
        f32::from(r) / 255.0,
        f32::from(g) / 255.0,
        f32::from(b) / 255.0,
        1.0,
    ]
}

/// Whether any of a box may be in the picture: not where all of its corners are beyond one side.
pub(super) fn is_in_sight(clip_from_local: &Mat4, extent: &Extent) -> bool {
    let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| {
        let pick = |bit: i32, low: f32, high: f32| if i & bit == 0 { low } else { high };
        let (min, max) = (extent.min, extent.max);
        let corner = Vec3::new(
            pick(1, min.x, max.x),
            pick(2, min.y, max.y),
            pick(4, min.z, max.z),
        );
        *clip_from_local * corner.extend(1.0)
    });
    // A point of a cloud is wider than its place: a tenth of the picture more on each side.
    let beyond = [
        corners.iter().all(|c| c.x < -1.1 * c.w),
        corners.iter().all(|c| c.x > 1.1 * c.w),
        corners.iter().all(|c| c.y < -1.1 * c.w),
        corners.iter().all(|c| c.y > 1.1 * c.w),
        corners.iter().all(|c| c.w <= 0.0),
    ];
    !beyond.contains(&true)
}

/// The depth texture of a pass.
pub(super) fn depth(view: &TextureView, clear: bool) -> RenderPassDepthStencilAttachment<'_> {
    RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            // Reverse-z: infinitely far.
            load: if clear {
                wgpu::LoadOp::Clear(0.0)
            } else {
                wgpu::LoadOp::Load
            },
            store: wgpu::StoreOp::Store,
        }),
        stencil_ops: None,
    }
}

/// A pass that draws into `color`.
pub(super) fn pass<'a>(
    encoder: &'a mut CommandEncoder,
    label: &str,
    color: &TextureView,
    clear: Option<wgpu::Color>,
    depth: Option<RenderPassDepthStencilAttachment<'_>>,
) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: &[Some(RenderPassColorAttachment {
            view: color,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: clear.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: depth,
        ..Default::default()
    })
}
