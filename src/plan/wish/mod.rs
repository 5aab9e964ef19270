//! What is wished of a plan, and what is usual where nobody says it: the window and the command line ask here.

mod asked;
mod pattern;

use glam::DVec2;

pub use asked::{AskedPlan, Edit, PhotoAt};
pub use pattern::Pattern;

use super::{Drone, PoseErrors, Positioning, Purpose};
use crate::survey::Polygon;

/// How far scales may be off where nobody says it: a tenth of the wished one, as a scale of 20 ± 2.
const WITHIN: f64 = 0.1;
/// Degrees that every gimbal of a camera drone reaches.
const GIMBAL: [f64; 2] = [-90.0, 0.0];
/// The axis below the horizon of the paper's photos, degrees (III-B).
pub const USUAL_TILT: f64 = 83.0;
/// Degrees off the normal of the ground that the slope pattern allows.
pub const USUAL_OFF_NORMAL: f64 = 10.0;
/// How much photos of a survey share with the next one, 0 to under 1.
pub const USUAL_SURVEY_OVERLAP: f64 = 0.7;
/// Metres between drone and surface.
pub const USUAL_CLEARANCE: f64 = 5.0;

/// What is wished of a plan. Lengths are in world units, angles in degrees.
#[derive(Debug, Clone, PartialEq)]
pub struct Wish {
    /// How the photos lie.
    pub pattern: Pattern,
    /// How large the rock is to be in the photos.
    pub size: Size,
    /// How much of its width and of its height a photo for scales shares with the next one, 0 to under 1.
    pub overlap: f64,
    /// How the survey's photos lie, of a pattern that has some.
    pub survey: SurveyWish,
    /// The widest gap between photos, in parts of the shorter side of a photo's footprint: the diameter of the
    /// largest circle that no photo shows.
    pub gap: f64,
    /// The camera's axis below the horizon, where the pattern has one for all photos.
    pub tilt: f64,
    /// How far a photo's axis may lie from the normal of the ground, of the slope pattern.
    pub off_normal: f64,
    /// The gimbal's lowest and highest pitch, -90 straight down.
    pub gimbal: [f64; 2],
    /// How near the drone may come to the surface, and to what it keeps out of.
    pub clearance: f64,
    /// Ground that it does not fly over, at any height.
    pub keep_out: Vec<Polygon>,
    /// How well it holds its pose.
    pub errors: PoseErrors,
    /// Where the drone takes off and lands, if that is known: the ground is looked at as far as there.
    pub take_off: Option<DVec2>,
}

impl Wish {
    /// What is usual, of a surface whose unit has so many metres, and of a drone, where it is known.
    pub fn usual(pattern: Pattern, size: Size, drone: Option<Drone>, unit_metres: f64) -> Self {
        Self {
            pattern,
            size,
            overlap: 0.0,
            survey: SurveyWish::default(),
            gap: 0.1,
            tilt: USUAL_TILT,
            off_normal: USUAL_OFF_NORMAL,
            gimbal: drone.map_or(GIMBAL, |drone| drone.gimbal),
            clearance: USUAL_CLEARANCE / unit_metres,
            keep_out: Vec::new(),
            errors: Positioning::default().errors(unit_metres),
            take_off: None,
        }
    }
}

impl Wish {
    /// Wishes for another overlap of the photos that the pattern is named for: those for scales, where it has some.
    pub fn set_overlap(&mut self, overlap: f64) {
        match self.pattern.main() {
            Purpose::Scale => self.overlap = overlap,
            Purpose::Survey => self.survey.overlap = overlap,
        }
    }

    /// The overlap of photos with this purpose.
    pub fn overlap_of(&self, purpose: Purpose) -> f64 {
        match purpose {
            Purpose::Scale => self.overlap,
            Purpose::Survey => self.survey.overlap,
        }
    }

    /// How large the rock is to be in photos with this purpose.
    pub fn size_of(&self, purpose: Purpose) -> Size {
        match purpose {
            Purpose::Scale => self.size,
            Purpose::Survey => self.survey.size.unwrap_or(self.size),
        }
    }
}

/// How the photos of a survey lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurveyWish {
    /// How much of its width and of its height a photo shares with the next one, 0 to under 1.
    pub overlap: f64,
    /// Rows straight down across the others, too.
    pub cross: bool,
    /// Photos around the area that look aslant into it.
    pub ring: bool,
    /// How large the rock is to be in them; `None` is as in the others.
    pub size: Option<Size>,
}

impl Default for SurveyWish {
    /// What reconstructions ask for.
    fn default() -> Self {
        Self {
            overlap: USUAL_SURVEY_OVERLAP,
            cross: false,
            ring: true,
            size: None,
        }
    }
}

/// How large the rock is to be in the photos.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Size {
    /// This scale, and how far it may be off anywhere in a photo: pixels per world unit.
    Scale {
        /// In the middle of what 98 of 100 of a photo's pixels have.
        pixels: f64,
        /// On both sides of it, for 98 of 100 pixels.
        within: Option<f64>,
    },
    /// Photos from so far: above the highest of the area, where one height is for all; else from the ground.
    Distance(f64),
}

impl Size {
    /// The same where lengths count in a unit that is so many of the one before.
    #[must_use]
    pub fn in_unit_of(self, before: f64) -> Self {
        match self {
            Self::Scale { pixels, within } => Self::Scale {
                pixels: pixels * before,
                within: within.map(|within| within * before),
            },
            Self::Distance(distance) => Self::Distance(distance / before),
        }
    }

    /// This scale, pixels per world unit, within what is usual.
    pub fn scale(pixels: f64) -> Self {
        Self::Scale {
            pixels,
            within: Some(WITHIN * pixels),
        }
    }
}
