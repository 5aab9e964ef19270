//! A calibration that somebody gives for the photos of a folder.

use super::{PhotoSet, SurveyCamera};
use crate::camera::{Camera, Distortion};
use crate::fault::Fault;
use crate::formats::photos::photo_metadata::is_another_focal;

/// How far a given focal length may give way while the model grows: from then on it is kept.
const GIVEN_FOCAL: f64 = 0.01;

impl PhotoSet {
    /// The same with a calibration for its photos of that size, which is kept; where none is of that size, for those of the same
    /// shape, whose numbers are the same in proportion.
    ///
    /// # Errors
    /// Where no photo is of that shape, or it is of a model that cannot be kept.
    pub fn with_camera(mut self, given: &Camera) -> Result<Self, Fault> {
        may_be_given(given)?;
        let has_its_size = |its: &SurveyCamera| {
            (its.camera.width, its.camera.height) == (given.width, given.height)
        };
        let is_exact = self.cameras.iter().any(has_its_size);
        let mut used = false;
        for its in &mut self.cameras {
            if is_exact && !has_its_size(its) {
                continue;
            }
            let Ok(camera) = given.rescaled(its.camera.width, its.camera.height) else {
                continue;
            };
            used = true;
            self.warnings.extend(of_other_photos(its, &camera));
            if !is_exact {
                self.warnings.push(format!(
                    "the given calibration is of photos of {} x {} px, and these have {} x {} px: its numbers are taken in proportion",
                    given.width, given.height, camera.width, camera.height
                ));
            }
            *its = SurveyCamera {
                camera,
                focal_error: Some(GIVEN_FOCAL),
                is_given: true,
            };
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

/// That a calibration's focal length is not what the photos state.
fn of_other_photos(stated: &SurveyCamera, given: &Camera) -> Option<String> {
    let off = off_stated(stated, given)?;
    Some(format!(
        "the given calibration has a focal length of {off}: check that it is theirs"
    ))
}

/// How far a focal length is from what the photos state, where that is more than it may be.
pub(super) fn off_stated(stated: &SurveyCamera, other: &Camera) -> Option<String> {
    let error = stated.focal_error.filter(|_| !stated.is_given)?;
    let ratio = other.fx / stated.camera.fx;
    is_another_focal(ratio, error).then(|| {
        format!(
            "{:.1} px, {:+.1} % from the {:.1} px that the photos of {} state ({:.1} % of error expected)",
            other.fx,
            (ratio - 1.0) * 100.0,
            stated.camera.fx,
            stated.camera.name,
            error * 100.0
        )
    })
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

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::photo_set::camera_of_tests as camera;

    /// Photos that state a focal length of 3000 px to 2 %.
    fn photos() -> PhotoSet {
        PhotoSet {
            photos: Vec::new(),
            cameras: vec![SurveyCamera {
                camera: camera(3000.0),
                focal_error: Some(0.02),
                is_given: false,
            }],
            left_out: Vec::new(),
            warnings: Vec::new(),
            origin: DVec3::ZERO,
            count: 0,
        }
    }

    /// Reduced to a quarter; cut to another shape it is refused.
    #[test]
    fn a_calibration_of_another_size_is_taken_in_proportion() {
        let reduced = Camera {
            width: 1000,
            height: 750,
            cx: 501.0,
            cy: 374.0,
            ..camera(760.0)
        };
        let set = photos().with_camera(&reduced).unwrap();
        let found = &set.cameras[0].camera;
        assert_eq!(
            (found.width, found.fx, found.cx, found.cy),
            (4000, 3040.0, 2004.0, 1496.0)
        );
        let [said] = &set.warnings[..] else {
            panic!("{:?}", set.warnings);
        };
        assert!(
            said.contains("of 1000 x 750 px, and these have 4000 x 3000 px"),
            "{said}"
        );
        let cut = Camera {
            height: 700,
            ..reduced
        };
        assert!(photos().with_camera(&cut).is_err());
    }

    #[test]
    fn a_calibration_of_another_lens_is_said() {
        let warnings = |focal| photos().with_camera(&camera(focal)).unwrap().warnings;
        assert_eq!(warnings(3100.0), Vec::<String>::new());
        let [said] = &warnings(3300.0)[..] else {
            panic!("{:?}", warnings(3300.0));
        };
        assert!(
            said.contains("3300.0 px, +10.0 % from the 3000.0 px"),
            "{said}"
        );
    }
}
