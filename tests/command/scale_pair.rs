//! `[scale] use`: which pair of scales an export carries, from the flight file to sheet, CSV and map.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{scales_json, stdout_of};
use serde_json::Value;

fn text_of(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// A copy of the bundled flight that says so.
fn flight_with(folder: &Path, words: &str) -> PathBuf {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    let flight = folder.join("flight");
    fs::create_dir_all(flight.join("photos")).expect("made");
    for name in ["pile.ply", "ost.yaml", "poses.csv"] {
        fs::copy(sample.join(name), flight.join(name)).expect("copied");
    }
    for entry in fs::read_dir(sample.join("photos")).expect("photos") {
        let entry = entry.expect("a photo");
        fs::copy(entry.path(), flight.join("photos").join(entry.file_name())).expect("copied");
    }
    let text = fs::read_to_string(sample.join("flight.toml")).expect("a flight");
    fs::write(flight.join("flight.toml"), format!("{text}{words}")).expect("written");
    flight
}

/// What follows each of these marks in the sheet, up to the next blank or tag.
fn after<'a>(sheet: &'a str, mark: &'a str) -> Vec<&'a str> {
    let found = sheet.split(mark).skip(1);
    found
        .map(|rest| rest.split(['<', ' ']).next().expect("a word"))
        .collect()
}

/// The text is the number, rounded to the text's decimals (none where it ends in rounded tens).
fn assert_is(text: &str, number: f64) {
    let decimals = text
        .split_once('.')
        .map_or(0, |(_, decimals)| decimals.len());
    assert_eq!(text, format!("{number:.decimals$}"), "{number}");
    // An interval of the bundled flight leaves at least these.
    assert!(text.len() >= 3, "{text}");
}

#[test]
fn the_export_carries_the_pair_in_use() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("export");
    let ways = [
        ("fitted", "", "fitted", "scale"),
        ("fitted", "[scale]\nuse = \"fitted\"\n", "fitted", "scale"),
        ("corners", "[scale]\nuse = \"corners\"\n", "scale", "fitted"),
    ];
    let mut overlays = Vec::new();
    let mut tables = Vec::new();
    for (way, (pair, words, used, beside)) in ways.into_iter().enumerate() {
        let flight = flight_with(folder.path(), words);
        let said = stdout_of(&["export", text_of(&flight), "--to", text_of(&to)]);
        // Their bars have other lengths, so they are made again; what means the same is kept.
        let made = if way == 1 { 0 } else { 9 };
        assert!(said.contains(&format!("pictures of {made} made")), "{said}");
        let of_export = |name: &str| fs::read(to.join(name)).expect("exported");
        let sheet = String::from_utf8(of_export("scales.html")).expect("UTF-8");
        let map: Value = serde_json::from_slice(&of_export("footprints.geojson")).expect("JSON");
        let csv = String::from_utf8(of_export("scales.csv")).expect("UTF-8");
        overlays.push(of_export("overlays/IMG_0001.jpg"));

        let report = scales_json(&flight, &[]);
        let photos = report["photos"].as_array().expect("photos");
        let other = if pair == "fitted" {
            "corners"
        } else {
            "fitted"
        };
        let big = after(&sheet, "<div class=\"big\">");
        let mark = format!("<div class=\"small\">{other}: ");
        let small = after(&sheet, &mark);
        assert_eq!((big.len(), small.len()), (18, 18));
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let heads = reader.headers().expect("a header").clone();
        let lines: Vec<csv::StringRecord> = reader.records().map(|l| l.expect("a line")).collect();
        for (index, photo) in photos.iter().enumerate() {
            let scale = |of: &str, edge: &str| photo[of][edge].as_f64().expect("a scale");
            for (place, edge) in ["top", "bottom"].into_iter().enumerate() {
                assert_is(big[2 * index + place], scale(used, edge));
                assert_is(small[2 * index + place], scale(beside, edge));
                let column = |name: &str| -> f64 {
                    let at = heads
                        .iter()
                        .position(|head| head == name)
                        .expect("a column");
                    lines[index][at].parse().expect("a number")
                };
                let corners = column(&format!("{edge}_px_per_cm"));
                assert_eq!(corners, scale("scale", edge));
                let fitted = column(&format!("fitted_{edge}_px_per_cm"));
                assert_eq!(fitted, scale("fitted", edge));
                let feature = &map["features"][index]["properties"];
                assert_eq!(feature["use"], pair);
                assert_eq!(feature[edge], photo["scale"][edge]);
                assert_eq!(feature[format!("fitted_{edge}")], photo["fitted"][edge]);
            }
        }
        tables.push(csv);
    }
    // The table holds both pairs whichever is in use; what is doubted is what goes along.
    let numbers = |table: &String| -> Vec<String> {
        let lines = table.lines();
        let cut = |line: &str| line.split(',').take(20).collect::<Vec<_>>().join(",");
        lines.map(cut).collect()
    };
    assert!(tables[0].contains(",corners_on_surface,verdict,reasons,note\n"));
    assert_eq!(numbers(&tables[0]), numbers(&tables[2]));
    assert_eq!(overlays[0], overlays[1]);
    assert_ne!(overlays[0], overlays[2]);
}

