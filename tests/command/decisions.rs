//! What the engineer has decided of photos, the `[[review]]` tables: in the lists of scales, in the
//! export, and which photos go along.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{fragscale, scales_json, stdout_of};

/// The sample beside its own photos, with these tables at its end.
fn sample_with(tables: &str) -> TempDir {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["ost.yaml", "poses.csv", "pile.ply"] {
        fs::copy(sample.join(name), folder.path().join(name)).expect("a copy");
    }
    let text = fs::read_to_string(sample.join("flight.toml")).expect("the flight");
    let photos = sample.join("photos");
    let photos = format!("{:?}", photos.to_str().expect("UTF-8"));
    let text = text.replace("\"photos\"", &photos) + tables;
    fs::write(folder.path().join("flight.toml"), text).expect("written");
    folder
}

fn text_of(path: &Path) -> &str {
    path.to_str().expect("UTF-8")
}

/// The values of a CSV's columns, of each photo.
fn csv(text: &str) -> BTreeMap<String, BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let head = reader.headers().expect("a head").clone();
    let lines = reader.records().map(|line| line.expect("a line"));
    lines
        .map(|line| {
            let cells = head.iter().zip(line.iter());
            let cells = cells.map(|(name, cell)| (name.to_owned(), cell.to_owned()));
            (line[0].to_owned(), cells.collect())
        })
        .collect()
}

/// The verdict of each photo in the JSON of `scales`.
fn verdicts(json: &Value) -> BTreeMap<String, String> {
    let word = |value: &Value| value.as_str().expect("a word").to_owned();
    let photos = json["photos"].as_array().expect("photos").iter();
    photos
        .map(|p| (word(&p["photo"]), word(&p["verdict"])))
        .collect()
}

/// A photo that is to check and one that is trusted, with the verdicts of all.
fn one_of_each() -> (String, String, BTreeMap<String, String>) {
    let folder = sample_with("");
    let all = verdicts(&scales_json(folder.path(), &[]));
    let one = |wanted: &str| {
        let mut found = all.iter().filter(|(_, verdict)| *verdict == wanted);
        found.next().expect("the sample has one").0.clone()
    };
    (one("check"), one("trust"), all.clone())
}

#[test]
fn decisions_stand_beside_the_scales() {
    let (doubted, trusted, before) = one_of_each();
    let folder = sample_with(&format!(
        "\n[[review]]\nphoto = \"{doubted}\"\ndecision = \"accepted\"\nnote = \"measured with a tape\"\ndate = \"2026-11-22\"\n\
         \n[[review]]\nphoto = \"{trusted}\"\ndecision = \"left-out\"\nnote = \"a truck\"\n"
    ));
    let json = scales_json(folder.path(), &[]);
    let mut expected = before;
    expected.insert(doubted.clone(), "accepted".to_owned());
    expected.insert(trusted.clone(), "left out".to_owned());
    assert_eq!(verdicts(&json), expected);
    let photos = json["photos"].as_array().expect("photos");
    for photo in photos {
        let name = photo["photo"].as_str().expect("a name");
        let reasons = photo["reasons"].as_array().expect("reasons");
        assert_eq!(
            reasons.is_empty(),
            photo["verdict"] == "trust" || name == trusted
        );
        let decided = match name {
            name if name == doubted => serde_json::json!({
                "decision": "accepted", "note": "measured with a tape", "date": "2026-11-22",
                "reasons_since": [],
            }),
            name if name == trusted => serde_json::json!({
                "decision": "left-out", "note": "a truck", "date": null, "reasons_since": [],
            }),
            _ => Value::Null,
        };
        assert_eq!(photo["decision"], decided, "{name}");
    }
    let lines = csv(&stdout_of(&[
        "scales",
        text_of(folder.path()),
        "--format",
        "csv",
    ]));
    for (photo, verdict) in &expected {
        assert_eq!(&lines[photo]["verdict"], verdict);
    }
    let reasons = &lines[&doubted]["reasons"];
    let end = "; checked, accepted on 2026-11-22: measured with a tape";
    assert!(
        reasons.ends_with(end) && reasons.len() > end.len(),
        "{reasons}"
    );
    assert_eq!(lines[&trusted]["reasons"], "left out: a truck");
}

