//! The review of doubtful photos: keys alone, one after the other, each with what shows its reason; what
//! is decided is undone and done again, and after the last the export is one click.

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, Theme};
use egui_kittest::kittest::NodeT;
use fragscale::app::Command;
use fragscale::app::command::Tab;
use fragscale::app::open_flight::tracing::Trace;
use fragscale::flight::{Along, DecisionKind, Doubt, InView, Limits, OnPhoto, Verdict};
use fragscale::scale::ScaleObjectKind;

use crate::desk::{Desk, Screen, flight};

const NONE: Modifiers = Modifiers::NONE;

/// The sample under limits that doubt every photo for its view, and some for more.
fn strict() -> Limits {
    Limits {
        flattest_angle: 80.0,
        ..Limits::default()
    }
}

fn decision(desk: &Desk, photo: usize) -> Option<DecisionKind> {
    let photo = desk.open().review.photo(photo).expect("a photo");
    photo.decision.map(|decision| decision.kind)
}

fn doubtful(desk: &Desk) -> Vec<usize> {
    desk.open().table.doubtful.clone()
}

#[test]
fn doubtful_photos_are_reviewed_with_keys_alone() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.harness.state_mut().apply(Command::Limits(strict()));
    desk.settle();
    let photos = doubtful(&desk);
    let count = photos.len();
    assert!(count >= 4, "{photos:?}");
    desk.press(NONE, Key::N);
    assert_eq!(desk.harness.state().state().tab, Tab::Review);
    assert_eq!(desk.open().selected, Some(photos[0]));
    assert!(desk.says(&format!("1 of {count}")), "{:?}", desk.texts());

    // Accepted with a note, all by keys: the letter of the key comes as a text, too, in the same frame.
    let pressed = Event::Key {
        key: Key::W,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: NONE,
    };
    let events = &mut desk.harness.input_mut().events;
    events.extend([pressed, Event::Text("w".to_owned())]);
    desk.settle();
    desk.harness.event(Event::Text("level toe".to_owned()));
    desk.settle();
    desk.press(NONE, Key::Enter);
    assert_eq!(decision(&desk, photos[0]), Some(DecisionKind::Accepted));
    let noted = desk.open().settings().decisions[0].note.clone();
    assert_eq!(noted, "level toe");
    assert_eq!(desk.open().selected, Some(photos[1]));
    assert!(desk.says(&format!("2 of {count}")));
    assert!(desk.says(&format!("{} to decide, 1 accepted, 0 left out", count - 1)));

    // Left out without a note: that of the photo before is not taken for this one's.
    desk.press(NONE, Key::Delete);
    assert_eq!(decision(&desk, photos[1]), Some(DecisionKind::LeftOut));
    assert_eq!(desk.open().settings().decisions[1].note, "");
    assert_eq!(desk.open().selected, Some(photos[2]));

    // Undone, which brings the photo back, and done again.
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(decision(&desk, photos[1]), None);
    assert_eq!(desk.open().selected, Some(photos[1]));
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(decision(&desk, photos[1]), Some(DecisionKind::LeftOut));

    // N goes to those that wait, Shift+N back to any.
    desk.press(NONE, Key::N);
    assert_eq!(desk.open().selected, Some(photos[2]));
    desk.press(Modifiers::SHIFT, Key::N);
    assert_eq!(desk.open().selected, Some(photos[1]));
    desk.press(NONE, Key::N);

    assert!(!desk.shows(Role::Button, "Export what was reviewed"));
    for _ in 2..count {
        desk.press(NONE, Key::Enter);
    }
    assert_eq!(desk.open().review_progress().waiting, 0);
    assert!(desk.says("All doubtful photos are decided."));
    let along = desk.open().review.going_along(Along::Trusted);
    assert!(!along[photos[1]] && along[photos[0]]);
    desk.click(Role::Button, "Export what was reviewed");
    assert!(desk.shows(Role::Button, "Export now"), "one click");
    desk.press(NONE, Key::Escape);
    assert_eq!(
        desk.harness.state().state().tab,
        Tab::Review,
        "it closed the window"
    );
    desk.press(NONE, Key::Escape);
    assert_eq!(desk.harness.state().state().tab, Tab::Photo);
    // Outside of the review nothing is accepted by a key.
    let before = desk.open().settings();
    desk.press(NONE, Key::Enter);
    assert_eq!(desk.open().settings(), before);
}

