//! Methods against the reference: residuals, norms of fitted curves, envelopes, shifts.
//!
//! ```text
//! method_curve   the mean of a method's trials, its spread, the function fitted to it
//! residuals      percent error of the passing at each size
//! curve_norm     distance of two fitted functions over the whole curve
//! percentiles    shifts of the Pxx and the envelope of the sizes
//! ```

mod curve_norm;
mod method_curve;
mod percentiles;
mod residuals;

pub use curve_norm::{CurveNorm, Improvement, Span};
pub use method_curve::{MeanPoint, MethodCurve};
pub use percentiles::{PercentileShift, SCALE_WARNING, Shift};
pub use residuals::{PERCENT_ERROR, PercentError};

use super::{DistributionSet, Model};
use crate::fault::Fault;
use crate::units::LengthUnit;

/// How to compare.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonOptions {
    /// The method that the others are held against: a `Labels::method` of the set.
    pub reference: String,
    /// The function fitted to every method's mean curve.
    pub model: Model,
    /// Half the width of the envelope, percent: 30 after Sanchidrián, Segarra, Ouchterlony and López,
    /// "On the accuracy of fragment size measurement by image analysis in combination with some
    /// distribution functions", Rock Mechanics and Rock Engineering 42 (2009) 95-116.
    pub envelope_percent: f64,
    /// Percents passing whose sizes are compared.
    pub percentiles: Vec<f64>,
}

impl ComparisonOptions {
    /// The usual: Swebrec, 30 %, P10, P20, P50, P80, P90.
    pub fn new(reference: impl Into<String>) -> Self {
        Self {
            reference: reference.into(),
            model: Model::Swebrec,
            envelope_percent: 30.0,
            percentiles: vec![10.0, 20.0, 50.0, 80.0, 90.0],
        }
    }
}

/// Methods held against one of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The unit of all sizes.
    pub unit: LengthUnit,
    /// How it was compared.
    pub options: ComparisonOptions,
    /// The reference's own curve.
    pub reference: MethodCurve,
    /// The sizes that the norms are taken over: the same for all methods.
    pub span: Span,
    /// Every other method, in the order of the set.
    pub methods: Vec<MethodComparison>,
    /// How much nearer to the reference one method is than another: every ordered pair of methods,
    /// empty with fewer than two.
    pub improvements: Vec<Improvement>,
}

/// One method held against the reference.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodComparison {
    /// Its own curve.
    pub curve: MethodCurve,
    /// At each size of the reference.
    pub residuals: Vec<PercentError>,
    /// Distance of its fitted function from the reference's.
    pub norm: CurveNorm,
    /// Its Pxx against the reference's.
    pub shift: Shift,
    /// What to know before trusting it, one sentence each.
    pub notes: Vec<String>,
}

impl Comparison {
    /// The envelope [low, high] of the sizes that a percent passes: the size of the reference's fitted
    /// function there, times 1 - 0.3 and 1 + 0.3 (`envelope_percent`).
    pub fn envelope_at(&self, percent: f64) -> [f64; 2] {
        let size = self.reference.fit.curve.size_at(percent);
        let share = self.options.envelope_percent / 100.0;
        [size * (1.0 - share), size * (1.0 + share)]
    }
}

/// Holds every method of a set against the reference. A method's trials are the set's curves with its
/// name: photos must have been merged, so one curve a method and trial.
///
/// # Errors
///
/// No such reference, no other method, a trial of many photos, a method that shares no size with the
/// reference or that no function can be fitted to, an envelope or percentiles outside of 0 to 100 %.
pub fn compare(trials: &DistributionSet, options: &ComparisonOptions) -> Result<Comparison, Fault> {
    let _ = (trials, options);
    Err(Fault::new("nothing is compared yet", "wait"))
}
