//! A frame of its own brought to the world: the paper's "finally transforms the point cloud using
//! global position information".
//!
//! Pairs of positions, one in the reconstruction's frame and one in the world, give a similarity
//! (rotation, one scale, translation): by least squares ([`similarity_of`], Umeyama 1991) inside a
//! search that does not mind wrong pairs ([`fit()`]). A world of Earth coordinates is no obstacle:
//! everything is counted from the middle of the points.

mod agreeing;
mod fit;
mod lengths;
mod level;
mod student;
mod triangulate;
mod turned_over;
mod umeyama;

pub use fit::{Fit, Pair, fit};
pub use lengths::{KnownLength, LengthsFit, scale_of_lengths};
pub use level::levelled;
pub use triangulate::{Sight, Triangulated, triangulate};
pub use turned_over::is_turned_over;
pub use umeyama::similarity_of;
