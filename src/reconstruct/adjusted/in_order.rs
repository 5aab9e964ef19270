//! A model whose photos are numbered as those of the folder: programs number them in the order in which their threads
//! ended.

use cumulus3d_core::reconstruction::{Image, Point3D, Rig, TrackEntry};
use cumulus3d_core::{Error, Reconstruction, Vec2};

use super::failed;
use crate::fault::Fault;
use crate::photo_set::PhotoSet;

/// The same, with a photo's place in the folder, from 1, as its identifier. Photos of other names are left out.
///
/// # Errors
/// Where the model contradicts itself.
pub(crate) fn in_order(model: &Reconstruction, photos: &PhotoSet) -> Result<Reconstruction, Fault> {
    with_pixels(model, photos, |_, _, _, pixel| pixel)
}

/// The same with other pixels: of a photo's identifier in `model` and its camera's, the pixel's number, and what it
/// is.
///
/// # Errors
/// Likewise.
pub(super) fn with_pixels(
    model: &Reconstruction,
    photos: &PhotoSet,
    pixel: impl FnMut(u32, u32, usize, Vec2) -> Vec2,
) -> Result<Reconstruction, Fault> {
    numbered(model, photos, pixel).map_err(|_| failed("reading the model"))
}

fn numbered(
    model: &Reconstruction,
    photos: &PhotoSet,
    mut changed: impl FnMut(u32, u32, usize, Vec2) -> Vec2,
) -> Result<Reconstruction, Error> {
    let mut made = Reconstruction::new();
    for (&id, camera) in model.cameras() {
        made.add_camera(camera.clone())?;
        made.add_rig(Rig::trivial(id))?;
    }
    let mut names = std::collections::HashMap::new();
    for (id, photo) in (1..).zip(&photos.photos) {
        let Some(image) = model.image_by_name(&photo.name) else {
            continue;
        };
        let (was, camera) = (image.image_id, image.camera_id);
        let pixels = image.points2d().iter().enumerate();
        let pixels = pixels.map(|(number, point)| changed(was, camera, number, point.xy));
        let new = Image::new(id, &photo.name, camera, pixels);
        let pose = model.world_to_cam(image.image_id);
        made.add_image_own_frame(new, pose)?;
        if pose.is_some() {
            made.register_image(id)?;
        }
        names.insert(image.image_id, id);
    }
    for (id, point) in model.points3d() {
        let seen = point.track.iter().filter_map(|seen| {
            let image = names.get(&seen.image_id)?;
            Some(TrackEntry::new(*image, seen.point2d_idx))
        });
        let point = Point3D {
            track: seen.collect(),
            ..point.clone()
        };
        made.add_point3d_with_id(id, point)?;
    }
    Ok(made)
}
