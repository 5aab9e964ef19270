//! Rays in the simulated lab: fragments as half-space intersections, the ground as a mesh, scale
//! spheres as spheres. All exact to rounding, so that what a photo shows has a known place.

pub(crate) mod fragment;
pub(crate) mod light;
pub(crate) mod pile;
pub(crate) mod terrain;

use glam::{DQuat, DVec2, DVec3};
use parry3d_f64::bounding_volume::Aabb;
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhNode};

use self::pile::{Fragment, Pile, PilePlan};
use self::terrain::Terrain;
use crate::fault::Fault;
use crate::geometry::Ray;
use crate::surface::{Caster, Cloud, Surface};

/// What a ray meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Thing {
    /// The ground: floor and fines.
    Ground,
    /// A fragment, by its place in the pile.
    Fragment(usize),
    /// A scale sphere, by its place in the scene.
    Sphere(usize),
}

/// Where a ray meets something.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meeting {
    /// Along the ray, > 0.
    pub t: f64,
    /// In the lab's frame, metres.
    pub point: DVec3,
    /// Unit, towards the outside of what is met.
    pub normal: DVec3,
    /// What it is.
    pub thing: Thing,
}

/// A scale sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Its middle, metres.
    pub center: DVec3,
    /// Metres.
    pub radius: f64,
}

/// Heights of what lies, averaged over about two fragments: what a point has around it.
#[derive(Debug)]
struct Surroundings {
    min: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
    z: Vec<f64>,
}

/// Everything that a ray can meet, in the lab's own frame (origin in the middle of the floor).
#[derive(Debug)]
pub struct Scene {
    pile: Pile,
    ground: Surface,
    ground_cloud: Cloud,
    spheres: Vec<Sphere>,
    hierarchy: Bvh,
    terrain: Terrain,
    /// The size that half of the mass passes, metres.
    grain: f64,
    surroundings: Surroundings,
}

/// Casts rays into a scene. One for each thread.
pub struct SceneCaster<'a> {
    scene: &'a Scene,
    ground: Caster<'a>,
}

