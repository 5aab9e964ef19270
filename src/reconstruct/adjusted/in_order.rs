//! A model whose photos are numbered as those of the folder: programs number them in the order in which their threads
//! ended.

use cumulus3d_core::reconstruction::{Image, Point3D, Rig, TrackEntry};
use cumulus3d_core::{Error, Reconstruction, Vec2};

use super::failed;
use crate::fault::Fault;
use crate::photo_set::PhotoSet;

/// The same, with a photo's place in the folder, from 1, as its identifier, and its name there: `called` has the model's name of
/// each photo. Photos of other names are left out.
///
/// # Errors
/// Where the model contradicts itself.
pub(crate) fn in_order(
    model: &Reconstruction,
    photos: &PhotoSet,
    called: &[String],
) -> Result<Reconstruction, Fault> {
    let called = called.iter().map(String::as_str);
    numbered(model, photos, called, |_, _, _, pixel| pixel).map_err(|_| failed("reading the model"))
}

/// The same of a model that calls the photos as the folder does, with other pixels: of a photo's identifier in `model` and its camera's, the pixel's number, and what it
/// is.
///
/// # Errors
/// Likewise.
pub(super) fn with_pixels(
    model: &Reconstruction,
    photos: &PhotoSet,
    pixel: impl FnMut(u32, u32, usize, Vec2) -> Vec2,
) -> Result<Reconstruction, Fault> {
    let called = photos.photos.iter().map(|photo| photo.name.as_str());
    numbered(model, photos, called, pixel).map_err(|_| failed("reading the model"))
}

fn numbered<'a>(
    model: &Reconstruction,
    photos: &PhotoSet,
    called: impl Iterator<Item = &'a str>,
    mut changed: impl FnMut(u32, u32, usize, Vec2) -> Vec2,
) -> Result<Reconstruction, Error> {
    let mut made = Reconstruction::new();
    for (&id, camera) in model.cameras() {
        made.add_camera(camera.clone())?;
        made.add_rig(Rig::trivial(id))?;
    }
    let mut names = std::collections::HashMap::new();
    for ((id, photo), called) in (1..).zip(&photos.photos).zip(called) {
        let Some(image) = model.image_by_name(called) else {
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
