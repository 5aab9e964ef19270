//! The one function that changes the state: it applies a command.

use std::path::PathBuf;

use crate::command::{Asking, Command};
use crate::exports::Replace;
use crate::files::{self, Kind};
use crate::open_flight::OpenFlight;
use crate::render::MOST_PIXELS;
use crate::size_distributions::Page;
use crate::state::{HeldBack, PictureRequest, Severity, State, sample_flight};
use crate::tasks::work::Task;

impl State {
    /// Does what a command says.
    pub fn apply(&mut self, command: Command) {
        match command {
            Command::Drop(paths) if self.may_be_distributions(&paths) => self.read_dropped(paths),
            Command::Drop(paths) => self.apply(Command::DropFlight(paths)),
            Command::Open(_)
            | Command::DropFlight(_)
            | Command::Add(_)
            | Command::OpenSample
            | Command::Close
            | Command::Quit => {
                self.leave(command);
            }
            Command::Discard => {
                if let Some(held_back) = self.held_back.take() {
                    self.go_on(held_back);
                }
            }
            Command::SaveFirst => {
                if let Some(held_back) = self.held_back.take() {
                    self.after_saving = Some(held_back);
                    self.save();
                }
            }
            Command::Keep => self.held_back = None,
            Command::Save => self.save(),
            Command::SaveAs(path) => self.save_as(path),
            Command::Export(folder) => self.export(folder),
            Command::Picture(request) => self.ask_picture(request),
            Command::FillGeoreference(form) => self.fill_georeference(form),
            Command::Georeference(request) => self.start_georeference(request),
            Command::SaveGeoreferenced { path, keep_surface } => {
                self.save_georeferenced(path, keep_surface);
            }
            Command::Ask(asking) => self.ask(asking),
            Command::Browse(what, folder) => self.browse(what, folder),
            Command::Cancel(task) => {
                if task.can_be_cancelled() && self.work.is_running(task) {
                    self.work.cancel(task);
                    self.say(Severity::Note, &format!("{}: cancelled", task.in_words()));
                    self.take_back_settings();
                    if task == Task::Save {
                        self.after_saving = None;
                    }
                }
            }
            Command::Unit(unit) => self.preferences.set_unit(unit),
            Command::Limits(limits) => {
                self.preferences.limits = limits;
                if let Some(open) = &mut self.open {
                    open.take_limits(&limits);
                }
            }
            Command::Layers(layers) => self.preferences.layers = layers,
            Command::Theme(theme) => {
                self.preferences.theme = theme;
                self.apply_theme();
            }
            Command::Zoom(factor) => self.context.set_zoom_factor(factor.clamp(0.5, 3.0)),
            Command::Page(page) => self.page = page,
            Command::Distributions(command) => self.apply_to_distributions(command),
            Command::Tab(tab) => self.tab = tab,
            Command::ToggleLog => self.preferences.log_open ^= true,
            Command::DismissNotice => self.notice = None,
            Command::CopyScales => {
                if let Some(text) = self.scales_to_copy() {
                    self.context.copy_text(text);
                }
            }
            Command::Copy(text) => self.context.copy_text(text),
            Command::Report(text) => self.say(Severity::Error, &text),
            Command::TakeAnswer => self.answered = None,
            Command::Undo | Command::Redo if self.page == Page::SizeDistributions => {
                self.undo_distributions(&command);
            }
            Command::Set(_) | Command::Undo | Command::Redo => self.edit_settings(&command),
            Command::Trace(step) => self.trace(step),
            Command::Select(_) | Command::SelectBy(_) => {
                if let Some(open) = &mut self.open {
                    let before = open.selected;
                    match command {
                        Command::Select(photo) => open.select(photo),
                        Command::SelectBy(rows) => open.select_by(rows),
                        _ => {}
                    }
                    if open.selected != before {
                        self.load_preview();
                    }
                }
            }
            Command::Click(_)
            | Command::Hover(_)
            | Command::DoubleClick(_)
            | Command::HoverPhoto(_)
            | Command::Choose(..)
            | Command::ChooseAll(_)
            | Command::Sort(_)
            | Command::Filter(_)
            | Command::FilterVerdict(_)
            | Command::Look(_)
            | Command::ToggleMeasure => {
                if let Some(open) = &mut self.open {
                    open.apply(command);
                }
            }
        }
        if let Some(open) = &mut self.open {
            open.looking.orbit.orthographic = self.preferences.layers.orthographic;
        }
    }

