//! Outlined fragments: label images, the table of their measures, outlines over the photo and in the world, curves.

mod label_image;
mod outlines;
mod report;
mod table;
mod world_outlines;

pub use label_image::{label_png, labels_png};
pub use outlines::outlines_png;
pub use report::{FragmentsReport, ReportPhoto, ReportSizes, fragments_report, report_pictures};
pub use table::{PhotoOfFragments, PhotoOfSizes, curves_csv, fragments_csv, sizes_csv};
pub use world_outlines::{WorldOutlines, world_geojson};
