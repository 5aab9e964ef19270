//! Whether the trials of a method are alike: the paper's Tables II and III.

use super::sentence::{sentence, warning};
use crate::command::Command;
use crate::fragmentation::{Anova, Repeatability};
use crate::panels::size_distributions::table::{Table, number};
use crate::size_distributions::Computed;

/// Draws the tables of each method.
pub(super) fn show(computed: &Computed, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    if computed.analysis.repeatability.is_empty() {
        sentence(
            "Add more than one trial of a method, to see whether they are alike.",
            ui,
        );
        return;
    }
    for (method, result) in &computed.analysis.repeatability {
        match result {
            Ok(found) => tables(computed, found, ui, commands),
            Err(fault) => {
                let text = format!("{method}: {fault}");
                ui.colored_label(ui.visuals().error_fg_color, text);
            }
        }
        ui.separator();
    }
}

fn tables(
    computed: &Computed,
    found: &Repeatability,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let Repeatability {
        method,
        trials,
        per_size,
        pooled,
        ..
    } = found;
    // First what is to be believed: with several photos a trial, the single sizes.
    if let Some(headline) = headline(found, &computed.analysis.trials.unit.to_string()) {
        ui.add(egui::Label::new(egui::RichText::new(headline).strong()).wrap());
        ui.add_space(4.0);
    }
    match pooled {
        Ok(pooled) => {
            pooled_table(method, pooled, ui, commands);
            if per_size.is_empty() {
                sentence(
                    &format!("{} trials: {}.", trials.len(), pooled.verdict("trials")),
                    ui,
                );
            }
            for note in &pooled.notes {
                warning(note, ui);
            }
        }
        Err(fault) => warning(&format!("{method}: {fault}"), ui),
    }
    if per_size.is_empty() {
        sentence(
            "Size by size it is told where a trial has several photos.",
            ui,
        );
        return;
    }
    ui.add_space(6.0);
    per_size_table(computed, found, ui, commands);
}

/// What the single sizes say; `None` where none was analysed.
fn headline(found: &Repeatability, unit: &str) -> Option<String> {
    let method = &found.method;
    let analysed = found.sizes.iter().zip(&found.per_size);
    let analysed: Vec<(f64, &Anova)> = analysed
        .filter_map(|(size, anova)| Some((*size, anova.as_ref().ok()?)))
        .collect();
    let (_, first) = analysed.first()?;
    // The product may end in ...0001; seven digits are what a level has.
    let level = (first.level * 1e9).round() / 1e7;
    let differ = analysed.iter().filter(|(_, a)| a.differs() == Some(true));
    let differ: Vec<String> = differ.map(|(size, _)| size.to_string()).collect();
    let count = analysed.len();
    Some(match differ.len() {
        0 => {
            format!("{method}: the trials do not differ at any of {count} sizes ({level} % level)")
        }
        some => format!(
            "{method}: the trials differ at {some} of {count} sizes ({level} % level): {} {unit}",
            differ.join(", ")
        ),
    })
}

fn pooled_table(method: &str, pooled: &Anova, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    let mut table = Table::new(format!("{method}, all sizes pooled"));
    table.column("Source", "What the percents passing vary with");
    table.column("df", "Degrees of freedom");
    table.column("SS", "Sum of squares, percentage points squared");
    table.column("MS", "Mean square: sum of squares per degree of freedom");
    table.column("F", "Mean square between the trials over that within them");
    for (source, variation, f) in [
        ("Trial", &pooled.between, pooled.f),
        ("Residual", &pooled.within, None),
        ("Total", &pooled.total, None),
    ] {
        let is_total = source == "Total";
        table.row(vec![
            source.to_owned(),
            variation.degrees_of_freedom.to_string(),
            number(variation.sum_of_squares, 6),
            if is_total {
                String::new()
            } else {
                number(variation.mean_square, 6)
            },
            f.map_or_else(String::new, |f| number(f, 4)),
        ]);
    }
    table.show(ui, commands);
    sentence(&said(pooled), ui);
}

fn per_size_table(
    computed: &Computed,
    found: &Repeatability,
    ui: &mut egui::Ui,
    commands: &mut Vec<Command>,
) {
    let method = &found.method;
    let mut table = Table::new(format!("{method}, size by size"));
    table.column(format!("Size {}", computed.analysis.trials.unit), "");
    table.column("df", "Degrees of freedom between and within the trials");
    table.column("MS trial", "Mean square between the trials");
    table.column("MS residual", "Mean square within the trials");
    table.column("F", "The one over the other");
    table.column(
        "Critical F",
        "Exceeded by chance with the probability of the level",
    );
    table.column(
        "p",
        "Probability of such an F or a larger one if the trials do not differ",
    );
    table.column("Trials differ", "Whether F is above its critical value");
    for (size, anova) in found.sizes.iter().zip(&found.per_size) {
        let mut row = vec![number(*size, 4)];
        match anova {
            Ok(anova) => row.extend([
                format!(
                    "{}, {}",
                    anova.between.degrees_of_freedom, anova.within.degrees_of_freedom
                ),
                number(anova.between.mean_square, 4),
                number(anova.within.mean_square, 4),
                number(anova.f, 4),
                number(anova.critical_f, 3),
                number(anova.p, 3),
                anova
                    .differs()
                    .map_or("–", |differs| if differs { "yes" } else { "no" })
                    .to_owned(),
            ]),
            Err(fault) => {
                row.push(fault.to_string());
                row.resize(8, String::new());
            }
        }
        table.row(row);
    }
    table.show(ui, commands);
}

/// The critical value, the probability and what else the table of sources has no place for.
fn said(anova: &Anova) -> String {
    format!(
        "F({}, {}; {}) = {}, p = {}, R² = {}, residual standard deviation {} percentage points.",
        anova.between.degrees_of_freedom,
        anova.within.degrees_of_freedom,
        anova.level,
        number(anova.critical_f, 3),
        number(anova.p, 3),
        number(anova.r_squared, 3),
        number(anova.residual_standard_deviation, 3)
    )
}
