//! The one function that changes the state: it applies a command.

use std::path::PathBuf;

use crate::command::{Asking, Command, ReviewStep, Tab};
use crate::flight::FlightSettings;
use crate::fragments::FragmentStep;
use crate::from_photos::Ended;
use crate::geometry::LevelBox;
use crate::open_flight::OpenFlight;
use crate::open_flight::picker::Purpose;
use crate::open_flight::survey::picked::PickedPoint;
use crate::scale::ScalePair;
use crate::size_distributions::Page;
use crate::state::bundled::sample_flight;
use crate::state::history::History;
use crate::state::leaving::{Leaving, Named};
use crate::state::{HeldBack, Severity, State};
use crate::tasks::Task;

/// So much of what was copied is shown.
const COPIED_SHOWN: usize = 60;

impl State {
    /// Does what a command says.
    pub fn apply(&mut self, command: Command) {
        self.kept_aside.touch();
        match command {
            Command::Drop(mut paths) if self.may_be_masks(&paths) => {
                if let Some(path) = paths.pop() {
                    self.fragment_step(FragmentStep::Masks { path, of: None });
                }
            }
            Command::Drop(paths) => {
                if self.drop_on_flight(&paths) {
                    return;
                }
                match self.may_be_distributions(&paths) {
                    true => self.read_dropped(paths),
                    false => self.apply(Command::DropFlight(paths)),
                }
            }
            Command::Open(path) => self.open_or_ask(vec![path]),
            Command::ReadAgain => {
                if let Some(open) = &self.open {
                    let paths = vec![open.files.path.clone()];
                    let named = Named::Again;
                    self.leave(Leaving::Read { paths, named });
                }
            }
            Command::DropFlight(paths) => self.open_or_ask(paths),
            Command::Add(path) => self.leave(Leaving::Read {
                paths: vec![path],
                named: Named::Added,
            }),
            Command::OpenAlone(path) => self.leave(Leaving::Read {
                paths: vec![path],
                named: Named::Alone,
            }),
            Command::OpenSample => self.leave(Leaving::Sample),
            Command::Kept(step) => self.kept_step(step),
            Command::Close => self.leave(Leaving::Close),
            Command::Quit => self.leave(Leaving::Quit),
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
            Command::Keep => {
                self.held_back = None;
                // What was to come behind the saving comes not.
                self.after_saving = None;
            }
            Command::Save => self.save(),
            Command::SaveAs(to) => self.save_as(to),
            Command::Export(to) => self.export(to),
            Command::Picture(request) => self.ask_picture(request),
            Command::AddLayer(path) => self.add_beside(path),
            Command::VolumeBase(path) => self.read_volume_base(path),
            Command::SaveMeasured(table, to) => self.save_measured(table, to),
            Command::FillGeoreference(form) => self.fill_georeference(form),
            Command::Georeference(request) => self.start_georeference(request),
            Command::SaveGeoreferenced { to, keep_surface } => {
                self.save_georeferenced(to, keep_surface);
            }
            Command::FromPhotos(step) => self.step_from_photos(step),
            Command::Season(step) => self.step_season(step),
            Command::Ask(Some(Asking::SaveAs)) => self.ask_where_to_save(),
            Command::Ask(asking) => self.ask(asking),
            Command::Browse(dialog) => self.browse(dialog),
            Command::Cancel(task) => {
                if task.can_be_cancelled && self.work.is_running(task) {
                    self.work.cancel(task);
                    self.say(Severity::Note, &format!("{}: cancelled", task.in_words));
                    self.take_back_settings();
                    if task == Task::SAVE {
                        self.after_saving = None;
                    }
                    if task == Task::PLAN {
                        self.plan_cancelled();
                    }
                    if task == Task::SEASON {
                        self.season_cancelled();
                    }
                    if task == Task::RECONSTRUCT {
                        self.from_photos.ended = Some(Ended::Cancelled);
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
            Command::ColorLimits(by, limits) => {
                if let Some(open) = &mut self.open {
                    open.colors.set(by, limits);
                }
            }
            Command::Theme(theme) => {
                self.preferences.theme = theme;
                self.apply_theme();
            }
            Command::Zoom(factor) => self.context.set_zoom_factor(factor.clamp(0.5, 3.0)),
            Command::Page(page) => {
                self.page = page;
                self.load_full_photo();
                self.begin_fragments();
            }
            Command::Map(command) => self.apply_to_map(command),
            Command::Plan(step) => self.plan_step(step),
            Command::Fragments(step) => self.fragment_step(step),
            Command::Distributions(command) => self.apply_to_distributions(command),
            Command::Tab(tab) => self.show_tab(tab),
            Command::ToggleLog => self.preferences.log_open ^= true,
            Command::ToggleLeft => self.preferences.left_open ^= true,
            Command::ToggleRight => self.preferences.right_open ^= true,
            Command::ToggleHealth => self.preferences.health_open ^= true,
            Command::DismissNotice => self.notice = None,
            Command::CopyScales => match self.scales_to_copy() {
                Some(text) => self.copy(text),
                None => {
                    let text = "no scales are copied: they are being computed, or there are none";
                    self.say(Severity::Note, text);
                }
            },
            Command::Copy(text) => self.copy(text),
            Command::Report(text) => self.say(Severity::Error, &text),
            Command::TakeAnswer => self.answered = None,
            Command::Undo if self.page == Page::SizeDistributions => {
                self.undo_distributions(History::undo);
            }
            Command::Redo if self.page == Page::SizeDistributions => {
                self.undo_distributions(History::redo);
            }
            Command::Undo if self.page == Page::Plan => self.undo_plan(History::undo),
            Command::Redo if self.page == Page::Plan => self.undo_plan(History::redo),
            Command::Undo if self.page == Page::Fragments => self.undo_fragments(false),
            Command::Redo if self.page == Page::Fragments => self.undo_fragments(true),
            Command::Undo => {
                // What was wrong with the step that is taken back is no matter any more; the log keeps it.
                self.notice = None;
                let changed =
                    self.undo_picks_or_settings(History::undo, History::undo, History::undo);
                // Else the last word at the foot of the window may be "saved".
                self.say_undone(&with_what("undone", &changed));
            }
            Command::Redo => {
                let changed =
                    self.undo_picks_or_settings(History::redo, History::redo, History::redo);
                self.say_undone(&with_what("done again", &changed));
            }
            Command::Set(after) => {
                // Made of those of the frame's beginning, which another command may have changed since.
                let settings = match (&self.settings_of_frame, &self.open) {
                    (Some(before), Some(open)) => open.settings().with_changes(before, after),
                    _ => after,
                };
                self.set_settings(settings);
            }
            Command::ExportRectified(on) => self.preferences.export_rectified = on,
            Command::Choose(photo, along) => self.choose(photo, along),
            Command::ChooseAll(choice) => self.choose_all(choice),
            Command::Decide(photo, decision) => self.decide(photo, decision),
            Command::Review(step) => self.review_step(step),
            Command::ToggleTint => self.toggle_tint(),
            Command::Control(step) => self.control_step(step),
            Command::Trace(step) => self.trace(step),
            Command::ToggleLoupe => self.toggle_loupe(),
            Command::GoToCorner(name) => {
                if let Some(open) = &mut self.open {
                    open.go_to_corner(name);
                }
            }
            Command::Photo(command) => self.apply_to_photo(command),
            Command::View(change) if self.is_growing_seen() => {
                if let Some(growing) = &mut self.from_photos.growing {
                    growing.change_view(change);
                }
            }
            Command::View(change) if self.opening_preview().is_some() => {
                if let Some(preview) = &mut self.preview {
                    preview.change_view(change);
                }
            }
            Command::Select(photo) => self.select(|open| open.select(photo)),
            Command::SelectBy(rows) => self.select(|open| open.select_by(rows)),
            Command::Click(ray) if self.page == Page::Plan => {
                if let Some(open) = &mut self.open {
                    open.pick(Purpose::Plan, ray);
                }
            }
            Command::DoubleClick(ray) if self.is_drawing_on_plan() => {
                if let Some(open) = &mut self.open {
                    open.pick(Purpose::EndArea, ray);
                }
            }
            Command::Click(_)
            | Command::Hover(..)
            | Command::DoubleClick(_)
            | Command::HoverPhoto(_)
            | Command::Sort(_)
            | Command::Filter(_)
            | Command::FilterVerdict(_)
            | Command::FilterDoubtful(_)
            | Command::View(_)
            | Command::ToggleMeasure
            | Command::MeasureAnew
            | Command::Survey(_)
            | Command::Beside(_)
            | Command::Clip(_)
            | Command::Pick(_) => {
                if let Some(open) = &mut self.open {
                    open.apply(command);
                }
            }
        }
        if let Some(open) = &mut self.open {
            open.looking.orbit.orthographic = self.preferences.layers.orthographic;
            open.look_at_control();
        }
        self.look_at_notice();
        self.look_at_values();
        self.upload_beside();
    }

    /// Whether something would be lost if the program ended now.
    pub(crate) fn asks_before_quitting(&self) -> bool {
        self.is_changed()
            || self.work.is_writing()
            || self.has_lost_points()
            || self.distributions.has_unsaved()
            || self.has_notes_to_take()
    }

    fn has_lost_points(&self) -> bool {
        let open = self.open.as_ref();
        open.is_some_and(|open| open.pointer.picked.is_lost())
    }

    /// Leaves the flight on the screen, unless something would be lost: then asks first.
    pub(crate) fn leave(&mut self, leaving: Leaving) {
        self.take_notes();
        let writes = matches!(leaving, Leaving::Quit) && self.work.is_writing();
        let is_lost = match &self.open {
            // What was added stays.
            Some(open) if leaving.comes_back() => open.is_changed() && open.is_edited(),
            _ => leaving.ends_flight() && self.is_changed(),
        };
        if is_lost || writes {
            self.held_back = Some(HeldBack::Leave(leaving));
        } else {
            self.go_on(HeldBack::Leave(leaving));
        }
    }

    fn go(&mut self, leaving: Leaving) {
        // What she has begun while a flight was read goes on.
        if !matches!(leaving, Leaving::Take(_)) {
            self.asking = None;
            self.after_saving = None;
        }
        // Read again, a flight is looked at as before.
        let is_again = |paths: &[PathBuf]| {
            let open = self.open.as_ref();
            open.is_some_and(|open| *paths == [open.files.path.clone()])
        };
        match &leaving {
            Leaving::Read { paths, .. } if is_again(paths) => {}
            Leaving::Read { .. } | Leaving::Sample => self.page = Page::Pile,
            Leaving::Take(_) | Leaving::Close | Leaving::Quit => {}
        }
        match leaving {
            Leaving::Read { paths, named } => self.start_opening(paths, named),
            Leaving::Sample => match sample_flight() {
                Some(path) => self.start_opening(vec![path], Named::ToOpen),
                None => self.say(
                    Severity::Error,
                    "the bundled flight is not beside the program; make one with 'fragscale sample DIR'",
                ),
            },
            Leaving::Take(arrived) => self.take_arrived(*arrived),
            Leaving::Close => {
                self.work.cancel(Task::OPEN);
                self.arrived = None;
                self.work.cancel_for_flight();
                if let Some(open) = self.open.take() {
                    open.let_go();
                }
                self.notice = None;
                self.tried = None;
            }
            Leaving::Quit => self.quit(),
        }
    }

    /// Goes on with what was held back.
    pub(crate) fn go_on(&mut self, held_back: HeldBack) {
        match held_back {
            HeldBack::Leave(leaving) if self.has_lost_points() && leaving.ends_flight() => {
                self.held_back = Some(HeldBack::Points(leaving));
            }
            HeldBack::Leave(Leaving::Quit) | HeldBack::Points(Leaving::Quit)
                if self.distributions.has_unsaved() =>
            {
                self.held_back = Some(HeldBack::Tables);
            }
            HeldBack::Leave(leaving) | HeldBack::Points(leaving) => self.go(leaving),
            HeldBack::Tables => self.go(Leaving::Quit),
            HeldBack::Replace { command, .. } => self.apply(*command),
        }
    }

    fn select(&mut self, select: impl FnOnce(&mut OpenFlight)) {
        if let Some(open) = &mut self.open {
            let before = open.selected;
            select(open);
            if open.selected != before {
                self.take_note(before);
                let reviews = self.reviewed_flight().is_some();
                if let Some(open) = self.open.as_mut().filter(|_| reviews) {
                    open.show_reason();
                }
                self.load_preview();
                self.begin_fragments();
            }
        }
    }

    fn show_tab(&mut self, tab: Tab) {
        match tab {
            Tab::Review => self.review_step(ReviewStep::Next),
            _ => {
                self.tab = tab;
                self.load_tint();
            }
        }
    }

    fn quit(&mut self) {
        self.work.cancel_all();
        self.may_quit = true;
        self.context.send_viewport_cmd(egui::ViewportCommand::Close);
    }

    pub(crate) fn ask(&mut self, asking: Option<Asking>) {
        let needs_flight = matches!(
            asking,
            Some(
                Asking::Export
                    | Asking::SaveAs
                    | Asking::Picture
                    | Asking::Map
                    | Asking::SaveMeasured(_)
                    | Asking::VolumeBase
                    | Asking::CloudUse
                    | Asking::AddLayer
                    | Asking::Masks
                    | Asking::Network
                    | Asking::ExportFragments
                    | Asking::ControlList
            )
        );
        if needs_flight && self.open.is_none() {
            return;
        }
        if asking == Some(Asking::Network) {
            self.network.refused = None;
        }
        if let (Some(Asking::Masks), Some(open)) = (asking, &mut self.open) {
            open.fragments.masks_refused = None;
        }
        let georeferences = matches!(
            asking,
            Some(Asking::Georeference | Asking::SaveGeoreferenced)
        );
        let of_reconstruction = |open: &OpenFlight| open.files.reconstruction.is_some();
        if georeferences && !self.open.as_deref().is_some_and(of_reconstruction) {
            return;
        }
        if asking == Some(Asking::Add) && self.open.is_none() && self.tried.is_none() {
            return;
        }
        self.answered = None;
        if self.asking == Some(Asking::Add) && asking.is_none() && self.open.is_some() {
            // Who does not name what the flight lacks that could not be opened goes on with the one on the screen.
            self.tried = None;
        }
        self.asking = asking;
        if asking != Some(Asking::SaveAs) {
            // Who does not say where to save does not want to go on either.
            self.after_saving = None;
        }
    }

    /// Sets the flight's settings, as a step that can be undone.
    pub(crate) fn set_settings(&mut self, settings: FlightSettings) {
        self.edit_settings(|history| {
            history.set(settings);
        });
    }

    /// While points are picked, undo is theirs as far as it goes; then the clipping box's, while its window is
    /// shown.
    fn undo_picks_or_settings(
        &mut self,
        picks: impl FnOnce(&mut History<Vec<PickedPoint>>) -> bool,
        limits: impl FnOnce(&mut History<LevelBox>) -> bool,
        settings: impl FnOnce(&mut History<FlightSettings>) -> bool,
    ) -> Vec<&'static str> {
        let picked = self.open.as_mut().map(|open| &mut open.pointer.picked);
        let undone = picked
            .filter(|picked| picked.is_on)
            .is_some_and(|picked| picks(&mut picked.history));
        if undone {
            return vec!["picked points"];
        }
        let open = self.open.as_mut();
        if open.is_some_and(|open| open.undo_clip(limits)) {
            return vec!["the clipping box"];
        }
        let settings_now = |state: &Self| state.open.as_ref().map(|open| open.settings());
        let before = settings_now(self);
        self.undo_settings(settings);
        match (before, settings_now(self)) {
            (Some(before), Some(now)) => now.changed_since(&before),
            _ => Vec::new(),
        }
    }

    fn undo_settings(&mut self, step: impl FnOnce(&mut History<FlightSettings>) -> bool) {
        let before = self.open.as_ref().map(|open| open.settings().decisions);
        self.edit_settings(|history| {
            step(history);
        });
        if let Some(before) = before.filter(|_| self.reviewed_flight().is_some()) {
            self.review_undone(&before);
        }
    }

    /// Whether another flight is being read, so that what is changed now would be lost with this one; and says it.
    pub(crate) fn changes_would_be_lost(&mut self) -> bool {
        let is_lost = self.is_opening() && self.reads_other;
        if is_lost {
            let text = "a flight is being opened; change this one when it is there, or cancel that";
            // Once, and not in each frame of a drag.
            if self.log.last().is_none_or(|last| last.text != text) {
                self.say(Severity::Note, text);
            }
        }
        is_lost
    }

    /// Undo, redo, and what they go over.
    fn edit_settings(&mut self, change: impl FnOnce(&mut History<FlightSettings>)) {
        // The reading of this one would stop the other's, too.
        if self.changes_would_be_lost() {
            return;
        }
        let Some(open) = &mut self.open else {
            return;
        };
        let before = open.settings();
        change(&mut open.history);
        open.take_decisions();
        let now = open.settings();
        let stated_changed = (now.pair, now.errors) != (before.pair, before.errors);
        let objects_changed = now.scale_objects != before.scale_objects;
        if !now.gives_the_scales_of(&before) {
            self.settings_changed();
        }
        if stated_changed {
            self.take_stated();
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
        let is_same_cloud = open.computed.surface.thinning == now.surface.thinning
            && open.computed.surface_up == now.surface_up
            && open.computed.placed == now.placed;
        if is_same_cloud {
            self.start_scales();
        } else {
            // Thinned points are gone from memory: the file has them.
            self.open_again(now);
        }
    }

    /// What "copy scales" copies: the selected photo's top and bottom scale for Split-Desktop in the
    /// chosen unit.
    ///
    /// `None` while scales for the settings of now are being computed.
    pub fn scales_to_copy(&self) -> Option<String> {
        self.scales_of(self.open.as_ref()?.selected?)
    }

    /// The same of any photo.
    pub fn scales_of(&self, photo: usize) -> Option<String> {
        let open = self.open.as_ref()?;
        if !open.is_computed() {
            return None;
        }
        let photo = open.review.photo(photo)?;
        if photo.pair == ScalePair::Fitted && !open.review.has_lines() {
            return None;
        }
        photo.scale_to_type()?;
        let [top, bottom] = photo.pair(self.preferences.unit());
        let shown = |scale: Option<f64>| {
            scale.map_or_else(
                || "no scale".to_owned(),
                |scale| crate::numbers::significant_digits(scale, 6),
            )
        };
        Some(format!("{}\t{}", shown(top), shown(bottom)))
    }

    /// Copies, and says so: nothing else shows it.
    fn copy(&mut self, text: String) {
        let more = text.chars().nth(COPIED_SHOWN).map_or("", |_| "…");
        let shown: String = text.chars().take(COPIED_SHOWN).collect();
        self.say(Severity::Note, &format!("copied: {shown}{more}"));
        self.context.copy_text(text);
    }
}

/// "undone: the unit, the ground"; without what, where nobody can say.
fn with_what(done: &str, changed: &[&str]) -> String {
    match changed.is_empty() {
        true => done.to_owned(),
        false => format!("{done}: {}", changed.join(", ")),
    }
}
