//! A cloud as structure from motion would give it.
//!
//! Points lie only where at least three photos of the survey see the surface, more where it has
//! texture (a matcher finds nothing on a blank wall) and light: into the dark between stones photos look, too, but of what
//! `reconstruct` finds there most hangs before the true surface ([`DARK`], [`LIT`]); their noise is largest
//! along the viewing ray (a matching error of a fraction of a pixel, divided by the base-to-height
//! ratio); a few fly. The survey is denser than the photos that are measured: rows with 75 % overlap
//! and a ring around the pile, as a pilot flies it for a reconstruction.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::flight_plan::FlightPlan;
use super::random::Random;
use super::scene::{Meeting, Scene, SceneCaster};
use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::geometry::Ray;
use crate::jobs::Progress;
use crate::surface::Cloud;

/// What the cloud shall be like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloudPlan {
    /// How many points.
    pub points: usize,
    /// Standard deviation of a match, in pixels; 0 gives points on the surface.
    pub noise_px: f64,
    /// Which share of the points flies.
    pub flying: f64,
}

/// By how much a matching error grows along the ray: the height over the base of a pair of photos.
const HEIGHT_OVER_BASE: f64 = 2.5;

/// How far beside a place its texture is looked for, in pixels.
const BESIDE_PX: f64 = 4.0;

/// Up to this grey level a place makes no point, and from [`LIT`] on darkness costs none. Of the 2.5 million points of a dense
/// cloud that `reconstruct` made of 39 photos of a muckpile those in pixels of 0 to 20 levels lie on the true surface (to two
/// pixels) in 22 of 100, of 20 to 45 in 38, 45 to 80 in 63, 80 to 120 in 84, of brighter ones in 93. The others hang before it, at
/// the rims of stones; a place without a point is bridged from there, which comes to the same. With these limits
/// fitted scales over simulated clouds are too large by as much as over reconstructed dense ones: by 0.72 and 0.80 % on a
/// stockpile and a muckpile, where those have 0.87 and 0.70 (scale balls left out of account); with points in the dark as elsewhere it
/// was 0.14 and 0.26.
const DARK: f64 = 30.0;

/// See [`DARK`].
const LIT: f64 = 130.0;

/// How many photos must see a point.
const SEEN_BY: usize = 3;

/// The poses of the survey that the cloud comes from.
pub(super) fn survey(plan: &FlightPlan, random: &mut Random) -> Vec<Pose> {
    let [columns, rows] = plan.count;
    let dense = FlightPlan {
        count: [columns * 4 + 1, rows * 4 + 1],
        spacing: plan.spacing / 4.0,
        ..plan.clone()
    };
    let mut shots = dense.fly(random);
    shots.extend(dense.ring(24, random));
    shots.iter().map(super::flight_plan::Shot::pose).collect()
}

/// In how many portions the cloud is drawn, each with random numbers of its own: the cloud is the
/// same on any number of cores.
const PORTIONS: usize = 64;

