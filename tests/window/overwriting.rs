//! What was read for what is on the screen is not written over, whatever is typed or answered; a file of
//! somebody else's goes only when she says so.

use std::fs;
use std::path::Path;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use fragscale::app::Command;
use fragscale::app::command::PictureRequest;
use fragscale::app::command::{Asking, Choice};
use fragscale::app::size_distributions::{DistributionCommand, Page};

use crate::desk::{Desk, copy, copy_files, flight};
use crate::own_frame::{model, positions};

const NO: &str = "never written over";

fn apply(desk: &mut Desk, command: Command) {
    desk.harness.state_mut().apply(command);
    desk.settle();
}

/// Says so, asks nothing, and leaves the file as it was.
#[track_caller]
fn refused(desk: &mut Desk, command: Command, path: &Path, words: &str) {
    let before = fs::read(path).expect("the file");
    desk.harness.state_mut().apply(Command::DismissNotice);
    apply(desk, command);
    let state = desk.harness.state().state();
    let said = state.notice.as_ref().map(|line| line.text.clone());
    let said = said.unwrap_or_default();
    assert!(said.contains(words), "{}: {said:?}", path.display());
    assert!(state.held_back.is_none());
    assert_eq!(fs::read(path).expect("the file"), before);
}

fn picture(path: &Path) -> Command {
    Command::Picture(PictureRequest {
        to: path.to_owned().into(),
        size: [64, 48],
        transparent: false,
        corner_rays: false,
    })
}

#[test]
fn a_flight_is_saved_over_no_file_that_it_was_read_from() {
    let folder = copy("tests/windrow");
    let at = |name: &str| folder.path().join(name);
    let text = fs::read_to_string(at("flight.toml")).expect("the flight");
    let text = text.replace("ground = \"auto\"", "ground = 0.25");
    fs::write(at("flight.toml"), text).expect("written");
    fs::hard_link(at("pile.ply"), at("hard.toml")).expect("a link");
    // Here from the beginning: a new file may get the number of the flight.toml that saving replaces.
    fs::write(at("second.toml"), "mine").expect("written");
    let mut names = vec![at("pile.ply"), at("poses.csv"), at("ost.yaml")];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("poses.csv", at("soft.toml")).expect("a link");
        names.extend([at("soft.toml"), at("hard.toml")]);
    }
    let mut desk = Desk::new(Some(folder.path()));
    for name in &names {
        refused(&mut desk, Command::SaveAs(name.clone().into()), name, NO);
        refused(&mut desk, picture(name), name, NO);
        let report = DistributionCommand::SaveReport(name.clone().into());
        apply(&mut desk, Command::Distributions(report));
        assert!(desk.harness.state().state().held_back.is_none());
    }
    refused(
        &mut desk,
        picture(&at("flight.toml")),
        &at("flight.toml"),
        NO,
    );

    // Where it was opened it is saved, without a question.
    desk.click(Role::Tab, "Flight");
    desk.fill("Ground elevation", "0.5");
    desk.press(Modifiers::COMMAND, Key::S);
    let text = fs::read_to_string(at("flight.toml")).expect("the flight");
    assert!(text.contains("ground = 0.5"), "{text}");
    // Over another's flight when she says so.
    apply(&mut desk, Command::SaveAs(at("second.toml").into()));
    assert!(desk.says("It is no flight file that fragscale wrote"));
    desk.click(Role::Button, "Keep the file");
    assert_eq!(fs::read(at("second.toml")).expect("a file"), b"mine");
    apply(&mut desk, Command::SaveAs(at("second.toml").into()));
    desk.click(Role::Button, "Replace it");
    let text = fs::read_to_string(at("second.toml")).expect("the flight");
    assert!(text.contains("ground = 0.5"), "{text}");
    // Now it is of that file, and goes back to where it came from when she says so.
    refused(
        &mut desk,
        picture(&at("second.toml")),
        &at("second.toml"),
        NO,
    );
    apply(&mut desk, Command::SaveAs(at("flight.toml").into()));
    assert!(desk.says("There is a file already"));
    desk.click(Role::Button, "Replace it");
    assert!(desk.logged("flight.toml: saved"));
}

