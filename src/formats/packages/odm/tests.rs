use std::fs;

use glam::{DMat3, DVec3};
use tempfile::TempDir;

use super::*;
use fragscale_test_data::shared_data;

const CAMERAS: (&str, &str) = (
    "cameras.json",
    r#"{"c": {"projection_type": "brown", "focal_x": 0.5, "focal_y": 0.5, "width": 400, "height": 200}}"#,
);
/// Two photos that look straight down, and a point 10 below the first, in a frame that is the
/// world less the offset.
const SPARSE: (&str, &str) = (
    "opensfm/reconstruction.json",
    r#"[{"cameras": {"v2 c": {"projection_type": "brown", "focal_x": 0.5, "focal_y": 0.5, "width": 400, "height": 200}},
    "shots": {
      "a.jpg": {"camera": "v2 c", "rotation": [3.141592653589793, 0, 0], "translation": [-1, 2, 50]},
      "b.jpg": {"camera": "v2 c", "rotation": [3.141592653589793, 0, 0], "translation": [-3, 4, 60]}},
    "points": {"7": {"coordinates": [1, 2, 40], "color": [1, 2, 3]}}}]"#,
);
/// The same photos in the world, in another order.
const SHOTS: (&str, &str) = (
    "odm_report/shots.geojson",
    r#"{"features": [
    {"properties": {"filename": "b.jpg", "camera": "v2 c", "focal": 0.5, "width": 400, "height": 200,
      "translation": [500003, 4000004, 60], "rotation": [3.141592653589793, 0, 0]}},
    {"properties": {"filename": "a.jpg", "focal": 0.5, "width": 400, "height": 200,
      "translation": [500001, 4000002, 50], "rotation": [3.141592653589793, 0, 0]}}]}"#,
);
const TRACKS: (&str, &str) = ("opensfm/tracks.csv", "a.jpg\t7\t0\t0\t0\t1\t2\t3\n");
const COORDS: (&str, &str) = (
    "odm_georeferencing/coords.txt",
    "WGS84 UTM 33N\n500000 4000000\n",
);
const CLOUD: (&str, &str) = ("odm_georeferencing/odm_georeferenced_model.las", "");
const LIST: (&str, &str) = ("img_list.txt", "a.jpg\nb.jpg\n\nc.jpg\n");

fn project(files: &[(&str, &str)]) -> TempDir {
    let dir = TempDir::new().unwrap();
    for (name, content) in files {
        let file = dir.path().join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, content).unwrap();
    }
    dir
}

fn names(project: &Project) -> Vec<&str> {
    let photos = project.reconstruction.photos.iter();
    photos.map(|photo| &*photo.name).collect()
}

#[test]
fn a_whole_project() {
    let dir = project(&[CAMERAS, SPARSE, SHOTS, TRACKS, COORDS, CLOUD, LIST]);
    assert!(is_odm_folder(dir.path()));
    let project = read_folder(dir.path()).unwrap();
    assert_eq!(names(&project), ["b.jpg", "a.jpg"]);
    assert_eq!(project.surface, Some(dir.path().join(CLOUD.0)));
    assert_eq!(project.photos, None);
    let reconstruction = project.reconstruction;
    assert_eq!(reconstruction.package, "opendronemap");
    assert_eq!(reconstruction.crs.as_deref(), Some("EPSG:32633"));
    assert_eq!(reconstruction.cameras[0].name, "c");
    assert_eq!(reconstruction.warnings, ["1 of 3 photos were not aligned"]);
    assert_eq!(
        reconstruction.cloud.points,
        [DVec3::new(500_001.0, 4_000_002.0, 40.0)]
    );
    // The point lies on the axis of a.jpg, which is the second photo now.
    assert_eq!(reconstruction.observations[0].photo, 1);
    assert!(reconstruction.median_reprojection_px().unwrap() < 1e-9);
}

