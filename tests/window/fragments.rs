//! The page of the fragments: outlined, corrected by mouse and keys, measured, saved and read again.

use std::fs;

use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use fragscale::app::command::Asking;
use fragscale::app::fragments::{EngineChoice, FragmentStep, PhotoOutlines};
use fragscale::app::size_distributions::Page;
use fragscale::app::{Command, photo_view::PhotoCommand};
use fragscale::labels::{NOT_ROCK, Outlines};
use glam::DVec2;

use crate::desk::{Desk, Screen, copy, copy_files, flight};

fn outlines(desk: &Desk) -> &PhotoOutlines {
    let open = desk.open();
    open.fragments.of(open.selected.unwrap()).expect("outlines")
}

fn fragments(outlines: &Outlines) -> usize {
    let areas = outlines.labels().areas();
    areas.iter().skip(1).filter(|area| **area > 0).count()
}

/// Where a pixel of the photo is on the screen, one pixel a point.
fn on_screen(desk: &Desk, pixel: DVec2) -> Pos2 {
    let name = format!("Photo view {}", desk.selected());
    let frame = desk.node(Role::Image, &name).rect();
    let size = DVec2::new(f64::from(frame.width()), f64::from(frame.height()));
    let open = desk.open();
    let photo = &open.flight().parts().photos[open.selected.unwrap()];
    let camera = open.flight().camera(photo);
    let image = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    let placing = open.photo_view.placing;
    let at = placing.corner(image, size) + pixel * placing.scale(image, size);
    frame.min + vec2(at.x as f32, at.y as f32)
}

fn drag(desk: &mut Desk, places: &[DVec2]) {
    let places: Vec<Pos2> = places.iter().map(|place| on_screen(desk, *place)).collect();
    desk.harness.hover_at(places[0]);
    desk.harness.drag_at(places[0]);
    for place in &places[1..] {
        desk.harness.hover_at(*place);
        desk.harness.step();
    }
    desk.harness.drop_at(places[places.len() - 1]);
    desk.settle();
}

fn click(desk: &mut Desk, pixel: DVec2) {
    let at = on_screen(desk, pixel);
    desk.click_at(at);
}

/// A copy of the bundled flight, with its photos.
fn sample() -> tempfile::TempDir {
    let folder = copy("assets/sample");
    copy_files("assets/sample/photos", &folder.path().join("photos"));
    folder
}

/// With the first photo of a copy of the bundled flight outlined.
fn outlined(path: &std::path::Path) -> Desk {
    let mut desk = Desk::new(Some(path));
    desk.click(Role::Tab, "Fragments");
    assert!(desk.says("Nothing is outlined in this photo yet."));
    desk.click(Role::Button, "Outline this photo");
    desk
}

/// The middle of the red ball in the first photo of the bundled flight: by eye, it has a radius of 70 pixels.
const BALL: DVec2 = DVec2::new(760.0, 279.0);

