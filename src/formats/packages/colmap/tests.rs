use std::fs;

use super::*;
use crate::camera::Camera;
use fragscale_test_data::shared_data;

const CAMERAS: &str = "7 PINHOLE 400 300 100 100 200 150\n";
const IMAGES: &str = "3 0 1 0 0 0 0 10 7 b.jpg\n250 175 90 1 2 -1\n\
                      1 0 1 0 0 0 0 12 7 a.jpg\n200 150 11 0 0 12345\n";
const POINTS: &str = "90 5 -2.5 0 9 8 7 0\n11 0 0 0 1 2 3 0\n";

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = dir.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    dir
}

fn model(at: &str) -> Vec<(String, &'static str)> {
    [
        ("cameras", CAMERAS),
        ("images", IMAGES),
        ("points3D", POINTS),
    ]
    .map(|(part, text)| (format!("{at}{part}.txt"), text))
    .to_vec()
}

fn folder_of(files: &[(String, &str)]) -> tempfile::TempDir {
    let files: Vec<(&str, &str)> = files.iter().map(|(n, t)| (n.as_str(), *t)).collect();
    folder(&files)
}

/// Half a turn about x: the camera looks down from z = 10, its x along the world's. The point
/// (5, -2.5, 0) lies 5 right and 2.5 below, so at (200 + 50, 150 + 25).
#[test]
fn the_parts_are_joined_by_their_ids() {
    let dir = folder_of(&model(""));
    let model = read_folder(dir.path()).unwrap();
    assert_eq!((model.package, model.sizes), ("colmap", Sizes::Known));
    let names: Vec<&str> = model.photos.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["b.jpg", "a.jpg"]);
    let first = &model.photos[0];
    assert_eq!(first.pose.center, DVec3::new(0.0, 0.0, 10.0));
    assert_eq!(first.pose.rotation.z_axis, DVec3::NEG_Z);
    assert_eq!(model.cameras[first.camera].name, "7");
    assert_eq!(model.cloud.colors, [[9, 8, 7], [1, 2, 3]]);
    assert_eq!(
        model.observations,
        [
            Observation {
                photo: 0,
                point: 0,
                pixel: DVec2::new(250.0, 175.0)
            },
            Observation {
                photo: 1,
                point: 1,
                pixel: DVec2::new(200.0, 150.0)
            },
        ]
    );
    assert_eq!(model.median_reprojection_px(), Some(0.0));
    assert_eq!(
        model.warnings,
        ["left out: 1 observations of 3D points that points3D.txt does not have"]
    );
}

#[test]
fn points_may_be_missing() {
    let dir = folder_of(&model("")[..2]);
    let model = read_folder(dir.path()).unwrap();
    assert!(model.cloud.points.is_empty() && model.observations.is_empty());
    assert_eq!(model.warnings.len(), 1);
    assert!(model.warnings[0].contains("no points3D.txt"));
}

#[test]
fn project_folders_are_recognised() {
    for at in ["", "sparse/0/", "sparse/"] {
        let dir = folder_of(&model(at));
        assert!(model_folder(dir.path()).is_some());
        assert_eq!(model_folder(dir.path()).unwrap(), dir.path().join(at));
        assert_eq!(read_folder(dir.path()).unwrap().photos.len(), 2);
    }
    let two = [model("sparse/0/"), model("sparse/1/")].concat();
    let warnings = read_folder(folder_of(&two).path()).unwrap().warnings;
    assert!(warnings[1].contains("sparse/1"), "{warnings:?}");
    let none = folder(&[("cameras.txt", CAMERAS), ("images.bin", "")]);
    assert!(model_folder(none.path()).is_none());
    assert!(read_folder(none.path()).is_err());
    assert!(model_folder(Path::new("no/such")).is_none());
}

#[test]
fn binary_wins_over_text() {
    let dir = folder_of(&model(""));
    fs::write(dir.path().join("cameras.bin"), [0_u8; 8]).unwrap();
    assert!(read_folder(dir.path()).is_ok());
    fs::write(dir.path().join("images.bin"), [1_u8]).unwrap();
    let error = read_folder(dir.path()).unwrap_err();
    assert!(error.file.ends_with("images.bin"), "{error}");
}

