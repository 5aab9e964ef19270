//! A photo as dense stereo takes it: undistorted, its pose known, its depths bounded.

use image::RgbImage;

use crate::camera::{Camera, Distortion, Pose};
use crate::fault::Fault;

/// An undistorted photo's camera and pose.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// A pinhole without distortion, for the size of the photo as [`Photos`] hands it over.
    pub camera: Camera,
    /// Where it was taken from, in the world.
    pub pose: Pose,
    /// The nearest and the farthest depth along the optical axis to search, in the world's unit.
    pub depths: [f64; 2],
}

/// Where the photos' pixels come from, one at a time: a survey's photos do not fit in memory together.
pub trait Photos: Sync {
    /// The undistorted photo of a view, of the size of its camera.
    ///
    /// # Errors
    /// Where it cannot be read.
    fn photo(&self, view: usize) -> Result<RgbImage, Fault>;
}

impl Photos for Vec<RgbImage> {
    fn photo(&self, view: usize) -> Result<RgbImage, Fault> {
        let photo = self.get(view).cloned();
        photo.ok_or_else(|| Fault::new(format!("there is no photo {view}"), "add it"))
    }
}

impl View {
    /// Checks what the search rests on.
    ///
    /// # Errors
    /// Where the camera has a lens or is none, or where the depths are no range in front of it.
    pub(crate) fn check(&self, which: usize) -> Result<(), Fault> {
        let remedy = "undistort the photos first";
        self.camera
            .validate()
            .map_err(|error| Fault::new(format!("view {which}: {error}"), remedy))?;
        if self.camera.distortion != Distortion::None {
            return Err(Fault::new(
                format!("view {which} is not undistorted"),
                remedy,
            ));
        }
        let [near, far] = self.depths;
        if !(near > 0.0 && far > near && far.is_finite()) {
            return Err(Fault::new(
                format!("view {which}: {near} to {far} is no range of depths"),
                "give it points that it sees",
            ));
        }
        Ok(())
    }
}
