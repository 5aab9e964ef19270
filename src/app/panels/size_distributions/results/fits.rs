//! The fitted functions: parameters, how well they fit, percentiles with their bands.

use super::sentence::{sentence, warning};
use crate::command::Command;
use crate::fragmentation::{Labels, PERCENTILES, Percentile};
use crate::panels::size_distributions::table::{Table, fixed, number};
use crate::size_distributions::Computed;
use crate::size_distributions::fitted_curve::FittedCurve;

/// Draws the tables.
pub(super) fn fits(computed: &Computed, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let settings = &computed.edit.settings;
    let unit = computed.analysis.trials.unit;
    sentence(
        &format!(
            "{} by least squares, every point alike.",
            settings.model.name()
        ),
        ui,
    );
    let mut parameters = Table::new("Parameters");
    parameters.column("Curve", "Method, trial; the photos of a trial are merged");
    for name in settings.model.parameter_names() {
        let is_size = name.starts_with('x');
        let name = if is_size {
            format!("{name} {unit}")
        } else {
            (*name).to_owned()
        };
        parameters.column(name, "Least-squares estimate");
        parameters.column("±", "Standard error of the estimate before it");
    }
    parameters.column(
        "RMSE",
        "Root of the mean squared residual, percentage points",
    );
    parameters.column("R²", "Share of the variation that the function explains");
    parameters.column("Points", "How many points it is fitted to");
    let mut percentiles = Table::new(format!("Percentiles of the fitted functions, {unit}"));
    percentiles.column("Curve", "Method, trial");
    // The difference may end in ...9999; seven digits are what a level has.
    let confidence = ((1.0 - settings.level) * 1e9).round() / 1e7;
    let mut bands = Table::new(format!("Bands of the fits alone, {confidence} %, {unit}"));
    // With a column for each end of each size the table would be wider than any panel.
    bands.column("Curve", "Method, trial");
    bands.column("Size", "Which share of the mass passes it");
    for end in ["from", "to"] {
        bands.column(end, "Of the confidence band of that size");
    }
    for percent in PERCENTILES {
        percentiles.column(
            format!("P{percent}"),
            format!("{percent} % of the mass passes it, by the fitted function; read off the curve as measured, as on the page Fragments, it is a little beside"),
        );
    }
    for FittedCurve {
        labels,
        fit,
        percentiles: sizes,
    } in &computed.fits
    {
        let Ok(fit) = fit else {
            continue;
        };
        let mut row = vec![labels.to_string()];
        for parameter in &fit.parameters {
            // The note below says why it has no value.
            let is_known = fit.determines(parameter.name);
            row.push(number(is_known.then_some(parameter.value), 5));
            row.push(number(parameter.standard_error.filter(|_| is_known), 2));
        }
        row.push(fixed(fit.rmse, 2));
        row.push(fixed(fit.r_squared, 4));
        row.push(fit.residuals.len().to_string());
        parameters.row(row);
        let cells = sizes.iter().map(|size| number(size.size, 4));
        percentiles.row([labels.to_string()].into_iter().chain(cells).collect());
        let ends = |size: &Percentile| match size.band {
            Some(band) => band.map(|end| number(end, 4)),
            None => [number(None, 4), number(None, 4)],
        };
        for size in sizes {
            let [from, to] = ends(size);
            let name = format!("P{}", size.percent);
            bands.row(vec![labels.to_string(), name, from, to]);
        }
    }
    parameters.show(ui, commands);
    percentiles.show(ui, commands);
    bands.show(ui, commands);
    for (labels, text) in notes(computed) {
        warning(&format!("{labels}: {text}"), ui);
    }
}

/// What is to be known of the fits, with the curves that have none.
fn notes(computed: &Computed) -> impl Iterator<Item = (&Labels, String)> {
    computed.fits.iter().flat_map(|fitted| {
        let said = match &fitted.fit {
            Ok(fit) => fit.notes.clone(),
            Err(fault) => vec![fault.to_string()],
        };
        said.into_iter().map(|text| (&fitted.labels, text))
    })
}
