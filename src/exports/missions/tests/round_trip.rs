//! All formats of one mission say the same: positions within 1e-7 degrees, heights within 1 mm, angles
//! within 0.01 degrees; of ArduPilot, which keeps no fractions of it, the gimbal's pitch within half a degree.

use fragscale_formats::{MissionFile, read_mission};
use proptest::prelude::*;

use super::*;

/// Those that are read back.
const FORMATS: [MissionFormat; 5] = [
    MissionFormat::DjiWpml,
    MissionFormat::QGroundControl,
    MissionFormat::Waypoints,
    MissionFormat::Litchi,
    MissionFormat::GeoJson,
];

fn read_back(mission: &Mission, format: MissionFormat) -> MissionFile {
    let bytes = file(mission, format);
    let name = format!("bench.{}", format.ending());
    let (_folder, path) = fragscale_test_data::written(&name, bytes);
    read_mission(&path).unwrap_or_else(|error| panic!("{format:?}: {error}"))
}

fn angle_between(a: f64, b: f64) -> f64 {
    let turned = (a - b).rem_euclid(360.0);
    turned.min(360.0 - turned)
}

/// Whether two stops are the same for who flies; heights counted as `a` counts them.
fn is_same(mission: &Mission, a: &Stop, read: &Mission, b: &Stop, format: MissionFormat) {
    let place = (a.latitude - b.latitude)
        .abs()
        .max((a.longitude - b.longitude).abs());
    assert!(place < 1e-7, "{format:?}: {place}");
    // The reader does not know the take-off that the heights were counted from.
    let of = if read.take_off.is_some() {
        read
    } else {
        mission
    };
    let height = of.height_above(b.latitude, b.longitude, b.height, a.height.above);
    let height = height.unwrap_or_else(|| panic!("{format:?}: {:?} for {:?}", b.height, a.height));
    assert!(
        (height - a.height.metres).abs() < 1e-3,
        "{format:?}: {height} {:?}",
        a.height
    );
    if let Some(heading) = a.heading {
        let found = b
            .heading
            .unwrap_or_else(|| panic!("{format:?}: no heading"));
        assert!(
            angle_between(heading, found) < 0.01,
            "{format:?}: {heading} {found}"
        );
    }
    assert_eq!(
        a.gimbal_pitch.is_some(),
        b.gimbal_pitch.is_some(),
        "{format:?}"
    );
    if let (Some(a), Some(b)) = (a.gimbal_pitch, b.gimbal_pitch) {
        // ArduPilot keeps whole degrees.
        let whole = matches!(
            format,
            MissionFormat::QGroundControl | MissionFormat::Waypoints
        );
        let off = if whole { 0.5 + 1e-9 } else { 0.01 };
        assert!((a - b).abs() < off, "{format:?}: {a} {b}");
        assert!(a != -90.0 || b == -90.0);
    }
    assert!(
        (a.settle - b.settle).abs() < 1e-3,
        "{format:?}: {} {}",
        a.settle,
        b.settle
    );
    assert_eq!(a.photo.is_some(), b.photo.is_some(), "{format:?}");
}

fn all_say_the_same(mission: &Mission) {
    for format in FORMATS {
        let read = read_back(mission, format).mission;
        assert_eq!(read.stops.len(), mission.stops.len(), "{format:?}");
        for (a, b) in mission.stops.iter().zip(&read.stops) {
            is_same(mission, a, &read, b, format);
        }
        if let (Some(a), Some(b)) = (mission.speed, read.speed) {
            assert!((a - b).abs() < 1e-3, "{format:?}: {a} {b}");
        }
        // Litchi's app knows the rest, and not its files.
        if format == MissionFormat::Litchi {
            continue;
        }
        let is_mavlink = matches!(
            format,
            MissionFormat::QGroundControl | MissionFormat::Waypoints
        );
        let finish = match mission.finish {
            // MAVLink has no such command at the end; it is named.
            Finish::FirstStop if is_mavlink => Finish::Hover,
            finish => finish,
        };
        assert_eq!(read.finish, finish, "{format:?}");
        assert!((read.safe_height.unwrap() - mission.safe_height.unwrap()).abs() < 1e-3);
        if let (Some(a), Some(b)) = (mission.take_off, read.take_off) {
            let place = (a.latitude - b.latitude)
                .abs()
                .max((a.longitude - b.longitude).abs());
            assert!(place < 1e-7, "{format:?}: {place}");
            let elevation = read
                .height_above(b.latitude, b.longitude, b.elevation.unwrap(), Above::Geoid)
                .unwrap();
            let planned = mission
                .height_above(a.latitude, a.longitude, a.elevation.unwrap(), Above::Geoid)
                .unwrap();
            assert!((elevation - planned).abs() < 1e-3, "{format:?}");
        }
        assert!(read.take_off.is_some(), "{format:?}");
        if format == MissionFormat::QGroundControl {
            assert_eq!(read.fences, mission.fences);
        }
    }
    assert_eq!(read_back(mission, MissionFormat::GeoJson).mission, *mission);
    let dji = read_back(mission, MissionFormat::DjiWpml).mission;
    assert_eq!(dji.drone, mission.drone);
    // Where nobody says it, DJI's files do: here there is a fence to keep out of.
    let lost = mission.lost_signal.or(Some(LostSignal::Hover));
    assert_eq!(dji.lost_signal, lost);
    for (a, b) in mission.stops.iter().zip(&dji.stops) {
        assert_eq!(a.photo, b.photo);
    }
}

#[test]
fn a_mission_by_hand() {
    all_say_the_same(&mission());
    for format in FORMATS {
        let found = read_back(&mission(), format);
        assert_eq!(found.mission.name, "bench");
    }
    // What is written for Copter says nothing that is passed over.
    for format in [
        MissionFormat::DjiWpml,
        MissionFormat::QGroundControl,
        MissionFormat::Waypoints,
        MissionFormat::GeoJson,
    ] {
        assert_eq!(read_back(&mission(), format).notes, [""; 0], "{format:?}");
    }
}

