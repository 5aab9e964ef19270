//! A new flight from photos on a NodeODM, against a server of our own on this computer.

use std::fs;
use std::io::{Cursor, Write};
use std::time::{Duration, Instant};

use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::kittest::NodeT;
use fragscale::app::command::Command;
use fragscale::app::from_photos::{Ended, FromPhotosStep};
use fragscale::app::tasks::work::Task;
use fragscale::surface::Cloud;
use fragscale_test_data::node_server::{NodeServer, Served, ServerFault};
use glam::DVec3;
use tempfile::TempDir;

use crate::desk::{Desk, Screen, copy_files};

const CAMERAS: &str = r#"{"lens": {"projection_type": "brown", "width": 1280, "height": 720, "focal_x": 0.8, "focal_y": 0.8,
    "c_x": 0.0, "c_y": 0.0, "k1": 0.0, "k2": 0.0, "p1": 0.0, "p2": 0.0, "k3": 0.0}}"#;

/// Nine photos that look down from 30 m on level ground.
fn results() -> Vec<u8> {
    let shots = (1..=9).map(|number| {
        format!(
            "{{\"type\": \"Feature\", \"properties\": {{\"filename\": \"IMG_000{number}.jpg\", \"camera\": \"lens\",
              \"translation\": [{number}, 0, 30], \"rotation\": [3.141592653589793, 0, 0]}}}}"
        )
    });
    let shots = format!(
        "{{\"features\": [{}]}}",
        shots.collect::<Vec<_>>().join(",")
    );
    // Level, 100 m wide.
    let points = (0..121).map(|at| DVec3::new(f64::from(at % 11), f64::from(at / 11), 0.0) * 10.0);
    let there = DVec3::new(-50.0, -50.0, 0.0);
    let cloud = Cloud {
        points: points.map(|point| point + there).collect(),
        ..Cloud::default()
    };
    let cloud = fragscale::exports::laz(&cloud, 32633, "simulated").expect("a LAZ");
    let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in [
        ("cameras.json", CAMERAS.as_bytes()),
        ("odm_report/shots.geojson", shots.as_bytes()),
        ("odm_georeferencing/odm_georeferenced_model.laz", &cloud),
    ] {
        let options = zip::write::SimpleFileOptions::default();
        writer.start_file(name, options).expect("a file");
        writer.write_all(bytes).expect("written");
    }
    writer.finish().expect("an archive").into_inner()
}

fn served(fault: ServerFault) -> Served {
    Served {
        token: Some("s3cret"),
        results: results(),
        fault,
        ..Served::default()
    }
}

/// The small window with nine photos and this node in it.
fn desk(address: &str) -> (TempDir, Desk) {
    let folder = tempfile::tempdir().expect("a folder");
    let photos = folder.path().join("face");
    copy_files("assets/sample/photos", &photos);
    let mut desk = Desk::new(None);
    desk.click(Role::Button, "New flight from photos");
    desk.fill_and_leave("Folder of the photos", photos.to_str().expect("UTF-8"));
    desk.click(Role::RadioButton, "Engine: NodeODM");
    desk.fill("Address", address);
    (folder, desk)
}

/// What is typed into a field that hides it.
fn fill_token(desk: &mut Desk, token: &str) {
    desk.node(Role::PasswordInput, "Token").click();
    desk.harness.run();
    desk.harness.event(egui::Event::Text(token.to_owned()));
    desk.harness.run();
    desk.press(egui::Modifiers::NONE, egui::Key::Enter);
}

fn ended(desk: &Desk) -> Option<&Ended> {
    desk.harness.state().state().from_photos.ended.as_ref()
}

fn start(desk: &mut Desk) {
    desk.node(Role::Button, "Start reconstruction").click();
    desk.harness.run_steps(5);
}

