//! A model in a frame of its own, brought to the world by positions, points and distances.

mod distances;
mod packages;

use std::fmt::Write as _;
use std::fs;

use glam::{DMat3, EulerRot};

use super::*;
use crate::camera::{Camera, Distortion, Pose};
use crate::flight::FlightFile;
use crate::formats::{MeasuredPosition, PosedPhoto, Sizes};
use crate::geodesy::Crs;
use crate::geometry::Similarity;
use crate::units::LengthUnit;
use fragscale_test_data::shared_data;

/// From the reconstruction's frame, whose z is nowhere near up, to UTM.
fn truth() -> Similarity {
    let rotation = DMat3::from_euler(EulerRot::ZYX, 1.1, 2.2, -0.7);
    Similarity::new(7.5, rotation, DVec3::new(435_250.5, 6_201_333.25, 412.0))
}

/// A camera over the middle of the flight that looks along `down` in the frame of the reconstruction.
fn photo(index: u32, center_in_world: DVec3) -> PosedPhoto {
    let truth = truth();
    let back = truth.rotation.transpose();
    let down = DMat3::from_cols(DVec3::X, -DVec3::Y, -DVec3::Z);
    let tilt = DMat3::from_rotation_x(0.1 * f64::from(index % 5) - 0.2);
    PosedPhoto {
        name: format!("flight/IMG_{index:04}.JPG"),
        camera: 0,
        pose: Pose {
            rotation: back * down * tilt,
            center: back * (center_in_world - truth.translation) / truth.scale,
        },
    }
}

fn centers() -> Vec<DVec3> {
    (0..12_u32)
        .map(|i| {
            let (column, row) = (f64::from(i % 4), f64::from(i / 4));
            let rough = f64::from(i * 7 % 5) * 0.6;
            DVec3::new(
                435_200.0 + 12.0 * column,
                6_201_300.0 + 15.0 * row,
                460.0 + rough,
            )
        })
        .collect()
}

fn reconstruction() -> Reconstruction {
    let camera = Camera {
        name: "1".to_owned(),
        width: 4000,
        height: 3000,
        fx: 3000.0,
        fy: 3000.0,
        cx: 2000.0,
        cy: 1500.0,
        skew: 0.0,
        distortion: Distortion::None,
    };
    Reconstruction {
        package: "test",
        cameras: vec![camera],
        photos: (0..)
            .zip(centers())
            .map(|(index, center)| photo(index, center))
            .collect(),
        sizes: Sizes::Known,
        ..Reconstruction::default()
    }
}

fn run(request: &GeoreferenceRequest) -> Result<Georeferenced, FileError> {
    georeference_model(Path::new("model"), &reconstruction(), request)
}

/// A file that is gone with the folder.
struct List(tempfile::TempDir);

impl List {
    fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("list.txt"), text).unwrap();
        Self(folder)
    }

    fn path(&self) -> PathBuf {
        self.0.path().join("list.txt")
    }
}

fn assert_is_truth(found: &Similarity, tolerance: f64) {
    let truth = truth();
    assert!(
        (found.scale / truth.scale - 1.0).abs() < tolerance,
        "{}",
        found.scale
    );
    for point in [DVec3::ZERO, DVec3::new(3.0, -4.0, 5.0)] {
        let off = found.apply(point).distance(truth.apply(point));
        assert!(off < 100.0 * tolerance, "{off}");
    }
}

/// UTM 32N positions as they are: the similarity comes out, and the world is the list's.
#[test]
fn projected_positions() {
    let mut text = "EPSG:32632\n".to_owned();
    for (i, c) in centers().iter().enumerate() {
        writeln!(text, "img_{i:04}.jpg {} {} {}", c.x, c.y, c.z).unwrap();
    }
    let list = List::new(&text);
    let found = run(&GeoreferenceRequest {
        positions: Some(list.path()),
        ..GeoreferenceRequest::default()
    })
    .unwrap();
    assert_is_truth(&found.similarity, 1e-8);
    assert_eq!(found.crs.as_deref(), Some("EPSG:32632"));
    assert_eq!((found.used(), found.unit), (12, LengthUnit::Metre));
    assert_eq!(found.heights.as_deref(), Some("not said"));
    assert_eq!(found.warnings, Vec::<String>::new());
    // What the list lacks has a name.
    let last = text.trim_end().rfind('\n').unwrap();
    let list = List::new(&text[..=last]);
    let found = run(&GeoreferenceRequest {
        positions: Some(list.path()),
        ..GeoreferenceRequest::default()
    });
    let said = found.unwrap().warnings.join("; ");
    assert!(
        said.contains("11 of 12 photos have a known position; without: "),
        "{said}"
    );
    assert!(said.contains("0011.JPG"), "{said}");
}