#[test]
fn outlined_corrected_saved_and_read_again() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let mut desk = outlined(&file);
    let first = outlines(&desk).now().clone();
    assert!(fragments(&first) > 500, "{}", fragments(&first));
    let measured = outlines(&desk).measured().expect("measured");
    let by_mass = measured.by_mass.as_ref().unwrap();
    assert_eq!(by_mass.whole + by_mass.cut, fragments(&first));
    // Size distributions has those of a fitted function.
    assert!(desk.says("This photo, by mass, as measured"));

    // The ball is one, until a stroke goes through it.
    click(&mut desk, BALL);
    let ball = desk.open().fragments.selected.expect("the ball");
    assert_eq!(first.fragment_at(BALL), Some(ball));
    let across = [-100.0, 0.0, 100.0].map(|x| BALL + DVec2::new(x, 3.0));
    desk.press(Modifiers::NONE, Key::S);
    drag(&mut desk, &across);
    // Behind the outlining itself.
    assert_eq!(outlines(&desk).editing.changes(), 2);
    let [above, below] = [-30.0, 30.0].map(|y| BALL + DVec2::new(0.0, y));
    let now = outlines(&desk).now();
    assert_ne!(now.fragment_at(above), now.fragment_at(below));
    // And one again by a stroke over both.
    desk.press(Modifiers::NONE, Key::M);
    drag(&mut desk, &[above, below]);
    let now = outlines(&desk).now();
    assert_eq!(now.fragment_at(above), now.fragment_at(below));
    // Looked at: it is not among the doubtful ones any more.
    assert_eq!(now.sure(now.fragment_at(BALL).unwrap()), None);

    // It is no rock: drawn about by clicks, ended by Enter.
    desk.press(Modifiers::NONE, Key::X);
    for (x, y) in [(-80.0, -80.0), (80.0, -80.0), (80.0, 80.0), (-80.0, 80.0)] {
        click(&mut desk, BALL + DVec2::new(x, y));
    }
    assert_eq!(desk.open().fragments.drawing.len(), 4);
    desk.press(Modifiers::NONE, Key::Backspace);
    click(&mut desk, BALL + DVec2::new(-80.0, 80.0));
    desk.press(Modifiers::NONE, Key::Enter);
    let excluded = outlines(&desk).now().labels().labels.iter();
    let excluded = excluded.filter(|label| **label == NOT_ROCK).count();
    // What is drawn about, and what is left of stones that lie mostly within.
    assert!((25_600..28_000).contains(&excluded), "{excluded}");

    // All of it undone is what was, and done again.
    let last = outlines(&desk).now().clone();
    for _ in 0..3 {
        desk.press(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(*outlines(&desk).now(), first);
    for _ in 0..3 {
        desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    }
    assert_eq!(*outlines(&desk).now(), last);

    // Saved beside the flight, and there again when it is opened.
    assert!(desk.harness.state().state().is_changed());
    desk.press(Modifiers::COMMAND, Key::S);
    assert!(!desk.harness.state().state().is_changed());
    let saved = folder.path().join("fragments/IMG_0001.png");
    assert!(saved.is_file());
    let mut again = Desk::new(Some(&file));
    again.click(Role::Tab, "Fragments");
    assert_eq!(*outlines(&again).now(), last);
    assert!(!again.harness.state().state().is_changed());
    assert!(outlines(&again).measured().is_some());

    // A picture of another size is said, and not shown.
    image::GrayImage::new(20, 20).save(&saved).unwrap();
    let mut broken = Desk::new(Some(&file));
    broken.click(Role::Tab, "Fragments");
    assert!(broken.open().fragments.of(0).is_none());
    assert!(broken.logged("20 x 20"));
    // It is not ours any more: nothing is written over it.
    broken.click(Role::Button, "Outline this photo");
    broken.press(Modifiers::COMMAND, Key::S);
    assert!(broken.harness.state().state().is_changed());
    broken.click(Role::Button, "Keep the file");
    assert_eq!(image::open(&saved).unwrap().width(), 20);
    fs::remove_file(&saved).unwrap();
    fs::remove_file(saved.with_file_name("IMG_0001_outlines.json")).unwrap();
    broken.press(Modifiers::COMMAND, Key::S);
    assert!(!broken.harness.state().state().is_changed());
}

/// Every card of a drone has the same names: outlines of another picture of that name are not taken, and not written over
/// without a question.
#[test]
fn outlines_of_another_picture_are_not_taken() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let mut desk = outlined(&file);
    desk.press(Modifiers::COMMAND, Key::S);
    let json = folder.path().join("fragments/IMG_0001_outlines.json");
    let before = fs::read_to_string(&json).expect("saved");
    let photos = folder.path().join("photos");
    fs::copy(photos.join("IMG_0002.jpg"), photos.join("IMG_0001.jpg")).expect("another picture");
    let words = "of another picture with the photo's name";
    let output = crate::common::fragscale(&[
        "delineate",
        file.to_str().expect("UTF-8"),
        "--engine",
        "saved",
        "--photo",
        "IMG_0001.jpg",
        "--to",
        folder.path().join("out").to_str().expect("UTF-8"),
    ]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        output.status.code() != Some(0) && said.contains(words),
        "{said}"
    );

    let mut other = Desk::new(Some(&file));
    other.click(Role::Tab, "Fragments");
    assert!(other.logged(words) && other.open().fragments.of(0).is_none());
    other.click(Role::Button, "Outline this photo");
    other.press(Modifiers::COMMAND, Key::S);
    assert_eq!(fs::read_to_string(&json).expect("there"), before);
    other.click(Role::Button, "Replace it");
    assert!(!other.harness.state().state().is_changed());
    assert_ne!(fs::read_to_string(&json).expect("there"), before);
    let mut again = Desk::new(Some(&file));
    again.click(Role::Tab, "Fragments");
    assert!(again.open().fragments.of(0).is_some());
}

