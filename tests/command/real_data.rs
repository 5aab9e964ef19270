//! Flights that other software wrote (shared data outside the repository). Where it is absent each
//! test says so and passes.

use std::fs;

use crate::common::{scale, scales_json, shared_data};
use fragscale::camera::Pose;
use fragscale::formats::read_project;
use fragscale::jobs::Progress;
use fragscale::opening::{OpenOptions, Opened, open_flight};
use glam::{DMat3, DQuat, DVec3};
use serde_json::Value;

fn edges(photo: &Value) -> [f64; 4] {
    ["top", "right", "bottom", "left"].map(|edge| scale(photo, edge).expect("a scale"))
}

/// OpenDroneMap solved Brighton on 400-pixel photos; its files have 4000. Its cloud ends inside
/// most footprints, so the ground matters: a plane at z = 0 gives 11 px/m instead of 60.
#[test]
fn brighton_opens_as_its_folder_stands() {
    let Some(folder) = shared_data("odm-brighton-0") else {
        return;
    };
    let report = scales_json(&folder, &["--unit", "m"]);
    let whole = folder.join("model_full_pierotofy.laz");
    let whole = scales_json(
        &folder,
        &["--unit", "m", "--surface", whole.to_str().expect("UTF-8")],
    );
    let photos = report["photos"].as_array().expect("photos");
    assert_eq!(photos.len(), 7);
    let mut within_3 = 0;
    for (photo, whole) in photos
        .iter()
        .zip(whole["photos"].as_array().expect("photos"))
    {
        assert_eq!(
            (&photo["width"], &photo["height"]),
            (&4000.into(), &2250.into())
        );
        for edge in ["top", "bottom"] {
            let scale_here = scale(photo, edge).expect("a scale");
            assert!(
                (55.0..66.0).contains(&scale_here),
                "{} {edge}: {scale_here}",
                photo["photo"]
            );
            let off = scale_here / scale(whole, edge).expect("a scale") - 1.0;
            assert!(off.abs() < 0.08, "{} {edge}: {off}", photo["photo"]);
            within_3 += u32::from(off.abs() < 0.03);
        }
    }
    assert!(within_3 >= 8, "only {within_3} of 14 within 3 %");
}

/// Saved as a flight.toml outside its folder, which may not be written to, it is the same flight.
#[test]
fn brighton_saved_as_a_flight_opens_again() {
    let Some(folder) = shared_data("odm-brighton-0") else {
        return;
    };
    let (options, progress) = (OpenOptions::default(), Progress::default());
    let opened = open_flight(&folder, &options, &progress).expect("a flight");
    let there = tempfile::tempdir().expect("a folder");
    let target = there.path().join("brighton.toml");
    let text = opened.origin.text_at(&target, &opened.settings);
    std::fs::write(&target, text.expect("a text")).expect("written");
    let saved = open_flight(&target, &options, &progress).expect("a flight");
    assert_eq!(saved.settings, opened.settings);
    assert_eq!(saved.flight.parts().photos, opened.flight.parts().photos);
    assert_eq!(
        saved.flight.scales(&progress),
        opened.flight.scales(&progress)
    );
    let files = |opened: &Opened| {
        let files = opened.photo_files.iter();
        files.filter(|file| file.path.is_some()).count()
    };
    assert_eq!(files(&saved), files(&opened));
}

