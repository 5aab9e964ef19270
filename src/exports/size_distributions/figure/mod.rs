//! The figure of size distributions: percent passing against size, and the residuals below it.
//!
//! ```text
//! style       colours, markers and dashes that are told apart in print and by the colour-blind
//! size_axis   where the logarithmic axis begins and ends, its lines and labels
//! of_comparison, of_fits, of_passing  what is shown of them
//! panels      what the panels of both have in common
//! layout      where everything is
//! draw        the contents as shapes (`crate::drawing`), the same on paper (SVG) and in pixels (PNG)
//! picture     a figure as a file
//! ```
//!
//! `FigureContents` knows nothing of who draws it: the window draws the same.

mod draw;
mod layout;
mod of_comparison;
mod of_fits;
mod of_passing;
mod panels;
mod picture;
mod size_axis;
mod style;
#[cfg(test)]
#[allow(
    clippy::expect_used,
    clippy::panic,
    reason = "in a test a panic is the report"
)]
mod tests;

pub use crate::drawing::{Dash, Marker};
pub use of_comparison::figure_of_comparison;
pub use of_fits::{FittedDistribution, figure_of_fits};
pub(crate) use of_passing::passing_figure;
pub use picture::{FigureFormat, figure_png, figure_svg};
pub use size_axis::{SizeAxis, SizeTick};
pub use style::FigureStyle;

/// What a figure shows. All sizes are in the unit of the size axis.
#[derive(Debug, Clone, PartialEq)]
pub struct FigureContents {
    /// Above the figure; may be empty.
    pub title: String,
    /// Of both panels.
    pub sizes: SizeAxis,
    /// Percent passing, 0 to 100. The legend is of this panel.
    pub passing: Panel,
    /// What is left between measured and reference or fitted, the styles being those of `passing`.
    pub residuals: Option<Panel>,
}

/// Values against sizes.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What the values are, with their unit.
    pub axis_title: String,
    /// The lowest and the highest value of the axis.
    pub range: [f64; 2],
    /// From the lowest to the highest value, where lines and labels are.
    pub ticks: Vec<f64>,
    /// Values with a line of their own across the panel, such as limits.
    pub levels: Vec<f64>,
    /// Behind the series, the first at the back.
    pub bands: Vec<Band>,
    /// The first at the back.
    pub series: Vec<Series>,
}

/// An area between two curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// For the legend.
    pub name: String,
    /// Whose it is.
    pub style: FigureStyle,
    /// Whether its edges are dashed lines, or it is a shade only.
    pub outlined: bool,
    /// The two edges, points [size, value], sizes ascending in each.
    pub edges: [Vec<[f64; 2]>; 2],
}

/// A measured distribution with its fitted curve, or the errors of one.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// For the legend.
    pub name: String,
    /// Its colour, marker and dash.
    pub style: FigureStyle,
    /// Drawn as markers, [size, value], sizes ascending.
    pub points: Vec<[f64; 2]>,
    /// Drawn as a line, [size, value], sizes ascending; empty without one.
    pub line: Vec<[f64; 2]>,
    /// [size, value] on the line from which one reads the size, as the P50.
    pub marks: Vec<[f64; 2]>,
}
