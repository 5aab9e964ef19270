//! Settings go into texts and come back, and nothing else of the text changes.

mod any;

use proptest::prelude::*;

use super::*;
use crate::flight::ReconstructionFlight;
use crate::surface::{SurfaceOptions, UpAxis};
use any::any_settings;

const COMMENTED: &str = r#"# The east bench, shot 12.
format = 1

[world]
unit = "m"       # UTM 30N
ground = 160     # toe of the face

[surface]
file = 'pile.ply'
max_edge = 2.50  # shadow behind the shovel

# Two devices.
[[camera]]
file = "ost.yaml"

[photos]
poses = "poses.csv"
folder = "photos"
"#;

fn settings() -> FlightSettings {
    FlightFile::parse(COMMENTED).unwrap().settings()
}

#[test]
fn nothing_changes_where_nothing_is_changed() {
    let text = FlightFile::text_with_settings(COMMENTED, &settings()).unwrap();
    assert_eq!(text, COMMENTED);
}

#[test]
fn only_what_is_changed_changes() {
    let mut settings = settings();
    settings.ground = Ground::At(161.25);
    settings.surface.thinning = Some(0.1);
    settings.image = ImageKind::AsShot;
    let text = FlightFile::text_with_settings(COMMENTED, &settings).unwrap();
    let expected = COMMENTED
        .replace("ground = 160     #", "ground = 161.25     #")
        .replace("behind the shovel\n", "behind the shovel\nthinning = 0.1\n")
        + "\n[scale]\nimage = \"as-shot\"\n";
    assert_eq!(text, expected);
    settings.surface = SurfaceOptions::default();
    settings.ground = Ground::Auto;
    let text = FlightFile::text_with_settings(&text, &settings).unwrap();
    assert!(text.contains("ground = \"auto\"     # toe"), "{text}");
    assert!(!text.contains("max_edge") && !text.contains("thinning"));
    assert!(text.starts_with("# The east bench, shot 12.\n"));
}

#[test]
fn a_file_from_windows_keeps_its_line_ends() {
    let text = COMMENTED.replace('\n', "\r\n");
    let mut settings = settings();
    assert_eq!(
        FlightFile::text_with_settings(&text, &settings).unwrap(),
        text
    );
    settings.ground = Ground::At(161.25);
    assert_eq!(
        FlightFile::text_with_settings(&text, &settings).unwrap(),
        text.replace("= 160 ", "= 161.25 ")
    );
}

#[test]
fn what_cannot_be_set_is_refused() {
    let mut settings = settings();
    settings.surface.max_edge = Some(f64::NAN);
    assert!(FlightFile::text_with_settings(COMMENTED, &settings).is_err());
    assert!(FlightFile::text_with_settings("format = 1", &settings).is_err());
}

/// Said of the surface's own file; z need not be said, and without a file nothing can be.
#[test]
fn another_axis_is_up() {
    let up = |surface_up| FlightSettings {
        surface_up,
        ..settings()
    };
    let text = FlightFile::text_with_settings(COMMENTED, &up(UpAxis::Y)).unwrap();
    assert_eq!(FlightFile::parse(&text).unwrap().surface_up(), UpAxis::Y);
    let back = FlightFile::text_with_settings(&text, &up(UpAxis::Z)).unwrap();
    let expected = FlightFile::text_with_settings(COMMENTED, &settings()).unwrap();
    assert_eq!(back, expected);
    let other = FlightFile::text_with_files(&text, Some("other.ply"), None).unwrap();
    assert_eq!(FlightFile::parse(&other).unwrap().surface_up(), UpAxis::Z);
    let without = "format = 1\nworld.unit = \"m\"\nphotos.reconstruction = \"a.nvm\"\n";
    assert!(FlightFile::text_with_settings(without, &up(UpAxis::Y)).is_err());
}

#[test]
fn paths_are_replaced_wherever_they_stand() {
    let moved = |path: &str| Ok(format!("../old/{path}"));
    let text = FlightFile::text_with_paths(COMMENTED, moved).unwrap();
    let mut expected = COMMENTED.replace("'pile.ply'", "\"../old/pile.ply\"");
    for path in ["ost.yaml", "poses.csv", "photos"] {
        expected = expected.replace(&format!("\"{path}\""), &format!("\"../old/{path}\""));
    }
    assert_eq!(text, expected);
    let short = "format = 1\nworld.unit = \"m\"\nphotos = { reconstruction = \"a.nvm\" }\n\
            camera = [{ width = 3, height = 2 }]\nsurface.file = \"b.ply\"\n";
    let text = FlightFile::text_with_paths(short, moved).unwrap();
    assert!(
        text.contains("reconstruction = \"../old/a.nvm\" }"),
        "{text}"
    );
    assert!(text.contains("surface.file = \"../old/b.ply\"\n"), "{text}");
    let refused = |_: &str| Err(Fault::new("no", "way"));
    assert!(FlightFile::text_with_paths(short, refused).is_err());
}

