use std::fs;

use glam::DMat3;
use proptest::prelude::*;

use super::*;
use fragscale_test_data::shared_data;

/// Two registered cameras and one that is not. The first looks straight down from (1, 2, 10) with
/// its top to north, which is the identity in these axes; the second is turned half about its view.
const SMALL: &str = "# Bundle file v0.3\n3 1\n\
    100 0.1 0.01\n1 0 0\n0 1 0\n0 0 1\n-1 -2 -10\n\
    0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n\
    200 0 0\n-1 0 0\n0 -1 0\n0 0 1\n0 0 -10\n\
    2 2 0\n10 20 255\n2 0 7 10.1010 0 2 9 -41 -39.0\n";

fn bundle_in(dir: &Path, text: &str) -> Result<Project, FileError> {
    let path = dir.join("bundle.out");
    fs::write(&path, text).unwrap();
    read_file(&path)
}

#[test]
fn poses_points_and_measurements_of_a_small_file() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("list.txt"), "a.jpg\nb.jpg\nc.jpg 0 190\n").unwrap();
    let project = bundle_in(dir.path(), SMALL).unwrap();
    assert_eq!(project.photos, Some(dir.path().to_owned()));
    let mut found = project.reconstruction;
    let [a, c] = &found.photos[..] else {
        panic!("two photos")
    };
    assert_eq!((a.name.as_str(), c.name.as_str()), ("a.jpg", "c.jpg"));
    assert_eq!(a.pose.center, DVec3::new(1.0, 2.0, 10.0));
    let nadir = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z);
    assert_eq!(a.pose.rotation, nadir);
    assert_eq!(c.pose.center, DVec3::new(0.0, 0.0, 10.0));
    assert_eq!(
        c.pose.rotation,
        DMat3::from_cols(DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z)
    );
    assert_eq!(found.cloud.colors, [[10, 20, 255]]);
    assert_eq!(
        found.warnings,
        ["1 of 3 photos were not registered and are left out"]
    );
    // a sees the point 1 east of its axis at depth 10: p = (0.1, 0), 100 * 0.1 * (1 + 0.001 + 1e-6).
    // c sees it 2 east and 2 north, turned by half: (-40, -40) where (-41, -39) was measured.
    let expected = (10.10100_f64 - 10.01001).abs();
    let median = found.median_reprojection_px().unwrap();
    assert!(
        (median - (expected + 2.0_f64.sqrt()) / 2.0).abs() < 1e-9,
        "{median}"
    );
    // And the same once the sizes are known.
    found.set_sizes(|_| Some((640, 480)));
    assert!((found.median_reprojection_px().unwrap() - median).abs() < 1e-9);
    assert_eq!((found.cameras[0].cx, found.cameras[1].fx), (320.0, 200.0));
}

#[test]
fn version_0_4_brings_names_and_sizes() {
    let dir = tempfile::tempdir().unwrap();
    let text = SMALL
        .replace("v0.3", "v0.4")
        .replace("\n100 ", "\n./x.jpg 640 480\n100 ")
        .replace(
            "\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0",
            "\ny.jpg 640 480\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0",
        )
        .replace("\n200 ", "\nz.jpg 480 640\n200 ");
    let found = bundle_in(dir.path(), &text).unwrap().reconstruction;
    assert!(found.sizes.are_known());
    let names: Vec<&str> = found.cameras.iter().map(|camera| &*camera.name).collect();
    assert_eq!(names, ["x.jpg", "z.jpg"]);
    assert_eq!((found.cameras[1].width, found.cameras[1].cy), (480, 320.0));
    let median = found.median_reprojection_px().unwrap();
    assert!(
        (median - (0.09099 + 2.0_f64.sqrt()) / 2.0).abs() < 1e-9,
        "{median}"
    );
}

#[test]
fn lines_do_not_matter() {
    let (header, body) = SMALL.split_once('\n').unwrap();
    let one_line = format!("\u{feff}{header} \r\n\r\n{}", body.replace('\n', "\t"));
    let read = |text: &str| {
        read(text.trim_start_matches('\u{feff}'))
            .unwrap()
            .reconstruction
    };
    assert_eq!(read(&one_line), read(SMALL));
    let more = format!("{SMALL}\n7 8\n");
    assert!(
        read(&more).warnings[1].contains("from line 22"),
        "{:?}",
        read(&more).warnings
    );
}

