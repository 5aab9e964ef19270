//! Control points are clicked in the photos of a model whose place in the world is known by construction.

use std::fs;
use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2, vec2};
use fragscale::app::Command;
use fragscale::app::control_points::{Applied, ControlStep};
use fragscale::control::ScaleBar;
use fragscale::units::LengthUnit;
use fragscale_test_data::shared_data;
use glam::{DMat3, DVec2, DVec3};
use tempfile::TempDir;

use crate::desk::{Desk, Screen, flight};
use crate::own_frame::{CENTERS, model};

/// In the model's frame.
const POINTS: [DVec3; 4] = [
    DVec3::new(0.5, 0.25, 10.0),
    DVec3::new(3.5, 0.5, 10.0),
    DVec3::new(3.25, 2.5, 10.0),
    DVec3::new(0.75, 2.25, 10.0),
];

/// Where they are in the world: 3 m to a unit, turned about x so that z is up.
fn surveyed(point: DVec3) -> DVec3 {
    DVec3::new(
        5e5 + 3.0 * point.x,
        5e6 - 3.0 * point.y,
        150.0 - 3.0 * point.z,
    )
}

/// Where a photo shows a point: 1000 px of focal length, looking along z.
fn shown(photo: usize, point: DVec3) -> DVec2 {
    let ray = point - DVec3::from(CENTERS[photo]);
    DVec2::new(400.0, 300.0) + ray.truncate() * (1000.0 / ray.z)
}

/// The model, with the tool taken.
fn desk() -> (TempDir, Desk) {
    let folder = tempfile::tempdir().expect("a folder");
    let package = folder.path().join("model");
    fs::create_dir(&package).expect("a folder");
    model(&package);
    let mut desk = Desk::new(Some(&package));
    desk.press(Modifiers::NONE, Key::G);
    assert!(desk.says("Control points"));
    (folder, desk)
}

/// Where a pixel of the selected photo is on the screen, one pixel a point.
fn on_screen(desk: &Desk, pixel: DVec2) -> Pos2 {
    let name = format!("Photo view {}", desk.selected());
    let frame = desk.node(Role::Image, &name).rect();
    let size = DVec2::new(f64::from(frame.width()), f64::from(frame.height()));
    let image = DVec2::new(800.0, 600.0);
    let placing = desk.open().photo_view.placing;
    let at = placing.corner(image, size) + pixel * placing.scale(image, size);
    frame.min + vec2(at.x as f32, at.y as f32)
}

fn select(desk: &mut Desk, photo: usize) {
    desk.harness.state_mut().apply(Command::Select(Some(photo)));
    desk.settle();
}

fn step(desk: &mut Desk, step: ControlStep) {
    desk.harness.state_mut().apply(Command::Control(step));
    desk.settle();
}

/// Clicks a point where this photo shows it.
fn click(desk: &mut Desk, photo: usize, point: DVec3) {
    select(desk, photo);
    let at = on_screen(desk, shown(photo, point));
    desk.click_at(at);
}

/// Adds the points as they were surveyed and clicks each in three photos.
fn mark_all(desk: &mut Desk) {
    for (number, point) in POINTS.into_iter().enumerate() {
        desk.click(Role::Button, "Add point");
        let DVec3 { x, y, z } = surveyed(point);
        desk.fill(
            &format!("Surveyed place of P{}", number + 1),
            &format!("{x}\t{y}\t{z}"),
        );
        for photo in 0..3 {
            click(desk, photo, point);
        }
    }
    desk.fill("System of the survey", "EPSG:32632");
}

#[track_caller]
fn assert_scales(desk: &Desk, expected: f64) {
    for photo in 0..5 {
        let scale = desk.open().scale(photo).expect("a scale").scale;
        for edge in [scale.top, scale.right, scale.bottom, scale.left] {
            let edge = edge.expect("an edge");
            assert!((edge / expected - 1.0).abs() < 1e-4, "{edge}");
        }
    }
}

