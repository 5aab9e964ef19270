//! Ground control points found in the reconstruction, from their marks in photos.

use std::path::Path;

use glam::{DVec2, DVec3};

use super::photo_names::PhotoNames;
use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::formats::Reconstruction;
use crate::formats::photos::photo_folder::PhotoFolder;
use crate::formats::poses::position_list::ControlPoints;
use crate::georeference::{Sight, Triangulated, triangulate};

/// Marks that fit worse, in pixels, are pointed out.
const POOR_PX: f64 = 10.0;

/// A control point that was triangulated.
#[derive(Debug, Clone)]
pub(super) struct MarkedPoint {
    pub(super) name: String,
    /// As the list states it.
    pub(super) position: DVec3,
    /// In the reconstruction's frame.
    pub(super) found: Triangulated,
}

/// Triangulates the points that are marked in two photos at least; what cannot be is said in
/// `warnings`.
pub(super) fn triangulated(
    reconstruction: &Reconstruction,
    points: &ControlPoints,
    folder: Option<&Path>,
    warnings: &mut Vec<String>,
) -> Result<Vec<MarkedPoint>, Fault> {
    let marked = points.points.iter().flat_map(|point| &point.marks);
    let listed: Vec<&str> = marked.map(|(photo, _)| photo.as_str()).collect();
    if listed.is_empty() {
        return Err(Fault::new(
            "its control points are marked in no photo",
            "give a list with the photo and the pixel of each mark, as OpenDroneMap's gcp_list.txt",
        ));
    }
    let names = PhotoNames::new(
        reconstruction.photos.iter().map(|p| p.name.as_str()),
        &listed,
    );
    let folder = PhotoFolder::new(folder);
    let mut found = Vec::new();
    for point in &points.points {
        let mut sights = Vec::new();
        let mut views: Vec<(Camera, Pose)> = Vec::new();
        for (photo, pixel) in &point.marks {
            let Some(photo) = names
                .find(photo)
                .and_then(|index| reconstruction.photos.get(index))
            else {
                continue;
            };
            let camera = camera_of(reconstruction, photo.camera, &photo.name, &folder)?;
            if !camera.contains(*pixel) {
                return Err(outside(&point.name, &photo.name, *pixel, &camera));
            }
            let Ok(direction) = camera.direction_as_shot(*pixel) else {
                continue;
            };
            sights.push(Sight {
                origin: photo.pose.center,
                direction: photo.pose.rotation * direction,
                pixel: *pixel,
            });
            views.push((camera, photo.pose));
        }
        let project = |index: usize, place: DVec3| {
            let (camera, pose) = views.get(index)?;
            camera.pixel_as_shot(pose.camera_from_world(place))
        };
        match triangulate(&sights, project) {
            Ok(triangulated) => {
                let rms = triangulated.rms_px();
                if rms > POOR_PX {
                    warnings.push(format!(
                        "control point '{}': its marks miss each other by {rms:.0} px",
                        point.name
                    ));
                }
                found.push(MarkedPoint {
                    name: point.name.clone(),
                    position: point.position,
                    found: triangulated,
                });
            }
            Err(fault) => warnings.push(format!(
                "control point '{}' is left out: {}",
                point.name, fault.what
            )),
        }
    }
    warnings.extend(names.warning);
    if found.is_empty() {
        return Err(Fault::new(
            "none of its control points is marked in two photos of the reconstruction",
            "check that the marks are in these photos",
        ));
    }
    Ok(found)
}

/// The camera of a photo, for the size of its file.
fn camera_of(
    reconstruction: &Reconstruction,
    camera: usize,
    photo: &str,
    folder: &PhotoFolder<'_>,
) -> Result<Camera, Fault> {
    let missing = || Fault::new(format!("photo '{photo}' has no camera"), "export it again");
    let camera = reconstruction.cameras.get(camera).ok_or_else(missing)?;
    let size = folder.size_of(photo).and_then(Result::ok);
    match (reconstruction.sizes.are_known(), size) {
        (true, Some((width, height))) if (width, height) != (camera.width, camera.height) => {
            camera.rescaled(width, height).map_err(|e| {
                Fault::new(
                    format!("photo '{photo}': {e}"),
                    "give the photos that the package was given",
                )
            })
        }
        (true, _) => Ok(camera.clone()),
        (false, Some((width, height))) => Ok(reconstruction.sized(camera, width, height)),
        (false, None) => Err(Fault::new(
            format!("the image size of '{photo}' is not known, so its marks cannot be placed"),
            "give the folder of the photos (--photos)",
        )),
    }
}

fn outside(point: &str, photo: &str, pixel: DVec2, camera: &Camera) -> Fault {
    Fault::new(
        format!(
            "the mark of '{point}' at {}, {} lies outside photo '{photo}' of {} x {}",
            pixel.x, pixel.y, camera.width, camera.height
        ),
        "give the folder of the photos that it was marked in (--photos)",
    )
}
