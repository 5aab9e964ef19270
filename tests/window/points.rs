//! Points that are picked on the surface: a list to copy, save, rename, undo.

use std::fs;

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use glam::DVec3;

use crate::desk::{Desk, Screen, flight};
use crate::viewport::{on_screen, on_windrow};

const PLACES: [(f64, f64); 2] = [(-1.0, 0.1), (0.2, 0.1)];

fn click(desk: &mut Desk, point: DVec3) {
    let at = on_screen(desk, &desk.open().looking.orbit.view(), point);
    desk.click_at(at);
}

/// From above, with two points picked.
fn picked(mut desk: Desk) -> Desk {
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::T);
    desk.click(Role::Button, "Pick points");
    assert!(desk.says("Click on the surface to pick points"));
    for (x, y) in PLACES {
        click(&mut desk, on_windrow(x, y));
    }
    desk
}

fn names(desk: &Desk) -> Vec<String> {
    let list = desk.open().pointer.picked.list().iter();
    list.map(|picked| picked.name.clone()).collect()
}

#[test]
fn points_are_picked_copied_and_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("points.csv");
    let mut desk = picked(Desk::new(Some(&flight("tests/windrow"))));
    let before = desk.selected().to_owned();
    assert_eq!(names(&desk), ["P1", "P2"]);
    let points: Vec<DVec3> = {
        let list = desk.open().pointer.picked.list().iter();
        list.map(|picked| picked.point).collect()
    };
    for (point, (x, y)) in points.iter().zip(PLACES) {
        // The surface at that place, to the clicked pixel.
        assert!(point.distance(on_windrow(x, y)) < 5e-3, "{point}");
        let expected = on_windrow(point.x, point.y);
        assert!((point.z - expected.z).abs() < 1e-6, "{point}");
    }
    desk.fill("Name of point 2", "crest");
    let rows: Vec<String> = ["P1", "crest"]
        .iter()
        .zip(&points)
        .map(|(name, p)| format!("{name}\t{}\t{}\t{}\n", p.x, p.y, p.z))
        .collect();
    let expected = format!("point\tx_m\ty_m\tz_m\n{}", rows.concat());
    desk.node(Role::Button, "Copy table").click();
    desk.harness.step();
    assert_eq!(desk.copied().as_deref(), Some(expected.as_str()));
    desk.settle();
    // Ctrl+C, with the mouse over the pile: the table, not the coordinates under it.
    let at = on_screen(
        &desk,
        &desk.open().looking.orbit.view(),
        on_windrow(0.0, 0.2),
    );
    desk.harness.hover_at(at);
    desk.settle();
    assert_eq!(
        desk.frame([Event::Copy]).as_deref(),
        Some(expected.as_str())
    );
    desk.click(Role::Button, "Save CSV…");
    desk.type_path(&path);
    desk.click(Role::Button, "Write table");
    let written = fs::read_to_string(&path).expect("a table");
    assert_eq!(written, expected.replace('\t', ","));
    assert_eq!(desk.selected(), before, "these clicks select nothing");
}

/// What nobody copied or saved goes with the flight: that is asked.
#[test]
fn picked_points_are_asked_about() {
    let mut desk = picked(Desk::new(Some(&flight("tests/windrow"))));
    desk.press(Modifiers::COMMAND, Key::W);
    assert!(desk.says("Picked points are in no file"));
    desk.click(Role::Button, "Stay here");
    assert_eq!(names(&desk), ["P1", "P2"]);
    desk.click(Role::Button, "Copy table");
    desk.press(Modifiers::COMMAND, Key::W);
    assert!(desk.harness.state().state().open.is_none());
}

#[test]
fn what_is_removed_comes_back() {
    let mut desk = picked(Desk::new(Some(&flight("tests/windrow"))));
    desk.click(Role::Button, "Remove P1");
    assert_eq!(names(&desk), ["P2"]);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(names(&desk), ["P1", "P2"]);
    desk.click(Role::Button, "Remove all");
    assert!(names(&desk).is_empty());
    desk.press(Modifiers::COMMAND, Key::Z);
    desk.fill("Name of point 1", "toe");
    assert_eq!(names(&desk), ["toe", "P2"]);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(names(&desk), ["P1", "P2"]);
    // Escape leaves the tool, the points stay, and undo is that of the settings again.
    desk.press(Modifiers::NONE, Key::Escape);
    assert!(!desk.open().pointer.picked.is_on);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(names(&desk), ["P1", "P2"]);
    // A click selects a photo again.
    click(&mut desk, on_windrow(-1.2, -0.5));
    assert_eq!(names(&desk).len(), 2);
}

#[test]
fn a_row_goes_there() {
    let mut desk = picked(Desk::new(Some(&flight("tests/windrow"))));
    let before = desk.open().looking.orbit;
    desk.click(Role::Button, "Go to P2");
    let after = desk.open().looking.orbit;
    let point = desk.open().pointer.picked.list()[1].point;
    assert_eq!(after.target, point);
    assert!(after.distance < before.distance);
    assert_eq!((after.yaw, after.pitch), (before.yaw, before.pitch));
}

/// Over the picture and in a picture that is saved.
#[test]
fn names_stand_on_the_picture() {
    let screen = Screen {
        size: [1000.0, 600.0],
        pixels_per_point: 1.0,
        theme: egui::Theme::Dark,
    };
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = picked(Desk::drawn(Some(&flight("tests/windrow")), &screen));
    let write = |desk: &mut Desk, name: &str| {
        let path = folder.path().join(name);
        desk.press(Modifiers::COMMAND, Key::P);
        desk.type_path(&path);
        desk.click(Role::Button, "Write picture");
        image::open(&path).expect("a PNG").to_rgb8()
    };
    let written = desk.written();
    assert!(written.iter().any(|written| written.text == "P2"));
    // Orange is nothing else here.
    let orange = |picture: &image::RgbImage| {
        let is = |p: &&image::Rgb<u8>| p[0] > 240 && p[1].abs_diff(150) < 12 && p[2] < 60;
        picture.pixels().filter(is).count()
    };
    let with = orange(&write(&mut desk, "with.png"));
    assert!(with > 100, "{with}");
    desk.click(Role::Button, "Remove all");
    assert!(orange(&write(&mut desk, "without.png")) < 10);
}
