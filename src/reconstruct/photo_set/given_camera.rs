//! A calibration that somebody gives for the photos of a folder.

use super::{PhotoSet, SurveyCamera};
use crate::camera::{Camera, Distortion};
use crate::fault::Fault;

/// How far a given focal length may give way while the model grows: from then on it is kept.
const GIVEN_FOCAL: f64 = 0.01;

impl PhotoSet {
    /// The same with a calibration for its photos of that size, which is kept.
    ///
    /// # Errors
    /// Where no photo is of that size, or it is of a model that cannot be kept.
    pub fn with_camera(mut self, given: &Camera) -> Result<Self, Fault> {
        may_be_given(given)?;
        let mut used = false;
        for its in &mut self.cameras {
            if (its.camera.width, its.camera.height) == (given.width, given.height) {
                used = true;
                *its = SurveyCamera {
                    camera: given.clone(),
                    focal_error: Some(GIVEN_FOCAL),
                    is_given: true,
                };
            }
        }
        if used {
            return Ok(self);
        }
        let sizes = self.cameras.iter().map(|its| &its.camera);
        let sizes: Vec<String> = sizes
            .map(|camera| format!("{} x {}", camera.width, camera.height))
            .collect();
        let what = format!(
            "it is for photos of {} x {} px, and these have {} px",
            given.width,
            given.height,
            sizes.join(", ")
        );
        Err(Fault::new(what, "give the calibration of these photos"))
    }
}

/// Whether a calibration can be kept in COLMAP's files.
///
/// # Errors
/// Why not.
fn may_be_given(camera: &Camera) -> Result<(), Fault> {
    let what = match &camera.distortion {
        _ if camera.skew != 0.0 => {
            "its axes are skew, which a reconstruction cannot keep".to_owned()
        }
        Distortion::None | Distortion::Brown(_) | Distortion::Fisheye(_) => return Ok(()),
        other => format!(
            "its lens model '{}' is one that a reconstruction cannot keep",
            other.name()
        ),
    };
    Err(Fault::new(what, "give a calibration of OpenCV's model"))
}
