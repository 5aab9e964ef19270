//! Meshes that look away from their photos: turned over, or inside out.

use std::fs;
use std::path::Path;

use glam::{DMat3, DVec3};

use crate::camera::Pose;
use crate::flight::{Doubt, Limits};
use crate::jobs::Progress;
use crate::{HealthItem, OpenOptions, Opened, StatedOfFlight, flight_health, open_flight};

/// Hills over a floor of 40 by 40, z up.
fn hills(x: f64, y: f64) -> f64 {
    1.5 + (0.9 * x).sin() * (0.7 * y).cos() + 0.1 * x
}

/// As a mesh in a frame of that way, with faces that look up or down.
fn mesh(from_z_up: DMat3, is_up: bool) -> String {
    let points = (0..41).flat_map(|i| (0..41).map(move |j| (f64::from(i), f64::from(j))));
    let mut text = String::new();
    for (x, y) in points {
        let point = from_z_up * DVec3::new(x, y, hills(x, y));
        text += &format!("v {} {} {}\n", point.x, point.y, point.z);
    }
    for i in 0..40 {
        for j in 1..41 {
            let at = 41 * i + j;
            let quad = [at, at + 41, at + 42, at + 1];
            for [a, b, c] in [[0, 1, 2], [0, 2, 3]].map(|of| of.map(|corner: usize| quad[corner])) {
                text += &match is_up {
                    true => format!("f {a} {b} {c}\n"),
                    false => format!("f {a} {c} {b}\n"),
                };
            }
        }
    }
    text
}

/// Three photos from 25 above, z up.
fn poses() -> [Pose; 3] {
    [(16.0, 75.0), (20.0, 90.0), (24.0, 80.0)]
        .map(|(x, tilt)| Pose::from_tilt_pan(DVec3::new(x, 20.0, 25.0), [tilt, 10.0]))
}

/// Meshroom's scene of them in such a frame, with points or without.
fn scene(from_z_up: DMat3, has_points: bool) -> String {
    let mut views = String::new();
    let mut all = String::new();
    for (index, pose) in poses().iter().enumerate() {
        let comma = if index == 0 { "" } else { "," };
        views += &format!(
            r#"{comma}{{"viewId":"{index}","poseId":"{index}","intrinsicId":"7","path":"/p/{index}.jpg","width":"400","height":"300"}}"#
        );
        // Eigen's camera from world in columns is the world from the camera in rows.
        let rotation = (from_z_up * pose.rotation).transpose().to_cols_array();
        let rotation = rotation.map(|value| format!("\"{value}\"")).join(",");
        let center = from_z_up * pose.center;
        all += &format!(
            r#"{comma}{{"poseId":"{index}","pose":{{"transform":{{"rotation":[{rotation}],"center":["{}","{}","{}"]}}}}}}"#,
            center.x, center.y, center.z
        );
    }
    let points: Vec<String> = (0..if has_points { 400 } else { 0 })
        .map(|place| {
            let (x, y) = (
                f64::from(place % 20) * 1.9 + 1.2,
                f64::from(place / 20) * 1.9 + 1.3,
            );
            let point = from_z_up * DVec3::new(x, y, hills(x, y));
            format!(
                r#"{{"X":["{}","{}","{}"],"color":["9","9","9"],"observations":[]}}"#,
                point.x, point.y, point.z
            )
        })
        .collect();
    format!(
        r#"{{"version":["1","2","6"],"views":[{views}],"poses":[{all}],"structure":[{}],
        "intrinsics":[{{"intrinsicId":"7","width":"400","height":"300","sensorWidth":"36","sensorHeight":"24","type":"pinhole",
        "focalLength":"36","pixelRatio":"1","principalPoint":["0","0"],"distortionType":"none"}}]}}"#,
        points.join(",")
    )
}

fn opened(folder: &Path, mesh: &str, scene: &str) -> Opened {
    fs::write(folder.join("mesh.obj"), mesh).unwrap();
    fs::write(folder.join("cameras.sfm"), scene).unwrap();
    let flight = "format = 1\nworld.unit = \"m\"\nsurface.file = \"mesh.obj\"\nphotos.reconstruction = \"cameras.sfm\"\n";
    fs::write(folder.join("flight.toml"), flight).unwrap();
    open_flight(folder, &OpenOptions::default(), &Progress::default()).unwrap()
}

