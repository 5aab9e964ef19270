//! Student's t, for intervals from few pairs.

/// The two-sided 95 % quantile of Student's t. For 1 and 2 degrees of freedom exact, else by the
/// expansion of Abramowitz & Stegun 26.7.5, good to three digits from 3 on.
pub(super) fn t95(degrees_of_freedom: usize) -> f64 {
    match degrees_of_freedom {
        0 => f64::INFINITY,
        1 => 12.706_204_736,
        2 => 4.302_652_730,
        n => {
            // Of the normal distribution.
            let x: f64 = 1.959_963_984_540;
            let n = n as f64;
            let (x3, x5, x7, x9) = (x.powi(3), x.powi(5), x.powi(7), x.powi(9));
            let g1 = (x3 + x) / 4.0;
            let g2 = (5.0 * x5 + 16.0 * x3 + 3.0 * x) / 96.0;
            let g3 = (3.0 * x7 + 19.0 * x5 + 17.0 * x3 - 15.0 * x) / 384.0;
            let g4 = (79.0 * x9 + 776.0 * x7 + 1482.0 * x5 - 1920.0 * x3 - 945.0 * x) / 92_160.0;
            x + g1 / n + g2 / n.powi(2) + g3 / n.powi(3) + g4 / n.powi(4)
        }
    }
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
            assert!((t95(n) - t).abs() < 1e-3, "{n}: {}", t95(n));
        }
        assert_eq!(t95(0), f64::INFINITY);
    }
}
