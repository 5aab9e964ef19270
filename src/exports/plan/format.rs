//! A plan as a file, in the format that its name asks for.

use std::path::Path;

use super::page::Page;
use super::{Plan, geotiff};
use crate::drawing::{pdf, png, svg};
use crate::fault::Fault;
use crate::units::LengthUnit;

/// The most pixels of the ground in a document: what is larger no report can hold.
const MOST_IN_DOCUMENT: u64 = 10_000_000;

/// What a plan is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlanFormat {
    /// Pixels with their place on the map.
    GeoTiff,
    /// A page in lines and text, the ground as pixels.
    Svg,
    /// The same, to print.
    Pdf,
    /// A page in pixels.
    Png,
}

impl PlanFormat {
    /// By the ending of a file's name.
    ///
    /// # Errors
    /// Another ending, or none.
    pub fn of(path: &Path) -> Result<Self, Fault> {
        let ending = path
            .extension()
            .map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("tif" | "tiff") => Ok(Self::GeoTiff),
            Some("svg") => Ok(Self::Svg),
            Some("pdf") => Ok(Self::Pdf),
            Some("png") => Ok(Self::Png),
            _ => Err(Fault::new(
                "a map is written as GeoTIFF, SVG, PDF or PNG",
                "let its name end in .tif, .svg, .pdf or .png",
            )),
        }
    }

    /// The bytes of a file in this format; the bar is in `unit`.
    ///
    /// # Errors
    /// Where a document's ground would have more than 10 million pixels, or it cannot be encoded.
    pub fn bytes(self, plan: &Plan, unit: LengthUnit) -> Result<Vec<u8>, Fault> {
        if self == Self::GeoTiff {
            return geotiff::bytes(plan);
        }
        let (columns, rows) = (plan.raster.columns, plan.raster.rows);
        if u64::from(columns) * u64::from(rows) > MOST_IN_DOCUMENT {
            let most = MOST_IN_DOCUMENT / 1_000_000;
            return Err(Fault::new(
                format!(
                    "its ground has {columns} x {rows} pixels, more than the {most} million that go on a page"
                ),
                "give a larger --pixel, or write a GeoTIFF",
            ));
        }
        let page = Page::new(plan);
        let shapes = page.shapes(plan, unit);
        let title = format!("Map of {}", plan.flight);
        match self {
            Self::Svg => Ok(svg::document(&shapes, page.size.map(hundredth), &title)?.into_bytes()),
            Self::Pdf => pdf::document(&shapes, page.size, &title),
            Self::Png | Self::GeoTiff => png::bytes(&shapes, page.size),
        }
    }

    /// What was made, for people.
    pub fn words(self, plan: &Plan) -> String {
        let raster = &plan.raster;
        let size = format!(
            "{} x {} pixels of {} {}",
            raster.columns,
            raster.rows,
            raster.pixel,
            plan.unit_of_lengths()
        );
        let crs = plan.crs_in_words();
        match self {
            Self::GeoTiff => format!("{size}, {crs}"),
            Self::Svg | Self::Pdf | Self::Png => {
                let scale = Page::new(plan).denominator;
                let scale = scale.map_or_else(String::new, |n| format!(", 1 : {n} on A4"));
                format!("ground of {size}{scale}, {crs}")
            }
        }
    }
}

fn hundredth(length: f64) -> f64 {
    (length * 100.0).round() / 100.0
}