/// Top and bottom of each photo's line, and whether it is seen from behind.
fn scales(opened: &Opened) -> Vec<([f64; 2], bool)> {
    let review = opened
        .review(&Limits::default(), &Progress::default())
        .unwrap();
    let unit = opened.flight.parts().unit;
    let of = |photo: crate::flight::PhotoReview<'_>| {
        let Some(fitted) = photo.fitted(unit) else {
            panic!("{:?}", photo.reasons());
        };
        (
            [fitted.top, fitted.bottom],
            photo.doubts.contains(&Doubt::FromBehind),
        )
    };
    review.photos().map(of).collect()
}

fn turned() -> DMat3 {
    DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0))
}

/// Meshroom's scenes have y down and the ground at y = 0; its meshes were as the scene before 2023, and are turned by 180
/// degrees about x since. Both give the scales that the same hills give with z up, with points to go by or without.
#[test]
fn meshes_of_meshroom_before_2023_and_since() {
    let folder = tempfile::tempdir().unwrap();
    let upright = opened(
        folder.path(),
        &mesh(DMat3::IDENTITY, true),
        &scene(DMat3::IDENTITY, true),
    );
    let expected = scales(&upright);
    let scenes_frame = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);
    for has_points in [true, false] {
        for (is_turned, frame) in [(false, scenes_frame), (true, turned() * scenes_frame)] {
            let scene = scene(scenes_frame, has_points);
            let found = opened(folder.path(), &mesh(frame, true), &scene);
            for (found, expected) in scales(&found).iter().zip(&expected) {
                let off = |end: usize| (found.0[end] / expected.0[end] - 1.0).abs();
                assert!(off(0).max(off(1)) < 1e-6, "{found:?} {expected:?}");
                assert!(!found.1);
            }
            let said = |what: &str| found.warnings.iter().any(|said| said.contains(what));
            assert_eq!(
                said("it was turned back"),
                is_turned,
                "{:?}",
                found.warnings
            );
            assert!(!said("--up y"), "{:?}", found.warnings);
        }
    }
    // Points know better than faces: that mesh is inside out, where it is.
    let scene = scene(scenes_frame, true);
    let inside_out = opened(folder.path(), &mesh(scenes_frame, false), &scene);
    let found = scales(&inside_out);
    assert!((found[0].0[0] / expected[0].0[0] - 1.0).abs() < 1e-6);
    assert!(found.iter().all(|found| found.1));
}

/// Of other packages nobody turns anything: who sees a mesh's back is told.
#[test]
fn the_back_of_a_mesh_is_doubted() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut list = "photo,x,y,z,tilt,pan\n".to_owned();
    for (index, pose) in poses().iter().enumerate() {
        let (x, tilt) = (pose.center.x, [75.0, 90.0, 80.0][index]);
        list += &format!("{index}.jpg,{x},20,25,{tilt},10\n");
    }
    fs::write(folder.join("poses.csv"), list).unwrap();
    let flight = "format = 1\nworld.unit = \"m\"\nsurface.file = \"mesh.obj\"\nphotos.poses = \"poses.csv\"\n\
                  [[camera]]\nwidth = 400\nheight = 300\nfx = 400\nfy = 400\ncx = 200\ncy = 150\n";
    fs::write(folder.join("flight.toml"), flight).unwrap();
    for is_up in [true, false] {
        fs::write(folder.join("mesh.obj"), mesh(DMat3::IDENTITY, is_up)).unwrap();
        let opened = open_flight(folder, &OpenOptions::default(), &Progress::default()).unwrap();
        assert!(scales(&opened).iter().all(|found| found.1 != is_up));
        let said = opened.all_warnings();
        let is_said = said.iter().any(|said| {
            said.contains("3 of 3 photos (0.jpg, 1.jpg, 2.jpg) were taken from behind")
        });
        assert_eq!(is_said, !is_up, "{said:?}");
        let review = opened
            .review(&Limits::default(), &Progress::default())
            .unwrap();
        let health = flight_health(&review, &StatedOfFlight::default());
        let up = health
            .iter()
            .find(|found| found.item == HealthItem::UpAxis)
            .unwrap();
        assert_eq!(up.short, if is_up { "z" } else { "?" });
    }
}
