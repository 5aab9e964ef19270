//! Where the small window of a finished profile opens: beside its line, which is what is looked at.

use egui::{Align2, Pos2, Rect, Vec2, Window, vec2};
use glam::{DVec2, DVec3};

use crate::open_flight::OpenFlight;
use crate::open_flight::survey::Drawn;
use crate::state::State;

/// How large the window is before anybody has seen one, with plot and numbers, points.
const EXPECTED: Vec2 = vec2(456.0, 400.0);

/// Between the window and the viewport's edge, and between it and the line, points.
const GAP: f32 = 8.0;

/// What the buttons over the viewport take of its height, points.
const BUTTONS: f32 = 40.0;

/// Where it may stand, the best first: at the lower edge, as the windows of the other tools.
const PLACES: [Align2; 6] = [
    Align2::CENTER_BOTTOM,
    Align2::LEFT_BOTTOM,
    Align2::RIGHT_BOTTOM,
    Align2::LEFT_TOP,
    Align2::RIGHT_TOP,
    Align2::CENTER_TOP,
];

/// Points of a profile that are looked at, at most, and those of each way between two of its corners.
const MOST_POINTS: usize = 400;
const BETWEEN: u8 = 32;

/// Puts the window beside the line once that is finished; later it stands where it was moved to, also for the next line
/// where it does not cover that.
pub(super) fn beside_its_line<'a>(
    window: Window<'a>,
    state: &State,
    (open, drawn): (&OpenFlight, &Drawn),
    context: &egui::Context,
    place: Rect,
) -> Window<'a> {
    // While the line is drawn the window is a small one of its own.
    let id = egui::Id::unique("finished profile");
    let window = window.id(id);
    let before: Option<Vec<DVec3>> = context.data(|data| data.get_temp(id));
    if before.as_ref() == Some(&drawn.points) {
        return window;
    }
    context.data_mut(|data| data.insert_temp(id, drawn.points.clone()));
    let line = on_screen(state, open, drawn, place);
    let now = context.memory(|memory| memory.area_rect(id));
    // That of an earlier run of the program has no size yet.
    let now = now.filter(Rect::is_positive);
    if now.is_some_and(|now| covered(now, &line) == 0) {
        return window;
    }
    let size = now.map_or(EXPECTED, |now| now.size());
    window.current_pos(best_place(place, size, &line).left_bottom())
}

/// Where the line is seen.
fn on_screen(state: &State, open: &OpenFlight, drawn: &Drawn, place: Rect) -> Vec<Pos2> {
    // What was measured last may be without the last corner.
    let ways = drawn.points.iter().zip(drawn.points.iter().skip(1));
    let mut points: Vec<DVec3> = ways
        .flat_map(|(from, to)| {
            (0..=BETWEEN).map(|at| from.lerp(*to, f64::from(at) / f64::from(BETWEEN)))
        })
        .collect();
    if let Some(profile) = drawn.profile() {
        let step = profile.points().count().div_ceil(MOST_POINTS).max(1);
        points.extend(profile.points().step_by(step).map(|at| at.point));
    }
    let view = state.view(open);
    let size = DVec2::new(f64::from(place.width()), f64::from(place.height()));
    let seen = points.into_iter().filter_map(|point| {
        let at = view.project(point, size)?;
        Some(place.min + vec2(at.x as f32, at.y as f32))
    });
    seen.collect()
}

/// How many points of the line a window there covers.
fn covered(window: Rect, line: &[Pos2]) -> usize {
    let window = window.expand(GAP);
    line.iter().filter(|at| window.contains(**at)).count()
}

/// The first of the places that cover the least of the line.
fn best_place(place: Rect, size: Vec2, line: &[Pos2]) -> Rect {
    let mut room = place.shrink(GAP);
    room.min.y += BUTTONS;
    let places = PLACES.map(|align| align.align_size_within_rect(size, room));
    let best = places.into_iter().min_by_key(|at| covered(*at, line));
    best.unwrap_or(room)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    /// By hand: a viewport of 1000 by 700 points, a window of 400 by 300.
    #[test]
    fn the_window_covers_no_line_where_there_is_room() {
        let place = Rect::from_min_size(pos2(100.0, 50.0), vec2(1000.0, 700.0));
        let size = vec2(400.0, 300.0);
        let line = |from: Pos2, to: Pos2| -> Vec<Pos2> {
            let shares = (0..=100_u8).map(|share| f32::from(share) / 100.0);
            shares.map(|share| from.lerp(to, share)).collect()
        };
        let best = |from, to| best_place(place, size, &line(from, to));
        // Across the middle, well above the foot.
        let middle = best(pos2(300.0, 300.0), pos2(900.0, 300.0));
        assert_eq!(middle.left_bottom(), pos2(400.0, 742.0));
        // Down to the foot in the middle, then also at the left.
        let left = best(pos2(600.0, 200.0), pos2(600.0, 740.0));
        assert_eq!(left.left_bottom(), pos2(108.0, 742.0));
        let right = best(pos2(200.0, 700.0), pos2(600.0, 700.0));
        assert_eq!(right.right_bottom(), pos2(1092.0, 742.0));
        // All along the foot: above it.
        let top = best(pos2(110.0, 700.0), pos2(1090.0, 700.0));
        assert_eq!(top.left_top(), pos2(108.0, 98.0));
        // Nowhere in sight.
        assert_eq!(best_place(place, size, &[]), middle);
    }
}
