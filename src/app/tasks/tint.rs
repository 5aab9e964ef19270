//! The scale field of the selected photo, to tint it with.

use super::work::Task;
use crate::jobs::Progress;
use crate::open_flight::tint::PhotoTint;
use crate::scale::{FieldError, PixelErrors, ScaleField};
use crate::state::{Severity, State};

impl Task {
    /// Computing the scale field that the selected photo is tinted with.
    pub const TINT: Self = Self::new("Tint").of_flight().to_the_end();
}

impl State {
    /// Tints the selected photo, or does no longer.
    pub(crate) fn toggle_tint(&mut self) {
        self.preferences.tint ^= true;
        self.load_tint();
    }

    /// Computes the field of the selected photo where it is wanted and not there; of another photo it is
    /// not wanted any more.
    pub(crate) fn load_tint(&mut self) {
        self.work.cancel(Task::TINT);
        let is_wanted = self.wants_field();
        let Some(open) = &mut self.open else {
            return;
        };
        let there = open.tint.as_ref().map(|tint| tint.photo);
        if there != open.selected {
            open.tint = None;
        }
        let Some(photo) = open.selected.filter(|_| is_wanted && open.tint.is_none()) else {
            return;
        };
        open.tints += 1;
        let (flight, number) = (open.flight().clone(), open.tints);
        let work = move |progress: &Progress| {
            // Who runs through the table with a key held down wants none of the photos between.
            std::thread::sleep(std::time::Duration::from_millis(60));
            if progress.is_cancelled() {
                return Err(FieldError::Cancelled);
            }
            progress.stage("computing the photo's scale field");
            let parts = flight.parts();
            let posed = &parts.photos[photo];
            let camera = flight.camera(posed);
            let (grid, surface) = (PhotoTint::grid(camera), &parts.surface);
            let field =
                ScaleField::compute(camera, &posed.pose, parts.image, grid, surface, progress)?;
            let errors = PixelErrors::new(&field, &flight.errors(posed), surface);
            Ok(PhotoTint::new(photo, field, errors, number))
        };
        self.start(Task::TINT, work, |state, tint| {
            match (tint, &mut state.open) {
                (Ok(tint), Some(open)) if open.selected == Some(tint.photo) => {
                    open.tint = Some(tint)
                }
                (Ok(_) | Err(FieldError::Cancelled), _) => {}
                (Err(error), _) => state.say(Severity::Error, &error.to_string()),
            }
        });
    }

    /// The same where the field may be another one: the flight was computed anew.
    pub(crate) fn load_tint_anew(&mut self) {
        if let Some(open) = &mut self.open {
            open.tint = None;
        }
        self.load_tint();
    }
}
