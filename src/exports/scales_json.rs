//! Scales as JSON (contract, section 5). Numbers read back to the same f64. Photos with scale objects
//! have these besides, as `scale_objects`.

use serde::Serialize;

use super::ReportObject;
use super::scale_report::ScaleReport;

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
    corners: Vec<Corner>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    scale_objects: &'a [ReportObject],
}

#[derive(Serialize)]
struct Scale {
    top: Option<f64>,
    right: Option<f64>,
    bottom: Option<f64>,
    left: Option<f64>,
}

#[derive(Serialize)]
struct Corner {
    name: &'static str,
    pixel: [f64; 2],
    direction: Option<[f64; 3]>,
    point: Option<[f64; 3]>,
    on: Option<&'static str>,
}

/// The report as JSON text with a line break at its end.
///
/// # Errors
/// Never with finite numbers, which is all that a report holds.
pub fn scales_json(report: &ScaleReport) -> serde_json::Result<String> {
    let photos = report.lines.iter().map(|line| Photo {
        photo: &line.photo,
        width: line.width,
        height: line.height,
        ground: line.ground,
        scale: Scale {
            top: line.scale.top,
            right: line.scale.right,
            bottom: line.scale.bottom,
            left: line.scale.left,
        },
        corners: line
            .corners
            .iter()
            .map(|corner| Corner {
                name: corner.name.as_str(),
                pixel: corner.pixel,
                direction: corner.direction,
                point: corner.point,
                on: corner.on,
            })
            .collect(),
        scale_objects: &line.scale_objects,
    });
    let mut text = serde_json::to_string(&Report {
        flight: &report.flight,
        unit: report.unit.symbol(),
        world_unit: report.world_unit.symbol(),
        unit_known: (!report.unit_known).then_some(false),
        photos: photos.collect(),
    })?;
    text.push('\n');
    Ok(text)
}
