//! Places on the drawing are those of a parallel projection by hand; the figure is read by roxmltree.

use std::path::Path;

use glam::DVec2;
use roxmltree::Document;

use super::*;
use crate::camera::Pose;
use crate::units::LengthUnit;
use fragscale_core::plan::{Flown, PlannedPose, Residual};

const SOUTH_WEST: DVec3 = DVec3::new(500_000.0, 5_000_000.0, 100.0);

/// Four planned photos around a box of 40 x 20 x 10 m; the third was not taken, and one more was that nobody planned.
fn figure_in(format: DrawingFormat) -> Vec<u8> {
    let plan = |name: &str, x: f64, y: f64, z: f64| PlannedPose {
        name: name.to_owned(),
        pose: Pose::from_tilt_pan(SOUTH_WEST + DVec3::new(x, y, z), [90.0, 0.0]),
    };
    let planned = [
        plan("P001", 0.0, 0.0, 4.0),
        plan("<P&2>", 40.0, 0.0, 4.0),
        plan("P003", 40.0, 20.0, 10.0),
        plan("P004", 0.0, 20.0, 4.0),
    ];
    let offset = DVec3::new(2.0, 1.0, -1.0);
    let residual = |photo: usize| Residual {
        photo,
        offset,
        tilt: 0.0,
        pan: 0.0,
        turn: 0.0,
        shared: None,
    };
    let places = [
        planned[0].pose.center + offset,
        SOUTH_WEST + DVec3::new(20.0, 10.0, 0.0),
        planned[1].pose.center + DVec3::new(-2.0, 1.0, 1.0),
        planned[3].pose.center + DVec3::new(2.0, -1.0, 1.0),
    ];
    let flown = Flown {
        residuals: vec![
            Some(residual(0)),
            Some(residual(2)),
            None,
            Some(residual(3)),
        ],
        unplanned: vec![1],
    };
    let report = FlownReport {
        flight: "Bench 7 < east",
        unit: LengthUnit::Metre,
        planned: &planned,
        photos: &["1.jpg", "EXTRA.jpg", "2.jpg", "4.jpg"].map(str::to_owned),
        flown: &flown,
    };
    let figure = FlownFigure {
        report: &report,
        places: &places,
        is_on_map: true,
    };
    figure.bytes(format).unwrap()
}

fn points(text: &str) -> Vec<DVec2> {
    let point = |text: &str| {
        let (x, y) = text.split_once(',').unwrap();
        DVec2::new(x.parse().unwrap(), y.parse().unwrap())
    };
    text.split(' ').map(point).collect()
}

/// From azimuth 205 degrees the eye looks to 25; right of that is 115: east is cos 25 to the right and sin 25 away,
/// north sin 25 to the left and cos 25 away. From 30 degrees above, what is away goes up by sin 30 of it, heights by
/// cos 30.
#[test]
fn places_are_projected_without_perspective() {
    let (sine, cosine) = (0.422_618_261_7, 0.906_307_787_0);
    let shown = |off: DVec3| {
        let right = off.x * cosine - off.y * sine;
        let up = (off.x * sine + off.y * cosine) * 0.5 + off.z * 0.866_025_403_8;
        DVec2::new(right, -up)
    };
    let svg = String::from_utf8(figure_in(DrawingFormat::Svg)).unwrap();
    let document = Document::parse(&svg).unwrap();
    let drawn = |tag: &str, attribute: &str, value: &str| -> Vec<Vec<DVec2>> {
        (document.descendants())
            .filter(|node| node.has_tag_name(tag) && node.attribute(attribute) == Some(value))
            .filter_map(|node| Some(points(node.attribute("points")?)))
            .collect()
    };
    // The height of the box alone goes straight up.
    let edges = drawn("polyline", "stroke-width", "1");
    let upright = edges
        .iter()
        .filter(|edge| edge.len() == 2 && (edge[0].x - edge[1].x).abs() < 0.02);
    let longest = upright
        .map(|edge| edge[0].distance(edge[1]))
        .fold(0.0, f64::max);
    let scale = longest / 0.866_025_403_8 / 10.0;
    assert!(scale > 5.0, "{scale}");
    let has = |lines: &[Vec<DVec2>], from: DVec2, to: DVec2| {
        let near = |a: DVec2, b: DVec2| a.distance(b) < 0.05;
        let is_it = |line: &Vec<DVec2>| {
            line.len() == 2
                && (near(line[0], from) && near(line[1], to)
                    || near(line[0], to) && near(line[1], from))
        };
        lines.iter().any(is_it)
    };
    // The floor's near corner is where the lowest edge begins.
    let lowest = edges
        .iter()
        .filter(|edge| edge.len() == 2)
        .flatten()
        .copied();
    let corner = lowest.reduce(|a, b| if a.y > b.y { a } else { b }).unwrap();
    let place = |x: f64, y: f64, z: f64| corner + shown(DVec3::new(x, y, z)) * scale;
    for to in [[40.0, 0.0, 0.0], [0.0, 20.0, 0.0], [0.0, 0.0, 10.0]] {
        assert!(has(&edges, corner, place(to[0], to[1], to[2])), "{to:?}");
    }
    // The corner that is hidden: its three edges are dashed.
    let hidden = drawn("polyline", "stroke", "#969696");
    assert_eq!(hidden.len(), 3);
    assert!(has(
        &hidden,
        place(40.0, 20.0, 0.0),
        place(40.0, 20.0, 10.0)
    ));
    // Marks: the last of each place has no rim.
    let middles = |fill: &str| -> Vec<DVec2> {
        let marks = drawn("polygon", "fill", fill);
        marks
            .iter()
            .map(|mark| mark.iter().sum::<DVec2>() / mark.len() as f64)
            .collect()
    };
    let at = |fill: &str, point: DVec2| middles(fill).iter().any(|mark| mark.distance(point) < 0.8);
    for [x, y, z] in [
        [0.0, 0.0, 4.0],
        [40.0, 0.0, 4.0],
        [40.0, 20.0, 10.0],
        [0.0, 20.0, 4.0],
    ] {
        assert!(at("#0072B2", place(x, y, z)), "{x} {y} {z}");
    }
    for [x, y, z] in [[2.0, 1.0, 3.0], [38.0, 1.0, 5.0], [2.0, 19.0, 5.0]] {
        assert!(at("#D55E00", place(x, y, z)), "{x} {y} {z}");
    }
    assert!(at("#009E73", place(20.0, 10.0, 0.0)));
    // Pairs are joined; the missing one is crossed, in the view and in the legend.
    let joins = drawn("polyline", "stroke-width", "1.6");
    assert!(has(&joins, place(0.0, 0.0, 4.0), place(2.0, 1.0, 3.0)));
    let crosses = drawn("polyline", "stroke", "#B90F28");
    assert_eq!(crosses.len(), 4);
    let middle = (crosses[0][0] + crosses[0][1]) / 2.0;
    assert!(middle.distance(place(40.0, 20.0, 10.0)) < 0.05);
}

