//! A flight under review: of each photo its file, its scale, how it looks at the surface, every reason
//! for doubt and the verdict. Tables, sheets, exports, pictures and the window read it; nobody else
//! judges.
//!
//! It is made of a flight's outcomes and of what was looked up, and it grows: footprints and colours
//! take longer than scales. Whatever is added, all photos are judged again, by one function.

mod photo;
mod sight;

use std::collections::HashMap;
use std::sync::Arc;

use crate::fault::Fault;
use crate::flight::verdict::{Facts, Judged, judge};
use crate::flight::{
    ColoursFound, Decision, Evidence, Flight, Limits, LookedUp, Outcome, PhotoFileState,
    TogetherFound, Verdict,
};
use crate::jobs::Progress;
use crate::scale::{FieldFacts, ScalePair, StatedErrors, ViewFacts};

pub use photo::{Along, PhotoReview};
pub use sight::{InView, OnPhoto, Sight};

/// A flight with everything that is known of its photos.
#[derive(Debug, Clone)]
pub struct Review {
    flight: Arc<Flight>,
    /// Parallel to the flight's photos, like all lists here.
    outcomes: Arc<Vec<Outcome>>,
    /// Once they are known.
    views: Option<Arc<Vec<Option<ViewFacts>>>>,
    /// Once they are known.
    fields: Option<Arc<Vec<Option<FieldFacts>>>>,
    /// Whether they are those of the errors that are stated now.
    fields_are_of_now: bool,
    looked_up: LookedUp,
    limits: Limits,
    /// What the engineer has decided, of each photo.
    decisions: Vec<Option<Decision>>,
    judged: Vec<Judged>,
}

impl Review {
    /// Computes the scales of a flight and reviews its photos, as far as they are known without looking
    /// at their footprints.
    ///
    /// # Errors
    /// Where the surface cannot be met, or the work was cancelled.
    pub fn of_scales(
        flight: Arc<Flight>,
        looked_up: LookedUp,
        limits: &Limits,
        progress: &Progress,
    ) -> Result<Self, Fault> {
        let outcomes = flight.scales(progress)?;
        Ok(Self::new(flight, outcomes, looked_up, limits))
    }

    /// The review of a flight whose scales are known: `outcomes` are those of [`Flight::scales`].
    pub fn new(
        flight: Arc<Flight>,
        outcomes: Vec<Outcome>,
        looked_up: LookedUp,
        limits: &Limits,
    ) -> Self {
        let mut review = Self {
            flight,
            outcomes: Arc::new(outcomes),
            views: None,
            fields: None,
            fields_are_of_now: false,
            looked_up,
            limits: *limits,
            decisions: Vec::new(),
            judged: Vec::new(),
        };
        review.judge();
        review
    }

    /// Looks at the footprints, and judges again.
    ///
    /// # Errors
    /// Where the surface cannot be met, or the work was cancelled.
    pub fn look(&mut self, progress: &Progress) -> Result<(), Fault> {
        let views = self.flight.views(&self.outcomes, progress)?;
        self.take_views(views);
        Ok(())
    }

    /// Computes the scale fields, and judges again.
    ///
    /// # Errors
    /// Where the surface cannot be triangulated, or the work was cancelled.
    pub fn compute_fields(&mut self, progress: &Progress) -> Result<(), Fault> {
        let fields = self.flight.fields(&self.outcomes, progress)?;
        self.take_fields(fields);
        Ok(())
    }

    /// Takes what the scale fields say, those of [`Flight::fields`], and judges again.
    pub fn take_fields(&mut self, fields: Vec<Option<FieldFacts>>) {
        self.fields = Some(Arc::new(fields));
        self.fields_are_of_now = true;
        self.judge();
    }

