//! Agisoft Metashape (before 2019: PhotoScan): `cameras.xml`, as File > Export > Export Cameras
//! writes it, and the projects `.psx` and `.psz`.
//!
//! Agisoft publishes no schema. Written from the Metashape manual (camera models), Agisoft's support
//! and forum, and what EasyIDP, DBAT, nerfstudio and Meta's KRT converter read; the conventions were
//! measured in `shared/data/metashape-wheat-gcp` (triangulated markers reproject to 1.9 px).
//!
//! ```text
//! <document version=""> <chunk label="" enabled="">     cameras.xml
//!   <sensors> <sensor>...                               see cameras.rs, calibration.rs
//!   <components> <component> <transform>...             see georeference.rs
//!   <cameras> [<group>] <camera>...                     see cameras.rs
//!   <transform> <reference>                             see georeference.rs
//! ```
//!
//! - A document of several chunks, which share no frame: the active one is read if it has an aligned
//!   photo, else the first that has. An XML whose root is `<chunk>` (a project's) reads as well.
//! - Photos are named by their label, in projects by their file.
//! - Tie points of a .psx: `points.rs`. Not read: `<region>`, `<markers>`, `<settings>`, dense
//!   clouds and models.
//!
//! The text that the same dialogue exports with angles: `opk.rs`.

mod calibration;
mod cameras;
#[cfg(test)]
mod error_tests;
mod georeference;
mod names;
mod opk;
mod points;
mod project;
#[cfg(test)]
mod tests;
mod xml;

use std::collections::{BTreeMap, HashMap};

use roxmltree::Node;

pub(crate) use calibration::read as read_calibration;
pub(crate) use opk::{is_opk, read as read_opk};
pub(crate) use project::read_project;

use self::cameras::{Photo, Sensor, count_components, photos, sensors};
use self::georeference::{Kept, Placing, Reference, moved};
use self::points::TiePoints;
use self::xml::{child, children, is_off, root_element};
use crate::MeasuredPosition;
use crate::PosedPhoto;
use crate::Reconstruction;
use crate::Sizes;
use crate::fault::Fault;
use crate::geodesy::{Crs, geographic_from_ecef};
use crate::geometry::Similarity;

/// What to do where no photo can be used.
const ALIGN: &str = "align the photos in Metashape, then export the cameras again";

/// Recognises a cameras.xml or a project by its name in lower case and its first bytes.
pub(crate) fn is_project(name: &str, start: &[u8]) -> bool {
    let has = |tag: &[u8]| start.windows(tag.len()).any(|window| window == tag);
    match root_element(start) {
        Some("document") => name.ends_with(".psx") || has(b"<chunk") || has(b"{projectname}"),
        Some("chunk") => has(b"<sensors"),
        _ => name.ends_with(".psz") && start.starts_with(b"PK"),
    }
}

/// Whether a text is a calibration file of Agisoft's.
pub(crate) fn is_calibration(text: &str) -> bool {
    root_element(text.as_bytes()) == Some("calibration")
}

/// Reads a cameras.xml, or the document of a `.psz`.
///
/// # Errors
/// Text that is not what the format says, or that holds no aligned photo.
pub(crate) fn read_xml(text: &str) -> Result<Reconstruction, Fault> {
    let document = xml::parse(text)?;
    let root = document.root_element();
    let chunks: Vec<Node<'_, '_>> = match root.tag_name().name() {
        "chunk" => vec![root],
        _ => {
            let listed = children(root, "chunks").flat_map(|list| children(list, "chunk"));
            children(root, "chunk").chain(listed).collect()
        }
    };
    if chunks.iter().any(|chunk| chunk.has_attribute("path")) {
        let what = "it only lists the chunks of a project";
        return Err(Fault::new(what, "open the project's .psx file"));
    }
    let active = child(root, "chunks").and_then(|list| list.attribute("active_id"));
    let aligned = chunks.iter().filter(|chunk| has_aligned(**chunk));
    let chosen = aligned
        .clone()
        .find(|chunk| active.is_some() && chunk.attribute("id") == active)
        .or_else(|| aligned.clone().find(|chunk| !is_off(**chunk, "enabled")))
        .or_else(|| aligned.clone().next());
    let Some(&chunk) = chosen else {
        return Err(Fault::new("it holds no aligned photo", ALIGN));
    };
    let frame = child(chunk, "frames").and_then(|frames| child(frames, "frame"));
    let mut found = read_chunk(chunk, frame, None)?;
    if chunks.len() > 1 {
        found.warnings.push(one_of_chunks(chunk, chunks.len()));
    }
    Ok(found)
}

