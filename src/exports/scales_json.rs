//! Scales as JSON (contract, section 5). Numbers read back to the same f64. Photos with scale objects
//! have these besides, as `scale_objects`. To add a key of a photo is to add a field of `Photo` and
//! its value, below.

use std::collections::BTreeMap;

use serde::Serialize;

use super::ReportObject;
use super::scale_report::{PhotoLine, ScaleReport};
use crate::camera::Camera;
use crate::flight::{Doubt, Verdict};
use crate::scale::{
    Corner, CornerName, CornerOutcome, ErrorSource, FittedScale, HalfAPose, Interval, PhotoScale,
    ScalePair, Uncertainty,
};

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
    fitted: Option<Fitted>,
    uncertainty: Option<Uncertain>,
    /// Null while nobody has looked at the photo.
    verdict: Option<&'static str>,
    reasons: Vec<String>,
    decision: Option<Decided<'a>>,
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
            fitted: line.fitted().map(Fitted::from),
            uncertainty: line
                .uncertainty()
                .map(|uncertainty| Uncertain::new(&uncertainty, line.photo.pair)),
            verdict: line.photo.settled().map(Verdict::as_str),
            reasons: line.photo.reasons(),
            decision: line.photo.decision.map(|decision| Decided {
                decision: decision.kind.as_str(),
                note: &decision.note,
                date: decision.date.map(|date| date.to_string()),
                reasons_since: line
                    .photo
                    .reasons_since_accepted()
                    .into_iter()
                    .map(Doubt::to_string)
                    .collect(),
            }),
            scale_objects: line.scale_objects,
        }
    }
}

/// What the engineer has decided.
#[derive(Serialize)]
struct Decided<'a> {
    decision: &'static str,
    note: &'a str,
    date: Option<String>,
    /// Those that were not there when she accepted the photo: then it is not accepted any more.
    reasons_since: Vec<String>,
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

/// The best line (contract, section 7).
#[derive(Serialize)]
struct Fitted {
    top: f64,
    bottom: f64,
    rms_percent: f64,
    worst_percent: f64,
    covered: f64,
    left_right_percent: f64,
}

impl From<FittedScale> for Fitted {
    fn from(fitted: FittedScale) -> Self {
        let FittedScale {
            top,
            bottom,
            rms_percent,
            worst_percent,
            covered,
            left_right_percent,
        } = fitted;
        Self {
            top,
            bottom,
            rms_percent,
            worst_percent,
            covered,
            left_right_percent,
        }
    }
}

/// How sure the scales are (contract, section 8).
#[derive(Serialize)]
struct Uncertain {
    top: Option<Ends>,
    bottom: Option<Ends>,
    left: Option<Ends>,
    right: Option<Ends>,
    fitted_top: Option<Ends>,
    fitted_bottom: Option<Ends>,
    parts_percent: BTreeMap<&'static str, Option<f64>>,
    not_counted: Vec<&'static str>,
    /// Of a pose of which one half is stated: the other, "position" or "angle".
    #[serde(skip_serializing_if = "Option::is_none")]
    pose_lacks: Option<&'static str>,
}

impl Uncertain {
    fn new(uncertainty: &Uncertainty, pair: ScalePair) -> Self {
        let parts = ErrorSource::ALL
            .into_iter()
            .zip(uncertainty.parts_percent(pair));
        Self {
            top: uncertainty.top.map(Ends::from),
            bottom: uncertainty.bottom.map(Ends::from),
            left: uncertainty.left.map(Ends::from),
            right: uncertainty.right.map(Ends::from),
            fitted_top: uncertainty.fitted_top.map(Ends::from),
            fitted_bottom: uncertainty.fitted_bottom.map(Ends::from),
            parts_percent: parts
                .map(|(source, part)| (source.as_str(), part))
                .collect(),
            not_counted: uncertainty
                .not_counted(pair)
                .map(ErrorSource::as_str)
                .collect(),
            pose_lacks: uncertainty.half_a_pose.map(HalfAPose::lacks),
        }
    }
}

#[derive(Serialize)]
struct Ends {
    standard_error: f64,
    low: f64,
    high: f64,
}

impl From<Interval> for Ends {
    fn from(interval: Interval) -> Self {
        Self {
            standard_error: interval.standard_error,
            low: interval.low,
            high: interval.high,
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
