//! What is said of a flight's files is said of each of its photos, which is then not trusted.

use std::fs;
use std::path::Path;

use crate::flight::{Doubt, FlightSettings, Limits, Verdict};
use crate::jobs::Progress;
use crate::units::LengthUnit;
use crate::{HealthItem, OpenOptions, Opened, StatedOfFlight, flight_health, look_up, open_flight};

/// Three photos straight down from 20 over a plane of 60 in square; `pile` and `poses` are what their files
/// hold, `world` what stands below [world].
fn write(folder: &Path, world: &str, pile: &[u8], poses: &str) {
    let text = format!(
        "format = 1\n[world]\n{world}\n[surface]\nfile = \"pile.ply\"\n[photos]\nposes = \"poses.csv\"\n\
         [[camera]]\nwidth = 400\nheight = 300\nfx = 400\nfy = 400\ncx = 200\ncy = 150\n"
    );
    fs::write(folder.join("flight.toml"), text).unwrap();
    fs::write(folder.join("pile.ply"), pile).unwrap();
    fs::write(folder.join("poses.csv"), poses).unwrap();
}

fn opened(folder: &Path) -> Result<Opened, String> {
    let opened = open_flight(folder, &OpenOptions::default(), &Progress::default());
    opened.map_err(|error| error.to_string())
}

/// A plane of points 1 apart, of 32-bit or 64-bit floats.
fn plane(east: f64, north: f64, up: f64, is_double: bool) -> Vec<u8> {
    let kind = if is_double { "double" } else { "float" };
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex 3721\nproperty {kind} x\nproperty {kind} y\nproperty {kind} z\nend_header\n"
    );
    let mut bytes = header.into_bytes();
    for place in 0..3721_u32 {
        let point = [
            east + f64::from(place % 61),
            north + f64::from(place / 61),
            up,
        ];
        for value in point {
            match is_double {
                true => bytes.extend(value.to_le_bytes()),
                false => bytes.extend((value as f32).to_le_bytes()),
            }
        }
    }
    bytes
}

fn poses(east: f64, north: f64, up: f64, angles: &str) -> String {
    let photo = |name: char, at: f64| {
        format!(
            "{name}.jpg,{},{},{},{angles}\n",
            east + at,
            north + 30.0,
            up + 20.0
        )
    };
    format!(
        "photo,x,y,z,omega,phi,kappa\n{}{}{}",
        photo('a', 20.0),
        photo('b', 30.0),
        photo('c', 40.0)
    )
}

/// The reasons of each photo, but that nobody has seen its file.
fn reasons(opened: &Opened) -> Vec<Vec<Doubt>> {
    let review = opened.review(&Limits::default(), &Progress::default());
    let review = review.unwrap();
    let photos = review.photos();
    let of_photo = |doubts: &[Doubt]| {
        let mut doubts = doubts.to_vec();
        doubts.retain(|doubt| !matches!(doubt, Doubt::NoPhotoFolder { .. }));
        doubts
    };
    photos
        .map(|photo| {
            assert_ne!(photo.verdict, Verdict::Trust);
            of_photo(photo.doubts)
        })
        .collect()
}

#[test]
fn angles_that_look_like_radians() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let doubt = Doubt::SmallAngles {
        largest: 1.2346,
        photos: 3,
    };
    for (angles, expected) in [("0,0.01,1.2346", vec![doubt]), ("0,0.01,90", vec![])] {
        let poses = poses(0.0, 0.0, 0.0, angles);
        write(folder, "unit = \"m\"", &plane(0.0, 0.0, 0.0, true), &poses);
        let opened = opened(folder).unwrap();
        assert_eq!(reasons(&opened), vec![expected.clone(); 3]);
        let said = opened.all_warnings();
        let said = said
            .iter()
            .filter(|said| said.contains("look like radians"));
        assert_eq!(said.count(), expected.len());
        // So does the strip, which has nothing of poses that nothing speaks against.
        let review = opened.review(&Limits::default(), &Progress::default());
        let health = flight_health(&review.unwrap(), &StatedOfFlight::default());
        let poses = health.iter().find(|found| found.item == HealthItem::Poses);
        let short = poses.map(|found| found.short.as_str());
        assert_eq!(short, (!expected.is_empty()).then_some("3 of 3 photos"));
    }
}

