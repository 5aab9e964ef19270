//! Which topic's poses a flight takes, of several.

use std::fs;
use std::path::{Path, PathBuf};

use glam::DVec3;

use super::writing::{Entry, Out, Style, bag};
use super::{
    camera_info, close, entry, expected, image, mount, moves, of_bag, pose_stamped, turned,
};
use crate::OpenOptions;
use crate::Opened;
use crate::camera::Pose;
use crate::fault::Fault;
use crate::info;
use crate::jobs::Progress;
use crate::open_flight;
use crate::packages::reconstruction::Reconstruction;

const STYLE: Style = Style::Ros1;

/// The flight of `expected`, `off` metres beside it along the world's y.
fn odometry(topic: &'static str, ms: u32, frames: [&str; 2], off: f64) -> Entry {
    let t = f64::from(ms) / 1000.0;
    let [parent, child] = frames;
    let out = Out::new(STYLE).header(ms, parent).text(child);
    let out = turned(out, [1000.0 + 2.0 * t, 2000.0 + off, 0.0], 100.0 * t);
    entry(topic, "nav_msgs/Odometry", out.f64s(&[0.0; 78]))
}

fn every(step: usize, to: u32, of: impl Fn(u32) -> Entry) -> Vec<Entry> {
    (0..=to).step_by(step).map(of).collect()
}

const BASE: [&str; 2] = ["map", "base_link"];

/// Two estimates of the base: /slow of 3 poses 0.5 m off and /fast of 9, of images at 0.2 and 0.6 s.
fn two() -> Vec<Entry> {
    let mut entries = vec![mount(STYLE), camera_info(STYLE)];
    entries.extend(every(400, 800, |ms| odometry("/slow", ms, BASE, 0.5)));
    entries.extend(every(100, 800, |ms| odometry("/fast", ms, BASE, 0.0)));
    entries.extend([image(STYLE, 200), image(STYLE, 600)]);
    entries
}

fn flown(entries: &[Entry], topic: Option<&str>) -> Result<Reconstruction, Fault> {
    of_bag(&bag(entries, "none"))
        .unwrap()
        .reconstruction_by(topic)
}

fn beside(t: f64, off: f64) -> Pose {
    let pose = expected(t);
    Pose {
        center: pose.center + DVec3::new(0.0, off, 0.0),
        ..pose
    }
}

#[track_caller]
fn assert_flies(found: &Reconstruction, off: f64) {
    assert_eq!(found.photos.len(), 2);
    for (photo, t) in found.photos.iter().zip([0.2, 0.6]) {
        assert!(close(&photo.pose, &beside(t, off)), "{photo:?}");
    }
}

#[test]
fn the_densest_topic_that_leads_to_the_camera_is_taken_and_named() {
    let found = flown(&two(), None).unwrap();
    assert_flies(&found, 0.0);
    assert_eq!(
        found.warnings,
        [
            "the camera's poses are those of /fast (9 while the images were taken, the most; /slow has 3 and is up to 0.500 m and 0.00 degrees from it); --topic, or topic in flight.toml's [photos], takes another"
        ]
    );
    // Denser, and of something else: what does not lead to the camera is not taken.
    let mut entries = two();
    entries.extend(every(20, 800, |ms| {
        odometry("/wheels", ms, ["odom", "wheel"], 7.0)
    }));
    let found = flown(&entries, None).unwrap();
    assert_flies(&found, 0.0);
    assert!(
        found.warnings[0].contains("from it); /wheels does not lead to the camera"),
        "{:?}",
        found.warnings
    );
    // Two topics do not change that; what changes its frames leads nowhere.
    entries.push(odometry("/wheels", 900, BASE, 7.0));
    entries.push(pose_stamped("/goal", 100));
    let found = flown(&entries, None).unwrap();
    assert_flies(&found, 0.0);
    assert!(
        found.warnings[0].contains("; /wheels, /goal do not lead to the camera"),
        "{:?}",
        found.warnings
    );
}

/// Only what surrounds the images counts: many poses from before them are of no use.
#[test]
fn poses_from_before_the_images_do_not_count() {
    let mut entries = vec![mount(STYLE), camera_info(STYLE)];
    entries.extend(every(50, 4000, |ms| odometry("/early", ms, BASE, 7.0)));
    entries.extend(
        (9800..=10_200)
            .step_by(200)
            .map(|ms| odometry("/late", ms, BASE, 0.0)),
    );
    entries.push(image(STYLE, 10_100));
    let found = flown(&entries, None).unwrap();
    assert!(close(&found.photos[0].pose, &expected(10.1)));
    assert!(
        found.warnings[0].contains(
            "/late (3 while the images were taken, the most; /early has 0 and none at an image)"
        ),
        "{:?}",
        found.warnings
    );
}

