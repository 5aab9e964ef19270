//! What volumes are over.

use glam::{DMat3, DVec2, DVec3};

use super::SurveyError;
use super::polygon::Polygon;
use super::profile::Profile;
use crate::surface::Surface;

/// The share of the rim that must lie on the surface for a plane through it.
const LEAST_RIM: f64 = 0.5;

/// What a volume is over.
#[derive(Debug, Clone, Copy)]
pub enum Base<'a> {
    /// A level at this elevation, world units.
    Height(f64),
    /// The plane nearest to the surface along the polygon's rim: least squares over the rim's length.
    Rim,
    /// Another surface in the same world, such as the floor before.
    Surface(&'a Surface),
}

/// What a volume was over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BaseFound {
    /// A level at this elevation, world units.
    Height(f64),
    /// The plane through the rim.
    Rim(Plane),
    /// Another surface.
    Surface,
}

/// A plane that is not upright.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// A place on it, in the world.
    pub through: DVec3,
    /// How much it rises for one unit along x and along y.
    pub rise: DVec2,
    /// The root of the mean squared height of the rim over it, world units.
    pub residual: f64,
}

impl Plane {
    /// Its height at a place (x, y in the world).
    pub fn height(&self, place: DVec2) -> f64 {
        self.through.z + self.rise.dot(place - self.through.truncate())
    }

    /// How steep it is, degrees from the horizontal.
    pub fn slope(&self) -> f64 {
        self.rise.length().atan().to_degrees()
    }

    /// The plane nearest to the surface along a polygon's rim.
    pub(super) fn of_rim(surface: &Surface, polygon: &Polygon) -> Result<Self, SurveyError> {
        let mut line = polygon.corners().to_vec();
        line.extend(polygon.corners().first());
        let rim = Profile::along(surface, &line)?;
        if rim.covered() < LEAST_RIM {
            return Err(SurveyError::RimNotCovered((100.0 * rim.covered()).max(0.0)));
        }
        let Some(start) = rim.points().next().map(|first| first.point) else {
            return Err(SurveyError::RimNotCovered(0.0));
        };
        // Ends and middle of each straight piece with Simpson's weights: exact for squares. From a place
        // nearby, for the digits of UTM coordinates.
        let mut places: Vec<(f64, DVec3)> = Vec::new();
        for run in &rim.runs {
            for ends in run.windows(2) {
                let length = ends[1].distance - ends[0].distance;
                let (from, to) = (ends[0].point - start, ends[1].point - start);
                let weights = [length / 6.0, length * 4.0 / 6.0, length / 6.0];
                places.extend(weights.into_iter().zip([from, (from + to) / 2.0, to]));
            }
        }
        let weight: f64 = places.iter().map(|(weight, _)| weight).sum();
        let middle = places.iter().map(|&(weight, place)| place * weight);
        let middle = middle.sum::<DVec3>() / weight;
        let mut spread = DMat3::ZERO;
        for &(weight, place) in &places {
            let off = place - middle;
            spread += DMat3::from_cols(off * off.x, off * off.y, off * off.z) * weight;
        }
        let (xx, xy, yy) = (spread.x_axis.x, spread.x_axis.y, spread.y_axis.y);
        let determinant = xx * yy - xy * xy;
        if determinant <= 1e-9 * (xx + yy) * (xx + yy) {
            return Err(SurveyError::NoRimPlane);
        }
        let (xz, yz) = (spread.x_axis.z, spread.y_axis.z);
        let rise = DVec2::new(yy * xz - xy * yz, xx * yz - xy * xz) / determinant;
        let off = |place: DVec3| (place - middle).z - rise.dot((place - middle).truncate());
        let squares = places
            .iter()
            .map(|&(weight, place)| weight * off(place) * off(place));
        Ok(Self {
            through: middle + start,
            rise,
            residual: (squares.sum::<f64>() / weight).sqrt(),
        })
    }
}
