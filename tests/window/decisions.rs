//! What the engineer decides of photos: with a note and a day, undone and done again, asked for on
//! closing, saved with the flight, and not taken for more than it was.

use std::fs;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::NodeT;
use fragscale::app::Command;
use fragscale::flight::{Along, DecisionKind, Verdict};

use crate::desk::{Desk, flight};

/// The first photo with this verdict.
fn first_with(desk: &Desk, verdict: Verdict) -> usize {
    let mut photos = desk.open().review.photos();
    let photo = photos.position(|photo| photo.verdict == verdict);
    photo.expect("the sample has one")
}

/// The sample with somebody before it, a photo that is to check selected.
fn doubting() -> (Desk, usize, String) {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let photo = first_with(&desk, Verdict::Check);
    let name = desk.open().name(photo).to_owned();
    desk.click(Role::Row, &format!("Photo {name}"));
    (desk, photo, name)
}

fn verdict(desk: &Desk, photo: usize) -> Verdict {
    desk.open().review.photo(photo).expect("a photo").verdict
}

#[test]
fn a_photo_is_accepted_with_a_note_saved_and_there_again() {
    let (mut desk, photo, name) = doubting();
    assert!(!desk.open().is_changed());
    let before = desk.open().chosen_count();
    desk.fill("Note on the photo", "measured with a tape");
    assert!(!desk.open().is_changed(), "a note alone decides nothing");
    desk.click(Role::Button, "Accept this photo");
    assert_eq!(verdict(&desk, photo), Verdict::Accepted);
    assert_eq!(desk.open().chosen_count(), before + 1);
    let now = chrono::Local::now().format("%Y-%m-%d").to_string();
    let said = format!("checked, accepted on {now}: measured with a tape");
    assert!(desk.says(&said), "{:?}", desk.texts());
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(verdict(&desk, photo), Verdict::Check);
    assert!(!desk.says("checked, accepted") && !desk.open().is_changed());
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(desk.says(&said));

    // Closing asks.
    desk.harness.state_mut().apply(Command::Close);
    desk.settle();
    assert!(desk.says("what was decided of its photos"));
    desk.click(Role::Button, "Stay here");
    let folder = tempfile::tempdir().expect("a folder");
    let saved = folder.path().join("flight.toml");
    let app = desk.harness.state_mut();
    app.apply(Command::SaveAs(saved.clone().into()));
    desk.settle();
    assert!(!desk.open().is_changed());
    let text = fs::read_to_string(&saved).expect("saved");
    let table = format!(
        "[[review]]\nphoto = \"{name}\"\ndecision = \"accepted\"\nnote = \"measured with a tape\"\ndate = \"{now}\"\nreasons = ["
    );
    assert!(text.contains(&table), "{text}");

    let mut again = Desk::new(Some(&saved));
    again.click(Role::Row, &format!("Photo {name}"));
    assert!(again.says(&said) && !again.open().is_changed());
    assert_eq!(verdict(&again, photo), Verdict::Accepted);
    // The note is changed in its place, and the decision taken back.
    again.fill("Note on the photo", "with a laser");
    assert!(again.says(&format!("accepted on {now}: with a laser")));
    again.click(Role::Button, "Take the decision back");
    assert_eq!(verdict(&again, photo), Verdict::Check);
    assert_eq!(again.open().chosen_count(), before);
}

/// The note stands beside the box: whoever ticks that means it.
#[test]
fn a_typed_note_goes_with_the_box() {
    let (mut desk, photo, name) = doubting();
    desk.fill("Note on the photo", "measured with a tape");
    desk.click(Role::Row, "Photo IMG_0001.jpg");
    desk.click(Role::CheckBox, &format!("Export {name}"));
    let decided = desk.open().settings().decisions;
    let [decision] = &decided[..] else {
        panic!("{decided:?}");
    };
    assert_eq!(
        (&decision.photo, &*decision.note),
        (&name, "measured with a tape")
    );
    assert_eq!(verdict(&desk, photo), Verdict::Accepted);
}

/// Undone and done again, a decision comes back without the note that was typed meanwhile: leaving asks, and saving
/// takes it.
#[test]
fn a_note_that_was_typed_between_undo_and_redo_is_saved() {
    let (mut desk, photo, name) = doubting();
    desk.click(Role::Button, "Leave this photo out");
    let folder = tempfile::tempdir().expect("a folder");
    let saved = folder.path().join("flight.toml");
    let save = |desk: &mut Desk| {
        let save = Command::SaveAs(saved.clone().into());
        desk.harness.state_mut().apply(save);
        desk.settle();
        fs::read_to_string(&saved).expect("saved")
    };
    save(&mut desk);
    desk.press(Modifiers::COMMAND, Key::Z);
    desk.fill("Note on the photo", "in the shade");
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(verdict(&desk, photo), Verdict::LeftOut);
    assert!(!desk.open().is_changed());
    desk.harness.state_mut().apply(Command::Close);
    desk.settle();
    assert!(desk.says("what was decided of its photos"));
    desk.click(Role::Button, "Stay here");
    // The same on the way to a file.
    for _ in 0..2 {
        desk.press(Modifiers::COMMAND, Key::Z);
    }
    desk.fill("Note on the photo", "in the sun");
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    let text = save(&mut desk);
    assert!(text.contains("note = \"in the sun\""), "{text}");
    assert!(!desk.open().is_changed() && !desk.logged("is kept with a decision only"));

    // Without a decision it is in no file, which is said.
    desk.click(Role::Button, "Take the decision back");
    desk.fill("Note on the photo", "perhaps");
    let text = save(&mut desk);
    assert!(!text.contains("perhaps"), "{text}");
    let said =
        format!("a note on {name} is kept with a decision only: accept the photo or leave it out");
    assert!(desk.logged(&said) && desk.says(&said));
}

