//! Random numbers that stay the same for ever.
//!
//! xoshiro256++ 1.0 seeded by SplitMix64, both by Blackman & Vigna, "Scrambled linear pseudorandom
//! number generators", ACM Trans. Math. Softw. 47 (2021) 36, <https://prng.di.unimi.it>. Written
//! out here, because a crate may change its stream with a release, and a sample would change with
//! it. `uniform`, `range`, `direction` and `rotation` use only operations that IEEE 754 rounds
//! exactly, so they give the same bits on every machine; `normal` asks the machine's logarithm,
//! whose last bit may differ.

use fragscale_core::split_mix::{SplitMix, spread};
use glam::{DQuat, DVec3, DVec4};

/// A stream of random numbers, fixed by its seed.
#[derive(Debug, Clone)]
pub struct Random {
    state: [u64; 4],
    /// What the streams forked from here start from: the seed, however many numbers were drawn.
    key: u64,
}

impl Random {
    /// The stream of a seed.
    pub fn new(seed: u64) -> Self {
        // SplitMix64 never gives four zeros in a row, the one state that xoshiro cannot leave.
        let nth = |n: u64| spread(seed.wrapping_add(SplitMix::GOLDEN.wrapping_mul(n)));
        Self {
            state: [nth(1), nth(2), nth(3), nth(4)],
            key: seed,
        }
    }

    /// An independent stream for the thing numbered `id`: the same for one seed and one id, however
    /// many numbers were drawn here before.
    pub fn fork(&self, id: u64) -> Self {
        // Two rounds, so that neither (seed, id + 1) nor (seed + 1, id) repeats a stream.
        Self::new(spread(
            spread(self.key ^ SplitMix::GOLDEN)
                .wrapping_add(spread(id.wrapping_add(SplitMix::GOLDEN))),
        ))
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        let [s0, s1, s2, s3] = self.state;
        let result = s0.wrapping_add(s3).rotate_left(23).wrapping_add(s0);
        let (s2, s3) = (s2 ^ s0, s3 ^ s1);
        self.state = [s0 ^ s3, s1 ^ s2, s2 ^ (s1 << 17), s3.rotate_left(45)];
        result
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (0.5 / (1u64 << 52) as f64)
    }

    /// Uniform from `low` on to `high`, which rounding may reach.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Normal with mean 0 and variance 1, by Marsaglia's polar method (Marsaglia & Bray, SIAM
    /// Review 6 (1964) 260); the second number of each pair is dropped.
    pub fn normal(&mut self) -> f64 {
        let (x, _, s) = self.in_disc();
        x * (-2.0 * s.ln() / s).sqrt()
    }

    /// A unit vector, uniform over the sphere (Marsaglia, Ann. Math. Stat. 43 (1972) 645).
    pub fn direction(&mut self) -> DVec3 {
        let (x, y, s) = self.in_disc();
        let root = 2.0 * (1.0 - s).sqrt();
        DVec3::new(x * root, y * root, 1.0 - 2.0 * s).normalize()
    }

    /// A rotation, uniform over all rotations: a point on the unit 3-sphere, as in Marsaglia 1972.
    pub fn rotation(&mut self) -> DQuat {
        let (x, y, s) = self.in_disc();
        let (z, w, t) = self.in_disc();
        let root = ((1.0 - s) / t).sqrt();
        DQuat::from_vec4(DVec4::new(x, y, z * root, w * root).normalize())
    }

    /// A point of the open unit disc other than its centre, and its squared radius.
    fn in_disc(&mut self) -> (f64, f64, f64) {
        loop {
            let (x, y) = (self.range(-1.0, 1.0), self.range(-1.0, 1.0));
            let s = x * x + y * y;
            if s > 0.0 && s < 1.0 {
                return (x, y, s);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first outputs of SplitMix64 for the seed 1234567, as published with the reference code.
    #[test]
    fn seeds_by_splitspread() {
        assert_eq!(
            Random::new(1_234_567).state,
            [
                6_457_827_717_110_365_317,
                3_203_168_211_198_807_973,
                9_817_491_932_198_370_423,
                4_593_380_528_125_082_431,
            ]
        );
    }

    /// The reference C code of xoshiro256++ from the state 1, 2, 3, 4 (also rand_xoshiro's test).
    #[test]
    fn draws_by_xoshiro() {
        let mut random = Random::new(0);
        random.state = [1, 2, 3, 4];
        let expected: [u64; 10] = [
            41_943_041,
            58_720_359,
            3_588_806_011_781_223,
            3_591_011_842_654_386,
            9_228_616_714_210_784_205,
            9_973_669_472_204_895_162,
            14_011_001_112_246_962_877,
            12_406_186_145_184_390_807,
            15_849_039_046_786_891_736,
            10_450_023_813_501_588_000,
        ];
        for bits in expected {
            assert_eq!(random.bits(), bits);
        }
    }

    #[test]
    fn forks_do_not_depend_on_what_was_drawn() {
        let mut random = Random::new(7);
        let mut before = random.fork(3);
        random.bits();
        let (mut after, mut other) = (random.fork(3), random.fork(4));
        let first = before.bits();
        assert_eq!(first, after.bits());
        assert_ne!(first, other.bits());
        assert_ne!(first, Random::new(7).bits());
        assert_ne!(Random::new(8).fork(3).bits(), first);
    }

    /// Means of 100 000 draws, each within 5 of its standard errors (at most 1 / sqrt(100 000)).
    #[test]
    fn moments() {
        const DRAWS: usize = 100_000;
        let mut random = Random::new(1);
        let limit = 5.0 / (DRAWS as f64).sqrt();
        let (mut uniform, mut normal, mut square) = (0.0, 0.0, 0.0);
        let (mut direction, mut cosines, mut turned) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for _ in 0..DRAWS {
            let u = random.uniform();
            assert!((0.0..1.0).contains(&u));
            uniform += u;
            let n = random.normal();
            normal += n;
            square += n * n;
            let d = random.direction();
            assert!((d.length() - 1.0).abs() < 1e-15);
            direction += d;
            cosines += d * d;
            let rotation = random.rotation();
            assert!(rotation.is_normalized());
            turned += rotation * DVec3::X;
        }
        let mean = |sum: f64| sum / DRAWS as f64;
        assert!((mean(uniform) - 0.5).abs() < limit);
        assert!(mean(normal).abs() < limit);
        // The variance of a square of a normal is 2.
        assert!((mean(square) - 1.0).abs() < limit * 2f64.sqrt());
        for axis in 0..3 {
            assert!(mean(direction[axis]).abs() < limit);
            assert!((mean(cosines[axis]) - 1.0 / 3.0).abs() < limit);
            assert!(mean(turned[axis]).abs() < limit);
        }
    }
}
