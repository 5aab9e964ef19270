//! What others fell into.

use super::*;

fn lines(mission: &Mission) -> Vec<Vec<String>> {
    let text = text(mission, MissionFormat::Waypoints);
    let lines = text.lines().skip(1);
    lines
        .map(|line| line.split('\t').map(str::to_owned).collect())
        .collect()
}

/// As `ref.waypoints`: 16, 115, 1000, 93, 2000 for each photo.
#[test]
fn a_gimbal_arrives_before_the_shot() {
    let commands: Vec<String> = lines(&mission())
        .iter()
        .map(|line| line[3].clone())
        .collect();
    let expected = [
        "16", "22", "178", "16", "115", "1000", "93", "2000", "16", "16", "115", "1000", "93",
        "2000", "20",
    ];
    assert_eq!(commands, expected);
    let plan: serde_json::Value =
        serde_json::from_slice(&file(&mission(), MissionFormat::QGroundControl)).unwrap();
    let items = plan["mission"]["items"].as_array().unwrap();
    let of_plan: Vec<String> = items
        .iter()
        .map(|item| item["command"].to_string())
        .collect();
    assert_eq!(of_plan, expected[1..]);
    // DJI: one sequence, in which the gimbal stands before the wait, and that before the photo.
    for name in ["wpmz/waylines.wpml", "wpmz/template.kml"] {
        let xml = unzipped(file(&mission(), MissionFormat::DjiWpml), name);
        let document = roxmltree::Document::parse(&xml).unwrap();
        let words: Vec<&str> = document
            .descendants()
            .filter(|node| {
                ["actionGroupMode", "actionTriggerType", "actionActuatorFunc"]
                    .contains(&node.tag_name().name())
            })
            .filter_map(|node| node.text())
            .collect();
        let photo = [
            "sequence",
            "reachPoint",
            "gimbalRotate",
            "hover",
            "takePhoto",
        ];
        assert_eq!(words, [photo, photo].concat());
    }
    let csv = text(&mission(), MissionFormat::Litchi);
    let first = csv.lines().nth(1).unwrap();
    // Tilt, wait for 3000 ms, photo, nothing.
    assert!(first.contains(",5,-62.7,0,3000,1,0,-1,0,"), "{first}");
}

/// Copter turns by CONDITION_YAW (115), absolute and the short way.
#[test]
fn copter_turns_by_a_command() {
    let lines = lines(&mission());
    assert_eq!(
        lines[4][2..12],
        ["2", "115", "37.4", "0", "0", "0", "0", "0", "0", "1"]
    );
    // ArduPilot keeps whole degrees (int8_t), and would cut -62.7 to -62.
    assert_eq!(lines[5][3..9], ["1000", "-63", "0", "0", "0", "12"]);
    let rounded = "keeps the gimbal's pitch in whole degrees";
    assert!(notes(&mission(), MissionFormat::Waypoints).contains(rounded));
    let mut straight = mission();
    straight.stops[0].gimbal_pitch = Some(-63.0);
    assert!(!notes(&straight, MissionFormat::QGroundControl).contains(rounded));
    assert_eq!(lines[11][3..5], ["1000", "-90"]);
    assert_eq!(lines[7][3..7], ["2000", "0", "0", "1"]);
    assert!(notes(&mission(), MissionFormat::Waypoints).contains("PX4 does not take"));
    // A wait in which Copter cannot turn half around is said.
    let mut hasty = mission();
    hasty.stops[0].settle = 2.9;
    assert!(notes(&hasty, MissionFormat::Waypoints).contains("ArduPilot waits for no gimbal"));
    assert!(!notes(&mission(), MissionFormat::Waypoints).contains("waits for no gimbal"));
}

/// ArduPilot's `AP_Mission::sanity_check_params` takes NaN for the yaw of commands with a place alone and refuses the
/// mission for any other; Mission Planner's reader passes over the line. So there is none, in either file.
#[test]
fn no_parameter_is_left_to_the_drone() {
    let mut bare = mission();
    bare.stops[0].heading = None;
    for line in lines(&bare) {
        assert!(
            line[4..11]
                .iter()
                .all(|number| number.parse::<f64>().unwrap().is_finite()),
            "{line:?}"
        );
    }
    let plan: serde_json::Value =
        serde_json::from_slice(&file(&bare, MissionFormat::QGroundControl)).unwrap();
    for item in plan["mission"]["items"].as_array().unwrap() {
        let parameters = item["params"].as_array().unwrap();
        assert!(
            parameters.iter().all(serde_json::Value::is_number),
            "{item}"
        );
    }
}

