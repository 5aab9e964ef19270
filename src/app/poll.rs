//! Taking what jobs and rays have brought, a little in each frame.

use std::time::Duration;

use crate::open_flight::OpenFlight;
use crate::open_flight::picker::{Picker, Purpose};
use crate::open_flight::survey::surveyor::Surveyor;
use crate::planning::PlanStep;
use crate::state::{Severity, State};
use crate::tasks::Task;

/// Steps of jobs taken in one frame: uploading a thumbnail takes a fraction of a millisecond.
const STEPS_A_FRAME: usize = 8;

/// Between two frames that show how far jobs are. Where the processor draws, a frame takes both cores of a small machine for a tenth
/// of a second, and most of them is to be left to the jobs.
const PAUSE: Duration = Duration::from_millis(100);
const PAUSE_IN_SOFTWARE: Duration = Duration::from_millis(500);
/// Nobody waits for a dialog's end; of what is paused what is in hand may still end.
const LONG_PAUSE: Duration = Duration::from_secs(1);

impl State {
    /// Takes what is there, and asks for another frame while something is under way.
    pub fn poll(&mut self) {
        while let Some(done) = self.work.finished() {
            match done {
                Ok(ending) => ending(self),
                Err(fault) => self.say(Severity::Error, &fault.to_string()),
            }
        }
        self.look_at_arrived();
        for step in self.work.steps(STEPS_A_FRAME) {
            step(self);
        }
        if !self.is_opening() {
            self.preview = None;
        }
        self.take_growth();
        self.take_season();
        let mut ends_area = false;
        if let Some(open) = &mut self.open {
            if !open.photo_view.tiles.take(&self.context) {
                self.context.request_repaint();
            }
            let answers = open.pointer.picker.as_mut().map(Picker::answers);
            let before = open.selected;
            for picked in answers.into_iter().flatten() {
                ends_area |= picked.purpose == Purpose::EndArea;
                open.take_picked(picked);
            }
            let measured = open.pointer.surveyor.as_mut().map(Surveyor::answers);
            for (request, measured) in measured.into_iter().flatten() {
                open.take_measured(&request, measured);
            }
            open.look_at_control();
            if open.selected != before {
                self.take_note(before);
                self.load_preview();
            }
        }
        if ends_area {
            self.plan_step(PlanStep::Finish);
        }
        self.look_at_notice();
        self.look_at_values();
        self.upload_beside();
        self.keep_aside();
        if !self.work.is_idle() {
            // Idle windows draw nothing. A dialog can take minutes.
            let all = |is: &dyn Fn(Task) -> bool| self.work.running().all(|(task, _)| is(task));
            let only_dialog = all(&|task| task == Task::DIALOG);
            let are_paused = all(&|task| self.work.is_paused(task));
            let in_software = self.gpu.as_ref().is_some_and(|gpu| gpu.software);
            let pause = match in_software {
                _ if only_dialog || are_paused => LONG_PAUSE,
                true => PAUSE_IN_SOFTWARE,
                false => PAUSE,
            };
            self.context.request_repaint_after(pause);
        }
    }

    /// Whether nothing is under way.
    pub fn is_idle(&self) -> bool {
        let waiting = |open: &OpenFlight| {
            let pointer = &open.pointer;
            pointer.picker.as_ref().is_some_and(Picker::is_waiting)
                || pointer.surveyor.as_ref().is_some_and(Surveyor::is_waiting)
                || open.photo_view.tiles.is_waiting()
        };
        self.work.is_idle() && !self.open.as_deref().is_some_and(waiting)
    }
}
