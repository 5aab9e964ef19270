//! Whether to trust a photo's scale: reasons for doubt, each with the limit that it passed.
//!
//! The limits are the engineer's; the defaults are ours and say where a linear change between the top
//! and the bottom scale, which is all that Split-Desktop knows, begins to mislead. Judging is pure and
//! quick, so that a changed limit shows at once.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::{Decision, DecisionKind, Doubt, Evidence, Outcome, PhotoFileState};
use crate::scale::{CornerName, CornerOutcome, EdgeScales, FieldFacts, ScalePair, ViewFacts};
use crate::units::LengthUnit;

/// When to doubt. A value at its limit is still good.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Limits {
    /// The larger of top/bottom and bottom/top above which a linear change between the two is too
    /// coarse.
    pub top_bottom_ratio: f64,
    /// The larger of left/right and right/left above which a scale that changes only from top to
    /// bottom misleads at the sides.
    pub left_right_ratio: f64,
    /// The longest edge of a corner's triangle, as a share of the footprint's mean edge, above which
    /// the corner lies over a hole of the cloud.
    pub triangle_share: f64,
    /// The angle between a corner's ray and the plane of the corner points, degrees, below which the
    /// view is too flat.
    pub flattest_angle: f64,
    /// The surface's root mean square distance from that plane, as a share of the footprint's mean
    /// edge, above which four corners say too little.
    pub plane_share: f64,
    /// How far the scale of the photo's pixels may be from the best line, root mean square, as a share of
    /// the scale: judged in the place of `plane_share` where there is a line.
    pub off_line_share: f64,
    /// The width of the 95 % interval of a scale that goes to Split-Desktop, as a share of the scale.
    pub interval_share: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            // Over a plane the change from top to bottom is linear, whatever the ratio; but a photo
            // in which the far fragments are half the size of the near ones misses the small ones.
            top_bottom_ratio: 2.0,
            // Halfway down, the sides are then about 11 % off the middle.
            left_right_ratio: 1.25,
            // On slopes of rubble (37 degrees) the height in the middle of a triangle can be off by
            // a quarter of its edge or so: 5 % of the scale.
            triangle_share: 0.2,
            // At 30 degrees fragments look half as high as they are wide, and a height that is off
            // moves the corner point by nearly twice as much.
            flattest_angle: 30.0,
            // At usual fields of view the mean edge is about as long as the distance, so that the
            // scale within the photo is about 8 % off that between its edges.
            plane_share: 0.08,
            // The same error as above, measured instead of guessed from four corners.
            off_line_share: 0.08,
            // Sizes are off by as much as the scale: more than that between two blasts would be taken for
            // a difference of the blasts.
            interval_share: 0.05,
        }
    }
}

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
}

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
                        doubts.insert(0, Doubt::NoFit { covered });
                        verdict = Verdict::NoScale;
                    }
                }
            }
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
        doubts.extend(doubts_of_field(field, pair, limits));
    }
    if let Some(view) = view {
        // Where the unit is not known, no length is said in it: the shares hold all the same.
        let unit = unit.unwrap_or(LengthUnit::Metre);
        let has_line = field.is_some_and(|field| field.fitted.is_some());
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

/// The larger of two scales over the smaller.
fn ratio(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    let (a, b) = (a?, b?);
    Some((a / b).max(b / a))
}

/// What the scale field says against the scales that go to Split-Desktop.
fn doubts_of_field(field: &FieldFacts, pair: ScalePair, limits: &Limits) -> Vec<Doubt> {
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
    if let Some(percent) = widest.filter(|&percent| percent > limit) {
        doubts.push(Doubt::WideInterval { percent, limit });
    }
    doubts
}

fn doubts_of_view(
    view: &ViewFacts,
    unit: LengthUnit,
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
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::scale::{Corner, FittedScale, Footprint, Interval, PhotoScale, Uncertainty};

    const SIZE: (u32, u32) = (1280, 720);

    const FOUND: PhotoFileState = PhotoFileState::Found {
        width: SIZE.0,
        height: SIZE.1,
    };

    /// Of that file, without a finding.
    fn evidence(file: &PhotoFileState) -> Evidence {
        Evidence {
            file: file.clone(),
            ..Evidence::default()
        }
    }

    fn on_surface() -> CornerOutcome {
        CornerOutcome::OnSurface {
            distance: 1.0,
            point: DVec3::ZERO,
        }
    }

    fn scale(outcomes: [CornerOutcome; 4], edges: [f64; 4]) -> Outcome {
        let corners = std::array::from_fn(|i| Corner {
            name: CornerName::ALL[i],
            pixel: DVec2::ZERO,
            direction: Some(DVec3::NEG_Z),
            outcome: outcomes[i],
        });
        let [top, right, bottom, left] = edges.map(|edge| edge.is_finite().then_some(edge));
        Outcome::Scale(Box::new(PhotoScale {
            corners,
            scale: EdgeScales {
                top,
                right,
                bottom,
                left,
            },
            ground: None,
        }))
    }

    fn good() -> Outcome {
        scale([on_surface(); 4], [100.0; 4])
    }

    /// Of a footprint with the mean edge 10.
    fn view() -> ViewFacts {
        ViewFacts {
            tilt: 90.0,
            height: Some(10.0),
            height_is_above_ground: false,
            flattest_corner: Some(50.0),
            triangle_edges: [Some(0.1); 4],
            plane_distance: Some(0.1),
            footprint_size: Some(10.0),
            footprint: Footprint {
                outline: Vec::new(),
                grid: Vec::new(),
                columns: 1,
                rows: 1,
            },
        }
    }

    fn limits() -> Limits {
        Limits {
            top_bottom_ratio: 1.5,
            left_right_ratio: 1.25,
            triangle_share: 0.25,
            flattest_angle: 30.0,
            plane_share: 0.125,
            off_line_share: 0.5,
            interval_share: 0.25,
        }
    }

    fn judged(outcome: &Outcome, view: &ViewFacts, file: &PhotoFileState) -> (Verdict, Vec<Doubt>) {
        let evidence = evidence(file);
        let facts = Facts {
            view: Some(view),
            ..facts(outcome, &evidence)
        };
        let judged = judge(&facts, &limits());
        (judged.verdict, judged.doubts)
    }

    /// Of a photo whose corners' scale is used, in metres, and nobody has looked.
    fn facts<'a>(outcome: &'a Outcome, evidence: &'a Evidence) -> Facts<'a> {
        Facts {
            outcome,
            view: None,
            field: None,
            pair: ScalePair::Corners,
            evidence,
            camera: SIZE,
            unit: Some(LengthUnit::Metre),
        }
    }

    #[test]
    fn a_good_photo_is_trusted() {
        assert_eq!(judged(&good(), &view(), &FOUND), (Verdict::Trust, vec![]));
    }

    /// Whose size nobody has seen may be ten times as large as the image that the scale is for.
    #[test]
    fn a_photo_of_unknown_size_is_not_trusted() {
        let [missing, not_named] = [PhotoFileState::Missing, PhotoFileState::NotNamed];
        assert_eq!(
            judged(&good(), &view(), &not_named),
            (Verdict::Check, vec![Doubt::NoPhotoFolder { size: SIZE }])
        );
        let found = Doubt::ReducedPhotos {
            size: SIZE,
            original: Some((6400, 3600)),
        };
        let evidence = Evidence {
            file: missing,
            doubts: vec![Doubt::UnderSurface, found.clone()],
            ..Evidence::default()
        };
        let judged = judge(&facts(&good(), &evidence), &limits());
        // The size is said once, and first: it is the number that is wrong.
        assert_eq!(judged.verdict, Verdict::Check);
        assert_eq!(judged.doubts, [found, Doubt::UnderSurface]);
        let said = judged.doubts[0].to_string();
        assert!(
            said.starts_with("for images of 1280 px width, not for the photos"),
            "{said}"
        );
    }

    /// Pixels per nothing are no scale, however good the view.
    #[test]
    fn without_a_unit_there_is_no_scale() {
        let (good, found) = (good(), evidence(&FOUND));
        let facts = Facts {
            unit: None,
            ..facts(&good, &found)
        };
        let judged = judge(&facts, &limits());
        assert_eq!(judged.verdict, Verdict::NoScale);
        assert_eq!(judged.doubts, [Doubt::UnitUnknown]);
    }

    /// At its limit a value is good, the next number beyond it is not.
    #[test]
    fn each_limit_is_exact() {
        let of_scale =
            |edges: [f64; 4]| judged(&scale([on_surface(); 4], edges), &view(), &FOUND).1;
        let of_view = |change: &dyn Fn(&mut ViewFacts)| {
            let mut view = view();
            change(&mut view);
            judged(&good(), &view, &FOUND).1
        };
        let unit = LengthUnit::Metre;
        // 100 or 150 at the top, and 100 or 150 at the bottom.
        let beyond = 150_f64.next_up();
        assert_eq!(of_scale([150.0, 1.0, 100.0, 1.0]), []);
        assert_eq!(of_scale([100.0, 1.0, 150.0, 1.0]), []);
        for edges in [[beyond, 1.0, 100.0, 1.0], [100.0, 1.0, beyond, 1.0]] {
            let doubt = Doubt::Ratio {
                ratio: beyond / 100.0,
                limit: 1.5,
            };
            assert_eq!(of_scale(edges), [doubt]);
        }
        assert_eq!(of_scale([1.0, 125.0, 1.0, 100.0]), []);
        let doubt = of_scale([1.0, 100.0, 1.0, 125_f64.next_up()]);
        assert!(matches!(doubt[..], [Doubt::Sideways { limit: 1.25, .. }]));
        assert_eq!(of_view(&|view| view.triangle_edges[1] = Some(2.5)), []);
        assert_eq!(
            of_view(&|view| view.triangle_edges = [None, Some(2.5_f64.next_up()), None, Some(7.0)]),
            [Doubt::LongTriangle {
                corners: vec![CornerName::TopRight, CornerName::BottomLeft],
                edge: 7.0,
                limit: 2.5,
                unit,
            }]
        );
        assert_eq!(of_view(&|view| view.flattest_corner = Some(30.0)), []);
        let angle = 30_f64.next_down();
        assert_eq!(
            of_view(&|view| view.flattest_corner = Some(angle)),
            [Doubt::FlatView { angle, limit: 30.0 }]
        );
        assert_eq!(of_view(&|view| view.plane_distance = Some(1.25)), []);
        let distance = 1.25_f64.next_up();
        assert_eq!(
            of_view(&|view| view.plane_distance = Some(distance)),
            [Doubt::NotPlane {
                distance,
                limit: 1.25,
                unit,
            }]
        );
        // What is not known is no reason.
        let nothing = of_view(&|view| {
            view.triangle_edges = [None; 4];
            (view.flattest_corner, view.plane_distance) = (None, None);
            view.footprint_size = None;
        });
        assert_eq!(nothing, []);
    }

    /// What the pixels say is judged of the scales that are used.
    #[test]
    fn the_field_is_judged_for_the_pair_in_use() {
        let interval = |width: f64| {
            Some(Interval {
                standard_error: 1.0,
                low: 100.0 - width / 2.0,
                high: 100.0 + width / 2.0,
            })
        };
        let field = |rms_percent: f64, of_line: f64, of_corners: f64| FieldFacts {
            covered: 1.0,
            fitted: Some(FittedScale {
                top: 100.0,
                bottom: 100.0,
                rms_percent,
                worst_percent: 99.0,
                covered: 1.0,
                left_right_percent: 0.0,
            }),
            uncertainty: Some(Uncertainty {
                top: interval(1.0),
                bottom: interval(of_corners),
                fitted_top: interval(of_line),
                fitted_bottom: interval(1.0),
                ..Uncertainty::default()
            }),
        };
        let doubts = |field: &FieldFacts, pair: ScalePair| {
            let (outcome, view, evidence) = (good(), view(), evidence(&FOUND));
            let facts = Facts {
                outcome: &outcome,
                view: Some(&view),
                field: Some(field),
                pair,
                evidence: &evidence,
                camera: SIZE,
                unit: Some(LengthUnit::Metre),
            };
            judge(&facts, &limits()).doubts
        };
        let both = [ScalePair::Fitted, ScalePair::Corners];
        for pair in both {
            assert_eq!(doubts(&field(50.0, 25.0, 25.0), pair), []);
            let percent = 50_f64.next_up();
            let off = Doubt::OffLine {
                percent,
                limit: 50.0,
            };
            assert_eq!(doubts(&field(percent, 1.0, 1.0), pair), [off]);
        }
        let wide = [Doubt::WideInterval {
            percent: 26.0,
            limit: 25.0,
        }];
        let noisy_corners = field(1.0, 1.0, 26.0);
        assert_eq!(both.map(|pair| doubts(&noisy_corners, pair).len()), [0, 1]);
        assert_eq!(doubts(&noisy_corners, ScalePair::Corners), wide);
        assert_eq!(doubts(&field(1.0, 26.0, 1.0), ScalePair::Fitted), wide);
    }

    #[test]
    fn the_gravest_doubt_comes_first() {
        let on_ground = CornerOutcome::OnGround {
            distance: 1.0,
            point: DVec3::ZERO,
        };
        let [s, g, n] = [on_surface(), on_ground, CornerOutcome::Nowhere];
        let mut flat = view();
        flat.flattest_corner = Some(3.0);
        let photo = scale([g, n, s, s], [f64::NAN, f64::NAN, 100.0, 100.0]);
        let (verdict, doubts) = judged(&photo, &flat, &PhotoFileState::Missing);
        assert_eq!(verdict, Verdict::NoScale);
        assert_eq!(
            doubts,
            [
                Doubt::NoPoint(vec![CornerName::TopRight]),
                Doubt::OffSurface(vec![CornerName::TopLeft]),
                Doubt::FlatView {
                    angle: 3.0,
                    limit: 30.0
                },
                Doubt::FileMissing { size: SIZE },
            ]
        );
        let (verdict, doubts) = judged(&scale([s, s, g, s], [100.0; 4]), &view(), &FOUND);
        assert_eq!(verdict, Verdict::Check);
        assert_eq!(
            doubts[0].to_string(),
            "off the surface, taken on the ground plane: bottom right"
        );
        // A verdict never stands without a reason.
        let (verdict, doubts) =
            judged(&scale([s; 4], [f64::NAN, 1.0, 100.0, 1.0]), &view(), &FOUND);
        assert_eq!((verdict, doubts.len()), (Verdict::NoScale, 1));
        let trouble = Outcome::Trouble("another shape".to_owned());
        let judged = judge(&facts(&trouble, &evidence(&FOUND)), &limits());
        let reason = Doubt::NoScale("another shape".to_owned());
        assert_eq!(
            (judged.verdict, judged.doubts),
            (Verdict::NoScale, vec![reason])
        );
    }

    fn field(covered: f64) -> FieldFacts {
        let fitted = FittedScale {
            top: 100.0,
            bottom: 100.0,
            rms_percent: 0.0,
            worst_percent: 0.0,
            covered,
            left_right_percent: 0.0,
        };
        FieldFacts {
            fitted: (covered >= 0.5).then_some(fitted),
            covered,
            uncertainty: None,
        }
    }

    /// The pair that goes to Split-Desktop decides, whatever the other one says.
    #[test]
    fn without_the_pair_in_use_there_is_no_scale() {
        let found = evidence(&FOUND);
        let n = CornerOutcome::Nowhere;
        let no_corners = scale([n; 4], [f64::NAN; 4]);
        let no_point = Doubt::NoPoint(CornerName::ALL.to_vec());
        let no_fit = Doubt::NoFit { covered: 0.31 };
        let of = |outcome: &Outcome, pair: ScalePair, field: Option<FieldFacts>| {
            let facts = Facts {
                pair,
                field: field.as_ref(),
                ..facts(outcome, &found)
            };
            let judged = judge(&facts, &limits());
            (judged.verdict, judged.doubts)
        };
        use ScalePair::{Corners, Fitted};
        use Verdict::{Check, NoScale, Trust};
        let [seen, hidden] = [Some(field(0.5)), Some(field(0.31))];
        assert_eq!(of(&good(), Fitted, seen.clone()), (Trust, vec![]));
        assert_eq!(of(&good(), Corners, hidden.clone()), (Trust, vec![]));
        assert_eq!(of(&good(), Fitted, None), (Trust, vec![]));
        let expected = (NoScale, vec![no_fit.clone()]);
        assert_eq!(of(&good(), Fitted, hidden.clone()), expected);
        let expected = (Check, vec![no_point.clone()]);
        assert_eq!(of(&no_corners, Fitted, seen.clone()), expected);
        let expected = (NoScale, vec![no_point.clone()]);
        assert_eq!(of(&no_corners, Corners, seen), expected);
        let expected = (NoScale, vec![no_fit, no_point]);
        assert_eq!(of(&no_corners, Fitted, hidden), expected);
    }

    #[test]
    fn verdicts_sort_best_first() {
        let mut verdicts = Verdict::ALL;
        verdicts.reverse();
        verdicts.sort();
        assert_eq!(verdicts, Verdict::ALL);
    }

    #[test]
    fn the_file_is_held_against_the_camera() {
        let doubts = |file: PhotoFileState| judged(&good(), &view(), &file).1;
        let file = (720, 1280);
        let turned = PhotoFileState::Found {
            width: file.0,
            height: file.1,
        };
        assert_eq!(doubts(turned), [Doubt::FileSize { file, camera: SIZE }]);
        let unreadable = PhotoFileState::Unreadable("no image".to_owned());
        assert_eq!(
            doubts(unreadable)[0].to_string(),
            "the photo file cannot be read: no image"
        );
    }
}