/// Trusted photos, too: in the review, whose arrows go through all of them, and beside it.
#[test]
fn delete_leaves_any_selected_photo_out() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.press(NONE, Key::N);
    desk.press(NONE, Key::ArrowUp);
    let (photo, reviewed) = desk.open().selected_review().expect("a photo");
    assert!(!reviewed.is_doubtful());
    desk.press(NONE, Key::Enter);
    assert_eq!(decision(&desk, photo), None, "nothing is to be accepted");
    desk.press(NONE, Key::Delete);
    assert_eq!(decision(&desk, photo), Some(DecisionKind::LeftOut));
    assert_eq!(desk.open().selected, Some(photo), "arrows go on from here");
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(decision(&desk, photo), None);

    desk.click(Role::Tab, "Photo");
    desk.fill("Note on the photo", "blurred");
    desk.press(NONE, Key::Delete);
    assert_eq!(decision(&desk, photo), Some(DecisionKind::LeftOut));
    assert_eq!(note(&desk, photo).as_deref(), Some("blurred"));
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(decision(&desk, photo), None);

    // While an outline is traced the key could be meant for its last point.
    let bar = ScaleObjectKind::Bar;
    for step in [Trace::Size(bar, 0.25), Trace::Begin(bar)] {
        desk.harness.state_mut().apply(Command::Trace(step));
    }
    desk.settle();
    desk.press(NONE, Key::Delete);
    assert_eq!(decision(&desk, photo), None);
    desk.press(NONE, Key::Escape);

    desk.press(NONE, Key::F1);
    for said in [
        "Leave the selected photo out",
        "Leave this photo out of the export, or take it along",
    ] {
        assert!(desk.says(said), "{said}");
    }
}

/// Its decision is shown, noted and taken back in the review as that of a doubtful one is.
#[test]
fn a_trusted_photo_that_was_left_out_is_reviewed() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    // The page begins with a doubtful photo.
    desk.click(Role::Tab, "Review");
    desk.click(Role::Row, "Photo IMG_0001.jpg");
    desk.press(NONE, Key::Space);
    assert!(
        desk.says("Nothing speaks against the selected photo."),
        "{:?}",
        desk.texts()
    );
    assert!(desk.says("left out on "), "{:?}", desk.texts());
    desk.fill("Note of the review", "blurred");
    // Enter in the note keeps what was decided: there is nothing to accept.
    assert_eq!(decision(&desk, 0), Some(DecisionKind::LeftOut));
    assert_eq!(note(&desk, 0).as_deref(), Some("blurred"));
    assert_eq!(desk.open().selected, Some(0));
    desk.click(Role::Button, "Take the decision back");
    assert_eq!(decision(&desk, 0), None);
    let accept = desk.node(Role::Button, "Accept the reviewed photo");
    assert!(accept.accesskit_node().is_disabled());
}

fn note(desk: &Desk, photo: usize) -> Option<String> {
    let photo = desk.open().review.photo(photo).expect("a photo");
    photo.decision.map(|decision| decision.note.clone())
}

/// Types a note in the stead of what is in the field, and stays in it.
fn type_note(desk: &mut Desk, text: &str) {
    desk.press(NONE, Key::W);
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    desk.harness.event(Event::Text(text.to_owned()));
    desk.settle();
}

