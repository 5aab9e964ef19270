//! A graphics card that computes: descriptors are compared and depths are found on it. What it cannot do, or not any
//! more, the processor does, and it is said.

use std::ffi::OsStr;
use std::fs::{self, ReadDir};
use std::path::Path;
use std::sync::{Arc, OnceLock};

use fragscale_render::Gpu;

use crate::dense::{Backend, Cpu, Gpu as Stereo, Planes, Problem, Sweep};
use crate::fault::Fault;
use crate::jobs::Progress;

/// A graphics card, and why it stopped where it did. Clones are one card.
#[derive(Debug, Clone)]
pub struct Card {
    gpu: Gpu,
    failed: Arc<OnceLock<Fault>>,
}

impl Card {
    /// This computer's. `None` where it has none but a driver that draws on the processor: what we write for the
    /// processor is faster than what such a driver makes of what we write for cards.
    pub fn found() -> Option<Self> {
        if !may_have_one() {
            return None;
        }
        let gpu = Gpu::fastest().ok()?;
        (!gpu.software).then(|| Self::on(gpu))
    }

    /// This device.
    pub fn on(gpu: Gpu) -> Self {
        Self {
            gpu,
            failed: Arc::default(),
        }
    }

    /// What is to be said of it: what it was used for, or why it stopped.
    pub(crate) fn said(&self) -> Result<String, String> {
        let name = &self.gpu.name;
        match self.failed.get() {
            None => Ok(format!("computed on {name}")),
            Some(fault) => Err(format!(
                "the graphics card {name} stopped, and the processor went on: {}",
                fault.what
            )),
        }
    }

    /// What `work` makes of the card; `None` where it failed now or before.
    pub(crate) fn try_on<T>(&self, work: impl FnOnce(&Gpu) -> Result<T, Fault>) -> Option<T> {
        if self.failed.get().is_some() {
            return None;
        }
        match work(&self.gpu) {
            Ok(made) => Some(made),
            Err(fault) => {
                // (Another thread may have said it already.)
                let _ = self.failed.set(fault);
                None
            }
        }
    }
}

/// Whether the system has anything that a driver of a card could talk to: asked first, because drivers take a while
/// to start, and on a server print lines of their own.
fn may_have_one() -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    // NVIDIA's, Windows' own below Linux, and of telephones.
    let devices = ["/dev/nvidia0", "/dev/dxg", "/dev/kgsl-3d0", "/dev/mali0"];
    let renders = |name: &OsStr| name.to_string_lossy().starts_with("renderD");
    let has_node = |folder: ReadDir| folder.flatten().any(|entry| renders(&entry.file_name()));
    devices.iter().any(|device| Path::new(device).exists())
        || fs::read_dir("/dev/dri").is_ok_and(has_node)
}

/// Depths by a card where there is one, else by the processor.
pub(crate) struct CardFirst<'a>(Option<(&'a Card, Stereo)>);

impl<'a> CardFirst<'a> {
    pub(crate) fn new(card: Option<&'a Card>) -> Self {
        let with_stereo = |card: &'a Card| {
            let stereo = card.try_on(|gpu| Stereo::on(gpu.clone()))?;
            Some((card, stereo))
        };
        Self(card.and_then(with_stereo))
    }
}

impl Backend for CardFirst<'_> {
    fn name(&self) -> String {
        match &self.0 {
            Some((card, _)) => card.gpu.name.clone(),
            None => Cpu.name(),
        }
    }

    fn sweep(
        &self,
        problem: &Problem,
        planes: &mut Planes,
        sweeps: &[Sweep],
        progress: &Progress,
    ) -> Result<(), Fault> {
        if let Some((card, stereo)) = &self.0 {
            let mut found = planes.clone();
            let work = |_: &Gpu| stereo.sweep(problem, &mut found, sweeps, progress);
            let done = card.try_on(work);
            if progress.is_cancelled() {
                return progress.advance(0, 1);
            }
            if done.is_some() {
                *planes = found;
                return Ok(());
            }
        }
        Cpu.sweep(problem, planes, sweeps, progress)
    }
}
