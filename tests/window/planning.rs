//! The page of the flight plan: what is asked for, dragged, drawn, taken back, and the files that it becomes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command as Program;

use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::NodeT;
use fragscale::app::planning::PlanStep;
use fragscale::app::size_distributions::Page;
use fragscale::app::{App, Command};
use fragscale::formats::read_mission;
use fragscale::plan::Size;
use glam::DVec2;

use crate::desk::Desk;

/// A plane in UTM that falls to the east by 1 in 2, with a ridge so that a pile is found, and a flight of one photo.
pub fn pile(folder: &Path) -> PathBuf {
    let mut points = String::new();
    for i in 0..81 * 81 {
        let (x, y) = (f64::from(i % 81) * 2.5, f64::from(i / 81) * 2.5);
        let off = DVec2::new(x - 100.0, y - 100.0).length();
        let z = 300.0 + (20.0 - 0.4 * off).max(0.0);
        points += &format!("{} {} {z}\n", 450_000.0 + x, 5_400_000.0 + y);
    }
    fs::write(folder.join("pile.xyz"), points).expect("a cloud");
    let pose = "photo,x,y,z,tilt,pan\nA.jpg,450100,5400100,400,90,0\n";
    fs::write(folder.join("poses.csv"), pose).expect("poses");
    let camera = std::path::absolute("assets/sample/ost.yaml").expect("a path");
    let text = format!(
        "format = 1\n[world]\nunit = \"m\"\ncrs = \"EPSG:32632\"\n[surface]\nfile = \"pile.xyz\"\n\
         [[camera]]\nfile = '{}'\n[photos]\nposes = \"poses.csv\"\n",
        camera.display()
    );
    fs::write(folder.join("flight.toml"), text).expect("a flight");
    folder.join("flight.toml")
}

/// At its page, seen from above.
pub fn planned(flight: &Path) -> Desk {
    let mut desk = Desk::new(Some(flight));
    desk.press(Modifiers::COMMAND, Key::Num3);
    desk.press(Modifiers::NONE, Key::T);
    desk.fill("Scale", "0.3");
    desk
}

pub fn count(desk: &Desk) -> usize {
    desk.open()
        .planning
        .made
        .as_ref()
        .expect("a plan")
        .plan
        .photos
        .len()
}

/// A place of the viewport, in parts of it off its middle.
fn at(desk: &Desk, x: f32, y: f32) -> Pos2 {
    let place = desk.viewport();
    place.center() + vec2(x * place.width(), y * place.height())
}

fn drag(desk: &mut Desk, from: Pos2, to: Pos2) {
    desk.harness.hover_at(from);
    desk.harness.drag_at(from);
    desk.harness.step();
    for share in [0.5, 1.0] {
        desk.harness.hover_at(from.lerp(to, share));
        desk.harness.step();
    }
    desk.harness.drop_at(to);
    desk.settle();
}

/// Another unit of the flight changes what its coordinates mean, not what was asked of the plan.
#[test]
fn what_was_asked_in_metres_stays_so_long_in_feet() {
    let mut desk = Desk::new(Some(&crate::desk::flight("assets/sample")));
    desk.press(Modifiers::COMMAND, Key::Num3);
    let before = desk.open().planning.now().expect("a wish").clone();
    desk.press(Modifiers::COMMAND, Key::Num1);
    desk.click(Role::Tab, "Flight");
    desk.click(Role::ComboBox, "Unit of the world's coordinates");
    desk.click(Role::Button, "ft");
    desk.press(Modifiers::COMMAND, Key::Num3);
    let planning = &desk.open().planning;
    let now = planning.now().expect("a wish").clone();
    assert!((now.clearance * 0.3048 / before.clearance - 1.0).abs() < 1e-9);
    let pixels = |size: &Size| match size {
        Size::Scale { pixels, .. } => *pixels,
        Size::Distance(_) => f64::NAN,
    };
    assert!((pixels(&now.size) / 0.3048 / pixels(&before.size) - 1.0).abs() < 1e-9);
    assert!(planning.is_of_now() || planning.refused().is_some());
}

/// The bundled lab is flown from half a metre, where the usual clearance of 5 m would refuse every photo.
#[test]
fn a_lab_begins_with_a_clearance_that_fits() {
    let mut desk = Desk::new(Some(&crate::desk::flight("assets/sample")));
    desk.press(Modifiers::COMMAND, Key::Num3);
    let asked = desk.open().planning.now().expect("a wish").clone();
    assert_eq!(asked.clearance, 0.2);
    assert!(count(&desk) > 0);
    desk.fill("Clearance", "5");
    assert!(desk.says("the clearance"));
    // Flown from a hundred metres it is the usual one, in feet as in metres.
    let folder = tempfile::tempdir().expect("a folder");
    let flight = pile(folder.path());
    let in_metres = fs::read_to_string(&flight).expect("a flight");
    // A system in metres would contradict feet.
    let in_feet = in_metres.replace("unit = \"m\"\ncrs = \"EPSG:32632\"", "unit = \"ft\"");
    for (text, clearance) in [(in_metres, 5.0), (in_feet, 5.0 / 0.3048)] {
        fs::write(&flight, &text).expect("a flight");
        let mut desk = Desk::new(Some(&flight));
        desk.press(Modifiers::COMMAND, Key::Num3);
        let asked = desk.open().planning.now().expect("a wish").clearance;
        assert!((asked - clearance).abs() < 1e-9, "{asked}: {text}");
    }
}

