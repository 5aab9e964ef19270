use std::collections::BTreeMap;

use glam::DVec2;

use super::*;
use crate::split_mix::SplitMix;

/// A label for each letter: `.` fines, `#` no rock, `1` to `9` fragments.
fn image(rows: &[&str]) -> LabelImage {
    let label = |letter: char| match letter {
        '#' => NOT_ROCK,
        letter => letter.to_digit(10).unwrap_or(FINES),
    };
    LabelImage {
        width: rows[0].len(),
        height: rows.len(),
        labels: rows.iter().flat_map(|row| row.chars().map(label)).collect(),
    }
}

fn squares() -> Outlines {
    let labels = image(&[
        "............",
        ".1111..2222.",
        ".1111..2222.",
        ".1111..2222.",
        ".1111..2222.",
        ".........###",
    ]);
    Outlines::new(labels, BTreeMap::from([(1, 0.9), (2, 0.4)]))
}

fn places(of: &[[f64; 2]]) -> Vec<DVec2> {
    of.iter().map(|place| DVec2::from_array(*place)).collect()
}

/// What comes of a change.
fn after(outlines: &Outlines, change: Change) -> Outlines {
    let mut editing = Editing::new(outlines.clone());
    editing.make(change);
    let done = editing.now().clone();
    assert!(editing.undo());
    assert_eq!(editing.now(), outlines);
    assert!(editing.redo());
    assert_eq!(*editing.now(), done);
    done
}

/// A stroke down the middle column of seven: three columns at each side, its own to one of them.
#[test]
fn a_square_is_split() {
    let outlines = squares();
    let split = outlines.split(&places(&[[3.5, 0.2], [3.5, 5.5]]));
    // What is right of the stroke has four pixels, fewer than count.
    assert!(split.is_err());
    let large = Outlines::new(
        image(&["1111111", "1111111", "1111111", "1111111"]),
        BTreeMap::from([(1, 0.7)]),
    );
    let split = large.split(&places(&[[3.5, -3.0], [3.5, 9.0]])).unwrap();
    let done = after(&large, split);
    let areas = done.labels().areas();
    assert_eq!(areas[0], 0);
    assert_eq!(areas[1] + areas[2], 28);
    assert_eq!(areas[1].min(areas[2]), 12);
    assert_eq!(done.doubtful(), []);
    assert!(large.split(&places(&[[3.5, 1.5], [3.5, 9.0]])).is_err());
}

#[test]
fn two_become_one_over_a_bridge() {
    let outlines = squares();
    let stroke = places(&[[2.5, 2.5], [9.5, 2.5]]);
    let done = after(&outlines, outlines.merge(&stroke).unwrap());
    let areas = done.labels().areas();
    // Two gaps on the stroke, each with its neighbours above and below.
    assert_eq!(areas[1], 32 + 2 * 3);
    assert_eq!(areas.get(2), None);
    assert_eq!(done.fragment_at(DVec2::new(8.5, 1.5)), Some(1));
    assert!(outlines.merge(&stroke[..1]).is_err());
    assert!(outlines.merge(&[]).is_err());
}

#[test]
fn an_outline_takes_what_lies_in_it() {
    let outlines = squares();
    let square = places(&[[4.0, 1.0], [8.0, 1.0], [8.0, 3.0], [4.0, 3.0]]);
    let done = after(&outlines, outlines.outline(None, &square).unwrap());
    let areas = done.labels().areas();
    assert_eq!(areas[1..], [14, 14, 8]);
    assert_eq!((done.sure(1), done.sure(3)), (Some(0.9), None));
    // The second one is what it holds now.
    let again = after(&outlines, outlines.outline(Some(2), &square).unwrap());
    assert_eq!(again.labels().areas()[1..], [14, 8]);
    assert!(outlines.outline(None, &square[..1]).is_err());
    let nowhere = places(&[[f64::NAN, 1.0], [f64::INFINITY, 1.0], [8.0, 1e300]]);
    assert!(outlines.outline(None, &nowhere).is_err());
}

#[test]
fn a_brush_leaves_fines() {
    let outlines = squares();
    let done = outlines.brush(&places(&[[0.0, 2.5], [5.0, 2.5]]), 0.5);
    let done = after(&outlines, done.unwrap());
    // A row of four goes; the row above it has too few to be a piece.
    assert_eq!(done.labels().areas()[1..], [8, 16]);
    assert!(outlines.brush(&places(&[[0.0, 0.0]]), 0.5).is_err());
    let all = outlines.brush(&places(&[[3.0, 3.0]]), 3.0).unwrap();
    assert_eq!(after(&outlines, all).labels().areas()[1], 0);
}

#[test]
fn excluded_and_back() {
    let outlines = squares();
    let square = places(&[[0.0, 0.0], [2.0, 0.0], [2.0, 6.0], [0.0, 6.0]]);
    let done = after(&outlines, outlines.exclude(&square, false).unwrap());
    let is_out = |of: &Outlines| {
        of.labels()
            .labels
            .iter()
            .filter(|is| **is == NOT_ROCK)
            .count()
    };
    assert_eq!(is_out(&done), 3 + 12);
    let back = after(&done, done.exclude(&square, true).unwrap());
    assert_eq!(is_out(&back), 3);
    // A line is nothing to leave out, there and back.
    let line = places(&[[0.0, 0.0], [5.0, 6.0], [5.0, 6.0], [0.1, 0.0]]);
    let fault = outlines.exclude(&line, false).unwrap_err();
    assert!(fault.to_string().contains("encloses nothing"), "{fault}");
    assert_eq!(back.labels().areas()[1], 12);
}