/// Draws the cloud, in the lab's frame.
///
/// # Errors
/// Where so little is seen by three photos that the points cannot be found, or on cancel.
pub(super) fn cloud(
    scene: &Scene,
    camera: &Camera,
    survey: &[Pose],
    plan: &CloudPlan,
    color_of: impl Fn(&mut SceneCaster<'_>, &Meeting) -> [u8; 3] + Sync,
    random: &Random,
    progress: &Progress,
) -> Result<Cloud, Fault> {
    progress.stage("reconstructing the cloud");
    let portions: Vec<Cloud> = (0..PORTIONS)
        .into_par_iter()
        .map(|portion| {
            let count = plan.points * (portion + 1) / PORTIONS - plan.points * portion / PORTIONS;
            let plan = CloudPlan {
                points: count,
                ..*plan
            };
            let mut random = random.fork(portion as u64);
            draw(
                scene,
                camera,
                survey,
                &plan,
                &color_of,
                &mut random,
                progress,
            )
        })
        .collect::<Result<_, Fault>>()?;
    let mut cloud = Cloud::default();
    for portion in portions {
        cloud.points.extend(portion.points);
        cloud.colors.extend(portion.colors);
    }
    Ok(cloud)
}

fn draw(
    scene: &Scene,
    camera: &Camera,
    survey: &[Pose],
    plan: &CloudPlan,
    color_of: &impl Fn(&mut SceneCaster<'_>, &Meeting) -> [u8; 3],
    random: &mut Random,
    progress: &Progress,
) -> Result<Cloud, Fault> {
    let mut caster = scene.caster()?;
    let mut cloud = Cloud::default();
    let mut tries = 0_usize;
    while cloud.points.len() < plan.points {
        tries += 1;
        if progress.is_cancelled() {
            return Err(Fault::new("cancelled", "start it again when you want it"));
        }
        if tries > plan.points * 50 {
            return Err(Fault::new(
                "the survey sees too little of the pile three times",
                "fly lower, or ask for fewer points",
            ));
        }
        let first = (random.uniform() * survey.len() as f64) as usize;
        let Some(pose) = survey.get(first) else {
            continue;
        };
        let (w, h) = (f64::from(camera.width), f64::from(camera.height));
        let pixel = DVec2::new(random.range(0.0, w), random.range(0.0, h));
        let direction = (pose.rotation * camera.direction_undistorted(pixel)).normalize();
        let ray = Ray {
            origin: pose.center,
            direction,
        };
        let Some(met) = caster.cast(&ray) else {
            continue;
        };
        if !seen_often(&mut caster, camera, survey, first, met.point) {
            continue;
        }
        let color = color_of(&mut caster, &met);
        if random.uniform() > texture(&mut caster, camera, &ray, pose, color, &color_of) {
            continue;
        }
        let blur = met.t / camera.fx * plan.noise_px;
        let sideways = DVec3::new(random.normal(), random.normal(), random.normal()) * blur;
        let along = direction * (random.normal() * blur * HEIGHT_OVER_BASE);
        let point = if random.uniform() < plan.flying {
            ray.at(met.t * random.range(0.6, 0.97))
        } else {
            met.point + sideways + along
        };
        cloud.points.push(point);
        cloud.colors.push(color);
    }
    Ok(cloud)
}

/// How likely a place is matched, 0 to 1: by the contrast with what lies a few pixels beside it, and its light.
fn texture(
    caster: &mut SceneCaster<'_>,
    camera: &Camera,
    ray: &Ray,
    pose: &Pose,
    color: [u8; 3],
    color_of: &impl Fn(&mut SceneCaster<'_>, &Meeting) -> [u8; 3],
) -> f64 {
    let beside = ray.direction + pose.rotation.x_axis * (BESIDE_PX / camera.fx);
    let beside = Ray {
        origin: ray.origin,
        direction: beside.normalize(),
    };
    let Some(met) = caster.cast(&beside) else {
        return 0.0;
    };
    let brightness = |color: [u8; 3]| color.iter().map(|&part| f64::from(part)).sum::<f64>() / 3.0;
    let contrast = (brightness(color) - brightness(color_of(caster, &met))).abs();
    (0.2 + contrast / 20.0).min(1.0) * ((brightness(color) - DARK) / (LIT - DARK)).clamp(0.0, 1.0)
}

/// Whether enough photos beside the first see a point.
fn seen_often(
    caster: &mut SceneCaster<'_>,
    camera: &Camera,
    survey: &[Pose],
    first: usize,
    point: DVec3,
) -> bool {
    let mut seen = 1;
    for (index, pose) in survey.iter().enumerate() {
        let in_image = camera
            .pixel_undistorted(pose.camera_from_world(point))
            .is_some_and(|pixel| camera.contains(pixel));
        if index == first || !in_image {
            continue;
        }
        let way = point - pose.center;
        let ray = Ray {
            origin: pose.center,
            direction: way.normalize(),
        };
        let clear = caster
            .cast(&ray)
            .is_some_and(|met| met.t > way.length() * (1.0 - 1e-6));
        seen += usize::from(clear);
        if seen >= SEEN_BY {
            return true;
        }
    }
    false
}
