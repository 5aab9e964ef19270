//! What is learnt from size distributions, going out: tables for people, JSON for programs, CSV, the
//! figure as SVG and PNG, and the report.

mod figure;
mod report;

pub use figure::{
    Band, Dash, FigureContents, FittedDistribution, Look, Marker, Panel, Series, SizeAxis,
    SizeTick, figure_of_comparison, figure_of_fits, figure_png, figure_svg,
};
pub use report::{ComparisonReport, comparison_report};

/// A method's name for people.
fn method_name(method: &str) -> &str {
    if method.is_empty() {
        "measured"
    } else {
        method
    }
}
