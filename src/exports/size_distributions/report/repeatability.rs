//! Whether the trials of a method agree: tables of variances, as in the paper's Tables II and III.

use super::numbers::{measured, number};
use crate::fault::Fault;
use crate::fragmentation::{Anova, Repeatability};
use crate::html_page::{Cell, NONE, heading, names, notes, paragraph, table};
use crate::size_distributions::method_name;
use crate::units::LengthUnit;

/// The tables of all methods; nothing without any.
pub(super) fn tables(all: &[&Repeatability], unit: LengthUnit) -> String {
    let tables: String = all.iter().map(|of| of_method(of, unit)).collect();
    match tables.is_empty() {
        true => tables,
        false => {
            heading(
                2,
                "Repeatability: one-way analysis of variance over the trials",
            ) + &tables
        }
    }
}

fn of_method(of: &Repeatability, unit: LengthUnit) -> String {
    let mut html = heading(3, method_name(&of.method));
    html += &match &of.pooled {
        Ok(pooled) => {
            let what = format!("All sizes pooled, {} trials.", of.trials.len());
            paragraph(&what) + &layout(pooled) + &verdict(pooled) + &notes(&pooled.notes)
        }
        Err(fault) => paragraph(&fault.to_string()),
    };
    if of.per_size.is_empty() {
        return html;
    }
    let rows = of.sizes.iter().zip(&of.per_size);
    let rows = rows.map(|(size, anova)| {
        let mut row = vec![Cell::from(measured(*size))];
        match anova {
            Ok(anova) => row.extend([
                format!(
                    "{}, {}",
                    anova.between.degrees_of_freedom, anova.within.degrees_of_freedom
                )
                .into(),
                optional(anova.f).into(),
                number(anova.critical_f).into(),
                optional(anova.p).into(),
                agree(anova),
            ]),
            Err(Fault { what, .. }) => {
                row.push(what.as_str().into());
                row.extend([NONE, NONE, NONE, NONE].map(Cell::from));
            }
        }
        row
    });
    let head = [
        format!("Size, {unit}"),
        "Degrees of freedom".to_owned(),
        "F".to_owned(),
        "Critical F".to_owned(),
        "p".to_owned(),
        "Trials".to_owned(),
    ];
    html + &paragraph("Each size on its own, the photos of a trial being its group.")
        + &table(&head, rows.collect())
}

/// The paper's layout.
fn layout(anova: &Anova) -> String {
    let head = names(&[
        "Source",
        "Degrees of freedom",
        "Sum of squares",
        "Mean square",
        "F",
    ]);
    let sources = [
        ("Trial", anova.between, optional(anova.f)),
        ("Residual", anova.within, String::new()),
        ("Total", anova.total, String::new()),
    ];
    let rows = sources.map(|(name, of, f)| {
        let mean = if name == "Total" {
            String::new()
        } else {
            number(of.mean_square)
        };
        vec![
            Cell::from(name),
            of.degrees_of_freedom.to_string().into(),
            number(of.sum_of_squares).into(),
            mean.into(),
            f.into(),
        ]
    });
    table(&head, rows.into_iter().collect())
}

fn verdict(anova: &Anova) -> String {
    let differ = match anova.f {
        Some(f) if f > anova.critical_f => "the trials differ",
        Some(_) => "no difference between the trials is shown",
        None => "nothing varies within the trials",
    };
    paragraph(&format!(
        "F is critical above {} at a level of {}: {differ} (p = {}).",
        number(anova.critical_f),
        anova.level,
        optional(anova.p)
    ))
}

fn agree(anova: &Anova) -> Cell {
    match anova.f {
        Some(f) if f > anova.critical_f => Cell::Judged(false, "differ"),
        Some(_) => Cell::Judged(true, "alike"),
        None => NONE.into(),
    }
}

/// F or p with four decimals.
fn optional(value: Option<f64>) -> String {
    value.map_or(NONE.to_owned(), |value| format!("{value:.4}"))
}
