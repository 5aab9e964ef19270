//! Names of up to 300 letters in several scripts, in panels of any width: no number is covered or cut,
//! no panel stays wider for the next flight.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use egui::accesskit::Role;
use egui::{
    Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, Pos2, Rect, TouchPhase, Vec2, pos2,
    vec2,
};
use egui_kittest::Harness;
use fragscale::app::App;
use fragscale::app::Command;
use fragscale::app::open_flight::tracing::Trace;
use fragscale::scale::ScaleObjectKind;
use glam::DVec2;
use tempfile::TempDir;

use crate::desk::{Desk, Written, copy};
use crate::random::Dice;

/// Words that names are made of.
const WORDS: [&str; 12] = [
    "IMG",
    "_",
    "DJI_0042",
    "muckpile",
    " ",
    "爆破照片",
    "発破の写真",
    "발파사진",
    "взрыв",
    "صورة التفجير",
    "Größe",
    "-7.25",
];

fn name(dice: &mut Dice, most: usize) -> String {
    let length = 1 + dice.below(most);
    let mut name = String::new();
    while name.chars().count() < length {
        name.push_str(WORDS[dice.below(WORDS.len())]);
    }
    let name: String = name.chars().take(length).collect();
    // Blanks at the ends of a cell are not part of it.
    name.trim().replace(' ', "_") + "x"
}

/// Where the windrow is moved to: coordinates of a map are long.
const ON_MAP: [f64; 3] = [585_000.0, 5_612_000.0, 160.0];

/// A line of three coordinates and what is behind them, moved to the map.
fn moved(line: &str, between: char) -> String {
    let mut cells: Vec<String> = line.split(between).map(str::to_owned).collect();
    for (cell, by) in cells.iter_mut().zip(ON_MAP) {
        *cell = (cell.parse::<f64>().expect("a number") + by).to_string();
    }
    cells.join(&between.to_string())
}

/// The windrow on a map, with other names of flight and photos.
fn named(dice: &mut Dice, most: usize) -> TempDir {
    let folder = copy("tests/windrow");
    let toml = folder.path().join("flight.toml");
    let text = fs::read_to_string(&toml).expect("the flight");
    let title = name(dice, most);
    let text = text.replacen("name = \"Windrow\"", &format!("name = \"{title}\""), 1);
    assert!(text.contains(&title));
    fs::write(&toml, text).expect("written");
    let pile = folder.path().join("pile.ply");
    let text = fs::read_to_string(&pile).expect("the pile");
    let (head, points) = text.split_once("end_header\n").expect("a head");
    let points: Vec<String> = points.lines().map(|line| moved(line, ' ')).collect();
    fs::write(&pile, format!("{head}end_header\n{}\n", points.join("\n"))).expect("written");
    let poses = folder.path().join("poses.csv");
    let text = fs::read_to_string(&poses).expect("the poses");
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let mut named = lines.next().expect("a head").to_owned() + "\n";
    for (number, line) in lines.enumerate() {
        let (_, rest) = line.split_once(',').expect("a row");
        let rest = moved(rest, ',');
        named += &format!("{}_{number}.jpg,{rest}\n", name(dice, most));
    }
    fs::write(&poses, named).expect("written");
    folder
}

fn desk(path: &Path, size: [f32; 2], pixels_per_point: f32) -> Desk {
    let path = path.to_owned();
    let harness = Harness::builder()
        .with_size(size)
        .with_pixels_per_point(pixels_per_point)
        .with_max_steps(30)
        // Letters that no font on the machine has are boxes.
        .allow_missing_glyphs()
        .build_eframe(|context| App::new(context, vec![path]));
    let mut desk = Desk { harness };
    desk.settle();
    let state = desk.harness.state().state();
    assert!(state.open.is_some(), "{:?}", state.log);
    desk
}

/// Drags the edge between the viewport and a panel so that the panel has this width, as far as it goes.
fn drag_edges(desk: &mut Desk, left: f32, right: f32) {
    for (is_left, width) in [(true, left), (false, right)] {
        let viewport = desk.viewport();
        let whole = desk.harness.ctx.content_rect();
        let y = viewport.bottom() - 30.0;
        let (from, to) = match is_left {
            true => (viewport.left() - 1.5, width),
            false => (viewport.right() + 1.5, whole.right() - width),
        };
        for (step, at) in [from, from, to, to].into_iter().enumerate() {
            let at = pos2(at, y);
            match step {
                1 => desk.harness.drag_at(at),
                3 => desk.harness.drop_at(at),
                _ => desk.harness.hover_at(at),
            }
            desk.harness.step();
        }
        desk.harness.hover_at(viewport.center());
        desk.harness.run_ok();
    }
}

