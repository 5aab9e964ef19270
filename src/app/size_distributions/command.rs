//! What the engineer can do with size distributions, as data.

use std::path::PathBuf;

use super::{PasteForm, PlotOf, ResultTab, Settings};
use crate::command::Destination;
use crate::fragmentation::Labels;

/// One thing to do on the page of size distributions.
#[derive(Debug, Clone, PartialEq)]
pub enum DistributionCommand {
    /// Adds these files.
    Add(Vec<PathBuf>),
    /// Adds the known fragments of the flight on the screen.
    AddKnown,
    /// Types into the small window for a table.
    FillPaste(PasteForm),
    /// Adds the table in it.
    Paste,
    /// Takes this one of the sources away.
    Remove(usize),
    /// Takes all away.
    RemoveAll,
    /// Looks at them in another way.
    Set(Settings),
    /// Computes once more what was cancelled.
    Compute,
    /// Draws these curves, or not.
    Show(Vec<Labels>, bool),
    /// Plots something else.
    Plot(PlotOf),
    /// Shows other results.
    Tab(ResultTab),
    /// Reads times of steps from this file.
    AddEffort(PathBuf),
    /// Takes those times away.
    RemoveEffort,
    /// Writes the figure: .svg or .png.
    SaveFigure(Destination),
    /// Writes the report.
    SaveReport(Destination),
    /// Writes all curves as a table.
    SaveTable(Destination),
}
