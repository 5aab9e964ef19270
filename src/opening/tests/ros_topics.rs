//! Which topic's poses an opened flight takes, of several.

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;

use crate::jobs::Progress;
use crate::{OpenOptions, Opened, info, open_flight};
use fragscale_test_data::ros::{bag, expected, two};

/// A folder with the recording, a surface and what else is written there.
fn folder(files: &[(&str, &str)]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    write("a.bag", &bag(&two()));
    write(
        "pile.xyz",
        b"900 1900 -9\n1100 1900 -9\n1100 2100 -9\n900 2100 -9\n",
    );
    for (name, text) in files {
        write(name, text.as_bytes());
    }
    let path = folder.path().to_owned();
    (folder, path)
}

fn open(path: &Path, folder: &Path, topic: Option<&str>) -> Result<Opened, String> {
    let options = OpenOptions {
        surface: Some(folder.join("pile.xyz")),
        topic: topic.map(str::to_owned),
        ..OpenOptions::default()
    };
    open_flight(path, &options, &Progress::default()).map_err(|error| error.to_string())
}

#[track_caller]
fn assert_is(opened: &Opened, off: f64) {
    let photos = &opened.flight.parts().photos;
    assert_eq!(photos.len(), 2);
    for (photo, t) in photos.iter().zip([0.2, 0.6]) {
        let (rotation, center) = expected(t);
        let off_by = photo.pose.center - (center + DVec3::new(0.0, off, 0.0));
        assert!(off_by.length() < 1e-12, "{photo:?}");
        assert!(
            photo.pose.rotation.abs_diff_eq(rotation, 1e-14),
            "{photo:?}"
        );
    }
}

#[test]
fn the_command_line_and_the_flight_file_choose() {
    let whole = "format = 1\n[world]\nunit = \"m\"\n[photos]\nreconstruction = \"a.bag\"\n";
    let (_guard, there) = folder(&[
        ("plain.toml", whole),
        ("slow.toml", &format!("{whole}topic = \"/slow\"\n")),
        ("wrong.toml", &format!("{whole}topic = \"/slo\"\n")),
        ("empty.toml", &format!("{whole}topic = \"\"\n")),
    ]);
    let opened = |file: &str, topic| open(&there.join(file), &there, topic);
    assert_is(&opened("a.bag", None).unwrap(), 0.0);
    assert_is(&opened("a.bag", Some("/slow")).unwrap(), 0.5);
    let plain = opened("plain.toml", None).unwrap();
    assert_is(&plain, 0.0);
    let named = |w: &String| w.contains("a.bag: the camera's poses are those of /fast");
    assert!(plain.warnings.iter().any(named), "{:?}", plain.warnings);
    assert_is(&opened("slow.toml", None).unwrap(), 0.5);
    // The command line goes before the file.
    assert_is(&opened("slow.toml", Some("fast")).unwrap(), 0.0);
    let error = opened("wrong.toml", None).unwrap_err();
    assert!(
        error.contains("a.bag: there is no topic '/slo' that gives poses; those that do are /slow (3 messages), /fast (9 messages)"),
        "{error}"
    );
    let error = opened("empty.toml", None).unwrap_err();
    assert!(error.contains("6: photos.topic is empty"), "{error}");
    // The topics, for choosing one.
    let told = info(&there.join("a.bag"), &Progress::default()).unwrap();
    let topics = told["topics"].as_array().unwrap();
    let of_poses = topics.iter().filter(|topic| topic["gives_poses"] == true);
    let of_poses: Vec<_> = of_poses
        .map(|topic| (topic["name"].as_str().unwrap(), topic["messages"].as_u64()))
        .collect();
    assert_eq!(of_poses, [("/slow", Some(3)), ("/fast", Some(9))]);
}

#[test]
fn poses_of_photo_files_are_chosen_too() {
    let camera = "[[camera]]\nwidth = 8\nheight = 6\nfx = 10.0\nfy = 10.0\ncx = 4.0\ncy = 3.0\n";
    let text = format!(
        "format = 1\n[world]\nunit = \"m\"\n[surface]\nfile = \"pile.xyz\"\n{camera}[photos]\nposes = \"a.bag\"\nfolder = \"photos\"\n"
    );
    let (_guard, there) = folder(&[
        ("plain.toml", &text),
        ("slow.toml", &format!("{text}topic = \"/slow\"\n")),
        (
            "poses.csv",
            "photo,x,y,z,omega,phi,kappa\na.png,0,0,9,0,0,0\n",
        ),
        (
            "other.toml",
            &text
                .replace("a.bag", "poses.csv")
                .replace("folder", "topic = \"/slow\"\nfolder"),
        ),
    ]);
    fs::create_dir(there.join("photos")).unwrap();
    for name in ["1700000000.2.png", "1700000000.6.png"] {
        let file = there.join("photos").join(name);
        image::RgbImage::new(8, 6).save(file).unwrap();
    }
    let opened = |file: &str| open(&there.join(file), &there, None);
    assert_is(&opened("plain.toml").unwrap(), 0.0);
    assert_is(&opened("slow.toml").unwrap(), 0.5);
    // A topic of what is no recording.
    let what = "a topic ('/slow') is named, and this is no recording of ROS";
    let error = opened("other.toml").unwrap_err();
    assert!(error.contains(&format!("poses.csv: {what}")), "{error}");
    let colmap =
        fragscale_test_data::repository().join("tests/fixtures/colmap-text-points/sparse/0");
    let error = open(&colmap, &there, Some("/slow")).unwrap_err();
    assert!(error.contains(what), "{error}");
}
