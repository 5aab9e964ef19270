//! What the engineer does on the page of the plan, as data.

use std::path::PathBuf;

use glam::DVec2;

use super::dragged::Handle;
use crate::command::Destination;
use crate::plan::AskedPlan;

/// One thing to do on the page of the plan.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanStep {
    /// Asks for something else.
    Ask(Box<AskedPlan>),
    /// Makes the plan of what is asked for now.
    Make,
    /// What a click in the viewport does from now on; what was drawn halfway is forgotten.
    Tool(PlanTool),
    /// Ends the area that is being drawn.
    Finish,
    /// Takes the last corner of it back.
    RemoveLast,
    /// Takes all its corners back; the tool stays.
    RemoveAll,
    /// Selects a photo by its place in the plan.
    Select(Option<usize>),
    /// Selects one that is so many further on the way.
    SelectBy(i32),
    /// Shows what the selected photo will, or does no longer.
    ToggleThrough,
    /// Drags something over the ground.
    Drag(Handle, DVec2),
    /// Lets it go.
    Drop,
    /// Leaves the selected photo out.
    Leave,
    /// Writes the missions, for the ground station that the name's ending says.
    SaveMission(Destination),
    /// Writes the table (CSV or JSON) or the page to print (HTML), by the name's ending.
    SaveTable(Destination),
    /// Takes outlines as the area, or as more ground to keep out of: typed, or a file.
    ReadAreas(PlanTool, String),
    /// Compares a mission with the flight that came of it.
    Compare(PathBuf),
    /// Looks at the plan again.
    CloseFlown,
    /// Writes the comparison: table, figure or page, by the name's ending.
    SaveFlown(Destination),
}

impl PlanStep {
    /// Whether it asks for another plan.
    pub(super) fn changes_what_is_asked(&self) -> bool {
        match self {
            Self::Ask(_)
            | Self::Finish
            | Self::Drag(..)
            | Self::Drop
            | Self::Leave
            | Self::ReadAreas(..) => true,
            Self::Make
            | Self::Tool(_)
            | Self::RemoveLast
            | Self::RemoveAll
            | Self::Select(_)
            | Self::SelectBy(_)
            | Self::ToggleThrough
            | Self::SaveMission(_)
            | Self::SaveTable(_)
            | Self::Compare(_)
            | Self::CloseFlown
            | Self::SaveFlown(_) => false,
        }
    }
}

/// What a click in the viewport does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PlanTool {
    /// Selects a photo.
    #[default]
    Select,
    /// Adds a corner of what is photographed.
    Area,
    /// Adds a corner of what is not flown over.
    KeepOut,
    /// Sets the take-off.
    TakeOff,
    /// Adds a photo.
    Add,
}