/// What another window or an editor has changed meanwhile goes only when she says so.
#[test]
fn a_flight_that_others_changed_is_asked_for() {
    let folder = copy("tests/windrow");
    let own = folder.path().join("flight.toml");
    let text = fs::read_to_string(&own).expect("the flight");
    let text = text.replace("ground = \"auto\"", "ground = 0.125");
    fs::write(&own, text).expect("written");
    let mut desk = Desk::new(Some(folder.path()));
    let change = |desk: &mut Desk, ground: &str| {
        desk.click(Role::Tab, "Flight");
        desk.fill("Ground elevation", ground);
        desk.press(Modifiers::COMMAND, Key::S);
    };
    let by_others = |text: &str| {
        let before = fs::read_to_string(&own).expect("the flight");
        fs::write(&own, before + text).expect("written");
    };
    change(&mut desk, "0.5");
    assert!(desk.logged("flight.toml: saved"));
    // Its own save is nobody else's.
    change(&mut desk, "0.25");
    assert!(desk.harness.state().state().held_back.is_none());
    by_others("\n[[review]]\nphoto = \"a.jpg\"\ndecision = \"left-out\"\n");
    change(&mut desk, "0.75");
    assert!(
        desk.says("was changed since it was read here"),
        "{:?}",
        desk.texts()
    );
    desk.click(Role::Button, "Keep the file");
    let text = fs::read_to_string(&own).expect("the flight");
    assert!(
        text.contains("left-out") && text.contains("ground = 0.25"),
        "{text}"
    );
    desk.press(Modifiers::COMMAND, Key::S);
    desk.click(Role::Button, "Replace it");
    let text = fs::read_to_string(&own).expect("the flight");
    assert!(text.contains("ground = 0.75"), "{text}");
    assert!(!desk.harness.state().state().is_changed());
}

/// A path into a folder that is not there is mended where it was typed.
#[test]
fn a_missing_folder_is_said_where_the_path_is_typed() {
    let folder = copy("tests/windrow");
    let mut desk = Desk::new(Some(folder.path()));
    let path = folder.path().join("new/saved.toml");
    apply(&mut desk, Command::Ask(Some(Asking::SaveAs)));
    desk.type_path(&path);
    desk.press(Modifiers::NONE, Key::Enter);
    assert!(desk.says("there is no folder"));
    fs::create_dir(folder.path().join("new")).expect("a folder");
    // The field has the keys again.
    desk.press(Modifiers::NONE, Key::Enter);
    assert!(desk.logged("saved.toml: saved"));
    assert!(path.is_file() && !desk.says("there is no folder"));
}

/// The folder of a reconstruction is read as a whole; a flight.toml in it is saved all the same.
#[test]
fn a_flight_in_the_folder_of_its_reconstruction_is_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    model(folder.path());
    let own = folder.path().join("saved.toml");
    let text = "format = 1\n[world]\nunit = \"m\"\nground = 11\n[photos]\nreconstruction = \".\"\n";
    fs::write(&own, text).expect("written");
    let mut desk = Desk::new(Some(&own));
    desk.click(Role::Tab, "Flight");
    desk.fill("Ground elevation", "12");
    desk.press(Modifiers::COMMAND, Key::S);
    let text = fs::read_to_string(&own).expect("the flight");
    assert!(text.contains("ground = 12"), "{text}");
    let images = folder.path().join("images.txt");
    refused(&mut desk, picture(&images), &images, "read");
}

#[test]
fn the_bundled_flight_stays_as_it_came() {
    let sample = flight("assets/sample");
    let mut desk = Desk::new(Some(&sample));
    let own = sample.join("flight.toml");
    refused(&mut desk, Command::SaveAs(own.clone().into()), &own, NO);
    let photo = sample.join("photos/IMG_0004.jpg");
    refused(&mut desk, picture(&photo), &photo, NO);
    refused(&mut desk, Command::SaveAs(photo.clone().into()), &photo, NO);
}

/// As the command refuses it, and before anything is written.
#[test]
fn nothing_is_exported_among_the_flights_photos() {
    let flight = copy("assets/sample");
    let photos = flight.path().join("photos");
    copy_files("assets/sample/photos", &photos);
    let count = || fs::read_dir(&photos).expect("a folder").count();
    let before = count();
    let mut desk = Desk::new(Some(flight.path()));
    apply(&mut desk, Command::ChooseAll(Choice::WithScale));
    for to in [&photos, &flight.path().to_owned()] {
        apply(&mut desk, Command::Export(to.clone().into()));
    }
    let log = &desk.harness.state().state().log;
    let texts = log.iter().map(|line| line.text.as_str());
    let refused = texts.filter(|text| text.contains("photos: the flight's photos lie in it"));
    assert_eq!(refused.count(), 2, "{log:?}");
    assert_eq!(count(), before);
    assert!(!flight.path().join("scales.html").exists());
}

