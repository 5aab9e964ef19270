//! Lines at round coordinates, and what is written at them.

use glam::DVec2;

use super::MapFrame;
use crate::numbers::round_down;

/// About how many units of the drawing lie between lines.
const APART: f64 = 110.0;

/// No frame has more lines each way: what is larger is no drawing that somebody reads.
const MOST: f64 = 500.0;

/// The grid of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Between lines, world units: 1, 2 or 5 times a power of ten.
    pub step: f64,
    /// Lines of one x, from the west.
    pub across: Vec<GridLine>,
    /// Lines of one y, from the south.
    pub up: Vec<GridLine>,
}

/// One of them.
#[derive(Debug, Clone, PartialEq)]
pub struct GridLine {
    /// x or y, world units.
    pub at: f64,
    /// The same with as many decimals as its step has.
    pub label: String,
}

impl Grid {
    /// Of what a frame shows.
    pub fn of(frame: &MapFrame) -> Self {
        let [min, max] = frame.bounds();
        let step = round_down(APART / frame.scale).filter(|step| {
            let size = (max - min) / *step;
            size.is_finite() && size.max_element() < MOST
        });
        let Some(step) = step else {
            return Self {
                step: 0.0,
                across: Vec::new(),
                up: Vec::new(),
            };
        };
        let decimals = (-step.log10().floor()).clamp(0.0, 9.0) as usize;
        let lines = |from: f64, to: f64| {
            let (first, last) = ((from / step).ceil(), (to / step).floor());
            let count = (last - first + 1.0).max(0.0) as u32;
            let line = |index: u32| {
                // + 0.0: no minus zero.
                let at = (first + f64::from(index)) * step + 0.0;
                GridLine {
                    at,
                    label: format!("{at:.decimals$}"),
                }
            };
            (0..count).map(line).collect()
        };
        let (DVec2 { x: west, y: south }, DVec2 { x: east, y: north }) = (min, max);
        Self {
            step,
            across: lines(west, east),
            up: lines(south, north),
        }
    }
}