/// What was typed of a photo waits for its decision while others are looked at; a decision that is there has it at once, as
/// a step that can be undone.
#[test]
fn a_half_typed_note_is_not_lost() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.harness.state_mut().apply(Command::Limits(strict()));
    desk.settle();
    desk.press(NONE, Key::N);
    let photos = doubtful(&desk);
    let shown = |desk: &Desk| {
        let field = desk.node(Role::TextInput, "Note of the review");
        field.value().unwrap_or_default()
    };
    type_note(&mut desk, "level toe");
    desk.click(Role::Button, "Next doubtful photo");
    assert_eq!(desk.open().selected, Some(photos[1]));
    assert_eq!(shown(&desk), "", "of the photo before");
    desk.press(Modifiers::SHIFT, Key::N);
    assert_eq!(desk.open().selected, Some(photos[0]));
    assert_eq!(shown(&desk), "level toe");
    assert!(!desk.open().is_changed(), "a note alone decides nothing");
    desk.click(Role::Button, "Accept the reviewed photo");
    assert_eq!(note(&desk, photos[0]).as_deref(), Some("level toe"));

    desk.press(Modifiers::SHIFT, Key::N);
    assert_eq!(desk.open().selected, Some(photos[0]));
    type_note(&mut desk, "steep toe");
    let other = format!("Photo {}", desk.open().name(photos[2]));
    desk.click(Role::Row, &other);
    assert_eq!(desk.open().selected, Some(photos[2]));
    assert_eq!(note(&desk, photos[0]).as_deref(), Some("steep toe"));
    assert_eq!(shown(&desk), "");
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(note(&desk, photos[0]).as_deref(), Some("level toe"));
    assert_eq!(decision(&desk, photos[0]), Some(DecisionKind::Accepted));
}

/// A trusted photo that was left out counts in the review as in the tool bar.
#[test]
fn what_is_left_out_counts_alike_in_tool_bar_and_review() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.click(Role::Row, "Photo IMG_0001.jpg");
    desk.press(NONE, Key::Space);
    desk.press(NONE, Key::N);
    assert_eq!(desk.open().review.count_of(Verdict::LeftOut), 1);
    let said = "1 to decide, 0 accepted, 1 left out";
    assert!(desk.says(said), "{:?}", desk.texts());
}

/// A photo that she has accepted stays one of those when nothing speaks against it any more.
#[test]
fn an_accepted_photo_that_is_trusted_now_counts_as_accepted() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.harness.state_mut().apply(Command::Limits(strict()));
    desk.settle();
    // Under the usual limits nothing speaks against it.
    desk.click(Role::Tab, "Review");
    desk.click(Role::Row, "Photo IMG_0001.jpg");
    desk.click(Role::Button, "Accept the reviewed photo");
    assert_eq!(decision(&desk, 0), Some(DecisionKind::Accepted));
    assert_eq!(desk.open().review.count_of(Verdict::Accepted), 1);
    let usual = Command::Limits(Limits::default());
    desk.harness.state_mut().apply(usual);
    desk.settle();
    assert_eq!(desk.open().review.count_of(Verdict::Accepted), 0);
    // More than in the tool bar, which is explained.
    let texts = desk.texts();
    let mut counts = texts
        .iter()
        .filter(|(text, _)| text.ends_with("1 accepted, 0 left out"));
    let (_, place) = counts.next().expect("the counts");
    desk.harness.hover_at(place.center() - egui::vec2(2.0, 0.0));
    desk.harness.step();
    desk.harness.hover_at(place.center());
    for _ in 0..60 {
        desk.harness.step();
    }
    let why = "1 of the accepted photos counts as trusted in the tool bar";
    assert!(desk.says(why), "{:?}", desk.texts());
}

/// The corner that is meant is in the middle of the view, and near: the rest of the pile is not.
#[test]
fn the_view_goes_to_the_corner_that_is_meant() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let limits = Limits {
        triangle_share: 0.001,
        ..Limits::default()
    };
    desk.harness.state_mut().apply(Command::Limits(limits));
    desk.settle();
    desk.press(NONE, Key::N);
    let (_, photo) = desk.open().selected_review().expect("a photo");
    let is_of_corner = |doubt: &Doubt| matches!(doubt, Doubt::LongTriangle { .. });
    let place = photo.doubts.iter().position(is_of_corner).expect("a hole");
    let Doubt::LongTriangle { corners, .. } = &photo.doubts[place] else {
        panic!("another reason");
    };
    let corners = corners.clone();
    let scale = photo.scale().expect("a scale");
    let points = scale.corners.iter().filter(|c| corners.contains(&c.name));
    let points: Vec<glam::DVec3> = points.filter_map(|corner| corner.point()).collect();
    if place > 0 {
        let said = format!("Show: {}", photo.doubts[place]);
        desk.click(Role::Button, &said);
    }
    let sight = desk.open().sight().expect("a sight");
    assert_eq!(sight.on_photo, OnPhoto::Corners(corners.clone()));
    assert_eq!(sight.in_view, InView::Corners(corners));
    let looking = desk.open().looking;
    let size = looking.size.expect("a viewport");
    for point in points {
        let pixel = looking
            .orbit
            .view()
            .project(point, size)
            .expect("before the eye");
        assert!(
            pixel.cmpge(glam::DVec2::ZERO).all() && pixel.cmple(size).all(),
            "{pixel} in {size}"
        );
    }
}

