//! A surface of millions of points: a sample of it is on the screen while it is read, and the flight before stays
//! where opening is cancelled.

use std::path::Path;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use fragscale::app::Command;
use fragscale::app::command::ViewChange;
use fragscale::app::tasks::Task;
use glam::DVec2;

use crate::desk::{Desk, flight};

/// Two million points: a slope with a step.
fn write_cloud(path: &Path) {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(6).expect("a format");
    let header = builder.into_header().expect("a header");
    let mut writer = las::Writer::from_path(path, header).expect("a writer");
    for i in 0..2_000_000_u32 {
        let (x, y) = (f64::from(i % 2000), f64::from(i / 2000));
        let point = las::Point {
            x,
            y,
            z: if x < 900.0 { 40.0 } else { y * 0.1 },
            gps_time: Some(0.0),
            ..las::Point::default()
        };
        writer.write_point(point).expect("written");
    }
    writer.close().expect("closed");
}

/// Opens the cloud and waits until there is something to look at.
fn open(desk: &mut Desk, cloud: &Path) {
    desk.harness
        .state_mut()
        .apply(Command::Add(cloud.to_owned()));
    let start = Instant::now();
    while desk.harness.state().state().opening_preview().is_none() {
        assert!(
            start.elapsed() < Duration::from_secs(60),
            "{:?}",
            desk.texts()
        );
        assert!(desk.harness.state().state().is_opening());
        desk.harness.step();
        std::thread::sleep(Duration::from_millis(1));
    }
    desk.harness.step();
}

const FIRST_LOOK: &str = "A first look: 800 000 of 2 000 000 points, while all are read";

#[test]
fn a_large_cloud_is_looked_at_while_it_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let cloud = folder.path().join("large.las");
    write_cloud(&cloud);
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let number = desk.open().number;
    let seen = desk.open().looking.orbit;
    assert!(desk.shows(Role::Image, "Viewport"));

    open(&mut desk, &cloud);
    assert!(desk.shows(Role::Image, FIRST_LOOK), "{:?}", desk.texts());
    assert!(!desk.shows(Role::Image, "Viewport"));
    // It can be turned; the flight behind it is not.
    let orbit = |desk: &Desk| {
        let preview = desk.harness.state().state().opening_preview();
        preview.map(|preview| preview.orbit)
    };
    let before = orbit(&desk);
    let turn = Command::View(ViewChange::Orbit(DVec2::new(50.0, 0.0)));
    desk.harness.state_mut().apply(turn);
    assert!(before.is_some() && orbit(&desk) != before);

    desk.harness.state_mut().apply(Command::Cancel(Task::OPEN));
    desk.settle();
    assert_eq!(desk.open().number, number);
    assert_eq!(desk.open().looking.orbit, seen);
    assert_eq!(desk.open().review.count(), 9);
    assert!(desk.harness.state().state().opening_preview().is_none());
    assert!(desk.shows(Role::Image, "Viewport"));

    open(&mut desk, &cloud);
    assert!(desk.shows(Role::Image, FIRST_LOOK));
    desk.settle();
    // A surface alone is for the flight on the screen.
    let vertices = desk.open().flight().parts().surface.vertices().len();
    assert_eq!((vertices, desk.open().review.count()), (2_000_000, 9));
    assert!(desk.open().number != number);
    assert!(desk.harness.state().state().opening_preview().is_none());
    assert!(desk.shows(Role::Image, "Viewport") && !desk.shows(Role::Image, FIRST_LOOK));
}
