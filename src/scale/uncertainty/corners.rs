//! How sure the four-corner scales are: the corner rays cast again under drawn errors.
//!
//! A corner hangs on one place of a rough surface. Moved by a wrong pose or focal length its ray may meet
//! another stone, and no derivative says so: so it is cast again, at the triangles around. What the
//! surface adds at the place that it meets is drawn from how far the points around the corner lie from
//! what their neighbours predict, each as likely as the photo shows of it: at a rim some of them are far. Some places lie in gaps
//! besides, in which no point is (`unseen`), and one on a triangle that bridges what no photo saw lies deeper (`bridges`).

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::LEAST_POINTS;
use super::bridges::Bridges;
use super::draws::{Draws, deviation, interval_of};
use super::stratified::stratified;
use super::surface_error::{DepthError, root_mean_square, tan_of_incidence};
use super::unseen::Unseen;
use super::{Interval, UncertainPhoto};
use crate::geometry::Ray;
use crate::scale::field::clipped;
use crate::scale::pyramid::{Pyramid, inward};
use crate::scale::{CornerOutcome, StatedErrors};
use crate::surface::{Cloud, Surface};

/// How many times errors are drawn: the ends of a 95 % interval are then known to a tenth of its half, or better where
/// what is stated outweighs the roughness ([`stratified`]).
const DRAWS: usize = 400;

/// From where the draws follow.
const SEED: u64 = 14;

/// How many points around a corner tell of the surface there.
const POINTS_AROUND: usize = 100;

/// The share of draws whose rays may miss the surface.
const MAY_MISS: f64 = 0.2;

/// The four-corner scales under drawn errors.
pub(super) struct CornerDraws {
    /// Of each edge in the order top, right, bottom, left: draws with all errors; empty where the edge
    /// has no interval.
    all: [Vec<f64>; 4],
    /// See `Uncertainty::parts_percent`.
    parts_percent: [Option<f64>; 4],
    /// See `Uncertainty::leaves_surface`.
    pub(super) leaves_surface: bool,
    /// See `Uncertainty::known`.
    pub(super) known: [bool; 4],
}

/// What is drawn once for all parts.
struct Shared {
    /// Of the camera's centre, in its axes.
    moved: DVec3,
    turned: DMat3,
    focal: f64,
    world: f64,
    /// Of each corner along its ray, in the flight's unit: as the surface states it.
    surface: [f64; 4],
}

/// Which errors have a part.
#[derive(Clone, Copy)]
struct Parts {
    pose: bool,
    lens: bool,
    surface: bool,
    world: bool,
}

/// What the depths of a photo's points do not tell.
type Between<'a> = (Unseen, Option<&'a Bridges>);

/// A corner with what is around it.
struct Around {
    /// Its pixel.
    pixel: DVec2,
    /// (x, y, 1) in camera axes.
    direction: DVec3,
    /// Its depth.
    depth: f64,
    /// The longest edge of the triangle that it met, world units.
    longest_edge: f64,
    /// The triangles near its ray, in camera axes; `None` where no ray will be cast.
    near: Option<Surface>,
    /// How far places like those of the points around it are off.
    errors: ErrorsAround,
    /// The root mean square of that.
    roughness: f64,
    /// The tangent of the ray's angle to the normal of the photo's plane.
    tan_of_incidence: f64,
}

