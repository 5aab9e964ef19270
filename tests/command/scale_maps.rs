//! Scale maps and rectified photos of the bundled flight, as a user asks for them.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use crate::common::{error_of, scales_json, stdout_of};
use crate::own_frame;

fn sample() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample")
}

/// The mean of a photo's map is near the fitted scale of `scales`, in the unit asked for; a second run
/// writes over its own files, never over others' and what was read.
#[test]
fn a_map_agrees_with_the_scales() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (flight, tif, png) = (sample(), at("map.tif"), at("map.png"));
    let flight_text = flight.to_string_lossy().into_owned();
    let arguments = [
        "scale-map",
        &flight_text,
        "--photo",
        "IMG_0002.jpg",
        "--unit",
        "in",
        "-o",
        &tif,
        "-o",
        &png,
    ];
    for _ in 0..2 {
        assert_eq!(stdout_of(&arguments), "");
    }
    let bytes = fs::read(&tif).expect("a map");
    let mut decoder = tiff::decoder::Decoder::new(Cursor::new(&bytes)).expect("a TIFF");
    assert_eq!(decoder.dimensions().expect("a size"), (1280, 720));
    let mut map = tiff::decoder::DecodingResult::F32(Vec::new());
    decoder.read_image_to_buffer(&mut map).expect("a page");
    let tiff::decoder::DecodingResult::F32(map) = map else {
        panic!("no 32-bit floats");
    };
    let mean = map.iter().map(|v| f64::from(*v)).sum::<f64>() / (1280.0 * 720.0);
    let scales = scales_json(&flight, &["--unit", "in"]);
    let photo = &scales["photos"][1];
    assert_eq!(photo["photo"], "IMG_0002.jpg");
    let fitted = |edge: &str| photo["fitted"][edge].as_f64().expect("a fitted scale");
    let middle = (fitted("top") + fitted("bottom")) / 2.0;
    assert!((mean / middle - 1.0).abs() < 1e-3, "{mean} {middle}");
    let picture = image::open(&png).expect("a picture");
    assert!(picture.width() > 1280 && picture.height() == 720);

    fs::write(&tif, "notes").expect("a file of somebody");
    let error = error_of(&arguments);
    assert!(error.contains("--force"), "{error}");
    assert_eq!(fs::read(&tif).expect("it"), b"notes");
    let photo = flight.join("photos/IMG_0002.jpg");
    let error = error_of(&[
        "scale-map",
        &flight_text,
        "--photo",
        "IMG_0002.jpg",
        "-o",
        &photo.to_string_lossy(),
    ]);
    assert!(
        error.contains("ends in .tif") || error.contains(".tif or .png"),
        "{error}"
    );
}

/// Several by their names: into one folder, in the flight's order, each once.
#[test]
fn several_photos_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("maps");
    let flight = sample().to_string_lossy().into_owned();
    let two = ["--photo", "IMG_0003.jpg", "--photo", "IMG_0001.jpg"];
    let mut arguments = vec!["scale-map", flight.as_str()];
    arguments.extend(two.iter().chain(&["--photo", "IMG_0003.jpg"]));
    let to_text = to.to_string_lossy();
    arguments.extend(["-o", &to_text]);
    stdout_of(&arguments);
    let files = fs::read_dir(&to).expect("a folder");
    let mut files: Vec<String> = files
        .map(|file| file.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    files.sort();
    let both = ["IMG_0001", "IMG_0003"].map(|stem| ["png", "tif"].map(|of| (stem, of)));
    let both = both.as_flattened().iter();
    let expected: Vec<String> = both
        .map(|(stem, of)| format!("{stem}_scale.{of}"))
        .collect();
    assert_eq!(files, expected);
    arguments.extend(["-o", "second"]);
    let error = error_of(&arguments);
    assert!(
        error.contains("several photos go into one folder"),
        "{error}"
    );
    // One that is not there is an error also among others.
    let error = error_of(&[
        "rectify",
        &flight,
        "--photo",
        "IMG_0001.jpg",
        "--photo",
        "none.jpg",
        "--to",
        &to_text,
    ]);
    assert!(error.contains("none.jpg"), "{error}");
}