    /// Leaves the flight on the screen, unless something would be lost: then asks first.
    fn leave(&mut self, command: Command) {
        let quits = command == Command::Quit;
        if self.is_changed() || (quits && self.work.is_writing()) {
            self.held_back = Some(if quits {
                HeldBack::Quit
            } else {
                HeldBack::Leave(Box::new(command))
            });
        } else {
            self.go(command);
        }
    }

    fn go(&mut self, command: Command) {
        self.asking = None;
        self.after_saving = None;
        if command != Command::Quit && command != Command::Close {
            self.page = Page::Pile;
        }
        match command {
            Command::Open(path) => self.start_opening(vec![path], false),
            Command::DropFlight(paths) => self.start_opening(paths, false),
            Command::Add(path) => self.start_opening(vec![path], true),
            Command::OpenSample => match sample_flight() {
                Some(path) => self.start_opening(vec![path], false),
                None => self.say(
                    Severity::Error,
                    "the bundled flight is not beside the program; make one with 'fragscale sample DIR'",
                ),
            },
            Command::Close => {
                self.work.cancel(Task::Open);
                self.work.cancel_for_flight();
                if let Some(open) = self.open.take() {
                    open.let_go();
                }
                self.notice = None;
                self.tried = None;
            }
            Command::Quit => self.quit(),
            _ => {}
        }
    }

    /// Goes on with what was held back.
    pub(crate) fn go_on(&mut self, held_back: HeldBack) {
        match held_back {
            HeldBack::Quit => self.quit(),
            HeldBack::Leave(command) => self.go(*command),
            HeldBack::Replace(command, _) => match *command {
                Command::SaveAs(path) => self.start_saving(path, true),
                Command::Export(folder) => self.start_export(folder, Replace::OtherFlight),
                Command::Picture(request) => self.picture = Some((request, true)),
                Command::Distributions(command) => self.replace_distributions(command),
                Command::SaveGeoreferenced { path, keep_surface } => {
                    self.start_saving_georeferenced(path, keep_surface, true);
                }
                _ => {}
            },
        }
    }

    fn quit(&mut self) {
        self.work.cancel_all();
        self.may_quit = true;
        self.context.send_viewport_cmd(egui::ViewportCommand::Close);
    }

    fn ask(&mut self, asking: Option<Asking>) {
        let needs_flight = matches!(
            asking,
            Some(Asking::Export | Asking::SaveAs | Asking::Picture)
        );
        if needs_flight && self.open.is_none() {
            return;
        }
        let georeferences = matches!(
            asking,
            Some(Asking::Georeference | Asking::SaveGeoreferenced)
        );
        let of_reconstruction = |open: &OpenFlight| open.reconstruction.is_some();
        if georeferences && !self.open.as_deref().is_some_and(of_reconstruction) {
            return;
        }
        if asking == Some(Asking::Add) && self.open.is_none() && self.tried.is_none() {
            return;
        }
        self.answered = None;
        self.asking = asking;
        if asking != Some(Asking::SaveAs) {
            // Who does not say where to save does not want to go on either.
            self.after_saving = None;
        }
    }

