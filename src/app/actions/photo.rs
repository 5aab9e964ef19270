//! The selected photo.

use egui::{Key, Modifiers};

use super::{Action, beside_photos, keys, on_fragments, on_pile, on_plan, survey, with_photo};
use crate::command::{Command, ReviewStep, ViewChange};
use crate::fragments::{FragmentStep, FragmentTool};
use crate::open_flight::Measure;
use crate::open_flight::survey::SurveyStep;
use crate::open_flight::survey::picked::PickStep;
use crate::open_flight::tracing::Trace;
use crate::photo_view::{Middle, PhotoCommand};
use crate::planning::{PlanStep, PlanTool};
use crate::scale::ScaleObjectKind;
use crate::state::State;

fn begin_tracing(state: &State, kind: ScaleObjectKind) -> Option<Command> {
    let open = state.open.as_ref()?;
    let possible = open.selected.is_some() && open.trace_size(kind).is_some();
    possible.then_some(Command::Trace(Trace::Begin(kind)))
}

actions! {
    NEXT {
        label: "Next photo",
        hover: "Select the next photo of the table",
        shortcut: keys(Modifiers::NONE, Key::ArrowDown),
        command: |state| match on_plan(state) {
            Some(_) => Some(Command::Plan(PlanStep::SelectBy(1))),
            None => beside_photos(state, Command::SelectBy(1)),
        },
    }
    PREVIOUS {
        label: "Previous photo",
        hover: "Select the photo above in the table",
        shortcut: keys(Modifiers::NONE, Key::ArrowUp),
        command: |state| match on_plan(state) {
            Some(_) => Some(Command::Plan(PlanStep::SelectBy(-1))),
            None => beside_photos(state, Command::SelectBy(-1)),
        },
    }
    MEASURE {
        label: "Measure a distance",
        hover: "Click two points on the surface",
        shortcut: keys(Modifiers::NONE, Key::M),
        command: |state| on_pile(state, Command::ToggleMeasure),
    }
    TINT {
        label: "Tint by scale",
        hover: "Tint the selected photo by the scale of its pixels, with lines of equal scale",
        shortcut: keys(Modifiers::NONE, Key::I),
        command: |state| with_photo(state, Command::ToggleTint),
    }
    TRACE_SPHERE {
        label: "Trace sphere",
        hover: "Mark the outline of a sphere of known size on the photo, to compare its scale",
        shortcut: None,
        command: |state| begin_tracing(state, ScaleObjectKind::Sphere),
    }
    TRACE_BAR {
        label: "Trace bar",
        hover: "Mark the two ends of a bar of known length on the photo, to compare its scale",
        shortcut: None,
        command: |state| begin_tracing(state, ScaleObjectKind::Bar),
    }
    FINISH_TRACING {
        label: "Finish the outline, or accept",
        hover: "Make a scale object of the points, as a click on the first one does; in a review accept the photo",
        shortcut: keys(Modifiers::NONE, Key::Enter),
        command: |state| {
            if let Some(planning) = on_plan(state) {
                let has_corners = !planning.drawing.is_empty();
                return has_corners.then_some(Command::Plan(PlanStep::Finish));
            }
            let fragments = on_fragments(state, |of| match (of.drawing.is_empty(), of.selected) {
                (false, _) => Some(FragmentStep::Finish),
                (true, Some(_)) => Some(FragmentStep::IsRight),
                (true, None) => None,
            });
            if let Some(command) = fragments {
                return command;
            }
            let open = state.open.as_ref()?;
            let Some(tracing) = &open.objects.tracing else {
                let drawn = open.pointer.drawn.as_ref().filter(|drawn| !drawn.finished);
                return match drawn {
                    Some(_) => on_pile(state, Command::Survey(SurveyStep::Finish)),
                    None => super::review::accept(state),
                };
            };
            let is_complete = tracing.is_complete();
            is_complete.then_some(Command::Trace(Trace::Finish))
        },
    }
    REMOVE_POINT {
        label: "Remove the last point",
        hover: "Take the last point of the outline back",
        shortcut: keys(Modifiers::NONE, Key::Backspace),
        command: |state| {
            if let Some(planning) = on_plan(state) {
                let has_corners = !planning.drawing.is_empty();
                return has_corners.then_some(Command::Plan(PlanStep::RemoveLast));
            }
            let fragments =
                on_fragments(state, |of| (!of.drawing.is_empty()).then_some(FragmentStep::RemoveCorner));
            if let Some(command) = fragments {
                return command;
            }
            let open = state.open.as_ref()?;
            let Some(tracing) = &open.objects.tracing else {
                let drawn = open.pointer.drawn.as_ref();
                let drawn = drawn.filter(|drawn| !drawn.points.is_empty());
                return on_pile(state, drawn.map(|_| Command::Survey(SurveyStep::RemoveLast))?);
            };
            let has_points = !tracing.outline.is_empty();
            has_points.then_some(Command::Trace(Trace::RemoveLast))
        },
    }
    LEAVE {
        label: "Leave tracing, measuring, the camera or the review",
        hover: "Take back what is begun with a tool, else put the tool away, else leave the camera, the photo view, the review",
        shortcut: keys(Modifiers::NONE, Key::Escape),
        command: |state| {
            // It closes the small window first.
            let open = state.open.as_ref().filter(|_| state.asking.is_none())?;
            if let Some(planning) = on_plan(state) {
                return match planning.tool {
                    _ if !planning.drawing.is_empty() => Some(Command::Plan(PlanStep::RemoveAll)),
                    PlanTool::Select if planning.through => {
                        Some(Command::Plan(PlanStep::ToggleThrough))
                    }
                    PlanTool::Select => planning.selected().map(|_| Command::Plan(PlanStep::Select(None))),
                    tool => Some(Command::Plan(PlanStep::Tool(tool))),
                };
            }
            let fragments = on_fragments(state, |of| match of.tool {
                _ if !of.drawing.is_empty() => Some(FragmentStep::RemoveCorners),
                FragmentTool::Select => of.selected.map(|_| FragmentStep::Select(None)),
                _ => Some(FragmentStep::Tool(FragmentTool::Select)),
            });
            if let Some(command) = fragments {
                return command;
            }
            if let Some(tracing) = &open.objects.tracing {
                return Some(Command::Trace(match tracing.outline.is_empty() {
                    true => Trace::GiveUp,
                    false => Trace::RemoveAll,
                }));
            }
            if open.pointer.picked.is_on {
                return on_pile(state, Command::Pick(PickStep::Toggle));
            }
            if let Some(drawn) = &open.pointer.drawn {
                let step = match drawn.is_in_hand() {
                    true => SurveyStep::RemoveAll,
                    false => SurveyStep::Leave,
                };
                return on_pile(state, Command::Survey(step));
            }
            let command = match open.pointer.measure {
                Measure::Off if open.looking.through.is_some() => {
                    Command::View(ViewChange::Through)
                }
                Measure::Off => {
                    if state.middle == Middle::Photo {
                        return on_pile(state, Command::Photo(PhotoCommand::Middle(Middle::Pile)));
                    }
                    state.reviewed_flight()?;
                    Command::Review(ReviewStep::Leave)
                }
                Measure::Second(_) => Command::MeasureAnew,
                Measure::First | Measure::Both(..) => Command::ToggleMeasure,
            };
            on_pile(state, command)
        },
    }
}

/// The menu's entries.
pub const MENU: &[Option<Action>] = &[
    Some(NEXT),
    Some(PREVIOUS),
    None,
    Some(MEASURE),
    Some(survey::POINTS),
    Some(survey::PROFILE),
    Some(survey::VOLUME),
    Some(survey::CLIP),
    Some(TINT),
    None,
    Some(TRACE_SPHERE),
    Some(TRACE_BAR),
    Some(FINISH_TRACING),
    Some(REMOVE_POINT),
    Some(LEAVE),
];