/// As a newcomer found: after an outlining by another engine undo brought the outlines back and not what outlined them, by whose
/// rules their sizes follow. The first outlining is undone, too.
#[test]
fn undo_knows_what_outlined() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let mut desk = outlined(&file);
    let sizes = |desk: &Desk| {
        let measured = outlines(desk).measured().expect("measured");
        let by_mass = measured.by_mass.as_ref().unwrap();
        (
            by_mass.curve.clone(),
            by_mass.fines,
            measured.intervals.clone(),
        )
    };
    let learned = sizes(&desk);
    desk.harness
        .state_mut()
        .apply(Command::Fragments(FragmentStep::Engine(
            EngineChoice::BroughtAlong(1),
        )));
    desk.click(Role::Button, "Outline anew");
    assert_eq!(outlines(&desk).by().engine, "classical");
    assert!(desk.says("Outlined by"));
    assert!(sizes(&desk).0 != learned.0);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(outlines(&desk).by().engine, "learned");
    assert!(sizes(&desk) == learned);
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(outlines(&desk).by().engine, "classical");
    // Saved as it is now; all of it undone, and saved again: the files are gone.
    desk.press(Modifiers::COMMAND, Key::S);
    let saved = folder.path().join("fragments/IMG_0001.png");
    let json = fs::read_to_string(saved.with_file_name("IMG_0001_outlines.json")).unwrap();
    assert!(json.contains("classical"), "{json}");
    for _ in 0..2 {
        desk.press(Modifiers::COMMAND, Key::Z);
    }
    assert!(desk.says("Nothing is outlined in this photo yet."));
    assert!(desk.harness.state().state().is_changed());
    desk.press(Modifiers::COMMAND, Key::S);
    assert!(!desk.harness.state().state().is_changed() && !saved.exists());
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(sizes(&desk) == learned);
    assert!(desk.harness.state().state().is_changed());
}

#[test]
fn the_doubtful_ones_are_gone_through_with_keys() {
    let folder = sample();
    let mut desk = outlined(&folder.path().join("flight.toml"));
    let doubtful = outlines(&desk).doubtful.clone();
    desk.press(Modifiers::NONE, Key::N);
    assert_eq!(desk.open().fragments.selected, Some(doubtful[0].0));
    // It is in the middle, one to one.
    assert_eq!(desk.open().photo_view.placing.zoom, Some(1.0));
    desk.press(Modifiers::NONE, Key::Enter);
    assert_eq!(desk.open().fragments.selected, Some(doubtful[1].0));
    desk.press(Modifiers::NONE, Key::Delete);
    let left = &outlines(&desk).doubtful;
    assert_eq!(left[..], doubtful[2..]);
    assert!(desk.says(&format!("{} fragments that nobody looked at", left.len())));
    // What is typed beside the fields of a small window is for none of it.
    let before = outlines(&desk).now().clone();
    desk.harness
        .state_mut()
        .apply(Command::Ask(Some(Asking::FromPhotos)));
    desk.harness.run();
    desk.harness.state().state().context.memory_mut(|memory| {
        if let Some(field) = memory.focused() {
            memory.surrender_focus(field);
        }
    });
    desk.harness.run();
    for key in [Key::N, Key::O, Key::Delete, Key::Enter] {
        desk.press(Modifiers::NONE, key);
    }
    assert!(outlines(&desk).now() == &before);
    assert_eq!(desk.open().fragments.selected, None);
    desk.press(Modifiers::NONE, Key::Escape);
    // Nor where a question waits.
    desk.harness.state_mut().apply(Command::Close);
    desk.harness.run();
    assert!(desk.harness.state().state().held_back.is_some());
    for key in [Key::N, Key::O, Key::Delete] {
        desk.press(Modifiers::NONE, key);
    }
    assert!(outlines(&desk).now() == &before);
    assert_eq!(desk.open().fragments.selected, None);
    desk.harness.state_mut().apply(Command::Keep);
    desk.harness.run();
    // A ball is no rock at all.
    let out = |desk: &Desk| {
        let labels = outlines(desk).now().labels().labels.clone();
        labels
            .into_iter()
            .filter(|label| *label == NOT_ROCK)
            .count()
    };
    let [(next, _), ..] = outlines(&desk).doubtful[..] else {
        panic!("a doubtful one");
    };
    let (area, before) = (
        outlines(&desk).now().labels().areas()[next as usize],
        out(&desk),
    );
    desk.press(Modifiers::NONE, Key::N);
    desk.press(Modifiers::COMMAND, Key::Delete);
    assert_eq!(out(&desk), before + area);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(out(&desk), before);
    // Coarser under the cursor, and finer.
    desk.harness
        .state_mut()
        .apply(Command::Photo(PhotoCommand::Fit));
    let before = outlines(&desk).now().clone();
    // The pixel in the middle of all of one's.
    let labels = before.labels();
    let its = |place: &usize| labels.labels[*place] == doubtful[4].0;
    let its: Vec<usize> = (0..labels.labels.len()).filter(its).collect();
    let (x, y) = (
        its[its.len() / 2] % labels.width,
        its[its.len() / 2] / labels.width,
    );
    let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
    let place = on_screen(&desk, at);
    desk.harness.hover_at(place);
    desk.settle();
    desk.press(Modifiers::NONE, Key::Plus);
    let coarser = outlines(&desk).now().clone();
    assert!(fragments(&coarser) <= fragments(&before) && coarser != before);
    desk.press(Modifiers::NONE, Key::Minus);
    assert!(fragments(outlines(&desk).now()) >= fragments(&coarser));
    // Another photo has none yet; this one still has.
    desk.press(Modifiers::NONE, Key::ArrowDown);
    assert!(desk.says("Nothing is outlined in this photo yet."));
    desk.press(Modifiers::NONE, Key::ArrowUp);
    assert!(outlines(&desk).editing.changes() >= 3);
    // However far one goes, the list shows the selected one.
    for _ in 0..20 {
        desk.press(Modifiers::NONE, Key::N);
    }
    let selected = desk.open().fragments.selected.expect("a fragment");
    let mut doubtful = outlines(&desk).doubtful.iter();
    let (_, sure) = doubtful.find(|of| of.0 == selected).expect("in the list");
    let row = format!("{selected}: {:.0} % sure", 100.0 * sure);
    assert!(desk.harness.query_by_label(&row).is_some(), "{row}");
}

