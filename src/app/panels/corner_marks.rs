//! The marks of corners on a photo: a disc on the surface, a triangle on the ground, a cross for none.

use egui::{Color32, Pos2, Rect, Stroke, Vec2, vec2};

use crate::scale::CornerOutcome;

/// How far from a frame's edges a corner's mark stays.
pub(crate) const CORNER_ROOM: f32 = 7.0;

/// The place that is nearest to `at` in a frame, `room` from its edges; in a frame that has no such place its middle.
pub(crate) fn nearest_inside(frame: Rect, room: f32, at: Pos2) -> Pos2 {
    let inside = frame.shrink2(Vec2::splat(room).min(frame.size() / 2.0));
    // Never turned round, as what is shrunk by more than half of it would be: a frame may be smaller than a mark.
    match inside.is_negative() {
        true => frame.center(),
        false => inside.clamp(at),
    }
}

/// A disc for a corner on the surface, a triangle for one on the ground, a cross for none.
pub(crate) fn draw_corner(painter: &egui::Painter, at: Pos2, outcome: &CornerOutcome) {
    let outline = Stroke::new(1.5, Color32::from_black_alpha(200));
    match outcome {
        CornerOutcome::OnSurface { .. } => {
            painter.circle(at, 5.0, Color32::from_rgb(64, 200, 110), outline);
        }
        CornerOutcome::OnGround { .. } => {
            let points = vec![
                at + vec2(0.0, -6.0),
                at + vec2(6.0, 5.0),
                at + vec2(-6.0, 5.0),
            ];
            let fill = Color32::from_rgb(255, 176, 32);
            painter.add(egui::Shape::convex_polygon(points, fill, outline));
        }
        CornerOutcome::Nowhere | CornerOutcome::NoRay(_) => {
            let stroke = Stroke::new(2.5, Color32::from_rgb(240, 60, 60));
            for sign in [-1.0, 1.0] {
                painter.line_segment(
                    [at + vec2(-5.0, -5.0 * sign), at + vec2(5.0, 5.0 * sign)],
                    stroke,
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn a_mark_has_a_place_in_every_frame() {
        let far = pos2(-100.0, 400.0);
        let of = |width: f32, height: f32| {
            nearest_inside(
                Rect::from_min_size(pos2(10.0, 20.0), vec2(width, height)),
                7.0,
                far,
            )
        };
        assert_eq!(of(100.0, 50.0), pos2(17.0, 63.0));
        assert_eq!(of(14.0, 50.0), pos2(17.0, 63.0));
        assert_eq!(of(6.0, 0.0), pos2(13.0, 20.0));
        assert_eq!(of(-14.0, 50.0), pos2(3.0, 63.0));
    }
}
