//! What is to be said of the lenses that were found: against what the photos state, and against each other.

use super::given_camera::off_stated;
use super::{PhotoSet, SurveyCamera};
use crate::camera::Camera;
use crate::fault::first_names;
use crate::formats::Reconstruction;

/// Degrees across that a lens of unknown focal length hardly sees less of: drones' longest fixed ones see 13 to 30.
const NARROW: f64 = 12.0;

impl PhotoSet {
    /// All of it, one sentence each.
    pub(crate) fn said_of_lenses(&self, model: &Reconstruction) -> Vec<String> {
        let lenses = model.cameras.iter().enumerate();
        let stated = lenses.filter_map(|(at, found)| Some((self.camera_of(model, at)?, found)));
        let said = stated.filter_map(|(stated, found)| {
            found_off_stated(stated, found).or_else(|| narrow(stated, found))
        });
        said.chain(self.own_lenses(model)).collect()
    }

    /// Photos that got a lens of their own beside others of the same camera.
    fn own_lenses(&self, model: &Reconstruction) -> Option<String> {
        let taken = |at: usize| model.photos.iter().filter(move |photo| photo.camera == at);
        let same = |one: usize, other: usize| {
            let [one, other] = [one, other].map(|at| self.named(&taken(at).next()?.name));
            Some(one?.camera == other?.camera)
        };
        let cameras = 0..model.cameras.len();
        let own = cameras.clone().filter_map(|at| {
            let mut of = taken(at);
            let (photo, None) = (of.next()?, of.next()) else {
                return None;
            };
            let mut with_more = (cameras.clone()).filter(|&other| taken(other).nth(1).is_some());
            let others = with_more.find(|&other| same(at, other) == Some(true))?;
            let [own, others] = [at, others].map(|at| model.cameras[at].fx);
            let longer = (own / others - 1.0) * 100.0;
            Some(format!("{} {longer:+.1} %", photo.name))
        });
        let own: Vec<String> = own.collect();
        (!own.is_empty()).then(|| {
            format!(
                "photos with a focal length of their own beside that of the others ({}): they were zoomed, cropped or stabilised, which their files \
                 do not say; look at them, or reconstruct once without them",
                first_names(&own)
            )
        })
    }
}

/// That the focal length that was found is not what the photos state; nothing of one that was given.
fn found_off_stated(stated: &SurveyCamera, found: &Camera) -> Option<String> {
    let off = off_stated(stated, found)?;
    Some(format!(
        "the lens that was found has a focal length of {off}: few photos, or photos that all look straight down at flat ground, tell it \
         badly; add some that look obliquely, or give a calibration (--camera)"
    ))
}

/// That photos that state nothing come out as seen through a telescope.
fn narrow(stated: &SurveyCamera, found: &Camera) -> Option<String> {
    let across = 2.0
        * (f64::from(found.width) / 2.0 / found.fx)
            .atan()
            .to_degrees();
    (stated.focal_error.is_none() && across < NARROW).then(|| {
        format!(
            "the lens that was found sees {across:.0} degrees across, and no photo states its focal length: photos that were cropped beside their middle, \
             or that all look straight down at flat ground, come out so, and their scales are wrong; take the camera's own files, or give a calibration \
             (--camera)"
        )
    })
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use glam::{DMat3, DVec3};

    use super::*;
    use crate::camera::Pose;
    use crate::formats::PosedPhoto;
    use crate::photo_set::{SurveyPhoto, camera_of_tests as camera};

    /// What is said of the lenses of photos 0.jpg, 1.jpg, ..., which are of these cameras of the model, where all state so long a
    /// focal length.
    fn said(stated: Option<f64>, is_given: bool, lenses: &[f64], of: &[usize]) -> String {
        let name = |number: usize| format!("{number}.jpg");
        let photos = 0..of.len();
        let set = PhotoSet {
            photos: (photos.clone())
                .map(|number| SurveyPhoto {
                    name: name(number),
                    path: PathBuf::new(),
                    camera: 0,
                    place: None,
                    gimbal: None,
                })
                .collect(),
            cameras: vec![SurveyCamera {
                camera: camera(stated.unwrap_or(4000.0)),
                focal_error: stated.map(|_| 0.02),
                is_given,
            }],
            left_out: Vec::new(),
            warnings: Vec::new(),
            origin: DVec3::ZERO,
            count: of.len(),
        };
        let model = Reconstruction {
            cameras: lenses.iter().copied().map(camera).collect(),
            photos: (photos.zip(of))
                .map(|(number, &camera)| PosedPhoto {
                    name: name(number),
                    camera,
                    pose: Pose {
                        rotation: DMat3::IDENTITY,
                        center: DVec3::ZERO,
                    },
                })
                .collect(),
            ..Reconstruction::default()
        };
        set.said_of_lenses(&model).join("; ")
    }

    #[test]
    fn a_lens_that_is_not_as_stated_is_said() {
        assert_eq!(said(Some(3000.0), false, &[2950.0], &[0, 0]), "");
        let off = said(Some(3000.0), false, &[2700.0], &[0, 0]);
        assert!(
            off.contains("2700.0 px, -10.0 % from the 3000.0 px") && off.contains("--camera"),
            "{off}"
        );
        assert_eq!(said(Some(3000.0), true, &[2700.0], &[0, 0]), "");
    }

    #[test]
    fn a_lens_of_its_own_is_said() {
        let own = said(Some(3000.0), false, &[3000.0, 3090.0], &[0, 1, 0, 0]);
        assert!(own.contains("(1.jpg +3.0 %): they were zoomed"), "{own}");
        // Two cameras of one photo each, and one for all.
        assert_eq!(said(Some(3000.0), false, &[3000.0, 3050.0], &[0, 1]), "");
    }

    /// 4000 pixels at 28 600 are 8 degrees; 12 begin at 2000 / tan 6 degrees, 19 029.
    #[test]
    fn a_telescope_is_said_where_nothing_is_stated() {
        let narrow = said(None, false, &[28_600.0], &[0, 0]);
        assert!(narrow.contains("sees 8 degrees across"), "{narrow}");
        assert_eq!(said(None, false, &[9000.0], &[0, 0]), "");
        assert_ne!(said(None, false, &[19_100.0], &[0, 0]), "");
        assert_eq!(said(None, false, &[18_900.0], &[0, 0]), "");
        assert_eq!(said(Some(28_600.0), false, &[28_600.0], &[0, 0]), "");
    }
}
