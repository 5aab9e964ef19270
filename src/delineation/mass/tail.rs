//! How the fines are distributed that no photo shows: a law that goes on below the limit of what is seen.
//!
//! The share of the mass that passes the limit is what was measured; the law's own shape below it is scaled to that share, so
//! that the curve goes on where it is. What it says there is the law's word, not the photos'.

use fragscale_core::fault::Fault;
use fragscale_fragmentation::{Curve, FitOptions, Model, SizeDistribution, fit};

/// What the fines follow.
#[derive(Debug, Clone, PartialEq)]
pub enum Tail {
    /// The Swebrec function (Ouchterlony 2005) that comes nearest to what was measured above the limit.
    Swebrec,
    /// A distribution of the same material, sieved: its points below the limit.
    Sieved(SizeDistribution),
}

/// Sizes per factor of ten, and how far down.
const PER_DECADE: f64 = 10.0;
const DECADES: f64 = 3.0;

/// Of less of the mass nothing is said, percent.
const LEAST: f64 = 0.05;

impl Tail {
    /// The curve with what lies below its first point.
    ///
    /// # Errors
    /// Where the law cannot be fitted, or says nothing there.
    pub fn below(&self, curve: &SizeDistribution) -> Result<SizeDistribution, Fault> {
        let Some([limit, passing]) = curve.points().first().copied() else {
            return Ok(curve.clone());
        };
        let fitted: Option<Curve> = match self {
            Self::Swebrec => Some(fit(curve, Model::Swebrec, &FitOptions::default())?.curve),
            Self::Sieved(_) => None,
        };
        let law = |size: f64| match (self, &fitted) {
            (Self::Sieved(sieved), _) => sieved.percent_passing(size),
            (_, Some(fitted)) => Some(fitted.percent_passing(size)),
            (_, None) => None,
        };
        let nothing = || {
            let what = "the law of the fines says nothing at the smallest size that was measured";
            Fault::new(
                what,
                "give a sieved distribution that reaches there, or swebrec",
            )
        };
        let at_limit = law(limit)
            .filter(|percent| *percent > 0.0)
            .ok_or_else(nothing)?;
        // Sizes of the same series as above the limit.
        let last = (limit.log10() * PER_DECADE).ceil() as i32 - 1;
        let steps = (last - (PER_DECADE * DECADES) as i32..=last).rev();
        let below = steps.map_while(|step| {
            let size = 10f64.powf(f64::from(step) / PER_DECADE);
            // No more than at the limit, where the law is level: rounding would.
            let percent = passing * (law(size)? / at_limit).min(1.0);
            (percent >= LEAST).then_some([size, percent])
        });
        let mut points: Vec<[f64; 2]> = below.collect();
        points.reverse();
        points.extend_from_slice(curve.points());
        SizeDistribution::new(points)
    }
}

#[cfg(test)]
mod tests {
    use fragscale_fragmentation::Swebrec;

    use super::*;

    fn points(of: &Swebrec, from: f64, factor: f64) -> SizeDistribution {
        let sizes = (0..12).map(|step| from * 1.25f64.powi(step));
        let sizes = sizes.take_while(|size| *size < of.xmax());
        let points = sizes.map(|size| [size, factor * 100.0 * of.passing(size)]);
        SizeDistribution::new(points.chain([[of.xmax(), factor * 100.0]]).collect()).unwrap()
    }

    /// What is cut off a Swebrec curve comes back, by its own law and by a sieved curve of it.
    #[test]
    fn what_was_cut_off_comes_back() {
        let whole = Swebrec::new(10.0, 60.0, 2.2).unwrap();
        let seen = points(&whole, 6.0, 1.0);
        let sieved = SizeDistribution::new(
            (0..40)
                .map(|step| {
                    let size = 0.1 * 1.18f64.powi(step);
                    [size, 100.0 * whole.passing(size)]
                })
                .collect(),
        )
        .unwrap();
        for (tail, tolerance) in [(Tail::Swebrec, 0.02), (Tail::Sieved(sieved), 0.1)] {
            let all = tail.below(&seen).unwrap();
            assert!(all.points()[0][0] < 0.5);
            for size in [0.5, 1.0, 2.0, 4.0, 6.0, 20.0] {
                let (found, wanted) = (
                    all.percent_passing(size).unwrap(),
                    100.0 * whole.passing(size),
                );
                assert!(
                    (found - wanted).abs() < tolerance * wanted,
                    "{size}: {found}, not {wanted}"
                );
            }
        }
    }

    /// The share that was measured stays; the law gives its shape alone.
    #[test]
    fn the_share_at_the_limit_stays() {
        let whole = Swebrec::new(10.0, 60.0, 2.2).unwrap();
        let mut seen: Vec<[f64; 2]> = points(&whole, 6.0, 1.0).points().to_vec();
        seen[0][1] *= 0.5;
        let seen = SizeDistribution::new(seen).unwrap();
        let all = Tail::Swebrec.below(&seen).unwrap();
        let [size, percent] = seen.points()[0];
        assert_eq!(all.percent_passing(size), Some(percent));
        assert!(
            all.points()
                .is_sorted_by(|a, b| a[0] < b[0] && a[1] <= b[1])
        );
        let far = SizeDistribution::new(vec![[100.0, 10.0], [200.0, 100.0]]).unwrap();
        assert!(Tail::Sieved(far).below(&seen).is_err());
    }
}
