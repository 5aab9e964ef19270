//! The flight's health: what it says of flights that are known to be ill, and that each remedy is one click
//! away.

use std::time::{Duration, Instant};

use egui::Key;
use egui::Modifiers;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};
use fragscale::app::command::{Asking, Command};
use fragscale::app::tasks::work::Task;
use fragscale::formats::read_cloud;
use fragscale::jobs::Progress;
use fragscale::opening::{Health, HealthFinding, HealthItem, Remedy};
use fragscale::split_mix::SplitMix;
use fragscale::surface::UpAxis;
use fragscale::units::LengthUnit;

use crate::desk::{Desk, Written, copy, copy_files, flight};
use crate::{own_frame, wrong_pile};

fn finding(desk: &Desk, item: HealthItem) -> &HealthFinding {
    let mut health = desk.open().health.iter();
    health
        .find(|finding| finding.item == item)
        .expect("each is there")
}

fn how(desk: &Desk, item: HealthItem) -> (Health, Option<Remedy>) {
    let finding = finding(desk, item);
    (finding.health, finding.remedy)
}

/// The sample is whole but for the one photo over a hole.
#[test]
fn the_sample_is_well_but_for_its_hole() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let all: Vec<HealthItem> = desk
        .open()
        .health
        .iter()
        .map(|finding| finding.item)
        .collect();
    assert_eq!(
        all,
        [
            HealthItem::Unit,
            HealthItem::CoordinateSystem,
            HealthItem::UpAxis,
            HealthItem::Colours,
            HealthItem::Distance,
            HealthItem::Exif,
            HealthItem::Holes,
            HealthItem::Photos,
        ]
    );
    for good in [
        HealthItem::Unit,
        HealthItem::UpAxis,
        HealthItem::Colours,
        HealthItem::Distance,
        HealthItem::Exif,
        HealthItem::Photos,
    ] {
        assert_eq!(
            how(&desk, good),
            (Health::Good, None),
            "{:?}",
            finding(&desk, good)
        );
    }
    // A lab has no coordinate system; its scales need none.
    assert_eq!(
        how(&desk, HealthItem::CoordinateSystem),
        (Health::Unknown, None)
    );
    assert_eq!(
        how(&desk, HealthItem::Holes),
        (Health::Bad, Some(Remedy::AddSurface))
    );
    assert_eq!(finding(&desk, HealthItem::Holes).short, "1 of 9 photos");
    assert_eq!(finding(&desk, HealthItem::Photos).short, "9 of 9");
    desk.click(Role::Button, "Holes: Add surface…");
    assert_eq!(desk.harness.state().state().asking, Some(Asking::Add));
    desk.press(Modifiers::NONE, Key::Escape);
    let label = format!("Unit: {}", finding(&desk, HealthItem::Unit).says);
    assert!(desk.shows(Role::Status, &label));
    desk.press(Modifiers::NONE, Key::F4);
    assert!(!desk.shows(Role::Status, &label), "it is put away");
}

