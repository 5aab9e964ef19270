//! The map of the bundled flight, as a user asks for it.

use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use tiff::decoder::Decoder;
use tiff::tags::Tag;

use crate::common::{error_of, scales_json, stdout_of};
use crate::own_frame;

fn sample() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample")
}

/// The corner points that `scales` says lie inside the GeoTIFF that its tags describe, and its pixels are as
/// large as asked for; the same command again writes over its own file.
#[test]
fn a_geotiff_holds_the_flight() {
    let folder = tempfile::tempdir().expect("a folder");
    let tif = folder.path().join("map.tif");
    let (flight, output) = (sample(), tif.to_string_lossy().into_owned());
    let flight_text = flight.to_string_lossy().into_owned();
    for _ in 0..2 {
        let said = stdout_of(&["map", &flight_text, "-o", &output, "--pixel", "5mm"]);
        assert!(
            said.contains("map.tif: ") && said.contains("pixels of 0.005 m"),
            "{said}"
        );
    }
    let bytes = fs::read(&tif).expect("a map");
    let mut decoder = Decoder::new(Cursor::new(&bytes)).expect("a TIFF");
    let (width, height) = decoder.dimensions().expect("a size");
    let mut numbers = |tag| {
        let value = decoder.find_tag(tag).expect("tags").expect("a tag");
        value.into_f64_vec().expect("numbers")
    };
    let scale = numbers(Tag::ModelPixelScaleTag);
    let tie = numbers(Tag::ModelTiepointTag);
    assert_eq!(scale[..2], [0.005, 0.005]);
    let (west, north) = (tie[3], tie[4]);
    let (east, south) = (
        west + f64::from(width) * scale[0],
        north - f64::from(height) * scale[1],
    );
    let scales = scales_json(&flight, &[]);
    let mut corners = 0;
    for photo in scales["photos"].as_array().expect("photos") {
        for corner in photo["corners"].as_array().into_iter().flatten() {
            let at = |i: usize| corner["point"][i].as_f64();
            let (Some(x), Some(y)) = (at(0), at(1)) else {
                continue;
            };
            assert!(x > west && x < east && y > south && y < north, "{x} {y}");
            corners += 1;
        }
    }
    assert!(corners > 20, "{corners}");
}

#[test]
fn what_cannot_be_a_map_is_refused_in_a_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let flight = sample().to_string_lossy().into_owned();
    let jpg = error_of(&["map", &flight, "-o", &at("map.jpg")]);
    assert!(
        jpg.contains("written as GeoTIFF, SVG, PDF or PNG; let its name end in"),
        "{jpg}"
    );
    let fine = error_of(&["map", &flight, "-o", &at("map.tif"), "--pixel", "0.1mm"]);
    assert!(
        fine.contains("more than 40 million; give a larger --pixel"),
        "{fine}"
    );
    let page = error_of(&["map", &flight, "-o", &at("map.svg"), "--pixel", "0.5mm"]);
    assert!(page.contains("the 10 million that go on a page"), "{page}");
    fs::write(at("note.pdf"), "%PDF-1.4 of somebody else").expect("a file");
    let foreign = error_of(&["map", &flight, "-o", &at("note.pdf")]);
    assert!(foreign.contains("--force"), "{foreign}");
    stdout_of(&["map", &flight, "-o", &at("note.pdf"), "--force"]);
    // An interrupted or refused map leaves nothing.
    for name in ["map.jpg", "map.tif", "map.svg"] {
        assert!(!Path::new(&at(name)).exists(), "{name}");
    }
}

/// A folder that is not there is named as it was typed, before anything is computed.
#[test]
fn a_missing_folder_is_named() {
    let flight = sample().to_string_lossy().into_owned();
    let error = error_of(&["map", &flight, "-o", "no such folder/map.pdf"]);
    assert!(
        error.contains("there is no folder no such folder; make it"),
        "{error}"
    );
    assert!(!error.contains(".part"), "{error}");
}