#[test]
fn its_curve_stands_beside_the_sieves() {
    let mut desk = outlined(&flight("assets/sample"));
    for _ in 0..2 {
        desk.harness
            .state_mut()
            .apply(Command::Page(Page::Fragments));
        desk.harness
            .state_mut()
            .apply(Command::Fragments(FragmentStep::TakeDistribution));
    }
    let state = desk.harness.state().state();
    assert_eq!(state.page, Page::SizeDistributions);
    // Once, however often it is taken over.
    let sources = state.distributions.sources();
    assert_eq!(sources.len(), 1);
    assert_eq!(
        sources[0].name,
        "Fragments of IMG_0001.jpg, Lab trial 1 (learned)"
    );
    assert_eq!(
        sources[0].set.curves[0].labels.method,
        "fragscale (learned)"
    );
    // Of outlines that were changed since it says so, until they are what they were.
    desk.settle();
    assert!(!desk.says("have changed since"));
    let go = |desk: &mut Desk, page: Page| {
        desk.harness.state_mut().apply(Command::Page(page));
        desk.settle();
    };
    go(&mut desk, Page::Fragments);
    desk.press(Modifiers::NONE, Key::N);
    desk.press(Modifiers::NONE, Key::Delete);
    assert_eq!(outlines(&desk).editing.changes(), 2);
    go(&mut desk, Page::SizeDistributions);
    assert!(
        desk.says("have changed since: send it again"),
        "{:?}",
        desk.texts()
    );
    go(&mut desk, Page::Fragments);
    desk.press(Modifiers::COMMAND, Key::Z);
    go(&mut desk, Page::SizeDistributions);
    assert!(!desk.says("have changed since"));
}

