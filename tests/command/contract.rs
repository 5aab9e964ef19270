//! The command as the contract has it (sections 5 and 6): formats, exit status, one-line errors,
//! files that are there whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{fragscale, scale, scales_json, stdout_of};
use serde_json::Value;
use tempfile::TempDir;

fn sample() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/windrow")
}

/// A copy of the sample to spoil.
fn copy() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for entry in fs::read_dir(sample()).expect("the sample") {
        let path = entry.expect("an entry").path();
        fs::copy(&path, folder.path().join(path.file_name().expect("a name"))).expect("a copy");
    }
    folder
}

fn edit(folder: &TempDir, file: &str, from: &str, to: &str) {
    let path = folder.path().join(file);
    let text = fs::read_to_string(&path).expect("the file");
    assert!(text.contains(from), "{file} does not contain {from:?}");
    fs::write(path, text.replacen(from, to, 1)).expect("written");
}

/// The error line of a run that must fail with status 1 and say nothing else.
fn error_of(arguments: &[&str]) -> String {
    let output = fragscale(arguments);
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {stderr}");
    assert!(
        output.stdout.is_empty(),
        "{arguments:?} wrote to standard output"
    );
    assert_eq!(stderr.lines().count(), 1, "{stderr}");
    assert!(stderr.starts_with("error: "), "{stderr}");
    stderr
}

#[test]
fn a_folder_with_a_flight_is_the_flight() {
    let folder = sample();
    let of_folder = scales_json(&folder, &[]);
    assert_eq!(of_folder, scales_json(&folder.join("flight.toml"), &[]));
    assert_eq!(of_folder["unit"], "cm");
    assert_eq!(of_folder["world_unit"], "m");
}

#[test]
fn json_has_the_contracts_keys_in_its_order() {
    let flight = sample().join("flight.toml");
    let text = stdout_of(&[
        "scales",
        flight.to_str().expect("UTF-8"),
        "--format",
        "json",
    ]);
    let keys = [
        "\"flight\"",
        "\"unit\"",
        "\"world_unit\"",
        "\"photos\"",
        "\"photo\"",
        "\"width\"",
        "\"height\"",
        "\"ground\"",
        "\"scale\"",
        "\"top\"",
        "\"right\"",
        "\"bottom\"",
        "\"left\"",
        "\"corners\"",
        "\"name\"",
        "\"pixel\"",
        "\"direction\"",
        "\"point\"",
        "\"on\"",
        "\"fitted\"",
        "\"rms_percent\"",
        "\"worst_percent\"",
        "\"covered\"",
        "\"left_right_percent\"",
        "\"uncertainty\"",
    ];
    let places: Vec<usize> = keys.iter().map(|key| text.find(key).expect(key)).collect();
    assert!(places.is_sorted(), "{places:?}");
    let report: Value = serde_json::from_str(&text).expect("JSON");
    let corners = report["photos"][0]["corners"].as_array().expect("corners");
    let names: Vec<&str> = corners
        .iter()
        .map(|c| c["name"].as_str().expect("a name"))
        .collect();
    assert_eq!(
        names,
        ["top_left", "top_right", "bottom_right", "bottom_left"]
    );
    assert_eq!(corners[2]["pixel"], serde_json::json!([1280.0, 720.0]));
    assert_eq!(report["photos"][0]["ground"], Value::Null);
}

#[test]
fn units_are_related_as_they_are() {
    let per_m = scales_json(&sample(), &["--unit", "m"]);
    for (unit, metres) in [("mm", 0.001), ("cm", 0.01), ("in", 0.0254), ("ft", 0.3048)] {
        let per_unit = scales_json(&sample(), &["--unit", unit]);
        let top = |report: &Value| scale(&report["photos"][4], "top").expect("a scale");
        let ratio = top(&per_unit) / top(&per_m);
        assert!((ratio / metres - 1.0).abs() < 1e-14, "{unit}: {ratio}");
    }
}