fn step_until(desk: &mut Desk, holds: impl Fn(&Desk) -> bool) {
    let began = Instant::now();
    while !holds(desk) {
        assert!(began.elapsed() < Duration::from_secs(60));
        desk.harness.step();
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Nothing of another engine is asked, a wrong token is said, then the flight is open; what was typed as the token is
/// drawn nowhere and written nowhere.
#[test]
fn a_node_makes_the_flight() {
    let server = NodeServer::start(served(ServerFault::None));
    let (folder, mut desk) = desk(&server.address());
    for engine in ["Quality: Fast", "Graphics card", "Calibration"] {
        assert!(!desk.shows(Role::RadioButton, engine) && !desk.shows(Role::TextInput, engine));
    }
    desk.click(Role::Button, "Start reconstruction");
    assert!(desk.says("the node asks for a token"));
    fill_token(&mut desk, "s3cret");
    desk.fill("Options", "pc-quality=low dsm");
    desk.click(Role::Button, "Start reconstruction");
    let Some(Ended::Made(made)) = ended(&desk) else {
        panic!("{:?}", ended(&desk));
    };
    assert_eq!(made.registered, 9);
    assert_eq!(
        desk.open().files.origin.flight_file(),
        Some(made.flight.as_path())
    );
    assert_eq!(made.flight, folder.path().join("face flight/flight.toml"));
    let tasks = server.tasks();
    assert!(tasks[0].fields["options"].contains(r#"{"name":"dsm","value":true}"#));
    for written in desk.written() {
        assert!(!written.text.contains("s3cret"), "{}", written.text);
    }
    let state = format!("{:?}", desk.harness.state().state().from_photos);
    assert!(!state.contains("s3cret"), "{state}");
    let kept = fs::read_to_string(&made.flight).expect("the flight");
    assert!(!kept.contains("s3cret"));
}

/// Its progress and messages are shown; cancelled the task ends there, and that is said.
#[test]
fn cancelling_ends_the_task_there() {
    let server = NodeServer::start(Served {
        messages: vec!["extracting features".to_owned()],
        ..served(ServerFault::NeverEnds)
    });
    let (folder, mut desk) = desk(&server.address());
    fill_token(&mut desk, "s3cret");
    start(&mut desk);
    step_until(&mut desk, |desk| {
        desk.says("the node reconstructs: extracting features")
    });
    assert!(!desk.shows(Role::Button, "Pause reconstruction"));
    desk.node(Role::Button, "Cancel reconstruction").click();
    step_until(&mut desk, |desk| {
        desk.says("Cancelled: the task on the node was cancelled and removed")
    });
    assert!(
        !desk
            .harness
            .state()
            .state()
            .work
            .is_running(Task::RECONSTRUCT)
    );
    let tasks = server.tasks();
    assert!(tasks[0].cancelled && tasks[0].removed);
    assert!(!folder.path().join("face flight").exists());
    // The same once more is another task.
    server.now_serves(|served| served.fault = ServerFault::None);
    desk.click(Role::Button, "Start reconstruction");
    assert!(
        matches!(ended(&desk), Some(Ended::Made(_))),
        "{:?}",
        ended(&desk)
    );
    assert_eq!(server.tasks().len(), 2);
}

/// Why a task failed stands there, with the node's last messages.
#[test]
fn a_failure_is_said_with_the_messages() {
    let server = NodeServer::start(served(ServerFault::Fails("Not enough memory")));
    let (_folder, mut desk) = desk(&server.address());
    fill_token(&mut desk, "s3cret");
    desk.click(Role::Button, "Start reconstruction");
    assert!(desk.says("the node had not enough memory (exit status 137)"));
    assert!(desk.says("Compressing all.zip"));
}

#[test]
fn addresses_are_looked_at_while_they_are_typed() {
    let (_folder, mut desk) = desk("localhost:3000");
    assert!(desk.says("is no node's address"));
    let button = desk.node(Role::Button, "Start reconstruction");
    assert!(button.accesskit_node().is_disabled());
    // Another computer without encryption asks.
    desk.fill("Address", "http://node.invalid:3000");
    desk.click(Role::Button, "Start reconstruction");
    assert!(desk.says("would cross the network unencrypted"));
    desk.click(Role::CheckBox, "Not encrypted: I trust the network");
    let form = &desk.harness.state().state().from_photos.form.node;
    assert!(form.insecure && form.is_open_to_all());
    desk.fill("Address", "https://node.invalid");
    assert!(!desk.shows(Role::CheckBox, "Not encrypted: I trust the network"));
}

/// One click behind a field that is typed into: the button is there before the field is left.
#[test]
fn start_is_one_click_behind_the_address() {
    let (_folder, mut desk) = desk("");
    let is_grey = |desk: &Desk| {
        let button = desk.node(Role::Button, "Start reconstruction");
        button.accesskit_node().is_disabled()
    };
    assert!(is_grey(&desk));
    desk.node(Role::TextInput, "Address").click();
    desk.harness.run();
    let address = "http://node.invalid:3000".to_owned();
    desk.harness.event(egui::Event::Text(address));
    desk.harness.run();
    assert!(!is_grey(&desk));
    desk.click(Role::Button, "Start reconstruction");
    assert!(desk.says("would cross the network unencrypted"));
}

/// In words that do not depend on where the sources lie.
fn looks(screen: &Screen, name: &str) {
    let mut desk = Desk::drawn(None, screen);
    desk.click(Role::Button, "New flight from photos");
    desk.fill_and_leave("Folder of the photos", "assets/sample/photos");
    desk.fill_and_leave("Folder to make", "flights/face 3");
    let found = Ok("COLMAP 3.8".to_owned());
    let step = Command::FromPhotos(FromPhotosStep::Colmap(found));
    desk.harness.state_mut().apply(step);
    desk.click(Role::RadioButton, "Engine: NodeODM");
    desk.fill("Address", "http://node.mine.example:3000");
    desk.harness.remove_cursor();
    desk.settle();
    desk.harness.snapshot(name);
}

#[test]
fn dark() {
    let screen = Screen {
        size: [760.0, 480.0],
        pixels_per_point: 1.0,
        theme: Theme::Dark,
    };
    looks(&screen, "node_odm_dark");
}

#[test]
fn light_at_200_percent() {
    let screen = Screen {
        size: [640.0, 400.0],
        pixels_per_point: 2.0,
        theme: Theme::Light,
    };
    looks(&screen, "node_odm_200_percent");
}
