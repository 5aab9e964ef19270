//! The surface in the corner loupe: crops of it, drawn with the photo's own eye into targets of their own.

use egui::TextureId;
use glam::DVec2;

use super::graphics::{AWAITED, Graphics};
use super::{Viewport, show};
use crate::corner_loupe::CROP;
use crate::open_flight::OpenFlight;
use crate::panels::Crops;
use crate::render::{Aside, PhotoZoom, Scope, Show, View};
use crate::scale::CornerName;
use crate::state::State;

/// The side of a crop, pixels.
const SIDE: u32 = 340;

/// The crops as they were drawn last.
#[derive(Default)]
pub(super) struct Drawn {
    asides: [Option<Aside>; 4],
    textures: [Option<TextureId>; 4],
    /// What they show: flight, photo, the surface's and the outcomes' places in memory, and how.
    of: Option<(u64, usize, usize, usize, Show)>,
}

impl Viewport {
    /// The corners of the selected photo on the surface, drawn where they are wanted and new.
    pub fn crops(&mut self, state: &State, ui: &egui::Ui) -> Option<Crops> {
        let open = state
            .open
            .as_deref()
            .filter(|_| state.preferences.loupe_open)?;
        let photo = open.selected?;
        let graphics = self.graphics.as_mut()?;
        let geometry = open.geometry.as_ref()?;
        let mut show = show(state, open, ui, 1.0);
        // The surface alone.
        for scope in [
            &mut show.frusta,
            &mut show.images,
            &mut show.corner_rays,
            &mut show.outlines,
            &mut show.fills,
        ] {
            *scope = Scope::None;
        }
        (show.flight_line, show.axes, show.scale_bar) = (false, false, false);
        (show.photo_blend, show.project_photo, show.ground) = (0.0, false, None);
        (show.clip, show.beside) = (None, false);
        (show.hovered, show.measured, show.picked) = (None, Vec::new(), Vec::new());
        let outcomes = std::sync::Arc::as_ptr(open.review.outcomes()).addr();
        let surface = std::sync::Arc::as_ptr(geometry).addr();
        let of = Some((open.number, photo, surface, outcomes, show.clone()));
        if self.crops.of != of {
            graphics.upload(state, open, ui.visuals());
            let awaited = draw(&mut self.crops, graphics, open, photo, &show)?;
            if awaited {
                ui.ctx().request_repaint_after(AWAITED);
            }
            self.crops.of = of.filter(|_| !awaited);
        }
        let [a, b, c, d] = self.crops.textures;
        Some(Crops {
            photo,
            textures: [a?, b?, c?, d?],
        })
    }
}

/// Says whether finer points are on their way.
fn draw(
    crops: &mut Drawn,
    graphics: &mut Graphics,
    open: &OpenFlight,
    photo: usize,
    show: &Show,
) -> Option<bool> {
    let reviewed = open.review.photo(photo)?;
    let camera = reviewed.camera;
    let image = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let view = View::through(&reviewed, open.looking.orbit.distance);
    let mut awaited = false;
    for (index, name) in CornerName::ALL.into_iter().enumerate() {
        let middle = open.corner_in_view(photo, name)?;
        let view = view.into_photo(PhotoZoom {
            // A square that the longer side fits into, less that of the crop.
            factor: 1.0 / CROP,
            middle: middle / image,
        });
        let aside = &mut crops.asides[index];
        let (texture, is_coarse) = graphics
            .renderer
            .draw_aside(aside, &view, show, [SIDE, SIDE]);
        awaited |= is_coarse;
        let mut renderer = graphics.state.renderer.write();
        let device = &graphics.state.device;
        let filter = eframe::wgpu::FilterMode::Linear;
        match crops.textures[index] {
            None => {
                crops.textures[index] =
                    Some(renderer.register_native_texture(device, texture, filter));
            }
            Some(id) => {
                renderer.update_egui_texture_from_wgpu_texture(device, texture, filter, id);
            }
        }
    }
    // The main picture's lines were made for another sight.
    graphics.drawn = None;
    Some(awaited)
}
