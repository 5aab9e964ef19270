//! What the engineer can do, as data: panels, the menu, shortcuts and tests all send these, and one
//! function applies them.

mod asking;
mod destination;
mod dialog;
mod review_step;
pub(crate) mod view_change;

use std::path::PathBuf;

pub use asking::Asking;
pub use destination::{Destination, MeasuredTable, PictureRequest};
pub use dialog::{Answers, Chooses, Dialog};
pub use review_step::ReviewStep;
pub use view_change::ViewChange;

use crate::control_points::ControlStep;
use crate::flight::{DecisionKind, FlightSettings, Limits, Verdict};
use crate::fragments::FragmentStep;
use crate::from_photos::FromPhotosStep;
use crate::geometry::Ray;
use crate::kept_aside::KeptStep;
use crate::linked::PointFrom;
use crate::map::MapCommand;
use crate::open_flight::beside::BesideStep;
use crate::open_flight::georeferencing::GeoreferenceForm;
use crate::open_flight::survey::SurveyStep;
use crate::open_flight::survey::clip::ClipStep;
use crate::open_flight::survey::picked::PickStep;
use crate::open_flight::table::SortBy;
use crate::open_flight::tracing::Trace;
use crate::opening::GeoreferenceRequest;
use crate::photo_view::PhotoCommand;
use crate::planning::PlanStep;
use crate::render::ColorBy;
use crate::scale::CornerName;
use crate::season::SeasonStep;
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
    /// The doubtful photos, one after the other.
    Review,
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

/// One thing to do.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// Opens a flight.
    Open(PathBuf),
    /// Reads the files of the flight on the screen anew.
    ReadAgain,
    /// Takes what was dropped: size distributions, or something of a flight.
    Drop(Vec<PathBuf>),
    /// Opens what was dropped: a flight, perhaps with its surface and photos; a surface alone is for
    /// the flight that could not be opened last. Beside a flight on the screen it is asked what it is to be.
    DropFlight(Vec<PathBuf>),
    /// Gives the flight on the screen, or the one that could not be opened last, this surface or this
    /// folder of photos.
    Add(PathBuf),
    /// Opens this cloud by itself, whatever flight is on the screen.
    OpenAlone(PathBuf),
    /// Opens the bundled flight.
    OpenSample,
    /// A step with changes that a window left behind.
    Kept(KeptStep),
    /// Goes back to the start page.
    Close,
    /// Writes flight.toml.
    Save,
    /// Writes flight.toml at this place.
    SaveAs(Destination),
    /// Whether exports have the rectified photos, too.
    ExportRectified(bool),
    /// Exports the chosen photos into this folder.
    Export(Destination),
    /// Writes a picture of the viewport.
    Picture(PictureRequest),
    /// Reads a cloud to be drawn beside the surface.
    AddLayer(PathBuf),
    /// Reads a second surface for volumes to be over.
    VolumeBase(PathBuf),
    /// Writes a table of what was measured.
    SaveMeasured(MeasuredTable, Destination),
    /// Where the colours of the surface end, in world units, degrees or pixels per world unit; `None` is
    /// where they do of themselves.
    ColorLimits(ColorBy, Option<[f64; 2]>),
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
    /// A step of making a new flight from photos.
    FromPhotos(FromPhotosStep),
    /// A step of going through a season of blasts.
    Season(SeasonStep),
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
    /// Looks what is under the mouse, in this part of the window; `None` where the mouse left it.
    Hover(PointFrom, Option<Ray>),
    /// Moves the view's centre to what is under the mouse.
    DoubleClick(Ray),
    /// The mouse is over a photo of the table.
    HoverPhoto(Option<usize>),
    /// Takes a photo along into the export, or not: decides whatever is needed for it.
    Choose(usize, bool),
    /// Takes many along.
    ChooseAll(Choice),
    /// Decides about a photo, with a note; `None` takes the decision back.
    Decide(usize, Option<(DecisionKind, String)>),
    /// A step of the review of doubtful photos.
    Review(ReviewStep),
    /// Sorts the table; the same column again turns it around.
    Sort(SortBy),
    /// Shows only photos that hold this text.
    Filter(String),
    /// Shows only photos with this verdict.
    FilterVerdict(Option<Verdict>),
    /// Shows only photos that something speaks against.
    FilterDoubtful(bool),

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
    /// Does something on the map.
    Map(MapCommand),
    /// Does something with the flight plan.
    Plan(PlanStep),
    /// Does something with the fragments of the selected photo.
    Fragments(FragmentStep),
    /// Does something with the size distributions.
    Distributions(DistributionCommand),
    /// Shows a tab of the right panel.
    Tab(Tab),
    /// Shows or hides the log.
    ToggleLog,
    /// Shows or hides the panel at the left.
    ToggleLeft,
    /// Shows or hides the panel at the right.
    ToggleRight,
    /// Shows or hides the strip of the flight's health.
    ToggleHealth,
    /// Puts the message over the viewport away.
    DismissNotice,

    /// Turns or leaves the view.
    View(ViewChange),
    /// Begins or ends measuring.
    ToggleMeasure,
    /// Takes the point back that measuring has begun with; the tool stays.
    MeasureAnew,
    /// A step of drawing a line or polygon on the surface, to measure there.
    Survey(SurveyStep),
    /// Does something with the clouds beside the surface.
    Beside(BesideStep),
    /// Does something with the clipping box.
    Clip(ClipStep),
    /// Does something with the picked points.
    Pick(PickStep),
    /// Does something with the control points.
    Control(ControlStep),
    /// A step of tracing a scale object on the selected photo.
    Trace(Trace),
    /// Shows the corners enlarged, or does no longer.
    ToggleLoupe,
    /// Goes to a corner of the selected photo.
    GoToCorner(CornerName),
    /// Does something in the photo view.
    Photo(PhotoCommand),
    /// Tints the selected photo by its scale, or does no longer.
    ToggleTint,
    /// Copies what Split-Desktop's dialog asks for: the selected photo's top and bottom scale.
    CopyScales,
    /// Copies a text.
    Copy(String),
    /// The path that the desktop's dialog gave stands in the field now.
    TakeAnswer,
    /// Tells what went wrong outside of the state: in the graphics device.
    Report(String),
}

impl Command {
    /// Whether it is done behind the others of a frame: it writes or leaves what a field may just have changed, or takes a place
    /// out of a list that others of them name by its number.
    pub(crate) fn comes_last(&self) -> bool {
        matches!(
            self,
            Self::Save
                | Self::SaveAs(_)
                | Self::SaveFirst
                | Self::Export(_)
                | Self::ReadAgain
                | Self::Open(_)
                | Self::OpenSample
                | Self::Close
                | Self::Quit
                | Self::Page(_)
                | Self::Control(
                    ControlStep::Remove(_) | ControlStep::RemoveBar(_) | ControlStep::Apply
                )
                | Self::Beside(BesideStep::Remove(_))
                | Self::Distributions(DistributionCommand::Remove(_))
                | Self::Pick(PickStep::Remove(_) | PickStep::RemoveAll)
                | Self::Plan(PlanStep::SaveMission(_) | PlanStep::SaveTable(_))
                | Self::Fragments(FragmentStep::Export(_))
        )
    }
}
