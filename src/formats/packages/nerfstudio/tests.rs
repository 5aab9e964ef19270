//! Cameras and poses in every form, what is said, what is refused.

use std::f64::consts::PI;
use std::fs;

use glam::DMat3;
use proptest::prelude::*;

use super::*;
use crate::camera::{Camera, Distortion};

/// Looks straight down from (5, 6, 7) with its top to north: the identity in OpenGL's axes.
const MATRIX: &str = "[[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]";

fn transforms(intrinsics: &str, frame: &str) -> String {
    format!(
        r#"{{{intrinsics}, "frames": [{{"file_path": "./images/a.jpg",
            "transform_matrix": {MATRIX}{frame}}}]}}"#
    )
}

fn camera_of(intrinsics: &str, frame: &str) -> Result<Camera, Fault> {
    let json = transforms(intrinsics, frame);
    let (mut found, _) = read(json.as_bytes(), |_| Some((800, 600)))?;
    Ok(found.cameras.remove(0))
}

#[test]
fn poses_and_names() {
    let json = transforms(
        r#""fl_x": 400, "w": 800, "h": 600, "ply_file_path": "x.ply""#,
        "",
    );
    let (found, cloud) = read(json.as_bytes(), |_| None).unwrap();
    let photo = &found.photos[0];
    assert_eq!(
        (photo.name.as_str(), cloud.as_deref()),
        ("images/a.jpg", Some("x.ply"))
    );
    assert_eq!(photo.pose.center, DVec3::new(5.0, 6.0, 7.0));
    let nadir = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z);
    assert_eq!(photo.pose.rotation, nadir);
    assert_eq!(photo_name("./train/r_0", |_| None), "train/r_0.png");
    assert_eq!(
        photo_name("r_0", |name| (name == "r_0").then_some((1, 1))),
        "r_0"
    );
}