/// Longitudes and latitudes of the receivers lead to their zone of UTM; and one that is a street off
/// is left out.
#[test]
fn receivers_in_degrees() {
    let utm = Crs::understand("EPSG:32632").unwrap();
    let mut reconstruction = reconstruction();
    for (index, (photo, center)) in reconstruction.photos.iter().zip(centers()).enumerate() {
        let mut place = utm.to_geographic(center).unwrap();
        if index == 4 {
            place.latitude += 0.001;
        }
        reconstruction
            .measured_positions
            .push(crate::formats::MeasuredPosition {
                photo: photo.name.clone(),
                position: place,
            });
    }
    let request = GeoreferenceRequest::default();
    let found = georeference_model(Path::new("model"), &reconstruction, &request).unwrap();
    assert_is_truth(&found.similarity, 1e-7);
    assert_eq!(found.crs.as_deref(), Some("EPSG:32632"));
    let out: Vec<&str> = found
        .positions
        .iter()
        .filter(|p| !p.used)
        .map(|p| p.name.as_str())
        .collect();
    assert_eq!(out, ["flight/IMG_0004.JPG"]);
    assert!(
        (found.positions[4].residual.y - 111.3).abs() < 1.0,
        "{:?}",
        found.positions[4]
    );
    assert!(
        found.warnings[0].ends_with("was left out of the fit: flight/IMG_0004.JPG"),
        "{:?}",
        found.warnings
    );
    // Another zone is another world, 3 degrees turned.
    let elsewhere = GeoreferenceRequest {
        crs: Some("EPSG:32631".to_owned()),
        ..request
    };
    let other = georeference_model(Path::new("model"), &reconstruction, &elsewhere).unwrap();
    assert_eq!(other.crs.as_deref(), Some("EPSG:32631"));
    let origin = utm.to_geographic(truth().apply(DVec3::ZERO)).unwrap();
    let there = Crs::understand("EPSG:32631")
        .unwrap()
        .from_geographic(origin)
        .unwrap();
    // So far outside its zone a grid is 0.26 % too long, which heights are not.
    let off = other.similarity.apply(DVec3::ZERO) - there;
    assert!(off.truncate().length() < 0.05 && off.z.abs() < 0.2, "{off}");
}

/// Marks of points whose places are known, as their photos show them.
fn marks(names: &[(&str, DVec3)], crs: &str) -> String {
    let reconstruction = reconstruction();
    let truth = truth();
    let mut text = format!("{crs}\n");
    for (name, world) in names {
        let point = truth.rotation.transpose() * (*world - truth.translation) / truth.scale;
        for photo in &reconstruction.photos {
            let camera = &reconstruction.cameras[0];
            let Some(pixel) = camera.pixel_as_shot(photo.pose.camera_from_world(point)) else {
                continue;
            };
            if camera.contains(pixel) {
                let (x, y, z) = (world.x, world.y, world.z);
                writeln!(
                    text,
                    "{x} {y} {z} {} {} {} {name}",
                    pixel.x,
                    pixel.y,
                    photo.name.rsplit('/').next().unwrap()
                )
                .unwrap();
            }
        }
    }
    text
}

const POINTS: [(&str, DVec3); 4] = [
    ("p1", DVec3::new(435_205.0, 6_201_303.0, 411.0)),
    ("p2", DVec3::new(435_233.0, 6_201_305.0, 413.5)),
    ("p3", DVec3::new(435_231.0, 6_201_328.0, 409.0)),
    ("p4", DVec3::new(435_207.0, 6_201_326.0, 412.0)),
];

