//! What the outlines of all photos come to together, measured when she asks for it: what the export writes as "all photos".

use std::collections::BTreeSet;
use std::sync::Arc;

use super::AllMeasured;
use super::outlined::{AllOutlined, Outlined, measured_each, sizes_of};
use crate::delineation::measures::SieveShape;
use crate::delineation::{OutlinedBy, photo};
use crate::exports::{self, MeasuredPhoto};
use crate::fault::Fault;
use crate::flight::{Flight, FlightSettings, LookedUp};
use crate::formats::{self, DistributionColumns};
use crate::jobs::Progress;
use crate::picture::edge_spread;
use crate::size_distributions::{MadeOf, OfFragments, Source};
use crate::state::{Severity, State};
use crate::tasks::Task;
use crate::units::LengthUnit;

impl Task {
    /// Measuring the fragments of all photos.
    pub const MEASURE_ALL: Self = Self::new("Measuring the fragments of all photos").of_flight();
}

/// All that the job needs.
struct Measuring {
    all: AllOutlined,
    made_of: MadeOf,
    flight: Arc<Flight>,
    looked_up: LookedUp,
    settings: FlightSettings,
    /// Of the curves.
    unit: LengthUnit,
}

impl State {
    /// Measures them.
    pub(super) fn measure_all_fragments(&mut self) {
        let Some(open) = &self.open else {
            return;
        };
        let all = match open.all_outlined() {
            Ok(all) => all,
            Err(refused) => {
                self.say(Severity::Error, &refused);
                return;
            }
        };
        let number = open.number;
        let measuring = Measuring {
            all,
            made_of: open.fragments_made_of(),
            flight: open.flight().clone(),
            looked_up: open.review.looked_up().clone(),
            settings: open.settings(),
            unit: self.preferences.unit(),
        };
        let work = move |progress: &Progress| measuring.measured(progress);
        self.start(Task::MEASURE_ALL, work, move |state, measured| {
            match (measured, &mut state.open) {
                (Ok(measured), Some(open)) if open.number == number => {
                    open.fragments.all = Some(measured);
                }
                (Err(why), Some(open)) if open.number == number => {
                    state.say(Severity::Error, &why);
                }
                _ => {}
            }
        });
    }

    /// Takes the curves of all photos over to the page of size distributions.
    pub(super) fn take_all_distributions(&mut self) {
        let source = self.source_of_all();
        self.take_source(source);
    }

    fn source_of_all(&self) -> Result<Source, Fault> {
        let nothing = || Fault::new("nothing is measured yet", "press 'Measure all photos'");
        let open = self.open.as_ref().ok_or_else(nothing)?;
        let all = open.fragments.all.as_ref().ok_or_else(nothing)?;
        let columns = DistributionColumns::default();
        let (set, warnings) = formats::size_distributions(&all.curves, &columns)?;
        Ok(Source {
            name: format!("Fragments of {}", open.flight().parts().name),
            path: None,
            set,
            warnings,
            fragments: Some(OfFragments {
                flight: open.files.origin.file().to_owned(),
                photo: None,
                made_of: all.made_of.clone(),
            }),
        })
    }
}

impl Measuring {
    fn measured(self, progress: &Progress) -> Result<AllMeasured, String> {
        let in_words = |fault: Fault| fault.to_string();
        let mut engines = BTreeSet::new();
        let (measured, said) = measured_each(&self.all.outlined, progress, |of| {
            let (photo, notes, engine) = self.photo(of, progress)?;
            engines.insert(match engine.is_empty() {
                true => "saved".to_owned(),
                false => engine,
            });
            Ok((photo, notes))
        })?;
        let sizes = sizes_of(&measured, &self.flight, &self.looked_up, progress)?;
        let mut notes = self.all.warnings.clone();
        notes.extend(said);
        notes.extend(sizes.warnings());
        let engines: Vec<String> = engines.into_iter().collect();
        let engines = engines.join(" and ");
        let units = [self.flight.parts().unit, self.unit];
        Ok(AllMeasured {
            made_of: self.made_of,
            photos: [measured.len(), self.all.of],
            curves: exports::distribution_csv(&engines, &sizes, units).map_err(in_words)?,
            sizes: sizes.into_all(),
            notes,
        })
    }

    /// A photo's fragments; with what is to be said of its outlines, and what outlined them.
    fn photo<'a>(
        &self,
        of: &'a Outlined,
        progress: &Progress,
    ) -> Result<(MeasuredPhoto<'a>, Vec<String>, String), String> {
        let failed = |fault: Fault| of.failed(&fault);
        let parts = self.flight.parts();
        let posed = &parts.photos[of.index];
        let camera = self.flight.camera(posed);
        let (labels, by, mut notes) = of.labels(&self.settings, posed, camera)?;
        let spread = match by.spread {
            Some(spread) => Some(spread),
            None => edge_spread(&of.pixels(camera)?),
        };
        let field = photo::field(&self.flight, posed, progress).map_err(failed)?;
        let (shape, habits) = (SieveShape::Calibrated, by.habits);
        let fragments = photo::fragments(&labels, &field, shape, habits, spread, parts.unit);
        notes.extend(fragments.notes(&labels, habits.is_some()));
        let measured = MeasuredPhoto {
            photo: &of.name,
            fragments,
            outlined: OutlinedBy::Saved(habits),
            spread,
            index: of.index,
            stem: &of.stem,
        };
        Ok((measured, notes, by.engine))
    }
}
