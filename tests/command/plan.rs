//! `fragscale plan`: over a surface that is made here, and read back.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{error_of, fragscale, shared_data, stdout_of};

/// A plane in UTM that falls to the east by 1 in 2, and a flight of one photo over it.
pub(super) fn plane(folder: &Path) -> String {
    let mut points = String::new();
    for i in 0..41 * 41 {
        let (x, y) = (f64::from(i % 41) * 5.0, f64::from(i / 41) * 5.0);
        points += &format!(
            "{} {} {}\n",
            450_000.0 + x,
            5_400_000.0 + y,
            300.0 - 0.5 * x
        );
    }
    fs::write(folder.join("plane.xyz"), points).unwrap();
    let pose = "photo,x,y,z,tilt,pan\nA.jpg,450100,5400100,350,90,0\n";
    fs::write(folder.join("poses.csv"), pose).unwrap();
    let camera = std::path::absolute("assets/sample/ost.yaml").unwrap();
    let text = format!(
        "format = 1\n[world]\nunit = \"m\"\ncrs = \"EPSG:32632\"\n[surface]\nfile = \"plane.xyz\"\n\
         [[camera]]\nfile = '{}'\n[photos]\nposes = \"poses.csv\"\n",
        camera.display()
    );
    fs::write(folder.join("flight.toml"), text).unwrap();
    folder.join("flight.toml").display().to_string()
}

/// The middle of it.
pub(super) const AREA: &str = "450060,5400060;450140,5400060;450140,5400140;450060,5400140";

/// Plans photos of it from a drone of DJI's, with what stands behind that.
pub(super) fn planned(flight: &str, more: &[&str]) -> std::process::Output {
    let scale = ["--drone", "mavic-3e", "--scale", "0.5 px/cm"];
    let places = ["--area", AREA, "--take-off", "450020,5400020"];
    fragscale(&[&["plan", flight][..], &scale, &places, more].concat())
}

#[test]
fn a_plan_becomes_missions_that_say_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let missions = ["m.kmz", "m.plan", "m.waypoints", "m.csv"].map(path);
    let mut more = vec!["--format", "json"];
    more.extend(missions.iter().flat_map(|mission| ["--mission", mission]));
    let output = planned(&flight, &more);
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{notes}");
    assert!(notes.contains("nominal"), "{notes}");
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    let photos = told["photos"].as_array().unwrap();
    assert!(photos.len() > 1);
    for photo in photos {
        // Squarely at the plane: atan(1/2) off straight down, uphill is west; everywhere the wished scale.
        assert!(
            (photo["tilt"].as_f64().unwrap() - 63.434_949).abs() < 1e-3,
            "{photo}"
        );
        assert!((photo["pan"].as_f64().unwrap() - 270.0).abs() < 1e-3);
        for scale in ["least", "greatest", "top", "bottom"] {
            assert!(
                (photo[scale].as_f64().unwrap() - 0.5).abs() < 1e-4,
                "{photo}"
            );
        }
    }
    // Latitude, longitude, height, heading, gimbal of each stop.
    let stops = missions.each_ref().map(|mission| {
        let told = stdout_of(&["mission", mission]);
        let numbers = |line: &str| -> Vec<f64> {
            let words = line.split([' ', ',']);
            words.skip(1).filter_map(|word| word.parse().ok()).collect()
        };
        let lines = told.lines().filter(|line| line.contains("  photo"));
        lines.map(numbers).collect::<Vec<_>>()
    });
    assert_eq!(stops[0].len(), photos.len());
    // The drone's own camera: its focal length over the scale, 50 pixels a metre.
    let focal = 5280_f64.hypot(3956.0) / 2.0 / 42_f64.to_radians().tan();
    for photo in photos {
        assert!(
            (photo["distance"].as_f64().unwrap() / (focal / 50.0) - 1.0).abs() < 1e-3,
            "{photo}"
        );
    }
    for (other, mission) in stops[1..].iter().zip(&missions[1..]) {
        assert_eq!(other.len(), photos.len());
        // ArduPilot keeps whole degrees of the gimbal's pitch.
        let whole = mission.ends_with(".plan") || mission.ends_with(".waypoints");
        let pitch = if whole { 0.5 + 1e-6 } else { 0.11 };
        for (ours, theirs) in stops[0].iter().zip(other) {
            let off = ours.iter().zip(theirs).map(|(a, b)| (a - b).abs());
            // Written to seven decimals of a degree and a centimetre.
            let most = [1.5e-7, 1.5e-7, 0.011, 0.11, pitch, 0.0];
            assert_eq!(ours.len(), most.len(), "{ours:?}");
            assert!(
                off.zip(most).all(|(off, most)| off <= most),
                "{ours:?} {theirs:?}"
            );
        }
    }
    // The same again writes over its own; .waypoints and Litchi's CSV bear no mark.
    let table = path("plan.csv");
    for _ in 0..2 {
        let again = planned(&flight, &["--mission", &missions[0], "-o", &table]);
        assert_eq!(
            again.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&again.stderr)
        );
    }
    // A take-off beside the surface has no height to count from.
    let off = [
        "plan",
        &flight,
        "--scale",
        "0.5 px/cm",
        "--area",
        AREA,
        "--take-off",
        "440000,5400020",
    ];
    let refused = fragscale(&off);
    assert_eq!(refused.status.code(), Some(1));
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        error.contains("take-off does not lie on the surface: it lies around (440000.0, 5400020.0), the surface at x 450000.0 to 450200.0"),
        "{error}"
    );
}

