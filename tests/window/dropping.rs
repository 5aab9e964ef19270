//! What is dropped on the window: flights, and the surfaces and photos that belong to them.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use fragscale::app::Command;
use fragscale::app::command::Asking;

use crate::common::shared_data;
use crate::desk::{Desk, flight};

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Err("the window reads by itself".to_owned())
    }
}

/// Lets files or folders go over the window.
pub fn drop_on(desk: &mut Desk, paths: &[&Path]) {
    for path in paths {
        let file = Arc::new(Dropped(path.to_path_buf()));
        desk.harness.input_mut().dropped_files.push(file);
    }
    desk.harness.step();
    desk.settle();
}

#[test]
fn a_folder_is_opened_by_dropping_it() {
    let mut desk = Desk::new(None);
    drop_on(&mut desk, &[&flight("tests/windrow")]);
    assert_eq!(desk.open().flight().parts().name, "Windrow");
    assert_eq!(desk.rows().len(), 9);
    drop_on(&mut desk, &[&flight("tests/fixtures/nvm-points-photos")]);
    assert_ne!(desk.open().flight().parts().name, "Windrow");
}

/// A real flight over a lake shore, as OpenDroneMap left it: the photos lie where its own report says.
#[test]
fn brighton_opens_by_dropping_its_folder() {
    let Some(folder) = shared_data("odm-brighton-0") else {
        return;
    };
    let mut desk = Desk::new(None);
    drop_on(&mut desk, &[&folder]);
    let open = desk.open();
    assert_eq!(open.review.outcomes().len(), 7);
    assert_eq!(
        open.files.crs.as_deref(),
        Some("EPSG:32615"),
        "UTM zone 15 north"
    );
    let surface = open.extent.surface;
    for photo in 0..7 {
        let scale = open.scale(photo).expect("a scale");
        for edge in [scale.scale.top, scale.scale.bottom] {
            // At 36 to 38 m above ground, 4000 px wide and f = 0.5555 widths: f / Z is 58 to 62 px/m.
            let edge = edge.expect("an edge");
            assert!((54.0..63.0).contains(&edge), "{edge} px/m");
        }
        let center = open.flight().parts().photos[photo].pose.center;
        let above = center.z - surface.center().z;
        assert!((30.0..45.0).contains(&above), "{above} m above the shore");
        // What its middle shows is on the shore that was measured, or within a photo's size of it.
        let points: Vec<_> = scale.corners.iter().filter_map(|c| c.point()).collect();
        let middle = points.iter().sum::<glam::DVec3>() / points.len() as f64;
        let off = (middle - surface.center()).truncate().abs();
        assert!(off.max_element() < surface.size().truncate().max_element() / 2.0 + 40.0);
    }
    assert!(desk.logged("3 of 7 image files are missing"));
}

/// A level plane at this elevation, as a PLY.
fn plane(path: &Path, z: f64) {
    let mut text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nend_header\n".to_owned();
    for (x, y) in [(-50, -50), (50, -50), (50, 50), (-50, 50)] {
        text.push_str(&format!("{x} {y} {z}\n"));
    }
    fs::write(path, text).unwrap();
}

/// A photo straight down from 10 m with f = 1000 px, over a plane at 0: 100 px/m.
fn level_flight(folder: &Path) -> PathBuf {
    plane(&folder.join("level.ply"), 0.0);
    let poses = "photo,x,y,z,tilt,pan\na.jpg,0,0,10,90,0\n";
    fs::write(folder.join("poses.csv"), poses).unwrap();
    let text = "format = 1 # mine\n[world]\nunit = \"m\"\n[surface]\nfile = \"level.ply\"\n[[camera]]\nwidth = 400\nheight = 300\nfx = 1000.0\nfy = 1000.0\ncx = 200.0\ncy = 150.0\n[photos]\nposes = \"poses.csv\"\n";
    let path = folder.join("flight.toml");
    fs::write(&path, text).unwrap();
    path
}

fn act(desk: &mut Desk, command: Command) {
    desk.harness.state_mut().apply(command);
    desk.settle();
}

fn top(desk: &Desk) -> f64 {
    let open = desk.open();
    let scale = open.scale(0).expect("a scale");
    scale.scale.top.expect("a top scale")
}

