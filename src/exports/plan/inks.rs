//! Colours and dashes: verdicts are told apart by both.

use crate::drawing::{Colour, Dash};
use crate::flight::Verdict;

/// What a plan is drawn with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PlanInks {
    /// Behind everything, and behind names.
    pub paper: [u8; 3],
    /// Words and frames.
    pub ink: [u8; 3],
    /// Lines of the grid.
    pub grid: [u8; 3],
    /// Of the verdicts in their order, and of what is not settled.
    verdicts: [Colour; 6],
}

impl PlanInks {
    /// For paper: dark on the grey of a lit surface.
    pub const PAPER: Self = Self {
        paper: [255; 3],
        ink: [34; 3],
        grid: [150; 3],
        verdicts: [
            [0, 110, 45],
            [0, 85, 150],
            [178, 74, 0],
            [70, 70, 70],
            [185, 15, 40],
            [80, 60, 120],
        ],
    };

    /// For a dark window, whose ground is darkened.
    pub const DARK: Self = Self {
        paper: [24, 26, 30],
        ink: [225; 3],
        grid: [110; 3],
        verdicts: [
            [110, 220, 140],
            [100, 205, 245],
            [255, 190, 80],
            [190, 190, 190],
            [255, 120, 120],
            [200, 180, 245],
        ],
    };

    /// The colour of a photo's lines.
    pub fn of(&self, verdict: Option<Verdict>) -> [u8; 3] {
        let place = verdict.and_then(|v| Verdict::ALL.iter().position(|known| *known == v));
        self.verdicts[place.unwrap_or(Verdict::ALL.len())]
    }
}

/// The dash of a photo's lines: whoever sees no colours, or prints in grey, has this.
pub(crate) fn dash(verdict: Option<Verdict>) -> Dash {
    match verdict {
        Some(Verdict::Trust | Verdict::Accepted) => Dash::Solid,
        Some(Verdict::Check) => Dash::Long,
        Some(Verdict::NoScale) => Dash::Short,
        Some(Verdict::LeftOut) | None => Dash::DashDot,
    }
}