/// Whether a text is a number with its unit, and not a name that has digits.
fn is_number_alone(text: &str) -> bool {
    let first = text
        .trim_start_matches(['±', ' '])
        .split_whitespace()
        .next();
    let first = first.map(|first| first.trim_end_matches(['%', '°']));
    first.is_some_and(|first| first.parse::<f64>().is_ok())
}

/// The numbers for which only dots stand.
fn hidden_numbers(desk: &Desk, what: &str) -> Vec<String> {
    let mut written = desk.written();
    written.retain(|written| written.text == "…");
    if written.is_empty() {
        return Vec::new();
    }
    let called = desk.texts();
    let mut found = Vec::new();
    for written in written {
        let dots = written.place.intersect(written.seen_in);
        if !dots.is_positive() {
            continue;
        }
        let at = dots.center();
        let mut here = called.iter().filter(|(_, place)| place.contains(at));
        if let Some((number, _)) = here.find(|(text, _)| is_number_alone(text)) {
            found.push(format!("{what}: dots stand for '{number}' at {dots}"));
        }
    }
    found
}

/// The numbers that are seen but not whole, or that lie under the viewport.
fn cut_numbers(desk: &Desk, what: &str) -> Vec<String> {
    let viewport = desk.shows(Role::Image, "Viewport").then(|| desk.viewport());
    let whole = desk.harness.ctx.content_rect();
    let mut found = Vec::new();
    for written in desk.written() {
        let (place, sight) = (written.place, written.seen_in.intersect(whole));
        let seen = place.intersect(sight);
        let is_number = written.text.chars().any(|c| c.is_ascii_digit());
        if !is_number || seen.width() <= 0.5 || seen.height() <= 0.5 {
            continue;
        }
        let text = &written.text;
        // Rows that are scrolled half away are still read right.
        if place.left() < sight.left() - 1.0 || place.right() > sight.right() + 1.0 {
            found.push(format!("{what}: '{text}' at {place} is cut to {sight}"));
        }
        let Some(viewport) = viewport else {
            continue;
        };
        // What is written on the viewport is clipped to it.
        let on_viewport = viewport.expand(1.0).contains_rect(sight);
        if !on_viewport && viewport.shrink(1.0).intersects(seen) && !is_over(desk, seen) {
            found.push(format!("{what}: '{text}' at {place} is under the viewport"));
        }
    }
    found
}

/// The intervals that a line break parts from their number, or in themselves.
fn parted_numbers(desk: &Desk, what: &str) -> Vec<String> {
    let parted = desk.written().into_iter().filter(|written| {
        let digit = |c: char| c.is_ascii_digit();
        let is_broken = |rows: &[String]| {
            let (end, begin) = (rows[0].trim_end(), rows[1].trim_start());
            let percent = end.ends_with(digit) && begin.starts_with('%');
            end.ends_with('±') || begin.starts_with('±') || percent
        };
        written.rows.windows(2).any(is_broken)
    });
    let told = parted.map(|written| format!("{what}: parted: {:?}", written.rows));
    told.collect()
}

/// Turns the wheel at a place.
fn wheel(desk: &mut Desk, at: Pos2, delta: Vec2) {
    desk.harness.hover_at(at);
    desk.harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta,
        phase: TouchPhase::Move,
        source: MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    desk.harness.run_ok();
}

/// A bar on the selected photo, which has numbers of its own.
fn trace_bar(desk: &mut Desk) {
    let bar = ScaleObjectKind::Bar;
    for step in [
        Trace::Size(bar, 0.25),
        Trace::Begin(bar),
        Trace::Add(DVec2::new(300.0, 200.0)),
        Trace::Add(DVec2::new(500.0, 260.0)),
    ] {
        desk.harness.state_mut().apply(Command::Trace(step));
    }
}

/// Whether a small window is there.
fn is_over(desk: &Desk, place: Rect) -> bool {
    desk.harness
        .ctx
        .layer_id_at(place.center())
        .is_some_and(|layer| layer.order != egui::Order::Background)
}