#[test]
fn control_points() {
    let list = List::new(&marks(&POINTS, "EPSG:32632"));
    let request = GeoreferenceRequest {
        control_points: Some(list.path()),
        ..GeoreferenceRequest::default()
    };
    let found = run(&request).unwrap();
    // The list's pixels are centres of pixels or corners: at most half a pixel, 1 cm on the ground.
    assert_is_truth(&found.similarity, 1e-3);
    assert_eq!(found.used(), 4);
    for position in &found.positions {
        assert_eq!(position.kind, KnownKind::ControlPoint);
        assert!(position.marks_px.unwrap() < 0.1, "{position:?}");
    }
    // Two are too few.
    let list = List::new(&marks(&POINTS[..2], "EPSG:32632"));
    let request = GeoreferenceRequest {
        control_points: Some(list.path()),
        ..request
    };
    let error = run(&request).unwrap_err();
    assert_eq!(error.file, list.path());
    assert!(
        error.fault.what.contains("2 known positions are too few"),
        "{error}"
    );
    // But one distance between them is enough for a scale.
    let apart = POINTS[0].1.distance(POINTS[1].1);
    let request = GeoreferenceRequest {
        distances: vec![format!("p1 p2 {apart}").parse().unwrap()],
        ..request
    };
    let found = run(&request).unwrap();
    assert!((found.similarity.scale / 7.5 - 1.0).abs() < 1e-3);
    assert_eq!(found.similarity.rotation, DMat3::IDENTITY);
    // Its ends are marks, a pixel off at least.
    let error = found.scale_error.unwrap();
    assert!((1e-4..1e-2).contains(&error), "{error}");
    assert!((found.lengths[0].fitted - apart).abs() < 1e-9);
    let said = found.scale_error_in_words();
    assert!(
        said.ends_with("by its marks alone: nothing checks the distance"),
        "{said}"
    );
    let request = GeoreferenceRequest {
        distances: vec!["p1 p9 1".parse().unwrap()],
        ..request
    };
    assert!(run(&request).unwrap_err().fault.what.contains("'p9'"));
}

/// A list in the next zone of UTM fits as well: only the photos' own receivers tell that the world is another place.
#[test]
fn a_list_of_another_place_is_said() {
    let utm = Crs::understand("EPSG:32632").unwrap();
    let mut reconstruction = reconstruction();
    // As EPSG:32632 itself says it: 8.0 degrees east.
    reconstruction.measured_positions = (reconstruction.photos.iter().zip(centers()))
        .map(|(photo, center)| MeasuredPosition {
            photo: photo.name.clone(),
            position: utm.to_geographic(center).unwrap(),
        })
        .collect();
    let said = |crs: &str| {
        let list = List::new(&marks(&POINTS, crs));
        let request = GeoreferenceRequest {
            control_points: Some(list.path()),
            ..GeoreferenceRequest::default()
        };
        let found = georeference_model(Path::new("model"), &reconstruction, &request);
        found.unwrap().warnings.join("; ")
    };
    let right = said("EPSG:32632");
    assert!(!right.contains("receivers"), "{right}");
    // 6 degrees of longitude further, at 55.95 degrees north: 374 km of the parallel.
    let zone = said("EPSG:32633");
    assert!(
        zone.contains("come to lie 37") && zone.contains("km away from where their own receivers"),
        "{zone}"
    );
    // Without a system there is nothing to compare.
    let local = said("local");
    assert!(!local.contains("receivers"), "{local}");
}

/// Level points whose easting and northing are swapped fit as well turned over, all cameras under the ground.
#[test]
fn a_world_that_is_turned_over_is_said() {
    let level = POINTS.map(|(name, at)| (name, at.with_z(411.0)));
    let said = |text: &str| {
        let list = List::new(text);
        let request = GeoreferenceRequest {
            control_points: Some(list.path()),
            ..GeoreferenceRequest::default()
        };
        let found = run(&request).unwrap();
        assert_eq!(found.used(), 4);
        found.warnings.join("; ")
    };
    let right = marks(&level, "local");
    let swapped: Vec<String> = (right.lines())
        .map(|line| match line.split(' ').collect::<Vec<_>>()[..] {
            [x, y, ref rest @ ..] => format!("{y} {x} {}", rest.join(" ")),
            _ => line.to_owned(),
        })
        .collect();
    let turned = "easting and northing are swapped";
    assert!(!said(&right).contains(turned), "{}", said(&right));
    let swapped = said(&swapped.join("\n"));
    assert!(swapped.contains(turned), "{swapped}");
}

/// So do the photos' own positions: then all look at the sky.
#[test]
fn photos_that_look_at_the_sky_are_said() {
    let said = |place: fn(DVec3) -> [f64; 3]| {
        let lines = (0..).zip(centers()).map(|(i, center)| {
            let [x, y, z] = place(center.with_z(460.0));
            format!("img_{i:04}.jpg {x} {y} {z}\n")
        });
        let list = List::new(&format!("local\n{}", lines.collect::<String>()));
        let request = GeoreferenceRequest {
            positions: Some(list.path()),
            ..GeoreferenceRequest::default()
        };
        run(&request).unwrap().warnings.join("; ")
    };
    let turned = "all photos come to look at the sky";
    let right = said(|center| center.to_array());
    assert!(!right.contains(turned), "{right}");
    let swapped = said(|center| [center.y, center.x, center.z]);
    assert!(swapped.contains(turned), "{swapped}");
}

