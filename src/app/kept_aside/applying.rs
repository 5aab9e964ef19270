//! When changes are kept aside and when they go, and what she does with what was left behind.

use std::time::Instant;

use super::KeptStep;
use crate::files;
use crate::open_flight::OpenFlight;
use crate::state::State;
use crate::state::leaving::{Leaving, Named};

impl State {
    pub(crate) fn kept_step(&mut self, step: KeptStep) {
        match step {
            KeptStep::Open(place) => {
                if let Some(left) = self.kept_aside.left.get(place) {
                    let paths = vec![left.folder.flight_file()];
                    let named = Named::Alone;
                    self.leave(Leaving::Read { paths, named });
                }
            }
            KeptStep::PutOff(place) => {
                if let Some(left) = self.kept_aside.left.get_mut(place) {
                    left.is_put_off = true;
                }
            }
        }
    }

    /// What was left behind goes once it was opened, and saved or discarded.
    fn let_go_of_left(&mut self) {
        let on_screen = self.open.as_deref().map(|open| open.number);
        let shown = self
            .open
            .as_deref()
            .filter(|open| open.files.kept.is_some());
        let shown = shown.and_then(|open| open.files.origin.flight_file());
        let is_opening = self.is_opening();
        let mut place = 0;
        while let Some(left) = self.kept_aside.left.get_mut(place) {
            let file = left.folder.flight_file();
            // The disk is asked where the paths differ alone.
            if shown.is_some_and(|shown| shown == file || files::is_same_file(shown, &file)) {
                left.opened = on_screen;
            } else if left.opened.is_some() && left.opened == on_screen {
                // Saved: but its photos are still found by ways that lead through the folder.
                left.withdraw();
            } else if left.opened.is_some() && !is_opening {
                self.kept_aside.left.remove(place).folder.remove();
                continue;
            }
            place += 1;
        }
    }

    /// Keeps aside what is not saved, some time after the last change was kept; and lets go of what is saved. In each frame.
    pub(crate) fn keep_aside(&mut self) {
        if self.kept_aside.root.is_none() || self.is_keeping() {
            return;
        }
        self.let_go_of_left();
        if !self.open.as_deref().is_some_and(OpenFlight::is_changed) {
            self.kept_aside.forget();
            return;
        }
        if !self.kept_aside.is_touched {
            return;
        }
        let now = Instant::now();
        let due = now + self.kept_aside.after;
        let due = *self.kept_aside.due.get_or_insert(due);
        if now < due {
            // An idle window draws no other frame for it.
            self.context.request_repaint_after(due - now);
            return;
        }
        self.kept_aside.is_touched = false;
        self.kept_aside.due = None;
        self.start_keeping();
    }
}
