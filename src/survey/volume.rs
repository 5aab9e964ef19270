//! Volume and area of a surface inside a polygon, over a base.

use glam::{DVec2, DVec3};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::SurveyError;
use super::base::{Base, BaseFound, Plane};
use super::bridges::Edges;
use super::layers::{Layers, layers};
use super::overlay::{Overlay, around};
use super::polygon::Polygon;
use super::prism::{Corner, Sums, clip_to};
use crate::geometry::Bounds;
use crate::surface::{Patch, Surface};

/// What lies inside a polygon. Lengths in world units, areas in their squares, volumes in their cubes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Volume {
    /// Between surface and base, where the surface is higher: what was put there, a pile's volume.
    pub fill: f64,
    /// Between surface and base, where the surface is lower: what was taken away. Positive.
    pub cut: f64,
    /// The polygon's own area in plan.
    pub plan_area: f64,
    /// The part of it, 0 to 1, that volumes are of: where there is a surface, and a base under it. The
    /// rest is holes, in which nothing is counted.
    pub covered: f64,
    /// The part of the plan, 0 to 1, about, where a mesh has closed bodies and nothing under them: their own volume counts,
    /// and the base does not.
    pub bodies: f64,
    /// The part of the plan, 0 to 1, about, where a mesh's faces (or its base's) lie over others that look up, too, or look down
    /// from the top: there the volume counts twice or with the wrong sign. A hundredth at most.
    pub doubtful: f64,
    /// The area of the surface itself inside the polygon, along its slopes.
    pub surface_area: f64,
    /// The part of the plan, 0 to 1, where a mesh has triangles that look down: what is under such an
    /// overhang is taken off, as it is no rock.
    pub overhang: f64,
    /// The lowest and the highest of the surface inside the polygon, elevations in the world; `None`
    /// where there is no surface.
    pub heights: Option<[f64; 2]>,
    /// The part of the plan, 0 to 1, where triangles of a cloud are longer than [`BRIDGE`](super::BRIDGE) times the median one: no points lie
    /// there, and the volume is what a plane between the rims of the hole makes of it. 0 of a mesh.
    pub bridged: f64,
    /// What the volumes are over.
    pub base: BaseFound,
}

impl Volume {
    /// Fill less cut: the change.
    pub fn net(&self) -> f64 {
        self.fill - self.cut
    }
}

/// A part of the plan from faces that look up less those that look down: of closed bodies it is rounding.
fn part_of_plan(part: f64) -> f64 {
    if part.abs() < 1e-9 {
        0.0
    } else {
        part.min(1.0)
    }
}

/// What was found of some triangles.
#[derive(Debug, Clone, Default)]
struct Found {
    /// Of the surface, over a plane.
    surface: Sums,
    /// Of surface and base where both are.
    both: Sums,
    heights: Option<[f64; 2]>,
    edges: Edges,
}

impl Found {
    fn and(self, other: Self) -> Self {
        let heights = joined(self.heights, other.heights);
        Self {
            surface: self.surface.and(other.surface),
            both: self.both.and(other.both),
            heights,
            edges: self.edges.and(other.edges),
        }
    }
}

/// The lowest and the highest of two ranges.
fn joined(a: Option<[f64; 2]>, b: Option<[f64; 2]>) -> Option<[f64; 2]> {
    match (a, b) {
        (Some(a), Some(b)) => Some([a[0].min(b[0]), a[1].max(b[1])]),
        (one, another) => one.or(another),
    }
}

/// Measures a surface inside a polygon: prisms between its triangles, cut at the polygon's sides, and
/// the base, so exact but for rounding. On all cores.
///
/// # Errors
/// Where the base is no base, or a triangulation fails.
pub fn volume(surface: &Surface, polygon: &Polygon, base: Base<'_>) -> Result<Volume, SurveyError> {
    let origin = surface.frame().origin();
    let parts = polygon.triangles(origin.truncate());
    let area = around(parts.iter().flatten().copied());
    let parts: Vec<([DVec2; 3], [DVec2; 2])> = (parts.into_iter())
        .map(|part| (part, around(part)))
        .collect();
    let base_found = match base {
        Base::Height(height) if !height.is_finite() => {
            return Err(SurveyError::BaseNotFinite(height));
        }
        Base::Height(height) => BaseFound::Height(height),
        Base::Rim => BaseFound::Rim(Plane::of_rim(surface, polygon)?),
        Base::Surface(_) => BaseFound::Surface,
    };
    let overlay = match base {
        Base::Surface(base) => Some(Overlay::new(base, origin, area)?),
        _ => None,
    };
    let over_base = |at: DVec3| match base_found {
        BaseFound::Height(height) => at.z - (height - origin.z),
        BaseFound::Rim(plane) => {
            let from = at - (plane.through - origin);
            from.z - plane.rise.dot(from.truncate())
        }
        BaseFound::Surface => 0.0,
    };
    let misses = |bounds: &Bounds| {
        bounds.max.truncate().cmplt(area[0]).any() || bounds.min.truncate().cmpgt(area[1]).any()
    };
    let patches = surface.patches().seen(misses)?;
    let is_cloud = surface.is_cloud();
    let of_patch = |patch: &Patch<'_>| {
        let mut found = Found::default();
        for corners in patch.triangles() {
            let [low, high] = around(corners.map(DVec3::truncate));
            let beside = |[from, to]: &[DVec2; 2]| high.cmplt(*from).any() || low.cmpgt(*to).any();
            if beside(&area) {
                continue;
            }
            let whole = corners.map(|at| Corner {
                at,
                above: over_base(at),
            });
            for (part, _) in parts.iter().filter(|(_, box_around)| !beside(box_around)) {
                let piece = clip_to(&whole, part);
                if piece.is_empty() {
                    continue;
                }
                let before = found.surface.plan;
                found.surface.add(&piece);
                if is_cloud {
                    let area = found.surface.plan - before;
                    found.edges.add(corners, area);
                }
                if let Some(overlay) = &overlay {
                    overlay.add(&piece, &mut found.both);
                }
                let heights = piece.iter().map(|corner| corner.at.z);
                let lowest = heights.clone().fold(f64::INFINITY, f64::min);
                let highest = heights.fold(f64::NEG_INFINITY, f64::max);
                found.heights = joined(found.heights, Some([lowest, highest]));
            }
        }
        found
    };
    // Added in the order of the patches, so that every run says the same.
    let found: Vec<Found> = patches.par_iter().map(of_patch).collect();
    let found = found.into_iter().fold(Found::default(), Found::and);
    let sums = match overlay {
        Some(_) => found.both,
        None => found.surface,
    };
    let own = layers(surface, polygon)?;
    let under = match base {
        Base::Surface(base) => layers(base, polygon)?,
        _ => Layers::default(),
    };
    // A file may have its faces the other way round.
    let sums = if own.is_turned_over != under.is_turned_over {
        sums.times(-1.0)
    } else {
        sums
    };
    let plan_area = polygon.area();
    Ok(Volume {
        fill: sums.above,
        cut: sums.below,
        plan_area,
        covered: part_of_plan(sums.plan / plan_area),
        bodies: own.closed,
        doubtful: own.doubtful.max(under.doubtful),
        surface_area: found.surface.along,
        overhang: sums.down / plan_area,
        heights: found.heights.map(|heights| heights.map(|z| z + origin.z)),
        bridged: found.edges.bridged() / plan_area,
        base: base_found,
    })
}