impl Scene {
    /// Builds a scene; the ground reaches `reach` (metres) to either side of the middle.
    ///
    /// # Errors
    /// Where the ground makes no surface.
    pub fn new(pile: Pile, plan: &PilePlan, reach: DVec2) -> Result<Self, Fault> {
        let broken = |e| Fault::new(format!("the ground is no surface: {e}"), "report this");
        let ground_cloud = ground_mesh(plan, reach);
        let ground = Surface::new(ground_cloud.clone()).map_err(broken)?;
        let boxes = pile.fragments.iter().enumerate().map(|(index, fragment)| {
            let (low, high) = corners(&pile, fragment)
                .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
                    (low.min(p), high.max(p))
                });
            // Room for the rounding of the box test.
            let room = DVec3::splat(fragment.size * 1e-9);
            (index, Aabb::new(low - room, high + room))
        });
        let hierarchy = Bvh::from_iter(BvhBuildStrategy::Binned, boxes);
        let grain = plan.sizes.size_at(0.5);
        let surroundings = Surroundings::of(&pile, plan, reach, grain);
        Ok(Self {
            terrain: plan.terrain,
            grain,
            surroundings,
            pile,
            ground,
            ground_cloud,
            spheres: Vec::new(),
            hierarchy,
        })
    }

    /// Adds scale spheres.
    pub fn add_spheres(&mut self, spheres: impl IntoIterator<Item = Sphere>) {
        self.spheres.extend(spheres);
    }

    /// The fragments.
    pub fn pile(&self) -> &Pile {
        &self.pile
    }

    /// The scale spheres.
    pub fn spheres(&self) -> &[Sphere] {
        &self.spheres
    }

    /// The ground's height at a place.
    pub fn ground_height(&self, at: DVec2) -> f64 {
        self.terrain.height(at)
    }

    /// How a fragment is turned.
    pub fn fragment_rotation(&self, index: usize) -> DQuat {
        let fragment = self.pile.fragments.get(index);
        fragment.map_or(DQuat::IDENTITY, |fragment| fragment.rotation)
    }

    /// A met point in its fragment's own frame (metres, turned back), the distance to the nearest
    /// other side with its normal there, and the fragment's size.
    pub fn fragment_spot(&self, index: usize, met: &Meeting) -> (DVec3, Option<(f64, DVec3)>, f64) {
        let Some(fragment) = self.pile.fragments.get(index) else {
            return (met.point, None, self.grain);
        };
        let back = fragment.rotation.inverse();
        let point = back * (met.point - fragment.center);
        let own = back * met.normal;
        let other_sides = self.pile.bodies[fragment.body]
            .planes()
            .iter()
            .filter(|plane| plane.normal.dot(own) < 0.999)
            .map(|plane| {
                (
                    plane.offset * fragment.size - plane.normal.dot(point),
                    plane.normal,
                )
            });
        let edge = other_sides.min_by(|a, b| a.0.total_cmp(&b.0));
        let edge = edge.map(|(distance, normal)| (distance.max(0.0), normal));
        (point, edge, fragment.size)
    }

    /// How much of the sky a point sees, 0 to 1: less the deeper it lies between its neighbours. An
    /// estimate from the mean height around it; casting rays for it would cost ten times the photo.
    pub fn openness(&self, point: DVec3, normal: DVec3) -> f64 {
        let depth = (self.surroundings.height(point.truncate()) - point.z) / self.grain;
        let facing = 0.5 + 0.5 * normal.z;
        (0.85 - 0.75 * depth).clamp(0.08, 1.0) * (0.35 + 0.65 * facing)
    }

    /// Makes ready for rays.
    ///
    /// # Errors
    /// Where the ground cannot be met.
    pub fn caster(&self) -> Result<SceneCaster<'_>, Fault> {
        let ground = self
            .ground
            .caster()
            .map_err(|e| Fault::new(format!("the ground cannot be met: {e}"), "report this"))?;
        Ok(SceneCaster {
            scene: self,
            ground,
        })
    }

    /// Ground and fragments as one mesh: the true surface, without the spheres.
    pub fn mesh(&self) -> Cloud {
        let mut mesh = self.ground_cloud.clone();
        for fragment in &self.pile.fragments {
            let first = mesh.points.len() as u32;
            mesh.points.extend(corners(&self.pile, fragment));
            let triangles = self.pile.bodies[fragment.body].triangles();
            mesh.triangles
                .extend(triangles.iter().map(|t| t.map(|corner| corner + first)));
        }
        mesh
    }

    fn ground_normal(&self, at: DVec2) -> DVec3 {
        let step = self.grain * 0.1;
        let slope = |way: DVec2| {
            let rise = self.terrain.height(at + way) - self.terrain.height(at - way);
            rise / (2.0 * step)
        };
        DVec3::new(-slope(DVec2::X * step), -slope(DVec2::Y * step), 1.0).normalize()
    }

    /// Where a ray meets a fragment, and the normal there.
    fn meet_fragment(&self, ray: &Ray, fragment: &Fragment) -> Option<(f64, DVec3)> {
        let back = fragment.rotation.inverse();
        let origin = back * (ray.origin - fragment.center) / fragment.size;
        let direction = back * ray.direction / fragment.size;
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        let mut normal = None;
        for side in self.pile.bodies[fragment.body].planes() {
            let (plane, offset) = (side.normal, side.offset);
            let towards = plane.dot(direction);
            let distance = offset - plane.dot(origin);
            if towards < 0.0 {
                let t = distance / towards;
                if t > enter {
                    (enter, normal) = (t, Some(plane));
                }
            } else if towards > 0.0 {
                leave = leave.min(distance / towards);
            } else if distance < 0.0 {
                return None;
            }
        }
        let normal = normal.filter(|_| enter <= leave)?;
        Some((enter, fragment.rotation * normal))
    }
}

