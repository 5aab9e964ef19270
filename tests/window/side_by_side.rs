//! What two hands do at once: a field that is typed into and the click or key that leaves it, photos that are walked through while
//! their files are read, files that others change while their flight is open.

use std::fs;

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use fragscale::app::Command;
use fragscale::app::control_points::ControlStep;
use fragscale::app::fragments::{FragmentStep, PhotoOutlines};
use fragscale::app::map::MapCommand;
use fragscale::exports::PlanGround;
use fragscale::scale::{Ground, ImageKind};
use glam::{DVec2, DVec3};

use crate::desk::{Desk, copy, copy_files};

/// A copy of the bundled flight, with its photos.
fn sample() -> tempfile::TempDir {
    let folder = copy("assets/sample");
    copy_files("assets/sample/photos", &folder.path().join("photos"));
    folder
}

/// Types into a field, and stays in it.
fn type_into(desk: &mut Desk, field: &str, text: &str) {
    desk.node(Role::TextInput, field).click();
    desk.harness.run();
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.harness.key_press(Key::Backspace);
    desk.harness.event(Event::Text(text.to_owned()));
    desk.harness.run();
}

fn apply(desk: &mut Desk, command: Command) {
    desk.harness.state_mut().apply(command);
    desk.settle();
}

/// What is typed counts before the click that leaves the field, and neither undoes the other; Ctrl+S in a field saves what
/// stands in it.
#[test]
fn what_is_typed_and_what_is_clicked_both_count() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let mut desk = Desk::new(Some(&file));
    desk.click(Role::Tab, "Flight");
    desk.click(Role::RadioButton, "Elevation");
    type_into(&mut desk, "Ground elevation", "0.123");
    desk.click(Role::RadioButton, "the photo as shot");
    let now = desk.open().settings();
    assert_eq!(
        (now.ground, now.image),
        (Ground::At(0.123), ImageKind::AsShot)
    );
    type_into(&mut desk, "Ground elevation", "0.25");
    desk.press(Modifiers::COMMAND, Key::S);
    let text = fs::read_to_string(&file).expect("a flight");
    assert!(text.contains("ground = 0.25"), "{text}");
    assert!(!desk.open().is_changed());
    // What is typed on is for the field.
    assert!(desk.harness.ctx.text_edit_focused());
    type_into(&mut desk, "Ground elevation", "0.5");
    desk.click(Role::Button, "Save flight");
    let text = fs::read_to_string(&file).expect("a flight");
    assert!(text.contains("ground = 0.5"), "{text}");
}

/// A place that is typed goes to its own point, though the point above it is taken away by the click that leaves the field.
#[test]
fn a_typed_place_stays_with_its_point() {
    let folder = sample();
    let mut desk = Desk::new(Some(&folder.path().join("flight.toml")));
    desk.press(Modifiers::NONE, Key::G);
    for _ in 0..3 {
        apply(&mut desk, Command::Control(ControlStep::Add));
    }
    type_into(&mut desk, "Surveyed place of P2", "100 200 300");
    desk.click(Role::Button, "Remove control point P1");
    let points = &desk.open().control_list().points;
    let found: Vec<_> = points
        .iter()
        .map(|point| (point.name.as_str(), point.position))
        .collect();
    let place = DVec3::new(100.0, 200.0, 300.0);
    assert_eq!(found, [("P2", Some(place)), ("P3", None)]);
    // Called otherwise and left by Tab, what is typed next is its place, and no tool or view.
    let sample = |desk: &Desk| desk.open().looking;
    let before = sample(&desk);
    type_into(&mut desk, "Name of control point 2", "GCP8");
    desk.press(Modifiers::NONE, Key::Tab);
    desk.harness.event(Event::Text("1 2 3".to_owned()));
    desk.harness.run();
    desk.press(Modifiers::NONE, Key::Enter);
    let point = &desk.open().control_list().points[1];
    assert_eq!(
        (point.name.as_str(), point.position),
        ("GCP8", Some(DVec3::new(1.0, 2.0, 3.0)))
    );
    assert_eq!(sample(&desk), before);
}

/// A typed area is in what Ctrl+S saves.
#[test]
fn a_typed_area_is_saved() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let mut desk = Desk::new(Some(&file));
    desk.press(Modifiers::COMMAND, Key::Num3);
    type_into(&mut desk, "Corners of the area", "0,0;0.5,0;0.5,0.4;0,0.4");
    desk.press(Modifiers::COMMAND, Key::S);
    let text = fs::read_to_string(&file).expect("a flight");
    assert!(text.contains("[plan]") && text.contains("0.4"), "{text}");
    assert!(!desk.open().is_changed());
}

