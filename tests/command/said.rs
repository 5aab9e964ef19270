//! What a newcomer could not know: that photos have no pose, that a unit is none of a pile's, that files went, which picture is
//! written, why rays meet nothing. All on copies of the bundled flight.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{error_of, fragscale, stdout_of};
use fragscale::flight::Limits;
use fragscale::jobs::Progress;
use fragscale::opening::{HealthItem, OpenOptions, StatedOfFlight, flight_health, open_flight};

/// The bundled flight in a folder of its own, its flight.toml and poses.csv as these change them.
fn copied(
    folder: &Path,
    flight: impl Fn(&str) -> String,
    poses: impl Fn(&str) -> String,
) -> String {
    let sample = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    fs::create_dir_all(folder.join("photos")).expect("a folder");
    for name in ["ost.yaml", "pile.ply"] {
        fs::copy(sample.join(name), folder.join(name)).expect("a copy");
    }
    for photo in fs::read_dir(sample.join("photos")).expect("photos") {
        let photo = photo.expect("a photo");
        let to = folder.join("photos").join(photo.file_name());
        fs::copy(photo.path(), to).expect("a copy");
    }
    let text = |name: &str| fs::read_to_string(sample.join(name)).expect("its text");
    fs::write(folder.join("flight.toml"), flight(&text("flight.toml"))).expect("written");
    fs::write(folder.join("poses.csv"), poses(&text("poses.csv"))).expect("written");
    folder.to_str().expect("UTF-8").to_owned()
}

/// Its first lines.
fn lines(count: usize) -> impl Fn(&str) -> String {
    move |text| {
        text.lines()
            .take(count)
            .flat_map(|line| [line, "\n"])
            .collect()
    }
}

#[test]
fn photos_without_a_pose_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let flight = copied(folder.path(), str::to_owned, lines(4));
    let said = stdout_of(&["check", &flight]);
    let others = "6 photos that lie beside these have no pose, and no scale (IMG_0004.jpg, ";
    assert!(said.contains(others), "{said}");
    // The window's strip says the same.
    let (options, progress) = (OpenOptions::default(), Progress::default());
    let opened = open_flight(Path::new(&flight), &options, &progress).expect("a flight");
    let review = opened.review_without_colours(&Limits::default(), &progress);
    let stated = StatedOfFlight {
        without_pose: opened.without_pose.as_deref(),
        ..StatedOfFlight::default()
    };
    let health = flight_health(&review.expect("a review"), &stated);
    let photos = health.iter().find(|found| found.item == HealthItem::Photos);
    let says = &photos.expect("its photos").says;
    assert!(says.contains(others), "{says}");
    let all = copied(folder.path(), str::to_owned, str::to_owned);
    assert!(!stdout_of(&["check", &all]).contains("have no pose"));
}

/// Which photos are meant by a reason that several have can be read.
#[test]
fn photos_that_share_a_reason_are_all_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let flight = copied(folder.path(), str::to_owned, str::to_owned);
    for number in [2, 4, 6, 8] {
        let photo = folder.path().join(format!("photos/IMG_000{number}.jpg"));
        fs::remove_file(photo).expect("removed");
    }
    let said = stdout_of(&["check", &flight]);
    let four = "4 photos (IMG_0002.jpg, IMG_0004.jpg, IMG_0006.jpg, IMG_0008.jpg): check: the photo file is missing";
    assert!(said.contains(four), "{said}");
    let rows = said.lines().filter(|line| line.ends_with("; see below"));
    let names: Vec<&str> = rows.filter_map(|row| row.split("  ").next()).collect();
    // The last one lies over a hole.
    let expected = [2, 4, 6, 8, 9].map(|number| format!("IMG_000{number}.jpg"));
    assert_eq!(names, expected, "{said}");
}

#[test]
fn a_pile_of_a_millimetre_is_not_trusted() {
    let folder = tempfile::tempdir().expect("a folder");
    let millimetres = |text: &str| text.replace("unit = \"m\"", "unit = \"mm\"");
    let flight = copied(folder.path(), millimetres, lines(3));
    let said = stdout_of(&["scales", &flight]);
    assert!(said.contains("mm from side to side"), "{said}");
    assert!(!said.contains("trust"), "{said}");
}

/// A second export of less takes away what the sheet no longer has, and says so.
#[test]
fn photos_that_an_export_takes_away_are_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let flight = copied(&folder.path().join("flight"), str::to_owned, lines(3));
    let to = folder.path().join("to");
    let to = to.to_str().expect("UTF-8");
    let export = |more: &[&str]| {
        let arguments = [&["export", &flight, "--to", to], more].concat();
        let output = fragscale(&arguments);
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stderr).expect("UTF-8")
    };
    let first = export(&[]);
    assert!(!first.contains("taken away"), "{first}");
    let second = export(&["--photo", "IMG_0001.jpg"]);
    assert!(second.contains("were taken away: "), "{second}");
    assert!(second.contains("IMG_0002"), "{second}");
}

#[test]
fn a_picture_of_another_kind_is_refused() {
    let sample = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/sample");
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("view.jpg");
    let error = error_of(&["render", sample, "-o", file.to_str().expect("UTF-8")]);
    let what = "view.jpg: a PNG is written here, and nothing as .jpg; end the name in .png";
    assert!(error.contains(what), "{error}");
    assert!(!file.exists());
}

/// Tilts of the other sign look at the sky.
#[test]
fn photos_that_look_at_the_sky_are_told_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let sky = |text: &str| {
        let lines = lines(2)(text);
        let mut lines = lines.lines();
        let head = lines.next().expect("a head").to_owned();
        let tilt = head.split(',').position(|name| name == "tilt");
        let tilt = tilt.expect("a column");
        let turned = lines.map(|line| {
            let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
            fields[tilt] = format!("-{}", fields[tilt]);
            fields.join(",")
        });
        [head]
            .into_iter()
            .chain(turned)
            .collect::<Vec<_>>()
            .join("\n")
    };
    let flight = copied(folder.path(), str::to_owned, sky);
    let output = fragscale(&["scales", &flight]);
    let said = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(said.contains("tilt or pitch has the other sign"), "{said}");
}
