//! The JSON files, as far as they are read.

use std::path::PathBuf;

use serde::Deserialize;

use crate::files::last_segment;

/// project.opf.
#[derive(Debug, Deserialize)]
pub(super) struct ProjectFile {
    pub(super) items: Vec<Item>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Item {
    #[serde(default)]
    pub(super) resources: Vec<Resource>,
}

#[derive(Debug, Deserialize)]
pub(super) struct Resource {
    pub(super) uri: String,
    pub(super) format: String,
}

#[derive(Debug, Deserialize)]
pub(super) struct CameraList {
    pub(super) cameras: Vec<ListedCamera>,
}

#[derive(Debug, Deserialize)]
pub(super) struct ListedCamera {
    pub(super) id: u64,
    pub(super) uri: String,
}

#[derive(Debug, Default, Deserialize)]
pub(super) struct InputCameras {
    #[serde(default)]
    pub(super) sensors: Vec<InputSensor>,
    #[serde(default)]
    pub(super) captures: Vec<Capture>,
}

#[derive(Debug, Deserialize)]
pub(super) struct InputSensor {
    pub(super) id: u64,
    pub(super) image_size_px: [u32; 2],
}

#[derive(Debug, Deserialize)]
pub(super) struct Capture {
    pub(super) reference_camera_id: u64,
    #[serde(default)]
    pub(super) cameras: Vec<InputCamera>,
    pub(super) geolocation: Option<Geolocation>,
}

#[derive(Debug, Deserialize)]
pub(super) struct InputCamera {
    pub(super) id: u64,
}

#[derive(Debug, Deserialize)]
pub(super) struct Geolocation {
    pub(super) crs: System,
    pub(super) coordinates: [f64; 3],
}

#[derive(Debug, Deserialize)]
pub(super) struct System {
    pub(super) definition: String,
}

#[derive(Debug, Deserialize)]
pub(super) struct CalibratedCameras {
    pub(super) sensors: Vec<CalibratedSensor>,
    pub(super) cameras: Vec<CalibratedCamera>,
}

#[derive(Debug, Deserialize)]
pub(super) struct CalibratedSensor {
    pub(super) id: u64,
    pub(super) internals: Internals,
}

#[derive(Debug, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(super) enum Internals {
    Perspective {
        principal_point_px: [f64; 2],
        focal_length_px: f64,
        radial_distortion: [f64; 3],
        tangential_distortion: [f64; 2],
    },
    Fisheye {
        principal_point_px: [f64; 2],
        affine: [f64; 4],
        polynomial: Vec<f64>,
    },
    #[serde(other)]
    Other,
}

#[derive(Debug, Deserialize)]
pub(super) struct CalibratedCamera {
    pub(super) id: u64,
    pub(super) sensor_id: u64,
    pub(super) position: [f64; 3],
    pub(super) orientation_deg: [f64; 3],
}

#[derive(Debug, Deserialize)]
pub(super) struct SceneFrame {
    pub(super) crs: System,
    pub(super) base_to_canonical: BaseToCanonical,
}

#[derive(Debug, Deserialize)]
pub(super) struct BaseToCanonical {
    pub(super) shift: [f64; 3],
    pub(super) scale: [f64; 3],
}

/// The path that a URI reference names, relative to the file that holds it.
pub(super) fn path_of(uri: &str) -> PathBuf {
    let uri = uri.split(['#', '?']).next().unwrap_or(uri);
    let path = decoded(uri.strip_prefix("file://").unwrap_or(uri));
    // file:///c:/data is c:/data.
    let drive = path
        .strip_prefix('/')
        .filter(|rest| rest.get(1..2) == Some(":"));
    PathBuf::from(drive.unwrap_or(&path))
}

/// The name of the file that a URI reference names.
pub(super) fn file_name(uri: &str) -> String {
    let uri = uri.split(['#', '?']).next().unwrap_or(uri);
    last_segment(&decoded(uri)).to_owned()
}

/// Percent-encoded bytes as they are meant.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        let code = after
            .get(..2)
            .and_then(|code| std::str::from_utf8(code).ok());
        match code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(byte) if *first == b'%' => {
                bytes.push(byte);
                rest = after.get(2..).unwrap_or_default();
            }
            _ => {
                bytes.push(*first);
                rest = after;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
