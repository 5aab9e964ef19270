//! Small files, what joins them, what is refused, and a real one.

use fragscale_test_data::shared_data;
use glam::DVec2;
use proptest::prelude::*;

use super::*;

const SMALL: &str = r#"[
    {"cameras": {"v2 c": {"focal": 0.5, "width": 400, "height": 200}},
     "shots": {
        "z.jpg": {"camera": "v2 c", "rotation": [3.141592653589793, 0, 0], "translation": [1, 2, 3]},
        "a.jpg": {"camera": "v2 c", "rotation": [0, 0, 0], "orientation": 6, "gps_dop": 1e9}},
     "points": {
        "7": {"coordinates": [-1, 2, -7], "color": [255.0, 300, -1]},
        "3": {"coordinates": [-1, 0, 1], "color": [1.6, 2, 3]}},
     "rig_cameras": {}, "reference_lla": {"latitude": 1}},
    {"shots": {"b.jpg": {"camera": "bad"}}, "cameras": {"bad": {"projection_type": "dual"}}}
]"#;

#[test]
fn poses_points_and_order_of_a_small_file() {
    let reconstruction = read(SMALL.as_bytes()).unwrap();
    let names: Vec<_> = reconstruction.photos.iter().map(|p| &*p.name).collect();
    assert_eq!(names, ["z.jpg", "a.jpg"]);
    // Half a turn about x: looks down. t = (1, 2, 3) = -R r, so r = (-1, 2, 3).
    let pose = reconstruction.photos[0].pose;
    assert!((pose.rotation.z_axis - DVec3::NEG_Z).length() < 1e-15);
    assert!((pose.center - DVec3::new(-1.0, 2.0, 3.0)).length() < 1e-15);
    assert_eq!(reconstruction.photos[1].pose.center, DVec3::ZERO);
    assert_eq!(reconstruction.cloud.points[0], DVec3::new(-1.0, 2.0, -7.0));
    assert_eq!(reconstruction.cloud.colors, [[255, 255, 0], [2, 2, 3]]);
    assert_eq!(reconstruction.package, "opensfm");
    assert!(reconstruction.sizes.are_known() && reconstruction.crs.is_none());
    assert_eq!(
        reconstruction.warnings.len(),
        2,
        "{:?}",
        reconstruction.warnings
    );
    assert!(reconstruction.warnings[0].contains("1 more reconstructions with 1 photos"));
}

#[test]
fn tracks_join_by_the_points_names() {
    let mut file = OpenSfm::read(SMALL.as_bytes()).unwrap();
    // Point 7 lies 10 below the camera z.jpg, on its axis; the others are not there.
    let tracks = "OPENSFM_TRACKS_VERSION_v1\n\
                  z.jpg\t7\t5\t0.0\t0.005\t0.01\t1\t2\t3\n\
                  z.jpg\t8\t5\t0.0\t0.0\t0.01\t1\t2\t3\n\
                  b.jpg\t7\t5\t0.0\t0.0\t0.01\t1\t2\t3\n";
    file.add_observations(tracks).unwrap();
    let [seen] = file.reconstruction.observations[..] else {
        panic!("one observation");
    };
    assert_eq!(
        (seen.photo, seen.point, seen.pixel),
        (0, 0, DVec2::new(200.0, 102.0))
    );
    let off = file.reconstruction.median_reprojection_px().unwrap();
    assert!((off - 2.0).abs() < 1e-12);
}

#[test]
fn what_is_wrong_is_named() {
    let with = |from: &str, to: &str| {
        assert!(SMALL.contains(from), "{from}");
        read(SMALL.replacen(from, to, 1).as_bytes())
    };
    for (from, to, named) in [
        (
            "\"v2 c\", \"rotation\": [0",
            "\"x\", \"rotation\": [0",
            "shot \"a.jpg\" names the camera \"x\"",
        ),
        ("[0, 0, 0]", "[0, 0]", "invalid length 2"),
        ("[0, 0, 0]", "[0, 0, NaN]", "expected value"),
        ("[0, 0, 0]", "[0, 1e308, 1e308]", "shot \"a.jpg\""),
        ("\"shots\"", "\"shot\"", "missing field `shots`"),
        ("\"a.jpg\"", "\"z.jpg\"", "\"z.jpg\" stands twice"),
        (
            "\"focal\": 0.5",
            "\"k1\": 0.5",
            "camera \"v2 c\" (perspective) has no `focal`",
        ),
        ("[-1, 0, 1]", "null", "invalid type: null"),
    ] {
        let fault = with(from, to).unwrap_err();
        assert!(fault.what.contains(named), "{to}: {fault}");
    }
    assert!(read(b"[]").is_err());
    assert!(
        read(b"{}")
            .unwrap_err()
            .what
            .contains("a list of reconstructions")
    );
    assert!(read(br#"[{"cameras": {}, "shots": {}}]"#).is_err());
    assert_eq!(
        with("[0, 0, 0]", "[0, \"0\", 0]").unwrap_err().line,
        Some(5)
    );
}

#[test]
fn colours_need_all_points() {
    let json = SMALL.replace(", \"color\": [1.6, 2, 3]", "");
    let reconstruction = read(json.as_bytes()).unwrap();
    assert_eq!(reconstruction.cloud.points.len(), 2);
    assert!(reconstruction.cloud.colors.is_empty());
}

#[test]
fn truncated_anywhere_it_is_an_error() {
    let end = SMALL.trim_end().len();
    for cut in 0..end {
        assert!(read(&SMALL.as_bytes()[..cut]).is_err(), "cut at {cut}");
    }
}

proptest! {
    #[test]
    fn damaged_files_never_panic(edits in prop::collection::vec((0_usize..2000, any::<u8>()), 1..6)) {
        let mut json = SMALL.as_bytes().to_vec();
        for (at, byte) in edits {
            let place = at % json.len();
            json[place] = byte;
        }
        let _ = read(&json);
    }
}

#[test]
fn berlin_reprojects() {
    let Some(folder) = shared_data("opensfm-berlin") else {
        return;
    };
    let json = std::fs::read(folder.join("reconstruction_example.json")).unwrap();
    let tracks = std::fs::read_to_string(folder.join("tracks_example.csv")).unwrap();
    let mut file = OpenSfm::read(&json).unwrap();
    file.add_observations(&tracks).unwrap();
    let reconstruction = file.reconstruction;
    let names: Vec<_> = reconstruction.photos.iter().map(|p| &*p.name).collect();
    assert_eq!(names, ["03.jpg", "01.jpg", "02.jpg"]);
    let camera = &reconstruction.cameras[0];
    assert_eq!(
        (camera.width, camera.height, camera.cx, camera.cy),
        (3264, 2448, 1632.0, 1224.0)
    );
    assert!((camera.fx - 0.869_665_848_485_535_9 * 3264.0).abs() < 1e-9);
    assert_eq!(reconstruction.cloud.points.len(), 1430);
    assert_eq!(reconstruction.cloud.colors.len(), 1430);
    assert_eq!(reconstruction.observations.len(), 3082);
    assert_eq!(reconstruction.warnings, [""; 0]);
    let median = reconstruction.median_reprojection_px().unwrap();
    assert!((median - 0.796).abs() < 5e-4, "{median}");
}
