//! The families of functions as the search sees them: each in coordinates of its own.

use super::coordinates::{Bounds, Coordinates, MOST, Optimum, Share};
use super::gates_gaudin_schuhmann::GatesGaudinSchuhmannCoordinates;
use super::points::Points;
use super::rosin_rammler::RosinRammlerCoordinates;
use super::swebrec::SwebrecCoordinates;
use crate::{Curve, Model};

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
