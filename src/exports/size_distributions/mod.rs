//! What is learnt from size distributions, going out: tables for people, JSON for programs, CSV, the
//! figure as SVG and PNG, and the report.

mod figure;

pub use figure::{
    Band, Dash, FigureContents, FittedDistribution, Look, Marker, Panel, Series, SizeAxis,
    SizeTick, figure_of_comparison, figure_of_fits, figure_png, figure_svg,
};

/// A method's name for people.
fn method_name(method: &str) -> &str {
    if method.is_empty() {
        "measured"
    } else {
        method
    }
}
