//! The page of the flight plan: where to fly over the surface on the screen (`fragscale_core::plan`), the same that
//! the command `plan` makes.
//!
//! ```text
//! dragged   what is moved by hand in the viewport: undo goes over what is asked for
//! command   what she does on the page
//! applying  does that
//! made      the plan that came of it
//! making    the plan, as a job, whenever something else is asked for
//! saving    mission and table as files
//! areas     areas that are typed or in a file
//! flown     a mission against the flight that came of it
//! comparing makes and writes that
//! ```
//!
//! The surface stays the viewport's; the flight's own cameras give way to the planned ones.

pub mod applying;
mod areas;
mod command;
mod comparing;
mod dragged;
mod flown;
mod made;
mod making;
mod saving;

use std::sync::Arc;

use glam::DVec2;

pub use command::{PlanStep, PlanTool};
pub use dragged::{Handle, typed_corners};
pub use flown::FlownMission;
pub use made::MadePlan;

use crate::fault::Fault;
use crate::plan::AskedPlan;
use crate::render::PlannedLine;
use crate::state::history::History;

/// What is wrong with a flight whose plan is wanted on the Earth.
fn no_system() -> Fault {
    let what = "nobody says in which coordinate system the flight's places are";
    let remedy = "open the flight with a cloud or model that states it, georeference it, or write crs = \"EPSG:...\" under [world] in its \
                  flight.toml";
    Fault::new(what, remedy)
}

/// The flight plan over a flight's surface.
#[derive(Default)]
pub struct Planning {
    /// What is asked for, with what was before; `None` until the page was seen.
    pub asked: Option<History<AskedPlan>>,
    /// What is usual, where nothing was saved: what nobody changed is not saved either.
    usual: Option<AskedPlan>,
    /// What the flight's file asks for.
    saved: Option<AskedPlan>,
    /// What is in a mission or on a sheet.
    written: Option<AskedPlan>,
    /// What is asked for while something is dragged.
    pub dragged: Option<AskedPlan>,
    /// What was made of it last.
    pub made: Option<Arc<MadePlan>>,
    /// Why nothing could be made of it, and of what.
    pub refused: Option<(AskedPlan, String)>,
    /// What a click in the viewport does.
    pub tool: PlanTool,
    /// The corners that were clicked so far, of an area that is being drawn.
    pub drawing: Vec<DVec2>,
    /// The photo that is looked at, by its place in the plan.
    selected: Option<usize>,
    /// The plan as lines of the picture, with that photo above the others: made anew when one of both changes, and not in
    /// each frame.
    lines: Arc<Vec<PlannedLine>>,
    /// Whether the viewport shows what that photo will.
    pub through: bool,
    /// A mission against the flight, which is looked at in place of the plan.
    pub flown: Option<Arc<FlownMission>>,
}

impl Planning {
    /// Over a flight whose file asks for this.
    pub(crate) fn of_saved(saved: Option<AskedPlan>) -> Self {
        Self {
            saved,
            ..Self::default()
        }
    }

    /// What is asked for now.
    pub fn now(&self) -> Option<&AskedPlan> {
        (self.dragged.as_ref()).or_else(|| Some(self.asked.as_ref()?.now()))
    }

    /// What is to be saved with the flight: what is asked for, once it is not what is usual.
    pub fn to_save(&self) -> Option<&AskedPlan> {
        match &self.asked {
            Some(asked) if self.saved.is_some() || Some(asked.now()) != self.usual.as_ref() => {
                Some(asked.now())
            }
            Some(_) => None,
            None => self.saved.as_ref(),
        }
    }

    /// Whether something is asked for that stands in no file.
    pub fn is_lost(&self) -> bool {
        let now = self.to_save();
        now.is_some() && now != self.written.as_ref()
    }

    /// Takes what was asked for before the surface was read again.
    pub(crate) fn keep_from(&mut self, before: &mut Self) {
        *self = Self {
            asked: before.asked.take(),
            usual: before.usual.take(),
            saved: before.saved.take(),
            written: before.written.take(),
            ..Self::default()
        };
    }

    /// Takes that what this was made of is in a mission or on a sheet.
    fn take_written(&mut self, made: &MadePlan) {
        self.written = Some(made.asked.clone());
    }

    /// Begins with what the flight's file asks for, else with what is usual.
    fn begin(&mut self, usual: AskedPlan) {
        self.asked = Some(History::new(self.saved.clone().unwrap_or(usual.clone())));
        self.usual = Some(usual);
    }

    /// Whether what is shown is what is asked for.
    pub fn is_of_now(&self) -> bool {
        let made = self.made.as_ref().map(|made| &made.asked);
        made.is_some() && made == self.now()
    }

    /// Takes that the flight's lengths count in another unit, so many of the one before: what was asked stays as long as it is, and the
    /// plan that was made is none of it.
    pub(crate) fn take_unit(&mut self, before: f64) {
        let in_unit =
            |asked: &Option<AskedPlan>| asked.as_ref().map(|asked| asked.in_unit_of(before));
        let now = self.now().map(|now| now.in_unit_of(before));
        *self = Self {
            usual: in_unit(&self.usual),
            saved: in_unit(&self.saved),
            asked: now.map(History::new),
            ..Self::default()
        };
    }

    /// Takes that the surface is another one: what is asked for stays, and the plan that was made is none of it.
    pub(crate) fn over_another_surface(&mut self) {
        let mut before = std::mem::take(self);
        self.keep_from(&mut before);
    }

    /// Why nothing can be made of what is asked for now.
    pub fn refused(&self) -> Option<&str> {
        let (asked, why) = self.refused.as_ref()?;
        (Some(asked) == self.now()).then_some(why.as_str())
    }

    /// The place in the plan of the photo that is looked at.
    pub fn selected(&self) -> Option<usize> {
        self.selected
    }

    /// What is looked at as lines of the picture: a mission and the flight that came of it, else the plan.
    pub fn lines(&self) -> Arc<Vec<PlannedLine>> {
        match &self.flown {
            Some(flown) => flown.lines.clone(),
            None => self.lines.clone(),
        }
    }

    /// Looks at another photo, or at none.
    pub(crate) fn select(&mut self, photo: Option<usize>) {
        let count = self.made.as_ref().map_or(0, |made| made.plan.photos.len());
        self.selected = photo.filter(|place| *place < count);
        self.through &= self.selected.is_some();
        let lines = self.made.as_ref().map(|made| made.lines(self.selected));
        self.lines = Arc::new(lines.unwrap_or_default());
    }

    /// Takes what was made; the same photo is looked at.
    fn take(&mut self, made: MadePlan) {
        self.made = Some(Arc::new(made));
        self.refused = None;
        self.select(self.selected);
    }

    /// The photo that is looked at.
    pub fn photo(&self) -> Option<(usize, &crate::plan::PlannedPhoto)> {
        let place = self.selected?;
        Some((place, self.made.as_ref()?.plan.photos.get(place)?))
    }
}
