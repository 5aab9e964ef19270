//! What things are made of: colour and fine relief of a point on a stone, a floor or a ball.

mod ground;
mod rock;

use glam::{DQuat, DVec3};

use crate::noise::{fbm, unit};
use crate::random::Random;
use ground::Ground;
use rock::Rock;

/// The point that a ray met, in the frame of the body it lies on, so that a texture sticks to its
/// stone. Lengths in metres, directions of length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot {
    /// Which body: every one has its own tint, grain, veins and stains.
    pub fragment: u64,
    /// The point itself.
    pub point: DVec3,
    /// The outward normal of the face it lies on.
    pub normal: DVec3,
    /// The world's up.
    pub up: DVec3,
    /// The body's diameter; for a floor, the diameter of the stones that its fines came from.
    pub size: f64,
    /// How much of the surface one pixel covers: finer texture than that is left out.
    pub pixel: f64,
    /// The nearest edge of the face.
    pub edge: Option<Edge>,
}

/// The nearest edge: broken rock is rounded and lighter there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    /// How far it is, in metres; the distance to the other face's plane serves as well.
    pub distance: f64,
    /// The outward normal of the face on its other side.
    pub normal: DVec3,
}

/// What light meets at a spot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Appearance {
    /// The diffuse albedo, linear RGB, each within 0.02..=0.9.
    pub albedo: [f64; 3],
    /// The normal with the fine relief, length 1, in the frame of the [`Spot`].
    pub normal: DVec3,
    /// The strength of the faint highlight of fresh mineral faces: 0 is matte, 1 is wet.
    pub sheen: f64,
    /// How much of the sky the fine relief leaves open, 0..=1: dark in pits and cracks.
    pub openness: f64,
}

impl Appearance {
    /// The same in the world's frame, for [`Light::shade`](crate::scene::light::Light::shade).
    #[must_use]
    pub(super) fn turned(self, world_from_body: DQuat) -> Self {
        Self {
            normal: world_from_body * self.normal,
            ..self
        }
    }
}

/// What a body is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Material(Kind);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Rock(Rock),
    Ground(Ground),
    Paint([f64; 3]),
}

impl Material {
    /// The lab's stones: crushed granite and limestone, washed.
    #[must_use]
    pub(super) const fn gravel() -> Self {
        Self(Kind::Rock(rock::GRAVEL))
    }

    /// A pile after the blast: grey to brownish, iron on old joints, dust on top.
    #[must_use]
    pub(super) const fn blasted_rock() -> Self {
        Self(Kind::Rock(rock::BLASTED))
    }

    /// A stockpile: one quarry's rock, moved and rained on, less dust, rounder edges.
    #[must_use]
    pub(super) const fn stockpile() -> Self {
        Self(Kind::Rock(rock::STOCKPILE))
    }

    /// The fines between the stones: sand and dust with small pebbles in it.
    #[must_use]
    pub(super) const fn fines() -> Self {
        Self(Kind::Ground(ground::FINES))
    }

    /// The lab's floor.
    #[must_use]
    pub(super) const fn concrete_floor() -> Self {
        Self(Kind::Ground(ground::CONCRETE))
    }

    /// A quarry's floor: driven over, pale, gritty.
    #[must_use]
    pub(super) const fn quarry_floor() -> Self {
        Self(Kind::Ground(ground::QUARRY))
    }

    /// The matte red ball that people put on a pile for scale.
    #[must_use]
    pub(super) const fn painted_sphere() -> Self {
        Self(Kind::Paint([0.52, 0.045, 0.035]))
    }

    /// Any rock, of stones as large as `size`, metres, and fines: mostly those of the same rock, now and then others.
    #[must_use]
    pub(super) fn any(size: f64, random: &mut Random) -> [Self; 2] {
        let tints = any_tint(random);
        let rock = Rock::random(size, tints, random);
        let tints = if random.uniform() < 0.6 {
            let bright = random.range(-0.5, 0.6).exp();
            tints.map(|tint| tint.map(|part| part * bright))
        } else {
            any_tint(random)
        };
        let fines = Ground::random(tints, random);
        [Self(Kind::Rock(rock)), Self(Kind::Ground(fines))]
    }

