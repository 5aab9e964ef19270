//! Area and volume inside the polygon.

use super::{copy, numbers, save};
use crate::command::{Asking, Command, MeasuredTable};
use crate::exports::{VolumeReport, volume_table};
use crate::names;
use crate::numbers::significant_digits;
use crate::open_flight::OpenFlight;
use crate::open_flight::survey::{BaseChoice, Drawn, SurveyStep};
use crate::survey::{BaseFound, LEAST_BRIDGED};

pub(super) fn volume(
    open: &OpenFlight,
    drawn: &Drawn,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let parts = open.flight().parts();
    ui.horizontal_wrapped(|ui| {
        ui.label("Over");
        let is_rim = drawn.base == BaseChoice::Rim;
        let rim = ui.radio(is_rim, "its rim");
        let hover = "The plane that is nearest to the surface along the polygon's sides";
        if rim.on_hover_text(hover).clicked() {
            commands.push(Command::Survey(SurveyStep::Base(BaseChoice::Rim)));
        }
        let is_second = drawn.base == BaseChoice::Second;
        let level = ui.radio(!is_rim && !is_second, "a level");
        let mut height = match drawn.base {
            BaseChoice::Height(height) => height,
            BaseChoice::Rim | BaseChoice::Second => open.ground(),
        };
        let before = height;
        let field = egui::DragValue::new(&mut height)
            .speed(open.extent.bulk.size().z.max(1e-6) / 500.0)
            .max_decimals(3)
            .suffix(format!(" {}", parts.unit_of_lengths()));
        let field = ui.add(field);
        field.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::SpinButton, true, "Level of the base")
        });
        field.on_hover_text("The elevation of the base");
        let hover = "A level plane at this elevation; at first the flight's ground";
        if level.on_hover_text(hover).clicked() || height != before {
            commands.push(Command::Survey(SurveyStep::Base(BaseChoice::Height(
                height,
            ))));
        }
    });
    ui.horizontal(|ui| {
        let is_second = drawn.base == BaseChoice::Second;
        let has = open.pointer.second.is_some();
        let radio = ui.add_enabled(has, egui::RadioButton::new(is_second, "a second cloud"));
        let hover = "The surface of another cloud or mesh, such as the floor before: fill is what came, cut \
                     what went";
        if radio.on_hover_text(hover).clicked() {
            commands.push(Command::Survey(SurveyStep::Base(BaseChoice::Second)));
        }
        let choose = ui.button("Choose…");
        let hover = "Read a cloud or mesh; it is brought to the flight's coordinate system";
        if choose.on_hover_text(hover).clicked() {
            commands.push(Command::Ask(Some(Asking::VolumeBase)));
        }
        if let Some(second) = &open.pointer.second {
            let name = second.path.file_name().unwrap_or_default();
            names::name(ui, &name.to_string_lossy());
        }
    });
    let Some(volume) = drawn.volume() else {
        return;
    };
    let unit = open.measured_unit();
    let number = |number: f64, unit: &str| format!("{} {unit}", significant_digits(number, 5));
    let (cubic, square) = (unit.volume(), unit.area());
    if !drawn.finished {
        // All numbers would grow over the place of the next corner.
        ui.label(format!("So far {}", number(volume.net(), &cubic)));
        return;
    }
    let mut rows = vec![
        ("Fill (above)", number(volume.fill, &cubic)),
        ("Cut (below)", number(volume.cut, &cubic)),
        ("Fill less cut", number(volume.net(), &cubic)),
        ("Plan area", number(volume.plan_area, &square)),
        ("Surface area", number(volume.surface_area, &square)),
    ];
    let holes = 1.0 - volume.covered - volume.bodies;
    if holes > 1e-9 {
        let holes = significant_digits(100.0 * holes, 3);
        rows.push(("Not covered, not counted", format!("{holes} %")));
    }
    if volume.bridged > LEAST_BRIDGED {
        let bridged = format!("{:.1} %", 100.0 * volume.bridged);
        rows.push(("Without points, bridged", bridged));
    }
    if volume.bodies > 0.0 {
        let bodies = format!("{:.0} % of the plan", 100.0 * volume.bodies);
        rows.push(("Closed bodies, without the base", bodies));
    }
    if volume.doubtful > 0.0 {
        let doubtful = format!("{:.1} % of the plan", 100.0 * volume.doubtful);
        rows.push(("Faces over each other, counted twice", doubtful));
    }
    numbers("volume numbers", &rows, ui);
    let base = open.base_name(drawn);
    let report = VolumeReport {
        flight: &parts.name,
        unit,
        volume,
        base: base.as_deref(),
        other_heights: open.other_heights(drawn),
    };
    if let BaseFound::Rim(_) = volume.base {
        ui.add(
            egui::Label::new(
                egui::RichText::new(format!("Over {}.", report.base_in_words())).weak(),
            )
            .wrap(),
        );
    }
    let corners = drawn.points.iter();
    let corners = corners.map(|corner| format!("{},{}\n", corner.x, corner.y));
    let corners = format!("x,y\n{}", corners.collect::<String>());
    let text = format!("{}\n{corners}", volume_table(&report));
    ui.horizontal_wrapped(|ui| {
        let hover = "The numbers as text, with the polygon's corners";
        copy("Copy numbers", hover, Some(text), ui, commands);
        let hover = "The polygon's corners alone, as CSV with all digits";
        copy("Copy points", hover, Some(corners), ui, commands);
        save(MeasuredTable::Volume, ui, commands);
    });
}
