//! The clipping box: what of the surface is seen and met by the mouse. Scales never depend on it.

use glam::DVec3;

use crate::geometry::{Bounds, LevelBox};
use crate::open_flight::OpenFlight;
use crate::scale::FootprintPoint;
use crate::state::history::History;

/// The box of a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clip {
    /// Whether its small window is shown.
    pub is_open: bool,
    /// Whether it clips.
    pub is_on: bool,
    /// Its limits.
    pub level: LevelBox,
}

impl Clip {
    /// Around the surface without its outliers; it is off.
    pub(crate) fn around(bulk: &Bounds) -> Self {
        let fitted = bulk.widened(bulk.size().length() * 1e-3 + f64::MIN_POSITIVE);
        Self {
            is_open: false,
            is_on: false,
            level: LevelBox::of(&fitted),
        }
    }

    /// The box, where it clips.
    pub fn clipping(&self) -> Option<LevelBox> {
        self.is_on.then_some(self.level)
    }
}

/// Something to do with the clipping box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ClipStep {
    /// Shows its small window and clips; where it clips or is shown, puts both away.
    Toggle,
    /// Puts its small window away; what it clips stays.
    Close,
    /// The limits of now are a step that undo goes back over: a drag is one.
    Settle,
    /// Clips or not.
    On(bool),
    /// Takes these limits.
    Set(LevelBox),
    /// Around the surface without its outliers.
    Fit,
    /// Around the footprint of the selected photo, over all heights.
    ToFootprint,
}

impl OpenFlight {
    /// Does something with the clipping box.
    pub(crate) fn clip_step(&mut self, step: ClipStep) {
        match step {
            ClipStep::Toggle => {
                let is_there = self.clip.is_open || self.clip.is_on;
                (self.clip.is_open, self.clip.is_on) = (!is_there, !is_there);
            }
            ClipStep::Close => self.clip.is_open = false,
            ClipStep::Settle => self.clip_history.set(self.clip.level),
            ClipStep::On(on) => self.clip.is_on = on,
            ClipStep::Set(level) if level.is_box() => self.clip.level = level,
            ClipStep::Set(_) => {}
            ClipStep::Fit => self.clip.level = Clip::around(&self.extent.bulk).level,
            ClipStep::ToFootprint => {
                if let Some(level) = self.around_footprint() {
                    self.clip.level = level;
                }
            }
        }
    }

    /// Undo or redo of the box's limits, while its small window is shown; false where there is nothing to undo.
    pub(crate) fn undo_clip(&mut self, step: impl FnOnce(&mut History<LevelBox>) -> bool) -> bool {
        let undone = self.clip.is_open && step(&mut self.clip_history);
        if undone {
            self.clip.level = *self.clip_history.now();
        }
        undone
    }

    /// The box around the footprint of the selected photo; `None` where it has none.
    pub fn around_footprint(&self) -> Option<LevelBox> {
        let outline = &self.view(self.selected?)?.footprint.outline;
        let point = |point: &FootprintPoint| point.outcome.point();
        let points: Vec<DVec3> = outline.iter().filter_map(point).collect();
        let around = self.clip.level.around(&points);
        let (low, high) = (self.extent.surface.min.z, self.extent.surface.max.z);
        let more = (high - low) * 1e-3;
        let level = LevelBox {
            low: around.low.with_z(low - more),
            high: around.high.with_z(high + more),
            ..around
        };
        (!points.is_empty() && level.is_box()).then_some(level)
    }
}
