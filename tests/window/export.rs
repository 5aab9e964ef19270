//! The export through its small window, read back and compared with that of the command.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use fragscale::app::Command;

use crate::common::fragscale;
use crate::desk::{Desk, copy, flight};

/// The lines of a scales.csv, the head first.
fn lines(folder: &Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("scales.csv")).expect("scales.csv");
    text.lines().map(str::to_owned).collect()
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    entries
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .into_string()
                .expect("UTF-8")
        })
        .collect()
}

/// A drive that was unplugged takes no pictures of an earlier export with it.
#[test]
fn photos_that_are_gone_leave_the_earlier_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    crate::desk::copy_files("assets/sample", folder.path());
    crate::desk::copy_files("assets/sample/photos", &folder.path().join("photos"));
    let to = folder.path().join("export");
    let mut desk = Desk::new(Some(folder.path()));
    let export = |desk: &mut Desk| {
        desk.click(Role::Button, "Export chosen photos");
        desk.type_path(&to);
        desk.click(Role::Button, "Export now");
    };
    export(&mut desk);
    let pictures = names(&to.join("photos"));
    assert!(!pictures.is_empty());
    fs::rename(folder.path().join("photos"), folder.path().join("away")).expect("moved");
    export(&mut desk);
    assert!(
        desk.logged("the photos' files are gone"),
        "{:?}",
        desk.harness.state().state().log
    );
    assert_eq!(names(&to.join("photos")), pictures);
}

#[test]
fn the_chosen_photos_are_exported_as_the_command_exports_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let (ours, theirs) = (folder.path().join("window"), folder.path().join("command"));
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.click(Role::RadioButton, "Pixels per in");
    desk.click(Role::Button, "Edit");
    desk.click(Role::Button, "Choose all photos with a scale");
    for photo in ["IMG_0001.jpg", "IMG_0004.jpg", "IMG_0009.jpg"] {
        desk.click(Role::CheckBox, &format!("Export {photo}"));
    }
    desk.click(Role::Button, "Export chosen photos");
    assert!(desk.says("6 of 9 photos go along"));
    desk.type_path(&ours);
    desk.click(Role::Button, "Export now");
    assert!(
        desk.logged("6 photos, pictures of 6 made"),
        "{:?}",
        desk.harness.state().state().log
    );
    assert!(
        !desk.shows(Role::Button, "Export now"),
        "the small window is closed"
    );

    // The command reads from the flight what she has decided.
    let saved = folder.path().join("flight.toml");
    desk.harness
        .state_mut()
        .apply(Command::SaveAs(saved.clone().into()));
    desk.settle();
    let arguments = [
        "export",
        saved.to_str().expect("UTF-8"),
        "--to",
        theirs.to_str().expect("UTF-8"),
        "--unit",
        "in",
        "--photos",
        "trusted",
    ];
    let output = fragscale(&arguments);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let left_out = ["IMG_0001", "IMG_0004", "IMG_0009"];
    let (window, command) = (lines(&ours), lines(&theirs));
    assert_eq!(command.len(), 7);
    assert_eq!(window, command);
    // The same folders, in them the chosen photos only.
    assert_eq!(names(&ours), names(&theirs));
    for entry in fs::read_dir(&ours).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            let files = names(&path);
            assert_eq!(files.len(), 6, "{}: {files:?}", path.display());
            assert!(
                !files
                    .iter()
                    .any(|file| left_out.iter().any(|name| file.contains(name)))
            );
        }
    }
    // Who finds it is told that the flight's file is not what was exported.
    let told = |folder: &Path| {
        let html = fs::read_to_string(folder.join("scales.html")).expect("scales.html");
        html.contains("changes that were not saved")
    };
    assert_eq!([told(&ours), told(&theirs)], [true, false]);
    let html = fs::read_to_string(ours.join("scales.html")).expect("scales.html");
    assert!(html.contains("IMG_0002.jpg") && !html.contains("photos/IMG_0004.jpg"));
}

#[test]
fn the_place_that_is_proposed_belongs_to_the_flight() {
    let (first, second) = (copy("tests/windrow"), copy("tests/windrow"));
    let mut desk = Desk::new(Some(first.path()));
    for folder in [first.path(), second.path()] {
        desk.harness
            .state_mut()
            .apply(Command::Open(folder.to_owned()));
        desk.settle();
        for keys in [Key::E, Key::P] {
            desk.press(Modifiers::COMMAND, keys);
            let path = desk.node(Role::TextInput, "Path").value().expect("a path");
            let wanted = folder.to_str().expect("UTF-8");
            assert!(path.starts_with(wanted), "{path} for {wanted}");
            desk.press(Modifiers::NONE, Key::Escape);
        }
    }
}

#[test]
fn nothing_is_exported_while_the_numbers_are_computed() {
    let folder = tempfile::tempdir().expect("a folder");
    let to = folder.path().join("export");
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    let app = desk.harness.state_mut();
    let mut settings = app.state().open.as_ref().expect("a flight").settings();
    settings.image = fragscale::scale::ImageKind::AsShot;
    app.apply(Command::Set(settings));
    app.apply(Command::Export(to.clone().into()));
    desk.settle();
    assert!(desk.says("still being computed"));
    assert!(!to.exists());
}
