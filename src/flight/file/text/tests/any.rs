//! Anything that a flight.toml may be set to.

use glam::DVec2;
use proptest::prelude::*;

use crate::control::ControlList;
use crate::flight::{Date, Decision, DecisionKind, FlightSettings, Placed, ScaleObject};
use crate::plan::{
    AskedPlan, Drone, Edit, Flying, Pattern, PhotoAt, Positioning, Size, SurveyWish,
};
use crate::scale::{Ground, ImageKind, PoseErrors, ScaleObjectKind, ScalePair, StatedErrors};
use crate::surface::{SurfaceOptions, UpAxis};
use crate::units::LengthUnit;

pub(super) fn any_settings() -> impl Strategy<Value = FlightSettings> {
    let length = || prop::option::of(1e-6..1e6_f64);
    let ground = prop_oneof![
        Just(Ground::Auto),
        (-1e4..1e4_f64).prop_map(Ground::At),
        (-100..100_i32).prop_map(|z| Ground::At(f64::from(z))),
    ];
    let image = prop_oneof![Just(ImageKind::Undistorted), Just(ImageKind::AsShot)];
    let objects = prop::collection::vec(any_object(), 0..4);
    let settings = (0..LengthUnit::ALL.len(), ground, image, length(), length());
    let axes = || prop::option::of((0.0..2.0_f64, 0.0..2.0_f64, any::<bool>()));
    let errors = (axes(), axes(), length(), length(), length(), any::<bool>());
    let axes = |axes: Option<(f64, f64, bool)>| {
        axes.map(|(x, y, same)| glam::DVec3::new(x, if same { x } else { y }, x))
    };
    let errors = errors.prop_map(
        move |(position, angle, focal, surface, world_scale, corners)| {
            let pose = PoseErrors {
                position: axes(position),
                angle: axes(angle),
            };
            let errors = StatedErrors {
                pose,
                focal,
                surface,
                world_scale,
            };
            let pair = match corners {
                true => ScalePair::Corners,
                false => ScalePair::Fitted,
            };
            (errors, pair)
        },
    );
    let placed = prop::option::of((0.1..9.0_f64, -1e7..1e7_f64, any::<bool>()));
    let plan = prop::option::of(any_plan());
    (settings, errors, objects, any_decisions(), placed, plan).prop_map(
        |(
            (unit, ground, image, max_edge, thinning),
            (errors, pair),
            scale_objects,
            decisions,
            placed,
            plan,
        )| {
            let placed = placed.map(|(scale, x, is_named)| Placed {
                transform: Box::new([
                    scale,
                    0.0,
                    0.0,
                    x,
                    0.0,
                    scale,
                    0.0,
                    5e6,
                    0.0,
                    0.0,
                    scale,
                    1.0 / 3.0,
                    0.0,
                    0.0,
                    0.0,
                    1.0,
                ]),
                crs: is_named.then(|| "EPSG:32633".to_owned()),
            });
            FlightSettings {
                pair,
                errors,
                unit: LengthUnit::ALL[unit],
                unit_known: true,
                ground,
                image,
                surface: SurfaceOptions { max_edge, thinning },
                surface_up: UpAxis::Z,
                scale_objects,
                decisions,
                placed,
                plan: plan.map(Box::new),
                control: ControlList::default(),
            }
        },
    )
}

