//! Writing the figure and the report of the size distributions.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::DistributionCommand;
use super::computing::Computed;
use crate::command::Command;
use crate::exports::{self, ComparisonReport, FigureContents, FigureFormat, FittedDistribution};
use crate::fault::Fault;
use crate::files::{self, Kind};
use crate::formats::FileError;
use crate::state::{Severity, State};
use crate::work::{Done, Task};

impl State {
    /// Writes the figure; asks before a file is replaced.
    pub(super) fn save_figure(&mut self, path: PathBuf) {
        let command = DistributionCommand::SaveFigure(path.clone());
        if self.may_save(&path, command) {
            self.start_saving_figure(path, false);
        }
    }

    /// Writes the report; asks before a file is replaced.
    pub(super) fn save_report(&mut self, path: PathBuf) {
        let command = DistributionCommand::SaveReport(path.clone());
        if self.may_save(&path, command) {
            self.start_saving_report(path, false);
        }
    }

    /// Whether the file can be written now; else asks, or says why not.
    fn may_save(&mut self, path: &Path, command: DistributionCommand) -> bool {
        self.asking = None;
        if self.is_busy(Task::SaveDistributions) {
            return false;
        }
        if !self.distributions.is_current() || self.distributions.computed.is_none() {
            let text = "the fits are still being computed; write when they are there";
            self.say(Severity::Error, text);
            return false;
        }
        let command = Command::Distributions(command);
        self.may_write(path, Kind::Result, &self.read(), command)
    }

    /// Goes on once a file may be replaced.
    pub(crate) fn replace_distributions(&mut self, command: DistributionCommand) {
        match command {
            DistributionCommand::SaveFigure(path) => self.start_saving_figure(path, true),
            DistributionCommand::SaveReport(path) => self.start_saving_report(path, true),
            _ => {}
        }
    }

    fn start_saving_figure(&mut self, path: PathBuf, replace: bool) {
        self.write(path, replace, |computed, path| {
            FigureFormat::of(path)?.bytes(&contents(computed))
        });
    }

    fn start_saving_report(&mut self, path: PathBuf, replace: bool) {
        self.write(path, replace, |computed, _| {
            report(computed).map(String::into_bytes)
        });
    }

    fn write(
        &mut self,
        path: PathBuf,
        replace: bool,
        bytes: impl FnOnce(&Computed, &Path) -> Result<Vec<u8>, Fault> + Send + 'static,
    ) {
        let Some(computed) = self.distributions.computed.clone() else {
            return;
        };
        let read = self.read();
        self.start(Task::SaveDistributions, move |progress| {
            progress.stage("drawing and writing");
            let computed: Arc<Computed> = computed;
            let written = bytes(&computed, &path)
                .and_then(|bytes| files::write(&path, &bytes, Kind::Result, &read, replace));
            Done::SavedDistributions(match written {
                Ok(()) => Ok(path),
                Err(fault) => Err(FileError::new(&path, fault).to_string()),
            })
        });
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
