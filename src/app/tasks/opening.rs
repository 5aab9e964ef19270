//! Opening a flight.

use std::path::PathBuf;

use super::stood::changed_in_words;
use super::work::Task;
use crate::command::Asking;
use crate::flight::FlightSettings;
use crate::jobs::Progress;
use crate::open_flight::OpenFlight;
use crate::open_flight::loading::{Loaded, NotOpened, is_cloud, load, named};
use crate::open_flight::picker::Picker;
use crate::open_flight::survey::surveyor::Surveyor;
use crate::opening::SurfaceSample;
use crate::opening_preview::OpeningPreview;
use crate::state::leaving::{Arrived, Leaving, Named};
use crate::state::{Severity, State};

impl Task {
    /// Reading a flight.
    pub const OPEN: Self = Self::new("Opening");
    /// Looking whether a file is a cloud, which can be several things to the flight on the screen.
    pub const LOOK: Self = Self::new("Looking at the file").of_flight();
}

impl State {
    /// Reads what was named and computes its scales. A surface alone is for the flight that could not
    /// be opened last, else for the one on the screen, unless it is to be looked at [`Named::Alone`]; photos
    /// alone are, too, if they are [`Named::Added`], else a flight of their own. [`Named::Again`] is the flight on the
    /// screen, with what was added to it, whatever `paths` says.
    pub fn start_opening(&mut self, paths: Vec<PathBuf>, how: Named) {
        let on_screen = self.open.as_ref();
        let on_screen = on_screen.map(|open| (open.files.path.clone(), open.files.options.clone()));
        let again = on_screen.clone().filter(|_| how == Named::Again);
        let seen = self.open.as_ref().filter(|_| how == Named::Again);
        let seen = seen.map(|open| open.first_number);
        let base = self.tried.clone().or(on_screen);
        let base = base.filter(|_| how != Named::Alone);
        let added = how == Named::Added;
        let beside = self.open.as_ref();
        let beside = beside.map(|open| (open.files.path.clone(), open.files.saved.clone()));
        let from = paths.clone();
        self.arrived = None;
        self.notice = None;
        self.from_photos.offered = None;
        self.reads_other = true;
        let (steps, gpu) = (self.work.steps_of_a_job(), self.gpu.clone());
        let work = move |progress: &Progress| {
            let on_sample = |sample: SurfaceSample, progress: &Progress| {
                let preview = OpeningPreview::new(gpu.as_ref(), sample);
                let of_job = progress.clone();
                let take = move |state: &mut Self| {
                    if !of_job.is_cancelled() {
                        state.preview = preview;
                    }
                };
                // Where nobody wants it any more, nobody misses it.
                let _ = steps.offer(take, progress);
            };
            again
                .map_or_else(|| named(&paths, base, added), Ok)
                .and_then(|(path, options)| load(path, options, None, Some(&on_sample), progress))
        };
        self.start(Task::OPEN, work, move |state, opened| {
            match (opened, seen) {
                (Ok(loaded), None) => {
                    state.arrived = Some(Box::new(Arrived {
                        loaded,
                        paths: from,
                        named: how,
                        beside,
                    }));
                }
                (opened, seen) => state.take_opened(opened, seen),
            }
        });
    }

    /// Puts a flight that was read in the place of the one on the screen; asks first where something would be lost. Only now: of
    /// a file that cannot be opened nobody is asked anything.
    pub(crate) fn look_at_arrived(&mut self) {
        // Another question is answered first.
        if self.held_back.is_some() {
            return;
        }
        if let Some(arrived) = self.arrived.take() {
            // Reading it has stopped the reading of the one on the screen with other settings.
            self.take_back_settings();
            self.leave(Leaving::Take(arrived));
        }
    }

    /// Takes a flight that was read; reads it again where it is the one on the screen, which was saved since.
    pub(crate) fn take_arrived(&mut self, arrived: Arrived) {
        let open = self.open.as_deref();
        match open.is_some_and(|open| arrived.is_of_old(open)) {
            true => self.start_opening(arrived.paths, arrived.named),
            false => self.take_flight(arrived.loaded, None),
        }
    }

    /// Opens what was named; a cloud alone can be several things to the flight on the screen, so it is asked
    /// which.
    pub(crate) fn open_or_ask(&mut self, paths: Vec<PathBuf>) {
        let read = |paths| Leaving::Read {
            paths,
            named: Named::ToOpen,
        };
        let is_flight = |open: &OpenFlight| !open.files.origin.is_surface_alone();
        let is_on_screen = self.open.as_deref().is_some_and(is_flight) && self.tried.is_none();
        let alone = match paths.as_slice() {
            [path] if is_on_screen && path.is_file() => path.clone(),
            _ => return self.leave(read(paths)),
        };
        // Its bytes say what it is.
        let work = move |progress: &Progress| {
            progress.stage("looking what it is");
            let is_cloud = is_cloud(&alone);
            (alone, is_cloud)
        };
        self.start(Task::LOOK, work, move |state, (path, is_cloud)| {
            if is_cloud {
                state.cloud = Some(path);
                state.ask(Some(Asking::CloudUse));
            } else {
                state.leave(read(vec![path]));
            }
        });
    }

    /// Reads the flight on the screen once more, with other settings.
    pub fn open_again(&mut self, settings: FlightSettings) {
        let Some(open_now) = &self.open else {
            return;
        };
        let (path, options) = (open_now.files.path.clone(), open_now.files.options.clone());
        let again = (open_now.number, settings);
        self.notice = None;
        self.reads_other = false;
        let work = move |progress: &Progress| load(path, options, Some(again), None, progress);
        self.start(Task::OPEN, work, |state, opened| {
            state.take_opened(opened, None);
        });
    }

