//! SIFT features of each photo (Lowe 2004), one photo at a time: all octaves of a photo lie in memory
//! together, some 150 bytes a pixel.

use std::path::Path;

use cumulus3d_core::{Camera, CameraModelKind, Descriptors, FeatureStore};
use cumulus3d_features::{
    CpuSift, FeatureSelection, GrayImage, SiftOptions, extract::extract_for_camera,
};
use image::{DynamicImage, RgbImage};

use super::small_photos::SmallPhotos;
use super::{camera_id, image_id};
use crate::adjusted::failed;
use crate::camera::Distortion;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::photo_set::{LeftOut, PhotoSet, SurveyCamera};

/// Longer side of what features are looked for in, pixels.
const SIDE: usize = 3200;

/// Features kept of a photo, the strongest of each part of it: whole parts without would bend the model.
const FEATURES: usize = 8192;
/// Parts along each side.
const CELLS: u32 = 16;

/// A photo with fewer is blurred, or of something without texture: 30 matches make a pose.
const FEWEST: usize = 100;

/// The result is written after so many photos, for a run that goes on.
const WRITTEN_EACH: usize = 20;

/// Finds the features of all photos that `store` does not have, and says which photos have none. Of those that it looks at
/// copies are kept in `small`.
///
/// # Errors
/// Where `kept` cannot be written, or the work was cancelled.
pub(super) fn find(
    store: &FeatureStore,
    photos: &PhotoSet,
    kept: &Path,
    mut small: Option<&mut SmallPhotos>,
    progress: &Progress,
) -> Result<Vec<LeftOut>, Fault> {
    let error = || failed("finding features");
    if store.num_cameras() == 0 {
        for (number, camera) in photos.cameras.iter().enumerate() {
            let lens = lens(camera_id(number), camera)?;
            store.add_camera(lens).map_err(|_| error())?;
        }
    }
    progress.stage(format!(
        "finding features of {} photos",
        photos.photos.len()
    ));
    let sift = CpuSift::new();
    let mut left_out = Vec::new();
    let mut unwritten = 0;
    for (number, photo) in photos.photos.iter().enumerate() {
        let going_on = progress.advance(number as u64, photos.photos.len() as u64);
        if going_on.is_err() && unwritten > 0 {
            keep(store, kept)?;
        }
        going_on?;
        let mut leave_out = |why: String| {
            left_out.push(LeftOut {
                photo: photo.name.clone(),
                why,
            });
        };
        let id = image_id(number);
        if !store.exists_keypoints(id) {
            let camera = camera_id(photo.camera);
            if !store.exists_image(id) {
                store
                    .add_image_with_id(id, &photo.name, camera)
                    .map_err(|_| error())?;
            }
            let size = &photos.cameras[photo.camera].camera;
            let gray = match photo.pixels(size) {
                Ok(pixels) => {
                    if let Some(small) = &mut small {
                        small.add(id, &pixels);
                    }
                    gray(pixels)?
                }
                Err(why) => {
                    leave_out(why);
                    continue;
                }
            };
            let (width, height) = (u64::from(size.width), u64::from(size.height));
            let (points, found) =
                extract_for_camera(&sift, &gray, None, width, height, SIDE, &options())
                    .map_err(|_| error())?;
            store.set_keypoints(id, points);
            store.set_descriptors(id, found.descriptors);
            unwritten += 1;
        }
        if store.num_keypoints(id) < FEWEST {
            leave_out("it is blurred or shows nothing but even surfaces".to_owned());
            store.set_keypoints(id, Vec::new());
            store.set_descriptors(id, Descriptors::new());
        }
        if unwritten >= WRITTEN_EACH {
            keep(store, kept)?;
            unwritten = 0;
        }
    }
    if unwritten > 0 {
        keep(store, kept)?;
    }
    Ok(left_out)
}

/// Writes what was found so far.
///
/// # Errors
/// Where the file cannot be written.
pub(super) fn keep(store: &FeatureStore, kept: &Path) -> Result<(), Fault> {
    let part = kept.with_extension("part");
    let cannot = |why: String| {
        let what = format!("{} cannot be written ({why})", kept.display());
        Fault::new(what, "make room on the disk")
    };
    store.save(&part).map_err(|error| {
        // Its own words are Korean; the system's are below them.
        let of_system = std::error::Error::source(&error);
        cannot(of_system.map_or("of unknown cause".to_owned(), ToString::to_string))
    })?;
    std::fs::rename(&part, kept).map_err(|error| cannot(error.to_string()))
}

fn options() -> SiftOptions {
    SiftOptions {
        max_num_features: FEATURES,
        selection: FeatureSelection::SpatialGrid { cells: CELLS },
        ..SiftOptions::default()
    }
}

fn gray(pixels: RgbImage) -> Result<GrayImage, Fault> {
    let image = DynamicImage::ImageRgb8(pixels).into_luma8();
    let (width, height) = (image.width() as usize, image.height() as usize);
    GrayImage::new(width, height, image.into_raw()).map_err(|_| failed("finding features"))
}

/// A camera as cumulus3d has it: OpenCV's model without k3.
fn lens(id: u32, camera: &SurveyCamera) -> Result<Camera, Fault> {
    let SurveyCamera {
        camera,
        focal_error,
        ..
    } = camera;
    let mut numbers = vec![camera.fx, camera.fy, camera.cx, camera.cy];
    let coefficients = match &camera.distortion {
        Distortion::Brown(brown) => brown.coefficients(),
        _ => [0.0; 8],
    };
    numbers.extend(&coefficients[..4]);
    let (width, height) = (u64::from(camera.width), u64::from(camera.height));
    let mut lens = Camera::new(id, CameraModelKind::OpenCv, width, height, numbers)
        .map_err(|_| failed("making a camera"))?;
    lens.focal_from_prior = focal_error.is_some();
    Ok(lens)
}