/// What the page writes is what the command writes.
#[test]
fn window_and_command_plan_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let flight = pile(folder.path());
    let mut desk = planned(&flight);
    assert_eq!(desk.harness.state().state().page, Page::Plan);
    assert!(count(&desk) > 3);
    desk.click(Role::Button, "Set take-off");
    let take_off = at(&desk, -0.25, 0.15);
    desk.click_at(take_off);
    let place = (desk.open().planning.now())
        .and_then(|asked| asked.take_off)
        .expect("a take-off");
    desk.click(Role::Button, "Save table…");
    desk.type_path(&folder.path().join("window.csv"));
    desk.click(Role::Button, "Write table");
    desk.click(Role::Button, "Save mission…");
    let mission = folder.path().join("window.plan");
    desk.type_path(&mission);
    desk.click(Role::Button, "Write mission");
    desk.click(Role::Button, "Save page…");
    desk.type_path(&folder.path().join("window.html"));
    desk.click(Role::Button, "Write page");
    let command = Program::new(env!("CARGO_BIN_EXE_fragscale"))
        .args([
            "plan",
            "--scale",
            "0.3 px/cm",
            "--format",
            "csv",
            "--output",
        ])
        .arg(folder.path().join("command.csv"))
        .arg(format!("--take-off={},{}", place.x, place.y))
        .arg("--mission")
        .arg(folder.path().join("command.plan"))
        .arg("--sheet")
        .arg(folder.path().join("command.html"))
        .arg(&flight)
        .output()
        .expect("the command");
    assert!(
        command.status.success(),
        "{}",
        String::from_utf8_lossy(&command.stderr)
    );
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
    assert_eq!(read("window.csv"), read("command.csv"));
    assert_eq!(read("window.plan"), read("command.plan"));
    // The command says besides which area was found.
    let page = read("window.html");
    assert!(page.contains("P001") && page.len() > read("command.html").len() / 2);
    let read = read_mission(&mission).expect("a mission").mission;
    let photos = read
        .stops
        .iter()
        .filter(|stop| stop.photo.is_some())
        .count();
    assert_eq!(photos, count(&desk));
}

/// An area is drawn by clicks, its corner dragged, and each of it is one step back.
#[test]
fn areas_are_drawn_dragged_and_taken_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = planned(&pile(folder.path()));
    let found = count(&desk);
    desk.click(Role::Button, "Draw area");
    for (x, y) in [
        (-0.1, -0.1),
        (0.1, -0.1),
        (0.15, 0.1),
        (0.1, 0.1),
        (-0.1, 0.1),
    ] {
        let place = at(&desk, x, y);
        desk.click_at(place);
    }
    // The one in the middle was a mistake.
    assert_eq!(desk.open().planning.drawing.len(), 5);
    desk.press(Modifiers::NONE, Key::Backspace);
    desk.press(Modifiers::NONE, Key::Backspace);
    desk.press(Modifiers::NONE, Key::Backspace);
    for (x, y) in [(0.1, 0.1), (-0.1, 0.1)] {
        let place = at(&desk, x, y);
        desk.click_at(place);
    }
    desk.press(Modifiers::NONE, Key::Enter);
    let drawn = desk
        .open()
        .planning
        .now()
        .and_then(|asked| asked.area.clone())
        .expect("an area");
    assert_eq!(drawn.len(), 4);
    let of_area = count(&desk);
    assert!(of_area < found, "{of_area} {found}");
    let corner = desk
        .node(Role::Slider, "Corner 2 of the area")
        .rect()
        .center();
    let to = at(&desk, 0.2, -0.15);
    drag(&mut desk, corner, to);
    let moved = desk
        .open()
        .planning
        .now()
        .and_then(|asked| asked.area.clone())
        .expect("an area");
    assert!(moved[1].distance(drawn[1]) > 5.0, "{moved:?} {drawn:?}");
    assert_eq!(
        [moved[0], moved[2], moved[3]],
        [drawn[0], drawn[2], drawn[3]]
    );
    assert!(count(&desk) > of_area);
    // Under the mouse, to a pixel.
    let corner = desk
        .node(Role::Slider, "Corner 2 of the area")
        .rect()
        .center();
    assert!(corner.distance(to) < 4.0, "{corner} {to}");
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(count(&desk), of_area);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(count(&desk), found);
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(count(&desk), of_area);
}

