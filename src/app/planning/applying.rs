//! Does what a step on the page of the plan says.

use glam::DVec2;

use super::dragged::{dragged, photo_at};
use super::{PlanStep, PlanTool, Planning};
use crate::open_flight::OpenFlight;
use crate::plan::{AskedPlan, Drone, Edit, Size};
use crate::size_distributions::Page;
use crate::state::history::History;
use crate::state::{Severity, State};
use crate::survey::Polygon;
use crate::tasks::Task;

/// How far a drone flies from the ground where no photo says how large the rock is to be, metres.
const USUAL_HEIGHT: f64 = 20.0;

impl State {
    pub(crate) fn plan_step(&mut self, step: PlanStep) {
        if step.changes_what_is_asked() && self.changes_would_be_lost() {
            return;
        }
        match step {
            PlanStep::Make => {
                if let Some(open) = &mut self.open {
                    open.begin_planning();
                    open.planning.refused = None;
                }
                self.work.try_again(Task::PLAN);
                self.make_plan();
            }
            PlanStep::SaveMission(to) => self.save_mission(to),
            PlanStep::SaveTable(to) => self.save_plan_table(to),
            PlanStep::ReadAreas(tool, text) => self.read_areas(tool, text),
            PlanStep::Compare(path) => self.compare_mission(path),
            PlanStep::SaveFlown(to) => self.save_flown(to),
            step => {
                let Some(open) = &mut self.open else {
                    return;
                };
                let before = open
                    .planning
                    .asked
                    .as_ref()
                    .map(|asked| asked.now().clone());
                open.planning.step(step);
                // Nobody wants the other one any more; of what is dragged each is made to its end.
                let now = open.planning.asked.as_ref().map(|asked| asked.now());
                if let (Some(before), Some(now)) = (before, now)
                    && before != *now
                {
                    let lost = !before.edits.is_empty() && now.is_other_ground(&before);
                    self.work.cancel(Task::PLAN);
                    if lost {
                        let text = "planned anew: what was changed of single photos by hand is gone; undo brings it back";
                        self.say(Severity::Warning, text);
                    }
                }
            }
        }
    }

    /// Whether corners of an area are clicked on the page of the plan.
    pub(crate) fn is_drawing_on_plan(&self) -> bool {
        let drawing = |open: &OpenFlight| !open.planning.drawing.is_empty();
        self.page == Page::Plan && self.open.as_deref().is_some_and(drawing)
    }

    /// What was cancelled is not begun again by itself.
    pub(crate) fn plan_cancelled(&mut self) {
        if let Some(open) = &mut self.open
            && let Some(now) = open.planning.now().cloned()
        {
            open.planning.refused = Some((now, "cancelled".to_owned()));
        }
    }

    /// Undo and redo of what is asked of the plan.
    pub(crate) fn undo_plan(&mut self, step: impl FnOnce(&mut History<AskedPlan>) -> bool) {
        if self.changes_would_be_lost() {
            return;
        }
        if let Some(open) = &mut self.open
            && let Some(asked) = &mut open.planning.asked
        {
            open.planning.dragged = None;
            step(asked);
        }
    }
}

impl OpenFlight {
    /// Asks for what is usual, where nothing was asked for yet: photos as large as the flight's own.
    pub(crate) fn begin_planning(&mut self) {
        if self.planning.asked.is_some() {
            return;
        }
        let parts = self.flight().parts();
        let metres = parts.unit.metres();
        let drone = parts.cameras.is_empty().then_some(Drone::ALL[0]);
        let camera = (parts.cameras.first().cloned()).unwrap_or_else(|| Drone::ALL[0].camera());
        let focal = (camera.fx * camera.fy).sqrt();
        let of_photos = (0..self.review.count()).filter_map(|photo| {
            let [top, bottom] = self.review.photo(photo)?.pair(parts.unit);
            Some((top? + bottom?) / 2.0)
        });
        let mut of_photos: Vec<f64> = of_photos.collect();
        let pixels =
            crate::geometry::median(&mut of_photos).unwrap_or(focal * metres / USUAL_HEIGHT);
        let size = Size::scale(crate::numbers::round_near(pixels).unwrap_or(pixels));
        let mut asked = AskedPlan::usual(size, drone, metres);
        // A lab is flown nearer than the usual clearance: half of the photos' distance is left for the relief.
        let half = focal / pixels / 2.0;
        asked.clearance = asked
            .clearance
            .min(crate::numbers::round_near(half).unwrap_or(half));
        self.planning.begin(asked);
    }

