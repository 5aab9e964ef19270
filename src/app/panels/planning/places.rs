//! Places of the plan: clicked on the surface, typed, or in a file.

use egui::Ui;

use crate::command::{Answers, Command, Dialog};
use crate::formats::typed_places;
use crate::open_flight::OpenFlight;
use crate::panels::field::hinted_field;
use crate::plan::AskedPlan;
use crate::planning::{PlanStep, PlanTool, typed_corners};
use crate::typed::typed;

/// The button for a file of areas.
fn load(name: &str, tool: PlanTool, ui: &mut Ui, commands: &mut Vec<Command>) {
    let hover = "From GeoJSON, KML or KMZ, as QGIS and Google Earth save polygons, or a file with a corner a line. It can also be \
                 dropped on this page";
    if ui.button(name).on_hover_text(hover).clicked() {
        let dialog = Dialog::file("Areas of the plan").answering(Answers::Areas(tool));
        commands.push(Command::Browse(dialog));
    }
}

/// Area, ground to keep out of, take-off, photos by hand.
pub(super) fn places(
    open: &OpenFlight,
    asked: &mut AskedPlan,
    ui: &mut Ui,
    commands: &mut Vec<Command>,
) {
    let planning = &open.planning;
    let tool =
        |tool: PlanTool, text: &str, hover: &str, ui: &mut Ui, commands: &mut Vec<Command>| {
            let is_taken = planning.tool == tool;
            let button = ui.add(egui::Button::new(text).selected(is_taken));
            button.widget_info(|| {
                egui::WidgetInfo::selected(egui::Role::Button, true, is_taken, text)
            });
            if button.on_hover_text(hover).clicked() {
                commands.push(Command::Plan(PlanStep::Tool(tool)));
            }
        };
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        ui.label("Area:");
        let of_area = ui.label(match &asked.area {
            None => "the pile that was found".to_owned(),
            Some(corners) => format!("drawn, {} corners", corners.len()),
        });
        // A terrace behind a crest may be taken for one.
        let made = planning.made.as_ref().filter(|_| asked.area.is_none());
        if let Some(heights) = made.and_then(|made| made.pile_heights.as_deref()) {
            of_area.on_hover_text(format!("It lies {heights}"));
        }
        let hover = "Click the corners of what is to be photographed; its corners can be dragged";
        tool(PlanTool::Area, "Draw area", hover, ui, commands);
        load("Load area…", PlanTool::Area, ui, commands);
        let find = ui.add_enabled(asked.area.is_some(), egui::Button::new("Find the pile"));
        if find
            .on_hover_text("What stands out of the floor around it")
            .clicked()
        {
            asked.area = None;
        }
    });
    let width = ui.available_width().clamp(80.0, 320.0);
    let corners = asked.area.as_deref().map(typed_corners);
    let hover =
        "Its corners in the world, x,y;x,y;…, or a file: a corner a line, GeoJSON, KML or KMZ";
    let hint = "x,y;x,y;… or a file";
    let field = "Corners of the area";
    let before = corners.unwrap_or_default();
    if let Some(text) = hinted_field(ui, field, hover, &before, hint, width)
        && let Some(text) = typed(&text)
    {
        commands.push(Command::Plan(PlanStep::ReadAreas(
            PlanTool::Area,
            text.display().to_string(),
        )));
    }
    ui.horizontal_wrapped(|ui| {
        ui.label("Keep out:");
        ui.label(match asked.keep_out.len() {
            0 => "nothing".to_owned(),
            1 => "1 area".to_owned(),
            count => format!("{count} areas"),
        });
        let hover =
            "Click the corners of ground that is not flown over, at any height: misfires, people";
        tool(PlanTool::KeepOut, "Draw keep-out", hover, ui, commands);
        load("Load keep-out…", PlanTool::KeepOut, ui, commands);
        let has = !asked.keep_out.is_empty();
        let remove = ui.add_enabled(has, egui::Button::new("Remove last"));
        if remove
            .on_hover_text("The area that was drawn last")
            .clicked()
        {
            asked.keep_out.pop();
        }
    });
    let hover = "One area more: its corners in the world, x,y;x,y;…, or a file of one or several: GeoJSON, KML or KMZ";
    if let Some(text) = hinted_field(ui, "Corners to keep out of", hover, "", hint, width)
        && let Some(text) = typed(&text)
    {
        commands.push(Command::Plan(PlanStep::ReadAreas(
            PlanTool::KeepOut,
            text.display().to_string(),
        )));
    }
    ui.horizontal_wrapped(|ui| {
        ui.label("Take-off:");
        let place = asked.take_off.map(|place| typed_corners(&[place]));
        let hover = "Where the drone takes off and lands, in the world: x,y";
        let text = place.unwrap_or_default();
        if let Some(text) = hinted_field(ui, "Take-off", hover, &text, "not set: x,y", 170.0) {
            match typed_places(&text).as_deref() {
                Ok([place]) => asked.take_off = Some(*place),
                _ if text.trim().is_empty() => asked.take_off = None,
                _ => commands.push(Command::Report("take-off: give one place: x,y".to_owned())),
            }
        }
        let hover =
            "Click where the drone takes off and lands: heights of the mission count from there";
        tool(PlanTool::TakeOff, "Set take-off", hover, ui, commands);
    });
    ui.horizontal_wrapped(|ui| {
        ui.label("Photos:");
        let hover = "Click places for one photo more each; drag the selected photo over the ground; Delete leaves it out";
        tool(PlanTool::Add, "Add photos", hover, ui, commands);
        let changed = !asked.edits.is_empty();
        let anew = ui.add_enabled(changed, egui::Button::new("As planned"));
        if anew.on_hover_text("Take back what was changed by hand").clicked() {
            asked.edits.clear();
        }
    });
    if matches!(planning.tool, PlanTool::Area | PlanTool::KeepOut) {
        ui.weak("Double click or Enter ends it; Backspace takes a corner back.");
    }
}