/// A ball that is traced after its photo was outlined counts as no rock from then on, in the window and by the command.
#[test]
fn a_scale_object_traced_later_is_taken_off() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let mut desk = outlined(&file);
    let whole = |desk: &Desk| {
        let measured = outlines(desk).measured().expect("measured");
        let fragments = measured.photo.fragments.iter();
        fragments.filter(|of| of.world.is_some()).count()
    };
    let before = whole(&desk);
    desk.press(Modifiers::COMMAND, Key::S);
    let ring = (0..12).map(|step| {
        let angle = f64::from(step) * std::f64::consts::TAU / 12.0;
        // A little too narrow: a rim is left beyond it.
        let place = BALL + DVec2::from_angle(angle) * 66.0;
        format!("[{:.1}, {:.1}]", place.x, place.y)
    });
    let ring: Vec<String> = ring.collect();
    let mut text = std::fs::read_to_string(&file).unwrap();
    text += &format!(
        "\n[[scale_object]]\nphoto = \"IMG_0001.jpg\"\nkind = \"sphere\"\nsize = 0.06\noutline = [{}]\nmask = true\n",
        ring.join(", ")
    );
    std::fs::write(&file, text).unwrap();
    let mut desk = Desk::new(Some(&file));
    desk.click(Role::Tab, "Fragments");
    assert!(desk.says("what its scale objects cover is outlined as rock, and counts as none"));
    assert!(whole(&desk) < before, "{} {before}", whole(&desk));
    // All of the ball is none, its rim as well, and nobody has to look at it.
    let of = outlines(&desk);
    let ball = of.now().fragment_at(BALL).expect("the ball");
    assert!(of.now().sure(ball).is_some());
    let measured = of.measured().expect("measured").fragment(ball);
    assert!(measured.is_none_or(|of| of.world.is_none()));
    let on_objects = of.on_objects().expect("measured").len();
    assert!(on_objects > 0 && of.now().doubtful().len() == of.doubtful.len() + on_objects);
    assert!(of.doubtful.iter().all(|(number, _)| *number != ball));
    assert!(desk.says("no rock, nothing to look at"));
    click(&mut desk, BALL);
    assert_eq!(desk.open().fragments.selected, Some(ball));
    assert!(desk.says("It lies on a scale object: no rock, and not measured."));
    assert!(
        !desk.harness.state().state().is_changed(),
        "the outlines stay"
    );
    let to = folder.path().join("by command");
    let done = std::process::Command::new(env!("CARGO_BIN_EXE_fragscale"))
        .args(["delineate", "--engine", "saved"])
        .args([file.as_path(), "--to".as_ref(), to.as_path()])
        .output()
        .unwrap();
    assert!(done.status.success());
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(
        said.contains("what its scale objects cover is outlined as rock"),
        "{said}"
    );
    let labels = image::open(to.join("IMG_0001_labels.png"))
        .unwrap()
        .into_luma16();
    assert_eq!(labels.get_pixel(BALL.x as u32, BALL.y as u32).0, [u16::MAX]);
}

