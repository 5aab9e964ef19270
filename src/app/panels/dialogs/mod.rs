//! Small windows beside the work: where to open, save or export, keys, about. None of them blocks;
//! only the question before unsaved changes are lost does.

mod choose;
mod cloud_use;
mod control_list;
mod fragments;
mod from_photos;
mod georeference;
mod keys;
mod on_node;
mod planning;
mod residuals;
mod save_measured;
mod season;

use std::path::Path;

use crate::command::{Answers, Asking, Command, Dialog, MeasuredTable, PictureRequest};
use crate::map::MapCommand;
use crate::names;
use crate::open_flight::OpenFlight;
use crate::panels::accessible::keep_focus;
use crate::panels::path_field::{path_field, path_to_write, taken_path};
use crate::panels::reconstruct_offer;
use crate::panels::size_distributions::{
    add_distributions, add_effort, paste, save_figure, save_report, save_table,
};
use crate::state::leaving::Leaving;
use crate::state::{HeldBack, State};
use crate::typed::typed;
use crate::units::LengthUnit;
use choose::choose;
use cloud_use::cloud_use;
use control_list::control_list;
use fragments::{export_fragments, masks, network};
use from_photos::from_photos;
use georeference::{georeference, save_georeferenced};
use keys::keys;
use planning::{PlanFile, mission, plan_table};
use save_measured::{add_layer, save_measured, volume_base};

/// Draws the small window that is open, and the question before losing changes.
pub fn ask(state: &State, context: &egui::Context, commands: &mut Vec<Command>) {
    keep_focus(state.asking.is_some(), context);
    if let Some(asking) = state.asking {
        let title = match asking {
            Asking::Open => "Open a flight",
            Asking::Add => "Add surface or photos",
            Asking::Choose => "Which of them?",
            Asking::Export => "Export for Split-Desktop",
            Asking::FromPhotos => "New flight from photos",
            Asking::Season => "Season of blasts",
            Asking::Georeference => "Georeference",
            Asking::SaveGeoreferenced => "Save georeferenced flight",
            Asking::SaveAs => "Save flight",
            Asking::Picture => "Save picture",
            Asking::Map => "Export map",
            Asking::Mission => "Save mission",
            Asking::PlanTable => "Save table of the plan",
            Asking::PlanSheet => "Save page for the pilot",
            Asking::Flown => "Save comparison",
            Asking::AddDistributions => "Add size distributions",
            Asking::PasteTable => "Paste table",
            Asking::AddEffort => "Add times of steps",
            Asking::SaveFigure => "Save figure",
            Asking::SaveReport => "Save report",
            Asking::SaveTable => "Save table",
            Asking::ControlList => "Load control points",
            Asking::Masks => "Outlines of another tool",
            Asking::Network => "A network of yours",
            Asking::ExportFragments => "Export fragments",
            Asking::AddLayer => "Add cloud as layer",
            Asking::CloudUse => "What is this cloud?",
            Asking::VolumeBase => "Base of the volume",
            Asking::SaveMeasured(MeasuredTable::Points) => "Save points",
            Asking::SaveMeasured(MeasuredTable::Profile) => "Save profile",
            Asking::SaveMeasured(MeasuredTable::Volume) => "Save volume",
            Asking::Keys => "Keys and mouse",
            Asking::About => "About fragscale",
        };
        let mut stays = true;
        let had_list = egui::Popup::is_any_open(context);
        egui::Window::new(title)
            .open(&mut stays)
            .collapsible(false)
            .resizable(false)
            .pivot(egui::Align2::CENTER_CENTER)
            .default_pos(context.content_rect().center())
            .show(context, |ui| {
                let wide = matches!(asking, Asking::Georeference | Asking::FromPhotos);
                let width = match asking {
                    Asking::Season => season::WIDTH,
                    _ if wide => 540.0,
                    _ => 460.0,
                };
                ui.set_max_width(width.min(context.content_rect().width() - 40.0));
                match asking {
                    Asking::Open => open(state, ui, commands),
                    Asking::Add => add(state, ui, commands),
                    Asking::Choose => choose(state, ui, commands),
                    Asking::Export => export(state, ui, commands),
                    Asking::FromPhotos => from_photos(state, ui, commands),
                    Asking::Season => season::season(state, ui, commands),
                    Asking::Georeference => georeference(state, ui, commands),
                    Asking::SaveGeoreferenced => save_georeferenced(state, ui, commands),
                    Asking::SaveAs => save_as(state, ui, commands),
                    Asking::Picture => picture(state, ui, commands),
                    Asking::Map => map(state, ui, commands),
                    Asking::Mission => mission(state, ui, commands),
                    Asking::PlanTable => plan_table(PlanFile::Table, state, ui, commands),
                    Asking::PlanSheet => plan_table(PlanFile::Sheet, state, ui, commands),
                    Asking::Flown => plan_table(PlanFile::Flown, state, ui, commands),
                    Asking::AddDistributions => add_distributions(state, ui, commands),
                    Asking::PasteTable => paste(state, ui, commands),
                    Asking::AddEffort => add_effort(state, ui, commands),
                    Asking::SaveFigure => save_figure(state, ui, commands),
                    Asking::SaveReport => save_report(state, ui, commands),
                    Asking::SaveTable => save_table(state, ui, commands),
                    Asking::ControlList => control_list(state, ui, commands),
                    Asking::Masks => masks(state, ui, commands),
                    Asking::Network => network(state, ui, commands),
                    Asking::ExportFragments => export_fragments(state, ui, commands),
                    Asking::AddLayer => add_layer(state, ui, commands),
                    Asking::CloudUse => cloud_use(state, ui, commands),
                    Asking::VolumeBase => volume_base(state, ui, commands),
                    Asking::SaveMeasured(table) => save_measured(table, state, ui, commands),
                    Asking::Keys => keys(ui),
                    Asking::About => about(ui),
                }
            });
        // A list that is open is closed by it first.
        let escape = !had_list && context.input(|input| input.key_pressed(egui::Key::Escape));
        if !stays || escape {
            commands.push(Command::Ask(None));
        }
    }
    if state.held_back.is_some() {
        confirm(state, context, commands);
    }
}