/// The photos stand where the relief was, within their footprints; the GeoTIFF says which it is.
#[test]
fn photos_are_the_ground_of_a_map() {
    let folder = tempfile::tempdir().expect("a folder");
    let flight = sample().to_string_lossy().into_owned();
    let of = |ground: &str| {
        let tif = folder.path().join(format!("{ground}.tif"));
        let to = tif.to_string_lossy().into_owned();
        stdout_of(&[
            "map", &flight, "-o", &to, "--ground", ground, "--pixel", "5mm",
        ]);
        let picture = image::open(&tif).expect("a TIFF").to_rgba8();
        let bytes = fs::read(&tif).expect("bytes");
        let mut decoder = Decoder::new(Cursor::new(&bytes)).expect("a TIFF");
        let said = decoder
            .get_tag_ascii_string(Tag::ImageDescription)
            .expect("words");
        assert!(said.contains(&format!("\"ground\":\"{ground}\"")), "{said}");
        picture
    };
    let (relief, photos, plain) = (of("relief"), of("photos"), of("plain"));
    // Nine footprints of about 0.7 m x 0.35 m on 2.8 m x 1.7 m; of another colour than the relief there.
    let pairs = photos.pixels().zip(relief.pixels());
    let other = pairs.filter(|(a, b)| (0..3).any(|c| a[c].abs_diff(b[c]) > 12));
    let share = other.count() as f64 / relief.pixels().len() as f64;
    assert!((0.25..0.65).contains(&share), "{share}");
    let open = |picture: &image::RgbaImage| picture.pixels().filter(|p| p[3] == 0).count();
    assert!(open(&plain) > 2 * open(&photos));
}

/// Of a model whose unit nobody states the page says so; a pixel of so many centimetres is none of it.
#[test]
fn an_unknown_unit_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let unknown = folder.path().join("model");
    fs::create_dir(&unknown).expect("a folder");
    own_frame::model(&unknown);
    let unknown = unknown.to_string_lossy().into_owned();
    let svg = folder.path().join("map.svg").to_string_lossy().into_owned();
    let error = error_of(&["map", &unknown, "-o", &svg, "--pixel", "1cm"]);
    assert!(
        error.contains("frame of its own, whose unit nobody states"),
        "{error}"
    );
    let flight = folder.path().join("unknown.toml");
    let text = "format = 1\n[world]\nunit = \"unknown\"\n[photos]\nreconstruction = \"model\"\n";
    fs::write(&flight, text).expect("a flight");
    let flight = flight.to_string_lossy();
    let info = stdout_of(&["info", &flight, "--format", "json"]);
    let info: serde_json::Value = serde_json::from_str(&info).expect("JSON");
    assert_eq!(info["world_unit"], serde_json::Value::Null);
    let said = stdout_of(&["map", &unknown, "-o", &svg]);
    assert!(
        said.contains("own frame, no coordinate system is stated"),
        "{said}"
    );
    let text = fs::read_to_string(&svg).expect("an SVG");
    assert!(text.contains("units of the file") && !text.contains("on A4"));
}

/// What `profile` writes is a line of the map, at its places; a polygon is typed. What lies elsewhere or is
/// none is refused.
#[test]
fn what_was_measured_is_on_the_map() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let flight = sample().to_string_lossy().into_owned();
    let (profile, svg, plain) = (at("profile.csv"), at("map.svg"), at("plain.svg"));
    let ends = ["--from", "-1,-0.5", "--to", "1,0.5"];
    stdout_of(
        &[
            &["profile", &flight, "--format", "csv", "-o", &profile],
            &ends[..],
        ]
        .concat(),
    );
    let map = ["map", &flight, "--ground", "plain", "-o"];
    stdout_of(&[&map[..], &[&plain]].concat());
    let square = "-0.5,-0.25;0.5,-0.25;0.5,0.25";
    let measured = ["--line", &profile, "--polygon", square];
    stdout_of(&[&map[..], &[&svg], &measured].concat());
    let text = |path: &str| fs::read_to_string(path).expect("an SVG");
    let (with, without) = (text(&svg), text(&plain));
    for words in ["measured line", "measured polygon"] {
        assert!(with.contains(words) && !without.contains(words), "{words}");
    }
    for (option, places, said) in [
        ("--line", "500000,5000000;500001,5000001", "beside the map"),
        ("--line", "1,1;1,1", "no length"),
        ("--line", "1,1;wall", "'wall' is no place"),
        ("--polygon", "0,0;1,0", "at least three"),
    ] {
        let error = error_of(&["map", &flight, "-o", &at("none.svg"), option, places]);
        assert!(error.contains(said), "{error}");
        assert!(!folder.path().join("none.svg").exists());
    }
}
