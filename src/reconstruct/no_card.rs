//! Built without graphics: there is no card, and the processor does all.

use crate::dense::{Backend, Cpu, Planes, Problem, Sweep};
use crate::fault::Fault;
use crate::jobs::Progress;

/// A graphics card, of which this build knows none.
#[derive(Debug, Clone)]
pub enum Card {}

impl Card {
    /// This computer's: `None`.
    pub fn found() -> Option<Self> {
        None
    }

    /// What is to be said of it.
    pub(crate) fn said(&self) -> Result<String, String> {
        match *self {}
    }
}

/// Depths by the processor.
pub(crate) struct CardFirst;

impl CardFirst {
    pub(crate) fn new(_: Option<&Card>) -> Self {
        Self
    }
}

impl Backend for CardFirst {
    fn name(&self) -> String {
        Cpu.name()
    }

    fn sweep(
        &self,
        problem: &Problem,
        planes: &mut Planes,
        sweeps: &[Sweep],
        progress: &Progress,
    ) -> Result<(), Fault> {
        Cpu.sweep(problem, planes, sweeps, progress)
    }
}