#[test]
fn tf_is_one_of_them() {
    // The base in odom three times, odom in the map as often.
    let mut entries = vec![mount(STYLE), camera_info(STYLE)];
    entries.extend(moves(STYLE));
    entries.extend([image(STYLE, 200), image(STYLE, 600)]);
    let only_tf = entries.clone();
    assert_flies(&flown(&only_tf, None).unwrap(), 0.0);
    assert_eq!(flown(&only_tf, None).unwrap().warnings, [""; 0]);
    // As many in a topic: tf, which leads further up.
    entries.extend(every(400, 800, |ms| {
        odometry("/odom", ms, ["odom", "base_link"], 0.5)
    }));
    let equal = flown(&entries, None).unwrap();
    assert_flies(&equal, 0.0);
    assert!(
        equal.warnings[0].contains("those of /tf (3 while the images were taken, the most; /odom has 3 in 'odom' instead of 'map')"),
        "{:?}",
        equal.warnings
    );
    // More in the topic: the topic, in its own frame.
    entries.push(odometry("/odom", 200, ["odom", "base_link"], 0.5));
    let denser = flown(&entries, None).unwrap();
    assert_flies(&denser, 0.5);
    assert!(
        denser.warnings[0].contains("those of /odom (4 while"),
        "{:?}",
        denser.warnings
    );
    assert_flies(&flown(&entries, Some("/tf")).unwrap(), 0.0);
}

#[test]
fn a_topic_is_chosen_by_its_name() {
    for name in ["/slow", "slow"] {
        let found = flown(&two(), Some(name)).unwrap();
        assert_flies(&found, 0.5);
        assert_eq!(found.warnings, [""; 0]);
    }
    // One that does not say what moves, beside others.
    let mut entries = two();
    entries.extend(every(400, 800, |ms| pose_stamped("/pose", ms)));
    let found = flown(&entries, Some("pose")).unwrap();
    assert_flies(&found, 0.0);
    assert_eq!(
        found.warnings,
        [
            "/pose does not say what moves: it is taken for the frame 'base_link', which carries the camera"
        ]
    );
    entries.push(odometry("/wheels", 0, ["odom", "wheel"], 7.0));
    entries.push(odometry("/mixed", 0, ["odom", "wheel"], 7.0));
    entries.push(odometry("/mixed", 0, BASE, 7.0));
    let there = "those that do are /slow (3 messages), /fast (9 messages), /pose (3 messages), /wheels (1 messages), /mixed (2 messages)";
    for (name, what) in [
        ("/nothing", "there is no topic '/nothing' that gives poses"),
        (
            "/cam/image_raw",
            "the topic '/cam/image_raw' (sensor_msgs/Image) gives no poses",
        ),
        (
            "/wheels",
            "the topic '/wheels' gives the poses of 'wheel', which does not carry the camera's frame 'cam_optical'",
        ),
        (
            "/mixed",
            "the topic '/mixed' gives poses of changing frames",
        ),
    ] {
        let fault = flown(&entries, Some(name)).unwrap_err();
        assert_eq!(fault.what, format!("{what}; {there}"));
    }
    let none = flown(
        &[mount(STYLE), camera_info(STYLE), image(STYLE, 1)],
        Some("x"),
    );
    assert!(none.unwrap_err().what.ends_with("; no topic does"));
}

/// A folder with the recording, a surface and what else is written there.
fn folder(files: &[(&str, &str)]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    write("a.bag", &bag(&two(), "none"));
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
        assert!(close(&photo.pose, &beside(t, off)), "{photo:?}");
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
    // Without a camera in the recording, the choice says what the camera is.
    let mut entries = two();
    entries.retain(|entry| entry.topic == "/slow" || entry.topic == "/fast");
    let recording = of_bag(&bag(&entries, "none")).unwrap();
    let files = ["1700000000.2.png".to_owned()];
    let fault = recording.pose_files(&files, None).unwrap_err();
    assert!(
        fault.what.starts_with("no frame is named as the camera's"),
        "{fault}"
    );
    let posed = recording.pose_files(&files, Some("slow")).unwrap();
    assert!((posed.photos[0].1.center - DVec3::new(1000.4, 2000.5, 0.0)).length() < 1e-12);
    assert!(
        posed.warnings[0].contains("taken for the camera itself"),
        "{:?}",
        posed.warnings
    );
}