#[test]
fn what_makes_no_plan_is_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let error_of = |more: &[&str], code: i32| {
        let mut arguments = vec!["plan", flight.as_str()];
        arguments.extend(more);
        let output = fragscale(&arguments);
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{error}");
        error
    };
    let drone = ["--drone", "mavic-3e"];
    let with = |more: &[&'static str]| [&drone[..], more].concat();
    let error = error_of(&drone, 2);
    assert!(
        error.contains("--scale") && error.contains("--height"),
        "{error}"
    );
    let error = error_of(&with(&["--scale", "1 px/cm"]), 1);
    assert!(error.contains("no pile stands out of the floor"), "{error}");
    // The cloud alone: nobody says in which unit it is.
    let cloud = folder.path().join("plane.xyz").display().to_string();
    let output = fragscale(&["plan", &cloud, "--drone", "mavic-3e", "--scale", "1 px/cm"]);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(error.contains("nobody says in which unit"), "{error}");
    let area = "450060,5400060;450140,5400060;450140,5400140";
    let mut said = vec![
        "plan", &cloud, "--drone", "mavic-3e", "--scale", "1 px/cm", "--unit", "m",
    ];
    said.extend(["--area", area]);
    let output = fragscale(&said);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    // Its coordinate system says it, too: US survey feet are no metres.
    let metres = String::from_utf8_lossy(&output.stdout).into_owned();
    let told_by = |option: [&str; 2]| {
        let mut without = said.clone();
        without.drain(6..8);
        let output = fragscale(&[&without[..], &option].concat());
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{error}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    assert_eq!(told_by(["--crs", "EPSG:32632"]), metres);
    let feet = told_by([
        "--crs",
        "+proj=utm +zone=32 +datum=WGS84 +units=us-ft +no_defs",
    ]);
    assert!(feet.contains("us-ft") && feet != metres, "{feet}");
    assert_eq!(told_by(["--unit", "us-ft"]), feet);
    // Web Mercator stretches by 1 / cos(latitude): there at 43.576 degrees north (pyproj).
    let mercator = [&said[..], &["--crs", "EPSG:3857"]].concat();
    let output = fragscale(&mercator);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(
        error.contains("a metre of EPSG:3857 is 0.72") && error.contains("on the ground there"),
        "{error}"
    );
    let geocentric = [&said[..], &["--crs", "EPSG:4978"]].concat();
    let output = fragscale(&geocentric);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{error}");
    assert!(
        error.contains("counts from the middle of the Earth"),
        "{error}"
    );
    said[5] = "1e-9 px/cm";
    let output = fragscale(&said);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        error.contains("no photo of the area can be taken"),
        "{error}"
    );
    let error = error_of(&with(&["--scale", "1 px/cm", "--area", "0,0;1,0;1,1"]), 1);
    assert!(
        error.contains("the area does not lie on the surface: it lies around (0.5, 0.5)"),
        "{error}"
    );
    let error = error_of(&with(&["--scale", "1 px/cm", "--overlap", "0.7"]), 2);
    assert!(error.contains("it is in percent: 70"), "{error}");
    error_of(&with(&["--scale", "twenty"]), 2);
    error_of(&with(&["--scale", "1 px/cm", "--mission", "m.kmz"]), 2);
    let area = ["--area", "450060,5400060;450140,5400060;450140,5400140"];
    let error = error_of(
        &[
            &drone[..],
            &area,
            &["--scale", "1 px/cm", "--overlap", "100"],
        ]
        .concat(),
        1,
    );
    assert!(error.contains("overlap"), "{error}");
}

