//! Tables of an analysis of variance: in the layout of the paper's Tables II and III, as CSV, as JSON.

use serde::Serialize;

use super::text_table::{aligned, or_dash, significant, trimmed};
use crate::fault::Fault;
use crate::fragmentation::{Anova, Repeatability, Variation};
use crate::units::LengthUnit;

/// What an analysis of variance gave, and of what.
#[derive(Debug, Clone, PartialEq)]
pub struct AnovaReport {
    /// What the source between the groups is called in tables: "trial".
    pub source: String,
    /// The groups in the plural, for the verdict: "trials".
    pub groups: String,
    /// Of all values.
    pub pooled: Anova,
    /// What the other tables are by: "size".
    pub by: Option<String>,
    /// The other tables, each with its value of `by`; an error says why there is none.
    pub per: Vec<(String, Result<Anova, Fault>)>,
}

impl AnovaReport {
    /// Of one table.
    pub fn new(source: impl Into<String>, groups: impl Into<String>, pooled: Anova) -> Self {
        Self {
            source: source.into(),
            groups: groups.into(),
            pooled,
            by: None,
            per: Vec::new(),
        }
    }

    /// Of a method's trials.
    ///
    /// # Errors
    ///
    /// Where there is no pooled table.
    pub fn of_trials(trials: &Repeatability, unit: LengthUnit) -> Result<Self, Fault> {
        let sizes = trials.sizes.iter().map(|size| trimmed(*size, 6));
        Ok(Self {
            by: (!trials.per_size.is_empty()).then(|| format!("size in {unit}")),
            per: sizes.zip(trials.per_size.iter().cloned()).collect(),
            ..Self::new("trial", "trials", trials.pooled.clone()?)
        })
    }
}

/// The report as aligned text.
pub fn anova_table(report: &AnovaReport) -> String {
    let mut text = table(report, &report.pooled);
    for (value, anova) in &report.per {
        let by = report.by.as_deref().unwrap_or_default();
        text += &format!("\n{by} {value}\n");
        text += &match anova {
            Ok(anova) => table(report, anova),
            Err(fault) => format!("no table: {fault}\n"),
        };
    }
    text
}

fn table(report: &AnovaReport, anova: &Anova) -> String {
    let head = [
        "source",
        "degrees of freedom",
        "sum of squares",
        "mean square",
        "F",
        "critical F",
        "p",
    ];
    let row = |source: &str, variation: &Variation| {
        vec![
            source.to_owned(),
            variation.degrees_of_freedom.to_string(),
            trimmed(variation.sum_of_squares, 6),
        ]
    };
    let mut between = row(&report.source, &anova.between);
    between.extend([
        significant(anova.between.mean_square, 4),
        or_dash(anova.f, |f| significant(f, 4)),
        significant(anova.critical_f, 4),
        or_dash(anova.p, |p| significant(p, 4)),
    ]);
    let mut within = row("residual", &anova.within);
    within.push(significant(anova.within.mean_square, 4));
    let mut text = aligned(&[
        head.map(str::to_owned).to_vec(),
        between,
        within,
        row("total", &anova.total),
    ]);
    text += &format!(
        "{}; R squared {}, residual standard deviation {}\n",
        anova.verdict(&report.groups),
        or_dash(anova.r_squared, |r| significant(r, 4)),
        significant(anova.residual_standard_deviation, 4)
    );
    for note in &anova.notes {
        text += &format!("note: {note}\n");
    }
    text
}

