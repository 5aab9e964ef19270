//! Applies what is done on the page of size distributions.

use std::sync::Arc;

use super::computing::{Computed, compute};
use super::{DistributionCommand, Edit};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::state::history::History;
use crate::state::{Severity, State};
use crate::tasks::Task;

impl Task {
    /// Fitting and comparing size distributions.
    pub const FITS: Self = Self::new("Fitting");
}

impl State {
    /// Does what a command of the page says.
    pub(crate) fn apply_to_distributions(&mut self, command: DistributionCommand) {
        let now = self.distributions.history.now().clone();
        match command {
            DistributionCommand::Add(paths) => self.read_distributions(paths),
            DistributionCommand::AddKnown => match self.known_fragments() {
                Some(path) => self.read_distributions(vec![path]),
                None => self.say(
                    Severity::Error,
                    "the flight on the screen has no reference.csv beside its flight.toml",
                ),
            },
            DistributionCommand::FillPaste(form) => {
                self.distributions.paste = form;
                self.distributions.paste.refused = None;
            }
            DistributionCommand::Paste => self.read_pasted(),
            DistributionCommand::Remove(place) => {
                let mut edit = now;
                if place < edit.sources.len() {
                    edit.sources.remove(place);
                    self.edit_distributions(edit);
                }
            }
            DistributionCommand::RemoveAll => self.edit_distributions(Edit {
                sources: Vec::new(),
                ..now
            }),
            DistributionCommand::Set(settings) => {
                let mut edit = now;
                edit.settings = settings;
                self.edit_distributions(edit);
            }
            DistributionCommand::Compute => self.start_computing(),
            DistributionCommand::Show(curves, shown) => {
                for labels in curves {
                    if shown {
                        self.distributions.hidden.remove(&labels);
                    } else {
                        self.distributions.hidden.insert(labels);
                    }
                }
            }
            DistributionCommand::Plot(plot) => self.distributions.plot = plot,
            DistributionCommand::Tab(tab) => self.distributions.tab = tab,
            DistributionCommand::AddEffort(path) => self.read_effort(path),
            DistributionCommand::RemoveEffort => self.distributions.effort = None,
            DistributionCommand::SaveFigure(to) => self.save_figure(to),
            DistributionCommand::SaveReport(to) => self.save_report(to),
            DistributionCommand::SaveTable(to) => self.save_table(to),
        }
    }

    /// A step that can be undone.
    pub(super) fn edit_distributions(&mut self, edit: Edit) {
        let before = self.distributions.history.now().clone();
        self.distributions.history.set(edit);
        self.distributions_changed(&before);
    }

    /// Undo and redo on this page.
    pub(crate) fn undo_distributions(&mut self, go: impl FnOnce(&mut History<Edit>) -> bool) {
        let before = self.distributions.history.now().clone();
        if go(&mut self.distributions.history) {
            self.distributions_changed(&before);
        }
    }

    fn distributions_changed(&mut self, before: &Edit) {
        if self.distributions.history.now() != before {
            self.distributions.edition += 1;
            self.start_computing();
        }
    }

    /// Computes anew what depends on the data and settings of now.
    fn start_computing(&mut self) {
        self.distributions.problem = None;
        if self.distributions.sources().is_empty() {
            self.work.cancel(Task::FITS);
            self.distributions.computed = None;
            return;
        }
        let edit = self.distributions.history.now().clone();
        let edition = self.distributions.edition;
        let work = move |progress: &Progress| compute(edition, edit, progress);
        self.start(Task::FITS, work, Self::take_fitted);
    }

    /// Takes what was computed; a result that is outdated was cancelled before.
    fn take_fitted(&mut self, result: Result<Computed, Fault>) {
        match result {
            Ok(computed) => self.distributions.computed = Some(Arc::new(computed)),
            Err(fault) => {
                self.distributions.problem = Some(fault.to_string());
                self.say(Severity::Error, &fault.to_string());
            }
        }
    }
}
