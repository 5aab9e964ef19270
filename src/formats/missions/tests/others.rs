//! QGroundControl, Mission Planner, Litchi.

use fragscale_core::plan::{Above, Finish, Height};

use super::*;

/// What `ref.plan` and `ref.waypoints` say alike.
fn is_ref(mission: &Mission) {
    let take_off = mission.take_off.unwrap();
    let above = Above::Geoid;
    let elevation = Some(Height {
        metres: 160.0,
        above,
    });
    assert_eq!((take_off.latitude, take_off.longitude), (50.0, 7.0));
    assert_eq!(take_off.elevation, elevation);
    assert_eq!(mission.safe_height, Some(20.0));
    assert_eq!(mission.finish, Finish::ReturnHome);
    assert_eq!(mission.stops.len(), 2);
    assert_eq!(place(&mission.stops[0]), (50.0001, 7.0001, 12.34));
    assert_eq!(place(&mission.stops[1]), (50.0002, 7.0001, 13.9));
    assert!(all_above(mission, Above::TakeOff));
    assert_eq!(photos(mission), [0, 1]);
    let aims: Vec<_> = (mission.stops.iter())
        .map(|stop| (stop.heading, stop.gimbal_pitch, stop.settle))
        .collect();
    let expected = [
        (Some(37.4), Some(-62.7), 3.0),
        (Some(40.0), Some(-58.1), 3.0),
    ];
    assert_eq!(aims, expected);
}

#[test]
fn the_sequence_of_a_photo_in_both_forms() {
    let (Some(plan), Some(waypoints)) = (shared("ref.plan"), shared("ref.waypoints")) else {
        return;
    };
    is_ref(&plan.mission);
    is_ref(&waypoints.mission);
    assert_eq!(plan.notes, [""; 0]);
    assert_eq!(waypoints.notes, [""; 0]);
    assert_eq!(
        (plan.mission.speed, waypoints.mission.speed),
        (Some(3.0), None)
    );
    let fences = &plan.mission.fences;
    assert_eq!(fences.len(), 2);
    assert!(!fences[0].keep_in && fences[1].keep_in);
    assert_eq!(fences[0].corners[2], [50.002, 7.002]);
}

#[test]
fn plans_that_qgroundcontrol_saved() {
    let Some(file) = shared("qgc/mavsdk_qgroundcontrol_sample.plan") else {
        return;
    };
    let mission = &file.mission;
    let home = mission.take_off.unwrap();
    assert_eq!((home.latitude, home.longitude), (47.397_750_7, 8.545_607_5));
    assert_eq!(home.elevation.unwrap().metres, 488.931_017_520_017_63);
    assert_eq!(
        (mission.speed, mission.safe_height),
        (Some(5.0), Some(50.0))
    );
    assert_eq!(mission.stops.len(), 3);
    assert_eq!(
        place(&mission.stops[2]),
        (47.398_278_42, 8.545_608_24, 50.0)
    );
    assert_eq!(photos(mission), [0]);
    assert_eq!(mission.finish, Finish::ReturnHome);

    let survey = shared("qgc/mavsdk_qgroundcontrol_sample_with_survey.plan").unwrap();
    assert_eq!(survey.mission.stops.len(), 8);
    let last = (47.397_481_130_140_56, 8.546_342_098_220_613, 50.0);
    assert_eq!(place(&survey.mission.stops[7]), last);
    let note = "photos by distance or time are no stops: not read (4 times, first at item 2.2)";
    assert!(said(&survey, note), "{:?}", survey.notes);

    let scan = shared("qgc/mavsdk_qgroundcontrol_sample_with_structured_scan.plan").unwrap();
    assert_eq!(scan.mission.stops.len(), 0);
    assert!(said(&scan, "it has no waypoint"));
    assert!(said(
        &scan,
        "a StructureScan without its waypoints is not read (item 2)"
    ));

    let camera = shared("qgc/mavsdk_qgroundcontrol_sample_with_digicam_control.plan").unwrap();
    assert_eq!(camera.mission.stops.len(), 0);
    assert!(said(
        &camera,
        "a photo before the first waypoint is passed over (item 1)"
    ));
}

