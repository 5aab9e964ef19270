//! A plan straight down over a level square, whose places on paper are known by hand; the page is read by roxmltree.

use std::f64::consts::FRAC_PI_2;

use glam::DVec2;
use roxmltree::{Document, Node};

use super::*;
use crate::camera::{Camera, Distortion};
use crate::jobs::Progress;
use crate::surface::{Cloud, Surface};
use crate::survey::Polygon;
use crate::units::LengthUnit;
use fragscale_core::plan::{Pace, Pattern, Plan, Refused, Size, Way, Wish};

const MIDDLE: DVec2 = DVec2::new(500_000.0, 5_000_000.0);

/// 600 x 400 pixels with 500 of focal length: from 20 m it shows 24 m x 16 m.
fn camera() -> Camera {
    Camera {
        name: String::new(),
        width: 600,
        height: 400,
        fx: 500.0,
        fy: 500.0,
        cx: 300.0,
        cy: 200.0,
        skew: 0.0,
        distortion: Distortion::None,
    }
}

/// 200 m x 200 m, level.
fn surface() -> Surface {
    let points = (0..101 * 101).map(|i| {
        let place = DVec2::new(f64::from(i % 101), f64::from(i / 101)) * 2.0 - 100.0;
        (place + MIDDLE).extend(100.0)
    });
    Surface::new(Cloud {
        points: points.collect(),
        ..Cloud::default()
    })
    .unwrap()
}

fn plan(surface: &Surface) -> Plan {
    let corners = [(-30.0, -20.0), (30.0, -20.0), (30.0, 20.0), (-30.0, 20.0)];
    let corners = corners.map(|corner| MIDDLE + DVec2::from(corner));
    let misfire = [(60.0, 30.0), (75.0, 30.0), (75.0, 45.0)];
    let misfire = misfire.map(|corner| MIDDLE + DVec2::from(corner));
    let size = Size::Scale {
        pixels: 25.0,
        within: Some(0.5),
    };
    let wish = Wish {
        tilt: 90.0,
        keep_out: vec![Polygon::new(&misfire).unwrap()],
        take_off: Some(MIDDLE - 50.0),
        ..Wish::usual(Pattern::Paper, size, None, 1.0)
    };
    let area = Polygon::new(&corners).unwrap();
    let mut plan = Plan::new(surface, &camera(), area, wish, &Progress::default()).unwrap();
    plan.photos[0].name = "<b>P&1".to_owned();
    plan.refused.push(Refused {
        place: MIDDLE + DVec2::new(35.0, 0.0),
        why: "it lies > 3 below".to_owned(),
    });
    plan
}

/// The page, its map apart as a document.
struct Sheet {
    page: String,
    map: String,
    plan: Plan,
    ways: Vec<Way>,
}

fn sheet(world: LengthUnit, with_take_off: bool) -> Sheet {
    let surface = surface();
    let plan = plan(&surface);
    let pace = Pace {
        speed: 4.0,
        stop: 3.0,
        battery: None,
        climb: 4.0,
        descent: 4.0,
        steepest: None,
    };
    let ways = match with_take_off {
        true => Way::through(&plan, &surface, MIDDLE - 50.0, &pace).unwrap(),
        false => Vec::new(),
    };
    let report = PlanReport {
        flight: "Bench 7 < east",
        world,
        scales: LengthUnit::Metre,
        plan: &plan,
        ways: &ways,
        pace,
        is_nominal: false,
        sun: None,
    };
    let sheet = FlightSheet {
        report: &report,
        drone: Some("DJI Mavic 3 Enterprise, wide camera"),
        settle: 2.0,
        crs: Some("EPSG:32632"),
        warnings: &[
            "a <warning> & more".to_owned(),
            "no photo at (500035.00, 5000000.00): it lies > 3 below".to_owned(),
        ],
    };
    let page = flight_sheet(&sheet).unwrap();
    let from = page.find("<svg").unwrap();
    let to = page.find("</svg>").unwrap() + 6;
    let map = page[from..to].to_owned();
    Sheet {
        page,
        map,
        plan,
        ways,
    }
}

