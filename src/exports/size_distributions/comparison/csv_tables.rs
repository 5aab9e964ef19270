//! A comparison as CSV: one table that programs and spreadsheets read, whose column `part` says what a line is of.

use crate::fragmentation::{Comparison, MeasuredNorm, MethodCurve};

/// Its columns. UNIT is that of the sizes, ENVELOPE half the envelope's width. (The first two and the last three also stood about the
/// first table of earlier versions: by them a file is known as one that may be written over, `files/marks.rs`.)
const COLUMNS: [&str; 28] = [
    "method",
    "size_UNIT",
    "part",
    "percentile",
    "fitted_function",
    "over",
    "reference_size_UNIT",
    "shift_percent",
    "envelope_low_UNIT",
    "envelope_high_UNIT",
    "percent_passing",
    "reference_percent_passing",
    "difference",
    "percent_error",
    "within_ENVELOPE_percent",
    "interpolated",
    "rms_difference",
    "relative_norm_percent",
    "measured_from_UNIT",
    "measured_to_UNIT",
    "measured_rms_difference",
    "measured_relative_norm_percent",
    "mean_shift_percent",
    "shift_spread_percent",
    "improvement_percent",
    "mean_percent_passing",
    "standard_deviation",
    "trials",
];

/// The cells of a line by their columns; the others are empty.
type Line = Vec<(&'static str, String)>;

/// The lines of its parts, one part after another: `mean` of every method by size, the reference's first; `error` by method and size;
/// `percentile` and `norm` by method; `improvement` of a method over every other one. `interpolated`: not measured at this size, but taken
/// from those beside it. `fitted_function`: what the sizes of percentiles, their shifts and the norms are of, which are not as measured. The
/// norm comes once over all of the reference's function and once where both were measured. What is not known is empty; numbers read back to
/// the same f64.
///
/// # Errors
/// Where memory runs out.
pub fn comparison_csv(comparison: &Comparison) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let unit = comparison.unit.to_string();
    let envelope = comparison.options.envelope_percent.to_string();
    let names = COLUMNS.map(|name| name.replace("UNIT", &unit).replace("ENVELOPE", &envelope));
    writer.write_record(names)?;
    let parts = [
        ("mean", means(comparison)),
        ("error", errors(comparison)),
        ("percentile", percentiles(comparison)),
        ("norm", norms(comparison)),
        ("improvement", improvements(comparison)),
    ];
    for (part, lines) in parts {
        for line in &lines {
            writer.write_record(COLUMNS.map(|column| match column {
                "part" => part,
                _ => cell(line, column),
            }))?;
        }
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    // All that went in was UTF-8.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn cell<'a>(line: &'a [(&'static str, String)], column: &str) -> &'a str {
    let found = line.iter().find(|(name, _)| *name == column);
    found.map_or("", |(_, value)| value.as_str())
}

fn means(comparison: &Comparison) -> Vec<Line> {
    let others = comparison.methods.iter().map(|method| &method.curve);
    let curves = std::iter::once(&comparison.reference).chain(others);
    let lines = curves.flat_map(|curve| {
        curve.points.iter().map(move |point| {
            vec![
                ("method", curve.method.clone()),
                ("size_UNIT", point.size.to_string()),
                ("mean_percent_passing", point.mean.to_string()),
                ("standard_deviation", number(point.standard_deviation)),
                ("trials", point.trials.to_string()),
            ]
        })
    });
    lines.collect()
}

fn errors(comparison: &Comparison) -> Vec<Line> {
    let lines = comparison.methods.iter().flat_map(|method| {
        method.residuals.iter().map(move |residual| {
            let within = residual.within.map(|within| within.to_string());
            // Of what is not known there is nothing to interpolate.
            let interpolated = residual.passing.map(|_| residual.interpolated.to_string());
            vec![
                ("method", method.curve.method.clone()),
                ("size_UNIT", residual.size.to_string()),
                ("percent_passing", number(residual.passing)),
                ("reference_percent_passing", residual.reference.to_string()),
                ("difference", number(residual.difference)),
                ("percent_error", number(residual.percent_error)),
                ("within_ENVELOPE_percent", within.unwrap_or_default()),
                ("interpolated", interpolated.unwrap_or_default()),
            ]
        })
    });
    lines.collect()
}

fn percentiles(comparison: &Comparison) -> Vec<Line> {
    let lines = comparison.methods.iter().flat_map(|method| {
        method.shift.percentiles.iter().map(move |percentile| {
            let [low, high] = percentile.envelope;
            vec![
                ("method", method.curve.method.clone()),
                ("size_UNIT", percentile.size.to_string()),
                ("percentile", percentile.percent.to_string()),
                ("fitted_function", function(&method.curve)),
                ("reference_size_UNIT", percentile.reference.to_string()),
                ("shift_percent", percentile.shift_percent.to_string()),
                ("envelope_low_UNIT", low.to_string()),
                ("envelope_high_UNIT", high.to_string()),
                ("within_ENVELOPE_percent", percentile.inside.to_string()),
            ]
        })
    });
    lines.collect()
}

fn norms(comparison: &Comparison) -> Vec<Line> {
    let lines = comparison.methods.iter().map(|method| {
        let (norm, shift) = (&method.norm, &method.shift);
        let measured =
            |value: fn(&MeasuredNorm) -> f64| number(method.measured_norm.as_ref().map(value));
        vec![
            ("method", method.curve.method.clone()),
            ("fitted_function", function(&method.curve)),
            ("rms_difference", norm.rms_difference.to_string()),
            ("relative_norm_percent", norm.relative_percent.to_string()),
            ("measured_from_UNIT", measured(|of| of.from)),
            ("measured_to_UNIT", measured(|of| of.to)),
            (
                "measured_rms_difference",
                measured(|of| of.norm.rms_difference),
            ),
            (
                "measured_relative_norm_percent",
                measured(|of| of.norm.relative_percent),
            ),
            ("mean_shift_percent", shift.mean_percent.to_string()),
            ("shift_spread_percent", number(shift.spread_percent)),
        ]
    });
    lines.collect()
}

/// The reference's is the same.
fn function(curve: &MethodCurve) -> String {
    curve.fit.model.key().to_owned()
}

fn improvements(comparison: &Comparison) -> Vec<Line> {
    let lines = comparison.improvements.iter().map(|improvement| {
        vec![
            ("method", improvement.method.clone()),
            ("over", improvement.over.clone()),
            ("improvement_percent", number(improvement.percent)),
        ]
    });
    lines.collect()
}

fn number(number: Option<f64>) -> String {
    number.map(|number| number.to_string()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::size_distributions::comparison::test_comparison::comparison;

    /// One table: as many cells in every line as there are columns, and every cell in a column of its name.
    #[test]
    fn a_program_reads_it_as_one_table() {
        let mut comparison = comparison();
        comparison.methods[1].residuals[1].interpolated = true;
        let text = comparison_csv(&comparison).unwrap();
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let names = reader.headers().unwrap().clone();
        let lines: Vec<csv::StringRecord> = reader.records().map(|line| line.unwrap()).collect();
        // Two sizes of three curves; two sizes, one percentile, one norm and one improvement of two methods.
        assert_eq!(lines.len(), 6 + 4 + 2 + 2 + 2);
        let said = |line: &csv::StringRecord| -> String {
            let cells = names.iter().zip(line).filter(|(_, cell)| !cell.is_empty());
            let cells: Vec<String> = cells.map(|(name, cell)| format!("{name} {cell}")).collect();
            cells.join(", ")
        };
        let said: Vec<String> = lines.iter().map(said).collect();
        for (index, line) in [
            (
                0,
                "method sieve, size_mm 10, part mean, mean_percent_passing 0, trials 1",
            ),
            (
                3,
                "method point cloud, size_mm 100, part mean, mean_percent_passing 88, standard_deviation 1.5, trials 2",
            ),
            (
                6,
                "method point cloud, size_mm 10, part error, percent_passing 5, reference_percent_passing 0, difference 5, \
                 interpolated false",
            ),
            (
                7,
                "method point cloud, size_mm 100, part error, percent_passing 88, reference_percent_passing 80, difference 8, \
                 percent_error 10, within_30_percent true, interpolated false",
            ),
            (
                9,
                "method scale object, size_mm 100, part error, percent_passing 88, reference_percent_passing 80, difference 8, \
                 percent_error 10, within_30_percent true, interpolated true",
            ),
            (
                10,
                "method point cloud, size_mm 36, part percentile, percentile 50, fitted_function swebrec, reference_size_mm 40, \
                 shift_percent -10, envelope_low_mm 28, envelope_high_mm 52, within_30_percent true",
            ),
            (
                12,
                "method point cloud, part norm, fitted_function swebrec, rms_difference 4, relative_norm_percent 9.4, measured_from_mm 10, measured_to_mm 100, \
                 measured_rms_difference 3, measured_relative_norm_percent 5, mean_shift_percent -10",
            ),
            (
                15,
                "method scale object, part improvement, over point cloud, improvement_percent -6.4",
            ),
        ] {
            assert_eq!(said[index], line);
        }
    }
}
