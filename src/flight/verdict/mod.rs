//! Whether to trust a photo's scale: reasons for doubt, each with the limit that it passed.
//!
//! The limits are the engineer's; the defaults are ours and say where a linear change between the top
//! and the bottom scale, which is all that Split-Desktop knows, begins to mislead. Judging is pure and
//! quick, so that a changed limit shows at once.

mod limits;

use std::fmt;

pub use limits::Limits;

#[cfg(doc)]
use crate::flight::AsRead;
use crate::flight::{Decision, DecisionKind, Doubt, Evidence, Outcome, PhotoFileState};
use crate::scale::{
    CornerName, CornerOutcome, EdgeScales, FieldFacts, LEAST_COVERED, ScalePair, ViewFacts,
};
use crate::units::LengthUnit;

/// What to do with a photo's scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Verdict {
    /// No reason for doubt was found.
    Trust,
    /// There are reasons for doubt; the engineer has looked at them, and takes the photo along.
    Accepted,
    /// There is a scale, and a reason to look before using it.
    Check,
    /// The engineer leaves the photo out.
    LeftOut,
    /// The top or the bottom scale is missing, of the pair that goes to Split-Desktop.
    NoScale,
}

impl Verdict {
    /// All of them, best first.
    pub const ALL: [Self; 5] = [
        Self::Trust,
        Self::Accepted,
        Self::Check,
        Self::LeftOut,
        Self::NoScale,
    ];

    /// In one or two words.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Trust => "trust",
            Self::Accepted => "accepted",
            Self::Check => "check",
            Self::LeftOut => "left out",
            Self::NoScale => "no scale",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// A photo's verdict with its reasons, whatever anybody has decided.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Judged {
    /// What to do with its scale: [`Verdict::Trust`], [`Verdict::Check`] or [`Verdict::NoScale`].
    pub verdict: Verdict,
    /// The gravest first.
    pub doubts: Vec<Doubt>,
}

impl Judged {
    /// The verdict with what the engineer has decided: she may leave any photo out, and take along what
    /// she was to check, as long as the reasons are those that she has looked at. Where there is no scale
    /// she cannot make one.
    pub(super) fn with(&self, decision: Option<&Decision>) -> Verdict {
        match (self.verdict, decision) {
            (_, Some(decision)) if decision.kind == DecisionKind::LeftOut => Verdict::LeftOut,
            (Verdict::Check, Some(decision)) if decision.covers(&self.doubts) => Verdict::Accepted,
            (verdict, _) => verdict,
        }
    }
}

/// What a photo is judged by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Facts<'a> {
    /// Its scale.
    pub outcome: &'a Outcome,
    /// `None` where the photo has no scale to look at, or nobody has looked.
    pub view: Option<&'a ViewFacts>,
    /// `None` where the photo has no scale, or nobody has computed its field.
    pub field: Option<&'a FieldFacts>,
    /// Which scales go to Split-Desktop.
    pub pair: ScalePair,
    /// What was looked up of it.
    pub evidence: &'a Evidence,
    /// Its camera's image size, pixels.
    pub camera: (u32, u32),
    /// The world's, `None` where nobody states it.
    pub unit: Option<LengthUnit>,
    /// [`AsRead::rounding`].
    pub rounding: f64,
}

/// Metres that a photo shows from side to side: a stone by itself to a whole mine. A lab's is 0.7 m, read as millimetres less than one.
const ACROSS: std::ops::Range<f64> = 0.02..5000.0;

/// Judges a photo: every reason for doubt, the gravest first, and what follows from them.
pub(super) fn judge(facts: &Facts<'_>, limits: &Limits) -> Judged {
    let Facts {
        outcome,
        view,
        field,
        pair,
        evidence,
        camera,
        unit,
        rounding,
    } = *facts;
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
            let EdgeScales {
                top,
                right,
                bottom,
                left,
            } = scale.scale;
            match pair {
                ScalePair::Corners if top.is_none() || bottom.is_none() => {
                    verdict = Verdict::NoScale;
                    if doubts.is_empty() {
                        let reason = "two corner points coincide".to_owned();
                        doubts.push(Doubt::NoScale(reason));
                    }
                }
                ScalePair::Corners => {}
                // A field that nobody has computed yet says nothing.
                ScalePair::Fitted => {
                    if let Some(field) = field.filter(|field| field.fitted.is_none()) {
                        let covered = field.covered;
                        let why = match covered < LEAST_COVERED {
                            true => Doubt::NoFit { covered },
                            false => Doubt::NoLine,
                        };
                        doubts.insert(0, why);
                        verdict = Verdict::NoScale;
                    }
                }
            }
            // Of what goes to Split-Desktop.
            let line = field.and_then(|field| field.fitted);
            let [top, bottom] = match (pair, line) {
                (ScalePair::Fitted, Some(line)) => [Some(line.top), Some(line.bottom)],
                _ => [top, bottom],
            };
            doubts.splice(0..0, strange_size(top.or(bottom), camera, unit));
            let limit = limits.top_bottom_ratio;
            if let Some(ratio) = ratio(top, bottom).filter(|&ratio| ratio > limit) {
                doubts.push(Doubt::Ratio { ratio, limit });
            }
            let limit = limits.left_right_ratio;
            if let Some(ratio) = ratio(left, right).filter(|&ratio| ratio > limit) {
                doubts.push(Doubt::Sideways { ratio, limit });
            }
        }
    }
    let found = evidence.against().cloned();
    let (mut of_number, found): (Vec<Doubt>, Vec<Doubt>) = found.partition(Doubt::is_of_the_number);
    // Whether it is known already that the photos have another size.
    let is_reduced = of_number
        .iter()
        .any(|doubt| matches!(doubt, Doubt::ReducedPhotos { .. }));
    if unit.is_none() {
        of_number.insert(0, Doubt::UnitUnknown);
        verdict = Verdict::NoScale;
    }
    doubts.splice(0..0, of_number);
    doubts.extend(found);
    if let Some(field) = field {
        doubts.extend(doubts_of_field(field, pair, unit, limits));
    }
    if let Some(view) = view {
        let has_line = field.is_some_and(|field| field.fitted.is_some());
        doubts.extend(doubt_of_rounding(view, unit, rounding));
        doubts.extend(doubts_of_view(view, unit, limits, has_line));
    }
    match &evidence.file {
        PhotoFileState::Missing | PhotoFileState::NotNamed if is_reduced => {}
        PhotoFileState::Missing => doubts.push(Doubt::FileMissing { size: camera }),
        PhotoFileState::NotNamed => doubts.push(Doubt::NoPhotoFolder { size: camera }),
        PhotoFileState::Unreadable(reason) => doubts.push(Doubt::FileUnreadable(reason.clone())),
        PhotoFileState::Found { width, height } if (*width, *height) != camera => {
            doubts.push(Doubt::FileSize {
                file: (*width, *height),
                camera,
            });
        }
        PhotoFileState::Found { .. } => {}
    }
    if verdict == Verdict::Trust && !doubts.is_empty() {
        verdict = Verdict::Check;
    }
    Judged { verdict, doubts }
}

