//! What the plan comes to, and what it lacks.

use egui::Ui;

use crate::command::Command;
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::panels::rows::pairs;
use crate::panels::working::working;
use crate::planning::PlanStep;
use crate::state::State;
use crate::tasks::Task;

/// Why nothing is planned, where that is so.
pub(super) fn refused(open: &OpenFlight, ui: &mut Ui, commands: &mut Vec<Command>) {
    let Some(why) = open.planning.refused() else {
        return;
    };
    ui.colored_label(ui.visuals().error_fg_color, why);
    if ui
        .button("Plan again")
        .on_hover_text("Try the same once more")
        .clicked()
    {
        commands.push(Command::Plan(PlanStep::Make));
    }
    ui.separator();
}

pub(super) fn found(state: &State, open: &OpenFlight, ui: &mut Ui, commands: &mut Vec<Command>) {
    let planning = &open.planning;
    if state.work.is_running(Task::PLAN) {
        ui.horizontal(|ui| {
            working(ui);
            ui.label("Planning…");
            if ui.button("Cancel").on_hover_text("Stop planning").clicked() {
                commands.push(Command::Cancel(Task::PLAN));
            }
        });
    }
    let Some(made) = &planning.made else {
        return;
    };
    let unit = open.flight().parts().unit;
    let plan = &made.plan;
    let number = |number: f64| significant_digits(number, 4);
    let kinds = crate::exports::kinds_in_words(plan);
    let mut rows = vec![
        (
            "Photos",
            kinds.unwrap_or_else(|| plan.photos.len().to_string()),
        ),
        ("Area", format!("{} {unit}²", number(plan.area.area()))),
        ("Photographed", crate::exports::percent(plan.cover.covered)),
        (
            "Widest gap",
            match plan.cover.widest_gap > 0.0 {
                true => format!("{} {unit} across", number(plan.cover.widest_gap)),
                false => "none".to_owned(),
            },
        ),
    ];
    if let Some(share) = plan.cover.surveyed {
        rows.push(("In 3 of the survey", crate::exports::percent(share)));
    }
    let seconds: f64 = made.ways.iter().map(|way| way.seconds(&made.pace)).sum();
    if !made.ways.is_empty() {
        let length: f64 = made.ways.iter().map(|way| way.length).sum();
        rows.push(("Way", format!("{} {unit}", number(length))));
        rows.push((
            "In the air",
            format!("{} min", significant_digits(seconds / 60.0, 2)),
        ));
        if made.pace.battery.is_some() {
            rows.push(("Batteries", made.ways.len().to_string()));
        }
    }
    if let Some((sun, shadows)) = &made.sun {
        let [high, from] = [sun.elevation, sun.azimuth];
        rows.push(("Sun", format!("{high:.0}° high, from {from:.0}°")));
        rows.push(("In shadow", crate::exports::percent(shadows.area)));
    }
    pairs("numbers of the plan", rows, ui);
    if let Some(why) = &made.no_way {
        ui.colored_label(ui.visuals().error_fg_color, why);
    } else if let Some(why) = made.no_mission() {
        ui.weak(why);
    }
    if let Some(why) = &made.no_sun {
        ui.colored_label(ui.visuals().error_fg_color, why);
    }
    for warning in made.not_taken_in_words().iter().chain(&made.warnings) {
        ui.colored_label(ui.visuals().warn_fg_color, warning);
    }
}
