//! Bundle adjustment: poses, points and lenses so that points lie where photos see them, and, where
//! the photos know, cameras where they were.

use std::collections::{HashMap, HashSet};

use cumulus3d_ba::{BaConfig, Loss, bundle_adjust};
use cumulus3d_core::{CameraModelKind, Reconstruction, Vec3};

use super::{Whose, failed, not_waited_for};
use crate::fault::Fault;
use crate::jobs::Progress;

/// Photos of a camera from which on lenses are adjusted while a model grows: before, poses take up what is the lens's. From then on
/// those of fewer photos are, too (one that lies turned among the others): held at what is only guessed, they would bend the model.
const PHOTOS_OF_A_LENS: usize = 4;

/// How square pixels are: sensors' are to less, and a lens does not change it.
const SQUARE: f64 = 0.001;

/// Pixels that a point may lie from where a photo sees it.
const FARTHEST_PX: f64 = 4.0;
/// Degrees between two rays at least: below, the depth is noise.
const LEAST_ANGLE: f64 = 1.5;

/// As it is called where it fails.
const DOING: &str = "the bundle adjustment";

/// What is adjusted.
pub(crate) struct Adjustment<'a> {
    /// Of these photos alone; of all where it is empty.
    pub(crate) images: HashSet<u32>,
    /// Where cameras were, each with the standard deviation of a coordinate.
    pub(crate) places: HashMap<u32, (Vec3, f64)>,
    /// How the lenses are stated.
    pub(crate) whose: &'a Whose<'a>,
    /// How far off where a photo sees a point is, pixels, one standard deviation: what is known of places and lenses counts
    /// beside it. `None` while a model grows: it is not known yet, counts as a pixel, and lenses of few photos are held.
    pub(crate) pixel: Option<f64>,
    /// Whether pixels are as square as the lens is stated, and the focal length is where it was found: photos that all look straight
    /// down the same way fit as well with a world that is stretched along one side of theirs.
    pub(crate) is_square: bool,
    /// At most.
    pub(crate) iterations: usize,
}

/// Adjusts, then takes away what does not fit. After an error the model is empty.
///
/// # Errors
/// Where there is no solution, or on cancel.
pub(crate) fn adjust(
    model: &mut Reconstruction,
    what: Adjustment<'_>,
    progress: &Progress,
) -> Result<(), Fault> {
    let is_local = !what.images.is_empty();
    let mut of_camera: HashMap<u32, usize> = HashMap::new();
    for image in model.registered_images() {
        if let Some(image) = model.image(image) {
            *of_camera.entry(image.camera_id).or_default() += 1;
        }
    }
    let few = of_camera
        .values()
        .all(|&photos| what.pixel.is_none() && photos < PHOTOS_OF_A_LENS)
        .then(|| of_camera.keys().copied());
    // A calibration that is given, once pixels are those of its pinhole.
    let given = what.whose.cameras().map(|(camera, _)| camera);
    let given = given.filter(|&camera| {
        let camera = model.camera(camera);
        camera.is_some_and(|camera| camera.model == CameraModelKind::Pinhole)
    });
    // The adjustment counts a pixel off as one standard deviation.
    let counted = |deviation: f64| deviation / what.pixel.unwrap_or(1.0);
    let lenses = what.whose.cameras().map(|(camera, known)| {
        let (mut values, mut deviations) = known.expected();
        if what.is_square
            && let Some(found) = model.camera(camera)
        {
            let longer = 2.0 * found.mean_focal() / (values[0] + values[1]);
            for (value, deviation) in values.iter_mut().zip(&mut deviations).take(2) {
                *value *= longer;
                *deviation = SQUARE * *value;
            }
        }
        (camera, (values.to_vec(), deviations.map(counted).to_vec()))
    });
    let places = what.places.iter();
    let places = places.map(|(&image, &(place, deviation))| (image, (place, counted(deviation))));
    let config = BaConfig {
        refine_focal_length: !is_local,
        refine_principal_point: !is_local,
        refine_extra_params: !is_local,
        constant_cameras: few.into_iter().flatten().chain(given).collect(),
        intrinsics_priors: lenses.collect(),
        position_priors: places.collect(),
        images: what.images,
        loss: Loss::Huber(1.0),
        max_num_iterations: what.iterations,
        function_tolerance: match what.pixel {
            None => 1e-6,
            // What thousands of observations hardly tell is left to what is known beside them.
            Some(_) => 1e-9,
        },
        ..BaConfig::default()
    };
    let mut taken = std::mem::replace(model, Reconstruction::new());
    let adjusted = not_waited_for(DOING, progress, move || {
        let summary = bundle_adjust(&mut taken, &config);
        (summary, taken)
    });
    let (summary, adjusted) = adjusted?;
    if !summary.is_ok_and(|summary| summary.is_usable()) {
        return Err(failed(DOING));
    }
    *model = adjusted;
    model.filter_observations_with_large_reprojection_error(FARTHEST_PX, None);
    model.filter_points3d_with_small_triangulation_angle(LEAST_ANGLE, None);
    Ok(())
}
