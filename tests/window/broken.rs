//! What cannot be opened is told with the reader's own sentence, and the flight on the screen stays.

use std::fs;
use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use fragscale::app::Command;

use crate::common::fragscale;
use crate::desk::{Desk, copy, flight};
use crate::dropping::drop_on;

/// What the command says of a path that it cannot open.
fn sentence(path: &Path) -> String {
    let output = fragscale(&["scales", path.to_str().expect("a UTF-8 path")]);
    assert_eq!(output.status.code(), Some(1));
    let stderr = String::from_utf8(output.stderr).expect("UTF-8");
    let line = stderr.lines().last().expect("a line");
    line.strip_prefix("error: ").expect("an error").to_owned()
}

/// Opens a path by typing it.
fn open(desk: &mut Desk, path: &Path) {
    desk.press(Modifiers::COMMAND, Key::O);
    desk.type_path(path);
    desk.click(Role::Button, "Open flight");
}

#[track_caller]
fn assert_told_and_usable(desk: &mut Desk, path: &Path) {
    let sentence = sentence(path);
    assert!(desk.says(&sentence), "not on the screen: {sentence}");
    assert!(desk.logged(&sentence), "not in the log: {sentence}");
    assert_eq!(desk.open().flight().parts().name, "Windrow");
    assert!(desk.open().review.views().is_some());
    desk.click(Role::Row, "Photo IMG_0002.jpg");
    assert_eq!(desk.selected(), "IMG_0002.jpg");
    desk.press(Modifiers::NONE, Key::ArrowUp);
    desk.click(Role::Button, "Put the message away");
    assert!(!desk.says(&sentence) || desk.harness.state().state().notice.is_none());
}

#[test]
fn a_broken_flight_is_told_and_the_other_one_stays() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    let folder = tempfile::tempdir().expect("a folder");

    let empty = folder.path().join("empty.toml");
    fs::write(&empty, "").expect("written");
    open(&mut desk, &empty);
    assert_told_and_usable(&mut desk, &empty);

    let nothing = folder.path().join("nothing in it");
    fs::create_dir(&nothing).expect("a folder");
    open(&mut desk, &nothing);
    assert_told_and_usable(&mut desk, &nothing);

    let nowhere = folder.path().join("not there.nvm");
    open(&mut desk, &nowhere);
    assert_told_and_usable(&mut desk, &nowhere);
}

#[test]
fn a_truncated_cloud_is_told() {
    let folder = copy("tests/windrow");
    let cloud = folder.path().join("pile.ply");
    let bytes = fs::read(&cloud).expect("the cloud");
    fs::write(&cloud, &bytes[..bytes.len() / 2]).expect("written");
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    drop_on(&mut desk, &[folder.path()]);
    assert_told_and_usable(&mut desk, folder.path());
}

#[test]
fn on_the_start_page_it_is_told_too() {
    let nowhere = flight("tests/no such flight");
    let mut desk = Desk::new(Some(&nowhere));
    assert!(desk.says(&sentence(&nowhere)));
    // And the sample can still be opened.
    drop_on(&mut desk, &[&flight("tests/windrow")]);
    assert_eq!(desk.rows().len(), 9);
    assert!(!desk.says(&sentence(&nowhere)));
}

/// A broken flight comes while the one before is still being computed.
#[test]
fn a_failed_opening_leaves_no_half_computed_flight() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    let all = desk.open().review.outcomes().clone();
    let app = desk.harness.state_mut();
    let mut settings = app.state().open.as_ref().expect("a flight").settings();
    settings.image = fragscale::scale::ImageKind::AsShot;
    app.apply(Command::Set(settings));
    app.apply(Command::Open(flight("tests/no such flight")));
    desk.settle();
    let open = desk.open();
    assert_eq!(open.flight().parts().image, open.settings().image);
    assert_ne!(
        *open.review.outcomes(),
        all,
        "the scales are those of the settings"
    );
    assert!(open.review.views().is_some());
}

/// What is cancelled is taken back: settings and numbers never disagree.
#[test]
fn a_cancelled_change_is_taken_back() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    let before = desk.open().settings();
    for (task, thinning) in [
        (fragscale::app::tasks::Task::SCALES, None),
        (fragscale::app::tasks::Task::OPEN, Some(0.3)),
    ] {
        let app = desk.harness.state_mut();
        let mut settings = before.clone();
        settings.image = fragscale::scale::ImageKind::AsShot;
        settings.surface.thinning = thinning;
        app.apply(Command::Set(settings));
        app.apply(Command::Cancel(task));
        desk.settle();
        assert_eq!(desk.open().settings(), before);
        assert!(!desk.open().history.can_undo(), "nothing is left to undo");
        assert!(desk.logged("cancelled"));
    }
}

/// The footprints of a flight that has just come are not lost with a change that is cancelled.
#[test]
fn footprints_come_after_a_cancelled_change() {
    let mut desk = Desk::new(None);
    let app = desk.harness.state_mut();
    app.apply(Command::Open(flight("tests/windrow")));
    while app.state().open.is_none() {
        std::thread::yield_now();
        app.poll();
    }
    let mut settings = app.state().open.as_ref().expect("a flight").settings();
    settings.image = fragscale::scale::ImageKind::AsShot;
    app.apply(Command::Set(settings));
    app.apply(Command::Cancel(fragscale::app::tasks::Task::SCALES));
    desk.settle();
    assert!(desk.open().review.views().is_some());
}
