//! Broken rock: facets that chipped, grains, veins, iron on old joints, worn edges, dust.

use glam::DVec3;

use super::{Appearance, Spot, any_tint, between, bumped, mix, octaves, visible};
use crate::noise::{cells, direction, fbm, gradient_noise, hash, jitter, smoothstep, unit};
use crate::random::Random;

/// A kind of rock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rock {
    /// Tells this rock's draws from another's.
    salt: u64,
    /// A stone's tint lies between two neighbours of these (linear RGB).
    tints: [[f64; 3]; 6],
    /// Brightness differs from stone to stone by this much (natural logarithm, both ways).
    spread: f64,
    /// Slope of the relief, from stone-sized waves to the finest.
    rough: f64,
    /// Diameter of the mineral grains, metres, smallest and largest.
    grain: [f64; 2],
    /// How much grains differ.
    speckle: f64,
    /// The part of stones with a vein.
    veined: f64,
    /// How much iron there is on old joints, 0..=1.
    stain: f64,
    /// How much dust lies on what looks up, 0..=1.
    dust: f64,
    dust_tint: [f64; 3],
    /// Radius of a worn edge over the stone's diameter.
    worn: f64,
    /// How wet it is, 0..=1: darker, and it shines.
    wet: f64,
}

pub(super) const GRAVEL: Rock = Rock {
    salt: 0x6772,
    tints: [
        [0.150, 0.152, 0.158],
        [0.270, 0.268, 0.262],
        [0.400, 0.385, 0.350],
        [0.330, 0.285, 0.245],
        [0.235, 0.225, 0.215],
        [0.450, 0.440, 0.420],
    ],
    spread: 0.40,
    rough: 0.42,
    grain: [0.0008, 0.0030],
    speckle: 0.55,
    veined: 0.16,
    stain: 0.22,
    dust: 0.18,
    dust_tint: [0.43, 0.41, 0.37],
    worn: 0.030,
    wet: 0.0,
};

pub(super) const BLASTED: Rock = Rock {
    salt: 0x626c,
    tints: [
        [0.175, 0.170, 0.165],
        [0.250, 0.238, 0.222],
        [0.300, 0.265, 0.225],
        [0.225, 0.215, 0.205],
        [0.270, 0.228, 0.185],
        [0.330, 0.315, 0.290],
    ],
    spread: 0.24,
    rough: 0.44,
    grain: [0.003, 0.010],
    speckle: 0.38,
    veined: 0.22,
    stain: 0.85,
    dust: 0.50,
    dust_tint: [0.355, 0.325, 0.285],
    worn: 0.018,
    wet: 0.0,
};

pub(super) const STOCKPILE: Rock = Rock {
    salt: 0x7370,
    tints: [
        [0.205, 0.208, 0.210],
        [0.260, 0.258, 0.250],
        [0.305, 0.298, 0.280],
        [0.240, 0.235, 0.228],
        [0.285, 0.265, 0.238],
        [0.225, 0.222, 0.222],
    ],
    spread: 0.20,
    rough: 0.38,
    grain: [0.001, 0.004],
    speckle: 0.42,
    veined: 0.12,
    stain: 0.30,
    dust: 0.36,
    dust_tint: [0.39, 0.37, 0.33],
    worn: 0.035,
    wet: 0.0,
};

const IRON: [f64; 3] = [0.245, 0.128, 0.058];

impl Rock {
    /// Any rock, from pale to nearly black, grey to red, fresh to dusty, dry to wet, angular to worn, with stones as
    /// large as `size`, of a dark and a pale colour.
    pub(super) fn random(size: f64, [hue, pale]: [[f64; 3]; 2], random: &mut Random) -> Self {
        let other = any_tint(random);
        // Of one quarry, or of a river that brings many.
        let variety = random.uniform().powi(2);
        let tint = |random: &mut Random| {
            let own = mix(hue, other[0], variety * random.uniform());
            let bright = random.range(-0.35, 0.35).exp();
            own.map(|part| part * bright * random.range(0.93, 1.07))
        };
        let grain = size * 10f64.powf(random.range(-2.3, -1.2));
        Self {
            salt: random.bits() & 0xffff,
            tints: std::array::from_fn(|_| tint(random)),
            spread: random.range(0.05, 0.6),
            rough: random.range(0.05, 0.75),
            grain: [grain * 0.4, grain],
            speckle: random.range(0.05, 0.9),
            veined: random.range(0.0, 0.5),
            stain: random.uniform().powi(2),
            dust: random.range(0.0, 0.9),
            dust_tint: mix(pale, other[1], 0.3 * random.uniform()),
            worn: 10f64.powf(random.range(-2.0, -0.8)),
            wet: (random.range(-1.5, 1.0)).max(0.0),
        }
    }