/// What was undone is no news any more once something else is decided.
#[test]
fn a_new_step_puts_the_word_of_the_undone_one_away() {
    let (mut desk, _, _) = doubting();
    let said = "undone: what was decided of photos";
    desk.click(Role::Button, "Leave this photo out");
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(desk.says(said), "{:?}", desk.texts());
    desk.click(Role::Button, "Accept this photo");
    assert!(!desk.says(said) && desk.logged(said));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert!(desk.says(said));
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(desk.says("done again: what was decided of photos"));
}

#[test]
fn a_trusted_photo_is_left_out_by_its_box_and_by_its_button() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let photo = first_with(&desk, Verdict::Trust);
    let name = desk.open().name(photo).to_owned();
    desk.click(Role::CheckBox, &format!("Export {name}"));
    assert_eq!(verdict(&desk, photo), Verdict::LeftOut);
    let along = |desk: &Desk| desk.open().review.going_along(Along::Trusted)[photo];
    assert!(!along(&desk));
    desk.click(Role::CheckBox, &format!("Export {name}"));
    assert!(
        along(&desk) && !desk.open().is_changed(),
        "nothing is decided"
    );
    desk.click(Role::Row, &format!("Photo {name}"));
    desk.click(Role::Button, "Leave this photo out");
    assert!(!along(&desk) && desk.says("left out on "));
    // The filter of those photos is there now.
    desk.click(Role::Button, "Only photos: left out");
    assert_eq!(desk.photos(), [name]);
}

/// Nobody accepts a scale that is none: not by a button, nor by the box or a key.
#[test]
fn a_photo_without_a_scale_is_not_accepted() {
    let (mut desk, photo, name) = doubting();
    let mut settings = desk.open().settings();
    // Shorter than the cloud's points are apart: no photo shows enough of the surface.
    settings.surface.max_edge = Some(0.001);
    desk.harness.state_mut().apply(Command::Set(settings));
    desk.settle();
    assert_eq!(verdict(&desk, photo), Verdict::NoScale);
    let is_grey = |desk: &Desk, role: Role, label: &str| {
        let node = desk.node(role, label);
        node.accesskit_node().is_disabled()
    };
    let export = format!("Export {name}");
    assert!(is_grey(&desk, Role::Button, "Accept this photo"));
    assert!(is_grey(&desk, Role::CheckBox, &export));
    desk.press(Modifiers::NONE, Key::Space);
    desk.press(Modifiers::NONE, Key::N);
    assert!(is_grey(&desk, Role::Button, "Accept the reviewed photo"));
    desk.press(Modifiers::NONE, Key::Enter);
    let accept = Some((DecisionKind::Accepted, String::new()));
    let app = desk.harness.state_mut();
    app.apply(Command::Decide(photo, accept));
    app.apply(Command::Choose(photo, true));
    desk.settle();
    assert!(desk.logged("A photo without a scale is not accepted"));
    assert!(desk.open().settings().decisions.is_empty());
    assert_eq!(desk.open().chosen_count(), 0);
}

/// The surface is another one after this change of its options.
#[test]
fn what_was_accepted_for_other_reasons_is_asked_again() {
    let (mut desk, photo, _) = doubting();
    desk.click(Role::Button, "Accept this photo");
    let doubts = |desk: &Desk| {
        desk.open()
            .review
            .photo(photo)
            .expect("a photo")
            .doubts
            .to_vec()
    };
    let before = doubts(&desk);
    let mut settings = desk.open().settings();
    // Shorter than the hole in the cloud is wide: two corners lie over no surface at all.
    settings.surface.max_edge = Some(0.03);
    desk.harness.state_mut().apply(Command::Set(settings));
    desk.settle();
    assert_ne!(doubts(&desk), before);
    assert_ne!(verdict(&desk, photo), Verdict::Accepted);
    assert!(!desk.open().review.going_along(Along::Trusted)[photo]);
    assert!(
        desk.says("It was accepted for other reasons"),
        "{:?}",
        desk.texts()
    );
    desk.click(Role::Button, "Accept this photo");
    assert!(!desk.says("It was accepted for other reasons"));
    assert!(desk.open().review.going_along(Along::Trusted)[photo]);
    // Back to the surface of before: fewer reasons than were seen.
    let decided = desk.open().settings().decisions;
    let mut settings = desk.open().settings();
    settings.surface.max_edge = None;
    desk.harness.state_mut().apply(Command::Set(settings));
    desk.settle();
    assert_eq!(decided[0].kind, DecisionKind::Accepted);
    let covered = decided[0].covers(&doubts(&desk));
    assert_eq!(verdict(&desk, photo) == Verdict::Accepted, covered);
}
