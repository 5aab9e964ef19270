//! Whether to trust a photo's scale: reasons for doubt, each with the limit that it passed.
//!
//! The limits are the engineer's; the defaults are ours and say where a uniform interpolation
//! between the top and the bottom scale begins to mislead. Judging is pure and quick, so that a
//! changed limit shows at once.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::Outcome;
use crate::scale::{CornerName, CornerOutcome, ViewFacts};
use crate::units::LengthUnit;

/// When to doubt.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Limits {
    /// The larger of top/bottom and bottom/top above which a linear change between the two is too
    /// coarse.
    pub top_bottom_ratio: f64,
    /// The longest edge of a corner's triangle, as a share of the footprint's mean edge, above which
    /// the corner lies over a hole of the cloud.
    pub triangle_share: f64,
    /// The angle between a corner's ray and the plane of the corner points, degrees, below which the
    /// view is too flat.
    pub flattest_angle: f64,
    /// The surface's root mean square distance from that plane, as a share of the footprint's mean
    /// edge, above which four corners say too little.
    pub plane_share: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            top_bottom_ratio: 2.0,
            triangle_share: 0.1,
            flattest_angle: 20.0,
            plane_share: 0.1,
        }
    }
}

/// What is known about a photo's image file.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum PhotoFileState {
    /// The flight names no folder of image files.
    #[default]
    NotNamed,
    /// There is a folder, but not this file in it.
    Missing,
    /// The file cannot be read, with the reason.
    Unreadable(String),
    /// Its size in pixels.
    Found {
        /// Width.
        width: u32,
        /// Height.
        height: u32,
    },
}

/// A reason not to trust a photo's scale. Prints as a sentence without a full stop.
#[derive(Debug, Clone, PartialEq)]
pub enum Doubt {
    /// The photo can have no scale at all, for this reason.
    NoScale(String),
    /// These corners were taken on the ground.
    OffSurface(Vec<CornerName>),
    /// These corners have no point, so edges have no scale.
    NoPoint(Vec<CornerName>),
    /// Top and bottom differ too much.
    Ratio {
        /// The larger over the smaller.
        ratio: f64,
        /// [`Limits::top_bottom_ratio`].
        limit: f64,
    },
    /// A corner lies over a hole of the cloud.
    LongTriangle {
        /// Which corners.
        corners: Vec<CornerName>,
        /// The longest edge, world units.
        edge: f64,
        /// Its limit, world units.
        limit: f64,
        /// Of both.
        unit: LengthUnit,
    },
    /// The view is too flat.
    FlatView {
        /// Degrees.
        angle: f64,
        /// Degrees.
        limit: f64,
    },
    /// The surface is far from the plane through the corners.
    NotPlane {
        /// Root mean square distance, world units.
        distance: f64,
        /// Its limit, world units.
        limit: f64,
        /// Of both.
        unit: LengthUnit,
    },
    /// The photo's file is missing.
    FileMissing,
    /// The photo's file cannot be read, with the reason.
    FileUnreadable(String),
    /// The photo's file has another size than its camera.
    FileSize {
        /// Of the file.
        file: (u32, u32),
        /// Of the camera.
        camera: (u32, u32),
    },
}

fn names(corners: &[CornerName]) -> String {
    let names: Vec<String> = corners
        .iter()
        .map(|corner| corner.as_str().replace('_', " "))
        .collect();
    names.join(", ")
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoScale(reason) => write!(f, "no scale: {reason}"),
            Self::OffSurface(corners) => {
                write!(
                    f,
                    "off the surface, taken on the ground: {}",
                    names(corners)
                )
            }
            Self::NoPoint(corners) => write!(
                f,
                "no point on the surface or the ground: {}",
                names(corners)
            ),
            Self::Ratio { ratio, limit } => write!(
                f,
                "top and bottom scale differ {ratio:.2} times, more than {limit:.2}"
            ),
            Self::LongTriangle {
                corners,
                edge,
                limit,
                unit,
            } => write!(
                f,
                "over a hole in the cloud ({}): a triangle edge of {edge:.3} {unit}, more than {limit:.3} {unit}",
                names(corners)
            ),
            Self::FlatView { angle, limit } => write!(
                f,
                "a flat view: a corner's ray meets the pile at {angle:.1}°, less than {limit:.1}°"
            ),
            Self::NotPlane {
                distance,
                limit,
                unit,
            } => write!(
                f,
                "not flat between the corners: the surface is {distance:.3} {unit} (rms) off their plane, more than {limit:.3} {unit}"
            ),
            Self::FileMissing => f.write_str("the photo file is missing"),
            Self::FileUnreadable(reason) => write!(f, "the photo file cannot be read: {reason}"),
            Self::FileSize { file, camera } => write!(
                f,
                "the photo file is {} × {}, its camera {} × {}",
                file.0, file.1, camera.0, camera.1
            ),
        }
    }
}

