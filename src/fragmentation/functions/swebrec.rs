//! The Swebrec distribution of fragment sizes.
//!
//! Ouchterlony, "The Swebrec function: linking fragmentation by blasting and crushing", Mining
//! Technology (Trans. Inst. Min. Metall. A) 114 (2005) A29-A44:
//!
//! ```text
//! P(x) = 1 / (1 + f(x)^b),    f(x) = ln(xmax / x) / ln(xmax / x50),    0 < x <= xmax
//! ```
//!
//! P is the share of the mass that passes a sieve of opening x. It knows no unit: sizes go in and
//! come out in the unit of xmax and x50.

/// The Swebrec distribution with a largest size, a median size and an undulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swebrec {
    x50: f64,
    xmax: f64,
    b: f64,
    /// ln(xmax / x50), above 0.
    spread: f64,
}

/// Parameters that make no Swebrec distribution.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SwebrecError {
    /// The median is not a positive number.
    #[error("x50 = {0}; the median size must be a number above 0")]
    Median(f64),
    /// The largest size is not above the median.
    #[error("xmax = {xmax} and x50 = {x50}; the largest size must be a number above the median")]
    Largest {
        /// The median size given.
        x50: f64,
        /// The largest size given.
        xmax: f64,
    },
    /// The undulation is not a positive number.
    #[error("b = {0}; the undulation must be a number above 0 (2 to 3 for most blasts)")]
    Undulation(f64),
}

impl Swebrec {
    /// A distribution with median size `x50`, largest size `xmax` (one unit) and undulation `b`.
    ///
    /// # Errors
    ///
    /// Unless 0 < x50 < xmax and b > 0, all finite.
    pub fn new(x50: f64, xmax: f64, b: f64) -> Result<Self, SwebrecError> {
        if !(x50.is_finite() && x50 > 0.0) {
            return Err(SwebrecError::Median(x50));
        }
        let spread = logarithm_of_ratio(xmax, x50);
        if !(xmax.is_finite() && xmax > x50 && spread > 0.0) {
            return Err(SwebrecError::Largest { x50, xmax });
        }
        if !(b.is_finite() && b > 0.0) {
            return Err(SwebrecError::Undulation(b));
        }
        Ok(Self {
            x50,
            xmax,
            b,
            spread,
        })
    }

    /// The median size: half of the mass passes it.
    pub fn x50(&self) -> f64 {
        self.x50
    }

    /// The largest size: everything passes it.
    pub fn xmax(&self) -> f64 {
        self.xmax
    }

    /// The undulation b, without unit.
    pub fn b(&self) -> f64 {
        self.b
    }

    /// P(x), 0 to 1: the share of the mass that passes a sieve of opening `x` (unit of x50). 0 for
    /// x <= 0, 1 for x >= xmax; NaN stays NaN.
    pub fn passing(&self, x: f64) -> f64 {
        if x <= 0.0 {
            return 0.0;
        }
        if x >= self.xmax {
            return 1.0;
        }
        if x == self.x50 {
            // What the formula says exactly, its rounding apart.
            return 0.5;
        }
        1.0 / (1.0 + self.reduced(x).powf(self.b))
    }

    /// The size that the share `p` of the mass passes (unit of x50), the inverse of `passing`:
    /// x = xmax exp(-ln(xmax / x50) (1 / p - 1)^(1 / b)). 0 for p <= 0, xmax for p >= 1; NaN stays
    /// NaN.
    pub fn size_at(&self, p: f64) -> f64 {
        if p <= 0.0 {
            return 0.0;
        }
        if p >= 1.0 {
            return self.xmax;
        }
        if p == 0.5 {
            return self.x50;
        }
        // (1 - p) / p: exact for p near 1, where 1 / p - 1 cancels.
        let reduced = ((1.0 - p) / p).powf(1.0 / self.b);
        self.xmax * (-self.spread * reduced).exp()
    }

    /// dP/dx at `x`, per unit of x50: b f^(b - 1) / (x ln(xmax / x50) (1 + f^b)^2). 0 outside of
    /// (0, xmax). For b < 1 it grows without bound towards xmax; NaN stays NaN.
    pub fn density(&self, x: f64) -> f64 {
        if x <= 0.0 || x >= self.xmax {
            return 0.0;
        }
        let f = self.reduced(x);
        let passing = self.passing(x);
        // f^(b-1) / (1 + f^b)^2 written with P: nothing overflows where f^b does.
        self.b * passing * (1.0 - passing) / (f * x * self.spread)
    }

    /// f(x) = ln(xmax / x) / ln(xmax / x50), for 0 < x < xmax.
    fn reduced(&self, x: f64) -> f64 {
        logarithm_of_ratio(self.xmax, x) / self.spread
    }
}