    /// `seen` is the first number of the flight on the screen, where it is this one as its files were before.
    fn take_opened(&mut self, opened: Result<Loaded, Box<NotOpened>>, seen: Option<u64>) {
        match opened {
            Ok(loaded) => self.take_flight(loaded, seen),
            Err(not_opened) => {
                let NotOpened {
                    why,
                    asks,
                    choices,
                    photos,
                    tried,
                } = *not_opened;
                if !choices.is_empty() {
                    self.say(Severity::Note, &why);
                    self.choices = choices;
                    self.ask(Some(Asking::Choose));
                    return;
                }
                self.say(Severity::Error, &why);
                self.from_photos.offered = photos;
                // A wrong surface does not make forget the flight that it was for.
                self.tried = tried.or_else(|| self.tried.take());
                self.take_back_settings();
                if asks.is_some() {
                    self.ask(asks);
                }
            }
        }
    }

    fn take_flight(&mut self, loaded: Loaded, seen: Option<u64>) {
        let name = loaded.opened.flight.parts().name.clone();
        let [read, computed] = loaded.took;
        self.note_step("Opening the flight", &name, read);
        self.note_step("Computing scales", &name, computed);
        let mut as_seen = None;
        let again = match (loaded.again_for, self.open.take()) {
            // The same flight with other surface options: what the engineer did stays.
            (Some(number), Some(before)) if number == before.number => {
                // Scales of the flight before would come over those of this one, and a plan over its surface.
                for task in [Task::SCALES, Task::PLAN, Task::CONTROL] {
                    self.work.cancel(task);
                }
                Some(before)
            }
            // She has gone on to another flight meanwhile.
            (Some(_), other) => {
                self.open = other;
                return;
            }
            (None, Some(before)) if seen == Some(before.first_number) => {
                as_seen = Some(before);
                None
            }
            (None, before) => {
                if let Some(before) = before {
                    before.let_go();
                }
                None
            }
        };
        if again.is_none() {
            self.work.cancel_for_flight();
            self.begin_log_of_flight();
        }
        for warning in loaded.opened.all_warnings() {
            // Read again with other settings, a file can have something new to say.
            let known = again
                .as_ref()
                .is_some_and(|before| before.all_warnings().contains(&warning));
            if !known {
                self.say(Severity::Warning, &warning);
            }
        }
        self.opened += 1;
        self.tried = None;
        let read_with = loaded.opened.settings.clone();
        let limits = self.preferences.limits;
        let mut open = Box::new(OpenFlight::new(self.opened, loaded, &limits));
        // What was kept aside is there but once.
        if again.is_none() && open.files.kept.is_none() {
            self.preferences.remember(&open.files.path);
        }
        if let Some(before) = again {
            for gone in open.keep_from(before) {
                self.say(Severity::Warning, &gone);
            }
            open.take_stated();
            open.take_decisions();
        }
        if let Some(before) = as_seen {
            for gone in open.look_as(before) {
                self.say(Severity::Warning, &gone);
            }
        }
        self.open = Some(open);
        self.start_picker();
        self.start_views();
        self.start_fields();
        self.start_comparing();
        self.start_geometry();
        self.load_preview();
        self.load_full_photo();
        self.start_thumbnails();
        // The page may be shown already: what files have of its outlines is read.
        self.begin_fragments();
        let Some(open) = &self.open else {
            return;
        };
        if !open.settings().gives_the_scales_of(&read_with) {
            // Changed again while the file was read.
            self.settings_changed();
            return;
        }
        // How many have no scale is not known before their fields are: the tool bar counts them.
        let name = &open.flight().parts().name;
        let sentence = format!("{name}: {} photos", open.review.count());
        self.say(Severity::Note, &sentence);
    }

    pub(crate) fn start_picker(&mut self) {
        let Some(open) = &mut self.open else {
            return;
        };
        open.point_at_nothing();
        let surface = open.flight().parts().surface.clone();
        let picker = Picker::new(surface.clone(), self.context.clone());
        let surveyor = Surveyor::new(surface, self.context.clone());
        match picker.and_then(|picker| Ok((picker, surveyor?))) {
            Ok((picker, surveyor)) => {
                open.pointer.picker = Some(picker);
                open.pointer.surveyor = Some(surveyor);
                open.survey_anew();
            }
            Err(fault) => self.say(Severity::Error, &fault.to_string()),
        }
    }

    /// A first look at the surface that is being read, where there is one.
    pub fn opening_preview(&self) -> Option<&OpeningPreview> {
        self.preview.as_ref().filter(|_| self.is_opening())
    }

    /// Whether a flight is being read.
    pub fn is_opening(&self) -> bool {
        self.work.is_running(Task::OPEN)
    }
}

impl Task {
    /// Looking whether files were changed since they were read.
    pub const CHANGED: Self = Self::new("Files read").of_flight();
}

impl State {
    /// Looks whether the flight's files are what they were: she comes back from another program, which may have
    /// written its cloud anew. A file on a drive that sleeps must not hold the window up.
    pub(crate) fn look_at_files(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        if self.work.is_running(Task::CHANGED) {
            return;
        }
        let (read_as, number) = (open.files.read_as.clone(), open.number);
        let work = move |_: &Progress| read_as.all_changed();
        self.start(Task::CHANGED, work, move |state, changed| {
            for path in changed {
                let Some(open) = state.open.as_mut().filter(|open| open.number == number) else {
                    return;
                };
                if open.files.said_changed.insert(path.clone()) {
                    state.say(Severity::Warning, &changed_in_words(&path));
                }
            }
        });
    }
}