    /// Takes another pair for Split-Desktop and other stated errors, no scale of the corners depends on
    /// them, and judges again. With other errors the fields have to be computed anew: until then the best
    /// lines stay, which do not depend on them either, but nothing says how sure they are.
    pub fn take_stated(&mut self, pair: ScalePair, errors: StatedErrors) {
        let parts = self.flight.parts();
        if (pair, errors) == (parts.pair, parts.errors) {
            return;
        }
        if errors != parts.errors {
            self.fields_are_of_now = false;
            if let Some(fields) = &mut self.fields {
                for facts in Arc::make_mut(fields).iter_mut().flatten() {
                    facts.uncertainty = None;
                }
            }
        }
        self.flight = Arc::new(self.flight.with_stated(pair, errors));
        self.judge();
    }

    /// Takes the footprints, those of [`Flight::views`], and judges again.
    pub fn take_views(&mut self, views: Vec<Option<ViewFacts>>) {
        self.views = Some(Arc::new(views));
        self.judge();
    }

    /// Takes the scales of the same photos with other settings and what was looked up for these, and
    /// judges again: footprints have to be looked at anew, but colours are what they were.
    pub fn take_scales(
        &mut self,
        flight: Arc<Flight>,
        outcomes: Vec<Outcome>,
        mut looked_up: LookedUp,
    ) {
        let before = self.looked_up.evidence.iter_mut();
        for (evidence, before) in looked_up.evidence.iter_mut().zip(before) {
            evidence.colours = std::mem::take(&mut before.colours);
            evidence.together = std::mem::take(&mut before.together);
        }
        self.flight = flight;
        self.outcomes = Arc::new(outcomes);
        self.views = None;
        self.fields = None;
        self.fields_are_of_now = false;
        self.looked_up = looked_up;
        self.judge();
    }

    /// Takes what the colours of photos say, each with its place in the flight, and judges again.
    pub fn take_colours(&mut self, found: impl IntoIterator<Item = (usize, ColoursFound)>) {
        let mut is_against = false;
        for (photo, found) in found {
            is_against |= matches!(found, ColoursFound::Against(_));
            if let Some(evidence) = self.looked_up.evidence.get_mut(photo) {
                is_against |= matches!(evidence.colours, ColoursFound::Against(_));
                evidence.colours = found;
            }
        }
        // Thousands of photos come one by one: what says nothing changes no verdict.
        if is_against {
            self.judge();
        }
    }

    /// Takes what photos and those beside them see, each with its place in the flight, and judges again.
    pub fn take_together(&mut self, found: impl IntoIterator<Item = (usize, TogetherFound)>) {
        for (photo, found) in found {
            if let Some(evidence) = self.looked_up.evidence.get_mut(photo) {
                evidence.together = found;
            }
        }
        self.judge();
    }

    /// Takes other limits, and judges again.
    pub fn take_limits(&mut self, limits: &Limits) {
        self.limits = *limits;
        self.judge();
    }

    /// Takes what the engineer has decided of photos; of one that the flight does not have nothing is
    /// taken. Decisions change no reason for doubt.
    pub fn take_decisions(&mut self, decisions: &[Decision]) {
        // Of two about a photo the first counts, as in `of_photo`.
        let decisions = decisions.iter().rev();
        let by_name: HashMap<&str, &Decision> =
            decisions.map(|of| (of.photo.as_str(), of)).collect();
        let photos = self.flight.parts().photos.iter();
        self.decisions = match by_name.is_empty() {
            true => Vec::new(),
            false => photos
                .map(|photo| by_name.get(photo.name.as_str()).copied().cloned())
                .collect(),
        };
    }

    /// Which photos go along into an export, parallel to the flight's; see
    /// [`PhotoReview::goes_along`].
    pub fn going_along(&self, along: Along) -> Vec<bool> {
        self.photos().map(|photo| photo.goes_along(along)).collect()
    }

