//! The flight plan over the surface: its lines in the picture, and handles for what is dragged over the ground.

use egui::{Color32, CursorIcon, Rect, Sense, Stroke, vec2};
use glam::{DVec2, DVec3};

use super::Scene;
use super::words::haloed;
use crate::command::Command;
use crate::geometry::Ray;
use crate::open_flight::OpenFlight;
use crate::plan::Terrain;
use crate::planning::{Handle, PlanStep, PlanTool};
use crate::render::{Scope, Show};

/// Side of what the mouse takes hold of, points.
const HOLD: f32 = 18.0;
const RADIUS: f32 = 5.0;
/// How often the place under the mouse is looked for again at the height of the place before.
const ROUNDS: usize = 12;

/// The plan in place of the flight's own photos.
pub(super) fn show_planned(open: &OpenFlight, show: &mut Show) {
    show.frusta = Scope::None;
    show.images = Scope::None;
    show.corner_rays = Scope::None;
    show.outlines = Scope::None;
    show.fills = Scope::None;
    show.flight_line = false;
    show.project_photo = false;
    show.photo_blend = 0.0;
    show.measured.clear();
    show.drawn_lines.clear();
    show.drawn_points.clear();
    let planning = &open.planning;
    if planning.flown.is_some() {
        show.frusta = Scope::All;
        show.planned_lines = planning.lines();
        return;
    }
    if !planning.through && planning.refused().is_none() {
        show.planned_lines = planning.lines();
    }
    let on_ground = Heights::of(open);
    // What is asked for stands there before it is planned, and where it cannot be.
    if let Some(now) = planning.now().filter(|_| !planning.is_of_now()) {
        for corners in now.area.iter().chain(&now.keep_out) {
            let around = corners.iter().chain(corners.first());
            let around = around.map(|corner| on_ground.at(*corner));
            show.drawn_lines.push(around.collect());
        }
    }
    let mut corners = planning.drawing.clone();
    if !corners.is_empty() {
        corners.extend(open.pointer.hover.map(|point| point.truncate()));
    }
    show.drawn_points = corners.iter().map(|corner| on_ground.at(*corner)).collect();
    show.drawn_lines.push(show.drawn_points.clone());
}

/// How high places of the map are drawn.
struct Heights<'a> {
    terrain: Option<&'a Terrain>,
    /// Where that has no ground.
    otherwise: f64,
}

impl<'a> Heights<'a> {
    fn of(open: &'a OpenFlight) -> Self {
        Self {
            terrain: open.planning.made.as_ref().map(|made| &made.plan.terrain),
            otherwise: open.ground(),
        }
    }

    /// A place of the map on the ground.
    fn at(&self, place: DVec2) -> DVec3 {
        let height = self.terrain.and_then(|terrain| terrain.height(place));
        place.extend(height.unwrap_or(self.otherwise))
    }
}

/// Where a ray meets the ground: on the level of the place before, again and again.
fn on_ground(ray: &Ray, from: DVec3, terrain: &Terrain) -> Option<DVec2> {
    let mut height = from.z;
    let mut place = None;
    for _ in 0..ROUNDS {
        let along = (height - ray.origin.z) / ray.direction.z;
        if !(along > 0.0 && along.is_finite()) {
            break;
        }
        let found = (ray.origin + ray.direction * along).truncate();
        place = Some(found);
        match terrain.height(found) {
            // Half of the way: a steep slope would be jumped over.
            Some(ground) => height = (height + ground) / 2.0,
            None => break,
        }
    }
    place
}

