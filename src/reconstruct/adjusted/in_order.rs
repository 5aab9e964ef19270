//! A model whose photos are numbered as those of the folder: programs number them in the order in which their threads
//! ended.

use cumulus3d_core::reconstruction::{Image, Point3D, Rig, TrackEntry};
use cumulus3d_core::{Camera, Error, Reconstruction, Rigid3, Vec2};

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
    let mut made = with_cameras_of(model)?;
    let mut names = std::collections::HashMap::new();
    for ((id, photo), called) in (1..).zip(&photos.photos).zip(called) {
        let Some(image) = model.image_by_name(called) else {
            continue;
        };
        let (was, camera) = (image.image_id, image.camera_id);
        let pixels = image.points2d().iter().enumerate();
        let pixels = pixels.map(|(number, point)| changed(was, camera, number, point.xy));
        let new = Image::new(id, &photo.name, camera, pixels);
        add_image(&mut made, new, model.world_to_cam(was))?;
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

/// A model without photos that has the cameras of another.
pub(super) fn with_cameras_of(model: &Reconstruction) -> Result<Reconstruction, Error> {
    let mut made = Reconstruction::new();
    for camera in model.cameras().values() {
        add_camera(&mut made, camera.clone())?;
    }
    Ok(made)
}

/// Adds a camera, which is a rig by itself.
pub(super) fn add_camera(model: &mut Reconstruction, camera: Camera) -> Result<(), Error> {
    let id = camera.camera_id;
    model.add_camera(camera)?;
    model.add_rig(Rig::trivial(id))?;
    Ok(())
}

/// Adds a photo, which is placed where it has a pose.
pub(super) fn add_image(
    model: &mut Reconstruction,
    image: Image,
    pose: Option<Rigid3>,
) -> Result<(), Error> {
    let id = image.image_id;
    model.add_image_own_frame(image, pose)?;
    if pose.is_some() {
        model.register_image(id)?;
    }
    Ok(())
}