/// Says which of several chunks was read.
fn one_of_chunks(chunk: Node<'_, '_>, count: usize) -> String {
    let label = chunk.attribute("label").unwrap_or_default();
    format!("it has {count} chunks, which share no frame; only '{label}' is read")
}

/// Whether a chunk has an aligned photo.
fn has_aligned(chunk: Node<'_, '_>) -> bool {
    let is_aligned =
        |node: Node<'_, '_>| node.has_tag_name("camera") && child(node, "transform").is_some();
    child(chunk, "cameras").is_some_and(|list| list.descendants().any(is_aligned))
}

/// The files of the photos of a `<frame>`, by camera id; paths are relative to the frame's folder.
fn paths_of<'a>(frame: Option<Node<'a, '_>>) -> HashMap<&'a str, &'a str> {
    let cameras = frame.and_then(|frame| child(frame, "cameras"));
    let of_camera = |camera: Node<'a, '_>| {
        let path = child(camera, "photo")?.attribute("path")?;
        Some((camera.attribute("camera_id")?, path))
    };
    cameras
        .into_iter()
        .flat_map(|cameras| children(cameras, "camera"))
        .filter_map(of_camera)
        .collect()
}

/// Reads a chunk; `frame` names the files of its photos.
fn read_chunk(
    chunk: Node<'_, '_>,
    frame: Option<Node<'_, '_>>,
    tie_points: Option<TiePoints>,
) -> Result<Reconstruction, Fault> {
    let mut found = Reconstruction {
        package: "metashape",
        sizes: Sizes::Known,
        ..Reconstruction::default()
    };
    let sensors = sensors(chunk, &mut found.warnings)?;
    let listed = photos(chunk, &sensors, &paths_of(frame), &mut found.warnings)?;
    let reference = Reference::of_chunk(chunk);
    if let Some(crs) = reference.understood() {
        found.measured_positions = measured_positions(&listed, crs);
    }
    let enabled = listed.iter().filter(|photo| photo.enabled).count();
    let counts = [
        (listed.len() - enabled, "are disabled"),
        (
            listed
                .iter()
                .filter(|p| p.enabled && p.pose.is_none())
                .count(),
            "were not aligned",
        ),
    ];
    for (count, why) in counts.into_iter().filter(|(count, _)| *count > 0) {
        found
            .warnings
            .push(format!("{count} photos {why} and are left out"));
    }
    let mut usable: Vec<Photo<'_>> = listed;
    usable.retain(|photo| photo.enabled && photo.pose.is_some());
    leave_out_unusable(&mut usable, &sensors, &mut found.warnings)?;
    let placing = Placing::of_chunk(chunk)?;
    let kept = leave_out_components(&mut usable, &placing, &mut found.warnings);
    let photo_of_camera = add_photos(&mut found, &usable, &placing, sensors);
    if found.photos.is_empty() {
        return Err(Fault::new("it holds no photo that can be used", ALIGN));
    }
    if let Some(tie_points) = tie_points {
        let is_kept = |component: Option<&str>| match kept {
            Kept::Placed => placing.of(component).is_some(),
            Kept::Alone(alone) => component.is_none() || component == alone,
        };
        tie_points.add_to(&mut found, &placing, is_kept, &photo_of_camera);
    }
    let rolling = usable.iter().filter(|photo| photo.rolling_shutter).count();
    if rolling > 0 {
        found.warnings.push(format!(
            "{rolling} photos are compensated for their rolling shutter, which is left out: their rows are at the pose of the middle one"
        ));
    }
    if kept == Kept::Placed {
        name_world(&mut found, &reference);
    }
    Ok(found)
}

/// Drops photos whose sensor cannot be used, which is said for each sensor.
///
/// # Errors
/// Where no photo is left: the first of the sensors' faults.
fn leave_out_unusable(
    photos: &mut Vec<Photo<'_>>,
    sensors: &[Sensor],
    warnings: &mut Vec<String>,
) -> Result<(), Fault> {
    let camera_of = |sensor: Option<usize>| sensors.get(sensor?).map(|sensor| &sensor.camera);
    let fault_of = |sensor: Option<usize>| match camera_of(sensor) {
        Some(camera) => camera.as_ref().err().cloned(),
        None => Some(Fault::new("their sensor is not there", xml::EXPORT)),
    };
    let mut dropped: BTreeMap<Option<usize>, usize> = BTreeMap::new();
    photos.retain(|photo| {
        let is_usable = camera_of(photo.sensor).is_some_and(Result::is_ok);
        if !is_usable {
            *dropped.entry(photo.sensor).or_default() += 1;
        }
        is_usable
    });
    for (sensor, count) in dropped {
        let Some(fault) = fault_of(sensor) else {
            continue;
        };
        if photos.is_empty() {
            return Err(fault);
        }
        let at = fault
            .line
            .map_or_else(String::new, |line| format!(" (line {line})"));
        warnings.push(format!("{count} photos are left out: {}{at}", fault.what));
    }
    Ok(())
}

