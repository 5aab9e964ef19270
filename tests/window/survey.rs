//! Drawing on the surface to measure there.

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::Harness;
use fragscale::app::command::ViewChange;
use fragscale::app::open_flight::survey::{BaseChoice, SurveyStep, SurveyTool};
use fragscale::app::{App, Command};
use glam::{DVec2, DVec3};

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
    // The plot would lie over what is drawn.
    assert!(desk.says("So far ") && !desk.says("Length in plan"));
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
    // What is begun goes first, then the tool.
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(points(&desk), Some(0));
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(points(&desk), None);
}

/// The plot opens at the viewport's lower edge, below the line, where there is room.
#[test]
fn a_finished_profile_does_not_lie_under_its_plot() {
    let path = flight("tests/windrow");
    let harness = Harness::builder()
        .with_size([1600.0, 1300.0])
        .with_max_steps(30)
        .build_eframe(|context| App::new(context, vec![path]));
    let mut desk = Desk { harness };
    desk.settle();
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::T);
    desk.click(Role::Button, "Profile along a line");
    let ends = [on_windrow(-0.6, 0.1), on_windrow(0.2, 0.1)];
    for end in ends {
        click(&mut desk, end);
    }
    desk.press(Modifiers::NONE, Key::Enter);
    let window = desk.node(Role::Window, "Profile").rect();
    let place = desk.viewport();
    assert!(place.expand(0.5).contains_rect(window), "{window} {place}");
    let aside = (window.center().x - place.center().x).abs();
    assert!(aside < 60.0, "{window} {place}");
    for end in ends {
        let at = on_screen(&desk, &desk.open().looking.orbit.view(), end);
        assert!(!window.contains(at), "{at} in {window}");
    }
}

/// Nothing is clicked yet: what is to be clicked is in sight, wherever on the screen it lies.
#[test]
fn a_tool_that_is_taken_does_not_lie_over_the_surface() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::T);
    let place = desk.viewport();
    // To the left and down.
    let size = DVec2::new(f64::from(place.width()), f64::from(place.height()));
    let pan = ViewChange::Pan(DVec2::new(-350.0, 200.0), size);
    desk.harness.state_mut().apply(Command::View(pan));
    desk.settle();
    let view = desk.open().looking.orbit.view();
    let surface = desk.open().flight().parts().surface.clone();
    let vertices = surface.vertices().step_by(surface.vertices().len() / 300);
    let seen: Vec<_> = vertices
        .map(|vertex| on_screen(&desk, &view, vertex))
        .collect();
    assert!(seen.iter().any(|at| at.x < place.left() + 100.0));
    for (button, title) in [
        ("Profile along a line", "Profile"),
        ("Volume inside a polygon", "Volume"),
    ] {
        desk.click(Role::Button, button);
        let window = desk.node(Role::Window, title).rect();
        assert!(place.expand(0.5).contains_rect(window), "{window} {place}");
        let covered = seen.iter().filter(|at| window.contains(**at)).count();
        assert_eq!(covered, 0, "{title} at {window} in {place}");
    }
}

