//! Photos alone, as a reconstruction: where each was taken and which way its camera looked, as its
//! EXIF and XMP say (`photo_metadata` is the specification of those). With a cloud this is a flight
//! without any structure from motion.
//!
//! Positions are (degrees east, degrees north, metres up) in EPSG:4326, or 4979 where all heights are above the ellipsoid; rotations take camera axes to
//! east, north, up at the photo's own place. Photos that do not say where they were or which way the
//! camera looked, or say it in a way that is not known, are left out and counted; those with a place
//! alone still are measured positions.
//! Photos of one maker, model, camera, size and source of the focal length share a camera.
//!
//! Beside photos of DJI's drones with RTK there may be a `*_Timestamp.MRK`: its places, which have
//! more digits and heights above the ellipsoid, go before EXIF's for the photos whose numbers it
//! names, if they agree within 20 m.
//!
//! Standard deviations that the receiver states for all three axes (XMP of DJI, Pix4D's, Skydio's; the
//! .MRK) are those of the poses, which nothing adjusted; where none are stated, those that such receivers
//! usually have. EXIF's GPSHPositioningError is not taken: it has no height, and its definition names no
//! probability. Of angles nothing states any.
//!
//! The errors to be expected are said in warnings, because they are the scale's errors: the focal
//! length's part as it is, and the height's part of the distance to the ground. They are counted in the
//! intervals as standard deviations, that of the focal length as the largest of all cameras.

mod cameras;
mod marks;

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec3;

use crate::fault::{Fault, first_names};
use crate::files::FileError;
use crate::jobs::Progress;
use crate::packages::LOOKED_AT;
use crate::packages::pose_covariance::PoseCovariance;
use crate::packages::reconstruction::{
    MeasuredPosition, PosedPhoto, Project, Reconstruction, Sizes,
};
use crate::photos::photo_metadata::{self, Fix, HeightReference, MeasuredPlace, PhotoMetadata};
use crate::photos::photos_below::photos_in;
pub use cameras::Cameras;

/// What photos without a cloud may become.
const RECONSTRUCT: &str = "these are photos alone; where they overlap, 'fragscale reconstruct' or File > New from \
     photos… makes a flight of them";

/// Photos alone: what they say, and the flight that they make.
#[derive(Debug)]
pub struct PhotosAlone {
    /// Those that can be read, by name.
    pub photos: Vec<(String, PhotoMetadata)>,
    /// Their flight; else why none of them can be placed.
    pub project: Result<Project, Fault>,
}

/// Whether one of a folder's photos, of as many as are looked at, says where it was taken and which way its camera looked.
pub(crate) fn has_placed(folder: &Path) -> bool {
    let says_both = |photo: PhotoMetadata| {
        let is_somewhere = photo.place.is_some_and(|place| place.height.is_some());
        is_somewhere && photo.orientation.is_some()
    };
    let photos = photos_in(folder).unwrap_or_default();
    let mut looked_at = photos.iter().take(LOOKED_AT);
    looked_at.any(|photo| photo_metadata::read_file(photo).is_ok_and(says_both))
}

/// Reads a folder of photos, or one photo.
///
/// # Errors
/// Where no photo says where it was taken and which way its camera looked.
pub(crate) fn read(path: &Path, progress: &Progress) -> Result<Project, FileError> {
    let project = read_alone(path, progress)?.project;
    project.map_err(|fault| FileError::new(path, fault))
}

/// The same, but photos that cannot be placed are read, too.
///
/// # Errors
/// Where the folder cannot be read, or an .MRK in it.
pub fn read_alone(path: &Path, progress: &Progress) -> Result<PhotosAlone, FileError> {
    let (folder, files) = if path.is_dir() {
        (path.to_owned(), photos_in(path)?)
    } else {
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        (folder, vec![path.to_owned()])
    };
    progress.stage(format!("reading the headers of {} photos", files.len()));
    let mut photos = Vec::new();
    let mut left_out = LeftOut::default();
    for file in &files {
        let name = file.file_name().unwrap_or_default();
        let name = name.to_string_lossy().into_owned();
        match photo_metadata::read_file(file) {
            Ok(metadata) => photos.push((name, metadata)),
            Err(error) => left_out.add("cannot be read", format!("{name}: {}", error.fault)),
        }
    }
    let warnings = marks::correct(&folder, &mut photos)?;
    let found = reconstruction_of(&photos, left_out, files.len(), warnings);
    Ok(PhotosAlone {
        project: found.map(|reconstruction| Project {
            reconstruction,
            photos: Some(folder),
            surface_note: Some(RECONSTRUCT.to_owned()),
            ..Project::default()
        }),
        photos,
    })
}

