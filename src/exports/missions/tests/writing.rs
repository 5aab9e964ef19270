//! Files with their names: parts, what may be written over.

use fragscale_formats::read_mission;

use super::*;

fn write_mission(
    mission: &Mission,
    path: &Path,
    inputs: &Inputs,
    force: bool,
) -> Result<WrittenMission, FileError> {
    write_missions(&[(String::new(), mission.clone())], path, inputs, force)
}

/// Two batteries of which each needs three files.
#[test]
fn batteries_and_parts_are_in_the_names() {
    let mut long = mission();
    long.stops = vec![long.stops[0].clone(); 250];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pile.csv");
    let batteries = ["-battery-1", "-battery-2"].map(|name| (name.to_owned(), long.clone()));
    let written = write_missions(&batteries, &path, &Inputs::default(), false).unwrap();
    assert_eq!(written.files.len(), 6);
    assert!(folder.path().join("pile-battery-2-3.csv").exists());
}

#[test]
fn more_stops_than_litchi_takes_are_several_missions() {
    let mut long = mission();
    let stop = long.stops[0].clone();
    long.stops = (0..250)
        .map(|i| Stop {
            latitude: 50.0 + f64::from(i) * 1e-5,
            gimbal_pitch: (i == 0).then_some(-62.7),
            ..stop.clone()
        })
        .collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("pile.csv");
    let written = write_mission(&long, &path, &Inputs::default(), false).unwrap();
    let names: Vec<_> = written
        .files
        .iter()
        .map(|path| path.file_name().unwrap().to_str().unwrap())
        .collect();
    assert_eq!(names, ["pile-1.csv", "pile-2.csv", "pile-3.csv"]);
    assert!(
        written.notes[0].starts_with("Litchi takes 99 stops at once: the mission is in 3 files"),
        "{:?}",
        written.notes
    );
    let mut stops = Vec::new();
    for path in &written.files {
        let part = read_mission(path).unwrap().mission;
        assert!(part.stops.len() <= 99);
        // The gimbal is where it was.
        assert_eq!(part.stops[0].gimbal_pitch, Some(-62.7));
        stops.extend(part.stops);
    }
    assert_eq!(stops.len(), 250);
    for (a, b) in long.stops.iter().zip(&stops) {
        assert!((a.latitude - b.latitude).abs() < 1e-9);
    }
}

/// 250 photos of 5 commands each, in missions of at most 700 with home, take-off, speed and end.
#[test]
fn more_commands_than_a_pixhawk_keeps_are_several_missions() {
    let mut long = mission();
    long.stops = vec![long.stops[0].clone(); 250];
    for format in [MissionFormat::QGroundControl, MissionFormat::Waypoints] {
        let files = mission_files(&long, format).unwrap();
        let suffixes: Vec<&str> = files
            .files
            .iter()
            .map(|(suffix, _)| suffix.as_str())
            .collect();
        assert_eq!(suffixes, ["-1", "-2"]);
        assert!(files.notes[0].starts_with("ArduPilot takes 700 commands at once"));
    }
    let files = mission_files(&long, MissionFormat::Waypoints)
        .unwrap()
        .files;
    let lines = |index: usize| {
        String::from_utf8(files[index].1.clone())
            .unwrap()
            .lines()
            .count()
            - 1
    };
    assert_eq!((lines(0), lines(1)), (4 + 139 * 5, 4 + 111 * 5));
    // DJI and what is to be looked at take them all.
    for format in [
        MissionFormat::DjiWpml,
        MissionFormat::Kml,
        MissionFormat::GeoJson,
    ] {
        assert_eq!(mission_files(&long, format).unwrap().files.len(), 1);
    }
}

/// What fragscale wrote it writes again; what others wrote only where somebody says so; what was read never.
#[test]
fn what_may_be_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let mut inputs = Inputs::default();
    for format in MissionFormat::ALL {
        let path = folder.path().join(format!("a.{}", format.ending()));
        let write = |inputs: &Inputs, force| write_mission(&mission(), &path, inputs, force);
        write(&inputs, false).unwrap();
        write(&inputs, false).unwrap();
        // As another program would write the same mission for Mission Planner or Litchi.
        if matches!(format, MissionFormat::Waypoints | MissionFormat::Litchi) {
            let text = std::fs::read_to_string(&path).unwrap();
            std::fs::write(&path, text.replace("-0\t", "0\t").replace(",-0,", ",0,")).unwrap();
            write(&inputs, false).unwrap_err();
        }
        write(&inputs, true).unwrap();
        inputs.add(&path);
        let error = write(&inputs, true).unwrap_err().to_string();
        assert!(error.contains("never written over"), "{error}");
    }
    let error =
        write_mission(&mission(), &folder.path().join("a.txt"), &inputs, false).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("a.txt: its name does not say what ground station it is for")
    );
}