#[test]
fn no_number_is_cut_whatever_the_names_and_widths() {
    let mut dice = Dice::new(15_006);
    let (mut found, mut widths) = (Vec::new(), Vec::new());
    for round in 0..12 {
        let most = [8, 40, 100, 300][round % 4];
        let folder = named(&mut dice, most);
        let size = [
            dice.between(640.0, 1500.0) as f32,
            dice.between(480.0, 900.0) as f32,
        ];
        let mut desk = desk(folder.path(), size, [1.0, 2.0, 1.25][round % 3]);
        for step in 0..4 {
            let (left, right) = (dice.between(200.0, 700.0), dice.between(200.0, 600.0));
            drag_edges(&mut desk, left as f32, right as f32);
            desk.harness.state_mut().apply(Command::Select(Some(step)));
            if step == 2 {
                trace_bar(&mut desk);
                desk.harness.state_mut().apply(Command::ToggleTint);
            }
            desk.settle();
            widths.push(desk.viewport().x_range());
            for tab in ["Photo", "Flight", "Limits", "Review"] {
                desk.click(Role::Tab, tab);
                let viewport = desk.viewport();
                let what = format!("round {round}.{step}, {size:?}, {tab}, viewport {viewport}");
                // Down to the end of the longest page.
                for _ in 0..if tab == "Photo" { 3 } else { 1 } {
                    found.extend(cut_numbers(&desk, &what));
                    found.extend(hidden_numbers(&desk, &what));
                    found.extend(parted_numbers(&desk, &what));
                    let on_page = pos2(viewport.right() + 100.0, viewport.bottom() - 20.0);
                    wheel(&mut desk, on_page, vec2(0.0, -400.0));
                }
                desk.harness.hover_at(viewport.center());
            }
        }
        // Coordinates beside the map, which takes long to make.
        if round % 4 == 0 {
            desk.press(Modifiers::COMMAND, Key::Num2);
            let map = desk.node(Role::Image, "Map").rect();
            let what = format!("round {round}, {size:?}, map {map}");
            found.extend(cut_numbers(&desk, &what));
            found.extend(hidden_numbers(&desk, &what));
            desk.press(Modifiers::COMMAND, Key::Num1);
        }
        for key in [Key::O, Key::E, Key::P, Key::L] {
            desk.press(Modifiers::COMMAND, key);
            found.extend(cut_numbers(
                &desk,
                &format!("round {round}, {size:?}, {key:?}"),
            ));
        }
    }
    widths.dedup();
    assert!(widths.len() > 20, "the panels have many widths: {widths:?}");
    let (count, first) = (found.len(), found.iter().take(40).cloned());
    let first: Vec<String> = first.collect();
    assert!(found.is_empty(), "{count}:\n{}", first.join("\n"));
}

/// A flight with long names leaves the panels as wide as they were.
#[test]
fn panels_are_as_wide_for_the_next_flight() {
    let mut dice = Dice::new(7);
    let folder = named(&mut dice, 300);
    let plain = copy("tests/windrow");
    for size in [[1024.0, 700.0], [1500.0, 950.0]] {
        let fresh = desk(plain.path(), size, 1.0).viewport().x_range();
        let mut desk = desk(folder.path(), size, 1.0);
        assert_eq!(desk.viewport().x_range(), fresh, "with long names");
        for tab in ["Flight", "Limits", "Photo"] {
            desk.click(Role::Tab, tab);
            assert_eq!(desk.viewport().x_range(), fresh, "{tab}");
        }
        let next = Command::Open(plain.path().to_owned());
        desk.harness.state_mut().apply(next);
        desk.settle();
        assert_eq!(desk.viewport().x_range(), fresh, "for the next flight");
    }
}