#[test]
fn faults_name_their_file() {
    let cameras_twice = CAMERAS.repeat(2);
    let points_twice = POINTS.repeat(2);
    let same_name = IMAGES.replace("a.jpg", "b.jpg");
    let same_id = IMAGES.replace("\n1 0 1", "\n3 0 1");
    let no_camera = IMAGES.replace("12 7 a", "12 8 a");
    for (file, text, says) in [
        ("cameras.txt", cameras_twice.as_str(), "'7' is there twice"),
        ("cameras.txt", "7 FOV 1 1 1 1 1 1 1", ":1: camera id 7 has"),
        ("images.txt", &same_name, "'b.jpg' is there twice"),
        ("images.txt", &same_id, "'3' is there twice"),
        (
            "images.txt",
            &no_camera,
            ":3: image 'a.jpg' uses camera id 8",
        ),
        ("images.txt", "# none\n", "it holds no image"),
        ("points3D.txt", &points_twice, "'90' is there twice"),
        ("points3D.txt", "90 1 2", ":1: the line ends where"),
    ] {
        let dir = folder_of(&model(""));
        fs::write(dir.path().join(file), text).unwrap();
        let error = read_folder(dir.path()).unwrap_err();
        assert!(error.file.ends_with(file), "{error}");
        assert!(error.to_string().contains(says), "{error}");
    }
}

/// The text holds 6 significant digits of what the binary file holds exactly.
fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 5.1e-6 * a.abs().max(b.abs())
}

fn close3(a: DVec3, b: DVec3) -> bool {
    close(a.x, b.x) && close(a.y, b.y) && close(a.z, b.z)
}

#[test]
fn a_real_model_reads_alike_from_text_and_binary() {
    let Some(data) = shared_data("sceaux-colmap") else {
        return;
    };
    let binary = read_folder(&data.join("bin")).unwrap();
    let text = read_folder(&data.join("txt")).unwrap();
    for model in [&binary, &text] {
        assert_eq!((model.cameras.len(), model.photos.len()), (1, 11));
        assert_eq!(model.cloud.points.len(), 7862);
        // The data's README, measured by another program.
        assert_eq!(model.observations.len(), 37_123);
        let median = model.median_reprojection_px().unwrap();
        assert!((median - 0.4997).abs() < 5e-5, "{median}");
        assert_eq!(model.warnings, [""; 0]);
    }
    let (a, b) = (&binary.cameras[0], &text.cameras[0]);
    assert_eq!((a.width, a.height), (b.width, b.height));
    let numbers = |c: &Camera| [vec![c.fx, c.fy, c.cx, c.cy], c.distortion.coefficients()];
    for (a, b) in numbers(a).concat().iter().zip(numbers(b).concat()) {
        assert!(close(*a, b), "{a} {b}");
    }
    for a in &binary.photos {
        let b = text.photos.iter().find(|b| b.name == a.name).unwrap();
        let apart = (a.pose.center - b.pose.center).length();
        assert!(apart < 5e-5, "{}: {apart}", a.name);
        assert!(a.pose.rotation.abs_diff_eq(b.pose.rotation, 5e-6));
    }
    // The two files have their own orders of points, so each side is sorted by what they share.
    let sorted = |model: &Reconstruction| {
        let mut seen: Vec<_> = model
            .observations
            .iter()
            .map(|o| {
                let photo = model.photos[o.photo as usize].name.clone();
                let point = o.point as usize;
                let color = model.cloud.colors[point];
                (photo, o.pixel, model.cloud.points[point], color)
            })
            .collect();
        seen.sort_by(|a, b| a.0.cmp(&b.0));
        seen
    };
    for (a, b) in sorted(&binary).iter().zip(sorted(&text)) {
        assert!(a.0 == b.0 && a.3 == b.3 && close3(a.2, b.2), "{a:?} {b:?}");
        assert!(close(a.1.x, b.1.x) && close(a.1.y, b.1.y), "{a:?} {b:?}");
    }
}
