//! The flight that is open: what was read, what was computed, what the engineer has done with it.

pub mod apply;
pub mod beside;
pub mod colors;
pub mod files;
mod flight_line;
pub mod georeferencing;
pub mod loading;
mod measure;
pub mod picker;
mod picking;
pub mod reviewing;
pub mod survey;
pub mod table;
pub mod tint;
pub mod tracing;

use std::sync::Arc;

use glam::DVec2;
use glam::DVec3;

use crate::control_points::Control;
use crate::corner_loupe::CornerFacts;
use crate::exports::PhotoLine;
use crate::flight::{ColoursFound, Flight, FlightSettings, Limits, LookedUp, Outcome, Review};
use crate::fragments::Fragments;
use crate::geometry::{Bounds, LevelBox, LocalFrame, Ray};
use crate::linked::{LinkedPoint, PointFrom};
use crate::map::FlightMap;
use crate::opening::{Colours, HealthFinding, StatedOfFlight, Together, flight_health};
use crate::photo_view::PhotoView;
use crate::planning::Planning;
use crate::render::{LargePhoto, Orbit, PhotoImage, PhotoZoom, SurfaceBuffers, drawn_ground};
use crate::scale::{FieldFacts, PhotoScale, ViewFacts};
use crate::state::history::History;
use beside::Beside;
use colors::Colors;
use files::FlightFiles;
use georeferencing::Georeferencing;
use loading::Loaded;
pub use measure::Measure;
use picker::Picker;
use reviewing::Reviewing;
use survey::clip::Clip;
use survey::picked::PickedPoints;
use survey::surveyor::Surveyor;
use survey::{Drawn, SecondBase};
use table::{Counts, PhotosTable, Row, Typical};
use tint::PhotoTint;
use tracing::TracedObjects;

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

/// How the viewport looks at the flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Looking {
    /// The free view.
    pub orbit: Orbit,
    /// The photo whose camera is looked through.
    pub through: Option<usize>,
    /// Which part of that photo is looked at.
    pub into: PhotoZoom,
    /// How much of that photo lies over the view, 0 to 1.
    pub blend: f64,
    /// The viewport's size in pixels, once it was drawn.
    pub size: Option<DVec2>,
    /// Whether the engineer has turned the view: until then it shows everything, however the window
    /// is laid out.
    pub turned: bool,
}

/// Small and large pictures of the flight's photos, as far as they were read.
pub struct Pictures {
    /// Small textures for the table.
    pub thumbnails: Vec<Option<egui::TextureHandle>>,
    /// Small pictures for the viewport.
    pub images: Vec<Option<Arc<PhotoImage>>>,
    /// When each was taken, by EXIF; those that were read.
    pub times: Vec<Option<String>>,
    /// The selected photo.
    pub preview: Option<Preview>,
}

/// Where the flight lies.
#[derive(Debug, Clone, Copy)]
pub struct Extent {
    /// Where coordinates are small.
    pub frame: LocalFrame,
    /// Around surface and cameras, without the surface's outliers.
    pub all: Bounds,
    /// Around the surface alone.
    pub surface: Bounds,
    /// Around the surface without outliers.
    pub bulk: Bounds,
}

/// What the mouse is for in the viewport.
#[derive(Default)]
pub struct Pointer {
    /// Where it points on the surface.
    pub hover: Option<DVec3>,
    /// What of the window it points from; `None` where it points at nothing.
    pub from: Option<PointFrom>,
    /// From where, and the ray that was cast for it last.
    pub asked: Option<(PointFrom, Ray)>,
    /// What is known of that place.
    pub linked: Option<Arc<LinkedPoint>>,
    /// The distance tool.
    pub measure: Measure,
    /// What is drawn on the surface to measure there.
    pub drawn: Option<Drawn>,
    /// What was finished with tools that are put away, one of each.
    pub put_away: Vec<Drawn>,
    /// A second surface that volumes can be over.
    pub second: Option<SecondBase>,
    /// Points that were picked on the surface.
    pub picked: PickedPoints,
    /// Its rays.
    pub picker: Option<Picker>,
    /// Measures what is drawn.
    pub surveyor: Option<Surveyor>,
}

