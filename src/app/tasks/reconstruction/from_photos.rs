//! A new flight from photos: looking what a folder holds, and reconstructing it.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::Duration;

use crate::command::{Asking, Command};
use crate::fault::Fault;
use crate::files::FileError;
use crate::formats::{FAILED, UNFINISHED};
use crate::from_photos::{
    Ended, FolderField, FoundPhotos, FromNode, FromPhotosForm, FromPhotosStep, NodeForm,
};
use crate::jobs::Progress;
use crate::node_odm::{Asked, Limits, NodeRequest, Token, reconstruct_on_node};
use crate::opening_preview::OpeningPreview;
use crate::reconstruct::{
    Card, Embedded, EngineName, OnGrowth, PhotoSet, Quality, Reconstructed, Request, about,
    left_out, may_be_made, proposed_folder, reconstruct, summary,
};
use crate::state::{Severity, State};
use crate::tasks::work::Task;
use crate::typed::typed;

impl Task {
    /// Reading the headers of a folder of photos.
    pub const LOOK_AT_PHOTOS: Self = Self::new("Looking at the photos");
    /// Asking COLMAP for its version.
    pub const LOOK_FOR_COLMAP: Self = Self::new("Looking for COLMAP");
    /// Making a flight from photos.
    pub const RECONSTRUCT: Self = Self::new("Reconstructing").writing();
}

impl State {
    /// Does a step of making a flight from photos.
    pub(crate) fn step_from_photos(&mut self, step: FromPhotosStep) {
        match step {
            FromPhotosStep::Ask(photos) => {
                self.ask(Some(Asking::FromPhotos));
                if self.work.is_running(Task::RECONSTRUCT) {
                    return;
                }
                if let Some(photos) = photos {
                    self.notice = None;
                    self.from_photos.ended = None;
                    self.from_photos.form.photos = photos.display().to_string();
                }
                // Files may have come, and a flight may be there that was proposed before.
                self.look_at_photos();
                // It may have been installed since.
                self.look_for_colmap();
            }
            FromPhotosStep::Colmap(installed) => self.from_photos.colmap = Some(installed),
            FromPhotosStep::Fill(form) => self.fill_from_photos(form),
            FromPhotosStep::Start if self.work.is_running(Task::LOOK_AT_PHOTOS) => {
                self.from_photos.starts_then = true;
            }
            FromPhotosStep::Start => self.start_reconstructing(),
            FromPhotosStep::Pause(paused) => self.work.pause(Task::RECONSTRUCT, paused),
            FromPhotosStep::Open => {
                if let Some(Ended::Made(made)) = &self.from_photos.ended {
                    let flight = made.flight.clone();
                    self.apply(Command::Open(flight));
                }
            }
        }
    }

    fn fill_from_photos(&mut self, form: FromPhotosForm) {
        let before = std::mem::replace(&mut self.from_photos.form, form);
        let now = &self.from_photos.form;
        let are_same = (&before.photos, &before.crs) == (&now.photos, &now.crs);
        if before != *now {
            self.from_photos.ended = None;
        }
        if !are_same {
            self.look_at_photos();
        }
    }

    /// Takes a folder that was chosen in the desktop's dialog. A flight goes into a folder of its own inside
    /// one that holds other things.
    pub(crate) fn take_folder_of_photos(&mut self, field: FolderField, folder: PathBuf) {
        let mut form = self.from_photos.form.clone();
        match field {
            FolderField::Photos => form.photos = folder.display().to_string(),
            FolderField::Calibration => form.calibration = folder.display().to_string(),
            FolderField::To if may_be_made(&folder) => form.to = folder.display().to_string(),
            FolderField::To => {
                let proposed = self.from_photos.found.as_ref().map(|found| &found.proposed);
                let name = proposed.and_then(|proposed| proposed.file_name());
                let inside = folder.join(name.unwrap_or("flight".as_ref()));
                form.to = inside.display().to_string();
            }
        }
        self.fill_from_photos(form);
    }

    fn look_at_photos(&mut self) {
        self.work.cancel(Task::LOOK_AT_PHOTOS);
        self.from_photos.found = None;
        self.from_photos.starts_then = false;
        let form = &self.from_photos.form;
        // Half of a path that is being typed is no folder.
        let Some(folder) = typed(&form.photos).filter(|folder| folder.is_dir()) else {
            return;
        };
        let crs = typed_text(&form.crs);
        let work = move |progress: &Progress| {
            let folder = std::path::absolute(&folder).unwrap_or(folder);
            let photos = PhotoSet::read(&folder, crs.as_deref(), progress);
            let takes = photos
                .iter()
                .flat_map(|set| Quality::ALL.map(|quality| about(set, quality)));
            FoundPhotos {
                takes: takes.collect(),
                photos: photos.map_err(|error| error.to_string()),
                proposed: proposed_folder(&folder),
            }
        };
        self.start(Task::LOOK_AT_PHOTOS, work, |state, found| {
            let can_start = found.photos.is_ok();
            state.from_photos.found = Some(found);
            if std::mem::take(&mut state.from_photos.starts_then) && can_start {
                state.start_reconstructing();
            }
        });
    }