/// What cannot be written is known before the work, and then nothing else is.
#[test]
fn what_no_drone_flies_is_refused_first() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (kmz, other, table) = (path("m.kmz"), path("m.plan"), path("p.csv"));
    let places = ["--area", AREA, "--take-off", "450020,5400020"];
    let refused = |drone: &[&str]| {
        let files = ["--mission", &other, "--mission", &kmz, "-o", &table];
        let scale = ["--scale", "0.5 px/cm"];
        let error = error_of(&[&["plan", &flight][..], &scale, drone, &places, &files].concat());
        assert!(
            [&kmz, &other, &table]
                .iter()
                .all(|path| !Path::new(path).exists())
        );
        error
    };
    let error = refused(&["--drone", "phantom-4-rtk"]);
    assert!(
        error.contains("m.kmz: DJI's files of missions have no number for the DJI Phantom 4 RTK"),
        "{error}"
    );
    let error = refused(&[]);
    assert!(
        error.contains("m.kmz: DJI's files need the drone"),
        "{error}"
    );
    let error = refused(&["--drone", "mavic-3e", "--unit", "ft"]);
    assert!(
        error.contains("are in ft, and EPSG:32632 counts in units of 1 m"),
        "{error}"
    );
    // Of a mission that is there, too.
    let mission = planned(&flight, &["--mission", &other]);
    assert_eq!(mission.status.code(), Some(0));
    let error = error_of(&["mission", &other, "--to", &kmz, "--drone", "phantom-4-rtk"]);
    assert!(
        error.contains("no number for the DJI Phantom 4 RTK"),
        "{error}"
    );
}

/// A system that is typed goes before the flight's own, and that is told.
#[test]
fn another_system_than_the_flights_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    for (system, is_told) in [("EPSG:32632", false), ("EPSG:25832", true)] {
        let output = planned(&flight, &["--crs", system]);
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
        let said = format!("--crs {system} is taken; the flight itself says EPSG:32632");
        assert_eq!(notes.contains(&said), is_told, "{notes}");
    }
}

/// Missions of a plan with more batteries lie beside the one of a plan with fewer: that is said, and no other file is.
#[test]
fn missions_of_another_plan_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    for other in ["m-old.kmz", "m-1-b.kmz", "n-1.kmz", "m-1.plan"] {
        fs::write(path(other), "mine").unwrap();
    }
    let notes = |battery: &str| {
        let mission = path("m.kmz");
        let output = planned(&flight, &["--mission", &mission, "--battery", battery]);
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
        notes
    };
    let first = notes("2");
    assert!(Path::new(&path("m-battery-2.kmz")).is_file(), "{first}");
    assert!(!first.contains("another plan"), "{first}");
    let second = notes("60");
    assert!(
        second.contains("m-battery-1.kmz, m-battery-2.kmz"),
        "{second}"
    );
    assert!(second.contains("beside it are of another plan"), "{second}");
    assert!(
        !second.contains("m-old") && !second.contains("m-1"),
        "{second}"
    );
}

