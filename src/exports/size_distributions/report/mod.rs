//! The report of a comparison: one HTML file without scripts, for a screen or A4 paper.

mod numbers;
mod repeatability;
#[cfg(test)]
#[allow(
    clippy::expect_used,
    clippy::panic,
    reason = "in a test a panic is the report"
)]
mod tests;

use numbers::{measured, number};

use super::fit::NOT_DETERMINED;
use super::{comparison_notes, curves, figure_of_comparison, figure_svg, method_name, star};
use crate::fault::Fault;
use crate::fragmentation::{
    Analysis, Comparison, Fit, MethodComparison, PERCENT_ERROR, Repeatability, SCALE_WARNING,
};
use crate::html_page::{
    self, Cell, NONE, heading, inside, names, notes, paragraph, percent, signed, table,
};
use crate::markup::escaped;

/// Confidence of the bands.
const LEVEL: f64 = 0.95;

/// What goes into the report of a comparison.
#[derive(Debug, Clone)]
pub struct ComparisonReport<'a> {
    /// The files that were read.
    pub sources: &'a [String],
    /// The comparison.
    pub comparison: &'a Comparison,
    /// Of each method with trials.
    pub repeatability: Vec<&'a Repeatability>,
    /// What was done before comparing, a sentence each: merging, resampling.
    pub preparation: &'a [String],
    /// What was mended or left out, a sentence each.
    pub warnings: Vec<String>,
}

impl<'a> ComparisonReport<'a> {
    /// Of an analysis of these sources; `mended` is what was noticed when they were read.
    ///
    /// # Errors
    ///
    /// Nothing was compared.
    pub fn of(
        sources: &'a [String],
        mended: Vec<String>,
        analysis: &'a Analysis,
    ) -> Result<Self, Fault> {
        let noticed = analysis.warnings.iter().cloned();
        let mut warnings = mended;
        warnings.extend(noticed.chain(analysis.not_analysed()));
        let tables = analysis.repeatability.iter();
        Ok(Self {
            sources,
            comparison: analysis.comparison.as_ref().map_err(Clone::clone)?,
            repeatability: tables.filter_map(|(_, t)| t.as_ref().ok()).collect(),
            preparation: &analysis.steps,
            warnings,
        })
    }
}

/// The report as HTML, with its figure in it.
pub fn comparison_report(report: &ComparisonReport<'_>) -> String {
    let comparison = report.comparison;
    let mut figure = figure_of_comparison(comparison);
    // The page has it as its own.
    let title = std::mem::take(&mut figure.title);
    let drawing = html_page::figure(&figure_svg(&figure));
    let methods = comparison.methods.iter();
    let methods: String = methods.map(|m| of_method(m, comparison)).collect();
    let body = [
        compared(report),
        drawing,
        summary(comparison),
        fits(comparison),
        methods,
        trials(comparison),
        repeatability::tables(&report.repeatability, comparison.unit),
        definitions(comparison),
    ];
    let window = format!("{title}: size distributions");
    html_page::page(&title, &window, &body.concat())
}

/// What was compared, and what to know before reading on.
fn compared(report: &ComparisonReport<'_>) -> String {
    let comparison = report.comparison;
    let unit = comparison.unit;
    let mut html = paragraph(&format!(
        "Size distributions of {}, held against '{}'. Sizes are in {unit}; percents are of the mass \
         that passes.",
        report.sources.join(", "),
        method_name(&comparison.reference.method)
    ));
    for sentence in report.preparation {
        html += &paragraph(sentence);
    }
    let rows = curves(comparison).map(|curve| {
        let sizes = |point: Option<f64>| point.map_or(NONE.to_owned(), measured);
        vec![
            method_name(&curve.method).into(),
            curve.trials.len().to_string().into(),
            curve.points.len().to_string().into(),
            sizes(curve.points.first().map(|p| p.size)).into(),
            sizes(curve.points.last().map(|p| p.size)).into(),
        ]
    });
    let head = [
        "Method".to_owned(),
        "Trials".to_owned(),
        "Sizes".to_owned(),
        format!("Smallest, {unit}"),
        format!("Largest, {unit}"),
    ];
    html += &table(&head, rows.collect());
    let known = comparison_notes(comparison);
    html + &notes(report.warnings.iter().chain(&known))
}