fn confirm(state: &State, context: &egui::Context, commands: &mut Vec<Command>) {
    let modal = egui::Modal::new(egui::Id::unique("unsaved")).show(context, |ui| {
        ui.set_width(360.0);
        match &state.held_back {
            Some(HeldBack::Replace { command, there }) => {
                replace(command, there, ui, commands);
            }
            Some(HeldBack::Tables) => pasted_tables(ui, commands),
            Some(HeldBack::Points(_)) => picked_points(ui, commands),
            _ if state.is_changed() => match &state.open {
                Some(open) if open.files.origin.is_surface_in_no_flight() => {
                    plan_alone(ui, commands);
                }
                _ => unsaved(state, ui, commands),
            },
            _ => writing(ui, commands),
        }
    });
    if modal.should_close() {
        commands.push(Command::Keep);
    }
}

/// A plan over a cloud alone is kept by a flight's file of its own.
fn plan_alone(ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.heading("The flight plan is in no file");
    ui.label(
        "It was not written since it was changed: neither as a mission nor as a sheet or a table.",
    );
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if ui.button("Save it").clicked() {
            commands.push(Command::SaveFirst);
        }
        if ui.button("Discard the plan").clicked() {
            commands.push(Command::Discard);
        }
        if ui.button("Stay here").clicked() {
            commands.push(Command::Keep);
        }
    });
}

fn pasted_tables(ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.heading("Pasted tables are in no file");
    ui.label(
        "Size distributions that were pasted go with the window, unless they are saved as a table.",
    );
    let save = ("Save them as a table…", Asking::SaveTable);
    save_discard_or_stay(save, ui, commands);
}

fn picked_points(ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.heading("Picked points are in no file");
    ui.label("Points that were picked go with the flight on the screen, unless they are copied or saved as a table.");
    let save = (
        "Save them as a table…",
        Asking::SaveMeasured(MeasuredTable::Points),
    );
    save_discard_or_stay(save, ui, commands);
}

