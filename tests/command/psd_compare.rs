//! `psd compare` as its user runs it: one command from a table to the figure, the report and JSON.

use std::fs;
use std::path::Path;

use crate::common::{fragscale, stdout_of};
use serde_json::Value;
use tempfile::TempDir;

/// What a sieve said, in mm.
const SIEVE: [[f64; 2]; 8] = [
    [8.0, 4.0],
    [16.0, 10.0],
    [31.5, 22.0],
    [63.0, 45.0],
    [90.0, 60.0],
    [125.0, 76.0],
    [180.0, 91.0],
    [250.0, 98.0],
];

/// The sieve, and three trials of two methods: the cloud's sizes are all 4 % too large, the object's
/// 10 %. Of the trials one says 1 point (2 points) too much, one as much too little, so that their
/// mean is the curve itself and their standard deviation 1 point (2 points).
fn table() -> String {
    let mut text = String::from("method,trial,size_mm,percent_passing\n");
    for [size, percent] in SIEVE {
        text += &format!("sieve,,{size},{percent}\n");
    }
    for (method, scale, spread) in [("point cloud", 1.04, 1.0), ("scale object", 1.1, 2.0)] {
        for (trial, off) in [(1, -spread), (2, 0.0), (3, spread)] {
            for [size, percent] in SIEVE {
                text += &format!("{method},{trial},{},{}\n", size * scale, percent + off);
            }
        }
    }
    text
}

fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("written");
    }
    folder
}

fn path(folder: &TempDir, name: &str) -> String {
    folder.path().join(name).to_str().expect("UTF-8").to_owned()
}

fn json(arguments: &[&str]) -> Value {
    let mut all = vec!["psd", "compare"];
    all.extend(arguments);
    all.extend(["--format", "json"]);
    serde_json::from_str(&stdout_of(&all)).expect("JSON")
}

/// The one line of an error.
fn error_of(arguments: &[&str]) -> String {
    let mut all = vec!["psd", "compare"];
    all.extend(arguments);
    let output = fragscale(&all);
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {stderr}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    let errors: Vec<&str> = stderr
        .lines()
        .filter(|line| line.starts_with("error: "))
        .collect();
    assert_eq!(errors.len(), 1, "{stderr}");
    errors[0].to_owned()
}

#[test]
fn one_command_gives_the_figure_the_report_and_the_numbers() {
    let folder = folder(&[("distributions.csv", &table())]);
    let [csv, svg, png, html] =
        ["distributions.csv", "out.svg", "out.png", "out.html"].map(|name| path(&folder, name));
    let found = json(&[&csv, "--figure", &svg, "--figure", &png, "--report", &html]);
    assert_eq!(found["unit"], "mm");
    assert_eq!(found["reference"]["method"], "sieve");
    let methods = found["methods"].as_array().expect("methods");
    for (method, (name, shift, spread)) in methods
        .iter()
        .zip([("point cloud", 4.0, 1.0), ("scale object", 10.0, 2.0)])
    {
        assert_eq!(method["method"], name);
        // Sizes that are all too large by a factor have a fit with the same factor.
        for percentile in method["percentiles"].as_array().expect("percentiles") {
            let found = percentile["shift_percent"].as_f64().expect("a shift");
            assert!((found - shift).abs() < 0.01, "{name}: {found}");
        }
        assert_eq!(method["shift"]["looks_like_scale"], true);
        for point in method["points"].as_array().expect("points") {
            let found = point["standard_deviation"].as_f64().expect("a deviation");
            assert!((found - spread).abs() < 1e-9, "{name}: {point}");
        }
    }
    assert!(
        found["improvements"][0]["percent"]
            .as_f64()
            .expect("a percentage")
            > 0.0
    );

    let svg = fs::read_to_string(&svg).expect("a figure");
    let document = roxmltree::Document::parse(&svg).expect("XML");
    let texts: Vec<&str> = document
        .descendants()
        .filter(|node| node.tag_name().name() == "text")
        .filter_map(|node| node.text().map(str::trim))
        .collect();
    for words in [
        "Size, mm",
        "Passing, % of mass",
        "point cloud, scale object against sieve",
    ] {
        assert!(texts.contains(&words), "{words} is not in {texts:?}");
    }
    assert!(
        texts
            .iter()
            .any(|text| text.starts_with("point cloud, 3 trials: Swebrec fit, P50 "))
    );
    let png = image::open(&png).expect("a PNG");
    assert_eq!(png.width(), 1800);

    let html = fs::read_to_string(&html).expect("a report");
    for words in [
        "<svg ",
        "Repeatability",
        "Fitted functions",
        "look at the shift",
        "check the scale",
    ] {
        assert!(html.contains(words), "{words}");
    }
}

