//! What a lens model says of a point that it does not reach.

/// The model does not reach this point of the image: no direction is seen there.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the distortion model folds back before it reaches this point (at a distorted radius of {fold:.4} focal lengths, the point is at {radius:.4})"
)]
pub struct NotInvertible {
    /// Distance of the point from the principal point, in focal lengths.
    pub radius: f64,
    /// How far the model reaches in that direction, in focal lengths.
    pub fold: f64,
}