#[test]
fn without_shots_the_offset_counts_where_the_version_is_known() {
    let topocentric = ("opensfm/reconstruction.topocentric.json", "[]");
    let dir = project(&[CAMERAS, SPARSE, TRACKS, COORDS, CLOUD, topocentric]);
    let moved = read_folder(dir.path()).unwrap();
    assert_eq!(names(&moved), ["a.jpg", "b.jpg"]);
    let center = moved.reconstruction.photos[0].pose.center;
    assert!((center - DVec3::new(500_001.0, 4_000_002.0, 50.0)).length() < 1e-9);
    assert!(moved.surface.is_some() && moved.reconstruction.warnings.is_empty());
    // Else the photos' GPS positions tell: 2.4 degrees turned against east and north at the
    // reference, whose place in the zone was computed outside.
    let shots = r#"[{"cameras": {"v2 c": {"projection_type": "brown", "focal_x": 0.5, "focal_y": 0.5, "width": 400, "height": 200}},
    "shots": {
      "a.jpg": {"camera": "v2 c", "rotation": [3.141592653589793, 0, 0], "translation": [58.0315, -47.4984, 40], "gps_position": [-60, -45, 40]},
      "b.jpg": {"camera": "v2 c", "rotation": [3.141592653589793, 0, 0], "translation": [-63.8877, -43.3249, 40], "gps_position": [62, -46, 40]},
      "c.jpg": {"camera": "v2 c", "rotation": [3.141592653589793, 0, 0], "translation": [-55.9487, 49.4116, 42], "gps_position": [58, 47, 42]}},
    "reference_lla": {"latitude": 60.20000079741062, "longitude": 17.80000682720282, "altitude": 0}}]"#;
    let coords = (COORDS.0, "WGS84 UTM 33N\n655203 6676977\n");
    let dir = project(&[CAMERAS, (SPARSE.0, shots), coords, CLOUD]);
    let told = read_folder(dir.path()).unwrap();
    let center = told.reconstruction.photos[0].pose.center;
    let expected = DVec3::new(655_203.0 - 58.0315, 6_676_977.0 - 47.4984, 40.0);
    assert!((center - expected).length() < 1e-6, "{center}");
    assert!(told.surface.is_some());
    let [said] = &told.reconstruction.warnings[..] else {
        panic!("{:?}", told.reconstruction.warnings)
    };
    assert!(said.contains("EPSG:32633 less 655203 6676977"), "{said}");
    // Else the frames are not mixed.
    let dir = project(&[CAMERAS, SPARSE, TRACKS, COORDS, CLOUD]);
    let own = read_folder(dir.path()).unwrap();
    let center = own.reconstruction.photos[0].pose.center;
    assert!((center - DVec3::new(1.0, 2.0, 50.0)).length() < 1e-9);
    assert_eq!((own.surface, own.reconstruction.crs), (None, None));
    assert!(own.reconstruction.warnings[0].contains("own frame"));
}

#[test]
fn without_georeference_all_is_local() {
    let shots = SHOTS.1.replace("50000", "").replace("400000", "");
    let dir = project(&[CAMERAS, SPARSE, (SHOTS.0, &shots), TRACKS, CLOUD]);
    let project = read_folder(dir.path()).unwrap();
    assert!(project.surface.is_some());
    assert_eq!(project.reconstruction.crs, None);
    assert_eq!(
        project.reconstruction.cloud.points,
        [DVec3::new(1.0, 2.0, 40.0)]
    );
    assert_eq!(project.reconstruction.warnings, [""; 0]);
}

#[test]
fn an_alignment_turns_the_camera_axes() {
    // A quarter turn about z and 5 up; ODM writes the centres right and the rotations wrong.
    let matrix = "[[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 5], [0, 0, 0, 1]]";
    let alignment = ("odm_georeferencing/alignment_matrix.json", matrix);
    let shots = SHOTS
        .1
        .replace("500003, 4000004, 60", "-4000004, 500003, 65")
        .replace("500001, 4000002, 50", "-4000002, 500001, 55");
    let shots = (SHOTS.0, &*shots);
    let dir = project(&[CAMERAS, SPARSE, shots, COORDS, alignment]);
    let photo = &read_folder(dir.path()).unwrap().reconstruction.photos[0];
    assert!((photo.pose.center - DVec3::new(-4_000_002.0, 500_001.0, 55.0)).length() < 1e-9);
    let turned = DMat3::from_cols(DVec3::Y, DVec3::X, DVec3::NEG_Z);
    assert!(photo.pose.rotation.abs_diff_eq(turned, 1e-15));
    let dir = project(&[CAMERAS, shots, COORDS, alignment]);
    let error = read_folder(dir.path()).unwrap_err().to_string();
    assert!(
        error.contains("shots.geojson: the project was aligned"),
        "{error}"
    );
}