#[test]
fn bad_plans_are_refused_in_a_line() {
    let again = "; open it in QGroundControl and save it again";
    for (name, what) in [
        (
            "qgc/mavsdk_qgroundcontrol_sample_wrong_overall_version",
            "\"version\" is 42, and only 1 is known",
        ),
        (
            "qgc/mavsdk_qgroundcontrol_sample_without_mission",
            "it has no \"mission\"",
        ),
        (
            "qgc/mavsdk_qgroundcontrol_sample_wrong_mission_version",
            "\"mission.version\" is 7, and only 2 is known",
        ),
        (
            "qgc/mavsdk_qgroundcontrol_sample_with_survey_wrong_version",
            "item 2: the version of a survey is 9, and only 3 to 6 are known",
        ),
        ("no_geoFence", "it has no \"geoFence\""),
        ("no_rallyPoints", "it has no \"rallyPoints\""),
    ] {
        let Some(path) = shared_data(&format!("missions/{name}.plan")) else {
            return;
        };
        let error = read_mission(&path).unwrap_err().to_string();
        assert!(error.ends_with(&format!(".plan: {what}{again}")), "{error}");
        assert_eq!(error.lines().count(), 1);
    }
}

#[test]
fn files_of_mission_planner() {
    let Some(file) = shared("waypoints/qgc_test_MissionPlanner.waypoints") else {
        return;
    };
    let home = file.mission.take_off.unwrap();
    assert_eq!((home.latitude, home.longitude), (47.660_459, -122.103_167));
    assert_eq!(home.elevation.unwrap().metres, 5.21);
    assert_eq!(file.mission.stops.len(), 5);
    assert_eq!(
        place(&file.mission.stops[4]),
        (47.660_459, -122.105_538, 100.0)
    );
    assert_eq!(file.mission.finish, Finish::Hover);

    let terrain = shared("waypoints/ardupilot_terrain_wp.waypoints")
        .unwrap()
        .mission;
    assert!(all_above(&terrain, Above::Ground));
    assert_eq!(terrain.stops.len(), 3);
    assert_eq!(
        place(&terrain.stops[0]),
        (-35.362_806, 149.158_480_2, 100.0)
    );

    let spline = shared("waypoints/ardupilot_spline_wp.waypoints").unwrap();
    assert_eq!(spline.mission.stops.len(), 2);
    assert_eq!(spline.mission.safe_height, Some(50.0));
    assert!(
        said(&spline, "splines are read as straight lines (line 4)"),
        "{:?}",
        spline.notes
    );

    // Without home, and absolute.
    let absolute = shared("waypoints/mavsdk_mission_planner_sample.waypoints").unwrap();
    assert_eq!(absolute.mission.stops.len(), 2);
    assert!(all_above(&absolute.mission, Above::Geoid));
    assert_eq!(
        place(&absolute.mission.stops[0]),
        (47.397_799_2, 8.545_466_9, 15.0)
    );
    assert_eq!(absolute.mission.take_off.unwrap().latitude, 47.397_810_1);
    assert!(said(
        &absolute,
        "above mean sea level: taken as the geoid EGM96"
    ));
}

/// Home is line 0 of the indices: the first waypoint is not it, and heights do not count from there.
#[test]
fn home_is_no_stop() {
    let text = "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t50\t7\t160\t1\n\
                1\t0\t3\t16\t5\t0\t0\t90\t50.1\t7.1\t-12.5\t1\n2\t0\t2\t2000\t0\t0\t1\t0\t0\t0\t0\t1\n";
    let (_folder, path) = written("a.waypoints", text);
    let file = read_mission(&path).unwrap();
    assert_eq!(file.mission.stops.len(), 1);
    assert_eq!(place(&file.mission.stops[0]), (50.1, 7.1, -12.5));
    assert_eq!(file.mission.stops[0].settle, 5.0);
    // Copter does not turn for it.
    assert_eq!(file.mission.stops[0].heading, None);
    assert!(said(
        &file,
        "the yaw of a waypoint is passed over: Copter ignores it (line 3)"
    ));
    let other = refused("a.txt", text.replace("110", "120"));
    assert!(
        other.starts_with("a.txt:1: 'QGC WPL 120': a version that is not known"),
        "{other}"
    );
    let short = refused("a.waypoints", text.replace("\t-12.5\t1", ""));
    assert!(
        short.starts_with("a.waypoints:3: the line ends where a parameter should be"),
        "{short}"
    );
    let frame = refused("a.waypoints", text.replace("1\t0\t3\t16", "1\t0\t2\t16"));
    assert!(
        frame.starts_with("a.waypoints:3: a waypoint in frame 2"),
        "{frame}"
    );
}

