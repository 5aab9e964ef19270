//! Pictures beside the main one, for the window: each with textures of its own.

use wgpu::TextureView;

use super::Renderer;
use super::part::{Most, Part};
use super::targets::Targets;
use crate::show::Show;
use crate::view::View;

/// The textures of a picture beside the main one.
#[derive(Debug)]
pub struct Aside(Targets);

impl Renderer {
    /// Draws a picture of `size` pixels into textures that the caller keeps; returns what to show of them,
    /// as [`Renderer::color_view`]. Unlike [`Renderer::picture`] nothing is read back, so nobody waits. Says
    /// whether finer points of a large cloud are on their way: draw it again in a moment.
    pub fn draw_aside<'a>(
        &mut self,
        aside: &'a mut Option<Aside>,
        view: &View,
        show: &Show,
        size: [u32; 2],
    ) -> (&'a TextureView, bool) {
        let samples = if self.gpu.software { 1 } else { 2 };
        let kept = aside.take().filter(|Aside(targets)| targets.size == size);
        let Aside(mut targets) =
            kept.unwrap_or_else(|| Aside(Targets::new(&self.gpu.device, size, samples)));
        let [_, awaited] = self.draw_part(&mut targets, view, show, Part::whole(size), Most::Aside);
        let Aside(targets) = aside.insert(Aside(targets));
        (&targets.picture_view, awaited)
    }
}
