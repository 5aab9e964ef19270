//! Distance of two fitted functions over the whole curve.
//!
//! The norms are integrals over the logarithm of the size, the limit of ever more sizes spaced evenly
//! on a logarithmic axis. They are taken by tanh-sinh quadrature (Takahasi and Mori, "Double
//! exponential formulas for numerical integration", Publications of RIMS 9 (1974) 721-741), piecewise
//! between the functions' topsizes: there the functions have kinks, which this rule does not mind at
//! the end of an interval.

use crate::Curve;
use crate::fault::Fault;

/// The sizes that functions are compared over, evenly in the logarithm of the size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// The smallest: the reference's fitted P1. In the set's unit.
    pub from: f64,
    /// The largest: the reference's fitted topsize, where it has one, else its fitted P99.
    pub to: f64,
    /// Percent passing `to` by the reference's function: 100 or 99.
    pub to_percent: f64,
}

impl Span {
    /// The span of a reference.
    ///
    /// # Errors
    ///
    /// Where its P1 is 0 or not below its topsize.
    pub(super) fn of(reference: &Curve) -> Result<Self, Fault> {
        let from = reference.size_at(1.0);
        let (to, to_percent) = match reference.size_at(100.0) {
            topsize if topsize.is_finite() => (topsize, 100.0),
            _ => (reference.size_at(99.0), 99.0),
        };
        if from > 0.0 && from < to && to.is_finite() {
            return Ok(Self {
                from,
                to,
                to_percent,
            });
        }
        let what = format!("the reference's function spans no sizes (P1 = {from}, top = {to})");
        Err(Fault::new(what, "fit another function"))
    }
}

/// A distance over the part of the span where both were measured: beyond it functions are compared that nobody measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredNorm {
    /// The smallest size of the span at which both were measured, in the set's unit.
    pub from: f64,
    /// The largest.
    pub to: f64,
    /// Which share of the span that is, on the logarithmic axis.
    pub share: f64,
    /// The distance between them.
    pub norm: CurveNorm,
}

impl MeasuredNorm {
    /// Of `curve` from `reference`, which were measured at sizes between these; `None` where they share none of the span.
    pub(super) fn between(
        curve: &Curve,
        reference: &Curve,
        span: Span,
        measured: [[f64; 2]; 2],
    ) -> Option<Self> {
        let from = measured
            .iter()
            .fold(span.from, |from, [low, _]| from.max(*low));
        let to = measured.iter().fold(span.to, |to, [_, high]| to.min(*high));
        (from < to).then(|| Self {
            from,
            to,
            share: (to / from).ln() / (span.to / span.from).ln(),
            norm: CurveNorm::between(curve, reference, Span { from, to, ..span }),
        })
    }
}

/// 2-norm of the difference of two functions over a span.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveNorm {
    /// Root of the mean squared difference, percentage points.
    pub rms_difference: f64,
    /// 100 ||P - P reference|| / ||P reference||, percent.
    pub relative_percent: f64,
}

impl CurveNorm {
    /// The distance of `curve` from `reference` over a span.
    pub(super) fn between(curve: &Curve, reference: &Curve, span: Span) -> Self {
        let (from, to) = (span.from.ln(), span.to.ln());
        let tops = [curve, reference].map(|curve| curve.size_at(100.0).ln());
        let mut bounds = vec![from, to];
        bounds.extend(tops.into_iter().filter(|top| *top > from && *top < to));
        bounds.sort_by(f64::total_cmp);
        let [difference, whole] = squares(
            |at| curve.percent_passing(at.exp()),
            |at| reference.percent_passing(at.exp()),
            &bounds,
        );
        Self {
            rms_difference: (difference / (to - from)).sqrt(),
            relative_percent: 100.0 * (difference / whole).sqrt(),
        }
    }
}

/// How much nearer to the reference one method is than another.
#[derive(Debug, Clone, PartialEq)]
pub struct Improvement {
    /// The method in question.
    pub method: String,
    /// The method that it is held against.
    pub over: String,
    /// 100 (norm of `over` - norm of `method`) / norm of `over`; above 0 where `method` is nearer to
    /// the reference. `None` where the norm of `over` is 0.
    pub percent: Option<f64>,
}

impl Improvement {
    /// Of a method (its name and norm) over another.
    pub(super) fn of(method: (&str, CurveNorm), over: (&str, CurveNorm)) -> Self {
        let [this, other] = [method.1, over.1].map(|norm| norm.relative_percent);
        Self {
            method: method.0.to_owned(),
            over: over.0.to_owned(),
            percent: (other > 0.0).then(|| 100.0 * (other - this) / other),
        }
    }
}

