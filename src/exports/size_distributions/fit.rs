//! Fitted functions going out: a table for people, CSV, JSON.

use serde::{Serialize, Serializer};

use super::text_table::{aligned, or_dash, significant, trimmed};
use crate::fragmentation::{Fit, FitOptions, LabelledDistribution, Percentile, TOPSIZE_PERCENT};
use crate::units::LengthUnit;

/// Functions fitted to the curves of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct FitReport {
    unit: LengthUnit,
    curves: Vec<FittedCurve>,
    level: f64,
    percents: Vec<f64>,
}

/// A curve with the function fitted to it.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedCurve {
    label: String,
    /// [size, percent passing].
    points: Vec<[f64; 2]>,
    weights: Option<Vec<f64>>,
    xmax_given: bool,
    fit: Fit,
}

impl FittedCurve {
    /// The fit of a curve, made with these options.
    pub fn new(curve: &LabelledDistribution, fit: Fit, options: &FitOptions) -> Self {
        Self {
            label: curve.labels.to_string(),
            points: curve.distribution.points().to_vec(),
            weights: options.weights.clone(),
            xmax_given: options.xmax.is_some(),
            fit,
        }
    }

    /// The fit itself.
    pub fn fit(&self) -> &Fit {
        &self.fit
    }
}

impl FitReport {
    /// Fits with sizes in `unit`, their bands at a confidence of `level`, and their percentiles: every
    /// ten from 10 to 90 and those asked for.
    pub fn new(
        unit: LengthUnit,
        curves: Vec<FittedCurve>,
        level: f64,
        percentiles: &[f64],
    ) -> Self {
        let tens = (1..10).map(|ten| 10.0 * f64::from(ten));
        let mut percents: Vec<f64> = tens.chain(percentiles.iter().copied()).collect();
        percents.sort_by(f64::total_cmp);
        percents.dedup();
        Self {
            unit,
            curves,
            level,
            percents,
        }
    }

    fn percentiles(&self, fit: &Fit) -> Vec<Percentile> {
        let percents = self.percents.iter();
        percents
            .map(|percent| fit.percentile(*percent, self.level))
            .collect()
    }
}

/// What people read in the place of a parameter's value that means nothing.
pub(super) const NOT_DETERMINED: &str = "not determined";

/// Why parameters of curves have no value in the report's CSV, a sentence each.
pub fn fit_csv_warnings(report: &FitReport) -> Vec<String> {
    let of_curve = |FittedCurve { label, fit, .. }: &FittedCurve| -> Vec<String> {
        let all = fit.not_determined.iter();
        all.map(|of| match label.is_empty() {
            true => of.why.clone(),
            false => format!("{label}: {}", of.why),
        })
        .collect()
    };
    report.curves.iter().flat_map(of_curve).collect()
}

/// The report as aligned text: parameters, how well they fit, percentiles, points, notes.
pub fn fit_table(report: &FitReport) -> String {
    let curves = report.curves.iter();
    let tables: Vec<String> = curves.map(|curve| table(report, curve)).collect();
    tables.join("\n")
}

/// Sizes that differ by less than this share are the same, to people and to the search of the fit: it gives a measured P80 back as
/// 210.00000000000003.
const SAME_SIZE: f64 = 1e-6;

/// Which of the sizes that a function gives, by their names, lie beyond those that were measured; nothing where none does.
fn beyond(points: &[[f64; 2]], given: &[(String, f64)], unit: LengthUnit) -> String {
    let sizes = points.iter().map(|[size, _]| *size);
    let least = sizes.clone().fold(f64::INFINITY, f64::min);
    let greatest = sizes.fold(f64::NEG_INFINITY, f64::max);
    let named = |is_it: &dyn Fn(f64) -> bool, end: &str, size: f64| {
        let names = given.iter().filter(|(_, size)| is_it(*size));
        let names: Vec<&str> = names.map(|(name, _)| name.as_str()).collect();
        (!names.is_empty())
            .then(|| format!("{} ({end} {} {unit})", names.join(", "), trimmed(size, 6)))
    };
    let below = named(&|size| size < least * (1.0 - SAME_SIZE), "below", least);
    let above = named(
        &|size| size > greatest * (1.0 + SAME_SIZE),
        "above",
        greatest,
    );
    let all: Vec<String> = below.into_iter().chain(above).collect();
    match all.is_empty() {
        true => String::new(),
        false => format!(
            "beyond what was measured, by the function alone: {}\n",
            all.join(" and ")
        ),
    }
}

/// Of how many points RMSE and R squared are, where that is not all of them.
fn telling(fit: &Fit) -> String {
    match fit.silent_points() {
        0 => String::new(),
        silent => format!(
            "RMSE and R squared are of the {} points that say something of the parameters, not of {silent} at which the function says 100 % \
             whatever they are\n",
            fit.telling_points
        ),
    }
}