    /// The one place where verdicts are made.
    fn judge(&mut self) {
        let parts = self.flight.parts();
        let unit = parts.unit_known.then_some(parts.unit);
        let nothing = Evidence::default();
        let photos = parts.photos.iter().zip(self.outcomes.iter());
        self.judged = photos
            .enumerate()
            .map(|(index, (photo, outcome))| {
                let camera = self.flight.camera(photo);
                let evidence = self.looked_up.evidence.get(index).unwrap_or(&nothing);
                let facts = Facts {
                    outcome,
                    view: self.view(index),
                    field: self.field(index),
                    pair: parts.pair,
                    evidence,
                    camera: (camera.width, camera.height),
                    unit,
                    rounding: parts.as_read.rounding,
                };
                judge(&facts, &self.limits)
            })
            .collect();
    }

    fn field(&self, photo: usize) -> Option<&FieldFacts> {
        self.fields.as_ref()?.get(photo)?.as_ref()
    }

    fn view(&self, photo: usize) -> Option<&ViewFacts> {
        self.views.as_ref()?.get(photo)?.as_ref()
    }

    /// The flight.
    pub fn flight(&self) -> &Arc<Flight> {
        &self.flight
    }

    /// The scales of its photos, in their order.
    pub fn outcomes(&self) -> &Arc<Vec<Outcome>> {
        &self.outcomes
    }

    /// How its photos look at the surface, in their order; `None` while nobody has looked.
    pub fn views(&self) -> Option<&Arc<Vec<Option<ViewFacts>>>> {
        self.views.as_ref()
    }

    /// Whether footprints and scale fields were looked at, with everything as it is set now: the one
    /// place that says when a verdict is the last word.
    pub fn is_looked_at(&self) -> bool {
        self.views.is_some() && self.has_fields()
    }

    /// Whether the scale fields are known, with everything as it is set now.
    pub fn has_fields(&self) -> bool {
        self.fields.is_some() && self.fields_are_of_now
    }

    /// Whether the best lines are known: they depend on no stated error.
    pub fn has_lines(&self) -> bool {
        self.fields.is_some()
    }

    /// What was looked up of its photos.
    pub fn looked_up(&self) -> &LookedUp {
        &self.looked_up
    }

    /// When a photo is doubted.
    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// How many photos there are.
    pub fn count(&self) -> usize {
        self.judged.len()
    }

    /// How many photos have this verdict; see [`PhotoReview::settled`].
    pub fn count_of(&self, verdict: Verdict) -> usize {
        let photos = self.photos();
        photos
            .filter(|photo| photo.settled() == Some(verdict))
            .count()
    }

    /// What is known of a photo by its place in the flight; `None` where there is no such photo.
    pub fn photo(&self, index: usize) -> Option<PhotoReview<'_>> {
        const UNKNOWN: &PhotoFileState = &PhotoFileState::NotNamed;
        const NOT_COMPARED: &TogetherFound = &TogetherFound::NotCompared;
        let parts = self.flight.parts();
        let photo = parts.photos.get(index)?;
        let judged = self.judged.get(index)?;
        let decision = self.decisions.get(index).and_then(Option::as_ref);
        let evidence = self.looked_up.evidence.get(index);
        Some(PhotoReview {
            photo,
            camera: self.flight.camera(photo),
            file: evidence.map_or(UNKNOWN, |evidence| &evidence.file),
            together: evidence.map_or(NOT_COMPARED, |evidence| &evidence.together),
            outcome: self.outcomes.get(index)?,
            view: self.view(index),
            field: self.field(index),
            doubts: &judged.doubts,
            verdict: judged.with(decision),
            own_verdict: judged.verdict,
            decision,
            is_looked_at: self.is_looked_at(),
            triangle_share: self.limits.triangle_share,
            pair: parts.pair,
            unit: parts.unit,
            unit_known: parts.unit_known,
        })
    }

    /// Of all photos, in their order.
    pub fn photos(&self) -> impl Iterator<Item = PhotoReview<'_>> {
        (0..self.count()).filter_map(|index| self.photo(index))
    }
}

#[cfg(test)]
mod tests;
