//! The extended Swebrec distribution of fragment sizes, with five parameters.
//!
//! Ouchterlony, "The Swebrec function: linking fragmentation by blasting and crushing", Mining
//! Technology (Trans. Inst. Min. Metall. A) 114 (2005) A29-A44, the extension for the fines:
//!
//! ```text
//! P(x) = 1 / (1 + a f(x)^b + (1 - a) g(x)^c),    0 < x <= xmax
//! f(x) = ln(xmax / x) / ln(xmax / x50),    g(x) = (xmax / x - 1) / (xmax / x50 - 1)
//! ```
//!
//! P is the share of the mass that passes a sieve of opening x. With a = 1 it is the Swebrec
//! distribution. Sizes go in and come out in the unit of xmax and x50.

use super::swebrec::{Swebrec, SwebrecError, logarithm_of_ratio};

/// The extended Swebrec distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Swebrec5 {
    x50: f64,
    xmax: f64,
    b: f64,
    a: f64,
    c: f64,
    /// ln(xmax / x50), above 0.
    spread: f64,
}

/// Parameters that make no extended Swebrec distribution.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Swebrec5Error {
    /// x50, xmax and b are no Swebrec distribution.
    #[error(transparent)]
    Swebrec(#[from] SwebrecError),
    /// The share of the first term is outside 0 to 1.
    #[error("a = {0}; the share of the coarse term must be 0 to 1")]
    Share(f64),
    /// The exponent of the fines is not a positive number.
    #[error("c = {0}; the exponent of the fines must be a number above 0")]
    Fines(f64),
}

