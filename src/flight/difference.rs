//! Where the four-corner scale and the best line differ by more than the corners' interval, and why.

use std::fmt;

use super::PhotoReview;
use crate::scale::{CornerOutcome, EdgeScales};

/// A smaller difference is written as none.
const LEAST_PERCENT: f64 = 0.05;

/// How the corners' scale differs from the best line, at the end where it differs most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// The corners' scale over the line's, less 1, percent.
    pub percent: f64,
    /// Whether that is at the top edge.
    pub at_top: bool,
    /// The likeliest reason.
    pub why: DifferenceReason,
}

/// Why corners and line differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DifferenceReason {
    /// A corner of the edge was taken on the ground.
    Ground,
    /// A corner of the edge lies over a hole of the cloud.
    Hole,
    /// The pile stands above or below its corners.
    Relief,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            percent, at_top, ..
        } = self;
        let edge = if *at_top { "top" } else { "bottom" };
        let more = if *percent < 0.0 { "smaller" } else { "larger" };
        let why = match self.why {
            DifferenceReason::Ground => "a corner was taken on the ground",
            DifferenceReason::Hole => "a corner lies over a hole of the cloud",
            DifferenceReason::Relief => {
                "relief, the corners do not lie where the pile between them does"
            }
        };
        write!(
            f,
            "the corners' {edge} scale is {:.1} % {more} than the best line's: {why}",
            percent.abs()
        )
    }
}

impl PhotoReview<'_> {
    /// How its corners' scale differs from the best line; `None` where by no more than the corners'
    /// interval, or where one of them is not known.
    pub fn difference(&self) -> Option<Difference> {
        let field = self.field?;
        let (line, uncertainty) = (field.fitted?, field.uncertainty.as_ref());
        let EdgeScales { top, bottom, .. } = self.scale()?.scale;
        let ends = [
            (true, top, line.top, uncertainty.and_then(|u| u.top)),
            (
                false,
                bottom,
                line.bottom,
                uncertainty.and_then(|u| u.bottom),
            ),
        ];
        let differing = ends
            .into_iter()
            .filter_map(|(at_top, corners, line, interval)| {
                let percent = (corners? / line - 1.0) * 100.0;
                // Without an interval (a corner on the ground) by anything that one would see.
                let within = match interval {
                    Some(ends) => (ends.low..=ends.high).contains(&line),
                    None => percent.abs() < 0.5,
                };
                // Of a plane the interval has no width, and what is left is how numbers are rounded.
                let is_seen = percent.abs() >= LEAST_PERCENT;
                (is_seen && !within).then_some((at_top, percent))
            });
        let (at_top, percent) = differing.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
        Some(Difference {
            percent,
            at_top,
            why: self.reason(at_top),
        })
    }

    fn reason(&self, at_top: bool) -> DifferenceReason {
        let edge = if at_top { [0, 1] } else { [2, 3] };
        let on_ground = |index: &usize| {
            let corner = self.scale().map(|scale| scale.corners[*index].outcome);
            matches!(corner, Some(CornerOutcome::OnGround { .. }))
        };
        let limit = self
            .view
            .and_then(|view| Some(view.footprint_size? * self.triangle_share));
        let over_hole = |index: &usize| {
            let edge = self.view.and_then(|view| view.triangle_edges[*index]);
            matches!((edge, limit), (Some(edge), Some(limit)) if edge > limit)
        };
        if edge.iter().any(on_ground) {
            DifferenceReason::Ground
        } else if edge.iter().any(over_hole) {
            DifferenceReason::Hole
        } else {
            DifferenceReason::Relief
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_a_sentence() {
        let difference = Difference {
            percent: -4.94,
            at_top: false,
            why: DifferenceReason::Hole,
        };
        assert_eq!(
            difference.to_string(),
            "the corners' bottom scale is 4.9 % smaller than the best line's: a corner lies over a hole of the cloud"
        );
    }
}