#[test]
fn what_only_adds_points_is_a_warning() {
    let link = (SPARSE.0, "../../../opensfm/reconstruction.json");
    let elsewhere = SPARSE.1.replace("50]", "51]");
    let broken = ("opensfm/tracks.csv", "a.jpg\t7");
    for (files, named) in [
        (vec![CAMERAS, SHOTS, link], "no sparse points"),
        (
            vec![CAMERAS, SHOTS, COORDS, (SPARSE.0, &*elsewhere)],
            "does not fit",
        ),
        (
            vec![CAMERAS, SHOTS, COORDS, SPARSE, broken],
            "no observations",
        ),
        (
            vec![CAMERAS, SHOTS, ("images.json", "[{}]")],
            "cannot be counted",
        ),
        (
            vec![CAMERAS, SHOTS, ("images.json", r#"[{"filename": "x"}]"#)],
            "1 of 1",
        ),
    ] {
        let dir = project(&files);
        let reconstruction = read_folder(dir.path()).unwrap().reconstruction;
        assert_eq!(reconstruction.photos.len(), 2);
        let [warning] = &reconstruction.warnings[..] else {
            panic!("{named}: {:?}", reconstruction.warnings);
        };
        assert!(warning.contains(named), "{warning}");
        assert!(reconstruction.observations.is_empty());
    }
}

#[test]
fn errors_name_the_file() {
    for (files, named) in [
        (vec![CAMERAS], "project without odm_report/shots.geojson"),
        (vec![SHOTS], "cameras.json: there is no such file"),
        (vec![CAMERAS, (SHOTS.0, "{")], "shots.geojson:1:"),
        (vec![CAMERAS, (SPARSE.0, "../x")], "reconstruction.json:1:"),
        (
            vec![("cameras.json", "{}"), SHOTS],
            "cameras.json: it holds no camera",
        ),
        (
            vec![
                CAMERAS,
                SHOTS,
                ("opensfm/geocoords_transformation.txt", "1 0"),
            ],
            "geocoords_transformation.txt: ",
        ),
    ] {
        let dir = project(&files);
        let error = read_folder(dir.path()).unwrap_err().to_string();
        assert!(error.contains(named), "{error}");
    }
    assert!(!is_odm_folder(Path::new("src")));
}

#[test]
fn truncated_anywhere_it_does_not_panic() {
    let files = [CAMERAS, SPARSE, SHOTS, TRACKS, COORDS, LIST];
    let dir = project(&files);
    for (name, content) in files {
        for cut in 0..content.len() {
            fs::write(dir.path().join(name), &content[..cut]).unwrap();
            let _ = read_folder(dir.path());
        }
        fs::write(dir.path().join(name), content).unwrap();
    }
}

#[test]
fn brighton_is_read_whole() {
    let Some(dir) = shared_data("odm-brighton-0") else {
        return;
    };
    let project = read_folder(&dir).unwrap();
    let listed = ["27", "19", "30", "29", "20", "18", "28"].map(|n| format!("DJI_00{n}.JPG"));
    assert_eq!(names(&project), listed);
    assert_eq!(
        project.surface,
        Some(dir.join("odm_georeferencing/odm_georeferenced_model.laz"))
    );
    assert_eq!(project.photos, Some(dir.join("images")));
    let reconstruction = project.reconstruction;
    assert_eq!(reconstruction.crs.as_deref(), Some("EPSG:32615"));
    let [camera] = &reconstruction.cameras[..] else {
        panic!("one camera")
    };
    assert_eq!(camera.name, "dji fc300s 400 225 brown 0.5555 rgb");
    assert_eq!((camera.width, camera.height), (400, 225));
    assert_eq!(camera.fx, 0.555_544_371_882_769_7 * 400.0);
    assert_eq!(reconstruction.warnings, [""; 0]);
    assert_eq!(reconstruction.cloud.points.len(), 837);
    // UTM shortens horizontal lengths here by 0.033 % and heights not at all, so what fits to
    // 0.102 px in OpenSfM's own frame, which is reported, fits a little less well in the world.
    assert_eq!(reconstruction.observations.len(), 2141);
    let median = reconstruction.median_reprojection_px().unwrap();
    let json = fs::read(dir.join("opensfm/reconstruction.json")).unwrap();
    let mut own = OpenSfm::read(&json).unwrap();
    let tracks = fs::read_to_string(dir.join("opensfm/tracks.csv")).unwrap();
    own.add_observations(&tracks).unwrap();
    let own = own.reconstruction.median_reprojection_px().unwrap();
    assert!((own - 0.102).abs() < 5e-4, "{own}");
    assert_eq!(median, own);
    let bent = Reconstruction {
        solved_reprojection_px: None,
        ..reconstruction
    };
    let bent = bent.median_reprojection_px().unwrap();
    assert!((bent - 0.110).abs() < 5e-4, "{bent}");
}

/// Both sources of poses, the second through the 4x4 matrix.
#[test]
fn brighton_is_the_same_without_shots() {
    let Some(data) = shared_data("odm-brighton-0") else {
        return;
    };
    let dir = TempDir::new().unwrap();
    for folder in ["opensfm", "odm_georeferencing"] {
        fs::create_dir(dir.path().join(folder)).unwrap();
    }
    for file in [
        "opensfm/reconstruction.json",
        "opensfm/tracks.csv",
        "opensfm/geocoords_transformation.txt",
        "odm_georeferencing/proj.txt",
    ] {
        fs::copy(data.join(file), dir.path().join(file)).unwrap();
    }
    let with = read_folder(&data).unwrap().reconstruction;
    let without = read_folder(dir.path()).unwrap().reconstruction;
    let (mut off, mut turned) = (0.0_f64, 0.0_f64);
    for (a, b) in with.photos.iter().zip(&without.photos) {
        assert_eq!(a.name, b.name);
        off = off.max(a.pose.center.distance(b.pose.center));
        let gap = (a.pose.rotation - b.pose.rotation).to_cols_array();
        turned = gap.into_iter().fold(turned, |worst, d| worst.max(d.abs()));
    }
    assert!(off < 1e-6 && turned < 1e-6, "{off} {turned}");
    assert_eq!(with.photos.len(), without.photos.len());
    assert_eq!(with.cloud, without.cloud);
    assert_eq!(
        without.cameras[0].name,
        "v2 dji fc300s 400 225 brown 0.5555 rgb"
    );
    assert_eq!((with.crs, without.warnings), (without.crs, Vec::new()));
}

#[test]
fn sparse_points_stand_in_and_the_places_are_said() {
    let dir = project(&[CAMERAS, SPARSE, SHOTS, COORDS]);
    let found = read_folder(dir.path()).unwrap();
    assert!(found.surface.is_none() && found.surface_note.unwrap().contains("odm_dem/dsm.tif"));
}

/// The photos are named in another order, and the world is turned by a quarter about z against
/// OpenSfM's frame; the cameras' own axes are not.
#[test]
fn what_opensfm_states_of_its_errors_follows_the_photos() {
    let covariance = "[[1e-6,0,0,0,0,0],[0,4e-6,0,0,0,0],[0,0,9e-6,0,0,0],[0,0,0,1,0,0],\
                      [0,0,0,0,4,0],[0,0,0,0,0,9]]";
    let sparse = SPARSE.1.replace(
        "\"translation\": [-1, 2, 50]",
        &format!("\"translation\": [-1, 2, 50], \"covariance\": {covariance}"),
    );
    // Half a turn about x, then a quarter about z: about (1, 1, 0), or (1, -1, 0) for the inverse.
    let half = std::f64::consts::PI / 2.0_f64.sqrt();
    let shots = SHOTS.1.replacen(
        "\"translation\": [500001, 4000002, 50], \"rotation\": [3.141592653589793, 0, 0]",
        &format!("\"translation\": [500001, 4000002, 50], \"rotation\": [{half}, {half}, 0]"),
        1,
    );
    let dir = project(&[CAMERAS, (SPARSE.0, &sparse), (SHOTS.0, &shots), COORDS]);
    let found = read_folder(dir.path()).unwrap().reconstruction;
    assert_eq!(found.pose_errors[0], PoseCovariance::default());
    let errors = found.pose_errors[1].errors();
    let position = errors.position.unwrap();
    assert!(
        (position - DVec3::new(2.0, 1.0, 3.0)).length() < 1e-12,
        "{position}"
    );
    // The right Jacobian at half a turn about x: 1 along x, and 2/pi between y and z, mixed.
    let about_x = errors.angle.unwrap().x.to_radians();
    assert!((about_x - 1e-3).abs() < 1e-12, "{about_x}");
    assert_eq!(found.errors.world_scale, None);
}

/// Three centres 10 m apart on a line along east: S = 200 m2, so sqrt(9/2 · 0.02² / 200) = 0.3 %.
#[test]
fn statistics_say_how_sure_the_scale_is() {
    let shot = |name: &str, x: f64| {
        format!(
            r#"{{"properties": {{"filename": "{name}", "camera": "c", "focal": 0.5, "width": 400, "height": 200,
                "translation": [{x}, 4000000, 60], "rotation": [3.141592653589793, 0, 0]}}}}"#
        )
    };
    let shots = [
        shot("a", 500_000.0),
        shot("b", 500_010.0),
        shot("c", 500_020.0),
    ]
    .join(", ");
    let shots = format!("{{\"features\": [{shots}]}}");
    let stats = r#"{"reconstruction_statistics": {"has_gps": true, "has_gcp": false},
        "gps_errors": {"std": {"x": 0.02, "y": 7, "z": 9}}, "odm_processing_statistics": {}}"#;
    let stats = ("odm_report/stats.json", stats);
    let dir = project(&[CAMERAS, (SHOTS.0, &shots), COORDS, stats]);
    let found = read_folder(dir.path()).unwrap().reconstruction;
    let percent = found.errors.world_scale.unwrap();
    assert!((percent - 0.3).abs() < 1e-9, "{percent}");
    // Of a frame of its own it says nothing.
    let dir = project(&[CAMERAS, (SHOTS.0, &shots), stats]);
    let found = read_folder(dir.path()).unwrap().reconstruction;
    assert_eq!(found.errors, StatedErrors::default());
}
