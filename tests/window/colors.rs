//! The limits of the surface's colours: histogram, handles, numbers, legend.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use fragscale::app::Command;
use fragscale::app::state::layers::Layers;
use fragscale::render::ColorBy;

use crate::desk::{Desk, Screen, flight};

const WIDE: Screen = Screen {
    size: [1300.0, 800.0],
    pixels_per_point: 1.0,
    theme: egui::Theme::Light,
};

fn colored(mut desk: Desk, by: ColorBy) -> Desk {
    let layers = Layers {
        color_by: by,
        ..desk.harness.state().state().preferences.layers
    };
    desk.harness.state_mut().apply(Command::Layers(layers));
    desk.settle();
    // A header that is closed has nothing in it.
    if !desk.shows(Role::Button, "Reset") {
        desk.harness.get_by_label("Layers").click();
        desk.settle();
    }
    desk
}

fn limits(desk: &Desk, by: ColorBy) -> Option<[f64; 2]> {
    desk.open().colors.limits(by)
}

fn type_limit(desk: &mut Desk, name: &str, text: &str) {
    desk.node(Role::SpinButton, name).click();
    desk.harness.run();
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.harness.event(Event::Text(text.to_owned()));
    desk.harness.run();
    desk.press(Modifiers::NONE, Key::Enter);
}

/// The values of the windrow: it lies between -0.03 and 0.27 (see `on_windrow`), its flanks rise 3 in 4.
#[test]
fn the_values_are_looked_at() {
    let desk = colored(
        Desk::new(Some(&flight("tests/windrow"))),
        ColorBy::Elevation,
    );
    let histogram = desk.open().colors.histogram(ColorBy::Elevation);
    let histogram = histogram.expect("elevations");
    let [low, high] = histogram.usual;
    assert!(
        (-0.04..0.0).contains(&low) && (0.24..0.28).contains(&high),
        "{low} {high}"
    );
    assert!(histogram.columns.contains(&1.0));
    let desk = colored(desk, ColorBy::Slope);
    let histogram = desk.open().colors.histogram(ColorBy::Slope);
    let histogram = histogram.expect("slopes");
    assert_eq!(histogram.usual, [0.0, 90.0]);
    // Level ground, and flanks of 36.87 degrees: columns are 90 / 64 wide.
    let most = |from: usize, to: usize| histogram.columns[from..to].iter().sum::<f64>();
    assert!(
        most(0, 3) > 0.5 && most(25, 28) > 0.05,
        "{:?}",
        histogram.columns
    );
    let desk = colored(desk, ColorBy::Scale);
    let histogram = desk.open().colors.histogram(ColorBy::Scale);
    let [low, high] = histogram.expect("scales").usual;
    let pair = desk.open().scale(0).expect("a scale");
    for edge in [pair.scale.top, pair.scale.bottom] {
        let edge = edge.expect("a scale");
        assert!(
            low < edge * 1.1 && edge < high * 1.1,
            "{edge} of {low} {high}"
        );
    }
}

#[test]
fn limits_are_typed_dragged_and_taken_back() {
    let by = ColorBy::Elevation;
    let mut desk = colored(Desk::drawn(Some(&flight("tests/windrow")), &WIDE), by);
    let ticks = |desk: &Desk| -> Vec<String> {
        let is_tick = |text: &String| text.parse::<f64>().is_ok();
        let viewport = desk.viewport();
        let right = viewport.right() - 60.0;
        let written = desk.written();
        let written = written.into_iter().filter(|written| {
            written.place.left() > right && viewport.contains(written.place.center())
        });
        let mut ticks: Vec<String> = written
            .map(|written| written.text)
            .filter(is_tick)
            .collect();
        ticks.dedup();
        ticks
    };
    let before = ticks(&desk);
    assert!(!before.is_empty());
    type_limit(&mut desk, "Upper limit of the colours", "5");
    let [low, high] = limits(&desk, by).expect("limits");
    assert!(low < 0.0 && high == 5.0);
    // The legend follows.
    assert!(ticks(&desk).contains(&"4".to_owned()), "{:?}", ticks(&desk));
    // The upper limit is not put under the lower one.
    type_limit(&mut desk, "Lower limit of the colours", "9");
    assert_eq!(limits(&desk, by), Some([low, high]));
    desk.click(Role::Button, "Reset");
    assert_eq!(limits(&desk, by), None);
    assert_eq!(ticks(&desk), before);
    // The lower handle to the middle between the two.
    let middle = |desk: &Desk, name| desk.node(Role::Slider, name).rect().center();
    let from = middle(&desk, "Lower handle of the colours");
    let to = from.lerp(middle(&desk, "Upper handle of the colours"), 0.5);
    desk.harness.hover_at(from);
    desk.harness.drag_at(from);
    desk.harness.run_steps(2);
    desk.harness.hover_at(to);
    desk.harness.run_steps(2);
    desk.harness.drop_at(to);
    desk.settle();
    let usual = desk.open().colors.histogram(by).expect("values").usual;
    let [low, high] = limits(&desk, by).expect("limits");
    assert_eq!(high, usual[1]);
    assert!((low - (usual[0] + usual[1]) / 2.0).abs() < 0.01, "{low}");
}