    fn look_for_colmap(&mut self) {
        if self.is_busy(Task::LOOK_FOR_COLMAP) {
            return;
        }
        let work = |_: &Progress| {
            let engine = EngineName::Colmap.engine();
            let engine = engine.map_err(|fault| fault.to_string())?;
            Ok(engine.name())
        };
        self.start(Task::LOOK_FOR_COLMAP, work, |state, installed| {
            state.from_photos.colmap = Some(installed);
        });
    }

    fn start_reconstructing(&mut self) {
        if self.is_busy(Task::RECONSTRUCT) {
            return;
        }
        let form = &self.from_photos.form;
        let proposed = self.from_photos.found.as_ref().map(|found| &found.proposed);
        let to = typed(&form.to).or_else(|| proposed.cloned());
        let (Some(photos), Some(to)) = (typed(&form.photos), to) else {
            return;
        };
        // The flight names the photos from where it lies, wherever the program was started.
        let absolute = |path: PathBuf| std::path::absolute(&path).unwrap_or(path);
        let request = Request {
            photos: absolute(photos),
            to: absolute(to),
            camera: typed(&form.calibration).map(absolute),
            crs: typed_text(&form.crs),
            dense: form.quality.dense(),
            card: None,
        };
        let (engine, processor_only) = (form.engine, form.processor_only);
        let node = form.node.clone();
        self.from_photos.ended = None;
        self.from_photos.node = None;
        let (writing, run) = (self.from_photos.writing.clone(), self.run_into(&request.to));
        self.from_photos.growing = None;
        // The last line of the log stands in the bar: else "cancelled" would, of the run before.
        let (from, into) = (request.photos.display(), request.to.display());
        self.say(
            Severity::Note,
            &format!("Reconstructing {from} into {into}"),
        );
        if node.chosen {
            self.start_on_node(request, &node);
            return;
        }
        // Of its own: a cancelled run may still have something to show.
        self.from_photos.grown = Default::default();
        let grown = self.from_photos.grown.clone();
        let work = move |progress: &Progress| {
            let _writes = alone(&writing, &request.to, progress)?;
            // (Drivers take a while to say what there is.)
            let card = (!processor_only).then(Card::found).flatten();
            let request = Request { card, ..request };
            if engine == EngineName::Embedded {
                let on_growth: OnGrowth = Box::new(move |growth| {
                    // Who draws a picture now takes the next model.
                    if let Ok(mut grown) = grown.try_lock() {
                        *grown = Some(growth);
                    }
                });
                let engine = Embedded {
                    on_growth: Some(on_growth),
                };
                return reconstruct(&request, &engine, progress);
            }
            let engine = engine.engine();
            let engine = engine.map_err(|fault| FileError::new(&request.photos, fault))?;
            reconstruct(&request, &*engine, progress)
        };
        self.run_reconstruction(work, run);
    }

    /// A run into that folder, from now on.
    fn run_into(&self, to: &Path) -> Run {
        Run {
            to: to.to_owned(),
            opened: self.opened,
        }
    }

    /// Reconstructs.
    fn run_reconstruction(
        &mut self,
        work: impl FnOnce(&Progress) -> Result<Reconstructed, FileError> + Send + 'static,
        run: Run,
    ) {
        self.start(
            Task::RECONSTRUCT,
            work,
            move |state, made: Result<Reconstructed, FileError>| match made {
                Ok(made) => state.take_reconstructed(made, run.opened),
                Err(error) => state.take_failed(error.to_string(), may_go_on(&run.to)),
            },
        );
    }

