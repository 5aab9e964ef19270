//! Surveys and both kinds in one plan, and their missions in every format.

use std::fs;

use serde_json::Value;

use super::plan::{plane, planned};
use crate::common::{error_of, fragscale, shared_data, stdout_of};

fn info(path: &str) -> Value {
    serde_json::from_str(&stdout_of(&["info", path, "--format", "json"])).unwrap()
}

/// Every photo of the two patterns in one plan, and of legs that are not steep, in every format: places to 1e-7 degrees,
/// heights to a millimetre, angles to a hundredth of a degree.
#[test]
fn all_formats_of_both_say_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    for pattern in ["both", "paper-both", "survey"] {
        let missions = ["m.kmz", "m.plan", "m.geojson", "m.csv", "m.waypoints"].map(path);
        let mut more = vec!["--pattern", pattern, "--steepest", "15", "--cross-grid"];
        more.extend(["--survey-scale", "0.25 px/cm", "--survey-overlap", "60"]);
        more.extend(["--format", "json", "--force"]);
        more.extend(missions.iter().flat_map(|mission| ["--mission", mission]));
        let output = planned(&flight, &more);
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
        let told: Value = serde_json::from_slice(&output.stdout).unwrap();
        let photos = told["photos"].as_array().unwrap();
        let of = |purpose: &str| {
            let photos = photos.iter();
            photos.filter(|photo| photo["purpose"] == purpose).count()
        };
        assert!(of("survey") > 10, "{pattern}");
        assert_eq!(of("scale") > 0, pattern != "survey");
        for (photo, number) in photos.iter().zip(1..) {
            let letter = if photo["purpose"] == "scale" {
                "P"
            } else {
                "S"
            };
            assert_eq!(photo["photo"], format!("{letter}{number:03}"));
            if photo["purpose"] == "survey" {
                let tilt = photo["tilt"].as_f64().unwrap();
                assert!(
                    (tilt - 90.0).abs() < 1e-9 || (tilt - 50.0).abs() < 1e-9,
                    "{tilt}"
                );
            }
        }
        assert!(
            told["surveyed"].as_f64().unwrap() > 0.97,
            "{pattern}: {}",
            told["surveyed"]
        );
        let first = info(&missions[2]);
        assert_eq!(first["photos"], photos.len());
        // A leg climbs by 15 degrees, or straight up; the drone comes from above its take-off.
        let stops = |told: &Value| told["stops"].as_array().unwrap().clone();
        let number = |stop: &Value, name: &str| stop[name].as_f64().unwrap();
        let metres = |stop: &Value| stop["height"]["metres"].as_f64().unwrap();
        for leg in stops(&first).windows(2) {
            let north = (number(&leg[1], "latitude") - number(&leg[0], "latitude")) * 111_195.0;
            let east = number(&leg[1], "longitude") - number(&leg[0], "longitude");
            let level = north.hypot(east * 111_320.0 * 48.75_f64.to_radians().cos());
            let rise = (metres(&leg[1]) - metres(&leg[0])).abs();
            let slope = rise.atan2(level).to_degrees();
            assert!(level < 0.05 || slope < 15.2, "{pattern}: {slope}");
        }
        let seen = |told: &Value| -> Vec<Value> {
            let stops = stops(told).into_iter();
            stops.filter(|stop| stop["photo"] == true).collect()
        };
        for mission in &missions {
            let read = info(mission);
            assert_eq!(read["kind"], "mission");
            let (ours, theirs) = (seen(&first), seen(&read));
            assert_eq!(ours.len(), theirs.len(), "{mission}");
            // ArduPilot keeps whole degrees of the gimbal's pitch.
            let whole = mission.ends_with(".plan") || mission.ends_with(".waypoints");
            let pitch = if whole { 0.5 + 1e-6 } else { 0.01 };
            for (ours, theirs) in ours.iter().zip(&theirs) {
                for (name, most) in [
                    ("latitude", 1e-7),
                    ("longitude", 1e-7),
                    ("gimbal_pitch", pitch),
                ] {
                    let off = (number(ours, name) - number(theirs, name)).abs();
                    assert!(off <= most, "{mission} {name}: {off}");
                }
                assert!((metres(ours) - metres(theirs)).abs() <= 1e-3, "{mission}");
                let turn = number(ours, "heading") - number(theirs, "heading");
                let turn = (turn + 180.0).rem_euclid(360.0) - 180.0;
                assert!(turn.abs() <= 0.01, "{mission}: {turn}");
            }
        }
    }
    // An overlap that is none is refused, whichever it is of.
    for wrong in [["--overlap", "99"], ["--survey-overlap", "120"]] {
        let output = planned(&flight, &[&["--pattern", "both"][..], &wrong].concat());
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1));
        assert!(error.contains("overlap is not from 0 to 98 %"), "{error}");
    }
}