/// The report as CSV, a line a source; the pooled table first, with an empty value of `by`. Numbers read
/// back to the same f64.
///
/// # Errors
/// Where memory runs out.
pub fn anova_csv(report: &AnovaReport) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let columns = [
        "source",
        "degrees_of_freedom",
        "sum_of_squares",
        "mean_square",
        "f",
        "critical_f",
        "p",
        "note",
    ];
    writer.write_record(report.by.as_deref().into_iter().chain(columns))?;
    let pooled = [(String::new(), Ok(report.pooled.clone()))];
    for (value, anova) in pooled.iter().chain(&report.per) {
        let value = report.by.as_ref().map(|_| value.as_str());
        let number = |number: Option<f64>| number.map(|n| n.to_string()).unwrap_or_default();
        let anova = match anova {
            Ok(anova) => anova,
            Err(fault) => {
                let note = fault.to_string();
                let cells = ["", "", "", "", "", "", "", &note];
                writer.write_record(value.into_iter().chain(cells))?;
                continue;
            }
        };
        for (source, variation) in [
            (report.source.as_str(), &anova.between),
            ("residual", &anova.within),
            ("total", &anova.total),
        ] {
            let is_between = std::ptr::eq(variation, &anova.between);
            let has_mean = !std::ptr::eq(variation, &anova.total);
            let between = |value: Option<f64>| number(value.filter(|_| is_between));
            let cells = [
                source.to_owned(),
                variation.degrees_of_freedom.to_string(),
                variation.sum_of_squares.to_string(),
                number(has_mean.then_some(variation.mean_square)),
                between(anova.f),
                between(Some(anova.critical_f)),
                between(anova.p),
                if is_between {
                    anova.notes.join("; ")
                } else {
                    String::new()
                },
            ];
            writer.write_record(value.into_iter().chain(cells.iter().map(String::as_str)))?;
        }
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    // All that went in was UTF-8.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

#[derive(Serialize)]
struct Between {
    df: usize,
    sum_of_squares: f64,
    mean_square: f64,
    f: Option<f64>,
    p: Option<f64>,
}

#[derive(Serialize)]
struct Within {
    df: usize,
    sum_of_squares: f64,
    mean_square: f64,
}

#[derive(Serialize)]
struct Total {
    df: usize,
    sum_of_squares: f64,
}

#[derive(Serialize)]
struct Table<'a> {
    between: Between,
    within: Within,
    total: Total,
    level: f64,
    critical_f: f64,
    r_squared: Option<f64>,
    residual_sd: f64,
    differs: Option<bool>,
    verdict: String,
    notes: &'a [String],
}

#[derive(Serialize)]
struct Part<'a> {
    value: &'a str,
    #[serde(flatten)]
    table: Option<Table<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<String>,
}

#[derive(Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    pooled: Table<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    by: Option<&'a str>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    per: Vec<Part<'a>>,
}

fn json_table<'a>(report: &AnovaReport, anova: &'a Anova) -> Table<'a> {
    Table {
        between: Between {
            df: anova.between.degrees_of_freedom,
            sum_of_squares: anova.between.sum_of_squares,
            mean_square: anova.between.mean_square,
            f: anova.f,
            p: anova.p,
        },
        within: Within {
            df: anova.within.degrees_of_freedom,
            sum_of_squares: anova.within.sum_of_squares,
            mean_square: anova.within.mean_square,
        },
        total: Total {
            df: anova.total.degrees_of_freedom,
            sum_of_squares: anova.total.sum_of_squares,
        },
        level: anova.level,
        critical_f: anova.critical_f,
        r_squared: anova.r_squared,
        residual_sd: anova.residual_standard_deviation,
        differs: anova.differs(),
        verdict: anova.verdict(&report.groups),
        notes: &anova.notes,
    }
}

