//! What the engineer can do, as data: panels, the menu, shortcuts and tests all send these, and one
//! function applies them.

use std::path::PathBuf;

use glam::{DVec2, DVec3};

use crate::flight::{FlightSettings, Limits, Verdict};
use crate::formats::GeoreferenceRequest;
use crate::geometry::Ray;
use crate::open_flight::georeferencing::{GeoreferenceForm, PathField};
use crate::open_flight::table::Column;
use crate::open_flight::tracing::Trace;
use crate::size_distributions::{DistributionCommand, Page};
use crate::state::layers::Layers;
use crate::state::preferences::Theme;
use crate::tasks::work::Task;
use crate::units::LengthUnit;

/// Which tab of the right panel is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tab {
    /// The selected photo.
    #[default]
    Photo,
    /// The flight's settings.
    Flight,
    /// When to doubt.
    Limits,
}

/// A small window that asks for a place; beside the desktop's own dialog, which not every desktop
/// has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asking {
    /// Which flight to open.
    Open,
    /// Which surface or photos the flight shall have.
    Add,
    /// Where the export goes.
    Export,
    /// What is known of the reconstruction's place in the world.
    Georeference,
    /// Where the georeferenced flight goes.
    SaveGeoreferenced,
    /// Where flight.toml goes.
    SaveAs,
    /// Where a picture goes, and how large it is.
    Picture,
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
    /// Which keys do what.
    Keys,
    /// What this program is.
    About,
}

/// Where something is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Destination {
    /// The file or folder.
    pub path: PathBuf,
    /// Whether it may replace what is there: she was asked, and said so.
    pub replace: bool,
}

/// Replaces nothing.
impl From<PathBuf> for Destination {
    fn from(path: PathBuf) -> Self {
        Self {
            path,
            replace: false,
        }
    }
}

/// A picture of the viewport to be written.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureRequest {
    /// Where to.
    pub to: Destination,
    /// In pixels.
    pub size: [u32; 2],
    /// Without a background, or on white.
    pub transparent: bool,
    /// With the layers of the paper's figure.
    pub corner_rays: bool,
}

/// The desktop's own dialog for a file or folder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dialog {
    /// What it says on top.
    pub title: &'static str,
    /// What is chosen in it.
    pub chooses: Chooses,
    /// What is done with that.
    pub answers: Answers,
}

/// What is chosen in a dialog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Chooses {
    /// A file that is there.
    File,
    /// A folder.
    Folder,
    /// A file to write, with this name if nobody types another.
    NewFile(&'static str),
}

/// What is done with what was chosen in a dialog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Answers {
    /// It is opened.
    Open,
    /// It stands in the field of the small window that is open.
    Asking,
    /// It stands in this field of georeferencing.
    Georeference(PathField),
}

impl Dialog {
    /// For a file, for the small window that is open.
    pub const fn file(title: &'static str) -> Self {
        Self {
            title,
            chooses: Chooses::File,
            answers: Answers::Asking,
        }
    }

    /// For a folder, for the small window that is open.
    pub const fn folder(title: &'static str) -> Self {
        Self {
            chooses: Chooses::Folder,
            ..Self::file(title)
        }
    }

    /// For a file to write, for the small window that is open.
    pub const fn new_file(title: &'static str, name: &'static str) -> Self {
        Self {
            chooses: Chooses::NewFile(name),
            ..Self::file(title)
        }
    }

    /// The same with another answer.
    #[must_use]
    pub const fn answering(self, answers: Answers) -> Self {
        Self { answers, ..self }
    }
}

/// Which photos a choice is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// All photos that have a scale.
    WithScale,
    /// Those with the verdict "trust".
    Trusted,
    /// None.
    None,
}

/// A change of the view: the free view is turned, or left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ViewChange {
    /// The mouse moved by these pixels: turn.
    Orbit(DVec2),
    /// The mouse moved by these pixels in a viewport of this size: move.
    Pan(DVec2, DVec2),
    /// Come closer (factor < 1) to what is under the cursor, in a viewport of this size.
    Zoom {
        /// Where the mouse is.
        cursor: DVec2,
        /// Of the viewport.
        size: DVec2,
        /// Under 1 comes closer.
        factor: f64,
    },
    /// The viewport has this size now, pixels.
    Resized(DVec2),
    /// Straight down.
    Top,
    /// To the north.
    Front,
    /// To the west.
    Side,
    /// Everything in sight.
    Fit,
    /// The selected photo's footprint and camera in sight.
    FitSelected,
    /// This point in the middle.
    Center(DVec3),
    /// Through the camera of the selected photo, or back.
    Through,
    /// How much of the photo lies over the view.
    Blend(f64),
}