/// The schema's order of elements, and heights above the sea where the take-off's elevation is known.
#[test]
fn kml_is_to_be_looked_at() {
    let kml = text(&mission(), MissionFormat::Kml);
    let document = roxmltree::Document::parse(&kml).unwrap();
    let places: Vec<&str> = document
        .descendants()
        .filter(|node| node.has_tag_name("coordinates"))
        .filter_map(|node| node.text())
        .collect();
    // Take-off, three stops, the path, a fence that ends where it began.
    assert_eq!(places.len(), 6);
    assert_eq!(places[0], "7,50");
    let height: f64 = places[1].rsplit(',').next().unwrap().parse().unwrap();
    assert!((height - 172.34).abs() < 0.02, "{height}");
    assert_eq!(places[4].split(' ').count(), 3);
    assert_eq!(
        places[5],
        "7.001,50.001 7.001,50.002 7.002,50.002 7.001,50.001"
    );
    assert!(kml.contains("12.34 m above the place of take-off; heading 37.4 degrees; gimbal -62.7 degrees; waits 3 s; photo P001"));
    let mut nowhere = mission();
    nowhere.take_off = None;
    assert!(text(&nowhere, MissionFormat::Kml).contains("<altitudeMode>relativeToGround</"));
    assert!(notes(&nowhere, MissionFormat::Kml).contains("above the ground below each stop"));
    nowhere.name = "a<b>&".to_owned();
    assert!(text(&nowhere, MissionFormat::Kml).contains("<name>a&lt;b&gt;&amp;</name>"));
}

/// Missions of all kinds that a ground station may get, written into a folder.
fn write_all_kinds(folder: &Path) -> Vec<PathBuf> {
    let mut absolute = mission();
    for stop in &mut absolute.stops {
        let metres = 160.0 + stop.height.metres;
        let above = Above::Geoid;
        stop.height = Height { metres, above };
    }
    let mut long = mission();
    let first = long.stops[0].clone();
    long.stops = (0..400)
        .map(|i| Stop {
            latitude: 50.0 + f64::from(i) * 1e-5,
            ..first.clone()
        })
        .collect();
    let mut hover = mission();
    hover.finish = Finish::Hover;
    hover.stops.truncate(1);
    let mut land = mission();
    land.finish = Finish::Land;
    land.take_off = None;
    let mut files = Vec::new();
    for (name, mission) in [
        ("relative", mission()),
        ("absolute", absolute),
        ("long", long),
        ("hover", hover),
        ("land", land),
    ] {
        for format in MissionFormat::ALL {
            let path = folder.join(format!("{name}.{}", format.ending()));
            let written = write_mission(&mission, &path, &Inputs::default(), true);
            files.extend(written.unwrap_or_else(|error| panic!("{error}")).files);
        }
    }
    files
}

/// The programs of `shared/check-missions`, where they run: DJI's tables (Python alone), ArduPilot's
/// pymavlink, the KML schema (fastkml), litchi_wp. `FRAGSCALE_MISSIONS_OUT` names a folder in which the
/// files stay, for `load_missions.py`, which needs a port.
#[test]
fn others_take_the_files() {
    let own = tempfile::tempdir().unwrap();
    let named = std::env::var_os("FRAGSCALE_MISSIONS_OUT").map(PathBuf::from);
    let folder = named.as_deref().unwrap_or(own.path());
    let files = write_all_kinds(folder);
    let (Some(data), Some(python)) = (
        fragscale_test_data::shared_data("missions"),
        fragscale_test_data::program("python3"),
    ) else {
        return;
    };
    let checks = data.join("../../check-missions");
    for (program, ending, bad) in [
        ("wpml_check.py", "kmz", "FAIL"),
        ("wp.py", "waypoints", "REFUSED"),
        ("kml.py", "kml", "REFUSED"),
        ("litchi.py", "csv", "REFUSED"),
    ] {
        let of_it: Vec<&PathBuf> = files
            .iter()
            .filter(|file| file.extension().is_some_and(|own| own == ending))
            .collect();
        let output = std::process::Command::new(&python)
            .arg(checks.join(program))
            .args(&of_it)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        let wrong = String::from_utf8_lossy(&output.stderr);
        if wrong.contains("ModuleNotFoundError") || wrong.contains("No such file") {
            continue;
        }
        assert!(output.status.success(), "{wrong}");
        assert!(!said.contains(bad) && !said.contains("False"), "{said}");
        let good = match ending {
            "kmz" => said.matches("OK  ").count(),
            "waypoints" => said.matches("round trip same: True").count(),
            "kml" => said.matches(" True").count(),
            _ => said.lines().count(),
        };
        assert_eq!(good, of_it.len(), "{said}");
        if ending == "csv" {
            // Of those with a stop below the take-off it takes all other lines: it knows no pits.
            assert_eq!(said.matches("2 of 3 lines valid").count(), 3, "{said}");
            assert_eq!(said.matches("99 of 99 lines valid").count(), 4, "{said}");
        }
    }
}
