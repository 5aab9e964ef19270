//! The parameters that the search runs in: chosen so that it is well conditioned, and so that the
//! bounds of each do not depend on the others.

use super::gates_gaudin_schuhmann::GatesGaudinSchuhmannCoordinates;
use super::points::Points;
use super::rosin_rammler::RosinRammlerCoordinates;
use super::search::Optimum;
use super::swebrec::SwebrecCoordinates;
use crate::{Curve, Model};

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

/// What each family brings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Family {
    Swebrec(SwebrecCoordinates),
    RosinRammler(RosinRammlerCoordinates),
    GatesGaudinSchuhmann(GatesGaudinSchuhmannCoordinates),
}

impl Family {
    pub(super) fn new(model: Model, points: &Points, xmax: Option<f64>) -> Self {
        match model {
            Model::Swebrec => Self::Swebrec(SwebrecCoordinates::new(points, xmax, false)),
            Model::Swebrec5 => Self::Swebrec(SwebrecCoordinates::new(points, xmax, true)),
            Model::RosinRammler => Self::RosinRammler(RosinRammlerCoordinates::new(points)),
            Model::GatesGaudinSchuhmann => {
                Self::GatesGaudinSchuhmann(GatesGaudinSchuhmannCoordinates::new(points, xmax))
            }
        }
    }

    pub(super) fn bounds(&self) -> Bounds {
        match self {
            Self::Swebrec(family) => family.bounds(),
            Self::RosinRammler(family) => family.bounds(),
            Self::GatesGaudinSchuhmann(family) => family.bounds(),
        }
    }

    /// At a logarithm of the size.
    pub(super) fn share(&self, at: &Coordinates, ln_size: f64) -> Share {
        match self {
            Self::Swebrec(family) => family.share(at, ln_size),
            Self::RosinRammler(family) => family.share(at, ln_size),
            Self::GatesGaudinSchuhmann(family) => family.share(at, ln_size),
        }
    }

    /// Where to begin; some with bounds narrowed to a stretch or a point.
    pub(super) fn starts(&self, points: &Points) -> Vec<Optimum> {
        match self {
            Self::Swebrec(family) => family.starts(points),
            Self::RosinRammler(family) => family.starts(points),
            Self::GatesGaudinSchuhmann(family) => family.starts(points),
        }
    }

    /// The function there; `None` where f64 cannot hold its parameters.
    pub(super) fn curve(&self, at: &Coordinates) -> Option<Curve> {
        match self {
            Self::Swebrec(family) => family.curve(at),
            Self::RosinRammler(family) => family.curve(at),
            Self::GatesGaudinSchuhmann(family) => family.curve(at),
        }
    }

    /// Whether a and c are fitted too.
    pub(super) fn is_extended(&self) -> bool {
        matches!(self, Self::Swebrec(family) if family.is_extended())
    }

    /// The change of each parameter (row) by each coordinate (column).
    pub(super) fn parameter_gradients(&self, at: &Coordinates) -> [Coordinates; MOST] {
        match self {
            Self::Swebrec(family) => family.parameter_gradients(at),
            Self::RosinRammler(family) => family.parameter_gradients(at),
            Self::GatesGaudinSchuhmann(family) => family.parameter_gradients(at),
        }
    }
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