/// One thing to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// Opens a flight.
    Open(PathBuf),
    /// Takes what was dropped: size distributions, or something of a flight.
    Drop(Vec<PathBuf>),
    /// Opens what was dropped: a flight, perhaps with its surface and photos; a surface alone is for
    /// the flight that could not be opened last, else for the one on the screen.
    DropFlight(Vec<PathBuf>),
    /// Gives the flight on the screen, or the one that could not be opened last, this surface or this
    /// folder of photos.
    Add(PathBuf),
    /// Opens the bundled flight.
    OpenSample,
    /// Goes back to the start page.
    Close,
    /// Writes flight.toml.
    Save,
    /// Writes flight.toml at this place.
    SaveAs(Destination),
    /// Exports the chosen photos into this folder.
    Export(Destination),
    /// Writes a picture of the viewport.
    Picture(PictureRequest),
    /// Types into the small window for georeferencing.
    FillGeoreference(GeoreferenceForm),
    /// Fits the reconstruction on the screen to the world.
    Georeference(GeoreferenceRequest),
    /// Writes what was fitted as a flight.toml, and opens it.
    SaveGeoreferenced {
        /// Where to.
        to: Destination,
        /// Whether the surface's file is in the world already.
        keep_surface: bool,
    },
    /// Opens a small window that asks for a place, or closes it.
    Ask(Option<Asking>),
    /// Opens the desktop's own dialog.
    Browse(Dialog),
    /// Cancels a task.
    Cancel(Task),
    /// Leaves the program.
    Quit,
    /// Goes on with what was held back because something would be lost.
    Discard,
    /// Saves, and then goes on with what was held back.
    SaveFirst,
    /// Does not go on.
    Keep,

    /// Selects a photo.
    Select(Option<usize>),
    /// Selects the photo so many rows further down the table.
    SelectBy(i32),
    /// Selects the photo that a click in the viewport means.
    Click(Ray),
    /// Looks what is under the mouse; `None` where the mouse left.
    Hover(Option<Ray>),
    /// Moves the view's centre to what is under the mouse.
    DoubleClick(Ray),
    /// The mouse is over a photo of the table.
    HoverPhoto(Option<usize>),
    /// Chooses a photo for export, or not.
    Choose(usize, bool),
    /// Chooses many.
    ChooseAll(Choice),
    /// Sorts the table; the same column again turns it around.
    Sort(Column),
    /// Shows only photos that hold this text.
    Filter(String),
    /// Shows only photos with this verdict.
    FilterVerdict(Option<Verdict>),

    /// Changes the flight's settings.
    Set(FlightSettings),
    /// Undoes the last change.
    Undo,
    /// Takes the last undo back.
    Redo,

    /// Changes the unit of the scales on the screen and in exports.
    Unit(LengthUnit),
    /// Changes when to doubt.
    Limits(Limits),
    /// Changes what the viewport shows.
    Layers(Layers),
    /// Light or dark.
    Theme(Theme),
    /// Enlarges everything; 1 is as the system has it.
    Zoom(f32),
    /// Shows a page of the window.
    Page(Page),
    /// Does something with the size distributions.
    Distributions(DistributionCommand),
    /// Shows a tab of the right panel.
    Tab(Tab),
    /// Shows or hides the log.
    ToggleLog,
    /// Puts the message over the viewport away.
    DismissNotice,

    /// Turns or leaves the view.
    View(ViewChange),
    /// Begins or ends measuring.
    ToggleMeasure,
    /// A step of tracing a scale object on the selected photo.
    Trace(Trace),
    /// Copies what Split-Desktop's dialog asks for: the selected photo's top and bottom scale.
    CopyScales,
    /// Copies a text.
    Copy(String),
    /// The path that the desktop's dialog gave stands in the field now.
    TakeAnswer,
    /// Tells what went wrong outside of the state: in the graphics device.
    Report(String),
}