    pub(super) fn surface(&self, spot: &Spot) -> Appearance {
        let seed = hash(spot.fragment ^ (self.salt << 48));
        let size = spot.size.max(1e-6);
        // Bedding: blotches are drawn out along one plane of the stone.
        let bed = direction(seed, 1);
        let own = spot.point / size;
        let bedded = own + bed * (bed.dot(own) * between(0.2, 2.2, seed, 2));

        // The relief, from a third of the stone down to the pixel. Its slope matters, not its height.
        let fine = octaves(size / 2.6, spot.pixel).clamp(1.0, 6.5);
        let (height, slope) = fbm(own * 2.6, seed, fine, 0.52);
        let (patch, _) = fbm(bedded * 2.1, seed ^ 0x22, 3.0, 0.55);
        let (joint, _) = gradient_noise(spot.normal * 1.7 + 0.37, seed ^ 0x33);
        // Faces broke apart in their own ways: smooth along a joint, rough across the grain.
        let uneven = (1.0 + 0.9 * joint + 0.7 * patch).clamp(0.4, 1.4);
        let rough = self.rough * between(0.7, 1.35, seed, 3) * uneven;

        // Chips: small faces that broke a little askew, and smaller ones on them. Their borders
        // follow the relief.
        let (mut askew, mut border) = (DVec3::ZERO, 1.0_f64);
        let coarse = between(2.6, 4.6, seed, 4);
        for (often, steep, layer) in [(coarse, 0.42, 0x11), (3.3 * coarse, 0.34, 0x12)] {
            let shown = visible(0.5 * size / often, spot.pixel);
            if shown > 0.0 {
                let chip = cells(own * often + slope * 0.09, seed ^ layer);
                let inside = smoothstep(0.0, 0.10, chip.second - chip.nearest);
                let tilt = steep * between(0.25, 1.0, seed, 5) * unit(chip.id, 2);
                askew += jitter(chip.id) * (tilt * inside * shown);
                border *= 1.0 - 0.5 * shown * (1.0 - inside);
            }
        }

        // The worn edge, uneven because the relief eats into it.
        let radius = self.worn * between(0.6, 1.7, seed, 6) * size;
        let (mut normal, mut edge) = (spot.normal, 0.0);
        if let Some(other) = spot.edge {
            let near = other.distance / radius + 0.9 * height;
            edge = 1.0 - smoothstep(0.0, 1.0, near);
            normal = normal.lerp(other.normal, 0.5 * edge).normalize_or(normal);
        }
        let normal = bumped(normal, slope * (rough / 2.6) * 1.15 + askew);

        let (mut colour, sheen) = self.mineral(spot, seed, bedded, height);

        // Old joints, face by face, carry iron; it creeps in from their edges.
        let rust = self.stain
            * smoothstep(
                -0.05,
                0.55,
                joint * 1.3 + patch * 1.1 - 0.22 + unit(seed, 7) * 0.5,
            );
        let iron = mix(IRON, [0.36, 0.25, 0.14], unit(seed, 8));
        colour = mix(colour, iron, rust * 0.85);
        let shade = (1.0 + 0.32 * patch) * (1.0 + 0.30 * height) * (1.0 + 0.22 * joint);
        colour = colour.map(|part| part * shade);

        // Worn edges show bruised, lighter mineral.
        let bruise = edge * smoothstep(-0.35, 0.3, patch + height);
        colour = mix(colour, colour.map(|part| part * 1.25 + 0.05), 0.7 * bruise);

        // Dust stays where the relief is level, in patches, and least on the bruised edge.
        let level = smoothstep(0.35, 0.97, normal.dot(spot.up) + 0.25 * patch);
        let dust = (self.dust * level * (0.75 + 0.7 * patch - 0.45 * height) * (1.0 - 0.5 * edge))
            .clamp(0.0, 0.9);
        colour = mix(colour, self.dust_tint, dust * between(0.6, 1.0, seed, 9));

        let pits = smoothstep(-0.10, -0.55, height - 0.2 * (1.0 - border));
        // Water fills the pores: less comes back (Twomey et al. 1986), and the film itself is a mirror.
        colour = colour.map(|part| part * (1.0 - 0.45 * self.wet));
        Appearance {
            albedo: colour,
            normal,
            sheen: sheen * (1.0 - dust) * (1.0 - rust) + 7.0 * self.wet,
            openness: 1.0 - 0.45 * pits,
        }
    }