/// How near each method is, in one table.
fn summary(comparison: &Comparison) -> String {
    let mut html = heading(2, "How near to the reference");
    let rows = comparison.methods.iter().map(|method| {
        let judged = method
            .residuals
            .iter()
            .filter_map(|residual| residual.within);
        let (good, all) = judged.fold((0, 0), |(good, all), within| {
            (good + i32::from(within), all + 1)
        });
        vec![
            Cell::from(method_name(&method.curve.method)),
            number(method.norm.rms_difference).into(),
            percent(Some(method.norm.relative_percent)).into(),
            signed(Some(method.shift.mean_percent)).into(),
            percent(method.shift.spread_percent).into(),
            format!("{good} of {all}").into(),
        ]
    });
    let head = [
        "Method".to_owned(),
        "2-norm, points".to_owned(),
        "2-norm, %".to_owned(),
        "Mean shift of Pxx, %".to_owned(),
        "Spread of shifts, %".to_owned(),
        format!(
            "Sizes within \u{b1}{} %",
            comparison.options.envelope_percent
        ),
    ];
    html += &table(&head, rows.collect());
    let better = comparison.improvements.iter().filter_map(|improvement| {
        let percent = improvement.percent.filter(|percent| *percent > 0.0)?;
        Some(format!(
            "'{}' is nearer to '{}' than '{}' by {percent:.1} % of the 2-norm.",
            method_name(&improvement.method),
            method_name(&comparison.reference.method),
            method_name(&improvement.over)
        ))
    });
    for sentence in better {
        html += &paragraph(&sentence);
    }
    html
}

/// The fitted functions.
fn fits(comparison: &Comparison) -> String {
    let unit = comparison.unit;
    let model = comparison.options.model;
    let mut head = names(&["Method"]);
    for name in model.parameter_names() {
        head.push(match name.starts_with('x') {
            true => format!("{name}, {unit}"),
            false => (*name).to_owned(),
        });
    }
    head.extend(names(&[
        "R\u{b2}",
        "RMSE, points",
        "Residual sum of squares",
        "Degrees of freedom",
    ]));
    let rows = curves(comparison).map(|curve| {
        let mut row = vec![Cell::from(method_name(&curve.method))];
        for name in model.parameter_names() {
            let found = curve.fit.parameters.iter().find(|p| p.name == *name);
            row.push(
                found
                    .map_or(NONE.to_owned(), |parameter| {
                        let error = parameter.standard_error.map_or(NONE.to_owned(), number);
                        match curve.fit.determines(name) {
                            true => format!("{} ({error})", number(parameter.value)),
                            false => NOT_DETERMINED.to_owned(),
                        }
                    })
                    .into(),
            );
        }
        let Fit {
            r_squared,
            rmse,
            residual_sum_of_squares,
            degrees_of_freedom,
            ..
        } = &curve.fit;
        row.push(format!("{r_squared:.5}").into());
        row.push(number(*rmse).into());
        row.push(number(*residual_sum_of_squares).into());
        row.push(degrees_of_freedom.to_string().into());
        row
    });
    let mut html = heading(2, &format!("Fitted functions: {}", model.name()));
    html += &paragraph("In brackets the standard errors.");
    html + &table(&head, rows.collect())
}

