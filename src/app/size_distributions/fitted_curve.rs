//! The function fitted to a curve.

use crate::fault::Fault;
use crate::fragmentation::{Fit, Labels, Percentile};

/// The function fitted to a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedCurve {
    /// What the curve is of.
    pub labels: Labels,
    /// The fit, or why there is none.
    pub fit: Result<Fit, Fault>,
    /// Of `PERCENTILES`, with their bands; empty without a fit.
    pub percentiles: Vec<Percentile>,
}