/// The flight of these photos, of `count` with those that are left out already.
///
/// # Errors
/// Where none can be placed.
fn reconstruction_of(
    photos: &[(String, PhotoMetadata)],
    mut left_out: LeftOut,
    count: usize,
    mut warnings: Vec<String>,
) -> Result<Reconstruction, Fault> {
    let mut reconstruction = Reconstruction {
        package: "photos",
        crs: Some("EPSG:4326".to_owned()),
        sizes: Sizes::Known,
        ..Reconstruction::default()
    };
    let mut cameras = Cameras::default();
    let mut posed = Vec::new();
    for (name, metadata) in photos {
        let Some(place) = metadata.place else {
            left_out.add("have no position", name.clone());
            continue;
        };
        let place = place.place;
        reconstruction.measured_positions.push(MeasuredPosition {
            photo: name.clone(),
            position: place,
        });
        let Some(orientation) = &metadata.orientation else {
            left_out.add(no_orientation(metadata), name.clone());
            continue;
        };
        if metadata.place.is_none_or(|place| place.height.is_none()) {
            left_out.add("have a position without a height", name.clone());
            continue;
        }
        let Some(camera) = cameras.of(metadata) else {
            left_out.add("do not say their focal length", name.clone());
            continue;
        };
        let center = DVec3::new(place.longitude, place.latitude, place.height);
        reconstruction.photos.push(PosedPhoto {
            name: name.clone(),
            camera,
            pose: orientation.pose(center),
        });
        let deviation = metadata.place.and_then(expected_deviation);
        let errors = PoseCovariance::of_deviations(deviation, None);
        reconstruction.pose_errors.push(errors);
        posed.push(metadata);
    }
    // Of all of them, or nothing is said for all.
    let is_above_ellipsoid = |photo: &&PhotoMetadata| {
        photo.place.and_then(|place| place.height) == Some(HeightReference::Ellipsoid)
    };
    if !posed.is_empty() && posed.iter().all(is_above_ellipsoid) {
        reconstruction.crs = Some("EPSG:4979".to_owned());
    }
    if reconstruction.photos.is_empty() {
        return Err(left_out.all(count));
    }
    warnings.extend(left_out.sentences(count));
    warnings.extend(cameras.warnings(&posed));
    warnings.extend(of_places(&posed));
    let said = photos
        .iter()
        .map(|(name, metadata)| (name.as_str(), metadata));
    warnings.extend(photo_metadata::warnings_of(said));
    reconstruction.errors.focal = cameras.largest_error().map(|error| error * 100.0);
    reconstruction.cameras = cameras.into_cameras();
    reconstruction.warnings = warnings;
    Ok(reconstruction)
}

/// What places of a fix are in words, and the standard deviations that such receivers have towards east,
/// north and up, metres. `None` without a fix.
fn usual(fix: Option<Fix>) -> (&'static str, Option<DVec3>) {
    let (words, deviation) = match fix {
        Some(Fix::RtkFixed) => ("RTK fixed: a few centimetres", [0.03, 0.03, 0.05]),
        Some(Fix::RtkFloat) => ("RTK float: decimetres to metres", [0.5, 0.5, 1.0]),
        Some(Fix::Single) => (
            "without corrections: some 2 m across and 5 m in height",
            [2.0, 2.0, 5.0],
        ),
        Some(Fix::Nothing) => return ("without a fix: not to be trusted", None),
        None => (
            "of unknown quality, most likely some 2 m across and 5 m in height",
            [2.0, 2.0, 5.0],
        ),
    };
    (words, Some(DVec3::from_array(deviation)))
}