    /// Undo, redo, and what they go over.
    pub(crate) fn edit_settings(&mut self, command: &Command) {
        if self.is_opening() && self.reads_other {
            // What is changed now would go with this flight, or its reading would stop the other's.
            let text = "another flight is being opened; change settings when it is there";
            self.say(Severity::Note, text);
            return;
        }
        let Some(open) = &mut self.open else {
            return;
        };
        let before = open.settings();
        match command {
            Command::Set(settings) => {
                let mut edit = open.history.now().clone();
                edit.settings = settings.clone();
                open.history.set(edit);
            }
            Command::Undo => {
                open.history.undo();
            }
            Command::Redo => {
                open.history.redo();
            }
            _ => {}
        }
        open.arrange();
        let now = open.settings();
        let objects_changed = now.scale_objects != before.scale_objects;
        if !now.gives_the_scales_of(&before) {
            self.settings_changed();
        }
        if objects_changed {
            self.start_comparing();
        }
    }

    /// Computes anew what depends on the settings.
    pub fn settings_changed(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let now = open.settings();
        if open.computed.surface.thinning == now.surface.thinning {
            self.start_scales();
        } else {
            // Thinned points are gone from memory: the file has them.
            self.open_again(now);
        }
    }

    /// What "copy scales" copies: the selected photo's top and bottom scale in the chosen unit.
    ///
    /// `None` while scales for the settings of now are being computed.
    pub fn scales_to_copy(&self) -> Option<String> {
        let open = self.open.as_ref()?;
        if !open.is_computed() {
            return None;
        }
        let photo = open.review.photo(open.selected?)?;
        photo.scale_to_type()?;
        let scale = photo.edges(self.preferences.unit());
        let shown = |scale: Option<f64>| {
            scale.map_or_else(
                || "no scale".to_owned(),
                |scale| crate::numbers::significant_digits(scale, 6),
            )
        };
        Some(format!("{}\t{}", shown(scale.top), shown(scale.bottom)))
    }

    /// Writes flight.toml where it was read, or asks where to.
    fn save(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        match open.origin.flight_file() {
            // The bundled flight stays as it came.
            Some(path) if !open.bundled => {
                let path = path.to_owned();
                self.save_as(path);
            }
            _ => self.ask(Some(Asking::SaveAs)),
        }
    }

    fn save_as(&mut self, path: PathBuf) {
        self.asking = None;
        if self.open.is_none() || self.is_busy(Task::Save) {
            return;
        }
        let own = self.open.as_ref().filter(|open| !open.bundled);
        let own = own.and_then(|open| open.origin.flight_file());
        if own.is_some_and(|own| files::is_same_file(own, &path)) {
            self.start_saving(path, true);
            return;
        }
        let (read, command) = (self.read_beside(&path), Command::SaveAs(path.clone()));
        if self.may_write(&path, Kind::Flight, &read, command) {
            self.start_saving(path, false);
        } else if self.held_back.is_none() {
            // Not saved, and nothing to answer.
            self.after_saving = None;
        }
    }

    fn export(&mut self, folder: PathBuf) {
        self.asking = None;
        if !self.is_busy(Task::Export) && self.may_export(&folder) {
            self.start_export(folder, Replace::Nothing);
        }
    }

    fn ask_picture(&mut self, request: PictureRequest) {
        self.asking = None;
        let [width, height] = request.size.map(u64::from);
        if self.open.is_none() || self.is_busy(Task::Picture) {
            return;
        }
        if width * height > MOST_PIXELS {
            let most = MOST_PIXELS / 1_000_000;
            let text = format!(
                "a picture of {width} x {height} pixels is too large; choose at most {most} million pixels"
            );
            self.say(Severity::Error, &text);
            return;
        }
        let (read, command) = (self.read(), Command::Picture(request.clone()));
        if self.may_write(&request.path, Kind::Result, &read, command) {
            self.picture = Some((request, false));
        }
    }

    /// Whether a task of this kind still writes; then says so.
    pub(crate) fn is_busy(&mut self, task: Task) -> bool {
        let busy = self.work.is_running(task);
        if busy {
            let text = format!(
                "{}: the one before is still under way; wait for it",
                task.in_words()
            );
            self.say(Severity::Error, &text);
        }
        busy
    }
}