/// Darkens what a photo that is looked through does not show.
pub(super) fn frame(open: &OpenFlight, scene: &Scene, ui: &egui::Ui) {
    let planning = &open.planning;
    let (Some((_, photo)), Some(made), true) = (planning.photo(), &planning.made, planning.through)
    else {
        return;
    };
    let camera = &made.plan.camera;
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let corner = |pixel: DVec2| {
        let direction = photo.pose.rotation * camera.direction_undistorted(pixel);
        let point = photo.pose.center + direction * photo.distance;
        Some(scene.screen(scene.view.project(point, scene.size())?))
    };
    let (Some(first), Some(last)) = (corner(DVec2::ZERO), corner(size)) else {
        return;
    };
    let (whole, inside) = (scene.place, Rect::from_two_pos(first, last));
    let painter = ui.painter().with_clip_rect(whole);
    let dark = Color32::from_black_alpha(150);
    let middle = |left: f32, right: f32| {
        Rect::from_min_max(
            egui::pos2(left, inside.top()),
            egui::pos2(right, inside.bottom()),
        )
    };
    for beside in [
        Rect::from_min_max(whole.min, egui::pos2(whole.right(), inside.top())),
        Rect::from_min_max(egui::pos2(whole.left(), inside.bottom()), whole.max),
        middle(whole.left(), inside.left()),
        middle(inside.right(), whole.right()),
    ] {
        if beside.is_positive() {
            painter.rect_filled(beside, 0.0, dark);
        }
    }
    let stroke = Stroke::new(1.0, Color32::WHITE);
    painter.rect_stroke(inside, 0.0, stroke, egui::StrokeKind::Inside);
}

/// Draws the handles, and drags them.
pub(super) fn handles(
    open: &OpenFlight,
    scene: &Scene,
    ui: &egui::Ui,
    commands: &mut Vec<Command>,
) {
    let planning = &open.planning;
    let (Some(made), Some(now)) = (&planning.made, planning.now()) else {
        return;
    };
    // A click that is to be a corner must not be taken by one that is there.
    if planning.flown.is_some() || planning.through || planning.tool != PlanTool::Select {
        return;
    }
    let mut all: Vec<(Handle, DVec2, String, Color32)> = Vec::new();
    let area = now.area.as_deref().unwrap_or(made.plan.area.corners());
    for (corner, place) in area.iter().enumerate() {
        let label = format!("Corner {} of the area", corner + 1);
        all.push((Handle::Area(corner), *place, label, Color32::WHITE));
    }
    for (area, corners) in now.keep_out.iter().enumerate() {
        for (corner, place) in corners.iter().enumerate() {
            let label = format!("Corner {} of keep-out {}", corner + 1, area + 1);
            let color = Color32::from_rgb(225, 60, 60);
            all.push((Handle::KeepOut(area, corner), *place, label, color));
        }
    }
    if let Some(place) = now.take_off {
        let color = Color32::from_rgb(90, 160, 255);
        all.push((Handle::TakeOff, place, "Take-off".to_owned(), color));
    }
    if let Some((_, photo)) = planning.photo() {
        let place = photo.target.truncate();
        let label = format!("Middle of {}", photo.name);
        let color = Color32::from_rgb(240, 190, 40);
        all.push((Handle::Photo(photo.name.clone()), place, label, color));
    }
    let painter = ui.painter().with_clip_rect(scene.place);
    let terrain = &made.plan.terrain;
    let heights = Heights::of(open);
    for (handle, place, label, color) in all {
        let point = heights.at(place);
        let Some(pixel) = scene.view.project(point, scene.size()) else {
            continue;
        };
        let on_screen = scene.screen(pixel);
        if !scene.place.contains(on_screen) {
            continue;
        }
        let id = ui.scope_id().with(("handle of the plan", &label));
        let hold = Rect::from_center_size(on_screen, vec2(HOLD, HOLD));
        let response = ui.interact(hold, id, Sense::drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, &label));
        let is_held = response.hovered() || response.dragged();
        let radius = if is_held { RADIUS + 2.0 } else { RADIUS };
        let rim = Stroke::new(1.5, Color32::from_black_alpha(200));
        painter.circle(on_screen, radius, color, rim);
        if handle == Handle::TakeOff {
            let corner = on_screen + vec2(0.0, 9.0);
            haloed(
                &painter,
                corner,
                egui::Align2::CENTER_TOP,
                "take-off",
                13.0,
                ui.visuals().strong_text_color(),
                ui,
            );
        }
        if response.dragged()
            && let Some(mouse) = response.interact_pointer_pos()
        {
            let ray = scene.view.ray(scene.pixel(mouse), scene.size());
            if let Some(to) = on_ground(&ray, point, terrain).filter(|to| *to != place) {
                commands.push(Command::Plan(PlanStep::Drag(handle, to)));
            }
        } else if response.drag_stopped() {
            commands.push(Command::Plan(PlanStep::Drop));
        }
        response
            .on_hover_cursor(CursorIcon::Grab)
            .on_hover_text(label);
    }
}
