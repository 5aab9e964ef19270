//! What the page of the plan takes from files and from the keyboard: areas, and missions that were flown.

use std::fs;
use std::path::Path;
use std::process::Command as Program;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use fragscale::app::size_distributions::Page;
use fragscale::plan::Pattern;
use glam::DVec2;

use crate::desk::Desk;
use crate::dropping::drop_on;
use crate::planning::{count, pile, planned};

fn area(desk: &Desk) -> Vec<DVec2> {
    let now = desk.open().planning.now();
    now.and_then(|asked| asked.area.clone()).expect("an area")
}

/// Corners are typed, read from a file of a map, and dropped; each is one step back, and what is none is said.
#[test]
fn areas_are_typed_loaded_and_dropped() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = planned(&pile(folder.path()));
    let found = count(&desk);
    desk.fill(
        "Corners of the area",
        "450080,5400080;450120,5400080;450120,5400120;450080,5400120",
    );
    assert_eq!(area(&desk)[2], DVec2::new(450_120.0, 5_400_120.0));
    assert!(count(&desk) < found);
    let typed = area(&desk);
    desk.fill("Corners of the area", "450080,5400080;450120,nowhere");
    assert!(desk.logged("nowhere"));
    assert_eq!(area(&desk), typed);
    // Longitude and latitude of EPSG:32632, as PROJ 9 has them: the north-east of the pile, 450100 to 450140.
    let ring = "[[8.3211304,48.7519135],[8.3216825,48.7515565],[8.3216728,48.7522761],[8.3211304,48.7519135]]";
    let file = folder.path().join("part.geojson");
    let text = format!("{{\"type\":\"Polygon\",\"coordinates\":[{ring}]}}");
    fs::write(&file, text).expect("a file");
    drop_on(&mut desk, &[&file]);
    let dropped = area(&desk);
    assert_eq!(dropped.len(), 3);
    assert!(
        dropped[1].distance(DVec2::new(450_140.0, 5_400_060.0)) < 0.1,
        "{dropped:?}"
    );
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(area(&desk), typed);
    // While ground to keep out of is drawn, it is that; so is what is typed beside it.
    desk.click(Role::Button, "Draw keep-out");
    drop_on(&mut desk, &[&file]);
    desk.fill(
        "Corners to keep out of",
        "450060,5400060;450070,5400060;450070,5400070",
    );
    let kept = |desk: &Desk| {
        desk.open()
            .planning
            .now()
            .map_or(0, |asked| asked.keep_out.len())
    };
    assert_eq!(kept(&desk), 2);
    assert_eq!(area(&desk), typed);
    desk.fill("Take-off", "450030,5400040");
    let now = desk.open().planning.now().expect("asked").clone();
    assert_eq!(now.take_off, Some(DVec2::new(450_030.0, 5_400_040.0)));
    // It is no flight to be opened.
    assert_eq!(desk.open().flight().parts().photos.len(), 1);
}

/// What the page says of both kinds is what the command plans.
#[test]
fn both_kinds_are_planned_in_the_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let flight = pile(folder.path());
    let mut desk = planned(&flight);
    desk.click(Role::ComboBox, "Pattern");
    desk.click(Role::Button, Pattern::Both.title());
    desk.fill("Survey's scale", "0.15");
    desk.click(Role::CheckBox, "Cross grid");
    desk.fill("Take-off", "450030,5400040");
    desk.fill("Steepest leg", "20");
    desk.click(Role::Button, "Save table…");
    desk.type_path(&folder.path().join("window.csv"));
    desk.click(Role::Button, "Write table");
    let output = Program::new(env!("CARGO_BIN_EXE_fragscale"))
        .args([
            "plan",
            "--scale",
            "0.3 px/cm",
            "--pattern",
            "both",
            "--survey-scale",
        ])
        .args([
            "0.15 px/cm",
            "--cross-grid",
            "--steepest",
            "20",
            "--format",
            "csv",
            "-o",
        ])
        .arg(folder.path().join("command.csv"))
        .arg("--take-off=450030,5400040")
        .arg(&flight)
        .output()
        .expect("the command");
    let notes = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{notes}");
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect(name);
    assert_eq!(read("window.csv"), read("command.csv"));
    assert!(read("window.csv").contains(",survey,"));
}

