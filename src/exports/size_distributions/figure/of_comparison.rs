//! What a figure shows of methods held against a reference: the paper's figure of distributions.

use super::panels;
use super::{Band, FigureContents, FigureStyle, Series, SizeAxis};
use crate::fragmentation::{Comparison, MethodCurve};
use crate::size_distributions::method_name;

/// Measured means with the fitted functions, their spread over the trials, the envelope about the
/// reference; below them the percent errors with their limits.
pub fn figure_of_comparison(comparison: &Comparison) -> FigureContents {
    let envelope = comparison.options.envelope_percent;
    let reference = &comparison.reference;
    let others = comparison.methods.iter().map(|method| &method.curve);
    // The reference first: its style and its place in the legend. It is drawn below the others.
    let curves: Vec<(FigureStyle, &MethodCurve)> = std::iter::once(reference)
        .chain(others)
        .enumerate()
        .map(|(number, curve)| (FigureStyle::of(number), curve))
        .collect();
    let measured = curves
        .iter()
        .flat_map(|(_, c)| c.points.iter().map(|p| p.size));
    let sizes = SizeAxis::covering(panels::size_title(comparison.unit), measured);
    let mut bands = vec![envelope_band(comparison)];
    bands.extend(
        curves
            .iter()
            .filter_map(|(style, curve)| spread_band(*style, curve)),
    );
    let series = curves.iter().map(|(style, curve)| Series {
        name: format!(
            "{}: {}",
            described(curve),
            panels::fit_words(&curve.fit, comparison.unit)
        ),
        style: *style,
        points: curve.known_to_all().map(|p| [p.size, p.mean]).collect(),
        line: panels::fitted_line(&curve.fit, &sizes),
        marks: panels::marks(&curve.fit),
    });
    let passing = panels::passing_panel(bands, series.collect());
    let mut errors = vec![Series {
        name: String::new(),
        style: FigureStyle::REFERENCE,
        points: Vec::new(),
        line: vec![[sizes.low, 0.0], [sizes.high, 0.0]],
        marks: Vec::new(),
    }];
    for (method, (style, _)) in comparison.methods.iter().zip(curves.iter().skip(1)) {
        let known = method.residuals.iter();
        let points: Vec<[f64; 2]> = known
            .filter_map(|r| Some([r.size, r.percent_error?]))
            .collect();
        errors.push(Series {
            name: method.curve.method.clone(),
            style: *style,
            line: points.clone(),
            points,
            marks: Vec::new(),
        });
    }
    let names: Vec<&str> = comparison
        .methods
        .iter()
        .map(|m| method_name(&m.curve.method))
        .collect();
    FigureContents {
        title: format!(
            "{} against {}",
            names.join(", "),
            method_name(&reference.method)
        ),
        sizes,
        passing,
        residuals: Some(panels::residual_panel(
            "Percent error of passing, %".to_owned(),
            1.5 * envelope,
            vec![-envelope, envelope],
            errors,
        )),
    }
}

/// The envelope of the sizes about the fitted reference.
fn envelope_band(comparison: &Comparison) -> Band {
    // Finer at the ends, where a function may come to 0 or 100 % only far away.
    let ends = [0.01, 0.02, 0.05, 0.1, 0.2];
    let mut percents: Vec<f64> = (0..=200).map(|half| f64::from(half) / 2.0).collect();
    percents.extend(ends.into_iter().chain(ends.map(|end| 100.0 - end)));
    percents.sort_by(f64::total_cmp);
    let edge = |side: usize| {
        let edge = percents.iter().filter_map(|&percent| {
            let size = comparison.envelope_at(percent).get(side).copied()?;
            (size.is_finite() && size > 0.0).then_some([size, percent])
        });
        edge.collect()
    };
    Band {
        name: format!(
            "\u{b1}{} % of the size, {} fit",
            comparison.options.envelope_percent,
            method_name(&comparison.reference.method)
        ),
        style: FigureStyle::REFERENCE,
        outlined: true,
        edges: [edge(0), edge(1)],
    }
}

/// Mean less and plus the standard deviation, where there are trials to have one.
fn spread_band(style: FigureStyle, curve: &MethodCurve) -> Option<Band> {
    let edges = curve.spread();
    let name = format!("{}: \u{b1} standard deviation", method_name(&curve.method));
    (edges[0].len() > 1).then_some(Band {
        name,
        style,
        outlined: false,
        edges,
    })
}

/// The method, and of how many trials its points are the mean.
fn described(curve: &MethodCurve) -> String {
    let name = method_name(&curve.method);
    match curve.trials.len() {
        0 | 1 => name.to_owned(),
        trials => format!("{name}, {trials} trials"),
    }
}
