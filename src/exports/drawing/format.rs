//! A drawing as a file, in the format that its name asks for.

use std::path::Path;

use super::shapes::Shape;
use super::{pdf, png, svg};
use crate::fault::Fault;

/// What a drawing is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DrawingFormat {
    /// Lines and text, for documents.
    Svg,
    /// The same, to print.
    Pdf,
    /// Pixels.
    Png,
}

impl DrawingFormat {
    /// By the ending of a file's name.
    ///
    /// # Errors
    /// Another ending, or none.
    pub fn of(path: &Path) -> Result<Self, Fault> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        match ending.to_lowercase().as_str() {
            "svg" => Ok(Self::Svg),
            "pdf" => Ok(Self::Pdf),
            "png" => Ok(Self::Png),
            _ => Err(Fault::new(
                "a drawing is written as SVG, PDF or PNG",
                "let its name end in .svg, .pdf or .png",
            )),
        }
    }

    /// The bytes of a file of this size, a CSS pixel a unit; `title` is for those who hear it.
    ///
    /// # Errors
    /// Only where the encoder fails.
    pub(crate) fn bytes(
        self,
        shapes: &[Shape],
        size: [f64; 2],
        title: &str,
    ) -> Result<Vec<u8>, Fault> {
        match self {
            Self::Svg => Ok(svg::document(shapes, size, title)?.into_bytes()),
            Self::Pdf => pdf::document(shapes, size, title),
            Self::Png => png::bytes(shapes, size),
        }
    }
}