/// Until the colours of all photos are compared, nothing is said of them that reads as final, and none is trusted for good.
#[test]
fn colours_that_are_being_compared_are_pending() {
    let mut desk = Desk::new(None);
    let open = Command::Open(flight("assets/sample"));
    desk.harness.state_mut().apply(open);
    let start = Instant::now();
    let mut was_pending = false;
    // In the tool bar and in the table.
    let is_trusted = |w: &Written| w.text.starts_with('✔') && w.text.ends_with("trust");
    loop {
        desk.harness.step();
        let state = desk.harness.state().state();
        if state.open.is_some() && state.is_idle() {
            break;
        }
        assert!(
            start.elapsed() < Duration::from_secs(120),
            "a job does not end"
        );
        let all = desk.harness.query_all_by_role(Role::Status);
        let mut all = all.filter_map(|node| node.accesskit_node().label());
        let said = all.find(|said| said.starts_with("Colours: "));
        if let Some(said) = said.filter(|_| state.work.is_running(Task::THUMBNAILS)) {
            was_pending |= said.contains("are still being compared");
            assert!(!said.contains("so far"), "{said}");
            assert!(!desk.written().iter().any(is_trusted));
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(was_pending);
    desk.settle();
    assert!(desk.written().iter().any(is_trusted));
    assert_eq!(finding(&desk, HealthItem::Colours).short, "same");
    let label = format!("Colours: {}", finding(&desk, HealthItem::Colours).says);
    assert!(desk.shows(Role::Status, &label));
}

#[test]
fn without_photos_they_are_added() {
    let folder = copy("assets/sample");
    let toml = folder.path().join("flight.toml");
    let text = std::fs::read_to_string(&toml).expect("the flight");
    std::fs::write(&toml, text.replace("folder = \"photos\"", "")).expect("written");
    let mut desk = Desk::new(Some(folder.path()));
    assert_eq!(
        how(&desk, HealthItem::Photos),
        (Health::Bad, Some(Remedy::AddPhotos))
    );
    assert_eq!(finding(&desk, HealthItem::Photos).short, "0 of 9");
    assert_eq!(
        how(&desk, HealthItem::Exif),
        (Health::Unknown, Some(Remedy::AddPhotos))
    );
    assert_eq!(how(&desk, HealthItem::Colours), (Health::Unknown, None));
    desk.click(Role::Button, "Photo files: Add photos…");
    assert_eq!(desk.harness.state().state().asking, Some(Asking::Add));
}

#[test]
fn a_frame_of_its_own_is_georeferenced() {
    let folder = tempfile::tempdir().expect("a folder");
    own_frame::model(folder.path());
    let mut desk = Desk::new(Some(folder.path()));
    for item in [HealthItem::Unit, HealthItem::CoordinateSystem] {
        assert_eq!(how(&desk, item), (Health::Bad, Some(Remedy::Georeference)));
    }
    assert_eq!(finding(&desk, HealthItem::Unit).short, "unknown");
    assert_eq!(
        finding(&desk, HealthItem::CoordinateSystem).short,
        "own frame"
    );
    desk.click(Role::Button, "Unit: Georeference…");
    assert_eq!(
        desk.harness.state().state().asking,
        Some(Asking::Georeference)
    );
}

#[test]
fn a_pile_that_is_upside_down_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    wrong_pile::under_surface(folder.path());
    let desk = Desk::new(Some(folder.path()));
    let up = finding(&desk, HealthItem::UpAxis);
    assert_eq!((up.health, up.short.as_str()), (Health::Bad, "?"));
    assert!(
        up.says.contains("taken from under the surface"),
        "{}",
        up.says
    );
}

/// Points that lie 3 cm (a normal error, 2 % of the distance) above and below where they should.
#[test]
fn a_noisy_cloud_is_said() {
    let folder = copy("assets/sample");
    copy_files("assets/sample/photos", &folder.path().join("photos"));
    let cloud = read_cloud(&folder.path().join("pile.ply"), &Progress::default()).expect("a cloud");
    let mut random = SplitMix(4);
    let mut text = String::new();
    for point in &cloud.cloud.points {
        // Of twelve shares the sum has a variance of one.
        let normal: f64 = (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
        text += &format!("{} {} {}\n", point.x, point.y, point.z + 0.03 * normal);
    }
    std::fs::write(folder.path().join("noisy.xyz"), text).expect("written");
    let file = folder.path().join("flight.toml");
    let toml = std::fs::read_to_string(&file).expect("the flight");
    std::fs::write(&file, toml.replace("pile.ply", "noisy.xyz")).expect("written");
    let desk = Desk::new(Some(&file));
    let points = finding(&desk, HealthItem::Points);
    assert_eq!(points.health, Health::Bad);
    assert_eq!(points.short, "9 of 9 photos");
    assert_eq!(points.remedy, Some(Remedy::AddSurface));
    assert!(
        points.says.contains("points of one place lie"),
        "{}",
        points.says
    );
}

/// One click turns the surface; it can be undone, and is saved.
#[test]
fn another_axis_is_taken_for_up() {
    let folder = tempfile::tempdir().expect("a folder");
    wrong_pile::y_up(folder.path());
    let mut desk = Desk::new(Some(folder.path()));
    let remedy = Some(Remedy::TurnUp(UpAxis::Y));
    assert_eq!(how(&desk, HealthItem::UpAxis), (Health::Bad, remedy));
    desk.click(Role::Button, "Up axis: Use y as up");
    desk.settle();
    assert_eq!(how(&desk, HealthItem::UpAxis), (Health::Good, None));
    let photo = desk.open().review.photo(0).expect("a photo");
    let top = photo.edges(LengthUnit::Metre).top.expect("a scale");
    assert!((top / 32.0 - 1.0).abs() < 0.05, "{top}");
    desk.press(Modifiers::COMMAND, Key::S);
    desk.settle();
    let text = std::fs::read_to_string(folder.path().join("flight.toml")).expect("saved");
    assert!(text.contains("surface.up = \"y\""), "{text}");
    desk.press(Modifiers::COMMAND, Key::Z);
    desk.settle();
    assert_eq!(how(&desk, HealthItem::UpAxis), (Health::Bad, remedy));
}

/// A unit that is not that of the coordinate system is said at the top of the window, not in the log alone.
#[test]
fn a_unit_against_the_coordinate_system_is_no_good_one() {
    let folder = copy("tests/windrow");
    let toml = folder.path().join("flight.toml");
    let text = std::fs::read_to_string(&toml).expect("the flight");
    for (unit, wanted) in [
        ("m", (Health::Good, "m")),
        ("in", (Health::Bad, "in, not m")),
    ] {
        let stated = format!("unit = \"{unit}\"\ncrs = \"EPSG:32632\"");
        let text = text.replacen("unit = \"m\"", &stated, 1);
        std::fs::write(&toml, text).expect("written");
        let desk = Desk::new(Some(folder.path()));
        let found = finding(&desk, HealthItem::Unit);
        assert_eq!((found.health, found.short.as_str()), wanted, "{unit}");
    }
}
