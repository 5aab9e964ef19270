//! Student's t and Fisher's F, for intervals from few pairs.

use statrs::distribution::{ContinuousCDF, FisherSnedecor, StudentsT};

/// The two-sided 95 % quantile of Student's t; infinite without a degree of freedom.
pub(super) fn t95(degrees_of_freedom: usize) -> f64 {
    let student = StudentsT::new(0.0, 1.0, degrees_of_freedom as f64);
    student.map_or(f64::INFINITY, |student| student.inverse_cdf(0.975))
}

/// Of good residuals' lengths in space, 99.9 % are below this many standard deviations (of one coordinate), where these are
/// estimated with so many degrees of freedom: the root of 3 F; infinite without one.
pub(super) fn length_999(degrees_of_freedom: usize) -> f64 {
    let fisher = FisherSnedecor::new(3.0, degrees_of_freedom as f64);
    fisher.map_or(f64::INFINITY, |fisher| {
        (3.0 * fisher.inverse_cdf(0.999)).sqrt()
    })
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

    /// The printed tables of F of 3 and n degrees of freedom, 0.1 % above (Abramowitz & Stegun, table 26.9); without end chi
    /// squared's 16.266 over 3.
    #[test]
    fn lengths_by_the_printed_table() {
        for (n, f) in [(5, 33.20), (8, 15.83), (14, 9.73), (30, 7.05), (120, 5.79)] {
            let found = length_999(n);
            assert!((found - (3.0_f64 * f).sqrt()).abs() < 5e-3, "{n}: {found}");
        }
        assert!((length_999(10_000_000) - 4.033_142).abs() < 1e-4);
        assert_eq!(length_999(0), f64::INFINITY);
    }
}
