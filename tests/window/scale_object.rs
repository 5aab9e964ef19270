//! Scale objects: traced on the photo with the mouse, compared, changed, saved, masked.

use std::fs;

use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2, Rect};
use egui_kittest::kittest::NodeT;
use fragscale::app::Command;
use fragscale::flight::ScaleObject;
use fragscale::scale::{ImageKind, ScaleObjectKind, Traced};
use fragscale::units::LengthUnit;
use glam::{DVec2, DVec3};
use tempfile::TempDir;

use crate::desk::{Desk, copy, copy_files, flight};

/// In the world's unit; the window begins with centimetres.
const DIAMETER: f64 = 0.06;

/// The sample to change, with its photos; the first photo selected.
fn sample() -> (TempDir, Desk) {
    let folder = copy("assets/sample");
    copy_files("assets/sample/photos", &folder.path().join("photos"));
    let desk = Desk::new(Some(folder.path()));
    (folder, desk)
}

/// The sphere of the selected photo, in camera axes.
fn sphere(desk: &Desk) -> DVec3 {
    let text = fs::read_to_string(flight("assets/sample/truth.json")).expect("truth");
    let truth: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let open = desk.open();
    let photo = &open.flight().parts().photos[open.selected.expect("a photo")];
    let camera = open.flight().camera(photo);
    let middle = DVec2::new(640.0, 360.0);
    let spheres = truth["spheres"].as_array().expect("spheres").iter();
    let seen = spheres.filter_map(|sphere| {
        let at = |axis: usize| sphere["center"][axis].as_f64().expect("a number");
        let center = photo
            .pose
            .camera_from_world(DVec3::new(at(0), at(1), at(2)));
        Some(((camera.pixel_as_shot(center)? - middle).length(), center))
    });
    seen.min_by(|a, b| a.0.total_cmp(&b.0)).expect("a sphere").1
}

/// Where its outline is in the image that is shown, pixels.
fn outline(desk: &Desk, points: u32) -> Vec<DVec2> {
    let center = sphere(desk);
    let open = desk.open();
    let photo = &open.flight().parts().photos[open.selected.expect("a photo")];
    let (camera, image) = (open.flight().camera(photo), open.flight().parts().image);
    let share = (DIAMETER / 2.0).powi(2) / center.length_squared();
    let (along, across) = center.normalize().any_orthonormal_pair();
    let radius = DIAMETER / 2.0 * (1.0 - share).sqrt();
    let point = |point: u32| {
        let turn = std::f64::consts::TAU * f64::from(point) / f64::from(points);
        let way = (along * turn.cos() + across * turn.sin()) * radius;
        image
            .pixel(camera, center * (1.0 - share) + way)
            .expect("in the photo")
    };
    (0..points).map(point).collect()
}

/// The inspector's photo.
fn frame(desk: &Desk) -> Rect {
    let name = format!("Photo {} with its scale", desk.selected());
    desk.node(Role::Image, &name).rect()
}

/// Where a pixel of the image is on the screen, fitted into its frame.
fn on_screen(desk: &Desk, pixel: DVec2) -> Pos2 {
    let frame = frame(desk);
    let fitted = frame.width().min(frame.height() * 1280.0 / 720.0);
    let scale = f64::from(fitted) / 1280.0;
    let off = (pixel - DVec2::new(640.0, 360.0)) * scale;
    frame.center() + egui::vec2(off.x as f32, off.y as f32)
}

fn open_section(desk: &mut Desk) {
    desk.click(Role::DisclosureTriangle, "Scale object");
}