impl<'a> SceneCaster<'a> {
    /// The scene that it casts into.
    pub fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// Whether anything stands in the way of a ray. Cheaper than the nearest thing: the first one
    /// found will do.
    pub fn is_blocked(&mut self, ray: &Ray) -> bool {
        let scene = self.scene;
        let parry_ray = parry3d_f64::query::Ray::new(ray.origin, ray.direction);
        let on_the_way = |node: &BvhNode| node.cast_ray(&parry_ray, f64::MAX) < f64::MAX;
        let mut near = scene.hierarchy.leaves(on_the_way);
        if near.any(|index| {
            let fragment = scene.pile.fragments.get(index as usize);
            fragment.is_some_and(|fragment| scene.meet_fragment(ray, fragment).is_some())
        }) {
            return true;
        }
        if scene
            .spheres
            .iter()
            .any(|sphere| meet_sphere(ray, sphere).is_some())
        {
            return true;
        }
        // A ray that rises more steeply than the heap leaves it for good.
        let level = ray.direction.truncate().length();
        ray.direction.z < scene.terrain.steepest() * level && self.ground.cast(ray).is_some()
    }

    /// The nearest thing that a ray (unit direction) meets.
    pub fn cast(&mut self, ray: &Ray) -> Option<Meeting> {
        let spheres = &self.scene.spheres;
        self.cast_among(ray, spheres)
    }

    /// The nearest ground or fragment that a ray meets: scale spheres are put on the pile, they are
    /// not of it.
    pub fn cast_at_surface(&mut self, ray: &Ray) -> Option<Meeting> {
        self.cast_among(ray, &[])
    }

    fn cast_among(&mut self, ray: &Ray, spheres: &[Sphere]) -> Option<Meeting> {
        let scene = self.scene;
        let mut nearest: Option<Meeting> = None;
        let mut keep = |t: f64, normal: DVec3, thing: Thing| {
            if nearest.is_none_or(|n| t < n.t) {
                nearest = Some(Meeting {
                    t,
                    point: ray.at(t),
                    normal,
                    thing,
                });
            }
        };
        let parry_ray = parry3d_f64::query::Ray::new(ray.origin, ray.direction);
        let met = scene.hierarchy.cast_ray(&parry_ray, f64::MAX, |index, _| {
            let fragment = scene.pile.fragments.get(index as usize)?;
            scene.meet_fragment(ray, fragment).map(|(t, _)| t)
        });
        if let Some((index, _)) = met
            && let Some(fragment) = scene.pile.fragments.get(index as usize)
            && let Some((t, normal)) = scene.meet_fragment(ray, fragment)
        {
            keep(t, normal, Thing::Fragment(index as usize));
        }
        for (index, sphere) in spheres.iter().enumerate() {
            if let Some(t) = meet_sphere(ray, sphere) {
                let normal = (ray.at(t) - sphere.center) / sphere.radius;
                keep(t, normal, Thing::Sphere(index));
            }
        }
        if let Some(hit) = self.ground.cast(ray) {
            keep(
                hit.t,
                scene.ground_normal(hit.point.truncate()),
                Thing::Ground,
            );
        }
        nearest
    }
}

