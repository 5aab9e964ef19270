//! Photos of random piles with the fragment of every pixel, for training a network that outlines fragments.
//!
//! The presets are few places with one kind of rock each; a network that saw only them would know no other.
//! So here everything is drawn: how sizes are distributed and which of them are stones at all, how worn and
//! how wet they are, of what colour, how deep they lie in fines of another colour, where the sun stands or
//! how overcast it is, from how near and how aslant the photo looks. What a lens, a sensor and a file do to
//! a photo is left to the training itself, which draws it anew each time.

use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

use fragscale_core::picture::{PhotoFormat, encode};
use glam::{DVec2, DVec3};
use image::RgbImage;

use super::scene::fragment::BROKEN;
use super::scene::light::{Lamp, Light};
use super::scene::pile::{Pile, PilePlan};
use super::scene::terrain::Terrain;
use super::scene::{Scene, Sphere};
use crate::camera::{Camera, Distortion, Pose};
use crate::fault::Fault;
use crate::fragmentation::Swebrec;
use crate::geometry::Ray;
use crate::jobs::Progress;
use crate::material::Material;
use crate::noise::gradient_noise;
use crate::photo::{self, Look};
use crate::random::Random;
use crate::{cannot_write, exports, write};

/// Photos of one pile.
const PHOTOS: u64 = 2;

/// Writes `photos/NAME.png` and `labels/NAME.png` of so many piles, two photos of each, `side` pixels
/// square. A label is a fragment's number from 1, or 0 for everything else. Everything follows from the
/// seed, pile by pile: more piles begin with the same ones. Photos that are there already are left alone.
///
/// # Errors
/// Where the folder cannot be written, or on cancel.
pub fn training_photos(
    folder: &Path,
    seed: u64,
    piles: u64,
    side: u32,
    progress: &Progress,
) -> Result<(), Fault> {
    let (photos, labels) = (folder.join("photos"), folder.join("labels"));
    for folder in [&photos, &labels] {
        fs::create_dir_all(folder).map_err(|error| cannot_write(&error))?;
    }
    for number in 0..piles {
        progress.advance(number, piles)?;
        let name = |photo: u64| format!("{seed:04}_{number:05}_{photo}.png");
        if (0..PHOTOS).all(|photo| labels.join(name(photo)).exists()) {
            continue;
        }
        let mut random = Random::new(seed).fork(number);
        let place = Place::draw(&mut random)?;
        let scene = place.scene(&mut random.fork(1))?;
        for photo in 0..PHOTOS {
            let mut random = random.fork(100 + photo);
            let (image, found) = place.photo(&scene, side, &mut random)?;
            let bytes = encode(&image, PhotoFormat::Png, 0, None, None)?;
            write(&photos.join(name(photo)), &bytes)?;
            let bytes = exports::label_png(side, side, &found);
            let bytes = bytes.map_err(|error| Fault::new(error, "report this"))?;
            write(&labels.join(name(photo)), &bytes)?;
        }
    }
    Ok(())
}

/// A random pile with its light.
struct Place {
    plan: PilePlan,
    look: Look,
    /// How deep stones lie in fines, in parts of the typical one; below 0 they lie on them.
    sunk: f64,
    uneven: f64,
}

impl Place {
    fn draw(random: &mut Random) -> Result<Self, Fault> {
        // The typical stone, by mass, is 1 cm: lengths mean nothing to a photo.
        let typical = 0.01;
        let largest = typical * 10f64.powf(random.range(0.15, 0.75));
        let sizes = Swebrec::new(typical, largest, random.range(1.3, 3.5))
            .map_err(|error| Fault::new(error.to_string(), "report this"))?;
        let slope = random.range(0.0, 0.7);
        let half = 0.16;
        let corners = if random.uniform() < 0.6 {
            BROKEN
        } else {
            // Pebbles.
            (50, 110)
        };
        let plan = PilePlan {
            terrain: Terrain::Windrow {
                half_crest: half,
                height: 0.5 * slope * half,
                slope: slope.max(0.01),
            },
            sizes,
            smallest: typical * random.range(0.16, 0.5),
            half_extent: DVec2::splat(half),
            thickness: typical * random.range(0.25, 0.9),
            corners,
            bodies: 60,
        };
        let [rock, fines] = Material::any(typical, random);
        let look = Look {
            rock,
            fines,
            // What lies around the pile is as good as what lies in it.
            floor: fines,
            sphere: Material::painted_sphere(),
            light: light(random),
            average: 1.0,
            grain: typical,
        };
        Ok(Self {
            plan,
            look,
            sunk: random.range(-0.6, 0.75),
            uneven: random.range(0.0, 0.6),
        })
    }

    fn scene(&self, random: &mut Random) -> Result<Scene, Fault> {
        let mut pile = Pile::strew(&self.plan, random, &Progress::default())?;
        let (typical, seed) = (self.look.grain, random.bits());
        pile.sink(|at| {
            let (noise, _) = gradient_noise((at / (8.0 * typical)).extend(0.0), seed);
            typical * (self.sunk + self.uneven * noise).max(0.0)
        });
        let mut scene = Scene::new(pile, &self.plan, self.plan.half_extent * 1.6)?;
        // Now and then something that is no rock.
        if random.uniform() < 0.1 {
            let radius = typical * random.range(1.0, 4.0);
            let at = DVec2::new(random.uniform(), random.uniform()) * 0.1 - 0.05;
            let center = at.extend(scene.ground_height(at) + radius);
            scene.add_spheres([Sphere { center, radius }]);
        }
        Ok(scene)
    }

