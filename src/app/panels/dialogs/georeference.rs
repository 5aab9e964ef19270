//! The small window that brings a reconstruction to the world: what is known of its place, how well
//! that fits, and where the flight that is made of it goes.

use super::residuals::residuals;
use super::{browse, named_field};
use crate::actions;
use crate::command::{Answers, Asking, Command, Dialog};
use crate::numbers::significant_digits;
use crate::open_flight::georeferencing::{GeoreferenceForm, KnownFrom, PathField};
use crate::open_flight::{Measure, OpenFlight};
use crate::opening::{GeoreferenceRequest, Georeferenced, KnownDistance, KnownEnds};
use crate::panels::Scrolled;
use crate::panels::path_field::{in_a_folder, path_field};
use crate::panels::working::working;
use crate::state::State;
use crate::tasks::Task;
use crate::typed::typed;

/// Draws the window's contents.
pub(super) fn georeference(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    let Some(reconstruction) = &open.files.reconstruction else {
        return;
    };
    let path = reconstruction.path.display();
    if let Some(said) = &reconstruction.in_world {
        let said: String = said.chars().take(80).collect();
        ui.label(format!("{path} is in the world already: {said}."));
        if open.files.origin.flight_file().is_some() {
            let button = ui.button("Open the reconstruction");
            let hover = "Without this flight.toml, in its own frame: there it can be placed anew";
            if button.on_hover_text(hover).clicked() {
                commands.push(Command::OpenAlone(reconstruction.path.clone()));
            }
        }
        return;
    }
    let most = (ui.ctx().content_rect().height() - 90.0).max(200.0);
    egui::ScrollArea::vertical()
        .max_height(most)
        .min_scrolled_height(most)
        .show_focused(ui, |ui| {
            ui.label(format!(
                "{path} is in a frame of its own. What is known of its place in the world?"
            ));
            ui.add_space(4.0);
            let mut form = open.georeferencing.form.clone();
            fields(state, open, &mut form, ui, commands);
            if form != open.georeferencing.form {
                commands.push(Command::FillGeoreference(form.clone()));
            }
            ui.separator();
            let is_fitted = open.georeferencing.fitted().is_some();
            fit(state, &form, is_fitted, ui, commands);
            match &open.georeferencing.outcome {
                None => {}
                Some((_, Err(error))) => {
                    ui.colored_label(ui.visuals().error_fg_color, error);
                }
                Some((_, Ok(fitted))) => {
                    ui.separator();
                    result(fitted, ui, commands);
                }
            }
        });
}

/// The source that is chosen, with its fields.
fn fields(
    state: &State,
    open: &OpenFlight,
    form: &mut GeoreferenceForm,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.horizontal_wrapped(|ui| {
        for (from, name, hover) in [
            (
                KnownFrom::Photos,
                "Positions in the photos",
                "What the drone's receiver wrote into the photos' own files",
            ),
            (
                KnownFrom::Positions,
                "List of positions",
                "A file with the position of each photo: CSV, OpenDroneMap's geo.txt, DJI's .MRK",
            ),
            (
                KnownFrom::ControlPoints,
                "Control points",
                "Surveyed points with their marks in photos: OpenDroneMap's gcp_list.txt",
            ),
            (
                KnownFrom::Distances,
                "Known distance",
                "The scale alone, from lengths between points of the reconstruction",
            ),
        ] {
            ui.radio_value(&mut form.from, from, name)
                .on_hover_text(hover);
        }
    });
    let photos = (PathField::Photos, "Folder of the photos");
    let points = (PathField::ControlPoints, "File of the control points");
    match form.from {
        KnownFrom::Photos => path_row(photos, form, ui, commands),
        KnownFrom::Positions => {
            let list = (PathField::Positions, "File of the positions");
            path_row(list, form, ui, commands);
        }
        KnownFrom::ControlPoints => {
            click_them(state, ui, commands);
            path_row(points, form, ui, commands);
            path_row(photos, form, ui, commands);
        }
        KnownFrom::Distances => {
            distances(open, form, ui);
            let named = |text: &str| {
                let distance: Option<KnownDistance> = text.parse().ok();
                distance.is_some_and(|known| matches!(known.ends, KnownEnds::Names(..)))
            };
            if form.distances.lines().any(named) {
                path_row(points, form, ui, commands);
            }
            ui.checkbox(&mut form.level, "Level by the ground")
                .on_hover_text(
                    "Turn the plane of the reconstruction's points level, cameras above",
                );
        }
    }
    if form.from != KnownFrom::Distances {
        ui.horizontal(|ui| {
            ui.label("Coordinate system");
            let hint = "EPSG:n; if empty that of the list, or the zone of UTM";
            let hover = "Of the world, and of a list that states none: EPSG:n, WKT or a PROJ text";
            let field = egui::TextEdit::singleline(&mut form.crs)
                .hint_text(hint)
                .desired_width(f32::INFINITY);
            named_field(ui.add(field), "Coordinate system", hover, &form.crs);
        });
    }
}

