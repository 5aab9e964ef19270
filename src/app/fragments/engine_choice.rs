//! Which engine outlines next: one that the program brings along, or the network that she named last.

use std::sync::Arc;

use crate::delineation::{ENGINES, Engine, NamedModel, ReadyEngine};

/// An engine to outline with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EngineChoice {
    /// One that the program brings along, by its place in `ENGINES`.
    BroughtAlong(usize),
    /// The network that she named last.
    Named,
}

impl Default for EngineChoice {
    fn default() -> Self {
        Self::BroughtAlong(0)
    }
}

/// The network that she named last; it stays while flights come and go.
#[derive(Debug, Default)]
pub struct Network {
    pub(super) model: Option<Arc<NamedModel>>,
    /// Why the one that she named then was not taken.
    pub refused: Option<String>,
}

impl Network {
    /// All that can be chosen.
    pub fn choices(&self) -> impl Iterator<Item = EngineChoice> {
        let own = (0..ENGINES.len()).map(EngineChoice::BroughtAlong);
        own.chain(self.model.is_some().then_some(EngineChoice::Named))
    }

    /// The choice itself, or the first one where it was a network that is not there.
    pub fn known(&self, choice: EngineChoice) -> EngineChoice {
        match choice {
            EngineChoice::Named if self.model.is_none() => EngineChoice::default(),
            choice => choice,
        }
    }

    /// What is chosen.
    pub fn engine(&self, choice: EngineChoice) -> Option<ReadyEngine> {
        match self.known(choice) {
            EngineChoice::Named => self.model.clone().map(ReadyEngine::Named),
            EngineChoice::BroughtAlong(place) => {
                ENGINES.get(place).copied().map(ReadyEngine::BroughtAlong)
            }
        }
    }

    /// What that is called.
    pub fn name(&self, choice: EngineChoice) -> &str {
        match self.known(choice) {
            EngineChoice::Named => self.model.as_ref().map_or("", |model| model.name()),
            EngineChoice::BroughtAlong(place) => {
                ENGINES.get(place).map_or("", |engine| engine.name())
            }
        }
    }
}