#[test]
fn a_surface_that_is_dropped_is_the_flights_surface() {
    let folder = tempfile::tempdir().unwrap();
    let path = level_flight(folder.path());
    let other = folder.path().join("higher.ply");
    plane(&other, 2.0);
    let mut desk = Desk::new(Some(&path));
    assert!((top(&desk) - 100.0).abs() < 1e-9);
    drop_on(&mut desk, &[&other]);
    assert!(desk.says("higher.ply") && desk.says("What is the cloud to it?"));
    assert!((top(&desk) - 100.0).abs() < 1e-9, "nothing is taken before");
    desk.click(Role::Button, "Use as the surface");
    // 8 m above the plane now.
    assert!((top(&desk) - 125.0).abs() < 1e-9, "{}", top(&desk));
    assert!(
        desk.open().is_changed(),
        "flight.toml names another surface"
    );
    act(&mut desk, Command::Save);
    let text = fs::read_to_string(&path).unwrap();
    assert!(
        text.contains("file = \"higher.ply\"") && text.contains("# mine"),
        "{text}"
    );
    assert!(!desk.open().is_changed());
    drop_on(&mut desk, &[&path]);
    assert!((top(&desk) - 125.0).abs() < 1e-9);
}

#[test]
fn a_cloud_beside_an_open_flight_is_what_the_engineer_says() {
    let folder = tempfile::tempdir().unwrap();
    let path = level_flight(folder.path());
    let other = folder.path().join("higher.ply");
    plane(&other, 2.0);
    let mut desk = Desk::new(Some(&path));
    // Escape takes nothing.
    drop_on(&mut desk, &[&other]);
    assert!(desk.shows(Role::Button, "Use as the surface"));
    desk.press(Modifiers::NONE, Key::Escape);
    assert!(!desk.shows(Role::Button, "Use as the surface"));
    assert!(!desk.open().is_changed() && desk.open().beside.is_empty());
    // File > Open asks as well.
    act(&mut desk, Command::Open(other.clone()));
    desk.click(Role::Button, "Show beside the surface");
    assert_eq!(desk.open().beside[0].path, other);
    drop_on(&mut desk, &[&other]);
    desk.click(Role::Button, "Use as the base of volumes");
    let base = desk.open().pointer.second.as_ref().expect("a base");
    assert_eq!(base.path, other);
    assert!((top(&desk) - 100.0).abs() < 1e-9 && !desk.open().is_changed());
    drop_on(&mut desk, &[&other]);
    desk.click(Role::Button, "Open on its own");
    assert!(desk.open().files.origin.is_surface_alone());
    assert_eq!(desk.open().files.path, other);
}

#[test]
fn a_flight_and_its_surface_are_dropped_together() {
    let folder = tempfile::tempdir().unwrap();
    let path = level_flight(folder.path());
    let other = folder.path().join("higher.ply");
    plane(&other, 2.0);
    let mut desk = Desk::new(None);
    drop_on(&mut desk, &[&other, &path]);
    assert!((top(&desk) - 125.0).abs() < 1e-9);
}

#[test]
fn a_flight_without_a_surface_waits_for_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = level_flight(folder.path());
    let other = folder.path().join("higher.ply");
    plane(&other, 2.0);
    fs::remove_file(folder.path().join("level.ply")).unwrap();
    let mut desk = Desk::new(None);
    drop_on(&mut desk, &[&other]);
    assert!(desk.open().files.origin.is_surface_alone());
    drop_on(&mut desk, &[&path]);
    assert!(
        desk.open().files.origin.is_surface_alone(),
        "the cloud stays"
    );
    assert!(desk.logged("level.ply: there is no such file"));
    act(&mut desk, Command::Ask(Some(Asking::Add)));
    assert!(desk.says("a cloud or mesh to be its surface"));
    drop_on(&mut desk, &[&other]);
    assert!((top(&desk) - 125.0).abs() < 1e-9);
}

#[test]
fn two_surfaces_at_once_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = level_flight(folder.path());
    let other = folder.path().join("higher.ply");
    plane(&other, 2.0);
    let mut desk = Desk::new(None);
    drop_on(
        &mut desk,
        &[&path, &other, &folder.path().join("level.ply")],
    );
    assert!(desk.logged("are two surfaces"));
}
