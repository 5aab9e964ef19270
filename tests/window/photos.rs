//! The table of photos, against what the command says of the same flight.

use std::collections::HashMap;

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use fragscale::flight::{Along, Doubt};

use crate::common::scales_json;
use crate::desk::{Desk, flight};
use crate::wrong_pile;

/// Top and bottom scale of each photo's corners in pixels per centimetre, from the command.
fn scales() -> HashMap<String, [f64; 2]> {
    pairs("scale")
}

/// The same of its best line.
fn fitted() -> HashMap<String, [f64; 2]> {
    pairs("fitted")
}

fn pairs(of: &str) -> HashMap<String, [f64; 2]> {
    let json = scales_json(&flight("assets/sample"), &["--unit", "cm"]);
    let photos = json["photos"].as_array().expect("photos");
    let edge = |photo: &serde_json::Value, edge: &str| photo[of][edge].as_f64().expect("a scale");
    photos
        .iter()
        .map(|photo| {
            let name = photo["photo"].as_str().expect("a name");
            (name.to_owned(), [edge(photo, "top"), edge(photo, "bottom")])
        })
        .collect()
}

/// Half the width of the intervals of fitted top and bottom and of the corners' top and bottom, from the
/// command, in pixels per centimetre.
fn halves() -> HashMap<String, [f64; 4]> {
    let json = scales_json(&flight("assets/sample"), &["--unit", "cm"]);
    let photos = json["photos"].as_array().expect("photos").iter();
    let half = |photo: &serde_json::Value, name: &str| {
        let [low, high] = ["low", "high"].map(|end| &photo["uncertainty"][name][end]);
        (high.as_f64().expect("a number") - low.as_f64().expect("a number")) / 2.0
    };
    photos
        .map(|photo| {
            let name = photo["photo"].as_str().expect("a name");
            let names = ["fitted_top", "fitted_bottom", "top", "bottom"];
            (name.to_owned(), names.map(|name| half(photo, name)))
        })
        .collect()
}

/// The half of each column that its numbers are written by: the middle one of all photos.
fn typical_halves() -> [f64; 4] {
    let all: Vec<[f64; 4]> = halves().into_values().collect();
    std::array::from_fn(|column| {
        let mut of_column: Vec<f64> = all.iter().map(|halves| halves[column]).collect();
        of_column.sort_by(f64::total_cmp);
        of_column[(of_column.len() - 1) / 2]
    })
}

/// How many digits a number has down to the first of half its interval, the second where that is a 1.
fn digits(value: f64, half: f64) -> i32 {
    let first = half.log10().floor();
    let has_two = half / 10_f64.powf(first) < 3.55;
    (value.log10().floor() - first) as i32 + 1 + i32::from(has_two)
}

/// Whether `shown` is `value` to this many significant digits.
#[track_caller]
fn assert_shown(shown: &str, value: f64, digits: i32) {
    let number: f64 = shown
        .parse()
        .unwrap_or_else(|_| panic!("'{shown}' is no number"));
    let last = 10_f64.powi(value.log10().floor() as i32 + 1 - digits);
    assert!(
        (number - value).abs() <= last * 0.500_001,
        "{shown} for {value}"
    );
    let count = shown.chars().filter(char::is_ascii_digit).count();
    assert_eq!(count, digits as usize, "{shown} for {value}");
}

#[test]
fn the_sample_opens_from_the_start_page_with_the_commands_scales() {
    let mut desk = Desk::new(None);
    desk.click(Role::Button, "Open the sample flight");
    let (scales, fitted, halves) = (scales(), fitted(), typical_halves());
    let rows = desk.rows();
    assert_eq!(rows.len(), 9);
    for (photo, cells) in &rows {
        assert_eq!(&cells[0], photo);
        let pairs = fitted[photo].into_iter().chain(scales[photo]);
        let places = [1, 2, 5, 6].into_iter().zip(halves);
        for ((place, half), scale) in places.zip(pairs) {
            assert_shown(&cells[place], scale, digits(scale, half));
        }
        assert_eq!(cells[7], "4/4");
    }
    // The other unit is the same number with another factor.
    desk.click(Role::RadioButton, "Pixels per m");
    for (photo, cells) in desk.rows() {
        let [of_fitted, _, of_top, of_bottom] = halves;
        for (cell, scale, half) in [
            (&cells[1], fitted[&photo][0], of_fitted),
            (&cells[5], scales[&photo][0], of_top),
            (&cells[6], scales[&photo][1], of_bottom),
        ] {
            // Tens and hundreds are rounded as well, and filled with zeros.
            let digits = digits(scale, half);
            let last = 10_f64.powi(scale.log10().floor() as i32 + 3 - digits);
            let shown: f64 = cell.parse().expect("a number");
            assert!((shown - scale * 100.0).abs() <= last * 0.500_001, "{cell}");
        }
    }
}

