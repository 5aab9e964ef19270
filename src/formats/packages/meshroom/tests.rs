use std::fs;

use proptest::prelude::*;

use super::*;
use fragscale_test_data::shared_data;

/// Two photos of a camera of f = 1000 px that look down from 10, one of them of a rig turned half about
/// its view, one photo without a pose and a point; all in quotes, as boost writes.
const SMALL: &str = r#"{
    "version": ["1", "2", "11"],
    "views": [
        {"viewId": "10", "poseId": "20", "intrinsicId": "30", "path": "D:\\flight\\a.jpg", "width": "4000",
         "metadata": {"Make": "x", "GPS:Latitude": "47, 30, 0", "GPS:LatitudeRef": "N",
                      "GPS:Longitude": "8", "GPS:LongitudeRef": "E", "GPS:Altitude": "400"}},
        {"viewId": "11", "poseId": "21", "intrinsicId": "30", "path": "D:\\flight\\b.jpg", "metadata": "",
         "rigId": "40", "subPoseId": "1", "isPoseIndependant": "false"},
        {"viewId": "12", "poseId": "22", "intrinsicId": "30", "path": "D:\\flight\\c.jpg"}],
    "intrinsics": [
        {"intrinsicId": "30", "width": "4000", "height": "2000", "sensorWidth": "36", "sensorHeight": "18",
         "type": "pinhole", "focalLength": "9", "pixelRatio": "1", "principalPoint": ["0", "0"],
         "distortionType": "radialk1", "distortionParams": ["0.1"], "undistortionType": "none"}],
    "poses": [
        {"poseId": "20", "pose": {"transform": {"rotation": ["1", "0", "0", "0", "-1", "0", "0", "0", "-1"],
            "center": ["1", "2", "10"]}, "locked": "0"}},
        {"poseId": "21", "pose": {"transform": {"rotation": ["1", "0", "0", "0", "-1", "0", "0", "0", "-1"],
            "center": ["3", "2", "10"]}}}],
    "rigs": [{"rigId": "40", "subPoses": [
        {"status": "uninitialized", "pose": {"rotation": ["1", "0", "0", "0", "1", "0", "0", "0", "1"], "center": ["0", "0", "0"]}},
        {"status": "estimated", "pose": {"rotation": ["-1", "0", "0", "0", "-1", "0", "0", "0", "1"], "center": ["1", "2", "3"]}}]}],
    "structure": [
        {"landmarkId": "0", "descType": "sift", "color": ["1", "2", "300"], "X": ["2", "2", "0"],
         "observations": [
            {"observationId": "10", "featureId": "5", "x": ["2100.1", "1000"], "scale": "1"},
            {"observationId": "12", "featureId": "5", "x": ["0", "0"]},
            {"observationId": "11", "featureId": "6"}]},
        {"landmarkId": "1", "color": ["1", "2", "3"], "X": [2, 2, 1], "observations": ""}]
}"#;

#[test]
fn a_scene_in_quotes() {
    let scene = read(SMALL.as_bytes()).unwrap();
    let found = scene.reconstruction;
    let [a, b] = &found.photos[..] else {
        panic!("two photos");
    };
    assert_eq!((a.name.as_str(), b.name.as_str()), ("a.jpg", "b.jpg"));
    let nadir = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z);
    assert_eq!(
        (a.pose.rotation, a.pose.center),
        (nadir, DVec3::new(1.0, 2.0, 10.0))
    );
    // The camera sits at (1, 2, 3) of the rig's axes, which are x east, y south, z down.
    assert_eq!(b.pose.center, DVec3::new(4.0, 0.0, 7.0));
    assert_eq!(
        b.pose.rotation,
        DMat3::from_cols(DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z)
    );
    assert_eq!(
        found.warnings,
        ["1 of 3 photos were not aligned and are left out"]
    );
    assert_eq!(
        found.cloud.points,
        [DVec3::new(2.0, 2.0, 0.0), DVec3::new(2.0, 2.0, 1.0)]
    );
    assert_eq!(found.cloud.colors, [[1, 2, 255], [1, 2, 3]]);
    // The point is 1 east of a's axis at 10: 2000 + 1000 (0.1 + 0.1 * 0.001), where 2100.1 was seen.
    assert_eq!(found.observations.len(), 1);
    assert!(found.median_reprojection_px().unwrap() < 1e-9);
    let [measured] = &found.measured_positions[..] else {
        panic!("one position");
    };
    assert_eq!(
        (measured.photo.as_str(), measured.position.latitude),
        ("a.jpg", 47.5)
    );
    assert_eq!(
        (found.cameras[0].fx, found.cameras[0].name.as_str()),
        (1000.0, "30")
    );
}

