//! Figures read back: places of points by the axes that are drawn, both formats, bad names and numbers.

use roxmltree::{Document, Node};

use super::*;
use crate::fragmentation::{
    Comparison, ComparisonOptions, CurveNorm, Fit, FitOptions, MeanPoint, MethodComparison,
    MethodCurve, Model, PercentError, Shift, SizeDistribution, Span, Swebrec, fit,
};
use crate::units::LengthUnit;

fn series(name: &str, style: FigureStyle, points: Vec<[f64; 2]>) -> Series {
    Series {
        name: name.to_owned(),
        style,
        line: points.clone(),
        points,
        marks: Vec::new(),
    }
}

/// A figure from 10 to 1000 mm.
fn figure(series: Vec<Series>) -> FigureContents {
    FigureContents {
        title: "A figure".to_owned(),
        sizes: SizeAxis::covering("Size, mm", [11.0, 900.0]),
        passing: panels::passing_panel(Vec::new(), series),
        residuals: None,
    }
}

/// Numbers of a list such as "1,2 3,4 ".
fn numbers(points: &str) -> Vec<[f64; 2]> {
    let pairs = points.split_whitespace().map(|pair| {
        let (x, y) = pair.split_once(',').expect("a pair");
        [x.parse().expect("x"), y.parse().expect("y")]
    });
    pairs.collect()
}

fn number(node: Node<'_, '_>, attribute: &str) -> f64 {
    let text = node.attribute(attribute).expect(attribute);
    text.parse().expect(attribute)
}

/// Where the labels with this text are, in the order in which they are drawn.
fn labels(document: &Document<'_>, text: &str) -> Vec<[f64; 2]> {
    let texts = document
        .descendants()
        .filter(|node| node.tag_name().name() == "text");
    texts
        .filter(|node| node.text().map(str::trim) == Some(text))
        .map(|node| [number(node, "x"), number(node, "y")])
        .collect()
}

/// Outlines filled with a colour, their middles.
fn markers(document: &Document<'_>, colour: &str) -> Vec<[f64; 2]> {
    let filled = document.descendants().filter(|node| {
        node.tag_name().name() == "polygon" && node.attribute("fill") == Some(colour)
    });
    filled
        .map(|node| {
            let points = numbers(node.attribute("points").expect("points"));
            let middle = |axis: usize| {
                let all = points.iter().map(|p| p[axis]);
                let (low, high) = all.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
                (low + high) / 2.0
            };
            [middle(0), middle(1)]
        })
        .collect()
}

/// 31.6 mm is half way from 10 to 100 mm, 25 % half way from 20 to 30 %: by the labels that people
/// read the axes by, not by what the drawing computes.
#[test]
fn a_point_is_where_the_axes_say() {
    let style = FigureStyle::of(1);
    let svg = figure_svg(&figure(vec![series(
        "a",
        style,
        vec![[1000.0_f64.sqrt(), 25.0]],
    )]));
    let document = Document::parse(&svg).expect("XML");
    // 20 is a percent and a size.
    let [[_, twenty], [left, _]] = labels(&document, "20")[..] else {
        panic!("20 at both axes");
    };
    let right = labels(&document, "200")[0][0];
    let thirty = labels(&document, "30")[0][1];
    // From 20 to 200 is one decade, of which 31.6 is log10(31.6 / 20).
    let x = left + (right - left) * (1000.0_f64.sqrt() / 20.0).log10();
    // Labels are put lower than their middle, all by the same: that of 0 and the frame say by how much.
    let lower = labels(&document, "0")[0][1] - frame_bottom(&document);
    let y = (twenty + thirty) / 2.0 - lower;
    let found = markers(&document, "#0072B2");
    // The first is in the panel, the second in the legend.
    assert_eq!(found.len(), 2);
    assert!((found[0][0] - x).abs() <= 0.02, "{found:?}, {x}");
    assert!((found[0][1] - y).abs() <= 0.02, "{found:?}, {y}");
}

/// The lowest end of the frame's dark strokes.
fn frame_bottom(document: &Document<'_>) -> f64 {
    let strokes = document.descendants().filter(|node| {
        node.tag_name().name() == "polyline" && node.attribute("stroke") == Some("#222222")
    });
    let ends = strokes.flat_map(|node| numbers(node.attribute("points").expect("points")));
    ends.map(|p| p[1]).fold(f64::MIN, f64::max)
}

