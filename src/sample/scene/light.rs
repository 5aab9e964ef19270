//! Light: the sun under a blue sky, or a lab's lamps; and how a surface sends it to the camera.
//!
//! Rough rock after Oren & Nayar, "Generalization of Lambert's Reflectance Model" (SIGGRAPH 1994),
//! the qualitative model; light between stones after Jimenez et al., "Practical Realtime
//! Strategies for Accurate Indirect Occlusion" (2016), in its simplest form.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use crate::material::Appearance;
use crate::noise::{hash, unit};

/// A lamp, or the sun: far away, so the same from everywhere, but as wide as it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lamp {
    /// Towards it, in the world; length 1.
    pub direction: DVec3,
    /// Irradiance of a surface that faces it, over pi: a white surface then has this radiance.
    pub colour: [f64; 3],
    /// Half the angle it spans, radians: the larger, the softer its shadows.
    pub radius: f64,
    /// Shadow rays per point, at least 1.
    pub rays: u32,
}

/// The light of a scene, in the world's frame (z up).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Light {
    /// One sun, the sky above and its reflection from the ground below.
    Sun {
        /// The sun.
        sun: Lamp,
        /// Radiance of the sky overhead.
        sky: [f64; 3],
        /// Radiance of the ground below the horizon.
        ground: [f64; 3],
    },
    /// A lab: soft lamps under a ceiling that reflects them.
    Lamps {
        /// The lamps.
        lamps: [Lamp; 3],
        /// Radiance of the walls and the ceiling.
        room: [f64; 3],
    },
}

impl Light {
    /// A clear day: the sun at `elevation` above the horizon and `azimuth` from x towards y
    /// (radians), warmer the lower it stands.
    #[must_use]
    pub(crate) fn sun(azimuth: f64, elevation: f64) -> Self {
        let (sin, cos) = elevation.sin_cos();
        let warm = (1.0 - sin).clamp(0.0, 1.0);
        Self::Sun {
            sun: Lamp {
                direction: DVec3::new(azimuth.cos() * cos, azimuth.sin() * cos, sin),
                colour: [1.0, 0.965 - 0.10 * warm, 0.91 - 0.26 * warm],
                // Wider than the real sun's 0.0047: haze blurs shadows that much.
                radius: 0.009,
                rays: 1,
            },
            sky: [0.155, 0.185, 0.228],
            ground: [0.13, 0.115, 0.095],
        }
    }

    /// Three soft-boxes under a ceiling: one strong, one to fill, one behind.
    #[must_use]
    pub(crate) fn lab() -> Self {
        let lamp = |x: f64, y: f64, z: f64, colour, radius, rays| Lamp {
            direction: DVec3::new(x, y, z).normalize(),
            colour,
            radius,
            rays,
        };
        Self::Lamps {
            lamps: [
                lamp(-0.75, 0.45, 0.95, [0.88, 0.85, 0.80], 0.07, 2),
                lamp(0.9, 0.25, 1.1, [0.17, 0.17, 0.18], 0.16, 1),
                lamp(0.1, -0.9, 1.0, [0.12, 0.12, 0.125], 0.16, 1),
            ],
            room: [0.125, 0.127, 0.128],
        }
    }

    /// The linear RGB radiance that `appearance` (its normal in the world's frame) sends towards
    /// `view` (from the point to the camera, length 1). `geometric_normal` is that of the face,
    /// `shadowed` says whether anything stands in the given direction, `openness` is the part of
    /// the hemisphere that nothing hides, 0 to 1.
    ///
    /// Where on a lamp the shadow rays go is drawn from `view`: their grain differs from pixel to
    /// pixel and is the same in every run.
    #[must_use]
    pub(crate) fn shade(
        &self,
        appearance: &Appearance,
        geometric_normal: DVec3,
        view: DVec3,
        shadowed: impl Fn(DVec3) -> bool,
        openness: f64,
    ) -> [f64; 3] {
        let seed = hash(view.x.to_bits() ^ hash(view.y.to_bits()));
        let (lamps, above, below): (&[Lamp], _, _) = match self {
            Self::Sun { sun, sky, ground } => (std::slice::from_ref(sun), *sky, *ground),
            Self::Lamps { lamps, room } => (lamps, *room, room.map(|part| 0.6 * part)),
        };
        let mut radiance = ambient(appearance, above, below, openness);
        for (lamp, channel) in lamps.iter().zip(0..) {
            let seen = lamp.seen(geometric_normal, seed ^ hash(channel), &shadowed);
            if seen > 0.0 {
                let (diffuse, shine) = reflected(appearance, lamp.direction, view);
                // The fine relief hides a low lamp from its pits, too.
                let seen = seen * (0.35 + 0.65 * appearance.openness);
                add(&mut radiance, |i| {
                    let (albedo, colour) = (part(appearance.albedo, i), part(lamp.colour, i));
                    seen * colour * (albedo * diffuse + shine)
                });
            }
        }
        radiance
    }
}

impl Lamp {
    /// The part of the lamp that the point sees.
    fn seen(&self, normal: DVec3, seed: u64, shadowed: impl Fn(DVec3) -> bool) -> f64 {
        let rays = self.rays.max(1);
        let (u, v) = self.direction.any_orthonormal_pair();
        // Evenly over the disc: turned on by the golden angle each time, from the pixel's own draw.
        const GOLDEN: DVec2 = DVec2::new(-0.737_368_878_078_319_9, 0.675_490_294_261_523_7);
        let mut turn = DVec2::from_angle(TAU * unit(seed, 1));
        let start = unit(seed, 2);
        let mut open = 0;
        for i in 0..rays {
            let away = turn * (((f64::from(i) + start) / f64::from(rays)).sqrt() * self.radius);
            let towards = (self.direction + away.x * u + away.y * v).normalize();
            if normal.dot(towards) > 0.0 && !shadowed(towards) {
                open += 1;
            }
            turn = turn.rotate(GOLDEN);
        }
        f64::from(open) / f64::from(rays)
    }
}

