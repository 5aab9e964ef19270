//! The small window for georeferencing: a model whose place in the world is known by construction is
//! brought there, and its scales are those of that world.

use std::fs;
use std::path::Path;

use egui::accesskit::Role;
use fragscale::app::Command;
use fragscale::app::actions::file::GEOREFERENCE;
use fragscale::app::open_flight::Measure;
use fragscale::geometry::Ray;
use glam::DVec3;
use tempfile::TempDir;

use crate::common::stdout_of;
use crate::desk::{Desk, flight};
use crate::own_frame::{model, positions};

/// 1000 px at 30 m.
const PIXELS_PER_METRE: f64 = 1000.0 / 30.0;

/// The model and this list of positions, with the small window open.
fn desk(list: &str) -> (TempDir, Desk) {
    let folder = tempfile::tempdir().expect("a folder");
    let package = folder.path().join("model");
    fs::create_dir(&package).expect("a folder");
    model(&package);
    fs::write(folder.path().join("list.csv"), list).expect("written");
    let mut desk = Desk::new(Some(&package));
    ask(&mut desk);
    (folder, desk)
}

fn ask(desk: &mut Desk) {
    desk.click(Role::Button, "File");
    desk.click(Role::Button, "Georeference…");
}

/// Fits the list of positions.
fn fit(desk: &mut Desk, folder: &Path) {
    desk.click(Role::RadioButton, "List of positions");
    let list = folder.join("list.csv");
    desk.fill("File of the positions", list.to_str().expect("UTF-8"));
    desk.fill("Coordinate system", "EPSG:32632");
    desk.click(Role::Button, "Fit to what is known");
}

#[track_caller]
fn assert_scales(desk: &Desk) {
    assert_eq!(desk.open().review.outcomes().len(), 5);
    for photo in 0..5 {
        let scale = desk.open().scale(photo).expect("a scale").scale;
        for edge in [scale.top, scale.right, scale.bottom, scale.left] {
            let edge = edge.expect("an edge");
            assert!((edge - PIXELS_PER_METRE).abs() < 1e-4, "{edge}");
        }
    }
}

#[test]
fn a_list_of_positions_gives_the_scales_of_the_world() {
    let (folder, mut desk) = desk(&positions());
    assert!(desk.says("is in a frame of its own"));
    fit(&mut desk, folder.path());
    let fitted = desk.open().georeferencing.fitted().expect("a fit");
    assert!((fitted.similarity.scale - 3.0).abs() < 1e-9);
    for words in [
        "Scale: 3.000000 m to one",
        "± less than 0.0001 % (standard error)",
        "5 of 5 positions used, RMS 0.000 m",
        "World: EPSG:32632, in m",
        "Heights count from: ",
    ] {
        assert!(desk.says(words), "{words}");
    }
    let rows = desk.rows_of("Residual of");
    assert_eq!(rows.len(), 5);
    assert_eq!(
        rows[0].1[1..],
        ["0.000"; 4]
            .map(str::to_owned)
            .into_iter()
            .chain(["used".to_owned()])
            .collect::<Vec<_>>()
    );

    // Beside the model, unless somebody says otherwise.
    desk.click(Role::Button, "Save and open…");
    let proposed = desk.node(Role::TextInput, "Path").value().expect("a path");
    let target = folder.path().join("model-georeferenced.toml");
    assert_eq!(Path::new(&proposed), target);
    desk.click(Role::Button, "Save and open");
    let open = desk.open();
    assert_eq!(open.files.origin.flight_file(), Some(target.as_path()));
    assert_eq!(open.files.crs.as_deref(), Some("EPSG:32632"));
    assert!(!open.is_changed());
    assert_scales(&desk);

    // The command writes the same file.
    let text = |path: &Path| path.to_str().expect("UTF-8").to_owned();
    let theirs = folder.path().join("theirs.toml");
    let (package, list) = (folder.path().join("model"), folder.path().join("list.csv"));
    stdout_of(&[
        "georeference",
        &text(&package),
        "--positions",
        &text(&list),
        "--crs",
        "EPSG:32632",
        "-o",
        &text(&theirs),
    ]);
    let read = |path: &Path| fs::read_to_string(path).expect("a flight");
    assert_eq!(read(&target), read(&theirs));

    // It is in the world now.
    ask(&mut desk);
    assert!(desk.says("is in the world already: a transform in its flight.toml"));
    assert!(!desk.shows(Role::Button, "Fit to what is known"));
}

