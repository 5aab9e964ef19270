//! Points, rays and frames, all f64.

mod bounds;
mod level_box;
mod local_frame;
mod median;
mod outline;
mod ray;
mod similarity;

pub use bounds::Bounds;
pub use level_box::LevelBox;
pub use local_frame::LocalFrame;
pub use median::{median, median_with_deviation};
pub use outline::{extent, surrounds, twice_signed_area};
pub use ray::Ray;
pub use similarity::{NotSimilarity, Similarity};
