//! What is drawn on the surface, as lines of the picture.

use glam::DVec3;

use crate::open_flight::OpenFlight;
use crate::open_flight::survey::SurveyTool;
use crate::render::Show;

/// Points of a profile that are shown at most.
const MOST_POINTS: usize = 1000;

/// Adds the line or polygon that is drawn.
pub(super) fn show_drawn(open: &OpenFlight, show: &mut Show) {
    let Some(drawn) = &open.pointer.drawn else {
        return;
    };
    let mut outline = drawn.outline(open.pointer.hover);
    show.drawn_points.clone_from(&outline);
    match (drawn.tool, drawn.profile()) {
        // The surface itself where it is known, else straight from point to point.
        (SurveyTool::Profile, Some(profile)) if drawn.finished => {
            let step = profile.points().count().div_ceil(MOST_POINTS).max(1);
            for run in &profile.runs {
                let mut line: Vec<DVec3> = run.iter().step_by(step).map(|at| at.point).collect();
                line.extend(run.last().map(|at| at.point));
                show.drawn_lines.push(line);
            }
        }
        (SurveyTool::Profile, _) => show.drawn_lines.push(outline),
        (SurveyTool::Volume, _) => {
            outline.extend(outline.first().copied());
            show.drawn_lines.push(outline);
        }
    }
}

/// Adds the points that were picked.
pub(super) fn show_picked(open: &OpenFlight, show: &mut Show) {
    let picked = open.pointer.picked.list().iter();
    show.picked = picked
        .map(|picked| (picked.name.clone(), picked.point))
        .collect();
}