/// More photos than Litchi takes are flights of their own, in every file alike: one a way, with its photos, and page, JSON and notes
/// say how many. That DJI's app alone takes them all at once.
#[test]
fn a_long_way_is_several_flights() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (csv, geojson, sheet) = (path("m.csv"), path("m.geojson"), path("m.html"));
    let survey = ["--pattern", "survey", "--survey-overlap", "90"];
    let said = |more: &[&str]| {
        let more = [&survey[..], &["--format", "json"], more].concat();
        let output = planned(&flight, &more);
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
        let told: Value = serde_json::from_slice(&output.stdout).unwrap();
        (told, notes)
    };
    let files = ["--mission", &csv, "--mission", &geojson, "--sheet", &sheet];
    let (told, notes) = said(&files);
    let ways = told["ways"].as_array().unwrap();
    let photos = told["photos"].as_array().unwrap();
    assert!(photos.len() > 99 && ways.len() > 1, "{}", photos.len());
    let flights = format!(
        "Litchi takes 99 stops at once: the way is in {} flights",
        ways.len()
    );
    assert!(notes.contains(&flights), "{notes}");
    let mut taken = 0;
    for (way, number) in ways.iter().zip(1..) {
        let names = way["photos"].as_array().unwrap();
        taken += names.len();
        let told = stdout_of(&["mission", &path(&format!("m-{number}.geojson"))]);
        for name in names {
            let name = format!("photo {}\n", name.as_str().unwrap());
            assert!(told.contains(&name), "{number}: {name}");
        }
        let litchi = fs::read_to_string(path(&format!("m-{number}.csv"))).unwrap();
        assert!(litchi.lines().count() <= 1 + 99);
    }
    assert_eq!(taken, photos.len());
    assert!(!Path::new(&path(&format!("m-{}.csv", ways.len() + 1))).exists());
    let page = fs::read_to_string(&sheet).unwrap();
    assert!(page.contains("Flight 2") && !page.contains("Battery 2"));
    let (told, notes) = said(&["--mission", &path("d.kmz")]);
    assert_eq!(told["ways"].as_array().unwrap().len(), 1);
    assert!(Path::new(&path("d.kmz")).exists() && !notes.contains("at once"));
}

/// The surface ends at x 450000 and 450200, y 5400000 and 5400200: of an area at its corner the survey's ring is flown beyond,
/// where nobody knows the ground. That is counted and said, on standard error, in JSON and on the page; of one in its middle not.
#[test]
fn flying_beyond_the_surface_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let sheet = folder.path().join("m.html").display().to_string();
    let said = |area: &str| {
        let scale = [
            "--drone",
            "mavic-3e",
            "--scale",
            "1 px/cm",
            "--pattern",
            "survey",
        ];
        let places = ["--area", area, "--take-off", "450100,5400100"];
        let more = ["--format", "json", "--force", "--sheet", &sheet];
        let output = fragscale(&[&["plan", &flight][..], &scale, &places, &more].concat());
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
        let told: Value = serde_json::from_slice(&output.stdout).unwrap();
        (told, notes, fs::read_to_string(&sheet).unwrap())
    };
    let (told, notes, page) = said("450002,5400002;450022,5400002;450022,5400022;450002,5400022");
    let photos = told["photos"].as_array().unwrap();
    let out = photos.iter().filter(|photo| {
        let at = |i: usize| photo["center"][i].as_f64().unwrap();
        at(0) < 450_000.0 - 2.0 || at(1) < 5_400_000.0 - 2.0
    });
    let out = out.count() as u64;
    let beyond = &told["beyond_surface"];
    assert!(
        out > 3 && beyond["stops"].as_u64().unwrap() >= out,
        "{beyond}"
    );
    assert!(beyond["legs"].as_u64().unwrap() > out && beyond["farthest"].as_f64().unwrap() > 2.0);
    let words = "legs lie beyond the surface, up to ";
    assert!(
        notes.contains(words) && notes.contains("nobody knows what stands there"),
        "{notes}"
    );
    assert_eq!(
        page.matches(words).count(),
        2,
        "among the warnings, and beside the clearance"
    );
    let (told, notes, page) = said("450090,5400090;450110,5400090;450110,5400110;450090,5400110");
    assert_eq!(told["beyond_surface"]["stops"], 0);
    assert!(!notes.contains(words) && !page.contains(words), "{notes}");
}