#[test]
fn what_is_wrong_is_named() {
    for (from, to, line, named) in [
        ("# Bundle file v0.3", "drews 1.0", 1, "MVE's bundle"),
        ("v0.3", "v0.2", 1, "only versions 0.3 and 0.4"),
        ("# Bundle file v0.3\n", "", 1, "only versions 0.3 and 0.4"),
        ("3 1", "18446744073709551616 1", 2, "the count of cameras"),
        (
            "3 1",
            "3 18446744073709551615",
            20,
            "the file ends where a point's position",
        ),
        (
            "3 1",
            "18446744073709551615 1",
            18,
            "R of the camera that begins here",
        ),
        ("100 0.1", "nan 0.1", 3, "the focal length is 'nan'"),
        ("100 0.1", "1e999 0.1", 3, "the focal length"),
        ("1 0 0\n0 1 0\n0 0 1", "1 0 0\n0 1 0\n0 0 -1", 3, "mirrors"),
        (
            "1 0 0\n0 1 0\n0 0 1",
            "1 0 0\n0 2 0\n0 0 1",
            3,
            "no rotation",
        ),
        ("2 0 7", "2 3 7", 20, "camera 3, where there are 3"),
        (
            "2 0 7",
            "3 0 7",
            20,
            "the file ends where a measurement's camera",
        ),
        ("2 0 7", "-1 0 7", 20, "count of measurements is '-1'"),
    ] {
        assert!(SMALL.contains(from), "{from}");
        let fault = read(&SMALL.replacen(from, to, 1)).unwrap_err();
        assert!(fault.what.contains(named), "{to}: {fault}");
        assert!(
            fault.line.is_some_and(|found| found.abs_diff(line) <= 2),
            "{to}: {fault:?}"
        );
    }
    let none = SMALL
        .replace("100 0.1", "0 0.1")
        .replace("200 0 0", "-1 0 0");
    assert!(
        read(&none)
            .unwrap_err()
            .what
            .contains("no registered camera")
    );
    assert!(read("").is_err());
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("list.txt"), "a.jpg\nb.jpg\na.jpg\n").unwrap();
    let error = bundle_in(dir.path(), SMALL).unwrap_err().to_string();
    assert!(
        error.contains("two cameras have the photo 'a.jpg'"),
        "{error}"
    );
}

#[test]
fn truncated_anywhere_it_is_an_error_or_a_shorter_number() {
    let last = SMALL.rfind(' ').unwrap();
    for cut in 0..=last {
        assert!(read(&SMALL[..cut]).is_err(), "cut at {cut}");
    }
}

proptest! {
    #[test]
    fn damaged_files_never_panic(edits in prop::collection::vec((0_usize..400, any::<char>()), 1..6)) {
        let mut text: Vec<char> = SMALL.chars().collect();
        for (at, c) in edits {
            let place = at % text.len();
            text[place] = c;
        }
        let _ = read(&text.into_iter().collect::<String>());
    }
}

#[test]
fn files_are_told_by_their_first_line() {
    assert!(is_bundle(b"# Bundle file v0.3\n", "x.txt"));
    assert!(is_bundle(b"drews 1.0\n", "synth_0.out"));
    assert!(is_bundle(b"1 2\n", "bundle.out"));
    assert!(!is_bundle(b"1 2\n", "nohup.out"));
}

/// The README's measure: 2039 observations at 0.201 px.
#[test]
fn kermit_reprojects() {
    let Some(folder) = shared_data("bundler-kermit") else {
        return;
    };
    let mut found = read_file(&bundle_of_folder(&folder).unwrap())
        .unwrap()
        .reconstruction;
    assert_eq!((found.photos.len(), found.cloud.points.len()), (9, 634));
    assert_eq!(found.observations.len(), 2039);
    let median = found.median_reprojection_px().unwrap();
    assert!((median - 0.201).abs() < 5e-4, "{median}");
    assert!(found.warnings[0].starts_with("2 of 11 photos were not registered"));
    assert!(found.warnings[1].contains("kermit000.jpg to kermit010.jpg"));
    found.set_sizes(|_| Some((640, 480)));
    assert!((found.median_reprojection_px().unwrap() - median).abs() < 1e-6);
}

#[test]
fn mve_is_not_bundler() {
    let Some(file) = shared_data("odm-brighton-0/mve/synth_0.out") else {
        return;
    };
    assert!(
        read_file(&file)
            .unwrap_err()
            .to_string()
            .contains("MVE's bundle")
    );
}
