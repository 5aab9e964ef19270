//! Projects built from the specification's examples.

use std::fs;

use super::*;

const PROJECT: &str = r#"{"version": "1.0", "format": "application/opf-project+json", "name": "x",
    "items": [
    {"id": "a", "type": "camera_list", "resources": [{"uri": "camera-list.json", "format": "application/opf-camera-list+json"}], "sources": []},
    {"id": "b", "type": "input_cameras", "resources": [{"uri": "./input%20cameras.json", "format": "application/opf-input-cameras+json"}]},
    {"id": "c", "type": "scene_reference_frame", "resources": [{"uri": "frame.json", "format": "application/opf-scene-reference-frame+json"}]},
    {"id": "d", "type": "ext_x"},
    {"id": "e", "type": "calibration", "resources": [{"uri": "sparse.gltf", "format": "model/gltf+json"},
        {"uri": "calibrated-cameras.json", "format": "application/opf-calibrated-cameras+json"}]}]}"#;

const LIST: &str = r#"{"format": "application/opf-camera-list+json", "version": "1.0", "cameras": [
    {"id": 47292894, "uri": "IMG_160929_114101_0001_GRE.tif"},
    {"id": 18446744073709551615, "uri": "file:///c:/data/images/DJI%2009572.jpg#page=0"},
    {"id": 28493939, "uri": "Image_09573.jpg"}, {"id": 28493939, "uri": "Image_09573.jpg"}]}"#;

const INPUTS: &str = r#"{"format": "application/opf-input-cameras+json", "version": "1.0",
    "sensors": [{"id": 57282113, "name": "y", "image_size_px": [6000, 4000], "internals": {}},
        {"id": 18493134, "name": "x", "image_size_px": [1280, 960]}],
    "captures": [{"id": 1, "reference_camera_id": 28493939, "cameras": [{"id": 28493939, "sensor_id": 57282113}],
        "geolocation": {"crs": {"definition": "EPSG:4326+5773"}, "coordinates": [33.5, -84.3, 300], "sigmas": [5, 5, 10]}},
        {"id": 2, "reference_camera_id": 7, "cameras": [{"id": 7, "sensor_id": 57282113}]}]}"#;

/// The specification's, with a third camera that looks straight down.
const CALIBRATED: &str = r#"{"format": "application/opf-calibrated-cameras+json", "version": "1.0",
    "cameras": [
        {"id": 47292894, "orientation_deg": [3.3432, -5.2849554, 9.345113], "position": [483.054, 13.957, 28.12], "sensor_id": 18493134},
        {"id": 28493939, "orientation_deg": [1.4753, 10.5839, -2.94832], "position": [243.054, 521.957, 31.12], "sensor_id": 57282113},
        {"id": 18446744073709551615, "orientation_deg": [0, 0, 90], "position": [0, 0, 0], "sensor_id": 57282113}],
    "sensors": [
        {"id": 18493134, "internals": {"affine": [1676.296432, 0.0, 0.0, 1676.296432], "is_p0_zero": true,
            "is_symmetric_affine": true, "polynomial": [0.0, 1.0, 0.0152646, -0.161096],
            "principal_point_px": [634.45, 481.23], "type": "fisheye"}},
        {"id": 57282113, "internals": {"principal_point_px": [3001.23, 2011.2434], "focal_length_px": 5312.353,
            "radial_distortion": [-0.01444223, 0.012321123, -2.13311e-05],
            "tangential_distortion": [0.001239402, 0.000432234], "type": "perspective"}}]}"#;

const FRAME: &str = r#"{"format": "application/opf-scene-reference-frame+json", "version": "1.0",
    "crs": {"definition": "EPSG:32616"}, "base_to_canonical": {"scale": [1.0, 1.0, 1.0],
    "shift": [-746308.1230880459, -3714810.972981808, -268.74755556838863], "swap_xy": false}}"#;

fn project(change: impl Fn(&str, &str) -> String) -> Result<Reconstruction, FileError> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("project.opf", PROJECT),
        ("camera-list.json", LIST),
        ("input cameras.json", INPUTS),
        ("frame.json", FRAME),
        ("calibrated-cameras.json", CALIBRATED),
    ] {
        let text = change(name, text);
        if !text.is_empty() {
            fs::write(folder.path().join(name), text).unwrap();
        }
    }
    read(&project_in(folder.path()).unwrap()).map(|project| project.reconstruction)
}