/// ln(large / small). As a difference of logarithms no ratio overflows; ln_1p keeps neighbours apart.
pub(super) fn logarithm_of_ratio(large: f64, small: f64) -> f64 {
    if large < 2.0 * small {
        ((large - small) / small).ln_1p()
    } else {
        large.ln() - small.ln()
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn near(a: f64, b: f64, relative: f64) -> bool {
        (a - b).abs() <= relative * a.abs().max(b.abs())
    }

    /// xmax / x50 = e and b = 2: at xmax / e^2 f is 2, so P = 1 / 5; at xmax / sqrt(e), 4 / 5.
    #[test]
    fn closed_forms() {
        let e = std::f64::consts::E;
        let curve = Swebrec::new(1.0, e, 2.0).expect("a curve");
        assert_eq!(curve.passing(1.0), 0.5);
        assert!(near(curve.passing(1.0 / e), 0.2, 1e-14));
        assert!(near(curve.passing(e.sqrt()), 0.8, 1e-14));
        assert!(near(curve.size_at(0.2), 1.0 / e, 1e-14));
        assert!(near(curve.size_at(0.8), e.sqrt(), 1e-14));
        // dP/dx at x50 is b / (4 x50 ln(xmax / x50)) = 1 / 2.
        assert!(near(curve.density(1.0), 0.5, 1e-14));
    }

    #[test]
    fn ends() {
        let curve = Swebrec::new(200.0, 800.0, 2.2).expect("a curve");
        assert_eq!(curve.passing(0.0), 0.0);
        assert_eq!(curve.passing(-1.0), 0.0);
        assert_eq!(curve.passing(800.0), 1.0);
        assert_eq!(curve.passing(f64::INFINITY), 1.0);
        assert_eq!(curve.size_at(0.0), 0.0);
        assert_eq!(curve.size_at(1.0), 800.0);
        assert_eq!(curve.size_at(0.5), 200.0);
        assert_eq!(curve.density(0.0), 0.0);
        assert_eq!(curve.density(800.0), 0.0);
        assert!(curve.passing(f64::NAN).is_nan());
        assert!(curve.size_at(f64::NAN).is_nan());
        assert!(curve.density(f64::NAN).is_nan());
    }

    #[test]
    fn refuses() {
        for x50 in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                Swebrec::new(x50, 2.0, 2.0),
                Err(SwebrecError::Median(_))
            ));
        }
        for xmax in [0.5, 1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                Swebrec::new(1.0, xmax, 2.0),
                Err(SwebrecError::Largest { .. })
            ));
        }
        for b in [0.0, -2.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                Swebrec::new(1.0, 2.0, b),
                Err(SwebrecError::Undulation(_))
            ));
        }
    }

    proptest! {
        #[test]
        fn the_median_is_exact(x50 in 1e-3..1e3f64, ratio in 1.01..100.0f64, b in 0.5..6.0f64) {
            let curve = Swebrec::new(x50, x50 * ratio, b).expect("a curve");
            prop_assert_eq!(curve.passing(x50), 0.5);
            prop_assert_eq!(curve.size_at(0.5), x50);
        }

        /// Near xmax P is 1 - f^b, of which a step of 1e-16 is left: so x comes back to
        /// 1e-16 dx/dP / x, and a thousandfold of both roundings for the exponents.
        #[test]
        fn size_to_share_and_back(x50 in 1e-3..1e3f64, ratio in 1.5..100.0f64, b in 1.0..4.0f64,
                                  at in 0.001..0.999f64) {
            let curve = Swebrec::new(x50, x50 * ratio, b).expect("a curve");
            let x = at * curve.xmax();
            let limit = 1e-13 * (1.0 + 1.0 / (curve.density(x) * x));
            prop_assert!(near(curve.size_at(curve.passing(x)), x, limit));
        }

        #[test]
        fn share_to_size_and_back(x50 in 1e-3..1e3f64, ratio in 1.5..100.0f64, b in 1.0..4.0f64,
                                  p in 0.001..0.999f64) {
            let curve = Swebrec::new(x50, x50 * ratio, b).expect("a curve");
            let x = curve.size_at(p);
            // x = xmax exp(-exponent): for b near 1 the fine tail is longer than f64's range, whose
            // smallest normal number is exp(-708).
            let exponent = ratio.ln() * (1.0 / p - 1.0).powf(1.0 / b);
            if exponent > 650.0 {
                prop_assert!((0.0..1e-270).contains(&x), "{x}");
            } else {
                prop_assert!(near(curve.passing(x), p, 1e-11));
            }
        }

        #[test]
        fn monotone(x50 in 1e-3..1e3f64, ratio in 1.1..100.0f64, b in 0.5..6.0f64,
                    low in 0.001..0.99f64, step in 1e-6..0.01f64) {
            let curve = Swebrec::new(x50, x50 * ratio, b).expect("a curve");
            let (x, y) = (low * curve.xmax(), (low + step) * curve.xmax());
            prop_assert!(curve.passing(x) <= curve.passing(y));
            prop_assert!(curve.size_at(low) <= curve.size_at(low + step));
        }

        /// Against the slope of `passing` over a millionth of xmax: the third derivative and the
        /// cancellation each leave about 1e-9 of 1 / xmax; 1e-5 covers the steep ends.
        #[test]
        fn density_is_the_slope(x50 in 1e-3..1e3f64, ratio in 1.5..50.0f64, b in 1.0..4.0f64,
                                at in 0.01..0.98f64) {
            let curve = Swebrec::new(x50, x50 * ratio, b).expect("a curve");
            let (x, h) = (at * curve.xmax(), 1e-6 * curve.xmax());
            let slope = (curve.passing(x + h) - curve.passing(x - h)) / (2.0 * h);
            prop_assert!((curve.density(x) - slope).abs() * curve.xmax() < 1e-5);
        }
    }
}