/// A column is read from above: 48.3 and 49.91 below each other are not. All digits are in the hover text and in what is copied.
#[test]
fn the_numbers_of_a_column_have_the_same_decimals() {
    for path in ["assets/sample", "tests/windrow"] {
        let mut desk = Desk::new(Some(&flight(path)));
        for unit in ["in", "ft", "m", "mm", "cm"] {
            desk.click(Role::RadioButton, &format!("Pixels per {unit}"));
            let rows = desk.rows();
            let decimals = |cell: &String| cell.split_once('.').map_or(0, |(_, after)| after.len());
            for column in [1, 2, 5, 6] {
                let cells: Vec<&String> = rows.iter().map(|(_, cells)| &cells[column]).collect();
                let first = decimals(cells[0]);
                let all = cells.iter().all(|cell| decimals(cell) == first);
                assert!(all, "{path}, {unit}, {column}: {cells:?}");
            }
        }
    }
}

/// A frame with a shortcut in it; what went to the clipboard.
fn shortcut(desk: &mut Desk, modifiers: Modifiers, key: Key) -> Option<String> {
    let event = |pressed| Event::Key {
        key,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers,
    };
    desk.harness
        .input_mut()
        .events
        .push(Event::ModifiersChanged(modifiers));
    let copied = desk.frame([event(true)]);
    desk.frame([event(false), Event::ModifiersChanged(Modifiers::NONE)]);
    copied
}

#[test]
fn photos_are_selected_by_their_rows_and_by_keys() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    assert_eq!(desk.selected(), "IMG_0001.jpg");
    desk.click(Role::Row, "Photo IMG_0004.jpg");
    assert_eq!(desk.selected(), "IMG_0004.jpg");
    assert!(desk.shows(Role::Image, "Photo IMG_0004.jpg with its scale"));
    desk.press(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(desk.selected(), "IMG_0005.jpg");
    for _ in 0..7 {
        desk.press(Modifiers::NONE, Key::ArrowUp);
    }
    assert_eq!(desk.selected(), "IMG_0001.jpg", "the first row is the end");
    // The keys follow the rows as they are shown.
    desk.click(
        Role::Button,
        "Sort by scale at the top edge, from its two corners",
    );
    let order = desk.photos();
    desk.click(Role::Row, &format!("Photo {}", order[3]));
    desk.press(Modifiers::NONE, Key::ArrowDown);
    assert_eq!(desk.selected(), order[4]);
}

#[test]
fn the_table_sorts_by_the_top_scale_both_ways_and_back() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    let scales = scales();
    let top =
        |photos: &[String]| -> Vec<f64> { photos.iter().map(|photo| scales[photo][0]).collect() };
    let of_flight = desk.photos();
    assert!(
        !top(&of_flight).is_sorted(),
        "the order of the flight is another"
    );
    for (turned, name) in [(false, "up"), (true, "down")] {
        let top_scale = "Sort by scale at the top edge, from its two corners";
        // The list has a bar to this column.
        desk.node(Role::Button, top_scale).scroll_to_me();
        desk.harness.run();
        desk.click(Role::Button, top_scale);
        let mut scales = top(&desk.photos());
        assert_eq!(scales.len(), 9);
        if turned {
            scales.reverse();
        }
        assert!(scales.is_sorted(), "{name}: {scales:?}");
    }
    desk.click(
        Role::Button,
        "Sort by scale at the top edge, from its two corners",
    );
    assert_eq!(desk.photos(), of_flight);
}

#[test]
fn the_table_is_filtered_by_text_and_by_verdict() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.fill("Filter photos", "img_0007");
    assert_eq!(desk.photos(), ["IMG_0007.jpg"]);
    desk.fill("Filter photos", "");
    assert_eq!(desk.photos().len(), 9);
    let with = |desk: &Desk, verdict: &str| -> Vec<String> {
        let rows = desk.rows().into_iter();
        rows.filter(|(_, cells)| cells[4].ends_with(verdict))
            .map(|(photo, _)| photo)
            .collect()
    };
    let trusted = with(&desk, "trust");
    assert!(trusted.len() > 5, "{trusted:?}");
    desk.click(Role::Tab, "Limits");
    desk.fill("Top and bottom scale differ more than", "1.1");
    let mut doubted: Vec<String> = fitted()
        .into_iter()
        .filter(|(_, [top, bottom])| (bottom / top).max(top / bottom) > 1.1)
        .map(|(photo, _)| photo)
        .collect();
    assert!(!doubted.is_empty() && doubted.len() < 9, "{doubted:?}");
    let check = with(&desk, "check");
    assert_eq!(
        check,
        desk.photos()
            .into_iter()
            .filter(|photo| doubted.contains(photo) || !trusted.contains(photo))
            .collect::<Vec<_>>()
    );
    desk.click(Role::Button, "Only photos: check");
    assert_eq!(desk.photos(), check);
    desk.click(Role::ComboBox, "Filter by verdict");
    desk.click(Role::Button, "trust");
    assert_eq!(desk.photos().len(), 9 - check.len());
    desk.click(Role::Button, "Only photos: trust");
    // The text looks into the reasons too.
    desk.fill("Filter photos", "TOP AND THE BOTTOM");
    let mut shown = desk.photos();
    shown.sort();
    doubted.sort();
    assert_eq!(shown, doubted);
    desk.fill("Filter photos", "");
    desk.click(Role::Button, "Usual limits");
    assert_eq!(with(&desk, "trust"), trusted);
}