#[test]
fn a_click_marks_and_the_other_photos_say_where() {
    let (_folder, mut desk) = desk();
    desk.click(Role::Button, "Add point");
    click(&mut desk, 0, POINTS[0]);
    let mark = |desk: &Desk, photo: &str| desk.open().control_list().points[0].mark_in(photo);
    let there = mark(&desk, "IMG_1.JPG").expect("a mark");
    assert!(there.distance(shown(0, POINTS[0])) < 0.01, "{there}");
    // One mark: a line in the next photo, through the true pixel.
    desk.press(Modifiers::NONE, Key::ArrowRight);
    assert_eq!(desk.selected(), "IMG_2.JPG");
    let found = &desk.open().control.found;
    assert!(found.predicted.is_none() && found.lines.len() == 1);
    let truth = shown(1, POINTS[0]);
    let off = found.lines[0].windows(2).map(|piece| {
        let along = piece[1] - piece[0];
        let share = (truth - piece[0]).dot(along) / along.length_squared();
        (piece[0] + along * share.clamp(0.0, 1.0)).distance(truth)
    });
    assert!(off.fold(f64::INFINITY, f64::min) < 0.02);
    click(&mut desk, 1, POINTS[0]);
    // Two: where it should be in the third, and which photos show it.
    let name = "P1 is seen in IMG_3.JPG";
    desk.click(Role::Button, name);
    assert_eq!(desk.selected(), "IMG_3.JPG");
    let found = &desk.open().control.found;
    let predicted = found.predicted.expect("a place");
    assert!(
        predicted.distance(shown(2, POINTS[0])) < 0.05,
        "{predicted}"
    );
    assert!(desk.says("2 marks, 0.0"));
    click(&mut desk, 2, POINTS[0]);
    assert!(desk.open().control.found.predicted.is_none());

    // Dragged by its rim it moves by what the mouse moves.
    let from = on_screen(&desk, shown(2, POINTS[0])) + vec2(4.0, 3.0);
    desk.harness.drag_at(from);
    desk.harness.step();
    desk.harness.hover_at(from + vec2(40.0, 25.0));
    desk.harness.step();
    desk.harness.drop_at(from + vec2(40.0, 25.0));
    desk.settle();
    let zoom = desk.open().photo_view.placing;
    assert_eq!(zoom.zoom, None, "the photo stays");
    let moved = mark(&desk, "IMG_3.JPG").expect("a mark");
    let by = moved - shown(2, POINTS[0]);
    assert!(
        (by.x / by.y - 40.0 / 25.0).abs() < 0.01 && by.x > 40.0,
        "{by}"
    );
    // It is another thing than the other marks are on, once there are enough to say so.
    click(&mut desk, 3, POINTS[0]);
    let suspect = desk.open().control.found.points[0]
        .as_ref()
        .expect("found")
        .suspect;
    assert_eq!(suspect, Some(2));
    desk.press(Modifiers::COMMAND, Key::Z);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(
        mark(&desk, "IMG_3.JPG")
            .expect("a mark")
            .distance(shown(2, POINTS[0]))
            < 0.01
    );

    // Delete takes it away in the photo that is looked at; undo brings it back.
    select(&mut desk, 2);
    desk.press(Modifiers::NONE, Key::Delete);
    assert_eq!(mark(&desk, "IMG_3.JPG"), None);
    assert!(mark(&desk, "IMG_1.JPG").is_some());
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(mark(&desk, "IMG_3.JPG").is_some());
    desk.click(Role::Button, "Remove the mark of P1 in IMG_2.JPG");
    assert_eq!(mark(&desk, "IMG_2.JPG"), None);
    // A click far from it marks nothing while no point is chosen.
    step(&mut desk, ControlStep::Choose(None));
    select(&mut desk, 1);
    let at = on_screen(&desk, DVec2::new(600.0, 200.0));
    desk.click_at(at);
    assert_eq!(mark(&desk, "IMG_2.JPG"), None);
}

