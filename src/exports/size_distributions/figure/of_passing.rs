//! What a figure shows of distributions alone.

use super::panels;
use super::{FigureContents, Series, SizeAxis};
use crate::units::LengthUnit;

/// Curves of percent passing, the first at the back; sizes in this unit.
pub(crate) fn passing_figure(unit: LengthUnit, series: Vec<Series>) -> FigureContents {
    let sizes = series.iter().flat_map(|of| &of.line).map(|point| point[0]);
    FigureContents {
        title: String::new(),
        sizes: SizeAxis::covering(panels::size_title(unit), sizes),
        passing: panels::passing_panel(Vec::new(), series),
        residuals: None,
    }
}