/// Home is line 0, is counted, and is where the drone takes off and not the first stop.
#[test]
fn heights_count_from_the_take_off() {
    let lines = lines(&mission());
    let indices: Vec<usize> = lines.iter().map(|line| line[0].parse().unwrap()).collect();
    assert_eq!(indices, (0..15).collect::<Vec<_>>());
    // The last parameter of home says who wrote it (files::marks).
    assert_eq!(
        lines[0][1..],
        ["1", "0", "16", "0", "0", "0", "-0", "50", "7", "160", "1"]
    );
    assert_eq!(
        lines[1][2..],
        ["3", "22", "0", "0", "0", "0", "50", "7", "20", "1"]
    );
    // Frame 3, latitude, longitude, metres above home: below it, too.
    assert_eq!(
        lines[3][2..],
        [
            "3", "16", "0", "0", "0", "37.4", "50.0001", "7.0001", "12.34", "1"
        ]
    );
    assert_eq!(lines[9][8..11], ["50.0002", "7.0001", "-13.9"]);
    let waylines = unzipped(
        file(&mission(), MissionFormat::DjiWpml),
        "wpmz/waylines.wpml",
    );
    assert!(waylines.contains("<wpml:executeHeightMode>relativeToStartPoint</"));
    assert!(waylines.contains("<wpml:executeHeight>-13.9</"));
    assert!(waylines.contains("<wpml:takeOffSecurityHeight>20</"));
    // Home over all that stands there, also where the radio is lost.
    assert!(waylines.contains("<wpml:globalRTHHeight>33</"));
    // Latitude first, and above the ellipsoid, which is 31.628 m above the geoid here (NGA's test of EGM96).
    let mut far = mission();
    if let Some(take_off) = &mut far.take_off {
        (take_off.latitude, take_off.longitude) = (38.628_155, -90.220_845);
    }
    let template = unzipped(file(&far, MissionFormat::DjiWpml), "wpmz/template.kml");
    let point = template.split("takeOffRefPoint>").nth(1).unwrap();
    let numbers: Vec<&str> = point.trim_end_matches("</wpml:").split(',').collect();
    assert_eq!(numbers[..2], ["38.628155", "-90.220845"]);
    let elevation: f64 = numbers[2].parse().unwrap();
    assert!((elevation - 128.372).abs() < 2e-3, "{point}");
}

/// What the drone does where the radio is lost is in DJI's words (Cloud API, "waylines.wpml": `exitOnRCLost`,
/// `executeRCLostAction`), and of files that cannot say it the pilot is told.
#[test]
fn a_lost_radio_does_what_was_asked_for() {
    for (lost, exit, action) in [
        (LostSignal::ReturnHome, "executeLostAction", "goBack"),
        (LostSignal::Hover, "executeLostAction", "hover"),
        (LostSignal::Land, "executeLostAction", "landing"),
        (LostSignal::GoOn, "goContinue", "goBack"),
    ] {
        let mut asked = mission();
        asked.lost_signal = Some(lost);
        for name in ["wpmz/waylines.wpml", "wpmz/template.kml"] {
            let xml = unzipped(file(&asked, MissionFormat::DjiWpml), name);
            assert!(
                xml.contains(&format!("<wpml:exitOnRCLost>{exit}</")),
                "{xml}"
            );
            assert!(xml.contains(&format!("<wpml:executeRCLostAction>{action}</")));
        }
        let unsaid = "does not say what the drone does where the radio is lost";
        assert!(notes(&asked, MissionFormat::Litchi).contains(unsaid));
        assert!(!notes(&asked, MissionFormat::GeoJson).contains(unsaid));
    }
    // Of missions that do not say it: not straight over a fence.
    let mut silent = mission();
    silent.lost_signal = None;
    assert!(text_of_dji(&silent).contains("executeRCLostAction>hover<"));
    assert!(
        notes(&silent, MissionFormat::DjiWpml)
            .contains("where the radio is lost: in DJI's file it hovers")
    );
    silent.fences.clear();
    assert!(text_of_dji(&silent).contains("executeRCLostAction>goBack<"));
}

