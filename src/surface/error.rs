//! What is wrong with points that make no surface.

/// Points that make no surface.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// Fewer than three different places.
    #[error("the cloud has {0} points with different (x, y); a surface needs at least 3")]
    TooFewPoints(usize),
    /// More points than can be counted here.
    #[error("the cloud has {0} points; thin it to under 4 294 967 296")]
    TooManyPoints(usize),
    /// No triangle has an area over (x, y).
    #[error("all points of the cloud lie on one line in (x, y)")]
    OnOneLine,
    /// A face list without a single triangle.
    #[error("none of the faces has three different corners")]
    NoTriangles,
    /// A face names a point that is not there.
    #[error("face {face} names point {point}, but there are only {count} points (counted from 0)")]
    NoSuchPoint {
        /// Which triangle, from 0.
        face: usize,
        /// The index it names.
        point: u32,
        /// How many points there are.
        count: usize,
    },
    /// NaN or infinity.
    #[error("point {0} (counted from 0) has a coordinate that is not a finite number")]
    NotFinite(usize),
    /// Beyond the reach of exact predicates.
    #[error("a coordinate is larger than 1e60")]
    TooFarOut,
    /// Something needs all triangles of a cloud of which only a part is in memory.
    #[error("only a part of the cloud is in memory, and this needs all of it")]
    OnlyAPart,
    /// A length of [`SurfaceOptions`](super::SurfaceOptions) that is none.
    #[error("{name} is {value}; it must be a positive length")]
    Option {
        /// As flight.toml calls it.
        name: &'static str,
        /// What it is.
        value: f64,
    },
}
