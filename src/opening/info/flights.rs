//! What is said of a flight, or of what one could be made of: a reconstruction, a recording, photos.

use std::collections::BTreeMap;

use serde_json::{Value, json};

use super::poses::{camera_value, photo_value};
use crate::fault::Fault;
use crate::flight::Flight;
use crate::formats::packages::ros::Recording;
use crate::formats::photos::photo_metadata::PhotoMetadata;
use crate::formats::{ImageUnit, Origin, Reconstruction, Sizes};
use crate::scale::ImageKind;

/// A reconstruction in its own frame.
pub(super) fn reconstruction_info(reconstruction: &Reconstruction) -> Value {
    let has_observations = !reconstruction.observations.is_empty();
    let cameras: Vec<Value> = reconstruction
        .cameras
        .iter()
        .map(|camera| {
            let mut value = camera_value(camera);
            if let Sizes::Unknown {
                unit,
                principal_points_from,
            } = reconstruction.sizes
            {
                // What a package does not write is null, not 0.
                value["width"] = Value::Null;
                value["height"] = Value::Null;
                if unit == ImageUnit::LongerSide {
                    for name in ["fx", "fy", "skew"] {
                        value[name] = Value::Null;
                    }
                }
                if principal_points_from == Origin::Middle {
                    value["cx"] = Value::Null;
                    value["cy"] = Value::Null;
                }
            }
            value
        })
        .collect();
    let photos = reconstruction.photos.iter().map(|photo| {
        let camera = reconstruction.cameras.get(photo.camera);
        let camera = camera.map(|camera| camera.name.as_str());
        photo_value(&photo.name, camera, &photo.pose)
    });
    json!({
        "kind": "reconstruction",
        "package": reconstruction.package,
        "crs": reconstruction.crs,
        "points": reconstruction.cloud.points.len(),
        "observations": has_observations.then_some(reconstruction.observations.len()),
        "median_reprojection_px": reconstruction.median_reprojection_px(),
        "warnings": reconstruction.warnings,
        "cameras": cameras,
        "photos": photos.collect::<Vec<_>>(),
    })
}

/// Photos of which none can be placed, and why.
pub(super) fn photos_info(photos: &[(String, PhotoMetadata)], fault: &Fault) -> Value {
    let name = |photo: &PhotoMetadata| {
        let is_named = photo.make.is_some() || photo.model.is_some();
        is_named.then(|| photo.camera_name())
    };
    let mut cameras: BTreeMap<(Option<String>, (u32, u32)), usize> = BTreeMap::new();
    for (_, photo) in photos {
        *cameras.entry((name(photo), photo.size)).or_default() += 1;
    }
    let cameras = cameras.iter().map(|((name, (width, height)), count)| {
        json!({"name": name, "width": width, "height": height, "photos": count})
    });
    let each = photos.iter().map(|(photo, metadata)| {
        let (width, height) = metadata.size;
        json!({"photo": photo, "camera": name(metadata), "width": width, "height": height})
    });
    let positions = photos.iter().filter(|(_, photo)| photo.place.is_some());
    json!({
        "kind": "photos",
        "cameras": cameras.collect::<Vec<_>>(),
        "photos": each.collect::<Vec<_>>(),
        "positions": positions.count(),
        "warnings": [format!("it is no flight: {fault}")],
    })
}

/// A ROS recording: what a reconstruction says where it is a flight, else its poses; in both cases its
/// topics.
pub(super) fn recording_info(recording: &Recording) -> Value {
    let mut value = match recording.reconstruction() {
        Ok(reconstruction) => reconstruction_info(&reconstruction),
        Err(fault) => {
            let mut warnings = recording.warnings();
            warnings.push(format!("it is no flight: {fault}"));
            let poses = recording.named_poses();
            let photos = poses
                .iter()
                .map(|(name, pose)| photo_value(name, None, pose));
            json!({
                "kind": "poses",
                "crs": null,
                "over_time": true,
                "photos": photos.collect::<Vec<_>>(),
                "warnings": warnings,
            })
        }
    };
    let topics = recording.topics.iter().map(|topic| {
        json!({
            "name": topic.name,
            "type": topic.type_name,
            "messages": topic.messages,
            "gives_poses": recording.gives_poses(topic),
        })
    });
    value["messages"] = recording.messages().into();
    value["topics"] = topics.collect();
    value
}

/// A flight, opened with all its files: cameras at their photos' size, photos in the world.
pub(super) fn flight_info(flight: &Flight, warnings: &[String]) -> Value {
    let parts = flight.parts();
    let photos = parts
        .photos
        .iter()
        .map(|photo| photo_value(&photo.name, Some(&flight.camera(photo).name), &photo.pose));
    let image = match parts.image {
        ImageKind::Undistorted => "undistorted",
        ImageKind::AsShot => "as-shot",
    };
    json!({
        "kind": "flight",
        "flight": parts.name,
        // Of a model in a frame of its own nobody knows it.
        "world_unit": parts.unit_known.then(|| parts.unit.symbol()),
        "crs": parts.as_read.system.as_ref().map(|system| &system.name),
        "image": image,
        "surface_vertices": parts.surface.vertices().len(),
        "cameras": parts.cameras.iter().map(camera_value).collect::<Vec<_>>(),
        "photos": photos.collect::<Vec<_>>(),
        "warnings": warnings,
    })
}