    /// What the material looks like at `spot`. A function of its arguments and nothing else.
    #[must_use]
    pub(super) fn surface(&self, spot: &Spot) -> Appearance {
        let seen = match &self.0 {
            Kind::Rock(rock) => rock.surface(spot),
            Kind::Ground(ground) => ground.surface(spot),
            Kind::Paint(colour) => paint(*colour, spot),
        };
        Appearance {
            albedo: seen.albedo.map(|part| part.clamp(0.02, 0.9)),
            ..seen
        }
    }
}

/// Matte paint: barely uneven, dusty on top.
fn paint(colour: [f64; 3], spot: &Spot) -> Appearance {
    let size = spot.size.max(1e-6);
    let (uneven, slope) = fbm(
        spot.point * (6.0 / size),
        spot.fragment,
        octaves(size / 6.0, spot.pixel).min(4.0),
        0.5,
    );
    let dust = 0.12 * spot.normal.dot(spot.up).max(0.0) * (1.0 + uneven);
    Appearance {
        albedo: mix(colour, [0.4, 0.36, 0.31], dust.clamp(0.0, 0.3))
            .map(|c| c * (1.0 + 0.1 * uneven)),
        normal: bumped(spot.normal, slope * 0.02),
        sheen: 0.25,
        openness: 1.0,
    }
}

/// How many octaves of a texture whose coarsest wave is `wave` long a pixel can still show.
fn octaves(wave: f64, pixel: f64) -> f64 {
    (wave / pixel.max(1e-6)).log2().max(0.0)
}

/// How much of a texture of the given length is left when a pixel covers `pixel`: 1 when it is
/// three pixels wide, 0 at one half.
fn visible(length: f64, pixel: f64) -> f64 {
    crate::noise::smoothstep(0.5, 3.0, length / pixel.max(1e-9))
}

/// The normal of a relief whose slope (height over length) has this gradient.
fn bumped(normal: DVec3, slope: DVec3) -> DVec3 {
    let along = slope - normal * slope.dot(normal);
    // A relief cannot overhang; beyond about 50 degrees the slope is drawn in.
    let steep = along.length();
    (normal - along / (1.0 + 0.35 * steep)).normalize_or(normal)
}

fn mix(a: [f64; 3], b: [f64; 3], part: f64) -> [f64; 3] {
    let ([a0, a1, a2], [b0, b1, b2]) = (a, b);
    [
        a0 + (b0 - a0) * part,
        a1 + (b1 - a1) * part,
        a2 + (b2 - a2) * part,
    ]
}

/// A dark and a pale colour of one hue that rock has: from grey over brown, yellow and red to green and blue grey.
fn any_tint(random: &mut Random) -> [[f64; 3]; 2] {
    const HUES: [[f64; 3]; 7] = [
        [1.0, 1.0, 1.0],
        [1.0, 0.95, 0.87],
        [1.0, 0.82, 0.60],
        [1.0, 0.66, 0.42],
        [1.0, 0.86, 0.45],
        [0.86, 1.0, 0.88],
        [0.84, 0.92, 1.0],
    ];
    let [one, other] = [(); 2].map(|()| {
        let draw = (random.uniform() * HUES.len() as f64) as usize;
        HUES[draw.min(HUES.len() - 1)]
    });
    let hue = mix(one, other, random.uniform());
    let bright = 10f64.powf(random.range(-1.25, -0.35));
    let dark = hue.map(|part| part * bright);
    let paler = random.range(1.2, 2.6);
    [dark, dark.map(|part| (part * paler).min(0.85))]
}

