//! A flight under review: of each photo its file, its scale, how it looks at the surface, every reason
//! for doubt and the verdict. Tables, sheets, exports, pictures and the window read it; nobody else
//! judges.
//!
//! It is made of a flight's outcomes and of what was looked up, and it grows: footprints and colours
//! take longer than scales. Whatever is added, all photos are judged again, by one function.

use std::sync::Arc;

use super::verdict::{Facts, Judged, judge};
use super::{
    ColoursFound, Decision, DecisionKind, Doubt, Evidence, Flight, Limits, LookedUp, Outcome,
    Photo, PhotoFileState, Verdict,
};
use crate::camera::Camera;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::scale::{
    EdgeScales, FieldFacts, FittedScale, PhotoScale, ScaleEstimate, ScalePair, StatedErrors,
    Uncertainty, ViewFacts,
};
use crate::units::LengthUnit;

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

/// Which photos go along into an export, beside what the engineer has decided of single ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// All but those that she leaves out.
    All,
    /// Those without doubt, and those that she has accepted.
    Trusted,
}

/// What is known of one photo.
#[derive(Debug, Clone, Copy)]
pub struct PhotoReview<'a> {
    /// The photo.
    pub photo: &'a Photo,
    /// That it was taken with.
    pub camera: &'a Camera,
    /// Its image file.
    pub file: &'a PhotoFileState,
    /// Its scale, pixels per world unit.
    pub outcome: &'a Outcome,
    /// How it looks at the surface; `None` where it has no scale, or while nobody has looked.
    pub view: Option<&'a ViewFacts>,
    /// What its scale field says; `None` where it has no scale, or while nobody has computed it.
    pub field: Option<&'a FieldFacts>,
    /// What speaks against its scale, the gravest first.
    pub doubts: &'a [Doubt],
    /// What follows from them and from `decision`.
    pub verdict: Verdict,
    /// What follows from them alone.
    pub own_verdict: Verdict,
    /// What the engineer has decided.
    pub decision: Option<&'a Decision>,
    /// Whether footprints and scale fields were looked at: until then [`Verdict::Trust`] is not the last
    /// word.
    pub is_looked_at: bool,
    /// [`Limits::triangle_share`].
    pub(super) triangle_share: f64,
    /// Which scales go to Split-Desktop.
    pub pair: ScalePair,
    /// Of the world.
    pub unit: LengthUnit,
    /// Whether somebody says that it is this unit.
    pub unit_known: bool,
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

    /// Takes other limits, and judges again.
    pub fn take_limits(&mut self, limits: &Limits) {
        self.limits = *limits;
        self.judge();
    }

    /// Takes what the engineer has decided of photos; of one that the flight does not have nothing is
    /// taken. Decisions change no reason for doubt.
    pub fn take_decisions(&mut self, decisions: &[Decision]) {
        let photos = self.flight.parts().photos.iter();
        let of = |name: &str| decisions.iter().find(|decision| decision.photo == name);
        self.decisions = match decisions.is_empty() {
            true => Vec::new(),
            false => photos.map(|photo| of(&photo.name).cloned()).collect(),
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
        let parts = self.flight.parts();
        let photo = parts.photos.get(index)?;
        let judged = self.judged.get(index)?;
        let decision = self.decisions.get(index).and_then(Option::as_ref);
        let evidence = self.looked_up.evidence.get(index);
        Some(PhotoReview {
            photo,
            camera: self.flight.camera(photo),
            file: evidence.map_or(UNKNOWN, |evidence| &evidence.file),
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

impl<'a> PhotoReview<'a> {
    /// The photo's name.
    pub fn name(&self) -> &'a str {
        &self.photo.name
    }

    /// Its corners and scales, where it has any.
    pub fn scale(&self) -> Option<&'a PhotoScale> {
        self.outcome.scale()
    }

    /// The same where the numbers mean something: the unit is known.
    pub fn scale_to_type(&self) -> Option<&'a PhotoScale> {
        self.scale().filter(|_| self.unit_known)
    }

    /// Pixels per `unit` along its edges; see [`Self::scale_to_type`] for whether they mean it.
    pub fn edges(&self, unit: LengthUnit) -> EdgeScales {
        let scale = self.scale().map(|scale| scale.scale).unwrap_or_default();
        // Pixels per world unit, times world units per unit.
        scale.times(unit.in_units_of(self.unit))
    }

    /// The best line through its scale field, pixels per `unit`.
    pub fn fitted(&self, unit: LengthUnit) -> Option<FittedScale> {
        let fitted = self.field?.fitted?;
        Some(fitted.times(unit.in_units_of(self.unit)))
    }

    /// How sure its scales are, pixels per `unit`.
    pub fn uncertainty(&self, unit: LengthUnit) -> Option<Uncertainty> {
        let uncertainty = self.field?.uncertainty.as_ref()?;
        Some(uncertainty.times(unit.in_units_of(self.unit)))
    }

    /// Top and bottom scale for Split-Desktop, pixels per `unit`: of the best line, or of the corners,
    /// as the flight says; nothing stands in for a line that is not there.
    pub fn pair(&self, unit: LengthUnit) -> [Option<f64>; 2] {
        let estimates = self.estimates(self.pair, unit);
        estimates.map(|estimate| Some(estimate?.value))
    }

    /// Top and bottom scale of either pair with how sure they are, pixels per `unit`.
    pub fn estimates(&self, pair: ScalePair, unit: LengthUnit) -> [Option<ScaleEstimate>; 2] {
        let sure = self.uncertainty(unit).unwrap_or_default();
        let (values, intervals) = match pair {
            ScalePair::Corners => {
                let edges = self.edges(unit);
                ([edges.top, edges.bottom], [sure.top, sure.bottom])
            }
            ScalePair::Fitted => {
                let fitted = self.fitted(unit);
                let values = [fitted.map(|f| f.top), fitted.map(|f| f.bottom)];
                (values, [sure.fitted_top, sure.fitted_bottom])
            }
        };
        std::array::from_fn(|edge| {
            Some(ScaleEstimate {
                value: values[edge]?,
                interval: intervals[edge],
            })
        })
    }

    /// How many of its corners are on the surface; `None` where nothing was computed.
    pub fn corners_on_surface(&self) -> Option<usize> {
        self.scale().map(PhotoScale::corners_on_surface)
    }

    /// What to do with its scale; `None` while nothing speaks against it, but nobody has looked at its
    /// footprint and its scale field yet.
    pub fn settled(&self) -> Option<Verdict> {
        (self.verdict != Verdict::Trust || self.is_looked_at).then_some(self.verdict)
    }

    /// Whether something speaks against it, whatever the engineer has decided: those are the photos that
    /// she reviews.
    pub fn is_doubtful(&self) -> bool {
        self.own_verdict != Verdict::Trust
    }

    /// Whether it is doubtful, and she has not decided about it for the reasons of now.
    pub fn waits_for_decision(&self) -> bool {
        let decided = self.decision.is_some_and(|decision| {
            decision.kind == DecisionKind::LeftOut || decision.covers(self.doubts)
        });
        self.is_doubtful() && !decided
    }

    /// Whether it goes along into an export: the one place that says so, for the window and the command.
    /// What she leaves out never goes; what she has accepted for the reasons of now always does, with a
    /// scale or without; else the verdict says it, once it is the last word.
    pub fn goes_along(&self, along: Along) -> bool {
        match (along, self.decision) {
            (_, Some(decision)) if decision.kind == DecisionKind::LeftOut => false,
            (Along::All, _) => true,
            (Along::Trusted, Some(decision)) if decision.covers(self.doubts) => true,
            (Along::Trusted, _) => self.settled() == Some(Verdict::Trust),
        }
    }

    /// The decision by which it goes along with those that are trusted, or does not; `None` where it
    /// does so by itself.
    pub fn decision_to(&self, go_along: bool) -> Option<Decision> {
        if self.goes_along(Along::Trusted) == go_along {
            return self.decision.cloned();
        }
        let by_itself = self.own_verdict == Verdict::Trust && self.is_looked_at;
        let kind = match go_along {
            true => DecisionKind::Accepted,
            false => DecisionKind::LeftOut,
        };
        (by_itself != go_along).then(|| Decision::new(self.name(), kind, self.doubts))
    }

    /// The reasons for doubt that were not there when the engineer accepted the photo: then it was
    /// accepted for others, and counts as not accepted until she looks again.
    pub fn reasons_since_accepted(&self) -> Vec<&'a Doubt> {
        let accepted = self.decision.filter(|d| d.kind == DecisionKind::Accepted);
        accepted.map_or_else(Vec::new, |decision| decision.new_reasons(self.doubts))
    }

    /// What the engineer has decided as a sentence, with what has changed since.
    pub fn decided(&self) -> Option<String> {
        let decision = self.decision?;
        let since = self.reasons_since_accepted();
        Some(match since.is_empty() {
            true => decision.to_string(),
            false => {
                let kinds: Vec<&str> = since.iter().map(|doubt| doubt.kind()).collect();
                let kinds = kinds.join(", ");
                format!("{decision} (for other reasons: {kinds} came since; look again)")
            }
        })
    }

    /// What every list of scales has to say beside its numbers, one sentence each: what fell back or
    /// failed, that the scale is for another image than the engineer has, that it is not of this pile.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if !self.unit_known {
            notes.push(Doubt::UnitUnknown.to_string());
        }
        match self.outcome {
            Outcome::Trouble(trouble) => notes.push(trouble.clone()),
            Outcome::Scale(scale) => notes.extend(scale.notes(self.unit.symbol())),
        }
        let said = |doubt: &&Doubt| {
            doubt.is_of_the_pile()
                || doubt.is_of_the_number() && **doubt != Doubt::UnitUnknown
                || matches!(doubt, Doubt::NoFit { .. })
        };
        notes.extend(self.doubts.iter().filter(said).map(Doubt::to_string));
        notes
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::camera::{Distortion, Pose};
    use crate::flight::{FlightParts, FlightSettings, InView, OnPhoto};
    use crate::geometry::Bounds;
    use crate::scale::{CornerName, Ground, ImageKind};
    use crate::surface::{Cloud, Surface};

    /// A photo of 100 x 100 px, 4 m above a plane with a point every half metre: a footprint of 4 m, so
    /// that its scale is 25 px/m, with nothing to doubt.
    fn flight() -> Arc<Flight> {
        let at = |i: u32| DVec3::new(f64::from(i % 21), f64::from(i / 21), 0.0) / 2.0;
        let cloud = Cloud {
            points: (0..21 * 21).map(at).collect(),
            ..Cloud::default()
        };
        let flight = Flight::new(FlightParts {
            name: String::new(),
            unit: LengthUnit::Metre,
            unit_known: true,
            ground: Ground::Auto,
            image: ImageKind::Undistorted,
            pair: Default::default(),
            errors: Default::default(),
            package_errors: Default::default(),
            surface: Arc::new(Surface::new(cloud).unwrap()),
            cameras: vec![Camera {
                name: String::new(),
                width: 100,
                height: 100,
                fx: 100.0,
                fy: 100.0,
                cx: 50.0,
                cy: 50.0,
                skew: 0.0,
                distortion: Distortion::None,
            }],
            photos: vec![Photo {
                name: "a.jpg".to_owned(),
                camera: 0,
                pose: Pose::from_tilt_pan(DVec3::new(5.1, 5.1, 4.0), [90.0, 0.0]),
                errors: Default::default(),
                package_errors: Default::default(),
                trouble: None,
            }],
        });
        Arc::new(flight.unwrap())
    }

    fn looked_up() -> LookedUp {
        let (width, height) = (100, 100);
        LookedUp {
            evidence: vec![Evidence {
                file: PhotoFileState::Found { width, height },
                ..Evidence::default()
            }],
            ..LookedUp::default()
        }
    }

    fn review() -> Review {
        let (limits, progress) = (Limits::default(), Progress::default());
        Review::of_scales(flight(), looked_up(), &limits, &progress).unwrap()
    }

    fn settled(review: &Review) -> Option<Verdict> {
        review.photo(0).unwrap().settled()
    }

    const OTHER: Doubt = Doubt::OtherColours {
        correlation: 0.1,
        points: 500,
    };

    #[test]
    fn nothing_is_trusted_before_it_was_looked_at() {
        let mut review = review();
        assert_eq!(settled(&review), None);
        review.look(&Progress::default()).unwrap();
        assert_eq!(settled(&review), None, "its field is not known");
        review.compute_fields(&Progress::default()).unwrap();
        assert_eq!(settled(&review), Some(Verdict::Trust));
        assert_eq!(review.count_of(Verdict::Trust), 1);
        let photo = review.photo(0).unwrap();
        let top = photo.edges(LengthUnit::Centimetre).top.unwrap();
        assert!((top - 0.25).abs() < 1e-12, "{top}");
        assert_eq!(photo.notes(), [""; 0]);
        // A corner's ray comes in at atan(4 / (2 * sqrt 2)), 54.7 degrees.
        review.take_limits(&Limits {
            flattest_angle: 55.0,
            ..Limits::default()
        });
        assert_eq!(settled(&review), Some(Verdict::Check));
        assert!(review.photo(1).is_none());
    }

    #[test]
    fn colours_outlive_a_change_of_the_settings() {
        let mut review = review();
        review.look(&Progress::default()).unwrap();
        review.compute_fields(&Progress::default()).unwrap();
        review.take_colours([(0, ColoursFound::Against(OTHER))]);
        assert_eq!(settled(&review), Some(Verdict::Check));
        let outcomes = review.outcomes().to_vec();
        review.take_scales(flight(), outcomes, looked_up());
        assert!(!review.is_looked_at());
        let photo = review.photo(0).unwrap();
        assert_eq!(
            (photo.verdict, photo.doubts),
            (Verdict::Check, &[OTHER][..])
        );
        assert_eq!(photo.notes(), [OTHER.to_string()]);
        review.take_colours([(0, ColoursFound::NothingAgainst)]);
        assert_eq!(review.photo(0).unwrap().verdict, Verdict::Trust);
    }

    /// Another pair and other errors leave corners and best lines as they are, to the bit.
    #[test]
    fn what_is_stated_changes_no_scale() {
        let mut review = review();
        let progress = Progress::default();
        review.look(&progress).unwrap();
        review.compute_fields(&progress).unwrap();
        let unit = LengthUnit::Metre;
        let fitted = review.photo(0).unwrap().fitted(unit).unwrap();
        let outcomes = review.outcomes().to_vec();
        review.take_stated(ScalePair::Corners, StatedErrors::default());
        assert_eq!(settled(&review), Some(Verdict::Trust));
        let photo = review.photo(0).unwrap();
        let edges = photo.edges(unit);
        assert_eq!(photo.pair(unit), [edges.top, edges.bottom]);
        let errors = StatedErrors {
            surface: Some(0.01),
            ..StatedErrors::default()
        };
        review.take_stated(ScalePair::Fitted, errors);
        assert_eq!(settled(&review), None, "its field is of other errors");
        let photo = review.photo(0).unwrap();
        assert_eq!(photo.fitted(unit), Some(fitted));
        assert_eq!(photo.pair(unit), [Some(fitted.top), Some(fitted.bottom)]);
        assert!(photo.uncertainty(unit).is_none());
        assert_eq!(review.flight().parts().errors, errors);
        review.compute_fields(&progress).unwrap();
        assert_eq!(settled(&review), Some(Verdict::Trust));
        assert_eq!(**review.outcomes(), outcomes);
    }

    /// A corner's reason is shown with its triangle around it: over points every half metre its longest edge is
    /// the diagonal, 0.5 * sqrt 2, more than 0.12 of the footprint's 4 m.
    #[test]
    fn what_shows_a_reason_is_around_its_corner() {
        let mut review = review();
        review.look(&Progress::default()).unwrap();
        review.take_limits(&Limits {
            triangle_share: 0.1,
            ..Limits::default()
        });
        let photo = review.photo(0).unwrap();
        let [doubt @ Doubt::LongTriangle { corners, .. }] = photo.doubts else {
            panic!("{:?}", photo.doubts);
        };
        assert!(photo.is_doubtful() && photo.waits_for_decision());
        let sight = doubt.sight();
        assert_eq!(sight.on_photo, OnPhoto::Corners(corners.clone()));
        let places = photo.points_in(&InView::Corners(vec![CornerName::TopLeft]));
        let bounds = Bounds::of(&places).unwrap();
        let corner = DVec3::new(3.1, 7.1, 0.0);
        let reach = DVec3::splat(0.5 * 2_f64.sqrt());
        assert!(
            (bounds.min - (corner - reach)).length() < 1e-9,
            "{bounds:?}"
        );
        assert!(
            (bounds.max - (corner + reach)).length() < 1e-9,
            "{bounds:?}"
        );
        let footprint = Bounds::of(&photo.points_in(&InView::Footprint)).unwrap();
        assert!((footprint.size() - DVec3::new(4.0, 4.0, 0.0)).length() < 1e-9);
        let side = Bounds::of(&photo.points_in(&InView::FromSide)).unwrap();
        assert!((side.size().z - 4.0).abs() < 1e-9, "with the camera");
        let left_out = Decision::new("a.jpg", DecisionKind::LeftOut, photo.doubts);
        review.take_decisions(&[left_out]);
        let photo = review.photo(0).unwrap();
        assert!(photo.is_doubtful() && !photo.waits_for_decision());
    }

    /// Decisions change what goes along and the word for it, no reason for doubt; an acceptance ends
    /// where another reason comes.
    #[test]
    fn what_the_engineer_decides() {
        let mut review = review();
        review.look(&Progress::default()).unwrap();
        review.compute_fields(&Progress::default()).unwrap();
        let along = |review: &Review| {
            [Along::All, Along::Trusted].map(|along| review.going_along(along)[0])
        };
        assert_eq!(along(&review), [true, true]);
        // The corners' rays come in at 54.7 degrees.
        let strict = Limits {
            flattest_angle: 55.0,
            ..Limits::default()
        };
        review.take_limits(&strict);
        assert_eq!(
            (settled(&review), along(&review)),
            (Some(Verdict::Check), [true, false])
        );
        let doubts = review.photo(0).unwrap().doubts.to_vec();
        let accepted = Decision::new("a.jpg", DecisionKind::Accepted, &doubts);
        review.take_decisions(std::slice::from_ref(&accepted));
        assert_eq!(
            (settled(&review), along(&review)),
            (Some(Verdict::Accepted), [true, true])
        );
        assert_eq!(review.photo(0).unwrap().doubts, doubts);
        review.take_colours([(0, ColoursFound::Against(OTHER))]);
        assert_eq!(
            (settled(&review), along(&review)),
            (Some(Verdict::Check), [true, false])
        );
        let photo = review.photo(0).unwrap();
        assert_eq!(photo.reasons_since_accepted(), [&OTHER]);
        assert_eq!(
            photo.decided().unwrap(),
            "checked, accepted (for other reasons: other-colours came since; look again)"
        );
        let left_out = Decision::new("a.jpg", DecisionKind::LeftOut, &doubts);
        review.take_decisions(&[left_out]);
        assert_eq!(
            (settled(&review), along(&review)),
            (Some(Verdict::LeftOut), [false, false])
        );
        // Of a photo that is not there, nothing is taken.
        let other = Decision {
            photo: "b.jpg".to_owned(),
            ..accepted
        };
        review.take_decisions(std::slice::from_ref(&other));
        assert_eq!(settled(&review), Some(Verdict::Check));
        assert_eq!(
            review.flight().decisions_without_photo(&[other]),
            [
                "a review is of photo 'b.jpg', which the flight does not have; the nearest name is 'a.jpg'"
            ]
        );
    }

    /// Without a unit there is no scale, whoever accepts it.
    #[test]
    fn nobody_accepts_a_scale_that_is_none() {
        let flight = flight();
        let settings = FlightSettings {
            unit_known: false,
            ..FlightSettings::default()
        };
        let flight = Arc::new(flight.with_settings(&settings).unwrap());
        let (limits, progress) = (Limits::default(), Progress::default());
        let mut review = Review::of_scales(flight, looked_up(), &limits, &progress).unwrap();
        let doubts = review.photo(0).unwrap().doubts.to_vec();
        review.take_decisions(&[Decision::new("a.jpg", DecisionKind::Accepted, &doubts)]);
        assert_eq!(settled(&review), Some(Verdict::NoScale));
        assert!(review.photo(0).unwrap().goes_along(Along::Trusted));
    }

    /// A file whose header cannot be read is doubted once.
    #[test]
    fn an_unreadable_file_is_doubted_once() {
        let mut looked_up = looked_up();
        let why = || Doubt::FileUnreadable("cut".to_owned());
        looked_up.evidence[0].file = PhotoFileState::Unreadable("cut".to_owned());
        looked_up.evidence[0].colours = ColoursFound::Against(why());
        let (limits, progress) = (Limits::default(), Progress::default());
        let review = Review::of_scales(flight(), looked_up, &limits, &progress).unwrap();
        assert_eq!(review.photo(0).unwrap().doubts, [why()]);
    }
}