/// Whoever saves stays, and leaves once more then.
fn save_discard_or_stay(
    (save, asking): (&str, Asking),
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if ui.button(save).clicked() {
            commands.push(Command::Keep);
            commands.push(Command::Ask(Some(asking)));
        }
        if ui.button("Discard them").clicked() {
            commands.push(Command::Discard);
        }
        if ui.button("Stay here").clicked() {
            commands.push(Command::Keep);
        }
    });
}

fn unsaved(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.heading("Unsaved changes");
    if let Some(open) = &state.open {
        let body = egui::TextStyle::Body.resolve(ui.style());
        let name = &open.flight().parts().name;
        ui.label(format!(
            "The settings of {}, what was decided of its photos, its control points, its flight plan or the outlines of fragments have changed since they were saved.",
            names::fitted(ui, name, &body, 300.0)
        ));
        // She may have named it a while ago.
        if let Some(HeldBack::Leave(Leaving::Take(arrived))) = &state.held_back {
            let name = names::fitted(ui, arrived.name(), &body, 300.0);
            ui.label(format!("{name} was read, to be shown in its place."));
        }
    }
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if ui.button("Save them").clicked() {
            commands.push(Command::SaveFirst);
        }
        if ui.button("Discard changes").clicked() {
            commands.push(Command::Discard);
        }
        if ui.button("Stay here").clicked() {
            commands.push(Command::Keep);
        }
    });
}

fn writing(ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.heading("Still writing");
    ui.label("Files are being written. An export or a reconstruction that is stopped goes on where it was next time.");
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if ui.button("Stop and quit").clicked() {
            commands.push(Command::Discard);
        }
        if ui.button("Stay here").clicked() {
            commands.push(Command::Keep);
        }
    });
}

fn replace(command: &Command, question: &str, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let what = match command {
        Command::Export(_) => "export",
        _ => "file",
    };
    ui.heading(format!("Replace the {what}?"));
    ui.label(question);
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        // It stands where another question's button stood: the second half of a double click there is no answer here.
        let replaces = ui.button("Replace it");
        if replaces.clicked() && !replaces.double_clicked() && !replaces.triple_clicked() {
            commands.push(Command::Discard);
        }
        if ui.button(format!("Keep the {what}")).clicked() {
            commands.push(Command::Keep);
        }
    });
}

fn open(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    ui.label(
        "A flight.toml, a file or folder that a photogrammetry package wrote, or a folder of photos \
         with positions and angles in them:",
    );
    let browse = [
        (
            "Browse for a file…",
            Dialog::file("Open a flight").answering(Answers::Open),
        ),
        (
            "Browse for a folder…",
            Dialog::folder("Open a flight's folder").answering(Answers::Open),
        ),
    ];
    if let Some(path) = taken_path(state, ui, Path::new(""), &browse, "Open flight", commands) {
        commands.push(Command::Open(path));
    }
}

fn add(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let name = match (&state.tried, &state.open) {
        (Some((path, _)), _) => path.display().to_string(),
        (None, Some(open)) => open.flight().parts().name.clone(),
        (None, None) => return,
    };
    let body = egui::TextStyle::Body.resolve(ui.style());
    let name = names::fitted(ui, &name, &body, 400.0).into_owned();
    let is_cloud = state.tried.is_none()
        && state
            .open
            .as_ref()
            .is_some_and(|open| open.files.origin.is_surface_alone());
    ui.label(match is_cloud {
        true => format!(
            "For the cloud {name}: its cameras, as a flight.toml, what a photogrammetry package wrote, or a \
             folder of drone photos."
        ),
        false => format!(
            "For {name}: a cloud or mesh to be its surface, or the folder of its photos. It can also be \
             dropped on this window."
        ),
    });
    let browse = [
        (
            "Browse for a surface…",
            Dialog::file("Surface of the flight"),
        ),
        (
            "Browse for a folder of photos…",
            Dialog::folder("Folder of the flight's photos"),
        ),
    ];
    // What was typed for another flight, or one that is still to be opened, is not meant for this one.
    let field = ui.push_id(&name, |ui| {
        taken_path(state, ui, Path::new(""), &browse, "Add it", commands)
    });
    if let Some(path) = field.inner {
        commands.push(Command::Add(path));
    }
    if state.from_photos.offered.is_some() {
        ui.separator();
        ui.label("Without a cloud, where the photos overlap, one can be made from them:");
        reconstruct_offer(state, ui, commands);
    }
}