/// The middle of the same point's marker in the PNG has its colour, two to a unit of the SVG.
#[test]
fn both_formats_are_the_same_figure() {
    let style = FigureStyle::of(1);
    let contents = figure(vec![series("a", style, vec![[50.0, 40.0], [300.0, 90.0]])]);
    let svg = figure_svg(&contents);
    let document = Document::parse(&svg).expect("XML");
    let png = figure_png(&contents).expect("a figure");
    let picture = image::load_from_memory(&png).expect("a PNG").to_rgb8();
    let root = document.root_element();
    assert_eq!(f64::from(picture.width()), 2.0 * number(root, "width"));
    assert_eq!(f64::from(picture.height()), 2.0 * number(root, "height"));
    let found = markers(&document, "#0072B2");
    assert_eq!(found.len(), 3);
    for [x, y] in found {
        let pixel = picture.get_pixel((2.0 * x) as u32, (2.0 * y) as u32);
        assert_eq!(pixel.0, style.colour, "at {x}, {y}");
    }
    // Print needs a white ground.
    assert_eq!(picture.get_pixel(0, 0).0, [255; 3]);
}

#[test]
fn names_from_outside_are_text() {
    let nasty = "<&\"' </svg><script>\u{0}\u{ffff}\n\u{1b}";
    let mut contents = figure(vec![series(
        nasty,
        FigureStyle::REFERENCE,
        vec![[50.0, 40.0]],
    )]);
    contents.title = nasty.to_owned();
    contents.sizes.title = nasty.to_owned();
    contents.passing.axis_title = nasty.to_owned();
    let svg = figure_svg(&contents);
    let document = Document::parse(&svg).expect("XML");
    let clean = "<&\"' </svg><script>";
    let is_it = |node: &Node<'_, '_>| node.text().is_some_and(|text| text.trim() == clean);
    let texts = document.descendants().filter(|n| n.is_element());
    // The title, the titles of both axes, the legend.
    assert_eq!(texts.filter(is_it).count(), 4);
    assert!(
        !document
            .descendants()
            .any(|node| node.tag_name().name() == "script")
    );
    let title = document
        .root_element()
        .first_element_child()
        .expect("a title");
    assert_eq!(title.tag_name().name(), "title");
    assert!(title.text().expect("words").starts_with(clean));
    figure_png(&contents).expect("a figure");
}

/// Nothing that a measurement or a fit may give stops the figure or leaves a number that is none.
#[test]
fn degenerate_contents_are_drawn() {
    let wild = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        -1.0,
        0.0,
        1e-300,
        1e300,
        50.0,
    ];
    let all: Vec<[f64; 2]> = wild.iter().flat_map(|x| wild.map(|y| [*x, y])).collect();
    let mut contents = figure(vec![series("wild", FigureStyle::of(3), all.clone())]);
    contents.passing.series[0].marks = all.clone();
    contents.passing.bands = vec![Band {
        name: "band".to_owned(),
        style: FigureStyle::of(5),
        outlined: true,
        edges: [all.clone(), all.clone()],
    }];
    contents.residuals = Some(panels::residual_panel(
        "Left".to_owned(),
        45.0,
        vec![30.0],
        contents.passing.series.clone(),
    ));
    let mut empty = figure(Vec::new());
    empty.title = String::new();
    empty.sizes = SizeAxis::covering("", []);
    let one = figure(vec![series("one", FigureStyle::of(1), vec![[50.0, 40.0]])]);
    let mut same = figure(vec![series(
        "same",
        FigureStyle::of(4),
        vec![[50.0, 40.0]; 3],
    )]);
    same.sizes = SizeAxis::covering("", [50.0]);
    let mut many = figure(
        (0..3000)
            .map(|i| series(&"long ".repeat(60), FigureStyle::of(i), Vec::new()))
            .collect(),
    );
    many.title = "long ".repeat(1000);
    for contents in [contents, empty, one, same, many] {
        let svg = figure_svg(&contents);
        Document::parse(&svg).expect("XML");
        assert!(
            !svg.contains("NaN") && !svg.contains("inf"),
            "{}",
            contents.title
        );
        let png = figure_png(&contents).expect("a figure");
        let picture = image::load_from_memory(&png).expect("a PNG");
        assert_eq!(picture.width(), 1800);
        assert!(picture.height() < 3600, "{}", picture.height());
    }
}

/// +300 % is beyond an axis to 150 %: an arrow at its end says how much.
#[test]
fn what_is_beyond_the_axis_is_said() {
    let errors = vec![series(
        "a",
        FigureStyle::of(1),
        vec![[50.0, 300.0], [100.0, -40.0]],
    )];
    let panel = panels::residual_panel("Error, %".to_owned(), 45.0, vec![-30.0, 30.0], errors);
    assert_eq!(panel.range, [-150.0, 150.0]);
    let mut contents = figure(Vec::new());
    contents.residuals = Some(panel);
    let svg = figure_svg(&contents);
    let document = Document::parse(&svg).expect("XML");
    assert_eq!(labels(&document, "+300").len(), 1);
}