/// Plain numbers say the same.
#[test]
fn a_scene_without_quotes() {
    let mut plain = String::new();
    for (index, part) in SMALL.split('"').enumerate() {
        let is_number = index % 2 == 1 && part.parse::<f64>().is_ok();
        let quote = if index % 2 == 1 && !is_number {
            "\""
        } else {
            ""
        };
        plain.push_str(&format!("{quote}{part}{quote}"));
    }
    let plain = plain.replace("\"false\"", "false");
    assert!(
        !plain.contains("\"1\"") && plain.contains("[1, 2, 11]"),
        "{plain}"
    );
    assert_eq!(
        read(plain.as_bytes()).unwrap().reconstruction,
        read(SMALL.as_bytes()).unwrap().reconstruction
    );
}

#[test]
fn names_are_told_apart() {
    let same = SMALL.replace("flight\\\\b.jpg", "other\\\\a.jpg");
    let found = read(same.as_bytes()).unwrap().reconstruction;
    assert_eq!(found.photos[0].name, "D:\\flight\\a.jpg");
    assert_eq!(found.photos[1].name, "D:\\other\\a.jpg");
    assert_eq!(found.measured_positions[0].photo, "D:\\flight\\a.jpg");
    let none = SMALL.replace("D:\\\\flight\\\\b.jpg", "");
    let found = read(none.as_bytes()).unwrap().reconstruction;
    assert_eq!(found.photos[1].name, "view 11");
    assert!(
        found.warnings[1].contains("without a path"),
        "{:?}",
        found.warnings
    );
}

#[test]
fn what_cannot_be_used_is_left_out_or_refused() {
    let with = |from: &str, to: &str| {
        assert!(SMALL.contains(from), "{from}");
        read(SMALL.replace(from, to).as_bytes())
    };
    let fault = with("radialk1", "fisheye1").unwrap_err();
    assert!(fault.what.contains("camera 30 cannot be used"), "{fault}");
    let two = SMALL
        .replace(
            "\"intrinsics\": [",
            r#""intrinsics": [{"intrinsicId": "31", "type": "3deradial4"}, "#,
        )
        .replace(
            "\"21\", \"intrinsicId\": \"30\"",
            "\"21\", \"intrinsicId\": \"31\"",
        );
    let found = read(two.as_bytes()).unwrap().reconstruction;
    assert_eq!((found.photos.len(), found.cameras.len()), (1, 1));
    assert!(
        found.warnings[0].contains("its 1 photos are left out"),
        "{:?}",
        found.warnings
    );
    assert!(found.warnings[1].starts_with("1 of 3 photos were not aligned"));
    let uninitialized = with("\"subPoseId\": \"1\"", "\"subPoseId\": \"0\"").unwrap();
    assert_eq!(uninitialized.reconstruction.photos.len(), 1);
    let independent = with("\"false\"", "\"1\"").unwrap().reconstruction;
    assert_eq!(
        independent.photos[1].pose.center,
        DVec3::new(3.0, 2.0, 10.0)
    );
    let newer = with("\"11\"],", "\"12\"],").unwrap().reconstruction;
    assert!(
        newer.warnings[0].contains("1.2.12, newer"),
        "{:?}",
        newer.warnings
    );
    for (from, to, named) in [
        ("\"poses\"", "\"x\"", "none of its views has a pose"),
        ("\"views\"", "\"x\"", "none of its views has a pose"),
        ("\"version\"", "\"x\"", "missing field `version`"),
        (
            "[\"1\", \"2\", \"11\"]",
            "\"\"",
            "version is not three numbers",
        ),
        (
            "\"viewId\": \"11\"",
            "\"viewId\": \"10\"",
            "the viewId 10 stands twice",
        ),
        (
            "\"poseId\": \"21\"",
            "\"poseId\": \"20\"",
            "the poseId 20 stands twice",
        ),
        (
            "[\"1\", \"2\", \"10\"]",
            "[\"1\", \"2\"]",
            "not three numbers",
        ),
        (
            "[\"1\", \"2\", \"10\"]",
            "[\"1\", \"2\", \"nan\"]",
            "expected a finite number",
        ),
        (
            "\"1\", \"0\", \"0\", \"0\", \"-1\", \"0\", \"0\", \"0\", \"-1\"",
            "\"1\"",
            "not nine numbers",
        ),
        (
            "\"-1\", \"0\", \"0\", \"0\", \"-1\"],\n            \"center\": [\"1\"",
            "\"-1\", \"0\", \"0\", \"0\", \"1\"],\n            \"center\": [\"1\"",
            "mirrors",
        ),
        ("[\"2\", \"2\", \"0\"]", "\"\"", "X of landmark 0"),
    ] {
        let fault = with(from, to).unwrap_err();
        assert!(fault.what.contains(named), "{to}: {fault}");
    }
}

