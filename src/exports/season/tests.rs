use super::*;
use crate::files::is_own_result;
use crate::units::LengthUnit;

fn row(blast: &str, date: Option<&str>, p50: Option<[f64; 3]>) -> SeasonRow {
    let sizes = p50.map(|[size, low, high]| {
        [(20.0, 0.5), (50.0, 1.0), (80.0, 2.0)].map(|(percent, factor)| FoundSize {
            percent,
            size: Some(size * factor),
            low: Some(low * factor),
            high: Some(high * factor),
        })
    });
    SeasonRow {
        blast: blast.to_owned(),
        date: date.and_then(|date| date.parse().ok()),
        flight: format!("flights/{blast}"),
        results: blast.to_owned(),
        findings: Some(FlightFindings {
            photos: 9,
            verdicts: VerdictCounts {
                trust: 7,
                check: 2,
                ..VerdictCounts::default()
            },
            sizes: sizes.map(Vec::from).unwrap_or_default(),
            shifts: vec![SizeShift {
                percent: 50.0,
                off_percent: -3.25,
            }],
            taken: None,
            warnings: vec!["it is <dark>".to_owned()],
        }),
        error: None,
    }
}

fn report() -> SeasonReport<'static> {
    let mut failed = row("C", None, None);
    failed.findings = None;
    failed.error = Some("flights/C: there is no such file; check the path".to_owned());
    SeasonReport {
        name: "North <pit>",
        unit: LengthUnit::Centimetre,
        rows: vec![
            row("A", Some("2026-05-01"), Some([12.0, 10.0, 15.0])),
            row("B", Some("2026-05-08"), Some([16.0, 13.0, 20.0])),
            failed,
            row("D", None, None),
        ],
        notes: vec!["2 folders hold no flight: docs".to_owned()],
    }
}

#[test]
fn the_table_has_every_flight() {
    let csv = season_csv(&report()).unwrap();
    assert!(is_own_result(csv.as_bytes()));
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let heads = reader.headers().unwrap().clone();
    let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.unwrap()).collect();
    let cell = |row: usize, head: &str| {
        let column = heads.iter().position(|known| known == head).unwrap();
        rows[row][column].to_owned()
    };
    assert_eq!(rows.len(), 4);
    assert_eq!(cell(0, "p80_cm"), "24");
    assert_eq!(cell(0, "p20_low_cm"), "5");
    assert_eq!(cell(1, "p50_high_cm"), "20");
    assert_eq!(cell(1, "date"), "2026-05-08");
    assert_eq!(
        (cell(0, "trust"), cell(0, "check"), cell(0, "no_scale")),
        ("7".into(), "2".into(), "0".into())
    );
    assert_eq!(cell(0, "p50_off_reference_percent"), "-3.25");
    // Beside a flight's psd.csv, whose sizes are others.
    assert_eq!(cell(0, "sizes_are"), "as measured, of all photos together");
    assert_eq!(
        (cell(2, "sizes_are"), cell(3, "sizes_are")),
        (String::new(), String::new())
    );
    assert_eq!(
        (cell(2, "state"), cell(2, "photos"), cell(2, "p50_cm")),
        ("failed".into(), String::new(), String::new())
    );
    assert!(cell(2, "error").contains("no such file"));
    assert_eq!(cell(3, "p50_cm"), "");
    assert_eq!(cell(3, "warnings"), "1");
}

#[test]
fn a_line_of_json_is_a_flight() {
    let lines = season_json_lines(&report()).unwrap();
    assert!(is_own_result(lines.as_bytes()));
    let lines: Vec<serde_json::Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    assert_eq!(lines.len(), 4);
    assert_eq!(lines[0]["sizes"][2]["size"], 24.0);
    assert_eq!(lines[0]["verdicts"]["trust"], 7);
    assert_eq!(lines[0]["error"], serde_json::Value::Null);
    assert_eq!(lines[2]["state"], "failed");
    assert_eq!(lines[3]["sizes"], serde_json::json!([]));
}

/// The page is XML but for its first line; nothing from outside becomes markup; the trend has a marker and an interval
/// for each blast with sizes, at the height of its size.
#[test]
fn the_page_shows_the_trend() {
    let page = season_page(&report());
    assert!(is_own_result(page.as_bytes()));
    let text = page.strip_prefix("<!DOCTYPE html>\n").unwrap();
    let document = roxmltree::Document::parse(text).unwrap();
    assert!(page.contains("North &lt;pit&gt;") && page.contains("it is &lt;dark&gt;"));
    let colour = |node: &roxmltree::Node<'_, '_>, colour: &str| {
        node.attribute("fill") == Some(colour) || node.attribute("stroke") == Some(colour)
    };
    let p50 = "#1E64AA";
    let middles: Vec<[f64; 2]> = document
        .descendants()
        .filter(|node| node.has_tag_name("polygon") && colour(node, p50))
        .map(|node| {
            let points: Vec<[f64; 2]> = node
                .attribute("points")
                .unwrap()
                .split_whitespace()
                .map(|point| {
                    let (x, y) = point.split_once(',').unwrap();
                    [x.parse().unwrap(), y.parse().unwrap()]
                })
                .collect();
            let count = points.len() as f64;
            let sum = points
                .iter()
                .fold([0.0; 2], |sum, at| [sum[0] + at[0], sum[1] + at[1]]);
            [sum[0] / count, sum[1] / count]
        })
        .collect();
    // Two blasts and the legend.
    assert_eq!(middles.len(), 3, "{middles:?}");
    // The labels of the axis say what height is what size.
    let label = |text: &str| {
        let node = document.descendants().find(|node| {
            node.has_tag_name("text")
                && node.text() == Some(text)
                && node.attribute("text-anchor") == Some("end")
        });
        let y: f64 = node.unwrap().attribute("y").unwrap().parse().unwrap();
        y
    };
    let (none, twenty) = (label("0"), label("20"));
    let size = |y: f64, shift: f64| 20.0 * (none - shift - y) / (none - twenty);
    // Text stands a little lower than the line that it names.
    let shift = 0.36 * 12.0 / 1.24;
    assert!(
        (size(middles[0][1], shift) - 12.0).abs() < 0.1,
        "{}",
        size(middles[0][1], shift)
    );
    assert!((size(middles[1][1], shift) - 16.0).abs() < 0.1);
    assert!(middles[0][0] < middles[1][0]);

    let said = "are as measured, of all photos together. Those in psd.csv";
    assert!(page.contains(said));

    let mut none = report();
    none.rows.truncate(0);
    none.rows.push(row("D", None, None));
    if let Some(findings) = &mut none.rows[0].findings {
        findings.shifts.clear();
    }
    let none = season_page(&none);
    assert!(!none.contains("<svg") && !none.contains(said));
}

#[test]
fn people_read_a_table() {
    let text = season_table(&report());
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].contains("P50 cm"));
    assert!(
        lines[1].contains("7 trust, 2 check") && lines[1].contains("12"),
        "{text}"
    );
    assert!(lines[3].contains("failed"), "{text}");
}