/// What to do with a photo's scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Verdict {
    /// No reason for doubt was found.
    Trust,
    /// There is a scale, and a reason to look before using it.
    Check,
    /// The top or the bottom scale is missing.
    NoScale,
}

impl Verdict {
    /// All of them, best first.
    pub const ALL: [Self; 3] = [Self::Trust, Self::Check, Self::NoScale];

    /// In one or two words.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Trust => "trust",
            Self::Check => "check",
            Self::NoScale => "no scale",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// Judges a photo: every reason for doubt, the gravest first, and what follows from them. `view` is
/// `None` where the photo has no scale to look at; `camera` is its camera's image size.
pub fn judge(
    outcome: &Outcome,
    view: Option<&ViewFacts>,
    file: &PhotoFileState,
    camera: (u32, u32),
    unit: LengthUnit,
    limits: &Limits,
) -> (Verdict, Vec<Doubt>) {
    let mut doubts = Vec::new();
    let mut verdict = Verdict::Trust;
    match outcome {
        Outcome::Trouble(reason) => {
            doubts.push(Doubt::NoScale(reason.clone()));
            verdict = Verdict::NoScale;
        }
        Outcome::Scale(scale) => {
            let named = |wanted: fn(&CornerOutcome) -> bool| -> Vec<CornerName> {
                let corners = scale.corners.iter();
                corners
                    .filter(|corner| wanted(&corner.outcome))
                    .map(|corner| corner.name)
                    .collect()
            };
            let no_point = named(|o| matches!(o, CornerOutcome::Nowhere | CornerOutcome::NoRay(_)));
            if !no_point.is_empty() {
                doubts.push(Doubt::NoPoint(no_point));
            }
            let off = named(|o| matches!(o, CornerOutcome::OnGround { .. }));
            if !off.is_empty() {
                doubts.push(Doubt::OffSurface(off));
            }
            match (scale.scale.top, scale.scale.bottom) {
                (Some(top), Some(bottom)) => {
                    let ratio = (top / bottom).max(bottom / top);
                    if ratio > limits.top_bottom_ratio {
                        let limit = limits.top_bottom_ratio;
                        doubts.push(Doubt::Ratio { ratio, limit });
                    }
                }
                _ => verdict = Verdict::NoScale,
            }
        }
    }
    if let Some(view) = view {
        doubts.extend(doubts_of_view(view, unit, limits));
    }
    match file {
        PhotoFileState::Missing => doubts.push(Doubt::FileMissing),
        PhotoFileState::Unreadable(reason) => doubts.push(Doubt::FileUnreadable(reason.clone())),
        PhotoFileState::Found { width, height } if (*width, *height) != camera => {
            doubts.push(Doubt::FileSize {
                file: (*width, *height),
                camera,
            });
        }
        PhotoFileState::NotNamed | PhotoFileState::Found { .. } => {}
    }
    if verdict == Verdict::Trust && !doubts.is_empty() {
        verdict = Verdict::Check;
    }
    (verdict, doubts)
}

fn doubts_of_view(view: &ViewFacts, unit: LengthUnit, limits: &Limits) -> Vec<Doubt> {
    let mut doubts = Vec::new();
    if let Some(size) = view.footprint_size {
        let limit = limits.triangle_share * size;
        let long: Vec<(CornerName, f64)> = CornerName::ALL
            .into_iter()
            .zip(view.triangle_edges)
            .filter_map(|(corner, edge)| Some((corner, edge?)))
            .filter(|&(_, edge)| edge > limit)
            .collect();
        if let Some(edge) = long.iter().map(|&(_, edge)| edge).max_by(f64::total_cmp) {
            let corners = long.into_iter().map(|(corner, _)| corner).collect();
            doubts.push(Doubt::LongTriangle {
                corners,
                edge,
                limit,
                unit,
            });
        }
        let limit = limits.plane_share * size;
        if let Some(distance) = view.plane_distance.filter(|&distance| distance > limit) {
            doubts.push(Doubt::NotPlane {
                distance,
                limit,
                unit,
            });
        }
    }
    let limit = limits.flattest_angle;
    if let Some(angle) = view.flattest_corner.filter(|&angle| angle < limit) {
        doubts.push(Doubt::FlatView { angle, limit });
    }
    doubts
}