impl Surroundings {
    fn of(pile: &Pile, plan: &PilePlan, reach: DVec2, grain: f64) -> Self {
        let cell = grain * 0.5;
        let (columns, rows) = (
            (2.0 * reach.x / cell).ceil().max(1.0) as usize,
            (2.0 * reach.y / cell).ceil().max(1.0) as usize,
        );
        let min = -reach;
        let mut z: Vec<f64> = (0..rows * columns)
            .map(|index| {
                let at = DVec2::new(
                    (index % columns) as f64 + 0.5,
                    (index / columns) as f64 + 0.5,
                );
                plan.terrain.height(min + at * cell)
            })
            .collect();
        // Fragments as flat discs at the height of their middles' tops.
        for fragment in &pile.fragments {
            let half = fragment.size * 0.5;
            let (low, high) = (
                (fragment.center.truncate() - min - DVec2::splat(half)) / cell,
                (fragment.center.truncate() - min + DVec2::splat(half)) / cell,
            );
            for row in low.y.max(0.0) as usize..=(high.y.max(0.0) as usize).min(rows - 1) {
                for column in low.x.max(0.0) as usize..=(high.x.max(0.0) as usize).min(columns - 1)
                {
                    let top = &mut z[row * columns + column];
                    *top = top.max(fragment.center.z + half * 0.6);
                }
            }
        }
        let mut smooth = Self {
            min,
            cell,
            columns,
            rows,
            z,
        };
        // Three passes of a box are close to a bell.
        for _ in 0..3 {
            smooth.blur();
        }
        smooth
    }

    fn blur(&mut self) {
        let old = self.z.clone();
        for row in 0..self.rows {
            for column in 0..self.columns {
                let (mut sum, mut count) = (0.0, 0.0);
                for r in row.saturating_sub(1)..=(row + 1).min(self.rows - 1) {
                    for c in column.saturating_sub(1)..=(column + 1).min(self.columns - 1) {
                        sum += old[r * self.columns + c];
                        count += 1.0;
                    }
                }
                self.z[row * self.columns + column] = sum / count;
            }
        }
    }

    /// Bilinear between the cells' middles.
    fn height(&self, at: DVec2) -> f64 {
        let place = ((at - self.min) / self.cell - 0.5).clamp(
            DVec2::ZERO,
            DVec2::new((self.columns - 1) as f64, (self.rows - 1) as f64),
        );
        let (column, row) = (place.x as usize, place.y as usize);
        let (right, down) = (
            (column + 1).min(self.columns - 1),
            (row + 1).min(self.rows - 1),
        );
        let z = |row: usize, column: usize| self.z[row * self.columns + column];
        let share = place.fract();
        let top = z(row, column) * (1.0 - share.x) + z(row, right) * share.x;
        let bottom = z(down, column) * (1.0 - share.x) + z(down, right) * share.x;
        top * (1.0 - share.y) + bottom * share.y
    }
}

/// The corners of a fragment in the lab.
fn corners<'a>(pile: &'a Pile, fragment: &'a Fragment) -> impl Iterator<Item = DVec3> + 'a {
    let vertices = pile.bodies[fragment.body].vertices().iter();
    vertices.map(|&v| fragment.center + fragment.rotation * (v * fragment.size))
}

fn meet_sphere(ray: &Ray, sphere: &Sphere) -> Option<f64> {
    let to = sphere.center - ray.origin;
    let along = to.dot(ray.direction);
    let beside = to.length_squared() - along * along;
    let half_chord = sphere.radius * sphere.radius - beside;
    if half_chord < 0.0 {
        return None;
    }
    [along - half_chord.sqrt(), along + half_chord.sqrt()]
        .into_iter()
        .find(|&t| t > 0.0)
}

/// The ground as a grid of triangles, fine enough for the heap's roundings.
fn ground_mesh(plan: &PilePlan, reach: DVec2) -> Cloud {
    let steps = 240;
    let mut mesh = Cloud::default();
    for row in 0..=steps {
        for column in 0..=steps {
            let share = DVec2::new(f64::from(column), f64::from(row)) / f64::from(steps);
            let at = (share * 2.0 - 1.0) * reach;
            mesh.points.push(at.extend(plan.terrain.height(at)));
        }
    }
    let stride = u32::from(steps as u16) + 1;
    for row in 0..stride - 1 {
        for column in 0..stride - 1 {
            let a = row * stride + column;
            mesh.add_polygon(&[a, a + 1, a + stride + 1, a + stride]);
        }
    }
    mesh
}