/// Real missions are known by what is in them, whatever they are; the bad ones are refused in a line.
#[test]
fn real_missions_are_known() {
    let Some(folder) = shared_data("missions") else {
        return;
    };
    let path = |name: &str| folder.join(name).display().to_string();
    for (name, format) in [
        ("wpml/dji_payload_sdk_waypoint_v3_test_file.kmz", "DJI"),
        ("wpml/matrice4", "DJI"),
        ("wpml/hover_waylines.wpml", "DJI"),
        ("qgc/mavsdk_qgroundcontrol_sample.plan", "QGroundControl"),
        ("waypoints/ardupilot_spline_wp.waypoints", "QGC WPL"),
        ("litchi/ymapper_waypoints.csv", "Litchi"),
        ("ref.plan", "QGroundControl"),
        ("ref.waypoints", "QGC WPL"),
    ] {
        let said = info(&path(name));
        assert_eq!(said["kind"], "mission", "{name}");
        assert!(!said["stops"].as_array().unwrap().is_empty(), "{name}");
        let words = said["format"].as_str().unwrap();
        assert!(
            words.contains(format) || format == "QGC WPL",
            "{name}: {words}"
        );
    }
    for name in ["no_geoFence.plan", "no_rallyPoints.plan"] {
        let output = fragscale(&["info", &path(name)]);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(
            (output.status.code(), error.lines().count()),
            (Some(1), 1),
            "{error}"
        );
    }
}

/// What a file does not say is asked for, each with its option; stated, the other ground station takes it.
#[test]
fn what_a_mission_does_not_say_is_stated() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    // Litchi says neither drone nor safe height nor take-off.
    let text = "latitude,longitude,altitude(m),heading(deg),curvesize(m),rotationdir,gimbalmode,gimbalpitchangle,\
        altitudemode,speed(m/s),poi_latitude,poi_longitude,poi_altitude(m),poi_altitudemode,photo_timeinterval,\
        photo_distinterval\n\
        50,7,20,90,0,0,2,-90,0,0,0,0,0,1,-1,-1\n50.001,7,20,90,0,0,2,-90,0,0,0,0,0,1,-1,-1\n";
    fs::write(path("in.csv"), text).unwrap();
    let to = path("out.kmz");
    let mut said = vec![
        "mission".to_owned(),
        path("in.csv"),
        "--to".to_owned(),
        to.clone(),
    ];
    for (lacks, states) in [
        ("--drone NAME", ["--drone", "mavic-3e"]),
        ("--speed M/S", ["--speed", "4"]),
        ("--safe-height METRES", ["--safe-height", "35"]),
    ] {
        let arguments: Vec<&str> = said.iter().map(String::as_str).collect();
        let output = fragscale(&arguments);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{error}");
        assert!(
            error.contains(lacks) && !fs::exists(&to).unwrap(),
            "{error}"
        );
        said.extend(states.map(str::to_owned));
    }
    let arguments: Vec<&str> = said.iter().map(String::as_str).collect();
    let output = fragscale(&arguments);
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{notes}");
    let read = info(&to);
    assert_eq!(
        (&read["speed"], &read["safe_height"]),
        (&4.0.into(), &35.0.into())
    );
    assert_eq!(read["stops"].as_array().unwrap().len(), 2);
    // What the file says otherwise is told.
    let plan = path("out.plan");
    let mut other = vec!["mission", &to, "--to", &plan, "--safe-height", "50"];
    other.extend([
        "--take-off",
        "50,7.001",
        "--elevation",
        "160",
        "--datum",
        "geoid",
    ]);
    let output = fragscale(&other);
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{notes}");
    assert!(
        notes.contains("--safe-height 50 is taken; the file says 35 m"),
        "{notes}"
    );
    let read = info(&plan);
    assert_eq!(read["take_off"]["longitude"], 7.001);
    assert_eq!(read["take_off"]["elevation"]["metres"], 160.0);
    // No drone climbs to there.
    let output = fragscale(&["mission", &to, "--safe-height", "99999"]);
    assert_eq!(output.status.code(), Some(1));
    let alone = fragscale(&["mission", &to, "--elevation", "160"]);
    assert_eq!(alone.status.code(), Some(2));
}

/// The page of what was flown: the figure, the numbers, and a row for each planned photo.
#[test]
fn what_was_flown_is_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (mission, page) = (path("m.geojson"), path("flown.html"));
    let output = planned(&flight, &["--mission", &mission]);
    assert_eq!(output.status.code(), Some(0));
    let arguments = ["flown", &flight, "--mission", &mission, "--report", &page];
    // The second time over its own.
    for _ in 0..2 {
        let output = fragscale(&arguments);
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
    }
    let text = fs::read_to_string(&page).unwrap();
    let planned = info(&mission)["photos"].as_u64().unwrap();
    for number in 1..=planned {
        assert!(text.contains(&format!("<td>P{number:03}</td>")), "{number}");
    }
    assert!(
        text.contains("<svg") && text.contains("not taken"),
        "{text}"
    );
    assert!(!text.contains("<?xml"));
    let wrong = path("flown.pdf");
    let refused = fragscale(&["flown", &flight, "--mission", &mission, "--report", &wrong]);
    assert_eq!(refused.status.code(), Some(1));
}

