//! What the viewport has uploaded, and when it draws anew.

use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui_wgpu::RenderState;
use egui::{Color32, Pos2, Rect, pos2};

use super::Scene;
use crate::flight::Outcome;
use crate::open_flight::OpenFlight;
use crate::opening_preview::OpeningPreview;
use crate::panels::line_color;
use crate::render::{
    BesideCloud, Gpu, PhotoGeometry, PhotoLook, Renderer, Show, SurfaceBuffers, View,
};
use crate::scale::ViewFacts;
use crate::state::State;

/// How long the view must rest before everything is drawn.
const REST: Duration = Duration::from_millis(250);

/// Points drawn while the view moves, on a graphics card and without one. They stand for the
/// triangles too where those are more than twice as many.
const MOVING_POINTS: [usize; 2] = [2_000_000, 100_000];

/// Triangles or points drawn in one frame when the view has come to rest, likewise: the window
/// answers meanwhile.
const PORTION: [usize; 2] = [usize::MAX, 400_000];

/// How soon a picture is drawn again for which points are on their way.
pub(super) const AWAITED: Duration = Duration::from_millis(16);

pub(super) struct Graphics {
    pub(super) state: RenderState,
    pub(super) gpu: Gpu,
    pub(super) renderer: Renderer,
    pub(super) texture: Option<egui::TextureId>,
    pub(super) uploaded: Uploaded,
    pub(super) drawn: Option<(View, Show, [u32; 2])>,
    /// What was looked at last, and since when; `None` where that is new.
    pub(super) moved: Option<(View, [u32; 2], Instant)>,
}

/// What the renderer has, to see what is new.
#[derive(Default)]
pub(super) struct Uploaded {
    pub(super) flight: Option<u64>,
    /// The first look at a surface that is read, instead of a flight.
    pub(super) preview: Option<Arc<SurfaceBuffers>>,
    pub(super) geometry: Option<Arc<SurfaceBuffers>>,
    /// The scales and views that the photos' lines were made of.
    pub(super) outcomes: Option<Arc<Vec<Outcome>>>,
    pub(super) views: Option<Arc<Vec<Option<ViewFacts>>>>,
    /// The order of the flight line.
    pub(super) line: Option<Arc<Vec<usize>>>,
    pub(super) images: Vec<bool>,
    pub(super) projected: Option<(usize, u64)>,
    pub(super) looks: Vec<PhotoLook>,
    /// The clouds beside the surface.
    pub(super) beside: Vec<Arc<BesideCloud>>,
}

impl Graphics {
    /// Uploads what is new.
    pub(super) fn upload(&mut self, state: &State, open: &OpenFlight, visuals: &egui::Visuals) {
        let uploaded = &mut self.uploaded;
        if uploaded.flight != Some(open.number) {
            *uploaded = Uploaded {
                flight: Some(open.number),
                images: vec![false; open.pictures.images.len()],
                ..Uploaded::default()
            };
            self.renderer.start(&open.extent.frame);
            self.renderer.set_bulk(Some(&open.extent.bulk));
            self.drawn = None;
        }
        let same_geometry = same(uploaded.geometry.as_ref(), open.geometry.as_ref());
        if !same_geometry {
            uploaded.geometry.clone_from(&open.geometry);
            self.renderer.set_surface(open.geometry.as_deref());
            (self.drawn, self.moved) = (None, None);
        }
        let beside = open.shown_beside();
        let both = || uploaded.beside.iter().zip(&beside);
        let same_beside =
            uploaded.beside.len() == beside.len() && both().all(|(a, b)| Arc::ptr_eq(a, b));
        if !same_beside {
            let clouds = beside.iter().map(|cloud| BesideCloud::clone(cloud));
            self.renderer.set_beside(clouds);
            uploaded.beside = beside;
            self.drawn = None;
        }
        let same_photos = same(uploaded.outcomes.as_ref(), Some(open.review.outcomes()))
            && same(uploaded.views.as_ref(), open.review.views());
        if !same_photos {
            uploaded.outcomes = Some(open.review.outcomes().clone());
            uploaded.views = open.review.views().cloned();
            let photos = PhotoGeometry::of_review(&open.extent.frame, &open.review);
            self.renderer.set_photos(photos);
            uploaded.looks.clear();
            uploaded.line = None;
            (self.drawn, self.moved) = (None, None);
        }
        if !same(uploaded.line.as_ref(), Some(&open.line)) {
            uploaded.line = Some(open.line.clone());
            self.renderer.set_flight_line(open.line.to_vec());
            self.drawn = None;
        }
        let may_fall = state.may_fall();
        let looks: Vec<PhotoLook> = open
            .review
            .photos()
            .map(|photo| {
                let settled = photo.settled();
                let last_word = settled.filter(|verdict| Some(*verdict) != may_fall);
                let color = line_color(last_word, visuals);
                let [red, green, blue, _] = color.to_array();
                PhotoLook {
                    visible: true,
                    color: [red, green, blue],
                }
            })
            .collect();
        if uploaded.looks != looks {
            self.renderer.set_looks(&looks);
            uploaded.looks = looks;
            self.drawn = None;
        }
        for (index, image) in open.pictures.images.iter().enumerate() {
            if let Some(image) = image
                && !uploaded.images[index]
            {
                self.renderer.set_photo_image(index, image);
                uploaded.images[index] = true;
                self.drawn = None;
            }
        }
        let preview = open
            .pictures
            .preview
            .as_ref()
            .filter(|preview| Some(preview.photo) == open.selected);
        let projected = preview.map(|preview| (preview.photo, preview.number));
        if uploaded.projected != projected {
            uploaded.projected = projected;
            let picture = preview.and_then(|preview| {
                let picture = preview.picture.as_ref().ok()?;
                Some((preview.photo, picture.projected.clone()?))
            });
            self.renderer.set_uploaded_photo(picture);
            self.drawn = None;
        }
    }

