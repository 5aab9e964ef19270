//! The window: an engineer opens a flight, looks at the pile and the photos, learns which scales not
//! to trust and why, and takes the others along.
//!
//! ```text
//! panels/, viewport/  read the State, send Commands
//! actions             menu entry, shortcut and tooltip in one
//! apply               the one function that applies a Command
//! open_flight/        the flight on the screen, and what commands do to it alone
//! opening_preview     a sample of a large surface, while it is read
//! tasks/              long work as jobs; poll takes their results
//! state/              everything that panels read
//! linked/             the point under the mouse, in the pile and in the photos
//! photo_view/         the selected photo in the middle of the window
//! control_points/     points that are marked in photos, and what follows from them
//! map/                the page of the map
//! planning/           the page of the flight plan
//! fragments/          the page of the fragments
//! kept_aside/         changes that are not saved, kept where a crash leaves them
//! from_photos         what the small window for a new flight from photos holds
//! season/             what the small window of a season of blasts holds, and what it does
//! size_distributions/ the page of size distributions
//! ```
//!
//! So a test is a list of commands, undo is a list of states, and no frame does work that grows with
//! the flight.

pub mod actions;
pub mod apply;
mod clicks;
pub mod command;
pub mod control_points;
pub mod corner_loupe;
mod deciding;
mod fonts;
pub mod fragments;
pub mod frame_times;
pub mod from_photos;
pub mod kept_aside;
pub mod linked;
pub mod map;
mod names;
pub mod open_flight;
pub mod opening_preview;
pub mod panels;
pub mod photo_view;
pub mod planning;
pub mod poll;
mod reviewing;
pub mod season;
pub mod size_distributions;
pub mod state;
pub mod tasks;
mod typed;
pub mod viewport;
mod writing;

use fragscale_batch as batch;
use fragscale_core::{
    camera, control, fault, files, flight, geodesy, geometry, jobs, labels, numbers, picture, plan,
    scale, surface, survey, units,
};
use fragscale_delineation as delineation;
use fragscale_exports as exports;
use fragscale_formats as formats;
use fragscale_fragmentation as fragmentation;
use fragscale_node_odm as node_odm;
use fragscale_opening as opening;
use fragscale_reconstruct as reconstruct;
use fragscale_render as render;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

pub use command::Command;
pub use state::State;

use command::Asking;
use flight::Verdict;
use frame_times::{FrameTimes, Phase};
use kept_aside::KeptAside;
use open_flight::OpenFlight;
use panels::{Inspector, LastFocus, PhotoPanel, Scrolled};
use photo_view::Middle;
use size_distributions::{DistributionCommand, Page, PasteForm, ResultTab};
use state::Severity;
use state::leaving::Leaving;
use viewport::Viewport;

/// Under which name the system knows the program, and keeps its folder.
const APP_ID: &str = "fragscale";

/// Under which name eframe keeps the preferences.
const PREFERENCES: &str = "preferences";

/// A window of less has room for a pile between its panels only where they give way, points.
pub(crate) const NARROW: f32 = 1000.0;

/// A window of less has no room between both panels, points.
const BOTH: f32 = 560.0;

/// The window's contents.
pub struct App {
    state: State,
    viewport: Viewport,
    inspector: Inspector,
    photo_panel: PhotoPanel,
    /// The title that the window has.
    title: String,
    /// Whether the keys were the window's in the frame before.
    was_focused: bool,
    /// The commands of shortcuts that were pressed in a field, until what was typed there counts.
    from_field: Vec<Command>,
    /// That field, which is entered again behind them, and where keys went then.
    left_field: Option<(egui::Id, Keys)>,
    /// Where Tab goes on.
    last_focus: LastFocus<Keys>,
    times: FrameTimes,
}

