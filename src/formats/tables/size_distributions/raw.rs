//! Curves as a table gives them.

use super::names::RetainedName;
use super::size_text::SizeText;
use crate::fragmentation::Labels;

/// A point as the table gives it.
#[derive(Debug, Clone, Copy)]
pub(super) struct RawPoint {
    pub(super) line: u64,
    pub(super) size: SizeText,
    pub(super) percent: f64,
    /// Whether a percent sign stands behind it.
    pub(super) percent_sign: bool,
}

/// A curve as the table gives it.
#[derive(Debug, Clone)]
pub(super) struct RawCurve {
    pub(super) labels: Labels,
    pub(super) weight: Option<f64>,
    /// Where it begins.
    pub(super) line: u64,
    pub(super) points: Vec<RawPoint>,
    /// Where its points are of what stays on sieves, what else is said of that.
    pub(super) sieves: Option<OnSieves>,
}

/// What stays on sieves, beside the points of its curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct OnSieves {
    pub(super) what: RetainedName,
    /// In the line of the pan.
    pub(super) pan: Option<f64>,
    /// In the line of what was washed out.
    pub(super) washed: Option<f64>,
    /// In the line of the total.
    pub(super) total: Option<f64>,
    /// What one of the last digit shown there is; 0 where nobody knows.
    pub(super) total_digit: f64,
}