/// What the window writes of outlines that were corrected is what the command writes of the same when they are saved; before
/// files are replaced it asks; the flight's photos keep their folder for themselves.
#[test]
fn results_are_those_of_the_command() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let mut desk = outlined(&file);
    desk.press(Modifiers::NONE, Key::B);
    drag(&mut desk, &[BALL, BALL + DVec2::new(40.0, 0.0)]);
    assert_eq!(outlines(&desk).editing.changes(), 2);
    let to = folder.path().join("from window");
    desk.click(Role::Button, "Export fragments…");
    desk.type_path(&folder.path().join("photos"));
    desk.click(Role::Button, "Write results");
    assert!(desk.logged("the flight's photos lie in it"));
    for replaced in [false, true] {
        desk.click(Role::Button, "Export fragments…");
        desk.type_path(&to);
        desk.click(Role::Button, "Write results");
        if replaced {
            assert!(desk.says("Replace the file?"));
            desk.click(Role::Button, "Replace it");
        }
        assert!(desk.logged("fragments of 1 photo written"));
    }
    assert!(desk.logged("8 of 9 photos are not outlined, and are left out"));
    assert!(desk.harness.state().state().is_changed());

    desk.press(Modifiers::COMMAND, Key::S);
    let by_command = folder.path().join("by command");
    let done = std::process::Command::new(env!("CARGO_BIN_EXE_fragscale"))
        .args(["delineate", "--engine", "saved"])
        .args([file.as_path(), "--to".as_ref(), by_command.as_path()])
        .status()
        .unwrap();
    assert!(done.success());
    for name in [
        "IMG_0001_labels.png",
        "IMG_0001_outlines.png",
        "IMG_0001_world.geojson",
        "fragments.csv",
        "distribution.csv",
        "sizes.csv",
    ] {
        let [a, b] = [&to, &by_command].map(|folder| fs::read(folder.join(name)).unwrap());
        assert!(a == b, "{name}");
    }
    let report = fs::read_to_string(to.join("report.html")).unwrap();
    assert!(report.contains("8 of 9 photos are not outlined"));
    // Closed and opened again it is the same of the saved outlines, which nobody has looked at since.
    let mut again = Desk::new(Some(&file));
    let third = folder.path().join("again");
    again
        .harness
        .state_mut()
        .apply(Command::Fragments(FragmentStep::Export(
            third.clone().into(),
        )));
    again.settle();
    assert!(again.logged("fragments of 1 photo written"));
    let [a, b] = [&to, &third].map(|folder| fs::read(folder.join("sizes.csv")).unwrap());
    assert!(a == b);
    // And the outlines that it wrote come back as another tool's, by their path.
    desk.press(Modifiers::NONE, Key::ArrowDown);
    desk.click(Role::Button, "Outlines of another tool…");
    assert!(desk.says("The outlines of IMG_0002.jpg: "));
    // What cannot be taken is said where it was asked for.
    desk.type_path(&to.join("report.html"));
    desk.click(Role::Button, "Take the outlines");
    assert!(desk.shows(Role::Button, "Take the outlines") && desk.says("report.html: "));
    assert!(desk.open().fragments.of(1).is_none());
    // As they are of the photo as shot, the lens moves them.
    desk.type_path(&to.join("IMG_0001_labels.png"));
    desk.click(Role::RadioButton, "the photo as shot");
    desk.click(Role::Button, "Take the outlines");
    let moved = outlines(&desk).now().clone();
    desk.click(Role::Button, "Outlines of another tool…");
    let usual = "undistorted in fragscale's own files, else as shot";
    desk.click(Role::RadioButton, usual);
    desk.type_path(&to.join("IMG_0001_labels.png"));
    desk.click(Role::Button, "Take the outlines");
    assert!(fragments(outlines(&desk).now()) > 500 && *outlines(&desk).now() != moved);
    assert!(!desk.shows(Role::Button, "Take the outlines"));
}

/// Outlines in LabelMe's form, which say of which photo they are: a square of 200 pixels.
fn labelme(path: &std::path::Path, photo: &str) {
    let text = format!(
        r#"{{"shapes": [{{"label": "rock", "points": [[500, 300], [700, 300], [700, 500], [500, 500]]}}],
            "imagePath": "{photo}", "imageHeight": 720, "imageWidth": 1280}}"#
    );
    fs::write(path, text).unwrap();
}

/// As a user found: LabelMe's outlines of another photo were taken, and what is doubtful of outlines stood in the log alone; what
/// was wrong with a file was still said beside the next one that was taken, and on other pages.
#[test]
fn outlines_of_another_photo_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [other, own] = ["other.json", "own.json"].map(|name| folder.path().join(name));
    labelme(&other, "IMG_0001.jpg");
    labelme(&own, "photos/IMG_0002.JPG");
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.click(Role::Tab, "Fragments");
    desk.press(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(desk.selected(), "IMG_0002.jpg");
    desk.click(Role::Button, "Outlines of another tool…");
    desk.type_path(&other);
    desk.click(Role::Button, "Take the outlines");
    let why = "other.json: it has no outlines of IMG_0002.jpg, but of IMG_0001.jpg";
    let notice = |desk: &Desk| desk.harness.state().state().notice.clone();
    assert!(desk.says(why) && notice(&desk).is_some());
    assert!(desk.open().fragments.of(1).is_none());
    desk.type_path(&own);
    desk.click(Role::Button, "Take the outlines");
    assert_eq!(fragments(outlines(&desk).now()), 1);
    assert_eq!(notice(&desk), None);
    // What is doubtful of them stays in sight, with their file, and goes with them.
    let doubt = "own.json: taken as outlines of the photo as shot";
    assert!(desk.says(doubt) && desk.logged(&format!("IMG_0002.jpg: {doubt}")));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(!desk.says(doubt));
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(desk.says(doubt));
    // What was wrong for one photo is not said of the next, nor what was done with it.
    for leave in [Key::ArrowUp, Key::ArrowDown] {
        let masks = FragmentStep::Masks {
            path: folder.path().join("none.json"),
            of: None,
        };
        desk.harness.state_mut().apply(Command::Fragments(masks));
        desk.settle();
        assert!(notice(&desk).is_some());
        let said = |desk: &Desk| {
            let said = desk.harness.state().state().last_said();
            said.is_some_and(|line| line.text.contains("none.json"))
        };
        assert!(said(&desk));
        desk.press(Modifiers::NONE, leave);
        assert!(notice(&desk).is_none() && !said(&desk));
    }
}

