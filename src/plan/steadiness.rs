//! How well a drone holds its pose, and what that makes of a photo's scale.
//!
//! Of a pinhole the scale is the focal length over the depth. A photo's middle scale is the mean of that over the ground
//! that it shows (weighted by how much of the image each place fills). Each of the pose's five errors (three of place,
//! pitch, heading; the gimbal keeps the horizon) moves it by some share, taken from the poses one standard error
//! before and behind; the squares add up.

use glam::{DMat3, DQuat, DVec3};

use super::photo::PlannedPhoto;
use super::terrain::Terrain;
use crate::camera::{Camera, Pose};
use crate::numbers::TO_95_PERCENT;

/// How far a drone's pose is off its plan: standard errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseErrors {
    /// Of x and of y each, world units.
    pub level: f64,
    /// Of the height, world units.
    pub upright: f64,
    /// Of the gimbal's pitch, degrees.
    pub pitch: f64,
    /// Of the heading, degrees.
    pub heading: f64,
}

impl PoseErrors {
    /// How far the drone may be off its place along one axis: half of the 95 % interval, world units.
    pub fn off_place(&self) -> f64 {
        TO_95_PERCENT * self.level.max(self.upright)
    }
}

/// By what a drone knows its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Positioning {
    /// Satellites alone.
    #[default]
    Gnss,
    /// Satellites with corrections from a base.
    Rtk,
}

impl Positioning {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Gnss, Self::Rtk];

    /// Its name on the command line.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Gnss => "gnss",
            Self::Rtk => "rtk",
        }
    }

    /// Its name in the window.
    pub fn title(self) -> &'static str {
        match self {
            Self::Gnss => "Satellites (GNSS)",
            Self::Rtk => "RTK",
        }
    }

    /// What it means.
    pub fn explained(self) -> &'static str {
        match self {
            Self::Gnss => "Satellites alone: 1.5 m level, 0.5 m in height",
            Self::Rtk => "Corrections from a base: 0.1 m level, 0.1 m in height",
        }
    }

    /// The errors of a pose, in a world with such units of so many metres.
    ///
    /// The places' are the "hovering accuracy" on DJI's pages "Specs" (Matrice 30, Phantom 4 RTK; GPS 1.5 and 0.5 m, RTK
    /// 0.1 m), taken as standard errors, for the maker does not say what share they hold. No maker states how
    /// well gimbal and compass keep a direction: half a degree and two are ours. The error of the take-off's height
    /// on the surface, and the barometer's drift, come on top: nobody states them.
    pub fn errors(self, unit_metres: f64) -> PoseErrors {
        let [level, upright] = match self {
            Self::Gnss => [1.5, 0.5],
            Self::Rtk => [0.1, 0.1],
        };
        PoseErrors {
            level: level / unit_metres,
            upright: upright / unit_metres,
            pitch: 0.5,
            heading: 2.0,
        }
    }
}

/// Half the width of the 95 % interval of a photo's middle scale, percent of it; `None` where it shows nothing.
pub(super) fn interval(
    photo: &PlannedPhoto,
    camera: &Camera,
    terrain: &Terrain,
    errors: &PoseErrors,
) -> Option<f64> {
    let moved = |by: DVec3| Pose {
        center: photo.pose.center + by,
        ..photo.pose
    };
    let turned = |axis: DVec3, degrees: f64| Pose {
        rotation: DMat3::from_quat(DQuat::from_axis_angle(axis, degrees.to_radians()))
            * photo.pose.rotation,
        ..photo.pose
    };
    let right = photo.pose.rotation * DVec3::X;
    // Under one of these nothing of the ground may be left.
    let middle = |pose: Pose| middle_scale(photo, pose, camera, terrain);
    let shares = [-1.0, 1.0].map(|sign| {
        [
            moved(DVec3::X * errors.level * sign),
            moved(DVec3::Y * errors.level * sign),
            moved(DVec3::Z * errors.upright * sign),
            turned(right, errors.pitch * sign),
            turned(DVec3::Z, errors.heading * sign),
        ]
        .map(middle)
    });
    let mut variance = 0.0;
    for (before, behind) in shares[0].iter().zip(&shares[1]) {
        variance += (((*behind)? - (*before)?) / 2.0).powi(2);
    }
    Some(100.0 * TO_95_PERCENT * variance.sqrt())
}

/// The mean of the logarithm of one over the depth, over what a photo from another pose shows: a share more of it is a
/// share more of the scale.
fn middle_scale(
    photo: &PlannedPhoto,
    pose: Pose,
    camera: &Camera,
    terrain: &Terrain,
) -> Option<f64> {
    let photo = PlannedPhoto {
        pose,
        reach: photo.reach + pose.center.distance(photo.pose.center),
        ..photo.clone()
    };
    let (mut sum, mut weights) = (0.0, 0.0);
    for (_, in_camera) in photo.sees(camera, terrain) {
        let weight = in_camera.z.powi(-2);
        sum -= weight * in_camera.z.ln();
        weights += weight;
    }
    (weights > 0.0).then(|| sum / weights)
}