/// The way to marking them in the photos of the flight.
fn click_them(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let action = actions::file::CONTROL_POINTS;
    if let Some(command) = (action.command)(state) {
        let button = ui.button("Click them in the photos");
        if button.on_hover_text(action.hover).clicked() {
            commands.push(command);
        }
    }
}

/// A field for a file or folder, with the desktop's dialog.
fn path_row(
    (field, label): (PathField, &str),
    form: &mut GeoreferenceForm,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.label(label);
    ui.horizontal(|ui| {
        let text = form.path(field);
        let width = ui.available_width() - 80.0;
        let edit = ui.add(egui::TextEdit::singleline(text).desired_width(width));
        named_field(edit, label, "A path, typed or pasted", text);
        if browse(ui, label) {
            let dialog = match field {
                PathField::Photos => Dialog::folder("Folder of the flight's photos"),
                PathField::Positions | PathField::ControlPoints => {
                    Dialog::file("List of positions")
                }
            };
            let dialog = dialog.answering(Answers::Georeference(field));
            commands.push(Command::Browse(dialog));
        }
    });
}

/// Distances that are typed, or measured on the surface.
fn distances(open: &OpenFlight, form: &mut GeoreferenceForm, ui: &mut egui::Ui) {
    ui.label("Two points and their distance in metres, one distance a line");
    let field = egui::TextEdit::multiline(&mut form.distances)
        .hint_text("x1,y1,z1 x2,y2,z2 12.5")
        .desired_rows(2)
        .desired_width(f32::INFINITY);
    let hover = "In the reconstruction's frame, or the names of two control points";
    named_field(ui.add(field), "Known distances", hover, &form.distances);
    ui.horizontal(|ui| {
        ui.label("Measured on the surface");
        let field = egui::TextEdit::singleline(&mut form.length).desired_width(70.0);
        let hover = "How long the measured distance is in truth, in metres";
        named_field(ui.add(field), "Length in metres", hover, &form.length);
        ui.label("m");
        let points = match open.pointer.measure {
            Measure::Both(a, b) if open.is_in_own_frame() => Ok((a, b)),
            Measure::Both(..) => {
                Err("The surface on the screen is not in the reconstruction's frame")
            }
            _ => Err("First measure a distance on the surface (M)"),
        };
        // A decimal comma is what half of the world types.
        let length = form.length.trim().replace(',', ".");
        let ready = match points {
            Ok(points) if length.parse().is_ok_and(|metres: f64| metres > 0.0) => Ok(points),
            Ok(_) => Err("First type its length in metres"),
            Err(why) => Err(why),
        };
        let button = egui::Button::new("Take the measured points");
        let button = ui.add_enabled(ready.is_ok(), button);
        let button = button.on_hover_text("Add the two points of the distance tool above");
        let button = button.on_disabled_hover_text(ready.err().unwrap_or_default());
        if let Ok((a, b)) = ready
            && button.clicked()
        {
            if !form.distances.is_empty() && !form.distances.ends_with('\n') {
                form.distances.push('\n');
            }
            let point = |p: glam::DVec3| format!("{},{},{}", p.x, p.y, p.z);
            let line = format!("{} {} {length}", point(a), point(b));
            form.distances.push_str(&line);
            form.length.clear();
        }
    });
}

/// The buttons that fit and save, or how far the fit is.
fn fit(
    state: &State,
    form: &GeoreferenceForm,
    is_fitted: bool,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let running = |&(task, _): &(Task, _)| task == Task::GEOREFERENCE;
    if let Some((_, (sentence, _))) = state.work.running().find(running) {
        ui.horizontal(|ui| {
            working(ui);
            ui.label(sentence);
            let stop = ui.button("Stop fitting");
            if stop.on_hover_text("Give this fit up").clicked() {
                commands.push(Command::Cancel(Task::GEOREFERENCE));
            }
        });
        return;
    }
    let request = request(form);
    ui.horizontal(|ui| {
        let button = ui.add_enabled(request.is_ok(), egui::Button::new("Fit to what is known"));
        let button = button.on_hover_text("Find the way from the reconstruction to the world");
        match request {
            Ok(request) if button.clicked() => commands.push(Command::Georeference(request)),
            Ok(_) => {}
            Err(why) => {
                ui.weak(why);
            }
        }
        if is_fitted {
            let save = ui.button("Save and open…");
            let hover = "Write a flight.toml with the way to the world in it, and open it";
            if save.on_hover_text(hover).clicked() {
                commands.push(Command::Ask(Some(Asking::SaveGeoreferenced)));
            }
        }
    });
}