#[test]
fn intrinsics_in_every_form() {
    let pinhole = camera_of(r#""fl_x": 400, "w": 800, "h": 600"#, "").unwrap();
    assert_eq!(
        (pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy),
        (400.0, 400.0, 400.0, 300.0)
    );
    assert_eq!(
        (pinhole.distortion, pinhole.name.as_str()),
        (Distortion::None, "1")
    );
    // A right angle: f is half the width. The size is that of the file.
    let angle = camera_of(&format!(r#""camera_angle_x": {}"#, PI / 2.0), "").unwrap();
    assert!((angle.fx - 400.0).abs() < 1e-9 && (angle.fy - 400.0).abs() < 1e-9);
    assert_eq!((angle.width, angle.height), (800, 600));
    let all = r#""camera_model": "OPENCV", "fl_x": 401, "fl_y": 402, "cx": 403, "cy": 304, "w": 800,
        "h": 600, "k1": 0.1, "k2": 0.2, "p1": 0.3, "p2": 0.4, "k3": 0.5, "k4": 0, "camera_angle_x": 9"#;
    let opencv = camera_of(all, "").unwrap();
    assert_eq!(
        (opencv.fx, opencv.fy, opencv.cx, opencv.cy),
        (401.0, 402.0, 403.0, 304.0)
    );
    assert_eq!(
        opencv.distortion.coefficients()[..5],
        [0.1, 0.2, 0.3, 0.4, 0.5]
    );
    let fisheye = camera_of(&all.replace("OPENCV", "OPENCV_FISHEYE"), "").unwrap();
    assert_eq!(fisheye.distortion.coefficients(), [0.1, 0.2, 0.5, 0.0]);
    let ngp = camera_of(r#""fl_x": 400, "is_fisheye": true, "k1": 0.1"#, "").unwrap();
    assert_eq!(ngp.distortion.name(), "fisheye");
}

#[test]
fn a_frames_intrinsics_stand_before_the_files() {
    let file = r#""fl_x": 400, "fl_y": 390, "w": 800, "h": 600, "k1": 0.1"#;
    let own = camera_of(file, r#", "fl_x": 500, "cx": 410, "k1": 0.2"#).unwrap();
    assert_eq!((own.fx, own.fy, own.cx), (500.0, 500.0, 410.0));
    assert_eq!(own.distortion.coefficients()[0], 0.2);
    let json = format!(
        r#"{{{file}, "frames": [
            {{"file_path": "a.jpg", "transform_matrix": {MATRIX}}},
            {{"file_path": "b.jpg", "transform_matrix": {MATRIX}, "fl_x": 500}},
            {{"file_path": "c.jpg", "transform_matrix": {MATRIX}}},
            {{"file_path": "d.jpg"}},
            {{"file_path": "e.jpg", "transform_matrix": {MATRIX}, "camera_model": "EQUIRECTANGULAR"}}],
           "applied_transform": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]}}"#
    );
    let (found, _) = read(json.as_bytes(), |_| None).unwrap();
    let cameras: Vec<usize> = found.photos.iter().map(|photo| photo.camera).collect();
    assert_eq!(cameras, [0, 1, 0]);
    for (warning, named) in found.warnings.iter().zip([
        "applied_transform",
        "1 of 5 photos have no pose",
        "EQUIRECTANGULAR",
    ]) {
        assert!(warning.contains(named), "{warning}");
    }
    assert_eq!(found.warnings.len(), 3);
}

#[test]
fn what_stands_twice_or_contradicts_itself_is_said() {
    // 400 px of a width of 800 are a right angle.
    let frame = format!(r#"{{"file_path": "a.jpg", "transform_matrix": {MATRIX}}}"#);
    let file = |angle: f64, second: &str| {
        let json = format!(
            r#"{{"fl_x": 400, "w": 800, "h": 600, "camera_angle_x": {angle}, "frames": [{frame}, {second}]}}"#
        );
        read(json.as_bytes(), |_| None)
    };
    let (found, _) = file(PI / 2.0, &frame).unwrap();
    assert_eq!(found.photos.len(), 1);
    assert!(found.warnings[0].starts_with("1 of 2 frames stand there a second time"));
    assert_eq!(found.warnings.len(), 1);
    let fault = file(PI / 2.0, &frame.replace("5]", "6]")).unwrap_err();
    assert!(fault.what.contains("different poses"), "{fault}");
    let (found, _) = file(PI / 3.0, &frame.replace("a.jpg", "b.jpg")).unwrap();
    let [warning] = &found.warnings[..] else {
        panic!("{:?}", found.warnings);
    };
    assert!(
        warning.contains("90.0 degrees, but camera_angle_x says 60.0"),
        "{warning}"
    );
}

/// 1500 px across 49.3 degrees are 1634 px of focal length: 35.7 is in millimetres, on a sensor of 32.8 mm. Fish-eyes see that much.
#[test]
fn a_focal_length_in_millimetres_is_refused() {
    let millimetres = r#""fl_x": 35.7, "w": 1500, "h": 1000"#;
    let angle = format!(
        r#"{millimetres}, "camera_angle_x": {}"#,
        49.3_f64.to_radians()
    );
    let fault = camera_of(&angle, "").unwrap_err();
    for words in ["field of view of 174.5 degrees", "says 49.3", "millimetres"] {
        assert!(fault.what.contains(words), "{fault}");
    }
    let right = angle.replace("35.7", "1634.2");
    assert!(camera_of(&right, "").is_ok());
    assert!(camera_of(&format!(r#"{angle}, "is_fisheye": true"#), "").is_ok());
    // Nothing contradicts it, and it is said.
    let json = transforms(millimetres, "");
    let (found, _) = read(json.as_bytes(), |_| None).unwrap();
    let [warning] = &found.warnings[..] else {
        panic!("{:?}", found.warnings);
    };
    assert!(
        warning.contains("174.5 degrees; if it is in millimetres"),
        "{warning}"
    );
}

#[test]
fn what_is_wrong_is_named() {
    for (intrinsics, frame, named) in [
        (r#""w": 800"#, "", "neither fl_x nor camera_angle_x"),
        (r#""fl_x": 0"#, "", "fx is 0"),
        (r#""fl_x": 1, "w": 0.5, "h": 1"#, "", "w is 0.5"),
        (r#""camera_angle_x": 4"#, "", "field of view is 4"),
        (r#""fl_x": 1, "k4": 0.1"#, "", "a perspective one with k4"),
        (
            r#""fl_x": 1, "camera_model": "EQUIRECTANGULAR""#,
            "",
            "EQUIRECTANGULAR",
        ),
        (r#""fl_x": 1, "ftheta_p0": 0.1"#, "", "F-theta"),
        (r#""fl_x": 1, "latlong": true"#, "", "a panorama"),
        (r#""fl_x": "1""#, "", "invalid type"),
        (r#""fl_x": NaN"#, "", "expected value"),
    ] {
        let fault = camera_of(intrinsics, frame).unwrap_err();
        assert!(fault.what.contains(named), "{intrinsics}: {fault}");
    }
    let json = transforms(r#""fl_x": 400"#, "");
    let fault = read(json.as_bytes(), |_| None).unwrap_err();
    assert!(fault.what.contains("no w and h"), "{fault}");
    for (from, to, named) in [
        ("[0, 0, 1, 7]", "[0, 0, 1]", "not 4 x 4"),
        ("[0, 0, 1, 7]", "[0, 0, -1, 7]", "mirrors"),
        ("[0, 0, 0, 1]", "[0, 0, 0, 2]", "last row"),
        ("[1, 0, 0, 5], ", "", "rotation"),
        (
            "\"transform_matrix\"",
            "\"x\"",
            "no frame with a transform_matrix",
        ),
    ] {
        let fault = read(json.replace(from, to).as_bytes(), |_| Some((8, 6))).unwrap_err();
        assert!(fault.what.contains(named), "{to}: {fault}");
    }
    assert!(read(br#"{"frames": []}"#, |_| None).is_err());
    for cut in 0..json.len() {
        assert!(read(&json.as_bytes()[..cut], |_| Some((8, 6))).is_err());
    }
}

#[test]
fn files_are_found_beside() {
    let dir = tempfile::tempdir().unwrap();
    let json = transforms(r#""fl_x": 4, "ply_file_path": "x.ply""#, "");
    fs::create_dir(dir.path().join("images")).unwrap();
    image::RgbImage::new(8, 6)
        .save(dir.path().join("images/a.jpg"))
        .unwrap();
    fs::write(dir.path().join("transforms.json"), json).unwrap();
    let file = transforms_of_folder(dir.path()).unwrap();
    let project = read_file(&file).unwrap();
    let camera = &project.reconstruction.cameras[0];
    assert_eq!((camera.width, camera.cy, project.surface), (8, 3.0, None));
    fs::write(dir.path().join("x.ply"), "").unwrap();
    assert!(read_file(&file).unwrap().surface.is_some());
}

proptest! {
    #[test]
    fn damaged_files_never_panic(edits in prop::collection::vec((0_usize..2000, any::<u8>()), 1..6)) {
        let mut json = transforms(r#""fl_x": 400, "w": 800, "h": 600, "k1": 0.1"#, "").into_bytes();
        for (at, byte) in edits {
            let place = at % json.len();
            json[place] = byte;
        }
        let _ = read(&json, |_| None);
    }
}