const OBJECTS: &str = r#"
# The red ball at the toe.
[[scale_object]]
photo = "a.jpg"
kind = "sphere"
size = 0.25          # by calliper
outline = [[1, 2], [3, 4.5], [5, 6]]

# The board.
[[scale_object]]
photo = "b.jpg"
kind = "bar"
size = 2
outline = [[10.0, 20.0], [30.0, 40.0]]
mask = false
"#;

#[test]
fn scale_objects_keep_what_is_not_changed() {
    let text = COMMENTED.to_owned() + OBJECTS;
    let mut settings = FlightFile::parse(&text).unwrap().settings();
    let changed = |settings: &FlightSettings| FlightFile::text_with_settings(&text, settings);
    assert_eq!(changed(&settings).unwrap(), text);
    assert!(settings.scale_objects[0].mask && !settings.scale_objects[1].mask);
    settings.scale_objects[0].size = 0.3;
    settings.scale_objects[1].outline[0].x = 11.5;
    let expected = text
        .replace("size = 0.25 ", "size = 0.3 ")
        .replace("[10.0, 20.0]", "[11.5, 20.0]");
    assert_eq!(changed(&settings).unwrap(), expected);
    // Without the first the second stays with its comment.
    let mut settings = FlightFile::parse(&text).unwrap().settings();
    let first = settings.scale_objects.remove(0);
    let (before, board) = text.split_once("\n# The red").unwrap();
    let board = &board[board.find("\n# The board").unwrap()..];
    assert_eq!(changed(&settings).unwrap(), before.to_owned() + board);
    settings.scale_objects.clear();
    assert_eq!(changed(&settings).unwrap(), COMMENTED);
    settings.scale_objects = vec![first];
    let text = FlightFile::text_with_settings(COMMENTED, &settings).unwrap();
    let added = "\n[[scale_object]]\nphoto = \"a.jpg\"\nkind = \"sphere\"\nsize = 0.25\n\
            outline = [[1.0, 2.0], [3.0, 4.5], [5.0, 6.0]]\nmask = true\n";
    assert_eq!(text, COMMENTED.to_owned() + added);
}

/// The ways in which TOML writes one thing.
const TEXTS: [&str; 6] = [
    COMMENTED,
    "format = 1\nworld.unit = \"m\"\nphotos.reconstruction = \"a.nvm\"\nscale_object = [{ photo = \"a.jpg\", kind = \"bar\", size = 0.25, outline = [[1, 2], [3, 4]] }]\n",
    "format = 1\n[[scale_object]]\nphoto = \"a.jpg\"\nkind = \"bar\"\nsize = 1\noutline = [[1, 2], [3, 4]]\n\n[world]\nunit = \"ft\"\n[photos]\nreconstruction = \"a.nvm\"\n",
    "format = 1\n[photos]\nreconstruction = \"sparse/0\"\n[world]\nunit = \"us-ft\"",
    "format = 1\nworld = { unit = \"mm\" }\nphotos = { reconstruction = \"a.nvm\" }\n",
    "format = 1\r\nworld.unit = \"ft\"\r\nphotos.reconstruction = \"a.nvm\"\r\nsurface.thinning = 1_0.0\r\nscale = { image = \"as-shot\", }\r\n",
];

proptest! {
    #[test]
    fn what_is_set_reads_back(
        which in 0..TEXTS.len(),
        steps in prop::collection::vec(any_settings(), 1..4),
    ) {
        let mut text = TEXTS[which].to_owned();
        let first = FlightFile::parse(&text).unwrap();
        for settings in steps {
            text = FlightFile::text_with_settings(&text, &settings).unwrap();
            let file = FlightFile::parse(&text).unwrap();
            prop_assert_eq!(file.settings(), settings);
            prop_assert_eq!(file.photo_source(), first.photo_source());
            prop_assert_eq!(&file.cameras, &first.cameras);
            prop_assert_eq!(file.surface(), first.surface());
        }
    }

    #[test]
    fn a_reconstructions_flight_reads_back(
        settings in any_settings(),
        name in "\\PC*",
        surface in prop::option::of("[a-z ü\"\\\\]{1,9}"),
    ) {
        let flight = ReconstructionFlight {
            name: &name,
            reconstruction: "../odm",
            transform: Some([0.1, 0.0, 0.0, 5e5, 0.0, 0.1, 0.0, 5e6, 0.0, 0.0, 0.1, 1.0 / 3.0, 0.0, 0.0, 0.0, 1.0]),
            folder: Some("../odm/images"),
            surface: surface.as_deref(),
            crs: Some("EPSG:32633"),
        };
        let file = FlightFile::for_reconstruction(&flight, &settings);
        let read = FlightFile::parse(&file.to_toml().unwrap()).unwrap();
        prop_assert_eq!(read.settings(), settings);
        prop_assert_eq!(read, file);
    }
}
