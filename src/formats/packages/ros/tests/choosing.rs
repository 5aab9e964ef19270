//! Which topic's poses a flight takes, of several.

use glam::DVec3;

use super::{close, expected, moves, of_bag, pose_stamped};
use crate::camera::Pose;
use crate::fault::Fault;
use crate::packages::reconstruction::Reconstruction;
use fragscale_test_data::ros::{
    BASE, Entry, Style, bag, camera_info, every, image, mount, odometry, two,
};

const STYLE: Style = Style::Ros1;

fn flown(entries: &[Entry], topic: Option<&str>) -> Result<Reconstruction, Fault> {
    of_bag(&bag(entries)).unwrap().reconstruction_by(topic)
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

#[test]
fn without_a_camera_the_choice_says_what_it_is() {
    let mut entries = two();
    entries.retain(|entry| entry.topic == "/slow" || entry.topic == "/fast");
    let recording = of_bag(&bag(&entries)).unwrap();
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
