//! Bundle adjustment: poses, points and lenses so that points lie where photos see them, and, where
//! the photos know, cameras where they were.
//!
//! Places and lenses count as much as they are known beside where photos see points, which the model itself tells
//! (0.1 to 0.5 pixels): weighed against a pixel, whatever they are, scales hung ten times as much on the focal length that the
//! maker states as was said. How sure the outcome is, is stated more carefully: there not every point counts by itself
//! (`covariance`). Weighed likewise, an EXIF that was 15 % off moved the scales of twelve photos by 0.5 %, four times what it states.

use std::collections::{HashMap, HashSet};

use cumulus3d_ba::{BaConfig, Loss, bundle_adjust};
use cumulus3d_core::{CameraModelKind, Reconstruction, Vec3};

use super::{Whose, failed, not_waited_for};
use crate::fault::Fault;
use crate::geometry::median;
use crate::jobs::Progress;
use crate::opening::covariance::deviation_of_pixels;

/// Photos of a camera from which on lenses are adjusted while a model grows: before, poses take up what is the lens's. From then on
/// those of fewer photos are, too (one that lies turned among the others): held at what is only guessed, they would bend the model.
const PHOTOS_OF_A_LENS: usize = 4;

/// How square pixels are: sensors' are to less, and a lens does not change it.
const SQUARE: f64 = 0.001;

/// No matcher tells where a photo sees a point better, pixels.
const LEAST_PX: f64 = 0.02;

/// From where on a point counts less and less in the last adjustment, in halfway values of how far points lie off. Half of them lie
/// close and a tenth far (stones that look otherwise from elsewhere), and weighed alike that tenth has three fifths of the say. (Of
/// bench 7202's 105 photos, against the truth: axes 0.026 degrees off and centres 13.3 mm where all to a pixel count alike, 0.022
/// and 11.1 so; in a model of the adjustment 0.9 in its place comes out the same.)
/// Priors are weighed against a halfway value: the information of points in that loss, the sum of their squared influences over the
/// sum of the slopes, is that of a deviation of 0.87 of it there.
const FAR: f64 = 1.5;

/// The root of the mean square in halfway values from which points err otherwise than by a normal law, of which it is 1.2 (simulated
/// photos: 2.6).
const HEAVY: f64 = 1.8;

/// Pixels that a point may lie from where a photo sees it.
pub(super) const FARTHEST_PX: f64 = 4.0;
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
    /// What is known of places and lenses is weighed against ...
    pub(crate) weighed: Weighed,
    /// At most.
    pub(crate) iterations: usize,
}

/// See [`Adjustment::weighed`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weighed {
    /// ... a pixel, while a model grows: it does not tell its own yet. Lenses of few photos are held.
    APixel,
    /// ... how far its points lie from where photos see them.
    ItsPixels,
    /// ... how far most of its points lie off, and those that lie much farther count the less; and pixels are as square as the lens is
    /// stated, and the focal length is where it was found: photos that all look straight down the same way fit as well with a world
    /// that is stretched along one side of theirs.
    ItsBestSquarePixels,
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
    let (pixel, loss) = match what.weighed {
        Weighed::APixel => (None, Loss::Huber(1.0)),
        Weighed::ItsPixels => (Some(pixel_deviation(model)), Loss::Huber(1.0)),
        Weighed::ItsBestSquarePixels => match heavy_tailed(model) {
            Some(halfway) => (Some(halfway), Loss::Cauchy(FAR * halfway)),
            None => (Some(pixel_deviation(model)), Loss::Huber(1.0)),
        },
    };
    let is_local = !what.images.is_empty();
    let mut of_camera: HashMap<u32, usize> = HashMap::new();
    for image in model.registered_images() {
        if let Some(image) = model.image(image) {
            *of_camera.entry(image.camera_id).or_default() += 1;
        }
    }
    let few = of_camera
        .values()
        .all(|&photos| pixel.is_none() && photos < PHOTOS_OF_A_LENS)
        .then(|| of_camera.keys().copied());
    // A calibration that is given, once pixels are those of its pinhole.
    let given = what.whose.cameras().map(|(camera, _)| camera);
    let given = given.filter(|&camera| {
        let camera = model.camera(camera);
        camera.is_some_and(|camera| camera.model == CameraModelKind::Pinhole)
    });
    // The adjustment counts a pixel off as one standard deviation.
    let counted = |deviation: f64| deviation / pixel.unwrap_or(1.0);
    let lenses = what.whose.cameras().map(|(camera, known)| {
        let (mut values, mut deviations) = known.expected();
        if what.weighed == Weighed::ItsBestSquarePixels
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
        loss,
        max_num_iterations: what.iterations,
        function_tolerance: match pixel {
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

/// The deviation of where photos see points. What nothing tells is a pixel; exact data of tests are what no matcher reaches.
pub(super) fn pixel_deviation(model: &Reconstruction) -> f64 {
    let (photos, points) = (model.registered_image_count(), model.num_points3d());
    deviation_of_pixels(off_px(model), photos, points).map_or(1.0, |pixel| pixel.max(LEAST_PX))
}

/// How far half of the points lie off at most, pixels, where many lie much farther; `None` where they err as by a normal law, which
/// squares do best by.
fn heavy_tailed(model: &Reconstruction) -> Option<f64> {
    let mut off: Vec<f64> = off_px(model).collect();
    let squares = off.iter().map(|off| off * off).sum::<f64>();
    let root = (squares / off.len().max(1) as f64).sqrt();
    let halfway = median(&mut off)?.max(LEAST_PX);
    (root > HEAVY * halfway).then_some(halfway)
}

/// How far points lie from where photos see them, pixels.
pub(super) fn off_px(model: &Reconstruction) -> impl Iterator<Item = f64> {
    let seen = model.points3d().flat_map(|(_, point)| {
        let seen = point.track.iter();
        seen.map(|seen| (point.xyz, seen.image_id, seen.point2d_idx))
    });
    let off = seen.filter_map(|(at, image, number)| {
        let pose = model.world_to_cam(image)?;
        let image = model.image(image)?;
        let camera = model.camera(image.camera_id)?;
        let found = camera.cam_to_img(&pose.transform_point(&at))?;
        Some((found - image.point2d(number).xy).norm())
    });
    off.filter(|off| off.is_finite())
}
