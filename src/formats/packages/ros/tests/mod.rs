//! A flight that was recorded, through every container; what is missing, doubtful or damaged.

mod choosing;
mod damaged;
mod writing;

use std::fs;
use std::path::Path;

use glam::{DMat3, DVec3};

use self::writing::{bag, db3, mcap};
use super::*;
use crate::Kind;
use crate::Package;
use crate::camera::{Brown, Distortion, Pose};
use crate::detect;
use crate::packages::reconstruction::Reconstruction;
use fragscale_test_data::ros::{
    D, Entry, Out, Style, camera_info, entry, image, image_of, mount, turned,
};
use fragscale_test_data::shared_data;

fn tf(style: Style, ms: u32, parent: &str, child: &str, center: [f64; 3], degrees: f64) -> Entry {
    let out = Out::new(style).u32(1).header(ms, parent).text(child);
    entry("/tf", "tf2_msgs/TFMessage", turned(out, center, degrees))
}

fn compressed(style: Style, ms: u32) -> Entry {
    let out = Out::new(style)
        .header(ms, "cam_optical")
        .text("jpeg")
        .u32(1)
        .byte(9);
    entry(
        "/cam/image_raw/compressed",
        "sensor_msgs/CompressedImage",
        out,
    )
}

fn fix(style: Style, ms: u32, latitude: f64) -> Entry {
    let out = Out::new(style).header(ms, "gps").byte(0).u16(1);
    let out = out.f64s(&[latitude, 16.5, 300.0]).f64s(&[0.0; 9]).byte(2);
    entry("/fix", "sensor_msgs/NavSatFix", out)
}

/// The base flies along x at 2 m/s and turns by 100 degrees a second; odom lies in the map.
fn moves(style: Style) -> Vec<Entry> {
    let mut entries = Vec::new();
    for ms in [0, 400, 800] {
        let t = f64::from(ms) / 1000.0;
        entries.push(tf(style, ms, "map", "odom", [1000.0, 2000.0, 0.0], 0.0));
        entries.push(tf(
            style,
            ms,
            "odom",
            "base_link",
            [2.0 * t, 0.0, 0.0],
            100.0 * t,
        ));
    }
    entries
}

fn flight(style: Style) -> Vec<Entry> {
    let mut entries = vec![
        mount(style),
        camera_info(style),
        fix(style, 0, 48.0),
        fix(style, 1000, 48.001),
    ];
    entries.extend(moves(style));
    entries.extend([
        image(style, 600),
        image(style, 100),
        image(style, 900),
        compressed(style, 100),
    ]);
    entries
}

fn of_bag(bytes: &[u8]) -> Result<Recording, Fault> {
    let mut recording = Recording::default();
    let warnings = bag::read(bytes, &mut |message| {
        recording.take(&message);
        Ok(())
    })?;
    recording.file_warnings = warnings;
    Ok(recording)
}

fn of_mcap(bytes: &[u8]) -> Result<Recording, Fault> {
    let mut recording = Recording::default();
    let warnings = mcap::read(bytes, &mut |message| {
        recording.take(&message);
        Ok(())
    })?;
    recording.file_warnings = warnings;
    Ok(recording)
}

/// What these messages are as a flight.
fn flown(entries: &[Entry]) -> Result<Reconstruction, Fault> {
    of_bag(&bag(entries, "none")).unwrap().reconstruction()
}

fn expected(t: f64) -> Pose {
    let (rotation, center) = fragscale_test_data::ros::expected(t);
    Pose { rotation, center }
}

fn close(found: &Pose, expected: &Pose) -> bool {
    found.rotation.abs_diff_eq(expected.rotation, 1e-14)
        && (found.center - expected.center).length() < 1e-12
}

