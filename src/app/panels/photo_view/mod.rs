//! The selected photo in the middle of the window: tiles of it as fine as the screen, and what lies over it.

mod control_marks;
mod head;
mod overlays;

use egui::{Color32, Key, Modifiers, Pos2, Rect, Sense, Vec2, pos2, vec2};
use glam::DVec2;

use super::accessible::{described, scales_in_words};
use super::corner_loupe;
use super::fragments::OnPhoto;
use super::inspector::tint::{self, Tint};
use super::inspector::traced_photo::{self, Dragged, PhotoPlace};
use super::inspector::{draw_bar, message, waiting};
use super::linked;
use crate::command::Command;
use crate::exports::PhotoLine;
use crate::flight::PhotoReview;
use crate::linked::PointFrom;
use crate::open_flight::OpenFlight;
use crate::photo_view::PhotoCommand;
use crate::photo_view::tiles::MOST_TILES;
use crate::picture::{PhotoPyramid, TileKey};
use crate::size_distributions::Page;
use crate::state::State;
use crate::tasks::Task;

/// What the panel keeps: what it has made of the tint, and a point or a mark that the mouse moves.
#[derive(Default)]
pub struct PhotoPanel {
    tint: Tint,
    dragged: Option<Dragged>,
    mark: Option<control_marks::DraggedMark>,
    fragments: OnPhoto,
}

impl PhotoPanel {
    /// Draws it into all the place that is there.
    pub fn show(&mut self, state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        let Some(open) = &state.open else {
            return;
        };
        super::head_of_middle(ui, |ui| head::head(state, open, ui, commands));
        let frame = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(frame, Sense::click_and_drag());
        let painter = ui.painter().with_clip_rect(frame);
        painter.rect_filled(frame, 0.0, ui.visuals().extreme_bg_color);
        let reviewed = open
            .selected
            .and_then(|photo| Some((photo, open.review.photo(photo)?)));
        let Some((photo, reviewed)) = reviewed else {
            response
                .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Photo view"));
            let text = "Select a photo in the table or in the viewport.";
            waiting(&painter, frame, text, ui);
            return;
        };
        response.widget_info(|| {
            let label = format!("Photo view {}", reviewed.name());
            egui::WidgetInfo::labeled(egui::Role::Image, true, label)
        });
        described(&response, || in_words(state, open, photo));
        keys(ui, commands);
        let is_fragments = state.page == Page::Fragments;
        if !is_fragments {
            control_marks::keys(open, photo, ui, commands);
        }
        let screen = Screen::new(open, reviewed, frame, ui);
        let place = screen.place(open, reviewed);
        let dragged = &mut self.dragged;
        let taken = match open.control.is_on {
            _ if is_fragments => self.fragments.mouse(open, &place, ui, &response, commands),
            true => {
                let mark = &mut self.mark;
                control_marks::mouse(open, photo, &place, mark, ui, &response, commands)
            }
            false => traced_photo::mouse(open, photo, &place, dragged, ui, &response, commands),
        };
        screen.mouse(ui, &response, taken, commands);
        let full = open.photo_view.full_of(photo);
        match full.map(|full| &full.pixels) {
            Some(Ok(pixels)) => {
                let wanted = screen.tiles(&place, pixels);
                if wanted != open.photo_view.tiles.wanted() {
                    commands.push(Command::Photo(PhotoCommand::Want(wanted)));
                }
                draw_tiles(open, &place, pixels, &painter);
            }
            Some(Err(reason)) => message(&painter, frame, reason, ui),
            // The thumbnail stands in until the photo is read.
            None => {
                if let Some(Some(texture)) = open.pictures.thumbnails.get(photo) {
                    let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
                    painter.image(texture.id(), place.rect, whole, Color32::from_gray(140));
                }
                if state.work.is_running(Task::FULL_PHOTO) {
                    waiting(&painter, frame, "Reading the photo at full resolution…", ui);
                }
            }
        }
        if is_fragments {
            self.fragments.draw(open, photo, &place, frame, ui);
            return;
        }
        // What is marked may lie under them, and a click on a corner is a mark then.
        let is_pointed_at = open.objects.tracing.is_some() || open.control.is_on;
        if !is_pointed_at {
            let tint = tint::wanted(state, open, reviewed);
            overlays::draw(
                state,
                open,
                reviewed,
                tint,
                &mut self.tint,
                &place,
                frame,
                ui,
            );
        }
        if !is_pointed_at && state.preferences.photo_overlays.corners {
            let kind = open.flight().parts().image;
            let to_screen = |pixel| {
                let at = place.to_screen(place.image.pixel_from(kind, place.camera, pixel)?);
                frame.expand(4.0).contains(at).then_some(at)
            };
            commands.extend(corner_loupe::clicked(reviewed, &response, frame, to_screen));
        }
        traced_photo::draw(open, photo, &place, self.dragged, &painter);
        control_marks::draw(open, photo, &place, self.mark, &painter);
        if open.control.is_on {
            // Its ring and its words would lie on what is to be marked.
            return;
        }
        linked::on_photo(
            state,
            open,
            PointFrom::Photo,
            &place,
            frame,
            ui,
            &response,
            commands,
        );
    }
}

/// What is shown, for who does not see it: which photo of how many, and its scales.
fn in_words(state: &State, open: &OpenFlight, photo: usize) -> String {
    let place = format!("photo {} of {}", photo + 1, open.review.count());
    let Some(row) = open.row(photo) else {
        return place;
    };
    let line = PhotoLine {
        unit: state.preferences.unit(),
        to_type: true,
        ..row.line
    };
    format!("{place}, {}", scales_in_words(state, &line))
}

