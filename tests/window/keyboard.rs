//! By the keyboard alone, and what a screen reader is told, as a newcomer without a mouse found it.

use egui::accesskit::{Live, Role};
use egui::{Key, Modifiers, Rect};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use fragscale::app::App;
use fragscale::app::command::{Asking, Command, Tab};
use fragscale::app::size_distributions::Page;
use fragscale::flight::Verdict;

use crate::desk::{Desk, flight};

const REDO: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// A small window with the bundled flight.
fn small() -> Desk {
    let path = flight("assets/sample");
    let harness = Harness::builder()
        .with_size([900.0, 600.0])
        .with_max_steps(30)
        .build_eframe(|context| App::new(context, vec![path]));
    let mut desk = Desk { harness };
    desk.settle();
    desk
}

fn focused(desk: &Desk) -> Option<(String, Rect)> {
    let id = desk.harness.ctx.memory(|memory| memory.focused())?;
    let part = desk.harness.ctx.read_response(id)?;
    let all = desk.harness.query_all(egui_kittest::kittest::By::new());
    let name = all
        .filter(|node| node.accesskit_node().is_focused())
        .find_map(|node| node.accesskit_node().label());
    Some((name.unwrap_or_default(), part.rect))
}

/// Ctrl+Shift+Z with nothing to do again took back what was done: egui takes Ctrl+Z for a part of it.
#[test]
fn redo_never_undoes() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let count = |desk: &Desk| {
        let photos = desk.open().review.photos();
        photos
            .filter(|photo| photo.verdict == Verdict::LeftOut)
            .count()
    };
    desk.press(Modifiers::NONE, Key::ArrowDown);
    desk.press(Modifiers::NONE, Key::Space);
    let decided = desk.open().settings().decisions.len();
    assert!(decided > 0);
    let left_out = count(&desk);
    for keys in [(REDO, Key::Z), (Modifiers::COMMAND, Key::Y)] {
        desk.press(keys.0, keys.1);
        assert_eq!(desk.open().settings().decisions.len(), decided);
        assert_eq!(count(&desk), left_out);
    }
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(desk.open().settings().decisions.len(), decided - 1);
    desk.press(REDO, Key::Z);
    assert_eq!(desk.open().settings().decisions.len(), decided);
}

/// What Tab comes to in a page that is longer than its panel comes into sight.
#[test]
fn what_has_the_focus_is_in_sight() {
    let mut desk = small();
    desk.harness.state_mut().apply(Command::Tab(Tab::Limits));
    desk.settle();
    let foot = desk.harness.ctx.content_rect().bottom();
    let last = "The 95 % interval of a scale is wider than";
    let mut came = false;
    for _ in 0..250 {
        desk.press(Modifiers::NONE, Key::Tab);
        let Some((name, place)) = focused(&desk) else {
            continue;
        };
        assert!(place.bottom() <= foot + 1.0, "{name}: {place}");
        if name.starts_with(last) {
            came = true;
            break;
        }
    }
    assert!(came);
}

/// Frames of two points' width: of what has the focus, and of nothing once the mouse was used.
#[test]
fn the_focus_is_seen() {
    let mut desk = small();
    let frames = |desk: &Desk| -> Vec<Rect> {
        let shapes = desk.harness.output().shapes.iter();
        let frames = shapes.filter_map(|clipped| match &clipped.shape {
            egui::Shape::Rect(frame) if frame.stroke.width == 2.0 => Some(frame.rect),
            _ => None,
        });
        frames.collect()
    };
    assert_eq!(frames(&desk), []);
    for _ in 0..12 {
        desk.press(Modifiers::NONE, Key::Tab);
        let (name, place) = focused(&desk).expect("a part");
        let frames = frames(&desk);
        assert!(
            frames.iter().any(|frame| frame.contains_rect(place)),
            "{name}: {frames:?}"
        );
    }
    let middle = desk.viewport().center();
    desk.click_at(middle);
    assert_eq!(frames(&desk), []);
}

/// The list of keys is longer than a window, and is read without a mouse.
#[test]
fn the_list_of_keys_is_read_by_keys() {
    let mut desk = small();
    desk.press(Modifiers::NONE, Key::F1);
    let place = |desk: &Desk| {
        let texts = desk.texts();
        let last = texts
            .iter()
            .find(|(text, _)| text.starts_with("Fragments: "));
        last.expect("the tools of fragments").1.top()
    };
    let before = place(&desk);
    desk.press(Modifiers::NONE, Key::ArrowDown);
    desk.press(Modifiers::NONE, Key::End);
    assert!(place(&desk) < before - 200.0, "{} {before}", place(&desk));
    assert!(place(&desk) < desk.harness.ctx.content_rect().bottom());
    // The list behind did not move with it.
    assert_eq!(desk.open().selected, Some(0));
    desk.press(Modifiers::NONE, Key::Home);
    assert!((place(&desk) - before).abs() < 2.0);
    desk.press(Modifiers::NONE, Key::Escape);
    assert_eq!(desk.harness.state().state().asking, None);
}

