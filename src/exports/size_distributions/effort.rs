//! Times of steps in the layout of the paper's Table I, in minutes, as text, CSV and JSON.

use serde::Serialize;

use super::text_table::{aligned, or_dash};
use crate::fragmentation::{Effort, TimeSum};

/// Seconds to minutes.
fn minutes(seconds: f64) -> f64 {
    seconds / 60.0
}

/// The table with totals and averages of rows and columns, its missing times below.
pub fn effort_text(effort: &Effort) -> String {
    let shown = |seconds: Option<f64>| or_dash(seconds, |s| format!("{:.2}", minutes(s)));
    let mut text = aligned(&cells(effort, "step (minutes)", "total", "average", shown));
    let missing = effort.missing();
    if !missing.is_empty() {
        let named: Vec<String> = missing
            .iter()
            .map(|(step, column)| format!("'{step}' of '{column}'"))
            .collect();
        text += &format!(
            "{} missing, in no total and no average: {}\n",
            match missing.len() {
                1 => "1 time is".to_owned(),
                count => format!("{count} times are"),
            },
            named.join(", ")
        );
    }
    text
}

/// The table as CSV, in minutes; a missing time is empty. Numbers read back to the same f64.
///
/// # Errors
/// Where memory runs out.
pub fn effort_csv(effort: &Effort) -> Result<String, csv::Error> {
    let shown = |seconds: Option<f64>| seconds.map(|s| minutes(s).to_string()).unwrap_or_default();
    let mut rows = cells(effort, "step", "total", "average", shown);
    if let Some(head) = rows.first_mut() {
        for name in head.iter_mut().skip(1) {
            name.push_str("_min");
        }
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row)?;
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    // All that went in was UTF-8.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The table's cells: a row a step, then totals and averages of the columns. Where totals and averages
/// of rows and columns meet: all times; the average total of a column; that of a step; the average time.
fn cells(
    effort: &Effort,
    corner: &str,
    total: &str,
    average: &str,
    shown: impl Fn(Option<f64>) -> String,
) -> Vec<Vec<String>> {
    let columns = 0..effort.columns().len();
    let mut head = vec![corner.to_owned()];
    head.extend(effort.columns().iter().cloned());
    head.extend([total.to_owned(), average.to_owned()]);
    let mut rows = vec![head];
    for (step, name) in effort.steps().iter().enumerate() {
        let sum = effort.of_step(step);
        let mut row = vec![name.clone()];
        row.extend(
            columns
                .clone()
                .map(|column| shown(effort.seconds(step, column))),
        );
        row.extend([shown(sum.known_total()), shown(sum.average())]);
        rows.push(row);
    }
    let all = effort.of_all();
    let of_columns = |of: fn(&TimeSum) -> Option<f64>| {
        columns
            .clone()
            .map(move |column| of(&effort.of_column(column)))
    };
    let mut totals = vec![total.to_owned()];
    totals.extend(of_columns(TimeSum::known_total).map(&shown));
    totals.extend([all.known_total(), effort.of_column_totals().average()].map(&shown));
    let mut averages = vec![average.to_owned()];
    averages.extend(of_columns(TimeSum::average).map(&shown));
    averages.extend([effort.of_step_totals().average(), all.average()].map(&shown));
    rows.extend([totals, averages]);
    rows
}

#[derive(Serialize)]
struct Report<'a> {
    unit: &'static str,
    columns: &'a [String],
    steps: Vec<Step<'a>>,
    column_sums: Vec<Sum>,
    all: Sum,
    average_column_total: Option<f64>,
    average_step_total: Option<f64>,
    missing: Vec<Missing<'a>>,
}

#[derive(Serialize)]
struct Step<'a> {
    step: &'a str,
    times: Vec<Option<f64>>,
    #[serde(flatten)]
    sum: Sum,
}

#[derive(Serialize)]
struct Sum {
    total: Option<f64>,
    average: Option<f64>,
    known: usize,
    missing: usize,
}

#[derive(Serialize)]
struct Missing<'a> {
    step: &'a str,
    column: &'a str,
}

impl From<TimeSum> for Sum {
    fn from(sum: TimeSum) -> Self {
        Self {
            total: sum.known_total().map(minutes),
            average: sum.average().map(minutes),
            known: sum.known,
            missing: sum.missing,
        }
    }
}

/// The table as JSON text with a line break at its end, in minutes; a missing time is null.
///
/// # Errors
/// Where memory runs out.
pub fn effort_json(effort: &Effort) -> serde_json::Result<String> {
    let columns = 0..effort.columns().len();
    let steps = effort.steps().iter().enumerate().map(|(at, name)| Step {
        step: name,
        times: (columns.clone())
            .map(|column| effort.seconds(at, column).map(minutes))
            .collect(),
        sum: effort.of_step(at).into(),
    });
    let missing = effort.missing().into_iter();
    let mut text = serde_json::to_string(&Report {
        unit: "min",
        columns: effort.columns(),
        steps: steps.collect(),
        column_sums: columns
            .clone()
            .map(|column| effort.of_column(column).into())
            .collect(),
        all: effort.of_all().into(),
        average_column_total: effort.of_column_totals().average().map(minutes),
        average_step_total: effort.of_step_totals().average().map(minutes),
        missing: missing
            .map(|(step, column)| Missing { step, column })
            .collect(),
    })?;
    text.push('\n');
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Minutes by hand: flight 10 and 12, cloud 30 and missing.
    fn effort() -> Effort {
        let mut effort = Effort::new();
        for (step, column, seconds) in [
            ("flight", "1", Some(600.0)),
            ("flight", "2", Some(720.0)),
            ("cloud", "1", Some(1800.0)),
            ("cloud", "2", None),
        ] {
            effort.add(step, column, seconds).unwrap();
        }
        effort
    }

    #[test]
    fn text() {
        assert_eq!(
            effort_text(&effort()),
            "step (minutes)      1      2  total  average\n\
             flight          10.00  12.00  22.00    11.00\n\
             cloud           30.00      -  30.00    30.00\n\
             total           40.00  12.00  52.00    26.00\n\
             average         20.00  12.00  26.00    17.33\n\
             1 time is missing, in no total and no average: 'cloud' of '2'\n"
        );
    }

    #[test]
    fn csv() {
        assert_eq!(
            effort_csv(&effort()).unwrap(),
            "step,1_min,2_min,total_min,average_min\n\
             flight,10,12,22,11\ncloud,30,,30,30\ntotal,40,12,52,26\n\
             average,20,12,26,17.333333333333332\n"
        );
    }

    #[test]
    fn json() {
        let value: serde_json::Value =
            serde_json::from_str(&effort_json(&effort()).unwrap()).unwrap();
        assert_eq!(value["unit"], "min");
        assert_eq!(value["columns"], serde_json::json!(["1", "2"]));
        assert_eq!(value["steps"][1]["step"], "cloud");
        assert_eq!(value["steps"][1]["times"], serde_json::json!([30.0, null]));
        assert_eq!(value["steps"][1]["average"], 30.0);
        assert_eq!(value["column_sums"][0]["total"], 40.0);
        assert_eq!(value["column_sums"][1]["missing"], 1);
        assert_eq!(value["all"]["total"], 52.0);
        assert_eq!(value["average_column_total"], 26.0);
        assert_eq!(
            value["missing"],
            serde_json::json!([{"step": "cloud", "column": "2"}])
        );
    }
}