/// Percentiles and residuals of a method.
fn of_method(method: &MethodComparison, comparison: &Comparison) -> String {
    let unit = comparison.unit;
    let name = method_name(&method.curve.method);
    let reference = method_name(&comparison.reference.method);
    let envelope = comparison.options.envelope_percent;
    let sized = |fit: &Fit, percent: f64| {
        let found = fit.percentile(percent, LEVEL);
        let size = number(found.size);
        match found.band {
            Some([low, high]) => format!("{size} ({} to {})", number(low), number(high)),
            None => size,
        }
    };
    let rows = method.shift.percentiles.iter().map(|found| {
        vec![
            format!("P{}", found.percent).into(),
            sized(&comparison.reference.fit, found.percent).into(),
            format!(
                "{} to {}",
                number(found.envelope[0]),
                number(found.envelope[1])
            )
            .into(),
            sized(&method.curve.fit, found.percent).into(),
            signed(Some(found.shift_percent)).into(),
            inside(Some(found.inside)),
        ]
    });
    let head = [
        "Passing".to_owned(),
        format!("{reference}, {unit} (95 %)"),
        format!("\u{b1}{envelope} %, {unit}"),
        format!("{name}, {unit} (95 %)"),
        "Shift, %".to_owned(),
        "Envelope".to_owned(),
    ];
    let mut html = heading(2, &format!("{name} against {reference}"));
    html += &heading(3, "Sizes that given percents pass, by the fitted functions");
    html += &table(&head, rows.collect());
    let rows = method.residuals.iter().map(|residual| {
        let mark = match residual.interpolated {
            true => "*",
            false => "",
        };
        vec![
            measured(residual.size).into(),
            percent(Some(residual.reference)).into(),
            (percent(residual.passing) + mark).into(),
            signed(residual.difference).into(),
            signed(residual.percent_error).into(),
            inside(residual.within),
        ]
    });
    let head = [
        format!("Size, {unit}"),
        format!("{reference}, %"),
        format!("{name}, %"),
        "Difference, points".to_owned(),
        "Percent error".to_owned(),
        format!("\u{b1}{envelope} %"),
    ];
    html += &heading(3, "Percent passing at the measured sizes");
    html += &table(&head, rows.collect());
    if let Some(star) = star(method) {
        html += &paragraph(&star);
    }
    html
}

/// Mean and standard deviation of the methods with trials.
fn trials(comparison: &Comparison) -> String {
    let unit = comparison.unit;
    let mut html = String::new();
    for curve in curves(comparison).filter(|curve| curve.trials.len() > 1) {
        let rows = curve.points.iter().map(|point| {
            vec![
                Cell::from(measured(point.size)),
                percent(Some(point.mean)).into(),
                percent(point.standard_deviation).into(),
                point.trials.to_string().into(),
            ]
        });
        let head = [
            format!("Size, {unit}"),
            "Mean passing, %".to_owned(),
            "Standard deviation, points".to_owned(),
            "Trials".to_owned(),
        ];
        html += &heading(3, method_name(&curve.method));
        html += &table(&head, rows.collect());
    }
    match html.is_empty() {
        true => html,
        false => heading(2, "Mean and spread of the trials") + &html,
    }
}

/// What the words mean.
fn definitions(comparison: &Comparison) -> String {
    let unit = comparison.unit;
    let span = comparison.span;
    let envelope = comparison.options.envelope_percent;
    let meant = [
        ("Percent error", PERCENT_ERROR.to_owned()),
        (
            "2-norm",
            format!(
                "root of the mean squared difference between the fitted functions of a method and of \
                 the reference, over sizes from {} to {} {unit} (the reference's P1 to P{}) evenly in \
                 the logarithm of the size; in percent, of the same norm of the reference's function",
                number(span.from), number(span.to), span.to_percent
            ),
        ),
        (
            "Shift",
            "100 (size - reference) / reference of the size that a percent passes, by the fitted \
             functions; above 0 the method says that the rock is coarser".to_owned(),
        ),
        (
            "Envelope",
            format!(
                "the reference's fitted size, \u{b1}{envelope} %, after Sanchidri\u{e1}n, Segarra, \
                 Ouchterlony and L\u{f3}pez, Rock Mechanics and Rock Engineering 42 (2009) 95-116; \
                 {SCALE_WARNING}"
            ),
        ),
        (
            "Confidence (95 %)",
            "of photos, how far they differ from each other: the function is fitted again without one photo (or trial) after another; of one \
             photo alone nobody knows. Of what was sieved, how far the points lie about the function, as if each had been measured by \
             itself. 95 of 100 such bands hold the true size, if the fitted function is the right one; what is wrong with all photos alike \
             (outlines, the scale) they do not hold, but the intervals of delineate's sizes.csv do"
                .to_owned(),
        ),
        (
            "Points",
            "percentage points: 40 % less 30 % are 10 points".to_owned(),
        ),
    ];
    let meant = meant.iter().map(|(word, meaning)| {
        format!("<dt>{}</dt><dd>{}.</dd>\n", escaped(word), escaped(meaning))
    });
    let meant: String = meant.collect();
    format!("{}<dl>\n{meant}</dl>\n", heading(2, "What the words mean"))
}