/// A key that a button has no use for is the program's, also while the button has the focus.
#[test]
fn keys_go_on_beside_a_button() {
    let mut desk = small();
    desk.press(Modifiers::NONE, Key::Tab);
    assert!(focused(&desk).is_some());
    let before = desk.open().selected;
    desk.press(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(
        desk.open().selected,
        before,
        "arrows lead from button to button"
    );
    let there = focused(&desk).map(|(name, _)| name);
    desk.press(Modifiers::NONE, Key::F1);
    assert_eq!(desk.harness.state().state().asking, Some(Asking::Keys));
    desk.press(Modifiers::NONE, Key::Escape);
    // Back where it was.
    assert_eq!(focused(&desk).map(|(name, _)| name), there);
    desk.click(Role::TextInput, "Filter photos");
    desk.press(Modifiers::NONE, Key::F1);
    assert_eq!(
        desk.harness.state().state().asking,
        None,
        "a field takes all keys"
    );
}

/// Enter gives a field up, and Tab goes on from it, not from the window's first button.
#[test]
fn tab_goes_on_from_the_field_that_enter_left() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    desk.harness.state_mut().apply(Command::Tab(Tab::Flight));
    desk.settle();
    let field = "Standard deviation of camera positions";
    let name = |desk: &Desk| focused(desk).map(|(name, _)| name);
    desk.click(Role::TextInput, field);
    desk.press(Modifiers::NONE, Key::Tab);
    let next = name(&desk).expect("the next part");
    desk.click(Role::TextInput, field);
    desk.press(Modifiers::NONE, Key::Enter);
    assert_eq!(name(&desk), None);
    desk.press(Modifiers::NONE, Key::Tab);
    assert_eq!(name(&desk), Some(next));
}

/// The pile and the photo are pictures: who does not see them is told what of.
#[test]
fn pictures_are_described() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.press(Modifiers::NONE, Key::B);
    let described = |desk: &Desk, name: &str| {
        let picture = desk.node(Role::Image, name);
        picture.accesskit_node().description().expect("words")
    };
    let pile = described(&desk, "Viewport");
    assert!(
        pile.ends_with("the surface with its photos, 9 photos; IMG_0001.jpg is selected"),
        "{pile}"
    );
    desk.press(Modifiers::NONE, Key::ArrowDown);
    let photo = described(&desk, "Photo view IMG_0002.jpg");
    assert!(photo.starts_with("photo 2 of 9, top "), "{photo}");
}

/// Tab goes over a photo in one step, its box: its cells are no stops.
#[test]
fn a_photo_is_one_stop() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.click(Role::TextInput, "Filter photos");
    let mut boxes = Vec::new();
    for step in 0..40 {
        desk.press(Modifiers::NONE, Key::Tab);
        let name = focused(&desk).map_or_else(String::new, |(name, _)| name);
        if name.starts_with("Export IMG") {
            boxes.push(step);
        }
    }
    assert!(boxes.len() >= 9, "{boxes:?}");
    assert!(
        boxes.windows(2).all(|pair| pair[1] - pair[0] == 1),
        "{boxes:?}"
    );
}

/// The row says its numbers, and the photo that is selected is said aloud.
#[test]
fn a_screen_reader_is_told() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let row = desk.node(Role::Row, "Photo IMG_0001.jpg");
    let words = row.accesskit_node().description().expect("numbers");
    assert!(
        words.starts_with("top 20.6") && words.contains("px/cm"),
        "{words}"
    );
    assert!(
        words.ends_with(", trust") || words.ends_with(", check"),
        "{words}"
    );
    let spoken = |desk: &Desk| -> Vec<String> {
        let all = desk.harness.query_all_by_role(Role::Status);
        all.filter(|node| node.accesskit_node().live() == Live::Polite)
            .filter_map(|node| node.accesskit_node().label())
            .collect()
    };
    assert!(spoken(&desk).contains(&format!("IMG_0001.jpg: {words}")));
    desk.press(Modifiers::NONE, Key::ArrowDown);
    assert!(
        spoken(&desk)
            .iter()
            .any(|said| said.starts_with("IMG_0002.jpg: top "))
    );
    desk.harness
        .state_mut()
        .apply(Command::Report("no such file".to_owned()));
    desk.settle();
    assert!(spoken(&desk).contains(&"no such file".to_owned()));
    // Lists say what is chosen.
    let list = desk.node(Role::ComboBox, "Filter by verdict");
    assert_eq!(
        list.accesskit_node().description().as_deref(),
        Some("any verdict")
    );
}

/// The pages' keys count them from left to right.
#[test]
fn the_keys_of_the_pages_follow_their_order() {
    let mut desk = small();
    let mut before = f32::NEG_INFINITY;
    for (key, page, name) in [
        (Key::Num1, Page::Pile, "Pile"),
        (Key::Num2, Page::Map, "Map"),
        (Key::Num3, Page::Plan, "Plan"),
        (Key::Num4, Page::Fragments, "Fragments"),
        (Key::Num5, Page::SizeDistributions, "Size distributions"),
    ] {
        desk.press(Modifiers::COMMAND, key);
        assert_eq!(desk.harness.state().state().page, page);
        let left = desk.node(Role::Tab, name).rect().left();
        assert!(left > before, "{name}");
        before = left;
    }
}
