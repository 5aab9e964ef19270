//! The profile: plot, crest, toes, angles of repose.

use egui_plot::{AxisHints, Line, Plot, PlotPoints, Points};

use super::{copy, numbers, save};
use crate::command::{Command, MeasuredTable};
use crate::exports::{ProfileReport, is_of_a_stone, profile_csv, profile_table};
use crate::open_flight::OpenFlight;
use crate::open_flight::survey::Drawn;
use crate::render::MEASURED;
use crate::survey::LEAST_BRIDGED;

/// Points of the plot at most: more than any screen has columns.
const MOST_POINTS: usize = 4000;

pub(super) fn profile(
    open: &OpenFlight,
    drawn: &Drawn,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Some(profile) = drawn.profile() else {
        return;
    };
    let parts = open.flight().parts();
    let unit = parts.unit_of_lengths();
    let faces = profile.faces();
    let color = ui.visuals().hyperlink_color;
    // Every so many of the points; the ends of holes always.
    let step = profile.points().count().div_ceil(MOST_POINTS).max(1);
    Plot::new("profile plot")
        .height(170.0)
        .data_aspect(1.0)
        .allow_scroll(false)
        .custom_x_axes(vec![
            // Closer than usual: with equal scales on both axes a narrow plot has no other distances.
            AxisHints::new_x()
                .label(format!("Along the line [{unit}]"))
                .label_spacing(30.0..=50.0),
        ])
        .custom_y_axes(vec![AxisHints::new_y().label(format!("Height [{unit}]"))])
        .show(ui, |plot| {
            for run in &profile.runs {
                let last = run.len() - 1;
                let shown = run.iter().enumerate();
                let shown = shown.filter(|(place, _)| place % step == 0 || *place == last);
                let points: PlotPoints<'_> =
                    shown.map(|(_, at)| [at.distance, at.point.z]).collect();
                plot.line(Line::new("Surface", points).color(color).width(2.0));
            }
            for face in faces.iter().flatten() {
                let ends = [face.crest, face.toe].map(|at| [at.distance, at.point.z]);
                let [red, green, blue] = MEASURED;
                let marks = Points::new("Crest and toe", ends.to_vec());
                plot.points(
                    marks
                        .radius(4.0)
                        .color(egui::Color32::from_rgb(red, green, blue)),
                );
            }
        });
    let height = |height: f64| format!("{height:.3} {unit}");
    let mut rows = vec![("Length in plan", height(profile.length))];
    if let Some(crest) = profile.crest() {
        rows.push(("Crest", height(crest.point.z)));
    }
    let names = [
        ["Toe before", "Angle of repose before"],
        ["Toe after", "Angle of repose after"],
    ];
    for ([toe, angle], face) in names.into_iter().zip(&faces) {
        if let Some(face) = face {
            rows.push((toe, height(face.toe.point.z)));
            let doubt = match is_of_a_stone(face, profile) {
                true => " (a stone's side)",
                false => "",
            };
            let repose = face
                .repose
                .map_or_else(|| "holes".to_owned(), |a| format!("{a:.1}°{doubt}"));
            rows.push((angle, repose));
        }
    }
    if profile.covered() < 1.0 - 1e-9 {
        rows.push((
            "Holes",
            format!("{:.1} %", 100.0 * (1.0 - profile.covered())),
        ));
    }
    if profile.bridged > LEAST_BRIDGED {
        rows.push((
            "Without points, bridged",
            format!("{:.1} %", 100.0 * profile.bridged),
        ));
    }
    numbers("profile numbers", &rows, ui);
    let report = ProfileReport {
        flight: &parts.name,
        unit: open.measured_unit(),
        profile,
    };
    ui.horizontal(|ui| {
        let hover = "Crest, toes and angles as text";
        copy(
            "Copy numbers",
            hover,
            Some(profile_table(&report)),
            ui,
            commands,
        );
        // Written out only when it is asked for.
        let button = ui.button("Copy points");
        let hover = "Every point of the profile as CSV: distance, x, y, height";
        if button.on_hover_text(hover).clicked() {
            commands.extend(profile_csv(&report).ok().map(Command::Copy));
        }
        save(MeasuredTable::Profile, ui, commands);
    });
}
