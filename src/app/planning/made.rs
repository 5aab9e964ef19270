//! A plan that was made, with what the window needs of it.

use std::sync::Arc;

use crate::camera::Camera;
use crate::plan::{AskedPlan, Pace, Plan, Shadows, Sun, Way};
use crate::render::{PlannedLine, plan_photos};
use crate::surface::Surface;
use crate::survey::Polygon;

/// What is said of a plan that nobody takes off for.
const NO_TAKE_OFF: &str = "Set the take-off to see the way, its time, and to write a mission.";

/// A plan with what was asked for, and what the window needs of it.
pub struct MadePlan {
    /// What it is of.
    pub asked: AskedPlan,
    /// Over which surface.
    pub(super) surface: Arc<Surface>,
    /// The flight's first camera then, where it had one.
    pub(super) camera: Option<Camera>,
    /// The pile on it, where that was looked for.
    pub(super) pile: Option<Polygon>,
    /// At which height it lies, and all else, in words.
    pub pile_heights: Option<String>,
    /// Without what was changed by hand.
    pub(super) base: Arc<Plan>,
    /// The plan.
    pub plan: Arc<Plan>,
    /// The ways through it, one a battery; empty without a take-off.
    pub ways: Vec<Way>,
    /// Why there is none although there is a take-off.
    pub no_way: Option<String>,
    /// How fast they are flown.
    pub pace: Pace,
    /// Where the sun stands then, and what lies in shadow, where a time was stated.
    pub sun: Option<(Sun, Shadows)>,
    /// Why that is not known although a time was stated.
    pub no_sun: Option<String>,
    /// Photos of changes by hand that could not be made: the plan has other photos of their names, or none.
    pub not_taken: Vec<String>,
    /// What is to be said beside the numbers.
    pub warnings: Vec<String>,
    /// Areas and way as lines of the picture.
    pub(super) lines: Vec<PlannedLine>,
}

impl MadePlan {
    /// That changes by hand were not made, where some were not.
    pub fn not_taken_in_words(&self) -> Option<String> {
        (!self.not_taken.is_empty()).then(|| {
            format!(
                "what was changed by hand of {} is not taken: this plan has another photo of that name, or none; change it again (As planned forgets all \
                 changes)",
                self.not_taken.join(", ")
            )
        })
    }

    /// Why there is no mission to write; `None` where there is one.
    pub fn no_mission(&self) -> Option<&str> {
        match &self.no_way {
            Some(why) => Some(why.as_str()),
            None => self.ways.is_empty().then_some(NO_TAKE_OFF),
        }
    }

    /// All of it as lines of the picture.
    pub fn lines(&self, selected: Option<usize>) -> Vec<PlannedLine> {
        let mut lines = self.lines.clone();
        lines.extend(plan_photos(&self.plan, selected));
        lines
    }
}

impl MadePlan {
    /// How many minutes a photo is taken after the take-off of its battery, and which share of the battery that is, where
    /// one was stated. `None` without a way.
    pub fn flown_at(&self, photo: usize) -> Option<(f64, Option<f64>)> {
        let has = |way: &&Way| way.points.iter().any(|point| point.photo == Some(photo));
        let way = self.ways.iter().find(has)?;
        let seconds = way.seconds_to(photo, &self.pace)?;
        let share = self.pace.battery.map(|battery| seconds / battery);
        Some((seconds / 60.0, share))
    }
}
