//! The flight that is open: what was read, what was computed, what the engineer has done with it.

pub mod apply;
pub mod georeferencing;
pub mod loading;
pub mod picker;
mod picking;
pub mod table;
pub mod tracing;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::exports::PhotoLine;
use crate::files::Inputs;
use crate::flight::{
    ColoursFound, ComparedObject, Flight, FlightSettings, Limits, LookedUp, Outcome, Review,
    ScaleObject, Verdict,
};
use crate::geometry::{Bounds, LocalFrame};
use crate::opening::{Colours, FlightOrigin, FlightReconstruction, OpenOptions, PhotoFile};
use crate::render::{LargePhoto, Orbit, PhotoImage, SurfaceBuffers, drawn_ground};
use crate::scale::{PhotoScale, ViewFacts};
use crate::state::bundled::sample_flight;
use crate::state::history::History;
use georeferencing::Georeferencing;
use loading::Loaded;
use picker::Picker;
use table::{Row, TableOrder};
use tracing::Tracing;

/// What undo goes back over.
#[derive(Debug, Clone, PartialEq)]
pub struct Edit {
    /// The flight's settings.
    pub settings: FlightSettings,
    /// Which photos are chosen for export.
    pub chosen: Vec<bool>,
}

/// The selected photo in the inspector.
#[derive(Debug)]
pub struct Preview {
    /// Which photo.
    pub photo: usize,
    /// Its pixels, undistorted as its scale assumes, or why it cannot be shown.
    pub picture: Result<PreviewPicture, String>,
    /// Counted, so that textures know a new one.
    pub number: u64,
}

/// The selected photo, undistorted as its scale assumes.
#[derive(Debug)]
pub struct PreviewPicture {
    /// For the inspector.
    pub large: Arc<egui::ColorImage>,
    /// For the viewport: over the look through the camera, and on the surface.
    pub projected: Option<LargePhoto>,
}

/// The distance tool.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Measure {
    /// Clicks select photos.
    #[default]
    Off,
    /// Waits for the first point.
    First,
    /// Has one.
    Second(DVec3),
    /// Has both; the next click begins anew.
    Both(DVec3, DVec3),
}

/// How the viewport looks at the flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Looking {
    /// The free view.
    pub orbit: Orbit,
    /// The photo whose camera is looked through.
    pub through: Option<usize>,
    /// How much of that photo lies over the view, 0 to 1.
    pub blend: f64,
    /// The viewport's size in pixels, once it was drawn.
    pub size: Option<DVec2>,
    /// Whether the engineer has turned the view: until then it shows everything, however the window
    /// is laid out.
    pub turned: bool,
}

/// A flight on the screen.
pub struct OpenFlight {
    /// Counted, so that results for an earlier flight are told from those for this one.
    pub number: u64,
    /// What the user named.
    pub path: PathBuf,
    /// The surface and photos that were named beside it.
    pub options: OpenOptions,
    /// The flight with its scales, doubts and verdicts: with the settings of now, once they are
    /// computed.
    pub review: Review,
    /// Of each photo.
    pub photo_files: Arc<Vec<PhotoFile>>,
    /// The world's coordinate system where the files state one.
    pub crs: Option<String>,
    /// The files read.
    pub inputs: Vec<PathBuf>,
    /// These, the photos and whatever was opened on the way: nothing of it is written over.
    pub read: Inputs,
    /// What was noticed while reading.
    pub warnings: Vec<String>,
    /// The flight.toml that it was opened from: it may be saved there.
    pub opened_file: Option<PathBuf>,
    /// Where it came from, and where it is saved.
    pub origin: FlightOrigin,
    /// The reconstruction that it was made of, if any.
    pub reconstruction: Option<FlightReconstruction>,
    /// Bringing that to the world.
    pub georeferencing: Georeferencing,
    /// Whether it is the flight that comes with the program, which stays as it came.
    pub bundled: bool,
    /// The settings in that file.
    pub saved: FlightSettings,
    /// The settings that the flight and its outcomes were computed with: those of now, but for the
    /// moment until a change is computed. Its scale objects count for nothing.
    pub computed: FlightSettings,
    /// The settings and choices of now, with those before.
    pub history: History<Edit>,
    /// Whether the photos to export have been proposed: once, after the first verdicts.
    pub proposed: bool,
    /// The selected photo.
    pub selected: Option<usize>,
    /// How the table is sorted and filtered.
    pub order: TableOrder,
    /// The rows that follow from it.
    pub shown: Vec<usize>,
    /// Small textures for the table.
    pub thumbnails: Vec<Option<egui::TextureHandle>>,
    /// Small pictures for the viewport.
    pub images: Vec<Option<Arc<PhotoImage>>>,
    /// The selected photo.
    pub preview: Option<Preview>,
    /// What the viewport draws.
    pub geometry: Option<Arc<SurfaceBuffers>>,
    /// Where coordinates are small.
    pub frame: LocalFrame,
    /// Around surface and cameras, without the surface's outliers.
    pub bounds: Bounds,
    /// Around the surface alone.
    pub surface_bounds: Bounds,
    /// Around the surface without outliers.
    pub bulk_bounds: Bounds,
    /// How the viewport looks.
    pub looking: Looking,
    /// Where the mouse points on the surface.
    pub hover: Option<DVec3>,
    /// The photo that the mouse is over in the table.
    pub hovered_photo: Option<usize>,
    /// The distance tool.
    pub measure: Measure,
    /// Rays of the mouse.
    pub picker: Option<Picker>,
    /// The scale object that is being traced on the selected photo.
    pub tracing: Option<Tracing>,
    /// How large the next scale objects are, as typed: a sphere, a bar.
    pub trace_sizes: [Option<f64>; 2],
    /// The scale objects with what the point cloud says beside them, once known.
    pub compared: Vec<(ScaleObject, ComparedObject)>,
}