/// What a pattern knows nothing of is refused, and so is half of what it is named for.
#[test]
fn what_a_pattern_does_not_do_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    for (more, what) in [
        (&["--pattern", "slope", "--cross-grid"][..], "--cross-grid"),
        (
            &["--pattern", "paper", "--survey-overlap", "60"],
            "--survey-overlap",
        ),
        (&["--pattern", "slope", "--tilt", "80"], "--tilt"),
        (&["--pattern", "paper", "--off-normal", "5"], "--off-normal"),
        (
            &[
                "--pattern",
                "survey",
                "--survey-overlap",
                "60",
                "--overlap",
                "70",
            ],
            "give one",
        ),
        (
            &["--pattern", "survey", "--overlap", "-5"],
            "the survey's overlap is not from 0",
        ),
        // Photos for scales are taken from 74 m, of a survey at twice the scale from 37.
        (
            &[
                "--pattern",
                "both",
                "--survey-scale",
                "1 px/cm",
                "--clearance",
                "60m",
            ],
            "no photo of the survey can be taken",
        ),
        (
            &[
                "--pattern",
                "both",
                "--survey-scale",
                "1 px/cm",
                "--clearance",
                "60m",
            ],
            "--clearance",
        ),
    ] {
        let output = planned(&flight, more);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{more:?} {error}");
        assert!(error.contains(what), "{more:?} {error}");
    }
}

/// Over a heap photos of a survey share less: which overlap is enough there is said, and who follows that is not warned again.
#[test]
fn an_overlap_that_is_advised_is_enough() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let mut points = String::new();
    for i in 0..41 * 41 {
        let (x, y) = (f64::from(i % 41) * 5.0, f64::from(i / 41) * 5.0);
        let z = 300.0 + (25.0 - (x - 100.0).hypot(y - 100.0)).max(0.0);
        points += &format!("{} {} {z}\n", 450_000.0 + x, 5_400_000.0 + y);
    }
    fs::write(folder.path().join("plane.xyz"), points).unwrap();
    let warned = |overlap: &str| {
        let survey = ["--pattern", "survey", "--no-ring"];
        let output = planned(
            &flight,
            &[&survey[..], &["--survey-overlap", overlap]].concat(),
        );
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{said}");
        said
    };
    for overlap in ["70", "50"] {
        let said = warned(overlap);
        let (_, behind) = said.split_once("a survey's overlap of ").expect(&said);
        let advised = behind.split(' ').next().unwrap();
        let again = warned(advised);
        assert!(
            !again.contains("a survey's overlap of"),
            "{advised}: {again}"
        );
    }
}

/// Numbers of photos that lie kilometres from their plans are no comparison, whatever they are called.
#[test]
fn a_mission_of_another_pit_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (mission, far) = (path("m.geojson"), path("far.geojson"));
    assert_eq!(
        planned(&flight, &["--mission", &mission]).status.code(),
        Some(0)
    );
    // A tenth of a degree to the east: 7.3 km.
    let text = fs::read_to_string(&mission).unwrap();
    fs::write(&far, text.replace("[8.3", "[8.4")).unwrap();
    let take_off = |place| ["--take-off", place];
    for more in [&[] as &[&str], &take_off("450020,5400020")] {
        let arguments = [&["flown", &flight, "--mission", &far][..], more].concat();
        let error = error_of(&arguments);
        assert!(
            error.contains("far.geojson: the mission lies 7.")
                && error.contains(" km from the flight"),
            "{error}"
        );
    }
    let own = ["flown", &flight, "--mission", &mission];
    let error = error_of(&[&own[..], &take_off("430000,5400020")].concat());
    assert!(
        error.contains("nearest stop lies 20 km from the take-off that is given"),
        "{error}"
    );
    // 80 m to the east and to the north of the file's own.
    let said = |place| {
        let output = fragscale(&[&own[..], &take_off(place)].concat());
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
        notes
    };
    let elsewhere = "m.geojson: the take-off that is given is taken; its own lies 113 m from it";
    let notes = said("450100,5400100");
    assert!(notes.contains(elsewhere), "{notes}");
    let notes = said("450020,5400020");
    assert!(!notes.contains("that is given is taken"), "{notes}");
}

/// Which file cannot say it is told where there are several, and a sentence that is true of several stands once.
#[test]
fn notes_on_several_missions_name_their_files() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (plan, csv) = (path("a.plan"), path("a.csv"));
    let notes = |missions: &[&str]| {
        let output = planned(&flight, missions);
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
        notes
    };
    let both = notes(&["--mission", &plan, "--mission", &csv]);
    let takes_off = format!("{plan}, {csv}: the drone takes off at ");
    assert!(both.contains(&takes_off), "{both}");
    let radio = "the file does not say what the drone does where the radio is lost";
    let lines = both.lines().filter(|line| line.contains(radio));
    assert!(lines.clone().count() > 0, "{both}");
    for line in lines {
        assert!(line.contains(&csv), "{line}");
    }
    let one = notes(&["--mission", &csv, "--force"]);
    assert!(one.contains(&format!("warning: {radio}")), "{one}");
}