/// The name of the selected photo is cut in the middle: its number, which tells photos apart, is there.
#[test]
fn names_are_cut_in_the_middle_and_whole_in_the_hover_text() {
    let mut dice = Dice::new(3);
    let folder = named(&mut dice, 300);
    let mut desk = desk(folder.path(), [1280.0, 720.0], 1.0);
    let photo = (0..9).find(|&photo| desk.open().name(photo).chars().count() > 200);
    let photo = photo.expect("a long name");
    desk.harness.state_mut().apply(Command::Select(Some(photo)));
    desk.settle();
    let name = desk.open().name(photo).to_owned();
    let end = format!("_{photo}.jpg");
    let cut: Vec<_> = desk
        .written()
        .into_iter()
        .filter(|w| w.text.contains('…'))
        .collect();
    // In the narrow column of the table the end is shorter.
    let in_table = |w: &&Written| w.place.right() < desk.viewport().left();
    let texts: Vec<&str> = cut
        .iter()
        .filter(in_table)
        .map(|w| w.text.as_str())
        .collect();
    // Where there is no room for more, the number alone, between dots.
    let end_of = |text: &&str| text.ends_with(&end[1..]) || **text == format!("…{photo}…");
    assert!(texts.iter().any(end_of), "{texts:?}");
    let inspector = cut
        .iter()
        .find(|w| w.place.left() > desk.viewport().right() && w.text.ends_with(&end))
        .expect("over the photo");
    assert!(name.starts_with(inspector.text.split('…').next().expect("a begin")));
    desk.harness.hover_at(inspector.place.center());
    for _ in 0..90 {
        desk.harness.step();
    }
    assert!(
        desk.written().iter().any(|w| w.text == name),
        "the whole name in the hover text"
    );
}

/// Names that are short enough are whole in a list of any width: thumbnails and verdicts cut none of them.
#[test]
fn short_names_are_whole_in_a_list_of_any_width() {
    let sample = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/sample");
    let mut desk = desk(&sample, [1500.0, 600.0], 1.0);
    for step in 0..20_u8 {
        let width = 180.0 + 8.0 * f32::from(step);
        drag_edges(&mut desk, width, 330.0);
        desk.settle();
        let edge = desk.viewport().left();
        let mut written = desk.written();
        written.retain(|written| written.place.right() < edge && written.text.ends_with("jpg"));
        assert!(written.len() > 3, "{width}");
        let cut = written.iter().find(|written| written.text.contains('…'));
        let cut = cut.map(|written| &written.text);
        assert!(cut.is_none(), "{width}: {cut:?}");
    }
}

/// The two numbers to type are in sight in a window of 800 x 600, however long the names are.
#[test]
fn both_scales_are_in_sight_in_a_small_window() {
    let mut dice = Dice::new(23);
    for most in [4, 8, 16, 40, 100] {
        let folder = named(&mut dice, most);
        let desk = desk(folder.path(), [800.0, 600.0], 1.0);
        let edge = desk.viewport().left();
        let written = desk.written();
        for heading in ["Fitted top", "Fitted bottom"] {
            let seen = written.iter().any(|written| {
                let sight = written.seen_in.expand(1.0);
                let is_seen = sight.contains_rect(written.place);
                written.text == heading && is_seen && written.place.right() < edge
            });
            assert!(seen, "{most}: {heading}");
        }
    }
}

/// A long line of the log is read to its end, in as many rows as it needs.
#[test]
fn lines_of_the_log_are_broken_and_not_cut() {
    let folder = copy("tests/windrow");
    let mut desk = desk(folder.path(), [900.0, 600.0], 1.0);
    let long = "many words that are read ".repeat(12) + "to their end";
    let app = desk.harness.state_mut();
    app.apply(Command::Report(long.clone()));
    app.apply(Command::DismissNotice);
    desk.press(Modifiers::COMMAND, Key::L);
    let line = format!("✖ {long}");
    let written = desk.written();
    let line = written.iter().find(|written| written.text == line);
    let line = line.expect("the last line is in sight");
    assert!(line.rows.len() > 1, "{:?}", line.rows);
    assert!(desk.says(&long));
}

/// A long log is laid out from its last lines on; what is copied is all of it.
#[test]
fn the_last_lines_of_a_long_log_are_laid_out() {
    let folder = copy("tests/windrow");
    let mut desk = desk(folder.path(), [900.0, 600.0], 1.0);
    let before = desk.harness.state().state().log.len();
    for line in 0..700 {
        let app = desk.harness.state_mut();
        app.apply(Command::Report(format!("line {line} of them")));
    }
    desk.harness.state_mut().apply(Command::DismissNotice);
    desk.press(Modifiers::COMMAND, Key::L);
    assert!(desk.says("line 699 of them"));
    let panel = desk.node(Role::Button, "Copy log").rect();
    wheel(
        &mut desk,
        panel.left_bottom() + vec2(40.0, 30.0),
        vec2(0.0, 1e6),
    );
    let earlier = format!("{} earlier lines: Copy log has them all", before + 400);
    assert!(desk.says(&earlier), "{:?}", desk.texts());
    assert!(desk.says("line 400 of them") && !desk.says("line 399 of them"));
    desk.node(Role::Button, "Copy log").click();
    let copied = (0..3).find_map(|_| {
        desk.harness.step();
        desk.copied()
    });
    assert!(copied.is_some_and(|text| text.contains("line 0 of them")));
}