/// A photo that was zoomed stands nearer by the others than its receiver, sure to centimetres, says. One that is sure to metres may
/// be wrong by itself.
#[test]
fn sure_receivers_that_contradict_tell_of_other_lenses() {
    let said = |sure: f64| {
        let lines = (0..).zip(centers()).map(|(i, center)| {
            let up = if i == 3 { 40.0 * sure } else { 0.0 };
            let [x, y, z] = (center + DVec3::Z * up).to_array();
            format!("img_{i:04}.jpg {x} {y} {z} 0 0 0 {sure} {sure}\n")
        });
        let list = List::new(&format!("EPSG:32632\n{}", lines.collect::<String>()));
        let request = GeoreferenceRequest {
            positions: Some(list.path()),
            ..GeoreferenceRequest::default()
        };
        let found = run(&request).unwrap();
        assert_eq!(found.used(), 11);
        found.warnings.join("; ")
    };
    let (sure, unsure) = (said(0.02), said(2.0));
    assert!(
        sure.contains("say that they are sure (flight/IMG_0003.JPG)"),
        "{sure}"
    );
    assert!(!unsure.contains("that they are sure"), "{unsure}");
}

/// Receivers whose longitudes lack their minus place nothing: nobody has looked at their list.
#[test]
fn mirrored_receivers_place_nothing() {
    let utm = Crs::understand("EPSG:32632").unwrap();
    let placed = |east: f64| {
        let mut model = reconstruction();
        let photos = reconstruction().photos.into_iter().zip(centers());
        let measured = photos.map(|(photo, center)| MeasuredPosition {
            photo: photo.name,
            position: utm
                .to_geographic(
                    center
                        .with_x(435_000.0 + east * (center.x - 435_000.0))
                        .with_z(460.0),
                )
                .unwrap(),
        });
        model.measured_positions = measured.collect();
        georeference_model(Path::new("model"), &model, &GeoreferenceRequest::default())
    };
    assert!(placed(1.0).is_ok());
    let fault = placed(-1.0).unwrap_err().to_string();
    assert!(
        fault.contains("turn the pile over") && fault.contains("lack their minus"),
        "{fault}"
    );
}

/// Four points of which one is typed a metre off in height: a fit of seven numbers to twelve takes most of it up, and cannot tell
/// which. And marks in a photo that is not there are named.
#[test]
fn points_that_contradict_each_other() {
    let right = marks(&POINTS, "EPSG:32632");
    let warnings = |text: &str| {
        let list = List::new(text);
        let request = GeoreferenceRequest {
            control_points: Some(list.path()),
            ..GeoreferenceRequest::default()
        };
        run(&request).unwrap().warnings.join("; ")
    };
    let said = warnings(&right);
    assert!(
        !said.contains("were surveyed (RMS)") && !said.contains("left out"),
        "{said}"
    );
    let wrong = right.replace("6201305 413.5 ", "6201305 414.5 ");
    assert_ne!(wrong, right);
    let said = warnings(&wrong);
    assert!(
        said.contains("off from where they were surveyed (RMS)"),
        "{said}"
    );
    assert!(!said.contains("nearly on a line"), "{said}");
    let said = warnings(&format!("{right}435205 6201303 411 10 10 A99.jpg p1\n"));
    assert!(
        said.contains("does not have are left out: A99.jpg"),
        "{said}"
    );
}

/// Two points that have each other's coordinates are named, whether the fit is refused or made: four points are too few to
/// outvote two.
#[test]
fn exchanged_points_are_named() {
    let said = |text: &str| {
        let list = List::new(text);
        let found = run(&GeoreferenceRequest {
            control_points: Some(list.path()),
            ..GeoreferenceRequest::default()
        });
        found.map_or_else(|error| error.to_string(), |found| found.warnings.join("; "))
    };
    let [p1, p2, p3, p4] = ["6201303 411", "6201305 413.5", "6201328 409", "6201326 412"];
    let exchange = |text: &str, one: &str, other: &str| {
        let (x, y) = (text.replace(one, "ONE"), other);
        x.replace(y, one).replace("ONE", y)
    };
    let right = marks(&POINTS, "EPSG:32632");
    let three = marks(&POINTS[..3], "EPSG:32632");
    for list in [&right, &three] {
        let said = said(list);
        assert!(!said.contains("exchange"), "{said}");
    }
    let (a, b) = (format!("435205 {p1} "), format!("435233 {p2} "));
    let (c, d) = (format!("435231 {p3} "), format!("435207 {p4} "));
    for (list, one, other, names) in [
        (&right, &a, &b, "'p1' and 'p2'"),
        (&right, &c, &a, "'p1' and 'p3'"),
        (&right, &c, &d, "'p3' and 'p4'"),
        (&three, &b, &c, "'p2' and 'p3'"),
    ] {
        let wrong = exchange(list, one, other);
        assert_ne!(&wrong, list);
        let said = said(&wrong);
        assert!(said.contains("exchange") && said.contains(names), "{said}");
    }
}