#[test]
fn a_review_of_the_paper_s_lab() {
    let screen = Screen {
        size: [1000.0, 520.0],
        pixels_per_point: 1.0,
        theme: Theme::Dark,
    };
    let mut desk = Desk::drawn(Some(&flight("assets/sample")), &screen);
    desk.press(NONE, Key::N);
    desk.harness.remove_cursor();
    desk.settle();
    desk.harness.snapshot("window_review");
}

/// Rows under the right mouse button, and the filter of doubtful photos.
#[test]
fn a_row_has_a_menu_and_doubtful_rows_stand_alone() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let count = desk.open().review.count();
    desk.click(Role::Button, "Only doubtful photos");
    assert_eq!(desk.open().table.shown, doubtful(&desk));
    assert!(desk.photos().len() < count);
    desk.click(Role::Button, "Only doubtful photos");
    let name = desk.open().name(2).to_owned();
    let row = format!("Photo {name}");
    let open_menu = |desk: &mut Desk| {
        desk.node(Role::Row, &row).click_secondary();
        desk.settle();
    };
    open_menu(&mut desk);
    desk.click(Role::Button, "Leave out");
    assert_eq!(decision(&desk, 2), Some(DecisionKind::LeftOut));
    open_menu(&mut desk);
    desk.click(Role::Button, "Take the decision back");
    assert_eq!(decision(&desk, 2), None);
    open_menu(&mut desk);
    desk.click(Role::Button, "Go to");
    assert_eq!(desk.open().selected, Some(2));
    open_menu(&mut desk);
    desk.node(Role::Button, "Copy file name").click();
    let copied = (0..3).find_map(|_| {
        desk.harness.step();
        desk.copied()
    });
    assert_eq!(copied, Some(name));
}

/// The scale's error as the size's, in the review and beside the number that is typed.
#[test]
fn what_the_error_does_to_a_size_is_said() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.press(NONE, Key::N);
    let unit = desk.harness.state().state().preferences.unit();
    let (_, photo) = desk.open().selected_review().expect("a photo");
    let [top, _] = photo.estimates(photo.pair, unit);
    let top = top.expect("a scale");
    let error = top.size_error().expect("an interval");
    // Numbers and intervals stand on one line: with blanks that do not break.
    let normal = |text: &str| text.replace('\u{a0}', " ");
    let says = |desk: &Desk, said: &str| desk.texts().iter().any(|(text, _)| normal(text) == said);
    let said = format!("top {} px/{unit}: P80 {error}", top.text(5));
    assert!(says(&desk, &said), "{:?}", desk.texts());
    desk.press(NONE, Key::Escape);
    assert!(says(&desk, &format!("P80 {error}")));
}

/// W brings the cursor into the note on a photo's own panel as in the review: what was typed went to the shortcuts.
#[test]
fn a_note_is_typed_on_the_photos_own_panel_too() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.click(Role::Tab, "Photo");
    desk.press(NONE, Key::W);
    desk.harness.event(Event::Text("blurred".to_owned()));
    desk.settle();
    desk.press(NONE, Key::Enter);
    desk.press(NONE, Key::Delete);
    let open = desk.open();
    let photo = open.review.photo(open.selected.expect("a photo"));
    let decision = photo.expect("a photo").decision.cloned();
    assert_eq!(decision.expect("a decision").note, "blurred");
}