#[test]
fn csv_has_the_contracts_columns_and_the_same_numbers() {
    let flight = sample();
    let flight = flight.to_str().expect("UTF-8");
    let text = stdout_of(&["scales", flight, "--format", "csv", "--unit", "in"]);
    let json = scales_json(&sample(), &["--unit", "in"]);
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some(
            "photo,width_px,height_px,top_px_per_in,bottom_px_per_in,left_px_per_in,\
             right_px_per_in,fitted_top_px_per_in,fitted_bottom_px_per_in,off_line_rms_percent,\
             covered,top_low,top_high,bottom_low,bottom_high,fitted_top_low,fitted_top_high,\
             fitted_bottom_low,fitted_bottom_high,corners_on_surface,verdict,reasons,note"
        )
    );
    let first: Vec<&str> = lines.next().expect("a photo").split(',').collect();
    assert_eq!(first[..3], ["IMG_0001.jpg", "1280", "720"]);
    for (column, edge) in [(3, "top"), (4, "bottom"), (5, "left"), (6, "right")] {
        assert_eq!(first[column].parse().ok(), scale(&json["photos"][0], edge));
    }
    let fitted = &json["photos"][0]["fitted"];
    for (column, key) in [
        (7, "top"),
        (8, "bottom"),
        (9, "rms_percent"),
        (10, "covered"),
    ] {
        assert_eq!(first[column].parse().ok(), fitted[key].as_f64(), "{key}");
    }
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let first = reader.records().next().expect("a photo").expect("a line");
    let photo = &json["photos"][0];
    let reasons = photo["reasons"].as_array().expect("reasons").iter();
    let reasons: Vec<&str> = reasons.map(|r| r.as_str().expect("words")).collect();
    let verdict = photo["verdict"].as_str().expect("a verdict");
    let expected = ["4", verdict, &reasons.join("; "), ""];
    assert_eq!(first.iter().skip(19).collect::<Vec<_>>(), expected);
    assert_eq!(lines.count(), 8);
}

/// Who names a file for a spreadsheet gets what a spreadsheet reads; the format that is named counts more.
#[test]
fn the_files_name_says_the_format() {
    let folder = tempfile::tempdir().expect("a folder");
    let flight = sample();
    let flight = flight.to_str().expect("UTF-8");
    let written = |name: &str, more: &[&str]| {
        let path = folder.path().join(name);
        let path = path.to_str().expect("UTF-8");
        stdout_of(&[&["scales", flight, "-o", path][..], more].concat());
        fs::read_to_string(path).expect("the file")
    };
    for format in ["csv", "json", "table"] {
        let expected = stdout_of(&["scales", flight, "--format", format]);
        assert_eq!(written(&format!("scales.{format}"), &[]), expected);
        assert_eq!(written("scales.CSV", &["--format", format]), expected);
    }
}

/// A corner that fell back or failed is said in the export and on standard error; exit status 0.
#[test]
fn what_fell_back_is_said_everywhere() {
    let folder = copy();
    edit(
        &folder,
        "poses.csv",
        "IMG_0001.jpg,-0.652,",
        "IMG_0001.jpg,-1.5,",
    );
    edit(&folder, "poses.csv", ",0.747,82.7,", ",0.747,5,");
    let path = folder.path().to_str().expect("UTF-8");
    let output = fragscale(&["scales", path, "--format", "csv"]);
    assert_eq!(output.status.code(), Some(0));
    let (stdout, stderr) = (
        String::from_utf8(output.stdout).expect("UTF-8"),
        String::from_utf8(output.stderr).expect("UTF-8"),
    );
    let fell_back = "top_left, bottom_left: off the surface, taken on the ground at z = ";
    assert!(stdout.contains(fell_back), "{stdout}");
    assert!(
        stderr.contains(&format!("warning: IMG_0001.jpg: {fell_back}")),
        "{stderr}"
    );
    assert!(
        stderr.contains("warning: IMG_0002.jpg: no scale: "),
        "{stderr}"
    );
    // In the table verdict and reason say it once.
    let table = fragscale(&["scales", path]);
    let table = String::from_utf8(table.stdout).expect("UTF-8");
    assert!(table.contains("\nIMG_0002.jpg: no scale: "), "{table}");
    assert!(!table.contains("no scale: no scale"), "{table}");
    // No top scale, no number.
    assert!(stdout.contains("\nIMG_0002.jpg,1280,720,,"), "{stdout}");
    let json = scales_json(folder.path(), &[]);
    let photo = &json["photos"][0];
    assert_eq!(photo["corners"][0]["on"], "ground");
    assert_eq!(photo["corners"][0]["point"][2], photo["ground"]);
    assert_eq!(json["photos"][1]["corners"][0]["on"], Value::Null);
    assert_eq!(json["photos"][1]["corners"][0]["point"], Value::Null);
    assert_eq!(json["photos"][1]["scale"]["top"], Value::Null);
}

