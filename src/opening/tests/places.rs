//! What the photos' own receivers say of the poses of all.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use fragscale_test_data::jpeg::{jpeg, packet};
use glam::DVec3;

use crate::flight::Doubt;
use crate::geodesy::Crs;
use crate::jobs::Progress;
use crate::{OpenOptions, Opened, open_flight};

/// Six photos, 30 m apart in two rows, straight down from 30 m.
fn centers() -> Vec<DVec3> {
    let place = |index: u32| DVec3::new(f64::from(index % 3), f64::from(index / 3), 0.0) * 30.0;
    (0..6)
        .map(|index| place(index) + DVec3::new(452_300.0, 5_411_800.0, 342.0))
        .collect()
}

/// The flight with these poses, in a world that `world` describes; its photos' receivers were at `places` in UTM.
fn flight(folder: &Path, world: &str, poses: &[DVec3], places: &[DVec3]) -> Opened {
    flight_by(folder, world, poses, places, "")
}

/// What a receiver says that has fixed its place.
const RTK: &str = r#"drone-dji:RtkFlag="50" drone-dji:RtkStdLon="0.012" drone-dji:RtkStdLat="0.011" drone-dji:RtkStdHgt="0.025" "#;

/// The same by a receiver that says this of itself.
fn flight_by(
    folder: &Path,
    world: &str,
    poses: &[DVec3],
    places: &[DVec3],
    receiver: &str,
) -> Opened {
    let crs = Crs::understand("EPSG:32632").unwrap();
    fs::create_dir_all(folder.join("photos")).unwrap();
    let mut text = "photo,x,y,z,omega,phi,kappa\n".to_owned();
    for (index, (pose, place)) in poses.iter().zip(places).enumerate() {
        writeln!(text, "{index}.jpg,{},{},{},0,0,0", pose.x, pose.y, pose.z).unwrap();
        let at = crs.to_geographic(*place).unwrap();
        let xmp = format!(
            r#"<rdf:Description {receiver}drone-dji:GpsLatitude="{:+.9}" drone-dji:GpsLongitude="{:+.9}" drone-dji:AbsoluteAltitude="{:+.3}"/>"#,
            at.latitude, at.longitude, at.height
        );
        let photo = jpeg((400, 300), &[], &[&packet(&xmp)]);
        fs::write(folder.join(format!("photos/{index}.jpg")), photo).unwrap();
    }
    fs::write(folder.join("poses.csv"), text).unwrap();
    let low = poses.iter().copied().reduce(DVec3::min).unwrap();
    let high = poses.iter().copied().reduce(DVec3::max).unwrap();
    let mut pile = String::new();
    for place in 0..441_u32 {
        let part = DVec3::new(f64::from(place % 21), f64::from(place / 21), 0.0) / 10.0 - 0.5;
        let point = low + (high - low) * part;
        writeln!(pile, "{} {} {}", point.x, point.y, low.z * 0.9).unwrap();
    }
    fs::write(folder.join("pile.xyz"), pile).unwrap();
    let text = format!(
        "format = 1\n[world]\n{world}\n[surface]\nfile = \"pile.xyz\"\n[photos]\nposes = \"poses.csv\"\nfolder = \"photos\"\n\
         [[camera]]\nwidth = 400\nheight = 300\nfx = 400\nfy = 400\ncx = 200\ncy = 150\n"
    );
    fs::write(folder.join("flight.toml"), text).unwrap();
    open_flight(folder, &OpenOptions::default(), &Progress::default()).unwrap()
}

/// The reason of this kind that each photo has.
fn reasons<'a>(opened: &'a Opened, kind: &str) -> Vec<Option<&'a Doubt>> {
    let evidence = opened.looked_up.evidence.iter();
    evidence
        .map(|found| found.doubts.iter().find(|doubt| doubt.kind() == kind))
        .collect()
}

