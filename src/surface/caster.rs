//! Rays at a surface: what casts them, by which way, and where they meet it.

use glam::DVec3;

use super::mesh::Mesh;
use super::walk::Walk;
use super::{Shape, Surface, SurfaceError};
use crate::geometry::Ray;

/// How many points of a cloud can be triangulated and sorted into a hierarchy in the time that a ray
/// takes that walks on what is not built (measured: 100 µs against 3 µs a point).
const SITES_PER_RAY: usize = 30;

/// Where a ray meets a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Along the ray, > 0.
    pub t: f64,
    /// In the world.
    pub point: DVec3,
    /// The longest edge of the triangle that was met, world units: far longer than the distance of
    /// the points means that the cloud has a hole there. On an edge or a vertex, that of one of the
    /// triangles there.
    pub longest_edge: f64,
    /// Whether the triangle of a mesh was met from the side from which its corners go round clockwise: it looks away. Never of
    /// a cloud.
    pub is_from_behind: bool,
}

impl Surface {
    /// Makes ready for rays: dozens to thousands on a cloud, any number on a mesh.
    ///
    /// # Errors
    /// Where the triangulation cannot be begun.
    pub fn caster(&self) -> Result<Caster<'_>, SurfaceError> {
        let way = match &self.whole.shape {
            Shape::Cloud(sites) => Way::Walk(Walk::new(sites, self.max_edge)?),
            Shape::Mesh(mesh) => Way::Mesh(mesh),
        };
        Ok(Caster { surface: self, way })
    }

    /// Whether so many rays are worth a mesh of the whole surface.
    fn pays_whole(&self, rays: usize) -> bool {
        match &self.whole.shape {
            // It may be there already, for the viewport or for others' rays.
            Shape::Cloud(sites) => {
                let is_few = || sites.points().len() <= rays.saturating_mul(SITES_PER_RAY);
                !sites.is_part() && (self.whole.mesh.get().is_some() || is_few())
            }
            Shape::Mesh(_) => true,
        }
    }

    /// Makes ready for about this many rays. Where they are so many that it pays, a cloud is
    /// triangulated whole, which the next caster for many finds done.
    ///
    /// # Errors
    /// Where the triangulation fails.
    pub fn caster_for(&self, rays: usize) -> Result<Caster<'_>, SurfaceError> {
        if !self.pays_whole(rays) {
            return self.caster();
        }
        let mesh = self.mesh()?;
        mesh.expect_rays(rays);
        let way = Way::Mesh(mesh);
        Ok(Caster { surface: self, way })
    }
}

/// Casts rays at a surface. One for each thread.
#[derive(Debug)]
pub struct Caster<'a> {
    surface: &'a Surface,
    pub(super) way: Way<'a>,
}

#[derive(Debug)]
pub(super) enum Way<'a> {
    Walk(Walk<'a>),
    Mesh(&'a Mesh),
}

impl<'a> Caster<'a> {
    /// The surface that it casts at.
    pub fn surface(&self) -> &'a Surface {
        self.surface
    }

    /// The nearest intersection in front of the ray's origin. Edges, vertices and the rim belong to
    /// the surface.
    pub fn cast(&mut self, ray: &Ray) -> Option<Hit> {
        let local = self.surface.frame().local_from_world_ray(ray);
        let slack = self.surface.slack(ray.origin);
        let met = match &mut self.way {
            Way::Walk(walk) => walk.cast(&local, slack),
            Way::Mesh(mesh) => mesh.cast(&local, slack, self.surface.max_edge),
        }?;
        Some(Hit {
            t: met.t,
            point: ray.at(met.t),
            longest_edge: met.longest_edge,
            is_from_behind: met.is_from_behind,
        })
    }
}
