//! The surface: triangles that rays meet.
//!
//! A cloud becomes its 2.5-D Delaunay triangulation over (x, y); a file with faces is used as it is
//! (contract, section 2). The two have different ways to meet rays: `walk` for a cloud, which
//! builds no more than the rays ask for, `mesh` for faces, which may overhang.

mod around;
mod caster;
mod cloud;
mod delaunay;
mod error;
mod from_above;
mod hull;
mod left_out;
mod levels;
mod made_once;
mod mesh;
mod part;
mod patches;
mod sites;
mod thinning;
mod tiles;
mod triangle_blocks;
mod up_axis;
mod vertices;
mod walk;
mod welded;

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use glam::DVec3;

pub use caster::{Caster, Hit};
pub use cloud::Cloud;
pub use error::SurfaceError;
pub use from_above::{Face, Light, MapRaster, hillshade};
pub use hull::convex_hull;
pub use left_out::LeftOut;
pub use levels::{Chosen, LevelNode, Levels};
pub use part::{CloudFacts, HullOfMany, PartPlan};
pub use patches::{Patch, Patches};
pub use sites::Wanted;
pub use up_axis::{UpAxis, doubtful_up};
pub use vertices::{VertexBlock, bulk_of};

use crate::geometry::{Bounds, LocalFrame};
use mesh::Mesh;
use patches::Run;
use sites::{Sites, sample_stride};
use tiles::Tiles;

/// What is left out of a surface. By default nothing is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SurfaceOptions {
    /// Triangles with a longer edge (world units, in 3D) are no part of the surface: rays pass
    /// through, as they should through a hole in the cloud. Edges and vertices that such a triangle
    /// shares with a shorter one still belong to the surface.
    pub max_edge: Option<f64>,
    /// One point stays in each square cell of this size (world units) over (x, y): the one nearest to
    /// the cell's middle, of equally near ones the highest. The cells lie at whole multiples of the
    /// size, so that the extent of the cloud does not matter. A mesh is used as it is.
    pub thinning: Option<f64>,
}

impl SurfaceOptions {
    /// Checks that the lengths are positive and finite.
    ///
    /// # Errors
    /// With the first that is not.
    pub fn validate(&self) -> Result<(), SurfaceError> {
        for (name, length) in [("max_edge", self.max_edge), ("thinning", self.thinning)] {
            if let Some(value) = length
                && !(value > 0.0 && value.is_finite())
            {
                return Err(SurfaceError::Option { name, value });
            }
        }
        Ok(())
    }
}

/// A surface that rays can be cast at. Clones share everything.
#[derive(Debug, Clone)]
pub struct Surface {
    /// All triangles, the long ones among them.
    whole: Arc<Whole>,
    /// Triangles with a longer edge do not count.
    max_edge: f64,
}

/// What surfaces with different maximal edges share.
#[derive(Debug)]
struct Whole {
    frame: LocalFrame,
    /// The largest absolute world coordinate: what the input was rounded at.
    magnitude: f64,
    shape: Shape,
    /// Heights of vertices or points from all over it, in the world: see [`Surface::usual_heights`].
    heights: Vec<f64>,
    /// Of the vertices, once somebody asked.
    blocks: OnceLock<Vec<VertexBlock>>,
    /// Of a cloud: its triangles, once somebody asked.
    tiles: OnceLock<Tiles>,
    /// Of a mesh: the boxes around runs of its faces, once somebody asked.
    runs: OnceLock<Vec<Run>>,
    /// The same as a mesh, once somebody asked.
    mesh: OnceLock<Arc<Whole>>,
    /// Held while it is made: threads that ask at the same time wait for the one that makes it.
    making: Mutex<()>,
}

impl Whole {
    fn new(frame: LocalFrame, magnitude: f64, shape: Shape, sample: &[DVec3]) -> Self {
        Self {
            frame,
            magnitude,
            shape,
            heights: sample.iter().map(|point| point.z).collect(),
            blocks: OnceLock::new(),
            tiles: OnceLock::new(),
            runs: OnceLock::new(),
            mesh: OnceLock::new(),
            making: Mutex::default(),
        }
    }
}

/// The largest absolute coordinate.
///
/// # Errors
/// Where it is beyond the reach of exact predicates.
fn magnitude_of(bounds: &Bounds) -> Result<f64, SurfaceError> {
    let magnitude = bounds.min.abs().max(bounds.max.abs()).max_element();
    match magnitude > 1e60 {
        true => Err(SurfaceError::TooFarOut),
        false => Ok(magnitude),
    }
}