/// DJI's docks take 8 m and more; a lower height to climb to is raised, and said.
#[test]
fn a_dock_climbs_at_least_eight_metres() {
    let mut docked = mission();
    docked.safe_height = Some(6.5);
    assert!(text_of_dji(&docked).contains("takeOffSecurityHeight>6.5<"));
    docked.drone = Some(DroneCodes {
        drone: 91,
        ..mavic_3e()
    });
    assert!(text_of_dji(&docked).contains("takeOffSecurityHeight>8<"));
    assert!(notes(&docked, MissionFormat::DjiWpml).contains("climbs to 8 m first at least"));
}

fn text_of_dji(mission: &Mission) -> String {
    unzipped(file(mission, MissionFormat::DjiWpml), "wpmz/waylines.wpml")
}

#[test]
fn latitude_and_longitude_stand_as_each_format_has_them() {
    let mission = mission();
    let kmz = file(&mission, MissionFormat::DjiWpml);
    for name in ["wpmz/waylines.wpml", "wpmz/template.kml"] {
        assert!(unzipped(kmz.clone(), name).contains("<coordinates>7.0001,50.0001</coordinates>"));
    }
    assert!(
        text(&mission, MissionFormat::Litchi)
            .lines()
            .nth(1)
            .unwrap()
            .starts_with("50.0001,7.0001,12.34,")
    );
    assert!(text(&mission, MissionFormat::GeoJson).contains("\"coordinates\":[7.0001,50.0001]"));
    assert!(text(&mission, MissionFormat::Kml).contains("<coordinates>7.0001,50.0001,"));
    let plan: serde_json::Value =
        serde_json::from_slice(&file(&mission, MissionFormat::QGroundControl)).unwrap();
    assert_eq!(
        plan["mission"]["plannedHomePosition"],
        serde_json::json!([50.0, 7.0, 160.0])
    );
    assert_eq!(
        plan["mission"]["items"][2]["params"],
        serde_json::json!([0.0, 0.0, 0.0, 37.4, 50.0001, 7.0001, 12.34])
    );
    assert_eq!(
        plan["geoFence"]["polygons"][0]["polygon"][0],
        serde_json::json!([50.001, 7.001])
    );
}

#[test]
fn a_plan_has_all_parts_and_no_carriage_return() {
    let text = text(&mission(), MissionFormat::QGroundControl);
    assert!(!text.contains('\r'));
    let mut bare = mission();
    bare.fences.clear();
    let plan: serde_json::Value =
        serde_json::from_slice(&file(&bare, MissionFormat::QGroundControl)).unwrap();
    assert_eq!(
        plan["geoFence"],
        serde_json::json!({"version": 2, "circles": [], "polygons": []})
    );
    assert_eq!(
        plan["rallyPoints"],
        serde_json::json!({"version": 2, "points": []})
    );
    assert_eq!(plan["version"], 1);
    assert_eq!(plan["mission"]["version"], 2);
    let ids: Vec<i64> = plan["mission"]["items"]
        .as_array()
        .unwrap()
        .iter()
        .map(|item| item["doJumpId"].as_i64().unwrap())
        .collect();
    assert_eq!(ids, (1..=14).collect::<Vec<_>>());
    let place = &plan["mission"]["items"][2];
    assert_eq!(
        (place["Altitude"].as_f64(), place["AltitudeMode"].as_i64()),
        (Some(12.34), Some(1))
    );
    assert!(place["AMSLAltAboveTerrain"].is_null() && place.get("AMSLAltAboveTerrain").is_some());
    assert!(plan["mission"]["items"][3].get("Altitude").is_none());
}

/// The same keys, in items of the same commands, as the reference that two consumers took.
#[test]
fn a_plan_is_built_as_the_reference() {
    let Some(path) = fragscale_test_data::shared_data("missions/ref.plan") else {
        return;
    };
    let reference: serde_json::Value =
        serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let ours: serde_json::Value =
        serde_json::from_slice(&file(&mission(), MissionFormat::QGroundControl)).unwrap();
    fn keys(value: &serde_json::Value) -> Vec<&String> {
        let mut keys: Vec<&String> = value.as_object().unwrap().keys().collect();
        keys.sort();
        keys
    }
    assert_eq!(keys(&ours), keys(&reference));
    for part in ["mission", "geoFence", "rallyPoints"] {
        assert_eq!(keys(&ours[part]), keys(&reference[part]));
    }
    for item in ours["mission"]["items"].as_array().unwrap() {
        let alike = reference["mission"]["items"]
            .as_array()
            .unwrap()
            .iter()
            .find(|other| other["command"] == item["command"]);
        if let Some(alike) = alike {
            assert_eq!(keys(item), keys(alike));
            assert_eq!(item["frame"], alike["frame"]);
        }
    }
}