#[test]
fn the_output_file_is_whole_or_not_there() {
    let folder = copy();
    let path = folder.path().to_str().expect("UTF-8");
    let output = folder.path().join("scales.csv");
    let name = output.to_str().expect("UTF-8");
    let printed = stdout_of(&["scales", path, "--format", "csv", "-o", name]);
    assert_eq!(printed, "");
    assert!(
        fs::read_to_string(&output)
            .expect("written")
            .starts_with("photo,")
    );
    // No spreadsheet opens a table for people.
    let book = folder.path().join("scales.xlsx");
    let refused = error_of(&["scales", path, "-o", book.to_str().expect("UTF-8")]);
    assert!(
        refused.contains("is written here, and nothing as .xlsx; end the name in .csv"),
        "{refused}"
    );
    assert!(!book.exists());
    // A run that fails leaves what was there, and nothing beside it.
    edit(&folder, "poses.csv", "83,1.2", "83,east");
    let before = fs::read_dir(folder.path()).expect("a folder").count();
    error_of(&["scales", path, "-o", name]);
    assert!(
        fs::read_to_string(&output)
            .expect("still there")
            .starts_with("photo,")
    );
    assert_eq!(
        fs::read_dir(folder.path()).expect("a folder").count(),
        before
    );
    let nowhere = error_of(&[
        "scales",
        sample().to_str().expect("UTF-8"),
        "-o",
        "no/such/place.csv",
    ]);
    assert!(
        nowhere.contains("no/such/place.csv: it cannot be written"),
        "{nowhere}"
    );
}

#[test]
fn another_surface_can_be_given() {
    let folder = copy();
    let plane = folder.path().join("plane.xyz");
    fs::write(&plane, "-9 -9 0\n9 -9 0\n9 9 0\n-9 9 0\n").expect("written");
    let plane = plane.to_str().expect("UTF-8");
    let report = scales_json(folder.path(), &["--surface", plane, "--unit", "m"]);
    let height = 0.752;
    // Near f / height, lower at the top edge, where the ground is farther.
    let top = scale(&report["photos"][0], "top").expect("a scale");
    let bottom = scale(&report["photos"][0], "bottom").expect("a scale");
    assert!(
        top < bottom && (bottom / (1012.5 / height) - 1.0).abs() < 0.05,
        "{top} {bottom}"
    );
}

#[test]
fn errors_name_the_file_the_place_and_the_remedy() {
    let spoil = |file: &str, from: &str, to: &str| {
        let folder = copy();
        edit(&folder, file, from, to);
        let path = folder.path().join("flight.toml");
        let line = error_of(&["scales", path.to_str().expect("UTF-8")]);
        line.replace(&format!("{}/", folder.path().display()), "")
    };
    let line = spoil("flight.toml", "ground", "grund");
    assert_eq!(
        line,
        "error: flight.toml:6: unknown key 'grund' in [world]; did you mean 'ground'?\n"
    );
    let line = spoil("poses.csv", "-0.413", "nan");
    assert!(
        line.starts_with("error: poses.csv:3: column y: 'nan' is not"),
        "{line}"
    );
    let line = spoil("poses.csv", "IMG_0002.jpg", "IMG_0001.jpg");
    assert!(
        line.starts_with("error: poses.csv:4: column photo: 'IMG_0001.jpg'"),
        "{line}"
    );
    let line = spoil("ost.yaml", "1012.5", "0");
    assert!(line.starts_with("error: ost.yaml:"), "{line}");
    let line = spoil(
        "pile.ply",
        "format ascii 1.0",
        "format binary_little_endian 1.0",
    );
    assert!(line.starts_with("error: pile.ply"), "{line}");
    let line = spoil("flight.toml", "pile.ply", "mound.ply");
    assert!(
        line.starts_with("error: mound.ply: there is no such file"),
        "{line}"
    );
    let line = spoil("flight.toml", "pile.ply", "poses.csv");
    assert!(line.contains("it holds poses, not a surface"), "{line}");
    let line = error_of(&["scales", sample().join("pile.ply").to_str().expect("UTF-8")]);
    assert!(
        line.contains("it holds a cloud or mesh, not a flight"),
        "{line}"
    );
    error_of(&["scales", "no/such/flight.toml"]);
    error_of(&["info", "src"]);
}

