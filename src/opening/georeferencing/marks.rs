//! Ground control points found in the reconstruction, from their marks in photos.

use glam::{DVec2, DVec3};

use super::photo_names::PhotoNames;
use super::{Georeferenced, LEAST_SURVEYED};
use crate::camera::{Camera, Pose};
use crate::control::{ControlList, Located, MarkedView, POOR_PX, locate};
use crate::fault::{Fault, first_names};
use crate::formats::Reconstruction;
use crate::formats::photos::photo_folder::PhotoFolder;
use crate::geometry::median;
use crate::numbers::significant_digits;

/// Who clicks a mark does it to about a pixel.
const LEAST_MARK_ERROR_PX: f64 = 1.0;

/// Surveyed points are known to about so much, metres: satellites with a base (RTK).
const SURVEY_ERROR: f64 = 0.03;

/// Marks that miss each other by this share of a photo's longer side, in the median of points, are no carelessness: 20 pixels of 4000.
const OF_OTHERS: f64 = 0.005;

/// So many times what marks and survey allow is no accident.
const CONTRADICTS: f64 = 5.0;

/// A control point that was triangulated.
#[derive(Debug, Clone)]
pub(super) struct MarkedPoint {
    pub(super) name: String,
    /// As the list states it; `None` where it is the end of a scale bar alone.
    pub(super) position: Option<DVec3>,
    /// Of the photos that it is marked in, pixels.
    pub(super) longer_side: f64,
    /// In the reconstruction's frame.
    pub(super) found: Located,
}

/// Triangulates the points that are marked in two photos at least; what cannot be is said in
/// `warnings`.
pub(super) fn triangulated(
    reconstruction: &Reconstruction,
    points: &ControlList,
    folder: &PhotoFolder<'_>,
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
    let mut unknown: Vec<&str> = listed
        .iter()
        .copied()
        .filter(|name| names.find(name).is_none())
        .collect();
    unknown.sort_unstable();
    unknown.dedup();
    if !unknown.is_empty() {
        warnings.push(format!(
            "marks in photos that the reconstruction does not have are left out: {}",
            first_names(&unknown)
        ));
    }
    let mut found = Vec::new();
    for point in &points.points {
        let mut seen: Vec<(&str, Camera, Pose, DVec2)> = Vec::new();
        for (photo, pixel) in &point.marks {
            let Some(photo) = names
                .find(photo)
                .and_then(|index| reconstruction.photos.get(index))
            else {
                continue;
            };
            let camera = camera_of(reconstruction, photo.camera, &photo.name, folder)?;
            if !camera.contains(*pixel) {
                return Err(outside(&point.name, &photo.name, *pixel, &camera));
            }
            seen.push((&photo.name, camera, photo.pose, *pixel));
        }
        let views: Vec<MarkedView<'_>> = (seen.iter())
            .map(|(_, camera, pose, pixel)| MarkedView {
                camera,
                pose,
                pixel: *pixel,
            })
            .collect();
        match locate(&views) {
            Ok(located) => {
                let rms = located.rms_px();
                if rms > POOR_PX {
                    warnings.push(format!(
                        "control point '{}': its marks miss each other by {rms:.0} px",
                        point.name
                    ));
                }
                if let Some((photo, ..)) = located.suspect.and_then(|place| seen.get(place)) {
                    warnings.push(format!(
                        "control point '{}': its mark in '{photo}' is probably on another thing, the others agree without it",
                        point.name
                    ));
                }
                let longer_side = seen
                    .iter()
                    .map(|(_, camera, ..)| camera.width.max(camera.height));
                found.push(MarkedPoint {
                    name: point.name.clone(),
                    position: point.position,
                    longer_side: f64::from(longer_side.max().unwrap_or(1)),
                    found: located,
                });
            }
            Err(fault) => warnings.push(format!(
                "control point '{}' is left out: {}",
                point.name, fault.what
            )),
        }
    }
    warnings.extend(names.warning);
    refuse_of_others(&found)?;
    if found.is_empty() {
        return Err(Fault::new(
            "none of its control points is marked in two photos of the reconstruction",
            "check that the marks are in these photos",
        ));
    }
    Ok(found)
}

/// Marks that miss each other all over are of photos of another size, or of others: a fit of them says what it likes.
fn refuse_of_others(marked: &[MarkedPoint]) -> Result<(), Fault> {
    let misses = marked.iter().map(|point| point.found.rms_px());
    let shares = marked
        .iter()
        .map(|point| point.found.rms_px() / point.longer_side);
    let share = median(&mut shares.collect::<Vec<f64>>()).unwrap_or_default();
    let miss = median(&mut misses.collect::<Vec<f64>>()).unwrap_or_default();
    match marked.len() >= LEAST_SURVEYED && share > OF_OTHERS {
        true => Err(Fault::new(
            format!(
                "the marks of its control points miss each other by {miss:.0} px (median): they are of photos of another size, or of others"
            ),
            "give the folder of the photos that they were made in (--photos), or mark them anew",
        )),
        false => Ok(()),
    }
}

/// How far marks are off, pixels along columns and rows: as far as those of all points miss each other, and a pixel at least.
pub(super) fn mark_error_px(marked: &[MarkedPoint]) -> f64 {
    let marks = marked.iter().flat_map(|point| &point.found.residuals_px);
    let marks: Vec<f64> = marks.copied().flatten().collect();
    let squares: f64 = marks.iter().map(|residual| residual * residual).sum();
    let free = 2.0 * marks.len() as f64 - 3.0 * marked.len() as f64;
    (squares / free.max(1.0)).sqrt().max(LEAST_MARK_ERROR_PX)
}

/// That the control points of a fit are off by much more than their marks and a survey allow; `None` where they are not.
pub(super) fn contradiction(marked: &[MarkedPoint], fit: &Georeferenced) -> Option<String> {
    let rms = fit.rms?;
    let used = fit.positions.iter().filter(|position| position.used);
    let used = used.filter_map(|position| marked.iter().find(|point| point.name == position.name));
    let variances: Vec<f64> = used
        .map(|point| {
            let covariance = point.found.covariance;
            covariance.x_axis.x + covariance.y_axis.y + covariance.z_axis.z
        })
        .collect();
    let mean = variances.iter().sum::<f64>() / variances.len() as f64;
    let by_marks = mark_error_px(marked) * mean.sqrt() * fit.similarity.scale;
    let allowed = by_marks.hypot(SURVEY_ERROR / fit.unit.metres());
    // No number where no control point was used: then nothing is said.
    (rms > CONTRADICTS * allowed).then(|| {
        format!(
            "the control points are {} {unit} off from where they were surveyed (RMS), where marks and survey allow {} {unit}: a typing error \
             in one of them, heights in another unit, or a mark on another thing",
            significant_digits(rms, 2),
            significant_digits(allowed, 2),
            unit = fit.unit
        )
    })
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