/// What a careful pilot is told: a clearance within what the drone is off its place by satellites alone (1.5 m, so 2.9 m for 95 of
/// 100), and ground to keep out of on the straight way home, over which the drone does not come when the radio is lost.
#[test]
fn what_a_drone_does_by_itself_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let mission = folder.path().join("m.kmz").display().to_string();
    let listed = || stdout_of(&["mission", &mission]);
    let warned = |more: &[&str]| {
        let more = [&["--mission", &mission, "--force"][..], more].concat();
        String::from_utf8_lossy(&planned(&flight, &more).stderr).into_owned()
    };
    let low = "is less than the drone may be off its place, 2.9 m (95 %)";
    assert!(warned(&["--clearance", "2m"]).contains(low));
    for more in [
        &["--clearance", "3m"][..],
        &["--clearance", "2m", "--positioning", "rtk"],
    ] {
        assert!(!warned(more).contains("may be off its place"), "{more:?}");
    }
    assert!(listed().contains("where the radio is lost: returns home\n"));
    let between = "450035,5400035;450045,5400035;450045,5400045;450035,5400045";
    let said = warned(&["--keep-out", between]);
    let home = "the straight way home leads over an area to keep out of";
    assert!(said.contains(home), "{said}");
    assert!(listed().contains("where the radio is lost: hovers\n"));
    let beyond = "450180,5400180;450190,5400180;450190,5400190;450180,5400190";
    assert!(!warned(&["--keep-out", beyond]).contains(home));
    assert!(listed().contains("where the radio is lost: returns home\n"));
    // The plane falls by 40 m over the area: its upper end is 20 m nearer to photos from some 74 m over its mean.
    let survey = ["--pattern", "survey", "--no-ring"];
    let said = warned(&survey);
    let shares = "photos of the survey share ";
    assert!(
        said.contains(shares) && said.contains(", and 70.0 % in its mean"),
        "{said}"
    );
}

/// Two batteries' missions are one flight's; photos that are all 48 m too high are those that were planned, by heights above the
/// ellipsoid, which lies 48 m above the geoid there (EGM96).
#[test]
fn batteries_are_compared_together_and_another_datum_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (mission, plan) = (path("m.kmz"), path("plan.json"));
    // Six photos, of which a battery lasts for two.
    let output = fragscale(&[
        "plan",
        &flight,
        "--drone",
        "mavic-3e",
        "--scale",
        "1 px/cm",
        "--area",
        AREA,
        "--take-off",
        "450020,5400020",
        "--battery",
        "2",
        "-o",
        &plan,
        "--mission",
        &mission,
    ]);
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{notes}");
    let told: Value = serde_json::from_slice(&fs::read(&plan).unwrap()).unwrap();
    let photos = told["photos"].as_array().unwrap();
    let batteries = told["ways"].as_array().unwrap().len();
    assert!(batteries > 1, "{batteries}");
    let missions: Vec<String> = (1..=batteries)
        .map(|number| path(&format!("m-battery-{number}.kmz")))
        .collect();
    let mut more = vec!["flown", &flight, "--take-off", "450020,5400020"];
    more.extend(missions.iter().flat_map(|mission| ["--mission", mission]));
    for (higher, is_named) in [(0.0, false), (48.3, true)] {
        let mut poses = "photo,x,y,z,tilt,pan\n".to_owned();
        for (number, photo) in photos.iter().enumerate() {
            let at = |i: usize| photo["center"][i].as_f64().unwrap();
            let (tilt, pan) = (&photo["tilt"], &photo["pan"]);
            let z = at(2) + higher;
            poses += &format!("DJI_{number:04}.JPG,{},{},{z},{tilt},{pan}\n", at(0), at(1));
        }
        fs::write(folder.path().join("poses.csv"), poses).unwrap();
        let output = fragscale(&more);
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        let all = format!("{0} of {0} planned", photos.len());
        assert!(said.contains(&all), "{said} {notes}");
        assert_eq!(
            notes.contains("m higher than planned: it may have taken off elsewhere, or heights count from two datums: the geoid lies 4"),
            is_named,
            "{notes}"
        );
        for (number, photo) in photos.iter().enumerate() {
            let name = photo["photo"].as_str().unwrap();
            let line = said.lines().find(|line| line.starts_with(name)).unwrap();
            assert!(line.contains(&format!("DJI_{number:04}.JPG")), "{line}");
        }
    }
}