/// A sieve in inches, a cloud in mm, each in a file of its own that says nothing of methods.
#[test]
fn files_are_joined_in_the_unit_of_the_first() {
    let sieve: String = SIEVE
        .iter()
        .map(|[size, p]| format!("{},{p}\n", size / 25.4))
        .collect();
    let cloud: String = SIEVE
        .iter()
        .map(|[size, p]| format!("{},{p}\n", size * 1.04))
        .collect();
    let folder = folder(&[
        ("sieve.csv", &format!("size_in,percent_passing\n{sieve}")),
        ("cloud.csv", &format!("size_mm,percent_passing\n{cloud}")),
    ]);
    let found = json(&[&path(&folder, "sieve.csv"), &path(&folder, "cloud.csv")]);
    assert_eq!(found["unit"], "in");
    let method = &found["methods"][0];
    assert_eq!(method["method"], "cloud");
    let shift = method["shift"]["mean_percent"].as_f64().expect("a shift");
    assert!((shift - 4.0).abs() < 0.01, "{shift}");
}

/// Two files of one method: on the command line one of them has another name.
#[test]
fn files_of_one_method_are_told_apart_by_name() {
    let table = |factor: f64| -> String {
        let rows = SIEVE
            .iter()
            .map(|[size, p]| format!("masks,{},{p}\n", size * factor));
        format!(
            "method,size_mm,percent_passing\n{}",
            rows.collect::<String>()
        )
    };
    let folder = folder(&[("a.csv", &table(1.0)), ("b=.csv", &table(1.04))]);
    let (a, b) = (path(&folder, "a.csv"), path(&folder, "b=.csv"));
    let error = error_of(&[&a, &b]);
    assert!(error.contains("'masks' is the only method"), "{error}");
    let found = json(&[&format!("sieve={a}"), &b]);
    assert_eq!(found["reference"]["method"], "sieve");
    assert_eq!(found["methods"][0]["method"], "masks");
    let shift = found["methods"][0]["shift"]["mean_percent"]
        .as_f64()
        .expect("a shift");
    assert!((shift - 4.0).abs() < 0.01, "{shift}");
    let error = error_of(&[
        &format!("sieve={a}"),
        &format!("x={}", path(&folder, "c.csv")),
    ]);
    assert!(error.contains("c.csv") && !error.contains("x="), "{error}");
}

/// Of three photos of a trial the first is half of the area, the others a quarter each: 10, 20 and 60 %
/// are 25 %; with equal weights 30 %.
#[test]
fn photos_are_merged_as_chosen_and_that_is_said() {
    let mut text = String::from("method,photo,area,size_mm,percent_passing\n");
    for [size, percent] in SIEVE {
        text += &format!("sieve,,,{size},{percent}\n");
    }
    for (photo, area, percent) in [("a", 2, 10), ("b", 1, 20), ("c", 1, 60)] {
        text += &format!(
            "cloud,{photo},{area},8,{percent}\ncloud,{photo},{area},63,70\ncloud,{photo},{area},250,99\n"
        );
    }
    let folder = folder(&[("all.csv", &text)]);
    let [csv, html] = ["all.csv", "out.html"].map(|name| path(&folder, name));
    for (merge, mean, words) in [
        ("area", 25.0, "by the area"),
        ("equal", 30.0, "equal weights"),
    ] {
        let found = json(&[&csv, "--merge", merge, "--report", &html]);
        let at_eight = found["methods"][0]["points"][0]["mean"]
            .as_f64()
            .expect("a mean");
        assert!((at_eight - mean).abs() < 1e-9, "{merge}: {at_eight}");
        assert!(fs::read_to_string(&html).expect("a report").contains(words));
    }
}

