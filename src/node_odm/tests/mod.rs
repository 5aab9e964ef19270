//! Runs against a server of our own that answers as NodeODM and ClusterODM were measured to answer
//! (`shared/data/nodeodm`), on this computer alone. What the command says and its exit status are in
//! `tests/command/node_odm.rs`.

mod between;
mod encrypted;
mod faults;
mod goes_on;
mod hands_over;
mod names;
mod worth;

use std::fs;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Duration;

use fragscale_test_data::node_server::{NodeServer, Served, ServerFault};
use tempfile::TempDir;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::*;

/// Three photos and what a node makes of them.
struct Desk {
    folder: TempDir,
    server: NodeServer,
}

const CAMERAS: &str = r#"{"lens": {"projection_type": "brown", "width": 64, "height": 48, "focal_x": 0.8, "focal_y": 0.8,
    "c_x": 0.0, "c_y": 0.0, "k1": 0.0, "k2": 0.0, "p1": 0.0, "p2": 0.0, "k3": 0.0}}"#;

const CLOUD: &str = "odm_georeferencing/odm_georeferenced_model.laz";

/// A LAS 1.2 of so many points (they need not be packed to be called so), as its specification says.
fn cloud(points: u32) -> Vec<u8> {
    let mut las = b"LASF".to_vec();
    las.extend([0; 20]);
    las.extend([1, 2]);
    las.extend([0; 64]);
    // Day and year; how long the header is, where points begin, no records; of kind 0, 20 bytes each.
    las.extend([1, 0, 0xea, 7, 227, 0, 227, 0, 0, 0, 0, 0, 0, 0, 0, 20, 0]);
    las.extend(points.to_le_bytes());
    las.extend(points.to_le_bytes());
    las.extend([0; 16]);
    let most = f64::from(points);
    for number in [
        0.01, 0.01, 0.01, 0.0, 0.0, 0.0, most, 0.0, 2.0, 0.0, 0.0, 0.0,
    ] {
        las.extend(f64::to_le_bytes(number));
    }
    for point in 0..points {
        las.extend((100 * point).to_le_bytes());
        las.extend((100 * (point % 3)).to_le_bytes());
        las.extend([0; 4]);
        las.extend([0, 0, 0b1001, 0, 0, 0, 0, 0]);
    }
    las
}

/// OpenDroneMap's project of three photos, and things that nobody asked for.
fn results() -> Vec<u8> {
    let shots = (1..=3).map(|number| {
        format!(
            "{{\"type\": \"Feature\", \"properties\": {{\"filename\": \"IMG_{number}.JPG\", \"camera\": \"lens\",
              \"translation\": [{number}, 0, 30], \"rotation\": [3.141592653589793, 0, 0]}}}}"
        )
    });
    let shots = format!(
        "{{\"features\": [{}]}}",
        shots.collect::<Vec<_>>().join(",")
    );
    zipped(&[
        ("cameras.json", CAMERAS.as_bytes()),
        ("odm_report/shots.geojson", shots.as_bytes()),
        (CLOUD, &cloud(5)),
        ("odm_orthophoto/odm_orthophoto.tif", b"not asked for"),
        ("odm_dem/dsm.tif", b"heights"),
        ("task_output.txt", b"not asked for"),
    ])
}

