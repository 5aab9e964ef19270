//! A figure as a file: SVG for documents, PNG for everything else.

use std::path::Path;

use super::FigureContents;
use super::draw::drawn;
use super::layout::{Layout, TEXT, WIDTH};
use crate::drawing::{png, svg};
use crate::fault::Fault;

/// What a figure is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureFormat {
    /// Lines and text, for documents.
    Svg,
    /// Pixels.
    Png,
}

impl FigureFormat {
    /// By the ending of a file's name.
    ///
    /// # Errors
    ///
    /// Another ending, or none.
    pub fn of(path: &Path) -> Result<Self, Fault> {
        let ending = path
            .extension()
            .map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(Fault::new(
                "a figure is written as SVG or PNG",
                "let its name end in .svg or .png",
            )),
        }
    }

    /// The bytes of a file in this format.
    ///
    /// # Errors
    ///
    /// As [`figure_png`].
    pub fn bytes(self, contents: &FigureContents) -> Result<Vec<u8>, Fault> {
        match self {
            Self::Svg => Ok(figure_svg(contents).into_bytes()),
            Self::Png => figure_png(contents),
        }
    }
}

/// The figure as an SVG document with real text, for a file or the inside of HTML.
pub fn figure_svg(contents: &FigureContents) -> String {
    let layout = layout(contents);
    let shapes = drawn(contents, &layout);
    // Only pictures can fail, and there is none in it.
    svg::document(&shapes, size(&layout), &spoken(contents)).unwrap_or_default()
}

/// The figure as the bytes of a PNG, 1800 pixels wide.
///
/// # Errors
///
/// Only where the encoder fails.
pub fn figure_png(contents: &FigureContents) -> Result<Vec<u8>, Fault> {
    let layout = layout(contents);
    png::bytes(&drawn(contents, &layout), size(&layout))
}

/// The same for both: text is measured with the font of the PNG.
fn layout(contents: &FigureContents) -> Layout {
    Layout::new(contents, |text| png::text_width(TEXT, text))
}

/// Width and height in whole units.
fn size(layout: &Layout) -> [f64; 2] {
    [WIDTH, layout.height.ceil()]
}

/// For those who hear pages: what is drawn, in a sentence.
fn spoken(contents: &FigureContents) -> String {
    let series = contents.passing.series.iter().map(|series| &series.name);
    let bands = contents.passing.bands.iter().map(|band| &band.name);
    let names: Vec<&str> = series
        .chain(bands)
        .map(String::as_str)
        .filter(|n| !n.is_empty())
        .collect();
    let title = match contents.title.as_str() {
        "" => "Size distributions",
        title => title,
    };
    format!(
        "{title}. {} against {}: {}",
        contents.passing.axis_title,
        contents.sizes.title,
        names.join("; ")
    )
}