#[test]
fn resampling_takes_the_series_sieves() {
    let folder = folder(&[("distributions.csv", &table())]);
    let csv = path(&folder, "distributions.csv");
    for (series, sizes) in [("iso", [8.0, 11.2]), ("astm", [8.0, 9.5])] {
        let found = json(&[&csv, "--resample", series]);
        let points = found["reference"]["points"].as_array().expect("points");
        let first: Vec<f64> = points
            .iter()
            .take(2)
            .filter_map(|point| point["size"].as_f64())
            .collect();
        assert_eq!(first, sizes, "{series}");
    }
}

#[test]
fn what_cannot_be_written_is_said_before_anything_is() {
    let folder = folder(&[("distributions.csv", &table())]);
    let csv = path(&folder, "distributions.csv");
    let [gif, bare, svg, txt] =
        ["out.gif", "out", "out.svg", "out.txt"].map(|name| path(&folder, name));
    for (arguments, words) in [
        (
            vec!["none.csv", "--figure", gif.as_str()],
            "out.gif: a figure is written as SVG or PNG",
        ),
        (
            vec![&csv, "--figure", &bare],
            "let its name end in .svg or .png",
        ),
        (
            vec![&csv, "--figure", &svg, "--report", &txt],
            "let its name end in .html",
        ),
        (
            vec![&csv, "--figure", &svg, "--reference", "sive"],
            "no method is called 'sive'",
        ),
        (
            vec![&csv, "--figure", &svg, "--envelope", "300"],
            "an envelope of 300 %",
        ),
        (vec![&csv, &csv, "--figure", &svg], "is there already"),
        (
            vec![&csv, "--figure", "no/such/folder/out.svg"],
            "cannot be written",
        ),
    ] {
        let error = error_of(&arguments);
        assert!(error.contains(words), "{error}");
    }
    let left: Vec<_> = fs::read_dir(folder.path()).expect("the folder").collect();
    assert_eq!(left.len(), 1, "{left:?}");
    assert!(Path::new(&csv).exists());
}

/// The same program's files of two blasts are one method by their words: that they are merged is said, with what calls them apart.
#[test]
fn the_same_file_of_two_blasts_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let curve = |photo: &str, scale: f64| {
        let mut text = String::from("method,trial,photo,size_mm,percent_passing\n");
        for [size, percent] in SIEVE {
            text += &format!("fragscale (learned),,{photo},{},{percent}\n", size * scale);
        }
        text
    };
    for (blast, scale) in [("a", 1.0), ("b", 1.5)] {
        fs::create_dir(folder.path().join(blast)).expect("a folder");
        let text = curve(&format!("{blast}.jpg"), scale);
        fs::write(folder.path().join(blast).join("distribution.csv"), text).expect("written");
    }
    fs::write(folder.path().join("sieve.csv"), table()).expect("written");
    let sieve = path(&folder, "sieve.csv");
    let [a, b] = ["a", "b"].map(|blast| path(&folder, &format!("{blast}/distribution.csv")));
    let said = |arguments: &[&str]| {
        let mut all = vec!["psd", "compare"];
        all.extend(arguments);
        String::from_utf8(fragscale(&all).stderr).expect("UTF-8")
    };
    let both = said(&[&sieve, &a, &b]);
    assert!(
        both.contains("both are taken for one method and merged"),
        "{both}"
    );
    assert!(both.contains(&format!("(A={a} B={b})")), "{both}");
    let apart = said(&[&sieve, &format!("A={a}"), &format!("B={b}")]);
    assert!(!apart.contains("taken for one method"), "{apart}");
}