/// Of a text of the map, where it is.
fn text_at(map: &Document<'_>, is_it: impl Fn(&str) -> bool) -> Option<(DVec2, String)> {
    let mut texts = map.descendants().filter(|node| node.has_tag_name("text"));
    let found = texts.find(|node| is_it(node.text().unwrap_or_default()))?;
    let number = |name: &str| found.attribute(name).unwrap().parse::<f64>().unwrap();
    let words = found.text().unwrap_or_default().to_owned();
    Some((DVec2::new(number("x"), number("y")), words))
}

fn points(node: Node<'_, '_>) -> Vec<DVec2> {
    let points = node.attribute("points").unwrap_or_default().split(' ');
    let point = |text: &str| {
        let (x, y) = text.split_once(',').unwrap();
        DVec2::new(x.parse().unwrap(), y.parse().unwrap())
    };
    points.filter(|text| !text.is_empty()).map(point).collect()
}

/// 25.4 mm are an inch, an inch 96 CSS pixels: from the coordinates at the grid and the scale that the page says, the
/// edges of each footprint follow, 12 m and 8 m from what its middle shows.
#[test]
fn places_on_paper_are_those_of_the_scale() {
    let sheet = sheet(LengthUnit::Metre, true);
    let map = Document::parse(&sheet.map).unwrap();
    let root = map.root_element();
    let wide: f64 = root.attribute("width").unwrap().parse().unwrap();
    // A4 less its margins.
    assert!(wide / 96.0 * 25.4 <= 186.0);
    let (_, words) = text_at(&map, |text| text.starts_with("1 : ")).unwrap();
    let denominator = words.split([' ', ',']).nth(2).unwrap();
    let denominator: f64 = denominator.parse().unwrap();
    // Pixels of CSS to a metre of the world.
    let scale = 1000.0 / denominator / 25.4 * 96.0;
    let (east, _) = text_at(&map, |text| text == "500000").unwrap();
    let north = text_at(&map, |text| text == "5000000").unwrap().0;
    // Words that read upwards turn about the place that their transform says.
    let turned = (map.descendants())
        .find(|node| node.text() == Some("5000000") && node.is_element())
        .and_then(|node| node.attribute("transform"))
        .unwrap();
    let y: f64 = turned
        .trim_end_matches(')')
        .rsplit(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((north.y - y).abs() < 5.0);
    let place = |point: DVec2| {
        let off = (point - MIDDLE) * scale;
        DVec2::new(east.x + off.x, y - off.y)
    };
    let drawn: Vec<Vec<DVec2>> = (map.descendants())
        .filter(|node| node.has_tag_name("polyline"))
        .map(points)
        .collect();
    let has = |points: &[DVec2]| {
        let near = |outline: &&Vec<DVec2>| {
            points
                .iter()
                .all(|point| outline.iter().any(|at| at.distance(*point) < 0.02))
        };
        drawn.iter().any(|outline| near(&outline))
    };
    for photo in &sheet.plan.photos {
        let turn = DVec2::from_angle(photo.pan.to_radians() - FRAC_PI_2);
        let middle = place(photo.pose.center.truncate());
        // Along the photo's top edge and up in it, from its middle, in metres.
        let is_it = |outline: &&Vec<DVec2>| {
            let offs = outline.iter().map(|at| {
                let off = (*at - middle) / scale;
                turn.rotate(DVec2::new(off.x, -off.y))
            });
            let (low, high) = offs.fold((DVec2::MAX, DVec2::MIN), |(low, high), off| {
                (low.min(off), high.max(off))
            });
            let half = DVec2::new(8.0, 12.0);
            low.distance(-half) < 0.01 && high.distance(half) < 0.01
        };
        assert_eq!(drawn.iter().filter(is_it).count(), 1, "{}", photo.name);
    }
    let misfire = [(60.0, 30.0), (75.0, 30.0), (75.0, 45.0)];
    assert!(has(
        &misfire.map(|corner| place(MIDDLE + DVec2::from(corner)))
    ));
    // The area, and the way from the take-off over all photos.
    let area = [(-30.0, -20.0), (30.0, -20.0), (30.0, 20.0), (-30.0, 20.0)];
    assert!(has(&area.map(|corner| place(MIDDLE + DVec2::from(corner)))));
    let stops = sheet
        .plan
        .photos
        .iter()
        .map(|photo| photo.pose.center.truncate());
    let way: Vec<DVec2> = stops.chain([MIDDLE - 50.0]).map(place).collect();
    assert!(has(&way), "{way:?}");
    // The bar: its words against its length on paper.
    let (_, words) = text_at(&map, |text| text.ends_with(" m")).unwrap();
    let metres: f64 = words.trim_end_matches(" m").parse().unwrap();
    let bars = drawn.iter().filter(|line| {
        let size = line.iter().fold(DVec2::MIN, |a, b| a.max(*b))
            - line.iter().fold(DVec2::MAX, |a, b| a.min(*b));
        (size.y - 6.0).abs() < 0.02 && (size.x - metres * scale).abs() < 0.02
    });
    assert_eq!(bars.count(), 1, "{words}");
}

#[test]
fn everything_is_said_and_nothing_becomes_markup() {
    let sheet = sheet(LengthUnit::Metre, true);
    let page = Document::parse(sheet.page.trim_start_matches("<!DOCTYPE html>")).unwrap();
    assert!(!sheet.page.contains("<b>") && !sheet.page.contains("<warning>"));
    let texts: Vec<&str> = (page.descendants())
        .filter_map(|node| node.is_text().then(|| node.text()).flatten())
        .collect();
    let has = |words: &str| texts.contains(&words);
    assert!(has("Flight plan: Bench 7 < east") && has("a <warning> & more"));
    let cells: Vec<&str> = (page.descendants())
        .filter(|node| node.has_tag_name("td"))
        .map(|node| node.text().unwrap_or_default())
        .collect();
    let map = Document::parse(&sheet.map).unwrap();
    assert!(sheet.plan.photos.len() > 4);
    for photo in &sheet.plan.photos {
        assert!(cells.contains(&photo.name.as_str()), "{}", photo.name);
        assert!(
            text_at(&map, |text| text == photo.name).is_some(),
            "{}",
            photo.name
        );
    }
    // The refused one has its name in both, and its reason.
    assert!(cells.contains(&"R1") && cells.contains(&"it lies > 3 below"));
    assert!(text_at(&map, |text| text == "R1").is_some());
    assert!(!sheet.page.contains("no photo at"));
    assert!(text_at(&map, |text| text == "take-off").is_some());
    // From 20 m above level ground, everywhere 25 px/m.
    assert_eq!(
        cells.iter().filter(|cell| **cell == "25.00").count(),
        2 * sheet.plan.photos.len()
    );
    assert!(has("25 ± 0.5 px/m"));
    assert!(has("-90°"));
    // On the ground's level, 20 m below the photos: the safe height is theirs.
    assert!((sheet.ways[0].safe_height - 120.0).abs() < 1e-6);
    assert!(has("20.0 m above take-off") && has("at least 20 m above take-off"));
    // EPSG:32632 has its middle meridian at 9 degrees, 500 000 m: 50 m to the west of it.
    assert!(has("x 499950.00, y 4999950.00 m"));
    let on_earth = |text: &&str| text.starts_with("N 45.1") && text.contains("°, E 8.999");
    assert!(texts.iter().any(on_earth));
    let ticks = page
        .descendants()
        .filter(|node| node.attribute("class") == Some("boxes"));
    assert_eq!(
        ticks
            .flat_map(|list| list.children().filter(Node::is_element))
            .count(),
        12
    );
}

/// Without a take-off there is no way, and the sheet says what that means; heights in feet are said in metres, too.
#[test]
fn what_is_not_known_is_said() {
    let without = sheet(LengthUnit::Metre, false);
    assert!(without.page.contains("plan made again with --take-off"));
    assert!(!without.page.contains("Safe height") && !without.page.contains(">take-off<"));
    // 20 ft are 6.1 m, rounded up to 7.
    let in_feet = sheet(LengthUnit::Foot, true);
    assert!(in_feet.page.contains("at least 20 ft (7 m) above take-off"));
}