#[test]
fn litchi_is_told_how_to_be_set() {
    let notes = notes(&mission(), MissionFormat::Litchi);
    assert!(notes.contains("set the heading mode to Custom"), "{notes}");
    assert!(notes.contains("set the finish action to RTH"), "{notes}");
    assert!(
        notes.contains("the fences are not in the file, for Litchi's CSV has no place"),
        "{notes}"
    );
    let mut high = mission();
    high.stops[2].height.metres = 501.0;
    let expected = "stop 3 is 501 m high, and Litchi flies from -200 to 500; take off nearer to it";
    assert_eq!(refused(&high, MissionFormat::Litchi), expected);
    let mut twice = mission();
    twice.stops[1] = twice.stops[0].clone();
    assert!(super::notes(&twice, MissionFormat::Litchi).contains("less than 0.6 m apart"));
}

#[test]
fn straight_down_stays_straight_down() {
    let mission = mission();
    let waylines = unzipped(file(&mission, MissionFormat::DjiWpml), "wpmz/waylines.wpml");
    assert!(waylines.contains("<wpml:gimbalPitchRotateAngle>-90</"));
    // From -180 to 180: 220 is -140.
    assert!(waylines.contains("<wpml:waypointHeadingAngle>-140</"));
    let csv = text(&mission, MissionFormat::Litchi);
    assert!(
        csv.lines()
            .nth(3)
            .unwrap()
            .starts_with("50.0002,7.0001,-13.9,220,0,0,2,-90,5,-90,")
    );
}

#[test]
fn heights_of_no_datum_are_refused() {
    let mut unknown = mission();
    unknown.stops[2].height.above = Above::Unknown;
    for format in MissionFormat::ALL {
        let expected = "the height of stop 3 is absolute, and nobody says above what; say whether it counts from the ellipsoid or from the geoid, up to 107 m apart: --datum of 'fragscale mission'";
        assert_eq!(refused(&unknown, format), expected);
    }
    let mut take_off = mission();
    if let Some(elevation) = take_off
        .take_off
        .as_mut()
        .and_then(|at| at.elevation.as_mut())
    {
        elevation.above = Above::Unknown;
    }
    assert!(
        refused(&take_off, MissionFormat::Kml)
            .starts_with("the elevation of the take-off is absolute")
    );
    // An absolute height needs the take-off's elevation where the target counts from there.
    let mut absolute = mission();
    absolute.take_off = None;
    absolute
        .stops
        .iter_mut()
        .for_each(|stop| stop.height.above = Above::Ellipsoid);
    let fault = refused(&absolute, MissionFormat::Litchi);
    assert!(fault.starts_with("the height of stop 1 counts from the ellipsoid WGS 84, and the target's from the place of take-off; give the elevation"), "{fault}");
    assert_eq!(
        mission_files(&absolute, MissionFormat::DjiWpml)
            .unwrap()
            .files
            .len(),
        1
    );
    let ground = |stop: &mut Stop| stop.height.above = Above::Ground;
    absolute.stops.iter_mut().for_each(ground);
    assert!(
        refused(&absolute, MissionFormat::DjiWpml)
            .contains("plan heights above the place of take-off")
    );
}

/// At 38.628155 N 90.220845 W the geoid lies 31.628 m below the ellipsoid (NGA's test of EGM96).
#[test]
fn each_file_has_the_datum_of_its_format() {
    let mut absolute = mission();
    for stop in &mut absolute.stops {
        (stop.latitude, stop.longitude) = (38.628_155, -90.220_845);
        stop.height = Height {
            metres: 100.0,
            above: Above::Ellipsoid,
        };
    }
    let kmz = file(&absolute, MissionFormat::DjiWpml);
    let waylines = unzipped(kmz.clone(), "wpmz/waylines.wpml");
    assert!(
        waylines.contains("<wpml:executeHeightMode>WGS84</")
            && waylines.contains("<wpml:executeHeight>100</")
    );
    let template = unzipped(kmz, "wpmz/template.kml");
    assert!(
        template.contains("<wpml:heightMode>EGM96</")
            && template.contains("<wpml:ellipsoidHeight>100</")
    );
    let number = |text: &str, before: &str| -> f64 {
        let rest = text.split(before).nth(1).unwrap();
        rest.split('<').next().unwrap().parse().unwrap()
    };
    assert!((number(&template, "<wpml:height>") - 131.628).abs() < 2e-3);
    // Mean sea level, frame 0.
    let lines = lines(&absolute);
    assert_eq!(lines[3][2..4], ["0", "16"]);
    assert!((lines[3][10].parse::<f64>().unwrap() - 131.628).abs() < 2e-3);
}