/// The fit to a Swebrec with xmax 4.5 times its median and b = 2.2, with residuals in round numbers.
fn fitted(median: f64) -> Fit {
    let swebrec = Swebrec::new(median, 4.5 * median, 2.2).expect("a curve");
    let sizes = [0.1, 0.2, 0.5, 1.0, 2.0, 4.0].map(|share| share * median);
    let points = sizes.map(|size| [size, 100.0 * swebrec.passing(size)]);
    let measured = SizeDistribution::new(points.to_vec()).expect("points");
    let mut found = fit(&measured, Model::Swebrec, &FitOptions::default()).expect("a fit");
    found.residuals = vec![1.0, -1.0];
    found
}

fn method(name: &str, trials: usize, median: f64) -> MethodCurve {
    let point = |size, mean| MeanPoint {
        size,
        mean,
        standard_deviation: (trials > 1).then_some(5.0),
        trials,
    };
    MethodCurve {
        method: name.to_owned(),
        trials: (1..=trials).map(|t| t.to_string()).collect(),
        points: vec![point(20.0, 2.0), point(80.0, 50.0), point(300.0, 99.0)],
        fit: fitted(median),
    }
}

#[test]
fn a_comparison_shows_what_it_found() {
    let error = |size, percent_error| PercentError {
        size,
        reference: 0.0,
        passing: None,
        interpolated: false,
        difference: None,
        percent_error,
        within: None,
    };
    let comparison = Comparison {
        unit: LengthUnit::Millimetre,
        options: ComparisonOptions::new("sieve"),
        reference: method("sieve", 1, 80.0),
        span: Span {
            from: 1.0,
            to: 360.0,
            to_percent: 100.0,
        },
        methods: vec![MethodComparison {
            curve: method("point cloud", 10, 100.0),
            residuals: vec![
                error(20.0, None),
                error(80.0, Some(-12.0)),
                error(300.0, Some(0.0)),
            ],
            norm: CurveNorm {
                rms_difference: 1.0,
                relative_percent: 1.0,
            },
            measured_norm: None,
            shift: Shift {
                percentiles: Vec::new(),
                mean_percent: 0.0,
                spread_percent: None,
                looks_like_scale: false,
            },
            notes: Vec::new(),
        }],
        improvements: Vec::new(),
        notes: Vec::new(),
    };
    let contents = figure_of_comparison(&comparison);
    let [sieve, cloud] = &contents.passing.series[..] else {
        panic!("two series");
    };
    assert_eq!(
        (sieve.style, cloud.style),
        (FigureStyle::REFERENCE, FigureStyle::of(1))
    );
    assert!(
        cloud.name.contains("10 trials") && cloud.name.contains("P50 100"),
        "{}",
        cloud.name
    );
    let [median, _] = &sieve.marks[..] else {
        panic!("P50 and P80");
    };
    assert!(
        (median[0] - 80.0).abs() < 1e-6 && median[1] == 50.0,
        "{median:?}"
    );
    let [envelope, spread] = &contents.passing.bands[..] else {
        panic!("two bands");
    };
    // 30 % about the median of 80 mm.
    for (edge, size) in envelope.edges.iter().zip([56.0, 104.0]) {
        let found = edge.iter().find(|point| point[1] == 50.0).expect("P50");
        assert!((found[0] - size).abs() < 1e-6, "{found:?}");
    }
    // 2 less 5 is nothing that passes.
    assert_eq!(spread.edges[0], [[20.0, 0.0], [80.0, 45.0], [300.0, 94.0]]);
    assert_eq!(spread.edges[1], [[20.0, 7.0], [80.0, 55.0], [300.0, 100.0]]);
    let errors = contents.residuals.as_ref().expect("errors");
    assert_eq!(errors.levels, [-30.0, 30.0]);
    assert_eq!(errors.series[1].points, [[80.0, -12.0], [300.0, 0.0]]);
    figure_svg(&contents);
}

#[test]
fn a_fit_shows_its_points_and_what_is_left() {
    let distribution = SizeDistribution::new(vec![[40.0, 20.0], [200.0, 90.0]]).expect("points");
    let fit = fitted(80.0);
    let of = FittedDistribution {
        name: String::new(),
        distribution: &distribution,
        fit: &fit,
    };
    let contents = figure_of_fits("A sieve", LengthUnit::Inch, &[of]);
    assert_eq!(contents.sizes.title, "Size, in");
    let [series] = &contents.passing.series[..] else {
        panic!("one series");
    };
    assert_eq!(series.points, [[40.0, 20.0], [200.0, 90.0]]);
    let left = contents.residuals.as_ref().expect("residuals");
    assert_eq!(left.series[0].points, [[40.0, 1.0], [200.0, -1.0]]);
    // Through the median, and to its top at 360.
    let at = |size: f64| {
        series
            .line
            .iter()
            .min_by(|a, b| (a[0] - size).abs().total_cmp(&(b[0] - size).abs()))
            .expect("a line")
    };
    assert!((at(80.0)[1] - 50.0).abs() < 1.0, "{:?}", at(80.0));
    let top = at(360.0);
    assert!((top[0] - 360.0).abs() < 1e-3 && top[1] > 99.999, "{top:?}");
}
