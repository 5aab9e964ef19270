//! What lies over the photo: edges, bars, grid and corners of the image that the scale is for, bent where
//! the other one is shown; lines of equal scale.

use egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, vec2};
use glam::DVec2;

use super::{PhotoPlace, Tint, draw_bar};
use crate::flight::PhotoReview;
use crate::open_flight::OpenFlight;
use crate::open_flight::tint::PhotoTint;
use crate::panels::corner_marks::{CORNER_ROOM, draw_corner, nearest_inside};
use crate::picture::scale_bars;
use crate::scale::{Corner, CornerOutcome, ImageKind};
use crate::state::State;

/// Pieces of a line, so that it bends as the lens does.
const PIECES: u32 = 24;

/// Parts that the grid has each way.
const PARTS: u32 = 8;

/// What a corner lies on, in a word.
pub(in crate::panels) fn lies_on(outcome: &CornerOutcome) -> &'static str {
    match outcome {
        CornerOutcome::OnSurface { .. } => "surface",
        CornerOutcome::OnGround { .. } => "ground",
        CornerOutcome::Nowhere => "missed",
        CornerOutcome::NoRay(_) => "no ray",
    }
}

/// The image that the scales are for, where another one is shown.
struct Image<'a> {
    place: &'a PhotoPlace<'a>,
    kind: ImageKind,
}

impl Image<'_> {
    fn to_screen(&self, pixel: DVec2) -> Option<Pos2> {
        let shown = self
            .place
            .image
            .pixel_from(self.kind, self.place.camera, pixel)?;
        Some(self.place.to_screen(shown))
    }

    /// Between two of its pixels, piece by piece.
    fn line(&self, painter: &egui::Painter, from: DVec2, to: DVec2, strokes: &[Stroke]) {
        let place = |step: u32| {
            let share = f64::from(step) / f64::from(PIECES);
            self.to_screen(from.lerp(to, share))
        };
        let places: Vec<Option<Pos2>> = (0..=PIECES).map(place).collect();
        for &stroke in strokes {
            for run in places.split(Option::is_none) {
                let points: Vec<Pos2> = run.iter().copied().flatten().collect();
                if points.len() > 1 {
                    painter.add(egui::Shape::line(points, stroke));
                }
            }
        }
    }
}

#[expect(clippy::too_many_arguments, reason = "one call, all of them different")]
pub(super) fn draw(
    state: &State,
    open: &OpenFlight,
    reviewed: PhotoReview<'_>,
    tint: Option<&PhotoTint>,
    made: &mut Tint,
    place: &PhotoPlace<'_>,
    frame: Rect,
    ui: &egui::Ui,
) {
    let painter = &ui.painter().with_clip_rect(frame);
    let shows = state.preferences.photo_overlays;
    let (unit, kind) = (state.preferences.unit(), open.flight().parts().image);
    let image = Image { place, kind };
    let camera = place.camera;
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    if let Some(tint) = tint.filter(|_| kind == place.image && shows.isolines) {
        made.take(open, tint, reviewed, unit, ui);
        made.draw(painter, place.rect);
    }
    let dark = Color32::from_black_alpha(150);
    if shows.grid {
        let strokes = [
            Stroke::new(2.0, Color32::from_black_alpha(70)),
            Stroke::new(1.0, Color32::from_white_alpha(110)),
        ];
        for part in 1..PARTS {
            let at = size * (f64::from(part) / f64::from(PARTS));
            image.line(painter, DVec2::new(at.x, 0.0), at.with_y(size.y), &strokes);
            image.line(painter, DVec2::new(0.0, at.y), at.with_x(size.x), &strokes);
        }
    }
    if shows.edges {
        let [r, g, b] = crate::render::SELECTED;
        let strokes = [
            Stroke::new(3.5, dark),
            Stroke::new(1.5, Color32::from_rgb(r, g, b)),
        ];
        let corners = [DVec2::ZERO, size.with_y(0.0), size, size.with_x(0.0)];
        for side in 0..4 {
            image.line(painter, corners[side], corners[(side + 1) % 4], &strokes);
        }
    }
    let Some(scale) = reviewed.scale_to_type() else {
        return;
    };
    // In a small picture words would lie over each other.
    let seen = place.rect.intersect(frame);
    let has_room = seen.width() > 330.0 && seen.height() > 120.0;
    if shows.bars && has_room {
        let pair = reviewed.estimates(reviewed.pair, unit);
        let to_screen = |pixel: DVec2| {
            image
                .to_screen(pixel)
                .unwrap_or_else(|| place.to_screen(pixel))
        };
        for bar in scale_bars(pair, camera.width, camera.height, unit) {
            // One that is out of sight would stick to the frame's edge.
            let seen = Rect::from_two_pos(to_screen(bar.from), to_screen(bar.to));
            if seen.expand(2.0).intersects(frame) {
                draw_bar(painter, frame, &bar, &to_screen);
            }
        }
    }
    if shows.corners {
        for corner in &scale.corners {
            let Some(at) = image.to_screen(corner.pixel) else {
                continue;
            };
            if frame.expand(4.0).contains(at) {
                let inside = nearest_inside(frame, CORNER_ROOM, at);
                draw_corner(painter, inside, &corner.outcome);
                if has_room {
                    name(painter, frame, inside, corner);
                }
            }
        }
    }
}

/// Which corner it is and what it lies on, beside it on the inner side of the frame.
fn name(painter: &egui::Painter, frame: Rect, at: Pos2, corner: &Corner) {
    let is_left = at.x < frame.center().x;
    let is_above = at.y < frame.center().y;
    let anchor = match (is_left, is_above) {
        (true, true) => Align2::LEFT_TOP,
        (false, true) => Align2::RIGHT_TOP,
        (true, false) => Align2::LEFT_BOTTOM,
        (false, false) => Align2::RIGHT_BOTTOM,
    };
    let sign = |is: bool| if is { 1.0 } else { -1.0 };
    let at = at + vec2(11.0 * sign(is_left), 5.0 * sign(is_above));
    let words = format!(
        "{}: {}",
        corner.name.as_str().replace('_', " "),
        lies_on(&corner.outcome)
    );
    let galley = painter.layout_no_wrap(words, FontId::proportional(12.0), Color32::WHITE);
    let place = anchor.anchor_size(at, galley.size());
    painter.rect_filled(place.expand(2.0), 2.0, Color32::from_black_alpha(150));
    painter.galley(place.min, galley, Color32::WHITE);
}