#[test]
fn the_specifications_example() {
    let found = project(|_, text| text.to_owned()).unwrap();
    assert_eq!(found.crs.as_deref(), Some("EPSG:32616"));
    let names: Vec<_> = found
        .photos
        .iter()
        .map(|photo| photo.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "IMG_160929_114101_0001_GRE.tif",
            "Image_09573.jpg",
            "DJI 09572.jpg"
        ]
    );
    let expected = DVec3::new(
        746_551.177_088_045_9,
        3_715_332.929_981_808,
        299.867_555_568_388_6,
    );
    assert!((found.photos[1].pose.center - expected).length() < 1e-8);
    // kappa 90: the image's right is north, its top west.
    let down = found.photos[2].pose.rotation;
    assert!((down.x_axis - DVec3::Y).length() < 1e-12 && (down.y_axis - DVec3::X).length() < 1e-12);
    let camera = &found.cameras[1];
    assert_eq!(
        (camera.width, camera.height, camera.cx),
        (6000, 4000, 3001.23)
    );
    let Distortion::Brown(brown) = camera.distortion else {
        panic!("{:?}", camera.distortion);
    };
    let expected = [
        -0.01444223,
        0.012321123,
        0.001239402,
        0.000432234,
        -2.13311e-05,
        0.0,
        0.0,
        0.0,
    ];
    assert_eq!(brown.coefficients(), expected);
    let place = found.measured_positions[0].position;
    assert_eq!((place.latitude, place.longitude), (33.5, -84.3));
    let said = found.warnings.join("; ");
    for part in [
        "sensor 18493134: its fish-eye is fitted, to 0.",
        "1 photos were not calibrated",
        "glTF",
    ] {
        assert!(said.contains(part), "{said}");
    }
}

#[test]
fn frames_are_taken_back() {
    let with = |from: &'static str, to: &'static str| {
        project(move |_, text| text.replace(from, to)).unwrap()
    };
    let feet = with("\"scale\": [1.0, 1.0, 1.0]", "\"scale\": [2.0, 2.0, 2.0]");
    assert!((feet.photos[2].pose.center.x - 373_154.061_544_022_95).abs() < 1e-8);
    let heights = with("\"scale\": [1.0, 1.0, 1.0]", "\"scale\": [1.0, 1.0, 0.5]");
    assert!(
        heights.warnings.join("; ").contains("2 times"),
        "{:?}",
        heights.warnings
    );
    // A system in US survey feet with heights in metres has each axis in its own unit, and says so itself.
    let own = project(|_, text| {
        text.replace("EPSG:32616", "EPSG:2227+5703")
            .replace("\"scale\": [1.0, 1.0, 1.0]", "\"scale\": [0.5, 0.5, 1.0]")
    });
    let (own, plain) = (own.unwrap(), with("EPSG:32616", "EPSG:32616"));
    let [own_center, plain_center] = [&own, &plain].map(|found| found.photos[2].pose.center);
    let expected = plain_center * DVec3::new(2.0, 2.0, 1.0);
    assert!(
        (own_center - expected).length() < 1e-8,
        "{own_center} {expected}"
    );
    assert!(
        !own.warnings.join("; ").contains("times"),
        "{:?}",
        own.warnings
    );
    let none = with("opf-scene-reference-frame", "ext-x");
    assert_eq!(none.crs, None);
    assert!(none.warnings.join("; ").contains("no reference frame"));
}

#[test]
fn sizes_may_come_from_the_photos() {
    let mut found = project(|_, text| text.replace("opf-input-cameras", "ext-x")).unwrap();
    assert!(!found.sizes.are_known());
    found.set_sizes(|_| Some((6000, 4000)));
    // Without a size nothing can be fitted.
    let said = found.warnings.join("; ");
    assert!(
        said.contains("sensor 18493134 are left out: its fish-eye polynomial has p2 ="),
        "{said}"
    );
    assert!(
        said.contains("1 photos have no calibration that can be read"),
        "{said}"
    );
    assert_eq!(found.cameras[0].cx, 3001.23);
}

#[test]
fn what_is_missing_is_named() {
    let error = project(|_, text| text.replace("opf-calibrated", "ext")).unwrap_err();
    assert!(
        error.fault.what.contains("without calibrated cameras"),
        "{error}"
    );
    let error = project(|name, text| {
        if name == "frame.json" {
            String::new()
        } else {
            text.to_owned()
        }
    });
    assert!(error.unwrap_err().file.ends_with("frame.json"));
    let found = project(|_, text| text.replace("\"perspective\"", "\"spherical\"")).unwrap();
    assert!(
        found
            .warnings
            .join("; ")
            .contains("sensor 57282113 are left out: its camera model")
    );
    let error = project(|_, text| text.replace("5312.353", "-1").replace("1676.296432", "0"));
    let error = error.unwrap_err();
    assert!(error.fault.what.contains("no photo can be read"), "{error}");
    let error = project(|_, text| text.replace("[1.0, 1.0, 1.0]", "[1.0, 2.0, 1.0]")).unwrap_err();
    assert!(error.fault.what.contains("scales by 1, 2, 1"), "{error}");
    let error = project(|_, text| text.replace("5312.353", "1e999")).unwrap_err();
    assert!(error.file.ends_with("calibrated-cameras.json"), "{error}");
}

#[test]
fn truncations_are_no_panic() {
    for end in 0..CALIBRATED.len() {
        assert!(json::parse::<CalibratedCameras>(&CALIBRATED.as_bytes()[..end]).is_err());
    }
}

#[test]
fn uris() {
    assert_eq!(
        parts::path_of("a%20b/c.json#x"),
        PathBuf::from("a b/c.json")
    );
    assert_eq!(
        parts::path_of("file:///c:/d.json"),
        PathBuf::from("c:/d.json")
    );
    assert_eq!(parts::path_of("file:///d.json"), PathBuf::from("/d.json"));
    assert_eq!(parts::file_name("100%.jpg"), "100%.jpg");
    assert_eq!(parts::file_name("%"), "%");
}
