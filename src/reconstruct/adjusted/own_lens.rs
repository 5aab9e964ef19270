//! Photos that may have been zoomed, cropped or stabilised, which their files do not say: by the others they stand elsewhere than
//! their receivers, sure of it, say. Under one lens with the others they bend the whole model; with a lens of its own a photo
//! that was not does no harm.

use std::collections::{HashMap, HashSet};

use cumulus3d_core::reconstruction::Image;
use cumulus3d_core::{Error, Reconstruction};

use super::failed;
use super::in_order::{add_camera, add_image, with_cameras_of};
use crate::fault::Fault;

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
