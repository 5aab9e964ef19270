//! The whole window as it looks, kept as pictures (`tests/snapshots`; `UPDATE_SNAPSHOTS=1` makes them
//! new). Small ones, because they are kept.

use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme};

use crate::desk::{Desk, Screen, flight};

/// The window with the sample flight, after somebody has done something.
fn sample(screen: &Screen, name: &str, prepare: impl FnOnce(&mut Desk)) {
    let mut desk = Desk::drawn(Some(&flight("assets/sample")), screen);
    prepare(&mut desk);
    desk.harness.remove_cursor();
    desk.settle();
    desk.harness.snapshot(name);
}

#[test]
fn dark() {
    let screen = Screen {
        size: [1000.0, 520.0],
        pixels_per_point: 1.0,
        theme: Theme::Dark,
    };
    sample(&screen, "window_dark", |_| {});
}

#[test]
fn light() {
    let screen = Screen {
        size: [900.0, 480.0],
        pixels_per_point: 1.0,
        theme: Theme::Light,
    };
    sample(&screen, "window_light", |desk| {
        desk.press(Modifiers::NONE, Key::T);
        desk.click(Role::Tab, "Flight");
    });
}

#[test]
fn at_200_percent() {
    let screen = Screen {
        size: [640.0, 330.0],
        pixels_per_point: 2.0,
        theme: Theme::Dark,
    };
    sample(&screen, "window_200_percent", |desk| {
        desk.click(Role::Tab, "Limits");
    });
}

/// The photo by its scale, with lines at round values and the legend; the pile below it is the steepest.
#[test]
fn tinted() {
    let screen = Screen {
        size: [900.0, 520.0],
        pixels_per_point: 1.0,
        theme: Theme::Dark,
    };
    sample(&screen, "window_tint", |desk| {
        // By keys: the middle of a row that is wider than its panel lies under the viewport.
        for _ in 0..4 {
            desk.press(Modifiers::NONE, Key::ArrowDown);
        }
        assert_eq!(desk.selected(), "IMG_0005.jpg");
        desk.click(Role::Button, "Tint by scale");
    });
}

#[test]
fn the_start_page() {
    let screen = Screen {
        size: [640.0, 400.0],
        pixels_per_point: 1.0,
        theme: Theme::Light,
    };
    let mut desk = Desk::drawn(None, &screen);
    desk.harness.snapshot("window_start");
}

/// The page of the flight plan with a photo that is looked at and the way.
#[test]
fn planning() {
    let screen = Screen {
        size: [1000.0, 560.0],
        pixels_per_point: 1.0,
        theme: Theme::Dark,
    };
    sample(&screen, "window_planning", |desk| {
        desk.press(Modifiers::COMMAND, Key::Num3);
        desk.fill("Clearance", "0.1");
        desk.click(Role::Button, "Set take-off");
        let place = desk.viewport();
        desk.click_at(place.center() + egui::vec2(-0.25 * place.width(), 0.12 * place.height()));
        desk.press(Modifiers::NONE, Key::ArrowDown);
    });
}