    /// Uploads a first look at a surface, where that is new.
    pub(super) fn upload_preview(&mut self, preview: &OpeningPreview) {
        if preview.points.is_none() || same(self.uploaded.preview.as_ref(), preview.points.as_ref())
        {
            return;
        }
        self.uploaded = Uploaded {
            preview: preview.points.clone(),
            geometry: preview.points.clone(),
            ..Uploaded::default()
        };
        self.renderer.start(&preview.frame);
        self.renderer.set_surface(preview.points.as_deref());
        (self.drawn, self.moved) = (None, None);
    }

    /// Draws the scene where it has changed, and shows it.
    pub(super) fn draw(&mut self, scene: &Scene, show: &Show, ui: &egui::Ui) {
        let mut show = show.clone();
        let now = Instant::now();
        let rests_since = match self.moved {
            Some((view, size, since)) if view == scene.view && size == scene.size => since,
            _ => now,
        };
        self.moved = Some((scene.view, scene.size, rests_since));
        let software = usize::from(self.gpu.software);
        let points = self.uploaded.geometry.as_deref();
        let points = points.map_or(0, |geometry| geometry.points);
        let many = points > MOVING_POINTS[software];
        if many && now.duration_since(rests_since) < REST {
            show.max_points = Some(MOVING_POINTS[software]);
            show.wireframe = false;
            ui.ctx().request_repaint_after(REST);
        }
        let wanted = (scene.view, show, scene.size);
        if self.drawn.as_ref() != Some(&wanted) {
            let portion = PORTION[software];
            let drawn = self
                .renderer
                .draw_portion(&wanted.0, &wanted.1, scene.size, portion);
            if !drawn.whole {
                ui.ctx().request_repaint();
            }
            if let Some(view) = self.renderer.color_view() {
                let mut renderer = self.state.renderer.write();
                let device = &self.state.device;
                let nearest = eframe::wgpu::FilterMode::Nearest;
                match self.texture {
                    None => {
                        self.texture =
                            Some(renderer.register_native_texture(device, view, nearest));
                    }
                    Some(texture) if drawn.new_texture => {
                        renderer
                            .update_egui_texture_from_wgpu_texture(device, view, nearest, texture);
                    }
                    Some(_) => {}
                }
            }
            if drawn.awaited {
                // Points of a large cloud are on their way; an idle window draws nothing once they are here.
                ui.ctx().request_repaint_after(AWAITED);
            }
            self.drawn = (drawn.whole && !drawn.awaited).then_some(wanted);
        }
        if let Some(texture) = self.texture {
            let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            ui.painter()
                .image(texture, scene.place, whole, Color32::WHITE);
        }
    }
}

/// Whether both are the same piece of memory, or both missing.
fn same<T>(a: Option<&Arc<T>>, b: Option<&Arc<T>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (None, None) => true,
        _ => false,
    }
}
