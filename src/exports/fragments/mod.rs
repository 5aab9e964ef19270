//! Outlined fragments: label images, the table of their measures, outlines over the photo and in the world, curves.

mod label_image;
mod left_over;
mod outlines;
mod photo_files;
mod report;
mod sizes;
mod table;
mod tables;
mod world_outlines;

pub use label_image::{label_png, labels_png};
pub use left_over::left_over;
use outlines::outlines_png;
use photo_files::OUTLINED_ENDINGS;
pub use photo_files::{OutlinedFiles, PhotoOutlined, outlined_files};
pub use sizes::{FragmentSizes, MassWay, MeasuredPhoto};
pub use table::{PhotoOfSizes, curves_csv};
pub use tables::{FRAGMENT_TABLES, FragmentTables, distribution_csv, fragment_tables};
use world_outlines::{WorldOutlines, world_geojson};