/// An elevation that nobody said is not 0 when it is read.
#[test]
fn what_is_not_known_is_not_made_up() {
    let mut unknown = mission();
    if let Some(take_off) = &mut unknown.take_off {
        take_off.elevation = None;
    }
    for format in [MissionFormat::QGroundControl, MissionFormat::Waypoints] {
        let read = read_back(&unknown, format).mission;
        assert_eq!(read.take_off, unknown.take_off, "{format:?}");
    }
}

fn stops(above: Above, heights: std::ops::Range<f64>) -> impl Strategy<Value = Stop> {
    let aim = (
        prop_oneof![0.0..360.0, Just(0.0), Just(180.0), Just(359.999_99)],
        prop_oneof![-90.0..30.0, Just(-90.0), Just(0.0)],
        prop_oneof![0.01..60.0, Just(0.0), Just(40.0)],
        prop::option::of("[A-Za-z0-9_-]{1,12}"),
        any::<bool>(),
    );
    let place = (prop_oneof![-0.01..0.01, Just(0.0)], -0.01..0.01, heights);
    (place, aim).prop_map(
        move |((north, east, metres), (heading, pitch, settle, name, shoots))| Stop {
            latitude: north,
            longitude: east,
            height: Height { metres, above },
            heading: Some(heading),
            gimbal_pitch: Some(pitch),
            settle,
            photo: shoots.then_some(PhotoOf { name }),
        },
    )
}

fn missions(above: Above, heights: std::ops::Range<f64>) -> impl Strategy<Value = Mission> {
    let finish = prop_oneof![
        Just(Finish::ReturnHome),
        Just(Finish::Hover),
        Just(Finish::Land),
        Just(Finish::FirstStop)
    ];
    let lost = prop::option::of(prop_oneof![
        Just(LostSignal::ReturnHome),
        Just(LostSignal::Hover),
        Just(LostSignal::Land),
        Just(LostSignal::GoOn)
    ]);
    let datum = prop_oneof![Just(Above::Geoid), Just(Above::Ellipsoid)];
    let whole = (
        (finish, lost),
        datum,
        0.5..15.0,
        1.2..150.0,
        -60.0..70.0,
        -170.0..170.0,
    );
    let some = prop::collection::vec(stops(above, heights), 1..12);
    (whole, some).prop_map(
        |(((finish, lost_signal), datum, speed, safe, latitude, longitude), mut stops)| {
            for stop in &mut stops {
                stop.latitude += latitude;
                stop.longitude += longitude;
            }
            Mission {
                take_off: Some(TakeOff {
                    latitude,
                    longitude,
                    elevation: Some(Height {
                        metres: 300.0,
                        above: datum,
                    }),
                }),
                speed: Some(speed),
                safe_height: Some(safe),
                finish,
                lost_signal,
                stops,
                ..mission()
            }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn relative_missions(mission in missions(Above::TakeOff, -150.0..400.0)) {
        all_say_the_same(&mission);
    }
}

proptest! {
    // The geoid takes a millisecond each time.
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn missions_above_the_ellipsoid(mission in missions(Above::Ellipsoid, 250.0..500.0)) {
        all_say_the_same(&mission);
    }

    #[test]
    fn missions_above_the_geoid(mission in missions(Above::Geoid, 250.0..500.0)) {
        all_say_the_same(&mission);
    }
}

/// What we write, with bytes changed: read or refused in one line, never a panic.
#[test]
fn damaged_files_are_read_or_refused() {
    let mut random = fragscale_core::split_mix::SplitMix(17);
    let mut below = |limit: usize| usize::try_from(random.next() % limit as u64).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for format in FORMATS {
        let bytes = file(&mission(), format);
        let path = folder.path().join("damaged");
        for _ in 0..200 {
            let mut changed = bytes.clone();
            for _ in 0..=below(4) {
                let at = below(changed.len());
                changed[at] = b"0123456789-.,:<>{}[]\"\tnule\xff\0"[below(28)];
            }
            changed.truncate(changed.len() - below(2) * below(bytes.len()));
            std::fs::write(&path, &changed).unwrap();
            if let Err(error) = read_mission(&path) {
                assert_eq!(error.to_string().lines().count(), 1, "{error}");
            }
        }
    }
}

/// A ground station's file becomes another's.
#[test]
fn real_files_are_written_again() {
    for (name, count) in [
        ("ref.plan", 2),
        ("wpml/dji_payload_sdk_waypoint_v3_test_file.kmz", 14),
        ("wpml/matrice4", 6),
        ("qgc/mavsdk_qgroundcontrol_sample.plan", 3),
        ("waypoints/qgc_test_MissionPlanner.waypoints", 5),
    ] {
        let Some(path) = fragscale_test_data::shared_data(&format!("missions/{name}")) else {
            return;
        };
        let mut mission = read_mission(&path).unwrap().mission;
        assert_eq!(mission.stops.len(), count);
        mission.drone = mission.drone.or(Some(mavic_3e()));
        mission.speed = mission.speed.or(Some(5.0));
        mission.safe_height = mission.safe_height.or(Some(30.0));
        mission.take_off = mission.take_off.or(super::mission().take_off);
        for format in FORMATS
            .into_iter()
            .filter(|format| *format != MissionFormat::Litchi)
        {
            let read = read_back(&mission, format).mission;
            assert_eq!(read.stops.len(), count);
            for (a, b) in mission.stops.iter().zip(&read.stops) {
                is_same(&mission, a, &read, b, format);
            }
        }
    }
}
