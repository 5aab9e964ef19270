//! The flight's settings: what is set on the page is what the command computes from a flight.toml that
//! says the same; undo brings back every bit.

use std::fs;
use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers, ViewportCommand, ViewportEvent, ViewportId};
use fragscale::flight::Outcome;
use tempfile::TempDir;

use crate::common::scales_json;
use crate::desk::{Desk, copy, flight};

/// A cloud without colours whose photos partly miss it, in feet, with comments in its flight.toml.
const MISSES: &str = "tests/fixtures/tiltpan-xyz-feet-misses";
const WINDROW: &str = "tests/windrow";

/// The edge scales that the window shows, pixels per unit of the world.
fn in_window(desk: &Desk) -> Vec<[Option<f64>; 4]> {
    let outcomes = desk.open().review.outcomes().iter();
    outcomes
        .map(|outcome| match outcome {
            Outcome::Scale(scale) => {
                let scale = scale.scale;
                [scale.top, scale.right, scale.bottom, scale.left]
            }
            Outcome::Trouble(_) => [None; 4],
        })
        .collect()
}

/// The same from the command, of the flight.toml with some text replaced.
fn from_command(folder: &Path, from: &str, to: &str) -> Vec<[Option<f64>; 4]> {
    let path = folder.join("flight.toml");
    let text = fs::read_to_string(&path).expect("the flight");
    assert!(text.contains(from), "no {from:?} in {text}");
    let other = folder.join("other.toml");
    fs::write(&other, text.replacen(from, to, 1)).expect("written");
    let world = unit_of(&text.replacen(from, to, 1));
    let json = scales_json(&other, &["--unit", &world]);
    let photos = json["photos"].as_array().expect("photos");
    let edges = ["top", "right", "bottom", "left"];
    photos
        .iter()
        .map(|photo| edges.map(|edge| photo["scale"][edge].as_f64()))
        .collect()
}

fn unit_of(text: &str) -> String {
    let unit = text.lines().find_map(|line| line.strip_prefix("unit = \""));
    unit.expect("a unit").trim_end_matches('"').to_owned()
}

/// To the bit, or to rounding in the last places where the command went through another unit.
#[track_caller]
fn assert_same(a: &[[Option<f64>; 4]], b: &[[Option<f64>; 4]]) {
    assert_eq!(a.len(), b.len());
    for (a, b) in a.as_flattened().iter().zip(b.as_flattened()) {
        match (a, b) {
            (Some(a), Some(b)) => assert!((a / b - 1.0).abs() < 1e-14, "{a} {b}"),
            (a, b) => assert_eq!(a, b),
        }
    }
}

/// Opens a copy of a flight on the page of its settings.
fn page(name: &str) -> (TempDir, Desk) {
    let folder = copy(name);
    let mut desk = Desk::new(Some(folder.path()));
    desk.click(Role::Tab, "Flight");
    (folder, desk)
}

/// Undoes the last change: numbers, corners and verdicts are what they were, to the bit.
#[track_caller]
fn undo_to(desk: &mut Desk, before: &[Outcome]) {
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(**desk.open().review.outcomes(), before);
    assert!(!desk.open().is_changed());
}

#[test]
fn the_ground_is_where_it_is_typed() {
    let (folder, mut desk) = page(MISSES);
    let before = desk.open().review.outcomes().to_vec();
    desk.fill("Ground elevation", "-0,25");
    let wanted = from_command(folder.path(), "ground = 0.0764", "ground = -0.25");
    let now = in_window(&desk);
    assert_same(&now, &wanted);
    assert_ne!(**desk.open().review.outcomes(), before);
    undo_to(&mut desk, &before);
    desk.click(Role::RadioButton, "Median elevation under each photo");
    let wanted = from_command(folder.path(), "ground = 0.0764", "ground = \"auto\"");
    assert_same(&in_window(&desk), &wanted);
    undo_to(&mut desk, &before);
}

/// A comma may be decimal or stand between thousands: nothing is guessed, and it is said beside the field.
#[test]
fn a_number_that_may_be_two_is_not_taken() {
    let (_folder, mut desk) = page(MISSES);
    let before = desk.open().settings();
    for (typed, why) in [
        ("1,200", "write 1200 or 1.200"),
        ("high", "'high' is not a number"),
    ] {
        desk.fill("Ground elevation", typed);
        assert_eq!(desk.open().settings(), before, "{typed}");
        assert!(desk.says(why), "{typed}");
    }
    desk.fill("Ground elevation", "1,25");
    assert_ne!(desk.open().settings(), before);
    assert!(!desk.says("is not a number"));
}

