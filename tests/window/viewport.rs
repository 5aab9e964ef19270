//! The viewport under the mouse: what a drag, a wheel, a click on a known place do to the view.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, MouseWheelUnit, Pos2, vec2};
use fragscale::app::open_flight::Measure;
use fragscale::render::{Orbit, View};
use glam::{DVec2, DVec3};

use crate::desk::{Desk, Screen, flight};

const SMALL: Screen = Screen {
    size: [1000.0, 600.0],
    pixels_per_point: 1.0,
    theme: egui::Theme::Dark,
};

fn orbit(desk: &Desk) -> Orbit {
    desk.open().looking.orbit
}

/// Where a view shows a point of the world, on the screen.
pub fn on_screen(desk: &Desk, view: &View, point: DVec3) -> Pos2 {
    let place = desk.viewport();
    let size = DVec2::new(f64::from(place.width()), f64::from(place.height()));
    let pixel = view.project(point, size).expect("before the eye");
    place.min + vec2(pixel.x as f32, pixel.y as f32)
}

/// The windrow's surface (tests/windrow): its western flank rises 3 in 4 to a level crest.
pub fn on_windrow(x: f64, y: f64) -> DVec3 {
    let profile = match x {
        x if x < -0.64 => 0.0,
        x if x < -0.32 => (x + 0.64) * 0.75,
        x if x < 0.24 => 0.24,
        _ => panic!("not needed"),
    };
    DVec3::new(x, y, profile + 0.02 * y)
}

fn drag(desk: &mut Desk, way: egui::Vec2) {
    // Off the middle: nothing of the panels over the viewport is there.
    let from = desk.viewport().center() + vec2(0.0, 60.0);
    desk.harness.hover_at(from);
    desk.harness.drag_at(from);
    desk.harness.hover_at(from + way);
    desk.harness.drop_at(from + way);
    desk.settle();
}

#[test]
fn dragging_turns_the_view() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    let before = orbit(&desk);
    drag(&mut desk, vec2(80.0, 30.0));
    let after = orbit(&desk);
    assert!(after.yaw != before.yaw && after.pitch > before.pitch);
    assert_eq!(after.target, before.target);
    assert_eq!(after.distance, before.distance);
    // The way back is the way back.
    drag(&mut desk, vec2(-80.0, -30.0));
    let turned = (orbit(&desk).yaw - before.yaw).rem_euclid(std::f64::consts::TAU);
    assert!(turned.min(std::f64::consts::TAU - turned) < 1e-6);
    assert!((orbit(&desk).pitch - before.pitch).abs() < 1e-6);
}

#[test]
fn keys_turn_the_view_to_the_sides_of_the_map() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    for (key, forward) in [
        (Key::T, DVec3::NEG_Z),
        (Key::F, DVec3::Y),
        (Key::S, DVec3::NEG_X),
    ] {
        desk.press(Modifiers::NONE, key);
        let seen = orbit(&desk).view().world_from_view.z_axis;
        assert!(seen.distance(forward) < 1e-9, "{key:?}: {seen}");
    }
    // A letter that is typed into a field is text.
    let before = orbit(&desk);
    desk.fill("Filter photos", "t");
    assert_eq!(orbit(&desk).view(), before.view());
}

