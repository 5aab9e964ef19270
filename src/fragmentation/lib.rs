//! Size distributions of broken rock: curves, their fits, and whether they can be trusted.
//!
//! ```text
//! distribution    points (size, percent passing) as a sieve or Split-Desktop gave them
//! distribution_set  many of them, each with its method, trial and photo, in one unit
//! sieve_series    the openings of ASTM E11, ISO 565 R20/3, EN 933-2
//! resampling      what a distribution reads at them, or at any other sizes
//! joining         the curves of several files in one unit
//! merging         photos to one distribution, weighted as chosen
//! functions       that are fitted: Swebrec and its extension, Rosin-Rammler, Gates-Gaudin-Schuhmann
//! fit             least squares, covariance, percentiles with confidence bands
//! comparison      methods against the reference: residuals, norms, envelopes, shifts
//! anova           one-way analysis of variance
//! reference_names how the reference is called where nobody chose one
//! repeats         what is left of a mean of photos without one after another: what its bands rest on
//! analysis        all of it for a table of methods: sieves, merging, the reference, what is said
//! effort          time that each step took
//! ```
//!
//! Percent passing is 0 to 100, of the mass, everywhere but inside the functions' own formulas
//! (`Swebrec` and its like), which take and give shares 0 to 1. Sizes are in the unit of the set; no
//! formula here knows a unit.

mod analysis;
mod anova;
mod comparison;
mod distribution;
mod distribution_set;
mod effort;
mod fit;
mod functions;
mod joining;
mod merging;
mod reference_names;
mod repeats;
#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod repeats_tests;
mod resampling;
mod sieve_series;

use fragscale_core::{fault, jobs, units};

pub use analysis::{
    Analysis, AnalysisOptions, MARKED_PERCENTILES, SIGNIFICANCE, fit_each, fit_trials,
};
pub use anova::{Anova, Repeatability, Variation, repeatability};
pub use comparison::{
    Comparison, ComparisonOptions, CurveNorm, Improvement, MeanPoint, MeasuredNorm,
    MethodComparison, MethodCurve, PERCENT_ERROR, PercentError, PercentileShift, SCALE_WARNING,
    Shift, Span, compare,
};
pub use distribution::{PERCENTILES, SizeDistribution};
pub use distribution_set::{DistributionSet, LabelledDistribution, Labels};
pub use effort::{Effort, TimeSum};
pub use fit::{Fit, FitOptions, FittedParameter, NotDetermined, Percentile, TOPSIZE_PERCENT, fit};
pub use functions::{
    Curve, GatesGaudinSchuhmann, GatesGaudinSchuhmannError, Model, RosinRammler, RosinRammlerError,
    Swebrec, Swebrec5, Swebrec5Error, SwebrecError,
};
pub use merging::{Merged, Weighting, merge};
pub use reference_names::{names_sieve, names_sieving};
pub use resampling::{Resampled, resample};
pub use sieve_series::{Sieve, SieveSeries};
