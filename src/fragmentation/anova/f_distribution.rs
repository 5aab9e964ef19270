//! Tail and critical values of the F distribution, by the incomplete beta function of statrs.

use statrs::function::beta::checked_beta_reg;

/// More degrees of freedom, between and within, than these are not looked at: far above, the continued
/// fraction of statrs ends before it has converged. Up to here nine digits are right.
pub(super) const MOST: [usize; 2] = [100_000, 1_000_000];

/// The probability of an F of `f` or more, with degrees of freedom [between, within].
///
/// P(F >= f) = I_z(d2 / 2, d1 / 2), z = d2 / (d2 + d1 f) (Abramowitz and Stegun, 26.6.2). statrs' own
/// tail takes z as 1 less the rest, which loses the small probabilities.
pub(super) fn upper_tail(degrees: [usize; 2], f: f64) -> Option<f64> {
    let [d1, d2] = degrees.map(|d| d as f64);
    checked_beta_reg(0.5 * d2, 0.5 * d1, d2 / (d2 + d1 * f)).ok()
}

/// The probability of an F of `f` or less.
pub(super) fn lower_tail(degrees: [usize; 2], f: f64) -> Option<f64> {
    let [d1, d2] = degrees.map(|d| d as f64);
    checked_beta_reg(0.5 * d1, 0.5 * d2, d1 * f / (d2 + d1 * f)).ok()
}

/// The F that is exceeded with the probability `level`, 0 to 1 exclusive.
///
/// By bisection of the tail in ln(f), to the last digits of a double: statrs' inverse of the
/// distribution is off by 1e-5 and more for small levels and many degrees of freedom.
pub(super) fn critical_value(degrees: [usize; 2], level: f64) -> Option<f64> {
    let (mut low, mut high) = (-700.0_f64, 700.0_f64);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return Some(middle.exp());
        }
        if upper_tail(degrees, middle.exp())? > level {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;

    fn near(found: Option<f64>, expected: f64, relative: f64) {
        let found = found.expect("a probability");
        assert!(
            (found / expected - 1.0).abs() < relative,
            "{found} instead of {expected}"
        );
    }

    /// scipy.stats.f.sf and .cdf, scipy 1.x (Boost's incomplete beta).
    #[test]
    fn tails_as_scipy_has_them() {
        for (degrees, f, upper) in [
            ([9, 20], 2.39, 0.050_224_876_747_636_02),
            ([9, 20], 0.003_363_4, 0.999_999_999_756_209_7),
            ([4, 20], 1.180_462_374_402_55, 0.349_447_493_402_192_94),
            ([8, 180], 21.0, 2.583_264_337_268_937_5e-22),
            ([3, 100], 80.0, 1.808_670_668_148_546_4e-26),
            ([2, 7], 5000.0, 9.052_728_398_795_021e-12),
            ([1, 2], 1e12, 9.999_999_999_985_001e-13),
            ([8, 1800], 201.0, 4.037_141_885_753_724e-243),
            ([9, 1_000_000], 2.0, 0.035_174_688_045_631_87),
            (MOST, 1.01, 0.016_769_291_307_162_076),
        ] {
            near(upper_tail(degrees, f), upper, 1e-9);
        }
        near(
            lower_tail([9, 20], 0.003_363_4),
            2.437_903_897_864_085_5e-10,
            1e-11,
        );
    }

    /// scipy.stats.f.isf; two of them have a closed form: with 2 and n degrees of freedom the tail is
    /// (1 + 2 f / n)^(-n / 2), with 1 and 1 the critical value is tan(pi (1 - level) / 2)^2.
    #[test]
    fn critical_values_as_scipy_has_them() {
        for (degrees, level, f) in [
            ([9, 20], 0.05, 2.392_814_108_442_279),
            ([9, 20], 0.95, 0.340_546_634_104_980_87),
            ([4, 20], 0.001, 7.096_034_067_322_515),
            ([8, 1800], 0.05, 1.943_538_680_561_467_6),
            ([30, 100_000], 0.05, 1.459_214_131_176_464_1),
            ([9, 1_000_000], 0.1, 1.631_523_666_504_554_5),
            ([1000, 1000], 0.5, 1.0),
            ([500, 3], 0.01, 26.148_270_019_708_278),
        ] {
            near(critical_value(degrees, level), f, 1e-9);
        }
        near(critical_value([2, 1], 0.01), 4999.5, 1e-12);
        near(critical_value([2, 4], 1e-40), 2.0 * (1e20 - 1.0), 1e-12);
        let angle = 0.5 * std::f64::consts::PI * (1.0 - 1e-3);
        near(critical_value([1, 1], 1e-3), angle.tan().powi(2), 1e-11);
    }
}