/// What comes from all around: the hemisphere above, the ground below, and the neighbours.
fn ambient(appearance: &Appearance, above: [f64; 3], below: [f64; 3], openness: f64) -> [f64; 3] {
    let up = 0.5 + 0.5 * appearance.normal.z;
    let open = (openness * appearance.openness).clamp(0.0, 1.0);
    let mut radiance = [0.0; 3];
    add(&mut radiance, |i| {
        let albedo = part(appearance.albedo, i);
        let hemisphere = part(below, i) + (part(above, i) - part(below, i)) * up;
        // A crevice is lit by its own walls, which are as bright as the rock.
        albedo * hemisphere * open / (1.0 - 0.8 * albedo * (1.0 - open))
    });
    radiance
}

/// Cosine times the reflectance over the albedo (pi times it), and the highlight.
fn reflected(appearance: &Appearance, towards: DVec3, view: DVec3) -> (f64, f64) {
    let normal = appearance.normal;
    let (lit, viewed) = (normal.dot(towards), normal.dot(view).clamp(0.05, 1.0));
    if lit <= 0.0 {
        return (0.0, 0.0);
    }
    // Oren & Nayar with a roughness of 0.45 rad, in the polynomial form of Fujii (2012).
    let sigma = 0.45 * 2.0 / PI;
    let a = 1.0 / (PI + (PI / 2.0 - 2.0 / 3.0) * sigma) * PI;
    let s = towards.dot(view) - lit * viewed;
    let over = if s > 0.0 { s / lit.max(viewed) } else { s };
    let diffuse = (lit * a * (1.0 + sigma * over)).max(0.0);
    // Blinn's highlight, wide: a broken face is a crowd of small ones.
    let half = (towards + view).normalize_or(normal);
    let shine = 0.055 * appearance.sheen * normal.dot(half).max(0.0).powi(24) * lit;
    (diffuse, shine)
}

fn part(colour: [f64; 3], index: usize) -> f64 {
    colour.get(index).copied().unwrap_or_default()
}

fn add(sum: &mut [f64; 3], of: impl Fn(usize) -> f64) {
    for (index, value) in sum.iter_mut().enumerate() {
        *value += of(index);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn white(normal: DVec3) -> Appearance {
        Appearance {
            albedo: [0.8; 3],
            normal,
            sheen: 0.0,
            openness: 1.0,
        }
    }

    #[test]
    fn radiance_is_finite_and_never_negative() {
        for light in [Light::sun(1.0, 0.6), Light::sun(1.0, 0.0), Light::lab()] {
            for i in 0..3000 {
                let draw = |channel| crate::noise::direction(i, channel);
                let appearance = Appearance {
                    sheen: unit(i, 4),
                    openness: unit(i, 5),
                    ..white(draw(1))
                };
                let seen = light.shade(&appearance, draw(2), draw(3), |d| d.x > 0.0, unit(i, 6));
                // No surface is brighter than a white one that faces all the light there is.
                assert!(seen.iter().all(|v| v.is_finite() && (0.0..2.0).contains(v)));
            }
        }
    }

    #[test]
    fn a_level_white_surface_sends_back_no_more_than_it_gets() {
        // The integral of radiance times cosine over the hemisphere, by the mean of draws that are
        // spread as the cosine: a reflectance below the albedo, above three quarters of it.
        let appearance = white(DVec3::Z);
        for elevation in [0.3_f64, 0.8, 1.5] {
            let towards = DVec3::new(elevation.cos(), 0.0, elevation.sin());
            let n = 20_000;
            let mut sum = 0.0;
            for i in 0..n {
                let view = (DVec3::Z + crate::noise::direction(i, 1)).normalize();
                sum += 0.8 * reflected(&appearance, towards, view).0;
            }
            let reflectance = sum / n as f64 / towards.z;
            assert!((0.6..0.8).contains(&reflectance), "{reflectance}");
        }
    }

    #[test]
    fn shadow_leaves_the_sky_only() {
        let light = Light::sun(0.5, 0.9);
        let lit = light.shade(&white(DVec3::Z), DVec3::Z, DVec3::Z, |_| false, 1.0);
        let dark = light.shade(&white(DVec3::Z), DVec3::Z, DVec3::Z, |_| true, 1.0);
        // A level white surface under the open sky: albedo times the sky's radiance.
        assert_eq!(dark, [0.155, 0.185, 0.228].map(|sky| 0.8 * sky));
        assert!(lit.iter().zip(dark).all(|(l, d)| *l > 1.5 * d));
        // Shadows are blue, the sun is warm.
        assert!(dark[2] > dark[0] && lit[0] > lit[2]);
        let closed = light.shade(&white(DVec3::Z), DVec3::Z, DVec3::Z, |_| true, 0.0);
        assert_eq!(closed, [0.0; 3]);
    }

    #[test]
    fn a_wide_lamp_has_a_half_shadow() {
        let lamp = Lamp {
            direction: DVec3::Z,
            colour: [1.0; 3],
            radius: 0.2,
            rays: 4,
        };
        let n = 2000;
        let seen = (0..n).map(|i| lamp.seen(DVec3::Z, i, |d| d.x > 0.0));
        let mean = seen.sum::<f64>() / n as f64;
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
    }
}