/// A mission that was flown half a metre to the east, 0.2 to the south and 0.1 too high, without its second photo.
#[test]
fn what_was_flown_is_compared_with_its_mission() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (mission, plan) = (path("m.kmz"), path("plan.json"));
    let output = planned(&flight, &["-o", &plan, "--mission", &mission]);
    assert_eq!(output.status.code(), Some(0));
    let told: Value = serde_json::from_slice(&fs::read(&plan).unwrap()).unwrap();
    let photos = told["photos"].as_array().unwrap();
    let mut poses = "photo,x,y,z,tilt,pan\n".to_owned();
    for (number, photo) in photos.iter().enumerate().filter(|(number, _)| *number != 1) {
        let at = |i: usize| photo["center"][i].as_f64().unwrap();
        let angle = |name: &str| photo[name].as_f64().unwrap();
        let (x, y, z) = (at(0) + 0.5, at(1) - 0.2, at(2) + 0.1);
        let (tilt, pan) = (angle("tilt"), angle("pan"));
        poses += &format!(
            "DJI_{number:04}.JPG,{x},{y},{z},{},{}\n",
            tilt - 0.5,
            pan + 1.0
        );
    }
    fs::write(folder.path().join("poses.csv"), poses).unwrap();
    // DJI's file has no place for a take-off without an elevation.
    let refused = fragscale(&["flown", &flight, "--mission", &mission]);
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(error.contains("say it: --take-off X,Y"), "{error}");
    let output = fragscale(&[
        "flown",
        &flight,
        "--mission",
        &mission,
        "--take-off",
        "450020,5400020",
        "--format",
        "json",
    ]);
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{notes}");
    assert!(notes.contains("1 planned photos were not taken"), "{notes}");
    let said: Value = serde_json::from_slice(&output.stdout).unwrap();
    let found: Vec<&Value> = (said["photos"].as_array().unwrap().iter())
        .map(|photo| &photo["flown"])
        .filter(|flown| !flown.is_null())
        .collect();
    assert_eq!(found.len(), photos.len() - 1);
    for flown in found {
        // DJI's file keeps 1e-7 degrees (a centimetre), millimetres and hundredths of a degree.
        for (i, expected) in [0.5, -0.2, 0.1].into_iter().enumerate() {
            let off = flown["offset"][i].as_f64().unwrap() - expected;
            assert!(off.abs() < 0.011, "{flown}");
        }
        assert!(
            (flown["tilt"].as_f64().unwrap() + 0.5).abs() < 0.011,
            "{flown}"
        );
        assert!(
            (flown["pan"].as_f64().unwrap() - 1.0).abs() < 0.011,
            "{flown}"
        );
        assert!(flown["shared"].as_f64().unwrap() > 0.9, "{flown}");
    }
    assert!(!notes.contains("look more than 30°"), "{notes}");
    let other = folder.path().join("other");
    fs::create_dir(&other).unwrap();
    for file in fs::read_dir(folder.path()).unwrap().map(Result::unwrap) {
        if file.file_type().unwrap().is_file() {
            fs::copy(file.path(), other.join(file.file_name())).unwrap();
        }
    }
    // The same places, looking the other way.
    let poses = fs::read_to_string(other.join("poses.csv")).unwrap();
    let mut lines = poses.lines();
    let mut turned = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let (before, pan) = line.rsplit_once(',').unwrap();
        let (before, _) = before.rsplit_once(',').unwrap();
        let pan: f64 = pan.parse().unwrap();
        turned += &format!("{before},50,{}\n", pan + 180.0);
    }
    fs::write(other.join("poses.csv"), turned).unwrap();
    let flight_of_another = other.join("flight.toml").display().to_string();
    let place = ["--take-off", "450020,5400020"];
    let arguments = ["flown", &flight_of_another, "--mission", &mission];
    let output = fragscale(&[&arguments[..], &place].concat());
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    let says = "photos look more than 30° away from where they were to look";
    assert!(notes.contains(says), "{notes}");
    // In a picture the photo that was not taken is red; without the mission nothing is.
    #[cfg(feature = "render")]
    {
        let reds = |name: &str, more: &[&str]| {
            let picture = path(name);
            // An axis is red, too.
            let own = ["render", &flight, "-o", &picture, "--show", "mesh"];
            let output = fragscale(&[&own[..], more].concat());
            let notes = String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(output.status.code(), Some(0), "{notes}");
            let pixels = image::open(&picture).unwrap().into_rgb8();
            // Thin lines are mixed with what is behind them.
            let is_red = |pixel: &&image::Rgb<u8>| {
                let [red, green, blue] = pixel.0.map(i32::from);
                red - green.max(blue) > 60 && (green - blue).abs() < 20
            };
            pixels.pixels().filter(is_red).count()
        };
        let of = ["--mission", &mission, "--take-off", "450020,5400020"];
        assert!(reds("flown3d.png", &of) > 10);
        assert_eq!(reds("alone.png", &[]), 0);
    }
    let figures = ["flown.svg", "flown.pdf", "flown.png"].map(path);
    let place = ["--mission", &mission, "--take-off", "450020,5400020"];
    let mut more = vec!["flown", &flight];
    more.extend(place);
    more.extend(figures.iter().flat_map(|figure| ["--figure", figure]));
    // The second time over its own.
    for _ in 0..2 {
        let output = fragscale(&more);
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
    }
    let svg = fs::read_to_string(&figures[0]).unwrap();
    assert!(svg.contains(">not taken: 1<"), "{svg}");
    more.extend(["--figure", "flown.gif"]);
    let refused = fragscale(&more);
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        error.contains("flown.gif: a drawing is written as SVG, PDF or PNG"),
        "{error}"
    );
}