/// The button is there while the size is typed, and the click that leaves the field begins, with that size.
#[test]
fn tracing_begins_by_one_click_behind_the_size() {
    let (_folder, mut desk) = sample();
    open_section(&mut desk);
    let type_size = |desk: &mut Desk, size: &str| {
        let field = desk.node(Role::TextInput, "Diameter of the next sphere");
        field.click();
        desk.harness.run();
        desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        desk.harness.event(egui::Event::Text(size.to_owned()));
        desk.harness.run();
    };
    type_size(&mut desk, "none");
    desk.click(Role::Button, "Trace sphere");
    assert!(desk.open().objects.tracing.is_none());
    type_size(&mut desk, "6");
    desk.click(Role::Button, "Trace sphere");
    assert!(desk.open().objects.tracing.is_some());
    let size = desk.open().trace_size(ScaleObjectKind::Sphere);
    assert_eq!(size, Some(DIAMETER));
    // The size of before does not stand for one that is none.
    desk.press(Modifiers::NONE, Key::Escape);
    type_size(&mut desk, "none");
    desk.click(Role::Button, "Trace sphere");
    assert!(desk.open().objects.tracing.is_none());
}

fn objects(desk: &Desk) -> Vec<ScaleObject> {
    desk.open().settings().scale_objects
}

/// Marks a sphere in eight clicks and finishes with Enter.
fn trace_sphere(desk: &mut Desk) {
    desk.fill("Diameter of the next sphere", "6");
    desk.click(Role::Button, "Trace sphere");
    for pixel in outline(desk, 8) {
        let at = on_screen(desk, pixel);
        desk.click_at(at);
    }
    desk.press(Modifiers::NONE, Key::Enter);
}

/// Clicks are good to a screen point, three pixels of the photo: the centre is found as well as that
/// lets it.
#[test]
fn a_sphere_is_traced_by_clicks() {
    let (_folder, mut desk) = sample();
    open_section(&mut desk);
    // Nothing is traced before its size is known.
    desk.click(Role::Button, "Trace sphere");
    assert!(desk.open().objects.tracing.is_none());
    trace_sphere(&mut desk);
    assert!(desk.open().objects.tracing.is_none());
    let [object] = &objects(&desk)[..] else {
        panic!("{:?}", objects(&desk));
    };
    assert_eq!(
        (object.kind, object.size),
        (ScaleObjectKind::Sphere, DIAMETER)
    );
    assert_eq!(
        (object.photo.as_str(), object.outline.len()),
        ("IMG_0001.jpg", 8)
    );
    let compared = desk.open().compared(object).expect("compared");
    let Ok(Traced::Sphere(found)) = &compared.traced else {
        panic!("{compared:?}");
    };
    let center = sphere(&desk);
    assert!(found.rms < 0.05, "{}", found.rms);
    assert!(
        (found.center.z / center.z - 1.0).abs() < 0.002,
        "{} for {center}",
        found.center
    );
    // What is on the screen is the scale in pixels per centimetre.
    let scale = compared.scale.expect("a scale") / 100.0;
    let text = fragscale::numbers::significant_digits(scale, 5);
    assert!(desk.says(&text), "{text}");
    assert!(desk.open().is_changed());
}

