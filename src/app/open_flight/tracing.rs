//! Tracing scale objects on the selected photo: what a draft is, and what commands do to it.

use glam::DVec2;

use crate::command::{Command, Tab};
use crate::fault::Fault;
use crate::flight::{ComparedObject, ScaleObject};
use crate::open_flight::OpenFlight;
use crate::scale::{ScaleObjectKind, Traced};
use crate::state::{Severity, State};
use crate::tasks::work::{Done, Task};

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
    /// Makes a scale object of the points.
    Finish,
    /// Forgets the points.
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

impl State {
    /// Does a step of tracing.
    pub(crate) fn trace(&mut self, step: Trace) {
        let Some(open) = &mut self.open else {
            return;
        };
        match step {
            Trace::Size(kind, size) if size > 0.0 && size.is_finite() => {
                open.trace_sizes[kind as usize] = Some(size);
            }
            Trace::Begin(kind) if open.selected.is_some() && open.trace_size(kind).is_some() => {
                open.tracing = Some(Tracing {
                    kind,
                    outline: Vec::new(),
                });
                self.tab = Tab::Photo;
            }
            Trace::Size(..) | Trace::Begin(_) => {}
            Trace::GiveUp => open.tracing = None,
            Trace::Finish => self.finish_tracing(),
            Trace::Add(_) | Trace::Move(..) | Trace::RemoveLast => {
                let Some(tracing) = &mut open.tracing else {
                    return;
                };
                let outline = &mut tracing.outline;
                match step {
                    Trace::Add(pixel) if pixel.is_finite() => outline.push(rounded(pixel)),
                    Trace::Move(point, pixel) if pixel.is_finite() => {
                        if let Some(place) = outline.get_mut(point) {
                            *place = rounded(pixel);
                        }
                    }
                    Trace::RemoveLast => {
                        outline.pop();
                    }
                    _ => {}
                }
                let (_, most) = tracing.kind.points();
                if tracing.outline.len() == most {
                    self.finish_tracing();
                }
            }
        }
    }

    fn finish_tracing(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let (Some(tracing), Some(photo)) = (&open.tracing, open.selected) else {
            return;
        };
        let Some(size) = open.trace_size(tracing.kind) else {
            return;
        };
        let Some(posed) = open.flight().parts().photos.get(photo) else {
            return;
        };
        let camera = open.flight().camera(posed);
        if let Err(fault) = Traced::new(camera, tracing.kind, size, &tracing.outline) {
            self.say(Severity::Error, &fault.to_string());
            return;
        }
        let object = ScaleObject {
            photo: posed.name.clone(),
            kind: tracing.kind,
            size,
            outline: tracing.outline.clone(),
            mask: true,
        };
        let mut settings = open.settings();
        settings.scale_objects.push(object);
        let count = settings.scale_objects.len();
        self.edit_settings(&Command::Set(settings));
        if let Some(open) = &mut self.open
            && open.settings().scale_objects.len() == count
        {
            open.tracing = None;
        }
    }

    /// Holds the scale objects against the surface.
    pub(crate) fn start_comparing(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let objects = open.settings().scale_objects;
        let (flight, outcomes) = (open.flight().clone(), open.review.outcomes().clone());
        self.start(Task::ScaleObjects, move |_| {
            let compared = flight.compare_objects(&objects, &outcomes);
            Done::Compared(compared.map(|compared| objects.into_iter().zip(compared).collect()))
        });
    }

    /// Takes what [`Self::start_comparing`] found.
    pub(crate) fn take_compared(
        &mut self,
        compared: Result<Vec<(ScaleObject, ComparedObject)>, Fault>,
    ) {
        match (compared, &mut self.open) {
            (Ok(compared), Some(open)) => open.compared = compared,
            (Err(fault), _) => self.say(Severity::Error, &fault.to_string()),
            (Ok(_), None) => {}
        }
    }
}

impl OpenFlight {
    /// How large the next object of a kind is: as typed, else as the last one of its kind.
    pub fn trace_size(&self, kind: ScaleObjectKind) -> Option<f64> {
        let objects = &self.history.now().settings.scale_objects;
        let last = objects.iter().rfind(|object| object.kind == kind);
        self.trace_sizes[kind as usize].or(last.map(|object| object.size))
    }

    /// The scale objects of a photo, with their places in the list of all.
    pub fn objects_of(&self, photo: usize) -> impl Iterator<Item = (usize, &ScaleObject)> {
        let name = self.name(photo).to_owned();
        let objects = self.history.now().settings.scale_objects.iter();
        objects.enumerate().filter(move |(_, o)| o.photo == name)
    }

    /// The command that changes a scale object; `None` where there is none at that place.
    pub fn change_object(
        &self,
        place: usize,
        change: impl FnOnce(&mut ScaleObject),
    ) -> Option<Command> {
        let mut settings = self.settings();
        change(settings.scale_objects.get_mut(place)?);
        Some(Command::Set(settings))
    }

    /// What the point cloud says beside a scale object, once that is known.
    pub fn compared(&self, object: &ScaleObject) -> Option<&ComparedObject> {
        let mut compared = self.compared.iter();
        let found = compared.find(|(before, _)| before == object);
        found
            .filter(|_| self.is_computed())
            .map(|(_, compared)| compared)
    }
}