/// The numbers of a volume lie beside its polygon.
#[test]
fn a_finished_volume_does_not_lie_under_its_numbers() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::T);
    // To where the window of a tool begins otherwise.
    let place = desk.viewport();
    let size = DVec2::new(f64::from(place.width()), f64::from(place.height()));
    let pan = ViewChange::Pan(DVec2::new(-200.0, 150.0), size);
    desk.harness.state_mut().apply(Command::View(pan));
    desk.settle();
    desk.click(Role::Button, "Volume inside a polygon");
    let corners = [(-0.2, -0.1), (0.1, -0.1), (0.1, 0.2), (-0.2, 0.2)];
    let corners = corners.map(|(x, y)| on_windrow(x, y));
    for corner in corners {
        click(&mut desk, corner);
    }
    desk.press(Modifiers::NONE, Key::Enter);
    assert!(desk.says("Fill (above)"));
    let window = desk.node(Role::Window, "Volume").rect();
    let view = desk.open().looking.orbit.view();
    for corner in corners {
        let at = on_screen(&desk, &view, corner);
        assert!(!window.contains(at), "{at} in {window}");
    }
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
    desk.node(Role::Button, "Copy points").click();
    desk.harness.step();
    let copied = desk.copied().expect("a table");
    assert_eq!(copied.lines().count(), 5, "{copied}");
    assert!(copied.starts_with("x,y\n"), "{copied}");
    // Measuring puts it away; it is there again with its tool, and the numbers.
    let corners = |desk: &Desk| {
        desk.open()
            .pointer
            .drawn
            .as_ref()
            .map(|drawn| drawn.points.len())
    };
    desk.press(Modifiers::NONE, Key::M);
    assert_eq!(corners(&desk), None);
    desk.press(Modifiers::NONE, Key::V);
    assert_eq!(corners(&desk), Some(4));
    assert!(desk.says("Fill (above)"));
    // A click begins anew; who did not mean that takes it back, as each corner.
    for (x, y) in [(-0.2, -0.2), (0.1, -0.2)] {
        click(&mut desk, on_windrow(x, y));
    }
    assert_eq!(corners(&desk), Some(2));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(corners(&desk), Some(1));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(corners(&desk), Some(4));
    let drawn = desk.open().pointer.drawn.as_ref().expect("a tool");
    assert!(drawn.finished && drawn.volume().is_some());
    // Escape takes back what was begun, all of it: the finished one is there again, and goes with its tool.
    for (x, y) in [(-0.2, -0.2), (0.1, -0.2)] {
        click(&mut desk, on_windrow(x, y));
    }
    assert_eq!(corners(&desk), Some(2));
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(corners(&desk), Some(4));
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(corners(&desk), None);
    desk.press(Modifiers::NONE, Key::V);
    assert_eq!(corners(&desk), Some(4));
    // One that is not finished goes with its tool.
    click(&mut desk, on_windrow(-0.2, -0.2));
    for _ in 0..2 {
        desk.press(Modifiers::NONE, Key::V);
    }
    assert_eq!(corners(&desk), Some(0));
}

/// The same surface half a unit lower: as much volume as half of the area, over the file as over a level.
#[test]
fn a_volume_is_over_a_second_cloud_and_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let (base, table) = (
        folder.path().join("before.xyz"),
        folder.path().join("volume.csv"),
    );
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    let vertices = desk.open().flight().parts().surface.clone();
    let lower = vertices
        .vertices()
        .map(|p| format!("{} {} {}\n", p.x, p.y, p.z - 0.5));
    std::fs::write(&base, lower.collect::<String>()).expect("a cloud");
    desk.press(Modifiers::NONE, Key::F2);
    desk.press(Modifiers::NONE, Key::T);
    desk.click(Role::Button, "Volume inside a polygon");
    for (x, y) in [(-0.3, -0.2), (0.2, -0.2), (0.2, 0.3), (-0.3, 0.3)] {
        click(&mut desk, on_windrow(x, y));
    }
    desk.press(Modifiers::NONE, Key::Enter);
    desk.click(Role::Button, "Choose…");
    desk.type_path(&base);
    desk.click(Role::Button, "Use it");
    let drawn = desk.open().pointer.drawn.as_ref().expect("a tool");
    assert_eq!(drawn.base, BaseChoice::Second);
    let volume = *drawn.volume().expect("a volume");
    assert!(
        (volume.fill - 0.5 * volume.plan_area).abs() < 1e-6 && volume.cut.abs() < 1e-9,
        "{volume:?}"
    );
    assert!(desk.says("before.xyz"));
    assert!(desk.logged("neither of the two states a coordinate system"));
    desk.click(Role::Button, "Save CSV…");
    desk.type_path(&table);
    desk.click(Role::Button, "Write table");
    let written = std::fs::read_to_string(&table).expect("a table");
    assert!(
        written.starts_with("flight,base,fill_m3,cut_m3"),
        "{written}"
    );
    assert!(written.contains(&volume.fill.to_string()) && written.contains("before.xyz"));
    // What is read is not written over.
    desk.click(Role::Button, "Save CSV…");
    desk.type_path(&base);
    desk.click(Role::Button, "Write table");
    assert!(
        std::fs::read_to_string(&base)
            .expect("the cloud")
            .starts_with(|c: char| c != 'f')
    );
    // One that lies far away is in another world.
    let far = folder.path().join("far.xyz");
    std::fs::write(
        &far,
        "500000 5000000 1\n500001 5000000 1\n500000 5000001 1\n",
    )
    .expect("a cloud");
    desk.click(Role::Button, "Choose…");
    desk.type_path(&far);
    desk.click(Role::Button, "Use it");
    assert!(desk.logged("far.xyz: it is not in the flight's frame"));
    let drawn = desk.open().pointer.drawn.as_ref().expect("a tool");
    assert_eq!(drawn.volume(), Some(&volume));
}