#[test]
fn an_export_into_another_flights_folder_is_asked_for() {
    let (first, second) = (copy("tests/windrow"), copy("tests/windrow"));
    let out = first.path().join("out");
    let mut desk = Desk::new(Some(first.path()));
    apply(&mut desk, Command::ChooseAll(Choice::WithScale));
    apply(&mut desk, Command::Export(out.clone().into()));
    assert!(
        desk.logged("open scales.html"),
        "{:?}",
        desk.harness.state().state().log
    );
    let list = || fs::read_to_string(out.join("export.json")).expect("the list");
    let before = list();
    // Its own again, without a question.
    apply(&mut desk, Command::Export(out.clone().into()));
    assert!(desk.harness.state().state().held_back.is_none());

    apply(&mut desk, Command::Save);
    apply(&mut desk, Command::Open(second.path().to_owned()));
    apply(&mut desk, Command::ChooseAll(Choice::WithScale));
    apply(&mut desk, Command::Export(out.clone().into()));
    assert!(desk.says("holds the export of another flight, 'Windrow'"));
    desk.click(Role::Button, "Keep the export");
    assert_eq!(list(), before);
    apply(&mut desk, Command::Export(out.clone().into()));
    desk.click(Role::Button, "Replace it");
    assert_ne!(list(), before);
    // Her yes was for that export, not for what somebody else put there.
    fs::write(out.join("scales.csv"), "mine").expect("written");
    apply(&mut desk, Command::Export(out.clone().into()));
    assert!(desk.logged("was changed since it was exported"));
    assert_eq!(fs::read(out.join("scales.csv")).expect("a file"), b"mine");
}

#[test]
fn a_georeferenced_flight_is_saved_over_no_list_that_it_was_fitted_to() {
    let folder = tempfile::tempdir().expect("a folder");
    let package = folder.path().join("model");
    fs::create_dir(&package).expect("a folder");
    model(&package);
    let list = folder.path().join("list.csv");
    fs::write(&list, positions()).expect("written");
    let mut desk = Desk::new(Some(&package));
    desk.click(Role::Button, "File");
    desk.click(Role::Button, "Georeference…");
    desk.click(Role::RadioButton, "List of positions");
    desk.fill("File of the positions", list.to_str().expect("UTF-8"));
    desk.fill("Coordinate system", "EPSG:32632");
    desk.click(Role::Button, "Fit to what is known");
    let save = |path: &Path| Command::SaveGeoreferenced {
        to: path.to_owned().into(),
        keep_surface: false,
    };
    refused(&mut desk, save(&list), &list, NO);
    let images = package.join("images.txt");
    refused(&mut desk, save(&images), &images, "read");
}

#[test]
fn a_figure_takes_the_place_of_no_table_that_was_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let table = folder.path().join("sizes.csv");
    let text = "method,size_mm,percent_passing\nsieve,10,5\nsieve,20,30\nsieve,40,70\nsieve,80,99\n\
                cloud,10,6\ncloud,20,33\ncloud,40,74\ncloud,80,99.5\n";
    fs::write(&table, text).expect("written");
    let times = folder.path().join("times.csv");
    fs::write(&times, "step,object,cloud\nflight,12,10\nspheres,3,0\n").expect("written");
    let mut desk = Desk::new(None);
    apply(&mut desk, Command::Page(Page::SizeDistributions));
    let add = DistributionCommand::Add(vec![table.clone()]);
    apply(&mut desk, Command::Distributions(add));
    let add = DistributionCommand::AddEffort(times.clone());
    apply(&mut desk, Command::Distributions(add));
    for path in [&table, &times] {
        let figure = DistributionCommand::SaveFigure(path.clone().into());
        refused(&mut desk, Command::Distributions(figure), path, NO);
        let report = DistributionCommand::SaveReport(path.clone().into());
        refused(&mut desk, Command::Distributions(report), path, NO);
    }
    // A figure over a figure: she is asked, and told whose it is.
    let figure = folder.path().join("a.svg");
    let save = || Command::Distributions(DistributionCommand::SaveFigure(figure.clone().into()));
    apply(&mut desk, save());
    apply(&mut desk, save());
    assert!(desk.says("fragscale wrote it"));
    desk.click(Role::Button, "Keep the file");
}