fn check(flight: &Reconstruction) {
    assert_eq!(flight.package, "ros");
    assert_eq!(flight.unit, Some(crate::units::LengthUnit::Metre));
    let [camera] = &flight.cameras[..] else {
        panic!("{:?}", flight.cameras);
    };
    assert_eq!(
        (camera.name.as_str(), camera.width, camera.height),
        ("cam", 640, 480)
    );
    assert_eq!(
        (camera.fx, camera.fy, camera.cx, camera.cy),
        (500.0, 510.0, 320.0, 240.0)
    );
    let [k1, k2, p1, p2, k3] = D;
    assert_eq!(
        camera.distortion,
        Distortion::Brown(Brown::new([k1, k2, p1, p2, k3, 0.0, 0.0, 0.0]))
    );
    let names: Vec<&str> = flight
        .photos
        .iter()
        .map(|photo| photo.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "cam/image_raw/1700000000100000000",
            "cam/image_raw/1700000000600000000"
        ]
    );
    for (photo, t) in flight.photos.iter().zip([0.1, 0.6]) {
        assert!(close(&photo.pose, &expected(t)), "{photo:?}");
    }
    assert_eq!(
        flight.warnings,
        [
            "/cam/image_raw/compressed: the photos are those of /cam/image_raw, of the same camera",
            "1 of 3 images have no pose and are left out: 'cam/image_raw/1700000000900000000', for one: it is younger than the last pose (1700000000.8 s)",
        ]
    );
    let [first, second] = &flight.measured_positions[..] else {
        panic!("{:?}", flight.measured_positions);
    };
    assert_eq!(first.photo, names[0]);
    assert!((first.position.latitude - 48.0001).abs() < 1e-12);
    assert!((second.position.latitude - 48.0006).abs() < 1e-12);
    assert_eq!(
        (second.position.longitude, second.position.height),
        (16.5, 300.0)
    );
}

#[test]
fn one_flight_from_every_container() {
    let ros1 = flight(Style::Ros1);
    for compression in ["none", "bz2", "lz4"] {
        check(
            &of_bag(&bag(&ros1, compression))
                .unwrap()
                .reconstruction()
                .unwrap(),
        );
    }
    let options = ::mcap::WriteOptions::new;
    for style in [Style::Little, Style::Big] {
        let ros2 = flight(style);
        for options in [
            options().compression(None),
            options().compression(Some(::mcap::Compression::Lz4)),
            options()
                .compression(Some(::mcap::Compression::Zstd))
                .chunk_size(Some(300)),
            options().use_chunks(false),
        ] {
            check(
                &of_mcap(&mcap(&ros2, "cdr", options))
                    .unwrap()
                    .reconstruction()
                    .unwrap(),
            );
        }
    }
    check(
        &of_mcap(&mcap(&ros1, "ros1", options()))
            .unwrap()
            .reconstruction()
            .unwrap(),
    );
}

fn project(path: &Path) -> Result<Reconstruction, FileError> {
    crate::read_project(path, &Progress::default()).map(|project| project.reconstruction)
}

