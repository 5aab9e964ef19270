//! The pile: fragments dropped one by one onto the ground and onto each other.
//!
//! Each fragment is laid on one of its flatter sides, turned about the vertical, and let down at the
//! lowest of a few places near where it was thrown, until it touches what lies there. What lies
//! there is kept as a height over a fine grid, so a fragment never sinks in by more than the grid's
//! rounding and never floats: it rests on at least one point. Rolling and settling are left out; the
//! choice of the lowest place stands for them.

use glam::{DQuat, DVec2, DVec3};
use rayon::prelude::*;

use super::fragment::Body;
use super::terrain::Terrain;
use crate::fault::Fault;
use crate::fragmentation::Swebrec;
use crate::jobs::Progress;
use crate::random::Random;

/// How many places a fragment tries.
const PLACES: usize = 5;

/// The most fragments: a label image has 16 bits, and 0 is the ground.
pub(crate) const MOST_FRAGMENTS: usize = 65_534;

/// What a pile is made of. Lengths in metres.
#[derive(Debug, Clone, PartialEq)]
pub struct PilePlan {
    /// The heap under the fragments.
    pub terrain: Terrain,
    /// The material, by sieve size and mass.
    pub sizes: Swebrec,
    /// Fragments below this sieve size are fines: they are ground, not bodies.
    pub smallest: f64,
    /// Half the extent over which fragments are strewn, in x and y.
    pub half_extent: DVec2,
    /// The volume of the fragments' bodies over the area that they are strewn over.
    pub thickness: f64,
    /// How many corners a fragment has, from and to: few are broken rock, many pebbles.
    pub corners: (u32, u32),
    /// How many different bodies there are; fragments are turned and scaled copies.
    pub bodies: u64,
}

/// A fragment of the pile: a copy of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fragment {
    /// Index into [`Pile::bodies`].
    pub body: usize,
    /// Its sieve size: the factor by which the body is scaled.
    pub size: f64,
    /// How the body is turned.
    pub rotation: DQuat,
    /// Where its centroid lies.
    pub center: DVec3,
}

/// Fragments on the ground.
#[derive(Debug)]
pub struct Pile {
    /// The bodies, each of sieve size 1.
    pub bodies: Vec<Body>,
    /// The fragments; the number of one is its place here plus 1.
    pub fragments: Vec<Fragment>,
}

impl Pile {
    /// Strews a pile.
    ///
    /// # Errors
    /// Where the plan asks for more than 65 534 fragments, or the work was cancelled.
    pub fn strew(plan: &PilePlan, random: &mut Random, progress: &Progress) -> Result<Self, Fault> {
        progress.stage("breaking rock");
        let shapes = random.fork(1);
        let bodies: Vec<Body> = (0..plan.bodies)
            .into_par_iter()
            .map(|index| Body::random(plan.corners, &mut shapes.fork(index)))
            .collect();
        let mut fragments = draw_sizes(plan, &bodies, &mut random.fork(2))?;
        let mut floor = Heights::over(plan);
        let mut drops = random.fork(3);
        progress.stage("heaping fragments");
        let count = fragments.len();
        for (index, fragment) in fragments.iter_mut().enumerate() {
            if index % 256 == 0 {
                progress.advance(index as u64, count as u64)?;
            }
            // The body was chosen from the list with its index.
            let body = &bodies[fragment.body];
            floor.drop(body, fragment, plan.half_extent, &mut drops);
        }
        Ok(Self { bodies, fragments })
    }

    /// Lets every fragment down by what is drawn for its place: it lies in fines.
    pub(crate) fn sink(&mut self, depth: impl Fn(DVec2) -> f64) {
        for fragment in &mut self.fragments {
            fragment.center.z -= depth(fragment.center.truncate());
        }
    }

    /// A fragment's volume in cubic metres.
    pub fn volume(&self, fragment: &Fragment) -> f64 {
        self.bodies[fragment.body].volume() * fragment.size.powi(3)
    }
}

/// Bodies and sizes until the pile's volume is reached, in random order.
///
/// The distribution is by mass. Drawn by mass, one fragment of size x stands for 1/x3 as many as one
/// of size 1; so sizes are drawn by mass and kept with the probability (smallest/x)3, which is the
/// distribution by number.
pub(crate) fn draw_sizes(
    plan: &PilePlan,
    bodies: &[Body],
    random: &mut Random,
) -> Result<Vec<Fragment>, Fault> {
    let area = 4.0 * plan.half_extent.x * plan.half_extent.y;
    let wanted = plan.thickness * area;
    let fines = plan.sizes.passing(plan.smallest);
    let mut fragments = Vec::new();
    let mut volume = 0.0;
    while volume < wanted {
        let size = plan.sizes.size_at(random.range(fines, 1.0));
        if random.uniform() >= (plan.smallest / size).powi(3) {
            continue;
        }
        let body = ((random.uniform() * bodies.len() as f64) as usize).min(bodies.len() - 1);
        volume += bodies[body].volume() * size.powi(3);
        fragments.push(Fragment {
            body,
            size,
            rotation: DQuat::IDENTITY,
            center: DVec3::ZERO,
        });
        if fragments.len() > MOST_FRAGMENTS {
            return Err(Fault::new(
                format!("the pile needs more than {MOST_FRAGMENTS} fragments"),
                "make it thinner or its smallest fragments larger",
            ));
        }
    }
    Ok(fragments)
}

