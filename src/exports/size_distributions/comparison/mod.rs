//! Methods held against the reference, as text, CSV and JSON.

mod csv_tables;
mod json;
mod text;

pub use csv_tables::comparison_csv;
pub use json::comparison_json;
pub use text::comparison_text;

#[cfg(test)]
pub(super) mod test_comparison {
    //! A comparison with round numbers.

    use crate::fragmentation::{
        Comparison, ComparisonOptions, CurveNorm, Fit, FitOptions, FittedParameter, Improvement,
        MeanPoint, MeasuredNorm, MethodComparison, MethodCurve, Model, PercentError,
        PercentileShift, Shift, SizeDistribution, Span, Swebrec, fit,
    };
    use crate::units::LengthUnit;

    fn curve(method: &str, trials: &[&str], means: [f64; 2]) -> MethodCurve {
        let point = |size, mean| MeanPoint {
            size,
            mean,
            standard_deviation: (trials.len() > 1).then_some(1.5),
            trials: trials.len(),
        };
        MethodCurve {
            method: method.to_owned(),
            trials: trials.iter().map(|trial| (*trial).to_owned()).collect(),
            points: vec![point(10.0, means[0]), point(100.0, means[1])],
            fit: round_fit(),
        }
    }

    /// A fit to a Swebrec, told in round numbers.
    fn round_fit() -> Fit {
        let swebrec = Swebrec::new(40.0, 150.0, 2.0).unwrap();
        let sizes = [5.0, 10.0, 20.0, 40.0, 80.0, 120.0];
        let points = sizes.map(|size| [size, 100.0 * swebrec.passing(size)]);
        let measured = SizeDistribution::new(points.to_vec()).unwrap();
        let parameter = |name, value| FittedParameter {
            name,
            value,
            standard_error: None,
        };
        let mut found = fit(&measured, Model::Swebrec, &FitOptions::default()).unwrap();
        found.parameters = vec![
            parameter("xmax", 150.0),
            parameter("x50", 40.0),
            parameter("b", 2.0),
        ];
        found.rmse = 0.5;
        found.r_squared = 0.999;
        found
    }

    pub(in crate::size_distributions) fn comparison() -> Comparison {
        let residual =
            |size, reference, passing: Option<f64>, percent_error: Option<f64>| PercentError {
                size,
                reference,
                passing,
                interpolated: false,
                difference: passing.map(|passing| passing - reference),
                percent_error,
                within: percent_error.map(|error| error.abs() <= 30.0),
            };
        let method = |name: &str, relative_percent| MethodComparison {
            curve: curve(name, &["1", "2"], [5.0, 88.0]),
            residuals: vec![
                residual(10.0, 0.0, Some(5.0), None),
                residual(100.0, 80.0, Some(88.0), Some(10.0)),
            ],
            norm: CurveNorm {
                rms_difference: 4.0,
                relative_percent,
            },
            measured_norm: Some(MeasuredNorm {
                from: 10.0,
                to: 100.0,
                share: 0.4,
                norm: CurveNorm {
                    rms_difference: 3.0,
                    relative_percent: 5.0,
                },
            }),
            shift: Shift {
                percentiles: vec![PercentileShift {
                    measured: true,
                    percent: 50.0,
                    reference: 40.0,
                    size: 36.0,
                    shift_percent: -10.0,
                    envelope: [28.0, 52.0],
                    inside: true,
                }],
                mean_percent: -10.0,
                spread_percent: None,
                looks_like_scale: false,
            },
            notes: vec!["look twice".to_owned()],
        };
        let improvement = |method: &str, over: &str, percent| Improvement {
            method: method.to_owned(),
            over: over.to_owned(),
            percent: Some(percent),
        };
        Comparison {
            unit: LengthUnit::Millimetre,
            options: ComparisonOptions::new("sieve"),
            reference: curve("sieve", &[""], [0.0, 80.0]),
            span: Span {
                from: 0.5,
                to: 150.0,
                to_percent: 100.0,
            },
            methods: vec![method("point cloud", 9.4), method("scale object", 10.0)],
            improvements: vec![
                improvement("point cloud", "scale object", 6.0),
                improvement("scale object", "point cloud", -6.4),
            ],
            notes: vec!["beyond what was measured".to_owned()],
        }
    }
}
