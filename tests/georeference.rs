//! `fragscale georeference`: from a reconstruction in a frame of its own to scales in metres.

#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    missing_docs,
    reason = "in a test or a benchmark a panic is the report"
)]

mod common;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use common::{fragscale, scale, scales_json, stdout_of};
use serde_json::Value;

/// A COLMAP model, and a flight.toml with the transform that its maker put it into the world by.
fn fixture() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/colmap-text-points")
}

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// The sixteen numbers of the fixture's flight.toml.
fn transform() -> Vec<f64> {
    let file = fs::read_to_string(fixture().join("flight.toml")).expect("the flight");
    let inside = file.split("transform = [").nth(1).expect("a transform");
    let inside = inside.split(']').next().expect("its end");
    let numbers = inside.split(',').map(str::trim).filter(|n| !n.is_empty());
    numbers.map(|n| n.parse().expect("a number")).collect()
}

/// A list of where the cameras stand in the world.
fn positions() -> String {
    let info = stdout_of(&["info", text(&fixture().join("sparse/0")), "--format", "json"]);
    let info: Value = serde_json::from_str(&info).expect("JSON");
    let m = transform();
    let mut list = "photo,x,y,z\n".to_owned();
    for photo in info["photos"].as_array().expect("photos") {
        let c: Vec<f64> = (photo["center"].as_array().expect("a centre").iter())
            .map(|x| x.as_f64().expect("a number"))
            .collect();
        let at = |row: usize| (0..3).map(|i| m[4 * row + i] * c[i]).sum::<f64>() + m[4 * row + 3];
        let name = photo["photo"].as_str().expect("a name");
        writeln!(list, "{name},{},{},{}", at(0), at(1), at(2)).expect("written");
    }
    list
}

/// The flight that is written has the scales of the flight that its maker wrote.
#[test]
fn known_positions_give_the_makers_scales() {
    let folder = tempfile::tempdir().expect("a folder");
    let list = folder.path().join("list.csv");
    let flight = folder.path().join("world.toml");
    fs::write(&list, positions()).expect("written");
    let model = fixture().join("sparse/0");
    let arguments = [
        "georeference", text(&model), "--positions", text(&list), "--crs", "EPSG:32632",
        "--format", "json", "-o", text(&flight),
    ];
    let said: Value = serde_json::from_str(&stdout_of(&arguments)).expect("JSON");
    assert_eq!(said["crs"], "EPSG:32632");
    for (found, made) in said["transform"].as_array().expect("numbers").iter().zip(transform()) {
        let found = found.as_f64().expect("a number");
        assert!((found - made).abs() < 1e-6, "{found} for {made}");
    }
    assert!(said["rms"].as_f64().expect("a number") < 1e-6);
    let (ours, makers) = (scales_json(&flight, &[]), scales_json(&fixture(), &[]));
    let pairs = ours["photos"].as_array().expect("photos").iter().zip(makers["photos"].as_array().expect("photos"));
    let mut compared = 0;
    for (ours, makers) in pairs {
        assert_eq!(ours["photo"], makers["photo"]);
        // The fixture's scales are those of the photos as shot, ours of undistorted ones: the corner
        // rays differ, the frame does not. So the ground is compared, and that there is a scale.
        let (a, b) = (scale(ours, "top"), scale(makers, "top"));
        assert_eq!(a.is_some(), b.is_some());
        if let (Some(a), Some(b)) = (a, b) {
            assert!((a / b - 1.0).abs() < 0.2, "{a} {b}");
            compared += 1;
        }
    }
    assert!(compared > 0);
}

#[test]
fn the_table_and_the_errors_are_lines() {
    let folder = tempfile::tempdir().expect("a folder");
    let list = folder.path().join("list.csv");
    fs::write(&list, positions()).expect("written");
    let model = fixture().join("sparse/0");
    let table = stdout_of(&["georeference", text(&model), "--positions", text(&list)]);
    assert!(table.starts_with("position"), "{table}");
    assert!(table.contains(" used, RMS 0.000 m\n"), "{table}");
    assert!(table.contains("scale: 6.8"), "{table}");
    let scaled = stdout_of(&["georeference", text(&model), "--distance", "0,0,0 -1,0,0 2.5"]);
    assert!(scaled.contains("scale: 2.5 m to one"), "{scaled}");
    // Exit status 1 and one line, and no file.
    let flight = folder.path().join("none.toml");
    let output = fragscale(&["georeference", text(&model), "-o", text(&flight)]);
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(error.lines().count(), 1, "{error}");
    assert!(error.contains("nothing is known of its place"), "{error}");
    assert!(!flight.exists());
    let usage = fragscale(&["georeference", text(&model), "--distance", "1 2"]);
    assert_eq!(usage.status.code(), Some(2));
}