/// The report as JSON text with a line break at its end: the pooled table, and with `by` one more for
/// each of its values in "per". An F without bound is null.
///
/// # Errors
/// Where memory runs out.
pub fn anova_json(report: &AnovaReport) -> serde_json::Result<String> {
    let per = report.per.iter().map(|(value, anova)| Part {
        value,
        table: anova.as_ref().ok().map(|anova| json_table(report, anova)),
        error: anova.as_ref().err().map(ToString::to_string),
    });
    let mut text = serde_json::to_string(&Report {
        pooled: json_table(report, &report.pooled),
        by: report.by.as_deref(),
        per: per.collect(),
    })?;
    text.push('\n');
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fragmentation::{
        DistributionSet, LabelledDistribution, Labels, SizeDistribution, repeatability,
    };

    fn report() -> AnovaReport {
        let pooled = Anova::of_sums((9, 8.6), (20, 1170.0), 0.05).unwrap();
        let apart = Anova::of_groups(&[[1.0, 1.0], [2.0, 2.0]], 0.05);
        let refused = Anova::of_groups(&[[1.0], [2.0]], 0.05);
        AnovaReport {
            by: Some("size".to_owned()),
            per: vec![("10".to_owned(), apart), ("20".to_owned(), refused)],
            ..AnovaReport::new("trial", "trials", pooled)
        }
    }

    /// The paper's Table III.
    #[test]
    fn text() {
        let text = anova_table(&report());
        let lines: Vec<&str> = text.lines().collect();
        let words = |line: usize| lines[line].split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(
            lines[0],
            "source    degrees of freedom  sum of squares  mean square        F  critical F      p"
        );
        assert_eq!(words(1), "trial 9 8.6 0.9556 0.01633 2.393 1.000");
        assert_eq!(words(2), "residual 20 1170 58.50");
        assert_eq!(words(3), "total 29 1178.6");
        assert!(lines[4].starts_with("trials do not differ at the 5 % level; R squared 0.007297"));
        let size = lines.iter().position(|line| *line == "size 10").unwrap();
        assert_eq!(words(size + 2), "trial 1 1 1.000 - 18.51 0");
        assert!(text.contains("\nsize 20\nno table: every group has one value only"));
    }

    /// Two trials of two photos: at 10 mm [20, 22] and [30, 32], F = 50.
    #[test]
    fn of_trials() {
        let photo = |trial: &str, photo: &str, percent| LabelledDistribution {
            labels: Labels {
                method: "cloud".to_owned(),
                trial: trial.to_owned(),
                photo: photo.to_owned(),
            },
            weight: None,
            distribution: SizeDistribution::new(vec![[10.0, percent], [25.4, 50.0]]).unwrap(),
        };
        let set = DistributionSet {
            unit: LengthUnit::Millimetre,
            curves: vec![
                photo("1", "a", 20.0),
                photo("1", "b", 22.0),
                photo("2", "a", 30.0),
                photo("2", "b", 32.0),
            ],
        };
        let trials = repeatability(&set, "cloud", &[], 0.05).unwrap();
        let report = AnovaReport::of_trials(&trials, set.unit).unwrap();
        let text = anova_table(&report);
        assert!(
            text.contains("trials do not differ at the 5 % level"),
            "{text}"
        );
        assert!(text.contains("\nsize in mm 10\n") && text.contains("\nsize in mm 25.4\n"));
        assert!(text.contains("50.00       18.51"), "{text}");
    }

    #[test]
    fn csv() {
        let text = anova_csv(&report()).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(
            lines[0],
            "size,source,degrees_of_freedom,sum_of_squares,mean_square,f,critical_f,p,note"
        );
        assert!(
            lines[1].starts_with(",trial,9,8.6,0.9555555555555555,0.01633428"),
            "{}",
            lines[1]
        );
        assert_eq!(lines[2], ",residual,20,1170,58.5,,,,");
        assert_eq!(lines[3], ",total,29,1178.6,,,,,");
        assert!(
            lines[4].starts_with("10,trial,1,1,1,,18.51"),
            "{}",
            lines[4]
        );
        assert!(
            lines[7].starts_with("20,,,,,,,,\"every group"),
            "{}",
            lines[7]
        );
    }

    #[test]
    fn json() {
        let value: serde_json::Value =
            serde_json::from_str(&anova_json(&report()).unwrap()).unwrap();
        assert_eq!(value["between"]["df"], 9);
        assert_eq!(value["between"]["sum_of_squares"], 8.6);
        assert_eq!(value["within"]["mean_square"], 58.5);
        assert_eq!(value["differs"], false);
        assert_eq!(value["by"], "size");
        assert_eq!(value["per"][0]["value"], "10");
        assert!(value["per"][0]["between"]["f"].is_null());
        assert_eq!(value["per"][0]["between"]["p"], 0.0);
        assert!(
            value["per"][1]["error"]
                .as_str()
                .unwrap()
                .contains("one value only")
        );
        assert!(value["per"][1].get("between").is_none());
    }
}