/// The keypad of CloudCompare and Blender; egui tells its digits as those over the letters.
#[test]
fn the_keypad_turns_the_view() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    let forward = |desk: &Desk| orbit(desk).view().world_from_view.z_axis;
    for (key, expected) in [
        (Key::Num7, DVec3::NEG_Z),
        (Key::Num9, DVec3::Z),
        (Key::Num1, DVec3::Y),
        (Key::Num9, DVec3::NEG_Y),
        (Key::Num3, DVec3::NEG_X),
        (Key::Num9, DVec3::X),
    ] {
        desk.press(Modifiers::NONE, key);
        let seen = forward(&desk);
        assert!(seen.distance(expected) < 1e-9, "{key:?}: {seen}");
    }
    // From the south six steps to the left are the west, then two up are 30 degrees down.
    desk.press(Modifiers::NONE, Key::Num1);
    for _ in 0..6 {
        desk.press(Modifiers::NONE, Key::Num4);
    }
    assert!(forward(&desk).distance(DVec3::X) < 1e-9);
    for _ in 0..2 {
        desk.press(Modifiers::NONE, Key::Num8);
    }
    let slope = 30_f64.to_radians();
    let down = DVec3::new(slope.cos(), 0.0, -slope.sin());
    assert!(forward(&desk).distance(down) < 1e-9);
    let before = orbit(&desk);
    for key in [Key::Num6, Key::Num2] {
        desk.press(Modifiers::NONE, key);
    }
    assert!((orbit(&desk).pitch - 15_f64.to_radians()).abs() < 1e-9);
    let turned = (before.yaw - orbit(&desk).yaw).to_degrees();
    assert!((turned - 15.0).abs() < 1e-9, "{turned}");
    // Parallel and back; everything in sight.
    for parallel in [true, false] {
        desk.press(Modifiers::NONE, Key::Num5);
        assert_eq!(orbit(&desk).orthographic, parallel);
    }
    let apply = |desk: &mut Desk| {
        let to = fragscale::app::command::ViewChange::Center(DVec3::splat(50.0));
        let app = desk.harness.state_mut();
        app.apply(fragscale::app::Command::View(to));
    };
    apply(&mut desk);
    desk.press(Modifiers::NONE, Key::Num0);
    assert!(orbit(&desk).target.length() < 5.0);
    // Digits are text in a field, and with Ctrl they are the pages.
    let before = orbit(&desk);
    desk.fill("Filter photos", "7");
    desk.press(Modifiers::COMMAND, Key::Num1);
    assert_eq!(orbit(&desk).view(), before.view());
    // While a number is dragged or typed, too.
    desk.press(Modifiers::COMMAND, Key::P);
    desk.node(Role::SpinButton, "Picture width").click();
    desk.harness.run();
    desk.press(Modifiers::NONE, Key::Num3);
    assert_eq!(orbit(&desk).view(), before.view());
}

#[test]
fn the_wheel_zooms_to_what_is_under_the_cursor() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::T);
    let point = on_windrow(-0.8, 0.3);
    let before = orbit(&desk);
    let cursor = on_screen(&desk, &before.view(), point);
    desk.harness.hover_at(cursor);
    desk.settle();
    desk.harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, 100.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    desk.settle();
    let after = orbit(&desk);
    assert!(after.distance < before.distance * 0.9);
    let now = on_screen(&desk, &after.view(), point);
    assert!(now.distance(cursor) < 0.5, "{now} was {cursor}");
}

#[test]
fn a_click_selects_the_photo_whose_middle_is_there() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    let flight = desk.open().flight().clone();
    let mut caster = flight.parts().surface.caster().expect("a caster");
    for photo in [8, 1, 3] {
        let posed = &flight.parts().photos[photo];
        let camera = flight.camera(posed);
        // The middle of the image on the surface: no other photo has it nearer to its middle.
        let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
        let axis = View::of_photo(camera, &posed.pose, 1.0).ray(size / 2.0, size);
        let middle = caster
            .cast(&axis)
            .expect("the middle is on the surface")
            .point;
        let at = on_screen(&desk, &orbit(&desk).view(), middle);
        desk.click_at(at);
        assert_eq!(desk.selected(), posed.name);
    }
    // Beside everything nothing is meant.
    let before = desk.selected().to_owned();
    desk.press(Modifiers::NONE, Key::F);
    let corner = desk.viewport().right_top() + vec2(-5.0, 5.0);
    desk.click_at(corner);
    assert_eq!(desk.selected(), before);
}

#[test]
fn a_click_on_a_camera_selects_its_photo() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::F);
    drag(&mut desk, vec2(40.0, 25.0));
    let centers: Vec<DVec3> = {
        let photos = desk.open().flight().parts().photos.iter();
        photos.map(|photo| photo.pose.center).collect()
    };
    for photo in [6, 2] {
        let at = on_screen(&desk, &orbit(&desk).view(), centers[photo]);
        desk.click_at(at);
        assert_eq!(desk.open().selected, Some(photo));
    }
}

#[test]
fn a_double_click_centres_the_view() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    let point = on_windrow(-0.9, 0.4);
    let at = on_screen(&desk, &orbit(&desk).view(), point);
    desk.harness.hover_at(at);
    for _ in 0..2 {
        desk.harness.drag_at(at);
        desk.harness.drop_at(at);
    }
    desk.settle();
    let target = orbit(&desk).target;
    assert!(target.distance(point) < 1e-3, "{target} for {point}");
    let middle = on_screen(&desk, &orbit(&desk).view(), point);
    assert!(middle.distance(desk.viewport().center()) < 1.0);
}

