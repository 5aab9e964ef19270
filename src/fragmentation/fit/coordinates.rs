//! The parameters that the search runs in: chosen so that it is well conditioned, and so that the
//! bounds of each do not depend on the others.

use super::points::Points;

/// The most parameters that a function has.
pub(super) const MOST: usize = 5;

/// As many of them as the function has parameters are used, in the order of
/// `Model::parameter_names`.
pub(super) type Coordinates = [f64; MOST];

/// [low, high] of each; equal where the coordinate is not fitted.
pub(super) type Bounds = [[f64; 2]; MOST];

/// Bounds of the logarithms of b, c, n and m.
pub(super) const EXPONENT: [f64; 2] = [-6.907_755_278_982_137, 6.907_755_278_982_137];

/// How far above the largest size that not everything passed, as a logarithm, xmax may lie: 1e100
/// times as large.
pub(super) const FARTHEST: f64 = 230.258_509_299_404_57;

/// A share passing and how it changes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Share {
    /// 0 to 1.
    pub(super) share: f64,
    /// By each coordinate.
    pub(super) gradient: Coordinates,
    /// By the logarithm of the size.
    pub(super) slope: f64,
}

/// A place where the search came to rest, or begins.
#[derive(Debug, Clone, Copy)]
pub(super) struct Optimum {
    pub(super) at: Coordinates,
    /// Where low and high are equal the coordinate was not free.
    pub(super) bounds: Bounds,
    /// With weights of mean 1.
    pub(super) sum: f64,
}

/// The weighted sum of squared residuals, percentage points squared; weights with a mean of 1.
pub(super) fn sum_of_squares(points: &Points, share: impl Fn(usize, f64) -> f64) -> f64 {
    let squares = points.points.iter().enumerate().map(|(index, point)| {
        let residual = point.percent - 100.0 * share(index, point.ln_size);
        point.weight * residual * residual
    });
    squares.sum()
}

/// `count` numbers from `low` to `high` in equal ratios; two or more.
pub(super) fn geometric(low: f64, high: f64, count: u32) -> impl Iterator<Item = f64> + Clone {
    let ratio = (high / low).powf(1.0 / f64::from(count - 1));
    (0..count).map(move |step| low * ratio.powf(f64::from(step)))
}