#[test]
fn scales_can_be_for_the_photo_as_shot() {
    let (folder, mut desk) = page(WINDROW);
    let before = desk.open().review.outcomes().to_vec();
    desk.click(Role::RadioButton, "the photo as shot");
    let as_shot = "[photos]\n";
    let wanted = from_command(
        folder.path(),
        as_shot,
        "[scale]\nimage = \"as-shot\"\n[photos]\n",
    );
    assert_same(&in_window(&desk), &wanted);
    assert_ne!(**desk.open().review.outcomes(), before);
    undo_to(&mut desk, &before);
}

#[test]
fn the_worlds_unit_changes_what_a_number_means() {
    let (folder, mut desk) = page(WINDROW);
    let before = desk.open().review.outcomes().to_vec();
    let shown = |desk: &Desk| -> f64 { desk.rows()[0].1[1].parse().expect("a number") };
    let in_metres = shown(&desk);
    desk.click(Role::ComboBox, "Unit of the world's coordinates");
    desk.click(Role::Button, "ft");
    let wanted = from_command(folder.path(), "unit = \"m\"", "unit = \"ft\"");
    assert_same(&in_window(&desk), &wanted);
    // The same numbers are feet now: a foot is 0.3048 m, so there are more pixels in each cm.
    assert!((shown(&desk) * 0.3048 / in_metres - 1.0).abs() < 1e-3);
    undo_to(&mut desk, &before);
    assert_eq!(shown(&desk), in_metres);
}

#[test]
fn long_triangles_are_left_out() {
    let (folder, mut desk) = page(WINDROW);
    let before = desk.open().review.outcomes().to_vec();
    desk.click(Role::CheckBox, "Leave out long triangles, edges over");
    // Shorter than any edge of the lattice: only its vertices are left, and rays go past them.
    desk.fill("Longest triangle edge", "0.001");
    let with = "file = \"pile.ply\"\nmax_edge = 0.001";
    let wanted = from_command(folder.path(), "file = \"pile.ply\"", with);
    assert_same(&in_window(&desk), &wanted);
    assert_ne!(**desk.open().review.outcomes(), before);
    desk.press(Modifiers::COMMAND, Key::Z);
    undo_to(&mut desk, &before);
}

#[test]
fn the_cloud_is_thinned_from_its_file() {
    let (folder, mut desk) = page(WINDROW);
    let before = desk.open().review.outcomes().to_vec();
    let points = |desk: &Desk| desk.open().flight().parts().surface.vertices().len();
    let all = points(&desk);
    desk.click(Role::Row, "Photo IMG_0003.jpg");
    desk.click(Role::CheckBox, "Thin the cloud, one point in each");
    desk.fill("Thinning cell", "0.2");
    // 3.2 m by 2.4 m: cells of 0.2 m at whole multiples, one more where an edge lies on one.
    let left = points(&desk);
    assert!((16 * 12..=17 * 13).contains(&left), "{left} of {all}");
    let with = "file = \"pile.ply\"\nthinning = 0.2";
    let wanted = from_command(folder.path(), "file = \"pile.ply\"", with);
    assert_same(&in_window(&desk), &wanted);
    assert_eq!(
        desk.selected(),
        "IMG_0003.jpg",
        "reading again leaves the selection"
    );
    desk.press(Modifiers::COMMAND, Key::Z);
    undo_to(&mut desk, &before);
    assert_eq!(points(&desk), all);
}

#[test]
fn saved_settings_are_in_flight_toml_beside_its_comments() {
    let (folder, mut desk) = page(MISSES);
    desk.fill("Ground elevation", "0.5");
    desk.click(Role::RadioButton, "the photo as shot");
    assert!(desk.open().is_changed());
    assert!(desk.harness.state().state().title().contains('*'));
    let path = folder.path().join("flight.toml");
    let before = fs::read_to_string(&path).expect("the flight");
    desk.click(Role::Button, "Save settings");
    assert!(!desk.open().is_changed());
    let text = fs::read_to_string(&path).expect("the flight");
    let wanted = before
        .replace("ground = 0.0764", "ground = 0.5")
        .replace("image = \"undistorted\"", "image = \"as-shot\"");
    assert_eq!(text, wanted, "nothing else has changed");
    assert_same(
        &in_window(&desk),
        &from_command(folder.path(), "format", "format"),
    );
    assert!(desk.logged("saved"));
    // Undo goes back behind the saving.
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(desk.open().is_changed());
}