/// In a list of photos of any width: at rest no column is half in sight, and every number of a row is read
/// whole by scrolling, under a bar that says so.
#[test]
fn every_number_of_the_list_can_be_scrolled_to() {
    let mut dice = Dice::new(31);
    for (width, pixels_per_point) in [(200.0, 1.0), (300.0, 2.0), (360.0, 2.0), (700.0, 1.0)] {
        let folder = named(&mut dice, 40);
        let mut desk = desk(folder.path(), [1500.0, 600.0], pixels_per_point);
        drag_edges(&mut desk, width, 330.0);
        desk.settle();
        let panel = desk.viewport().left();
        assert!((panel - width).abs() < 12.0 || width > 600.0, "{panel}");
        let (_, row) = desk.rows().remove(0);
        let wanted: BTreeSet<String> = row
            .into_iter()
            .filter(|text| is_number_alone(text))
            .collect();
        assert!(wanted.len() > 5, "{wanted:?}");
        let mut read = BTreeSet::new();
        for step in 0..40 {
            if step == 0 {
                let mut cut = cut_numbers(&desk, "at rest");
                cut.extend(hidden_numbers(&desk, "at rest"));
                assert!(cut.is_empty(), "{width}: {cut:?}");
            }
            for written in desk.written() {
                if written.seen_in.expand(1.0).contains_rect(written.place) {
                    read.insert(written.text);
                }
            }
            let on_list = pos2(60.0, desk.viewport().center().y);
            wheel(&mut desk, on_list, vec2(-20.0, 0.0));
        }
        let missing: Vec<&String> = wanted.difference(&read).collect();
        assert!(missing.is_empty(), "{width}: {missing:?}");
    }
}

/// The page of size distributions, with methods and files of long names.
#[test]
fn no_number_is_cut_beside_the_curves() {
    let mut dice = Dice::new(99);
    let mut found = Vec::new();
    for most in [8, 100, 300] {
        let folder = tempfile::tempdir().expect("a folder");
        let mut table = "method,trial,photo,size_mm,percent_passing\n".to_owned();
        for method in 0..2 {
            let method = format!("{}_{method}", name(&mut dice, most));
            for trial in 1..3 {
                for photo in ["a", "b"] {
                    let photo = format!("{}_{photo}", name(&mut dice, most));
                    for (size, passing) in [(8, 6.25), (16, 14.5), (63, 65.0), (125, 96.125)] {
                        let passing = passing + f64::from(trial);
                        table += &format!("{method},{trial},{photo},{size},{passing}\n");
                    }
                }
            }
        }
        // A file's name holds 255 bytes.
        let path = folder
            .path()
            .join(format!("{}.csv", name(&mut dice, most.min(60))));
        fs::write(&path, table).expect("written");
        let size = [
            dice.between(640.0, 1500.0) as f32,
            dice.between(480.0, 900.0) as f32,
        ];
        let harness = Harness::builder()
            .with_size(size)
            .with_max_steps(30)
            .allow_missing_glyphs()
            .build_eframe(|context| App::new(context, Vec::new()));
        let mut desk = Desk { harness };
        desk.press(Modifiers::COMMAND, Key::Num5);
        let paths = vec![path];
        desk.harness.state_mut().apply(Command::Drop(paths));
        desk.settle();
        let log = &desk.harness.state().state().log;
        assert!(
            desk.harness
                .state()
                .state()
                .distributions
                .computed
                .is_some(),
            "{log:?}"
        );
        for tab in [
            "Fits",
            "Against the reference",
            "Repeatability",
            "Time effort",
        ] {
            desk.click(Role::Tab, tab);
            found.extend(cut_numbers(&desk, &format!("{most}, {size:?}, {tab}")));
        }
    }
    let (count, first) = (found.len(), found.iter().take(40).cloned());
    let first: Vec<String> = first.collect();
    assert!(found.is_empty(), "{count}:\n{}", first.join("\n"));
}