#[test]
fn files_and_folders_of_ros_2() {
    let folder = tempfile::tempdir().unwrap();
    let entries = flight(Style::Little);
    // What a URI would take for something else is in its name.
    let file = folder.path().join("a ?#%41é.db3");
    db3(&file, &entries, "cdr");
    assert_eq!(
        detect(&file),
        Ok(Kind::Reconstruction(Package::Ros, file.clone()))
    );
    check(&project(&file).unwrap());
    // Nothing was written beside it.
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    let mut packed = entries.clone();
    for entry in &mut packed {
        entry.data = zstd::encode_all(&entry.data[..], 3).unwrap();
    }
    let packed_file = folder.path().join("packed.db3");
    db3(&packed_file, &packed, "cdr");
    check(&project(&packed_file).unwrap());
    // A recording in several files, of which neither is a flight on its own.
    let split = folder.path().join("split");
    fs::create_dir(&split).unwrap();
    fs::write(
        split.join("metadata.yaml"),
        "rosbag2_bagfile_information:\n  version: 9\n",
    )
    .unwrap();
    let fault = project(&split).unwrap_err().to_string();
    assert!(
        fault.contains("metadata.yaml is all that is there"),
        "{fault}"
    );
    let (first, second) = entries.split_at(6);
    db3(&split.join("split_0.db3"), first, "cdr");
    fs::write(
        split.join("split_1.mcap"),
        mcap(second, "cdr", ::mcap::WriteOptions::new()),
    )
    .unwrap();
    assert_eq!(
        detect(&split),
        Ok(Kind::Reconstruction(Package::Ros, split.clone()))
    );
    check(&project(&split).unwrap());
    fs::write(split.join("split_2.mcap.zstd"), b"(\xb5/\xfd").unwrap();
    let fault = project(&split).unwrap_err().to_string();
    assert!(
        fault.contains("split_2.mcap.zstd: a recording that is compressed as a whole"),
        "{fault}"
    );
    // What a recorder that was cut off left beside the file is said.
    let mut log = file.clone().into_os_string();
    log.push("-wal");
    fs::write(log, b"rest").unwrap();
    let warnings = project(&file).unwrap().warnings;
    assert!(warnings[0].contains("-wal are not read"), "{warnings:?}");
}

fn odometry(topic: &'static str, ms: u32, child: &str) -> Entry {
    let t = f64::from(ms) / 1000.0;
    let out = Out::new(Style::Ros1).header(ms, "/map").text(child);
    let out = turned(out, [1000.0 + 2.0 * t, 2000.0, 0.0], 100.0 * t);
    entry(topic, "nav_msgs/Odometry", out.f64s(&[0.0; 78]))
}

fn pose_stamped(topic: &'static str, ms: u32) -> Entry {
    let t = f64::from(ms) / 1000.0;
    let out = Out::new(Style::Ros1).header(ms, "map");
    let out = turned(out, [1000.0 + 2.0 * t, 2000.0, 0.0], 100.0 * t);
    entry(topic, "geometry_msgs/PoseStamped", out)
}

#[test]
fn topics_of_poses_carry_the_camera_too() {
    let style = Style::Ros1;
    let seen = [mount(style), camera_info(style), image(style, 200)];
    let with = |more: &[Entry]| flown(&[&seen[..], more].concat());
    // Odometry names what moves; a topic that does not name it is no rival, and that is said.
    let named = with(&[
        odometry("/odom", 0, "base_link"),
        odometry("/odom", 400, "base_link"),
        pose_stamped("/goal", 0),
    ])
    .unwrap();
    assert!(close(&named.photos[0].pose, &expected(0.2)));
    assert_eq!(
        named.warnings,
        [
            "the camera's poses are those of /odom (2 while the images were taken); /goal does not lead to the camera; --topic, or topic in flight.toml's [photos], takes another"
        ]
    );
    // A lone PoseStamped is taken for what carries the camera.
    let lone = with(&[pose_stamped("/pose", 0), pose_stamped("/pose", 400)]).unwrap();
    assert!(close(&lone.photos[0].pose, &expected(0.2)));
    assert_eq!(
        lone.warnings,
        [
            "/pose does not say what moves: it is taken for the frame 'base_link', which carries the camera"
        ]
    );
    // Without tf, for the camera.
    let no_tf = flown(&[
        camera_info(style),
        image(style, 200),
        pose_stamped("/pose", 0),
        pose_stamped("/pose", 400),
    ])
    .unwrap();
    let at = no_tf.photos[0].pose;
    assert!((at.center - DVec3::new(1000.4, 2000.0, 0.0)).length() < 1e-12);
    assert!(
        at.rotation
            .abs_diff_eq(DMat3::from_rotation_z(20_f64.to_radians()), 1e-14)
    );
    assert!(
        no_tf.warnings[0].contains("taken for the camera itself"),
        "{:?}",
        no_tf.warnings
    );
    // Several that do not name what moves are not chosen between.
    let fault = |more: &[Entry]| with(more).unwrap_err().what;
    assert_eq!(
        fault(&[
            pose_stamped("/a", 0),
            pose_stamped("/b", 0),
            odometry("/odom", 0, "wheel")
        ]),
        "nothing leads from the camera's frame 'cam_optical' to the world: there are /a (something in 'map'), /b (something in 'map'), /odom ('wheel' in 'map')"
    );
    assert_eq!(
        fault(&[]),
        "nothing leads from the camera's frame 'cam_optical' to the world: there are no poses"
    );
    assert_eq!(
        fault(&[
            odometry("/odom", 0, "base_link"),
            odometry("/odom", 400, "other")
        ]),
        "nothing leads from the camera's frame 'cam_optical' to the world: there are /odom (of changing frames)"
    );
    // A gap of over half a second is not bridged.
    let gap = fault(&[
        odometry("/odom", 0, "base_link"),
        odometry("/odom", 600, "base_link"),
    ]);
    assert!(
        gap.starts_with("none of 1 images has a pose:") && gap.contains("0.6 s apart"),
        "{gap}"
    );
}

