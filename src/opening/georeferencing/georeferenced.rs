//! A reconstruction's way to the world, and how well what is known fits it, in numbers and words.

use glam::DVec3;

use crate::geometry::Similarity;
use crate::numbers::{TO_95_PERCENT, significant_digits, stated_percent};
use crate::scale::StatedErrors;
use crate::units::LengthUnit;

/// What a known position belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KnownKind {
    /// The centre of a photo's camera.
    Photo,
    /// A ground control point.
    ControlPoint,
}

/// How well a known position fits.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionResidual {
    /// The photo's name in the reconstruction, or the control point's.
    pub name: String,
    /// Which of the two.
    pub kind: KnownKind,
    /// Known less fitted, to the east, north and up, in the unit of the world.
    pub residual: DVec3,
    /// Whether it was used; else it is an outlier, or was only compared.
    pub used: bool,
    /// Of a control point: how far, in pixels, it projects from its marks (root mean square).
    pub marks_px: Option<f64>,
}

/// How well a known distance fits.
#[derive(Debug, Clone, PartialEq)]
pub struct LengthResidual {
    /// Its two ends.
    pub name: String,
    /// As known, in metres.
    pub known: f64,
    /// As fitted, in metres.
    pub fitted: f64,
}

/// A reconstruction's way to the world.
#[derive(Debug, Clone, PartialEq)]
pub struct Georeferenced {
    /// From the reconstruction's frame to the world.
    pub similarity: Similarity,
    /// The coordinate system of the world; `None` where it is a local one.
    pub crs: Option<String>,
    /// The unit of the world.
    pub unit: LengthUnit,
    /// What the heights count from, in words; `None` where only the scale is known.
    pub heights: Option<String>,
    /// Known positions, in the reconstruction's or the list's order; empty with distances.
    pub positions: Vec<PositionResidual>,
    /// Known distances.
    pub lengths: Vec<LengthResidual>,
    /// The root of the mean squared length of the used residuals, in the unit of the world.
    pub rms: Option<f64>,
    /// The standard error of the scale, relative to it; `None` with one distance between points that nobody marked.
    pub scale_error: Option<f64>,
    /// Half the width of its 95 % interval, relative to it.
    pub scale_interval: Option<f64>,
    /// The standard error, in degrees, of the rotation about the long axis of the positions.
    pub rotation_error_degrees: Option<f64>,
    /// How sure poses and focal length are, where the model's package does not say it and [`georeference`](super::georeference) or
    /// [`look_up_errors`](Georeferenced::look_up_errors) can: of photos to the pile, whatever place both have in the world, whose scale is not in it.
    pub errors: StatedErrors,
    /// What was assumed or left out, one sentence each.
    pub warnings: Vec<String>,
}

impl Georeferenced {
    /// What a flight states of its world's scale, percent: the standard deviation that gives its 95 % interval. Of few positions
    /// or distances that is more than the standard error, which nobody knows well: of two distances 6.5 times.
    pub fn stated_world_scale(&self) -> Option<f64> {
        Some(stated_percent(self.scale_interval? / TO_95_PERCENT))
    }

    /// How sure the scale is, in words.
    pub fn scale_error_in_words(&self) -> String {
        let checks = self.positions.len() + self.lengths.len() > 1;
        match (self.scale_error, self.scale_interval) {
            (Some(error), Some(interval)) => format!(
                "± {} (standard error), ± {} (95 %){}",
                percent(error),
                percent(interval),
                if checks {
                    ""
                } else {
                    ", by its marks alone: nothing checks the distance"
                }
            ),
            _ => "from one distance that nothing checks".to_owned(),
        }
    }

    /// A residual, or their mean, as text: with three decimals, and more where the mean has no two digits in them (a model on
    /// a table).
    pub fn residual_in_words(&self, residual: f64) -> String {
        // What is less than a millionth is rounding.
        let mean = self.rms.filter(|rms| *rms > 1e-6).unwrap_or(1.0);
        let decimals = (1.0 - mean.log10().floor()).max(3.0);
        let unit = 10.0_f64.powf(decimals);
        // Plus zero: a residual of nothing has no sign.
        let rounded = (residual * unit).round() / unit + 0.0;
        format!("{rounded:.*}", decimals as usize)
    }

    /// How many of the known positions (`what` they are called) were used, and how far off they are in the mean; `None` with
    /// distances.
    pub fn used_in_words(&self, what: &str) -> Option<String> {
        let rms = self.residual_in_words(self.rms?);
        let (used, all) = (self.used(), self.positions.len());
        Some(format!(
            "{used} of {all} {what} used, RMS {rms} {}",
            self.unit
        ))
    }

    /// How many known positions were used.
    pub fn used(&self) -> usize {
        self.positions
            .iter()
            .filter(|position| position.used)
            .count()
    }
}

/// Two digits that count; a fit to rounding is said to be one.
pub(super) fn percent(share: f64) -> String {
    match share * 100.0 {
        percent if percent < 1e-4 => "less than 0.0001 %".to_owned(),
        percent => format!("{} %", significant_digits(percent, 2)),
    }
}