fn export(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    let unit = state.preferences.unit();
    let chosen = open.chosen_count();
    ui.label(format!(
        "{chosen} of {} photos go along; scales in pixels per {unit}. The folder gets scales.csv, \
         scales.html to print and type from, the undistorted photos, overlays, and footprints as \
         GeoJSON.",
        open.review.count()
    ));
    let start = open.files.proposed(Some("split-desktop"));
    let browse = [("Browse…", Dialog::folder("Export for Split-Desktop into"))];
    let (path, entered) = path_field(state, ui, &start, &browse, commands);
    let mut rectified = state.preferences.export_rectified;
    let check = ui.checkbox(&mut rectified, "Rectified photos, too");
    let hover = "Each photo seen squarely onto the plane through what it shows, with one scale for the whole \
                 image, a bar and a world file: for programs that know one scale";
    if check.on_hover_text(hover).changed() {
        commands.push(Command::ExportRectified(rectified));
    }
    ui.separator();
    let path = typed(&path).filter(|_| chosen > 0);
    let button = ui.add_enabled(path.is_some(), egui::Button::new("Export now"));
    let button = button.on_hover_text("An interrupted export goes on where it stopped");
    if let Some(path) = path
        && (button.clicked() || entered)
    {
        commands.push(Command::Export(path.into()));
    }
    if chosen == 0 {
        ui.weak("No photo goes along: tick the boxes in the table.");
    }
}

fn save_as(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    ui.label(
        "The flight's settings and where its files are; the files themselves stay as they are.",
    );
    let start = open.files.proposed(None);
    let browse = [("Browse…", Dialog::new_file("Save flight", "flight.toml"))];
    if let Some(path) = path_to_write(state, ui, &start, &browse, "Save flight", commands) {
        commands.push(Command::SaveAs(path.into()));
    }
}

fn picture(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    let id = ui.scope_id().with("picture options");
    let mut options: (u32, u32, bool, bool) = ui
        .data(|data| data.get_temp(id))
        .unwrap_or((1920, 1080, false, false));
    ui.horizontal(|ui| {
        ui.label("Size");
        for (side, name) in [(&mut options.0, "Width"), (&mut options.1, "Height")] {
            let field = egui::DragValue::new(side).range(16..=16384).suffix(" px");
            let field = ui.add(field);
            let label = format!("Picture {}", name.to_lowercase());
            field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::SpinButton, true, &label));
            field.on_hover_text(format!("{name} of the picture in pixels"));
        }
    });
    ui.horizontal(|ui| {
        ui.radio_value(&mut options.2, false, "White background");
        ui.radio_value(&mut options.2, true, "Transparent");
    });
    ui.horizontal(|ui| {
        ui.radio_value(&mut options.3, false, "What the viewport shows");
        ui.radio_value(&mut options.3, true, "The corner-ray figure");
    });
    ui.data_mut(|data| data.insert_temp(id, options));
    let start = open.files.proposed(Some("figure.png"));
    let browse = [("Browse…", Dialog::new_file("Save picture", "figure.png"))];
    if let Some(path) = path_to_write(state, ui, &start, &browse, "Write picture", commands) {
        commands.push(Command::Picture(PictureRequest {
            to: path.into(),
            size: [options.0, options.1],
            transparent: options.2,
            corner_rays: options.3,
        }));
    }
}

