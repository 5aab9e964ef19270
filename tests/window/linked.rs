//! The linked cursor: what the mouse points at glows in the pile and in the photos, with its numbers.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, vec2};
use fragscale::app::linked::LinkedPoint;
use fragscale::render::View;
use glam::{DVec2, DVec3};

use crate::desk::{Desk, flight};

/// The windrow's level crest is 0.24 and 0.02 y high (tests/windrow).
fn on_crest(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, y, 0.24 + 0.02 * y)
}

fn linked(desk: &Desk) -> LinkedPoint {
    let linked = desk.open().pointer.linked.as_deref();
    linked.expect("something under the mouse").clone()
}

fn hover(desk: &mut Desk, at: Pos2) {
    desk.harness.hover_at(at - vec2(2.0, 0.0));
    desk.harness.step();
    desk.harness.hover_at(at);
    desk.settle();
}

/// Where the free view shows a point.
fn in_viewport(desk: &Desk, point: DVec3) -> Pos2 {
    let place = desk.viewport();
    let size = DVec2::new(f64::from(place.width()), f64::from(place.height()));
    let view = desk.open().looking.orbit.view();
    let pixel = view.project(point, size).expect("before the eye");
    place.min + vec2(pixel.x as f32, pixel.y as f32)
}

fn says(desk: &Desk, words: &str) -> bool {
    desk.written().iter().any(|text| text.text.contains(words))
}

/// By hand: which photos have a point in their frame. Nothing of the windrow stands before its crest.
fn in_frame(desk: &Desk, point: DVec3) -> Vec<usize> {
    let parts = desk.open().flight().parts();
    let photos = parts.photos.iter().enumerate();
    let sees = photos.filter(|(_, photo)| {
        let camera = desk.open().flight().camera(photo);
        let p = photo.pose.rotation.transpose() * (point - photo.pose.center);
        let (u, v) = (
            camera.fx * p.x / p.z + camera.cx,
            camera.fy * p.y / p.z + camera.cy,
        );
        let (w, h) = (f64::from(camera.width), f64::from(camera.height));
        p.z > 0.0 && (0.0..=w).contains(&u) && (0.0..=h).contains(&v)
    });
    sees.map(|(index, _)| index).collect()
}

#[test]
fn what_is_pointed_at_in_the_pile_is_known_in_the_photos() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    // A place of the crest that several photos have in their frame.
    let places = (-20..20).map(|step| on_crest(-0.04, f64::from(step) * 0.05));
    let point = places
        .into_iter()
        .find(|point| in_frame(&desk, *point).len() > 1);
    let point = point.expect("photos that overlap");
    let at = in_viewport(&desk, point);
    hover(&mut desk, at);
    let found = linked(&desk);
    assert!(found.point.distance(point) < 5e-3, "{}", found.point);
    let seen: Vec<usize> = found.seen.iter().map(|(photo, _)| *photo).collect();
    assert_eq!(seen, in_frame(&desk, found.point));
    assert!(seen.len() > 1);
    assert!(says(&desk, &format!("seen in {} photos", seen.len())));
    // The crest is level across: the ring lies 10 cm around.
    assert!(found.is_ten_centimetres && found.ring.len() > 60);
    for end in found.ring.iter().flatten() {
        assert!((end.distance(found.point) - 0.1).abs() < 1e-9);
    }
    // The root of fx fy over the depth, in centimetres.
    let parts = desk.open().flight().parts();
    let (index, sighting) = found.seen[0];
    let photo = &parts.photos[index];
    let camera = desk.open().flight().camera(photo);
    let depth = (found.point - photo.pose.center).dot(photo.pose.rotation.z_axis);
    let scale = (camera.fx * camera.fy).sqrt() / depth;
    assert!((sighting.scale - scale).abs() < 1e-9 * scale);
    // Ctrl+C copies the place, to the last digit.
    let copied = desk.frame([Event::Copy]).expect("a text");
    let numbers: Vec<f64> = copied
        .split('\t')
        .map(|text| text.parse().unwrap())
        .collect();
    assert_eq!(numbers, linked(&desk).point.to_array());
    // Off the viewport nothing glows.
    let off = desk.node(Role::TextInput, "Filter photos").rect().center();
    hover(&mut desk, off);
    assert!(desk.open().pointer.linked.is_none());
    assert!(!says(&desk, "seen in"));
}