#[test]
fn surveyed_points_bring_the_flight_to_the_world_and_back() {
    let (folder, mut desk) = desk();
    assert!(desk.says("Mark three surveyed points in two photos each (0 so far)"));
    mark_all(&mut desk);
    desk.click(Role::Button, "Apply control points");
    let open = desk.open();
    assert_eq!(open.files.crs.as_deref(), Some("EPSG:32632"));
    let center = open.flight().parts().photos[4].pose.center;
    let truth = surveyed(DVec3::from(CENTERS[4]));
    assert!(center.distance(truth) < 0.01, "{center}");
    assert!(open.flight().parts().unit_known && open.settings().errors.world_scale.is_some());
    // 1000 px at 30 m.
    assert_scales(&desk, 1000.0 / 30.0);
    assert!(desk.says("4 of 4 points used, RMS 0.00"));
    assert!(desk.says("m off"));
    let tests_of = desk.open().control.applied.as_ref();
    assert!(matches!(tests_of, Some(Applied::Placed(found, ..)) if found.used() == 4));
    // Residuals are those of the points that were applied.
    let changed = "have changed since they were applied";
    let before = desk.open().control_list().points[1].position;
    step(
        &mut desk,
        ControlStep::Survey(1, before.map(|at| at + DVec3::Z)),
    );
    assert!(desk.says(changed) && !desk.says("4 of 4 points used") && !desk.says("m off"));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(!desk.says(changed) && desk.says("4 of 4 points used"));

    // One step back: own frame, points still there; and forth.
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(desk.open().files.crs, None);
    assert!(!desk.open().flight().parts().unit_known);
    assert_eq!(desk.open().control_list().points.len(), 4);
    assert!(!desk.says("4 of 4 points used"));
    assert_scales(&desk, 1000.0 / 10.0);
    desk.press(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
    assert_eq!(desk.open().files.crs.as_deref(), Some("EPSG:32632"));

    // Nothing is written before she saves; then the flight opens in the world with its points.
    let target = folder.path().join("bench.toml");
    let list = folder.path().join("bench-control-points.txt");
    let files = || fs::read_dir(folder.path()).expect("a folder").count();
    assert_eq!(files(), 1);
    desk.press(Modifiers::COMMAND, Key::S);
    desk.type_path(&target);
    desk.press(Modifiers::NONE, Key::Enter);
    assert!(
        !desk.open().is_changed(),
        "{:?}",
        desk.harness.state().state().log.last()
    );
    assert!(target.is_file() && list.is_file());
    let marked = desk.open().control_list().clone();
    let again = Desk::new(Some(&target));
    assert_eq!(*again.open().control_list(), marked);
    assert_eq!(again.open().files.crs.as_deref(), Some("EPSG:32632"));
    assert!(!again.open().is_changed());
    assert_scales(&again, 1000.0 / 30.0);

    // The command reads that list, and brings the model to the same place.
    let text = |path: &Path| path.to_str().expect("UTF-8").to_owned();
    let said = crate::common::stdout_of(&[
        "georeference",
        &text(&folder.path().join("model")),
        "--gcp",
        &text(&list),
        "--format",
        "json",
    ]);
    let said: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    // And how sure it says that is.
    let interval = said["scale_interval_95"].as_f64().expect("a number");
    let world = again.open().settings().errors.world_scale.expect("stated");
    let stated = 100.0 * interval / 1.959_964;
    assert!((world - stated).abs() <= 1e-3 * stated, "{world} {stated}");
    let ours = again.open().settings().placed.expect("placed").transform;
    for (ours, theirs) in ours.iter().zip(said["transform"].as_array().expect("16")) {
        let theirs = theirs.as_f64().expect("a number");
        assert!(
            (ours - theirs).abs() <= 1e-9 * ours.abs().max(1.0),
            "{ours} {theirs}"
        );
    }
}

/// A package that does not say how sure its poses are: what its photos see does, as for the command, whose axes are the model's,
/// too, and whose unit is another.
#[test]
fn a_placed_model_says_how_sure_its_poses_are() {
    let Some(colmap) = shared_data("sceaux-colmap/bin") else {
        return;
    };
    let mut desk = Desk::new(Some(&colmap));
    desk.press(Modifiers::NONE, Key::G);
    let flight = desk.open().flight().clone();
    let shown = |photo: usize, point: DVec3| {
        let posed = &flight.parts().photos[photo];
        let camera = flight.camera(posed);
        let pixel = camera.pixel_as_shot(posed.pose.camera_from_world(point))?;
        camera.contains(pixel).then_some(pixel)
    };
    let vertices = flight.parts().surface.vertices();
    let seen = vertices.filter_map(|point| Some([shown(0, point)?, shown(3, point)?]));
    let seen: Vec<[DVec2; 2]> = seen.collect();
    for (point, marks) in [seen[0], seen[seen.len() / 2]].into_iter().enumerate() {
        step(&mut desk, ControlStep::Add);
        for (photo, pixel) in [0, 3].into_iter().zip(marks) {
            let pixel = Some(pixel);
            step(
                &mut desk,
                ControlStep::Mark {
                    point,
                    photo,
                    pixel,
                },
            );
        }
    }
    step(&mut desk, ControlStep::AddBar);
    desk.fill("Length of scale bar 1", "7,5");
    desk.click(Role::Button, "Apply control points");
    let settings = desk.open().settings();
    let scale = settings
        .placed
        .expect("placed")
        .similarity()
        .expect("one")
        .scale;
    assert!(desk.says("m along x, y, z to the pile"));
    let said = crate::common::stdout_of(&[
        "georeference",
        colmap.to_str().expect("UTF-8"),
        "--distance",
        "0,0,0 1,0,0 2.5",
        "--format",
        "json",
    ]);
    let said: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let axes = |key: &str| DVec3::from([0, 1, 2].map(|axis| number(&said[key][axis])));
    let errors = settings.errors;
    for (ours, theirs) in [
        (
            errors.pose.position.expect("stated") / scale,
            axes("position_standard_error") / 2.5,
        ),
        (
            errors.pose.angle.expect("stated"),
            axes("angle_standard_error_degrees"),
        ),
        (
            DVec3::splat(errors.focal.expect("stated")),
            DVec3::splat(number(&said["focal_standard_error_percent"])),
        ),
    ] {
        assert!(
            (ours / theirs - 1.0).abs().max_element() < 1e-3,
            "{ours} {theirs}"
        );
    }
    // One bar that nothing checks but how well its ends are marked.
    assert!(errors.world_scale.is_some_and(|percent| percent > 0.0));
}

/// A flight that has a place takes a bar's length and stays there; a bar that tells it less surely than the flight does is refused.
#[test]
fn a_scale_bar_lengthens_a_flight_where_it_stands() {
    let (_folder, mut desk) = desk();
    mark_all(&mut desk);
    desk.click(Role::Button, "Apply control points");
    assert_eq!(desk.open().files.crs.as_deref(), Some("EPSG:32632"));
    for point in 0..POINTS.len() {
        step(&mut desk, ControlStep::Survey(point, None));
    }
    step(&mut desk, ControlStep::AddBar);
    let bar = ScaleBar {
        ends: ["P1".to_owned(), "P2".to_owned()],
        // In a world of three times the model, 1 % longer than it was.
        length: POINTS[0].distance(POINTS[1]) * 3.0 * 1.01,
        unit: LengthUnit::Metre,
    };
    step(&mut desk, ControlStep::Bar(0, bar));
    desk.click(Role::Button, "Apply control points");
    assert!(desk.says("and these scale bars tell it to ±"));
    assert_scales(&desk, 1000.0 / 30.0);

    let middle = |desk: &Desk| {
        let photos = desk.open().flight().parts().photos.iter();
        photos.map(|photo| photo.pose.center).sum::<DVec3>() / 5.0
    };
    let before = middle(&desk);
    let mut settings = desk.open().settings();
    settings.errors.world_scale = Some(2.0);
    desk.harness.state_mut().apply(Command::Set(settings));
    desk.settle();
    desk.click(Role::Button, "Apply control points");
    assert_scales(&desk, 1000.0 / 30.0 / 1.01);
    assert_eq!(desk.open().files.crs.as_deref(), Some("EPSG:32632"));
    assert!(middle(&desk).distance(before) < 1e-6);
    let stated = desk.open().settings().errors.world_scale.expect("stated");
    assert!(stated < 1.0, "{stated}");
    assert!(desk.says("1.0 % longer; it stays where it is"));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_scales(&desk, 1000.0 / 30.0);
}

#[test]
fn scale_bars_alone_give_the_unit() {
    let (_folder, mut desk) = desk();
    for point in &POINTS[..2] {
        desk.click(Role::Button, "Add point");
        click(&mut desk, 0, *point);
        click(&mut desk, 1, *point);
    }
    desk.click(Role::Button, "Add scale bar");
    assert!(desk.says("of the reconstruction's units"));
    // Nobody has said yet how long it is.
    assert!(desk.says("Type how long the scale bar is in truth."));
    desk.fill("Length of scale bar 1", "2,5");
    assert_eq!(desk.open().control_list().bars[0].length, 2.5);
    assert!(!desk.says("Type how long the scale bar is in truth."));
    let feet = POINTS[0].distance(POINTS[1]) * 3.0 / LengthUnit::Foot.metres();
    step(
        &mut desk,
        ControlStep::Bar(
            0,
            ScaleBar {
                ends: ["P1".to_owned(), "P2".to_owned()],
                length: feet,
                unit: LengthUnit::Foot,
            },
        ),
    );
    desk.fill("Name of control point 1", "staff foot");
    assert_eq!(desk.open().control_list().bars[0].ends[0], "staff foot");
    desk.click(Role::Button, "Apply control points");
    assert_eq!(desk.open().files.crs, None);
    let parts = desk.open().flight().parts();
    assert!(parts.unit_known && parts.unit == LengthUnit::Metre);
    assert_scales(&desk, 1000.0 / 30.0);
    assert!(desk.says("by its marks alone: nothing checks the distance"));
    assert!(desk.says("% off"));
    // A pixel at each mark: of two photos that look along z, f / z pixels a unit across, f x / z² along the view.
    let covariance = |point: DVec3| {
        let normal = [0, 1].into_iter().fold(DMat3::ZERO, |sum, photo| {
            let ray = point - DVec3::from(CENTERS[photo]);
            let scale = 1000.0 / ray.z;
            let row = |axis: DVec3, at: f64| (axis - DVec3::Z * (at / ray.z)) * scale;
            let rows = [row(DVec3::X, ray.x), row(DVec3::Y, ray.y)];
            let square = |of: DVec3| DMat3::from_cols(of * of.x, of * of.y, of * of.z);
            sum + square(rows[0]) + square(rows[1])
        });
        normal.inverse()
    };
    let bar = POINTS[1] - POINTS[0];
    let both = covariance(POINTS[0]) + covariance(POINTS[1]);
    let along = bar.normalize();
    let expected = 100.0 * along.dot(both * along).sqrt() / bar.length();
    let stated = desk.open().settings().errors.world_scale.expect("stated");
    assert!(
        (stated / expected - 1.0).abs() < 0.02,
        "{stated} {expected}"
    );
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(!desk.open().flight().parts().unit_known);
    desk.click(Role::Button, "Remove control point P2");
    assert!(
        desk.open().control_list().bars.is_empty(),
        "nothing for it to end at"
    );
}

#[test]
fn the_tool_is_found_from_what_lacks() {
    let folder = tempfile::tempdir().expect("a folder");
    model(folder.path());
    let mut desk = Desk::new(Some(folder.path()));
    desk.click(Role::Button, "Unit: Control points…");
    assert!(desk.open().control.is_on);
    desk.click(Role::Button, "Back to the photos");
    assert!(!desk.open().control.is_on && !desk.photos().is_empty());
    desk.click(Role::Button, "File");
    desk.click(Role::Button, "Georeference…");
    desk.click(Role::RadioButton, "Control points");
    desk.click(Role::Button, "Click them in the photos");
    assert!(desk.open().control.is_on);
    // A list with a point that the flight's photos do not show is loaded whole.
    let list = folder.path().join("list.txt");
    fs::write(
        &list,
        "EPSG:32632\n1 2 3 99.5 49.5 img_1.jpg a\n4 5 6 7 8 other.jpg b\n",
    )
    .expect("written");
    step(&mut desk, ControlStep::Load(list));
    let points = &desk.open().control_list().points;
    assert_eq!(
        points[0].mark_in("IMG_1.JPG"),
        Some(DVec2::new(100.0, 50.0))
    );
    assert_eq!(points[1].marks[0].0, "other.jpg");
    assert!(desk.logged("1 of 2 marks are in photos that the flight does not have"));
    desk.fill("Surveyed place of a", "1 2");
    assert!(desk.logged("a surveyed place is three numbers"));
}

/// The tool as it looks: marks on a ball and on a rock of the sample's fifth photo, and a scale bar between them.
#[test]
fn how_it_looks() {
    let screen = Screen {
        size: [1000.0, 560.0],
        pixels_per_point: 1.0,
        theme: egui::Theme::Dark,
    };
    let mut desk = Desk::drawn(Some(&flight("assets/sample")), &screen);
    desk.press(Modifiers::NONE, Key::G);
    select(&mut desk, 4);
    for (point, pixel) in [DVec2::new(478.0, 415.0), DVec2::new(300.0, 235.0)]
        .into_iter()
        .enumerate()
    {
        step(&mut desk, ControlStep::Add);
        let pixel = Some(pixel);
        step(
            &mut desk,
            ControlStep::Mark {
                point,
                photo: 4,
                pixel,
            },
        );
    }
    step(&mut desk, ControlStep::AddBar);
    desk.harness.remove_cursor();
    desk.settle();
    desk.harness.snapshot("control_points");
}