/// The keys that this panel alone has: the arrows to the sides go to the next photo, as those up and down.
fn keys(ui: &egui::Ui, commands: &mut Vec<Command>) {
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    for (key, rows) in [(Key::ArrowRight, 1), (Key::ArrowLeft, -1)] {
        if ui.input_mut(|input| input.consume_key(Modifiers::NONE, key)) {
            commands.push(Command::SelectBy(rows));
        }
    }
}

/// The frame on the screen.
struct Screen {
    frame: Rect,
    pixels_per_point: f64,
    /// In pixels of the screen.
    size: DVec2,
    /// The image's size in pixels of its camera.
    image: DVec2,
}

impl Screen {
    fn new(_open: &OpenFlight, reviewed: PhotoReview<'_>, frame: Rect, ui: &egui::Ui) -> Self {
        let pixels_per_point = f64::from(ui.ctx().pixels_per_point());
        let camera = reviewed.camera;
        let size = DVec2::new(f64::from(frame.width()), f64::from(frame.height()));
        Self {
            frame,
            pixels_per_point,
            size: (size * pixels_per_point).max(DVec2::ONE),
            image: DVec2::new(f64::from(camera.width), f64::from(camera.height)),
        }
    }

    /// Where the photo is.
    fn place<'a>(&self, open: &OpenFlight, reviewed: PhotoReview<'a>) -> PhotoPlace<'a> {
        let placing = open.photo_view.placing;
        let corner = placing.corner(self.image, self.size) / self.pixels_per_point;
        let size = self.image * placing.scale(self.image, self.size) / self.pixels_per_point;
        let narrow = |v: DVec2| vec2(v.x as f32, v.y as f32);
        PhotoPlace {
            rect: Rect::from_min_size(self.frame.min + narrow(corner), narrow(size)),
            camera: reviewed.camera,
            image: open.photo_view.image_for(open.flight().parts().image),
        }
    }

    /// The wheel zooms to the cursor, dragging moves, a double click fits.
    fn mouse(
        &self,
        ui: &egui::Ui,
        response: &egui::Response,
        taken: bool,
        commands: &mut Vec<Command>,
    ) {
        let frame = self.size;
        let wide = |v: Vec2| DVec2::new(f64::from(v.x), f64::from(v.y)) * self.pixels_per_point;
        if let Some(cursor) = response.hover_pos() {
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let factor = (f64::from(scroll) * 0.005).exp() * f64::from(pinch);
            if factor != 1.0 {
                commands.push(Command::Photo(PhotoCommand::Zoom {
                    cursor: wide(cursor - self.frame.min),
                    factor,
                    frame,
                }));
            }
        }
        if response.dragged() && !taken && response.drag_delta() != Vec2::ZERO {
            commands.push(Command::Photo(PhotoCommand::Pan {
                by: wide(response.drag_delta()),
                frame,
            }));
        }
        if response.double_clicked() && !taken {
            commands.push(Command::Photo(PhotoCommand::Fit));
        }
    }

    /// The tiles that are to be seen, the one that stands in for all of them first.
    fn tiles(&self, place: &PhotoPlace<'_>, pixels: &PhotoPyramid) -> Vec<TileKey> {
        let share = |at: Pos2| {
            let share = (at - place.rect.min) / place.rect.size();
            DVec2::new(f64::from(share.x), f64::from(share.y))
        };
        let (from, to) = (share(self.frame.min), share(self.frame.max));
        let last = pixels.levels() - 1;
        let mut wanted = pixels.tiles_in(last, DVec2::ZERO, DVec2::ONE);
        if from.cmpgt(DVec2::ONE).any() || to.cmplt(DVec2::ZERO).any() {
            return wanted;
        }
        let (columns, _) = pixels.size();
        let wide = f64::from(place.rect.width()) * self.pixels_per_point;
        let mut level = pixels.level_for(wide / f64::from(columns));
        let mut tiles = pixels.tiles_in(level, from, to);
        // On a very large screen a coarser level must do.
        while tiles.len() >= MOST_TILES && level < last {
            level += 1;
            tiles = pixels.tiles_in(level, from, to);
        }
        if level < last {
            let middle = (from + to) * 0.5;
            let off = |key: &TileKey| {
                let place = pixels.place(*key).map(|[[from, to], _]| (from + to) * 0.5);
                place.map_or(f64::INFINITY, |place| place.distance(middle))
            };
            tiles.sort_by(|a, b| off(a).total_cmp(&off(b)));
            wanted.extend(tiles);
        }
        wanted
    }
}

/// Draws what is there of the photo, fine tiles over coarse ones.
fn draw_tiles(
    open: &OpenFlight,
    place: &PhotoPlace<'_>,
    pixels: &PhotoPyramid,
    painter: &egui::Painter,
) {
    let narrow = |share: DVec2| vec2(share.x as f32, share.y as f32);
    for (key, texture) in open.photo_view.tiles.there() {
        let is_wanted = open.photo_view.tiles.wanted().contains(&key);
        let Some([[from, to], [start, end]]) = pixels.place(key).filter(|_| is_wanted) else {
            continue;
        };
        let at = |share: DVec2| place.rect.min + narrow(share) * place.rect.size();
        let on_screen = Rect::from_min_max(at(from), at(to));
        let inner = Rect::from_min_max(narrow(start).to_pos2(), narrow(end).to_pos2());
        painter.image(texture.id(), on_screen, inner, Color32::WHITE);
    }
}
