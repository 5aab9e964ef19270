//! The figure of a flight against its plan (Bamford, Esmaeili & Schoellig 2017, figure of the flight): the box of air
//! that was flown in, the planned and the flown path, and where each photo was taken.
//!
//! It is one parallel view from the side and from above, for heights and places are seen in it together: lengths along
//! each side of the box are all to one scale, which its labels say; lines that are parallel stay so. Each place stands
//! over the foot of a line on the floor of the box, so that nobody takes depth for height. Residuals
//! are to scale, not made larger.
//!
//! ```text
//! view   from which side, and how large
//! draw   the box, the paths, the photos, the legend
//! names  of photos, where they have room
//! page   the figure with the table of residuals, as a page for the flight's report
//! ```

mod draw;
mod names;
mod page;
mod style;
#[cfg(test)]
mod tests;
mod view;

use glam::DVec3;

use crate::drawing::DrawingFormat;
use crate::fault::Fault;
use crate::flown_report::FlownReport;

/// A flight against its plan, with what its figure shows besides.
#[derive(Debug, Clone, Copy)]
pub struct FlownFigure<'a> {
    /// The comparison.
    pub report: &'a FlownReport<'a>,
    /// Where each photo was taken, in the world; as many as the report has names.
    pub places: &'a [DVec3],
    /// Whether y of the world is the north of a map.
    pub is_on_map: bool,
}

impl FlownFigure<'_> {
    /// The figure with the numbers, the table of residuals and what was not taken, as one HTML page.
    ///
    /// # Errors
    /// Only where the figure cannot be encoded.
    pub fn page(&self, warnings: &[String]) -> Result<String, Fault> {
        page::page(self, warnings)
    }

    /// The bytes of a file of this format.
    ///
    /// # Errors
    /// Only where the encoder fails.
    pub fn bytes(&self, format: DrawingFormat) -> Result<Vec<u8>, Fault> {
        let (shapes, size) = draw::draw(self);
        let title = format!("{}: planned and flown", self.report.flight);
        format.bytes(&shapes, size, &title)
    }
}