#[test]
fn what_cannot_be_mapped_is_said_in_a_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let flight = sample().to_string_lossy().into_owned();
    let (map, to) = (at("map.tif"), at("out"));
    for command in [
        vec!["scale-map", &flight, "--photo", "IMG_002.jpg", "-o", &map],
        vec!["rectify", &flight, "--photo", "IMG_002.jpg", "--to", &to],
    ] {
        let error = error_of(&command);
        assert!(
            error.contains("the nearest name is 'IMG_0002.jpg'"),
            "{error}"
        );
    }
    let tiny = [
        "rectify",
        &flight,
        "--photo",
        "IMG_0002.jpg",
        "--to",
        &to,
        "--pixel",
        "1e-6m",
    ];
    let error = error_of(&tiny);
    assert!(
        error.contains("more than 200 million") && error.contains("--pixel"),
        "{error}"
    );
    let twice = ["scale-map", &flight, "--all", "-o", &map, "-o", &to];
    assert!(error_of(&twice).contains("one folder"));
    // A model whose unit nobody states.
    let unknown = at("model");
    fs::create_dir(&unknown).expect("a folder");
    own_frame::model(Path::new(&unknown));
    for command in [
        vec!["scale-map", &unknown, "--all", "-o", &to],
        vec!["rectify", &unknown, "--all", "--to", &to],
    ] {
        let error = error_of(&command);
        assert!(
            error.contains("frame of its own, whose unit nobody states"),
            "{error}"
        );
    }
    assert!(!Path::new(&map).exists() && !Path::new(&to).exists());
}

/// Every photo gets its picture and its world file; the places of the pile's photos overlap on the map.
#[test]
fn all_photos_are_rectified_into_a_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("new/out");
    let flight = sample().to_string_lossy().into_owned();
    let to_text = to.to_string_lossy().into_owned();
    let arguments = [
        "rectify", &flight, "--all", "--to", &to_text, "--ortho", "--pixel", "2mm", "--format",
        "tiff",
    ];
    let said = stdout_of(&arguments);
    assert_eq!(said.lines().count(), 9, "{said}");
    assert!(said.contains("pixels of 0.2 cm"), "{said}");
    // Its own files, world files too, are replaced.
    stdout_of(&arguments);
    let mut corners = Vec::new();
    for number in 1..=9 {
        let picture = to.join(format!("IMG_000{number}_ortho.tif"));
        let bytes = fs::read(&picture).expect("a picture");
        let picture_of = image::load_from_memory(&bytes).expect("a TIFF").to_rgba8();
        let seen = picture_of.pixels().filter(|p| p[3] == 255).count();
        assert!(seen * 2 > picture_of.pixels().len(), "{number}: {seen}");
        let world = fs::read_to_string(picture.with_extension("tfw")).expect("a world file");
        let numbers: Vec<f64> = world
            .lines()
            .take(6)
            .map(|l| l.parse().expect("a number"))
            .collect();
        assert_eq!((numbers[0], numbers[3]), (0.002, -0.002));
        corners.push([numbers[4], numbers[5]]);
    }
    // The flight's photos are about 0.65 m apart to the east.
    assert!(corners[1][0] - corners[0][0] > 0.4, "{corners:?}");
    fs::write(to.join("IMG_0003_ortho.tfw"), "1\n0\n0\n-1\n0\n0\n").expect("of somebody");
    assert!(error_of(&arguments).contains("--force"));
}

/// An export with rectified photos has the very files of `rectify`, and knows them again.
#[test]
fn an_export_has_rectified_photos_by_choice() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let (flight, export, rectified) = (sample(), at("export"), at("rectified"));
    let flight = flight.to_string_lossy().into_owned();
    let arguments = ["export", &flight, "--to", &export, "--rectified", "fit"];
    let said = stdout_of(&arguments);
    assert!(said.contains("pictures of 9 made"), "{said}");
    stdout_of(&[
        "rectify",
        &flight,
        "--photo",
        "IMG_0004.jpg",
        "--to",
        &rectified,
    ]);
    for ending in ["png", "pgw"] {
        let of_export = folder
            .path()
            .join(format!("export/rectified/IMG_0004.{ending}"));
        let alone = folder
            .path()
            .join(format!("rectified/IMG_0004_rectified.{ending}"));
        assert!(fs::read(of_export).expect("exported") == fs::read(alone).expect("alone"));
    }
    let said = stdout_of(&arguments);
    assert!(said.contains("of 9 there already"), "{said}");
    // Seen otherwise they are other pictures; without them they go.
    let said = stdout_of(&["export", &flight, "--to", &export, "--rectified", "ortho"]);
    assert!(said.contains("pictures of 9 made"), "{said}");
    stdout_of(&["export", &flight, "--to", &export]);
    assert!(!folder.path().join("export/rectified/IMG_0004.png").exists());
}
