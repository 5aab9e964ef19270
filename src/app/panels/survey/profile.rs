//! The profile: plot, crest, toes, angles of repose.

use egui_plot::{AxisHints, Line, Plot, PlotPoints, Points};

use super::{copy, numbers, save};
use crate::command::{Command, MeasuredTable};
use crate::exports::{ProfileReport, profile_csv, profile_table, stone_sides};
use crate::open_flight::OpenFlight;
use crate::open_flight::survey::Drawn;
use crate::render::MEASURED;
use crate::survey::LEAST_BRIDGED;

/// Points of the plot at most: more than any screen has columns.
const MOST_POINTS: usize = 4000;

/// How high the plot is, and what its axes take of its width and height, points.
const HEIGHT: f32 = 170.0;
const AXES: [f32; 2] = [55.0, 40.0];

/// How many times as high as long a low relief is drawn, and how much of the plot's height it fills then, at most.
const TIMES: [f64; 6] = [100.0, 50.0, 20.0, 10.0, 5.0, 2.0];
const FILLED: f64 = 0.8;

/// Of a line's length: a lower relief is drawn as if it were as high.
const LEAST_RELIEF: f64 = 0.01;

/// How many times as high as long a profile is drawn, so that its relief is seen; `room` is the plot's, points.
fn times_as_high(relief: f64, length: f64, [width, height]: [f32; 2]) -> f64 {
    let most = FILLED * length * f64::from(height / width.max(1.0));
    let mut times = TIMES.into_iter();
    times.find(|times| times * relief <= most).unwrap_or(1.0)
}

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
    if !drawn.finished {
        // The plot would lie over the place of the next point.
        ui.label(format!("So far {:.3} {unit} in plan", profile.length));
        return;
    }
    let faces = profile.faces();
    let color = ui.visuals().hyperlink_color;
    // Every so many of the points; the ends of holes always.
    let step = profile.points().count().div_ceil(MOST_POINTS).max(1);
    let heights = profile.points().map(|at| at.point.z);
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| {
        [low.min(z), high.max(z)]
    });
    // A line beyond the surface has none.
    let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
    let relief = (high - low).max(LEAST_RELIEF * profile.length);
    let room = [ui.available_width() - AXES[0], HEIGHT - AXES[1]];
    let times = times_as_high(relief, profile.length, room);
    let of_height = match times > 1.0 {
        true => format!("Height [{unit}], × {times}"),
        false => format!("Height [{unit}]"),
    };
    let middle = low.midpoint(high);
    Plot::new("profile plot")
        .height(HEIGHT)
        .data_aspect(times as f32)
        .include_y(middle - 0.5 * relief)
        .include_y(middle + 0.5 * relief)
        .allow_scroll(false)
        .custom_x_axes(vec![
            // Closer than usual: with the scales of both axes bound to each other a narrow plot has no other distances.
            AxisHints::new_x()
                .label(format!("Along the line [{unit}]"))
                .label_spacing(30.0..=50.0),
        ])
        .custom_y_axes(vec![AxisHints::new_y().label(of_height)])
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
    let stones = stone_sides(&faces, profile);
    for (([toe, angle], face), is_of_a_stone) in names.into_iter().zip(&faces).zip(stones) {
        if let Some(face) = face {
            rows.push((toe, height(face.toe.point.z)));
            let doubt = match is_of_a_stone {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_low_relief_is_drawn_higher() {
        let room = [385.0, 130.0];
        let times = |relief: f64, length: f64| times_as_high(relief, length, room);
        // A flank of 3 in 4 is drawn as it is; gravel on a floor is seen.
        assert_eq!(times(0.25, 1.2), 1.0);
        assert_eq!(times(0.036, 1.2), 5.0);
        assert_eq!(times(0.36, 12.0), 5.0);
        // A plane is drawn as one.
        assert_eq!(times(LEAST_RELIEF * 12.0, 12.0), 20.0);
    }
}
