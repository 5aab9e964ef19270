//! What goes out drawn: shapes, and one writer for each format that they go out in.
//!
//! ```text
//! shapes         lines, areas, words and pictures
//! strokes        markers and dashes
//! svg, png, pdf  the shapes as a document, in pixels, on a page; base64 for pictures inside SVG
//! format         which of them a file's name asks for
//! ```

mod base64;
mod format;
pub(crate) mod pdf;
pub(crate) mod png;
mod shapes;
mod strokes;
pub(crate) mod svg;

pub(crate) use base64::base64;
pub use format::DrawingFormat;
pub(crate) use shapes::{Anchor, Colour, Pen, Shape};
pub use strokes::{Dash, Marker};
