//! `fragscale reconstruct --node` from outside, against a server of our own on this computer that answers as NodeODM
//! and ClusterODM were measured to answer: what it says, its exit status, and what it leaves.

use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use fragscale::exports::laz;
use fragscale::jobs::Progress;
use fragscale::opening::{OpenOptions, open_flight};
use fragscale_test_data::node_server::{NodeServer, Served, ServerFault};
use glam::{DQuat, DVec3};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::common::{scale, scales_json, shared_data};

const SAMPLE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sample");
const TOKEN: &str = "s3cret+token/7";

fn zipped(files: &[(String, Vec<u8>)]) -> Vec<u8> {
    let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        let options = zip::write::SimpleFileOptions::default();
        writer.start_file(name.as_str(), options).expect("a file");
        writer.write_all(bytes).expect("written");
    }
    writer.finish().expect("an archive").into_inner()
}

/// The bundled flight as OpenDroneMap would have written it, somewhere in UTM zone 33: poses, lens, cloud.
fn sample_as_odm() -> Vec<(String, Vec<u8>)> {
    let there = DVec3::new(500_000.0, 5_000_000.0, 100.0);
    let opened = open_flight(
        Path::new(SAMPLE),
        &OpenOptions::default(),
        &Progress::default(),
    );
    let opened = opened.expect("the bundled flight");
    let parts = opened.flight.parts();
    let camera = &parts.cameras[0];
    let fragscale::camera::Distortion::Brown(brown) = &camera.distortion else {
        panic!("the bundled lens is Brown's");
    };
    let [k1, k2, p1, p2, k3, ..] = brown.coefficients();
    let (w, h) = (f64::from(camera.width), f64::from(camera.height));
    // OpenSfM counts from the middle of the image, in parts of the longer side, pixels at their centres.
    let lens = json!({ "lens": {
        "projection_type": "brown", "width": camera.width, "height": camera.height,
        "focal_x": camera.fx / w, "focal_y": camera.fy / w,
        "c_x": (camera.cx - w / 2.0) / w, "c_y": (camera.cy - h / 2.0) / w,
        "k1": k1, "k2": k2, "p1": p1, "p2": p2, "k3": k3,
    }});
    let shots = parts.photos.iter().map(|photo| {
        let turn = DQuat::from_mat3(&photo.pose.rotation.transpose()).to_scaled_axis();
        let center = photo.pose.center + there;
        json!({ "type": "Feature", "properties": {
            "filename": photo.name, "camera": "lens",
            "translation": center.to_array(), "rotation": turn.to_array(),
        }})
    });
    let shots = json!({ "type": "FeatureCollection", "features": shots.collect::<Vec<_>>() });
    let pile =
        fragscale::formats::read_cloud(&Path::new(SAMPLE).join("pile.ply"), &Progress::default());
    let mut pile = pile.expect("the bundled pile").cloud;
    for point in &mut pile.points {
        *point += there;
    }
    let pile = laz(&pile, 32633, "simulated").expect("a LAZ");
    vec![
        ("cameras.json".to_owned(), lens.to_string().into_bytes()),
        (
            "odm_report/shots.geojson".to_owned(),
            shots.to_string().into_bytes(),
        ),
        (
            "odm_georeferencing/coords.txt".to_owned(),
            b"WGS84 UTM 33N\n500000 5000000\n".to_vec(),
        ),
        (
            "odm_georeferencing/odm_georeferenced_model.laz".to_owned(),
            pile,
        ),
    ]
}

/// A folder of the bundled photos.
struct Desk {
    folder: TempDir,
    server: NodeServer,
}

