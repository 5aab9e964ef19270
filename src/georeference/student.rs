//! Student's t, for intervals from few pairs.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// The two-sided 95 % quantile of Student's t; infinite without a degree of freedom.
pub(super) fn t95(degrees_of_freedom: usize) -> f64 {
    let student = StudentsT::new(0.0, 1.0, degrees_of_freedom as f64);
    student.map_or(f64::INFINITY, |student| student.inverse_cdf(0.975))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// NIST/SEMATECH e-Handbook, 1.3.6.7.2.
    #[test]
    fn the_printed_table() {
        for (n, t) in [
            (1, 12.706),
            (2, 4.303),
            (5, 2.571),
            (8, 2.306),
            (14, 2.145),
            (100, 1.984),
        ] {
            assert!((t95(n) - t).abs() < 5.1e-4, "{n}: {}", t95(n));
        }
        assert_eq!(t95(0), f64::INFINITY);
    }
}
