//! Steps of the review of doubtful photos. What is decided goes the way of every decision, so that undo
//! goes back over it.

use crate::command::{ReviewStep, Tab};
use crate::flight::{Decision, DecisionKind, OnPhoto};
use crate::open_flight::OpenFlight;
use crate::size_distributions::Page;
use crate::state::{Severity, State};

/// The field of the note in the review, and in the photo's own panel: a key brings the cursor into it.
pub(crate) fn note_field(tab: Tab) -> egui::Id {
    egui::Id::unique(match tab {
        Tab::Review => "note of the review",
        _ => "note on the photo",
    })
}

impl State {
    /// The flight whose doubtful photos are being reviewed: while its page is in sight.
    pub fn reviewed_flight(&self) -> Option<&OpenFlight> {
        let in_sight = self.page == Page::Pile && self.preferences.right_open;
        let open = self.open.as_deref()?;
        (in_sight && self.tab == Tab::Review).then_some(open)
    }

    /// Whether the scale field of the selected photo is to be seen.
    pub fn wants_field(&self) -> bool {
        let sight = self.reviewed_flight().and_then(OpenFlight::sight);
        self.preferences.tint || sight.is_some_and(|sight| sight.on_photo == OnPhoto::Field)
    }

    /// Does a step.
    pub(crate) fn review_step(&mut self, step: ReviewStep) {
        let was_reviewing = self.reviewed_flight().is_some();
        if matches!(step, ReviewStep::Next | ReviewStep::Back) {
            let before = self.open.as_ref().and_then(|open| open.selected);
            self.take_note(before);
        }
        let Some(open) = &mut self.open else {
            return;
        };
        match step {
            ReviewStep::Next => {
                let next = open.next_doubtful(!was_reviewing);
                self.page = Page::Pile;
                self.tab = Tab::Review;
                self.preferences.right_open = true;
                self.review_photo(next);
            }
            ReviewStep::Back => {
                let before = open.doubtful_before();
                self.review_photo(before);
            }
            ReviewStep::Reason(reason) => {
                open.reviewing.reason = reason;
                open.show_reason();
                self.load_tint();
            }
            ReviewStep::Note(photo, note) => {
                open.reviewing.notes.insert(photo, note);
            }
            ReviewStep::TakeNote(photo) => self.take_note(Some(photo)),
            ReviewStep::WriteNote => {
                let field = note_field(self.tab);
                self.context
                    .memory_mut(|memory| memory.request_focus(field));
            }
            ReviewStep::Accept => self.decide_and_go_on(DecisionKind::Accepted),
            ReviewStep::LeaveOut => self.decide_and_go_on(DecisionKind::LeftOut),
            ReviewStep::Leave => {
                self.tab = Tab::Photo;
                self.load_tint();
            }
        }
    }

    /// Selects a photo of the review, and shows its gravest reason.
    fn review_photo(&mut self, photo: Option<usize>) {
        let Some(open) = self.open.as_mut().filter(|_| photo.is_some()) else {
            return;
        };
        open.select(photo);
        open.reviewing.reason = 0;
        open.show_reason();
        self.load_preview();
    }

    /// Decides about the selected photo, and goes on to the next doubtful one where it was one itself, in its review: who goes
    /// through all photos with arrows stays where she is.
    fn decide_and_go_on(&mut self, kind: DecisionKind) {
        let is_reviewing = self.reviewed_flight().is_some();
        let Some(open) = &self.open else {
            return;
        };
        let Some((photo, reviewed)) = open.selected_review() else {
            return;
        };
        let goes_on = is_reviewing && reviewed.is_doubtful();
        let note = open.note_of(photo).to_owned();
        self.decide(photo, Some((kind, note)));
        let Some(open) = self.open.as_ref().filter(|_| goes_on) else {
            return;
        };
        let is_decided = open
            .review
            .photo(photo)
            .is_some_and(|p| !p.waits_for_decision());
        if is_decided {
            let waits = open.review_progress().waiting > 0;
            let next = open.next_doubtful(false).filter(|_| waits);
            self.review_photo(next);
        }
    }

    /// Takes the note that was typed of a photo with its decision, where one holds: its field is left, or another
    /// photo is selected. Without a decision it waits for one.
    pub(crate) fn take_note(&mut self, photo: Option<usize>) {
        self.note_anew(photo.as_slice());
    }

    /// Takes every note that has a decision now, before the flight is saved or left: undo and redo may have brought one back.
    pub(crate) fn take_notes(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let typed: Vec<usize> = open.reviewing.notes.keys().copied().collect();
        self.note_anew(&typed);
    }

    /// Whether saving or leaving would take notes.
    pub(crate) fn has_notes_to_take(&self) -> bool {
        self.open.as_deref().is_some_and(|open| {
            let mut typed = open.reviewing.notes.keys();
            typed.any(|photo| open.noted_anew(*photo).is_some())
        })
    }

    /// Warns of notes that are in no file, as nothing is decided of their photos.
    pub(crate) fn warn_of_waiting_notes(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let mut waiting = open.waiting_notes();
        let Some(first) = waiting.next() else {
            return;
        };
        let name = open.name(first);
        let said = match waiting.count() {
            0 => format!(
                "a note on {name} is kept with a decision only: accept the photo or leave it out"
            ),
            more => format!(
                "notes on {name} and {more} more are kept with decisions only: accept the photos or leave them out"
            ),
        };
        self.say(Severity::Warning, &said);
    }

    /// Brings the photo back whose decision was undone or done again.
    pub(crate) fn review_undone(&mut self, before: &[Decision]) {
        let Some(open) = &self.open else {
            return;
        };
        let now = open.settings().decisions;
        let other = now.iter().find(|decision| !before.contains(decision));
        let gone = || before.iter().find(|decision| !now.contains(decision));
        let Some(changed) = other.or_else(gone) else {
            return;
        };
        let photos = &open.flight().parts().photos;
        let photo = photos.iter().position(|photo| photo.name == changed.photo);
        self.review_photo(photo);
    }
}
