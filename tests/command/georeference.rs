//! `fragscale georeference`: from a reconstruction in a frame of its own to scales in metres.

use crate::own_frame;

use std::fs;
use std::path::Path;

use crate::common::{fragscale, scale, scales_json, stdout_of};
use fragscale_test_data::shared_data;
use own_frame::{CENTERS, model, positions};
use serde_json::Value;

fn text(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

fn command<'a>(model: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    [&["georeference", text(model)], more].concat()
}

/// 1000 px at 30 m are 33.3 px/m.
#[test]
fn known_positions_give_scales_in_metres() {
    let folder = tempfile::tempdir().expect("a folder");
    model(folder.path());
    let (list, flight) = (
        folder.path().join("list.csv"),
        folder.path().join("world.toml"),
    );
    fs::write(&list, positions()).expect("written");
    let arguments = [
        "georeference",
        text(folder.path()),
        "--positions",
        text(&list),
        "--crs",
        "EPSG:32632",
        "--format",
        "json",
        "-o",
        text(&flight),
    ];
    let said: Value = serde_json::from_str(&stdout_of(&arguments)).expect("JSON");
    assert_eq!(
        (&said["crs"], &said["unit"]),
        (&"EPSG:32632".into(), &"m".into())
    );
    assert!((said["scale"].as_f64().expect("a number") - 3.0).abs() < 1e-9);
    assert!(said["rms"].as_f64().expect("a number") < 1e-6);
    let scales = scales_json(&flight, &[]);
    let photos = scales["photos"].as_array().expect("photos");
    assert_eq!((photos.len(), &scales["world_unit"]), (5, &"m".into()));
    for photo in photos {
        for edge in ["top", "bottom", "left", "right"] {
            // In px/cm.
            let scale = scale(photo, edge).expect("a scale");
            assert!((scale - 1.0 / 3.0).abs() < 1e-6, "{scale}");
        }
    }
}

/// What `reconstruct` leaves of photos without places: a flight without a unit, and its model beside it. Its numbers
/// are called no scales, once; and the flight is taken where its model is meant.
#[test]
fn a_flight_without_a_unit_is_brought_to_the_world() {
    let folder = tempfile::tempdir().expect("a folder");
    let beside = folder.path().join("reconstruction");
    fs::create_dir(&beside).expect("a folder");
    model(&beside);
    let flight = "format = 1\nname = \"North face\"\n[world]\nunit = \"unknown\"\n[photos]\nreconstruction = \"reconstruction\"\n";
    fs::write(folder.path().join("flight.toml"), flight).expect("written");
    let output = fragscale(&["scales", text(folder.path())]);
    let table = String::from_utf8(output.stdout).expect("UTF-8");
    let notes = String::from_utf8(output.stderr).expect("UTF-8");
    let says = "in a frame of its own, whose unit nobody states";
    assert_eq!(table.matches(says).count(), 1, "{table}");
    assert!(table.contains("as if that unit were m"), "{table}");
    assert_eq!(notes.matches(says).count(), 1, "{notes}");

    let list = folder.path().join("list.csv");
    fs::write(&list, positions()).expect("written");
    let world = folder.path().join("world.toml");
    let more = ["--positions", text(&list), "-o", text(&world)];
    stdout_of(&command(folder.path(), &more));
    let written = fs::read_to_string(&world).expect("a flight");
    assert!(written.contains("name = \"North face\""), "{written}");
    assert!(
        written.contains("reconstruction = \"reconstruction\""),
        "{written}"
    );
    let scales = scales_json(&world, &[]);
    let top = scale(&scales["photos"][0], "top").expect("a scale");
    assert!((top - 1.0 / 3.0).abs() < 1e-6, "{top}");
    // Distances alone keep no place: of a flight that has one that is said.
    let placed = folder.path().join("placed.toml");
    let in_utm = flight.replace("\"unknown\"", "\"m\"\ncrs = \"EPSG:32632\"");
    fs::write(&placed, in_utm).expect("written");
    let by_length = ["--distance", "0,0,0 0,0,1 2"];
    let said = |of: &Path| {
        let output = fragscale(&command(of, &by_length));
        String::from_utf8(output.stderr).expect("UTF-8")
    };
    let keeps_none = "do not keep here";
    assert!(said(&placed).contains(keeps_none), "{}", said(&placed));
    let of_none = folder.path().join("flight.toml");
    assert!(!said(&of_none).contains(keeps_none), "{}", said(&of_none));
    // A flight with nothing behind it is still none.
    let alone = folder.path().join("alone.toml");
    fs::write(
        &alone,
        flight.replace("\"reconstruction\"\n", "\"nowhere\"\n"),
    )
    .expect("written");
    let error = fragscale(&["georeference", text(&alone), "--positions", text(&list)]);
    let error = String::from_utf8(error.stderr).expect("UTF-8");
    assert!(error.contains("alone.toml"), "{error}");
}

