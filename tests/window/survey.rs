//! Drawing on the surface to measure there.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use fragscale::app::Command;
use fragscale::app::open_flight::survey::{BaseChoice, SurveyStep, SurveyTool};
use glam::DVec3;

use crate::desk::{Desk, flight};
use crate::viewport::{on_screen, on_windrow};

fn click(desk: &mut Desk, point: DVec3) {
    let at = on_screen(desk, &desk.open().looking.orbit.view(), point);
    desk.click_at(at);
}

#[test]
fn a_profile_is_drawn_and_measured() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::T);
    desk.click(Role::Button, "Profile along a line");
    assert!(desk.says("Click the points of a line"));
    let (from, to) = (on_windrow(-1.0, 0.1), on_windrow(0.2, 0.1));
    let before = desk.selected().to_owned();
    click(&mut desk, from);
    // Live: the mouse is the line's end until it is clicked.
    let at = on_screen(
        &desk,
        &desk.open().looking.orbit.view(),
        on_windrow(0.0, 0.1),
    );
    // The first brings the mouse there, the second moves it.
    for step in [6.0, 0.0] {
        desk.harness.hover_at(at + egui::vec2(step, 0.0));
        desk.settle();
    }
    let length = |desk: &Desk| {
        let drawn = desk.open().pointer.drawn.as_ref().expect("a tool");
        drawn.profile().expect("a profile").length
    };
    assert!((length(&desk) - 1.0).abs() < 0.01, "{}", length(&desk));
    click(&mut desk, to);
    desk.press(Modifiers::NONE, Key::Enter);
    assert!((length(&desk) - 1.2).abs() < 0.01, "{}", length(&desk));
    assert!(desk.says("Length in plan"));
    let drawn = desk.open().pointer.drawn.as_ref().expect("a tool");
    let profile = drawn.profile().expect("a profile");
    for at in profile.points() {
        let expected = on_windrow(at.point.x, at.point.y).z;
        assert!(
            (at.point.z - expected).abs() < 1e-6,
            "{at:?} for {expected}"
        );
    }
    // The flank rises 3 in 4: 36.87 degrees, from -0.64 to -0.32.
    let face = profile.faces()[0].expect("a face");
    assert!(
        (face.repose.expect("an angle") - 36.87).abs() < 0.02,
        "{face:?}"
    );
    assert!((face.toe.point.x + 0.64).abs() < 1e-3, "{face:?}");
    assert!((face.height() - 0.24).abs() < 1e-3, "{face:?}");
    assert!(desk.says("36.9°"));
    assert_eq!(desk.selected(), before, "these clicks select nothing");
    desk.node(Role::Button, "Copy points").click();
    desk.harness.step();
    let copied = desk.copied().expect("a text");
    assert!(
        copied.starts_with("distance_m,x_m,y_m,height_m,part\n"),
        "{copied}"
    );
    // The file is that of the command.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("profile.csv");
    desk.settle();
    desk.click(Role::Button, "Save CSV…");
    desk.type_path(&path);
    desk.click(Role::Button, "Write table");
    assert_eq!(std::fs::read_to_string(&path).expect("a table"), copied);
    desk.press(Modifiers::NONE, Key::Backspace);
    let points = |desk: &Desk| {
        desk.open()
            .pointer
            .drawn
            .as_ref()
            .map(|drawn| drawn.points.len())
    };
    assert_eq!(points(&desk), Some(1));
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(points(&desk), None);
}

#[test]
fn a_volume_is_drawn_and_measured() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::T);
    desk.click(Role::Button, "Volume inside a polygon");
    for (x, y) in [(-0.3, -0.2), (0.2, -0.2), (0.2, 0.3), (-0.3, 0.3)] {
        click(&mut desk, on_windrow(x, y));
    }
    desk.press(Modifiers::NONE, Key::Enter);
    let base = |height: f64| Command::Survey(SurveyStep::Base(BaseChoice::Height(height)));
    desk.harness.state_mut().apply(base(0.14));
    desk.settle();
    let drawn = desk.open().pointer.drawn.as_ref().expect("a tool");
    assert!(drawn.finished && drawn.tool == SurveyTool::Volume);
    let volume = drawn.volume().expect("a volume");
    assert!((volume.plan_area - 0.25).abs() < 2e-3, "{volume:?}");
    // The level crest, which rises by 0.02 a unit along y: 0.241 in the square's middle.
    assert!(
        (volume.fill / volume.plan_area - 0.101).abs() < 1e-4,
        "{volume:?}"
    );
    assert!(volume.cut == 0.0, "{volume:?}");
    for name in ["Fill (above)", "Cut (below)", "Plan area", "Surface area"] {
        assert!(desk.says(name), "{name}");
    }
    desk.click(Role::RadioButton, "its rim");
    let drawn = desk.open().pointer.drawn.as_ref().expect("a tool");
    // A plane lies on the plane through its rim.
    assert!(drawn.volume().expect("a volume").net().abs() < 1e-6);
    desk.node(Role::Button, "Copy numbers").click();
    desk.harness.step();
    let copied = desk.copied().expect("a text");
    assert!(
        copied.contains("m³") && copied.contains("\nx,y\n"),
        "{copied}"
    );
    // Measuring puts it away.
    desk.press(Modifiers::NONE, Key::M);
    assert!(desk.open().pointer.drawn.is_none());
}