/// A flight on the screen: its review, and what only a window has.
pub struct OpenFlight {
    /// Counted, so that results for an earlier flight are told from those for this one.
    pub number: u64,
    /// The number of its first reading: the same flight read again has another `number`.
    pub first_number: u64,
    /// The flight with its scales, doubts and verdicts: with the settings of now, once they are
    /// computed.
    pub review: Review,
    /// The settings that it was computed with: those of now, but for the moment until a change is
    /// computed. Their scale objects, pair and stated errors count for nothing.
    pub computed: FlightSettings,
    /// The settings of now, with those before: what undo goes back over.
    pub history: History<FlightSettings>,
    /// What it was read from, and where it is saved.
    pub files: FlightFiles,
    /// Bringing its reconstruction to the world.
    pub georeferencing: Georeferencing,
    /// The selected photo.
    pub selected: Option<usize>,
    /// The table of photos.
    pub table: PhotosTable,
    /// How it is at a glance.
    pub health: Vec<HealthFinding>,
    /// The photo under review.
    pub reviewing: Reviewing,
    /// Of its photos.
    pub pictures: Pictures,
    /// The selected photo in the middle of the window.
    pub photo_view: PhotoView,
    /// The flight as a plan.
    pub map: FlightMap,
    /// The flight that is planned over its surface.
    pub planning: Planning,
    /// The fragments of its photos.
    pub fragments: Fragments,
    /// What the selected photo's corners lie on, where that is looked at.
    pub corners: Option<CornerFacts>,
    /// The scale field of the selected photo, where it is to be tinted.
    pub tint: Option<PhotoTint>,
    /// How many such fields were asked for.
    pub tints: u64,
    /// Clouds beside the surface.
    pub beside: Vec<Beside>,
    /// The clipping box.
    pub clip: Clip,
    /// Its limits of now, with those before: undo goes back over them while its small window is shown.
    pub clip_history: History<LevelBox>,
    /// What the surface's colours mean.
    pub colors: Colors,
    /// What the viewport draws.
    pub geometry: Option<Arc<SurfaceBuffers>>,
    /// The photos in the order of the flight line.
    pub line: Arc<Vec<usize>>,
    /// Where it lies.
    pub extent: Extent,
    /// How the viewport looks.
    pub looking: Looking,
    /// The mouse in the viewport.
    pub pointer: Pointer,
    /// Scale objects on its photos.
    pub objects: TracedObjects,
    /// Marking control points.
    pub control: Control,
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
        let mut bounds = bulk_bounds;
        for photo in &opened.flight.parts().photos {
            bounds.min = bounds.min.min(photo.pose.center);
            bounds.max = bounds.max.max(photo.pose.center);
        }
        let review = Review::new(
            opened.flight.clone(),
            outcomes,
            opened.looked_up.clone(),
            limits,
        );
        let computed = opened.settings.clone();
        let plan = computed.plan.as_deref().cloned();
        let mut open = Self {
            number,
            first_number: number,
            review,
            history: History::new(computed.clone()),
            computed,
            georeferencing: Georeferencing::new(opened.origin.photo_folder()),
            files: FlightFiles::new(path, options, opened),
            selected: (count > 0).then_some(0),
            table: PhotosTable::default(),
            health: Vec::new(),
            reviewing: Reviewing::default(),
            pictures: Pictures {
                thumbnails: vec![None; count],
                images: vec![None; count],
                times: vec![None; count],
                preview: None,
            },
            photo_view: PhotoView::default(),
            map: FlightMap::default(),
            planning: Planning::of_saved(plan),
            fragments: Fragments::default(),
            corners: None,
            tint: None,
            tints: 0,
            beside: Vec::new(),
            clip: Clip::around(&bulk_bounds),
            clip_history: History::new(Clip::around(&bulk_bounds).level),
            colors: Colors::default(),
            geometry: None,
            line: Arc::default(),
            extent: Extent {
                frame: LocalFrame::near(&surface_bounds),
                all: bounds,
                surface: surface_bounds,
                bulk: bulk_bounds,
            },
            looking: Looking {
                orbit: first_look(&bounds),
                through: None,
                into: PhotoZoom::default(),
                blend: 0.5,
                size: None,
                turned: false,
            },
            pointer: Pointer::default(),
            objects: TracedObjects::default(),
            control: Control::default(),
        };
        open.arrange();
        open.order_line();
        open.take_decisions();
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
        self.history.now().clone()
    }

    /// The same to look at: a frame that copied the decisions of thousands of photos would be late.
    pub fn settings_now(&self) -> &FlightSettings {
        self.history.now()
    }

    /// The same as saving writes them: with the flight plan, which has an undo of its own.
    pub fn settings_to_save(&self) -> FlightSettings {
        FlightSettings {
            plan: self.planning.to_save().cloned().map(Box::new),
            ..self.settings()
        }
    }

    /// Whether the scales on the screen are those of the settings of now.
    pub fn is_computed(&self) -> bool {
        let now = self.history.now();
        now.gives_the_scales_of(&self.computed)
    }

    /// Whether something would be lost if it were closed.
    pub fn is_changed(&self) -> bool {
        // Of a cloud in no flight's file nothing is kept but the plan over it, which may be in a mission.
        if self.files.origin.is_surface_in_no_flight() {
            return self.planning.is_lost();
        }
        self.is_edited() || self.files.origin.has_other_files() || self.files.kept.is_some()
    }

    /// Whether settings, plan or outlines are not saved.
    pub fn is_edited(&self) -> bool {
        let saved = &self.files.saved;
        let changed = self.settings_now().changed_since(saved);
        // The plan has an undo of its own, beside the settings'.
        changed.iter().any(|what| *what != FlightSettings::PLAN)
            || self.planning.to_save() != saved.plan.as_deref()
            || self.fragments.is_changed()
    }

    /// Takes a change of the settings back that will not be computed: what is on the screen must be
    /// what the settings say.
    pub fn take_back_settings(&mut self) {
        if !self.is_computed() {
            let now = self.history.now().clone();
            self.history.replace(FlightSettings {
                scale_objects: now.scale_objects,
                decisions: now.decisions,
                pair: now.pair,
                errors: now.errors,
                control: now.control,
                ..self.computed.clone()
            });
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
        self.objects.compared.clear();
        self.arrange();
    }

    /// Takes the footprints.
    pub fn take_views(&mut self, views: Vec<Option<ViewFacts>>) {
        self.review.take_views(views);
        self.arrange();
    }

    /// Takes what the scale fields say.
    pub fn take_fields(&mut self, fields: Vec<Option<FieldFacts>>) {
        self.review.take_fields(fields);
        self.arrange();
    }

    /// Takes the pair for Split-Desktop and the errors that the settings of now state.
    pub fn take_stated(&mut self) {
        let now = self.history.now();
        self.review.take_stated(now.pair, now.errors);
        self.arrange();
    }

    /// Takes what a photo's colours say.
    pub fn take_colours(&mut self, photo: usize, colours: &Colours) {
        let found = ColoursFound::from(colours);
        let speaks_against = matches!(found, ColoursFound::Against(_));
        self.review.take_colours([(photo, found)]);
        match speaks_against {
            true => self.arrange(),
            false => self.look_at_health(),
        }
    }

    /// Takes what the engineer has decided of photos.
    pub fn take_decisions(&mut self) {
        self.review.take_decisions(&self.history.now().decisions);
        self.arrange();
    }

    /// Takes what photos and those beside them see.
    pub fn take_together(&mut self, found: &[(usize, Together)]) {
        let found = found.iter();
        self.review
            .take_together(found.map(|(photo, together)| (*photo, together.into())));
        self.arrange();
    }

    /// What was noticed while reading and what was looked up, one sentence each.
    pub fn all_warnings(&self) -> Vec<String> {
        let looked_up = self.review.looked_up();
        let looked_up = looked_up.warnings_of(self.files.path.display());
        self.files
            .warnings
            .iter()
            .cloned()
            .chain(looked_up)
            .collect()
    }

    /// Sorts and filters the table.
    pub fn arrange(&mut self) {
        self.map.revision += 1;
        let rows: Vec<Row<'_>> = (0..self.review.count())
            .filter_map(|photo| self.row(photo))
            .collect();
        let doubtful =
            |(photo, row): (usize, &Row<'_>)| row.line.photo.is_doubtful().then_some(photo);
        let doubtful = rows.iter().enumerate().filter_map(doubtful).collect();
        let typical = Typical::of_columns(&rows);
        self.table.shown = self.table.order.shown(&rows);
        self.table.doubtful = doubtful;
        self.table.typical = typical;
        self.table.counts = Counts::new(&self.review);
        self.look_at_health();
    }

    fn look_at_health(&mut self) {
        let stated = StatedOfFlight {
            crs: self.files.crs.as_deref(),
            reconstruction: self.files.reconstruction.as_ref(),
            doubtful_up: self.files.doubtful_up,
            without_pose: self.files.without_pose.as_deref(),
        };
        self.health = flight_health(&self.review, &stated);
    }

    /// How many photos go along into an export.
    pub fn chosen_count(&self) -> usize {
        self.table.counts.chosen
    }

    /// The elevation of the ground: as set, or where a ray needed it, or the surface's middle.
    pub fn ground(&self) -> f64 {
        let outcomes = self.review.outcomes();
        drawn_ground(self.settings_now().ground, outcomes, &self.extent.bulk)
    }
}

/// From the south and well above: a pile is flat, and its footprints are what one looks for.
fn first_look(bounds: &Bounds) -> Orbit {
    let mut orbit = Orbit::new(bounds);
    orbit.pitch = 0.9;
    orbit
}