#[test]
fn the_distance_of_two_known_points_is_measured() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.click(Role::Button, "Measure a distance");
    assert!(desk.says("click the first point"));
    let (first, second) = (on_windrow(-1.2, -0.5), on_windrow(0.1, 0.5));
    let before = desk.selected().to_owned();
    let at = on_screen(&desk, &orbit(&desk).view(), first);
    desk.click_at(at);
    assert!(desk.says("click the second point") || desk.says("Distance 0.0"));
    // Live: the mouse is the second point. The first step brings it there, the second moves it.
    let at = on_screen(&desk, &orbit(&desk).view(), second);
    for step in [6.0, 0.0] {
        desk.harness.hover_at(at + vec2(step, 0.0));
        desk.settle();
    }
    // sqrt(1.3^2 + 1^2) level, 0.26 up, to the pixel.
    assert!(
        desk.says("Distance 1.66") && desk.says("(level 1.64") && desk.says("up 0.2"),
        "{:?}",
        desk.texts()
    );
    assert!(matches!(desk.open().pointer.measure, Measure::Second(_)));
    desk.click_at(at);
    let Measure::Both(a, b) = desk.open().pointer.measure else {
        panic!("{:?}", desk.open().pointer.measure);
    };
    assert!(a.distance(first) < 1e-3 && b.distance(second) < 1e-3);
    assert!(desk.says(&format!("Distance {:.3} m", a.distance(b))));
    // sqrt(1.3^2 + 1^2 + 0.26^2)
    assert!((a.distance(b) - 1.660_60).abs() < 2e-3);
    assert_eq!(desk.selected(), before, "these clicks select nothing");
    desk.press(Modifiers::NONE, Key::M);
    assert_eq!(desk.open().pointer.measure, Measure::Off);
    // Escape takes the first point back, then the tool.
    desk.press(Modifiers::NONE, Key::M);
    desk.click_at(at);
    assert!(matches!(desk.open().pointer.measure, Measure::Second(_)));
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(desk.open().pointer.measure, Measure::First);
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(desk.open().pointer.measure, Measure::Off);
}

#[test]
fn the_view_through_the_camera_is_the_photo() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.click(Role::Row, "Photo IMG_0005.jpg");
    let free = orbit(&desk);
    assert!(!desk.shows(Role::Slider, "Photo over the view"));
    desk.press(Modifiers::NONE, Key::C);
    assert_eq!(desk.open().looking.through, Some(4));
    assert!(desk.shows(Role::Slider, "Photo over the view"));
    // The next photo's camera is looked through next.
    desk.press(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(desk.open().looking.through, Some(5));
    // A click in the middle of the photo meets the middle of its image on the surface.
    desk.press(Modifiers::NONE, Key::M);
    let middle = desk.viewport().center();
    desk.click_at(middle);
    let Measure::Second(point) = desk.open().pointer.measure else {
        panic!("{:?}", desk.open().pointer.measure);
    };
    let flight = desk.open().flight().clone();
    let photo = &flight.parts().photos[5];
    let camera = flight.camera(photo);
    let pixel = camera
        .pixel_undistorted(photo.pose.camera_from_world(point))
        .expect("before the camera");
    let half = DVec2::new(f64::from(camera.width), f64::from(camera.height)) / 2.0;
    assert!(pixel.distance(half) < 2.0, "{pixel}");
    // Leaving brings the free view back.
    desk.click(Role::Button, "Look through the camera");
    assert_eq!(desk.open().looking.through, None);
    assert_eq!(orbit(&desk).view(), free.view());
}

#[test]
fn a_picture_of_the_viewport_has_the_size_that_was_chosen() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("figure.png");
    let mut desk = Desk::drawn(Some(&flight("tests/windrow")), &SMALL);
    desk.press(Modifiers::COMMAND, Key::P);
    for (side, pixels) in [("Picture width", "320"), ("Picture height", "200")] {
        desk.node(Role::SpinButton, side).click();
        desk.harness.run();
        desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        desk.harness.event(Event::Text(pixels.to_owned()));
        desk.harness.run();
        desk.press(Modifiers::NONE, Key::Enter);
    }
    desk.click(Role::RadioButton, "Transparent");
    desk.click(Role::RadioButton, "The corner-ray figure");
    desk.type_path(&path);
    desk.click(Role::Button, "Write picture");
    assert!(
        desk.logged("figure.png: written"),
        "{:?}",
        desk.harness.state().state().log
    );
    let picture = image::open(&path).expect("a PNG").to_rgba8();
    assert_eq!(picture.dimensions(), (320, 200));
    let clear = picture.pixels().filter(|pixel| pixel[3] == 0).count();
    assert!(clear > 1000, "the background is transparent");
    assert!(picture.pixels().len() - clear > 1000, "and the pile is not");
}

#[test]
fn without_a_graphics_device_it_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("figure.png");
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::COMMAND, Key::P);
    desk.type_path(&path);
    desk.click(Role::Button, "Write picture");
    assert!(desk.says("there is no graphics device"));
    assert!(!path.exists());
}