impl App {
    /// The start page, or the flight that is named, which is opened at once.
    pub fn new(context: &eframe::CreationContext<'_>, paths: Vec<PathBuf>) -> Self {
        let preferences = context
            .storage
            .and_then(|storage| eframe::get_value(storage, PREFERENCES))
            .unwrap_or_default();
        for theme in [egui::Theme::Dark, egui::Theme::Light] {
            context.egui_ctx.style_mut_of(theme, more_contrast);
        }
        fonts::use_system_fonts(&context.egui_ctx);
        let mut state = State::new(context.egui_ctx.clone(), preferences);
        let viewport = Viewport::new(context.wgpu_render_state.as_ref());
        state.gpu = viewport.gpu().cloned();
        // Where the preferences are not kept nothing else is.
        if let Some(own) = context.storage.and_then(|_| eframe::storage_dir(APP_ID)) {
            state.kept_aside = KeptAside::in_folder(own.join("unsaved"), None);
        }
        let times = std::env::var_os("FRAGSCALE_FRAME_TIMES").map(PathBuf::from);
        let times = FrameTimes::into_file(times.as_deref()).unwrap_or_else(|error| {
            state.say(Severity::Error, &format!("no frame times: {error}"));
            FrameTimes::default()
        });
        if !paths.is_empty() {
            state.apply(Command::Drop(paths));
        }
        Self {
            state,
            viewport,
            inspector: Inspector::default(),
            photo_panel: PhotoPanel::default(),
            title: String::new(),
            was_focused: true,
            from_field: Vec::new(),
            left_field: None,
            last_focus: LastFocus::default(),
            times,
        }
    }

    /// What is shown.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Does something, as a panel would.
    pub fn apply(&mut self, command: Command) {
        self.state.apply(command);
    }

    /// Keeps changes that are not saved aside in this folder, at once, and offers what was left there.
    pub fn keep_aside_in(&mut self, root: PathBuf) {
        self.state.kept_aside = KeptAside::in_folder(root, Some(Duration::ZERO));
    }

    /// Takes what jobs have brought, without drawing.
    pub fn poll(&mut self) {
        self.state.poll();
    }

    /// A table that is pasted onto the page of size distributions, into no field: shown in its small
    /// window first, where its unit and method can be said.
    fn take_pasted_table(&mut self, context: &egui::Context) {
        let is_wanted = self.state.page == Page::SizeDistributions
            && self.state.held_back.is_none()
            && self.state.asking.is_none()
            && !context.egui_wants_keyboard_input();
        if !is_wanted {
            return;
        }
        // Taken away: the field that gets the keys now must not paste it once more.
        let mut pasted = None;
        context.input_mut(|input| {
            input.events.retain(|event| match event {
                egui::Event::Paste(text) => {
                    pasted = Some(text.clone());
                    false
                }
                _ => true,
            });
        });
        if let Some(table) = pasted {
            let form = PasteForm {
                table,
                refused: None,
                ..self.state.distributions.paste.clone()
            };
            let fill = DistributionCommand::FillPaste(form);
            self.state.apply(Command::Distributions(fill));
            self.state.apply(Command::Ask(Some(Asking::PasteTable)));
        }
    }

    /// What is typed beside the fields of a small window is for none of what lies behind it: there a letter is a tool, and Delete
    /// takes away.
    fn keep_keys_from_behind(&self, context: &egui::Context) {
        let asks = self.state.asking.is_some() || self.state.held_back.is_some();
        if !asks || actions::keys_are_taken(context) {
            return;
        }
        let of_focus = actions::keys_of_focus(context);
        context.input_mut(|input| {
            input.events.retain(|event| match event {
                egui::Event::Text(_) => false,
                egui::Event::Key { key, modifiers, .. } => {
                    modifiers.command
                        || matches!(key, egui::Key::Tab | egui::Key::Escape | egui::Key::F1)
                        || of_focus.contains(key)
                }
                _ => true,
            });
        });
    }

    fn hold_back_closing(&mut self, context: &egui::Context) {
        let closes = context.input(|input| input.viewport().close_requested());
        if closes && self.state.asks_before_quitting() && !self.state.may_quit {
            context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.state.leave(Leaving::Quit);
        }
    }
}

