//! Scale objects: traced on the selected photo step by step, and held against the surface.

use super::work::Task;
use crate::command::Tab;
use crate::fault::Fault;
use crate::flight::ScaleObject;
use crate::jobs::Progress;
use crate::open_flight::tracing::{Trace, Tracing, rounded};
use crate::scale::Traced;
use crate::state::{Severity, State};

impl Task {
    /// Holding scale objects against the surface.
    pub const SCALE_OBJECTS: Self = Self::new("Scale objects").of_flight().to_the_end();
}

impl State {
    /// Does a step of tracing.
    pub(crate) fn trace(&mut self, step: Trace) {
        let Some(open) = &mut self.open else {
            return;
        };
        match step {
            Trace::Size(kind, size) if size > 0.0 && size.is_finite() => {
                open.objects.sizes[kind as usize] = Some(size);
            }
            Trace::Begin(kind) if open.selected.is_some() && open.trace_size(kind).is_some() => {
                open.objects.tracing = Some(Tracing {
                    kind,
                    outline: Vec::new(),
                });
                self.tab = Tab::Photo;
            }
            Trace::Size(..) | Trace::Begin(_) => {}
            Trace::GiveUp => open.objects.tracing = None,
            Trace::Finish => self.finish_tracing(),
            Trace::Add(_) | Trace::Move(..) | Trace::RemoveLast | Trace::RemoveAll => {
                let Some(tracing) = &mut open.objects.tracing else {
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
                    Trace::RemoveAll => outline.clear(),
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
        let (Some(tracing), Some(photo)) = (&open.objects.tracing, open.selected) else {
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
        self.set_settings(settings);
        if let Some(open) = &mut self.open
            && open.settings().scale_objects.len() == count
        {
            open.objects.tracing = None;
        }
    }

    /// Holds the scale objects against the surface.
    pub(crate) fn start_comparing(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let objects = open.settings().scale_objects;
        if objects.is_empty() && open.objects.compared.is_empty() {
            return;
        }
        let review = open.review.clone();
        let work = move |_: &Progress| {
            let compared = review.compare_objects(&objects)?;
            Ok(objects.into_iter().zip(compared).collect())
        };
        self.start(
            Task::SCALE_OBJECTS,
            work,
            |state, compared: Result<_, Fault>| match (compared, &mut state.open) {
                (Ok(compared), Some(open)) => open.objects.compared = compared,
                (Err(fault), _) => state.say(Severity::Error, &fault.to_string()),
                (Ok(_), None) => {}
            },
        );
    }
}