/// A model of its own frame, turned and moved, whose unit is said: in metres it is right, in feet 0.3048 times as large.
#[test]
fn receivers_tell_the_length() {
    let folder = tempfile::tempdir().unwrap();
    let places = centers();
    let own: Vec<DVec3> = (places.iter())
        .map(|place| {
            let from = *place - places[0];
            DVec3::new(-from.y, from.x, from.z) + DVec3::new(7.0, 3.0, 30.0)
        })
        .collect();
    let of_unit = |unit: &str| flight(folder.path(), &format!("unit = \"{unit}\""), &own, &places);
    assert_eq!(reasons(&of_unit("m"), "other-length"), [None; 6]);
    let wrong = of_unit("ft");
    for reason in reasons(&wrong, "other-length") {
        let Some(Doubt::OtherLength { ratio, error }) = reason else {
            panic!("{reason:?}");
        };
        // UTM is 0.04 % shorter than the ground there.
        assert!(
            (ratio - 0.3048).abs() < 3e-4 && *error < 0.01,
            "{ratio} {error}"
        );
    }
    let said = wrong.all_warnings();
    let about = said
        .iter()
        .filter(|said| said.contains("0.305 times as far apart"));
    assert_eq!(about.count(), 1, "{said:?}");
    // As large as receivers err: they tell nothing.
    let near: Vec<DVec3> = (places.iter())
        .map(|place| places[0] + (*place - places[0]) * 0.05)
        .collect();
    let hover = flight(folder.path(), "unit = \"m\"", &near, &places[..]);
    assert!(reasons(&hover, "other-length").iter().all(Option::is_some));
    let hover = flight(folder.path(), "unit = \"m\"", &own, &near);
    assert_eq!(reasons(&hover, "other-length"), [None; 6]);
}

/// All photos are called as others: none fits its pose, in the right system.
#[test]
fn names_that_were_all_exchanged() {
    let folder = tempfile::tempdir().unwrap();
    let (world, poses) = ("unit = \"m\"\ncrs = \"EPSG:32632\"", centers());
    let right = flight(folder.path(), world, &poses, &poses);
    assert_eq!(reasons(&right, "other-place"), [None; 6]);
    // Of another datum, all by as much.
    let moved: Vec<DVec3> = (poses.iter())
        .map(|place| *place + DVec3::new(120.0, 80.0, 40.0))
        .collect();
    let moved = flight(folder.path(), world, &poses, &moved);
    assert_eq!(reasons(&moved, "other-place"), [None; 6]);
    let exchanged: Vec<DVec3> = [4, 0, 5, 1, 2, 3].map(|index| poses[index]).to_vec();
    let wrong = flight(folder.path(), world, &poses, &exchanged);
    for reason in reasons(&wrong, "other-place") {
        assert!(
            matches!(reason, Some(Doubt::OtherPlace { usual: None, distance }) if *distance > 20.0),
            "{reason:?}"
        );
    }
    let said = wrong.all_warnings();
    let about = said
        .iter()
        .filter(|said| said.contains("taken elsewhere than their poses stand"));
    assert_eq!(about.count(), 1, "{said:?}");
}

/// A receiver that knows its place to two centimetres tells a length to better than a hundredth, and two photos 9 m apart.
#[test]
fn sure_receivers_tell_more() {
    let folder = tempfile::tempdir().unwrap();
    let world = "unit = \"m\"\ncrs = \"EPSG:32632\"";
    let places: Vec<DVec3> = (centers().into_iter())
        .map(|place| centers()[0] + (place - centers()[0]) * 0.3)
        .collect();
    let of =
        |poses: &[DVec3], receiver: &str| flight_by(folder.path(), world, poses, &places, receiver);
    let longer = |factor: f64| -> Vec<DVec3> {
        let from = |place: &DVec3| places[0] + (*place - places[0]) * factor;
        places.iter().map(from).collect()
    };
    let has = |opened: &Opened, kind: &str| {
        reasons(opened, kind)
            .iter()
            .map(Option::is_some)
            .collect::<Vec<_>>()
    };
    let swapped: Vec<DVec3> = [1, 0, 2, 3, 4, 5].map(|index| places[index]).to_vec();
    for (receiver, is_told) in [(RTK, true), ("", false)] {
        let right = of(&longer(1.005), receiver);
        assert_eq!(has(&right, "other-length"), [false; 6]);
        assert_eq!(has(&right, "other-place"), [false; 6]);
        assert_eq!(
            has(&of(&longer(1.03), receiver), "other-length"),
            [is_told; 6]
        );
        let swapped = has(&of(&swapped, receiver), "other-place");
        assert_eq!(swapped, [is_told, is_told, false, false, false, false]);
    }
}