fn table(report: &FitReport, curve: &FittedCurve) -> String {
    let FittedCurve { fit, points, .. } = curve;
    let mut text = String::new();
    if !curve.label.is_empty() {
        text += &format!("{}: ", curve.label);
    }
    text += &format!(
        "{} fitted to {} points{}; sizes in {}\n\n",
        fit.model.name(),
        points.len(),
        if curve.weights.is_some() {
            ", weighted"
        } else {
            ""
        },
        report.unit
    );
    let row = |cells: &[String]| cells.to_vec();
    let mut parameters = vec![
        ["parameter", "value", "standard error"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for parameter in &fit.parameters {
        let given = parameter.name == "xmax" && curve.xmax_given;
        let is_known = fit.determines(parameter.name);
        parameters.push(row(&[
            parameter.name.to_owned(),
            match is_known {
                true => significant(parameter.value, 6),
                false => NOT_DETERMINED.to_owned(),
            },
            if given {
                "given".to_owned()
            } else {
                let error = parameter.standard_error.filter(|_| is_known);
                or_dash(error, |error| significant(error, 3))
            },
        ]));
    }
    text += &aligned(&parameters);
    text += &format!(
        "residual sum of squares {}, RMSE {} percentage points, R squared {}, {} degrees of freedom\n{}\n",
        significant(fit.residual_sum_of_squares, 6),
        significant(fit.rmse, 3),
        significant(fit.r_squared, 6),
        fit.degrees_of_freedom,
        telling(fit),
    );
    // A fit knows its own points, neither a method's errors nor what it does not see.
    let confidence = format!("fit's {} % from", trimmed(100.0 * report.level, 6));
    let mut sizes = vec![row(&[
        "passing".to_owned(),
        "size".to_owned(),
        confidence,
        "to".to_owned(),
    ])];
    let mut line = |name: String, percentile: Percentile| {
        let end = |index: usize| {
            or_dash(percentile.band.map(|band| band[index]), |end| {
                significant(end, 4)
            })
        };
        let size = significant(percentile.size, 5);
        sizes.push(vec![name, size, end(0), end(1)]);
    };
    let percentiles = report.percentiles(fit).into_iter();
    let topsize = (
        format!("topsize (P{TOPSIZE_PERCENT})"),
        fit.topsize(report.level),
    );
    let mut by_function = Vec::new();
    for (name, percentile) in percentiles
        .map(|percentile| (format!("P{}", percentile.percent), percentile))
        .chain([topsize])
    {
        by_function.push((name.clone(), percentile.size));
        line(name, percentile);
    }
    // One that was given is nobody's guess.
    let xmax = (fit.parameters.iter())
        .find(|parameter| parameter.name == "xmax" && !curve.xmax_given)
        .filter(|parameter| fit.determines(parameter.name))
        .map(|parameter| (parameter.name.to_owned(), parameter.value));
    by_function.extend(xmax);
    text += &aligned(&sizes);
    text += &beyond(points, &by_function, report.unit);
    text += &format!(
        "uniformity P60/P10 {}, curvature P30^2/(P10 P60) {}\n\n",
        significant(fit.uniformity(), 4),
        significant(fit.curvature(), 4),
    );
    let head = ["size", "measured %", "fitted %", "residual"];
    let mut measured = vec![head.map(str::to_owned).to_vec()];
    for (&[size, percent], residual) in points.iter().zip(&fit.residuals) {
        measured.push(row(&[
            trimmed(size, 6),
            format!("{percent:.2}"),
            format!("{:.2}", percent - residual),
            format!("{residual:+.2}"),
        ]));
    }
    text += &aligned(&measured);
    for note in &fit.notes {
        text += &format!("note: {note}\n");
    }
    text
}

/// The report as CSV, a line a number: parameters with their standard errors, measures of the fit,
/// percentiles with their bands. Numbers read back to the same f64; what there is not is empty.
///
/// # Errors
/// Where memory runs out.
pub fn fit_csv(report: &FitReport) -> Result<String, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let unit = report.unit;
    writer.write_record([
        "curve",
        "model",
        "quantity",
        "unit",
        "value",
        "standard_error",
        "band_low",
        "band_high",
    ])?;
    for FittedCurve { label, fit, .. } in &report.curves {
        let mut line = |quantity: &str, unit: &str, value: f64, rest: [Option<f64>; 3]| {
            let number = |number: Option<f64>| {
                let number = number.filter(|number| number.is_finite());
                number.map(|number| number.to_string()).unwrap_or_default()
            };
            let [error, low, high] = rest.map(number);
            let value = number(Some(value));
            let key = fit.model.key();
            writer.write_record([label, key, quantity, unit, &value, &error, &low, &high])
        };
        for parameter in &fit.parameters {
            let unit = if parameter.name.starts_with('x') {
                unit.symbol()
            } else {
                ""
            };
            // A number here would be taken for one. Why there is none the notes say, which have no place in CSV.
            let (value, error) = match fit.determines(parameter.name) {
                true => (parameter.value, parameter.standard_error),
                false => (f64::NAN, None),
            };
            line(parameter.name, unit, value, [error, None, None])?;
        }
        let none = [None; 3];
        line(
            "residual_sum_of_squares",
            "",
            fit.residual_sum_of_squares,
            none,
        )?;
        line("rmse", "percentage points", fit.rmse, none)?;
        line("r_squared", "", fit.r_squared, none)?;
        line("telling_points", "", fit.telling_points as f64, none)?;
        line(
            "degrees_of_freedom",
            "",
            fit.degrees_of_freedom as f64,
            none,
        )?;
        let sizes = report
            .percentiles(fit)
            .into_iter()
            .map(|size| (key(size.percent), size));
        let topsize = ("topsize".to_owned(), fit.topsize(report.level));
        for (name, percentile) in sizes.chain([topsize]) {
            let band = percentile.band;
            let rest = [None, band.map(|band| band[0]), band.map(|band| band[1])];
            line(&name, unit.symbol(), percentile.size, rest)?;
        }
        line("uniformity", "", fit.uniformity(), none)?;
        line("curvature", "", fit.curvature(), none)?;
    }
    let bytes = writer.into_inner().map_err(|e| e.into_error())?;
    // All that went in was UTF-8.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// "p50", "p2.5".
fn key(percent: f64) -> String {
    format!("p{percent}")
}

/// Names with values, as a JSON object in this order.
struct Named<T>(Vec<(String, T)>);

impl<T: Serialize> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

#[derive(Serialize)]
struct JsonFit<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    curve: Option<&'a str>,
    model: &'static str,
    unit: &'static str,
    weighted: bool,
    parameters: Named<f64>,
    standard_errors: Named<Option<f64>>,
    residual_sum_of_squares: f64,
    r_squared: f64,
    rmse: f64,
    telling_points: usize,
    degrees_of_freedom: usize,
    percentiles: Named<f64>,
    level: f64,
    percentile_bands: Named<Option<[f64; 2]>>,
    topsize: f64,
    topsize_band: Option<[f64; 2]>,
    uniformity: f64,
    curvature: f64,
    points: Vec<JsonPoint>,
    notes: &'a [String],
}

#[derive(Serialize)]
struct JsonPoint {
    size: f64,
    passing: f64,
    fitted: f64,
    residual: f64,
    band: Option<[f64; 2]>,
}

/// The report as JSON text with a line break at its end: an object where the table has a single curve
/// without labels, else an array. Infinite numbers are null.
///
/// # Errors
/// Where memory runs out.
pub fn fit_json(report: &FitReport) -> serde_json::Result<String> {
    let fits: Vec<JsonFit> = report
        .curves
        .iter()
        .map(|curve| json(report, curve))
        .collect();
    let mut text = match fits.as_slice() {
        [only] if only.curve.is_none() => serde_json::to_string(only)?,
        all => serde_json::to_string(all)?,
    };
    text.push('\n');
    Ok(text)
}

fn json<'a>(report: &FitReport, curve: &'a FittedCurve) -> JsonFit<'a> {
    let fit = &curve.fit;
    let percentiles = report.percentiles(fit);
    let parameters = fit.parameters.iter();
    let errors = parameters.clone();
    let topsize = fit.topsize(report.level);
    let points = curve.points.iter().zip(&fit.residuals);
    JsonFit {
        curve: (!curve.label.is_empty()).then_some(curve.label.as_str()),
        model: fit.model.key(),
        unit: report.unit.symbol(),
        weighted: curve.weights.is_some(),
        parameters: Named(parameters.map(|p| (p.name.to_owned(), p.value)).collect()),
        standard_errors: Named(
            errors
                .map(|p| (p.name.to_owned(), p.standard_error))
                .collect(),
        ),
        residual_sum_of_squares: fit.residual_sum_of_squares,
        r_squared: fit.r_squared,
        rmse: fit.rmse,
        telling_points: fit.telling_points,
        degrees_of_freedom: fit.degrees_of_freedom,
        percentiles: Named(
            percentiles
                .iter()
                .map(|p| (key(p.percent), p.size))
                .collect(),
        ),
        level: report.level,
        percentile_bands: Named(
            percentiles
                .iter()
                .map(|p| (key(p.percent), p.band))
                .collect(),
        ),
        topsize: topsize.size,
        topsize_band: topsize.band,
        uniformity: fit.uniformity(),
        curvature: fit.curvature(),
        points: points
            .map(|(&[size, passing], &residual)| JsonPoint {
                size,
                passing,
                fitted: passing - residual,
                residual,
                band: fit.band_at(size, report.level),
            })
            .collect(),
        notes: &fit.notes,
    }
}
