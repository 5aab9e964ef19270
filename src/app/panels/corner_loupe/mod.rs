//! The corner loupe in the inspector: of each corner the photo beside the surface, seen from the same eye.

use egui::{Color32, Pos2, Rect, Sense, Stroke, pos2, vec2};
use glam::{DVec2, DVec3};

use super::corner_marks::{CORNER_ROOM, draw_corner, nearest_inside};
use crate::command::Command;
use crate::corner_loupe::{CROP, CornerTriangle};
use crate::flight::{Doubt, PhotoReview};
use crate::names::unbroken;
use crate::open_flight::OpenFlight;
use crate::scale::{Corner, CornerOutcome};
use crate::state::State;

/// The triangle that a corner lies on.
const TRIANGLE: Color32 = Color32::from_rgb(255, 120, 40);

/// The surface beside the photo's crops: a texture for each corner, of this photo.
#[derive(Debug, Clone, Copy)]
pub struct Crops {
    /// Which photo.
    pub photo: usize,
    /// In the contract's order.
    pub textures: [egui::TextureId; 4],
}

/// What a corner lies on, in words.
fn words(
    photo: PhotoReview<'_>,
    unit: &str,
    corner: &Corner,
    triangle: Option<CornerTriangle>,
) -> String {
    let name = corner.name.as_str().replace('_', " ");
    let edge = triangle.map(|triangle| triangle.longest_edge());
    let over_hole = photo.doubts.iter().any(
        |doubt| matches!(doubt, Doubt::LongTriangle { corners, .. } if corners.contains(&corner.name)),
    );
    match (corner.outcome, triangle, edge) {
        (CornerOutcome::OnSurface { .. }, _, Some(edge)) if over_hole => {
            format!("{name}: over a hole, its triangle has an edge of {edge:.3} {unit}")
        }
        (CornerOutcome::OnSurface { .. }, _, Some(edge)) => {
            format!("{name}: on a triangle with edges up to {edge:.3} {unit}")
        }
        (CornerOutcome::OnSurface { .. }, ..) => format!("{name}: on the surface"),
        (CornerOutcome::OnGround { .. }, Some(triangle), _) => {
            format!(
                "{name}: on the ground, {:.3} {unit} off the surface",
                triangle.off
            )
        }
        (CornerOutcome::OnGround { .. }, ..) => format!("{name}: on the ground"),
        (CornerOutcome::Nowhere, ..) => format!("{name}: missed, it meets nothing"),
        (CornerOutcome::NoRay(_), ..) => format!("{name}: no ray"),
    }
}

