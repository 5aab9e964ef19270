//! Floors: sand and dust with pebbles pressed into them, or concrete.

use glam::DVec3;

use super::{Appearance, Spot, between, bumped, mix, octaves, visible};
use crate::noise::{cells, fbm, hash, ridged, smoothstep, unit};
use crate::random::Random;

/// A kind of floor. Lengths that grow with the stones are given over [`Spot::size`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ground {
    salt: u64,
    dark: [f64; 3],
    light: [f64; 3],
    /// Slope of the unevenness.
    rough: f64,
    /// How much grains of sand differ.
    speckle: f64,
    /// The part of the three sizes' cells that hold a pebble.
    pebbles: f64,
    /// The part of the floor along which hairline cracks run, 0 or more.
    cracked: f64,
}

pub(super) const FINES: Ground = Ground {
    salt: 0x6669,
    dark: [0.125, 0.112, 0.096],
    light: [0.345, 0.310, 0.262],
    rough: 0.42,
    speckle: 0.5,
    pebbles: 0.72,
    cracked: 0.0,
};

pub(super) const CONCRETE: Ground = Ground {
    salt: 0x636f,
    dark: [0.270, 0.268, 0.260],
    light: [0.420, 0.415, 0.400],
    rough: 0.05,
    speckle: 0.16,
    pebbles: 0.03,
    cracked: 1.0,
};

pub(super) const QUARRY: Ground = Ground {
    salt: 0x7175,
    dark: [0.190, 0.165, 0.135],
    light: [0.390, 0.345, 0.285],
    rough: 0.30,
    speckle: 0.34,
    pebbles: 0.40,
    cracked: 0.0,
};

/// Diameters of the pebbles' cells over the size of the stones, and their share of the slots.
const PEBBLES: [(f64, f64); 3] = [(0.34, 0.45), (0.14, 0.8), (0.06, 1.0)];

impl Ground {
    /// Any fines: sand, mud, dust, from a dark to a pale colour.
    pub(super) fn random([dark, light]: [[f64; 3]; 2], random: &mut Random) -> Self {
        Self {
            salt: random.bits() & 0xffff,
            dark,
            light,
            rough: random.range(0.05, 0.8),
            speckle: random.range(0.05, 0.8),
            pebbles: random.range(0.0, 0.9),
            cracked: 0.0,
        }
    }

    pub(super) fn surface(&self, spot: &Spot) -> Appearance {
        let seed = hash(spot.fragment ^ (self.salt << 48));
        let size = spot.size.max(1e-6);
        let at = spot.point / size;
        let pixel = spot.pixel / size;

        // Wet and dry, trodden and loose: patches far larger than a stone.
        let (patch, _) = fbm(at * 0.22, seed, 4.0, 0.55);
        let fine = octaves(0.7, pixel).clamp(1.0, 7.0);
        let (height, slope) = fbm(at * 1.4, seed ^ 1, fine, 0.6);
        let mut colour = mix(
            self.dark,
            self.light,
            (0.5 + 1.1 * patch + 0.35 * height).clamp(0.0, 1.0),
        );
        let mut normal = bumped(spot.normal, slope * (self.rough / 1.4));
        let mut openness = 1.0 - 0.5 * self.rough * smoothstep(0.0, -0.7, height);

        // Grains of sand, down to the pixel.
        let (sand, tilt) = fbm(
            at * 22.0,
            seed ^ 2,
            octaves(1.0 / 22.0, pixel).min(4.0),
            0.8,
        );
        colour = colour.map(|part| part * (1.0 + self.speckle * sand));
        normal = bumped(normal, tilt * (self.rough * 0.028));

        for ((diameter, share), layer) in PEBBLES.into_iter().zip(3..) {
            let shown = visible(diameter * 0.5, pixel);
            if shown <= 0.0 {
                continue;
            }
            let warp = slope * (0.03 * diameter);
            let cell = cells((at + warp) / diameter, seed ^ layer);
            if unit(cell.id, 1) >= self.pebbles * share {
                continue;
            }
            // An angular pebble: the largest of a few slanted distances, not a sphere.
            let radius = between(0.22, 0.46, cell.id, 2);
            let (bevel, far) = corner(cell.offset, cell.id);
            let rim = far / radius;
            if rim < 1.0 {
                let tint = mix(
                    mix(self.light, [0.30, 0.295, 0.285], 0.55),
                    mix(self.dark, [0.16, 0.16, 0.16], 0.5),
                    unit(cell.id, 3),
                );
                let light = between(0.75, 1.45, cell.id, 4) * (1.0 + 0.35 * sand + 0.3 * height);
                let dusty = mix(tint.map(|part| part * light), colour, 0.25);
                let cover = shown * smoothstep(1.0, 0.9, rim);
                colour = mix(colour, dusty, cover);
                let dome = smoothstep(0.25, 0.75, rim);
                let slanted = (spot.normal + bevel * (0.12 + 0.75 * dome)).normalize_or(normal);
                normal = normal
                    .lerp(bumped(slanted, slope * 0.12), cover)
                    .normalize_or(normal);
                openness = openness + (1.0 - openness) * cover;
            } else {
                // The gap beside it, where the sky is half hidden.
                openness *= 1.0 - 0.55 * shown * smoothstep(1.45, 1.0, rim);
            }
        }

        if self.cracked > 0.0 {
            let near = ridged(at * 0.35, seed ^ 9, 3.0);
            let width = 0.012 * self.cracked;
            let crack = smoothstep(1.0 - width, 1.0 - 0.4 * width, near);
            openness *= 1.0 - 0.6 * crack;
            colour = colour.map(|part| part * (1.0 - 0.35 * crack));
        }
        Appearance {
            albedo: colour,
            normal,
            sheen: 0.0,
            openness: openness.clamp(0.0, 1.0),
        }
    }
}

/// How far out of a polyhedron around 0 an offset lies, and the direction of the face there.
fn corner(offset: DVec3, id: u64) -> (DVec3, f64) {
    let spin = DVec3::new(unit(id, 5), unit(id, 6), unit(id, 7)) * 2.0 - 1.0;
    let mut best = (DVec3::ZERO, 0.0);
    for face in FACES {
        // Seven fixed faces, each pushed by the pebble's own draw.
        let face = (face + 0.55 * spin * (1.0 + face.x)).normalize_or(DVec3::X);
        let out = face.dot(offset);
        if out > best.1 {
            best = (face, out);
        }
    }
    best
}

const FACES: [DVec3; 7] = [
    DVec3::new(1.0, 0.1, 0.2),
    DVec3::new(0.5, 0.85, -0.1),
    DVec3::new(-0.4, 0.9, 0.15),
    DVec3::new(-0.95, 0.1, -0.2),
    DVec3::new(-0.45, -0.85, 0.1),
    DVec3::new(0.55, -0.8, 0.1),
    DVec3::new(0.1, 0.0, 1.0),
];
