//! A new flight from photos: what is said of a folder of them, and what comes out.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Key, Modifiers, Theme};
use egui_kittest::kittest::NodeT;
use fragscale::app::command::{Asking, Command};
use fragscale::app::from_photos::{Ended, FromPhotosStep};
use fragscale::app::tasks::work::Task;
use fragscale::reconstruct::{EngineName, Quality};
use glam::DVec3;
use tempfile::TempDir;

use crate::desk::{Desk, Screen, copy_files};
use crate::dropping::drop_on;
use crate::rough_ground::photograph;

/// Nine photos of the sample flight, which do not overlap and do not say where they were taken.
fn nine_photos() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let photos = folder.path().join("face");
    copy_files("assets/sample/photos", &photos);
    (folder, photos)
}

/// The small window, with this folder in it.
fn desk(photos: &Path) -> Desk {
    let mut desk = Desk::new(None);
    desk.click(Role::Button, "New flight from photos");
    desk.fill_and_leave("Folder of the photos", photos.to_str().expect("UTF-8"));
    desk
}

fn asking(desk: &Desk) -> Option<Asking> {
    desk.harness.state().state().asking
}

fn quality(desk: &Desk) -> Quality {
    desk.harness.state().state().from_photos.form.quality
}

fn engine(desk: &Desk) -> EngineName {
    desk.harness.state().state().from_photos.form.engine
}

/// As if this COLMAP were installed, or none for that reason, whatever this machine has.
fn with_colmap(desk: &mut Desk, installed: Result<&str, &str>) {
    let installed = installed.map(str::to_owned).map_err(str::to_owned);
    let step = FromPhotosStep::Colmap(installed);
    desk.harness.state_mut().apply(Command::FromPhotos(step));
    desk.settle();
}

fn ended(desk: &Desk) -> Option<&Ended> {
    desk.harness.state().state().from_photos.ended.as_ref()
}

fn is_reconstructing(desk: &Desk) -> bool {
    let work = &desk.harness.state().state().work;
    work.is_running(Task::RECONSTRUCT)
}

/// Starts, and does not wait for the end.
fn start(desk: &mut Desk) {
    desk.node(Role::Button, "Start reconstruction").click();
    // The small window takes its new height.
    desk.harness.run_steps(5);
    assert!(is_reconstructing(desk));
}

#[test]
fn photos_without_overlap_are_a_line() {
    let (folder, photos) = nine_photos();
    for number in 4..=9 {
        fs::remove_file(photos.join(format!("IMG_000{number}.jpg"))).expect("removed");
    }
    fs::write(photos.join("IMG_0010.jpg"), "").expect("written");
    let mut desk = desk(&photos);
    for words in [
        "3 of 4 photos can be read",
        "3 by ",
        "1280 x 720 px",
        "no photo says where it was taken",
        "1 of 4 photos left out: it ",
    ] {
        assert!(desk.says(words), "{words}");
    }
    assert!(!is_reconstructing(&desk));
    desk.click(Role::Button, "Start reconstruction");
    let Some(Ended::Failed(why)) = ended(&desk) else {
        panic!("{:?}", ended(&desk));
    };
    assert!(desk.says(why) && !why.contains("defect"), "{why}");
    // The same photos end the same way.
    assert!(!desk.says("What was done is kept in that folder"));
    assert_eq!(asking(&desk), Some(Asking::FromPhotos));
    // Beside the photos, and nothing among them.
    assert!(folder.path().join("face flight").is_dir());
    assert!(!folder.path().join("face flight/flight.toml").exists());
    assert_eq!(fs::read_dir(&photos).expect("a folder").count(), 4);
    // Another folder is another matter.
    desk.fill("Folder of the photos", "");
    assert!(ended(&desk).is_none());
}

/// The photos are looked at anew for another coordinate system; the run begins behind that.
#[test]
fn start_is_one_click_behind_a_field() {
    let (_folder, photos) = nine_photos();
    for number in 4..=9 {
        fs::remove_file(photos.join(format!("IMG_000{number}.jpg"))).expect("removed");
    }
    let mut desk = desk(&photos);
    desk.node(Role::TextInput, "Coordinate system").click();
    desk.harness.run();
    let crs = "EPSG:32632".to_owned();
    desk.harness.event(egui::Event::Text(crs.clone()));
    desk.harness.run();
    desk.click(Role::Button, "Start reconstruction");
    assert_eq!(desk.harness.state().state().from_photos.form.crs, crs);
    assert!(ended(&desk).is_some(), "it ran");
}