#[test]
fn only_raw_images_of_a_known_camera_are_photos() {
    let style = Style::Ros1;
    let mut entries = flight(style);
    entries.retain(|entry| entry.topic != "/cam/image_raw/compressed" && entry.topic != "/fix");
    let with = |more: Entry| {
        let mut all = entries.clone();
        all.push(more);
        flown(&all).unwrap().warnings[0].clone()
    };
    assert!(
        with(image_of(
            style,
            "/cam/image_rect_color",
            100,
            "rgb8",
            [640, 480]
        ))
        .contains("rectified images")
    );
    assert!(with(image_of(style, "/cam/depth", 100, "16UC1", [640, 480])).contains("depth images"));
    assert!(
        with(image_of(style, "/cam/image_raw", 200, "rgb8", [320, 240]))
            .contains("1 images have another size")
    );
    // In another namespace, but of the camera's frame.
    assert!(
        with(image_of(style, "/elsewhere/image", 100, "rgb8", [640, 480]))
            .contains("of the same camera")
    );
    // Binned images have a smaller camera, others none.
    let binned = |size| {
        let mut all = moves(style);
        all.extend([
            mount(style),
            camera_info(style),
            image_of(style, "/cam/image_raw", 100, "rgb8", size),
        ]);
        flown(&all)
    };
    let half = binned([320, 240]).unwrap();
    assert_eq!(
        (
            half.cameras[0].width,
            half.cameras[0].fx,
            half.cameras[0].cx
        ),
        (320, 250.0, 160.0)
    );
    assert!(
        half.warnings[0].contains("scaled to the images' size"),
        "{:?}",
        half.warnings
    );
    assert!(
        binned([480, 480])
            .unwrap_err()
            .what
            .contains("another shape")
    );
    // What a camera must be, camera files say (see there).
    let crop = Out::new(style)
        .header(100, "cam_optical")
        .u32(480)
        .u32(640)
        .text("plumb_bob")
        .u32(0);
    let crop = crop
        .f64s(&[500.0, 0.0, 319.5, 0.0, 510.0, 239.5, 0.0, 0.0, 1.0])
        .f64s(&[7.0; 21]);
    let crop = crop.u32(0).u32(0).u32(10).u32(0).u32(100).u32(100).byte(0);
    let mut all = moves(style);
    all.extend([
        mount(style),
        entry("/cam/camera_info", "sensor_msgs/CameraInfo", crop),
        image(style, 100),
    ]);
    let fault = flown(&all).unwrap_err().what;
    assert!(
        fault.contains("the region of interest '100 x 100 at 10, 0' is a crop"),
        "{fault}"
    );
}