#[test]
fn files_of_litchi() {
    let Some(file) = shared("litchi/litchi_wp_waypoints.csv") else {
        return;
    };
    let mission = &file.mission;
    assert_eq!(mission.stops.len(), 52);
    assert_eq!(photos(mission).len(), 47);
    assert!(all_above(mission, Above::Ground));
    assert_eq!(
        place(&mission.stops[0]),
        (21.256_875_6, -157.807_261_1, 100.0)
    );
    assert_eq!(
        place(&mission.stops[51]),
        (21.257_703_8, -157.805_444_9, 100.0)
    );
    assert_eq!(
        (mission.stops[1].heading, mission.stops[1].settle),
        (Some(180.0), 1.5)
    );
    assert_eq!(mission.speed, Some(15.0));
    assert!(said(&file, "only where Litchi's heading mode is Custom"));

    // Saved again by a spreadsheet that writes decimal commas.
    let path = shared_data("missions/litchi/litchi_wp_waypoints.csv").unwrap();
    let text = std::fs::read_to_string(path).unwrap();
    let saved_again = text.replace(',', ";").replace('.', ",");
    let (_folder, path) = written("litchi_wp_waypoints.csv", saved_again);
    let again = read_mission(&path).unwrap().mission;
    assert_eq!(again, *mission);

    // Blanks behind the commas, and actionparam9 twice in the head.
    let blanks = shared("litchi/fp2lm_LitchiMissionTest.csv").unwrap();
    assert_eq!(blanks.mission.stops.len(), 10);
    assert_eq!(photos(&blanks.mission).len(), 10);
    let first = (43.000_922_531_700_8, -89.000_306_951_157_3, 30.0);
    assert_eq!(place(&blanks.mission.stops[0]), first);
    assert_eq!(blanks.mission.stops[0].heading, Some(88.630_554));
    assert_eq!(blanks.mission.stops[0].gimbal_pitch, None);
    assert!(said(
        &blanks,
        "its gimbalmode is 0 (10 times, first at waypoint 1)"
    ));

    let golden = shared("litchi/fp2lm_litchi_golden.csv").unwrap().mission;
    assert!(all_above(&golden, Above::TakeOff));
    assert_eq!((golden.stops.len(), golden.speed), (10, None));
    assert_eq!(golden.stops[3].heading, Some(178.6));

    let short = shared("litchi/ymapper_waypoints.csv").unwrap().mission;
    assert_eq!((short.stops.len(), short.speed), (4, Some(6.0)));
    assert_eq!(short.stops[0].gimbal_pitch, Some(0.0));
    assert_eq!(
        place(&short.stops[3]),
        (39.582_319_488_614_814, 3.376_525_161_887_631_3, 30.0)
    );
}

#[test]
fn what_is_no_mission_is_refused_in_a_line() {
    assert!(
        refused("a.csv", "x,y\n1,2\n").starts_with("a.csv: it holds no mission of a known kind")
    );
    assert!(refused("a.plan", "").starts_with("a.plan: it is empty"));
    assert!(refused("a.plan", "{\"a\": 1}").contains("JSON without \"fileType\": \"Plan\""));
    let cut = refused("a.plan", "{\"fileType\": \"Plan\",\n \"version\": 1");
    assert!(cut.starts_with("a.plan:2: EOF"), "{cut}");
    let deep = refused("a.plan", format!("{{\"mission\":{}", "[".repeat(1_000_000)));
    assert!(deep.starts_with("a.plan:1: "), "{deep}");
    // Three bytes of JSON would be a hundred in memory.
    let many = format!(
        "{{\"fileType\": \"Plan\", \"x\": \"{}\"}}",
        " ".repeat(17 << 20)
    );
    assert!(refused("a.plan", many).starts_with("a.plan: it is larger than 16 MB, no mission"));
    let folder = tempfile::tempdir().unwrap();
    let empty = read_mission(folder.path()).unwrap_err().to_string();
    assert!(
        empty.contains("a folder without waylines.wpml and template.kml"),
        "{empty}"
    );
    let missing = read_mission(&folder.path().join("no.kmz")).unwrap_err();
    assert!(missing.to_string().contains("there is no such file"));
}