fn outlined(desk: &Desk, photo: usize) -> Option<&PhotoOutlines> {
    desk.open().fragments.of(photo)
}

/// The selected photo with its right half as one fragment, drawn by four clicks.
fn draw(desk: &mut Desk) {
    use fragscale::app::fragments::FragmentTool;
    let step = |desk: &mut Desk, step: FragmentStep| apply(desk, Command::Fragments(step));
    step(desk, FragmentStep::Tool(FragmentTool::Outline));
    for (x, y) in [
        (300.0, 100.0),
        (600.0, 100.0),
        (600.0, 400.0),
        (300.0, 400.0),
    ] {
        step(desk, FragmentStep::Click(DVec2::new(x, y)));
    }
    step(desk, FragmentStep::Finish);
}

/// Outlines that files have are read again where walking on stopped their reading; read again with its photos in another order,
/// a flight has them at the photos of their names, and says which are gone.
#[test]
fn outlines_stay_with_their_photos() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let mut desk = Desk::new(Some(&file));
    desk.press(Modifiers::COMMAND, Key::Num4);
    desk.click(Role::Button, "Outline this photo");
    desk.press(Modifiers::NONE, Key::ArrowDown);
    desk.click(Role::Button, "Outline this photo");
    desk.press(Modifiers::COMMAND, Key::S);
    assert!(folder.path().join("fragments/IMG_0002.png").is_file());
    // Read again on this page they are there at once.
    desk.press(Modifiers::NONE, Key::F5);
    let selected = desk.open().selected.expect("a photo");
    assert!(outlined(&desk, selected).is_some(), "read again");

    let mut desk = Desk::new(Some(&file));
    desk.press(Modifiers::COMMAND, Key::Num4);
    for key in [
        Key::ArrowDown,
        Key::ArrowDown,
        Key::ArrowUp,
        Key::ArrowUp,
        Key::ArrowDown,
    ] {
        // Not waited for.
        desk.harness.key_press(key);
        desk.harness.step();
    }
    desk.settle();
    assert_eq!(desk.selected(), "IMG_0002.jpg");
    assert!(outlined(&desk, 1).is_some(), "read");
    desk.press(Modifiers::NONE, Key::ArrowUp);
    assert!(outlined(&desk, 0).is_some(), "read");

    // Corrected and not saved; then another program writes the poses the other way round.
    draw(&mut desk);
    let [first, second] =
        [0, 1].map(|photo| outlined(&desk, photo).expect("outlines").now().clone());
    assert!(outlined(&desk, 0).is_some_and(PhotoOutlines::is_changed));
    let poses = folder.path().join("poses.csv");
    let text = fs::read_to_string(&poses).expect("poses");
    let mut lines: Vec<&str> = text.lines().collect();
    lines[1..].reverse();
    fs::write(&poses, lines.join("\n") + "\n").expect("written");
    let mut settings = desk.open().settings();
    settings.surface.thinning = Some(0.01);
    apply(&mut desk, Command::Set(settings));
    assert_eq!(desk.open().name(8), "IMG_0001.jpg");
    assert_eq!(desk.selected(), "IMG_0001.jpg");
    assert_eq!(*outlined(&desk, 8).expect("outlines").now(), first);
    assert_eq!(*outlined(&desk, 7).expect("outlines").now(), second);
    assert!(outlined(&desk, 0).is_none());

    // And without that photo.
    let without: Vec<&str> = lines
        .iter()
        .copied()
        .filter(|line| !line.starts_with("IMG_0001"))
        .collect();
    fs::write(&poses, without.join("\n") + "\n").expect("written");
    let mut settings = desk.open().settings();
    settings.surface.thinning = Some(0.02);
    apply(&mut desk, Command::Set(settings));
    assert_eq!(desk.open().review.count(), 8);
    assert!(desk.logged("photo 'IMG_0001.jpg' is not in the flight any more"));
    assert_eq!(*outlined(&desk, 7).expect("outlines").now(), second);
}