impl Desk {
    fn new(served: Served) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let photos = folder.path().join("face");
        fs::create_dir(&photos).expect("a folder");
        for number in 1..=9 {
            let name = format!("IMG_000{number}.jpg");
            fs::copy(
                Path::new(SAMPLE).join("photos").join(&name),
                photos.join(&name),
            )
            .expect("a copy");
        }
        Self {
            folder,
            server: NodeServer::start(served),
        }
    }

    fn faulty(fault: ServerFault) -> Self {
        Self::new(Served {
            fault,
            token: Some(TOKEN),
            results: zipped(&sample_as_odm()),
            ..Served::default()
        })
    }

    fn to(&self) -> PathBuf {
        self.folder.path().join("flight")
    }

    fn command(&self, more: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fragscale"));
        command
            .arg("reconstruct")
            .arg(self.folder.path().join("face"));
        command.arg("--to").arg(self.to());
        command.args(["--node", &self.server.address(), "--give-up-after", "0.01"]);
        command.args(more).env("FRAGSCALE_NODE_TOKEN", TOKEN);
        command
    }

    fn run(&self, more: &[&str]) -> Output {
        let output = self.command(more).output().expect("it starts");
        self.no_token(&output);
        output
    }

    /// Neither what is said nor a single byte that was written holds the token, as it is or as URLs have it.
    fn no_token(&self, output: &Output) {
        let mut all = vec![output.stdout.clone(), output.stderr.clone()];
        let mut folders = vec![self.folder.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    folders.push(path);
                } else {
                    all.push(path.to_string_lossy().into_owned().into_bytes());
                    all.push(fs::read(path).expect("read"));
                }
            }
        }
        for bytes in all {
            assert!(!bytes.windows(6).any(|six| six == b"s3cret"));
        }
    }

    /// The one line of a run that must fail with this status.
    fn error(&self, status: i32, more: &[&str]) -> String {
        let output = self.run(more);
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(status), "{said}");
        let errors: Vec<&str> = said
            .lines()
            .filter(|line| line.starts_with("error: "))
            .collect();
        assert_eq!(errors.len(), 1, "{said}");
        assert_eq!(output.stdout, b"");
        assert!(!self.to().join("flight.toml").exists());
        errors[0].to_owned()
    }
}