/// The height of what lies, over a grid.
struct Heights {
    min: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
    z: Vec<f64>,
}

/// A fragment over the cells that it covers: height of its underside and its top above its centre.
struct Shadow {
    cells: Vec<(usize, f64, f64)>,
}

impl Heights {
    fn over(plan: &PilePlan) -> Self {
        // A third of the smallest fragment, and room for the largest beyond the rim.
        let cell = plan.smallest / 3.0;
        let reach = plan.half_extent + DVec2::splat(2.0 * plan.sizes.size_at(1.0));
        let count = |length: f64| (length / cell).ceil().max(1.0) as usize;
        let (columns, rows) = (count(2.0 * reach.x), count(2.0 * reach.y));
        let min = -reach;
        let z = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| {
                let at = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) * cell;
                plan.terrain.height(min + at)
            })
            .collect();
        Self {
            min,
            cell,
            columns,
            rows,
            z,
        }
    }

    /// Lays a fragment down: chooses its rotation and its place.
    fn drop(&mut self, body: &Body, fragment: &mut Fragment, half: DVec2, random: &mut Random) {
        fragment.rotation = resting_rotation(body, random);
        let thrown = DVec2::new(random.range(-half.x, half.x), random.range(-half.y, half.y));
        let mut best: Option<(DVec3, Shadow)> = None;
        for _ in 0..PLACES {
            let nearby = DVec2::new(random.normal(), random.normal()) * fragment.size * 1.5;
            let at = (thrown + nearby).clamp(-half, half);
            let shadow = self.shadow(body, fragment, at);
            let z = shadow
                .cells
                .iter()
                .map(|&(cell, under, _)| self.z[cell] - under)
                .fold(f64::NEG_INFINITY, f64::max);
            if z.is_finite() && best.as_ref().is_none_or(|(center, _)| z < center.z) {
                best = Some((at.extend(z), shadow));
            }
        }
        if let Some((center, shadow)) = best {
            fragment.center = center;
            for (cell, _, top) in shadow.cells {
                self.z[cell] = self.z[cell].max(center.z + top);
            }
        }
    }

    /// The cells under a fragment whose centre is above `at`.
    fn shadow(&self, body: &Body, fragment: &Fragment, at: DVec2) -> Shadow {
        let planes: Vec<(DVec3, f64)> = body
            .planes()
            .iter()
            .map(|plane| {
                (
                    fragment.rotation * plane.normal,
                    plane.offset * fragment.size,
                )
            })
            .collect();
        let reach = body.bounding_radius() * fragment.size;
        let index = |x: f64, most: usize| ((x / self.cell).max(0.0) as usize).min(most - 1);
        let low = at - self.min - DVec2::splat(reach);
        let high = at - self.min + DVec2::splat(reach);
        let mut cells = Vec::new();
        for row in index(low.y, self.rows)..=index(high.y, self.rows) {
            for column in index(low.x, self.columns)..=index(high.x, self.columns) {
                let middle = DVec2::new(column as f64 + 0.5, row as f64 + 0.5) * self.cell;
                let offset = self.min + middle - at;
                if let Some((under, top)) = vertical_range(&planes, offset) {
                    cells.push((row * self.columns + column, under, top));
                }
            }
        }
        Shadow { cells }
    }
}

/// Where a vertical line enters and leaves a convex body, above the body's centre.
fn vertical_range(planes: &[(DVec3, f64)], at: DVec2) -> Option<(f64, f64)> {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for &(normal, offset) in planes {
        let rest = offset - normal.truncate().dot(at);
        if normal.z > 1e-12 {
            high = high.min(rest / normal.z);
        } else if normal.z < -1e-12 {
            low = low.max(rest / normal.z);
        } else if rest < 0.0 {
            return None;
        }
    }
    (low < high).then_some((low, high))
}

/// A rotation that lays the body on one of the sides that it could rest on: near its centre sides
/// are low, and low sides are large and stable.
fn resting_rotation(body: &Body, random: &mut Random) -> DQuat {
    let lowest = body
        .planes()
        .iter()
        .map(|plane| (plane.normal, plane.offset * random.range(1.0, 1.35)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(DVec3::NEG_Z, |(normal, _)| normal);
    let down = DQuat::from_rotation_arc(lowest, DVec3::NEG_Z);
    let turn = DQuat::from_rotation_z(random.range(0.0, std::f64::consts::TAU));
    // Nothing in a heap lies quite level.
    let tilt = DQuat::from_scaled_axis(DVec3::new(random.normal(), random.normal(), 0.0) * 0.12);
    (tilt * turn * down).normalize()
}
