//! Photos for a reconstruction, and both kinds in one plan.

use super::*;
use crate::plan::patterns::{ASLANT, TURN};

fn survey(pattern: Pattern, change: impl Fn(&mut SurveyWish)) -> Wish {
    let mut wish = wish(pattern);
    change(&mut wish.survey);
    wish
}

fn of(plan: &Plan, purpose: Purpose) -> Vec<&PlannedPhoto> {
    let photos = plan.photos.iter();
    photos.filter(|photo| photo.purpose == purpose).collect()
}

/// A pinhole's own projection: where a place is in a photo, pixels.
fn pixel(photo: &PlannedPhoto, place: DVec3) -> Option<DVec2> {
    let camera = camera();
    let [right, down, axis] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| photo.pose.rotation * axis);
    let off = place - photo.pose.center;
    let depth = off.dot(axis);
    let at = DVec2::new(
        camera.fx * off.dot(right) / depth + camera.cx,
        camera.fy * off.dot(down) / depth + camera.cy,
    );
    let inside = at.cmpge(DVec2::ZERO).all() && at.x <= 600.0 && at.y <= 400.0;
    (depth > 0.0 && inside).then_some(at)
}

/// Areas that are small beside the terrain's pixels: with one photo left out, the covered share is that of 40 000 places of
/// the area, put into the photos one by one.
#[test]
fn the_covered_share_is_that_of_places() {
    let surface = surface(|_| 0.0);
    for half in [5.3, 8.9, 13.1, 21.7] {
        let plan = plan(&surface, half, wish(Pattern::Slope));
        let photos = &plan.photos[1..];
        let cover = Cover::of(
            (photos, plan.wish.survey.overlap),
            &plan.camera,
            &plan.area,
            &plan.terrain,
        );
        let places = (0..200 * 200).map(|i| {
            let at = DVec2::new(f64::from(i % 200), f64::from(i / 200)) + 0.5;
            let place = at * (half / 100.0) - half + DVec2::new(500_000.0, 5_000_000.0);
            place.extend(0.0)
        });
        let is_seen = |place: &DVec3| photos.iter().any(|photo| pixel(photo, *place).is_some());
        let seen = places.filter(is_seen).count() as f64 / 40_000.0;
        assert!(
            (cover.covered - seen).abs() < 0.015,
            "{half}: {} {seen}",
            cover.covered
        );
        assert!(cover.covered < 1.0 && cover.widest_gap > 0.0, "{half}");
    }
}

/// Over level ground, photos of 24 x 16 with half of each side shared: every place of the area is in four photos of each
/// grid; rows of the one run along x and of the other along y.
#[test]
fn a_cross_grid_shows_each_place_eight_times() {
    let surface = surface(|_| 0.0);
    let cross = |cross| {
        survey(Pattern::Survey, move |survey| {
            survey.overlap = 0.5;
            survey.cross = cross;
            survey.ring = false;
        })
    };
    let (single, double) = (
        plan(&surface, 40.0, cross(false)),
        plan(&surface, 40.0, cross(true)),
    );
    for (plan, least) in [(&single, 4), (&double, 8)] {
        assert!(plan.photos.iter().all(|photo| photo.tilt == 90.0));
        assert!(plan.photos[0].name == "S001", "{}", plan.photos[0].name);
        for i in 0..39 * 39 {
            let at = DVec2::new(f64::from(i % 39), f64::from(i / 39)) * 2.0 - 38.0;
            let place = (at + DVec2::new(500_000.0, 5_000_000.0)).extend(0.0);
            let seen = plan
                .photos
                .iter()
                .filter(|photo| pixel(photo, place).is_some());
            let count = seen.count();
            assert!(count >= least, "{count} at {at}");
        }
        assert_eq!(plan.cover.surveyed, Some(plan.cover.covered));
        assert!(plan.cover.covered > 0.999, "{}", plan.cover.covered);
    }
    // Of a square the crossing rows are as many.
    let pans = |plan: &Plan| -> std::collections::BTreeSet<i64> {
        let photos = plan.photos.iter();
        photos.map(|photo| photo.pan.round() as i64).collect()
    };
    assert_eq!(pans(&single).len(), 2);
    assert_eq!(pans(&double).len(), 4);
}

/// The ring: once around, every photo aslant and from outside of what it looks at; neighbours turn by little and share
/// what was asked for.
#[test]
fn a_ring_looks_into_the_area_from_all_sides() {
    let surface = surface(|_| 0.0);
    let overlap = 0.6;
    let wish = survey(Pattern::Survey, |survey| survey.overlap = overlap);
    let plan = plan(&surface, 40.0, wish);
    let mut ring: Vec<&PlannedPhoto> = (plan.photos.iter())
        .filter(|photo| photo.tilt < 80.0)
        .collect();
    let middle = DVec2::new(500_000.0, 5_000_000.0);
    let around = |photo: &PlannedPhoto| {
        let off = photo.pose.center.truncate() - middle;
        off.y.atan2(off.x)
    };
    ring.sort_by(|a, b| around(a).total_cmp(&around(b)));
    // Sides of 80 with steps of 24 * 0.4, and 4 corners of 90 degrees, at most 15 apart.
    assert!(ring.len() >= 4 * 8 + 4 * 6, "{}", ring.len());
    assert!(ring.len() < 4 * 9 + 4 * 9, "{}", ring.len());
    for (photo, next) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        assert!((photo.tilt - ASLANT).abs() < 1e-9);
        // 20 along the axis.
        assert!((photo.pose.center.z - 20.0 * ASLANT.to_radians().sin()).abs() < 0.2);
        let (center, target) = (photo.pose.center.truncate(), photo.target.truncate());
        // Half of 16 / sin 50 inside the side.
        let inside = 40.0 - (target - middle).abs().max_element();
        assert!((-1e-6..=10.45).contains(&inside), "{inside}");
        assert!(center.distance(middle) > target.distance(middle));
        let turn = (next.pan - photo.pan + 180.0).rem_euclid(360.0) - 180.0;
        // Around it counter-clockwise each turns that way.
        assert!((-TURN - 1e-9..=1e-9).contains(&turn), "{turn}");
        // Along a side: the middle of the next lies so far to the side of a photo of 600 pixels.
        if turn.abs() < 1e-9 {
            let at = pixel(photo, next.target).unwrap();
            let shared = 1.0 - (at.x - 300.0).abs() / 600.0;
            assert!(shared > overlap - 1e-3, "{shared}");
        }
    }
}

