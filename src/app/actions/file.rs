//! Opening, saving, writing.

use egui::{Key, Modifiers};

use super::{Action, SHIFT, keys, on_pile, with_distributions, with_flight};
use crate::command::{Answers, Asking, Command, Dialog};
use crate::control_points::ControlStep;
use crate::from_photos::FromPhotosStep;
use crate::season::SeasonStep;
use crate::size_distributions::DistributionCommand;

actions! {
    OPEN {
        label: "Open…",
        hover: "Open a flight: a flight.toml, or what a photogrammetry package wrote",
        shortcut: keys(Modifiers::COMMAND, Key::O),
        command: |_| Some(Command::Ask(Some(Asking::Open))),
    }
    OPEN_FILE {
        label: "Open file…",
        hover: "Choose a file with the desktop's own dialog",
        shortcut: None,
        command: |_| {
            Some(Command::Browse(
                Dialog::file("Open a flight").answering(Answers::Open),
            ))
        },
    }
    OPEN_FOLDER {
        label: "Open folder…",
        hover: "Choose a folder with the desktop's own dialog",
        shortcut: None,
        command: |_| {
            Some(Command::Browse(
                Dialog::folder("Open a flight's folder").answering(Answers::Open),
            ))
        },
    }
    FROM_PHOTOS {
        label: "New from photos…",
        hover: "Make a flight from its photos alone: a cloud, and where each photo was taken",
        shortcut: keys(Modifiers::COMMAND, Key::N),
        command: |_| Some(Command::FromPhotos(FromPhotosStep::Ask(None))),
    }
    SEASON {
        label: "Season of blasts…",
        hover: "Do the same with many flights: scales, check, export, scale maps, fragments; and see how they are",
        shortcut: None,
        command: |_| Some(Command::Season(SeasonStep::Ask)),
    }
    ADD {
        label: "Add surface or photos…",
        hover: "Give the flight another cloud or mesh as its surface, or the folder of its photos",
        shortcut: keys(SHIFT, Key::O),
        command: |state| {
            let wanted = state.open.is_some() || state.tried.is_some();
            wanted.then_some(Command::Ask(Some(Asking::Add)))
        },
    }
    ADD_LAYER {
        label: "Add cloud as layer…",
        hover: "Draw another cloud or mesh beside the flight's surface; scales never depend on it",
        shortcut: None,
        command: |state| on_pile(state, Command::Ask(Some(Asking::AddLayer))),
    }
    GEOREFERENCE {
        label: "Georeference…",
        hover: "Bring a reconstruction in a frame of its own to the world, or to its true scale, by what \
                is known of it",
        shortcut: None,
        command: |state| {
            state.open.as_ref()?.files.reconstruction.as_ref()?;
            Some(Command::Ask(Some(Asking::Georeference)))
        },
    }
    CONTROL_POINTS {
        label: "Control points…",
        hover: "Click surveyed points and the ends of scale bars in photos: they bring the flight to the world, or \
                give it its unit",
        shortcut: keys(Modifiers::NONE, Key::G),
        command: |state| {
            let has_photos = state.open.as_ref()?.review.count() > 1;
            has_photos.then(|| on_pile(state, Command::Control(ControlStep::Toggle)))?
        },
    }
    OPEN_SAMPLE {
        label: "Open the sample flight",
        hover: "Nine photos of the paper's lab, simulated, with known answers",
        shortcut: None,
        command: |_| Some(Command::OpenSample),
    }
    ADD_DISTRIBUTIONS {
        label: "Add size distributions…",
        hover: "Add tables of cumulative percent passing by size: what Split-Desktop or a sieve gave",
        shortcut: keys(Modifiers::COMMAND, Key::D),
        command: |_| Some(Command::Ask(Some(Asking::AddDistributions))),
    }
    PASTE_TABLE {
        label: "Paste table…",
        hover: "Add a table of size distributions that was copied from a spreadsheet or a text",
        shortcut: keys(SHIFT, Key::D),
        command: |_| Some(Command::Ask(Some(Asking::PasteTable))),
    }
    ADD_KNOWN {
        label: "Add the flight's known fragments",
        hover: "Add reference.csv beside the flight on the screen: the sieve curve of its fragments",
        shortcut: None,
        command: |state| {
            state.known_fragments()?;
            Some(Command::Distributions(DistributionCommand::AddKnown))
        },
    }
    SAVE_FIGURE {
        label: "Save figure…",
        hover: "Write the figure of the size distributions as an SVG or PNG",
        shortcut: None,
        command: |state| with_distributions(state, Asking::SaveFigure),
    }
    SAVE_REPORT {
        label: "Save report…",
        hover: "Write the figure and all tables of methods held against the reference as an HTML page",
        shortcut: None,
        command: |state| {
            let computed = state.distributions.computed.as_ref()?;
            let compared = computed.analysis.methods.len() > 1;
            compared.then_some(Command::Ask(Some(Asking::SaveReport)))
        },
    }
    SAVE_TABLE {
        label: "Save table…",
        hover: "Write all curves, pasted ones too, as a table that can be added again",
        shortcut: None,
        command: |state| {
            let some = !state.distributions.sources().is_empty();
            some.then_some(Command::Ask(Some(Asking::SaveTable)))
        },
    }
    READ_AGAIN {
        label: "Read again",
        hover: "Read the flight's files anew, as they are now",
        shortcut: keys(Modifiers::NONE, Key::F5),
        command: |state| {
            with_flight(state, Command::ReadAgain)
        },
    }
    SAVE {
        label: "Save",
        hover: "Write the flight's settings into its flight.toml",
        shortcut: keys(Modifiers::COMMAND, Key::S),
        command: |state| with_flight(state, Command::Save),
    }
    SAVE_AS {
        label: "Save as…",
        hover: "Write a flight.toml at another place",
        shortcut: keys(SHIFT, Key::S),
        command: |state| with_flight(state, Command::Ask(Some(Asking::SaveAs))),
    }
    EXPORT {
        label: "Export for Split-Desktop…",
        hover: "Write a folder with the scales, a sheet to type from, undistorted photos and overlays",
        shortcut: keys(Modifiers::COMMAND, Key::E),
        command: |state| with_flight(state, Command::Ask(Some(Asking::Export))),
    }
    PICTURE {
        label: "Save picture…",
        hover: "Write the viewport, or the corner-ray figure, as a PNG of any size",
        shortcut: keys(Modifiers::COMMAND, Key::P),
        command: |state| on_pile(state, Command::Ask(Some(Asking::Picture))),
    }
    EXPORT_MAP {
        label: "Export map…",
        hover: "Write the flight as a plan: a page for a report (SVG, PDF, PNG) or pixels for map programs (GeoTIFF)",
        shortcut: None,
        command: |state| with_flight(state, Command::Ask(Some(Asking::Map))),
    }
    CLOSE {
        label: "Close flight",
        hover: "Go back to the start page",
        shortcut: keys(Modifiers::COMMAND, Key::W),
        command: |state| with_flight(state, Command::Close),
    }
    QUIT {
        label: "Quit",
        hover: "Leave fragscale",
        shortcut: keys(Modifiers::COMMAND, Key::Q),
        command: |_| Some(Command::Quit),
    }
}

/// The menu's entries.
pub const MENU: &[Option<Action>] = &[
    Some(OPEN),
    Some(OPEN_FILE),
    Some(OPEN_FOLDER),
    Some(FROM_PHOTOS),
    Some(SEASON),
    Some(ADD),
    Some(ADD_LAYER),
    Some(GEOREFERENCE),
    Some(CONTROL_POINTS),
    Some(OPEN_SAMPLE),
    None,
    Some(ADD_DISTRIBUTIONS),
    Some(PASTE_TABLE),
    Some(ADD_KNOWN),
    Some(SAVE_FIGURE),
    Some(SAVE_REPORT),
    Some(SAVE_TABLE),
    None,
    Some(READ_AGAIN),
    Some(SAVE),
    Some(SAVE_AS),
    None,
    Some(EXPORT),
    Some(PICTURE),
    Some(EXPORT_MAP),
    None,
    Some(CLOSE),
    Some(QUIT),
];
