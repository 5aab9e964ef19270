//! A comparison as JSON.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::fragmentation::{
    Comparison, CurveNorm, MethodComparison, MethodCurve, PERCENT_ERROR, SCALE_WARNING,
};

#[derive(Serialize)]
struct Report<'a> {
    unit: &'a str,
    model: &'a str,
    envelope_percent: f64,
    reference: Curve<'a>,
    methods: Vec<Method<'a>>,
    improvements: Vec<Improvement<'a>>,
    span: Span,
    percent_error_definition: &'a str,
    scale_warning: &'a str,
    notes: &'a [String],
}

#[derive(Serialize)]
struct Curve<'a> {
    method: &'a str,
    trials: &'a [String],
    points: Vec<Point>,
    fit: Fit<'a>,
}

#[derive(Serialize)]
struct Point {
    size: f64,
    mean: f64,
    standard_deviation: Option<f64>,
    trials: usize,
}

#[derive(Serialize)]
struct Fit<'a> {
    model: &'a str,
    parameters: BTreeMap<&'a str, f64>,
    standard_errors: BTreeMap<&'a str, Option<f64>>,
    residual_sum_of_squares: f64,
    rmse: f64,
    r_squared: f64,
    notes: &'a [String],
}

#[derive(Serialize)]
struct Method<'a> {
    #[serde(flatten)]
    curve: Curve<'a>,
    residuals: Vec<Residual>,
    norm: Norm,
    /// Where both were measured.
    measured_norm: Option<MeasuredNorm>,
    percentiles: Vec<Percentile>,
    shift: Shift,
    notes: &'a [String],
}

#[derive(Serialize)]
struct Residual {
    size: f64,
    reference: f64,
    passing: Option<f64>,
    /// Not measured at this size, but taken from those beside it.
    interpolated: bool,
    difference: Option<f64>,
    percent_error: Option<f64>,
    within: Option<bool>,
}

#[derive(Serialize)]
struct Norm {
    rms_difference: f64,
    relative_percent: f64,
}

#[derive(Serialize)]
struct MeasuredNorm {
    from: f64,
    to: f64,
    /// Of the span, on its logarithmic axis.
    share: f64,
    #[serde(flatten)]
    norm: Norm,
}

#[derive(Serialize)]
struct Percentile {
    percent: f64,
    reference: f64,
    size: f64,
    shift_percent: f64,
    envelope: [f64; 2],
    inside: bool,
}

#[derive(Serialize)]
struct Shift {
    mean_percent: f64,
    spread_percent: Option<f64>,
    looks_like_scale: bool,
}

#[derive(Serialize)]
struct Improvement<'a> {
    method: &'a str,
    over: &'a str,
    percent: Option<f64>,
}

#[derive(Serialize)]
struct Span {
    from: f64,
    from_percent: f64,
    to: f64,
    to_percent: f64,
}

/// The comparison as JSON text with a line break at its end. Sizes are in `unit`; what is not known or
/// not defined is null.
///
/// # Errors
/// Where memory runs out.
pub fn comparison_json(comparison: &Comparison) -> serde_json::Result<String> {
    let span = comparison.span;
    let improvements = comparison.improvements.iter().map(|found| Improvement {
        method: &found.method,
        over: &found.over,
        percent: found.percent,
    });
    let mut text = serde_json::to_string(&Report {
        unit: comparison.unit.symbol(),
        model: comparison.options.model.key(),
        envelope_percent: comparison.options.envelope_percent,
        reference: curve(&comparison.reference),
        methods: comparison.methods.iter().map(method).collect(),
        improvements: improvements.collect(),
        span: Span {
            from: span.from,
            from_percent: 1.0,
            to: span.to,
            to_percent: span.to_percent,
        },
        percent_error_definition: PERCENT_ERROR,
        scale_warning: SCALE_WARNING,
        notes: &comparison.notes,
    })?;
    text.push('\n');
    Ok(text)
}

fn curve(curve: &MethodCurve) -> Curve<'_> {
    let fit = &curve.fit;
    let points = curve.points.iter().map(|point| Point {
        size: point.size,
        mean: point.mean,
        standard_deviation: point.standard_deviation,
        trials: point.trials,
    });
    Curve {
        method: &curve.method,
        trials: &curve.trials,
        points: points.collect(),
        fit: Fit {
            model: fit.model.key(),
            parameters: (fit.parameters.iter()).map(|p| (p.name, p.value)).collect(),
            standard_errors: (fit.parameters.iter())
                .map(|p| (p.name, p.standard_error))
                .collect(),
            residual_sum_of_squares: fit.residual_sum_of_squares,
            rmse: fit.rmse,
            r_squared: fit.r_squared,
            notes: &fit.notes,
        },
    }
}

fn norm(norm: &CurveNorm) -> Norm {
    Norm {
        rms_difference: norm.rms_difference,
        relative_percent: norm.relative_percent,
    }
}

fn method(method: &MethodComparison) -> Method<'_> {
    let residuals = method.residuals.iter().map(|residual| Residual {
        size: residual.size,
        reference: residual.reference,
        passing: residual.passing,
        interpolated: residual.interpolated,
        difference: residual.difference,
        percent_error: residual.percent_error,
        within: residual.within,
    });
    let percentiles = method.shift.percentiles.iter().map(|found| Percentile {
        percent: found.percent,
        reference: found.reference,
        size: found.size,
        shift_percent: found.shift_percent,
        envelope: found.envelope,
        inside: found.inside,
    });
    Method {
        curve: curve(&method.curve),
        residuals: residuals.collect(),
        norm: norm(&method.norm),
        measured_norm: method.measured_norm.as_ref().map(|of| MeasuredNorm {
            from: of.from,
            to: of.to,
            share: of.share,
            norm: norm(&of.norm),
        }),
        percentiles: percentiles.collect(),
        shift: Shift {
            mean_percent: method.shift.mean_percent,
            spread_percent: method.shift.spread_percent,
            looks_like_scale: method.shift.looks_like_scale,
        },
        notes: &method.notes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::size_distributions::comparison::test_comparison::comparison;

    #[test]
    fn values_under_their_names() {
        let mut comparison = comparison();
        comparison.methods[0].residuals[1].interpolated = true;
        let text = comparison_json(&comparison).unwrap();
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(value["unit"], "mm");
        assert_eq!(value["model"], "swebrec");
        assert_eq!(value["reference"]["method"], "sieve");
        assert_eq!(value["reference"]["fit"]["parameters"]["x50"], 40.0);
        let method = &value["methods"][0];
        assert_eq!(method["method"], "point cloud");
        assert_eq!(method["points"][1]["standard_deviation"], 1.5);
        assert!(method["residuals"][0]["percent_error"].is_null());
        assert_eq!(method["residuals"][1]["percent_error"], 10.0);
        assert_eq!(method["residuals"][0]["interpolated"], false);
        assert_eq!(method["residuals"][1]["interpolated"], true);
        assert_eq!(method["norm"]["relative_percent"], 9.4);
        assert_eq!(method["measured_norm"]["relative_percent"], 5.0);
        assert_eq!(method["measured_norm"]["to"], 100.0);
        assert_eq!(method["percentiles"][0]["shift_percent"], -10.0);
        assert_eq!(method["shift"]["mean_percent"], -10.0);
        assert_eq!(value["improvements"][0]["percent"], 6.0);
        assert_eq!(value["span"]["from_percent"], 1.0);
    }
}
