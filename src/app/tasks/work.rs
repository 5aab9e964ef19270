//! Long work of the window: jobs by their task, each replacing the one before it.
//!
//! The window never waits: it asks now and then whether something is done, and takes it. Work whose
//! result nobody wants any more is cancelled and ends on its own.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::{Duration, Instant};

use egui::ColorImage;

use crate::fault::Fault;
use crate::flight::{ComparedObject, Flight, FlightSettings, LookedUp, Outcome, ScaleObject};
use crate::fragmentation::Effort;
use crate::geometry::Bounds;
use crate::jobs::{Job, Progress};
use crate::open_flight::georeferencing::PathField;
use crate::opening::{Colours, FlightOrigin, Georeferenced, OpenOptions, Opened};
use crate::render::{CloudBuffers, LargePhoto, MeshBuffers, PhotoImage};
use crate::scale::ViewFacts;
use crate::size_distributions::Computed;
use crate::size_distributions::reading::Read;

/// What is being done. Of each task one job runs at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Task {
    /// Reading a flight.
    Open,
    /// Computing scales anew after a setting changed.
    Scales,
    /// Holding scale objects against the surface.
    ScaleObjects,
    /// Draping footprints.
    Views,
    /// Triangles and points for the viewport.
    Geometry,
    /// Small pictures of all photos.
    Thumbnails,
    /// The selected photo for the inspector.
    Preview,
    /// Writing the export folder.
    Export,
    /// Writing flight.toml.
    Save,
    /// Writing a picture of the viewport.
    Picture,
    /// Fitting a reconstruction to the world.
    Georeference,
    /// Reading size distributions.
    ReadDistributions,
    /// Reading times of steps.
    ReadEffort,
    /// Fitting and comparing them.
    Fits,
    /// Writing their figure or report.
    SaveDistributions,
    /// Waiting for the desktop's own dialog.
    Dialog,
}

impl Task {
    /// For the status bar.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Open => "Opening",
            Self::Scales => "Scales",
            Self::ScaleObjects => "Scale objects",
            Self::Views => "Footprints",
            Self::Geometry => "Surface",
            Self::Thumbnails => "Thumbnails",
            Self::Preview => "Photo",
            Self::Export => "Export",
            Self::Save => "Saving",
            Self::Picture => "Picture",
            Self::Georeference => "Georeferencing",
            Self::ReadDistributions => "Reading",
            Self::ReadEffort => "Reading times",
            Self::Fits => "Fitting",
            Self::SaveDistributions => "Writing",
            Self::Dialog => "Dialog",
        }
    }

    /// Whether it can be cancelled: without footprints and triangles the flight on the screen would
    /// stay half-finished.
    pub fn can_be_cancelled(self) -> bool {
        !matches!(self, Self::Views | Self::Geometry | Self::ScaleObjects)
    }
}

/// Why a native dialog was opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DialogFor {
    /// A flight's file or folder.
    Open,
    /// A surface, or the folder of the photos.
    Add,
    /// Where the export folder goes.
    Export,
    /// Where flight.toml goes.
    SaveAs,
    /// Where a picture goes.
    Picture,
    /// Files of size distributions.
    Distributions,
    /// A table of times.
    Effort,
    /// Where the figure of the size distributions goes.
    Figure,
    /// Where the report on them goes.
    Report,
    /// What georeferencing reads: this field's file or folder.
    Georeference(PathField),
}

/// A flight with its scales.
#[derive(Debug)]
pub struct Loaded {
    /// What the user named.
    pub path: PathBuf,
    /// The surface and photos that she named beside it.
    pub options: OpenOptions,
    /// What was read.
    pub opened: Opened,
    /// Of each photo.
    pub outcomes: Vec<Outcome>,
    /// Around the surface.
    pub surface_bounds: Bounds,
    /// Around the surface without outliers.
    pub bulk_bounds: Bounds,
    /// How long reading took, and computing the scales.
    pub took: [Duration; 2],
    /// The number of the open flight that was read again with other surface options.
    pub again_for: Option<u64>,
}

/// A flight that cannot be opened.
#[derive(Debug)]
pub struct NotOpened {
    /// Why, in a line.
    pub why: String,
    /// What was tried, if a flight was named: its surface or its photos may be named next.
    pub tried: Option<(PathBuf, OpenOptions)>,
}

/// What the viewport draws, on the graphics device.
#[derive(Debug)]
pub struct Geometry {
    /// The points.
    pub cloud: CloudBuffers,
    /// The triangles.
    pub mesh: MeshBuffers,
    /// How many points there are.
    pub points: usize,
}