/// Over half of the photo looks past the pile: there is no line, the corners' scale stands beside, and
/// is what counts where the flight says so.
#[test]
fn without_a_fit_the_corners_count_only_where_they_are_asked_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let photo = "photo,x,y,z,tilt,pan\na.jpg,0,0,2,90,0\n";
    fs::write(folder.path().join("poses.csv"), photo).expect("written");
    // 2 m above a square of 1 m: 1 m2 of the 4 m x 4 m that the photo shows.
    let square = "-0.5 -0.5 0\n0.5 -0.5 0\n0.5 0.5 0\n-0.5 0.5 0\n";
    fs::write(folder.path().join("square.xyz"), square).expect("written");
    let words =
        "no fitted scale: only 6 % of the photo shows the surface, of the 50 % that a line needs";
    for (used, has_scale) in [("fitted", false), ("corners", true)] {
        let flight = format!(
            "format = 1\nname = \"square\"\n[world]\nunit = \"m\"\n[surface]\nfile = \"square.xyz\"\n\
             [[camera]]\nwidth = 400\nheight = 400\nfx = 200.0\nfy = 200.0\ncx = 200.0\ncy = 200.0\n\
             [photos]\nposes = \"poses.csv\"\n[scale]\nuse = \"{used}\"\n"
        );
        let path = folder.path().join("flight.toml");
        fs::write(&path, flight).expect("written");
        let report = scales_json(&path, &["--unit", "m"]);
        assert_eq!(report["photos"][0]["fitted"], Value::Null);
        // On the ground at z = 0: 400 px over 4 m.
        let top = report["photos"][0]["scale"]["top"]
            .as_f64()
            .expect("a scale");
        assert!((top - 100.0).abs() < 1e-9, "{top}");
        let output = crate::common::fragscale(&["scales", text_of(&path)]);
        let err = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(
            err.contains("warning: a.jpg: no scale: "),
            !has_scale,
            "{err}"
        );
        assert_eq!(err.contains(words), !has_scale, "{err}");
        let to = folder.path().join("export");
        stdout_of(&[
            "export",
            text_of(&path),
            "--to",
            text_of(&to),
            "--unit",
            "m",
        ]);
        let sheet = fs::read_to_string(to.join("scales.html")).expect("the sheet");
        assert_eq!(sheet.contains(words), !has_scale);
        assert_eq!(
            sheet.contains("<div class=\"big\">100.00</div>"),
            has_scale,
            "{sheet}"
        );
        assert_eq!(
            sheet.contains("<div class=\"small\">corners: 100.00 px/m</div>"),
            !has_scale
        );
    }
}