#[test]
fn the_export_takes_along_what_was_decided() {
    let (doubted, trusted, before) = one_of_each();
    let accept =
        format!("\n[[review]]\nphoto = \"{doubted}\"\ndecision = \"accepted\"\nnote = \"<b>&\"\n");
    let leave = format!("\n[[review]]\nphoto = \"{trusted}\"\ndecision = \"left-out\"\n");
    let folder = sample_with(&(accept + &leave));
    let names = |which: &dyn Fn(&str, &str) -> bool| -> Vec<String> {
        let photos = before.iter().filter(|(name, verdict)| which(name, verdict));
        photos.map(|(name, _)| name.clone()).collect()
    };
    for (which, expected) in [
        ("all", names(&|name, _| name != trusted)),
        (
            "trusted",
            names(&|name, verdict| name != trusted && (verdict == "trust" || name == doubted)),
        ),
    ] {
        let to = folder.path().join(which);
        let flight = text_of(folder.path());
        stdout_of(&["export", flight, "--to", text_of(&to), "--photos", which]);
        let lines = csv(&fs::read_to_string(to.join("scales.csv")).expect("scales.csv"));
        assert_eq!(lines.keys().cloned().collect::<Vec<_>>(), expected);
        assert_eq!(lines[&doubted]["verdict"], "accepted");
        let sheet = fs::read_to_string(to.join("scales.html")).expect("the sheet");
        assert_eq!(sheet.matches(">accepted</div>").count(), 1);
        assert!(sheet.contains("checked, accepted: &lt;b&gt;&amp;</div>"));
        assert!(sheet.contains(&format!("<li>{trusted}: left out</li>")));
    }
}

/// An acceptance holds for the reasons that were seen.
#[test]
fn accepted_for_other_reasons_is_not_accepted() {
    let (doubted, _, _) = one_of_each();
    let table = format!(
        "\n[[review]]\nphoto = \"{doubted}\"\ndecision = \"accepted\"\nreasons = [\"other-device\"]\n"
    );
    let folder = sample_with(&table);
    let json = scales_json(folder.path(), &[]);
    assert_eq!(verdicts(&json)[&doubted], "check");
    let mut photos = json["photos"].as_array().expect("photos").iter();
    let photo = photos
        .find(|p| p["photo"] == doubted.as_str())
        .expect("there");
    assert_eq!(photo["decision"]["reasons_since"], photo["reasons"]);
    let lines = csv(&stdout_of(&[
        "scales",
        text_of(folder.path()),
        "--format",
        "csv",
    ]));
    assert!(lines[&doubted]["reasons"].contains("checked, accepted (for other reasons: "));
}

#[test]
fn what_cannot_be_decided_is_said() {
    let run = |tables: &str| {
        let folder = sample_with(tables);
        let output = fragscale(&["scales", text_of(folder.path())]);
        let err = String::from_utf8(output.stderr).expect("UTF-8");
        (output.status.code(), err)
    };
    let table = |photo: &str| format!("[[review]]\nphoto = \"{photo}\"\ndecision = \"left-out\"\n");
    let (status, err) = run(&table("IMG_001.jpg"));
    assert_eq!(status, Some(0));
    let said = "a review is of photo 'IMG_001.jpg', which the flight does not have; the nearest name is 'IMG_0001.jpg'";
    assert!(err.contains(said), "{err}");
    let (status, err) = run(&(table("IMG_0001.jpg") + &table("IMG_0001.jpg")));
    assert_eq!(status, Some(1));
    let said =
        "flight.toml:20: photo 'IMG_0001.jpg' has two [[review]] tables; keep the one that holds";
    assert!(err.contains(said), "{err}");
    // Nothing is left to export.
    let all: String = (1..=9).map(|n| table(&format!("IMG_000{n}.jpg"))).collect();
    let folder = sample_with(&all);
    let to = folder.path().join("to");
    let output = fragscale(&["export", text_of(folder.path()), "--to", text_of(&to)]);
    let err = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(
        err.contains("all of its 9 photos are left out by [[review]] tables"),
        "{err}"
    );
    assert!(!to.exists());
}