    /// The fresh rock: the stone's own tint, its grains and its veins.
    fn mineral(&self, spot: &Spot, seed: u64, bedded: DVec3, height: f64) -> ([f64; 3], f64) {
        let pick = unit(seed, 20) * 5.0;
        let at = pick.floor();
        let pair = self
            .tints
            .windows(2)
            .zip(0..)
            .find(|(_, i)| f64::from(*i) == at);
        let tint = match pair {
            Some(([a, b], _)) => mix(*a, *b, pick - at),
            _ => [0.3; 3],
        };
        let brightness = (self.spread * (2.0 * unit(seed, 21) - 1.0)).exp();
        let mut colour = tint.map(|part| part * brightness);
        let mut sheen = between(0.0, 0.6, seed, 22);

        // Grains: light feldspar, grey quartz, dark mica. Finer than a pixel, they melt together.
        let draw = unit(seed, 23);
        let [smallest, largest] = self.grain;
        let grain = smallest + (largest - smallest) * draw * draw;
        let shown = visible(grain, spot.pixel);
        let speckle = self.speckle * between(0.15, 1.0, seed, 24);
        if shown > 0.0 {
            // Drawn out along the bedding and ragged: grains are no dots.
            let at = bedded * spot.size / grain + DVec3::splat(1.4 * height);
            let cell = cells(at, seed ^ 0x44);
            let kind = unit(cell.id, 1);
            let light = between(0.7, 1.3, cell.id, 2);
            let factor = if kind < 0.16 {
                [0.35; 3]
            } else if kind < 0.5 {
                [1.22 * light, 1.17 * light, 1.12 * light]
            } else {
                [light; 3]
            };
            let shown = speckle * shown;
            colour = times(colour, mix([1.0; 3], factor, shown));
            sheen *= 1.0 + shown * (4.0 * unit(cell.id, 3) - 1.0);
        }
        // What is left of the grains in a pixel: a mottle of clusters.
        let (mottle, _) = fbm(
            bedded * 11.0,
            seed ^ 0x55,
            octaves(spot.size / 11.0, spot.pixel).min(4.0),
            0.75,
        );
        let mottled = 1.0 + 0.95 * speckle * mottle;
        colour = colour.map(|part| part * mottled);

        // A vein is where a slow noise passes zero: calcite, or a dark seam.
        if unit(seed, 25) < self.veined {
            let (sheet, _) = gradient_noise(
                bedded * between(1.0, 2.4, seed, 26) + 0.05 * mottle,
                seed ^ 0x66,
            );
            let width = between(0.012, 0.05, seed, 27) * (1.0 + 1.5 * height);
            let vein = 1.0 - smoothstep(0.4 * width, width, sheet.abs());
            let filling = if unit(seed, 28) < 0.7 {
                [0.56, 0.53, 0.49]
            } else {
                [0.07, 0.068, 0.066]
            };
            colour = mix(colour, filling, 0.75 * vein);
        }
        (colour, sheen.max(0.0))
    }
}

fn times(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    let ([a0, a1, a2], [b0, b1, b2]) = (a, b);
    [a0 * b0, a1 * b1, a2 * b2]
}