fn any_plan() -> impl Strategy<Value = AskedPlan> {
    let size = || {
        (
            1.0..900.0_f64,
            prop::option::of(0.1..9.0_f64),
            any::<bool>(),
        )
            .prop_map(|(value, within, is_scale)| match is_scale {
                true => Size::Scale {
                    pixels: value,
                    within,
                },
                false => Size::Distance(value),
            })
    };
    let place = || (-1e7..1e7_f64, 0.0..1e7_f64).prop_map(|(x, y)| DVec2::new(x, y));
    let edit = (0..3, place(), place()).prop_map(|(kind, at, place)| {
        let photo = |name: &str| PhotoAt {
            name: name.to_owned(),
            at,
        };
        match kind {
            0 => Edit::Move(photo("P \"1\""), place),
            1 => Edit::Add(place),
            _ => Edit::Leave(photo("P2")),
        }
    });
    let area = || {
        (place(), 1.0..90.0_f64)
            .prop_map(|(at, side)| vec![at, at + DVec2::new(side, 0.0), at + DVec2::new(0.0, side)])
    };
    let photos = (
        prop::sample::select(Pattern::ALL.to_vec()),
        size(),
        prop::option::of(size()),
        prop::option::of(prop::sample::select(Drone::ALL.to_vec())),
        prop::sample::select(Positioning::ALL.to_vec()),
        any::<[bool; 3]>(),
    );
    let places = (
        prop::option::of(area()),
        prop::collection::vec(area(), 0..3),
        prop::option::of(place()),
        prop::collection::vec(edit, 0..4),
    );
    let numbers = (
        prop::array::uniform8(0.0..90.0_f64),
        prop::option::of(1.0..60.0_f64),
        prop::option::of(Just("2026-11-22T10:00+01:00".to_owned())),
    );
    (photos, places, numbers).prop_map(
        |(
            (pattern, size, of_survey, drone, positioning, [fill_gaps, cross, ring]),
            (area, keep_out, take_off, edits),
            (n, battery, when),
        )| AskedPlan {
            pattern,
            size,
            overlap: n[0] / 100.0,
            survey: SurveyWish {
                overlap: n[1] / 100.0,
                cross,
                ring,
                size: of_survey,
            },
            fill_gaps,
            tilt: n[2],
            off_normal: n[3],
            drone,
            positioning,
            clearance: n[4],
            area,
            keep_out,
            take_off,
            flying: Flying {
                speed: n[5],
                settle: n[6],
                battery,
                climb: n[7],
                descent: n[7] / 3.0,
                steepest: battery.map(|minutes| minutes / 2.0),
            },
            when,
            edits,
        },
    )
}

/// Of three photos at most, each once.
fn any_decisions() -> impl Strategy<Value = Vec<Decision>> {
    let kind = prop_oneof![Just(DecisionKind::Accepted), Just(DecisionKind::LeftOut)];
    let note = prop::sample::select(vec!["", "flat toe", "\"ä\" # \\"]);
    let date = prop::option::of((1..=9999_u16, 1..=12_u8, 1..=28_u8));
    let reasons = prop::sample::subsequence(vec!["flat-view", "off-line", "ratio"], 0..4);
    let decided = (kind, note, date, prop::option::of(reasons));
    prop::collection::hash_map(0..3_usize, decided, 0..4).prop_map(|decided| {
        let decided = decided.into_iter();
        let of_photo = decided.map(|(photo, (kind, note, date, reasons))| Decision {
            photo: ["a.jpg", "ä \"1\".jpg", "c"][photo].to_owned(),
            kind,
            note: note.to_owned(),
            date: date.and_then(|(year, month, day)| Date::new(year, month, day)),
            reasons: reasons.map(|kinds| kinds.into_iter().map(str::to_owned).collect()),
        });
        of_photo.collect()
    })
}

/// Few photos and sizes, so that some objects are the same.
fn any_object() -> impl Strategy<Value = ScaleObject> {
    let photo = prop::sample::select(vec!["a.jpg", "ä \"1\".jpg"]);
    let points = prop::collection::vec((-9.0..4e3_f64, 0..3000_i32), 3..6);
    (photo, any::<bool>(), 1..4_i32, points, any::<bool>()).prop_map(
        |(photo, is_bar, size, points, mask)| {
            let points = points.into_iter().map(|(x, y)| DVec2::new(x, f64::from(y)));
            ScaleObject {
                photo: photo.to_owned(),
                kind: match is_bar {
                    true => ScaleObjectKind::Bar,
                    false => ScaleObjectKind::Sphere,
                },
                size: f64::from(size) / 4.0,
                outline: points.take(if is_bar { 2 } else { 9 }).collect(),
                mask,
            }
        },
    )
}
