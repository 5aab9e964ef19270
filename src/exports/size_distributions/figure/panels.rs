//! What the panels of all figures have in common: axes, fitted lines, words.

use super::{Band, Panel, Series, SizeAxis};
use crate::fragmentation::{Fit, MARKED_PERCENTILES};
use crate::numbers::significant_digits;
use crate::units::LengthUnit;

/// Sizes at which a fitted function is drawn, across the whole axis.
const SAMPLES: u32 = 241;
/// A value of some hundred percent would press all the others onto the zero: beyond it they are arrows.
const MOST_RESIDUAL: f64 = 150.0;

pub(super) fn size_title(unit: LengthUnit) -> String {
    format!("Size, {unit}")
}

/// The panel of percent passing.
pub(super) fn passing_panel(bands: Vec<Band>, series: Vec<Series>) -> Panel {
    Panel {
        axis_title: "Passing, % of mass".to_owned(),
        range: [0.0, 100.0],
        ticks: (0..=10).map(|tick| f64::from(10 * tick)).collect(),
        levels: MARKED_PERCENTILES.to_vec(),
        bands,
        series,
    }
}

/// A panel about 0 that shows all points, and at least `least` to both sides.
pub(super) fn residual_panel(
    axis_title: String,
    least: f64,
    levels: Vec<f64>,
    series: Vec<Series>,
) -> Panel {
    let values = series
        .iter()
        .flat_map(|s| &s.points)
        .map(|point| point[1].abs());
    let largest = values.filter(|value| value.is_finite()).fold(0.0, f64::max);
    // A marker at the end stays clear of the frame.
    let end = (1.08 * largest).min(MOST_RESIDUAL.max(least)).max(least);
    let steps = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 25.0, 50.0, 100.0];
    let step = steps
        .into_iter()
        .find(|step| end <= 4.0 * step)
        .unwrap_or(end / 4.0);
    let count = (end / step).ceil() as i32;
    Panel {
        axis_title,
        range: [-f64::from(count) * step, f64::from(count) * step],
        // Divided rather than multiplied where it is a tenth or so: 3 / 10 is 0.3, 3 * 0.1 is not.
        ticks: (-count..=count)
            .map(|tick| (f64::from(tick) * step * 10.0).round() / 10.0)
            .collect(),
        levels,
        bands: Vec::new(),
        series,
    }
}

/// A fitted function over the axis, with the corner at its largest size.
pub(super) fn fitted_line(fit: &Fit, sizes: &SizeAxis) -> Vec<[f64; 2]> {
    let corner = fit.curve.size_at(100.0);
    let mut at: Vec<f64> = sizes.sizes(SAMPLES).collect();
    at.extend((sizes.low..sizes.high).contains(&corner).then_some(corner));
    at.sort_by(f64::total_cmp);
    let line = at
        .into_iter()
        .map(|size| [size, fit.curve.percent_passing(size)]);
    line.filter(|point| point[1].is_finite()).collect()
}

/// P50 and P80 of a fitted function.
pub(super) fn marks(fit: &Fit) -> Vec<[f64; 2]> {
    let marks = MARKED_PERCENTILES.map(|percent| [fit.curve.size_at(percent), percent]);
    marks
        .into_iter()
        .filter(|mark| mark[0].is_finite())
        .collect()
}

/// "Swebrec fit, P50 112, P80 203 mm".
pub(super) fn fit_words(fit: &Fit, unit: LengthUnit) -> String {
    let mut words = format!("{} fit", fit.model.name());
    for [size, percent] in marks(fit) {
        words += &format!(", P{percent} {}", significant_digits(size, 3));
    }
    words + " " + unit.symbol()
}
