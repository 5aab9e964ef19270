//! The files that a flight is made of, as a simulation or a reconstruction writes them: poses and clouds.
//! Values go in, bytes or text come out, the same ones on every day.

mod laz;
mod ply;
mod poses_csv;

pub use self::laz::laz;
pub use self::ply::ply;
pub use self::poses_csv::{Orientation, PoseRow, StatedDeviations, poses_csv};
