//! What the engineer asks of a plan, with what she moves by hand. A flight's file keeps it.

use glam::DVec2;

use super::{Pattern, Size, SurveyWish, USUAL_CLEARANCE, USUAL_OFF_NORMAL, USUAL_TILT, Wish};
use crate::plan::{Drone, Flying, Positioning};
use crate::survey::{Polygon, SurveyError};

/// What the engineer asks of a plan. Lengths are in world units.
#[derive(Debug, Clone, PartialEq)]
pub struct AskedPlan {
    /// How photos lie.
    pub pattern: Pattern,
    /// How large the rock is to be in them.
    pub size: Size,
    /// Of photos for scales, 0 to under 1.
    pub overlap: f64,
    /// How photos of a survey lie, of a pattern that has some.
    pub survey: SurveyWish,
    /// Whether gaps are filled with photos more.
    pub fill_gaps: bool,
    /// Degrees below the horizon, of the paper's pattern.
    pub tilt: f64,
    /// Degrees off the normal of the ground, of the slope pattern.
    pub off_normal: f64,
    /// What flies; `None` is the flight's first camera.
    pub drone: Option<Drone>,
    /// By what it knows its place.
    pub positioning: Positioning,
    /// How near it may come to the surface.
    pub clearance: f64,
    /// What is photographed; `None` is the pile that is found.
    pub area: Option<Vec<DVec2>>,
    /// What is not flown over.
    pub keep_out: Vec<Vec<DVec2>>,
    /// Where it takes off and lands.
    pub take_off: Option<DVec2>,
    /// How it is flown from photo to photo.
    pub flying: Flying,
    /// When it is flown: a time with its difference from UTC.
    pub when: Option<String>,
    /// What was changed of single photos by hand, in order.
    pub edits: Vec<Edit>,
}

/// A photo of a plan. Names are given in the order of the flight: of a plan that came out otherwise the same name is another photo's.
#[derive(Debug, Clone, PartialEq)]
pub struct PhotoAt {
    /// Its name.
    pub name: String,
    /// The place that it showed when it was changed.
    pub at: DVec2,
}

/// A change of single photos by hand.
#[derive(Debug, Clone, PartialEq)]
pub enum Edit {
    /// A photo shows another place.
    Move(PhotoAt, DVec2),
    /// One more, of this place.
    Add(DVec2),
    /// A photo is left out.
    Leave(PhotoAt),
}

impl AskedPlan {
    /// What is usual for photos of this size, in a world whose unit has so many metres.
    pub fn usual(size: Size, drone: Option<Drone>, unit_metres: f64) -> Self {
        Self {
            pattern: Pattern::default(),
            size,
            overlap: 0.0,
            survey: SurveyWish::default(),
            fill_gaps: false,
            tilt: USUAL_TILT,
            off_normal: USUAL_OFF_NORMAL,
            drone,
            positioning: Positioning::default(),
            clearance: USUAL_CLEARANCE / unit_metres,
            area: None,
            keep_out: Vec::new(),
            take_off: None,
            flying: Flying::default(),
            when: None,
            edits: Vec::new(),
        }
    }

    /// The same wish where lengths count in a unit that is so many of the one before: the world's coordinates are what they were.
    #[must_use]
    pub fn in_unit_of(&self, before: f64) -> Self {
        Self {
            size: self.size.in_unit_of(before),
            survey: SurveyWish {
                size: self.survey.size.map(|size| size.in_unit_of(before)),
                ..self.survey
            },
            clearance: self.clearance / before,
            ..self.clone()
        }
    }

    /// The same without what was changed by hand, and without what only the way depends on.
    pub fn base(&self) -> Self {
        Self {
            edits: Vec::new(),
            flying: Flying::default(),
            when: None,
            ..self.clone()
        }
    }

    /// Whether photos are planned anew for it: it is not only flown otherwise.
    pub fn is_other_ground(&self, other: &Self) -> bool {
        self.base() != other.base()
    }

    /// The same in place of another one: where photos are planned anew they have other names, and what was changed of
    /// them by hand cannot stay.
    #[must_use]
    pub fn instead_of(mut self, before: &Self) -> Self {
        if self.is_other_ground(before) {
            self.edits.clear();
        }
        self
    }

    /// As the plan takes it.
    ///
    /// # Errors
    /// Where an area to keep out of is none.
    pub fn wish(&self, unit_metres: f64) -> Result<Wish, SurveyError> {
        let usual = Wish::usual(self.pattern, self.size, self.drone, unit_metres);
        let keep_out = self.keep_out.iter().map(|corners| Polygon::new(corners));
        Ok(Wish {
            overlap: self.overlap,
            survey: self.survey,
            tilt: self.tilt,
            off_normal: self.off_normal,
            clearance: self.clearance,
            errors: self.positioning.errors(unit_metres),
            keep_out: keep_out.collect::<Result<_, _>>()?,
            take_off: self.take_off,
            ..usual
        })
    }
}
