//! A comparison as CSV: four tables with an empty line between them, as spreadsheets take them.

use crate::fragmentation::Comparison;

/// The tables: means of every method by size; percent errors by method and size; percentiles by method;
/// norms by method, with the improvement over every other one. What is not known is empty; numbers read
/// back to the same f64.
///
/// # Errors
/// Where memory runs out.
pub fn comparison_csv(comparison: &Comparison) -> Result<String, csv::Error> {
    let tables = [
        means(comparison),
        residuals(comparison),
        percentiles(comparison),
        norms(comparison),
    ];
    let mut texts = Vec::new();
    for table in tables {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in table {
            writer.write_record(row)?;
        }
        let bytes = writer.into_inner().map_err(|e| e.into_error())?;
        // All that went in was UTF-8.
        texts.push(String::from_utf8_lossy(&bytes).into_owned());
    }
    Ok(texts.join("\n"))
}

fn means(comparison: &Comparison) -> Vec<Vec<String>> {
    let mut rows = vec![vec![
        "method".to_owned(),
        format!("size_{}", comparison.unit),
        "mean_percent_passing".to_owned(),
        "standard_deviation".to_owned(),
        "trials".to_owned(),
    ]];
    let others = comparison.methods.iter().map(|method| &method.curve);
    for curve in std::iter::once(&comparison.reference).chain(others) {
        for point in &curve.points {
            rows.push(vec![
                curve.method.clone(),
                point.size.to_string(),
                point.mean.to_string(),
                number(point.standard_deviation),
                point.trials.to_string(),
            ]);
        }
    }
    rows
}

fn residuals(comparison: &Comparison) -> Vec<Vec<String>> {
    let mut rows = vec![vec![
        "method".to_owned(),
        format!("size_{}", comparison.unit),
        "reference_percent_passing".to_owned(),
        "percent_passing".to_owned(),
        "difference".to_owned(),
        "percent_error".to_owned(),
        format!("within_{}_percent", comparison.options.envelope_percent),
    ]];
    for method in &comparison.methods {
        for residual in &method.residuals {
            rows.push(vec![
                method.curve.method.clone(),
                residual.size.to_string(),
                residual.reference.to_string(),
                number(residual.passing),
                number(residual.difference),
                number(residual.percent_error),
                residual
                    .within
                    .map_or_else(String::new, |within| within.to_string()),
            ]);
        }
    }
    rows
}

fn percentiles(comparison: &Comparison) -> Vec<Vec<String>> {
    let unit = comparison.unit;
    let mut rows = vec![vec![
        "method".to_owned(),
        "percentile".to_owned(),
        format!("reference_{unit}"),
        format!("size_{unit}"),
        "shift_percent".to_owned(),
        format!("envelope_low_{unit}"),
        format!("envelope_high_{unit}"),
        "inside".to_owned(),
    ]];
    for method in &comparison.methods {
        for percentile in &method.shift.percentiles {
            rows.push(vec![
                method.curve.method.clone(),
                percentile.percent.to_string(),
                percentile.reference.to_string(),
                percentile.size.to_string(),
                percentile.shift_percent.to_string(),
                percentile.envelope[0].to_string(),
                percentile.envelope[1].to_string(),
                percentile.inside.to_string(),
            ]);
        }
    }
    rows
}

fn norms(comparison: &Comparison) -> Vec<Vec<String>> {
    let mut head = vec![
        "method".to_owned(),
        "rms_difference".to_owned(),
        "relative_norm_percent".to_owned(),
        "mean_shift_percent".to_owned(),
        "shift_spread_percent".to_owned(),
    ];
    let others = || comparison.methods.iter().map(|method| &method.curve.method);
    head.extend(others().map(|over| format!("improvement_percent_over_{over}")));
    let mut rows = vec![head];
    for method in &comparison.methods {
        let name = &method.curve.method;
        let mut row = vec![
            name.clone(),
            method.norm.rms_difference.to_string(),
            method.norm.relative_percent.to_string(),
            method.shift.mean_percent.to_string(),
            number(method.shift.spread_percent),
        ];
        row.extend(others().map(|over| {
            let mut all = comparison.improvements.iter();
            let found = all.find(|found| found.method == *name && found.over == *over);
            number(found.and_then(|found| found.percent))
        }));
        rows.push(row);
    }
    rows
}

fn number(number: Option<f64>) -> String {
    number.map(|number| number.to_string()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::size_distributions::comparison::test_comparison::comparison;

    #[test]
    fn four_tables() {
        let text = comparison_csv(&comparison()).unwrap();
        let tables: Vec<&str> = text.split("\n\n").collect();
        assert_eq!(tables.len(), 4);
        assert!(tables[0].starts_with(
            "method,size_mm,mean_percent_passing,standard_deviation,trials\nsieve,10,0,,1\n"
        ));
        assert!(tables[0].contains("\npoint cloud,100,88,1.5,2\n"));
        assert!(tables[1].contains("\npoint cloud,10,0,5,5,,\npoint cloud,100,80,88,8,10,true\n"));
        assert!(tables[2].contains("\npoint cloud,50,40,36,-10,28,52,true\n"));
        assert_eq!(
            tables[3],
            "method,rms_difference,relative_norm_percent,mean_shift_percent,shift_spread_percent,\
             improvement_percent_over_point cloud,improvement_percent_over_scale object\n\
             point cloud,4,9.4,-10,,,6\nscale object,4,10,-10,,-6.4,\n"
        );
    }
}