    /// A photo and the fragment of every pixel.
    fn photo(
        &self,
        scene: &Scene,
        side: u32,
        random: &mut Random,
    ) -> Result<(RgbImage, Vec<u16>), Fault> {
        let typical = self.look.grain;
        // How many pixels the typical stone has: from far away or near.
        let pixels = 10f64.powf(random.range(1.15, 2.15));
        let focal = f64::from(side) * random.range(0.8, 1.6);
        let middle = f64::from(side) / 2.0;
        let camera = Camera {
            name: String::new(),
            width: side,
            height: side,
            fx: focal,
            fy: focal,
            cx: middle,
            cy: middle,
            skew: 0.0,
            distortion: Distortion::None,
        };
        let distance = typical * focal / pixels;
        let tilt = if random.uniform() < 0.6 {
            random.range(75.0, 90.0)
        } else {
            random.range(42.0, 75.0)
        };
        let pan = random.range(0.0, 360.0);
        // Looks at a place of the pile, so near its middle that the whole photo shows pile where that is possible.
        let room = (self.plan.half_extent.x - distance * 0.5 / focal * f64::from(side)).max(0.0);
        let at = DVec2::new(random.range(-1.0, 1.0), random.range(-1.0, 1.0)) * room * 0.8;
        let aim = at.extend(scene.ground_height(at));
        let looks = Pose::from_tilt_pan(DVec3::ZERO, [tilt, pan])
            .rotation
            .z_axis;
        let pose = Pose::from_tilt_pan(aim - looks * distance, [tilt, pan]);
        let mut look = self.look.clone();
        look.average = metered(&look, scene, &camera, &pose)? * random.range(-0.5, 0.5).exp();
        let photo = photo::take(
            scene,
            &camera,
            &pose,
            &look,
            random.bits(),
            &Progress::default(),
        )?;
        Ok((photo.image, photo.labels))
    }
}

/// The mean radiance, as a camera's meter takes it.
fn metered(look: &Look, scene: &Scene, camera: &Camera, pose: &Pose) -> Result<f64, Fault> {
    let mut caster = scene.caster()?;
    let (mut sum, mut count) = (0.0, 0u32);
    for place in 0..400 {
        let at = DVec2::new(f64::from(place % 20), f64::from(place / 20)) + 0.5;
        let pixel = at / 20.0 * f64::from(camera.width);
        let direction = (pose.rotation * camera.direction_undistorted(pixel)).normalize();
        let ray = Ray {
            origin: pose.center,
            direction,
        };
        if let Some(met) = caster.cast(&ray) {
            let seen = look.radiance(&mut caster, camera, direction, &met);
            sum += seen.iter().sum::<f64>() / 3.0;
            count += 1;
        }
    }
    Ok(sum / f64::from(count.max(1)))
}

/// From a low sun to an overcast sky, or lamps.
fn light(random: &mut Random) -> Light {
    let turn = random.range(0.0, TAU);
    let towards = |elevation: f64, azimuth: f64| {
        let (sin, cos) = elevation.sin_cos();
        DVec3::new(azimuth.cos() * cos, azimuth.sin() * cos, sin)
    };
    let kind = random.uniform();
    if kind < 0.55 {
        return Light::sun(turn, random.range(0.2, 1.45));
    }
    let lamp = |random: &mut Random, bright: f64, azimuth: f64| Lamp {
        direction: towards(random.range(0.35, PI / 2.0), azimuth),
        colour: [1.0, 1.0, 1.0].map(|part: f64| part * bright * random.range(0.9, 1.1)),
        radius: random.range(0.05, 0.7),
        rays: 1,
    };
    // Overcast: hardly any light from one direction; lamps: from three.
    let (strong, fill, room) = if kind < 0.8 {
        (random.range(0.0, 0.4), 0.05, random.range(0.25, 0.45))
    } else {
        let fill = random.range(0.1, 0.6);
        (random.range(0.6, 1.0), fill, random.range(0.05, 0.2))
    };
    Light::Lamps {
        lamps: [
            lamp(random, strong, turn),
            lamp(random, fill, turn + 2.0),
            lamp(random, fill * 0.7, turn + 4.0),
        ],
        room: [room, room, room * 1.05],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same seed gives the same photos; another one, others; both show stones that a network could learn.
    #[test]
    fn photos_follow_from_the_seed() {
        let folder = tempfile::tempdir().unwrap();
        let make = |name: &str, seed: u64| {
            let folder = folder.path().join(name);
            training_photos(&folder, seed, 1, 64, &Progress::default()).unwrap();
            let file = format!("{seed:04}_00000_1.png");
            let read = |kind: &str| fs::read(folder.join(kind).join(&file)).unwrap();
            let labels = image::load_from_memory(&read("labels")).unwrap();
            let labels = labels.as_luma16().unwrap().clone().into_raw();
            assert!(labels.iter().any(|label| *label > 0));
            (read("photos"), labels)
        };
        let first = make("one", 5);
        assert_eq!(first, make("again", 5));
        assert_ne!(first, make("other", 6));
    }
}