/// What the form asks for, or what is missing in it.
fn request(form: &GeoreferenceForm) -> Result<GeoreferenceRequest, String> {
    let crs = form.crs.trim();
    let mut request = GeoreferenceRequest {
        photos: typed(&form.photos),
        crs: (!crs.is_empty()).then(|| crs.to_owned()),
        ..GeoreferenceRequest::default()
    };
    match form.from {
        // A package may have kept the photos' positions itself, without any folder.
        KnownFrom::Photos => {}
        KnownFrom::Positions => {
            let list = typed(&form.positions).ok_or("name the file of the positions")?;
            request.positions = Some(list);
        }
        KnownFrom::ControlPoints => {
            let list = typed(&form.control_points).ok_or("name the file of the control points")?;
            request.control_points = Some(list);
        }
        KnownFrom::Distances => {
            let lines = form
                .distances
                .lines()
                .filter(|line| !line.trim().is_empty());
            let known: Result<Vec<KnownDistance>, String> = lines.map(str::parse).collect();
            request.distances = known?;
            if request.distances.is_empty() {
                return Err("type two points and their distance".to_owned());
            }
            let named = |known: &KnownDistance| matches!(known.ends, KnownEnds::Names(..));
            if request.distances.iter().any(named) {
                request.control_points = typed(&form.control_points);
            }
            request.level = form.level;
            request.crs = None;
        }
    }
    Ok(request)
}

/// What was found, and how well it fits.
fn result(fitted: &Georeferenced, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let unit = fitted.unit;
    let scale = significant_digits(fitted.similarity.scale, 7);
    ui.strong(format!(
        "Scale: {scale} {unit} to one of the reconstruction's units"
    ));
    ui.label(fitted.scale_error_in_words());
    if let Some(degrees) = fitted.rotation_error_degrees {
        ui.label(format!(
            "Least sure rotation: ± {degrees:.3} degrees (standard error)"
        ));
    }
    if let Some(used) = fitted.used_in_words("positions") {
        ui.label(used);
    }
    if let Some(errors) = fitted.errors_in_words() {
        ui.label(format!("Poses: {errors}"));
    }
    let crs = fitted.crs.as_deref().map_or_else(
        || "local, no coordinate system".to_owned(),
        |crs| crs.chars().take(60).collect(),
    );
    ui.label(format!("World: {crs}, in {unit}"));
    if let Some(heights) = &fitted.heights {
        ui.label(format!("Heights count from: {heights}"));
    }
    for warning in &fitted.warnings {
        ui.colored_label(ui.visuals().warn_fg_color, format!("⚠ {warning}"));
    }
    for length in &fitted.lengths {
        ui.label(format!(
            "{}: {:.4} m known, {:.4} m fitted",
            length.name, length.known, length.fitted
        ));
    }
    if !fitted.positions.is_empty() {
        ui.add_space(4.0);
        residuals(fitted, ui, commands);
    }
}

/// Draws the window that asks where the flight goes.
pub(super) fn save_georeferenced(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    ui.label(
        "A flight.toml with the way to the world; the reconstruction itself stays as it is. The new \
         flight is opened then.",
    );
    // A surface that states a coordinate system is in it; one that states none came with the
    // reconstruction, as far as anybody knows.
    let id = ui.scope_id().with(("surface", open.number));
    let kept: Option<bool> = ui.data(|data| data.get_temp(id));
    let mut keep_surface = kept.unwrap_or(open.files.crs.is_some());
    match open.files.origin.surface() {
        None => keep_surface = false,
        Some(surface) => {
            let name = surface.file_name().unwrap_or(surface.as_os_str()).display();
            ui.checkbox(&mut keep_surface, format!("Keep the surface {name}"))
                .on_hover_text("Only where it is in the world already: it is not moved");
        }
    }
    ui.data_mut(|data| data.insert_temp(id, keep_surface));
    let start = open.proposed_georeferenced();
    let browse = [("Browse…", Dialog::new_file("Save flight", "flight.toml"))];
    let (path, entered) = path_field(state, ui, &start, &browse, commands);
    ui.separator();
    let mut taken = None;
    ui.horizontal(|ui| {
        let path = typed(&path).filter(|_| open.georeferencing.fitted().is_some());
        let button = ui.add_enabled(path.is_some(), egui::Button::new("Save and open"));
        taken = path.filter(|_| button.clicked() || entered);
        if ui.button("Back to the fit").clicked() {
            commands.push(Command::Ask(Some(Asking::Georeference)));
        }
    });
    if let Some(path) = in_a_folder(ui, taken) {
        commands.push(Command::SaveGeoreferenced {
            to: path.into(),
            keep_surface,
        });
    }
}
