//! Scale objects on the inspector's photo: their outlines, and points that are set and moved with the
//! mouse.

use egui::{Color32, Pos2, Rect, Stroke, Vec2, vec2};
use glam::DVec2;

use crate::camera::Camera;
use crate::clicks::{apart, clicked_places};
use crate::command::Command;
use crate::open_flight::OpenFlight;
use crate::open_flight::tracing::{Trace, Tracing, rounded};
use crate::scale::{ImageKind, ScaleObjectKind, Traced};

/// Within this distance the mouse means a point, screen points.
const REACH: f32 = 9.0;

/// Bright on rock, and not one of the colours that corners have.
const OUTLINE: Color32 = Color32::from_rgb(70, 225, 255);

/// Under lines and points, so that they are seen on any photo.
const SHADE: Color32 = Color32::from_black_alpha(210);

/// A photo on the screen: where it is, and which image of which camera it is.
pub(in crate::panels) struct PhotoPlace<'a> {
    /// The whole photo, also where it is cut off.
    pub rect: Rect,
    pub camera: &'a Camera,
    pub image: ImageKind,
}

impl PhotoPlace<'_> {
    /// Of a pixel of the image that is shown.
    pub(in crate::panels) fn to_screen(&self, pixel: DVec2) -> Pos2 {
        let share = vec2(
            (pixel.x / f64::from(self.camera.width)) as f32,
            (pixel.y / f64::from(self.camera.height)) as f32,
        );
        self.rect.min + share * self.rect.size()
    }

    /// The pixel of the image that is shown under a place of the screen, also beside the image.
    pub(in crate::panels) fn pixel_under(&self, at: Pos2) -> DVec2 {
        let share = (at - self.rect.min) / self.rect.size();
        DVec2::new(
            f64::from(share.x) * f64::from(self.camera.width),
            f64::from(share.y) * f64::from(self.camera.height),
        )
    }

    /// Of a pixel of the photo as shot, where the image that is shown has it.
    pub(in crate::panels) fn screen_of_shot(&self, pixel: DVec2) -> Option<Pos2> {
        let shown = match self.image {
            ImageKind::AsShot => pixel,
            ImageKind::Undistorted => {
                let direction = self.camera.direction_as_shot(pixel).ok()?;
                self.camera.pixel_undistorted(direction)?
            }
        };
        Some(self.to_screen(shown))
    }

    /// The pixel of the photo as shot under a place of the screen.
    pub(in crate::panels) fn shot_under(&self, at: Pos2) -> Option<DVec2> {
        let shown = self.pixel_under(at);
        match self.image {
            ImageKind::AsShot => Some(shown),
            ImageKind::Undistorted => {
                let direction = self.camera.direction_undistorted(shown);
                self.camera.pixel_as_shot(direction)
            }
        }
    }
}

/// A point that is being moved: which object (`None` for the one that is traced), which point of it,
/// and where to, in pixels as shot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::panels) struct Dragged {
    object: Option<usize>,
    point: usize,
    to: DVec2,
    /// From the mouse to the point: what is taken at its rim does not jump.
    grip: Vec2,
}

/// An outline on the photo.
struct Outline<'a> {
    /// Its place in the flight's list; `None` for the one that is traced.
    object: Option<usize>,
    kind: ScaleObjectKind,
    size: Option<f64>,
    points: &'a [DVec2],
}

/// The outlines on a photo, the one that is traced last.
fn outlines(open: &OpenFlight, photo: usize) -> Vec<Outline<'_>> {
    let done = open.objects_of(photo).map(|(place, object)| Outline {
        object: Some(place),
        kind: object.kind,
        size: Some(object.size),
        points: &object.outline,
    });
    let draft = open.objects.tracing.as_ref().map(|tracing| Outline {
        object: None,
        kind: tracing.kind,
        size: open.trace_size(tracing.kind),
        points: &tracing.outline,
    });
    done.chain(draft).collect()
}

/// Sets and moves points. Returns whether the mouse is taken, so that it does not move the photo.
pub(in crate::panels) fn mouse(
    open: &OpenFlight,
    photo: usize,
    place: &PhotoPlace<'_>,
    dragged: &mut Option<Dragged>,
    ui: &egui::Ui,
    response: &egui::Response,
    commands: &mut Vec<Command>,
) -> bool {
    let outlines = outlines(open, photo);
    let point_at = |at: Pos2| {
        let points = outlines.iter().flat_map(|outline| {
            let object = outline.object;
            let points = outline.points.iter().enumerate();
            points.map(move |(point, pixel)| (object, point, *pixel))
        });
        let near = points.filter_map(|(object, point, pixel)| {
            let grip = place.screen_of_shot(pixel)? - at;
            let to = pixel;
            (grip.length() <= REACH).then_some(Dragged {
                object,
                point,
                to,
                grip,
            })
        });
        near.min_by(|a, b| a.grip.length().total_cmp(&b.grip.length()))
    };
    let is_primary = response.dragged_by(egui::PointerButton::Primary);
    if response.drag_started() && is_primary {
        let origin = ui.input(|input| input.pointer.press_origin());
        *dragged = origin.and_then(point_at);
    }
    let at = response.interact_pointer_pos();
    if let (Some(moved), Some(at)) = (dragged.as_mut(), at)
        && let Some(pixel) = place.shot_under(at + moved.grip)
    {
        moved.to = pixel;
    }
    if response.drag_stopped()
        && let Some(moved) = dragged.take()
    {
        commands.extend(drop_point(open, moved));
        return true;
    }
    let Some(tracing) = &open.objects.tracing else {
        return dragged.is_some();
    };
    for at in apart(clicked_places(ui, response), REACH) {
        // Beside the photo there is nothing to mark.
        let pixel = place
            .shot_under(at)
            .filter(|&pixel| place.camera.contains(pixel));
        commands.extend(click(tracing, point_at(at), pixel));
    }
    if response.hovered() {
        ui.set_cursor_icon(egui::CursorIcon::Crosshair);
    }
    dragged.is_some()
}

