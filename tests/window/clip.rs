//! The clipping box: what is seen, what the mouse meets, and what never depends on it.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use fragscale::app::Command;
use fragscale::app::linked::PointFrom;
use fragscale::app::open_flight::Measure;
use fragscale::app::open_flight::survey::clip::ClipStep;
use fragscale::geometry::LevelBox;
use glam::DVec3;

use crate::desk::{Desk, Screen, flight};
use crate::photo_view::wheel;
use crate::viewport::{on_screen, on_windrow};

const WIDE: Screen = Screen {
    size: [1300.0, 800.0],
    pixels_per_point: 1.0,
    theme: egui::Theme::Dark,
};

fn set(desk: &mut Desk, level: LevelBox) {
    let app = desk.harness.state_mut();
    app.apply(Command::Clip(ClipStep::Set(level)));
    desk.settle();
}

fn type_limit(desk: &mut Desk, name: &str, text: &str) {
    desk.node(Role::SpinButton, name).click();
    desk.harness.run();
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.harness.event(Event::Text(text.to_owned()));
    desk.harness.run();
    desk.press(Modifiers::NONE, Key::Enter);
}

#[test]
fn limits_are_typed_and_the_mouse_meets_what_is_left() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::T);
    let scales = desk.open().review.outcomes().clone();
    desk.press(Modifiers::NONE, Key::X);
    assert!(desk.open().clip.is_on && desk.says("turn"));
    type_limit(&mut desk, "Clip x to", "-0.7");
    assert!((desk.open().clip.level.high.x + 0.7).abs() < 1e-9);
    // No box: refused.
    type_limit(&mut desk, "Clip x from", "3");
    assert!(desk.open().clip.level.low.x < -0.7);
    // Left of it a point is met, right of it nothing.
    desk.press(Modifiers::NONE, Key::M);
    let at = |desk: &Desk, point| on_screen(desk, &desk.open().looking.orbit.view(), point);
    let outside = at(&desk, on_windrow(-0.5, 0.5));
    desk.click_at(outside);
    assert_eq!(desk.open().pointer.measure, Measure::First);
    let inside = at(&desk, on_windrow(-1.0, 0.5));
    desk.click_at(inside);
    assert!(matches!(desk.open().pointer.measure, Measure::Second(_)));
    // A photo shows all of it.
    let ray = |desk: &Desk, point: DVec3| {
        let center = desk.open().flight().parts().photos[4].pose.center;
        fragscale::geometry::Ray {
            origin: center,
            direction: (point - center).normalize(),
        }
    };
    let to = on_windrow(-0.5, 0.1);
    for (from, met) in [(PointFrom::Photo, true), (PointFrom::Pile, false)] {
        let ray = ray(&desk, to);
        let app = desk.harness.state_mut();
        app.apply(Command::Hover(from, Some(ray)));
        desk.settle();
        assert_eq!(desk.open().pointer.hover.is_some(), met, "{from:?}");
    }
    desk.click(Role::CheckBox, "Clip");
    assert!(desk.open().clip.clipping().is_none());
    assert_eq!(desk.open().review.outcomes(), &scales);
}

/// A face follows the mouse along its axis: 40 points to the right on the screen, seen from above in parallel.
/// A drag is one step of undo.
#[test]
fn a_face_is_dragged() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::Num5);
    desk.press(Modifiers::NONE, Key::T);
    desk.press(Modifiers::NONE, Key::X);
    let before = desk.open().clip.level;
    let face = |desk: &Desk| {
        let level = desk.open().clip.level;
        let middle = level.middle();
        let face = middle.with_x(level.high.x);
        on_screen(desk, &desk.open().looking.orbit.view(), face)
    };
    let handle = desk.node(Role::Slider, "Face x to").rect().center();
    assert!((handle - face(&desk)).length() < 1.0);
    desk.harness.drag_at(handle);
    desk.harness.run();
    for step in [-13.0, -29.0, -40.0] {
        desk.harness.hover_at(handle + egui::vec2(step, 0.0));
        desk.harness.run();
    }
    desk.harness.drop_at(handle + egui::vec2(-40.0, 0.0));
    desk.settle();
    let level = desk.open().clip.level;
    assert!(level.high.x < before.high.x && level.low == before.low);
    assert_eq!((level.high.y, level.high.z), (before.high.y, before.high.z));
    assert!((face(&desk).x - handle.x + 40.0).abs() < 1.0);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(desk.open().clip.level, before);
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(desk.open().clip.level, level);
    // X again takes the window and the clipping away, and brings both back.
    desk.press(Modifiers::NONE, Key::X);
    assert!(!desk.open().clip.is_on && !desk.open().clip.is_open);
    assert!(!desk.shows(Role::Slider, "Face x to"));
    desk.press(Modifiers::NONE, Key::X);
    assert_eq!(desk.open().clip.clipping(), Some(level));
}