#[test]
fn the_table_and_the_errors_are_lines() {
    let folder = tempfile::tempdir().expect("a folder");
    model(folder.path());
    let list = folder.path().join("list.csv");
    fs::write(&list, positions()).expect("written");
    let table = stdout_of(&command(folder.path(), &["--positions", text(&list)]));
    assert!(table.starts_with("position"), "{table}");
    assert!(
        table.contains("5 of 5 positions used, RMS 0.000 m\n"),
        "{table}"
    );
    let scaled = stdout_of(&command(folder.path(), &["--distance", "0,0,0 -1,0,0 2.5"]));
    assert!(scaled.contains("scale: 2.5 m to one"), "{scaled}");
    // Exit status 1, one line, and no file.
    let flight = folder.path().join("none.toml");
    let output = fragscale(&command(folder.path(), &["-o", text(&flight)]));
    assert_eq!(output.status.code(), Some(1));
    let error = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(error.lines().count(), 1, "{error}");
    assert!(error.contains("nothing is known of its place"), "{error}");
    assert!(!flight.exists());
    let usage = fragscale(&command(folder.path(), &["--distance", "1 2"]));
    assert_eq!(usage.status.code(), Some(2));
}

/// Four of five cameras, at the corners of a rectangle, have positions that are 0.3 m too high and too low
/// in turn. No similarity follows that, so the residuals are these, and with S the sum of the squares of
/// the distances from the long axis (the y of the cameras, from their mean, times 3: 82.8 m²) the turn about
/// it is known to sqrt(4 · 0.3² / (3 · 5 - 7) / S) = 0.023313 rad = 1.335715 degrees.
#[test]
fn the_rotations_standard_error_is_in_degrees() {
    let folder = tempfile::tempdir().expect("a folder");
    model(folder.path());
    let mut list = "photo,x,y,z\n".to_owned();
    for (i, ([x, y, z], way)) in CENTERS.iter().zip([1.0, -1.0, 1.0, -1.0, 0.0]).enumerate() {
        let (x, y, z) = (5e5 + 3.0 * x, 5e6 - 3.0 * y, 150.0 - 3.0 * z + 0.3 * way);
        list += &format!("img_{}.jpg,{x},{y},{z}\n", i + 1);
    }
    let path = folder.path().join("list.csv");
    fs::write(&path, list).expect("written");
    let arguments = ["--positions", text(&path), "--format", "json"];
    let said = stdout_of(&command(folder.path(), &arguments));
    let said: Value = serde_json::from_str(&said).expect("JSON");
    let degrees = said["rotation_standard_error_degrees"].as_f64();
    let degrees = degrees.expect("a number");
    assert!((degrees - 1.335_715).abs() < 1e-5, "{degrees}");
    // Lengths do not suffer from it; but five positions do not tell that all of their noise is upwards. The mean of a
    // coordinate's square is 4 · 0.3² / 8 = 0.045, of which the level ones have 2 / (8/3 + 2), and the sum of the squares from
    // the middle is 226.8 m²: sqrt(0.045 · 3/7 / 226.8).
    let error = said["scale_standard_error"].as_f64().expect("a number");
    assert!((error - 0.009_221_4).abs() < 1e-6, "{error}");
}

/// COLMAP states nothing of how sure it is; what its photos see does, and the flight counts it.
#[test]
fn a_models_own_errors_are_counted() {
    let Some(model) = shared_data("sceaux-colmap/txt") else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let flight = folder.path().join("world.toml");
    let more = ["--distance", "0,0,0 1,0,0 2.5", "-o", text(&flight)];
    let table = stdout_of(&command(&model, &more));
    assert!(table.contains("poses: ± 0.0"), "{table}");
    let scales = scales_json(&flight, &[]);
    let counted = scales["photos"].as_array().expect("photos").iter();
    let counted: Vec<&Value> = counted
        .map(|photo| &photo["uncertainty"])
        .filter(|of| !of.is_null())
        .collect();
    assert!(!counted.is_empty());
    for of in counted {
        // One distance that nothing checks.
        assert_eq!(of["not_counted"], serde_json::json!(["world"]));
        for part in ["pose", "lens"] {
            let percent = of["parts_percent"][part].as_f64().expect("a number");
            assert!((0.003..0.3).contains(&percent), "{part} {percent}");
        }
    }
}

/// A folder of others' photos is refused before a flight is written that could not be opened; and --level is for distances.
#[test]
fn what_does_not_belong_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    model(folder.path());
    let [list, flight, others] =
        ["list.csv", "world.toml", "others"].map(|name| folder.path().join(name));
    fs::write(&list, positions()).expect("written");
    fs::create_dir(&others).expect("a folder");
    fs::write(others.join("holiday.jpg"), "").expect("written");
    let known = ["--positions", text(&list), "-o", text(&flight)];
    for (photos, why) in [
        (&others, "none of the flight's 5 photos"),
        (&flight, "no such folder"),
    ] {
        let refused = fragscale(&command(
            folder.path(),
            &[&known[..], &["--photos", text(photos)]].concat(),
        ));
        assert_eq!(refused.status.code(), Some(1));
        let error = String::from_utf8(refused.stderr).expect("UTF-8");
        assert!(error.contains(why) && error.lines().count() == 1, "{error}");
        assert!(!flight.exists());
    }
    // In folders within the named one, beside a picture that is none of them.
    let mine = folder.path().join("mine");
    for name in ["logo.jpg", "sub1/IMG_1.JPG", "sub2/IMG_2.JPG"] {
        let path = mine.join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, "").expect("written");
    }
    let arguments = ["--positions", text(&list), "--photos", text(&mine)];
    let done = fragscale(&command(folder.path(), &arguments));
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    let done = fragscale(&command(
        folder.path(),
        &[&known[..], &["--level"]].concat(),
    ));
    assert!(done.status.success());
    let said = String::from_utf8(done.stderr).expect("UTF-8");
    assert!(said.contains("--level is for distances"), "{said}");
}