/// Long triangles left out make it another surface: what was measured over the one of before is measured anew.
#[test]
fn over_another_surface_all_is_measured_anew() {
    let folder = sample();
    let mut desk = Desk::new(Some(&folder.path().join("flight.toml")));
    desk.press(Modifiers::COMMAND, Key::Num4);
    desk.click(Role::Button, "Outline this photo");
    let whole = |desk: &Desk| {
        let measured = outlined(desk, 0).and_then(PhotoOutlines::measured);
        measured
            .and_then(|of| of.by_mass.as_ref().ok())
            .map(|of| of.whole)
    };
    let before = whole(&desk).expect("measured");
    let mut settings = desk.open().settings();
    settings.surface.max_edge = Some(0.012);
    apply(&mut desk, Command::Set(settings));
    let after = whole(&desk).expect("measured");
    assert!(after < before, "{after} of {before}");
}

/// The lengths of a plan that stands in the file are converted, whether its page was looked at or not.
#[test]
fn a_saved_plan_keeps_its_lengths_in_another_unit() {
    for is_seen in [false, true] {
        let folder = sample();
        let file = folder.path().join("flight.toml");
        let text = fs::read_to_string(&file).expect("a flight");
        fs::write(
            &file,
            text + "\n[plan]\npattern = \"slope\"\ndistance = 2.0\nclearance = 1.0\n",
        )
        .expect("written");
        let mut desk = Desk::new(Some(&file));
        if is_seen {
            desk.press(Modifiers::COMMAND, Key::Num3);
            desk.press(Modifiers::COMMAND, Key::Num1);
        }
        let mut settings = desk.open().settings();
        settings.unit = fragscale::units::LengthUnit::Foot;
        apply(&mut desk, Command::Set(settings));
        desk.press(Modifiers::COMMAND, Key::S);
        let text = fs::read_to_string(&file).expect("a flight");
        let value = |key: &str| -> f64 {
            let line = text
                .lines()
                .find_map(|line| line.strip_prefix(&format!("{key} = ")));
            line.expect(key).parse().expect("a number")
        };
        // The coordinates count in feet now: the same numbers of the world are as many feet.
        assert!(
            (value("distance") - 2.0 / 0.3048).abs() < 1e-9,
            "{is_seen}: {text}"
        );
        assert!(
            (value("clearance") - 1.0 / 0.3048).abs() < 1e-9,
            "{is_seen}: {text}"
        );
    }
}

/// Read again, a flight keeps the surface that was added to it, whatever its own file names.
#[test]
fn read_again_with_what_was_added() {
    let folder = sample();
    let own = folder.path().join("pile.ply");
    let added = folder.path().join("other.ply");
    fs::copy(&own, &added).expect("a copy");
    let file = folder.path().join("flight.toml");
    let mut desk = Desk::new(Some(&file));
    apply(&mut desk, Command::Add(added.clone()));
    assert_eq!(desk.open().files.origin.surface(), Some(added.as_path()));
    desk.press(Modifiers::NONE, Key::F5);
    assert!(desk.harness.state().state().held_back.is_none());
    assert_eq!(desk.open().files.origin.surface(), Some(added.as_path()));
}

/// Read again, a flight is looked at as before: the photo of that name is selected, wherever it stands by now; the layers,
/// the filter and the map's ground stay, and what was picked is not asked for.
#[test]
fn read_again_it_is_looked_at_as_before() {
    let folder = sample();
    let layer = folder.path().join("before.ply");
    fs::copy(folder.path().join("pile.ply"), &layer).expect("a copy");
    let mut desk = Desk::new(Some(&folder.path().join("flight.toml")));
    desk.click(Role::Row, "Photo IMG_0002.jpg");
    apply(&mut desk, Command::AddLayer(layer.clone()));
    apply(&mut desk, Command::Filter("IMG".to_owned()));
    let ground = MapCommand::Ground(PlanGround::Photos);
    apply(&mut desk, Command::Map(ground));
    desk.press(Modifiers::NONE, Key::T);
    let looking = desk.open().looking;
    let poses = folder.path().join("poses.csv");
    let text = fs::read_to_string(&poses).expect("poses");
    let mut lines: Vec<&str> = text.lines().collect();
    lines[1..].reverse();
    fs::write(&poses, lines.join("\n") + "\n").expect("written");
    let number = desk.open().number;
    desk.press(Modifiers::NONE, Key::F5);
    assert!(desk.harness.state().state().held_back.is_none());
    assert_ne!(desk.open().number, number, "it was read");
    assert_eq!(desk.open().name(7), "IMG_0002.jpg");
    assert_eq!(desk.open().selected, Some(7));
    let layers: Vec<_> = desk
        .open()
        .beside
        .iter()
        .map(|of| of.path.clone())
        .collect();
    assert_eq!(layers, std::slice::from_ref(&layer));
    // It is read: nothing is written over it.
    assert!(desk.open().files.read.named(&layer).is_some());
    assert_eq!(desk.open().table.order.text, "IMG");
    assert_eq!(desk.open().map.ground, PlanGround::Photos);
    assert_eq!(desk.open().looking, looking);
    // That photo is gone.
    let without = lines.iter().filter(|line| !line.starts_with("IMG_0002"));
    let without: Vec<&str> = without.copied().collect();
    fs::write(&poses, without.join("\n") + "\n").expect("written");
    desk.press(Modifiers::NONE, Key::F5);
    assert_eq!(desk.open().selected, Some(0));
    assert_eq!(desk.open().beside.len(), 1);
}

