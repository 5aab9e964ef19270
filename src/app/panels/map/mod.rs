//! The map: the plan of the flight, moved by dragging, larger and smaller by the wheel.
//!
//! ```text
//! over  grid, north, bar and what is under the mouse, drawn over it
//! ```

mod over;

use egui::{Color32, Pos2, Rect, Sense, Vec2, pos2, vec2};
use glam::DVec2;

use super::tool_bar::action_button;
use crate::actions;
use crate::command::Command;
use crate::exports::{MapFrame, PlanGround};
use crate::map::{MadePlan, MapCommand, PartInSight};
use crate::names;
use crate::open_flight::OpenFlight;
use crate::render::SELECTED;
use crate::state::State;
use crate::tasks::Task;

/// The ground of a dark window, so that light lines stand out from it.
const DARKENED: u8 = 118;
/// The same of photos, which are darker than a hillshade.
const PICTURE_DARKENED: u8 = 190;

/// Draws the page.
pub fn map(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    let fill = ui.visuals().panel_fill;
    let place = ui.available_rect_before_wrap();
    ui.painter().rect_filled(place, 0.0, fill);
    super::notice(state, ui, commands);
    want_plan(state, open, commands);
    super::head_of_middle(ui, |ui| choices(state, open, ui, commands));
    // However wide the row above would be.
    let whole = Rect::from_min_max(pos2(place.left(), ui.cursor().top()), place.max);
    ui.painter()
        .rect_filled(whole, 0.0, ui.visuals().extreme_bg_color);
    let Some(made) = &open.map.made else {
        match state.work.refused(Task::MAP, &open.map.wish()) {
            Some(reason) => super::inspector::message(ui.painter(), whole, reason, ui),
            None => {
                let text = "The map is being made: footprints come first.";
                super::inspector::waiting(ui.painter(), whole, text, ui);
            }
        }
        return;
    };
    // Coordinates stand beside the map: over it they would hide footprints.
    let frame = over::without_labels(&Screen::new(open, made, whole).map, whole, ui);
    let response = ui.allocate_rect(frame, Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Map"));
    let margins = ui.painter().with_clip_rect(whole);
    let painter = ui.painter().with_clip_rect(frame);
    let screen = Screen::new(open, made, frame);
    screen.mouse(ui, &response, commands);
    screen.want_part(state, open, made, ui, commands);
    screen.draw(open, made, &painter, ui);
    over::grid(&screen.map, &painter, &margins, frame, ui);
    screen.outline(open, made, open.table.hovered, &painter, 1.5);
    screen.outline(open, made, open.selected, &painter, 3.0);
    screen.survey(open, &painter);
    over::north(&made.plan, &painter, frame, ui);
    over::bar(
        &made.plan,
        &screen.map,
        state.preferences.unit(),
        &painter,
        frame,
        ui,
    );
    let Some(at) = response.hover_pos() else {
        return;
    };
    let point = screen.point(at);
    let photo = made.photos.at(&made.plan, point);
    if response.clicked()
        && let Some(photo) = photo
    {
        commands.push(Command::Select(Some(photo)));
    }
    screen.outline(open, made, photo, &painter, 1.5);
    over::words(made, point, photo, &painter, frame, ui);
}

/// What can be done with the map, what lies under it, and which coordinates it has.
fn choices(state: &State, open: &OpenFlight, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        let fit = ui.button("Fit");
        fit.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, "Fit map"));
        if fit.on_hover_text("Show all of the map").clicked() {
            commands.push(Command::Map(MapCommand::Fit));
        }
        action_button(
            state,
            actions::file::EXPORT_MAP,
            "Export map…",
            ui,
            commands,
        );
        ui.label("Ground");
        let has_colours = !open.flight().parts().surface.colors().is_empty();
        let has_files = open.files.photo_files.iter().any(|file| file.path.is_some());
        for (kind, label, hover, may) in [
            (PlanGround::Relief, "Relief", "The surface's hillshade", true),
            (
                PlanGround::Photos,
                "Photos",
                "Each place in the colour of the photo that shows it most squarely and from nearest",
                has_files,
            ),
            (
                PlanGround::Colours,
                "Colours",
                "The colours of the cloud's own points",
                has_colours,
            ),
            (PlanGround::Plain, "Plain", "Nothing under the footprints", true),
        ] {
            let chosen = open.map.ground == kind;
            let button = ui.add_enabled(may, egui::Button::selectable(chosen, label));
            let name = format!("Ground: {}", label.to_lowercase());
            button.widget_info(|| {
                egui::WidgetInfo::selected(egui::Role::Button, may, chosen, &name)
            });
            let button = button.on_hover_text(hover).on_disabled_hover_text(match kind {
                PlanGround::Photos => "No photo's file is there: add the folder of the photos",
                _ => "The cloud has no colours",
            });
            if button.clicked() && !chosen {
                commands.push(Command::Map(MapCommand::Ground(kind)));
            }
        }
        if let Some(made) = &open.map.made {
            let words = names::styled(ui, &made.plan.crs_in_words(), egui::TextStyle::Body, |text| {
                text.weak()
            });
            words.on_hover_text("The coordinate system of the map");
        }
    });
}

/// Asks for a plan where there is none of the review as it is now.
fn want_plan(state: &State, open: &OpenFlight, commands: &mut Vec<Command>) {
    let map = &open.map;
    let is_known = open.review.views().is_some() && open.is_computed();
    if is_known && map.of_now().is_none() && state.work.may_start(Task::MAP, &map.wish()) {
        commands.push(Command::Map(MapCommand::Make));
    }
}