impl CornerDraws {
    pub(super) fn new(
        photo: &UncertainPhoto<'_>,
        plane: DVec3,
        (depths, between): (&[DepthError], Between<'_>),
        surface: &Surface,
    ) -> Self {
        let (unseen, _) = between;
        let stated = &photo.errors;
        // Fewer say nothing of what lies between points; what is stated of each counts all the same.
        let is_seen = depths.len() >= LEAST_POINTS;
        let has = Parts {
            pose: stated.pose.is_stated(),
            lens: stated.focal.is_some(),
            surface: is_seen || stated.surface.is_some(),
            world: stated.world_scale.is_some(),
        };
        let camera_from_world = photo.field.pose().rotation.transpose();
        let shared = drawn_errors(stated, camera_from_world);
        let mut draws = Draws::new(SEED);
        let corners: [Option<Around>; 4] = std::array::from_fn(|index| {
            let corner = &photo.scale.corners[index];
            let CornerOutcome::OnSurface {
                distance,
                longest_edge,
                ..
            } = corner.outcome
            else {
                // Nobody knows how far the ground is from what the ray would have met.
                return None;
            };
            let direction = camera_from_world * corner.direction?;
            let depth = distance * direction.z;
            let direction = direction / direction.z;
            let errors = match is_seen {
                true => ErrorsAround::of(corner.pixel, depths),
                false => ErrorsAround::default(),
            };
            let near = (has.pose || has.lens)
                .then(|| triangles_near(photo, direction, depth, &shared, surface));
            Some(Around {
                pixel: corner.pixel,
                direction,
                depth,
                longest_edge,
                near: near.flatten(),
                roughness: errors.root_mean_square(),
                errors: errors.times(unseen.wider_beside()),
                tan_of_incidence: tan_of_incidence(plane, direction),
            })
        });
        let mut of_parts = |parts: Parts| -> [Vec<f64>; 4] {
            edges_under(photo, (&corners, between), &shared, parts, &mut draws)
        };
        let nothing = Parts {
            pose: false,
            lens: false,
            surface: false,
            world: false,
        };
        let alone = [
            has.pose.then_some(Parts {
                pose: true,
                ..nothing
            }),
            has.lens.then_some(Parts {
                lens: true,
                ..nothing
            }),
            has.surface.then_some(Parts {
                surface: true,
                ..nothing
            }),
            has.world.then_some(Parts {
                world: true,
                ..nothing
            }),
        ];
        let scale = photo.scale.scale;
        let parts_percent = alone.map(|parts| {
            let [mut top, _, mut bottom, _] = of_parts(parts?);
            let ends =
                [(&mut top, scale.top), (&mut bottom, scale.bottom)].map(|(drawn, scale)| {
                    drawn.sort_unstable_by(f64::total_cmp);
                    let scale = scale.filter(|_| !drawn.is_empty())?;
                    Some(deviation(drawn) / scale)
                });
            let squares: Vec<f64> = ends
                .into_iter()
                .flatten()
                .map(|share| share * share)
                .collect();
            // An edge on the ground has no draws; where both are, nothing is known.
            (!squares.is_empty())
                .then(|| (squares.iter().sum::<f64>() / squares.len() as f64).sqrt() * 100.0)
        });
        let is_any = has.pose || has.lens || has.surface || has.world;
        let all = match is_any {
            true => of_parts(has),
            false => Default::default(),
        };
        // Both corners of an edge are on the surface, and under the drawn errors too often one of them is not.
        let [top_left, top_right, bottom_right, bottom_left] = &corners;
        let has_left = |edge: &Vec<f64>, ends: [&Option<Around>; 2]| {
            is_any && edge.is_empty() && ends.iter().all(|end| end.is_some())
        };
        Self {
            leaves_surface: has_left(&all[0], [top_left, top_right])
                || has_left(&all[2], [bottom_left, bottom_right]),
            known: [has.pose, has.lens, has.surface, has.world],
            all,
            parts_percent,
        }
    }

    /// See `Uncertainty::parts_percent`.
    pub(super) fn parts_percent(&self) -> [Option<f64>; 4] {
        self.parts_percent
    }

    /// Of an edge (0 top, 1 right, 2 bottom, 3 left) with this scale.
    pub(super) fn interval(&self, edge: usize, scale: Option<f64>) -> Option<Interval> {
        let drawn = self.all.get(edge).filter(|drawn| !drawn.is_empty())?;
        Some(interval_of(drawn.clone(), scale?))
    }
}

/// Draws of what is stated, turned into the camera's axes.
fn drawn_errors(stated: &StatedErrors, camera_from_world: DMat3) -> Vec<Shared> {
    let position = stated.pose.position.unwrap_or(DVec3::ZERO);
    let angle = stated.pose.angle.unwrap_or(DVec3::ZERO);
    let angle = angle.map(f64::to_radians);
    let factor = |percent: Option<f64>, normal: f64| {
        let factor = 1.0 + percent.unwrap_or(0.0) / 100.0 * normal;
        factor.max(0.1)
    };
    let of_draw = |[x, y, z, a, b, c, focal, world, surface @ ..]: [f64; 12]| Shared {
        moved: camera_from_world * (position * DVec3::new(x, y, z)),
        turned: DMat3::from_quat(DQuat::from_scaled_axis(angle * DVec3::new(a, b, c))),
        focal: factor(stated.focal, focal),
        world: factor(stated.world_scale, world),
        surface: surface.map(|normal: f64| stated.surface.unwrap_or(0.0) * normal),
    };
    stratified(DRAWS, SEED).into_iter().map(of_draw).collect()
}

/// The depth errors of the points nearest to a corner, each as likely as the photo shows the triangles at it: a corner lies
/// anywhere, and a sparse cloud has most of its points where there is most to recognize.
#[derive(Debug, Default)]
struct ErrorsAround {
    errors: Vec<DepthError>,
    /// How much of the photo those up to each of them take.
    areas: Vec<f64>,
}

impl ErrorsAround {
    fn of(pixel: DVec2, depths: &[DepthError]) -> Self {
        let mut errors = depths.to_vec();
        if errors.len() > POINTS_AROUND {
            let off = |error: &DepthError| error.pixel.distance_squared(pixel);
            errors.select_nth_unstable_by(POINTS_AROUND, |a, b| off(a).total_cmp(&off(b)));
            errors.truncate(POINTS_AROUND);
        }
        let up_to = |all: &mut f64, error: &DepthError| {
            *all += error.area;
            Some(*all)
        };
        let areas = errors.iter().scan(0.0, up_to).collect();
        Self { errors, areas }
    }

