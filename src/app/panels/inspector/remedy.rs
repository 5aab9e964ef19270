//! What is done about a reason for doubt, as a button beside it.

use crate::actions;
use crate::command::{Command, Tab};
use crate::flight::{Doubt, FlightSettings};
use crate::opening::Remedy;
use crate::state::State;
use crate::surface::UpAxis;

/// A remedy as this window offers it.
pub(in crate::panels) struct Offer {
    /// On the button.
    pub(in crate::panels) name: &'static str,
    /// Over it.
    pub(in crate::panels) hover: &'static str,
    /// What it does.
    pub(in crate::panels) command: Command,
}

impl Offer {
    /// The one thing in this window that helps against a reason for doubt, where there is one now.
    pub(in crate::panels) fn against(state: &State, doubt: &Doubt) -> Option<Self> {
        let georeference = (actions::file::GEOREFERENCE.command)(state);
        Self::of(state, Remedy::against(doubt, georeference.is_some())?)
    }

    /// Of a remedy; `None` where it cannot be done now.
    pub(in crate::panels) fn of(state: &State, remedy: Remedy) -> Option<Self> {
        let add = || (actions::file::ADD.command)(state);
        Some(match remedy {
            Remedy::Georeference => Self {
                name: "Georeference…",
                hover: actions::file::GEOREFERENCE.hover,
                command: (actions::file::GEOREFERENCE.command)(state)?,
            },
            Remedy::SetUnit => Self {
                name: "Set the unit…",
                hover: "Say in which unit the cloud and the poses are",
                command: Command::Tab(Tab::Flight),
            },
            Remedy::AddPhotos => Self {
                name: "Add photos…",
                hover: "Name the folder that the photos of this flight are in",
                command: add()?,
            },
            Remedy::TurnUp(up) => Self {
                name: match up {
                    UpAxis::X => "Use x as up",
                    UpAxis::Y => "Use y as up",
                    UpAxis::Z => "Use z as up",
                },
                hover: "Turn the surface so that this axis of its file points up; Flight has the same choice",
                command: Command::Set(FlightSettings {
                    surface_up: up,
                    ..state.open.as_ref()?.settings()
                }),
            },
            Remedy::AddSurface => Self {
                name: "Add surface…",
                hover: "Name another cloud or mesh for this flight",
                command: add()?,
            },
        })
    }
}

/// The button for it.
pub(in crate::panels) fn remedy_button(
    offer: Offer,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let button = ui.button(offer.name).on_hover_text(offer.hover);
    button.widget_info(|| {
        // Told from the menu's entry of the same name.
        let label = format!("Remedy: {}", offer.name);
        egui::WidgetInfo::labeled(egui::Role::Button, true, label)
    });
    if button.clicked() {
        commands.push(offer.command);
    }
}