#[test]
fn photos_are_looked_for_and_alembic_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let scene = dir.path().join("cameras.sfm");
    fs::write(&scene, SMALL).unwrap();
    assert_eq!(read_file(&scene).unwrap().photos, None);
    fs::create_dir(dir.path().join("images")).unwrap();
    fs::write(dir.path().join("images/a.jpg"), "").unwrap();
    assert_eq!(
        read_file(&scene).unwrap().photos,
        Some(dir.path().join("images"))
    );
    let alembic = dir.path().join("sfm.abc");
    fs::write(&alembic, b"Ogawa\xff").unwrap();
    let error = read_file(&alembic).unwrap_err().to_string();
    assert!(
        error.contains("Alembic") && error.contains("ConvertSfMFormat"),
        "{error}"
    );
    assert!(is_scene(b"Ogawa", "x") && is_scene(b"{", "x.sfm") && !is_scene(b"{", "x.json"));
}

#[test]
fn truncated_anywhere_it_is_an_error() {
    for cut in 0..SMALL.len() {
        assert!(read(&SMALL.as_bytes()[..cut]).is_err(), "cut at {cut}");
    }
}

proptest! {
    #[test]
    fn damaged_files_never_panic(edits in prop::collection::vec((0_usize..4000, any::<u8>()), 1..6)) {
        let mut json = SMALL.as_bytes().to_vec();
        for (at, byte) in edits {
            let place = at % json.len();
            json[place] = byte;
        }
        let _ = read(&json);
    }
}

/// What the README says of version 1.2.0: 27 poses, a principal point of (2020, 1040) from the corner.
#[test]
fn the_compatibility_scene() {
    let Some(folder) = shared_data("meshroom-compat") else {
        return;
    };
    let found = read_file(&folder.join("scene_v1.2.0.json"))
        .unwrap()
        .reconstruction;
    assert_eq!(found.cloud.points.len(), 9261);
    let camera = &found.cameras[1];
    assert_eq!(
        (camera.fx, camera.fy, camera.cx, camera.cy),
        (1000.0, 2000.0, 2020.0, 1040.0)
    );
    assert_eq!(
        camera.distortion.coefficients()[..5],
        [0.1, 0.05, 0.0, 0.0, -0.001]
    );
    assert_eq!(found.photos[0].pose.center, DVec3::NEG_ONE);
    let centers: HashSet<[i64; 3]> = found
        .photos
        .iter()
        .map(|p| p.pose.center.round().as_i64vec3().to_array())
        .collect();
    assert_eq!(centers.len(), 27);
    let error = read_file(&folder.join("small.sfm"))
        .unwrap_err()
        .to_string();
    assert!(error.contains("none of its views has a pose"), "{error}");
}

/// 22 views, 18 poses, a phone with GPS (README).
#[test]
fn meshroom_2023() {
    let Some(file) = shared_data("meshroom2023-south/cameras.sfm") else {
        return;
    };
    let found = read_file(&file).unwrap().reconstruction;
    assert_eq!((found.photos.len(), found.cameras.len()), (18, 1));
    assert_eq!(
        found.warnings,
        ["4 of 22 photos were not aligned and are left out"]
    );
    assert!(found.measured_positions.len() > 18);
    let place = found.measured_positions[0].position;
    assert!((place.latitude - (47.0 + 13.0 / 60.0 + 55.13 / 3600.0)).abs() < 1e-12);
    // 4.687 mm on 6.4 mm of 4000 px.
    let f = 4.686_553_003_292_894 / 6.4 * 4000.0;
    let camera = &found.cameras[0];
    assert!((camera.fx - f).abs() < 1e-9 && (camera.fy - f).abs() < 1e-9);
    assert!((camera.cx - 2_002.699_098_456_852).abs() < 1e-9);
    // All look at one building: the point where their axes meet best lies in front of every camera,
    // between 1.28 and 3.73 units. With the rotations transposed it lies behind some.
    let (mut sum, mut weighted) = (DMat3::ZERO, DVec3::ZERO);
    for photo in &found.photos {
        let forward = photo.pose.rotation.z_axis;
        let across = DMat3::IDENTITY
            - DMat3::from_cols(
                forward * forward.x,
                forward * forward.y,
                forward * forward.z,
            );
        sum += across;
        weighted += across * photo.pose.center;
    }
    let meeting = sum.inverse() * weighted;
    let depths: Vec<f64> = found
        .photos
        .iter()
        .map(|p| p.pose.camera_from_world(meeting).z)
        .collect();
    let (near, far) = (
        depths.iter().copied().fold(f64::MAX, f64::min),
        depths.iter().copied().fold(0.0, f64::max),
    );
    assert!(
        (near - 1.285).abs() < 1e-3 && (far - 3.733).abs() < 1e-3,
        "{near} {far}"
    );
    assert_eq!(camera.distortion.name(), "brown");
}
