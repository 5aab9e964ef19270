//! DJI's files.

use std::io::Write;

use fragscale_core::plan::{Above, DroneCodes, Finish, PayloadCodes};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::*;

#[test]
fn pilot_2_for_a_mavic_3e() {
    let Some(file) = shared("wpml/dji_payload_sdk_waypoint_v3_test_file.kmz") else {
        return;
    };
    let mission = &file.mission;
    assert_eq!(mission.name, "dji_payload_sdk_waypoint_v3_test_file");
    let payload = PayloadCodes {
        payload: 66,
        payload_sub: 0,
        position: 0,
    };
    let drone = DroneCodes {
        drone: 77,
        drone_sub: 0,
        payload: Some(payload),
    };
    assert_eq!(mission.drone, Some(drone));
    assert_eq!(mission.take_off, None);
    assert_eq!(
        (mission.speed, mission.safe_height),
        (Some(5.0), Some(20.0))
    );
    assert_eq!(mission.finish, Finish::ReturnHome);
    assert_eq!(mission.stops.len(), 14);
    assert!(all_above(mission, Above::TakeOff));
    let first = (22.577_493_986_46, 113.943_123_779_504, 100.0);
    assert_eq!(place(&mission.stops[0]), first);
    let last = (22.577_543_668_376_8, 113.941_785_877_178, 100.0);
    assert_eq!(place(&mission.stops[13]), last);
    // A third one at waypoint 7 is shot every 10 m.
    assert_eq!(photos(mission), [0, 4]);
    assert!(said(
        &file,
        "photos by distance or time are no stops: not read (waypoint 7)"
    ));
    let name = |stop: usize| {
        mission.stops[stop]
            .photo
            .clone()
            .and_then(|photo| photo.name)
    };
    assert_eq!(name(4).as_deref(), Some("航点5"));
    // The gimbal is moved at stop 2, and at stop 4 behind its photo.
    let pitches: Vec<_> = (0..14)
        .filter(|i| mission.stops[*i].gimbal_pitch.is_some())
        .collect();
    assert_eq!(pitches, [2, 5]);
    assert!(mission.stops.iter().all(|stop| stop.heading.is_none()));
    assert!(
        said(&file, "video is not read (4 times, first at waypoint 1)"),
        "{:?}",
        file.notes
    );
    assert!(
        said(&file, "the action zoom is passed over (2 times"),
        "{:?}",
        file.notes
    );
}

/// Its template says the same of places and heights.
#[test]
fn a_template_alone_is_read() {
    let Some(kmz) = shared_data("missions/wpml/dji_payload_sdk_waypoint_v3_test_file.kmz") else {
        return;
    };
    let mut archive = zip::ZipArchive::new(std::fs::File::open(&kmz).unwrap()).unwrap();
    let mut text = String::new();
    let mut entry = archive.by_name("wpmz/template.kml").unwrap();
    std::io::Read::read_to_string(&mut entry, &mut text).unwrap();
    let (_folder, path) = written("template.kml", &text);
    let template = read_mission(&path).unwrap().mission;
    let waylines = read_mission(&kmz).unwrap().mission;
    assert_eq!(template.stops.len(), 14);
    for (a, b) in template.stops.iter().zip(&waylines.stops) {
        assert_eq!((place(a), a.height), (place(b), b.height));
    }
    assert_eq!(photos(&template), [0, 4]);
    assert_eq!(template.speed, Some(5.0));
    // Heights of their own, above the geoid; headings of their own.
    let own = text
        .replace("<wpml:useGlobalHeight>1", "<wpml:useGlobalHeight>0")
        .replace("<wpml:height>100", "<wpml:height>60.5")
        .replace(">relativeToStartPoint<", ">EGM96<");
    let (_folder, path) = written("template.kml", own);
    let stops = read_mission(&path).unwrap().mission.stops;
    assert!(stops.iter().all(|stop| stop.height.metres == 60.5));
    assert!(stops.iter().all(|stop| stop.height.above == Above::Geoid));
}

#[test]
fn a_folder_of_flighthub_for_a_matrice_4t() {
    let Some(file) = shared("wpml/matrice4") else {
        return;
    };
    let mission = &file.mission;
    assert_eq!(mission.name, "matrice4");
    let codes = mission.drone.unwrap();
    assert_eq!(
        (codes.drone, codes.drone_sub, codes.payload.unwrap().payload),
        (99, 1, 89)
    );
    assert_eq!(
        (mission.speed, mission.safe_height),
        (Some(15.0), Some(20.0))
    );
    // It stands in the template alone.
    let take_off = mission.take_off.unwrap();
    let place_of_it = (take_off.latitude, take_off.longitude);
    assert_eq!(place_of_it, (31.089_768, 104.391_869));
    let elevation = take_off.elevation.unwrap();
    assert_eq!(
        (elevation.metres, elevation.above),
        (423.438_678, Above::Ellipsoid)
    );
    let stops = &mission.stops;
    assert_eq!(stops.len(), 6);
    assert!(all_above(mission, Above::Ellipsoid));
    assert_eq!(
        place(&stops[0]),
        (31.089_917_013_199_5, 104.390_938_810_099, 487.0)
    );
    let fifth = (
        31.090_799_697_869_1,
        104.391_033_031_409,
        487.925_313_037_914,
    );
    assert_eq!(place(&stops[4]), fifth);
    let headings: Vec<_> = stops.iter().map(|stop| stop.heading).collect();
    let along = Some(57.0);
    assert_eq!(headings, [along, along, along, along, along, None]);
    // The gimbal goes to -45 before the first waypoint.
    assert_eq!(mission.gimbal_pitches(), [Some(-45.0); 6]);
    assert_eq!(photos(mission), [0; 0]);
    assert!(said(
        &file,
        "flown through are read as stops (4 times, first at waypoint 1)"
    ));
    assert!(said(
        &file,
        "actions on the way (betweenAdjacentPointsIncludeFirstPoint)"
    ));
}