/// The flight that comes back has the scales of the bundled one: its cloud is rounded to a millimetre.
#[test]
fn photos_become_a_flight_on_a_node() {
    let desk = Desk::faulty(ServerFault::None);
    let output = desk.run(&["--option", "pc-quality=low", "--option", "dsm"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let written = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(written.contains("flight.toml: 9 of 9 photos"), "{written}");
    let made = scales_json(&desk.to(), &[]);
    let bundled = scales_json(Path::new(SAMPLE), &[]);
    let pairs = |report: &Value| report["photos"].as_array().expect("photos").clone();
    assert_eq!(pairs(&made).len(), 9);
    for (photo, known) in pairs(&made).iter().zip(&pairs(&bundled)) {
        assert_eq!(photo["photo"], known["photo"]);
        for edge in ["top", "right", "bottom", "left"] {
            let (found, known) = (
                scale(photo, edge).expect("a scale"),
                scale(known, edge).expect("a scale"),
            );
            assert!(
                (found / known - 1.0).abs() < 0.01,
                "{edge}: {found} for {known}"
            );
        }
    }
    // The token is what the node knows it by, and it was asked for these.
    let tasks = desk.server.tasks();
    let options = &tasks[0].fields["options"];
    assert!(
        options.contains(r#"{"name":"pc-quality","value":"low"}"#),
        "{options}"
    );
    assert!(
        options.contains(r#"{"name":"dsm","value":true}"#),
        "{options}"
    );
}

/// A real project of OpenDroneMap's, through a cluster: the same flight to the last bit as from its folder.
#[test]
fn brighton_through_a_cluster_is_brighton() {
    let Some(brighton) = shared_data("odm-brighton-0") else {
        return;
    };
    let mut files = Vec::new();
    for name in [
        "cameras.json",
        "images.json",
        "img_list.txt",
        "odm_georeferencing/coords.txt",
        "odm_georeferencing/odm_georeferenced_model.laz",
        "odm_georeferencing/proj.txt",
        "odm_report/shots.geojson",
        "opensfm/geocoords_transformation.txt",
        "opensfm/reconstruction.json",
        "opensfm/tracks.csv",
    ] {
        if let Ok(bytes) = fs::read(brighton.join(name)) {
            files.push((name.to_owned(), bytes));
        }
    }
    let desk = Desk::new(Served {
        cluster: true,
        token: Some(TOKEN),
        results: zipped(&files),
        ..Served::default()
    });
    let photos = desk.folder.path().join("face");
    fs::remove_dir_all(&photos).expect("removed");
    fs::create_dir(&photos).expect("a folder");
    for number in 27..=30 {
        let name = format!("DJI_00{number}.JPG");
        fs::copy(brighton.join("images").join(&name), photos.join(&name)).expect("a copy");
    }
    let output = desk.run(&[]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let known = scales_json(&brighton, &[]);
    let made = scales_json(&desk.to(), &[]);
    let of = |report: &Value| {
        let photos = report["photos"].as_array().expect("photos").clone();
        let numbers = photos
            .iter()
            .map(|photo| (photo["photo"].clone(), photo["scale"].clone()));
        numbers.collect::<Vec<_>>()
    };
    assert_eq!(of(&made), of(&known));
    assert_eq!(made["world_unit"], "m");
    let flight = fs::read_to_string(desk.to().join("flight.toml")).expect("the flight");
    assert!(flight.contains("unit = \"m\""), "{flight}");
    // The photos say where they were taken: that went along.
    let tasks = desk.server.tasks();
    let geo = tasks[0]
        .files
        .iter()
        .find(|(name, _)| name == "geo.txt")
        .expect("geo.txt");
    let geo = String::from_utf8_lossy(&geo.1).into_owned();
    assert!(geo.starts_with("EPSG:4326\nDJI_0027.JPG -91.994"), "{geo}");
    assert_eq!(geo.lines().count(), 5);
}

#[test]
fn every_fault_is_one_line_and_a_status() {
    let other = NodeServer::start(Served::default());
    for (fault, said) in [
        (
            ServerFault::UploadsRefused(usize::MAX),
            "it goes on with what the node has",
        ),
        (ServerFault::DiskFull, "the node's disk is full"),
        (
            ServerFault::Fails("Cannot process dataset"),
            "exit status 1)",
        ),
        (ServerFault::Fails("Not enough memory"), "exit status 137)"),
        (ServerFault::Forgets, "does not know the task any more"),
        (ServerFault::Dies, "it goes on with the task"),
        (
            ServerFault::NeverAnswers,
            "it does not answer (the node has said nothing",
        ),
        (
            ServerFault::TooShort(usize::MAX),
            "the results broke off after",
        ),
        (ServerFault::TooLong, "cut off or no zip archive"),
        (ServerFault::Page, "it is no NodeODM and no ClusterODM"),
        (ServerFault::EndlessAnswer, "an answer of more than 4 MB"),
        (
            ServerFault::Redirects(format!("{}/?token=s3cret", other.address())),
            "it sends on to another address",
        ),
    ] {
        let desk = Desk::faulty(fault.clone());
        let error = desk.error(1, &[]);
        assert!(
            error.starts_with(&format!("error: {}: ", desk.server.address())),
            "{error}"
        );
        assert!(error.contains(said), "{fault:?}: {error}");
    }
    assert!(other.calls().is_empty());
}

#[test]
fn what_was_typed_is_looked_at_first() {
    let desk = Desk::faulty(ServerFault::None);
    let error = desk.error(1, &["--token", "wrong"]);
    assert!(error.contains("the node refuses the token"), "{error}");
    let error = desk.error(1, &["--option", "pc-qualty=low"]);
    assert!(error.contains("perhaps pc-quality is meant"), "{error}");
    let error = desk.error(2, &["--option", "=low"]);
    assert!(error.contains("no option of OpenDroneMap"), "{error}");
    let error = desk.error(2, &["--engine", "colmap"]);
    assert!(error.contains("cannot be used with"), "{error}");
    assert!(!desk.to().exists());

    let run = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_fragscale"))
            .args(["reconstruct", SAMPLE, "--to"])
            .arg(desk.to())
            .args(arguments)
            .output()
            .expect("it starts");
        desk.no_token(&output);
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    // Nothing is sent in the clear to another computer, and no address that holds a secret is repeated.
    let (status, said) = run(&["--node", "http://node.invalid:3000"]);
    assert_eq!(status, Some(1));
    assert!(
        said.contains("would cross the network unencrypted; use https://")
            && said.contains("--insecure"),
        "{said}"
    );
    let (status, said) = run(&["--node", "http://localhost:3000?token=s3cret"]);
    assert_eq!(status, Some(1));
    assert!(said.contains("holds a token"), "{said}");
    let (status, said) = run(&["--node", "localhost:3000"]);
    assert_eq!(status, Some(1));
    assert!(said.contains("is no node's address"), "{said}");
    let (status, said) = run(&["--insecure"]);
    assert_eq!(status, Some(2), "{said}");
}

/// Killed in the middle, the same command fetches the results of the task that it had begun.
#[cfg(unix)]
#[test]
fn killed_it_goes_on_with_its_task() {
    let desk = Desk::faulty(ServerFault::NeverEnds);
    let mut child = desk.command(&[]).spawn().expect("it starts");
    let asked = |server: &NodeServer| {
        server
            .calls()
            .iter()
            .filter(|call| call.ends_with("/info"))
            .count()
    };
    desk.server.wait_until(|server| asked(server) > 3);
    child.kill().expect("killed");
    child.wait().expect("ended");
    let opened = crate::common::error_of(&["scales", desk.to().to_str().expect("UTF-8")]);
    assert!(
        opened.contains("a reconstruction that is not finished"),
        "{opened}"
    );
    desk.server
        .now_serves(|served| served.fault = ServerFault::None);
    let output = desk.run(&[]);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(desk.server.tasks().len(), 1);
    assert!(desk.to().join("flight.toml").is_file() && !desk.to().join("unfinished").exists());
}

/// A closed terminal and a system that shuts down are no wish to throw the node's work away.
#[cfg(unix)]
#[test]
fn terminated_it_leaves_the_task() {
    for (signal, status) in [("-HUP", 129), ("-TERM", 143)] {
        let desk = Desk::faulty(ServerFault::NeverEnds);
        let child = desk
            .command(&[])
            .stderr(std::process::Stdio::piped())
            .spawn()
            .expect("it starts");
        let asked = |server: &NodeServer| {
            let calls = server.calls();
            calls.iter().filter(|call| call.ends_with("/info")).count()
        };
        desk.server.wait_until(|server| asked(server) > 3);
        let kill = Command::new("kill")
            .args([signal, &child.id().to_string()])
            .status();
        assert!(kill.expect("kill is there").success());
        let output = child.wait_with_output().expect("it ends");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(status), "{said}");
        assert!(
            said.starts_with("interrupted; the node may go on with the task: the same command"),
            "{said}"
        );
        assert_eq!(said.lines().count(), 1, "{said}");
        let tasks = desk.server.tasks();
        assert!(!tasks[0].cancelled && !tasks[0].removed);
        desk.server
            .now_serves(|served| served.fault = ServerFault::None);
        let output = desk.run(&[]);
        assert_eq!(output.status.code(), Some(0));
        assert_eq!(desk.server.tasks().len(), 1);
    }
}

/// Ctrl+C cancels and removes the task on the node, says so, and leaves nothing.
#[cfg(unix)]
#[test]
fn interrupted_it_calls_the_task_off() {
    let desk = Desk::faulty(ServerFault::NeverEnds);
    let child = desk
        .command(&[])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("it starts");
    let asked = |server: &NodeServer| {
        server
            .calls()
            .iter()
            .filter(|call| call.ends_with("/info"))
            .count()
    };
    desk.server.wait_until(|server| asked(server) > 3);
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.expect("kill is there").success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.starts_with("interrupted; the task on the node was cancelled and removed"),
        "{said}"
    );
    assert_eq!(said.lines().count(), 1, "{said}");
    let tasks = desk.server.tasks();
    assert!(tasks[0].cancelled && tasks[0].removed);
    assert!(!desk.to().exists());
}