/// At 5.4 million the last bit of a 32-bit float is half a unit: points are off by a quarter, of footprints 20
/// wide. `f32::EPSILON / 2` of the largest coordinate is the bound that is said (0.32).
#[test]
fn points_that_were_rounded() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (east, north) = (452_300.0, 5_411_800.0);
    let poses = poses(east, north, 312.0, "0,0,90");
    for is_double in [false, true] {
        let pile = plane(east, north, 312.0, is_double);
        write(folder, "unit = \"m\"", &pile, &poses);
        let reasons = reasons(&opened(folder).unwrap());
        let [first, ..] = &reasons[..] else {
            panic!("{reasons:?}");
        };
        match (is_double, &first[..]) {
            (
                false,
                [
                    Doubt::RoundedPoints {
                        rounding,
                        footprint,
                        unit: Some(LengthUnit::Metre),
                    },
                ],
            ) => {
                let bound = (north + 60.0) * 2_f64.powi(-24);
                assert!((rounding - bound).abs() < 0.01, "{rounding}");
                assert!((10.0..30.0).contains(footprint), "{footprint}");
            }
            (true, []) => {}
            other => panic!("{other:?}"),
        }
    }
}

/// Placed in a world in which they are three times as large, points are off by three times as much.
#[test]
fn rounding_goes_with_what_is_rounded() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (east, north) = (452_300.0, 5_411_800.0);
    let poses = poses(east, north, 312.0, "0,0,90");
    let pile = plane(east, north, 312.0, false);
    let rounding = |world: &str| {
        write(folder, world, &pile, &poses);
        opened(folder).unwrap().flight.parts().as_read.rounding
    };
    let bound = (north + 60.0) * 2_f64.powi(-24);
    let as_it_is = rounding("unit = \"m\"");
    assert!((as_it_is / bound - 1.0).abs() < 1e-6, "{as_it_is}");
    let placed = "unit = \"m\"\nplaced = { transform = [3,0,0,0, 0,3,0,0, 0,0,3,0, 0,0,0,1] }";
    assert!((rounding(placed) / as_it_is - 3.0).abs() < 1e-12);
}

/// What poses and cloud do not say themselves, flight.toml may say wrongly.
#[test]
fn a_unit_against_the_coordinate_system() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (east, north) = (452_300.0, 5_411_800.0);
    let world = "unit = \"ft\"\ncrs = \"EPSG:32632\"";
    let poses = poses(east, north, 312.0, "0,0,90");
    write(folder, world, &plane(east, north, 312.0, true), &poses);
    let opened = opened(folder).unwrap();
    let doubt = Doubt::UnitNotSystems {
        unit: LengthUnit::Foot,
        system: "EPSG:32632".to_owned(),
        counted: "m".to_owned(),
    };
    assert_eq!(reasons(&opened), vec![vec![doubt.clone()]; 3]);
    let said = opened.all_warnings();
    let about = said.iter().filter(|said| said.contains("counts in m"));
    assert_eq!(about.count(), 1, "{said:?}");
    // Set right while it is open, nothing is left of it.
    let settings = FlightSettings {
        unit: LengthUnit::Metre,
        ..opened.settings.clone()
    };
    let mended = opened.flight.with_settings(&settings).unwrap();
    let looked_up = look_up(&mended, &opened.photo_files);
    assert!(
        looked_up
            .evidence
            .iter()
            .all(|found| found.doubts.is_empty()),
        "{looked_up:?}"
    );
    let review = opened.review(&Limits::default(), &Progress::default());
    let stated = StatedOfFlight {
        crs: opened.crs.as_deref(),
        ..StatedOfFlight::default()
    };
    let health = flight_health(&review.unwrap(), &stated);
    let unit = health.iter().find(|found| found.item == HealthItem::Unit);
    assert_eq!(unit.unwrap().short, "ft, not m");
}

/// A mine's own grid is nowhere in UTM; control points bring it there, and only then its lengths are held against
/// the map.
#[test]
fn a_placed_flight_is_held_against_the_map_where_it_stands() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let far = -4_000_000.0;
    let poses = poses(far, far, 0.0, "0,0,90");
    let pile = plane(far, far, 0.0, true);
    let crs = "unit = \"m\"\ncrs = \"EPSG:32632\"";
    write(folder, crs, &pile, &poses);
    let error = opened(folder).unwrap_err();
    assert!(error.contains("a metre of EPSG:32632 is"), "{error}");
    let to = |east: f64, north: f64| {
        format!(
            "{crs}\nplaced = {{ transform = [1,0,0,{}, 0,1,0,{}, 0,0,1,300, 0,0,0,1] }}",
            east - far,
            north - far
        )
    };
    write(folder, &to(452_300.0, 5_411_800.0), &pile, &poses);
    let placed = opened(folder).unwrap();
    let about_lengths = |said: &String| said.contains("a metre of");
    assert!(!placed.all_warnings().iter().any(about_lengths));
    assert_eq!(placed.crs.as_deref(), Some("EPSG:32632"));
    // And where they bring it out of the map, that is said.
    write(folder, &to(5_000_000.0, 5_411_800.0), &pile, &poses);
    let error = opened(folder).unwrap_err();
    assert!(error.contains("a metre of EPSG:32632 is"), "{error}");
}