/// The similarity that takes one reconstruction's photos to those of another of the same scene: the
/// rotation from the cameras' own rotations, scale and translation from their centres.
fn similarity(from: &[(String, Pose)], to: &[(String, Pose)]) -> [f64; 16] {
    let pairs: Vec<(Pose, Pose)> = from
        .iter()
        .map(|(name, pose)| {
            let same = to.iter().find(|(other, _)| name.ends_with(other.as_str()));
            (*pose, same.expect("the same photo").1)
        })
        .collect();
    let reference = DQuat::from_mat3(&(pairs[0].1.rotation * pairs[0].0.rotation.transpose()));
    let mean = pairs
        .iter()
        .fold(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), |sum, (a, b)| {
            let q = DQuat::from_mat3(&(b.rotation * a.rotation.transpose()));
            if q.dot(reference) < 0.0 {
                sum - q
            } else {
                sum + q
            }
        });
    let rotation = DMat3::from_quat(mean.normalize());
    let count = pairs.len() as f64;
    let center = |side: fn(&(Pose, Pose)) -> DVec3| pairs.iter().map(side).sum::<DVec3>() / count;
    let (a, b) = (center(|pair| pair.0.center), center(|pair| pair.1.center));
    let spread = |side: fn(&(Pose, Pose)) -> DVec3, middle: DVec3| {
        pairs
            .iter()
            .map(|pair| (side(pair) - middle).length_squared())
            .sum::<f64>()
            .sqrt()
    };
    let scale = spread(|pair| pair.1.center, b) / spread(|pair| pair.0.center, a);
    let linear = rotation * scale;
    let t = b - linear * a;
    let [x, y, z] = [linear.row(0), linear.row(1), linear.row(2)];
    [
        x.x, x.y, x.z, t.x, y.x, y.y, y.z, t.y, z.x, z.y, z.z, t.z, 0.0, 0.0, 0.0, 1.0,
    ]
}

/// One scene, solved by COLMAP and by VisualSFM: brought together by a similarity, the same photos
/// have the same scales on the same surface.
#[test]
fn colmap_and_visualsfm_agree_after_a_similarity() {
    let (Some(nvm), Some(colmap), Some(photos)) = (
        shared_data("sceaux-nvm/VisualSFM_example.nvm"),
        shared_data("sceaux-colmap/bin"),
        shared_data("sceaux-images"),
    ) else {
        return;
    };
    let read = |path| {
        let project = read_project(path, &Progress::default());
        project.expect("a reconstruction").reconstruction
    };
    let poses = |reconstruction: &fragscale::formats::Reconstruction| -> Vec<(String, Pose)> {
        let photos = reconstruction.photos.iter();
        photos
            .map(|photo| (photo.name.clone(), photo.pose))
            .collect()
    };
    let (from, to) = (read(&nvm), read(&colmap));
    let transform = similarity(&poses(&from), &poses(&to));

    // Both frames have COLMAP's axes, z into the scene: a plane across it, behind the castle's front.
    let folder = tempfile::tempdir().expect("a folder");
    let far = 40.0;
    let plane = format!("-{far} -{far} 10\n{far} -{far} 10\n{far} {far} 10\n-{far} {far} 10\n");
    fs::write(folder.path().join("plane.xyz"), plane).expect("written");
    let flight = |reconstruction: &str, transform: &str| {
        format!(
            "format = 1\n[world]\nunit = \"m\"\n[surface]\nfile = \"plane.xyz\"\n\
             [photos]\nreconstruction = '{reconstruction}'\nfolder = '{}'\n{transform}\n",
            photos.display()
        )
    };
    let path = folder.path().join("colmap.toml");
    fs::write(&path, flight(colmap.to_str().expect("UTF-8"), "")).expect("written");
    let of_colmap = scales_json(&path, &["--unit", "m"]);
    let path = folder.path().join("nvm.toml");
    let transform = format!("transform = {transform:?}");
    fs::write(&path, flight(nvm.to_str().expect("UTF-8"), &transform)).expect("written");
    let of_nvm = scales_json(&path, &["--unit", "m"]);

    let by_name = |report: &Value, name: &str| {
        let photos = report["photos"].as_array().expect("photos").iter();
        let found = photos
            .clone()
            .find(|p| p["photo"].as_str().is_some_and(|n| n.ends_with(name)));
        edges(found.expect("the photo"))
    };
    let mut compared = 0;
    for photo in of_colmap["photos"].as_array().expect("photos") {
        let name = photo["photo"].as_str().expect("a name");
        for (a, b) in edges(photo).into_iter().zip(by_name(&of_nvm, name)) {
            assert!((a / b - 1.0).abs() < 0.02, "{name}: {a} and {b}");
            compared += 1;
        }
    }
    assert_eq!(compared, 44);
}