/// Of a scale, where so much of the world is no blast's.
fn strange_size(
    scale: Option<f64>,
    (width, _): (u32, u32),
    unit: Option<LengthUnit>,
) -> Option<Doubt> {
    let across = f64::from(width) / scale? * unit?.metres();
    (!ACROSS.contains(&across)).then_some(Doubt::StrangeSize { across })
}

/// The larger of two scales over the smaller.
fn ratio(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    let (a, b) = (a?, b?);
    Some((a / b).max(b / a))
}

/// What the scale field says against the scales that go to Split-Desktop.
fn doubts_of_field(
    field: &FieldFacts,
    pair: ScalePair,
    unit: Option<LengthUnit>,
    limits: &Limits,
) -> Vec<Doubt> {
    let mut doubts = Vec::new();
    let limit = limits.off_line_share * 100.0;
    if let Some(line) = field.fitted
        && line.rms_percent > limit
    {
        let percent = line.rms_percent;
        doubts.push(Doubt::OffLine { percent, limit });
    }
    let limit = limits.interval_share * 100.0;
    let widest = field.uncertainty.as_ref().and_then(|uncertainty| {
        let ends = match pair {
            ScalePair::Fitted => [uncertainty.fitted_top, uncertainty.fitted_bottom],
            ScalePair::Corners => [uncertainty.top, uncertainty.bottom],
        };
        let widths = ends.into_iter().flatten().map(|ends| ends.width_percent());
        widths.max_by(f64::total_cmp)
    });
    let has_left = field
        .uncertainty
        .as_ref()
        .is_some_and(|uncertainty| pair == ScalePair::Corners && uncertainty.leaves_surface);
    if has_left {
        let percent = None;
        doubts.push(Doubt::WideInterval { percent, limit });
    } else if let Some(percent) = widest.filter(|&percent| percent > limit) {
        let percent = Some(percent);
        doubts.push(Doubt::WideInterval { percent, limit });
    }
    if let Some(uncertainty) = &field.uncertainty {
        let (noise, steepness) = (uncertainty.noise, uncertainty.steepness);
        if noise.is_doubtful() {
            doubts.push(Doubt::NoisyPoints { noise, unit });
        }
        if steepness > STEEPEST {
            let limit = STEEPEST;
            doubts.push(Doubt::Wall { steepness, limit });
        }
    }
    doubts
}

/// Walls that stand steeper are no surface over (x, y), degrees from level: a plain one of 85 degrees with 5 cm of noise, 15 m away,
/// had scales 0.2 % too large in intervals of 0.1 %; standing on end, with 2 to 10 cm, 0.5 to 2.7 %.
const STEEPEST: f64 = 75.0;

/// Rounded by more than this share of a footprint, points leave scales wrong by as much as dense clouds are
/// sure of them: 0.32 m in footprints of 55 m (0.6 %) moved best lines by 0.26 % (single corners by 2.7 %).
const ROUNDED_SHARE: f64 = 0.01;

fn doubt_of_rounding(view: &ViewFacts, unit: Option<LengthUnit>, rounding: f64) -> Option<Doubt> {
    let footprint = view.footprint_size?;
    (rounding > ROUNDED_SHARE * footprint).then_some(Doubt::RoundedPoints {
        rounding,
        footprint,
        unit,
    })
}

fn doubts_of_view(
    view: &ViewFacts,
    unit: Option<LengthUnit>,
    limits: &Limits,
    has_line: bool,
) -> Vec<Doubt> {
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
        if let Some(distance) = view.plane_distance.filter(|&distance| distance > limit)
            && !has_line
        {
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

#[cfg(test)]
mod tests;
