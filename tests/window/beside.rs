//! Clouds beside the surface: drawn, hidden, coloured, taken away; nothing is computed of them.

use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use image::RgbImage;

use crate::desk::{Desk, Screen, flight};

const WIDE: Screen = Screen {
    size: [1300.0, 800.0],
    pixels_per_point: 1.0,
    theme: egui::Theme::Dark,
};

/// A dense level square over the windrow.
fn square(path: &Path) {
    let at = |i: u32| f64::from(i) * 0.01 - 0.5;
    let line = |i: u32| -> String {
        let points = (0..100).map(|j| format!("{} {} 0.6\n", at(i), at(j)));
        points.collect()
    };
    std::fs::write(path, (0..100).map(line).collect::<String>()).expect("a cloud");
}

fn add(desk: &mut Desk, path: &Path) {
    if !desk.shows(Role::Button, "Add cloud as layer…") {
        desk.harness.get_by_label("Layers").click();
        desk.settle();
    }
    desk.click(Role::Button, "Add cloud as layer…");
    desk.type_path(path);
    desk.click(Role::Button, "Add layer");
}

/// What is saved of the viewport now.
fn written(desk: &mut Desk, folder: &Path, name: &str) -> RgbImage {
    let to = folder.join(name);
    desk.press(Modifiers::COMMAND, Key::P);
    desk.type_path(&to);
    desk.click(Role::Button, "Write picture");
    image::open(&to).expect("a PNG").to_rgb8()
}

/// How many pixels are not the same.
fn differ(a: &RgbImage, b: &RgbImage) -> usize {
    let pairs = a.pixels().zip(b.pixels());
    let far = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).any(|c| a[c].abs_diff(b[c]) > 8);
    pairs.filter(far).count()
}

#[test]
fn a_cloud_is_drawn_beside_the_surface() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("before.xyz");
    square(&path);
    let mut desk = Desk::drawn(Some(&flight("tests/windrow")), &WIDE);
    let outcomes = desk.open().review.outcomes().clone();
    desk.press(Modifiers::NONE, Key::T);
    let bare = written(&mut desk, folder.path(), "bare.png");
    add(&mut desk, &path);
    assert!(desk.logged("before.xyz: taken to be in the flight's own frame"));
    let shown = written(&mut desk, folder.path(), "shown.png");
    assert!(differ(&shown, &bare) > 20_000);
    desk.click(Role::CheckBox, "Layer before.xyz");
    let hidden = written(&mut desk, folder.path(), "hidden.png");
    assert_eq!(differ(&hidden, &bare), 0);
    desk.click(Role::CheckBox, "Layer before.xyz");
    // The file has no colours: its own are grey, where the first colour is orange.
    desk.click(Role::Button, "Own colours of before.xyz");
    let own = written(&mut desk, folder.path(), "own.png");
    let blue = |picture: &RgbImage| picture.pixels().filter(|p| p[2] > 140).count();
    assert!(differ(&own, &bare) > 20_000 && blue(&own) > blue(&shown) + 20_000);
    desk.click(Role::Button, "Remove layer before.xyz");
    assert!(desk.open().beside.is_empty());
    assert_eq!(desk.open().review.outcomes(), &outcomes);
}

#[test]
fn what_lies_in_another_world_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("far.xyz");
    let far = "500000 5000000 1\n500001 5000000 1\n500000 5000001 1\n";
    std::fs::write(&path, far).expect("a cloud");
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    add(&mut desk, &path);
    assert!(desk.open().beside.is_empty());
    assert!(desk.logged("far.xyz: it is not in the flight's frame"));
    let near = folder.path().join("near.xyz");
    square(&near);
    add(&mut desk, &near);
    assert_eq!(desk.open().beside.len(), 1);
    // It is read: nothing is written over it.
    assert!(desk.open().files.read.named(&near).is_some());
}