fn map(state: &State, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let Some(open) = &state.open else {
        return;
    };
    let unit = state.preferences.unit();
    ui.label(format!(
        "A name that ends in .tif is written as GeoTIFF for map programs; .svg, .pdf and .png are a page of A4 \
         with grid, legend and a scale bar in {unit}."
    ));
    if open.files.crs.is_none() {
        ui.weak("No coordinate system is stated: the file is in the flight's own frame.");
    }
    let pixel = map_pixel(open, unit, ui);
    if open
        .pointer
        .drawn
        .as_ref()
        .is_some_and(|drawn| drawn.points.len() > 1)
    {
        ui.weak("The line or polygon that is measured goes along.");
    }
    let start = open.files.proposed(Some("map.pdf"));
    let browse = [("Browse…", Dialog::new_file("Export map", "map.pdf"))];
    if let Some(path) = path_to_write(state, ui, &start, &browse, "Write map", commands) {
        let to = path.into();
        commands.push(Command::Map(MapCommand::Save { to, pixel }));
    }
}

/// The side of a pixel of the map's ground, world units, typed in `unit`; `None` as on the screen.
fn map_pixel(open: &OpenFlight, unit: LengthUnit, ui: &mut egui::Ui) -> Option<f64> {
    let plan = &open.map.made.as_ref()?.plan;
    let (one, symbol) = match plan.unit_known {
        true => (unit.in_units_of(plan.unit), unit.symbol()),
        false => (1.0, plan.unit_of_lengths()),
    };
    let id = ui.scope_id().with("map pixel");
    let mut pixel: Option<f64> = ui.data(|data| data.get_temp(id)).flatten();
    let mut typed = pixel.unwrap_or(plan.raster.pixel) / one;
    let before = typed;
    ui.horizontal(|ui| {
        ui.label("Pixel size");
        let field = egui::DragValue::new(&mut typed)
            .speed(before * 0.01)
            .range(1e-6..=1e6)
            .max_decimals(6)
            .suffix(format!(" {symbol}"));
        let field = ui.add(field);
        field.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::SpinButton, true, "Pixel size of the map")
        });
        field.on_hover_text("The side of a pixel of the ground");
        if typed != before {
            pixel = Some(typed * one);
        }
        let [low, high] = plan.extent;
        let size = (high - low) / pixel.unwrap_or(plan.raster.pixel);
        ui.weak(format!("{:.0} x {:.0} pixels", size.x, size.y));
    });
    ui.data_mut(|data| data.insert_temp(id, pixel));
    pixel
}

fn about(ui: &mut egui::Ui) {
    ui.label(format!("fragscale {}", env!("CARGO_PKG_VERSION")));
    ui.label(
        "Image scales for blast fragmentation photos: the rays of the four image corners meet the \
         triangulated point cloud of the pile, and the distances between the corner points give \
         the scale.",
    );
    ui.add_space(6.0);
    ui.label("After Bamford, Esmaeili & Schoellig (2017), Point-Cloud-Based Aerial Fragmentation Analysis for Application in the Minerals Industry.");
    ui.add_space(6.0);
    ui.weak("MIT OR Apache-2.0");
}

/// A field for a path that counts while it is typed; `hint` is what counts while it is empty.
fn path_line(ui: &mut egui::Ui, text: &mut String, hint: &str, width: f32) -> egui::Response {
    let font = egui::TextStyle::Body.resolve(ui.style());
    let hint = names::fitted(ui, hint, &font, width - 10.0).into_owned();
    let edit = egui::TextEdit::singleline(text).hint_text(hint);
    ui.add(edit.desired_width(width))
}

/// What a screen reader says of a text field, and what the mouse finds out.
fn named_field(field: egui::Response, label: &str, hover: &str, text: &str) {
    field.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::TextInput, true, label);
        info.current_text_value = Some(text.to_owned());
        info
    });
    field.on_hover_text(hover);
}

/// The button beside a field that names a file or folder: whether the desktop's own dialog is asked for.
fn browse(ui: &mut egui::Ui, label: &str) -> bool {
    let browse = ui.button("Browse…");
    browse.widget_info(|| {
        let name = format!("Browse for the {}", label.to_lowercase());
        egui::WidgetInfo::labeled(egui::Role::Button, true, name)
    });
    let hover = "Choose in the desktop's own dialog";
    browse.on_hover_text(hover).clicked()
}