#[derive(Debug)]
enum Shape {
    Cloud(Sites),
    Mesh(Mesh),
}

/// What a caster of either kind returns, in the local frame.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Met {
    /// Along the ray, > 0.
    t: f64,
    /// See [`Hit::longest_edge`].
    longest_edge: f64,
    /// See [`Hit::is_from_behind`].
    is_from_behind: bool,
}

/// The longest edge of a triangle.
pub(crate) fn longest_edge([a, b, c]: [DVec3; 3]) -> f64 {
    a.distance(b).max(b.distance(c)).max(c.distance(a))
}

impl Surface {
    /// The surface of a cloud: its faces where it has any, else its triangulation over (x, y), in
    /// which of points with equal (x, y) the highest stands.
    ///
    /// # Errors
    /// Where the points make no surface.
    pub fn new(cloud: Cloud) -> Result<Self, SurfaceError> {
        Self::with_options(cloud, &SurfaceOptions::default())
    }

    /// The surface of a cloud, less what the options leave out.
    ///
    /// # Errors
    /// Where the points, or those that are left, make no surface, and where an option is no length.
    pub fn with_options(cloud: Cloud, options: &SurfaceOptions) -> Result<Self, SurfaceError> {
        Self::with_facts(cloud, options, None)
    }

    /// The same of a cloud of which its file says where it lies: the surface is then that which a part of it would
    /// belong to, to the last bit. What is said is not used where a point lies outside, of a mesh, and where points
    /// are left out.
    ///
    /// # Errors
    /// As [`Self::with_options`].
    pub fn with_facts(
        cloud: Cloud,
        options: &SurfaceOptions,
        facts: Option<&CloudFacts>,
    ) -> Result<Self, SurfaceError> {
        options.validate()?;
        let Cloud {
            mut points,
            mut colors,
            triangles,
        } = cloud;
        if let Some(index) = points.iter().position(|p| !p.is_finite()) {
            return Err(SurfaceError::NotFinite(index));
        }
        let bounds = Bounds::of(&points).ok_or(SurfaceError::TooFewPoints(0))?;
        let facts = facts.filter(|facts| {
            triangles.is_empty()
                && options.thinning.is_none()
                && facts.count == points.len() as u64
                && facts.bounds.contains(bounds.min)
                && facts.bounds.contains(bounds.max)
        });
        let bounds = facts.map_or(bounds, |facts| facts.bounds);
        let magnitude = magnitude_of(&bounds)?;
        for (face, triangle) in triangles.iter().enumerate() {
            if let Some(&point) = triangle.iter().find(|&&i| i as usize >= points.len()) {
                let count = points.len();
                return Err(SurfaceError::NoSuchPoint { face, point, count });
            }
        }
        if colors.len() != points.len() {
            // Not one for each point: nobody knows which.
            colors.clear();
        }
        if let Some(size) = options.thinning
            && triangles.is_empty()
        {
            thinning::thin(&mut points, &mut colors, size)?;
        }
        let frame = LocalFrame::near(&bounds);
        let sample = match facts {
            Some(facts) => facts.sample.clone(),
            None => {
                let stride = sample_stride(points.len());
                points.iter().step_by(stride).copied().collect()
            }
        };
        for point in &mut points {
            *point = frame.local_from_world(*point);
        }
        let shape = match (triangles.is_empty(), facts) {
            (true, None) => Shape::Cloud(Sites::new(points, &colors)?),
            (true, Some(facts)) => {
                let (bounds, grid) = part::local_grid(facts, &frame);
                Shape::Cloud(Sites::over(points, &colors, bounds, grid)?)
            }
            (false, _) => Shape::Mesh(Mesh::new(points, colors, triangles)?),
        };
        let whole = Whole::new(frame, magnitude, shape, &sample);
        Ok(Self {
            whole: Arc::new(whole),
            max_edge: options.max_edge.unwrap_or(f64::INFINITY),
        })
    }

    /// Whether only a part of its cloud is in memory: see [`Self::wanted`].
    pub fn is_part(&self) -> bool {
        matches!(&self.whole.shape, Shape::Cloud(sites) if sites.is_part())
    }