/// Ground to keep out of is a fence of the mission, and no stop lies over it; how far the drone's errors move a scale is
/// that of its distance.
#[test]
fn what_is_kept_out_of_is_a_fence() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let mission = folder.path().join("m.plan").display().to_string();
    let corners = "450090,5400090;450110,5400090;450110,5400110;450090,5400110";
    let more = [
        "--keep-out",
        corners,
        "--mission",
        &mission,
        "--format",
        "json",
        "--positioning",
    ];
    let output = planned(&flight, &[&more[..], &["rtk"]].concat());
    let notes = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{notes}");
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    for photo in told["photos"].as_array().unwrap() {
        let at = |i: usize| photo["center"][i].as_f64().unwrap();
        let inside =
            (450_085.0..450_115.0).contains(&at(0)) && (5_400_085.0..5_400_115.0).contains(&at(1));
        assert!(!inside, "{photo}");
        // Along the normal of the plane 0.1 m is 0.1 m, whichever way: 1.96 of it over the distance.
        let expected = 100.0 * 1.96 * 0.1 / photo["distance"].as_f64().unwrap();
        let interval = photo["interval_95_percent"].as_f64().unwrap();
        assert!(
            (interval / expected - 1.0).abs() < 0.1,
            "{interval} {expected}"
        );
    }
    let written: Value = serde_json::from_slice(&fs::read(&mission).unwrap()).unwrap();
    let fence = &written["geoFence"]["polygons"][0];
    assert_eq!(fence["inclusion"], false);
    assert_eq!(fence["polygon"].as_array().unwrap().len(), 4);
    // Latitude and longitude swapped, or another zone: nobody would be kept out.
    let far = planned(
        &flight,
        &["--keep-out", "5400090,450090;5400110,450090;5400110,450110"],
    );
    let error = String::from_utf8_lossy(&far.stderr).into_owned();
    assert_eq!(far.status.code(), Some(1));
    assert!(error.contains("nowhere near the surface"), "{error}");
    let fast = planned(&flight, &["--speed", "1e308"]);
    assert!(String::from_utf8_lossy(&fast.stderr).contains("at most 25 m/s"));
    let inside = planned(
        &flight,
        &["--keep-out", "450010,5400010;450030,5400010;450020,5400040"],
    );
    let error = String::from_utf8_lossy(&inside.stderr).into_owned();
    assert_eq!(inside.status.code(), Some(1));
    assert!(
        error.contains("take-off lies in an area to keep out of"),
        "{error}"
    );
}