    /// The same on a node, whose messages are shown as they come.
    fn start_on_node(&mut self, of: Request, node: &NodeForm) {
        let request = match on_node(of, node) {
            Ok(request) => request,
            Err(fault) => return self.take_failed(fault.to_string(), false),
        };
        let told = Arc::new(Mutex::new(FromNode::default()));
        self.from_photos.node = Some(told.clone());
        let (writing, run) = (self.from_photos.writing.clone(), self.run_into(&request.to));
        let context = self.context.clone();
        let work = move |progress: &Progress| {
            let _writes = alone(&writing, &request.to, progress)?;
            let tell = |tells: &dyn Fn(&mut FromNode)| {
                tells(&mut told.lock().unwrap_or_else(PoisonError::into_inner));
                context.request_repaint();
            };
            let heard = |message: &str| tell(&|told| told.hear(message));
            let made = reconstruct_on_node(&request, &heard, progress);
            // Nobody takes the end of a run that was cancelled; but what became of the task is of interest.
            if let Err(error) = &made
                && progress.is_cancelled()
            {
                tell(&|told| told.called_off = Some(error.fault.to_string()));
            }
            made
        };
        self.run_reconstruction(work, run);
    }

    /// Takes the model of the run as it is now, where it is looked at: with no other flight on the screen.
    pub(crate) fn take_growth(&mut self) {
        let is_seen = self.open.is_none() && self.work.is_running(Task::RECONSTRUCT);
        if !is_seen {
            self.from_photos.growing = None;
            return;
        }
        let grown = self.from_photos.grown.try_lock().ok();
        let Some(growth) = grown.and_then(|mut grown| grown.take()) else {
            return;
        };
        let before = self.from_photos.growing.take();
        let next = OpeningPreview::growing(self.gpu.as_ref(), growth, before.as_ref());
        // A model without points is nothing to look at.
        self.from_photos.growing = next.or(before);
    }

    /// Whether the viewport shows the model that grows.
    pub(crate) fn is_growing_seen(&self) -> bool {
        let is_free = self.open.is_none() && self.opening_preview().is_none();
        is_free && self.from_photos.growing.is_some()
    }

    /// Says what came out and opens it, unless she has opened another flight since.
    fn take_reconstructed(&mut self, made: Reconstructed, opened: u64) {
        for warning in left_out(&made.left_out, made.photos) {
            self.say(Severity::Warning, &warning);
        }
        for warning in &made.warnings {
            self.say(Severity::Warning, warning);
        }
        for line in summary(&made) {
            self.say(Severity::Note, &line);
        }
        let flight = made.flight.clone();
        self.from_photos.ended = Some(Ended::Made(Box::new(made)));
        if self.opened == opened && !self.is_opening() {
            self.apply(Command::Open(flight));
        }
    }

    /// `goes_on`: the same run once more goes on where this one stopped.
    fn take_failed(&mut self, why: String, goes_on: bool) {
        let is_seen = self.asking == Some(Asking::FromPhotos);
        let before = self.notice.take();
        self.say(Severity::Error, &why);
        if is_seen {
            // The small window says it.
            self.notice = before;
        }
        self.from_photos.ended = Some(Ended::Failed(why));
        self.from_photos.goes_on = goes_on;
    }
}

/// A run that was started.
struct Run {
    /// Where its flight goes.
    to: PathBuf,
    /// Of how many flights that were opened it is: whether another one was since.
    opened: u64,
}

/// Whether the same run once more goes on where it stopped: not where its photos could not be reconstructed, of which nothing else comes
/// than before.
fn may_go_on(folder: &Path) -> bool {
    folder.join(UNFINISHED).is_file() && !folder.join(FAILED).is_file()
}

/// What is asked of a node.
///
/// # Errors
/// Where the address is none, or an option.
fn on_node(of: Request, node: &NodeForm) -> Result<NodeRequest, Fault> {
    Ok(NodeRequest {
        photos: of.photos,
        to: of.to,
        node: node.typed()?,
        token: Token::typed_or_set(&node.token.0),
        insecure: node.insecure,
        options: Asked::parse_all(&node.options)?,
        control_points: None,
        limits: Limits::default(),
    })
}

/// The text of a field, where there is one.
fn typed_text(text: &str) -> Option<String> {
    let text = text.trim();
    (!text.is_empty()).then(|| text.to_owned())
}

/// Waits until no other run writes.
///
/// # Errors
/// Where this one was cancelled, too.
fn alone<'a>(
    writing: &'a Mutex<()>,
    to: &Path,
    progress: &Progress,
) -> Result<MutexGuard<'a, ()>, FileError> {
    progress.stage("waiting for the run before to stop");
    loop {
        match writing.try_lock() {
            Ok(guard) => return Ok(guard),
            // One that panicked holds nothing any more.
            Err(TryLockError::Poisoned(poisoned)) => return Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => {}
        }
        let waits = progress.advance(0, 1);
        waits.map_err(|fault| FileError::new(to, fault))?;
        std::thread::sleep(Duration::from_millis(20));
    }
}