#[test]
fn what_was_looked_at_is_no_longer_doubtful() {
    let outlines = squares();
    assert_eq!(outlines.doubtful(), [(2, 0.4), (1, 0.9)]);
    let change = outlines.is_right(2);
    assert!(change.is_only_looked());
    assert_eq!(after(&outlines, change).doubtful(), [(1, 0.9)]);
    let gone = after(&outlines, outlines.delete(1));
    assert_eq!(gone.doubtful(), [(2, 0.4)]);
    assert!(outlines.delete(7).is_nothing());
    let ball = after(&outlines, outlines.no_rock(1));
    assert_eq!(ball.doubtful(), [(2, 0.4)]);
    assert_eq!(ball.labels().areas()[1..], gone.labels().areas()[1..]);
    let out = |of: &Outlines| {
        of.labels()
            .labels
            .iter()
            .filter(|label| **label == NOT_ROCK)
            .count()
    };
    assert_eq!(out(&ball) - out(&outlines), outlines.labels().areas()[1]);
}

#[test]
fn outlined_anew_is_a_step_like_any_other() {
    let outlines = squares();
    let mut labels = outlines.labels().clone();
    labels.labels.reverse();
    let other = Outlines::new(labels, BTreeMap::from([(1, 0.3), (7, 0.5)]));
    assert_eq!(after(&outlines, outlines.become_these(&other)), other);
    assert!(outlines.become_these(&outlines).is_nothing());
    assert!(outlines.nothing().is_nothing());
}

/// Two thousand edits at random, undone, are as if they had never been, and at every step each pixel belongs to
/// one region.
#[test]
fn two_thousand_edits_are_undone() {
    let (width, height) = (160, 120);
    let mut random = SplitMix(5);
    let blocks =
        (0..width * height).map(|place| (place % width / 20 + place / width / 20 * 8) as u32);
    let labels = LabelImage {
        width,
        height,
        labels: blocks.collect(),
    };
    let sure = (1..48).map(|number| (number, f64::from(number) / 48.0));
    let first = Outlines::new(labels, sure.collect());
    let mut editing = Editing::new(first.clone());
    let mut unit = move || random.unit();
    let mut tried = 0;
    while editing.changes() < 2000 {
        tried += 1;
        assert!(tried < 20_000);
        let mut stroke = || -> Vec<DVec2> {
            let from = DVec2::new(unit() * 170.0 - 5.0, unit() * 130.0 - 5.0);
            let near =
                |unit: &mut dyn FnMut() -> f64| DVec2::new(unit() - 0.5, unit() - 0.5) * 60.0;
            (0..4).map(|_| from + near(&mut unit)).collect()
        };
        let stroke = stroke();
        let now = editing.now();
        let number = now.fragment_at(stroke[0]);
        let change = match tried % 8 {
            0 | 1 => now.split(&stroke),
            2 => now.merge(&stroke[..2]),
            3 => now.outline(number, &stroke),
            4 => now.brush(&stroke[..2], unit() * 6.0),
            5 => now.exclude(&stroke, unit() < 0.7),
            6 => Ok(number.map_or_else(|| now.is_right(1), |number| now.is_right(number))),
            _ if tried % 16 == 7 => Ok(now.no_rock(number.unwrap_or(1))),
            _ => Ok(now.delete(number.unwrap_or(1))),
        };
        if let Ok(change) = change {
            editing.make(change);
        }
        let labels = editing.now().labels();
        let out = labels
            .labels
            .iter()
            .filter(|label| **label == NOT_ROCK)
            .count();
        assert_eq!(labels.areas().iter().sum::<usize>() + out, width * height);
    }
    let last = editing.now().clone();
    assert_ne!(last, first);
    while editing.undo() {}
    assert_eq!(*editing.now(), first);
    while editing.redo() {}
    assert_eq!(*editing.now(), last);
}

/// What is drawn about too narrowly leaves no rim: a square of 10, of which 8 x 8 pixels are drawn about. Of one that is only
/// touched most is left.
#[test]
fn what_is_mostly_excluded_is_excluded() {
    let (width, height) = (40, 20);
    let label = |place: usize| match (place % width, place / width) {
        (5..15, 5..15) => 1,
        (15..30, 5..15) => 2,
        _ => FINES,
    };
    let labels = LabelImage {
        width,
        height,
        labels: (0..width * height).map(label).collect(),
    };
    let outlines = Outlines::new(labels, BTreeMap::new());
    let corners = [(6.0, 6.0), (17.0, 6.0), (17.0, 14.0), (6.0, 14.0)];
    let corners = corners.map(|(x, y)| DVec2::new(x, y));
    let excluded = after(&outlines, outlines.exclude(&corners, false).unwrap());
    let count = |wanted: u32| {
        let labels = excluded.labels().labels.iter();
        labels.filter(|label| **label == wanted).count()
    };
    // The first, and two columns of the second.
    assert_eq!(
        (count(1), count(2), count(NOT_ROCK)),
        (0, 150 - 16, 100 + 16)
    );
}