/// A header of 400 x 300 pixels, with the place where its receiver says that it was taken.
fn photo(place: Option<crate::geodesy::Geographic>) -> Vec<u8> {
    let xmp = place.map_or_else(String::new, |place| {
        format!(
            r#"<rdf:Description drone-dji:GpsLatitude="{:+.9}" drone-dji:GpsLongitude="{:+.9}"/>"#,
            place.latitude, place.longitude
        )
    });
    fragscale_test_data::jpeg::jpeg((400, 300), &[], &[&fragscale_test_data::jpeg::packet(&xmp)])
}

/// Its photos lie in `photos`.
fn name_photo_folder(folder: &Path) {
    let file = folder.join("flight.toml");
    let text = fs::read_to_string(&file).unwrap();
    let named = text.replace("[photos]\n", "[photos]\nfolder = \"photos\"\n");
    fs::write(&file, named).unwrap();
}

/// Of two cards one is missing and the other's photos lie in one folder: each file is found for two photos. Named with
/// its folder it is the one's, and the other has none.
#[test]
fn photos_of_one_name_share_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let poses = poses(0.0, 0.0, 0.0, "0,0,90")
        .replace("b.jpg", "d1/x.jpg")
        .replace("c.jpg", "d2/x.jpg");
    write(folder, "unit = \"m\"", &plane(0.0, 0.0, 0.0, true), &poses);
    name_photo_folder(folder);
    fs::create_dir_all(folder.join("photos/d2")).unwrap();
    for name in ["a.jpg", "x.jpg"] {
        fs::write(folder.join("photos").join(name), photo(None)).unwrap();
    }
    let shared = |opened: &Opened| -> Vec<bool> {
        let is_shared = |doubt: &Doubt| matches!(doubt, Doubt::SameFile { .. });
        let evidence = opened.looked_up.evidence.iter();
        evidence
            .map(|found| found.doubts.iter().any(is_shared))
            .collect()
    };
    let found = opened(folder).unwrap();
    assert_eq!(shared(&found), [false, true, true]);
    let said = found.all_warnings();
    let about = said
        .iter()
        .filter(|said| said.contains("its file is that of d2/x.jpg, too"));
    assert_eq!(about.count(), 1, "{said:?}");
    // The right one is there, too: nothing is shared.
    fs::write(folder.join("photos/d2/x.jpg"), photo(None)).unwrap();
    assert_eq!(shared(&opened(folder).unwrap()), [false; 3]);
}

/// Two of three photos have changed their names: their receivers were where the other's pose is, 20 m away. What all are off does not
/// count. Twenty feet are no more than a receiver errs by.
#[test]
fn receivers_that_were_elsewhere() {
    receivers_elsewhere("m", "EPSG:32632", [452_300.0, 5_411_800.0], true);
    receivers_elsewhere("us-ft", "EPSG:2231", [3_000_000.0, 1_300_000.0], false);
}

fn receivers_elsewhere(unit: &str, system: &str, [east, north]: [f64; 2], is_far: bool) {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let world = &format!("unit = \"{unit}\"\ncrs = \"{system}\"");
    let poses = poses(east, north, 312.0, "0,0,90");
    write(folder, world, &plane(east, north, 312.0, true), &poses);
    name_photo_folder(folder);
    fs::create_dir_all(folder.join("photos")).unwrap();
    let crs = crate::geodesy::Crs::understand(system).unwrap();
    for (at, is_swapped) in [([20.0, 30.0, 40.0], false), ([40.0, 30.0, 20.0], true)] {
        for (name, at) in ["a.jpg", "b.jpg", "c.jpg"].into_iter().zip(at) {
            // All of them 3 m off, and each by another metre.
            let place = glam::DVec3::new(east + at + 3.0 + 0.01 * at, north + 31.0, 332.0);
            fs::write(
                folder.join("photos").join(name),
                photo(crs.to_geographic(place)),
            )
            .unwrap();
        }
        let is_said = is_swapped && is_far;
        let found = opened(folder).unwrap();
        let of_photo = found.looked_up.evidence.iter().map(|found| {
            let of_place = found.doubts.iter().find_map(|doubt| match doubt {
                Doubt::OtherPlace {
                    distance,
                    usual: Some(usual),
                } => Some([*distance, *usual]),
                _ => None,
            });
            of_place.is_some_and(|[distance, usual]| (distance - 20.0).abs() < 1.0 && usual < 1.0)
        });
        let of_photo: Vec<bool> = of_photo.collect();
        assert_eq!(of_photo, [is_said, false, is_said]);
        let said = found.all_warnings();
        let about = said
            .iter()
            .filter(|said| said.contains("from where its pose stands"));
        assert_eq!(about.count(), usize::from(is_said), "{said:?}");
    }
}