#[test]
fn what_is_refused() {
    let sentence = |text: &str, crs: Option<&str>| {
        let list = List::new(text);
        let error = run(&GeoreferenceRequest {
            positions: Some(list.path()),
            crs: crs.map(str::to_owned),
            ..GeoreferenceRequest::default()
        })
        .unwrap_err();
        error.fault.to_string()
    };
    let nothing = run(&GeoreferenceRequest::default()).unwrap_err();
    assert!(
        nothing.to_string().starts_with("model: nothing is known"),
        "{nothing}"
    );
    let strangers = "EPSG:32632\na.jpg 1 2 3\nb.jpg 2 3 4\n";
    assert!(sentence(strangers, None).contains("none of its names"));
    let twice = "photo,x,y,z\nIMG_0001.JPG,1,2,3\nx/IMG_0001.JPG,1,2,3\n";
    assert!(sentence(twice, None).contains("has two positions"));
    let two = "EPSG:32632\nIMG_0001.JPG 1 2 3\nIMG_0002.JPG 2 3 4\n";
    assert!(sentence(two, None).contains("too few"));
    assert!(sentence(two, Some("EPSG:4326")).contains("no projected"));
    let mut all = "EPSG:32632\n".to_owned();
    for (i, c) in centers().iter().enumerate() {
        writeln!(all, "IMG_{i:04}.JPG {} {} {}", c.x, c.y, c.z).unwrap();
    }
    // At 55.95 degrees north.
    let mercator = sentence(&all, Some("EPSG:3857"));
    assert!(
        mercator.contains("a metre of EPSG:3857 is 0.5"),
        "{mercator}"
    );
    assert!(sentence(two, Some("somewhere")).contains("'somewhere'"));
    let line = "EPSG:32632\nIMG_0000.JPG 435200 6201300 460\nIMG_0001.JPG 435212 6201300 460.6\nIMG_0002.JPG 435224 6201300 461.2\nIMG_0003.JPG 435236 6201300 460.6\n";
    assert!(
        sentence(line, None).contains("on a line"),
        "{}",
        sentence(line, None)
    );
}

/// What is written as a flight.toml reads back to the bit and opens.
#[test]
fn the_flight_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("model.nvm");
    fs::write(&model, "NVM_V3\n").unwrap();
    let mut text = "EPSG:32632\n".to_owned();
    for (i, c) in centers().iter().enumerate() {
        writeln!(text, "IMG_{i:04}.JPG {} {} {}", c.x, c.y, c.z).unwrap();
    }
    let list = List::new(&text);
    let found = run(&GeoreferenceRequest {
        positions: Some(list.path()),
        ..GeoreferenceRequest::default()
    })
    .unwrap();
    let target = folder.path().join("flight.toml");
    let text = found.flight_text(&target, &model, None, None).unwrap();
    let file = FlightFile::parse(&text).unwrap();
    assert_eq!(file.crs(), Some("EPSG:32632"));
    let crate::flight::PhotoSource::Reconstruction(path, Some(numbers)) = file.photo_source()
    else {
        panic!("{text}");
    };
    assert_eq!(path, "model.nvm");
    assert_eq!(
        numbers.map(f64::to_bits),
        found.similarity.to_row_major().map(f64::to_bits)
    );
    // Rounding is all that is left of it.
    assert!(
        file.errors()
            .world_scale
            .is_some_and(|percent| percent < 1e-6)
    );
    let inside = found
        .flight_text(&target, folder.path(), None, None)
        .unwrap_err();
    assert!(inside.fault.what.contains("in its stead"));
}

#[test]
fn pixels_outside_the_photo_are_refused() {
    let text = "EPSG:32632\n435205 6201303 411 9000 10 IMG_0001.JPG p1\n435205 6201303 411 90 10 IMG_0002.JPG p1\n";
    let list = List::new(text);
    let request = GeoreferenceRequest {
        control_points: Some(list.path()),
        ..GeoreferenceRequest::default()
    };
    let error = run(&request).unwrap_err();
    assert!(error.fault.what.contains("lies outside photo"), "{error}");
}
