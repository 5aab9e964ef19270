//! What the engineer decides of photos, as changes of the flight's settings: so undo goes back over it,
//! closing asks for it, and saving writes it.

use chrono::Datelike;

use crate::command::Choice;
use crate::fault::one_line;
use crate::flight::{Along, Date, Decision, DecisionKind, PhotoReview, Verdict};
use crate::open_flight::reviewing::{STILL_LOOKING, no_scale};
use crate::state::{Severity, State};

impl State {
    /// Takes a photo along into the export, or not.
    pub(crate) fn choose(&mut self, photo: usize, go_along: bool) {
        self.choose_each(|place, reviewed| match place == photo {
            true => go_along,
            false => reviewed.goes_along(Along::Trusted),
        });
    }

    /// Takes many along.
    pub(crate) fn choose_all(&mut self, choice: Choice) {
        let accepted = self.choose_each(|_, reviewed| match choice {
            Choice::WithScale => no_scale(&reviewed).is_none(),
            Choice::Trusted => reviewed.own_verdict == Verdict::Trust,
            Choice::None => false,
        });
        // Of one photo she sees it beside its reasons.
        let said = match accepted {
            0 => return,
            1 => "1 doubtful photo is accepted by that, whatever its reasons are".to_owned(),
            n => format!("{n} doubtful photos are accepted by that, whatever their reasons are"),
        };
        self.say(Severity::Note, &said);
    }

    /// Decides whatever is needed so that those photos go along for which `wanted` says so. Returns how many doubtful ones it accepted.
    fn choose_each(&mut self, wanted: impl Fn(usize, PhotoReview<'_>) -> bool) -> usize {
        let Some(open) = &self.open else {
            return 0;
        };
        if !open.review.is_looked_at() {
            self.say(Severity::Note, STILL_LOOKING);
            return 0;
        }
        let mut accepted = 0;
        let mut decided = Vec::new();
        let mut settings = open.settings();
        for (place, photo) in open.review.photos().enumerate() {
            let wanted = wanted(place, photo);
            // Nobody can take along what is not there.
            let can = !wanted || no_scale(&photo).is_none();
            if can && photo.goes_along(Along::Trusted) != wanted {
                let decision = photo.decision_to(wanted).map(|decision| Decision {
                    date: today(),
                    note: one_line(open.note_of(place)),
                    ..decision
                });
                if decision.is_some() {
                    decided.push(place);
                }
                accepted += usize::from(wanted && photo.is_doubtful());
                settings.decide(photo.name(), decision);
            }
        }
        self.set_settings(settings);
        self.forget_notes(&decided);
        accepted
    }

    /// Decides about a photo, today and for the reasons of now.
    pub(crate) fn decide(&mut self, photo: usize, decision: Option<(DecisionKind, String)>) {
        let Some(open) = &self.open else {
            return;
        };
        let Some(reviewed) = open.review.photo(photo) else {
            return;
        };
        // What is accepted is what was seen, and a scale.
        let accepts = matches!(decision, Some((DecisionKind::Accepted, _)));
        let why_not = open.why_not_accepted(&reviewed).filter(|_| accepts);
        if let Some(why_not) = why_not {
            self.say(Severity::Note, why_not);
            return;
        }
        let decision = decision.map(|(kind, note)| Decision {
            note: one_line(&note),
            date: today(),
            ..Decision::new(reviewed.name(), kind, reviewed.doubts)
        });
        let mut settings = open.settings();
        settings.decide(reviewed.name(), decision);
        self.set_settings(settings);
        self.forget_notes(&[photo]);
    }

    /// Gives decisions that hold the notes that were typed of these photos since, as one step. What was decided stays, and the
    /// reasons it was decided for: that goes while photos are still being looked at, too.
    pub(crate) fn note_anew(&mut self, photos: &[usize]) {
        let Some(open) = &self.open else {
            return;
        };
        let mut noted = Vec::new();
        let mut settings = open.settings();
        for &photo in photos {
            if let Some(decision) = open.noted_anew(photo) {
                let decision = Decision {
                    date: today(),
                    ..decision
                };
                settings.decide(open.name(photo), Some(decision));
                noted.push(photo);
            }
        }
        if !noted.is_empty() {
            self.set_settings(settings);
            self.forget_notes(&noted);
        }
    }

    /// What was typed of these photos is in their decisions, or was taken back with them.
    fn forget_notes(&mut self, decided: &[usize]) {
        // Then nothing was decided.
        if self.changes_would_be_lost() {
            return;
        }
        if let Some(open) = &mut self.open {
            let notes = &mut open.reviewing.notes;
            notes.retain(|photo, _| !decided.contains(photo));
        }
    }
}

/// The day where this computer stands: the core knows no clock.
fn today() -> Option<Date> {
    let now = chrono::Local::now();
    let year = now.year().try_into().ok()?;
    Date::new(
        year,
        now.month().try_into().ok()?,
        now.day().try_into().ok()?,
    )
}