impl Swebrec5 {
    /// A distribution with median size `x50`, largest size `xmax` (one unit), undulation `b`, share
    /// `a` of the Swebrec term and exponent `c` of the term for the fines.
    ///
    /// # Errors
    ///
    /// Unless 0 < x50 < xmax, b > 0, 0 <= a <= 1 and c > 0, all finite.
    pub fn new(x50: f64, xmax: f64, b: f64, a: f64, c: f64) -> Result<Self, Swebrec5Error> {
        Swebrec::new(x50, xmax, b)?;
        if !(0.0..=1.0).contains(&a) {
            return Err(Swebrec5Error::Share(a));
        }
        if !(c.is_finite() && c > 0.0) {
            return Err(Swebrec5Error::Fines(c));
        }
        Ok(Self {
            x50,
            xmax,
            b,
            a,
            c,
            spread: logarithm_of_ratio(xmax, x50),
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

    /// The share a of the Swebrec term, 0 to 1.
    pub fn a(&self) -> f64 {
        self.a
    }

    /// The exponent c of the term for the fines, without unit.
    pub fn c(&self) -> f64 {
        self.c
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
        1.0 / (1.0 + self.odds(logarithm_of_ratio(self.xmax, x)))
    }

    /// The size that the share `p` of the mass passes (unit of x50), the inverse of `passing`. 0 for
    /// p <= 0, xmax for p >= 1; NaN stays NaN.
    ///
    /// There is no closed form; the two terms alone bracket the answer, and halving the bracket
    /// until nothing is left of it cannot fail.
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
        let odds = (1.0 - p) / p;
        if odds.is_nan() {
            return odds;
        }
        // Where a term alone has these odds, as ln(xmax / x). The weighted mean of the two terms has
        // them in between.
        let coarse = self.spread * odds.powf(1.0 / self.b);
        let fines = ln_1p_exp(ln_exp_m1(self.spread) + odds.ln() / self.c);
        // Beyond this every size is 0 as an f64.
        let longest = 2000.0;
        let mut low = coarse.min(fines).min(longest);
        let mut high = coarse.max(fines).min(longest);
        for _ in 0..200 {
            // In equal ratios, so that a size near xmax keeps its digits too.
            let middle = if low > 0.0 {
                low * (high / low).sqrt()
            } else {
                0.5 * high
            };
            if !(middle > low && middle < high) {
                break;
            }
            if self.odds(middle) < odds {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.xmax * (-high).exp()
    }

    /// a f^b + (1 - a) g^c, which is (1 - P) / P, at `y` = ln(xmax / x) > 0.
    fn odds(&self, y: f64) -> f64 {
        let coarse = (y / self.spread).powf(self.b);
        let fines = (self.c * (ln_exp_m1(y) - ln_exp_m1(self.spread))).exp();
        // A term without a share stays out, be it infinite.
        match self.a {
            1.0 => coarse,
            0.0 => fines,
            a => a * coarse + (1.0 - a) * fines,
        }
    }
}

/// ln(e^y - 1) for y > 0, without overflow.
pub(crate) fn ln_exp_m1(y: f64) -> f64 {
    if y > 30.0 {
        y + (-(-y).exp()).ln_1p()
    } else {
        y.exp_m1().ln()
    }
}

/// ln(1 + e^z), the inverse of `ln_exp_m1`, without overflow.
fn ln_1p_exp(z: f64) -> f64 {
    if z > 30.0 {
        z + (-z).exp().ln_1p()
    } else {
        z.exp().ln_1p()
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// xmax = 4, x50 = 2: at x = 1, f = 2 and g = 3. With b = 2, c = 1 and a = 1/2 the odds are
    /// 4 / 2 + 3 / 2 = 3.5, so P = 1 / 4.5. At x = 4 / sqrt 2, f = 1 / 2 and g = sqrt 2 - 1.
    #[test]
    fn closed_forms() {
        let curve = Swebrec5::new(2.0, 4.0, 2.0, 0.5, 1.0).expect("a curve");
        assert!((curve.passing(1.0) - 1.0 / 4.5).abs() < 1e-15);
        assert!((curve.size_at(1.0 / 4.5) - 1.0).abs() < 1e-14);
        let root = 2f64.sqrt();
        let passing = 1.0 / (1.0 + 0.125 + 0.5 * (root - 1.0));
        assert!((curve.passing(4.0 / root) - passing).abs() < 1e-15);
        assert!((curve.size_at(passing) - 4.0 / root).abs() < 1e-14);
        assert_eq!(curve.passing(2.0), 0.5);
        assert_eq!(curve.size_at(0.5), 2.0);
    }

    #[test]
    fn ends() {
        let curve = Swebrec5::new(200.0, 800.0, 2.2, 0.7, 1.3).expect("a curve");
        for (size, passing) in [(-1.0, 0.0), (0.0, 0.0), (800.0, 1.0), (f64::INFINITY, 1.0)] {
            assert_eq!(curve.passing(size), passing);
        }
        assert_eq!(curve.size_at(0.0), 0.0);
        assert_eq!(curve.size_at(1.0), 800.0);
        assert!(curve.passing(f64::NAN).is_nan());
        assert!(curve.size_at(f64::NAN).is_nan());
        // Farther down than any f64.
        assert_eq!(
            Swebrec5::new(1.0, 2.0, 0.01, 0.5, 0.001)
                .expect("a curve")
                .size_at(1e-9),
            0.0
        );
    }

    #[test]
    fn refuses() {
        assert!(matches!(
            Swebrec5::new(2.0, 1.0, 2.0, 0.5, 1.0),
            Err(Swebrec5Error::Swebrec(SwebrecError::Largest { .. }))
        ));
        for a in [-0.1, 1.1, f64::NAN] {
            let error = Swebrec5::new(1.0, 2.0, 2.0, a, 1.0).expect_err("a");
            assert!(matches!(error, Swebrec5Error::Share(_)));
        }
        for c in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = Swebrec5::new(1.0, 2.0, 2.0, 0.5, c).expect_err("c");
            assert!(matches!(error, Swebrec5Error::Fines(_)));
        }
    }

    proptest! {
        #[test]
        fn with_all_in_the_first_term_it_is_swebrec(
            x50 in 1e-3..1e3f64, ratio in 1.1..1e6f64, b in 0.5..6.0f64, c in 0.1..5.0f64,
            at in 0.001..0.999f64,
        ) {
            let extended = Swebrec5::new(x50, x50 * ratio, b, 1.0, c).expect("a curve");
            let plain = Swebrec::new(x50, x50 * ratio, b).expect("a curve");
            let x = at * plain.xmax();
            prop_assert!((extended.passing(x) - plain.passing(x)).abs() < 1e-14);
            // An exponent y = ln(xmax / x) of some hundreds turns 1e-16 of it into 1e-13 of x.
            let size = plain.size_at(at);
            prop_assert!((extended.size_at(at) - size).abs() <= 1e-12 * size);
        }

        #[test]
        fn share_to_size_and_back(
            x50 in 1e-3..1e3f64, ratio in 1.5..1e4f64, b in 1.0..4.0f64, a in 0.0..1.0f64,
            c in 0.5..4.0f64, p in 0.01..0.999f64,
        ) {
            let curve = Swebrec5::new(x50, x50 * ratio, b, a, c).expect("a curve");
            let x = curve.size_at(p);
            prop_assert!((curve.passing(x) - p).abs() < 1e-11, "{x}");
            prop_assert!(curve.size_at(p + 1e-6) >= x);
        }
    }
}
