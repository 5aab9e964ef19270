//! The flight that is open: what was read, what was computed, what the engineer has done with it.

pub mod apply;
pub mod files;
pub mod georeferencing;
pub mod loading;
pub mod picker;
mod picking;
pub mod table;
pub mod tracing;

use std::sync::Arc;

use glam::{DVec2, DVec3};

use crate::exports::PhotoLine;
use crate::flight::{
    ColoursFound, Flight, FlightSettings, Limits, LookedUp, Outcome, Review, Verdict,
};
use crate::geometry::{Bounds, LocalFrame};
use crate::opening::Colours;
use crate::render::{LargePhoto, Orbit, PhotoImage, SurfaceBuffers, drawn_ground};
use crate::scale::{PhotoScale, ViewFacts};
use crate::state::history::History;
use files::FlightFiles;
use georeferencing::Georeferencing;
use loading::Loaded;
use picker::Picker;
use table::{PhotosTable, Row};
use tracing::TracedObjects;

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

/// Small and large pictures of the flight's photos, as far as they were read.
pub struct Pictures {
    /// Small textures for the table.
    pub thumbnails: Vec<Option<egui::TextureHandle>>,
    /// Small pictures for the viewport.
    pub images: Vec<Option<Arc<PhotoImage>>>,
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
    /// The distance tool.
    pub measure: Measure,
    /// Its rays.
    pub picker: Option<Picker>,
}

/// A flight on the screen: its review, and what only a window has.
pub struct OpenFlight {
    /// Counted, so that results for an earlier flight are told from those for this one.
    pub number: u64,
    /// The flight with its scales, doubts and verdicts: with the settings of now, once they are
    /// computed.
    pub review: Review,
    /// The settings that it was computed with: those of now, but for the moment until a change is
    /// computed. Their scale objects count for nothing.
    pub computed: FlightSettings,
    /// The settings and choices of now, with those before.
    pub history: History<Edit>,
    /// Whether the photos to export have been proposed: once, after the first verdicts.
    pub proposed: bool,
    /// What it was read from, and where it is saved.
    pub files: FlightFiles,
    /// Bringing its reconstruction to the world.
    pub georeferencing: Georeferencing,
    /// The selected photo.
    pub selected: Option<usize>,
    /// The table of photos.
    pub table: PhotosTable,
    /// Of its photos.
    pub pictures: Pictures,
    /// What the viewport draws.
    pub geometry: Option<Arc<SurfaceBuffers>>,
    /// Where it lies.
    pub extent: Extent,
    /// How the viewport looks.
    pub looking: Looking,
    /// The mouse in the viewport.
    pub pointer: Pointer,
    /// Scale objects on its photos.
    pub objects: TracedObjects,
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
        let mut open = Self {
            number,
            review,
            computed: computed.clone(),
            history: History::new(Edit {
                settings: computed,
                chosen: vec![false; count],
            }),
            proposed: false,
            georeferencing: Georeferencing::new(opened.origin.photo_folder()),
            files: FlightFiles::new(path, options, opened),
            selected: (count > 0).then_some(0),
            table: PhotosTable::default(),
            pictures: Pictures {
                thumbnails: vec![None; count],
                images: vec![None; count],
                preview: None,
            },
            geometry: None,
            extent: Extent {
                frame: LocalFrame::near(&surface_bounds),
                all: bounds,
                surface: surface_bounds,
                bulk: bulk_bounds,
            },
            looking: Looking {
                orbit: first_look(&bounds),
                through: None,
                blend: 0.5,
                size: None,
                turned: false,
            },
            pointer: Pointer::default(),
            objects: TracedObjects::default(),
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
        self.settings() != self.files.saved || self.files.origin.has_other_files()
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
        self.objects.compared.clear();
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
        let rows: Vec<Row<'_>> = (0..self.review.count())
            .filter_map(|photo| self.row(photo))
            .collect();
        self.table.shown = self.table.order.shown(&rows);
    }

    /// How many photos are chosen for export.
    pub fn chosen_count(&self) -> usize {
        self.history.now().chosen.iter().filter(|&&c| c).count()
    }

    /// The elevation of the ground: as set, or where a ray needed it, or the surface's middle.
    pub fn ground(&self) -> f64 {
        let outcomes = self.review.outcomes();
        drawn_ground(self.settings().ground, outcomes, &self.extent.surface)
    }
}

/// From the south and well above: a pile is flat, and its footprints are what one looks for.
fn first_look(bounds: &Bounds) -> Orbit {
    let mut orbit = Orbit::new(bounds);
    orbit.pitch = 0.9;
    orbit
}
