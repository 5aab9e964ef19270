//! A photo of the lab: a ray for every pixel, through the lens, lit and developed.

use std::cell::RefCell;

use glam::{DQuat, DVec2, DVec3};
use image::RgbImage;
use rayon::prelude::*;

use super::material::{Edge, Material, Spot};
use super::scene::light::Light;
use super::scene::{Meeting, Scene, SceneCaster, Thing};
use super::sensor::Sensor;
use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::geometry::Ray;
use crate::jobs::Progress;

/// What a scene looks like.
#[derive(Debug, Clone)]
pub(super) struct Look {
    /// The fragments.
    pub rock: Material,
    /// The heap's fines between them.
    pub fines: Material,
    /// The floor around the heap.
    pub floor: Material,
    /// The scale spheres.
    pub sphere: Material,
    /// What lights it.
    pub light: Light,
    /// The radiance that becomes middle grey.
    pub average: f64,
    /// The size of a typical fragment, metres.
    pub grain: f64,
}

/// A photo with its truth.
#[derive(Debug)]
pub(super) struct Photo {
    /// As shot.
    pub image: RgbImage,
    /// Which fragment each pixel shows: its number from 1, or 0 for ground and spheres.
    pub labels: Vec<u16>,
}

/// Takes a photo, as shot. `seed` makes its noise its own.
///
/// # Errors
/// Where the scene cannot be met, or on cancel.
pub(super) fn take(
    scene: &Scene,
    camera: &Camera,
    pose: &Pose,
    look: &Look,
    seed: u64,
    progress: &Progress,
) -> Result<Photo, Fault> {
    let (width, height) = (camera.width, camera.height);
    let sensor = Sensor::metered(look.average, seed);
    let rows: Vec<Vec<([u8; 3], u16)>> = (0..height)
        .into_par_iter()
        .map(|y| {
            if progress.is_cancelled() {
                return Err(Fault::new("cancelled", "start it again when you want it"));
            }
            let mut caster = scene.caster()?;
            let row = (0..width).map(|x| {
                let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let direction = camera.direction_as_shot(pixel).ok();
                let met = direction.and_then(|direction| {
                    let direction = (pose.rotation * direction).normalize();
                    let ray = Ray {
                        origin: pose.center,
                        direction,
                    };
                    let met = caster.cast(&ray)?;
                    Some((direction, met))
                });
                let (radiance, label) = match met {
                    Some((direction, met)) => (
                        look.radiance(&mut caster, camera, direction, &met),
                        match met.thing {
                            // A pile has at most 65 534 fragments.
                            Thing::Fragment(index) => (index + 1) as u16,
                            Thing::Ground | Thing::Sphere(_) => 0,
                        },
                    ),
                    None => ([look.average * 0.4; 3], 0),
                };
                (sensor.develop(radiance, x, y, (width, height)), label)
            });
            Ok(row.collect())
        })
        .collect::<Result<_, Fault>>()?;
    let mut image = RgbImage::new(width, height);
    let mut labels = Vec::with_capacity(rows.len() * width as usize);
    for (pixel, (color, label)) in image.pixels_mut().zip(rows.into_iter().flatten()) {
        pixel.0 = color;
        labels.push(label);
    }
    Ok(Photo { image, labels })
}

impl Look {
    /// The linear radiance that a met point sends back along the ray.
    pub(super) fn radiance(
        &self,
        caster: &mut SceneCaster<'_>,
        camera: &Camera,
        direction: DVec3,
        met: &Meeting,
    ) -> [f64; 3] {
        let scene = caster.scene();
        let pixel = met.t / camera.fx;
        let (material, spot, turn) = match met.thing {
            Thing::Ground => {
                let on_heap = scene.ground_height(met.point.truncate()) > self.grain * 0.1;
                let spot = Spot {
                    fragment: 0,
                    point: met.point,
                    normal: met.normal,
                    up: DVec3::Z,
                    size: self.grain,
                    pixel,
                    edge: None,
                };
                let material = if on_heap { &self.fines } else { &self.floor };
                (material, spot, DQuat::IDENTITY)
            }
            Thing::Fragment(index) => {
                let spot = scene.fragment_spot(index, met);
                let turn = scene.fragment_rotation(index);
                let edge = spot.1.map(|(distance, normal)| Edge { distance, normal });
                let back = turn.inverse();
                let spot = Spot {
                    fragment: index as u64 + 1,
                    point: spot.0,
                    normal: back * met.normal,
                    up: back * DVec3::Z,
                    size: spot.2,
                    pixel,
                    edge,
                };
                (&self.rock, spot, turn)
            }
            Thing::Sphere(index) => {
                let center = scene.spheres().get(index).map_or(DVec3::ZERO, |s| s.center);
                let spot = Spot {
                    fragment: index as u64,
                    point: met.point - center,
                    normal: met.normal,
                    up: DVec3::Z,
                    size: self.grain * 5.0,
                    pixel,
                    edge: None,
                };
                (&self.sphere, spot, DQuat::IDENTITY)
            }
        };
        let appearance = material.surface(&spot).turned(turn);
        let start = met.point + met.normal * (self.grain * 1e-5);
        // `shade` asks through a shared closure.
        let caster = RefCell::new(caster);
        let shadowed = |towards: DVec3| {
            let ray = Ray {
                origin: start,
                direction: towards,
            };
            caster.borrow_mut().is_blocked(&ray)
        };
        let openness = scene.openness(met.point, met.normal);
        self.light
            .shade(&appearance, met.normal, -direction, shadowed, openness)
    }
}
