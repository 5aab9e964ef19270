//! Scales as JSON (contract, section 5). Numbers read back to the same f64. Photos with scale objects
//! have these besides, as `scale_objects`. To add a key of a photo is to add a field of `Photo` and
//! its value, below.

use serde::Serialize;

use super::ReportObject;
use super::scale_report::{PhotoLine, ScaleReport};
use crate::camera::Camera;
use crate::scale::{Corner, CornerName, CornerOutcome, PhotoScale};

#[derive(Serialize)]
struct Report<'a> {
    flight: &'a str,
    unit: &'a str,
    world_unit: &'a str,
    /// False where nobody states the world's unit: then no number is a scale. Else left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    unit_known: Option<bool>,
    photos: Vec<Photo<'a>>,
}

#[derive(Serialize)]
struct Photo<'a> {
    photo: &'a str,
    width: u32,
    height: u32,
    ground: Option<f64>,
    scale: Scale,
    corners: [CornerRay; 4],
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    scale_objects: &'a [ReportObject],
}

impl<'a> Photo<'a> {
    fn new(line: &PhotoLine<'a>) -> Self {
        let camera = line.photo.camera;
        Self {
            photo: line.photo.name(),
            width: camera.width,
            height: camera.height,
            ground: line.ground(),
            scale: Scale::new(line),
            corners: corners(line.photo.scale(), camera),
            scale_objects: line.scale_objects,
        }
    }
}

#[derive(Serialize)]
struct Scale {
    top: Option<f64>,
    right: Option<f64>,
    bottom: Option<f64>,
    left: Option<f64>,
}

impl Scale {
    fn new(line: &PhotoLine<'_>) -> Self {
        let scale = line.scale();
        Self {
            top: scale.top,
            right: scale.right,
            bottom: scale.bottom,
            left: scale.left,
        }
    }
}

#[derive(Serialize)]
struct CornerRay {
    name: &'static str,
    pixel: [f64; 2],
    direction: Option<[f64; 3]>,
    point: Option<[f64; 3]>,
    on: Option<&'static str>,
}

/// The corners in the contract's order; where nothing was computed, without rays.
fn corners(scale: Option<&PhotoScale>, camera: &Camera) -> [CornerRay; 4] {
    let mut corners = CornerName::ALL.map(|name| CornerRay {
        name: name.as_str(),
        pixel: name.pixel(camera).to_array(),
        direction: None,
        point: None,
        on: None,
    });
    let computed: &[Corner] = scale.map_or(&[], |scale| &scale.corners);
    for (corner, computed) in corners.iter_mut().zip(computed) {
        corner.direction = computed.direction.map(|d| d.to_array());
        corner.point = computed.point().map(|p| p.to_array());
        corner.on = match computed.outcome {
            CornerOutcome::OnSurface { .. } => Some("surface"),
            CornerOutcome::OnGround { .. } => Some("ground"),
            CornerOutcome::Nowhere | CornerOutcome::NoRay(_) => None,
        };
    }
    corners
}

/// The report as JSON text with a line break at its end.
///
/// # Errors
/// Never with finite numbers, which is all that a report holds.
pub fn scales_json(report: &ScaleReport<'_>) -> serde_json::Result<String> {
    let mut text = serde_json::to_string(&Report {
        flight: report.flight(),
        unit: report.unit().symbol(),
        world_unit: report.world_unit().symbol(),
        unit_known: (!report.unit_known()).then_some(false),
        photos: report.lines().map(|line| Photo::new(&line)).collect(),
    })?;
    text.push('\n');
    Ok(text)
}