/// REP 105 calls the frame of ECEF earth; two cameras must be in one world.
#[test]
fn the_world_is_the_topmost_frame() {
    let style = Style::Ros1;
    let mut entries = flight(style);
    assert_eq!(flown(&entries).unwrap().crs, None);
    let earth = Out::new(style).u32(1).header(0, "earth").text("map");
    let earth = turned(earth, [4e6, 1e6, 4.8e6], 0.0);
    entries.push(entry("/tf_static", "tf2_msgs/TFMessage", earth));
    let above = flown(&entries).unwrap();
    assert_eq!(above.crs.as_deref(), Some("ECEF"));
    let expected = expected(0.1).center + DVec3::new(4e6, 1e6, 4.8e6);
    assert!((above.photos[0].pose.center - expected).length() < 1e-8);
    // A second camera, of a body that is tracked on its own.
    let info = Out::new(style)
        .header(0, "other")
        .u32(6)
        .u32(8)
        .text("")
        .u32(0);
    let info = info
        .f64s(&[9.0, 0.0, 3.5, 0.0, 9.0, 2.5, 0.0, 0.0, 1.0])
        .f64s(&[0.0; 21]);
    let info = info.u32(0).u32(0).u32(0).u32(0).u32(0).u32(0).byte(0);
    entries.push(entry("/two/camera_info", "sensor_msgs/CameraInfo", info));
    entries.push(image_of(style, "/two/image_raw", 100, "rgb8", [8, 6]));
    entries.push(odometry("/odom", 0, "other"));
    let fault = flown(&entries).unwrap_err();
    assert_eq!(
        fault.what,
        "the cameras' poses are in two worlds, 'earth' and 'map'"
    );
}

#[test]
fn what_is_missing_is_named() {
    let style = Style::Ros1;
    let without = |topics: &[&str]| {
        let mut entries = flight(style);
        entries.retain(|entry| !topics.contains(&entry.topic));
        flown(&entries).unwrap_err().what
    };
    assert!(without(&["/cam/camera_info"]).contains("holds no camera"));
    assert!(without(&["/cam/image_raw", "/cam/image_raw/compressed"]).contains("holds no images"));
    assert!(
        without(&[
            "/cam/camera_info",
            "/cam/image_raw",
            "/cam/image_raw/compressed"
        ])
        .contains("holds neither")
    );
    assert!(without(&["/tf"]).contains("there are no poses"));
    assert!(without(&["/tf_static"]).contains(
        "'cam_optical' to the world: there are tf ('base_link' in 'odom'), tf ('odom' in 'map')"
    ));
}

#[test]
fn messages_that_cannot_be_read_are_counted() {
    let style = Style::Ros1;
    let mut entries = flight(style);
    let mut bad = image(style, 300);
    bad.data.pop();
    entries.push(bad);
    let mut nan = tf(style, 500, "odom", "base_link", [f64::NAN, 0.0, 0.0], 0.0);
    nan.topic = "/tf";
    entries.push(nan);
    let recording = of_bag(&bag(&entries, "none")).unwrap();
    assert_eq!(
        recording.warnings(),
        [
            "/tf: 1 of 7 messages are no tf2_msgs/TFMessage (the first has a pose that is not finite) and are left out",
            "/cam/image_raw: 1 of 4 messages are no sensor_msgs/Image (the first has a list that is longer than the message) and are left out",
        ]
    );
    let json = of_mcap(&mcap(&entries[..2], "json", ::mcap::WriteOptions::new())).unwrap();
    let fault = json.reconstruction().unwrap_err();
    assert!(fault.what.contains("encoded as 'json'"), "{fault}");
    assert!(
        json.warnings()[0].contains("encoded as 'json' and not read"),
        "{:?}",
        json.warnings()
    );
    assert_eq!(json.messages(), 2);
}

