//! What the plot draws, made once by the job that computes: no frame evaluates a function.
//!
//! The plot is linear, so the first coordinate of every point is the decimal logarithm of a size.

use egui_plot::PlotPoint;

use super::fitted_curve::FittedCurve;
use crate::exports::FigureStyle;
use crate::fragmentation::{Analysis, Curve, Labels, MARKED_PERCENTILES, MethodCurve};

/// How many points a drawn function has.
const STEPS: u32 = 160;

/// All that is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// In the order of the methods.
    pub methods: Vec<MethodDrawing>,
    /// Around the reference's function: what passes at a size if every size of the reference is so
    /// many percent larger or smaller.
    pub envelope: Area,
}

/// The curves of a method.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodDrawing {
    /// The method.
    pub method: String,
    /// The same as in the figure.
    pub style: FigureStyle,
    /// Every measured curve.
    pub curves: Vec<(Labels, Vec<PlotPoint>)>,
    /// The function fitted to each trial.
    pub fits: Vec<(Labels, Vec<PlotPoint>)>,
    /// The function fitted to the mean of several trials; empty with one.
    pub mean: Vec<PlotPoint>,
    /// Mean of the trials, plus and less a standard deviation.
    pub spread: Area,
    /// Points of the fitted function that are told by name: P50, P80.
    pub marks: Vec<(String, PlotPoint)>,
    /// Percent errors against the reference.
    pub errors: Vec<PlotPoint>,
}

/// Between two curves over the same sizes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Area {
    /// Logarithms of the sizes.
    pub sizes: Vec<f64>,
    /// Percent passing, the lower edge.
    pub low: Vec<f64>,
    /// The upper edge.
    pub high: Vec<f64>,
}

impl Drawing {
    /// Of an analysis and the function fitted to each curve of its trials.
    pub(super) fn of(analysis: &Analysis, fits: &[FittedCurve]) -> Self {
        let points = analysis.photos.curves.iter();
        let sizes = points.flat_map(|curve| curve.distribution.points().iter().map(|p| p[0]));
        let (low, high) = sizes.fold((f64::INFINITY, 0.0_f64), |(low, high), size| {
            (low.min(size), high.max(size))
        });
        // A little further than measured: functions are told from lines between points.
        let (low, high) = (low / 2.0, high * 1.5);
        let comparison = analysis.comparison.as_ref().ok();
        let mut others = 0;
        let methods = analysis.methods.iter().map(|method| {
            let is_reference = Some(method) == analysis.reference.as_ref();
            let style = if is_reference {
                FigureStyle::REFERENCE
            } else {
                others += 1;
                FigureStyle::of(others)
            };
            let of_method = |labels: &Labels| labels.method == *method;
            let curves = analysis
                .photos
                .curves
                .iter()
                .filter(|c| of_method(&c.labels));
            let curves = curves.map(|curve| {
                let points = curve.distribution.points().iter();
                let points = points.map(|&[size, percent]| at(size, percent)).collect();
                (curve.labels.clone(), points)
            });
            let fitted = fits.iter().filter(|f| of_method(&f.labels));
            let fits = fitted.clone().filter_map(|fitted| {
                let fit = fitted.fit.as_ref().ok()?;
                Some((fitted.labels.clone(), line(&fit.curve, low, high)))
            });
            let of_trials = fitted.flat_map(|fitted| {
                let told = fitted.percentiles.iter();
                let told = told.filter(|p| MARKED_PERCENTILES.contains(&p.percent));
                let labels = &fitted.labels;
                told.map(move |p| {
                    (
                        format!("P{} of {labels}, fitted", p.percent),
                        at(p.size, p.percent),
                    )
                })
            });
            let compared = comparison.and_then(|c| {
                let of = |m: &&crate::fragmentation::MethodComparison| m.curve.method == *method;
                c.methods.iter().find(of)
            });
            let mean = comparison.filter(|_| is_reference).map(|c| &c.reference);
            let mean = compared.map(|c| &c.curve).or(mean);
            // With several trials it is their mean that counts.
            let several = mean.filter(|mean| mean.trials.len() > 1);
            let marks = match several {
                None => of_trials.collect(),
                Some(mean) => MARKED_PERCENTILES
                    .map(|percent| {
                        let name = format!("P{percent} of {method}, mean, fitted");
                        (name, at(mean.fit.curve.size_at(percent), percent))
                    })
                    .to_vec(),
            };
            let errors = compared.iter().flat_map(|compared| &compared.residuals);
            let errors = errors.filter_map(|e| Some(at(e.size, e.percent_error?)));
            MethodDrawing {
                method: method.clone(),
                style,
                curves: curves.collect(),
                fits: fits.collect(),
                spread: mean.map(spread).unwrap_or_default(),
                mean: several
                    .map(|mean| line(&mean.fit.curve, low, high))
                    .unwrap_or_default(),
                marks,
                errors: errors.collect(),
            }
        });
        let methods = methods.collect();
        let envelope = comparison.map(|comparison| {
            let curve = &comparison.reference.fit.curve;
            let share = comparison.options.envelope_percent / 100.0;
            let sizes: Vec<f64> = sizes_between(low, high).collect();
            let passing =
                |factor: f64| sizes.iter().map(move |s| curve.percent_passing(s * factor));
            Area {
                low: passing(1.0 / (1.0 + share)).collect(),
                // Sizes smaller by all of themselves: everything passes everywhere.
                high: passing(1.0 / (1.0 - share).max(f64::MIN_POSITIVE)).collect(),
                sizes: sizes.iter().map(|size| size.log10()).collect(),
            }
        });
        Self {
            methods,
            envelope: envelope.unwrap_or_default(),
        }
    }
}

fn at(size: f64, value: f64) -> PlotPoint {
    PlotPoint::new(size.log10(), value)
}

fn sizes_between(low: f64, high: f64) -> impl Iterator<Item = f64> {
    let ratio = high / low;
    (0..STEPS).map(move |step| low * ratio.powf(f64::from(step) / f64::from(STEPS - 1)))
}

fn line(curve: &Curve, low: f64, high: f64) -> Vec<PlotPoint> {
    let sizes = sizes_between(low, high);
    sizes
        .map(|size| at(size, curve.percent_passing(size)))
        .collect()
}

fn spread(mean: &MethodCurve) -> Area {
    let [low, high] = mean.spread();
    let percents = |edge: &[[f64; 2]]| edge.iter().map(|point| point[1]).collect();
    Area {
        sizes: low.iter().map(|point| point[0].log10()).collect(),
        low: percents(&low),
        high: percents(&high),
    }
}
