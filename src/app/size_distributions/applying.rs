//! Applies what is done on the page of size distributions.

use super::{DistributionCommand, Edit};
use crate::command::Command;
use crate::state::{Severity, State};

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
            DistributionCommand::SaveFigure(path) => self.save_figure(path),
            DistributionCommand::SaveReport(path) => self.save_report(path),
        }
    }

    /// A step that can be undone.
    pub(super) fn edit_distributions(&mut self, edit: Edit) {
        let before = self.distributions.history.now().clone();
        self.distributions.history.set(edit);
        self.distributions_changed(&before);
    }

    /// Undo and redo on this page.
    pub(crate) fn undo_distributions(&mut self, command: &Command) {
        let before = self.distributions.history.now().clone();
        let moved = match command {
            Command::Undo => self.distributions.history.undo(),
            _ => self.distributions.history.redo(),
        };
        if moved {
            self.distributions_changed(&before);
        }
    }

    fn distributions_changed(&mut self, before: &Edit) {
        if self.distributions.history.now() != before {
            self.distributions.edition += 1;
            self.start_computing();
        }
    }
}