/// The desktop asks the window to close. Whether it asked for more time, and whether it went.
fn close(desk: &mut Desk) -> bool {
    let input = desk.harness.input_mut();
    let window = input
        .viewports
        .get_mut(&ViewportId::ROOT)
        .expect("the window");
    window.events.push(ViewportEvent::Close);
    desk.harness.step();
    let held_back = desk.asked().contains(&ViewportCommand::CancelClose);
    desk.harness.run();
    !held_back
}

#[test]
fn closing_with_unsaved_changes_asks_first() {
    let (folder, mut desk) = page(MISSES);
    assert!(close(&mut desk), "nothing would be lost");
    desk.fill("Ground elevation", "0.5");
    assert!(!close(&mut desk));
    assert!(desk.says("have changed since they were saved"));
    desk.click(Role::Button, "Stay here");
    assert!(!desk.says("have changed since they were saved"));
    assert!(desk.open().is_changed());
    // The start page asks as well.
    desk.press(Modifiers::COMMAND, Key::W);
    assert!(desk.says("have changed since they were saved"));
    desk.click(Role::Button, "Stay here");
    assert!(!close(&mut desk));
    desk.node(Role::Button, "Discard changes").click();
    desk.harness.step();
    assert!(desk.asked().contains(&ViewportCommand::Close));
    assert!(close(&mut desk), "she has said so");
    let text = fs::read_to_string(folder.path().join("flight.toml")).expect("the flight");
    assert!(text.contains("ground = 0.0764"));
}

#[test]
fn saving_first_goes_on_with_closing() {
    let (folder, mut desk) = page(MISSES);
    desk.fill("Ground elevation", "0.5");
    desk.press(Modifiers::COMMAND, Key::W);
    desk.click(Role::Button, "Save them");
    let text = fs::read_to_string(folder.path().join("flight.toml")).expect("the flight");
    assert!(text.contains("ground = 0.5"));
    assert!(
        desk.harness.state().state().open.is_none(),
        "the flight is closed"
    );
    assert!(desk.shows(Role::Button, "Open the sample flight"));
}

#[test]
fn another_flight_waits_for_the_answer() {
    let (_folder, mut desk) = page(MISSES);
    desk.fill("Ground elevation", "0.5");
    let other = flight(WINDROW);
    desk.harness
        .state_mut()
        .apply(fragscale::app::Command::Open(other));
    desk.settle();
    assert_eq!(
        desk.open().flight().parts().name,
        "Fixture tiltpan-xyz-feet-misses"
    );
    assert!(desk.says("Windrow was read, to be shown in its place"));
    desk.click(Role::Button, "Discard changes");
    assert_eq!(desk.open().flight().parts().name, "Windrow");
}

/// Nobody discards changes for a file that turns out to be none: she is asked once the other flight is there.
#[test]
fn a_file_that_cannot_be_opened_costs_no_changes() {
    let (folder, mut desk) = page(MISSES);
    desk.fill("Ground elevation", "0.5");
    let changed = desk.open().settings();
    let open = |desk: &mut Desk, path: &Path| {
        let open = fragscale::app::Command::Open(path.to_owned());
        desk.harness.state_mut().apply(open);
        desk.settle();
    };
    open(&mut desk, &folder.path().join("no such flight"));
    assert!(desk.harness.state().state().held_back.is_none());
    assert!(desk.logged("no such flight"));
    assert!(desk.open().is_changed());
    assert_eq!(desk.open().settings(), changed);
    // Who stays is not led to the other flight by what she does next.
    open(&mut desk, &flight(WINDROW));
    desk.click(Role::Button, "Stay here");
    desk.press(Modifiers::COMMAND, Key::S);
    assert!(!desk.open().is_changed());
    assert_eq!(desk.open().settings(), changed);
}

/// The same flight by another way, with changes that are saved first: what is shown is what was saved.
#[test]
fn a_flight_that_was_saved_since_is_read_again() {
    let (folder, mut desk) = page(MISSES);
    desk.fill("Ground elevation", "0.5");
    let changed = desk.open().settings();
    let number = desk.open().number;
    let again = fragscale::app::Command::Open(folder.path().to_owned());
    desk.harness.state_mut().apply(again);
    desk.settle();
    desk.click(Role::Button, "Save them");
    assert_ne!(desk.open().number, number, "it was opened");
    assert_eq!(desk.open().settings().ground, changed.ground);
    assert!(!desk.open().is_changed());
}
