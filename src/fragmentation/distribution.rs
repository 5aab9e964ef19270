//! A measured size distribution: cumulative percent passing at some sizes.

use crate::fault::Fault;

/// The percents passing whose sizes are told where nobody chose others.
pub const PERCENTILES: [f64; 5] = [10.0, 20.0, 50.0, 80.0, 90.0];

/// Cumulative percent passing by size, at least two points.
///
/// Sizes are above 0 and strictly ascending, percents are 0 to 100 and never fall. Between two points
/// the percent is linear in the logarithm of the size, as on the paper that sieve curves are drawn on.
#[derive(Debug, Clone, PartialEq)]
pub struct SizeDistribution {
    points: Vec<[f64; 2]>,
}

impl SizeDistribution {
    /// A distribution of points [size, percent passing], in any order.
    ///
    /// # Errors
    ///
    /// Fewer than two points, a size that is no number above 0, a percent outside 0 to 100, a size
    /// twice, a percent that falls where the size grows.
    pub fn new(mut points: Vec<[f64; 2]>) -> Result<Self, Fault> {
        for &[size, percent] in &points {
            if !(size.is_finite() && size > 0.0) {
                let what = format!("size {size} is not above 0");
                return Err(Fault::new(what, "give sizes above 0"));
            }
            if !(0.0..=100.0).contains(&percent) {
                let what = format!("{percent} % passing at size {size} is outside 0 to 100 %");
                return Err(Fault::new(what, "give cumulative percent passing"));
            }
        }
        if points.len() < 2 {
            let what = format!("a size distribution of {} points", points.len());
            return Err(Fault::new(
                what,
                "give two or more sizes with their percent passing",
            ));
        }
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        for pair in points.windows(2) {
            let &[[size, percent], [next_size, next_percent]] = pair else {
                continue;
            };
            if size == next_size {
                let what = format!("size {size} is there twice");
                return Err(Fault::new(what, "keep one of the two"));
            }
            if next_percent < percent {
                let what = format!(
                    "passing falls from {percent} % at size {size} to {next_percent} % at size \
                     {next_size}"
                );
                let remedy = "give cumulative percent passing, which grows with the size";
                return Err(Fault::new(what, remedy));
            }
        }
        Ok(Self { points })
    }

    /// The points [size, percent passing], sizes ascending.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// The percent passing at a size. Below the smallest measured size it is known only if nothing
    /// passed that, above the largest only if all did: else `None`.
    pub fn percent_passing(&self, size: f64) -> Option<f64> {
        let (first, last) = (self.points.first()?, self.points.last()?);
        if size < first[0] {
            return (first[1] == 0.0).then_some(0.0);
        }
        if size > last[0] {
            return (last[1] == 100.0).then_some(100.0);
        }
        let after = self.points.partition_point(|point| point[0] < size);
        let upper = self.points.get(after)?;
        if upper[0] == size {
            return Some(upper[1]);
        }
        let lower = self.points.get(after.checked_sub(1)?)?;
        let share = (size / lower[0]).ln() / (upper[0] / lower[0]).ln();
        Some(lower[1] + share * (upper[1] - lower[1]))
    }

    /// The size that a percent passes, the inverse of `percent_passing`; where the curve is flat the
    /// smallest such size. `None` outside of the measured percents.
    pub fn size_at(&self, percent: f64) -> Option<f64> {
        let after = self.points.partition_point(|point| point[1] < percent);
        let upper = self.points.get(after)?;
        if upper[1] == percent {
            return Some(upper[0]);
        }
        let lower = self.points.get(after.checked_sub(1)?)?;
        let share = (percent - lower[1]) / (upper[1] - lower[1]);
        Some(lower[0] * (upper[0] / lower[0]).powf(share))
    }
}

/// A measured size as it was typed: units that were converted left 2.2399999999999998 of 2.24.
pub(crate) fn as_typed(size: f64) -> String {
    let near: Option<f64> = format!("{size:.5e}").parse().ok();
    near.unwrap_or(size).to_string()
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;

    /// From 10 to 1000 the middle on a logarithmic axis is 100.
    #[test]
    fn between_points_it_is_linear_in_the_logarithm() {
        let points = vec![[1000.0, 80.0], [10.0, 20.0]];
        let curve = SizeDistribution::new(points).expect("a distribution");
        assert_eq!(curve.points()[0], [10.0, 20.0]);
        assert!((curve.percent_passing(100.0).expect("inside") - 50.0).abs() < 1e-12);
        assert!((curve.size_at(50.0).expect("inside") - 100.0).abs() < 1e-10);
        assert_eq!(curve.percent_passing(1000.0), Some(80.0));
        assert_eq!(curve.size_at(20.0), Some(10.0));
    }

    #[test]
    fn outside_only_what_is_certain() {
        let open = SizeDistribution::new(vec![[1.0, 5.0], [2.0, 95.0]]).expect("a distribution");
        assert_eq!(open.percent_passing(0.5), None);
        assert_eq!(open.percent_passing(3.0), None);
        assert_eq!(open.size_at(4.0), None);
        assert_eq!(open.size_at(96.0), None);
        let closed = SizeDistribution::new(vec![[1.0, 0.0], [2.0, 100.0]]).expect("a distribution");
        assert_eq!(closed.percent_passing(0.5), Some(0.0));
        assert_eq!(closed.percent_passing(3.0), Some(100.0));
    }

    #[test]
    fn refuses_in_a_sentence() {
        for (points, sentence) in [
            (vec![[1.0, 5.0]], "1 points"),
            (vec![[0.0, 5.0], [1.0, 6.0]], "size 0 "),
            (vec![[1.0, 5.0], [2.0, 101.0]], "101 % passing at size 2 "),
            (vec![[1.0, 5.0], [1.0, 6.0]], "size 1 is there twice"),
            (
                vec![[1.0, 5.0], [2.0, 4.0]],
                "falls from 5 % at size 1 to 4 %",
            ),
            (vec![[1.0, f64::NAN], [2.0, 4.0]], "NaN % passing"),
        ] {
            let fault = SizeDistribution::new(points)
                .expect_err(sentence)
                .to_string();
            assert!(fault.contains(sentence), "{fault}");
        }
    }
}
