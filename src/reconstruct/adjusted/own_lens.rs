//! Photos that may have been zoomed, cropped or stabilised, which their files do not say: by the others they stand elsewhere than
//! their receivers, sure of it, say. Under one lens with the others they bend the whole model; with a lens of its own a photo
//! that was not does no harm.

use std::collections::{HashMap, HashSet};

use cumulus3d_core::reconstruction::{Image, Rig};
use cumulus3d_core::{Error, Reconstruction};

use super::failed;
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
    let mut made = Reconstruction::new();
    for (&id, camera) in model.cameras() {
        made.add_camera(camera.clone())?;
        made.add_rig(Rig::trivial(id))?;
    }
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
            made.add_camera(camera)?;
            made.add_rig(Rig::trivial(id))?;
            own.insert(image, id);
        }
    }
    for image in model.images() {
        let id = image.image_id;
        let camera = own.get(&id).copied().unwrap_or(image.camera_id);
        let pixels = image.points2d().iter().map(|point| point.xy);
        let pose = model.world_to_cam(id);
        made.add_image_own_frame(Image::new(id, &image.name, camera, pixels), pose)?;
        if pose.is_some() {
            made.register_image(id)?;
        }
    }
    for (id, point) in model.points3d() {
        made.add_point3d_with_id(id, point.clone())?;
    }
    Ok(made)
}