/// Photos with 25 px/m of 500 px focal length look down from 20 above the mean height, with 70 % overlap there: over a heap
/// that is 8 higher they see 12/20 of that, and share 1 - 0.3 * 20/12 = 50 %.
#[test]
fn a_survey_shares_less_over_what_is_higher() {
    let high = |place: DVec2| if place.x.abs() < 10.0 { 8.0 } else { 0.0 };
    let surface = surface(high);
    let wish = survey(Pattern::Survey, |survey| survey.ring = false);
    let plan = plan(&surface, 40.0, wish.clone());
    let mean = plan.photos[0].pose.center.z - 20.0;
    assert!((1.0..3.0).contains(&mean), "{mean}");
    let expected = 1.0 - 0.3 * 20.0 / (12.0 + mean);
    let least = plan.cover.least_overlap.unwrap();
    assert!((least - expected).abs() < 1e-3, "{least} {expected}");
    // Photos for scales alone are of no survey.
    let scales = Wish {
        pattern: Pattern::Slope,
        ..wish
    };
    assert_eq!(
        super::plan(&surface, 40.0, scales).cover.least_overlap,
        None
    );
}

/// Both in one plan: the photos for scales are those of the pattern alone, so are those of the survey; gaps and overlap are
/// those of each kind by itself, and the survey's own scale is its own.
#[test]
fn both_are_planned_in_one_flight() {
    let surface = surface(|place| 2.0 * (place.x / 12.0).sin() + 0.2 * place.y);
    for (pattern, alone) in [
        (Pattern::Both, Pattern::Slope),
        (Pattern::PaperBoth, Pattern::Paper),
    ] {
        let coarse = |pattern| {
            survey(pattern, |survey| {
                survey.size = Some(Size::scale(12.5));
            })
        };
        let both = plan(&surface, 40.0, coarse(pattern));
        let scales = plan(&surface, 40.0, coarse(alone));
        let mut only_survey = coarse(Pattern::Survey);
        only_survey.size = Size::scale(12.5);
        let only_survey = plan(&surface, 40.0, only_survey);
        let same = |found: &[&PlannedPhoto], expected: &Plan, most: f64| {
            assert_eq!(found.len(), expected.photos.len());
            for photo in found {
                let near =
                    |other: &&PlannedPhoto| other.pose.center.distance(photo.pose.center) < most;
                assert!(
                    expected.photos.iter().any(|other| near(&other)),
                    "{}",
                    photo.name
                );
            }
        };
        let (for_scales, surveys) = (of(&both, Purpose::Scale), of(&both, Purpose::Survey));
        // The raster reaches farther, and so lies otherwise, and it is finer than the survey alone needs.
        same(&for_scales, &scales, 0.3);
        same(&surveys, &only_survey, 0.3);
        assert!((both.cover.widest_gap - scales.cover.widest_gap).abs() < 1.0);
        assert!((both.cover.covered - scales.cover.covered).abs() < 0.01);
        assert!(scales.cover.surveyed.is_none() && both.cover.surveyed.unwrap() > 0.98);
        // Of photos edge to edge little is shared, although all of it is in the survey, too.
        let shared = |purpose: Purpose| {
            let photos = both.photos.iter().zip(&both.cover.shared);
            let own = photos.filter(|(photo, _)| photo.purpose == purpose);
            let shared: Vec<f64> = own.map(|(_, shared)| *shared).collect();
            shared.iter().sum::<f64>() / shared.len() as f64
        };
        assert!(shared(Purpose::Scale) < 0.4, "{}", shared(Purpose::Scale));
        assert!(shared(Purpose::Survey) > 0.7, "{}", shared(Purpose::Survey));
        // Numbered in the order of the flight, and named by what they are for.
        for (photo, number) in both.photos.iter().zip(1..) {
            let letter = if photo.purpose == Purpose::Scale {
                "P"
            } else {
                "S"
            };
            assert_eq!(photo.name, format!("{letter}{number:03}"));
        }
        // What is filled or added is for scales.
        let more = both
            .with_photo(
                DVec2::new(500_000.0, 5_000_000.0),
                &surface,
                &Progress::default(),
            )
            .unwrap();
        assert_eq!(of(&more, Purpose::Scale).len(), for_scales.len() + 1);
    }
}

/// A gimbal that only looks straight down takes no ring, and that is said, photo by photo.
#[test]
fn a_ring_that_the_gimbal_cannot_do_is_refused() {
    let surface = surface(|_| 0.0);
    let mut wish = survey(Pattern::Survey, |_| {});
    let whole = plan(&surface, 30.0, wish.clone());
    wish.gimbal = [-90.0, -60.0];
    let cut = plan(&surface, 30.0, wish);
    assert!(cut.photos.iter().all(|photo| photo.tilt == 90.0));
    assert_eq!(cut.photos.len() + cut.refused.len(), whole.photos.len());
    assert!(
        cut.refused
            .iter()
            .all(|refused| refused.why.contains("gimbal"))
    );
}