/// What a click means while something is traced: another point, or the first one again to close the
/// outline. A second click on one of the others is none.
fn click(tracing: &Tracing, on: Option<Dragged>, pixel: Option<DVec2>) -> Option<Command> {
    match on {
        Some(Dragged {
            object: None,
            point: 0,
            ..
        }) => {
            let closes = tracing.kind == ScaleObjectKind::Sphere && tracing.is_complete();
            closes.then_some(Command::Trace(Trace::Finish))
        }
        Some(Dragged { object: None, .. }) => None,
        Some(_) | None => Some(Command::Trace(Trace::Add(pixel?))),
    }
}

/// What a point that is let go means.
fn drop_point(open: &OpenFlight, moved: Dragged) -> Option<Command> {
    let Some(object) = moved.object else {
        return Some(Command::Trace(Trace::Move(moved.point, moved.to)));
    };
    open.change_object(object, |object| {
        if let Some(place) = object.outline.get_mut(moved.point) {
            *place = rounded(moved.to);
        }
    })
}

/// Draws the outlines with their points.
pub(in crate::panels) fn draw(
    open: &OpenFlight,
    photo: usize,
    place: &PhotoPlace<'_>,
    dragged: Option<Dragged>,
    painter: &egui::Painter,
) {
    for (outline, number) in outlines(open, photo).into_iter().zip(1_usize..) {
        let mut points = outline.points.to_vec();
        if let Some(moved) = dragged.filter(|moved| moved.object == outline.object)
            && let Some(point) = points.get_mut(moved.point)
        {
            *point = moved.to;
        }
        let traced = outline
            .size
            .and_then(|size| Traced::new(place.camera, outline.kind, size, &points).ok());
        let on_screen: Vec<Pos2> = points
            .iter()
            .filter_map(|p| place.screen_of_shot(*p))
            .collect();
        match traced {
            Some(Traced::Sphere(sphere)) => {
                let round = sphere.outline(place.camera, place.image, 0.0, 96);
                let round = round.into_iter().map(|pixel| place.to_screen(pixel));
                line(
                    painter,
                    egui::Shape::closed_line,
                    &round.collect::<Vec<_>>(),
                );
                if let Some(center) = place.image.pixel(place.camera, sphere.center) {
                    let center = place.to_screen(center);
                    for arm in [vec2(4.0, 0.0), vec2(0.0, 4.0)] {
                        line(painter, egui::Shape::line, &[center - arm, center + arm]);
                    }
                }
            }
            Some(Traced::Bar(_)) | None => line(painter, egui::Shape::line, &on_screen),
        }
        let is_traced = outline.object.is_none();
        // Small on a small outline, so that they do not hide what it is around.
        let size = Rect::from_points(&on_screen).size().max_elem();
        let radius = match is_traced {
            true => 5.0,
            false => (size / 20.0).clamp(1.2, 3.5),
        };
        for at in &on_screen {
            painter.circle(
                *at,
                radius,
                Color32::WHITE,
                Stroke::new(radius * 0.5, SHADE),
            );
            painter.circle_filled(*at, radius * 0.35, Color32::from_rgb(190, 0, 90));
        }
        if !is_traced && let Some(top) = on_screen.iter().min_by(|a, b| a.y.total_cmp(&b.y)) {
            let text = number.to_string();
            label(
                painter,
                *top - vec2(0.0, 14.0),
                egui::Align2::CENTER_CENTER,
                text,
            );
        }
    }
}

/// A bright line with dark borders.
fn line(
    painter: &egui::Painter,
    shape: impl Fn(Vec<Pos2>, Stroke) -> egui::Shape,
    points: &[Pos2],
) {
    for (width, color) in [(4.0, SHADE), (2.0, OUTLINE)] {
        painter.add(shape(points.to_vec(), Stroke::new(width, color)));
    }
}

fn label(painter: &egui::Painter, at: Pos2, anchor: egui::Align2, text: String) {
    let font = egui::FontId::proportional(13.0);
    let galley = painter.layout_no_wrap(text, font, Color32::WHITE);
    let place = anchor.anchor_size(at, galley.size());
    painter.rect_filled(place.expand(3.0), 3.0, SHADE);
    painter.galley(place.min, galley, Color32::WHITE);
}