/// The frame on the screen.
struct Screen {
    frame: Rect,
    /// In points.
    size: DVec2,
    middle: DVec2,
    map: MapFrame,
}

impl Screen {
    fn new(open: &OpenFlight, made: &MadePlan, frame: Rect) -> Self {
        let size = wide(frame.size()).max(DVec2::ONE);
        let (middle, scale) = open.map.looking.seen(&made.plan, size);
        Self {
            frame,
            size,
            middle,
            map: MapFrame::around(
                middle,
                wide(frame.min.to_vec2()).to_array(),
                size.to_array(),
                scale,
            ),
        }
    }

    fn place(&self, point: DVec2) -> Pos2 {
        let [x, y] = self.map.place(point);
        pos2(x as f32, y as f32)
    }

    fn point(&self, at: Pos2) -> DVec2 {
        self.map.point([f64::from(at.x), f64::from(at.y)])
    }

    /// The wheel zooms to the cursor, dragging moves, a double click fits.
    fn mouse(&self, ui: &egui::Ui, response: &egui::Response, commands: &mut Vec<Command>) {
        let size = self.size;
        if let Some(cursor) = response.hover_pos() {
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let factor = (f64::from(scroll) * 0.005).exp() * f64::from(pinch);
            if factor != 1.0 {
                let cursor = wide(cursor - self.frame.min);
                commands.push(Command::Map(MapCommand::Zoom {
                    cursor,
                    factor,
                    size,
                }));
            }
        }
        if response.dragged() && response.drag_delta() != Vec2::ZERO {
            let by = wide(response.drag_delta());
            commands.push(Command::Map(MapCommand::Pan { by, size }));
        }
        if response.double_clicked() {
            commands.push(Command::Map(MapCommand::Fit));
        }
    }

    /// Asks for a picture of what is in sight where the one that is there is another.
    fn want_part(
        &self,
        state: &State,
        open: &OpenFlight,
        made: &MadePlan,
        ui: &egui::Ui,
        commands: &mut Vec<Command>,
    ) {
        let part = PartInSight {
            revision: made.revision,
            middle: self.middle,
            scale: self.map.scale,
            size: self.size,
            pixels: f64::from(ui.ctx().pixels_per_point()),
            dark: ui.visuals().dark_mode,
            covered: over::covered(&made.plan, &self.map, state.preferences.unit(), self.frame)
                .map(|place| [place.min, place.max].map(|end| wide(end - self.frame.min))),
        };
        let is_drawn = open
            .map
            .drawn
            .as_ref()
            .is_some_and(|drawn| drawn.part == part);
        if !is_drawn && state.work.may_start(Task::MAP_PART, &part) {
            commands.push(Command::Map(MapCommand::Draw(part)));
        }
    }

    /// The ground, the finer one over it, and the photos.
    fn draw(&self, open: &OpenFlight, made: &MadePlan, painter: &egui::Painter, ui: &egui::Ui) {
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        let is_picture = matches!(
            made.plan.ground_kind,
            PlanGround::Photos | PlanGround::Colours
        );
        let tint = match (ui.visuals().dark_mode, is_picture) {
            (true, false) => Color32::from_gray(DARKENED),
            (true, true) => Color32::from_gray(PICTURE_DARKENED),
            (false, _) => Color32::WHITE,
        };
        let over = |[min, max]: [DVec2; 2]| Rect::from_two_pos(self.place(min), self.place(max));
        let coarse = over(made.plan.raster.bounds());
        painter.image(made.ground.id(), coarse, whole, tint);
        let Some(drawn) = &open.map.drawn else {
            return;
        };
        if let Some((ground, bounds)) = &drawn.ground {
            painter.image(ground.id(), over(*bounds), whole, tint);
        }
        let shown = open.map.shown(&made.plan, self.map.bounds());
        let shown = shown.unwrap_or(drawn);
        painter.image(
            shown.photos.id(),
            over(shown.frame.bounds()),
            whole,
            Color32::WHITE,
        );
    }

    /// The outline of one photo.
    fn outline(
        &self,
        open: &OpenFlight,
        made: &MadePlan,
        photo: Option<usize>,
        painter: &egui::Painter,
        width: f32,
    ) {
        let Some(photo) = photo.and_then(|photo| made.plan.photos.get(photo)) else {
            return;
        };
        let is_selected = open.selected.map(|photo| open.name(photo)) == Some(photo.name.as_str());
        let [red, green, blue] = SELECTED;
        let color = match is_selected {
            true => Color32::from_rgb(red, green, blue),
            false => painter
                .ctx()
                .style_of(painter.ctx().theme())
                .visuals
                .strong_text_color(),
        };
        let points = photo.outline.iter().map(|point| self.place(*point));
        let points: Vec<Pos2> = points.collect();
        painter.add(egui::Shape::closed_line(
            points,
            egui::Stroke::new(width, color),
        ));
    }

    /// The line or polygon that is measured on the pile.
    fn survey(&self, open: &OpenFlight, painter: &egui::Painter) {
        let Some(drawn) = &open.pointer.drawn else {
            return;
        };
        let points = drawn.outline(None).into_iter();
        let points: Vec<Pos2> = points.map(|point| self.place(point.truncate())).collect();
        for (width, color) in [(5.0, Color32::BLACK), (2.5, Color32::WHITE)] {
            painter.add(egui::Shape::line(
                points.clone(),
                egui::Stroke::new(width, color),
            ));
        }
    }
}

fn wide(v: Vec2) -> DVec2 {
    DVec2::new(f64::from(v.x), f64::from(v.y))
}

/// The corner of what lies over the map.
fn inside(frame: Rect, right: f32, down: f32) -> Pos2 {
    frame.min + vec2(right, down)
}