    /// What a click on the surface at a place does on the page of the plan.
    pub(crate) fn plan_at(&mut self, place: DVec2) {
        let planning = &mut self.planning;
        let Some(now) = planning.now().cloned() else {
            return;
        };
        match planning.tool {
            PlanTool::Select => {}
            PlanTool::Area | PlanTool::KeepOut => {
                // A double click ends the drawing where its first click put a corner.
                if planning.drawing.last() != Some(&place) {
                    planning.drawing.push(place);
                }
            }
            PlanTool::TakeOff => {
                planning.ask(AskedPlan {
                    take_off: Some(place),
                    ..now
                });
                planning.tool = PlanTool::Select;
            }
            PlanTool::Add => {
                let mut asked = now;
                asked.edits.push(Edit::Add(place));
                planning.ask(asked);
            }
        }
    }
}

impl Planning {
    fn ask(&mut self, asked: AskedPlan) {
        self.dragged = None;
        if let Some(history) = &mut self.asked {
            let asked = asked.instead_of(history.now());
            history.set(asked);
        }
    }

    fn step(&mut self, step: PlanStep) {
        match step {
            PlanStep::Ask(asked) => self.ask(*asked),
            PlanStep::Tool(tool) => {
                self.drawing.clear();
                self.tool = if self.tool == tool {
                    PlanTool::Select
                } else {
                    tool
                };
            }
            PlanStep::RemoveLast => {
                self.drawing.pop();
            }
            PlanStep::RemoveAll => self.drawing.clear(),
            PlanStep::Finish => self.finish(),
            PlanStep::Select(photo) => self.select(photo),
            PlanStep::SelectBy(by) => {
                let count = self.made.as_ref().map_or(0, |made| made.plan.photos.len());
                let next = match self.selected {
                    None => 0,
                    Some(place) => place.saturating_add_signed(by as isize),
                };
                self.select(count.checked_sub(1).map(|last| next.min(last)));
            }
            PlanStep::ToggleThrough => self.through = !self.through && self.selected.is_some(),
            PlanStep::Drag(handle, to) => {
                let plan = self.made.as_ref().map(|made| &*made.plan);
                self.dragged = self.now().map(|now| dragged(now, &handle, to, plan));
            }
            PlanStep::Drop => {
                if let Some(dragged) = self.dragged.take() {
                    self.ask(dragged);
                }
            }
            PlanStep::Leave => {
                let plan = self.made.as_ref().map(|made| &made.plan);
                let photo = (self.photo().zip(plan))
                    .and_then(|((_, photo), plan)| photo_at(plan, &photo.name));
                if let (Some(photo), Some(mut asked)) = (photo, self.now().cloned()) {
                    asked.edits.push(Edit::Leave(photo));
                    self.ask(asked);
                }
            }
            PlanStep::CloseFlown => self.flown = None,
            PlanStep::Make
            | PlanStep::SaveMission(_)
            | PlanStep::SaveTable(_)
            | PlanStep::ReadAreas(..)
            | PlanStep::Compare(_)
            | PlanStep::SaveFlown(_) => {}
        }
    }

    /// Takes the area that was drawn; one that is none stays, to be mended by taking corners back.
    fn finish(&mut self) {
        let Some(mut asked) = self.now().cloned() else {
            return;
        };
        if Polygon::new(&self.drawing).is_err() {
            return;
        }
        let corners = std::mem::take(&mut self.drawing);
        match self.tool {
            PlanTool::Area => asked.area = Some(corners),
            PlanTool::KeepOut => asked.keep_out.push(corners),
            _ => return,
        }
        self.ask(asked);
        self.tool = PlanTool::Select;
    }
}