/// While another flight is being read nothing of this one is changed: it would be gone with it, unasked.
#[test]
fn nothing_is_changed_while_another_flight_is_read() {
    let folder = sample();
    let other = sample();
    let mut desk = Desk::new(Some(&folder.path().join("flight.toml")));
    desk.press(Modifiers::COMMAND, Key::Num3);
    let asked = desk.open().planning.now().expect("asked").clone();
    let app = desk.harness.state_mut();
    app.apply(Command::Open(other.path().to_owned()));
    let mut another = asked.clone();
    another.clearance *= 2.0;
    app.apply(Command::Plan(fragscale::app::planning::PlanStep::Ask(
        Box::new(another),
    )));
    app.apply(Command::Fragments(FragmentStep::Delete));
    let state = app.state();
    // A file on a busy disk may be there already: then there was nothing to lose.
    let before = state.open.as_ref().expect("a flight");
    assert_eq!(before.planning.now(), Some(&asked));
    desk.settle();
    assert!(desk.logged("a flight is being opened; change this one when it is there"));
    assert!(desk.open().files.path.starts_with(other.path()));
}

/// Over another surface a plan is made anew, and a volume that was drawn is measured on it; a stroke of Ctrl+W in a field closes
/// nothing.
#[test]
fn another_surface_keeps_what_is_asked_and_not_what_was_made() {
    let folder = sample();
    let mut desk = Desk::new(Some(&folder.path().join("flight.toml")));
    desk.press(Modifiers::COMMAND, Key::Num3);
    desk.settle();
    let surface = |desk: &Desk| {
        desk.open()
            .planning
            .made
            .as_ref()
            .map(|made| made.plan.photos.len())
    };
    let before = surface(&desk).expect("a plan");
    let asked = desk.open().planning.now().cloned();
    let mut settings = desk.open().settings();
    settings.surface.max_edge = Some(0.012);
    apply(&mut desk, Command::Set(settings));
    assert_eq!(desk.open().planning.now().cloned(), asked);
    assert_ne!(surface(&desk), Some(before));
    desk.press(Modifiers::COMMAND, Key::Num1);
    desk.node(Role::TextInput, "Filter photos").click();
    desk.harness.run();
    desk.press(Modifiers::COMMAND, Key::W);
    assert!(desk.harness.state().state().open.is_some());
}

/// Who keeps the file that would be replaced does not leave once something is saved elsewhere.
#[test]
fn keeping_a_file_forgets_what_was_to_come_behind_saving() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let mut desk = Desk::new(Some(&file));
    let mut settings = desk.open().settings();
    settings.pair = fragscale::scale::ScalePair::Corners;
    apply(&mut desk, Command::Set(settings));
    let text = fs::read_to_string(&file).expect("a flight");
    fs::write(&file, text + "\n# changed by another program\n").expect("written");
    desk.press(Modifiers::COMMAND, Key::W);
    // Both clicks of a double click at the same place.
    desk.click(Role::Button, "Save them");
    assert!(
        desk.harness.state().state().held_back.is_some(),
        "it is asked first"
    );
    apply(&mut desk, Command::Keep);
    apply(
        &mut desk,
        Command::SaveAs(folder.path().join("other.toml").into()),
    );
    assert!(folder.path().join("other.toml").is_file());
    assert!(desk.harness.state().state().open.is_some(), "it stays open");
}
