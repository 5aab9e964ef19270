//! Writing the figure, the report and the table of the size distributions.

use std::path::Path;

use super::DistributionCommand;
use super::computing::Computed;
use crate::command::{Command, Destination};
use crate::exports::{self, ComparisonReport, FigureContents, FigureFormat, FittedDistribution};
use crate::fault::Fault;
use crate::files::{self, Kind};
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Writing the figure or report of size distributions.
    pub const SAVE_DISTRIBUTIONS: Self = Self::new("Writing").writing();
}

impl State {
    /// Writes the figure; asks before a file is replaced.
    pub(super) fn save_figure(&mut self, to: Destination) {
        if self.may_save(&to, DistributionCommand::SaveFigure) {
            self.write(to, |computed, path| {
                FigureFormat::of(path)?.bytes(&contents(computed))
            });
        }
    }

    /// Writes the report; asks before a file is replaced.
    pub(super) fn save_report(&mut self, to: Destination) {
        if self.may_save(&to, DistributionCommand::SaveReport) {
            self.write(to, |computed, _| report(computed).map(String::into_bytes));
        }
    }

    /// Writes all curves as they were read; asks before a file is replaced.
    pub(super) fn save_table(&mut self, to: Destination) {
        self.asking = None;
        if self.is_busy(Task::SAVE_DISTRIBUTIONS) {
            return;
        }
        let command = |to| Command::Distributions(DistributionCommand::SaveTable(to));
        if !self.may_write(&to, Kind::Result, &self.read(), command) {
            return;
        }
        let (sources, read) = (self.distributions.sources().to_vec(), self.read());
        let work = move |_: &Progress| {
            let sets: Vec<_> = sources.iter().map(|source| &source.set).collect();
            let Destination { path, replace } = to;
            let no_memory =
                |error| Fault::new(format!("it cannot be made ({error})"), "free memory");
            let written = exports::points_of_curves_csv(&sets)
                .map_err(no_memory)
                .and_then(|text| {
                    files::write(&path, text.as_bytes(), Kind::Result, &read, replace)
                });
            match written {
                Ok(()) => Ok((path, sources)),
                Err(fault) => Err(FileError::new(&path, fault).to_string()),
            }
        };
        self.start(Task::SAVE_DISTRIBUTIONS, work, |state, written| {
            let path = written.map(|(path, sources)| {
                state.distributions.saved = sources;
                path
            });
            state.take_written(path);
        });
    }

    /// Whether the file can be written now; else asks, or says why not.
    fn may_save(
        &mut self,
        to: &Destination,
        command: impl FnOnce(Destination) -> DistributionCommand,
    ) -> bool {
        self.asking = None;
        if self.is_busy(Task::SAVE_DISTRIBUTIONS) {
            return false;
        }
        if !self.distributions.is_current() || self.distributions.computed.is_none() {
            let text = "the fits are still being computed; write when they are there";
            self.say(Severity::Error, text);
            return false;
        }
        let command = |to| Command::Distributions(command(to));
        self.may_write(to, Kind::Result, &self.read(), command)
    }

    fn write(
        &mut self,
        to: Destination,
        bytes: impl FnOnce(&Computed, &Path) -> Result<Vec<u8>, Fault> + Send + 'static,
    ) {
        let Some(computed) = self.distributions.computed.clone() else {
            return;
        };
        let read = self.read();
        let work = move |progress: &Progress| {
            progress.stage("drawing and writing");
            let Destination { path, replace } = to;
            let written = bytes(&computed, &path)
                .and_then(|bytes| files::write(&path, &bytes, Kind::Result, &read, replace));
            match written {
                Ok(()) => Ok(path),
                Err(fault) => Err(FileError::new(&path, fault).to_string()),
            }
        };
        self.start(Task::SAVE_DISTRIBUTIONS, work, Self::take_written);
    }
}

/// The figure of the comparison, or of the fits where nothing is compared.
fn contents(computed: &Computed) -> FigureContents {
    let analysis = &computed.analysis;
    if let Ok(comparison) = &analysis.comparison {
        return exports::figure_of_comparison(comparison);
    }
    let fits = computed.fits.iter().map(|fitted| &fitted.fit);
    let fitted = FittedDistribution::of(&analysis.trials, fits);
    let title = computed.edit.settings.model.name();
    exports::figure_of_fits(title, analysis.trials.unit, &fitted)
}

fn report(computed: &Computed) -> Result<String, Fault> {
    let sources = &computed.edit.sources;
    let names: Vec<String> = sources.iter().map(|source| source.name.clone()).collect();
    let mended = sources.iter().flat_map(|source| {
        let named = |warning| format!("{}: {warning}", source.name);
        source.warnings.iter().map(named)
    });
    let report = ComparisonReport::of(&names, mended.collect(), &computed.analysis)?;
    Ok(exports::comparison_report(&report))
}
