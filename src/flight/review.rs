//! A flight under review: of each photo its file, its scale, how it looks at the surface, every reason
//! for doubt and the verdict. Tables, sheets, exports, pictures and the window read it; nobody else
//! judges.
//!
//! It is made of a flight's outcomes and of what was looked up, and it grows: footprints and colours
//! take longer than scales. Whatever is added, all photos are judged again, by one function.

use std::sync::Arc;

use super::verdict::{Judged, judge};
use super::{
    ColoursFound, Doubt, Evidence, Flight, Limits, LookedUp, Outcome, Photo, PhotoFileState,
    Verdict,
};
use crate::camera::Camera;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::scale::{EdgeScales, PhotoScale, ViewFacts};
use crate::units::LengthUnit;

/// A flight with everything that is known of its photos.
#[derive(Debug, Clone)]
pub struct Review {
    flight: Arc<Flight>,
    /// Parallel to the flight's photos, like all lists here.
    outcomes: Arc<Vec<Outcome>>,
    /// Once they are known.
    views: Option<Arc<Vec<Option<ViewFacts>>>>,
    looked_up: LookedUp,
    limits: Limits,
    judged: Vec<Judged>,
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
    /// What speaks against its scale, the gravest first.
    pub doubts: &'a [Doubt],
    /// What follows from them.
    pub verdict: Verdict,
    /// Whether footprints were looked at: until then [`Verdict::Trust`] is not the last word.
    pub is_looked_at: bool,
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
            looked_up,
            limits: *limits,
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
                let size = (camera.width, camera.height);
                let evidence = self.looked_up.evidence.get(index).unwrap_or(&nothing);
                judge(
                    outcome,
                    self.view(index),
                    evidence,
                    size,
                    unit,
                    &self.limits,
                )
            })
            .collect();
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

    /// Whether the footprints were looked at.
    pub fn is_looked_at(&self) -> bool {
        self.views.is_some()
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
        let Judged { verdict, doubts } = self.judged.get(index)?;
        let evidence = self.looked_up.evidence.get(index);
        Some(PhotoReview {
            photo,
            camera: self.flight.camera(photo),
            file: evidence.map_or(UNKNOWN, |evidence| &evidence.file),
            outcome: self.outcomes.get(index)?,
            view: self.view(index),
            doubts,
            verdict: *verdict,
            is_looked_at: self.is_looked_at(),
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

    /// How many of its corners are on the surface; `None` where nothing was computed.
    pub fn corners_on_surface(&self) -> Option<usize> {
        self.scale().map(PhotoScale::corners_on_surface)
    }

    /// What to do with its scale; `None` while nothing speaks against it, but nobody has looked at its
    /// footprint yet.
    pub fn settled(&self) -> Option<Verdict> {
        (self.verdict != Verdict::Trust || self.is_looked_at).then_some(self.verdict)
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
            doubt.is_of_the_pile() || doubt.is_of_the_number() && **doubt != Doubt::UnitUnknown
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
    use crate::flight::FlightParts;
    use crate::scale::{Ground, ImageKind};
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
            warnings: Vec::new(),
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