/// What came out of a job.
#[derive(Debug)]
pub enum Done {
    /// A flight, or why it cannot be opened.
    Opened(Box<Result<Loaded, Box<NotOpened>>>),
    /// Scales after a setting changed, with the settings.
    Scales(Result<(Arc<Flight>, Vec<Outcome>, LookedUp, FlightSettings), Fault>),
    /// The scale objects with what the point cloud says beside them.
    Compared(Result<Vec<(ScaleObject, ComparedObject)>, Fault>),
    /// How the photos look at the surface.
    Views(Result<Vec<Option<ViewFacts>>, Fault>),
    /// For the viewport.
    Geometry(Result<Box<Geometry>, Fault>),
    /// Nobody wants it any more.
    Cancelled,
    /// All thumbnails have been sent.
    Thumbnails,
    /// The selected photo, undistorted as its scale assumes, or why it cannot be shown.
    Preview {
        /// Which photo.
        photo: usize,
        /// Its pixels.
        picture: Result<PreviewPicture, String>,
    },
    /// What was exported and where, in a sentence, with what to know about it.
    Exported(Result<(String, Vec<String>), String>),
    /// Of the flight of this origin: the flight.toml that was written, with the settings in it.
    Saved(FlightOrigin, Result<(FlightOrigin, FlightSettings), String>),
    /// The reconstruction fitted to the world, or why not in a line; with the folder of photos that
    /// was named for it.
    Georeferenced(Option<PathBuf>, Box<Result<Georeferenced, String>>),
    /// Where the georeferenced flight was written.
    SavedGeoreferenced(Result<PathBuf, String>),
    /// Times of steps from this file, with what was noticed, or why there are none in a line.
    ReadEffort(PathBuf, Result<(Effort, Vec<String>), String>),
    /// Size distributions, or why they cannot be read.
    ReadDistributions(Read),
    /// Fits and comparisons.
    Fitted(Result<Arc<Computed>, Fault>),
    /// Where a figure or report was written.
    SavedDistributions(Result<PathBuf, String>),
    /// Where the picture was written.
    Picture(Result<PathBuf, String>),
    /// What the person chose; `None` where she did not, or where the desktop has no dialog.
    Dialog(DialogFor, Option<PathBuf>),
}

/// A reduced, undistorted photo on its way to the table and the viewport.
#[derive(Debug)]
pub struct Thumbnail {
    /// Of which opened flight, counted.
    pub flight: u64,
    /// Which photo.
    pub photo: usize,
    /// For the table.
    pub small: Option<ColorImage>,
    /// For the viewport.
    pub image: Option<PhotoImage>,
    /// How its colours compare with the surface's.
    pub colours: Colours,
}

/// The selected photo, undistorted as its scale assumes.
#[derive(Debug)]
pub struct PreviewPicture {
    /// For the inspector.
    pub large: Arc<ColorImage>,
    /// For the viewport: over the look through the camera, and on the surface.
    pub projected: Option<LargePhoto>,
}

/// The jobs under way.
#[derive(Debug)]
pub struct Work {
    running: Vec<(Task, Job<(Done, Duration)>)>,
    context: egui::Context,
    /// Small pictures arrive one by one, not at the end.
    thumbnails: Receiver<Thumbnail>,
    send_thumbnail: SyncSender<Thumbnail>,
}

impl Work {
    /// Nothing to do yet. The context is woken when something is done.
    pub fn new(context: egui::Context) -> Self {
        // Bounded: pictures wait in the job, not in memory, until the window has taken some.
        let (send_thumbnail, thumbnails) = sync_channel(16);
        Self {
            running: Vec::new(),
            context,
            thumbnails,
            send_thumbnail,
        }
    }

    /// Starts a task; one of the same kind that still runs is cancelled and its result dropped.
    ///
    /// # Errors
    /// Where the system has no thread left.
    pub fn start(
        &mut self,
        task: Task,
        work: impl FnOnce(&Progress) -> Done + Send + 'static,
    ) -> Result<(), Fault> {
        self.cancel(task);
        let context = self.context.clone();
        let job = Job::start(task.in_words(), move |progress| {
            let begun = Instant::now();
            let done = work(progress);
            context.request_repaint();
            (done, begun.elapsed())
        })?;
        self.running.push((task, job));
        Ok(())
    }

    /// Where the thumbnails' job sends them.
    pub fn thumbnail_sender(&self) -> SyncSender<Thumbnail> {
        self.send_thumbnail.clone()
    }

    /// The thumbnails that have arrived, at most `most`.
    pub fn thumbnails(&self, most: usize) -> Vec<Thumbnail> {
        self.thumbnails.try_iter().take(most).collect()
    }

    /// Cancels a task, if it runs; its result will not be seen.
    pub fn cancel(&mut self, task: Task) {
        self.running.retain(|(running, job)| {
            if *running == task {
                job.progress().cancel();
            }
            *running != task
        });
    }

    /// Cancels what belongs to the flight on the screen; what is written goes on.
    pub fn cancel_for_flight(&mut self) {
        for task in [
            Task::Scales,
            Task::Views,
            Task::ScaleObjects,
            Task::Geometry,
            Task::Thumbnails,
            Task::Preview,
            Task::Georeference,
        ] {
            self.cancel(task);
        }
    }

    /// Whether a file is being written.
    pub fn is_writing(&self) -> bool {
        let tasks = [
            Task::Export,
            Task::Save,
            Task::Picture,
            Task::SaveDistributions,
        ];
        tasks.into_iter().any(|task| self.is_running(task))
    }

    /// Cancels everything.
    pub fn cancel_all(&mut self) {
        for (_, job) in self.running.drain(..) {
            job.progress().cancel();
        }
    }

    /// What runs, with its sentence and its fraction from 0 to 1.
    pub fn running(&self) -> impl Iterator<Item = (Task, (String, f64))> {
        self.running
            .iter()
            .map(|(task, job)| (*task, job.progress().snapshot()))
    }

    /// Whether this task runs.
    pub fn is_running(&self, task: Task) -> bool {
        self.running.iter().any(|(running, _)| *running == task)
    }

    /// Whether nothing runs.
    pub fn is_idle(&self) -> bool {
        self.running.is_empty()
    }

    /// Takes the first that is done, with how long it took: one at a time, because taking it may cancel others that are done
    /// as well. A job that panicked is a fault of ours, told like any other.
    pub fn finished(&mut self) -> Option<Result<(Done, Duration), Fault>> {
        let place = self.running.iter().position(|(_, job)| job.is_finished())?;
        let (_, job) = self.running.remove(place);
        Some(job.finish())
    }
}

impl Drop for Work {
    fn drop(&mut self) {
        self.cancel_all();
    }
}
