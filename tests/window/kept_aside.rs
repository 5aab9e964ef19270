//! A machine that loses its power takes little along: what was not saved is offered when the program starts again.

use std::fs;
use std::path::{Path, PathBuf};

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use fragscale::app::Command;
use fragscale::app::command::Asking;
use fragscale::app::fragments::FragmentStep;
use fragscale::app::size_distributions::Page;
use fragscale::flight::FlightSettings;
use fragscale::scale::Ground;
use image::GrayImage;

use crate::desk::{Desk, copy, copy_files};

/// What is typed for the ground.
const HALF: Ground = Ground::At(0.5);

/// A window that keeps its changes aside in `root`.
fn keeping(flight: Option<&Path>, root: &Path) -> Desk {
    let mut desk = Desk::new(flight);
    desk.harness.state_mut().keep_aside_in(root.to_owned());
    desk.settle();
    desk
}

fn set_ground(desk: &mut Desk, ground: f64) {
    let settings = FlightSettings {
        ground: Ground::At(ground),
        ..desk.open().settings()
    };
    desk.harness.state_mut().apply(Command::Set(settings));
    desk.settle();
}

/// The flight.toml files that are kept.
fn kept(root: &Path) -> Vec<PathBuf> {
    let folders = fs::read_dir(root).into_iter().flatten();
    let files = folders.map(|entry| entry.expect("an entry").path().join("flight.toml"));
    files.filter(|file| file.is_file()).collect()
}

fn is_changed(desk: &Desk) -> bool {
    desk.harness.state().state().is_changed()
}

/// Her flight in a folder, with its photos, as an archive would have it.
fn sample() -> tempfile::TempDir {
    let folder = copy("assets/sample");
    copy_files("assets/sample/photos", &folder.path().join("photos"));
    folder
}

#[test]
fn what_was_not_saved_is_there_again() {
    let (folder, own) = (sample(), tempfile::tempdir().expect("a folder"));
    let root = own.path().join("unsaved");
    let flight = folder.path().join("flight.toml");
    let as_saved = fs::read_to_string(&flight).expect("the flight");

    // Half of the photo is one fragment, the other half another.
    let mut desk = keeping(Some(&flight), &root);
    assert!(!root.exists(), "nothing is changed yet");
    desk.harness
        .state_mut()
        .apply(Command::Page(Page::Fragments));
    let open = desk.open();
    let photo = &open.flight().parts().photos[open.selected.expect("a photo")];
    let camera = open.flight().camera(photo);
    let labels = GrayImage::from_fn(camera.width, camera.height, |x, _| {
        image::Luma([1 + u8::from(x < camera.width / 2)])
    });
    let masks = own.path().join("labels.png");
    labels.save(&masks).expect("written");
    let read = FragmentStep::Masks {
        path: masks,
        of: None,
    };
    desk.harness.state_mut().apply(Command::Fragments(read));
    desk.settle();
    desk.harness.state_mut().apply(Command::Page(Page::Pile));
    set_ground(&mut desk, 0.5);
    let outlines = |desk: &Desk| {
        let open = desk.open();
        let of = open.fragments.of(open.selected.expect("a photo"));
        of.expect("outlines").now().clone()
    };
    let outlined = outlines(&desk);
    let [file] = <[PathBuf; 1]>::try_from(kept(&root)).expect("one");
    let text = fs::read_to_string(&file).expect("kept");
    assert!(text.contains("ground = 0.5"), "{text}");
    assert_eq!(fs::read_to_string(&flight).expect("there"), as_saved);

    // Another window that runs meanwhile is offered nothing of it.
    let other = keeping(None, &root);
    assert!(!other.shows(Role::Button, "Open them"));
    drop(other);

    // The power fails.
    drop(desk);
    let mut desk = keeping(None, &root);
    assert!(desk.says("were kept"), "{:?}", desk.texts());
    desk.click(Role::Button, "Open them");
    assert!(!desk.shows(Role::Button, "Open them"));
    assert!(is_changed(&desk));
    assert_eq!(desk.open().settings().ground, HALF);
    let recent = &desk.harness.state().state().preferences.recent;
    assert!(!recent.contains(&file), "{recent:?}");
    desk.harness
        .state_mut()
        .apply(Command::Page(Page::Fragments));
    desk.settle();
    assert_eq!(outlines(&desk), outlined);

    // It is saved where it was; then nothing is kept any more.
    desk.press(Modifiers::COMMAND, Key::S);
    let state = desk.harness.state().state();
    assert_eq!(state.asking, Some(Asking::SaveAs));
    let proposed = desk.open().files.proposed(None);
    assert_eq!(proposed, flight);
    let save = Command::SaveAs(proposed.into());
    desk.harness.state_mut().apply(save);
    desk.settle();
    assert!(desk.says("It is the flight that these changes belong to."));
    desk.click(Role::Button, "Replace it");
    assert!(!is_changed(&desk));
    assert_eq!(kept(&root).len(), 0);
    // Its photos, which are read in full later, are still found.
    let photos = &desk.open().files.photo_files;
    let is_there = |path: &Option<PathBuf>| path.as_ref().is_some_and(|path| path.is_file());
    assert!(photos.iter().all(|photo| is_there(&photo.path)));
    let to = own.path().join("exported");
    desk.harness
        .state_mut()
        .apply(Command::Export(to.clone().into()));
    desk.settle();
    assert!(to.join("scales.csv").is_file(), "{:?}", desk.texts());
    drop(desk);

    let mut desk = keeping(Some(&flight), &root);
    assert!(!desk.shows(Role::Button, "Open them") && !is_changed(&desk));
    // A window that ends badly after saving leaves an empty folder, which goes now.
    assert_eq!(fs::read_dir(&root).expect("a folder").count(), 0);
    assert_eq!(desk.open().settings().ground, HALF);
    assert!(
        desk.open().files.warnings.is_empty(),
        "{:?}",
        desk.open().files.warnings
    );
    desk.harness
        .state_mut()
        .apply(Command::Page(Page::Fragments));
    desk.settle();
    assert_eq!(outlines(&desk), outlined);
}

