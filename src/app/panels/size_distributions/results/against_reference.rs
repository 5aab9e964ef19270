//! Every method against the reference: percent errors, norms, shifts.

use super::sentence::{sentence, warning};
use crate::command::Command;
use crate::exports::comparison_notes;
use crate::fragmentation::{Comparison, PERCENT_ERROR, SCALE_WARNING};
use crate::panels::size_distributions::table::{Table, fixed, number, signed};
use crate::size_distributions::Computed;

/// Draws the tables, or why there are none.
pub(super) fn show(computed: &Computed, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let analysis = &computed.analysis;
    match &analysis.comparison {
        _ if analysis.methods.len() < 2 => {
            sentence("Add another method, to hold it against this one.", ui);
        }
        Err(fault) => {
            ui.colored_label(ui.visuals().error_fg_color, fault.to_string());
        }
        Ok(comparison) => tables(comparison, ui, commands),
    }
}

fn tables(comparison: &Comparison, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let unit = comparison.unit;
    let reference = &comparison.reference.method;
    sentence(&format!("Reference: {reference}."), ui);
    shifts(comparison, ui, commands);
    for note in comparison_notes(comparison) {
        warning(&note, ui);
    }
    sentence(&first_upper(SCALE_WARNING), ui);
    ui.add_space(8.0);
    norms(comparison, ui, commands);
    let mut table = Table::new("Percent error of the passing");
    table.column(format!("Size {unit}"), "The reference's sizes");
    table.column(reference.as_str(), "Mean percent passing of the reference");
    for method in &comparison.methods {
        let name = &method.curve.method;
        table.column(name.as_str(), "Mean percent passing of its trials");
        table.column("Error %", PERCENT_ERROR);
        let hover = format!(
            "Whether the error is within ± {} %",
            comparison.options.envelope_percent
        );
        table.column("Within", hover);
    }
    let sizes = comparison.methods.first().map_or(0, |m| m.residuals.len());
    for place in 0..sizes {
        let mut row = Vec::new();
        for method in &comparison.methods {
            let Some(error) = method.residuals.get(place) else {
                continue;
            };
            if row.is_empty() {
                row.push(number(error.size, 4));
                row.push(fixed(error.reference, 2));
            }
            row.push(fixed(error.passing, 2));
            row.push(signed(error.percent_error, 1));
            row.push(yes_no(error.within));
        }
        table.row(row);
    }
    table.show(ui, commands);
    sentence(&first_upper(PERCENT_ERROR), ui);
}

fn shifts(comparison: &Comparison, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let unit = comparison.unit;
    let mut table = Table::new(format!("Shifts of the fitted percentiles, {unit}"));
    table.column("Percentile", "Sizes of the fitted functions");
    table.column(comparison.reference.method.as_str(), "The reference's size");
    let envelope = comparison.options.envelope_percent;
    table.column("Envelope", format!("The reference's size ± {envelope} %"));
    for method in &comparison.methods {
        table.column(method.curve.method.as_str(), "The method's size");
        table.column(
            "Shift %",
            "Of the reference's size; above 0 the method says coarser",
        );
        table.column("Inside", "Whether the method's size is in the envelope");
    }
    for (place, percent) in comparison.options.percentiles.iter().enumerate() {
        let mut row = vec![format!("P{percent}")];
        for method in &comparison.methods {
            let Some(shift) = method.shift.percentiles.get(place) else {
                continue;
            };
            if row.len() == 1 {
                let [low, high] = shift.envelope;
                row.push(number(shift.reference, 4));
                row.push(format!("{} to {}", number(low, 4), number(high, 4)));
            }
            row.push(number(shift.size, 4));
            row.push(signed(shift.shift_percent, 1));
            row.push(yes_no(Some(shift.inside)));
        }
        table.row(row);
    }
    let mut row = vec!["mean".to_owned(), String::new(), String::new()];
    for method in &comparison.methods {
        row.push(String::new());
        let spread = fixed(method.shift.spread_percent, 1);
        row.push(format!(
            "{} ± {spread}",
            signed(method.shift.mean_percent, 1)
        ));
        row.push(String::new());
    }
    table.row(row);
    table.show(ui, commands);
}

fn norms(comparison: &Comparison, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let mut table = Table::new("Distance of the fitted curves");
    let (from, to) = (comparison.span.from, comparison.span.to);
    let unit = comparison.unit;
    table.column("Method", "");
    let hover =
        "2-norm of the difference over the reference's curve, in percent of the reference's";
    table.column("Norm %", hover);
    table.column("RMS difference", "Percentage points of the passing");
    for method in &comparison.methods {
        table.row(vec![
            method.curve.method.clone(),
            fixed(method.norm.relative_percent, 2),
            fixed(method.norm.rms_difference, 2),
        ]);
    }
    table.show(ui, commands);
    let text = format!(
        "Taken from {} to {} {unit}, evenly in the logarithm of the size.",
        number(from, 4),
        number(to, 4)
    );
    sentence(&text, ui);
    for improvement in &comparison.improvements {
        // Each pair is there both ways; told is who is nearer.
        if let Some(percent) = improvement.percent
            && percent >= 0.0
        {
            let text = format!(
                "{} is nearer to the reference than {} by {} % of the latter's norm.",
                improvement.method,
                improvement.over,
                fixed(percent, 1)
            );
            sentence(&text, ui);
        }
    }
    ui.add_space(8.0);
}

fn yes_no(value: Option<bool>) -> String {
    match value {
        Some(true) => "yes".to_owned(),
        Some(false) => "no".to_owned(),
        None => "–".to_owned(),
    }
}

/// As a sentence of its own.
fn first_upper(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters
        .next()
        .map(|letter| letter.to_uppercase().to_string());
    format!("{}{}.", first.unwrap_or_default(), letters.as_str())
}