#[test]
fn a_folder_that_is_none_is_said() {
    let (folder, photos) = nine_photos();
    let mut desk = desk(&folder.path().join("nowhere"));
    assert!(desk.says("There is no such folder"));
    desk.fill(
        "Folder of the photos",
        folder.path().to_str().expect("UTF-8"),
    );
    assert!(desk.says("a reconstruction needs three at least"));
    // A folder that holds other things is refused before anything is done.
    desk.fill_and_leave("Folder of the photos", photos.to_str().expect("UTF-8"));
    // Enter is the button below.
    desk.fill("Folder to make", photos.to_str().expect("UTF-8"));
    assert!(desk.says("the folder is not empty"));
    desk.fill_and_leave("Folder to make", "");
    desk.fill("Coordinate system", "EPSG:4326");
    assert!(desk.says("is no projected coordinate system"));
}

/// The embedded engine is always there; COLMAP where it is installed, else it says why not.
#[test]
fn an_engine_is_chosen() {
    let (_folder, photos) = nine_photos();
    let mut desk = desk(&photos);
    assert_eq!(engine(&desk), EngineName::Embedded);
    // What the machine has was looked for by itself.
    let found = &desk.harness.state().state().from_photos.colmap;
    let is_found = found.as_ref().expect("looked for").is_ok();
    assert_eq!(is_found, fragscale_test_data::program("colmap").is_some());

    with_colmap(&mut desk, Ok("COLMAP 3.8"));
    desk.click(Role::RadioButton, "Engine: COLMAP 3.8");
    assert_eq!(engine(&desk), EngineName::Colmap);
    desk.click(Role::RadioButton, "Engine: Embedded");
    assert_eq!(engine(&desk), EngineName::Embedded);

    with_colmap(&mut desk, Err("COLMAP is not installed"));
    let grey = desk.node(Role::RadioButton, "Engine: COLMAP");
    assert!(grey.accesskit_node().is_disabled());
    let place = grey.rect().center();
    desk.harness.hover_at(place);
    for _ in 0..60 {
        desk.harness.step();
    }
    assert!(desk.says("COLMAP is not installed"));
}

