//! Where the corners' rays meet the surface, and how the camera looks at it.

use std::iter::once;

use crate::command::Command;
use crate::panels::rows::Rows;
use crate::scale::{CornerOutcome, PhotoScale, ViewFacts};

/// What stands for a number that there is not.
const NONE: &str = "–";

/// The corner points, a row each, in the world's `unit`, in words; a click on a corner goes there.
pub(super) fn corners(
    unit: &str,
    scale: &PhotoScale,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.separator();
    ui.strong(format!("Corner points, {unit}"));
    let rows = scale.corners.iter().map(|corner| {
        let coordinates = match corner.point() {
            Some(point) => point.to_array().map(|value| format!("{value:.3}")),
            None => [(); 3].map(|()| NONE.to_owned()),
        };
        let on = match corner.outcome {
            CornerOutcome::OnSurface { .. } => "surface",
            CornerOutcome::OnGround { .. } => "ground",
            CornerOutcome::Nowhere => "nothing",
            CornerOutcome::NoRay(_) => "no ray",
        };
        let name = corner.name.as_str().replace('_', " ");
        once(name)
            .chain(coordinates)
            .chain([on.to_owned()])
            .collect()
    });
    let rows = Rows {
        id: "corners",
        heads: Some(&["Corner", "x", "y", "z", "on"]),
        rows: rows.collect(),
    };
    rows.show(ui, |ui, place, name| {
        // No tooltip: it would lie over the next row.
        let link = ui.link(name);
        link.widget_info(|| {
            let label = format!("Go to the corner {name}");
            egui::WidgetInfo::labeled(egui::Role::Link, true, label)
        });
        if link.clicked()
            && let Some(corner) = scale.corners.get(place)
        {
            commands.push(Command::GoToCorner(corner.name));
        }
    });
}

/// How high the camera is, in the world's `unit`, in words, and how it looks down.
pub(super) fn facts(unit: &str, view: &ViewFacts, ui: &mut egui::Ui) {
    ui.separator();
    let below = match view.height_is_above_ground {
        true => "Height above ground",
        false => "Height above surface",
    };
    let length = |length: Option<f64>| length.map(|length| format!("{length:.3} {unit}"));
    let flattest = view.flattest_corner.map(|angle| format!("{angle:.1}°"));
    let rows = [
        (below, length(view.height)),
        ("Tilt below horizon", Some(format!("{:.2}°", view.tilt))),
        ("Flattest corner ray", flattest),
        ("Off the corners' plane (rms)", length(view.plane_distance)),
        ("Mean edge of the footprint", length(view.footprint_size)),
    ];
    let rows = Rows {
        id: "facts",
        heads: None,
        rows: rows
            .into_iter()
            .map(|(name, value)| vec![name.to_owned(), value.unwrap_or_else(|| NONE.to_owned())])
            .collect(),
    };
    rows.show(ui, |ui, _, name| {
        ui.weak(name);
    });
}