#[test]
fn what_is_pointed_at_on_the_photo_is_known_in_the_pile() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::B);
    let name = format!("Photo view {}", desk.selected());
    let middle = desk.node(Role::Image, &name).rect().center();
    hover(&mut desk, middle);
    let found = linked(&desk);
    // The middle of the fitted photo is the middle of its image.
    let open = desk.open();
    let posed = &open.flight().parts().photos[open.selected.unwrap()];
    let camera = open.flight().camera(posed);
    let half = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
    let ray = View::of_photo(camera, &posed.pose, 1.0).ray(half, half * 2.0);
    let off = (found.point - ray.origin).cross(ray.direction).length();
    assert!(off < 0.01, "{off}");
    let seen = found.in_photo(open.selected.unwrap()).expect("itself");
    assert!(seen.pixel.distance(half) < 4.0, "{}", seen.pixel);
    // The menu stays where it was opened, and goes to the other photos.
    let other = found
        .seen
        .iter()
        .map(|(photo, _)| *photo)
        .find(|p| Some(*p) != open.selected);
    let other = desk.open().name(other.expect("another photo")).to_owned();
    for pressed in [true, false] {
        desk.harness.event(Event::PointerButton {
            pos: middle,
            button: PointerButton::Secondary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    }
    desk.settle();
    assert!(desk.shows(Role::Button, "Copy coordinates"));
    desk.click(Role::Button, &format!("Go to {other}"));
    assert_eq!(desk.selected(), other);
}

/// A key changes the photo or the view under a mouse that rests: what it points at is another place.
#[test]
fn the_point_is_that_under_a_resting_mouse() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::B);
    let name = format!("Photo view {}", desk.selected());
    let middle = desk.node(Role::Image, &name).rect().center();
    hover(&mut desk, middle);
    let before = linked(&desk).point;
    desk.press(Modifiers::NONE, Key::ArrowDown);
    let open = desk.open();
    assert_eq!(open.selected, Some(1));
    let posed = &open.flight().parts().photos[1];
    let camera = open.flight().camera(posed);
    let half = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
    let ray = View::of_photo(camera, &posed.pose, 1.0).ray(half, half * 2.0);
    let now = linked(&desk).point;
    let off = (now - ray.origin).cross(ray.direction).length();
    assert!(off < 0.01, "{off}");
    assert!(now.distance(before) > 0.05, "{now}");

    let at = desk.viewport().center();
    hover(&mut desk, at);
    let before = linked(&desk).point;
    desk.press(Modifiers::NONE, Key::T);
    let now = linked(&desk).point;
    assert!(now != before);
    assert!(in_viewport(&desk, now).distance(at) < 1.0, "{now}");
}

/// Beside the image there is no ray.
#[test]
fn beside_the_photo_nothing_is_pointed_at() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::P);
    let name = format!("Photo view {}", desk.selected());
    let frame = desk.node(Role::Image, &name).rect();
    let middle = frame.center();
    hover(&mut desk, middle);
    assert!(desk.open().pointer.linked.is_some());
    let open = desk.open();
    let camera = open.flight().camera(&open.flight().parts().photos[0]);
    let wider = frame.width() / frame.height() > camera.width as f32 / camera.height as f32;
    let beside = match wider {
        true => frame.left_center() + vec2(3.0, 0.0),
        false => frame.center_top() + vec2(0.0, 3.0),
    };
    hover(&mut desk, beside);
    assert!(desk.open().pointer.linked.is_none());
}

/// Through the camera the wheel looks into the photo, about the cursor, and back; it does not leave it.
#[test]
fn the_wheel_looks_into_the_photo_that_is_looked_through() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::C);
    let cursor = desk.viewport().center() + vec2(70.0, 50.0);
    hover(&mut desk, cursor);
    let before = linked(&desk).point;
    for (up, zoomed) in [(200.0, true), (-900.0, false)] {
        desk.harness.event(Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: vec2(0.0, up),
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        });
        desk.settle();
        assert_eq!(desk.open().looking.through, desk.open().selected);
        assert_eq!(desk.open().looking.into.factor > 1.5, zoomed);
        hover(&mut desk, cursor);
        assert!(linked(&desk).point.distance(before) < 1e-3);
    }
    assert_eq!(
        desk.open().looking.into,
        fragscale::render::PhotoZoom::default()
    );
}
