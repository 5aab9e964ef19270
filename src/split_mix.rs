//! SplitMix64: Steele, Lea & Flood, "Fast splittable pseudorandom number generators" (OOPSLA 2014).
//! For what has to be drawn the same each time: samples of a robust fit, shuffles, seeds. Written out,
//! because a crate may change its stream with a release.

/// A sequence that its seed fixes for ever.
#[derive(Debug, Clone)]
pub struct SplitMix(pub u64);

impl SplitMix {
    /// What the seed grows by: 2^64 over the golden ratio.
    pub const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

    /// The next 64 bits.
    #[expect(
        clippy::should_implement_trait,
        reason = "a sequence without an end is awkward as an iterator"
    )]
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(Self::GOLDEN);
        spread(self.0)
    }

    /// From 0 to below 1, a multiple of 2^-53: all that an `f64` there holds of the next 64 bits.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The output function: a bijection that spreads every bit.
#[must_use]
pub const fn spread(bits: u64) -> u64 {
    let z = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first numbers of Vigna's splitmix64.c for the seed 1234567, as Rosetta Code prints them.
    #[test]
    fn the_published_sequence() {
        let mut sequence = SplitMix(1_234_567);
        let found = std::array::from_fn(|_| sequence.next());
        assert_eq!(
            found,
            [
                6_457_827_717_110_365_317,
                3_203_168_211_198_807_973,
                9_817_491_932_198_370_423,
                4_593_380_528_125_082_431,
                16_408_922_859_458_223_821_u64,
            ]
        );
    }

    /// The first of them over 2^64, to the last of 53 bits; the bits that do not fit are cut off.
    #[test]
    fn units_are_its_upper_bits() {
        let unit = SplitMix(1_234_567).unit();
        assert_eq!(unit, 0.350_079_542_021_408_1);
        let of_two_to_64 = 6_457_827_717_110_365_317.0 / 18_446_744_073_709_551_616.0;
        assert!(unit <= of_two_to_64 && of_two_to_64 - unit < 2.0_f64.powi(-53));
    }
}
