//! The figure of size distributions: percent passing against size, and the percent errors below it.
//!
//! ```text
//! look        colours, markers and dashes that are told apart in print and by the colour-blind
//! size_axis   where the logarithmic axis begins and ends, its lines and labels
//! contents    what is shown, from fits or a comparison
//! draw        the contents by plotters, the same on paper (SVG) and in pixels (PNG)
//! picture     the bytes of both
//! ```
//!
//! `FigureContents` knows nothing of who draws it: the window draws the same.

mod look;
mod size_axis;

pub use look::{Dash, Look, Marker};
pub use size_axis::{SizeAxis, SizeTick};

/// What a figure shows. All sizes are in the unit of the size axis; nothing in it is drawn twice.
#[derive(Debug, Clone, PartialEq)]
pub struct FigureContents {
    /// Above the figure; may be empty.
    pub title: String,
    /// Of both panels.
    pub sizes: SizeAxis,
    /// Percent passing, 0 to 100. The legend is of this panel.
    pub passing: Panel,
    /// Percent errors against the reference, where there is one. Its looks are those of `passing`.
    pub errors: Option<Panel>,
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
    pub look: Look,
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
    pub look: Look,
    /// Drawn as markers, [size, value], sizes ascending.
    pub points: Vec<[f64; 2]>,
    /// Drawn as a line, [size, value], sizes ascending; empty without one.
    pub line: Vec<[f64; 2]>,
    /// [size, value] on the line from which one reads the size, as the P50.
    pub marks: Vec<[f64; 2]>,
}
