//! Shifts of the sizes that given percents pass, and whether they stay in the envelope.

/// What an envelope of sizes hides.
pub const SCALE_WARNING: &str = "a wrong image scale moves every Pxx by the same percentage and hides inside of a 30 % envelope: \
     look at the shift, not only at whether the size is inside";

/// One percentile of a method against the reference's; both of the fitted functions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PercentileShift {
    /// Percent passing.
    pub percent: f64,
    /// The reference's size, in the set's unit.
    pub reference: f64,
    /// The method's size.
    pub size: f64,
    /// 100 (size - reference) / reference; above 0 the method says coarser.
    pub shift_percent: f64,
    /// The envelope [low, high] of the reference's size.
    pub envelope: [f64; 2],
    /// Whether the method's size is in the envelope.
    pub inside: bool,
}

/// The shifts of all percentiles. See [`SCALE_WARNING`].
#[derive(Debug, Clone, PartialEq)]
pub struct Shift {
    /// In the order of the options.
    pub percentiles: Vec<PercentileShift>,
    /// Mean of the shifts, percent.
    pub mean_percent: f64,
    /// Standard deviation of the shifts (n - 1), percent; `None` with one percentile.
    pub spread_percent: Option<f64>,
    /// Whether the shifts are so much alike (spread below a quarter of the mean, which is 2 % or more)
    /// that they look like an error of the scale.
    pub looks_like_scale: bool,
}
