//! The small windows.

use super::MeasuredTable;

/// A small window that asks for a place; beside the desktop's own dialog, which not every desktop
/// has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asking {
    /// Which flight to open.
    Open,
    /// Which surface or photos the flight shall have.
    Add,
    /// Which of the flights in a folder.
    Choose,
    /// Where the export goes.
    Export,
    /// Which photos a new flight is made of.
    FromPhotos,
    /// Which season of blasts is gone through.
    Season,
    /// What is known of the reconstruction's place in the world.
    Georeference,
    /// Where the georeferenced flight goes.
    SaveGeoreferenced,
    /// Where flight.toml goes.
    SaveAs,
    /// Where a picture goes, and how large it is.
    Picture,
    /// Where the map goes.
    Map,
    /// Where the planned mission goes.
    Mission,
    /// Where the table of the plan goes.
    PlanTable,
    /// Where the page to print of the plan goes.
    PlanSheet,
    /// Where the comparison of a mission with its flight goes.
    Flown,
    /// Which files of size distributions to add.
    AddDistributions,
    /// A table of size distributions.
    PasteTable,
    /// Which file has the times of steps.
    AddEffort,
    /// Where the figure of the size distributions goes.
    SaveFigure,
    /// Where the report on them goes.
    SaveReport,
    /// Where the table of size distributions goes.
    SaveTable,
    /// Which list has the control points.
    ControlList,
    /// Which file has the outlines of the selected photo.
    Masks,
    /// Which file describes her network.
    Network,
    /// Where the tables and the report of the fragments go.
    ExportFragments,
    /// Which cloud is drawn beside the surface.
    AddLayer,
    /// What the cloud is to be that was dropped or opened beside a flight.
    CloudUse,
    /// Which cloud a volume is over.
    VolumeBase,
    /// Where a table of what was measured goes.
    SaveMeasured(MeasuredTable),
    /// Which keys do what.
    Keys,
    /// What this program is.
    About,
}
