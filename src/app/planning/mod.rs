//! The page of the flight plan: where to fly over the surface on the screen (`fragscale_core::plan`), the same that
//! the command `plan` makes.
//!
//! ```text
//! asked     what the engineer asks for, with what she moved by hand: undo goes over it
//! command   what she does on the page
//! applying  does that
//! made      the plan that came of it
//! making    the plan, as a job, whenever something else is asked for
//! lines     the plan as lines of the picture
//! saving    mission and table as files
//! ```
//!
//! The surface stays the viewport's; the flight's own cameras give way to the planned ones.

pub mod applying;
mod asked;
mod command;
mod lines;
mod made;
mod making;
mod saving;

use std::sync::Arc;

use glam::DVec2;

pub use asked::{AskedPlan, Edit, Handle};
pub use command::{PlanStep, PlanTool};
pub use made::MadePlan;

use crate::state::history::History;

/// The flight plan over a flight's surface.
#[derive(Default)]
pub struct Planning {
    /// What is asked for, with what was before; `None` until the page was seen.
    pub asked: Option<History<AskedPlan>>,
    /// The same while something is dragged.
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
    pub selected: Option<usize>,
    /// Whether the viewport shows what that photo will.
    pub through: bool,
}

impl Planning {
    /// What is asked for now.
    pub fn now(&self) -> Option<&AskedPlan> {
        (self.dragged.as_ref()).or_else(|| Some(self.asked.as_ref()?.now()))
    }

    /// Whether what is shown is what is asked for.
    pub fn is_of_now(&self) -> bool {
        let made = self.made.as_ref().map(|made| &made.asked);
        made.is_some() && made == self.now()
    }

    /// Why nothing can be made of what is asked for now.
    pub fn refused(&self) -> Option<&str> {
        let (asked, why) = self.refused.as_ref()?;
        (Some(asked) == self.now()).then_some(why.as_str())
    }

    /// The photo that is looked at.
    pub fn photo(&self) -> Option<(usize, &crate::plan::PlannedPhoto)> {
        let place = self.selected?;
        Some((place, self.made.as_ref()?.plan.photos.get(place)?))
    }
}
