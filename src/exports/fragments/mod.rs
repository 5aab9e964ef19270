//! Outlined fragments: label images, the table of their measures, outlines over the photo, curves.

mod label_image;
mod outlines;
mod table;

pub use label_image::{label_png, labels_png};
pub use outlines::outlines_png;
pub use table::{PhotoOfFragments, PhotoOfSizes, curves_csv, fragments_csv, sizes_csv};