/// A draw between two numbers.
fn between(low: f64, high: f64, seed: u64, channel: u64) -> f64 {
    low + (high - low) * unit(seed, channel)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::{direction, unit};

    const ALL: [Material; 7] = [
        Material::gravel(),
        Material::blasted_rock(),
        Material::stockpile(),
        Material::fines(),
        Material::concrete_floor(),
        Material::quarry_floor(),
        Material::painted_sphere(),
    ];

    fn spot(i: u64) -> Spot {
        Spot {
            fragment: i % 97,
            point: direction(i, 1) * unit(i, 2),
            normal: direction(i, 3),
            up: direction(i, 4),
            size: 0.02 + unit(i, 5),
            pixel: 0.02 * unit(i, 6),
            edge: (!i.is_multiple_of(3)).then(|| Edge {
                distance: 0.05 * unit(i, 7),
                normal: direction(i, 8),
            }),
        }
    }

    #[test]
    fn albedo_and_normal_keep_their_bounds() {
        for material in ALL {
            for i in 0..4000 {
                let spot = spot(i);
                let seen = material.surface(&spot);
                assert!(seen.albedo.iter().all(|part| (0.02..=0.9).contains(part)));
                assert!((seen.normal.length() - 1.0).abs() < 1e-9);
                assert!((0.0..=1.0).contains(&seen.openness));
                assert!(seen.sheen.is_finite() && seen.sheen >= 0.0);
            }
        }
    }

    #[test]
    fn degenerate_spots_stay_finite() {
        for material in ALL {
            let seen = material.surface(&Spot {
                size: 0.0,
                pixel: 0.0,
                edge: Some(Edge {
                    distance: 0.0,
                    normal: -spot(1).normal,
                }),
                ..spot(1)
            });
            assert!(seen.albedo.iter().all(|part| (0.02..=0.9).contains(part)));
            assert!(seen.normal.is_finite());
        }
    }

    #[test]
    fn the_same_spot_looks_the_same() {
        for material in ALL {
            for i in 0..50 {
                assert_eq!(material.surface(&spot(i)), material.surface(&spot(i)));
            }
        }
    }

    #[test]
    fn stones_differ_in_brightness_as_rock_does() {
        // Means of stones: crushed rock is grey, between 0.1 and 0.5, and no two are alike.
        for material in [
            Material::gravel(),
            Material::blasted_rock(),
            Material::stockpile(),
        ] {
            let means: Vec<f64> = (0..60)
                .map(|fragment| {
                    let greens = (0..200).map(|i| {
                        let at = Spot {
                            fragment,
                            size: 1.0,
                            pixel: 0.002,
                            ..spot(i)
                        };
                        material.surface(&at).albedo[1]
                    });
                    greens.sum::<f64>() / 200.0
                })
                .collect();
            assert!(
                means.iter().all(|mean| (0.08..0.6).contains(mean)),
                "{means:?}"
            );
            let mean = means.iter().sum::<f64>() / 60.0;
            let spread = means.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / 60.0;
            assert!((0.02..0.15).contains(&spread.sqrt()), "{}", spread.sqrt());
        }
    }

    #[test]
    fn dust_lies_on_what_looks_up() {
        let mean = |up: DVec3| {
            let greens = (0..2000).map(|i| {
                let at = Spot {
                    normal: DVec3::Z,
                    up,
                    edge: None,
                    ..spot(i)
                };
                Material::blasted_rock().surface(&at).albedo[1]
            });
            greens.sum::<f64>() / 2000.0
        };
        assert!(mean(DVec3::Z) > mean(-DVec3::Z) + 0.01);
    }

    #[test]
    fn a_far_pixel_sees_a_smoother_stone() {
        let rough = |pixel: f64| {
            let tilts = (0..1000).map(|i| {
                let at = Spot {
                    size: 0.5,
                    pixel,
                    edge: None,
                    ..spot(i)
                };
                Material::gravel().surface(&at).normal.dot(at.normal).acos()
            });
            tilts.sum::<f64>() / 1000.0
        };
        assert!(rough(0.1) < rough(0.001));
    }
}