#[test]
fn names_lengths_and_counts_are_said() {
    let svg = String::from_utf8(figure_in(DrawingFormat::Svg)).unwrap();
    let document = Document::parse(&svg).unwrap();
    let texts: Vec<&str> = (document.descendants())
        .filter(|node| node.has_tag_name("text"))
        .map(|node| node.text().unwrap_or_default())
        .collect();
    for words in [
        "P001",
        "<P&2>",
        "P003",
        "P004",
        "EXTRA.jpg",
        "N",
        "x 40.0 m",
        "y 20.0 m",
        "z 10.0 m",
        "planned: 4 photos",
        "flown: 4 photos",
        "not taken: 1",
        "not planned: 1",
        "Bench 7 < east: planned and flown",
    ] {
        assert_eq!(
            texts.iter().filter(|text| **text == words).count(),
            1,
            "{words} {texts:?}"
        );
    }
    // sqrt(2² + 1²).
    assert!(
        texts
            .iter()
            .any(|text| text.contains("taken 3 of 4 planned; level, rms 2.24 m")),
        "{texts:?}"
    );
}

#[test]
fn every_format_has_its_ending() {
    assert!(figure_in(DrawingFormat::Pdf).starts_with(b"%PDF-1.4"));
    assert!(figure_in(DrawingFormat::Png).starts_with(b"\x89PNG"));
    for (name, format) in [
        ("a.SVG", DrawingFormat::Svg),
        ("a.pdf", DrawingFormat::Pdf),
        ("a.png", DrawingFormat::Png),
    ] {
        assert_eq!(DrawingFormat::of(Path::new(name)), Ok(format));
    }
    let fault = DrawingFormat::of(Path::new("a.tif")).unwrap_err();
    assert_eq!(fault.remedy, "let its name end in .svg, .pdf or .png");
}

/// One photo has a box without a size.
#[test]
fn a_single_place_is_drawn() {
    let planned = [PlannedPose {
        name: "P001".to_owned(),
        pose: Pose::from_tilt_pan(SOUTH_WEST, [90.0, 0.0]),
    }];
    let flown = Flown {
        residuals: vec![None],
        unplanned: Vec::new(),
    };
    let report = FlownReport {
        flight: "one",
        unit: LengthUnit::Metre,
        planned: &planned,
        photos: &[],
        flown: &flown,
    };
    let figure = FlownFigure {
        report: &report,
        places: &[],
        is_on_map: false,
    };
    let svg = String::from_utf8(figure.bytes(DrawingFormat::Svg).unwrap()).unwrap();
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    assert!(svg.contains(">P001<") && svg.contains(">y<"));
}
