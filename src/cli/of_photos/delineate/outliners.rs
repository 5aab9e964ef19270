//! What outlines the fragments of photos: an engine, or what another tool outlined.

use std::path::PathBuf;

use super::DelineateArguments;
use super::chosen_engine::ChosenEngine;
use crate::cli::outputs::Outputs;
use crate::delineation::{Engine, Learned, ReadyEngine};
use crate::files::Recording;
use crate::opening::{Opened, OutlinesOfOthers};

/// What outlines the fragments: looked at before the flight is opened, so that what is wrong is said at once.
pub(in crate::cli) struct Outliners {
    engine: Option<ReadyEngine>,
    /// The files of the engine.
    pub(super) of_engine: Vec<PathBuf>,
    /// Outlines in place of an engine's.
    pub(super) others: Option<OutlinesOfOthers>,
}

impl Outliners {
    /// Those that are asked for.
    pub(in crate::cli) fn open(arguments: &DelineateArguments) -> Result<Self, String> {
        arguments.mass.check()?;
        let recording = Recording::start();
        let chosen = arguments.engine.as_ref().map(ChosenEngine::open);
        let engine = chosen.transpose()?;
        let of_engine = recording.files();
        drop(recording);
        Ok(Self {
            engine,
            of_engine,
            others: arguments.masks.open()?,
        })
    }

    pub(super) fn engine(&self) -> &dyn Engine {
        self.engine
            .as_ref()
            .map_or(&Learned, |engine| engine.engine())
    }

    /// Where the files go: not over those that are read.
    pub(super) fn outputs<'a>(
        &self,
        arguments: &'a DelineateArguments,
        opened: &Opened,
    ) -> Result<Outputs<'a>, String> {
        let described = arguments.engine.as_ref().and_then(ChosenEngine::file);
        let masks = arguments.masks.masks.as_ref();
        // A folder of outlines may be written into, but not over those that are read.
        let outlines = self.others.iter().flat_map(OutlinesOfOthers::files);
        let inputs = arguments.flight.files().chain(masks).chain(described);
        let inputs = inputs.cloned().chain(arguments.mass.file());
        let mut outputs = Outputs::new(arguments.force, inputs.chain(outlines.cloned()));
        outputs.read(&opened.read)?;
        Ok(outputs)
    }
}