#[test]
fn what_was_saved_or_discarded_is_not_kept() {
    let (folder, own) = (
        copy("tests/windrow"),
        tempfile::tempdir().expect("a folder"),
    );
    let (root, flight) = (own.path(), folder.path().join("flight.toml"));
    let mut desk = keeping(Some(&flight), root);
    set_ground(&mut desk, 0.5);
    assert_eq!(kept(root).len(), 1);
    desk.press(Modifiers::COMMAND, Key::S);
    assert_eq!(kept(root).len(), 0);

    // Undone and kept again, it is that of now.
    set_ground(&mut desk, 0.75);
    set_ground(&mut desk, 0.25);
    let [file] = <[PathBuf; 1]>::try_from(kept(root)).expect("one");
    let text = fs::read_to_string(file).expect("kept");
    assert!(text.contains("ground = 0.25"), "{text}");
    desk.harness.state_mut().apply(Command::Close);
    desk.settle();
    desk.click(Role::Button, "Discard changes");
    assert_eq!(kept(root).len(), 0);

    // Put off, it is offered by the next window; opened and discarded, by none.
    desk.harness.state_mut().apply(Command::Open(flight));
    desk.settle();
    set_ground(&mut desk, 0.75);
    drop(desk);
    let mut desk = keeping(None, root);
    desk.click(Role::Button, "Not now");
    assert!(!desk.says("were kept"));
    drop(desk);
    let mut desk = keeping(None, root);
    desk.click(Role::Button, "Open them");
    desk.harness.state_mut().apply(Command::Close);
    desk.settle();
    desk.click(Role::Button, "Discard changes");
    assert_eq!(kept(root).len(), 0);
    drop(desk);
    assert!(!keeping(None, root).says("were kept"));
}

/// Where nothing can be written she is told, once.
#[test]
fn that_nothing_can_be_kept_is_said_once() {
    let folder = copy("tests/windrow");
    let mut desk = Desk::new(Some(&folder.path().join("flight.toml")));
    let no_folder = folder.path().join("pile.ply/unsaved");
    desk.harness.state_mut().keep_aside_in(no_folder);
    set_ground(&mut desk, 0.5);
    set_ground(&mut desk, 0.75);
    let log = &desk.harness.state().state().log;
    let said = log
        .iter()
        .filter(|line| line.text.contains("cannot be kept aside"));
    assert_eq!(said.count(), 1, "{log:?}");
}