/// Far away handles lie close together, under the mouse wherever it is: she could not come near again.
#[test]
fn the_wheel_goes_through_a_handle() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::X);
    let long = |desk: &Desk| {
        let level = desk.open().clip.level;
        let on_screen = |at| on_screen(desk, &desk.open().looking.orbit.view(), at);
        (on_screen(level.high) - on_screen(level.low)).length()
    };
    let before = long(&desk);
    let handle = desk.node(Role::Slider, "Face x to").rect().center();
    wheel(&mut desk, handle, 100.0);
    assert!(long(&desk) > 1.1 * before, "{} for {before}", long(&desk));
}

#[test]
fn the_box_goes_to_the_footprint_and_back() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::X);
    let fitted = desk.open().clip.level;
    desk.click(Role::Button, "To the footprint");
    let level = desk.open().clip.level;
    let selected = desk.open().selected.expect("a photo");
    let scale = desk.open().scale(selected).expect("a scale");
    // Its corners lie in it, and it is no larger than they are apart, for a footprint is nearly straight.
    let corners: Vec<DVec3> = scale.corners.iter().filter_map(|c| c.point()).collect();
    assert_eq!(corners.len(), 4);
    for &corner in &corners {
        let wider = LevelBox {
            low: level.low - 1e-6,
            high: level.high + 1e-6,
            ..level
        };
        assert!(wider.contains(corner), "{corner}");
    }
    let around = level.around(&corners);
    let more = (level.half() - around.half()) / around.half();
    assert!(more.x < 0.1 && more.y < 0.1, "{more}");
    // Turned, it has the corners still.
    type_limit(&mut desk, "Clip turn", "30");
    assert!((desk.open().clip.level.turn.to_degrees() - 30.0).abs() < 1e-9);
    desk.click(Role::Button, "To the footprint");
    let turned = desk.open().clip.level;
    assert!(turned.contains((corners[0] + corners[2]) / 2.0));
    desk.click(Role::Button, "Fit box");
    assert_eq!(desk.open().clip.level, fitted);
}

/// A third of the surface is a third of the picture: looked at from above in parallel projection. The
/// saved picture has the same.
#[test]
fn what_is_outside_is_not_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = Desk::drawn(Some(&flight("tests/windrow")), &WIDE);
    desk.press(Modifiers::NONE, Key::Num5);
    desk.press(Modifiers::NONE, Key::T);
    let mut layers = desk.harness.state().state().preferences.layers;
    layers = layers.corner_ray_figure();
    for scope in [
        &mut layers.frusta,
        &mut layers.outlines,
        &mut layers.corner_rays,
    ] {
        *scope = fragscale::render::Scope::None;
    }
    (layers.axes, layers.scale_bar, layers.eye_dome) = (false, false, false);
    let surface = |desk: &mut Desk, name: &str| {
        let path = folder.path().join(name);
        desk.press(Modifiers::COMMAND, Key::P);
        desk.click(Role::RadioButton, "Transparent");
        desk.type_path(&path);
        desk.click(Role::Button, "Write picture");
        let picture = image::open(&path).expect("a PNG").to_rgba8();
        picture.pixels().filter(|pixel| pixel[3] == 255).count() as f64
    };
    for cloud in [false, true] {
        (layers.mesh, layers.cloud) = (!cloud, cloud);
        desk.harness.state_mut().apply(Command::Layers(layers));
        desk.settle();
        let whole = surface(&mut desk, &format!("whole-{cloud}.png"));
        let bounds = desk.open().extent.surface;
        let mut level = LevelBox::of(&bounds.widened(0.5));
        level.high.x = bounds.min.x + bounds.size().x / 3.0;
        set(&mut desk, level);
        desk.harness
            .state_mut()
            .apply(Command::Clip(ClipStep::On(true)));
        desk.settle();
        let third = surface(&mut desk, &format!("third-{cloud}.png"));
        // The box's edges are translucent.
        assert!(
            (third / whole - 1.0 / 3.0).abs() < 0.03,
            "{third} of {whole}, {cloud}"
        );
        // Turned by half a circle about its middle it is the same box.
        set(&mut desk, level.turned_to(std::f64::consts::PI));
        let same = surface(&mut desk, &format!("same-{cloud}.png"));
        assert!((same / third - 1.0).abs() < 0.01, "{same} {third}");
        desk.harness
            .state_mut()
            .apply(Command::Clip(ClipStep::On(false)));
    }
}
