//! The report read back as XML, which it is too.

use roxmltree::{Document, Node, ParsingOptions};

use super::*;
use crate::fragmentation::{
    DistributionSet, LabelledDistribution, Labels, SizeDistribution, repeatability,
};
use crate::size_distributions::comparison::test_comparison::comparison;
use crate::units::LengthUnit;

fn parsed(html: &str) -> Document<'_> {
    let options = ParsingOptions {
        allow_dtd: true,
        ..ParsingOptions::default()
    };
    Document::parse_with_options(html, options).expect("XML")
}

fn html(comparison: &Comparison, repeatability: &[Repeatability], warnings: &[String]) -> String {
    let report = ComparisonReport {
        sources: &["distributions.csv".to_owned()],
        comparison,
        repeatability: repeatability.iter().collect(),
        preparation: &["Photos: merged with equal weights".to_owned()],
        warnings: warnings.to_vec(),
    };
    comparison_report(&report)
}

fn named<'a>(document: &'a Document<'_>, name: &'a str) -> impl Iterator<Item = Node<'a, 'a>> {
    let all = document.root().descendants();
    all.filter(move |node| node.tag_name().name() == name)
}

/// The cells of the rows that begin with this text, in all tables.
fn rows(document: &Document<'_>, first: &str) -> Vec<Vec<String>> {
    let rows = named(document, "tr").map(|row| {
        let cells = row
            .children()
            .map(|cell| cell.text().unwrap_or_default().to_owned());
        cells.collect::<Vec<String>>()
    });
    rows.filter(|row| row.first().is_some_and(|cell| cell == first))
        .collect()
}

#[test]
fn says_what_was_found() {
    let page = html(&comparison(), &[], &[]);
    let document = parsed(&page);
    assert_eq!(named(&document, "svg").count(), 1);
    assert_eq!(
        named(&document, "h1").next().and_then(|h| h.text()),
        Some("point cloud, scale object against sieve")
    );
    // What was compared, how near, its fit.
    assert_eq!(
        rows(&document, "point cloud")[..2],
        [
            vec!["point cloud", "2", "2", "10", "100"],
            vec![
                "point cloud",
                "4.000",
                "9.4",
                "\u{2212}10.0",
                "\u{2013}",
                "1 of 1"
            ],
        ]
    );
    assert_eq!(rows(&document, "point cloud")[2][1], "150.0 (\u{2013})");
    let median = rows(&document, "P50").swap_remove(0);
    // With the band of a fit that leaves next to nothing.
    assert!(
        median[1].starts_with("40.00 (40.00 to 40.00)"),
        "{median:?}"
    );
    assert_eq!(
        [&median[0], &median[2], &median[4], &median[5]],
        ["P50", "28.00 to 52.00", "\u{2212}10.0", "inside"]
    );
    // Where nothing of the reference passes, no percent error is defined.
    assert_eq!(
        rows(&document, "10")[0],
        ["10", "0.0", "5.0", "+5.0", "\u{2013}", "\u{2013}"]
    );
    assert_eq!(
        rows(&document, "100")[0],
        ["100", "80.0", "88.0", "+8.0", "+10.0", "inside"]
    );
    assert!(page.contains(
        "&#39;point cloud&#39; is nearer to &#39;sieve&#39; than &#39;scale object&#39; by 6.0 %"
    ));
    // The other way round it is the same said twice.
    assert!(!page.contains("6.4 %"));
    for said in [
        "look twice",
        "beyond what was measured",
        PERCENT_ERROR.get(..40).expect("a sentence"),
    ] {
        assert!(page.contains(said), "{said}");
    }
}

/// A passing that nobody measured has a star, which is explained below its table alone.
#[test]
fn what_is_interpolated_has_a_star() {
    let mut comparison = comparison();
    assert!(!html(&comparison, &[], &[]).contains("* interpolated"));
    comparison.methods[0].residuals[1].interpolated = true;
    let page = html(&comparison, &[], &[]);
    let document = parsed(&page);
    let at_hundred = rows(&document, "100");
    assert_eq!(
        at_hundred[0],
        ["100", "80.0", "88.0*", "+8.0", "+10.0", "inside"]
    );
    assert_eq!(at_hundred[1][2], "88.0");
    let said: Vec<&str> = named(&document, "p").filter_map(|p| p.text()).collect();
    let said = said.iter().filter(|said| said.starts_with('*'));
    assert_eq!(
        said.collect::<Vec<_>>(),
        [
            &"* interpolated between the sizes beside it: not every trial of 'point cloud' was measured at this one"
        ]
    );
}

#[test]
fn nothing_from_outside_becomes_markup() {
    let nasty = "</td></svg><script>alert(1)</script>&\"'\u{0}";
    let mut comparison = comparison();
    comparison.reference.method = nasty.to_owned();
    for method in &mut comparison.methods {
        method.curve.method = nasty.to_owned();
        method.notes.push(nasty.to_owned());
    }
    let page = html(&comparison, &[], &[nasty.to_owned()]);
    assert_eq!(named(&parsed(&page), "script").count(), 0);
}

/// The groups 1 2 3, 2 3 4 and 3 4 5: 6 between and 6 within, F = 3 / 1.
#[test]
fn variances_in_the_papers_layout() {
    let curve = |trial: usize, photo: usize| LabelledDistribution {
        labels: Labels {
            method: "cloud".to_owned(),
            trial: trial.to_string(),
            photo: photo.to_string(),
        },
        weight: None,
        distribution: SizeDistribution::new(vec![[10.0, (trial + photo) as f64], [200.0, 100.0]])
            .expect("a distribution"),
    };
    let curves = (0..3).flat_map(|trial| (1..4).map(move |photo| curve(trial, photo)));
    let set = DistributionSet {
        unit: LengthUnit::Millimetre,
        curves: curves.collect(),
    };
    let found = repeatability(&set, "cloud", &[10.0], 0.05).expect("an analysis");
    let page = html(&comparison(), &[found], &[]);
    let document = parsed(&page);
    assert_eq!(
        rows(&document, "Trial")[0],
        ["Trial", "2", "6.000", "3.000", "3.0000"]
    );
    assert_eq!(
        rows(&document, "Residual")[0],
        ["Residual", "6", "6.000", "1.000", ""]
    );
    // F(2, 6; 0.05) = 5.143, by any table.
    let at_ten = rows(&document, "10");
    let at_ten = at_ten.last().expect("a row");
    assert_eq!(at_ten[1..4], ["2, 6", "3.0000", "5.143"]);
    assert_eq!(at_ten[5], "alike");
}