#[test]
fn residuals_are_sorted_and_copied() {
    // The fourth photo half a metre too high, and with it the others' residuals.
    let high = positions().replace(
        "img_4.jpg,500000,4999991,150",
        "img_4.jpg,500000,4999991,150.5",
    );
    let (folder, mut desk) = desk(&high);
    fit(&mut desk, folder.path());
    let lengths = |desk: &Desk| -> Vec<f64> {
        let rows = desk.rows_of("Residual of");
        rows.iter()
            .map(|(_, cells)| cells[4].parse().expect("a length"))
            .collect()
    };
    let listed = lengths(&desk);
    let mut wanted = listed.clone();
    wanted.sort_by(|a, b| b.total_cmp(a));
    assert_eq!(listed.len(), 5);
    assert_ne!(listed, wanted, "the list's order is another one");
    desk.click(Role::Button, "Sort by length");
    assert_eq!(lengths(&desk), wanted);

    desk.node(Role::Button, "Copy table").click();
    desk.harness.step();
    let copied = desk.copied().expect("a table");
    let lines: Vec<Vec<&str>> = copied
        .lines()
        .map(|line| line.split('\t').collect())
        .collect();
    assert_eq!(
        lines[0],
        ["position", "dE m", "dN m", "dU m", "length m", "used"]
    );
    assert_eq!(lines.len(), 6);
    for (line, wanted) in lines[1..].iter().zip(wanted) {
        let numbers: Vec<f64> = line[1..5]
            .iter()
            .map(|n| n.parse().expect("a number"))
            .collect();
        assert_eq!(numbers[3], wanted);
        let length = DVec3::from_slice(&numbers).length();
        assert!((length - wanted).abs() < 2e-4, "{line:?}");
    }

    // What is typed next is about another fit.
    desk.fill("Coordinate system", "EPSG:32633");
    assert!(desk.open().georeferencing.outcome.is_none());
    assert!(!desk.shows(Role::Button, "Save and open…"));
}

#[test]
fn positions_on_a_line_are_refused_in_a_sentence() {
    let mut line = "photo,x,y,z\n".to_owned();
    for i in 1..=5 {
        line.push_str(&format!("img_{i}.jpg,{},5000000,150\n", 500_000 + 3 * i));
    }
    let (folder, mut desk) = desk(&line);
    fit(&mut desk, folder.path());
    assert!(desk.says("list.csv: "));
    assert!(desk.says("lie on a line"));
    assert!(desk.says("add positions beside it, such as ground control points"));
    assert!(!desk.shows(Role::Button, "Save and open…"));
    assert!(desk.rows_of("Residual of").is_empty());
}