/// Standard deviations of a place towards east, north and up in metres: as the receiver states them, else
/// the usual ones. `None` without either.
pub fn expected_deviation(place: MeasuredPlace) -> Option<DVec3> {
    let Some(usual) = usual(place.fix).1 else {
        return place.deviation;
    };
    let height = match place.height {
        // Set at take-off: tens of metres.
        Some(HeightReference::Barometer) => usual.z.max(20.0),
        _ => usual.z,
    };
    Some(place.deviation.unwrap_or(usual.with_z(height)))
}

/// Photos that are left out, by the reason.
#[derive(Default)]
struct LeftOut {
    by_reason: BTreeMap<String, Vec<String>>,
}

impl LeftOut {
    fn add(&mut self, reason: impl Into<String>, photo: String) {
        self.by_reason.entry(reason.into()).or_default().push(photo);
    }

    fn sentences(&self, all: usize) -> impl Iterator<Item = String> {
        self.by_reason.iter().map(move |(reason, photos)| {
            let count = photos.len();
            format!(
                "{count} of {all} photos are left out, because they {reason} ({})",
                first_names(photos)
            )
        })
    }

    /// Why nothing is left.
    fn all(&self, all: usize) -> Fault {
        let reasons = self.by_reason.iter().map(|(reason, photos)| {
            format!(
                "{} of {all} {reason} ({})",
                photos.len(),
                first_names(photos)
            )
        });
        let reasons: Vec<String> = reasons.collect();
        Fault::new(
            format!(
                "photos that do not say enough to place them: {}",
                reasons.join(", ")
            ),
            "give the reconstruction that was made from them, or a poses.csv, or reconstruct them here: 'fragscale reconstruct', File > New from photos…",
        )
    }
}

/// Why it is not known which way a photo's camera looked.
fn no_orientation(photo: &PhotoMetadata) -> String {
    match photo.unknown_angles.as_slice() {
        [] => "do not say which way the camera looked".to_owned(),
        uris => format!(
            "have angles in the XMP namespace '{}', of which it is not known whether they are the camera's and how they count",
            uris.join("', '")
        ),
    }
}

/// What is to be said of the photos' places: their heights' reference, how far off they may be, and
/// how high above the take-off they are.
fn of_places(photos: &[&PhotoMetadata]) -> Vec<String> {
    let places: Vec<MeasuredPlace> = photos.iter().filter_map(|photo| photo.place).collect();
    let mut warnings = Vec::new();
    let relative: Vec<f64> = photos.iter().filter_map(|p| p.relative_altitude).collect();
    let above_take_off = range(&relative).map_or_else(String::new, |(low, high)| {
        format!("; the photos say {low:.1} to {high:.1} m above the take-off")
    });
    let mut references: BTreeMap<HeightReference, usize> = BTreeMap::new();
    for reference in places.iter().filter_map(|place| place.height) {
        *references.entry(reference).or_default() += 1;
    }
    for (reference, count) in references {
        warnings.push(format!(
            "the heights of {count} photos {}{above_take_off}",
            reference.in_words()
        ));
    }
    let mut fixes: BTreeMap<Option<Fix>, Vec<Option<DVec3>>> = BTreeMap::new();
    for place in &places {
        fixes.entry(place.fix).or_default().push(place.deviation);
    }
    for (fix, deviations) in fixes {
        let count = deviations.len();
        let (what, _) = usual(fix);
        let worst = deviations.iter().flatten().copied().reduce(DVec3::max);
        let stated = worst.map_or_else(String::new, |worst| {
            let across = worst.x.max(worst.y);
            format!(
                " (the receiver states up to {across:.2} m across, {:.2} m in height)",
                worst.z
            )
        });
        warnings.push(format!(
            "the positions of {count} photos are {what}{stated}"
        ));
    }
    warnings
}

fn range(values: &[f64]) -> Option<(f64, f64)> {
    let first = *values.first()?;
    let wider = |(low, high): (f64, f64), &value: &f64| (low.min(value), high.max(value));
    Some(values.iter().fold((first, first), wider))
}

#[cfg(test)]
mod tests;
