//! A flight plan stands in its flight's file, and nothing of it goes without a question.

use std::fs;

use egui::accesskit::Role;
use egui::{Key, Modifiers};

use crate::desk::Desk;
use crate::planning::{count, pile, planned};

/// Saved with the flight, a plan is there when that is opened again: areas, take-off, and what was moved by hand.
#[test]
fn a_plan_is_saved_with_its_flight() {
    let folder = tempfile::tempdir().expect("a folder");
    let flight = pile(folder.path());
    let before = fs::read_to_string(&flight).expect("a flight");
    let mut desk = Desk::new(Some(&flight));
    desk.press(Modifiers::COMMAND, Key::Num3);
    assert!(!desk.open().is_changed(), "nobody asked for anything");
    let mut desk = planned(&flight);
    desk.fill(
        "Corners of the area",
        "450060,5400060;450140,5400060;450140,5400140;450060,5400140",
    );
    desk.fill("Take-off", "450030,5400040");
    desk.harness
        .state_mut()
        .apply(fragscale::app::Command::Plan(
            fragscale::app::planning::PlanStep::Select(Some(0)),
        ));
    desk.settle();
    desk.click(Role::Button, "Leave out");
    let asked = desk.open().planning.now().expect("asked").clone();
    assert_eq!(asked.edits.len(), 1);
    assert!(desk.open().is_changed());
    let photos = count(&desk);
    desk.press(Modifiers::COMMAND, Key::S);
    assert!(!desk.open().is_changed());
    let text = fs::read_to_string(&flight).expect("a flight");
    assert!(text.starts_with(&before), "{text}");
    assert!(text.contains("\n[plan]\npattern = \"slope\"\n"), "{text}");
    let with_edit = text;
    // Another look at it.
    let mut desk = Desk::new(Some(&flight));
    assert!(!desk.open().is_changed());
    desk.press(Modifiers::COMMAND, Key::Num3);
    assert_eq!(desk.open().planning.now(), Some(&asked));
    assert_eq!(count(&desk), photos);
    assert!(!desk.open().is_changed());
    // What is changed then is asked for.
    desk.fill("Take-off", "450031,5400040");
    desk.press(Modifiers::COMMAND, Key::W);
    assert!(desk.says("its flight plan"));
    desk.click(Role::Button, "Save them");
    let text = fs::read_to_string(&flight).expect("a flight");
    assert!(text.contains("take_off = [450031.0, 5400040.0]"), "{text}");
    // Of another plan the same name is another photo's: nothing is done to it, and that is said.
    let other = with_edit.replace(
        "take_off = [450030.0, 5400040.0]",
        "take_off = [450170.0, 5400160.0]",
    );
    assert_ne!(other, with_edit);
    fs::write(&flight, &other).expect("a flight");
    let mut desk = Desk::new(Some(&flight));
    desk.press(Modifiers::COMMAND, Key::Num3);
    assert_eq!(count(&desk), photos + 1, "nothing is left out");
    assert!(desk.logged("is not taken: this plan has another photo of that name, or none"));
    // By hand little is needed.
    let head = text.split("[plan]").next().expect("a head");
    fs::write(
        &flight,
        format!("{head}[plan]\npattern = \"slope\"\nscale = 30\nclearance = 6\n"),
    )
    .expect("a flight");
    let mut desk = Desk::new(Some(&flight));
    desk.press(Modifiers::COMMAND, Key::Num3);
    let now = desk.open().planning.now().expect("asked");
    assert_eq!((now.clearance, now.edits.len()), (6.0, 0));
    assert!(count(&desk) > 0);
    // What cannot be read says where.
    let broken = text.replace("pattern = \"slope\"", "pattern = \"spiral\"");
    fs::write(&flight, &broken).expect("a flight");
    let line = broken.lines().position(|line| line.contains("spiral"));
    let desk = Desk::new(Some(&flight));
    let place = format!("flight.toml:{}", line.map_or(0, |line| line + 1));
    assert!(desk.logged(&place) && desk.logged("plan.pattern 'spiral' is not known"));
}

/// A cloud alone has no flight.toml until a flight is planned over it: then it is kept there, without photos.
#[test]
fn a_plan_over_a_cloud_alone_is_saved_with_the_cloud() {
    let folder = tempfile::tempdir().expect("a folder");
    pile(folder.path());
    let cloud = folder.path().join("pile.xyz");
    let mut desk = Desk::new(Some(&cloud));
    desk.press(Modifiers::COMMAND, Key::S);
    assert!(desk.logged(
        "a cloud without photos makes no flight; add its cameras first, or plan a flight over it"
    ));
    desk.click(Role::Tab, "Flight");
    desk.click(Role::ComboBox, "Unit of the world's coordinates");
    desk.click(Role::Button, "m");
    desk.press(Modifiers::COMMAND, Key::Num3);
    desk.fill("Take-off", "450030,5400040");
    let asked = desk.open().planning.now().expect("asked").clone();
    desk.press(Modifiers::COMMAND, Key::W);
    desk.click(Role::Button, "Save it");
    let file = folder.path().join("next blast.toml");
    desk.type_path(&file);
    desk.press(Modifiers::NONE, Key::Enter);
    assert!(
        desk.harness.state().state().open.is_none(),
        "saved, it closes"
    );
    let text = fs::read_to_string(&file).expect("a flight");
    assert!(
        text.contains("file = \"pile.xyz\"") && !text.contains("[photos]"),
        "{text}"
    );
    let mut desk = Desk::new(Some(&file));
    assert!(desk.open().files.origin.is_surface_alone());
    assert!(!desk.open().is_changed());
    desk.press(Modifiers::COMMAND, Key::Num3);
    assert_eq!(desk.open().planning.now(), Some(&asked));
    assert!(count(&desk) > 0);
    desk.fill("Take-off", "450031,5400040");
    assert!(desk.open().is_changed());
    desk.press(Modifiers::COMMAND, Key::S);
    assert!(!desk.open().is_changed());
    let text = fs::read_to_string(&file).expect("a flight");
    assert!(text.contains("take_off = [450031.0, 5400040.0]"), "{text}");
}

/// A cloud alone has no flight.toml: its plan is in a mission, a sheet or a table, or it is asked about.
#[test]
fn a_plan_over_a_cloud_alone_is_asked_about() {
    let folder = tempfile::tempdir().expect("a folder");
    pile(folder.path());
    let cloud = folder.path().join("pile.xyz");
    let mut desk = Desk::new(Some(&cloud));
    assert!(desk.open().files.origin.is_surface_alone());
    desk.click(Role::Tab, "Flight");
    desk.click(Role::ComboBox, "Unit of the world's coordinates");
    desk.click(Role::Button, "m");
    desk.press(Modifiers::COMMAND, Key::Num3);
    desk.press(Modifiers::COMMAND, Key::W);
    assert!(desk.harness.state().state().open.is_none(), "it is usual");
    let mut desk = Desk::new(Some(&cloud));
    desk.click(Role::Tab, "Flight");
    desk.click(Role::ComboBox, "Unit of the world's coordinates");
    desk.click(Role::Button, "m");
    desk.press(Modifiers::COMMAND, Key::Num3);
    desk.fill("Take-off", "450030,5400040");
    desk.press(Modifiers::COMMAND, Key::W);
    assert!(desk.says("The flight plan is in no file"));
    desk.click(Role::Button, "Stay here");
    desk.click(Role::Button, "Save table…");
    desk.type_path(&folder.path().join("plan.csv"));
    desk.click(Role::Button, "Write table");
    desk.press(Modifiers::COMMAND, Key::W);
    assert!(desk.harness.state().state().open.is_none());
}
