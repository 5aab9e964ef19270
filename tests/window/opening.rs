//! No dead ends on opening: a cloud alone is looked at, folders above flights lead to them, what is
//! missing is asked for, and a reason has the button to its remedy beside it.

use std::fs;
use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use fragscale::app::Command;
use fragscale::app::command::Asking;
use fragscale::flight::{Doubt, PhotoFileState};

use crate::common::fragscale;
use crate::desk::{Desk, copy_files, flight};
use crate::own_frame::model;

fn asking(desk: &Desk) -> Option<Asking> {
    desk.harness.state().state().asking
}

fn act(desk: &mut Desk, command: Command) {
    desk.harness.state_mut().apply(command);
    desk.settle();
}

/// A part of the window says these words when the mouse is over it.
#[track_caller]
fn assert_hover(desk: &mut Desk, name: &str, words: &str) {
    let place = desk.node(Role::Button, name).rect().center();
    desk.harness.hover_at(place);
    for _ in 0..60 {
        desk.harness.step();
    }
    assert!(desk.says(words), "{:?}", desk.texts());
}

#[test]
fn a_cloud_alone_is_looked_at_and_gets_its_cameras() {
    let folder = tempfile::tempdir().expect("a folder");
    let sample = flight("assets/sample");
    let cloud = folder.path().join("pile.ply");
    fs::copy(sample.join("pile.ply"), &cloud).expect("a copy");
    let mut desk = Desk::new(Some(&cloud));
    let open = desk.open();
    assert_eq!(open.review.count(), 0);
    assert!(!open.is_changed());
    // As many as the file's header says.
    let head = fs::read(&cloud).expect("the cloud");
    let head = String::from_utf8_lossy(&head[..400]).into_owned();
    let count = head.split("element vertex ").nth(1).expect("a count");
    let count: usize = count
        .lines()
        .next()
        .expect("a line")
        .trim()
        .parse()
        .expect("a number");
    assert_eq!(open.flight().parts().surface.vertices().len(), count);
    desk.click(Role::Tab, "Flight");
    assert!(desk.says("pile.ply"));
    assert_hover(
        &mut desk,
        "Export chosen photos",
        "add the cameras of this cloud",
    );
    // Nothing that is done with a flight breaks on it.
    let panels = [
        Command::ToggleMeasure,
        Command::SelectBy(1),
        Command::CopyScales,
    ];
    for command in panels.into_iter().chain([
        Command::View(fragscale::app::command::ViewChange::FitSelected),
        Command::View(fragscale::app::command::ViewChange::Through),
        Command::Save,
    ]) {
        act(&mut desk, command);
    }
    let to = folder.path().join("cloud.toml");
    act(&mut desk, Command::SaveAs(to.clone().into()));
    assert!(desk.logged("a cloud without photos makes no flight; add its cameras first"));
    assert!(!to.exists());

    desk.click(Role::Button, "Add cameras…");
    assert!(desk.says("For the cloud pile"));
    desk.type_path(&sample);
    desk.click(Role::Button, "Add it");
    let open = desk.open();
    assert_eq!(open.review.count(), 9);
    assert_eq!(open.files.origin.surface(), Some(cloud.as_path()));

    // The command computes scales, and there are none.
    let output = fragscale(&["scales", cloud.to_str().expect("UTF-8")]);
    let err = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(err.lines().count(), 1, "{err}");
    assert!(
        err.contains("it holds a cloud or mesh, not a flight"),
        "{err}"
    );
}

#[test]
fn another_cloud_takes_the_place_of_the_one_that_is_looked_at() {
    let cloud = flight("assets/sample/pile.ply");
    let mut desk = Desk::new(Some(&cloud));
    act(&mut desk, Command::Open(flight("tests/windrow/pile.ply")));
    let open = desk.open();
    assert!(open.files.origin.is_surface_alone());
    assert_eq!(open.files.path, flight("tests/windrow/pile.ply"));
    // And a flight does, with its own surface.
    act(&mut desk, Command::Open(flight("assets/sample")));
    assert_eq!(desk.open().files.origin.surface(), Some(cloud.as_path()));
}

#[test]
fn a_folder_above_a_flight_opens_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let project = folder.path().join("blast 7/flight");
    copy_files("tests/windrow", &project);
    for above in [folder.path().join("blast 7"), folder.path().to_owned()] {
        let desk = Desk::new(Some(&above));
        assert_eq!(desk.open().flight().parts().name, "Windrow");
    }
}

#[test]
fn several_flights_below_a_folder_are_there_to_choose_from() {
    let folder = tempfile::tempdir().expect("a folder");
    copy_files("tests/windrow", &folder.path().join("one"));
    let package = folder.path().join("two");
    fs::create_dir(&package).expect("a folder");
    model(&package);
    let mut desk = Desk::new(Some(folder.path()));
    assert_eq!(asking(&desk), Some(Asking::Choose));
    assert!(desk.harness.state().state().open.is_none());
    desk.click(Role::Button, "two: COLMAP, 5 photos");
    assert_eq!(desk.open().review.count(), 5);
    assert_eq!(asking(&desk), None);
}

