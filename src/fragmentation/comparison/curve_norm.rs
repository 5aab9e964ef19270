//! Distance of two fitted functions over the whole curve.

/// The sizes that functions are compared over, evenly in the logarithm of the size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// The smallest: the reference's fitted P1. In the set's unit.
    pub from: f64,
    /// The largest: the reference's fitted topsize, where it has one, else its fitted P99.
    pub to: f64,
    /// Percent passing `to` by the reference's function: 100 or 99.
    pub to_percent: f64,
}

/// 2-norm of the difference of two functions over a span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveNorm {
    /// Root of the mean squared difference, percentage points.
    pub rms_difference: f64,
    /// 100 ||P - P reference|| / ||P reference||, percent.
    pub relative_percent: f64,
}

/// How much nearer to the reference one method is than another.
#[derive(Debug, Clone, PartialEq)]
pub struct Improvement {
    /// The method in question.
    pub method: String,
    /// The method that it is held against.
    pub over: String,
    /// 100 (norm of `over` - norm of `method`) / norm of `over`; above 0 where `method` is nearer to
    /// the reference. `None` where the norm of `over` is 0.
    pub percent: Option<f64>,
}