#[test]
fn what_dji_asks_for_is_asked_for() {
    let mut mission = mission();
    mission.drone = None;
    assert!(refused(&mission, MissionFormat::DjiWpml).starts_with("DJI's files need the drone"));
    mission.drone = Some(mavic_3e());
    mission.speed = None;
    assert!(refused(&mission, MissionFormat::DjiWpml).starts_with("DJI's files need a speed"));
    mission.speed = Some(20.0);
    mission.safe_height = Some(1.0);
    assert!(refused(&mission, MissionFormat::DjiWpml).contains("from 1.2 to 1500 m"));
    mission.safe_height = Some(30.0);
    let waylines = unzipped(file(&mission, MissionFormat::DjiWpml), "wpmz/waylines.wpml");
    assert!(
        waylines.contains("<wpml:autoFlightSpeed>20</")
            && waylines.contains("<wpml:globalTransitionalSpeed>15</")
    );
    assert!(!notes(&mission, MissionFormat::DjiWpml).contains("DJI's tables"));
    mission.drone = Some(DroneCodes {
        drone: 68,
        drone_sub: 0,
        payload: None,
    });
    assert!(notes(&mission, MissionFormat::DjiWpml).contains("drone 68/0 is not in DJI's tables"));
    if let Some(photo) = &mut mission.stops[0].photo {
        photo.name = Some("a/b <1>".to_owned());
    }
    assert!(notes(&mission, MissionFormat::DjiWpml).contains("are written as _"));
    let waylines = unzipped(file(&mission, MissionFormat::DjiWpml), "wpmz/waylines.wpml");
    assert!(waylines.contains("<wpml:fileSuffix>a_b__1_</"));
    let mut swapped = mavic_3e();
    swapped.drone_sub = 1;
    mission.drone = Some(swapped);
    assert!(notes(&mission, MissionFormat::DjiWpml).contains("camera 66 is not one of drone 77/1"));
}

#[test]
fn a_mission_without_stops_is_refused() {
    let mut empty = mission();
    empty.stops.clear();
    for format in MissionFormat::ALL {
        assert_eq!(
            refused(&empty, format),
            "the mission has no stops; give a mission that has waypoints"
        );
    }
}

/// Each ground station is told, or the pilot, from which height the drone comes straight home: whole metres as on the pilot's sheet.
#[test]
fn the_height_to_come_home_at_is_told() {
    let home = |return_height, safe_height| {
        let mission = Mission {
            return_height,
            safe_height: Some(safe_height),
            ..mission()
        };
        let waylines = unzipped(file(&mission, MissionFormat::DjiWpml), "wpmz/waylines.wpml");
        let (_, behind) = waylines.split_once("<wpml:globalRTHHeight>").unwrap();
        behind.split('<').next().unwrap().to_owned()
    };
    assert_eq!(home(Some(22.1), 20.0), "23");
    // Not a metre more for a rounding error; never below what is climbed to first.
    assert_eq!(home(Some(33.0 + 1e-12), 20.0), "33");
    assert_eq!(home(Some(12.0), 20.5), "21");
    // Nobody says it: the height to climb to is there, and that is said.
    assert_eq!(home(None, 20.5), "20.5");
    let unsaid = Mission {
        return_height: None,
        ..mission()
    };
    assert!(notes(&unsaid, MissionFormat::DjiWpml).contains("nobody says from which height"));
    assert!(!notes(&mission(), MissionFormat::DjiWpml).contains("nobody says from which height"));
    for format in [MissionFormat::Waypoints, MissionFormat::QGroundControl] {
        assert!(
            notes(&mission(), format)
                .contains("RTL_ALT to 3300 or more (centimetres; RTL_ALT_M 33 in newer versions)")
        );
    }
    assert!(
        notes(&mission(), MissionFormat::Litchi).contains("return-to-home height to 33 m or more")
    );
    assert!(!notes(&unsaid, MissionFormat::Litchi).contains("return-to-home"));
}
