//! Taking what jobs and rays have brought, a little in each frame.

use std::time::Duration;

use crate::open_flight::OpenFlight;
use crate::open_flight::picker::Picker;
use crate::open_flight::survey::surveyor::Surveyor;
use crate::state::{Severity, State};
use crate::tasks::Task;

/// Steps of jobs taken in one frame: uploading a thumbnail takes a fraction of a millisecond.
const STEPS_A_FRAME: usize = 8;

/// How long the window waits for its next frame while jobs run, which it then shows the progress of: often enough for a bar,
/// and where frames are drawn by the processor, most of that is left to the jobs.
fn pause_between_frames(last_frame: Duration) -> Duration {
    (9 * last_frame).clamp(Duration::from_millis(100), Duration::from_secs(1))
}

impl State {
    /// Takes what is there, and asks for another frame while something is under way.
    pub fn poll(&mut self) {
        while let Some(done) = self.work.finished() {
            match done {
                Ok(ending) => ending(self),
                Err(fault) => self.say(Severity::Error, &fault.to_string()),
            }
        }
        for step in self.work.steps(STEPS_A_FRAME) {
            step(self);
        }
        if !self.is_opening() {
            self.preview = None;
        }
        self.take_growth();
        self.take_season();
        if let Some(open) = &mut self.open {
            if !open.photo_view.tiles.take(&self.context) {
                self.context.request_repaint();
            }
            let answers = open.pointer.picker.as_mut().map(Picker::answers);
            let before = open.selected;
            for picked in answers.into_iter().flatten() {
                open.take_picked(picked);
            }
            let measured = open.pointer.surveyor.as_mut().map(Surveyor::answers);
            for (request, measured) in measured.into_iter().flatten() {
                open.take_measured(&request, measured);
            }
            open.look_at_control();
            if open.selected != before {
                self.load_preview();
            }
        }
        self.look_at_values();
        self.upload_beside();
        if !self.work.is_idle() {
            // Idle windows draw nothing. A dialog can take minutes.
            let all = |is: &dyn Fn(Task) -> bool| self.work.running().all(|(task, _)| is(task));
            let only_dialog = all(&|task| task == Task::DIALOG);
            let are_paused = all(&|task| self.work.is_paused(task));
            let pause = match only_dialog {
                true => Duration::from_millis(500),
                // What is in hand may still end.
                false if are_paused => Duration::from_secs(1),
                false => pause_between_frames(self.last_frame),
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A tenth of the time is for drawing, between ten frames a second and one.
    #[test]
    fn slow_frames_are_drawn_less_often() {
        let pause = |ms| pause_between_frames(Duration::from_millis(ms)).as_millis();
        assert_eq!([0, 3, 50, 80, 400].map(pause), [100, 100, 450, 720, 1000]);
    }
}