#[test]
fn a_command_line_that_is_not_understood_ends_with_2() {
    for arguments in [
        &["scales"][..],
        &["scales", "a", "--unit", "furlong"],
        &["scales", "a", "--format", "yaml"],
        &["scails", "a"],
        &["info"],
        // With the window, no command means the window.
        #[cfg(not(feature = "app"))]
        &[],
        #[cfg(feature = "app")]
        &["no such flight"],
    ] {
        let output = fragscale(arguments);
        let stderr = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert!(
            stderr.starts_with("error: ") && stderr.lines().count() == 1,
            "{stderr}"
        );
    }
    assert!(stdout_of(&["--help"]).contains("scales"));
    assert!(stdout_of(&["--version"]).starts_with("fragscale "));
}

/// The window needs a screen, and says what does not.
#[cfg(all(feature = "app", target_os = "linux"))]
#[test]
fn without_a_screen_there_is_no_window() {
    for arguments in [&[][..], &[sample().to_str().expect("UTF-8")]] {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_fragscale"))
            .args(arguments)
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .output()
            .expect("the command starts");
        let stderr = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(1), "{stderr}");
        assert!(
            stderr.starts_with("error: there is no screen") && stderr.lines().count() == 1,
            "{stderr}"
        );
    }
}

/// A mistyped command is not taken for a flight.
#[cfg(feature = "app")]
#[test]
fn a_mistyped_command_is_recognised() {
    let output = fragscale(&["scails", "a"]);
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(
        stderr.contains("'scails' is neither a command (perhaps 'scales')"),
        "{stderr}"
    );
}

/// The help of all commands is no answer to one that is not there: a chapter of the manual is called so.
#[cfg(feature = "app")]
#[test]
fn help_for_no_command_says_so() {
    for help in ["--help", "-h"] {
        let output = fragscale(&["season", help]);
        let stderr = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(2), "{stderr}");
        assert!(
            stderr.contains("'season' is neither a command (perhaps 'batch')"),
            "{stderr}"
        );
        assert!(output.stdout.is_empty());
    }
    // clap's own word for it.
    let output = fragscale(&["help", "season"]);
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(!stderr.contains("'help' is neither"), "{stderr}");
    for words in [
        &["help"][..],
        &["help", "batch"],
        &["batch", "--help"],
        &["--help"],
    ] {
        assert_eq!(fragscale(words).status.code(), Some(0), "{words:?}");
    }
}

/// A flight's folder that is called like a command: how it is opened is told.
#[cfg(feature = "app")]
#[test]
fn a_folder_that_is_called_like_a_command_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("sample")).expect("a folder");
    let run = |arguments: &[&str]| {
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_fragscale"))
            .args(arguments)
            .current_dir(folder.path())
            .output()
            .expect("the program");
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).expect("UTF-8")
    };
    let stderr = run(&["sample"]);
    assert!(
        stderr.contains(
            "'sample' is a command; to open the folder of that name type 'fragscale ./sample'"
        ),
        "{stderr}"
    );
    assert_eq!(stderr.lines().count(), 1, "{stderr}");
    // Without such a folder there is nothing to mix up.
    let stderr = run(&["scales"]);
    assert!(!stderr.contains("./scales"), "{stderr}");
}

#[test]
fn info_says_what_was_understood() {
    let info = |name: &str| -> Value {
        let path = sample().join(name);
        let text = stdout_of(&["info", path.to_str().expect("UTF-8"), "--format", "json"]);
        serde_json::from_str(&text).expect("JSON")
    };
    let cloud = info("pile.ply");
    assert_eq!(cloud["kind"], "cloud");
    assert_eq!(cloud["points"], 82 * 61);
    assert_eq!(cloud["faces"], 0);
    assert_eq!(cloud["colors"], true);
    assert_eq!(
        cloud["bounds"]["min"],
        serde_json::json!([-1.6, -1.2, -0.024])
    );
    assert_eq!(cloud["crs"], Value::Null);
    let camera = &info("ost.yaml")["cameras"][0];
    assert_eq!(camera["name"], "bebop");
    assert_eq!(
        (&camera["width"], &camera["cx"]),
        (&1280.into(), &637.75.into())
    );
    assert_eq!(camera["distortion"], "brown");
    assert_eq!(camera["coefficients"][3], -0.0003);
    let poses = info("poses.csv");
    assert_eq!(
        poses["photos"][8]["center"],
        serde_json::json!([0.657, 0.407, 0.75])
    );
    let flight = info("flight.toml");
    assert_eq!(flight["kind"], "flight");
    assert_eq!(flight["photos"].as_array().map(Vec::len), Some(9));
    let text = stdout_of(&["info", sample().join("pile.ply").to_str().expect("UTF-8")]);
    assert!(text.contains("kind: cloud"), "{text}");
}
