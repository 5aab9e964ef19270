//! Where the small windows of profiles and volumes open: beside what is looked at. That is the surface before anything is drawn
//! on it, and then the finished line or polygon.

use egui::{Align2, Id, Pos2, Rect, Vec2, Window, vec2};
use glam::{DVec2, DVec3};

use crate::geometry::Bounds;
use crate::open_flight::OpenFlight;
use crate::open_flight::survey::{Drawn, SurveyTool};
use crate::state::State;

/// How large a window is before anybody has seen one, with plot and numbers, points.
const PROFILE: Vec2 = vec2(456.0, 400.0);
const VOLUME: Vec2 = vec2(456.0, 320.0);

/// The same while it is drawn.
const PROFILE_IN_HAND: Vec2 = vec2(316.0, 110.0);
const VOLUME_IN_HAND: Vec2 = vec2(316.0, 170.0);

/// What a window has beside what is in it, points.
const MARGINS: f32 = 16.0;

/// Between a window and the viewport's edge, and between it and the line, points.
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

/// Points of a profile or of the surface that are looked at, at most, and those of each way between two corners.
const MOST_POINTS: usize = 400;
const BETWEEN: u8 = 32;

/// Puts the window beside the surface when a flight's first line or polygon is begun, and beside the line or polygon once that is
/// finished; later it stands where it was moved to, also for the next one where it does not cover that.
pub(super) fn beside_what_is_looked_at<'a>(
    window: Window<'a>,
    state: &State,
    (open, drawn): (&OpenFlight, &Drawn),
    context: &egui::Context,
    place: Rect,
) -> Window<'a> {
    // While it is drawn the window is a small one of its own.
    let (id, expected) = match (drawn.tool, drawn.finished) {
        (SurveyTool::Profile, false) => ("profile in hand", PROFILE_IN_HAND),
        (SurveyTool::Profile, true) => ("finished profile", PROFILE),
        (SurveyTool::Volume, false) => ("volume in hand", VOLUME_IN_HAND),
        (SurveyTool::Volume, true) => ("finished volume", VOLUME),
    };
    let id = Id::unique(id);
    let width = (expected.x - MARGINS).min((place.width() - MARGINS).max(180.0));
    let window = window.id(id).default_width(width);
    let stands = match drawn.finished {
        true => stands_for(drawn.points.clone(), id, context),
        false => stands_for(open.first_number, id, context),
    };
    if stands {
        return window;
    }
    let looked_at = match drawn.finished {
        true => line(drawn),
        false => surface(open),
    };
    let looked_at = on_screen(&looked_at, state, open, place);
    let now = context.memory(|memory| memory.area_rect(id));
    // That of an earlier run of the program has no size yet.
    let now = now.filter(Rect::is_positive);
    if now.is_some_and(|now| covered(now, &looked_at) == 0) {
        return window;
    }
    let size = now.map_or(expected, |now| now.size());
    window.current_pos(best_place(place, size, &looked_at).left_bottom())
}

/// Whether the window was last placed for this; from now on it is.
fn stands_for<T>(of: T, id: Id, context: &egui::Context) -> bool
where
    T: PartialEq + Clone + Send + Sync + 'static,
{
    context.data_mut(|data| {
        let stands = data.get_temp::<T>(id).as_ref() == Some(&of);
        data.insert_temp(id, of);
        stands
    })
}

/// Places on the line, or on the polygon and within it.
fn line(drawn: &Drawn) -> Vec<DVec3> {
    // What was measured last may be without the last corner.
    let corners = drawn.points.iter();
    let first = drawn.points.first();
    let first = first.filter(|_| drawn.tool == SurveyTool::Volume);
    let next = drawn.points.iter().skip(1).chain(first);
    let mut points: Vec<DVec3> = corners
        .zip(next)
        .flat_map(|(from, to)| {
            (0..=BETWEEN).map(|at| from.lerp(*to, f64::from(at) / f64::from(BETWEEN)))
        })
        .collect();
    if let (SurveyTool::Volume, Some(bounds)) = (drawn.tool, Bounds::of(&points)) {
        let middle = bounds.center();
        let inside: Vec<DVec3> = points.iter().map(|at| at.lerp(middle, 0.5)).collect();
        points.extend(inside);
    }
    if let Some(profile) = drawn.profile() {
        let step = profile.points().count().div_ceil(MOST_POINTS).max(1);
        points.extend(profile.points().step_by(step).map(|at| at.point));
    }
    points
}

/// Places all over the surface.
fn surface(open: &OpenFlight) -> Vec<DVec3> {
    let surface = &open.flight().parts().surface;
    let count = surface.vertices().len();
    let places = (0..count).step_by(count.div_ceil(MOST_POINTS).max(1));
    // No frame goes through all of them.
    places
        .flat_map(|place| surface.vertices_in(place..place + 1))
        .collect()
}

/// Where places of the world are seen.
fn on_screen(points: &[DVec3], state: &State, open: &OpenFlight, place: Rect) -> Vec<Pos2> {
    let view = state.view(open);
    let size = DVec2::new(f64::from(place.width()), f64::from(place.height()));
    let seen = points.iter().filter_map(|point| {
        let at = view.project(*point, size)?;
        Some(place.min + vec2(at.x as f32, at.y as f32))
    });
    seen.collect()
}

/// How many points of what is looked at a window there covers.
fn covered(window: Rect, line: &[Pos2]) -> usize {
    let window = window.expand(GAP);
    line.iter().filter(|at| window.contains(**at)).count()
}

/// The first of the places that cover the least of it.
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