/// The flight that came of the plan, a metre too far east, without its second photo.
fn flown(folder: &Path, plan: &Path) {
    let text = fs::read_to_string(plan).expect("a plan");
    let told: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let mut poses = "photo,x,y,z,tilt,pan\n".to_owned();
    let photos = told["photos"].as_array().expect("photos");
    for (number, photo) in photos.iter().enumerate().filter(|(number, _)| *number != 1) {
        let number_of = |value: &serde_json::Value| value.as_f64().expect("a number");
        let [x, y, z] = [0, 1, 2].map(|i| number_of(&photo["center"][i]));
        let (tilt, pan) = (number_of(&photo["tilt"]), number_of(&photo["pan"]));
        poses += &format!("DJI_{number:04}.JPG,{},{y},{z},{tilt},{pan}\n", x + 1.0);
    }
    fs::write(folder.join("poses.csv"), poses).expect("poses");
}

/// A mission that is dropped on its flight is compared with it, as the command does; the table is the command's.
#[test]
fn a_mission_is_compared_with_the_flight_on_the_screen() {
    let folder = tempfile::tempdir().expect("a folder");
    let flight = pile(folder.path());
    let path = |name: &str| folder.path().join(name);
    let run = |arguments: &[&str]| {
        let output = Program::new(env!("CARGO_BIN_EXE_fragscale"))
            .current_dir(folder.path())
            .args(arguments)
            .output()
            .expect("the command");
        let notes = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{notes}");
    };
    run(&[
        "plan",
        "flight.toml",
        "--scale",
        "0.3 px/cm",
        "--take-off",
        "450030,5400040",
        "--mission",
        "m.plan",
        "--format",
        "json",
        "-o",
        "plan.json",
    ]);
    flown(folder.path(), &path("plan.json"));
    run(&[
        "flown",
        "flight.toml",
        "--mission",
        "m.plan",
        "--format",
        "csv",
        "-o",
        "command.csv",
    ]);
    let mut desk = Desk::new(Some(&flight));
    drop_on(&mut desk, &[&path("m.plan")]);
    assert_eq!(desk.harness.state().state().page, Page::Plan);
    let compared = desk.open().planning.flown.clone().expect("a comparison");
    let residuals = &compared.compared.flown.residuals;
    assert_eq!(
        residuals
            .iter()
            .filter(|residual| residual.is_none())
            .count(),
        1
    );
    for residual in residuals.iter().flatten() {
        assert!((residual.offset.x - 1.0).abs() < 0.02, "{residual:?}");
    }
    assert!(desk.says("not taken") && desk.says("1 planned photos were not taken (P002)"));
    desk.click(Role::Button, "Save comparison…");
    desk.type_path(&path("window.csv"));
    desk.click(Role::Button, "Write comparison");
    let read = |name: &str| fs::read_to_string(path(name)).expect(name);
    assert_eq!(read("window.csv"), read("command.csv"));
    for (name, begins) in [("flown.svg", "<svg"), ("flown.html", "<!DOCTYPE html>")] {
        desk.click(Role::Button, "Save comparison…");
        desk.type_path(&path(name));
        desk.click(Role::Button, "Write comparison");
        assert!(read(name).contains(begins), "{name}");
    }
    desk.click(Role::Button, "Close");
    assert!(desk.open().planning.flown.is_none() && count(&desk) > 0);
    // What is no mission is said, and by its path, too.
    fs::write(path("broken.plan"), "{\"fileType\": \"Plan\"}").expect("a file");
    drop_on(&mut desk, &[&path("broken.plan")]);
    assert!(desk.logged("broken.plan"));
    assert!(desk.open().planning.flown.is_none());
    desk.fill("Mission's file", path("m.plan").to_str().expect("a path"));
    assert!(desk.open().planning.flown.is_some());
    // The mission says its own take-off: nobody gave that of the plan on the screen for it.
    desk.click(Role::Button, "Close");
    desk.fill("Take-off", "450050,5400040");
    let now = desk.open().planning.now().expect("asked");
    assert_eq!(now.take_off, Some(DVec2::new(450_050.0, 5_400_040.0)));
    drop_on(&mut desk, &[&path("m.plan")]);
    let again = desk.open().planning.flown.clone().expect("a comparison");
    assert_eq!(again.compared, compared.compared);
}