/// A frame that takes long gets several clicks at once, and the mouse is elsewhere by then.
#[test]
fn corners_are_where_they_were_clicked() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.click(Role::Tab, "Fragments");
    desk.press(Modifiers::NONE, Key::O);
    let corners = [(300.0, 200.0), (500.0, 240.0), (420.0, 400.0)];
    let corners = corners.map(|(x, y)| DVec2::new(x, y));
    let button = |pos: Pos2, pressed: bool| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let mut events = Vec::new();
    for corner in &corners[..2] {
        let at = on_screen(&desk, *corner);
        events.extend([
            egui::Event::PointerMoved(at),
            button(at, true),
            button(at, false),
        ]);
    }
    events.push(egui::Event::PointerMoved(on_screen(&desk, corners[2])));
    desk.frame(events);
    desk.settle();
    let drawing = desk.open().fragments.drawing.clone();
    assert_eq!(drawing.len(), 2, "{drawing:?}");
    for (drawn, clicked) in drawing.iter().zip(corners) {
        assert!(drawn.distance(clicked) < 1.0, "{drawn} for {clicked}");
    }
}

/// A network of hers is named in the window, outlines, and what it is said to leave goes into the numbers: the same after
/// saving and opening again, where nobody has named it.
#[test]
fn a_network_of_hers() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let fixture =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/onnx/dark.onnx");
    fs::copy(fixture, folder.path().join("dark.onnx")).unwrap();
    let described = folder.path().join("mine.toml");
    let maps = "model = 'dark.onnx'\nfines_of_unfound = 0.5\n[[output]]\nis = 'border'\n";
    fs::write(&described, maps).unwrap();
    let mut desk = Desk::new(Some(&file));
    desk.click(Role::Tab, "Fragments");
    desk.click(Role::ComboBox, "Engine");
    desk.click(Role::Button, "Your network…");
    // What cannot be taken is said where it was asked for.
    desk.type_path(&folder.path().join("poses.csv"));
    desk.click(Role::Button, "Take the network");
    assert!(desk.shows(Role::Button, "Take the network") && desk.says("poses.csv"));
    desk.type_path(&described);
    desk.click(Role::Button, "Take the network");
    assert!(!desk.shows(Role::Button, "Take the network"));
    assert!(desk.logged("network mine: ready"));
    desk.click(Role::Button, "Outline this photo");
    assert_eq!(outlines(&desk).by().engine, "mine");
    let habits = outlines(&desk).by().habits.expect("habits");
    assert_eq!(habits.fines_of_unfound, 0.5);
    let by_mass = |desk: &Desk| {
        let measured = outlines(desk).measured().expect("measured");
        let by_mass = measured.by_mass.as_ref().unwrap();
        (
            by_mass.curve.clone(),
            by_mass.fines,
            measured.intervals.clone(),
        )
    };
    let first = by_mass(&desk);
    // Half of what is not outlined, where other tools leave all of it.
    let unfound = outlines(&desk)
        .measured()
        .unwrap()
        .by_mass
        .as_ref()
        .unwrap()
        .unfound;
    assert!(unfound > 0.02, "{unfound}");
    desk.press(Modifiers::COMMAND, Key::S);
    let mut again = Desk::new(Some(&file));
    again.click(Role::Tab, "Fragments");
    assert_eq!(outlines(&again).by().habits, Some(habits));
    assert!(by_mass(&again) == first);
    // And the engine that is chosen there is one that comes along.
    assert_eq!(again.open().fragments.engine, EngineChoice::default());
}

