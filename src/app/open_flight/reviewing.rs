//! The review of the doubtful photos: which one is next, which reason is shown, and where to look.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use crate::fault::one_line;
use crate::flight::{Decision, Doubt, InView, PhotoReview, Sight, Verdict};
use crate::open_flight::OpenFlight;
use crate::render::PhotoZoom;

/// How steep the view comes down on a footprint, radians.
const STEEP: f64 = 0.9;

/// The same on what is looked at from the side: the horizon is a line, the surface is not.
const LEVEL: f64 = 0.08;

/// What the review holds beside the decisions.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Reviewing {
    /// Which of the selected photo's reasons for doubt is shown.
    pub reason: usize,
    /// What was typed as notes of photos, by their indices, and no decision has yet: they wait for one while other
    /// photos are looked at.
    pub notes: BTreeMap<usize, String>,
}

/// How far the review is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReviewProgress {
    /// How many photos are doubtful.
    pub doubtful: usize,
    /// The place of the selected photo among them, from 1; `None` where it is not doubtful.
    pub at: Option<usize>,
    /// How many of them wait for a decision.
    pub waiting: usize,
    /// How many photos she has accepted for the reasons of now, also where nothing speaks against them any more.
    pub accepted: usize,
    /// How many of these are such: they count as trusted in the tool bar.
    pub accepted_and_trusted: usize,
    /// How many are left out, doubtful or not, as the tool bar counts them.
    pub left_out: usize,
}

/// Why nothing can be decided for the reasons of now: not all of them are known.
pub(crate) const STILL_LOOKING: &str =
    "Footprints and scale fields are still being looked at; decide when they are there";

/// Why nobody takes this photo along, where it has no scale: what its box asks, and all that accepts it.
pub(crate) fn no_scale(photo: &PhotoReview<'_>) -> Option<&'static str> {
    let has_none = photo.own_verdict == Verdict::NoScale;
    has_none.then_some("A photo without a scale is not accepted: there is none to take along")
}

impl OpenFlight {
    /// The selected photo with everything that is known of it.
    pub fn selected_review(&self) -> Option<(usize, PhotoReview<'_>)> {
        let photo = self.selected?;
        Some((photo, self.review.photo(photo)?))
    }

    /// Why nobody can accept this photo now; `None` where somebody can. Buttons and keys ask here.
    pub fn why_not_accepted(&self, photo: &PhotoReview<'_>) -> Option<&'static str> {
        match photo.is_looked_at && self.is_computed() {
            true => no_scale(photo),
            false => Some(STILL_LOOKING),
        }
    }

    /// What is in the field of a photo's note: what was typed, else what is saved.
    pub fn note_of(&self, photo: usize) -> &str {
        let typed = self.reviewing.notes.get(&photo).map(String::as_str);
        let saved = || Some(self.review.photo(photo)?.decision?.note.as_str());
        typed.or_else(saved).unwrap_or_default()
    }

    /// The photo's decision with the note that was typed since; `None` where nothing was, or no decision holds that
    /// could have it.
    pub(crate) fn noted_anew(&self, photo: usize) -> Option<Decision> {
        let note = one_line(self.reviewing.notes.get(&photo)?);
        let decision = self.decision_that_holds(photo)?;
        (decision.note != note).then(|| Decision {
            note,
            ..decision.clone()
        })
    }

    /// The photos whose typed notes no file has, as no decision holds that could have them.
    pub(crate) fn waiting_notes(&self) -> impl Iterator<Item = usize> {
        let notes = self.reviewing.notes.iter();
        let waiting = notes.filter(move |(photo, note)| {
            !note.trim().is_empty() && self.decision_that_holds(**photo).is_none()
        });
        waiting.map(|(photo, _)| *photo)
    }

    /// What was decided of a photo, where no reasons have come since.
    fn decision_that_holds(&self, photo: usize) -> Option<&Decision> {
        let reviewed = self.review.photo(photo)?;
        let holds = reviewed.reasons_since_accepted().is_empty();
        reviewed.decision.filter(|_| holds)
    }

    /// How far the review is.
    pub fn review_progress(&self) -> ReviewProgress {
        let doubtful = &self.table.doubtful;
        let counts = &self.table.counts;
        let place = |photo| doubtful.iter().position(|&at| at == photo);
        ReviewProgress {
            doubtful: doubtful.len(),
            at: self.selected.and_then(place).map(|place| place + 1),
            waiting: counts.waiting,
            accepted: counts.accepted,
            accepted_and_trusted: counts.accepted_and_trusted,
            left_out: counts.of(Verdict::LeftOut),
        }
    }

    /// The reason for doubt that is shown of the selected photo.
    pub fn reason(&self) -> Option<&Doubt> {
        let (_, photo) = self.selected_review()?;
        let last = photo.doubts.len().checked_sub(1)?;
        photo.doubts.get(self.reviewing.reason.min(last))
    }

    /// What shows it.
    pub fn sight(&self) -> Option<Sight> {
        self.reason().map(Doubt::sight)
    }

    /// The next doubtful photo that waits for a decision, this one where `from_here`; the next doubtful
    /// one where none waits.
    pub(crate) fn next_doubtful(&self, from_here: bool) -> Option<usize> {
        let waits = |photo: &usize| {
            let photo = self.review.photo(*photo);
            photo.is_some_and(|photo| photo.waits_for_decision())
        };
        let before = |photo: &&usize| match self.selected {
            Some(selected) if from_here => **photo < selected,
            Some(selected) => **photo <= selected,
            None => false,
        };
        let doubtful = &self.table.doubtful;
        let begin = doubtful.iter().take_while(before).count();
        let around = || doubtful[begin..].iter().chain(&doubtful[..begin]).copied();
        around().find(waits).or_else(|| around().next())
    }

    /// The doubtful photo before the selected one.
    pub(crate) fn doubtful_before(&self) -> Option<usize> {
        let doubtful = self.table.doubtful.iter().rev();
        let before = |photo: &&usize| self.selected.is_none_or(|selected| **photo < selected);
        let mut around = doubtful.clone().filter(before);
        around.next().or_else(|| doubtful.clone().next()).copied()
    }

    /// Turns the view to what the shown reason means.
    pub(crate) fn show_reason(&mut self) {
        let Some(sight) = self.sight() else {
            return;
        };
        self.looking.turned = true;
        if sight.in_view == InView::ThroughCamera {
            self.looking.through = self.selected;
            self.looking.into = PhotoZoom::default();
            return;
        }
        self.looking.through = None;
        let Some((_, photo)) = self.selected_review() else {
            return;
        };
        let points = photo.points_in(&sight.in_view);
        let forward = photo.photo.pose.rotation.z_axis.truncate();
        let orbit = &mut self.looking.orbit;
        orbit.pitch = match sight.in_view {
            InView::FromSide => LEVEL,
            _ => STEEP,
        };
        // Across its line of sight, where that is not straight down.
        if sight.in_view == InView::FromSide && forward.length() > 0.1 {
            orbit.yaw = forward.y.atan2(-forward.x).rem_euclid(TAU);
        }
        match points.is_empty() {
            true => self.fit(),
            false => self.fit_points(&points),
        }
    }
}