/// Photos are selected, dragged, left out and added, and their numbers are those of the new place at once.
#[test]
fn photos_are_changed_by_hand() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = planned(&pile(folder.path()));
    let before = count(&desk);
    desk.press(Modifiers::NONE, Key::ArrowDown);
    desk.press(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(desk.open().planning.selected(), Some(1));
    // A click on its name in the table does the same.
    desk.click(Role::Label, "P001");
    assert_eq!(desk.open().planning.selected(), Some(0));
    desk.press(Modifiers::NONE, Key::ArrowDown);
    let of = |desk: &Desk| {
        let (_, photo) = desk.open().planning.photo().expect("a photo");
        (
            photo.name.clone(),
            photo.target,
            photo.forecast.expect("a forecast"),
        )
    };
    let (name, target, _) = of(&desk);
    let handle = format!("Middle of {name}");
    let from = desk.node(Role::Slider, &handle).rect().center();
    let place = at(&desk, 0.05, 0.05);
    drag(&mut desk, from, place);
    let (same, moved, forecast) = of(&desk);
    assert_eq!(same, name);
    assert!(moved.distance(target) > 3.0);
    // 0.3 px/cm in the middle of what it will show.
    let [least, greatest] = forecast.bulk;
    assert!(
        ((least + greatest) / 2.0 / 30.0 - 1.0).abs() < 0.01,
        "{least} {greatest}"
    );
    desk.press(Modifiers::NONE, Key::Delete);
    assert_eq!(count(&desk), before - 1);
    desk.click(Role::Button, "Add photos");
    let place = at(&desk, -0.05, 0.02);
    desk.click_at(place);
    let place = at(&desk, 0.02, -0.05);
    desk.click_at(place);
    assert_eq!(count(&desk), before + 1);
    desk.press(Modifiers::NONE, Key::Escape);
    desk.press(Modifiers::NONE, Key::ArrowUp);
    desk.press(Modifiers::NONE, Key::C);
    assert!(desk.open().planning.through);
    desk.press(Modifiers::NONE, Key::Escape);
    assert!(!desk.open().planning.through);
    // Planned anew, photos have other names: what was done by hand cannot stay, and that is said.
    assert!(!desk.logged("by hand is gone"));
    desk.fill("Clearance", "6");
    assert!(desk.logged("by hand is gone"));
    assert_eq!(count(&desk), before);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(count(&desk), before + 1);
    desk.click(Role::Button, "As planned");
    assert_eq!(count(&desk), before);
}

/// Why nothing is planned stands above the fields, which are higher than a small window.
#[test]
fn why_nothing_is_planned_is_seen_in_a_small_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = pile(folder.path());
    let harness = Harness::builder()
        .with_size([800.0, 600.0])
        .with_max_steps(30)
        .build_eframe(|context| App::new(context, vec![path]));
    let mut desk = Desk { harness };
    desk.settle();
    desk.press(Modifiers::COMMAND, Key::Num3);
    let mut asked = desk.open().planning.now().expect("a wish").clone();
    asked.clearance = 200.0;
    let ask = Command::Plan(PlanStep::Ask(Box::new(asked)));
    desk.harness.state_mut().apply(ask);
    desk.settle();
    let why = desk.open().planning.refused().expect("a reason").to_owned();
    let written = desk.written();
    let why = written.iter().find(|written| written.text == why);
    let why = why.expect("it is drawn");
    assert!(why.seen_in.expand(1.0).contains_rect(why.place));
    assert!(desk.shows(Role::Button, "Plan again"));
}

/// A keep-out over a part of the pile, and fields that are wrong or cannot be.
#[test]
fn what_cannot_be_is_said_and_taken_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = planned(&pile(folder.path()));
    desk.click(Role::Button, "Draw keep-out");
    for (x, y) in [(-0.1, -0.15), (0.1, -0.15), (0.1, 0.15)] {
        let place = at(&desk, x, y);
        desk.click_at(place);
    }
    desk.press(Modifiers::NONE, Key::Enter);
    let made = desk.open().planning.made.clone().expect("a plan");
    assert!(
        made.plan
            .refused
            .iter()
            .any(|refused| refused.why.contains("keep out"))
    );
    assert!(desk.says("keep out"));
    // Nearer than it may be to the ground.
    desk.fill("Clearance", "200");
    assert!(
        desk.says("the clearance"),
        "{:?}",
        desk.open().planning.refused()
    );
    assert!(desk.shows(Role::Button, "Plan again"));
    // Nothing of the plan before.
    assert!(!desk.says("Photographed") && !desk.says("P001"));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(desk.open().planning.is_of_now());
    // A mission needs a take-off; a table does not.
    let is_grey = |name: &str| {
        let node = desk.node(Role::Button, name);
        node.accesskit_node().is_disabled()
    };
    assert!(is_grey("Save mission…") && !is_grey("Save table…"));
    let to = folder.path().join("m.kml");
    let save = PlanStep::SaveMission(to.clone().into());
    desk.harness.state_mut().apply(Command::Plan(save));
    desk.settle();
    assert!(desk.logged("takes off"));
    assert!(!to.exists());
    desk.fill("Scale", "0");
    assert!(
        matches!(desk.open().planning.now().expect("a wish").size, Size::Scale { pixels, .. } if pixels > 0.0)
    );
}
