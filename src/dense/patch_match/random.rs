//! Random numbers that follow from the pixel and the sweep: the same on every device and in any order.
//!
//! The mixing is Chris Wellons' "lowbias32" (2018), a bijection of 32 bits; `shaders/patch_match.wgsl` has
//! it too.

#[inline(always)]
const fn mix(bits: u32) -> u32 {
    let bits = (bits ^ (bits >> 16)).wrapping_mul(0x7feb_352d);
    let bits = (bits ^ (bits >> 15)).wrapping_mul(0x846c_a68b);
    bits ^ (bits >> 16)
}

/// A sequence for one pixel and purpose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Random(u32);

impl Random {
    #[inline(always)]
    pub(crate) const fn at(x: u32, y: u32, salt: u32) -> Self {
        Self(mix(x ^ mix(y ^ mix(salt))))
    }

    /// The next number in [-1, 1), a multiple of 2^-23.
    #[inline(always)]
    pub(crate) fn signed(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        (mix(self.0) >> 8) as f32 * (1.0 / 8_388_608.0) - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean 0 within five standard errors, all octants of the cube equally often.
    #[test]
    fn spread_evenly() {
        let mut octants = [0_u32; 8];
        let mut sum = 0.0_f64;
        for y in 0..100 {
            for x in 0..100 {
                let mut random = Random::at(x, y, 7);
                let three = [random.signed(), random.signed(), random.signed()];
                sum += f64::from(three[0]);
                let octant = three.iter().fold(0, |o, r| 2 * o + usize::from(*r > 0.0));
                octants[octant] += 1;
            }
        }
        assert!(sum.abs() < 5.0 * (10_000.0_f64 / 3.0).sqrt(), "{sum}");
        for count in octants {
            assert!((1250_i64 - i64::from(count)).abs() < 5 * 35, "{octants:?}");
        }
    }
}