impl OpenFlight {
    /// Shows a flight that was just read.
    pub fn new(number: u64, loaded: Loaded, limits: &Limits) -> Self {
        let Loaded {
            path,
            options,
            opened,
            outcomes,
            surface_bounds,
            bulk_bounds,
            took: _,
            again_for: _,
        } = loaded;
        let count = outcomes.len();
        let saved = opened
            .file
            .as_ref()
            .map_or_else(|| opened.settings.clone(), |(_, file)| file.settings());
        let bundled = is_bundled(&opened.origin.suggested_file());
        let opened_file = opened.file.map(|(path, _)| path).filter(|_| !bundled);
        let mut bounds = bulk_bounds;
        for photo in &opened.flight.parts().photos {
            bounds.min = bounds.min.min(photo.pose.center);
            bounds.max = bounds.max.max(photo.pose.center);
        }
        let mut open = Self {
            number,
            path,
            options,
            review: Review::new(opened.flight, outcomes, opened.looked_up, limits),
            photo_files: Arc::new(opened.photo_files),
            crs: opened.crs,
            inputs: opened.inputs,
            read: opened.read,
            warnings: opened.warnings,
            bundled,
            opened_file,
            georeferencing: Georeferencing::new(opened.origin.photo_folder()),
            reconstruction: opened.reconstruction,
            origin: opened.origin,
            saved,
            computed: opened.settings.clone(),
            history: History::new(Edit {
                settings: opened.settings,
                chosen: vec![false; count],
            }),
            proposed: false,
            selected: (count > 0).then_some(0),
            order: TableOrder::default(),
            shown: Vec::new(),
            thumbnails: vec![None; count],
            images: vec![None; count],
            preview: None,
            geometry: None,
            frame: LocalFrame::near(&surface_bounds),
            bounds,
            surface_bounds,
            bulk_bounds,
            looking: Looking {
                orbit: first_look(&bounds),
                through: None,
                blend: 0.5,
                size: None,
                turned: false,
            },
            hover: None,
            hovered_photo: None,
            measure: Measure::Off,
            picker: None,
            tracing: None,
            trace_sizes: [None; 2],
            compared: Vec::new(),
        };
        open.arrange();
        open
    }

    /// The flight, with the settings that it is computed with.
    pub fn flight(&self) -> &Arc<Flight> {
        self.review.flight()
    }

    /// Lets it go. Millions of points take longer to free than a frame may: a thread does it.
    pub fn let_go(self: Box<Self>) {
        // Where there is no thread, it is freed here.
        let _ = std::thread::Builder::new()
            .name("let go".to_owned())
            .spawn(move || drop(self));
    }

    /// The settings of now.
    pub fn settings(&self) -> FlightSettings {
        self.history.now().settings.clone()
    }

    /// Whether the scales on the screen are those of the settings of now.
    pub fn is_computed(&self) -> bool {
        let now = &self.history.now().settings;
        now.gives_the_scales_of(&self.computed)
    }

    /// Whether something would be lost if it were closed.
    pub fn is_changed(&self) -> bool {
        self.settings() != self.saved || self.origin.has_other_files()
    }