/// A real quarry, whose file has y upwards: every photo shows the wished scale, or says what is wrong.
#[test]
fn a_real_quarry_is_planned() {
    let Some(terrain) = shared_data("authume-quarry-terrain/Geometries/Point_cloud/Terrain.xyz")
    else {
        return;
    };
    // As it is it lies on its side: that is said, and how to turn it.
    let lying = terrain.display().to_string();
    let scale = ["--drone", "mavic-3e", "--scale", "1 px/cm", "--unit", "m"];
    let refused = fragscale(&[&["plan", &lying][..], &scale].concat());
    let notes = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        notes.contains("write up = \"y\" below [surface]"),
        "{notes}"
    );
    let folder = tempfile::tempdir().unwrap();
    // A cloud alone has z upwards, unless another axis is named.
    let turned = fs::read_to_string(terrain).unwrap();
    let turned: String = (turned.lines())
        .filter_map(|line| {
            let mut numbers = line
                .split_whitespace()
                .filter_map(|word| word.parse::<f64>().ok());
            let (x, y, z) = (numbers.next()?, numbers.next()?, numbers.next()?);
            Some(format!("{x} {} {y}\n", -z))
        })
        .collect();
    let cloud = folder.path().join("quarry.xyz");
    fs::write(&cloud, turned).unwrap();
    let flight = cloud.display().to_string();
    let area = ["--unit", "m", "--area", "20,-380;90,-380;90,-260;20,-260"];
    let asked = [
        "--drone", "mavic-3e", "--scale", "1 px/cm", "--format", "json",
    ];
    let told = |words: &[&str]| -> Value {
        let told = fragscale(&[&["plan"], words, &asked, &area].concat());
        let notes = String::from_utf8_lossy(&told.stderr).into_owned();
        assert_eq!(told.status.code(), Some(0), "{notes}");
        // Its unit was stated, and it has no photos to doubt.
        assert!(!notes.contains("no scale and no length"), "{notes}");
        serde_json::from_slice(&told.stdout).unwrap()
    };
    let (turned, told) = (told(&[&flight]), told(&[&lying, "--up", "y"]));
    assert_eq!(turned["photos"], told["photos"]);
    let photos = told["photos"].as_array().unwrap();
    assert!(photos.len() > 5, "{}", photos.len());
    for photo in photos {
        let scale = |name: &str| photo[name].as_f64();
        let is_named = !photo["troubles"].as_array().unwrap().is_empty();
        let is_right = [scale("top"), scale("bottom")]
            .iter()
            .flatten()
            .all(|scale| (scale - 1.0).abs() < 0.1);
        assert!(is_named || is_right, "{photo}");
    }
}

/// The page has the plan's photos; a name that is none of a page is refused before anything is read.
#[test]
fn a_plan_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (sheet, plan) = (path("sheet.html"), path("plan.json"));
    // The second time over its own.
    for _ in 0..2 {
        let output = planned(&flight, &["-o", &plan, "--sheet", &sheet]);
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
    }
    let page = fs::read_to_string(&sheet).unwrap();
    let told: Value = serde_json::from_slice(&fs::read(&plan).unwrap()).unwrap();
    for photo in told["photos"].as_array().unwrap() {
        let cell = format!("<td>{}</td>", photo["photo"].as_str().unwrap());
        assert!(page.contains(&cell), "{cell}");
    }
    assert!(
        page.contains("the maker&#39;s nominal one") && page.contains("DJI Mavic 3 Enterprise")
    );
    let refused = planned(&flight, &["--sheet", &path("sheet.pdf")]);
    let error = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(error.contains("let its name end in .html"), "{error}");
    // What somebody else wrote stays.
    fs::write(&sheet, "<!DOCTYPE html>\n<html></html>").unwrap();
    assert_eq!(
        planned(&flight, &["--sheet", &sheet]).status.code(),
        Some(1)
    );
}

/// On a plane that falls to the east by 1 in 2 the morning sun throws no shadow, and the evening's, which stands lower than
/// the plane rises, leaves all of it dark.
#[test]
fn the_sun_throws_shadows() {
    let folder = tempfile::tempdir().unwrap();
    let flight = plane(folder.path());
    for (when, expected, azimuth) in [
        ("2026-06-21T06:00Z", 0.0, 0.0..180.0),
        ("2026-06-21T20:30+02:00", 1.0, 180.0..360.0),
    ] {
        let output = planned(&flight, &["--sun", when, "--format", "json"]);
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{notes}");
        let told: Value = serde_json::from_slice(&output.stdout).unwrap();
        let sun = |name: &str| told["sun"][name].as_f64().unwrap();
        assert!(
            (5.0..35.0).contains(&sun("elevation")) && azimuth.contains(&sun("azimuth")),
            "{when}"
        );
        // Along the surface's edge nothing stands behind it.
        assert!(
            (sun("shadow") - expected).abs() < 0.02,
            "{when}: {}",
            sun("shadow")
        );
        assert!(
            (told["photos"][0]["shadow"].as_f64().unwrap() - expected).abs() < 0.1,
            "{when}"
        );
    }
    let wrong = planned(&flight, &["--sun", "noon"]);
    let error = String::from_utf8_lossy(&wrong.stderr).into_owned();
    assert!(
        error.contains("sun: the time is none") && wrong.status.code() == Some(1),
        "{error}"
    );
}
