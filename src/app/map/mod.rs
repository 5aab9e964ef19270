//! The page of the map: the flight as a plan (`exports::Plan`), the same that goes into files.
//!
//! ```text
//! command   what the engineer does on it
//! applying  does that
//! making    the plan, as a job, whenever the review of the flight has changed
//! part      the part of it that is in sight
//! drawing   draws that, as a job
//! found     which photos lie at a place
//! saving    the plan as a file
//! ```
//!
//! A frame draws two textures and the photo that is selected: no more for more photos.

mod applying;
mod command;
mod drawing;
mod found;
mod making;
mod part;
mod saving;

use std::sync::Arc;

use glam::DVec2;

pub use command::MapCommand;
pub use found::PhotosAt;
pub use part::{DrawnPart, PartInSight};

use crate::exports::{Plan, PlanGround};
use crate::surface::Surface;

/// The map of a flight.
#[derive(Default)]
pub struct FlightMap {
    /// Counts what the review of the flight has become: of another number the plan is of old.
    pub revision: u64,
    /// The plan, once it was made.
    pub made: Option<MadePlan>,
    /// What lies under it.
    pub ground: PlanGround,
    /// Where one looks.
    pub looking: MapLooking,
    /// What of it was drawn last.
    pub drawn: Option<DrawnPart>,
    /// What was drawn last with all of it in it.
    pub whole: Option<DrawnPart>,
}

/// A plan with what the window needs of it.
pub struct MadePlan {
    /// Of this number.
    pub revision: u64,
    /// The plan.
    pub plan: Arc<Plan>,
    /// Its photos by their places.
    pub photos: Arc<PhotosAt>,
    /// Its ground.
    pub ground: egui::TextureHandle,
    /// What the ground is of.
    pub surface: Arc<Surface>,
}

impl FlightMap {
    /// What is wished for of [`Task::MAP`]: a plan of the review, with the ground, of now.
    ///
    /// [`Task::MAP`]: crate::tasks::Task::MAP
    pub fn wish(&self) -> (u64, PlanGround) {
        (self.revision, self.ground)
    }

    /// The plan, if it is of the review and with the ground of now.
    pub fn of_now(&self) -> Option<&MadePlan> {
        let made = self.made.as_ref()?;
        let is_of_now = made.revision == self.revision && made.plan.ground_kind == self.ground;
        is_of_now.then_some(made)
    }

    /// Takes a part that was drawn.
    fn take_drawn(&mut self, drawn: DrawnPart) {
        let is_whole = |made: &MadePlan| drawn.holds(made.plan.extent);
        if self.made.as_ref().is_some_and(is_whole) {
            self.whole = Some(drawn.clone());
        }
        self.drawn = Some(drawn);
    }

    /// What is shown of photos where this part of the map (least and greatest x and y) is in sight: what was drawn last, or all of
    /// the map, coarser, until the part is drawn that was zoomed or moved to. Else photos would end at the edge of the part before.
    pub fn shown(&self, plan: &Plan, [min, max]: [DVec2; 2]) -> Option<&DrawnPart> {
        let last = self.drawn.as_ref()?;
        let [least, greatest] = plan.extent;
        let whole = self.whole.as_ref().filter(|whole| whole.is_as(last));
        match last.holds([min.max(least), max.min(greatest)]) {
            true => Some(last),
            false => whole.or(Some(last)),
        }
    }
}

/// Which part of the plan is in sight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MapLooking {
    /// World x and y in the frame's middle, and points of the screen to a world unit; `None` shows all of it.
    pub at: Option<(DVec2, f64)>,
}

/// How much of the frame the whole plan fills.
const FITTED: f64 = 0.92;

/// The closest look: points of the screen to a pixel of the ground.
const CLOSEST: f64 = 40.0;

impl MapLooking {
    /// The middle and the scale in a frame of this size, points of the screen.
    pub fn seen(&self, plan: &Plan, size: DVec2) -> (DVec2, f64) {
        self.at.unwrap_or_else(|| fit(plan, size))
    }

    /// Larger by a factor, with what is under the cursor staying there; `cursor` counts from the frame's left
    /// upper corner, y down.
    #[must_use]
    pub fn zoomed(self, plan: &Plan, cursor: DVec2, factor: f64, size: DVec2) -> Self {
        let (middle, scale) = self.seen(plan, size);
        let (_, fitted) = fit(plan, size);
        let closest = (CLOSEST / plan.raster.pixel).max(fitted);
        let next = (scale * factor).clamp(fitted * 0.5, closest);
        if !next.is_finite() {
            return self;
        }
        let off = DVec2::new(cursor.x - size.x / 2.0, size.y / 2.0 - cursor.y);
        let under = middle + off / scale;
        Self {
            at: Some((held(plan, under - off / next), next)),
        }
    }

    /// Moved by so many points of the screen, y down.
    #[must_use]
    pub fn panned(self, plan: &Plan, by: DVec2, size: DVec2) -> Self {
        let (middle, scale) = self.seen(plan, size);
        let middle = middle - DVec2::new(by.x, -by.y) / scale;
        Self {
            at: Some((held(plan, middle), scale)),
        }
    }
}

fn fit(plan: &Plan, size: DVec2) -> (DVec2, f64) {
    let [min, max] = plan.extent;
    let scale = (size * FITTED / (max - min)).min_element();
    ((min + max) / 2.0, scale.max(f64::MIN_POSITIVE))
}

/// Not lost from sight: some place of the plan is in the frame's middle.
fn held(plan: &Plan, middle: DVec2) -> DVec2 {
    middle.clamp(plan.extent[0], plan.extent[1])
}