/// VisualSFM writes no image sizes: without its photos nothing can be computed.
#[test]
fn an_nvm_without_photos_asks_for_their_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let nvm = folder.path().join("model.nvm");
    let fixture = flight("tests/fixtures/nvm-points-photos");
    fs::copy(fixture.join("model.nvm"), &nvm).expect("a copy");
    let mut desk = Desk::new(Some(&nvm));
    assert!(desk.harness.state().state().open.is_none());
    assert_eq!(asking(&desk), Some(Asking::Add));
    assert!(desk.says("the folder of its photos"));
    desk.type_path(&fixture.join("my photos"));
    desk.click(Role::Button, "Add it");
    let photos = desk.open().files.photo_files.iter();
    let found = photos.filter(|file| matches!(file.state, PhotoFileState::Found { .. }));
    assert_eq!(found.count(), 3);
}

/// Cameras without points.
#[test]
fn cameras_without_a_surface_ask_for_it() {
    let folder = tempfile::tempdir().expect("a folder");
    model(folder.path());
    fs::write(folder.path().join("points3D.txt"), "").expect("written");
    let desk = Desk::new(Some(folder.path()));
    assert_eq!(asking(&desk), Some(Asking::Add));
    assert!(desk.logged("it has no 3D points to make a surface of"));
}

/// A model in a frame of its own, without its photos: both reasons are one click from their remedies.
#[test]
fn a_reason_has_its_remedy_beside_it() {
    let folder = tempfile::tempdir().expect("a folder");
    model(folder.path());
    let mut desk = Desk::new(Some(folder.path()));
    let photo = desk.open().review.photo(0).expect("a photo");
    assert!(photo.doubts.contains(&Doubt::UnitUnknown));
    assert_hover(
        &mut desk,
        "Export chosen photos",
        "the model's unit is not known",
    );
    desk.click(Role::Button, "Remedy: Georeference…");
    assert_eq!(asking(&desk), Some(Asking::Georeference));
    desk.press(Modifiers::NONE, Key::Escape);
    desk.click(Role::Button, "Remedy: Add photos…");
    assert_eq!(asking(&desk), Some(Asking::Add));
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(asking(&desk), None);
}

/// What the command says on standard error of a flight without a unit and without photos, the window
/// says too; and copies no number of it.
#[test]
fn what_the_command_says_is_seen_in_the_window() {
    let folder = tempfile::tempdir().expect("a folder");
    model(folder.path());
    let path: &Path = folder.path();
    let output = fragscale(&["scales", path.to_str().expect("UTF-8")]);
    let err = String::from_utf8(output.stderr).expect("UTF-8");
    let desk = Desk::new(Some(path));
    let doubts = desk.open().review.photo(0).expect("a photo").doubts;
    assert!(!doubts.is_empty());
    let said = "no scale and no length: the model is in a frame of its own";
    assert!(err.contains(said) && desk.says(said), "{err}");
    assert_eq!(desk.harness.state().state().scales_to_copy(), None);
    for doubt in doubts {
        assert!(desk.says(&doubt.to_string()), "{doubt}");
    }
}

/// A cloud that another program writes anew is said when she comes back to the window, and read again with F5.
#[test]
fn files_that_are_written_anew_are_said_and_read_again() {
    let folder = tempfile::tempdir().expect("a folder");
    copy_files("assets/sample", folder.path());
    copy_files("assets/sample/photos", &folder.path().join("photos"));
    let path = folder.path().join("flight.toml");
    let mut desk = Desk::new(Some(&path));
    let back = |desk: &mut Desk| {
        for is_focused in [false, true] {
            desk.harness.input_mut().focused = is_focused;
            desk.harness.step();
        }
        desk.settle();
    };
    back(&mut desk);
    assert!(!desk.logged("was changed since it was read"));
    let count = |desk: &Desk| desk.open().flight().parts().surface.vertices().count();
    let before = count(&desk);
    let corners = [(-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0)];
    let points = corners.map(|(x, y)| format!("{x} {y} 0.1\n")).concat();
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
    fs::write(folder.path().join("pile.ply"), format!("{header}{points}")).expect("a cloud");
    back(&mut desk);
    let said = |desk: &Desk| {
        let log = &desk.harness.state().state().log;
        let lines = log
            .iter()
            .filter(|line| line.text.contains("was changed since it was read"));
        lines.count()
    };
    assert_eq!(said(&desk), 1);
    assert!(desk.logged("pile.ply was changed since it was read"));
    back(&mut desk);
    assert_eq!((said(&desk), count(&desk)), (1, before));
    // An export says it, too, whatever was said before.
    desk.press(Modifiers::COMMAND, Key::E);
    desk.type_path(&folder.path().join("export"));
    desk.click(Role::Button, "Export now");
    assert_eq!(said(&desk), 2);
    let sheet = fs::read_to_string(folder.path().join("export/scales.html")).expect("a sheet");
    assert!(sheet.contains("pile.ply was changed since it was read"));
    desk.press(Modifiers::COMMAND, Key::Num3);
    desk.press(Modifiers::NONE, Key::F5);
    desk.settle();
    assert_eq!(
        desk.harness.state().state().page,
        fragscale::app::size_distributions::Page::Plan
    );
    assert_eq!(count(&desk), 4);
    back(&mut desk);
    assert_eq!(said(&desk), 2);
}