    fn times(mut self, factor: f64) -> Self {
        self.errors
            .iter_mut()
            .for_each(|error| error.relative *= factor);
        self
    }

    fn root_mean_square(&self) -> f64 {
        root_mean_square(&self.errors).unwrap_or(0.0)
    }

    /// One of them; `None` where there is none.
    fn draw(&self, draws: &mut Draws) -> Option<f64> {
        let at = draws.uniform() * self.areas.last()?;
        let place = self.areas.partition_point(|to| *to <= at);
        let drawn = self.errors.get(place.min(self.errors.len() - 1));
        drawn.map(|error| error.relative)
    }
}

/// The direction that a corner's ray has under drawn errors, in the camera axes that are written.
fn drawn_direction(
    photo: &UncertainPhoto<'_>,
    corner: &Around,
    shared: &Shared,
    parts: Parts,
) -> DVec3 {
    let mut direction = corner.direction;
    if parts.lens {
        let mut camera = photo.field.camera().clone();
        camera.fx *= shared.focal;
        camera.fy *= shared.focal;
        if let Ok(found) = photo.field.image().direction(&camera, corner.pixel)
            && found.z > 0.0
        {
            direction = found / found.z;
        }
    }
    match parts.pose {
        true => shared.turned * direction,
        false => direction,
    }
}

/// The triangles that a corner's ray may meet under the drawn errors, in camera axes.
fn triangles_near(
    photo: &UncertainPhoto<'_>,
    direction: DVec3,
    depth: f64,
    shared: &[Shared],
    surface: &Surface,
) -> Option<Surface> {
    let mut reach = 0.0_f64;
    for drawn in shared {
        let turned = drawn.turned * direction;
        let turned = turned.truncate() / turned.z.max(0.1);
        let by_lens = (1.0 / drawn.focal - 1.0).abs() * direction.truncate().length();
        // What lies at half the depth moves twice as far.
        let by_position = 2.0 * drawn.moved.length() / depth * direction.length();
        reach = reach.max((turned - direction.truncate()).length() + by_lens + by_position);
    }
    let room = DVec2::splat(reach * 1.2 + 1e-6);
    let (min, max) = (direction.truncate() - room, direction.truncate() + room);
    let pose = photo.field.pose();
    let center = surface.frame().local_from_world(pose.center);
    let seen = Pyramid::of_directions(min, max, center, pose.rotation);
    let sides = inward(min, max);
    let camera_from_local = pose.rotation.transpose();
    let mut points = Vec::new();
    for patch in surface.patches().seen(|bounds| seen.misses(bounds)).ok()? {
        for triangle in patch.triangles_seen(|bounds| seen.misses(bounds)) {
            let corners = triangle.map(|corner| camera_from_local * (corner - center));
            // Only what the pyramid holds of the surface, so that it does not matter which others are there.
            if clipped(corners, &sides).is_empty() {
                continue;
            }
            points.extend(corners);
        }
    }
    let count = u32::try_from(points.len() / 3).ok()?;
    let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let cloud = Cloud {
        points,
        triangles,
        ..Cloud::default()
    };
    Surface::new(cloud).ok()
}

/// Draws of the four edges' scales under some of the errors; empty where an end is not known.
fn edges_under(
    photo: &UncertainPhoto<'_>,
    (corners, (unseen, bridges)): (&[Option<Around>; 4], Between<'_>),
    shared: &[Shared],
    parts: Parts,
    draws: &mut Draws,
) -> [Vec<f64>; 4] {
    let mut edges: [Vec<f64>; 4] = Default::default();
    let mut casters: Vec<_> = corners
        .iter()
        .map(|corner| {
            let near = corner.as_ref()?.near.as_ref()?;
            // Each of the first rays would look at every triangle: of a wide reach there are millions.
            near.caster_for(shared.len()).ok()
        })
        .collect();
    let camera = photo.field.camera();
    let (width, height) = (f64::from(camera.width), f64::from(camera.height));
    let casts = parts.pose || parts.lens;
    for drawn in shared {
        let mut ends: [Option<DVec3>; 4] = [None; 4];
        for (index, corner) in corners.iter().enumerate() {
            let Some(corner) = corner else { continue };
            let direction = drawn_direction(photo, corner, drawn, parts);
            let origin = match parts.pose {
                true => drawn.moved,
                false => DVec3::ZERO,
            };
            let mut along = corner.depth;
            if casts {
                let Some(hit) = casters
                    .get_mut(index)
                    .and_then(Option::as_mut)
                    .and_then(|caster| caster.cast(&Ray { origin, direction }))
                else {
                    continue;
                };
                along = hit.t;
            }
            if parts.surface {
                let error = corner.errors.draw(draws).unwrap_or(0.0);
                let stated = drawn.surface[index];
                let gap = unseen.gap(corner.tan_of_incidence, draws) * corner.roughness;
                let bridged = bridges.map_or(0.0, |bridges| {
                    bridges.draw(corner.longest_edge, corner.depth, draws)
                });
                along = along * (1.0 + error + gap + bridged) + stated / direction.length();
            }
            ends[index] = Some(origin + direction * along);
        }
        let world = match parts.world {
            true => drawn.world,
            false => 1.0,
        };
        let [top_left, top_right, bottom_right, bottom_left] = ends;
        let of_edges = [
            (width, top_left, top_right),
            (height, top_right, bottom_right),
            (width, bottom_left, bottom_right),
            (height, top_left, bottom_left),
        ];
        for (edge, (pixels, from, to)) in edges.iter_mut().zip(of_edges) {
            if let (Some(from), Some(to)) = (from, to) {
                let scale = pixels / ((from - to).length() * world);
                edge.extend(scale.is_finite().then_some(scale));
            }
        }
    }
    // Where too many rays leave the surface, the others say too little.
    let least = (1.0 - MAY_MISS) * shared.len() as f64;
    edges.map(|edge| match (edge.len() as f64) < least {
        true => Vec::new(),
        false => edge,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One point on one part of the photo, one on three; a third is too far away.
    #[test]
    fn a_corner_lies_on_what_takes_most_of_the_photo() {
        let error = |x: f64, relative: f64, area: f64| DepthError {
            pixel: DVec2::new(x, 0.0),
            relative,
            area,
        };
        let mut depths = vec![error(1.0, 0.01, 1.0), error(2.0, -0.02, 3.0)];
        depths.extend((0..POINTS_AROUND).map(|_| error(100.0, 0.0, 0.0)));
        depths.push(error(1e6, 5.0, 1e6));
        let around = ErrorsAround::of(DVec2::ZERO, &depths).times(2.0);
        assert!((around.root_mean_square() - (13e-4_f64).sqrt()).abs() < 1e-12);
        let mut draws = Draws::new(1);
        let drawn: Vec<f64> = (0..4000).filter_map(|_| around.draw(&mut draws)).collect();
        let of_small = drawn.iter().filter(|error| **error == 0.02).count();
        assert!(drawn.iter().all(|error| *error == 0.02 || *error == -0.04));
        // A binomial number of 4000 with 1/4 has a deviation of 27.
        assert!((900..1100).contains(&of_small), "{of_small}");
        assert_eq!(ErrorsAround::default().draw(&mut draws), None);
        assert_eq!(ErrorsAround::default().root_mean_square(), 0.0);
    }
}
