//! What is learnt from size distributions, going out: tables for people, JSON for programs, CSV, the
//! figure as SVG and PNG, and the report.

mod anova;
mod comparison;
mod effort;
mod figure;
mod fit;
mod points;
mod report;
mod text_table;

pub use anova::{AnovaReport, anova_csv, anova_json, anova_table};
pub use comparison::{comparison_csv, comparison_json, comparison_text};
pub use effort::{effort_csv, effort_json, effort_text};
pub(crate) use figure::passing_figure;
pub use figure::{
    Band, Dash, FigureContents, FigureFormat, FigureStyle, FittedDistribution, Marker, Panel,
    Series, SizeAxis, SizeTick, figure_of_comparison, figure_of_fits, figure_png, figure_svg,
};
pub use fit::{FitReport, FittedCurve, fit_csv, fit_csv_warnings, fit_json, fit_table};
pub use points::points_of_curves_csv;
pub use report::{ComparisonReport, comparison_report};

use crate::fragmentation::{Comparison, MethodComparison, MethodCurve};

/// What is to be known of a comparison before it is trusted, a sentence each: of the reference, of each method, of the
/// functions that were fitted to them.
pub fn comparison_notes(comparison: &Comparison) -> Vec<String> {
    let of_methods = comparison.methods.iter().flat_map(|method| &method.notes);
    let mut notes: Vec<String> = comparison.notes.iter().chain(of_methods).cloned().collect();
    for curve in curves(comparison) {
        let name = method_name(&curve.method);
        notes.extend(
            curve
                .fit
                .notes
                .iter()
                .map(|note| format!("'{name}': {note}")),
        );
    }
    notes
}

/// The reference's curve, then the others'.
fn curves(comparison: &Comparison) -> impl Iterator<Item = &MethodCurve> {
    let others = comparison.methods.iter().map(|method| &method.curve);
    std::iter::once(&comparison.reference).chain(others)
}

/// What the star behind a method's percents at sizes of the reference means; `None` where none has one.
fn star(method: &MethodComparison) -> Option<String> {
    let mut residuals = method.residuals.iter();
    let name = method_name(&method.curve.method);
    let lacking = match method.curve.trials.len() {
        0 | 1 => format!("'{name}' was not measured at this one"),
        _ => format!("not every trial of '{name}' was measured at this one"),
    };
    let is_any = residuals.any(|residual| residual.interpolated);
    is_any.then(|| format!("* interpolated between the sizes beside it: {lacking}"))
}

/// A method's name for people.
fn method_name(method: &str) -> &str {
    match method {
        "" => "measured",
        name => name,
    }
}
