//! The fitted functions: parameters, how well they fit, percentiles with their bands.

use super::results::{sentence, warning};
use super::table::{Table, fixed, number};
use crate::app::command::Command;
use crate::app::size_distributions::Computed;
use crate::app::size_distributions::computing::{FittedCurve, PERCENTILES};
use crate::fragmentation::Labels;

/// Draws the tables.
pub(super) fn fits(computed: &Computed, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let settings = &computed.edit.settings;
    let unit = computed.set.unit;
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
    let mut percentiles = Table::new(format!("Percentiles, {unit}"));
    percentiles.column("Curve", "Method, trial");
    for percent in PERCENTILES {
        percentiles.column(
            format!("P{percent}"),
            format!("{percent} % of the mass passes it"),
        );
        let band = 100.0 * (1.0 - settings.level);
        let hover = format!("Confidence band of {} %", number(band, 3));
        percentiles.column(format!("P{percent} band"), hover);
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
            row.push(number(parameter.value, 5));
            row.push(number(parameter.standard_error, 2));
        }
        row.push(fixed(fit.rmse, 2));
        row.push(fixed(fit.r_squared, 4));
        row.push(fit.residuals.len().to_string());
        parameters.row(row);
        let mut row = vec![labels.to_string()];
        for size in sizes {
            row.push(number(size.size, 4));
            row.push(size.band.map_or_else(
                || "–".to_owned(),
                |[low, high]| format!("{} to {}", number(low, 4), number(high, 4)),
            ));
        }
        percentiles.row(row);
    }
    parameters.show(ui, commands);
    percentiles.show(ui, commands);
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