#[test]
fn points_are_taken_back_moved_and_given_up() {
    let (_folder, mut desk) = sample();
    open_section(&mut desk);
    desk.fill("Diameter of the next sphere", "6");
    desk.click(Role::Button, "Trace sphere");
    let places: Vec<Pos2> = outline(&desk, 6)
        .into_iter()
        .map(|p| on_screen(&desk, p))
        .collect();
    let count = |desk: &Desk| {
        desk.open()
            .objects
            .tracing
            .as_ref()
            .map(|t| t.outline.len())
    };
    for place in &places {
        desk.click_at(*place);
    }
    assert_eq!(count(&desk), Some(6));
    // A second click on a point is none.
    desk.click_at(places[3]);
    assert_eq!(count(&desk), Some(6));
    desk.press(Modifiers::NONE, Key::Backspace);
    assert_eq!(count(&desk), Some(5));
    // Dragging a point moves it and nothing else.
    let before = desk
        .open()
        .objects
        .tracing
        .clone()
        .expect("a draft")
        .outline;
    drag(&mut desk, places[2], places[2] + egui::vec2(20.0, 0.0));
    let after = desk
        .open()
        .objects
        .tracing
        .clone()
        .expect("a draft")
        .outline;
    let moved = after[2] - before[2];
    let pixels = 20.0 * 1280.0 / f64::from(frame(&desk).width());
    assert!(
        (moved.x - pixels).abs() < 4.0 && moved.y.abs() < 4.0,
        "{moved}"
    );
    assert_eq!((&after[..2], &after[3..]), (&before[..2], &before[3..]));
    // The points go first, then the tool.
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(count(&desk), Some(0));
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(count(&desk), None);
    assert!(objects(&desk).is_empty() && !desk.open().is_changed());
    // Another photo is another outline.
    desk.click(Role::Button, "Trace sphere");
    desk.click_at(places[0]);
    desk.press(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(count(&desk), None);
}

fn drag(desk: &mut Desk, from: Pos2, to: Pos2) {
    desk.harness.hover_at(from);
    desk.harness.drag_at(from);
    desk.harness.step();
    for share in [0.4, 0.8, 1.0] {
        desk.harness.hover_at(from.lerp(to, share));
        desk.harness.step();
    }
    desk.harness.drop_at(to);
    desk.settle();
}

#[test]
fn a_click_on_the_first_point_closes_the_outline() {
    let (_folder, mut desk) = sample();
    open_section(&mut desk);
    desk.fill("Diameter of the next sphere", "6,0");
    desk.click(Role::Button, "Trace sphere");
    let places: Vec<Pos2> = outline(&desk, 5)
        .into_iter()
        .map(|p| on_screen(&desk, p))
        .collect();
    for place in places.iter().chain([&places[0]]) {
        desk.click_at(*place);
    }
    assert_eq!(objects(&desk).len(), 1);
    // A finished outline's points are moved as well, and that is a step of undo.
    let before = objects(&desk);
    drag(&mut desk, places[1], places[1] - egui::vec2(15.0, 12.0));
    assert_ne!(objects(&desk), before);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(objects(&desk), before);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(objects(&desk).is_empty());
    desk.press(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert_eq!(objects(&desk), before);
}

/// A bar is done with its second end; its length on the pile is that between the two places.
#[test]
fn a_bar_is_two_clicks() {
    let (_folder, mut desk) = sample();
    open_section(&mut desk);
    desk.fill("Length of the next bar", "30");
    desk.click(Role::Button, "Trace bar");
    for pixel in [DVec2::new(400.0, 300.0), DVec2::new(900.0, 420.0)] {
        let at = on_screen(&desk, pixel);
        desk.click_at(at);
    }
    let [object] = &objects(&desk)[..] else {
        panic!("{:?}", objects(&desk));
    };
    let compared = desk.open().compared(object).expect("compared");
    let pixels = DVec2::new(500.0, 120.0).length();
    let scale = compared.scale.expect("a scale");
    assert!((scale * 0.3 / pixels - 1.0).abs() < 0.01, "{scale}");
    let beyond = compared.beyond_length().expect("a length");
    let text = format!("{:+.2} %", beyond * 100.0);
    assert!(desk.says(&text), "{text}");
}

#[test]
fn size_mask_and_deleting_are_changes_of_the_flight() {
    let (folder, mut desk) = sample();
    open_section(&mut desk);
    let before = desk.open().review.outcomes().clone();
    trace_sphere(&mut desk);
    let scale = |desk: &Desk| {
        let object = &objects(desk)[0];
        desk.open()
            .compared(object)
            .and_then(|compared| compared.scale)
            .expect("a scale")
    };
    let first = scale(&desk);
    // Twice as large is twice as far, at half the scale.
    desk.fill("Size of sphere 1", "12");
    assert!((scale(&desk) * 2.0 / first - 1.0).abs() < 1e-9);
    desk.click(Role::CheckBox, "Mask sphere 1 in export");
    assert!(!objects(&desk)[0].mask);
    assert!(
        std::sync::Arc::ptr_eq(&before, desk.open().review.outcomes()),
        "no scale depends on it"
    );
    desk.press(Modifiers::COMMAND, Key::S);
    assert!(!desk.open().is_changed());
    let text = fs::read_to_string(folder.path().join("flight.toml")).expect("the flight");
    assert!(
        text.contains("[[scale_object]]") && text.contains("mask = false"),
        "{text}"
    );
    let again = Desk::new(Some(folder.path()));
    assert_eq!(objects(&again), objects(&desk));
    assert!(!again.open().objects.compared.is_empty());
    desk.click(Role::Button, "Delete sphere 1");
    assert!(objects(&desk).is_empty() && desk.open().is_changed());
}

/// It is shown and typed in the unit that is chosen in the window, and kept in that of the flight's world.
#[test]
fn a_size_is_in_the_unit_of_the_window() {
    let (folder, mut desk) = sample();
    open_section(&mut desk);
    trace_sphere(&mut desk);
    for (unit, size) in [
        (LengthUnit::Centimetre, "6"),
        (LengthUnit::Millimetre, "60"),
        (LengthUnit::Metre, "0.06"),
        (LengthUnit::Inch, "2.362204724"),
    ] {
        desk.harness.state_mut().apply(Command::Unit(unit));
        desk.settle();
        for name in ["Diameter of the next sphere", "Size of sphere 1"] {
            let field = desk.node(Role::TextInput, name);
            let shown = field.accesskit_node().value();
            assert_eq!(shown.as_deref(), Some(size), "{name} in {unit}");
        }
    }
    desk.fill("Size of sphere 1", "3");
    assert_eq!(objects(&desk)[0].size, 0.0762);
    desk.press(Modifiers::COMMAND, Key::S);
    let text = fs::read_to_string(folder.path().join("flight.toml")).expect("the flight");
    assert!(text.contains("size = 0.0762"), "{text}");
}

/// Of a photo as shot the clicks are kept as they are; of an undistorted one they go through the lens.
#[test]
fn the_outline_is_kept_in_pixels_as_shot() {
    let (_folder, mut desk) = sample();
    open_section(&mut desk);
    trace_sphere(&mut desk);
    let undistorted = objects(&desk)[0].outline.clone();
    desk.click(Role::Tab, "Flight");
    desk.click(Role::RadioButton, "the photo as shot");
    desk.click(Role::Tab, "Photo");
    desk.click(Role::Button, "Delete sphere 1");
    trace_sphere(&mut desk);
    assert_eq!(desk.open().flight().parts().image, ImageKind::AsShot);
    let as_shot = objects(&desk)[0].outline.clone();
    for (a, b) in undistorted.iter().zip(&as_shot) {
        assert!((*a - *b).length() < 0.05, "{a} and {b}");
    }
}

#[test]
fn what_is_masked_is_blue_in_the_export() {
    let (folder, mut desk) = sample();
    open_section(&mut desk);
    trace_sphere(&mut desk);
    desk.click(Role::Button, "Edit");
    desk.click(Role::Button, "Choose all photos with a scale");
    let to = folder.path().join("export");
    desk.click(Role::Button, "Export chosen photos");
    desk.type_path(&to);
    desk.click(Role::Button, "Export now");
    assert!(
        desk.logged("pictures of 9 made"),
        "{:?}",
        desk.harness.state().state().log
    );
    let mask = image::open(to.join("masks/IMG_0001.png"))
        .expect("a mask")
        .to_rgb8();
    let black = mask.pixels().filter(|pixel| pixel.0 == [0; 3]).count();
    assert!(black > 10_000, "{black}");
    assert_eq!(fs::read_dir(to.join("masks")).expect("masks").count(), 1);
    // Without the mask the photo is made anew, and only that one.
    desk.click(Role::CheckBox, "Mask sphere 1 in export");
    desk.click(Role::Button, "Export chosen photos");
    desk.type_path(&to);
    desk.click(Role::Button, "Export now");
    assert!(desk.logged("pictures of 1 made, of 8 there already"));
    assert!(!to.join("masks/IMG_0001.png").exists());
}
