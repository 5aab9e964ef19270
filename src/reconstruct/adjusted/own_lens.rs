//! Photos that were zoomed, cropped or stabilised, which their files do not say: under one lens with the others they bend the whole
//! model. They are found by a trial in which each photo has a lens of its own: the focal lengths of photos of one camera then
//! agree but for theirs. With a lens of its own a photo that was not does no harm.
//!
//! Photos of one lens come out apart by 0.01 to 0.05 % (simulated, seen to 0.1 pixels), and by 0.1 and 0.3 % (Sceaux and Kermit's
//! doll, eleven real photos each; medians).

use std::collections::{HashMap, HashSet};

use cumulus3d_core::reconstruction::Image;
use cumulus3d_core::{Error, Reconstruction, Vec3};

use super::bundle::{Adjustment, Weighed, adjust};
use super::in_order::{add_camera, add_image, with_cameras_of};
use super::{Whose, failed};
use crate::fault::Fault;
use crate::geometry::median_with_deviation;
use crate::jobs::Progress;

/// Photos of a camera of which some can be told from the others.
const FEWEST: usize = 5;
/// A part of a focal length by which photos of one lens come out apart, ...
const LEAST: f64 = 0.005;
/// ... and so many times their own deviation from each other, where the ground says little of it.
const TIMES: f64 = 6.0;

/// Photos whose focal lengths are others than those of most photos of their camera; `places` are those of
/// [`Adjustment::places`].
///
/// # Errors
/// Where the trial has no solution, or the work was cancelled.
pub(super) fn of_another_length(
    model: &Reconstruction,
    places: &HashMap<u32, (Vec3, f64)>,
    whose: &Whose<'_>,
    progress: &Progress,
) -> Result<HashSet<u32>, Fault> {
    let mut of_camera: HashMap<u32, Vec<u32>> = HashMap::new();
    for image in model.registered_images() {
        if let Some(camera) = model.image(image).map(|image| image.camera_id) {
            of_camera.entry(camera).or_default().push(image);
        }
    }
    of_camera.retain(|_, images| images.len() >= FEWEST);
    let images: HashSet<u32> = of_camera.values().flatten().copied().collect();
    let mut other = HashSet::new();
    if images.is_empty() {
        return Ok(other);
    }
    let mut tried = with_own_lenses(model, &images)?;
    let whose = &whose.again(&tried);
    // What is stated counts little once points fit: not before lenses are nearly right.
    for _ in 0..2 {
        let trial = Adjustment {
            images: HashSet::new(),
            places: places.clone(),
            whose,
            weighed: Weighed::ByItsPixels,
            iterations: 30,
        };
        adjust(&mut tried, trial, progress)?;
    }
    let length = |image: u32| {
        let camera = tried.camera(tried.image(image)?.camera_id)?;
        Some((image, camera.mean_focal().ln()))
    };
    for images in of_camera.values() {
        let lengths: Vec<(u32, f64)> = images.iter().filter_map(|&image| length(image)).collect();
        let mut numbers: Vec<f64> = lengths.iter().map(|(_, length)| *length).collect();
        let Some([middle, deviation]) = median_with_deviation(&mut numbers) else {
            continue;
        };
        let most = LEAST.max(TIMES * deviation);
        let apart = |(_, length): &&(u32, f64)| (length - middle).abs() > most;
        other.extend(lengths.iter().filter(apart).map(|(image, _)| *image));
    }
    Ok(other)
}

/// The same model with a lens of its own for each of these photos, which begins as that of the others.
///
/// # Errors
/// Where the model contradicts itself.
pub(super) fn with_own_lenses(
    model: &Reconstruction,
    images: &HashSet<u32>,
) -> Result<Reconstruction, Fault> {
    made(model, images).map_err(|_| failed("making a camera"))
}

fn made(model: &Reconstruction, images: &HashSet<u32>) -> Result<Reconstruction, Error> {
    let mut made = with_cameras_of(model)?;
    let mut own = HashMap::new();
    let free = model.cameras().keys().max().map_or(1, |most| most + 1);
    let mut sorted: Vec<u32> = images.iter().copied().collect();
    sorted.sort_unstable();
    for (id, image) in (free..).zip(sorted) {
        let of = model
            .image(image)
            .and_then(|image| model.camera(image.camera_id));
        if let Some(camera) = of {
            let mut camera = camera.clone();
            camera.camera_id = id;
            add_camera(&mut made, camera)?;
            own.insert(image, id);
        }
    }
    for image in model.images() {
        let id = image.image_id;
        let camera = own.get(&id).copied().unwrap_or(image.camera_id);
        let pixels = image.points2d().iter().map(|point| point.xy);
        let new = Image::new(id, &image.name, camera, pixels);
        add_image(&mut made, new, model.world_to_cam(id))?;
    }
    for (id, point) in model.points3d() {
        made.add_point3d_with_id(id, point.clone())?;
    }
    Ok(made)
}
