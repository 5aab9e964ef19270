//! What the outlines of the selected photo come to, measured anew whenever they change.

use std::sync::Arc;

use super::{MeasuredFragments, PhotoOutlines};
use crate::delineation;
use crate::delineation::intervals::{Doubts, SizeInterval, coarse_end_not_shown, intervals};
use crate::delineation::mass::{Steps, by_mass};
use crate::delineation::measures::SieveShape;
use crate::exports;
use crate::fault::Fault;
use crate::flight::{FlightSettings, ScaleObject};
use crate::formats::{self, DistributionColumns};
use crate::jobs::Progress;
use crate::scale::ScaleField;
use crate::size_distributions::{OfFragments, Page, Source};
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Measuring a photo's fragments.
    pub const MEASURE_FRAGMENTS: Self = Self::new("Measuring fragments").of_flight();
}

impl State {
    /// Measures the selected photo's outlines where that is not done, or a change came after it.
    pub(crate) fn measure_fragments(&mut self) {
        let Some(open) = self.open.as_ref().filter(|_| self.page == Page::Fragments) else {
            return;
        };
        let Some(photo) = open.selected else {
            return;
        };
        let settings = open.settings();
        let objects = objects_in(&settings, open.name(photo));
        let is_measured =
            |of: &PhotoOutlines| of.measured().is_some_and(|of| of.without == objects);
        let Some(of) = open.fragments.of(photo).filter(|of| !is_measured(of)) else {
            return;
        };
        // As it is when the job begins; while she edits on, the next one is begun when this one ends.
        let wish = (open.number, photo, of.revision);
        if !self.work.may_start(Task::MEASURE_FRAGMENTS, &wish) {
            return;
        }
        let (number, revision) = (open.number, of.revision);
        let outlines = of.editing.shared();
        let (habits, spread) = (of.by().habits, of.by().spread);
        let field = open.fragments.field.as_ref().filter(|(of, _)| *of == photo);
        let field = field.map(|(_, field)| field.clone());
        let flight = open.flight().clone();
        let reviewed = open.review.photo(photo);
        let scale = reviewed.and_then(|photo| delineation::photo::scale_error(&photo));
        let doubts = Doubts::of(habits, scale);
        let work = move |progress: &Progress| {
            progress.stage("measuring");
            let mut labels = outlines.labels().clone();
            // What she changes meanwhile need not be copied for this.
            drop(outlines);
            let posed = &flight.parts().photos[photo];
            let field: Arc<ScaleField> = match field {
                Some(field) => field,
                None => Arc::new(delineation::photo::field(&flight, posed, progress)?),
            };
            let camera = flight.camera(posed);
            let taken_off =
                delineation::photo::take_off_objects(&mut labels, &settings, posed, camera);
            let (shape, unit) = (SieveShape::Calibrated, flight.parts().unit);
            let measured =
                delineation::photo::fragments(&labels, &field, shape, habits, spread, unit);
            let steps = Steps::of(habits);
            let by_mass = by_mass([(&measured, steps)]);
            let percents = SizeInterval::PERCENTS;
            let intervals = intervals(&[(&measured, steps)], doubts, &percents).unwrap_or_default();
            let coarse = by_mass.as_ref().ok();
            let coarse = coarse.and_then(|of| coarse_end_not_shown(of, &intervals));
            let notes = (taken_off.note.into_iter())
                .chain(measured.notes(&labels, habits.is_some()))
                .chain(coarse);
            let measured = MeasuredFragments {
                notes: notes.collect(),
                without: objects,
                on_objects: taken_off.gone,
                photo: measured,
                by_mass,
                intervals,
            };
            Ok((field, measured))
        };
        self.start_wished(
            Task::MEASURE_FRAGMENTS,
            wish,
            work,
            move |state, (field, measured)| {
                if let Some(open) = &mut state.open
                    && open.number == number
                {
                    open.fragments.field = Some((photo, field));
                    if let Some(of) = open.fragments.photos.get_mut(&photo) {
                        of.take_measured(revision, measured);
                    }
                }
                // Changed meanwhile, or another photo: that one is next.
                state.measure_fragments();
            },
        );
    }

    /// Takes the size distribution of the selected photo over to its page.
    pub(super) fn take_fragments_distribution(&mut self) {
        let source = self.fragments_source();
        self.take_source(source);
    }

    /// Takes curves over to their page, or says why there are none.
    pub(super) fn take_source(&mut self, source: Result<Source, Fault>) {
        match source {
            Ok(source) => {
                self.take_distribution(source);
                self.page = Page::SizeDistributions;
            }
            Err(fault) => self.say(Severity::Error, &fault.to_string()),
        }
    }

    /// The curve as the table that the command writes, read as any other.
    fn fragments_source(&self) -> Result<Source, Fault> {
        let nothing = || Fault::new("nothing is measured yet", "wait until it is");
        let open = self.open.as_ref().ok_or_else(nothing)?;
        let photo = open.selected.ok_or_else(nothing)?;
        let of = open.fragments.of(photo).ok_or_else(nothing)?;
        let measured = of.measured().ok_or_else(nothing)?;
        let by_mass = measured.by_mass.as_ref().map_err(Clone::clone)?;
        let method = format!("fragscale ({})", of.by().engine);
        let (world, unit) = (open.flight().parts().unit, self.preferences.unit());
        let name = open.name(photo);
        let table = exports::curves_csv(&method, &[(name, by_mass)], world, unit);
        let table = table.map_err(|error| Fault::new(error.to_string(), "report this"))?;
        let (set, warnings) = formats::size_distributions(&table, &DistributionColumns::default())?;
        Ok(Source {
            name: format!(
                "Fragments of {name}, {} ({})",
                open.flight().parts().name,
                of.by().engine
            ),
            path: None,
            set,
            warnings,
            fragments: Some(OfFragments {
                flight: open.files.origin.file().to_owned(),
                photo: Some(photo),
                made_of: open.fragments_made_of().of_photo(photo, open.name(photo)),
            }),
        })
    }

    /// Whether a curve is of outlines, or of a unit, that the flight on the screen does not have any more; of another flight's nothing
    /// is known.
    pub fn is_outdated(&self, source: &Source) -> bool {
        let (Some(made_of), Some(open)) = (&source.fragments, &self.open) else {
            return false;
        };
        if made_of.flight != open.files.origin.file() {
            return false;
        }
        match made_of.photo {
            // Outlines that are not on the screen are as they were.
            Some(photo) if open.fragments.of(photo).is_none() => false,
            Some(photo) => {
                let now = open.fragments_made_of();
                now.of_photo(photo, open.name(photo)) != made_of.made_of
            }
            None => open.fragments_made_of() != made_of.made_of,
        }
    }
}

/// The scale objects of a photo that are taken off its outlines.
fn objects_in(settings: &FlightSettings, photo: &str) -> Vec<ScaleObject> {
    let objects = settings.scale_objects.iter();
    let masked = objects.filter(|object| object.photo == photo && object.mask);
    masked.cloned().collect()
}
