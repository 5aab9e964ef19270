//! Tracing scale objects on the selected photo: what a draft is.

use glam::DVec2;

use crate::flight::{ComparedObject, ScaleObject};
use crate::open_flight::OpenFlight;
use crate::scale::ScaleObjectKind;

/// A step of tracing. Places are pixels of the photo as shot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trace {
    /// How large the next object of this kind is, world units.
    Size(ScaleObjectKind, f64),
    /// Begins on the selected photo.
    Begin(ScaleObjectKind),
    /// Adds a point.
    Add(DVec2),
    /// Moves one of the points.
    Move(usize, DVec2),
    /// Takes the last point back.
    RemoveLast,
    /// Takes all points back; the tracing goes on.
    RemoveAll,
    /// Makes a scale object of the points.
    Finish,
    /// Forgets the points, and traces no longer.
    GiveUp,
}

/// An object that is being traced on the selected photo.
#[derive(Debug, Clone, PartialEq)]
pub struct Tracing {
    /// What it is.
    pub kind: ScaleObjectKind,
    /// The points so far, pixels of the photo as shot.
    pub outline: Vec<DVec2>,
}

impl Tracing {
    /// Whether there are enough points.
    pub fn is_complete(&self) -> bool {
        self.outline.len() >= self.kind.points().0
    }
}

/// A place to a hundredth of a pixel: nobody points closer, and flight.toml stays readable.
pub(crate) fn rounded(pixel: DVec2) -> DVec2 {
    (pixel * 100.0).round() / 100.0
}

/// Scale objects of a flight in the window.
#[derive(Debug, Default)]
pub struct TracedObjects {
    /// That is being traced on the selected photo.
    pub tracing: Option<Tracing>,
    /// How large the next ones are, as typed: a sphere, a bar.
    pub sizes: [Option<f64>; 2],
    /// All of them with what the point cloud says beside them, once known.
    pub compared: Vec<(ScaleObject, ComparedObject)>,
}

impl OpenFlight {
    /// How large the next object of a kind is: as typed, else as the last one of its kind.
    pub fn trace_size(&self, kind: ScaleObjectKind) -> Option<f64> {
        let objects = &self.history.now().scale_objects;
        let last = objects.iter().rfind(|object| object.kind == kind);
        self.objects.sizes[kind as usize].or(last.map(|object| object.size))
    }

    /// The scale objects of a photo, with their places in the list of all.
    pub fn objects_of(&self, photo: usize) -> impl Iterator<Item = (usize, &ScaleObject)> {
        let name = self.name(photo).to_owned();
        let objects = self.history.now().scale_objects.iter();
        objects.enumerate().filter(move |(_, o)| o.photo == name)
    }

    /// What the point cloud says beside a scale object, once that is known.
    pub fn compared(&self, object: &ScaleObject) -> Option<&ComparedObject> {
        let mut compared = self.objects.compared.iter();
        let found = compared.find(|(before, _)| before == object);
        found
            .filter(|_| self.is_computed())
            .map(|(_, compared)| compared)
    }
}