    /// What was asked of a part of a cloud and is not in memory. Only if it is nothing is what was computed with
    /// this surface (and its clones) that of the whole; else compute it anew with a larger part.
    pub fn wanted(&self) -> Wanted {
        match &self.whole.shape {
            Shape::Cloud(sites) => sites.wanted(),
            Shape::Mesh(_) => Wanted::default(),
        }
    }

    /// The same surface with another [`SurfaceOptions::max_edge`]; shares the points with this one.
    ///
    /// # Errors
    /// Where it is no length.
    pub fn with_max_edge(&self, max_edge: Option<f64>) -> Result<Self, SurfaceError> {
        let options = SurfaceOptions {
            max_edge,
            thinning: None,
        };
        options.validate()?;
        Ok(Self {
            whole: Arc::clone(&self.whole),
            max_edge: max_edge.unwrap_or(f64::INFINITY),
        })
    }

    /// See [`SurfaceOptions::max_edge`].
    pub fn max_edge(&self) -> Option<f64> {
        self.max_edge.is_finite().then_some(self.max_edge)
    }

    /// Whether its triangles were put between points here, and not read.
    pub fn is_cloud(&self) -> bool {
        matches!(self.whole.shape, Shape::Cloud(_))
    }

    /// The same surface as a mesh with all its triangles: for display, and for many rays. Triangulates
    /// a cloud at the first call; the maximal edge of the mesh can still be changed.
    ///
    /// # Errors
    /// Where the triangulation fails.
    pub fn to_mesh(&self) -> Result<Self, SurfaceError> {
        self.mesh()?;
        let whole = self.whole.mesh.get().unwrap_or(&self.whole);
        Ok(Self {
            whole: Arc::clone(whole),
            max_edge: self.max_edge,
        })
    }

    fn mesh(&self) -> Result<&Mesh, SurfaceError> {
        let sites = match &self.whole.shape {
            Shape::Mesh(mesh) => return Ok(mesh),
            Shape::Cloud(sites) if sites.is_part() => {
                sites.want_all("a mesh of it");
                return Err(SurfaceError::OnlyAPart);
            }
            Shape::Cloud(sites) => sites,
        };
        if self.whole.mesh.get().is_none() {
            // On all cores, so not while the lock is held: who waits for others may be given work that
            // asks for the mesh, too.
            let triangles = match sites.points().len() <= walk::FEW_SITES {
                // As the walk has them: of a coarse lattice there are many triangulations.
                true => delaunay::triangulate(sites.points())?,
                false => {
                    let tiles = self.whole.tiles.get_or_init(|| Tiles::new(sites));
                    let made = tiles.seen(sites, |_| false)?.into_iter();
                    made.flat_map(|made| &made.triangles).copied().collect()
                }
            };
            // A thread that panicked while it held the lock has set nothing.
            let making = self.whole.making.lock();
            let _making = making.unwrap_or_else(PoisonError::into_inner);
            if self.whole.mesh.get().is_none() {
                let (points, colors) = (sites.points().to_vec(), sites.colors().to_vec());
                let shape = Shape::Mesh(Mesh::new(points, colors, triangles)?);
                let mut whole = Whole::new(self.whole.frame, self.whole.magnitude, shape, &[]);
                whole.heights.clone_from(&self.whole.heights);
                // It is empty: whoever sets it holds the lock.
                let _ = self.whole.mesh.set(Arc::new(whole));
            }
        }
        match self.whole.mesh.get().map(|whole| &whole.shape) {
            Some(Shape::Mesh(mesh)) => Ok(mesh),
            // It was set a moment ago, to a mesh.
            _ => Err(SurfaceError::NoTriangles),
        }
    }

    /// The triangles, counter-clockwise seen from above where the surface is a triangulated cloud;
    /// indices into the order of [`Self::vertices`]. Triangulates a cloud at the first call.
    ///
    /// # Errors
    /// Where the triangulation fails.
    pub fn triangles(&self) -> Result<Vec<[u32; 3]>, SurfaceError> {
        let points = self.points();
        let mut triangles = self.mesh()?.triangles().to_vec();
        if self.max_edge.is_finite() {
            triangles.retain(|t| longest_edge(t.map(|i| points[i as usize])) <= self.max_edge);
        }
        Ok(triangles)
    }

    /// In the local frame.
    fn points(&self) -> &[DVec3] {
        match &self.whole.shape {
            Shape::Cloud(sites) => sites.points(),
            Shape::Mesh(mesh) => mesh.points(),
        }
    }
}

#[cfg(test)]
mod tests;
