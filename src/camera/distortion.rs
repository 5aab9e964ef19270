//! Lens distortion: where on the image plane a lens puts a direction, and back.
//!
//! The plane is the normalised image plane (x right, y down, at z = 1, no unit). "Ideal" points are
//! those of a camera without distortion, "distorted" ones those of the photo as shot.
//!
//! Every model is a map that grows outward from the middle until, for many calibrations, it folds
//! back: beyond that fold the polynomial means nothing, two directions would share a pixel, and some
//! pixels have no direction at all. Both ways stop at the fold and say so.

use glam::{DVec2, DVec3};

use super::agisoft::{Agisoft, AgisoftProjection};
use super::brown::Brown;
use super::fisheye::Fisheye;
use super::not_invertible::NotInvertible;
use super::visualsfm::VisualSfm;

/// A lens model with its coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Distortion {
    /// A pinhole.
    #[default]
    None,
    /// OpenCV's rational model.
    Brown(Brown),
    /// OpenCV's equidistant model.
    Fisheye(Fisheye),
    /// VisualSFM's radial term, which acts on the measured point.
    VisualSfm(VisualSfm),
    /// Agisoft's model where it has terms that OpenCV's lack.
    Agisoft(Agisoft),
}

impl Distortion {
    /// The name in flight.toml and in `info`.
    pub fn name(&self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Brown(_) => "brown",
            Self::Fisheye(_) => "fisheye",
            Self::VisualSfm(_) => "visualsfm",
            Self::Agisoft(model) => match model.projection() {
                AgisoftProjection::Frame => "agisoft-frame",
                AgisoftProjection::EquidistantFisheye => "agisoft-equidistant-fisheye",
                AgisoftProjection::EquisolidFisheye => "agisoft-equisolid-fisheye",
            },
        }
    }

    /// The coefficients, in the order of the model's own documentation.
    pub fn coefficients(&self) -> Vec<f64> {
        match self {
            Self::None => Vec::new(),
            Self::Brown(model) => model.coefficients().to_vec(),
            Self::Fisheye(model) => model.coefficients().to_vec(),
            Self::VisualSfm(model) => vec![model.k],
            Self::Agisoft(model) => model.coefficients().to_vec(),
        }
    }

    /// The distorted image point of a direction in camera axes, or `None` where the lens does not
    /// see it (behind the camera, or beyond the fold).
    pub fn distorted_from_direction(&self, direction: DVec3) -> Option<DVec2> {
        let ideal = || (direction.z > 0.0).then(|| direction.truncate() / direction.z);
        match self {
            Self::None => ideal(),
            Self::Brown(model) => model.distorted_from_ideal(ideal()?),
            Self::Fisheye(model) => model.distorted_from_direction(direction),
            Self::VisualSfm(model) => model.distorted_from_ideal(ideal()?),
            Self::Agisoft(model) => model.distorted_from_direction(direction),
        }
    }

    /// The direction (camera axes, not normalised) that the lens puts at a distorted image point,
    /// such that going back is off by at most `tolerance` in the normalised plane.
    ///
    /// # Errors
    /// Where the model has no inverse at that point.
    pub fn direction_from_distorted(
        &self,
        distorted: DVec2,
        tolerance: f64,
    ) -> Result<DVec3, NotInvertible> {
        match self {
            Self::None => Ok(distorted.extend(1.0)),
            Self::Brown(model) => Ok(model
                .ideal_from_distorted(distorted, tolerance)?
                .extend(1.0)),
            Self::Fisheye(model) => model.direction_from_distorted(distorted, tolerance),
            Self::VisualSfm(model) => Ok(model.ideal_from_distorted(distorted)?.extend(1.0)),
            Self::Agisoft(model) => model.direction_from_distorted(distorted, tolerance),
        }
    }
}
