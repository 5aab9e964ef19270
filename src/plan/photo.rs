//! A photo that is to be taken, or that cannot be.

use glam::{DVec2, DVec3};

use super::forecast::Forecast;
use super::terrain::Terrain;
use crate::camera::{Camera, Pose};

/// What photos are taken for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Purpose {
    /// To be measured: each is held to the wished scale.
    Scale,
    /// To be reconstructed: they are held to what they share.
    Survey,
}

impl Purpose {
    /// In a word.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Scale => "scale",
            Self::Survey => "survey",
        }
    }

    /// What the photo of this number in the flight is called.
    pub(super) fn photo_name(self, number: usize) -> String {
        let letter = match self {
            Self::Scale => 'P',
            Self::Survey => 'S',
        };
        format!("{letter}{number:03}")
    }
}

/// A photo that is to be taken.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedPhoto {
    /// Its place in the plan: P001, P002, …; S003 of a survey.
    pub name: String,
    /// What it is taken for.
    pub purpose: Purpose,
    /// Where from, in the world.
    pub pose: Pose,
    /// The axis below the horizon, degrees: 90 straight down.
    pub tilt: f64,
    /// Where it looks, degrees clockwise from world +y, 0 to under 360.
    pub pan: f64,
    /// What its middle shows, on the ground as it is smoothed over a footprint.
    pub target: DVec3,
    /// From there to the camera, along the axis.
    pub distance: f64,
    /// The angle between its axis and the normal of the ground, degrees.
    pub off_normal: f64,
    /// Nothing farther than this from its target along x or y is in it.
    pub reach: f64,
    /// What it will show; `None` where that is nothing of the surface.
    pub forecast: Option<Forecast>,
    /// Where the edges of its image lie on the surface, clockwise from the top left corner; what looks beyond the surface
    /// is missing.
    pub outline: Vec<DVec3>,
    /// How far its scale may be off, because the drone does not stand where it is told to: half the width of the 95 %
    /// interval, percent. `None` where it shows nothing.
    pub interval: Option<f64>,
}

impl PlannedPhoto {
    /// The terrain's points inside its image, in the world and in camera axes; what hides behind others, too.
    pub(super) fn sees<'a>(
        &'a self,
        camera: &'a Camera,
        terrain: &'a Terrain,
    ) -> impl Iterator<Item = (DVec3, DVec3)> + 'a {
        let points = terrain.around(self.target.truncate(), self.reach);
        points.filter_map(|point| {
            let in_camera = self.pose.camera_from_world(point);
            let pixel = camera.pixel_undistorted(in_camera)?;
            camera.contains(pixel).then_some((point, in_camera))
        })
    }
}

/// A photo that cannot be taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Refused {
    /// What it was to show.
    pub place: DVec2,
    /// Why, one clause; what it says of this photo alone stands behind a colon.
    pub why: String,
}

/// Why there is no plane of the ground.
pub(super) const NO_GROUND: &str =
    "most of the photo would look beyond the surface, or into a hole of it";

impl Refused {
    /// Why, without what that says of this photo alone: photos with one cause are told together.
    pub fn cause(&self) -> &str {
        let parts = self.why.split_once(':');
        parts.map_or(self.why.as_str(), |(cause, _)| cause)
    }

    /// Of a place that has no ground to look at.
    pub(super) fn without_ground(place: DVec2) -> Self {
        let why = NO_GROUND.to_owned();
        Self { place, why }
    }
}