#[test]
fn photo_files_take_the_poses_of_a_recording() {
    let recording = of_bag(&bag(&flight(Style::Ros1), "lz4")).unwrap();
    let posed = recording
        .pose_files(
            &[
                "1700000000.100000.png".to_owned(),
                "1700000000600000000.jpg".to_owned(),
            ],
            None,
        )
        .unwrap();
    assert!(close(&posed.photos[0].1, &expected(0.1)));
    assert!(close(&posed.photos[1].1, &expected(0.6)));
    let fault = recording
        .pose_files(&["1.png".to_owned()], None)
        .unwrap_err();
    assert!(
        fault
            .what
            .ends_with("the poses cover 1700000000 s to 1700000000.8 s"),
        "{fault}"
    );
    let bare = of_bag(&bag(
        &[pose_stamped("/pose", 0), pose_stamped("/pose", 400)],
        "none",
    ))
    .unwrap();
    let posed = bare
        .pose_files(&["1700000000.2.png".to_owned()], None)
        .unwrap();
    assert!((posed.photos[0].1.center.x - 1000.4).abs() < 1e-12);
    assert!(posed.warnings[0].contains("taken for the camera itself"));
}

/// 26 566 and 518 messages are the README's counts; the poses were decoded by a script of a few lines
/// (Python's struct and sqlite3).
#[test]
fn the_shared_recordings() {
    for name in [
        "tf_example.bag",
        "tf_example_ros2",
        "tf_example_ros2/tf_example.db3",
    ] {
        let Some(path) = shared_data(&format!("ros-bags/{name}")) else {
            return;
        };
        let recording = read(&path, &Progress::default()).unwrap();
        assert_eq!(recording.messages(), 518, "{name}");
        assert_eq!(recording.warnings(), [""; 0]);
        let poses = recording.named_poses();
        assert_eq!(poses.len(), 517);
        let (name, pose) = &poses[0];
        assert_eq!(name, "tf:odom.base_footprint/1714741164177519307");
        assert_eq!(
            pose.center,
            DVec3::new(1.1603796887148006, -2.942426888388735, 0.0)
        );
        let (z, w) = (0.6808039454578293_f64, 0.7324656905610344);
        assert!(
            (pose.rotation.x_axis - DVec3::new(w * w - z * z, 2.0 * z * w, 0.0)).length() < 1e-12
        );
        let way = recording.frames.way_up("base_link").unwrap();
        assert_eq!((way.root.as_str(), way.links.len()), ("odom", 2));
        let fault = recording.reconstruction().unwrap_err();
        assert!(fault.what.contains("neither images"), "{fault}");
    }
    let Some(path) = shared_data("ros-bags/ROS_example.bag") else {
        return;
    };
    let recording = read(&path, &Progress::default()).unwrap();
    assert_eq!(recording.messages(), 26_566);
    let counts: Vec<u64> = recording
        .topics
        .iter()
        .map(|topic| topic.messages)
        .collect();
    assert_eq!(counts, [12_765, 8_362, 5_439]);
    assert_eq!(recording.named_poses().len(), 26_566);
    assert_eq!(
        messages_of_other_reader(&path),
        (26_566, own_checksum(&path))
    );
}

/// A sum over all messages' bytes, by place.
fn checksum(sum: u64, data: &[u8]) -> u64 {
    data.iter().fold(sum, |sum, &byte| {
        sum.wrapping_mul(31).wrapping_add(byte.into())
    })
}

fn own_checksum(path: &Path) -> u64 {
    let mut sum = 0;
    let file = open_file(path).unwrap();
    bag::read(BufReader::new(file), &mut |message| {
        sum = checksum(sum, message.data);
        Ok(())
    })
    .unwrap();
    sum
}

/// How many messages the crate `rosbag` finds, and the sum over them.
fn messages_of_other_reader(path: &Path) -> (u64, u64) {
    use rosbag::{ChunkRecord, MessageRecord, RosBag};
    let bag = RosBag::new(path).unwrap();
    let (mut count, mut sum) = (0, 0);
    for record in bag.chunk_records() {
        if let ChunkRecord::Chunk(chunk) = record.unwrap() {
            for message in chunk.messages() {
                if let MessageRecord::MessageData(message) = message.unwrap() {
                    count += 1;
                    sum = checksum(sum, message.data);
                }
            }
        }
    }
    (count, sum)
}
