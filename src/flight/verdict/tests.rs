//! Every limit, from both sides.

use glam::{DVec2, DVec3};

use super::*;
use crate::scale::{Corner, FittedScale, Footprint, Interval, PhotoScale, PointNoise, Uncertainty};

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
        longest_edge: 0.1,
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
        rounding: 0.0,
    }
}

#[test]
fn a_good_photo_is_trusted() {
    assert_eq!(judged(&good(), &view(), &FOUND), (Verdict::Trust, vec![]));
}

/// 1280 px at 100 px/m are 12.8 m; read as millimetres 12.8 mm, which no photo of a blast shows, and at 0.2 px/m 6.4 km.
#[test]
fn a_photo_that_shows_too_little_or_too_much_of_the_world_is_doubted() {
    let said = |per_unit: f64, unit: LengthUnit| {
        let outcome = scale([on_surface(); 4], [per_unit; 4]);
        let evidence = evidence(&FOUND);
        let facts = Facts {
            unit: Some(unit),
            ..facts(&outcome, &evidence)
        };
        let judged = judge(&facts, &limits());
        let doubts: Vec<String> = judged.doubts.iter().map(Doubt::to_string).collect();
        (judged.verdict, doubts.join("; "))
    };
    assert_eq!(
        said(100.0, LengthUnit::Metre),
        (Verdict::Trust, String::new())
    );
    let (verdict, doubts) = said(100.0, LengthUnit::Millimetre);
    assert_eq!(verdict, Verdict::Check);
    assert!(doubts.starts_with("it shows 13 mm from side"), "{doubts}");
    let (verdict, doubts) = said(0.2, LengthUnit::Metre);
    assert_eq!(verdict, Verdict::Check);
    assert!(doubts.starts_with("it shows 6.4 km from side"), "{doubts}");
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
    // Lengths are said in nobody's unit, not in metres.
    let rough = ViewFacts {
        triangle_edges: [Some(7.0); 4],
        ..view()
    };
    let facts = Facts {
        view: Some(&rough),
        ..facts
    };
    let said = judge(&facts, &limits()).doubts[1].to_string();
    assert!(said.contains("7.000 units of the file"), "{said}");
}

/// At its limit a value is good, the next number beyond it is not.
#[test]
fn each_limit_is_exact() {
    let of_scale = |edges: [f64; 4]| judged(&scale([on_surface(); 4], edges), &view(), &FOUND).1;
    let of_view = |change: &dyn Fn(&mut ViewFacts)| {
        let mut view = view();
        change(&mut view);
        judged(&good(), &view, &FOUND).1
    };
    let unit = Some(LengthUnit::Metre);
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

/// Of a footprint of 10 units points may be off by 0.1 of them.
#[test]
fn rounding_is_held_against_the_footprint() {
    let (good, found, view) = (good(), evidence(&FOUND), view());
    let doubts = |rounding: f64| {
        let facts = Facts {
            view: Some(&view),
            rounding,
            ..facts(&good, &found)
        };
        judge(&facts, &limits()).doubts
    };
    assert_eq!(doubts(0.1), []);
    let rounding = 0.1_f64.next_up();
    let expected = Doubt::RoundedPoints {
        rounding,
        footprint: 10.0,
        unit: Some(LengthUnit::Metre),
    };
    assert_eq!(doubts(rounding), [expected]);
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
            rounding: 0.0,
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
        percent: Some(26.0),
        limit: 25.0,
    }];
    let noisy_corners = field(1.0, 1.0, 26.0);
    assert_eq!(both.map(|pair| doubts(&noisy_corners, pair).len()), [0, 1]);
    assert_eq!(doubts(&noisy_corners, ScalePair::Corners), wide);
    assert_eq!(doubts(&field(1.0, 26.0, 1.0), ScalePair::Fitted), wide);
    // Rays of drawn errors leave the surface: there is no interval to be too wide, and it is not sure all the same.
    let mut leaving = field(1.0, 1.0, 1.0);
    if let Some(uncertainty) = &mut leaving.uncertainty {
        (uncertainty.leaves_surface, uncertainty.top) = (true, None);
    }
    assert_eq!(doubts(&leaving, ScalePair::Fitted), []);
    let [unsure] = &doubts(&leaving, ScalePair::Corners)[..] else {
        panic!("one doubt");
    };
    assert!(
        unsure
            .to_string()
            .contains("rays of its corners leave the surface")
    );
    // The corners of this photo have one scale; its line has not.
    let mut steep = field(1.0, 1.0, 1.0);
    steep.fitted = steep.fitted.map(|line| FittedScale {
        bottom: 1450.0,
        ..line
    });
    let limit = limits().top_bottom_ratio;
    let ratio = [Doubt::Ratio { ratio: 14.5, limit }];
    assert_eq!(doubts(&steep, ScalePair::Fitted), ratio);
    assert_eq!(doubts(&steep, ScalePair::Corners), []);
    // A wall's points are not beside each other from above.
    let mut wall = field(1.0, 1.0, 1.0);
    for (steepness, count) in [(74.9, 0), (75.1, 1)] {
        if let Some(uncertainty) = &mut wall.uncertainty {
            uncertainty.steepness = steepness;
        }
        assert_eq!(doubts(&wall, ScalePair::Fitted).len(), count);
    }
    // Points of one place lie apart by 0.9 % of their distance, and by more.
    let mut noisy = field(1.0, 1.0, 1.0);
    for (relative, is_said) in [(0.0089, false), (0.0091, true)] {
        let noise = PointNoise {
            height: 0.25,
            relative,
        };
        if let Some(uncertainty) = &mut noisy.uncertainty {
            uncertainty.noise = noise;
        }
        let unit = Some(LengthUnit::Metre);
        let said = is_said.then_some(Doubt::NoisyPoints { noise, unit });
        let wanted: Vec<Doubt> = said.into_iter().collect();
        assert_eq!(
            both.map(|pair| doubts(&noisy, pair)),
            [wanted.clone(), wanted]
        );
    }
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
    let (verdict, doubts) = judged(&scale([s; 4], [f64::NAN, 1.0, 100.0, 1.0]), &view(), &FOUND);
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
    let below_zero = FieldFacts {
        fitted: None,
        ..field(0.97)
    };
    let expected = (NoScale, vec![Doubt::NoLine]);
    assert_eq!(of(&good(), Fitted, Some(below_zero)), expected);
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