#[test]
fn dji_fly_without_turns() {
    let Some(file) = shared("wpml/waygen") else {
        return;
    };
    let mission = &file.mission;
    let codes = mission.drone.unwrap();
    assert_eq!((codes.drone, codes.payload), (68, None));
    assert_eq!((mission.speed, mission.safe_height), (Some(2.4), None));
    assert_eq!(mission.stops.len(), 12);
    assert_eq!(photos(mission).len(), 12);
    let first = (34.987_628_098_859_49, -106.618_221_614_496_58, 50.0);
    assert_eq!(place(&mission.stops[0]), first);
    assert_eq!(mission.stops[0].heading, Some(270.0));
    assert_eq!(mission.stops[4].heading, Some(90.0));
    // Said once, it stays.
    assert_eq!(mission.stops[1].gimbal_pitch, None);
    assert_eq!(mission.gimbal_pitches(), [Some(-90.0); 12]);
    let name = mission.stops[11].photo.as_ref().unwrap().name.as_deref();
    assert_eq!(name, Some("point11"));
    // Its template has no waypoint.
    let template = shared("wpml/waygen/template.kml").unwrap();
    assert_eq!(template.mission.stops.len(), 0);
    assert!(said(&template, "it has no waypoint"));
}

#[test]
fn hovers_and_photos_by_time() {
    let Some(file) = shared("wpml/hover_waylines.wpml") else {
        return;
    };
    let mission = &file.mission;
    assert_eq!(mission.stops.len(), 33);
    assert_eq!(photos(mission), [2, 4]);
    let first = (
        7.798_316_218_444_109,
        98.321_873_138_665_13,
        86.867_979_017_004_03,
    );
    assert_eq!(place(&mission.stops[0]), first);
    // The gimbal looks to the north and down.
    assert_eq!(
        (mission.stops[0].heading, mission.stops[0].gimbal_pitch),
        (Some(0.0), Some(-90.0))
    );
    assert_eq!(
        (mission.stops[2].settle, mission.stops[3].settle),
        (2.0, 0.0)
    );
    assert_eq!(mission.speed, Some(8.9408));
    assert!(said(
        &file,
        "photos by distance or time are no stops: not read (waypoint 0)"
    ));
    assert!(said(&file, "speeds of their own"));
}

#[test]
fn a_template_of_an_area_is_refused() {
    let Some(path) = shared_data("missions/wpml/matrice4/template.kml") else {
        return;
    };
    let error = read_mission(&path).unwrap_err().to_string();
    let expected = "template.kml:32: a template of the kind 'targetdetection' has no waypoints; give the .kmz with its waylines.wpml";
    assert!(error.ends_with(expected), "{error}");
}

fn kmz(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut writer = ZipWriter::new(&mut bytes);
    for (name, content) in entries {
        writer
            .start_file(*name, SimpleFileOptions::default())
            .unwrap();
        writer.write_all(content).unwrap();
    }
    writer.finish().unwrap();
    bytes.into_inner()
}

#[test]
fn what_is_no_mission_of_dji_is_refused_in_a_line() {
    let none = refused("a.kmz", kmz(&[("doc.kml", b"<kml/>")]));
    assert!(
        none.starts_with("a.kmz: it holds neither waylines.wpml nor template.kml"),
        "{none}"
    );
    let kml = refused("a.kml", "<?xml version=\"1.0\"?><kml><Document/></kml>");
    assert!(
        kml.starts_with("a.kml: KML without DJI's missionConfig is no mission"),
        "{kml}"
    );
    let wayline = |mode: &str, height: &str| {
        format!(
            "<kml xmlns:wpml=\"http://www.dji.com/wpmz/1.0.6\"><Document><wpml:missionConfig/>\n<Folder>\
             <wpml:executeHeightMode>{mode}</wpml:executeHeightMode>\n<Placemark><Point><coordinates>7,50\
             </coordinates></Point><wpml:executeHeight>{height}</wpml:executeHeight></Placemark></Folder>\
             </Document></kml>"
        )
    };
    let unknown = refused("a.wpml", wayline("MSL", "3"));
    assert!(unknown.starts_with("a.wpml:2: heights count from 'MSL', which is not known"));
    let inside = refused(
        "a.kmz",
        kmz(&[("wpmz/waylines.wpml", wayline("WGS84", "x").as_bytes())]),
    );
    let expected = "a.kmz: its waylines.wpml, line 3: <executeHeight> holds 'x', not a number";
    assert!(inside.starts_with(expected), "{inside}");
    let high = refused("a.wpml", wayline("WGS84", "1e9"));
    assert!(
        high.starts_with("a.wpml: stop 1: 1000000000 m above"),
        "{high}"
    );
    let laughs = "<!DOCTYPE l [<!ENTITY l \"lol\">]><kml>&l;</kml>";
    assert!(refused("a.kml", laughs).contains("document type"));
}

/// A few hundred kB that inflate to more than any mission are not unpacked.
#[test]
fn a_zip_that_inflates_without_end_is_refused() {
    let bomb = vec![b' '; (crate::missions::LARGEST + 10) as usize];
    let fault = refused("a.kmz", kmz(&[("wpmz/waylines.wpml", &bomb)]));
    assert!(
        fault.starts_with("a.kmz: its waylines.wpml inflates to more than 64 MB"),
        "{fault}"
    );
}