/// All photos that are not outlined yet, one after the other; what is outlined or saved stays.
#[test]
fn all_photos_are_outlined() {
    let folder = sample();
    // Of nine photos three are left, for the test's time.
    let file = folder.path().join("flight.toml");
    let poses = folder.path().join("poses.csv");
    let text = fs::read_to_string(&poses).unwrap();
    let few = text.lines().take(4).collect::<Vec<_>>().join("\n") + "\n";
    fs::write(&poses, few).unwrap();
    let mut desk = outlined(&file);
    let first = outlines(&desk).now().clone();
    desk.press(Modifiers::COMMAND, Key::S);
    let mut desk = Desk::new(Some(&file));
    desk.click(Role::Tab, "Fragments");
    desk.click(Role::Button, "Outline all");
    let open = desk.open();
    assert_eq!(open.fragments.waiting(), 0);
    assert_eq!(*open.fragments.of(0).unwrap().now(), first);
    assert!(!open.fragments.of(0).unwrap().is_changed());
    for photo in [1, 2] {
        let of = open.fragments.of(photo).expect("outlines");
        assert!(fragments(of.now()) > 500 && of.is_changed());
    }
    // And it says at once what they come to.
    let all = open.fragments.all.as_ref().expect("measured");
    assert_eq!(all.photos, [3, 3]);
    assert!(all.sizes.is_some() && desk.says("3 of 3"));
}

/// What all photos come to is what the export writes of "all photos", from outlines on the screen and in files alike; what is changed
/// behind it is said, and its curves take the place of a single photo's beside the sieves.
#[test]
fn all_photos_together() {
    let folder = sample();
    let file = folder.path().join("flight.toml");
    let mut desk = outlined(&file);
    desk.press(Modifiers::COMMAND, Key::S);
    // The first is in files alone, the second on the screen.
    let mut desk = Desk::new(Some(&file));
    desk.press(Modifiers::NONE, Key::ArrowDown);
    desk.click(Role::Tab, "Fragments");
    desk.click(Role::Button, "Outline this photo");
    desk.click(Role::Button, "To size distributions");
    desk.harness
        .state_mut()
        .apply(Command::Page(Page::Fragments));
    desk.settle();
    desk.click(Role::Button, "Measure all photos");
    let all = desk.open().fragments.all.as_ref().expect("measured");
    assert_eq!(all.photos, [2, 9]);
    assert!(desk.says("7 of 9 photos are not outlined, and are left out"));
    let (by_mass, intervals) = all.sizes.as_ref().expect("sizes");
    let to = folder.path().join("exported");
    let found: Vec<[Option<f64>; 3]> = intervals
        .iter()
        .map(|of| [by_mass.curve.size_at(of.percent), of.low, of.high])
        .collect();
    desk.harness
        .state_mut()
        .apply(Command::Fragments(FragmentStep::Export(to.clone().into())));
    desk.settle();
    let table = fs::read_to_string(to.join("sizes.csv")).unwrap();
    let mut rows = table.lines().filter(|line| line.starts_with("all photos,"));
    for (percent, found) in ["20", "50", "80"].iter().zip(found) {
        let row: Vec<&str> = rows.next().expect("of all photos").split(',').collect();
        assert_eq!(row[1], *percent);
        // The world counts in metres, the table in centimetres.
        let written: Vec<Option<f64>> = row[2..5].iter().map(|of| of.parse().ok()).collect();
        assert_eq!(written, found.map(|found| Some(found? * 100.0)));
        assert!(written[0].is_some(), "{row:?}");
    }

    desk.click(Role::Button, "All to size distributions");
    let sources = desk.harness.state().state().distributions.sources();
    assert_eq!(sources.len(), 1);
    assert_eq!(sources[0].set.curves.len(), 2);
    assert!(!desk.says("have changed since"));
    desk.harness
        .state_mut()
        .apply(Command::Page(Page::Fragments));
    desk.settle();
    let changed = "were changed since: measure again";
    assert!(!desk.says(changed));
    desk.press(Modifiers::NONE, Key::N);
    desk.press(Modifiers::NONE, Key::Delete);
    assert!(desk.says(changed));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(!desk.says(changed));
}

#[test]
fn the_page_as_it_looks() {
    let screen = Screen {
        size: [1200.0, 760.0],
        pixels_per_point: 1.0,
        theme: egui::Theme::Dark,
    };
    let folder = sample();
    let mut desk = Desk::drawn(Some(&folder.path().join("flight.toml")), &screen);
    desk.click(Role::Tab, "Fragments");
    desk.click(Role::Button, "Outline this photo");
    click(&mut desk, BALL);
    desk.harness.snapshot("fragments");
}
