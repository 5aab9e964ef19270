//! A flight and its settings.

use glam::DVec3;

use super::*;
use crate::camera::Distortion;
use crate::jobs::Progress;
use crate::surface::Cloud;

/// A camera that sees 1.28 by 0.72 of what is 1 away.
fn camera() -> Camera {
    Camera {
        name: String::new(),
        width: 1280,
        height: 720,
        fx: 1000.0,
        fy: 1000.0,
        cx: 640.0,
        cy: 360.0,
        skew: 0.0,
        distortion: Distortion::None,
    }
}

/// One photo straight down from 10 above a level lattice of 2 on [-20, 20]².
pub(super) fn flight() -> Flight {
    let at = |i: i32| f64::from(i) * 2.0;
    let points = (-10..=10)
        .flat_map(|i| (-10..=10).map(move |j| DVec3::new(at(i), at(j), 0.0)))
        .collect();
    let cloud = Cloud {
        points,
        ..Cloud::default()
    };
    Flight::new(FlightParts {
        name: "test".to_owned(),
        unit: LengthUnit::Metre,
        unit_known: true,
        ground: Ground::Auto,
        image: ImageKind::Undistorted,
        pair: Default::default(),
        errors: Default::default(),
        package_errors: Default::default(),
        surface: Arc::new(Surface::new(cloud).unwrap()),
        cameras: vec![camera()],
        as_read: Default::default(),
        photos: vec![Photo {
            name: "a.jpg".to_owned(),
            camera: 0,
            pose: Pose::from_tilt_pan(DVec3::new(0.0, 0.0, 10.0), [90.0, 0.0]),
            errors: Default::default(),
            package_errors: Default::default(),
            trouble: None,
        }],
    })
    .unwrap()
}

fn settings() -> FlightSettings {
    FlightSettings {
        pair: Default::default(),
        errors: Default::default(),
        unit: LengthUnit::Metre,
        unit_known: true,
        ground: Ground::Auto,
        image: ImageKind::Undistorted,
        surface: SurfaceOptions::default(),
        surface_up: Default::default(),
        scale_objects: Vec::new(),
        decisions: Vec::new(),
        placed: None,
        plan: None,
        control: Default::default(),
    }
}

fn scale(flight: &Flight) -> PhotoScale {
    let outcomes = flight.scales(&Progress::default()).unwrap();
    let [Outcome::Scale(scale)] = &outcomes[..] else {
        panic!("one scale");
    };
    (**scale).clone()
}

/// With all triangles left out the corners fall to the ground that is set.
#[test]
fn settings_change_without_the_file() {
    let flight = flight();
    assert_eq!(scale(&flight).corners_on_surface(), 4);
    let mut settings = settings();
    settings.surface.max_edge = Some(1.0);
    settings.ground = Ground::At(-10.0);
    settings.unit = LengthUnit::Foot;
    let changed = flight.with_settings(&settings).unwrap();
    let scale_now = scale(&changed);
    assert_eq!(changed.parts().unit, LengthUnit::Foot);
    assert_eq!(scale_now.corners_on_surface(), 0);
    assert!((scale_now.scale.top.unwrap() - 50.0).abs() < 1e-9);
    // And back again.
    settings.surface.max_edge = None;
    let back = changed.with_settings(&settings).unwrap();
    assert!((scale(&back).scale.top.unwrap() - 100.0).abs() < 1e-9);
}

#[test]
fn impossible_settings_are_refused() {
    let flight = flight();
    let mut bad = settings();
    bad.surface.max_edge = Some(-1.0);
    assert!(flight.with_settings(&bad).is_err());
    let mut bad = settings();
    bad.ground = Ground::At(f64::NAN);
    assert!(flight.with_settings(&bad).is_err());
}

/// A shell completes names as macOS spells them (U+0041 U+0308 for U+00C4); of two that differ in their case alone neither is meant.
#[test]
fn a_photo_is_named_as_a_shell_spells_it() {
    let mut parts = flight().parts().clone();
    let first = parts.photos[0].clone();
    let names = ["H\u{c4}NGE 1.JPG", "b.jpg", "B.jpg"];
    parts.photos = names
        .map(|name| Photo {
            name: name.to_owned(),
            ..first.clone()
        })
        .to_vec();
    let flight = Flight::new(parts).unwrap();
    for (typed, found) in [
        ("HA\u{308}NGE 1.JPG", 0),
        ("h\u{e4}nge 1.jpg", 0),
        ("b.jpg", 1),
        ("B.jpg", 2),
    ] {
        assert_eq!(flight.photo_typed(typed), Ok(found), "{typed}");
    }
    for typed in ["B.JPG", "HANGE 1.JPG"] {
        assert!(flight.photo_typed(typed).is_err(), "{typed}");
    }
    // A decision in a file is of the photo that it names.
    assert!(flight.photo_named("h\u{e4}nge 1.jpg").is_err());
}
