//! A figure as a file: SVG for documents, PNG for everything else.

use std::path::Path;

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, RgbImage};
use plotters::drawing::IntoDrawingArea;
use plotters::prelude::{BitMapBackend, DrawingBackend, SVGBackend};

use super::FigureContents;
use super::draw::draw;
use super::layout::{Layout, TEXT, WIDTH};
use super::pen::{FINE, Pen, of_plotters};
use crate::fault::Fault;
use crate::files::{SVG_MARK, marked_png};
use crate::markup::escaped;
use crate::picture::reduced;

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
    /// As [`figure_svg`] and [`figure_png`].
    pub fn bytes(self, contents: &FigureContents) -> Result<Vec<u8>, Fault> {
        match self {
            Self::Svg => figure_svg(contents).map(String::into_bytes),
            Self::Png => figure_png(contents),
        }
    }
}

/// Pixels of a PNG to a unit of the figure: 1800 across, which are 300 dpi at 15 cm.
const PIXELS: u32 = 2;

/// Where plotters puts text, in heights of a line: an SVG's by half an ex, a picture's by its own count.
const SVG_LOWER: f64 = 0.09;
const PNG_LOWER: f64 = 0.21;

/// The figure as an SVG document with real text, for a file or the inside of HTML.
///
/// # Errors
///
/// Only where plotters fails.
pub fn figure_svg(contents: &FigureContents) -> Result<String, Fault> {
    let mut drawn = String::new();
    let layout = layout(contents)?;
    let size @ (width, height) = fine_size(&layout);
    draw_on(
        SVGBackend::with_string(&mut drawn, size),
        contents,
        &layout,
        SVG_LOWER,
    )?;
    // Plotters' own first tag says neither what the picture is nor that its units are finer.
    let body = drawn.split_once('\n').map_or("", |(_, body)| body);
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" \
         viewBox=\"0 0 {width} {height}\" role=\"img\">\n{SVG_MARK}<title>{}</title>\n{body}",
        width / FINE,
        height / FINE,
        escaped(&spoken(contents)),
    ))
}

/// The figure as the bytes of a PNG, 1800 pixels wide.
///
/// # Errors
///
/// Only where plotters or the encoder fails.
pub fn figure_png(contents: &FigureContents) -> Result<Vec<u8>, Fault> {
    let layout = layout(contents)?;
    let size @ (width, height) = fine_size(&layout);
    let mut pixels = vec![0; width as usize * height as usize * 3];
    draw_on(
        BitMapBackend::with_buffer(&mut pixels, size),
        contents,
        &layout,
        PNG_LOWER,
    )?;
    let fine = RgbImage::from_raw(width, height, pixels).unwrap_or_default();
    let picture = reduced(&fine, width.max(height) * PIXELS / FINE);
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(
            &picture,
            picture.width(),
            picture.height(),
            ExtendedColorType::Rgb8,
        )
        .map_err(|e| {
            let what = format!("the figure cannot be encoded ({e})");
            Fault::new(what, "report it: this is a defect")
        })?;
    Ok(marked_png(bytes))
}

/// The same for both pictures: text is measured with the font of the PNG.
fn layout(contents: &FigureContents) -> Result<Layout, Fault> {
    let mut nothing = String::new();
    let area = SVGBackend::with_string(&mut nothing, (1, 1)).into_drawing_area();
    let pen = Pen::new(&area, 0.0)?;
    Ok(Layout::new(contents, |text| pen.width(TEXT, text)))
}

/// Width and height in plotters' units; a multiple of `FINE`, so that nothing is cut when reduced.
fn fine_size(layout: &Layout) -> (u32, u32) {
    let whole = |length: f64| length.ceil() as u32 * FINE;
    (whole(WIDTH), whole(layout.height))
}

fn draw_on<B: DrawingBackend>(
    backend: B,
    contents: &FigureContents,
    layout: &Layout,
    lower: f64,
) -> Result<(), Fault> {
    let area = backend.into_drawing_area();
    draw(contents, layout, &Pen::new(&area, lower)?)?;
    area.present().map_err(of_plotters)
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
