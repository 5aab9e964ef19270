//! Whether two photos see the surface where it is.
//!
//! A patch of one photo is laid on the surface and looked for in another photo that was taken from beside it. Where the surface
//! is right both show the same there. Where it lies nearer or farther than in truth, or a focal length or a height is wrong,
//! the other photo shows something else, until the patches are moved along their rays to where the rock is: the factor at which
//! they match best is that by which the surface's distance is wrong, and so the photo's scale. Nobody has to say anything for
//! it but the poses: the cloud needs no colours, the files no metadata.
//!
//! ```text
//! small_photo  a photo as it is compared
//! patches      its patches on the surface
//! sweep        how well they match in another photo, by the factor (plane sweep, Collins 1996, with one plane a patch)
//! ```
//!
//! Brightness and places in the small photo are 32-bit floats, a ten thousandth of a pixel: no number that anybody reads is one.
//!
//! What both photos have wrong in the same way (the unit, a flight moved as a whole over a flat floor) no two photos see.

mod patches;
mod small_photo;
mod sweep;
#[cfg(test)]
mod tests;

use glam::DVec3;

use crate::camera::{Camera, Pose};

pub use patches::Patches;
pub use small_photo::SmallPhoto;
pub use sweep::{Look, Parallax, SeenAt, seen_at};

/// A photo to be compared.
#[derive(Debug, Clone, Copy)]
pub struct Sighted<'a> {
    /// Its pixels.
    pub photo: &'a SmallPhoto,
    /// The camera.
    pub camera: &'a Camera,
    /// The pose.
    pub pose: &'a Pose,
}

/// A share of the distance below which nothing is said. An error of the distance is one of the scale, and no stated interval holds it;
/// of 340 photos of right flights, clouds of packages among them, none saw the surface more than 0.4 % off.
const WORTH_SAYING: f64 = 0.01;

/// Both photos of a pair may hang on different stones: the two factors are of one error where they differ by less than this share of it.
const ALIKE: f64 = 0.5;

/// Of what two photos show, as much as this matches where the surface is if it is right: shadows move, stones hide others, and between
/// the points of a sparse cloud the surface is elsewhere.
const MOST: f64 = 0.6;
/// Where less matches than this the surface is wrong. (Of right flights of rock none did; of a doll from 600 points two photos of nine.)
const LEAST: f64 = 0.33;

/// Where two photos see the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PairSight {
    /// Where it is, within this share of its distance from the camera.
    There(f64),
    /// Where it is in this share of what both show, and not so in the rest.
    Partly(f64),
    /// At this many times its distance.
    Elsewhere(SeenAt),
    /// Nowhere: they show other things.
    Nowhere,
    /// They do not tell: other light, water, leaves, hardly any parallax.
    Unclear,
}

impl PairSight {
    /// Of the patches of one photo in the other, and the other way round.
    pub fn of(first: Look, second: Look) -> Self {
        let (first, second) = match (first, second) {
            (Look::At(first), Look::At(second)) => (first, second),
            (Look::Nowhere, Look::Nowhere | Look::FewNowhere)
            | (Look::FewNowhere, Look::Nowhere) => {
                return Self::Nowhere;
            }
            _ => return Self::Unclear,
        };
        let (a, b) = (first.factor - 1.0, second.factor - 1.0);
        let share = first.share.min(second.share);
        match (first.is_elsewhere, second.is_elsewhere) {
            (false, false) if share < LEAST => Self::Partly(share),
            (false, false) if share < MOST => Self::Unclear,
            // Both see a part nearer than it is, or both see one farther.
            (false, false) if is_alike(first.part_elsewhere, second.part_elsewhere) => {
                Self::Partly(share)
            }
            (false, false) => Self::There(a.abs().max(b.abs())),
            (true, true)
                if a.abs().min(b.abs()) > WORTH_SAYING
                    && is_alike(Some(first.factor), Some(second.factor)) =>
            {
                Self::Elsewhere(match first.there > second.there {
                    true => first,
                    false => second,
                })
            }
            _ => Self::Unclear,
        }
    }
}

/// Whether two factors are of one error: see [`ALIKE`].
fn is_alike(first: Option<f64>, second: Option<f64>) -> bool {
    let (Some(a), Some(b)) = (first.map(|a| a - 1.0), second.map(|b| b - 1.0)) else {
        return false;
    };
    (a - b).abs() < ALIKE * a.abs().max(b.abs())
}

/// The pixel of the undistorted image as a linear function of a factor f: (a + f b) / its third, where the factor moves a point
/// of the surface along the ray from `eye`.
fn ray_in(camera: &Camera, pose: &Pose, eye: DVec3, point: DVec3) -> [DVec3; 2] {
    let into = |v: DVec3| {
        let v = pose.rotation.transpose() * v;
        let (x, y) = (camera.fx * v.x + camera.skew * v.y, camera.fy * v.y);
        DVec3::new(x + camera.cx * v.z, y + camera.cy * v.z, v.z)
    };
    [into(eye - pose.center), into(point - eye)]
}