/// Six photos with RTK: cancelled at once, started again, and the flight is open, in metres.
#[test]
fn a_flight_comes_out() {
    let folder = tempfile::tempdir().expect("a folder");
    let photos = folder.path().join("ground");
    photograph(&photos);
    let mut desk = desk(&photos);
    assert!(desk.says("6 photos"));
    assert!(desk.says("6 of 6 say where they were taken, to 0.015 m level and 0.025 m up"));
    assert_eq!(quality(&desk), Quality::Fast);
    assert!(desk.says("It takes less than a minute on this computer"));
    desk.click(Role::RadioButton, "Quality: Best");
    assert_eq!(quality(&desk), Quality::Best);
    // The dense cloud of so few and small photos takes seconds all the same.
    desk.click(Role::RadioButton, "Quality: Fast");

    start(&mut desk);
    let begun = Instant::now();
    desk.node(Role::Button, "Cancel reconstruction").click();
    while is_reconstructing(&desk) {
        assert!(begun.elapsed() < Duration::from_secs(1), "not cancelled");
        desk.harness.step();
    }
    desk.harness.run_steps(5);
    assert!(desk.says("Cancelled. What was done is kept in that folder"));

    // Paused it says so and waits.
    start(&mut desk);
    desk.node(Role::Button, "Pause reconstruction").click();
    desk.harness.run_steps(5);
    assert!(desk.says("Paused: "));
    let how_far = |desk: &Desk| {
        let work = &desk.harness.state().state().work;
        let mut running = work.running();
        running.find(|(task, _)| *task == Task::RECONSTRUCT)
    };
    // It ends the photo that it is at, however long that takes on this machine.
    let stands = (0..60).any(|_| {
        let before = how_far(&desk);
        std::thread::sleep(Duration::from_millis(700));
        before.is_some() && how_far(&desk) == before
    });
    assert!(stands, "{:?}", how_far(&desk));
    desk.node(Role::Button, "Go on with the reconstruction")
        .click();
    desk.harness.run_steps(5);
    assert!(!desk.says("Paused: "));

    // The window can be put away meanwhile; the foot of the window says how far it is.
    desk.harness
        .key_press_modifiers(Modifiers::NONE, Key::Escape);
    desk.harness.step();
    desk.harness.step();
    assert_eq!(asking(&desk), None);
    assert!(desk.shows(Role::Button, "Cancel reconstructing"));
    // In the viewport the model grows.
    let mut grown = 0;
    while is_reconstructing(&desk) {
        desk.harness.step();
        let growing = desk.harness.state().state().from_photos.growing.as_ref();
        if let Some(growing) = growing {
            let words = growing.in_words();
            assert!(words.starts_with("The model grows: ") && words.contains(" of 6 photos"));
            grown = grown.max(growing.cameras.len());
            assert!(growing.count > 20, "{}", growing.count);
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(grown >= 2, "{grown} cameras");
    desk.settle();
    assert!(desk.harness.state().state().from_photos.growing.is_none());

    let Some(Ended::Made(made)) = ended(&desk) else {
        panic!("{:?}", ended(&desk));
    };
    assert_eq!(made.registered, 6, "{:?}", made.left_out);
    assert!(made.reprojection_px.is_some_and(|px| px < 1.0));
    assert!(desk.logged("6 of 6 photos"));
    let whole = |path: &Path| path.canonicalize().expect("a file");
    let made = folder.path().join("ground flight/flight.toml");
    let opened = desk.open().files.origin.flight_file().map(whole);
    assert_eq!(opened, Some(whole(&made)));
    // Where the cameras were is known: 6 m lie between the first and the third.
    let parts = desk.open().flight().parts();
    assert_eq!(parts.unit_of_lengths(), "m");
    let center = |name: &str| {
        let its = |photo: &&fragscale::flight::Photo| photo.name == name;
        let photo = parts.photos.iter().find(its).expect("a photo");
        photo.pose.center
    };
    let apart = center("DJI_0003.jpg") - center("DJI_0001.jpg");
    assert!((apart - DVec3::X * 6.0).length() < 0.06, "{apart}");

    // The next one goes elsewhere.
    desk.press(Modifiers::COMMAND, Key::N);
    let found = desk.harness.state().state().from_photos.found.as_ref();
    let proposed = &found.expect("looked at").proposed;
    assert!(
        proposed.ends_with("ground flight 2"),
        "{}",
        proposed.display()
    );
}

/// Photos with places and angles want a cloud, which can be made from them.
#[test]
fn dropped_photos_without_a_cloud_can_be_reconstructed() {
    let folder = tempfile::tempdir().expect("a folder");
    let photos = folder.path().join("ground");
    photograph(&photos);
    let mut desk = Desk::new(None);
    drop_on(&mut desk, &[&photos]);
    assert_eq!(asking(&desk), Some(Asking::Add));
    desk.click(Role::Button, "Reconstruct…");
    assert_eq!(asking(&desk), Some(Asking::FromPhotos));
    assert!(desk.says("6 photos"));
}

/// Photos that say nothing are no flight: one click leads to what can be done.
#[test]
fn dropped_photos_can_be_reconstructed() {
    let (_folder, photos) = nine_photos();
    let mut desk = Desk::new(None);
    drop_on(&mut desk, &[&photos]);
    assert!(desk.harness.state().state().open.is_none());
    desk.click(Role::Button, "Reconstruct…");
    assert_eq!(asking(&desk), Some(Asking::FromPhotos));
    assert!(desk.says("9 photos"));
    let field = desk.node(Role::TextInput, "Folder of the photos").value();
    assert_eq!(field.as_deref().map(Path::new), Some(photos.as_path()));
    assert!(!desk.shows(Role::Button, "Reconstruct…"), "it led there");
}

/// In words that do not depend on where the sources lie.
fn looks(screen: &Screen, name: &str) {
    let mut desk = Desk::drawn(None, screen);
    desk.click(Role::Button, "New flight from photos");
    desk.fill_and_leave("Folder of the photos", "assets/sample/photos");
    desk.fill_and_leave("Folder to make", "flights/face 3");
    with_colmap(&mut desk, Ok("COLMAP 3.8"));
    desk.harness.remove_cursor();
    desk.settle();
    desk.harness.snapshot(name);
}

#[test]
fn dark() {
    let screen = Screen {
        size: [760.0, 480.0],
        pixels_per_point: 1.0,
        theme: Theme::Dark,
    };
    looks(&screen, "from_photos_dark");
}

#[test]
fn light_at_200_percent() {
    let screen = Screen {
        size: [640.0, 400.0],
        pixels_per_point: 2.0,
        theme: Theme::Light,
    };
    looks(&screen, "from_photos_200_percent");
}

/// A calibration for photos of another size is refused in one line, with its file.
#[test]
fn a_calibration_goes_along() {
    let (folder, photos) = nine_photos();
    let lens = folder.path().join("lens.yaml");
    let yaml = fs::read_to_string("assets/sample/ost.yaml").expect("the sample's");
    let larger = yaml.replace("image_width: 1280", "image_width: 2560");
    assert_ne!(larger, yaml);
    fs::write(&lens, larger).expect("written");
    let mut desk = desk(&photos);
    desk.fill("Calibration", lens.to_str().expect("UTF-8"));
    desk.click(Role::Button, "Start reconstruction");
    let Some(Ended::Failed(why)) = ended(&desk) else {
        panic!("{:?}", ended(&desk));
    };
    assert!(
        why.contains("lens.yaml: it is for photos of 2560 x 720 px"),
        "{why}"
    );
}
