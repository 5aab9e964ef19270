//! What is measured on a surface: profiles along lines, areas and volumes inside polygons. Exact on the
//! triangles, in the world's unit; where there is no triangle nothing is filled in, and how much is
//! missing is told.
//!
//! ```text
//! profile   the surface over a line: a height at every edge that is crossed
//! face      crest, toe and angle of repose of a profile
//! polygon   an outline in plan, cut into triangles
//! prism     integrals under a piece of a triangle
//! bridges   what lies on triangles over holes
//! base      what volumes are over: a level, the plane of the rim, another surface
//! overlay   which triangles of another surface lie under one
//! layers    whether a mesh's faces lie so that prisms under them add up
//! volume    all of it inside a polygon
//! ```

mod base;
mod bridges;
mod envelope;
mod face;
mod layers;
mod overlay;
mod polygon;
mod prism;
mod profile;
mod volume;

pub use base::{Base, BaseFound, Plane};
pub use bridges::{BRIDGE, LEAST_BRIDGED};
pub use face::Face;
pub use polygon::{MOST_CORNERS, Polygon};
pub use profile::{Profile, ProfilePoint};
pub use volume::{Volume, volume};

use crate::surface::SurfaceError;

/// Why something cannot be measured.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SurveyError {
    /// A line needs two different places.
    #[error("the line has no length; give two different places")]
    NoLength,
    /// NaN or infinity.
    #[error("place {0} (counted from 1) is not a finite number")]
    NotFinite(usize),
    /// A polygon needs three.
    #[error("the polygon has {0} different corners; give at least three")]
    TooFewCorners(usize),
    /// More than [`MOST_CORNERS`].
    #[error("the polygon has {0} corners; simplify it to at most {MOST_CORNERS}")]
    TooManyCorners(usize),
    /// Two of its sides meet.
    #[error("sides {0} and {1} of the polygon (counted from 1) cross or touch; draw it without")]
    CrossesItself(usize, usize),
    /// All corners on a line.
    #[error("the polygon has no area; its corners lie on one line")]
    NoArea,
    /// The elevation of the base is NaN or infinity.
    #[error("the base is at {0}; give a finite elevation")]
    BaseNotFinite(f64),
    /// Too little to lay a plane through.
    #[error(
        "only {0:.0} % of the polygon's rim lies on the surface, too little for a plane through it; \
         draw it inside the surface or give the base's height"
    )]
    RimNotCovered(f64),
    /// What the rim shows lies on one line.
    #[error("no plane can be laid through the polygon's rim; give the base's height")]
    NoRimPlane,
    /// Percent of the polygon.
    #[error(
        "in {0:.1} % of the polygon faces of the mesh lie over others that look up, too: they would count twice; \
         merge tiles that overlap and remove faces that are there twice, in a mesh program, or give the points as a cloud"
    )]
    CountedTwice(f64),
    /// Percent of the polygon.
    #[error(
        "in {0:.1} % of the polygon faces of the mesh look down that look up elsewhere: what they bound would count with the \
         wrong sign; let a mesh program turn all of them outwards, or give the points as a cloud"
    )]
    TurnedOver(f64),
    /// The faces cannot be looked at.
    #[error("{0}")]
    Faces(String),
    /// The triangulation failed.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
}

#[cfg(test)]
mod tests;