#[test]
fn choices_for_export_are_undone_and_done_again() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    let chosen = |desk: &Desk| desk.open().review.going_along(Along::Trusted);
    desk.click(Role::Button, "Edit");
    desk.click(Role::Button, "Choose all photos with a scale");
    assert_eq!(chosen(&desk), [true; 9]);
    desk.click(Role::CheckBox, "Export IMG_0003.jpg");
    assert!(!chosen(&desk)[2]);
    desk.click(Role::Row, "Photo IMG_0005.jpg");
    desk.press(Modifiers::NONE, Key::Space);
    let both = chosen(&desk);
    assert_eq!(both.iter().filter(|&&chosen| chosen).count(), 7);
    assert!(!both[2] && !both[4]);
    desk.press(Modifiers::COMMAND, Key::Z);
    desk.press(Modifiers::COMMAND, Key::Z);
    assert_eq!(chosen(&desk), [true; 9]);
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    desk.press(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(chosen(&desk), both);
    assert_eq!(desk.selected(), "IMG_0005.jpg", "undo leaves the selection");
    assert!(desk.open().is_changed(), "choices are in flight.toml");
}

#[test]
fn scales_are_copied_as_the_dialog_asks_for_them() {
    let mut desk = Desk::new(Some(&flight("assets/sample")));
    desk.click(Role::Row, "Photo IMG_0002.jpg");
    let [top, bottom] = fitted()["IMG_0002.jpg"];
    desk.node(Role::Button, "Copy top and bottom scale").click();
    desk.harness.step();
    let copied = desk.copied();
    let from_keys = shortcut(&mut desk, Modifiers::COMMAND | Modifiers::SHIFT, Key::C);
    for copied in [copied, from_keys] {
        let copied = copied.expect("something was copied");
        let (a, b) = copied.split_once('\t').expect("two numbers");
        assert_shown(a, top, 6);
        assert_shown(b, bottom, 6);
    }
}

#[test]
fn every_tab_of_the_right_panel_opens() {
    let mut desk = Desk::new(Some(&flight("tests/windrow")));
    assert!(desk.says("Top, px/cm"));
    desk.click(Role::Tab, "Flight");
    assert!(desk.says("Unit of the world's coordinates"));
    desk.click(Role::Tab, "Limits");
    assert!(desk.says("A photo is to check when one of these holds"));
    desk.click(Role::Tab, "Photo");
    assert!(desk.says("Corner points, m"));
}

/// The verdicts in the table, and the photos that are chosen for export.
fn verdicts_and_chosen(desk: &Desk) -> (Vec<String>, Vec<bool>) {
    let rows = desk.rows().into_iter();
    let verdicts = rows.map(|(_, cells)| cells[4].clone()).collect();
    (verdicts, desk.open().review.going_along(Along::Trusted))
}

/// What the window proposes for export is what it trusts.
#[test]
fn a_photo_from_under_the_surface_is_not_trusted() {
    let folder = tempfile::tempdir().expect("a folder");
    wrong_pile::under_surface(folder.path());
    let desk = Desk::new(Some(folder.path()));
    assert_eq!(desk.photos(), wrong_pile::ABOVE_AND_UNDER);
    let (verdicts, chosen) = verdicts_and_chosen(&desk);
    assert!(verdicts[0].ends_with("trust"), "{verdicts:?}");
    assert!(verdicts[1].ends_with("check"), "{verdicts:?}");
    assert_eq!(chosen, [true, false]);
    let of_under = desk.open().review.photo(1).expect("a photo");
    assert_eq!(of_under.doubts, [Doubt::UnderSurface]);
}

#[test]
fn swapped_photos_are_not_trusted() {
    let as_flown = Desk::new(Some(&flight("assets/sample")));
    let (as_flown, chosen_as_flown) = verdicts_and_chosen(&as_flown);
    let folder = tempfile::tempdir().expect("a folder");
    wrong_pile::swapped(folder.path());
    let desk = Desk::new(Some(folder.path()));
    let (verdicts, chosen) = verdicts_and_chosen(&desk);
    for photo in 0..9 {
        let is_swapped = wrong_pile::SWAPPED.contains(&photo);
        let reviewed = desk.open().review.photo(photo).expect("a photo");
        let of_colours = reviewed.doubts.iter().any(Doubt::is_of_colours);
        assert_eq!(of_colours, is_swapped, "{photo}: {:?}", reviewed.doubts);
        match is_swapped {
            true => assert!(verdicts[photo].ends_with("check"), "{verdicts:?}"),
            false => assert_eq!(verdicts[photo], as_flown[photo]),
        }
        assert_eq!(
            chosen[photo],
            chosen_as_flown[photo] && !is_swapped,
            "{photo}"
        );
    }
}
