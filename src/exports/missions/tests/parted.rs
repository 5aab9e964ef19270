//! Plans whose ways a target does not take at once.

use fragscale_core::plan::{LostSignal, Pace, Pattern, Plan, Size, Told, Way, Wish, missions};
use glam::DVec2;

use super::*;
use crate::camera::{Camera, Distortion};
use crate::geodesy::Crs;
use crate::jobs::Progress;
use crate::surface::{Cloud, Surface};
use crate::survey::Polygon;
use crate::units::LengthUnit;

const MIDDLE: DVec2 = DVec2::new(500_000.0, 5_000_000.0);

fn corners(corners: [(f64, f64); 4]) -> Polygon {
    Polygon::new(&corners.map(|corner| MIDDLE + DVec2::from(corner))).unwrap()
}

/// Photos of 24 m x 16 m with 40 % shared each way over a level field of 160 m x 160 m; between it and the take-off ground
/// to keep out of, 30 m wide.
fn plan() -> (Plan, Vec<Way>, Pace) {
    let points = (0..121 * 121).map(|i| {
        let place = DVec2::new(f64::from(i % 121), f64::from(i / 121)) * 2.0 - 120.0;
        (place + MIDDLE).extend(100.0)
    });
    let surface = Surface::new(Cloud {
        points: points.collect(),
        ..Cloud::default()
    })
    .unwrap();
    let camera = Camera {
        name: String::new(),
        width: 600,
        height: 400,
        fx: 500.0,
        fy: 500.0,
        cx: 300.0,
        cy: 200.0,
        skew: 0.0,
        distortion: Distortion::None,
    };
    let size = Size::Scale {
        pixels: 25.0,
        within: None,
    };
    let take_off = MIDDLE - DVec2::new(112.0, 0.0);
    let wish = Wish {
        overlap: 0.4,
        keep_out: vec![keep_out()],
        take_off: Some(take_off),
        ..Wish::usual(Pattern::Slope, size, None, 1.0)
    };
    let area = corners([(-80.0, -80.0), (80.0, -80.0), (80.0, 80.0), (-80.0, 80.0)]);
    let plan = Plan::new(&surface, &camera, area, wish, &Progress::default()).unwrap();
    let pace = Pace {
        speed: 4.0,
        stop: 3.0,
        battery: None,
        climb: 4.0,
        descent: 4.0,
        steepest: None,
    };
    let ways = Way::through(&plan, &surface, take_off, &pace).unwrap();
    (plan, ways, pace)
}

fn keep_out() -> Polygon {
    corners([
        (-104.0, -15.0),
        (-100.0, -15.0),
        (-100.0, 15.0),
        (-104.0, 15.0),
    ])
}

fn told(settle: f64) -> Told {
    Told {
        name: "pile".to_owned(),
        drone: Some(mavic_3e()),
        unit: LengthUnit::Metre,
        speed: 4.0,
        settle,
        by_battery: false,
    }
}

/// Each file is a flight of its own: it begins and ends at its safe height, leads around what is kept out of from the take-off on and
/// back to it, and its target takes it. All of them take every photo once.
#[test]
fn each_file_is_a_flight_of_its_own() {
    let (plan, ways, pace) = plan();
    assert!(
        ways.len() == 1 && plan.photos.len() > 180,
        "{}",
        plan.photos.len()
    );
    let crs = Crs::understand("EPSG:32632").unwrap();
    for (target, settle, limit) in [
        (
            MissionFormat::QGroundControl,
            2.0,
            "ArduPilot takes 700 commands at once: the way is in ",
        ),
        (
            MissionFormat::Waypoints,
            0.0,
            "ArduPilot takes 700 commands at once: the way is in ",
        ),
        (
            MissionFormat::Litchi,
            2.0,
            "Litchi takes 99 stops at once: the way is in ",
        ),
    ] {
        let told = told(settle);
        let (flights, said) = flights_for(&[target], (&plan, &ways), &pace, &told).unwrap();
        assert!(
            flights.len() > 1 && said.len() == 1 && said[0].starts_with(limit),
            "{said:?}"
        );
        for way in &flights {
            let corners = way.corners();
            for leg in corners.windows(2) {
                let [from, to] = [leg[0], leg[1]].map(|corner| corner.truncate());
                assert!(
                    keep_out().distance_to_leg(from, to) >= 5.0 - 1e-9,
                    "{leg:?}"
                );
            }
        }
        let told = missions(&plan, &flights, &crs, &told).unwrap();
        let mut photos = 0;
        for ((behind, mission), number) in told.iter().zip(1..) {
            assert_eq!(*behind, format!("-{number}"));
            assert_eq!(mission.name, format!("pile-{number}"));
            for end in [mission.stops.first(), mission.stops.last()] {
                assert_eq!(Some(end.unwrap().height.metres), mission.safe_height);
            }
            let stops = mission.stops.iter();
            photos += stops.filter(|stop| stop.photo.is_some()).count();
            assert_eq!(mission_files(mission, target).unwrap().files.len(), 1);
            assert_eq!(mission.lost_signal, Some(LostSignal::Hover));
        }
        assert_eq!(photos, plan.photos.len());
        // With one photo more the first would be too long: its target has no more than a few stops left.
        let first = &told[0].1;
        let more = Mission {
            stops: first
                .stops
                .iter()
                .cloned()
                .chain(first.stops.iter().take(12).cloned())
                .collect(),
            ..first.clone()
        };
        assert!(mission_files(&more, target).unwrap().files.len() > 1);
    }
    // DJI takes them all at once, and so what is asked for together with Litchi's is parted as that needs it.
    let (one, said) =
        flights_for(&[MissionFormat::DjiWpml], (&plan, &ways), &pace, &told(2.0)).unwrap();
    assert_eq!((one, said), (ways.clone(), Vec::new()));
    let both = [MissionFormat::DjiWpml, MissionFormat::Litchi];
    let (both, _) = flights_for(&both, (&plan, &ways), &pace, &told(2.0)).unwrap();
    let litchi = flights_for(&[MissionFormat::Litchi], (&plan, &ways), &pace, &told(2.0));
    assert_eq!(both, litchi.unwrap().0);
}