    /// Takes a change of the settings back that will not be computed: what is on the screen must be
    /// what the settings say.
    pub fn take_back_settings(&mut self) {
        if !self.is_computed() {
            let mut edit = self.history.now().clone();
            edit.settings = FlightSettings {
                scale_objects: edit.settings.scale_objects,
                ..self.computed.clone()
            };
            self.history.replace(edit);
            self.arrange();
        }
    }

    /// The photo's name.
    pub fn name(&self, photo: usize) -> &str {
        let photos = &self.flight().parts().photos;
        photos.get(photo).map_or("", |photo| photo.name.as_str())
    }

    /// The photo's scale, where it has one.
    pub fn scale(&self, photo: usize) -> Option<&PhotoScale> {
        self.review.photo(photo)?.scale()
    }

    /// How the photo looks at the surface, once known.
    pub fn view(&self, photo: usize) -> Option<&ViewFacts> {
        self.review.photo(photo)?.view
    }

    /// What the table knows of a photo, scales in pixels per world unit; `None` where there is no such
    /// photo.
    pub fn row(&self, photo: usize) -> Option<Row<'_>> {
        Some(Row {
            line: PhotoLine::of(self.review.photo(photo)?, photo),
            chosen: self.history.now().chosen.get(photo).copied()?,
        })
    }

    /// Takes other limits.
    pub fn take_limits(&mut self, limits: &Limits) {
        self.review.take_limits(limits);
        self.arrange();
    }

    /// Takes scales with other settings, those of `computed`.
    pub fn take_scales(
        &mut self,
        flight: Arc<Flight>,
        outcomes: Vec<Outcome>,
        looked_up: LookedUp,
        computed: FlightSettings,
    ) {
        self.review.take_scales(flight, outcomes, looked_up);
        self.computed = computed;
        self.compared.clear();
        self.arrange();
    }

    /// Takes the footprints. What can be trusted then is proposed for export, once; the rest waits for
    /// the engineer.
    pub fn take_views(&mut self, views: Vec<Option<ViewFacts>>) {
        self.review.take_views(views);
        if !self.proposed {
            self.proposed = true;
            let verdicts = self.review.photos().map(|photo| photo.verdict);
            let proposal: Vec<bool> = verdicts.map(|verdict| verdict == Verdict::Trust).collect();
            self.history.each(|edit| edit.chosen.clone_from(&proposal));
        }
        self.arrange();
    }

    /// Takes what a photo's colours say. One that they speak against is no longer proposed for export.
    pub fn take_colours(&mut self, photo: usize, colours: &Colours) {
        let found = ColoursFound::from(colours.doubt());
        let speaks_against = found != ColoursFound::NothingAgainst;
        let before = self.review.photo(photo).map(|photo| photo.verdict);
        self.review.take_colours([(photo, found)]);
        if !speaks_against {
            return;
        }
        if self.proposed && before == Some(Verdict::Trust) {
            self.history.each(|edit| {
                if let Some(chosen) = edit.chosen.get_mut(photo) {
                    *chosen = false;
                }
            });
        }
        self.arrange();
    }

    /// What was noticed while reading and what was looked up, one sentence each.
    pub fn all_warnings(&self) -> Vec<String> {
        let looked_up = self.review.looked_up().warnings_of(self.path.display());
        self.warnings.iter().cloned().chain(looked_up).collect()
    }

    /// Sorts and filters the table.
    pub fn arrange(&mut self) {
        let rows: Vec<Row<'_>> = (0..self.review.count())
            .filter_map(|photo| self.row(photo))
            .collect();
        self.shown = self.order.shown(&rows);
    }

    /// How many photos are chosen for export.
    pub fn chosen_count(&self) -> usize {
        self.history.now().chosen.iter().filter(|&&c| c).count()
    }

    /// The elevation of the ground: as set, or where a ray needed it, or the surface's middle.
    pub fn ground(&self) -> f64 {
        let outcomes = self.review.outcomes();
        drawn_ground(self.settings().ground, outcomes, &self.surface_bounds)
    }
}

/// From the south and well above: a pile is flat, and its footprints are what one looks for.
fn first_look(bounds: &Bounds) -> Orbit {
    let mut orbit = Orbit::new(bounds);
    orbit.pitch = 0.9;
    orbit
}

/// Whether a flight.toml is that of the bundled flight, however its path is written.
fn is_bundled(file: &Path) -> bool {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    let folder = file.parent().and_then(real);
    folder.is_some() && folder == sample_flight().as_deref().and_then(real)
}
