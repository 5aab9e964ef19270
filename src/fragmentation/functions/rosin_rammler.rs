//! The Rosin-Rammler distribution of fragment sizes, as it is used for blasted rock.
//!
//! Rosin & Rammler, "The laws governing the fineness of powdered coal", Journal of the Institute of
//! Fuel 7 (1933) 29-36; with the median as its size, as in Cunningham's Kuz-Ram model (1983):
//!
//! ```text
//! P(x) = 1 - exp(-ln 2 (x / x50)^n)
//! ```
//!
//! P is the share of the mass that passes a sieve of opening x. There is no largest size. Sizes go in
//! and come out in the unit of x50. It is Weibull's distribution of the scale x50 / (ln 2)^(1/n), the
//! characteristic size, which 63.2 % passes.

use std::f64::consts::LN_2;

/// The Rosin-Rammler distribution with a median size and a uniformity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RosinRammler {
    x50: f64,
    n: f64,
}

/// Parameters that make no Rosin-Rammler distribution.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum RosinRammlerError {
    /// The median is not a positive number.
    #[error("x50 = {0}; the median size must be a number above 0")]
    Median(f64),
    /// The uniformity index is not a positive number.
    #[error("n = {0}; the uniformity must be a number above 0 (0.7 to 2 for most blasts)")]
    Uniformity(f64),
}

impl RosinRammler {
    /// A distribution with median size `x50` and uniformity `n`.
    ///
    /// # Errors
    ///
    /// Unless x50 > 0 and n > 0, both finite.
    pub fn new(x50: f64, n: f64) -> Result<Self, RosinRammlerError> {
        if !(x50.is_finite() && x50 > 0.0) {
            return Err(RosinRammlerError::Median(x50));
        }
        if !(n.is_finite() && n > 0.0) {
            return Err(RosinRammlerError::Uniformity(n));
        }
        Ok(Self { x50, n })
    }

    /// The median size: half of the mass passes it.
    pub fn x50(&self) -> f64 {
        self.x50
    }

    /// The uniformity n, without unit.
    pub fn n(&self) -> f64 {
        self.n
    }

    /// P(x), 0 to 1: the share of the mass that passes a sieve of opening `x` (unit of x50). 0 for
    /// x <= 0; NaN stays NaN.
    pub fn passing(&self, x: f64) -> f64 {
        if x <= 0.0 {
            return 0.0;
        }
        if x == self.x50 {
            return 0.5;
        }
        // exp_m1 keeps the digits of the fines.
        -(-LN_2 * (x / self.x50).powf(self.n)).exp_m1()
    }

    /// The size that the share `p` of the mass passes (unit of x50), the inverse of `passing`:
    /// x = x50 (-ln(1 - p) / ln 2)^(1 / n). 0 for p <= 0, infinite for p >= 1; NaN stays NaN.
    pub fn size_at(&self, p: f64) -> f64 {
        if p <= 0.0 {
            return 0.0;
        }
        if p >= 1.0 {
            return f64::INFINITY;
        }
        if p == 0.5 {
            return self.x50;
        }
        self.x50 * (-(-p).ln_1p() / LN_2).powf(1.0 / self.n)
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// With n = 1 every x50 halves what is left: 1/2, 3/4, 7/8. With n = 2 at twice the median a
    /// sixteenth is left. At the characteristic size x50 / (ln 2)^(1/n) 1 - 1/e passes.
    #[test]
    fn closed_forms() {
        let plain = RosinRammler::new(10.0, 1.0).expect("a curve");
        for (x, passing) in [(10.0, 0.5), (20.0, 0.75), (30.0, 0.875)] {
            assert!((plain.passing(x) - passing).abs() < 1e-15);
            assert!((plain.size_at(passing) - x).abs() < 1e-13);
        }
        let steep = RosinRammler::new(10.0, 2.0).expect("a curve");
        assert!((steep.passing(20.0) - 15.0 / 16.0).abs() < 1e-15);
        let characteristic = 10.0 / LN_2.sqrt();
        let share = 1.0 - (-1f64).exp();
        assert!((steep.passing(characteristic) - share).abs() < 1e-15);
        assert!((steep.size_at(share) - characteristic).abs() < 1e-13);
    }

    #[test]
    fn ends() {
        let curve = RosinRammler::new(10.0, 1.2).expect("a curve");
        assert_eq!(curve.passing(-1.0), 0.0);
        assert_eq!(curve.passing(0.0), 0.0);
        assert_eq!(curve.passing(f64::INFINITY), 1.0);
        assert_eq!(curve.size_at(0.0), 0.0);
        assert_eq!(curve.size_at(1.0), f64::INFINITY);
        assert!(curve.passing(f64::NAN).is_nan());
        assert!(curve.size_at(f64::NAN).is_nan());
    }

    #[test]
    fn refuses() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let median = RosinRammler::new(bad, 1.0).expect_err("x50");
            assert!(matches!(median, RosinRammlerError::Median(_)));
            let uniformity = RosinRammler::new(1.0, bad).expect_err("n");
            assert!(matches!(uniformity, RosinRammlerError::Uniformity(_)));
        }
    }

    proptest! {
        #[test]
        fn share_to_size_and_back(x50 in 1e-3..1e3f64, n in 0.3..6.0f64, p in 1e-6..0.9999f64) {
            let curve = RosinRammler::new(x50, n).expect("a curve");
            prop_assert!((curve.passing(curve.size_at(p)) - p).abs() < 1e-13);
            prop_assert_eq!(curve.passing(x50), 0.5);
        }
    }
}