/// Draws the loupe, once it is opened. `texture` is the photo's, as its scale assumes it.
pub(super) fn corner_loupe(
    state: &State,
    open: &OpenFlight,
    photo: PhotoReview<'_>,
    texture: Option<egui::TextureId>,
    crops: Option<Crops>,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Some(scale) = photo.scale() else {
        return;
    };
    let is_open = state.preferences.loupe_open;
    let unit = open.flight().parts().unit_of_lengths();
    let heading = ui.selectable_label(is_open, "🔍 Corner loupe");
    heading.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::Button, true, is_open, "Corner loupe")
    });
    let hover = "The four corners enlarged, the photo beside the surface, with the triangle that each lies on";
    if heading.on_hover_text(hover).clicked() {
        commands.push(Command::ToggleLoupe);
    }
    if !is_open {
        return;
    }
    let facts = open
        .corners
        .as_ref()
        .filter(|facts| Some(facts.photo) == open.selected);
    let crops = crops.filter(|crops| Some(crops.photo) == open.selected);
    let side = ((ui.available_width() - 8.0) / 2.0).clamp(40.0, 170.0);
    for (index, corner) in scale.corners.iter().enumerate() {
        let triangle = facts.and_then(|facts| facts.triangles[index]);
        let text = words(photo, unit, corner, triangle);
        let (place, response) =
            ui.allocate_exact_size(vec2(2.0 * side + 4.0, side), Sense::click());
        response.widget_info(|| {
            let label = format!("Loupe {text}");
            egui::WidgetInfo::labeled(egui::Role::Button, true, label)
        });
        let left = Rect::from_min_size(place.min, vec2(side, side));
        let right = left.translate(vec2(side + 4.0, 0.0));
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        let painter = ui.painter().with_clip_rect(left);
        painter.rect_filled(left, 0.0, ui.visuals().extreme_bg_color);
        // The photo as shot or undistorted, as the scale is for it.
        let image = open.flight().parts().image;
        let camera = photo.camera;
        let of_image = Crop::new(left, corner.pixel, camera);
        if let Some(texture) = texture {
            let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
            let all = Rect::from_min_max(of_image.at(DVec2::ZERO), of_image.at(size));
            painter.image(texture, all, whole, Color32::WHITE);
        }
        let pose = photo.photo.pose;
        let seen = |point: DVec3| image.pixel(camera, pose.camera_from_world(point));
        draw_triangle(&painter, triangle, |point| Some(of_image.at(seen(point)?)));
        draw_corner(&painter, left.center(), &corner.outcome);
        let painter = ui.painter().with_clip_rect(right);
        painter.rect_filled(right, 0.0, ui.visuals().extreme_bg_color);
        if let Some(crops) = crops {
            painter.image(crops.textures[index], right, whole, Color32::WHITE);
        }
        if let Some(middle) = open
            .selected
            .and_then(|at| open.corner_in_view(at, corner.name))
        {
            let of_view = Crop::new(right, middle, camera);
            draw_triangle(&painter, triangle, |point| {
                let pixel = camera.pixel_undistorted(pose.camera_from_world(point))?;
                Some(of_view.at(pixel))
            });
            draw_corner(&painter, right.center(), &corner.outcome);
        }
        if response.on_hover_text("Click to go there").clicked() {
            commands.push(Command::GoToCorner(corner.name));
        }
        ui.add(egui::Label::new(unbroken(&text)).wrap());
    }
}

/// The corner that a click on a photo means: a marker is hit within its size. `to_screen` says where the
/// pixel of a corner is; markers stay inside of the frame.
pub(super) fn clicked(
    photo: PhotoReview<'_>,
    response: &egui::Response,
    frame: Rect,
    to_screen: impl Fn(DVec2) -> Option<Pos2>,
) -> Option<Command> {
    let at = response
        .interact_pointer_pos()
        .filter(|_| response.clicked())?;
    let corners = photo.scale_to_type()?.corners.iter();
    let near = corners.filter_map(|corner| {
        let marker = nearest_inside(frame, CORNER_ROOM, to_screen(corner.pixel)?);
        (marker.distance(at) <= 9.0).then_some((corner.name, marker.distance(at)))
    });
    let nearest = near.min_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Command::GoToCorner(nearest.0))
}

/// A part of an image on the screen.
struct Crop {
    place: Rect,
    middle: DVec2,
    /// Points of the screen for a pixel.
    scale: f64,
}

impl Crop {
    fn new(place: Rect, middle: DVec2, camera: &crate::camera::Camera) -> Self {
        let across = f64::from(camera.width.max(camera.height)) * CROP;
        Self {
            place,
            middle,
            scale: f64::from(place.width()) / across,
        }
    }

    fn at(&self, pixel: DVec2) -> Pos2 {
        let off = (pixel - self.middle) * self.scale;
        self.place.center() + vec2(off.x as f32, off.y as f32)
    }
}

fn draw_triangle(
    painter: &egui::Painter,
    triangle: Option<CornerTriangle>,
    to_screen: impl Fn(DVec3) -> Option<Pos2>,
) {
    let Some(triangle) = triangle else {
        return;
    };
    if let [Some(a), Some(b), Some(c)] = triangle.corners.map(to_screen) {
        for (width, color) in [(3.5, Color32::from_black_alpha(170)), (1.6, TRIANGLE)] {
            painter.add(egui::Shape::closed_line(
                vec![a, b, c],
                Stroke::new(width, color),
            ));
        }
    }
}