fn zipped(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in files {
        writer
            .start_file(*name, SimpleFileOptions::default())
            .unwrap();
        writer.write_all(bytes).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

/// Patience for tests.
fn quick() -> Limits {
    Limits {
        idle: Duration::from_secs(20),
        commit: Duration::from_secs(20),
        give_up: Duration::from_millis(400),
        shortest_pause: Duration::from_millis(5),
        longest_pause: Duration::from_millis(20),
        download: 1 << 20,
        ..Limits::default()
    }
}

impl Desk {
    fn new(served: Served) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let photos = folder.path().join("face 7");
        fs::create_dir(&photos).unwrap();
        for number in 1..=3_u8 {
            let even = image::RgbImage::from_pixel(64, 48, image::Rgb([80 * number, 90, 100]));
            even.save(photos.join(format!("IMG_{number}.JPG"))).unwrap();
        }
        fs::write(photos.join("geo.txt"), "EPSG:32615\nIMG_1.JPG 1 2 3\n").unwrap();
        let served = Served {
            results: if served.results.is_empty() {
                results()
            } else {
                served.results.clone()
            },
            ..served
        };
        Self {
            folder,
            server: NodeServer::start(served),
        }
    }

    fn faulty(fault: ServerFault) -> Self {
        Self::new(Served {
            fault,
            ..Served::default()
        })
    }

    fn photos(&self) -> PathBuf {
        self.folder.path().join("face 7")
    }

    fn to(&self) -> PathBuf {
        self.folder.path().join("flight")
    }

    fn request(&self) -> NodeRequest {
        NodeRequest {
            photos: self.photos(),
            to: self.to(),
            node: Address::parse(&self.server.address()).unwrap(),
            token: None,
            insecure: false,
            options: Vec::new(),
            control_points: None,
            limits: quick(),
        }
    }

    /// The same for a run that soon gives up a node which says nothing.
    fn impatient_request(&self) -> NodeRequest {
        NodeRequest {
            limits: Limits {
                idle: Duration::from_millis(300),
                ..quick()
            },
            ..self.request()
        }
    }

    /// Waits until the node was asked more than so many times what it is or how far a task is.
    fn wait_until_asked(&self, times: usize) {
        self.server.wait_until(|server| {
            let calls = server.calls();
            let asked = calls.iter().filter(|call| call.ends_with("/info"));
            asked.count() > times
        });
    }

    fn run(&self) -> Result<Reconstructed, String> {
        self.run_request(&self.request())
    }

    fn run_request(&self, request: &NodeRequest) -> Result<Reconstructed, String> {
        let made = reconstruct_on_node(request, &|_| {}, &Progress::default());
        made.map_err(|error| {
            let said = error.to_string();
            assert!(!said.contains('\n'), "{said}");
            said
        })
    }

    /// The error of a run that must fail; no flight is there then.
    fn error(&self) -> String {
        let error = self.run().unwrap_err();
        assert!(!self.to().join("flight.toml").exists());
        assert!(!self.to().join("odm").exists());
        error
    }

    /// How often something was called.
    fn called(&self, begin: &str) -> usize {
        self.server
            .calls()
            .iter()
            .filter(|call| call.starts_with(begin))
            .count()
    }
}

/// Everything of a run: what is asked, sent, made and left.
#[test]
fn photos_become_a_flight() {
    for cluster in [false, true] {
        let desk = Desk::new(Served {
            cluster,
            token: Some("s3cret & more"),
            ..Served::default()
        });
        let heard = Mutex::new(Vec::new());
        let request = NodeRequest {
            token: Token::typed("s3cret & more"),
            options: vec![Asked::parse("pc-quality=low").unwrap()],
            ..desk.request()
        };
        let hear = |line: &str| heard.lock().unwrap().push(line.to_owned());
        let made = reconstruct_on_node(&request, &hear, &Progress::default()).unwrap();
        assert_eq!(
            (made.registered, made.photos, made.left_out.len()),
            (3, 3, 0)
        );
        // Of the surface.
        assert_eq!(made.points, 5);
        assert_eq!(made.flight, desk.to().join("flight.toml"));
        let messages = heard.into_inner().unwrap();
        assert!(
            messages.ends_with(&["matching".to_owned(), "Compressing all.zip".to_owned()]),
            "{messages:?}"
        );

        // What the node got, to the byte.
        let [task] = &desk.server.tasks()[..] else {
            panic!("one task")
        };
        let field = |name: &str| task.fields.get(name).map(String::as_str);
        assert_eq!(field("name"), Some("face 7"));
        assert_eq!(field("skipPostProcessing"), Some("true"));
        assert!(
            field("outputs")
                .unwrap()
                .contains("\"opensfm/reconstruction.json\"")
        );
        assert_eq!(
            field("options"),
            Some(
                r#"[{"name":"pc-quality","value":"low"},{"name":"skip-3dmodel","value":true},{"name":"skip-orthophoto","value":true}]"#
            )
        );
        let mut names: Vec<&str> = task.files.iter().map(|(name, _)| name.as_str()).collect();
        names.sort_unstable();
        assert_eq!(names, ["IMG_1.JPG", "IMG_2.JPG", "IMG_3.JPG", "geo.txt"]);
        for (name, bytes) in &task.files {
            assert_eq!(
                *bytes,
                fs::read(desk.photos().join(name)).unwrap(),
                "{name}"
            );
        }
        assert!(task.committed && task.removed && !task.cancelled);
        assert_eq!(
            desk.called("POST /task/remove application/x-www-form-urlencoded"),
            1
        );
        assert_eq!(
            desk.called("GET /task/fda57596-9d93-48f0-8e5b-000000000001/output?line=0"),
            if cluster { 2 } else { 1 }
        );

        // The flight, and nothing else.
        let mut there: Vec<String> = fs::read_dir(desk.to())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        there.sort_unstable();
        assert_eq!(there, ["flight.toml", "node_log.txt", "odm"]);
        let odm = desk.to().join("odm");
        assert!(odm.join("cameras.json").is_file());
        assert!(!odm.join("odm_orthophoto").exists() && !odm.join("task_output.txt").exists());
        let flight = fs::read_to_string(&made.flight).unwrap();
        assert!(flight.contains("reconstruction = \"odm\""), "{flight}");
        assert!(flight.contains("folder = \"../face 7\""), "{flight}");
        assert!(flight.contains("name = \"face 7\""), "{flight}");
        // A flight is not made twice.
        let again = desk.run_request(&request).unwrap_err();
        assert!(again.contains("there is a flight in it already"), "{again}");
    }
}

#[test]
fn files_go_several_at_once() {
    let desk = Desk::faulty(ServerFault::None);
    for number in 4..=40_u8 {
        let even = image::RgbImage::from_pixel(64, 48, image::Rgb([number, 2 * number, 100]));
        even.save(desk.photos().join(format!("IMG_{number}.JPG")))
            .unwrap();
    }
    desk.run().unwrap();
    assert_eq!(desk.called("POST /task/new/upload/"), 41);
    let at_once = desk.server.most_at_once();
    assert!((2..=4).contains(&at_once), "{at_once}");
}

#[test]
fn control_points_go_along() {
    let desk = Desk::faulty(ServerFault::None);
    let list = desk.photos().join("gcp_list.txt");
    fs::write(
        &list,
        "EPSG:32615\n1 2 3 10 20 IMG_1.JPG a\n1 2 3 10 20 IMG_2.JPG a\n",
    )
    .unwrap();
    desk.run().unwrap();
    let tasks = desk.server.tasks();
    let sent = tasks[0]
        .files
        .iter()
        .find(|(name, _)| name == "gcp_list.txt")
        .unwrap();
    assert_eq!(sent.1, fs::read(&list).unwrap());

    // One between commas, as spreadsheets write it, is written as OpenDroneMap reads it: what has six parts between blanks.
    let desk = Desk::faulty(ServerFault::None);
    let commas = "EPSG:32615,,,,,,\n1,2,3,10,20,IMG_1.JPG,a\n1,2,3,10,20,IMG_2.JPG,a\n";
    fs::write(desk.photos().join("gcp_list.txt"), commas).unwrap();
    desk.run().unwrap();
    let tasks = desk.server.tasks();
    let sent = tasks[0].files.iter();
    let (_, sent) = sent
        .clone()
        .find(|(name, _)| name == "gcp_list.txt")
        .unwrap();
    let sent = String::from_utf8_lossy(sent);
    let marks = sent.lines().filter(|line| !line.starts_with('#')).skip(1);
    let marks: Vec<Vec<&str>> = marks
        .map(|line| line.split_whitespace().collect())
        .collect();
    assert!(sent.starts_with("EPSG:32615\n"), "{sent}");
    assert_eq!(marks[0], ["1", "2", "3", "10", "20", "IMG_1.JPG", "a"]);
    assert_eq!(marks[1], ["1", "2", "3", "10", "20", "IMG_2.JPG", "a"]);

    // One that OpenDroneMap could not use is said before anything is sent.
    for (text, said) in [
        (
            "EPSG:32615\n1 2 3 10 20 other.JPG a\n",
            "marked in one of the photos",
        ),
        ("no list", "gcp_list.txt"),
    ] {
        let desk = Desk::faulty(ServerFault::None);
        fs::write(desk.photos().join("gcp_list.txt"), text).unwrap();
        let error = desk.error();
        assert!(error.contains(said), "{error}");
        assert!(desk.server.calls().is_empty());
        assert!(!desk.to().exists());
    }
}

#[test]
fn what_cannot_be_sent_is_said_before_anything_is() {
    let desk = Desk::faulty(ServerFault::None);
    // Places of other photos.
    let places = desk.photos().join("geo.txt");
    fs::write(&places, "EPSG:32615\nother.JPG 1 2 3\n").unwrap();
    let error = desk.error();
    assert!(
        error.contains("geo.txt: none of its lines begins with the name of one of the photos"),
        "{error}"
    );
    fs::remove_file(&places).unwrap();
    fs::remove_file(desk.photos().join("IMG_2.JPG")).unwrap();
    assert!(desk.error().contains("needs three at least"));
    let there = NodeRequest {
        node: Address::parse("http://node.example:3000").unwrap(),
        ..desk.request()
    };
    let error = desk.run_request(&there).unwrap_err();
    assert!(
        error.contains("would cross the network unencrypted"),
        "{error}"
    );
    // A flight among its photos would be taken for one of them.
    let among = NodeRequest {
        to: desk.photos(),
        ..desk.request()
    };
    assert!(desk.run_request(&among).is_err());
    assert!(desk.server.calls().is_empty() && !desk.to().exists());
}

/// The whole of a folder, as names and bytes.
fn all_files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    let Ok(entries) = fs::read_dir(folder) else {
        return found;
    };
    for entry in entries {
        let path = entry.unwrap().path();
        match path.is_dir() {
            true => found.extend(all_files(&path)),
            false => found.push((path.clone(), fs::read(&path).unwrap())),
        }
    }
    found
}