/// The integrals of (p - q)^2 and of q^2 over intervals with these ascending bounds.
fn squares(p: impl Fn(f64) -> f64, q: impl Fn(f64) -> f64, bounds: &[f64]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for pair in bounds.windows(2) {
        let &[from, to] = pair else { continue };
        sums[0] += integral(|at| (p(at) - q(at)).powi(2), from, to);
        sums[1] += integral(|at| q(at).powi(2), from, to);
    }
    sums
}

/// The integral of a function over an interval, to about 1e-12 of itself.
fn integral(function: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    use std::f64::consts::FRAC_PI_2;
    /// Beyond, the weights are below the last digit of a double.
    const REACH: f64 = 3.3;
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let sum = |steps: i32| {
        let step = REACH / f64::from(steps);
        let terms = (-steps..=steps).map(|k| {
            let t = step * f64::from(k);
            let stretched = FRAC_PI_2 * t.sinh();
            let weight = FRAC_PI_2 * t.cosh() / stretched.cosh().powi(2);
            weight * function(middle + half * stretched.tanh())
        });
        half * step * terms.sum::<f64>()
    };
    let mut steps = 16;
    let mut before = sum(steps);
    loop {
        steps *= 2;
        let now = sum(steps);
        if (now - before).abs() <= 1e-12 * now.abs() || steps >= 4096 {
            return now;
        }
        before = now;
    }
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;
    use crate::{GatesGaudinSchuhmann, RosinRammler, Swebrec};

    fn near(found: f64, expected: f64, relative: f64) {
        assert!(
            (found / expected - 1.0).abs() < relative,
            "{found} instead of {expected}"
        );
    }

    fn swebrec(x50: f64, xmax: f64, b: f64) -> Curve {
        Curve::Swebrec(Swebrec::new(x50, xmax, b).expect("a Swebrec"))
    }

    /// Power laws e^u and e^(2u) from -3 to 0: integrals of their squares in closed form.
    #[test]
    fn powers_in_closed_form() {
        let [difference, whole] = squares(f64::exp, |u| (2.0 * u).exp(), &[-3.0, -1.0, 0.0]);
        let power = |m: f64| (1.0 - (-3.0 * m).exp()) / m;
        near(whole, power(4.0), 1e-11);
        near(
            difference,
            power(2.0) - 2.0 * power(3.0) + power(4.0),
            1e-11,
        );
        // A kink where an interval ends, and a root, whose slope has no bound there.
        near(integral(f64::sqrt, 0.0, 4.0), 16.0 / 3.0, 1e-11);
    }

    /// scipy.integrate.quad over ln(size), split at the topsizes, epsabs 1e-13.
    #[test]
    fn swebrecs_as_scipy_integrates_them() {
        let reference = swebrec(40.0, 150.0, 2.2);
        let span = Span::of(&reference).expect("a span");
        near(span.from, 0.003_476_714_123_232_862_4, 1e-12);
        assert_eq!((span.to, span.to_percent), (150.0, 100.0));
        for ([x50, xmax, b], rms, relative) in [
            (
                [44.0, 120.0, 2.6],
                4.758_157_188_163_953_5,
                15.243_821_331_793_86,
            ),
            (
                [43.2, 162.0, 2.2],
                1.326_944_606_686_027,
                4.251_163_990_930_406,
            ),
            (
                [38.0, 300.0, 3.0],
                1.714_598_483_686_046_6,
                5.493_099_935_010_838,
            ),
            (
                [40.0, 150.0, 6.0],
                9.179_992_198_529_474,
                29.410_159_304_897_455,
            ),
            (
                [41.0, 90.0, 1.2],
                4.823_429_616_296_217,
                15.452_936_161_967_118,
            ),
        ] {
            let norm = CurveNorm::between(&swebrec(x50, xmax, b), &reference, span);
            near(norm.rms_difference, rms, 1e-9);
            near(norm.relative_percent, relative, 1e-9);
        }
        let same = CurveNorm::between(&reference, &reference, span);
        assert_eq!((same.rms_difference, same.relative_percent), (0.0, 0.0));
    }

    /// Gates-Gaudin-Schuhmann is a power of the size up to its topsize, where it has a kink: with
    /// u = ln(size / 100), e^(m u) from ln(0.01) on, and 1 - e^u from ln(0.5) on for the one that ends
    /// at 50.
    #[test]
    fn gates_gaudin_schuhmann_in_closed_form() {
        let power = |xmax, m| {
            let curve = GatesGaudinSchuhmann::new(xmax, m).expect("a curve");
            Curve::GatesGaudinSchuhmann(curve)
        };
        let span = Span::of(&power(100.0, 1.0)).expect("a span");
        near(span.from, 1.0, 1e-12);
        assert_eq!((span.to, span.to_percent), (100.0, 100.0));
        let norm = CurveNorm::between(&power(50.0, 1.0), &power(100.0, 1.0), span);
        // Below 50 the one is twice the other.
        let below = (0.25 - 1e-4) / 2.0;
        let above = 2.0_f64.ln() - 2.0 * 0.5 + (1.0 - 0.25) / 2.0;
        let whole = (1.0 - 1e-4) / 2.0;
        near(
            norm.relative_percent,
            100.0 * ((below + above) / whole).sqrt(),
            1e-10,
        );
        let mean_square = (below + above) / 100.0_f64.ln();
        near(norm.rms_difference, 100.0 * mean_square.sqrt(), 1e-10);
    }

    /// Below 50 the one power law is twice the other: over sizes from 10 to 40, at which both were measured, the distance is as large as
    /// the reference, 100 %. The span goes from 1 to 100.
    #[test]
    fn where_both_were_measured_alone() {
        let power = |xmax| {
            let curve = GatesGaudinSchuhmann::new(xmax, 1.0).expect("a curve");
            Curve::GatesGaudinSchuhmann(curve)
        };
        let (curve, reference) = (power(50.0), power(100.0));
        let span = Span::of(&reference).expect("a span");
        let measured = |ranges| MeasuredNorm::between(&curve, &reference, span, ranges);
        let found = measured([[10.0, 90.0], [5.0, 40.0]]).expect("a part");
        assert_eq!((found.from, found.to), (10.0, 40.0));
        near(found.share, 4.0_f64.ln() / 100.0_f64.ln(), 1e-12);
        near(found.norm.relative_percent, 100.0, 1e-9);
        // Measured further than the span goes, it is all of it.
        let whole = measured([[0.1, 200.0], [0.5, 300.0]]).expect("all");
        assert_eq!((whole.from, whole.to), (span.from, span.to));
        near(whole.share, 1.0, 1e-12);
        assert_eq!(whole.norm, CurveNorm::between(&curve, &reference, span));
        assert_eq!(measured([[10.0, 20.0], [20.0, 40.0]]), None);
    }

    /// Rosin-Rammler has no topsize: the span ends at its P99.
    #[test]
    fn without_a_topsize_the_span_ends_at_p99() {
        let curve = RosinRammler::new(40.0, 1.0).expect("a curve");
        let span = Span::of(&Curve::RosinRammler(curve)).expect("a span");
        // 2^-(x / 40) = 0.01.
        near(span.to, 40.0 * 100.0_f64.log2(), 1e-12);
        assert_eq!(span.to_percent, 99.0);
    }

    /// Many evenly spaced sizes come to the same, which is what the integral stands for.
    #[test]
    fn the_integral_is_the_limit_of_many_sizes() {
        let (reference, curve) = (swebrec(40.0, 150.0, 2.2), swebrec(44.0, 120.0, 2.6));
        let span = Span::of(&reference).expect("a span");
        let count = 200_000;
        let (mut difference, mut whole) = (0.0, 0.0);
        for at in 0..count {
            let share = (f64::from(at) + 0.5) / f64::from(count);
            let size = span.from * (span.to / span.from).powf(share);
            let (p, q) = (curve.percent_passing(size), reference.percent_passing(size));
            difference += (p - q).powi(2);
            whole += q * q;
        }
        let norm = CurveNorm::between(&curve, &reference, span);
        near(
            norm.rms_difference,
            (difference / f64::from(count)).sqrt(),
            1e-7,
        );
        near(
            norm.relative_percent,
            100.0 * (difference / whole).sqrt(),
            1e-7,
        );
    }

    /// 9.4 after 10 is an improvement of 6 %, and the other way round 6.38 % worse.
    #[test]
    fn nearer_is_an_improvement() {
        let norm = |relative_percent| CurveNorm {
            rms_difference: 1.0,
            relative_percent,
        };
        let cloud = Improvement::of(("cloud", norm(9.4)), ("object", norm(10.0)));
        near(cloud.percent.expect("a percentage"), 6.0, 1e-12);
        let object = Improvement::of(("object", norm(10.0)), ("cloud", norm(9.4)));
        near(
            object.percent.expect("a percentage"),
            -6.382_978_723_404_255,
            1e-12,
        );
        let perfect = Improvement::of(("object", norm(10.0)), ("cloud", norm(0.0)));
        assert_eq!(perfect.percent, None);
    }
}