#[test]
fn a_measured_distance_gives_the_scale() {
    let (folder, mut desk) = desk(&positions());
    desk.click(Role::RadioButton, "Known distance");
    assert!(desk.says("type two points and their distance"));
    desk.harness.state_mut().apply(Command::ToggleMeasure);
    for x in [1.25, 3.25] {
        let origin = DVec3::new(x, 1.5, 0.0);
        let direction = DVec3::Z;
        desk.harness
            .state_mut()
            .apply(Command::Click(Ray { origin, direction }));
        desk.settle();
    }
    assert!(matches!(desk.open().pointer.measure, Measure::Both(..)));
    // Two of the model's units are six metres.
    desk.fill("Length in metres", "6,0");
    desk.click(Role::Button, "Take the measured points");
    assert_eq!(
        desk.open().georeferencing.form.distances,
        "1.25,1.5,10 3.25,1.5,10 6.0"
    );
    desk.click(Role::CheckBox, "Level by the ground");
    desk.click(Role::Button, "Fit to what is known");
    assert!(desk.says("Scale: 3.000000 m to one"));
    assert!(desk.says("from one distance that nothing checks"));
    assert!(desk.says("6.0000 m known, 6.0000 m fitted"));
    desk.click(Role::Button, "Save and open…");
    desk.type_path(&folder.path().join("to scale.toml"));
    desk.click(Role::Button, "Save and open");
    assert_eq!(desk.open().files.crs, None);
    assert_scales(&desk);
    // Cameras above, now.
    let open = desk.open();
    let center = open.flight().parts().photos[0].pose.center;
    assert!((center.z - open.extent.surface.max.z - 30.0).abs() < 1e-6);
}

#[test]
fn a_file_is_replaced_only_when_she_says_so() {
    let (folder, mut desk) = desk(&positions());
    let target = folder.path().join("model-georeferenced.toml");
    fs::write(&target, "mine").expect("written");
    fit(&mut desk, folder.path());
    desk.click(Role::Button, "Save and open…");
    desk.click(Role::Button, "Save and open");
    assert!(desk.says("There is a file already"));
    desk.click(Role::Button, "Keep the file");
    assert_eq!(fs::read_to_string(&target).expect("a file"), "mine");
    desk.click(Role::Button, "Save and open");
    desk.click(Role::Button, "Replace it");
    assert_eq!(
        desk.open().files.origin.flight_file(),
        Some(target.as_path())
    );
    assert_scales(&desk);
}

/// A surface that was scanned in the world stays where it is.
#[test]
fn a_surface_in_the_world_is_kept_where_she_says_so() {
    let (folder, mut desk) = desk(&positions());
    let scan = folder.path().join("scan.xyz");
    let mut text = String::new();
    // 60 m below the cameras: 16.7 px/m.
    for i in 0..21 * 21 {
        let (x, y) = (500_000 + 5 * (i % 21) - 50, 5_000_000 + 5 * (i / 21) - 50);
        text.push_str(&format!("{x} {y} 90\n"));
    }
    fs::write(&scan, text).expect("written");
    desk.harness.state_mut().apply(Command::Add(scan.clone()));
    desk.settle();
    ask(&mut desk);
    fit(&mut desk, folder.path());
    desk.click(Role::Button, "Save and open…");
    desk.click(Role::CheckBox, "Keep the surface scan.xyz");
    desk.click(Role::Button, "Save and open");
    assert!(desk.open().files.origin.flight_file().is_some());
    assert!(!desk.open().is_changed());
    for photo in 0..5 {
        let top = desk.open().scale(photo).expect("a scale").scale.top;
        assert!((top.expect("a scale") - 1000.0 / 60.0).abs() < 1e-4);
    }
}

#[test]
fn only_reconstructions_are_georeferenced() {
    let desk = Desk::new(Some(&flight("tests/windrow")));
    assert_eq!((GEOREFERENCE.command)(desk.harness.state().state()), None);
    // Here the flight.toml says where it is.
    let folder = tempfile::tempdir().expect("a folder");
    model(folder.path());
    let text = "format = 1\n[world]\nunit = \"m\"\ncrs = \"EPSG:32632\"\n[photos]\nreconstruction = \".\"\n";
    let path = folder.path().join("known.toml");
    fs::write(&path, text).expect("written");
    let mut desk = Desk::new(Some(&path));
    ask(&mut desk);
    assert!(desk.says("is in the world already: EPSG:32632 in its flight.toml"));
    assert!(!desk.shows(Role::Button, "Fit to what is known"));
    // As the command takes the model behind a flight.
    desk.click(Role::Button, "Open the reconstruction");
    ask(&mut desk);
    assert!(desk.shows(Role::Button, "Fit to what is known"));
}
