//! The Gates-Gaudin-Schuhmann distribution of fragment sizes: a straight line on paper with two
//! logarithmic axes.
//!
//! Schuhmann, "Principles of comminution, I: size distribution and surface calculations", AIME
//! Technical Publication 1189 (1940):
//!
//! ```text
//! P(x) = (x / xmax)^m,    0 < x <= xmax
//! ```
//!
//! P is the share of the mass that passes a sieve of opening x. Sizes go in and come out in the unit
//! of xmax.

/// The Gates-Gaudin-Schuhmann distribution with a largest size and a slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GatesGaudinSchuhmann {
    xmax: f64,
    m: f64,
}

/// Parameters that make no Gates-Gaudin-Schuhmann distribution.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GatesGaudinSchuhmannError {
    /// The largest size is not a positive number.
    #[error("xmax = {0}; the largest size must be a number above 0")]
    Largest(f64),
    /// The slope is not a positive number.
    #[error("m = {0}; the slope must be a number above 0 (0.5 to 1 for most crushed rock)")]
    Slope(f64),
}

impl GatesGaudinSchuhmann {
    /// A distribution with largest size `xmax` and slope `m`.
    ///
    /// # Errors
    ///
    /// Unless xmax > 0 and m > 0, both finite.
    pub fn new(xmax: f64, m: f64) -> Result<Self, GatesGaudinSchuhmannError> {
        if !(xmax.is_finite() && xmax > 0.0) {
            return Err(GatesGaudinSchuhmannError::Largest(xmax));
        }
        if !(m.is_finite() && m > 0.0) {
            return Err(GatesGaudinSchuhmannError::Slope(m));
        }
        Ok(Self { xmax, m })
    }

    /// The largest size: everything passes it.
    pub fn xmax(&self) -> f64 {
        self.xmax
    }

    /// The slope m, without unit.
    pub fn m(&self) -> f64 {
        self.m
    }

    /// P(x), 0 to 1: the share of the mass that passes a sieve of opening `x` (unit of xmax). 0 for
    /// x <= 0, 1 for x >= xmax; NaN stays NaN.
    pub fn passing(&self, x: f64) -> f64 {
        if x <= 0.0 {
            return 0.0;
        }
        if x >= self.xmax {
            return 1.0;
        }
        (x / self.xmax).powf(self.m)
    }

    /// The size that the share `p` of the mass passes (unit of xmax), the inverse of `passing`:
    /// x = xmax p^(1 / m). 0 for p <= 0, xmax for p >= 1; NaN stays NaN.
    pub fn size_at(&self, p: f64) -> f64 {
        if p <= 0.0 {
            return 0.0;
        }
        if p >= 1.0 {
            return self.xmax;
        }
        self.xmax * p.powf(1.0 / self.m)
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// With m = 1/2 a quarter of the largest size passes a half; with m = 3 half of it an eighth.
    #[test]
    fn closed_forms() {
        let root = GatesGaudinSchuhmann::new(100.0, 0.5).expect("a curve");
        assert!((root.passing(25.0) - 0.5).abs() < 1e-15);
        assert!((root.size_at(0.5) - 25.0).abs() < 1e-13);
        let cube = GatesGaudinSchuhmann::new(100.0, 3.0).expect("a curve");
        assert!((cube.passing(50.0) - 0.125).abs() < 1e-15);
        assert!((cube.size_at(0.125) - 50.0).abs() < 1e-13);
    }

    #[test]
    fn ends() {
        let curve = GatesGaudinSchuhmann::new(100.0, 0.8).expect("a curve");
        for (size, passing) in [(-1.0, 0.0), (0.0, 0.0), (100.0, 1.0), (f64::INFINITY, 1.0)] {
            assert_eq!(curve.passing(size), passing);
        }
        assert_eq!(curve.size_at(0.0), 0.0);
        assert_eq!(curve.size_at(1.0), 100.0);
        assert!(curve.passing(f64::NAN).is_nan());
        assert!(curve.size_at(f64::NAN).is_nan());
    }

    #[test]
    fn refuses() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let largest = GatesGaudinSchuhmann::new(bad, 1.0).expect_err("xmax");
            assert!(matches!(largest, GatesGaudinSchuhmannError::Largest(_)));
            let slope = GatesGaudinSchuhmann::new(1.0, bad).expect_err("m");
            assert!(matches!(slope, GatesGaudinSchuhmannError::Slope(_)));
        }
    }

    proptest! {
        #[test]
        fn share_to_size_and_back(xmax in 1e-3..1e3f64, m in 0.1..6.0f64, p in 1e-6..1.0f64) {
            let curve = GatesGaudinSchuhmann::new(xmax, m).expect("a curve");
            prop_assert!((curve.passing(curve.size_at(p)) - p).abs() <= 1e-13 * p);
        }
    }
}