impl eframe::App for App {
    fn logic(&mut self, context: &egui::Context, _frame: &mut eframe::Frame) {
        self.times.begin();
        self.hold_back_closing(context);
        self.keep_keys_from_behind(context);
        self.last_focus.go_on(&keys_of(&self.state), context);
        let pressed = actions::pressed(&self.state, context);
        if !pressed.is_empty()
            && context.text_edit_focused()
            && let Some(field) = context.memory(|memory| memory.focused())
        {
            // The field is left, and says in this frame what was typed into it: that comes first.
            context.memory_mut(|memory| memory.surrender_focus(field));
            self.from_field = pressed;
            self.left_field = Some((field, keys_of(&self.state)));
        } else {
            for command in pressed {
                self.state.apply(command);
            }
        }
        let dropped = context.input(|input| input.raw.dropped_files.clone());
        if !dropped.is_empty() {
            let paths = dropped.iter().map(|file| file.path().to_owned());
            self.state.apply(Command::Drop(paths.collect()));
        }
        self.take_pasted_table(context);
        let is_focused = context.input(|input| input.focused);
        let was_focused = std::mem::replace(&mut self.was_focused, is_focused);
        if is_focused && !was_focused {
            self.state.look_at_files();
        }
        self.state.poll();
        self.viewport.take_picture(&mut self.state);
        let title = self.state.title();
        if title != self.title {
            context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
        self.times.end(Phase::Logic);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let mut commands = Vec::new();
        let (state, out) = (&self.state, &mut commands);
        egui::Panel::top("menu").show(ui, |ui| panels::menu_bar(state, ui, out));
        panels::kept_aside(state, ui, out);
        if state.open.is_some() || state.page == Page::SizeDistributions {
            egui::Panel::top("tools").show(ui, |ui| panels::tool_bar(state, ui, out));
        }
        if state.preferences.health_open && state.open.is_some() && state.page == Page::Pile {
            egui::Panel::top("health").show(ui, |ui| panels::health(state, ui, out));
        }
        egui::Panel::bottom("status").show(ui, |ui| panels::status_bar(state, ui, out));
        panels::spoken(state, ui);
        if state.preferences.log_open {
            egui::Panel::bottom("log")
                .resizable(true)
                .default_size(120.0)
                .show(ui, |ui| panels::log_panel(state, ui, out));
        }
        if state.page == Page::SizeDistributions {
            panels::size_distributions(state, ui, out);
        } else if state.open.is_some() {
            // However narrow the window is, a part of it is left for the viewport: a third of it at first.
            let width = ui.available_width();
            // A narrow window has panels of its own: a wide one gets its own back. In it they take less.
            let is_narrow = width < NARROW;
            let most = if is_narrow { 0.34 } else { 0.4 };
            let marks = |open: &OpenFlight| open.control.is_on && state.page == Page::Pile;
            let is_marking = state.open.as_deref().is_some_and(marks);
            // Each page has panels of its own: what fits one is no width for the others.
            let [left, right] = match state.page {
                Page::Plan => ["asked of the plan", "planned photos"],
                Page::Fragments => ["photos", "fragments"],
                _ if is_marking => ["control points", "inspector"],
                _ => ["photos", "inspector"],
            };
            // Where both leave nothing between them the left one waits until the right one is closed.
            let both_fit = width >= BOTH || !state.preferences.right_open;
            if state.preferences.left_open && both_fit {
                egui::Panel::left((left, is_narrow))
                    .resizable(true)
                    .default_size((width * 0.36).clamp(180.0, 500.0))
                    .min_size(180.0)
                    .max_size((width * most).max(180.0))
                    .show(ui, |ui| match state.page {
                        Page::Plan => panels::asked_of_plan(state, ui, out),
                        _ if is_marking => panels::control_points(state, ui, out),
                        _ => panels::photos_table(state, ui, out),
                    });
            }
            if state.preferences.right_open {
                self.inspector.crops = self.viewport.crops(state, ui);
                let inspector = &mut self.inspector;
                egui::Panel::right((right, is_narrow))
                    .resizable(true)
                    .default_size((width * 0.32).clamp(220.0, 330.0))
                    .min_size(220.0)
                    // Its pages' names are wider than its least size.
                    .max_size((width * most).max(256.0))
                    .show(ui, |ui| match state.page {
                        Page::Plan => panels::planned_photos(state, ui, out),
                        Page::Fragments => panels::fragments(state, ui, out),
                        _ => panels::right_panel(state, inspector, ui, out),
                    });
            }
            let photo_panel = &mut self.photo_panel;
            if state.middle == Middle::Both && state.page == Page::Pile {
                // Below each other where there is more height than width.
                let rest = ui.available_size();
                let (panel, length) = match rest.x >= rest.y {
                    true => (egui::Panel::right(("photo beside", is_narrow)), rest.x),
                    false => (egui::Panel::bottom(("photo below", is_narrow)), rest.y),
                };
                panel
                    .resizable(true)
                    .default_size(length * 0.5)
                    .min_size(160.0)
                    .max_size((length - 160.0).max(160.0))
                    .show(ui, |ui| photo_panel.show(state, ui, out));
            }
            let (viewport, times) = (&mut self.viewport, &mut self.times);
            egui::CentralPanel::no_frame().show(ui, |ui| {
                let place = ui.available_rect_before_wrap();
                if state.page == Page::Map {
                    panels::map(state, ui, out);
                } else if state.page == Page::Fragments && state.opening_preview().is_none() {
                    let fill = ui.visuals().panel_fill;
                    ui.painter().rect_filled(place, 0.0, fill);
                    panels::notice(state, ui, out);
                    photo_panel.show(state, ui, out);
                } else if let Some(preview) = state.opening_preview() {
                    viewport.show_preview(state, preview, ui, out, times);
                } else if state.middle.has_pile() || state.page == Page::Plan {
                    viewport.show(state, ui, out, times);
                    overlays(state, ui, place, out);
                    if state.page == Page::Pile {
                        panels::survey_panel(state, ui.ctx(), place, out);
                    }
                } else {
                    let fill = ui.visuals().panel_fill;
                    ui.painter().rect_filled(place, 0.0, fill);
                    panels::notice(state, ui, out);
                    photo_panel.show(state, ui, out);
                }
            });
        } else if let Some(preview) = state
            .opening_preview()
            .or(state.from_photos.growing.as_ref())
        {
            let (viewport, times) = (&mut self.viewport, &mut self.times);
            egui::CentralPanel::no_frame().show(ui, |ui| {
                viewport.show_preview(state, preview, ui, out, times);
            });
        } else {
            self.viewport.clear();
            egui::CentralPanel::default_margins().show(ui, |ui| {
                panels::notice(state, ui, out);
                panels::start_page(state, ui, out);
            });
        }
        panels::ask(state, ui.ctx(), out);
        drop_hint(state, ui.ctx());
        panels::focus_ring(ui.ctx());
        self.times.end(Phase::Panels);
        if !commands.is_empty() || !self.from_field.is_empty() {
            // What was typed into a field counts before the click that left it does, and before the shortcut.
            commands.sort_by_key(Command::comes_last);
            commands.append(&mut self.from_field);
            // The mouse moves in many a frame, and settings are copied where somebody sets any.
            let sets = commands
                .iter()
                .any(|command| matches!(command, Command::Set(_)));
            let open = self.state.open.as_ref().filter(|_| sets);
            self.state.settings_of_frame = open.map(|open| open.settings());
            for command in commands {
                self.state.apply(command);
                ui.ctx().request_repaint();
            }
            self.state.settings_of_frame = None;
        }
        // What is typed on is for the field, where that is still shown and nothing asks.
        if let Some((field, before)) = self.left_field.take()
            && keys_of(&self.state) == before
        {
            ui.ctx().memory_mut(|memory| memory.request_focus(field));
        }
        self.last_focus.take(keys_of(&self.state), ui.ctx());
        self.times.end(Phase::Commands);
    }

    fn on_exit(&mut self) {
        self.state.kept_aside.end();
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        eframe::set_value(storage, PREFERENCES, &self.state.preferences);
    }
}

/// Where keys go: to which page of which flight, and whether something is asked.
type Keys = (Page, Option<u64>, bool);

fn keys_of(state: &State) -> Keys {
    let flight = state.open.as_ref().map(|open| open.first_number);
    let asks = state.asking.is_some() || state.held_back.is_some();
    (state.page, flight, asks)
}

/// What lies over the viewport: layers, views, the slider of a look through a camera, the last error.
fn overlays(state: &State, ui: &mut egui::Ui, place: egui::Rect, commands: &mut Vec<Command>) {
    let mut inner = ui.new_child(
        egui::UiBuilder::new()
            .max_rect(place.shrink(8.0))
            .layout(egui::Layout::top_down(egui::Align::Min)),
    );
    let ui = &mut inner;
    panels::notice(state, ui, commands);
    egui::Frame::popup(ui.style()).show(ui, |ui| {
        ui.horizontal_wrapped(|ui| panels::view_buttons(state, ui, commands));
    });
    let through = state
        .open
        .as_ref()
        .is_some_and(|open| open.looking.through.is_some() && state.page == Page::Pile);
    if through {
        egui::Frame::popup(ui.style()).show(ui, |ui| panels::blend_slider(state, ui, commands));
    }
    egui::Frame::popup(ui.style()).show(ui, |ui| {
        ui.set_max_width(220.0);
        egui::CollapsingHeader::new("Layers")
            .default_open(false)
            .show(ui, |ui| {
                // On a small screen it is higher than the viewport.
                egui::ScrollArea::vertical()
                    .show_focused(ui, |ui| panels::layers_panel(state, ui, commands));
            });
    });
}

/// egui's own text is grey on grey; numbers that are typed off the screen need more contrast. Its orange is
/// not read on a light page, nor its red on a dark one: warnings and errors have the colours of the verdicts.
fn more_contrast(style: &mut egui::Style) {
    let visuals = &mut style.visuals;
    visuals.warn_fg_color = panels::verdict_color(Verdict::Check, visuals);
    visuals.error_fg_color = panels::verdict_color(Verdict::NoScale, visuals);
    if !visuals.dark_mode {
        // egui's light blue is 2.8 : 1 on a light page; this is over 6 : 1.
        visuals.hyperlink_color = egui::Color32::from_rgb(0, 86, 160);
    }
    let text = if visuals.dark_mode { 215 } else { 25 };
    visuals.widgets.noninteractive.fg_stroke.color = egui::Color32::from_gray(text);
    visuals.widgets.inactive.fg_stroke.color = egui::Color32::from_gray(text);
    visuals.weak_text_alpha = 0.72;
}

/// Says what happens when the file over the window is let go.
fn drop_hint(state: &State, context: &egui::Context) {
    let hovering = context.input(|input| !input.raw.hovered_files.is_empty());
    if hovering {
        let painter = context.layer_painter(egui::LayerId::new(
            egui::Order::Foreground,
            egui::Id::unique("drop"),
        ));
        let place = context.content_rect();
        painter.rect_filled(place, 0.0, egui::Color32::from_black_alpha(150));
        painter.text(
            place.center(),
            egui::Align2::CENTER_CENTER,
            match state.page {
                Page::Pile | Page::Map | Page::Plan | Page::Fragments => {
                    "Let go to open this flight"
                }
                Page::SizeDistributions if state.distributions.tab == ResultTab::Effort => {
                    "Let go to add these times of steps"
                }
                Page::SizeDistributions => "Let go to add these size distributions",
            },
            egui::FontId::proportional(26.0),
            egui::Color32::WHITE,
        );
    }
}

/// What to do where no window opens.
const WITHOUT_SCREEN: &str = "on a machine without a screen use 'fragscale scales', 'fragscale export' or 'fragscale render'";

/// Opens the window and runs until it is closed.
///
/// # Errors
/// Where no window can be opened.
pub fn run(paths: Vec<PathBuf>) -> Result<(), String> {
    let screen = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"];
    if cfg!(target_os = "linux") && screen.iter().all(|name| std::env::var_os(name).is_none()) {
        return Err(format!(
            "there is no screen (neither DISPLAY nor WAYLAND_DISPLAY is set); {WITHOUT_SCREEN}"
        ));
    }
    let mut setup = eframe::egui_wgpu::WgpuSetupCreateNew::without_display_handle();
    setup.device_descriptor = Arc::new(crate::render::device_descriptor);
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("fragscale")
            .with_app_id("fragscale")
            .with_icon(icon())
            .with_inner_size([1280.0, 720.0])
            .with_min_inner_size([640.0, 400.0])
            .with_drag_and_drop(true),
        wgpu_options: eframe::egui_wgpu::WgpuConfiguration {
            wgpu_setup: setup.into(),
            ..Default::default()
        },
        ..Default::default()
    };
    eframe::run_native(
        APP_ID,
        options,
        Box::new(|context| Ok(Box::new(App::new(context, paths)))),
    )
    .map_err(|error| format!("the window cannot be opened ({error}); {WITHOUT_SCREEN}"))
}

/// The program's sign: a footprint under a camera.
fn icon() -> egui::IconData {
    const SIDE: u32 = 64;
    let mut rgba = Vec::with_capacity((SIDE * SIDE * 4) as usize);
    for y in 0..SIDE {
        for x in 0..SIDE {
            let (u, v) = (f64::from(x) / 63.0, f64::from(y) / 63.0);
            // A pyramid from the top's middle to a trapezium at the foot.
            let spread = 0.05 + 0.42 * ((v - 0.12) / 0.8).clamp(0.0, 1.0);
            let inside = (u - 0.5).abs() <= spread && (0.12..=0.92).contains(&v);
            let pixel: [u8; 4] = if inside && v > 0.72 {
                [232, 146, 42, 255]
            } else if inside {
                [70, 120, 170, 255]
            } else {
                [0, 0, 0, 0]
            };
            rgba.extend(pixel);
        }
    }
    egui::IconData {
        rgba,
        width: SIDE,
        height: SIDE,
    }
}