/// Drops photos of components that are in frames of their own.
fn leave_out_components<'a>(
    photos: &mut Vec<Photo<'a>>,
    placing: &Placing<'_>,
    warnings: &mut Vec<String>,
) -> Kept<'a> {
    let kept = placing.kept(&count_components(photos));
    let before = photos.len();
    photos.retain(|photo| match kept {
        Kept::Placed => placing.of(photo.component).is_some(),
        Kept::Alone(component) => photo.component == component,
    });
    let dropped = before - photos.len();
    if dropped > 0 {
        warnings.push(format!(
            "{dropped} photos are left out: they belong to components that are in frames of their own"
        ));
    }
    kept
}

/// Adds the photos in the world, and the cameras that can be used; returns where each photo went, by
/// its camera's id.
fn add_photos<'a>(
    found: &mut Reconstruction,
    photos: &[Photo<'a>],
    placing: &Placing<'_>,
    sensors: Vec<Sensor>,
) -> HashMap<&'a str, u32> {
    let mut photo_of_camera = HashMap::new();
    let focal_error_of_sensor: Vec<_> = sensors.iter().map(|sensor| sensor.focal_error).collect();
    let mut camera_of_sensor = HashMap::new();
    for (index, sensor) in sensors.into_iter().enumerate() {
        // The faults of sensors with photos are said by now.
        if let Ok(camera) = sensor.camera {
            camera_of_sensor.insert(index, found.cameras.len());
            found.cameras.push(camera);
        }
    }
    let focal_errors = photos
        .iter()
        .filter_map(|photo| focal_error_of_sensor.get(photo.sensor?).copied().flatten());
    // Of several cameras the least sure: the flight has one number.
    found.errors.focal = focal_errors.reduce(f64::max);
    for photo in photos {
        let camera = photo.sensor.and_then(|index| camera_of_sensor.get(&index));
        if let (Some(pose), Some(&camera)) = (photo.pose, camera) {
            let world = placing.of(photo.component);
            if let Ok(index) = u32::try_from(found.photos.len()) {
                photo_of_camera.insert(photo.id, index);
            }
            let to_world = |world: Similarity| world.rotation * world.scale;
            found
                .pose_errors
                .push(world.map_or(photo.errors, |world| photo.errors.moved(&to_world(world))));
            found.photos.push(PosedPhoto {
                name: photo.name.clone(),
                camera,
                pose: world.map_or(pose, |similarity| moved(&similarity, &pose)),
            });
        }
    }
    photo_of_camera
}

/// Says which frame the transform led to.
fn name_world(found: &mut Reconstruction, reference: &Reference) {
    if let Reference::Local { unit } = reference {
        found.unit = *unit;
        return;
    }
    // A chunk that was only scaled keeps the coordinate system of its photos' GPS.
    let geocentric = |photo: &PosedPhoto| {
        geographic_from_ecef(photo.pose.center).is_some_and(|place| place.height.abs() < 1e6)
    };
    if !found.photos.iter().all(geocentric) {
        found.warnings.push(
            "it names a coordinate system, but its transform does not lead there: its frame is taken as a local one".to_owned(),
        );
        return;
    }
    found.crs = Some("ECEF".to_owned());
    found.preferred_crs = reference.projected().map(str::to_owned);
    found.warnings.extend(reference.warnings());
}

/// Where the receivers measured the photos, in the chunk's coordinate system.
fn measured_positions(photos: &[Photo<'_>], crs: &Crs) -> Vec<MeasuredPosition> {
    let enabled = photos.iter().filter(|photo| photo.enabled);
    let measured = enabled.filter_map(|photo| {
        Some(MeasuredPosition {
            photo: photo.name.clone(),
            position: crs.to_geographic(photo.measured?)?,
        })
    });
    measured.collect()
}
