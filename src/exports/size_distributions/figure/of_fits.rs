//! What a figure shows of distributions and the functions fitted to them.

use super::panels;
use super::{Band, FigureContents, FigureStyle, Series, SizeAxis};
use crate::fault::Fault;
use crate::fragmentation::{DistributionSet, Fit, LabelledDistribution, SizeDistribution};
use crate::units::LengthUnit;

/// Confidence of the bands.
const LEVEL: f64 = 0.95;
/// Sizes at which a band is drawn.
const SAMPLES: u32 = 121;
/// Of more curves bands and marks would hide each other.
const MOST_WITH_BANDS: usize = 6;

/// A measured distribution with the function fitted to it.
#[derive(Debug, Clone)]
pub struct FittedDistribution<'a> {
    /// What it is of.
    pub name: String,
    /// As measured; sizes in the figure's unit.
    pub distribution: &'a SizeDistribution,
    /// Of this distribution.
    pub fit: &'a Fit,
}

impl<'a> FittedDistribution<'a> {
    /// Of a set's curves those that have a fit; `fits` in the order of the curves.
    pub fn of(
        set: &'a DistributionSet,
        fits: impl IntoIterator<Item = &'a Result<Fit, Fault>>,
    ) -> Vec<Self> {
        let fitted = |(curve, fit): (&'a LabelledDistribution, &'a Result<Fit, Fault>)| {
            Some(Self {
                name: curve.labels.to_string(),
                distribution: &curve.distribution,
                fit: fit.as_ref().ok()?,
            })
        };
        set.curves.iter().zip(fits).filter_map(fitted).collect()
    }
}

/// Measured points, fitted functions with their confidence bands (95 %) and P50 and P80 where they are
/// few; below them what is left.
pub fn figure_of_fits(
    title: impl Into<String>,
    unit: LengthUnit,
    fitted: &[FittedDistribution<'_>],
) -> FigureContents {
    let measured = fitted
        .iter()
        .flat_map(|f| f.distribution.points())
        .map(|point| point[0]);
    let sizes = SizeAxis::covering(panels::size_title(unit), measured);
    let few = fitted.len() <= MOST_WITH_BANDS;
    let mut bands = Vec::new();
    let mut passing = Vec::new();
    let mut left_over = Vec::new();
    for (number, of) in fitted.iter().enumerate() {
        let style = FigureStyle::of(number);
        let words = panels::fit_words(of.fit, unit);
        let name = match of.name.as_str() {
            "" => words,
            name => format!("{name}: {words}"),
        };
        bands.extend(few.then(|| confidence_band(style, of, &sizes)).flatten());
        let points = of.distribution.points();
        passing.push(Series {
            name,
            style,
            points: points.to_vec(),
            line: panels::fitted_line(of.fit, &sizes),
            marks: if few {
                panels::marks(of.fit)
            } else {
                Vec::new()
            },
        });
        let left: Vec<[f64; 2]> = points
            .iter()
            .zip(&of.fit.residuals)
            .map(|(point, left)| [point[0], *left])
            .collect();
        left_over.push(Series {
            name: of.name.clone(),
            style,
            line: left.clone(),
            points: left,
            marks: Vec::new(),
        });
    }
    FigureContents {
        title: title.into(),
        sizes,
        passing: panels::passing_panel(bands, passing),
        residuals: Some(panels::residual_panel(
            "Measured less fitted, points".to_owned(),
            1.0,
            vec![0.0],
            left_over,
        )),
    }
}

fn confidence_band(
    style: FigureStyle,
    of: &FittedDistribution<'_>,
    sizes: &SizeAxis,
) -> Option<Band> {
    let known: Vec<(f64, [f64; 2])> = sizes
        .sizes(SAMPLES)
        .filter_map(|size| Some((size, of.fit.band_at(size, LEVEL)?)))
        .collect();
    let edge = |side: fn([f64; 2]) -> f64| -> Vec<[f64; 2]> {
        known
            .iter()
            .map(|(size, band)| [*size, side(*band).clamp(0.0, 100.0)])
            .collect()
    };
    let edges = [edge(|[low, _]| low), edge(|[_, high]| high)];
    let percent = 100.0 * LEVEL;
    let name = match of.name.as_str() {
        "" => format!("confidence band of the fit, {percent} %"),
        name => format!("{name}: confidence band of the fit, {percent} %"),
    };
    (known.len() > 1).then_some(Band {
        name,
        style,
        outlined: false,
        edges,
    })
}
