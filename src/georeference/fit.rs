//! The similarity between two frames from pairs of positions of which some may be wrong.
//!
//! Those that agree with each other ([`agreeing`](super::agreeing)) are fitted together by least squares.
//!
//! The standard error of the scale. With q the sources and y the targets, both from their weighted
//! means, and R the rotation, the scale is s = sum(w q·Rᵀy) / sum(w |q|²) (Umeyama 1991, equation 42,
//! written out). A small rotation moves y across q and leaves s as it is, so to the first order
//!
//! ```text
//! var(s) = sum(w qᵀ RᵀC R q) / (sum(w |q|²))²,   C = 3 / (3 n - 7) · sum(w r rᵀ)
//! ```
//!
//! with C the covariance of a residual r of weight 1: n pairs are 3 n numbers, and 7 were fitted. For
//! equal weights and noise that is the same in all directions it is sigma² / sum(|q|²). Few pairs tell each direction's
//! noise badly, and along their longest axis too small: C is drawn to its own mean as if two degrees of freedom more in
//! each direction had that. In simulations with 3 to 30 pairs, on strips and squares, with noise that is the same in all directions
//! or three times as much upwards, the 95 % interval then holds the truth in 93.6 to 98.7 of 100; without it in 87.9 of three
//! and 91 of five. It supposes
//! that the errors of the positions are independent. Those of a drifting receiver are not, and then
//! the true error is larger.

use glam::{DMat3, DVec3};

use super::agreeing::{Weighted, agreeing, of_indices, on_a_line, outer};
use super::student::t95;
use crate::fault::Fault;
use crate::geometry::{Similarity, median};
use crate::numbers::significant_digits;

/// So many degrees of freedom in each direction have the noise of all together.
const SHARED: f64 = 2.0;
/// Radians that the rotation about the long axis of the positions may be unsure by (one standard
/// deviation): 5 degrees. More, and they lie on a line.
const LARGEST_ROTATION_ERROR: f64 = 0.087_266_462_6;
/// Across and along: positions that are narrower lie on a line.
const NARROW: f64 = 0.05;
/// Relative standard error of a scale beyond which there is no scale.
pub(super) const LARGEST_SCALE_ERROR: f64 = 0.1;

/// One position in both frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// In the reconstruction's frame.
    pub source: DVec3,
    /// In the world.
    pub target: DVec3,
    /// Standard deviation of a coordinate of `target`, in units of the world, where it is stated.
    pub accuracy: Option<f64>,
}

impl Pair {
    /// Standard deviation of a coordinate that a drone's receiver measured without saying how well, metres.
    pub const USUAL_OF_RECEIVERS: f64 = 5.0;

    /// A receiver that says it is off by no more (one standard deviation, metres) hardly ever is by many times that: what contradicts
    /// it may be wrong.
    pub const SURE_OF_RECEIVERS: f64 = 0.3;

    /// One [`accuracy`](Self::accuracy) for all directions, of standard deviations along three axes.
    pub fn accuracy_of(deviations: DVec3) -> f64 {
        (deviations.length_squared() / 3.0).sqrt()
    }
}

/// A fitted similarity and how well it fits. Lengths are in units of the world.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// From the reconstruction's frame to the world.
    pub similarity: Similarity,
    /// Where each target lies from its fitted source, in the order of the pairs.
    pub residuals: Vec<DVec3>,
    /// Which pairs were used.
    pub used: Vec<bool>,
    /// The root of the mean squared length of the used residuals.
    pub rms: f64,
    /// The standard error of the scale, relative to it.
    pub scale_error: f64,
    /// Half the width of the scale's 95 % interval, relative to it (Student's t).
    pub scale_interval: f64,
    /// The standard error, in radians, of the rotation about the long axis of the positions, which is the
    /// least sure.
    pub rotation_error: f64,
}

impl Fit {
    /// How many pairs were used.
    pub fn count(&self) -> usize {
        self.used.iter().filter(|used| **used).count()
    }
}

/// Fits.
///
/// # Errors
/// Fewer than three pairs, numbers that are not finite, positions on a line or in one place, positions
/// that do not agree with each other, or do not determine the scale to 10 %.
pub fn fit(pairs: &[Pair]) -> Result<Fit, Fault> {
    let count = pairs.len();
    if count < 3 {
        return Err(Fault::new(
            format!("{count} known positions are too few for a place in the world"),
            "give three at least that are not on a line, or known distances for the scale alone",
        ));
    }
    let is_good = |pair: &Pair| {
        let known = pair.accuracy.is_none_or(|a| a > 0.0 && a.is_finite());
        pair.source.is_finite() && pair.target.is_finite() && known
    };
    if !pairs.iter().all(is_good) {
        return Err(Fault::new(
            "a known position is not finite",
            "correct it or leave it out",
        ));
    }
    // Everything is counted from the middle: coordinates of the Earth would eat the digits.
    let middle = pairs.iter().map(|pair| pair.target).sum::<DVec3>() / count as f64;
    let (weighted, accuracies_are_stated) = weighted(pairs, middle);
    let used = agreeing(&weighted, accuracies_are_stated)?;
    finish(&weighted, &used, middle)
}

/// With targets from the middle, and whether any accuracy is stated: a weight is its inverse square then.
fn weighted(pairs: &[Pair], middle: DVec3) -> (Vec<Weighted>, bool) {
    // Pairs without an accuracy beside others are taken to be as good as the others' median.
    let mut stated: Vec<f64> = pairs.iter().filter_map(|pair| pair.accuracy).collect();
    let usual = median(&mut stated);
    let weight = |pair: &Pair| pair.accuracy.or(usual).unwrap_or(1.0).powi(-2);
    let of_pairs = pairs.iter();
    let of_pairs = of_pairs.map(|pair| (pair.source, pair.target - middle, weight(pair)));
    (of_pairs.collect(), usual.is_some())
}

/// They do lie beside a line; `off` is how far a coordinate is from where the fit has it, world units.
fn of_another_shape(off: f64) -> Fault {
    Fault::new(
        format!(
            "the known positions are {} units of the world off where the fit has them: they are not of the shape that the reconstruction has, and do not \
             tell how it is turned",
            significant_digits(off, 2)
        ),
        "look for a wrong number, columns in another order (latitude first), longitudes or latitudes without their minus, heights of two kinds (above \
         the ellipsoid and above the sea), marks in photos of another size, another coordinate system",
    )
}

fn trace(matrix: DMat3) -> f64 {
    matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z
}

/// The least squares of the pairs at these indices, and how sure they are.
fn finish(pairs: &[Weighted], indices: &[usize], middle: DVec3) -> Result<Fit, Fault> {
    let local = of_indices(pairs, indices).ok_or_else(on_a_line)?;
    let used: Vec<bool> = (0..pairs.len())
        .map(|index| indices.contains(&index))
        .collect();
    let residuals: Vec<DVec3> = (pairs.iter())
        .map(|(p, q, _)| *q - local.apply(*p))
        .collect();
    let chosen: Vec<(DVec3, DVec3, f64, DVec3)> = (pairs.iter().zip(&residuals))
        .zip(&used)
        .filter(|(_, used)| **used)
        .map(|(((p, q, w), r), _)| (*p, *q, *w, *r))
        .collect();
    let total: f64 = chosen.iter().map(|c| c.2).sum();
    let source = chosen.iter().map(|c| c.0 * c.2).sum::<DVec3>() / total;
    let target = chosen.iter().map(|c| c.1 * c.2).sum::<DVec3>() / total;
    let free = 3 * chosen.len() - 7;
    let covariance = chosen
        .iter()
        .map(|c| outer(c.3) * c.2)
        .fold(DMat3::ZERO, |a, b| a + b)
        * (3.0 / free as f64);
    // Of few pairs no direction tells its own noise: all share some of what they have together.
    let each = free as f64 / 3.0;
    let together = DMat3::IDENTITY * (trace(covariance) / 3.0);
    let covariance = (covariance * each + together * SHARED) * (each + SHARED).recip();
    let rotation = local.rotation;
    let (mut weighted, mut spread) = (0.0, 0.0);
    let (mut sources, mut targets) = (DMat3::ZERO, DMat3::ZERO);
    for (p, q, w, _) in &chosen {
        let turned = rotation * (*p - source);
        weighted += w * turned.dot(covariance * turned);
        spread += w * turned.length_squared();
        sources += outer(*p - source) * (w * local.scale * local.scale);
        targets += outer(*q - target) * *w;
    }
    let scale_error = weighted.sqrt() / spread / local.scale;
    // Of one coordinate, of weight 1.
    let sigma = (trace(covariance) / 3.0).sqrt();
    let across = beside_the_axis(sources).min(beside_the_axis(targets));
    let rotation_error = sigma / across;
    if rotation_error.is_nan() || rotation_error > LARGEST_ROTATION_ERROR {
        let along = trace(sources).min(trace(targets)).sqrt();
        return Err(match across > NARROW * along {
            true => of_another_shape(sigma / (total / chosen.len() as f64).sqrt()),
            false => on_a_line(),
        });
    }
    if scale_error.is_nan() || scale_error > LARGEST_SCALE_ERROR {
        return Err(Fault::new(
            format!(
                "the known positions give the scale to {:.0} % only",
                scale_error * 100.0
            ),
            "check that they are those of these photos, or add more exact ones",
        ));
    }
    let squares: f64 = chosen.iter().map(|c| c.3.length_squared()).sum();
    Ok(Fit {
        similarity: Similarity::new(local.scale, rotation, local.translation + middle),
        residuals,
        used,
        rms: (squares / chosen.len() as f64).sqrt(),
        scale_error,
        scale_interval: scale_error * t95(free),
        rotation_error,
    })
}
/// The root of the summed squares of the distances from the longest axis, of points with that sum of
/// outer products.
fn beside_the_axis(sum: DMat3) -> f64 {
    let matrix = nalgebra::Matrix3::from_column_slice(&sum.to_cols_array());
    let mut values: Vec<f64> = matrix.symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
        .iter()
        .take(2)
        .map(|value| value.max(0.0))
        .sum::<f64>()
        .sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::split_mix::SplitMix;

    /// Normal numbers by Box and Muller.
    struct Noise(SplitMix);

    impl Noise {
        fn uniform(&mut self) -> f64 {
            ((self.0.next() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
        }

        fn normal(&mut self) -> f64 {
            let (u, v) = (self.uniform(), self.uniform());
            (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
        }

        fn vector(&mut self) -> DVec3 {
            DVec3::new(self.normal(), self.normal(), self.normal())
        }
    }

    fn truth() -> Similarity {
        let rotation = DMat3::from_euler(glam::EulerRot::ZYX, 2.0, -0.4, 1.0);
        Similarity::new(12.5, rotation, DVec3::new(512_345.678, 5_812_345.25, 312.5))
    }

    /// A flight of strips in the reconstruction's frame: `count` places, a little rough in height.
    fn flight(count: usize, noise: &mut Noise) -> Vec<DVec3> {
        (0..count)
            .map(|i| {
                let (strip, along) = (i / 5, i % 5);
                DVec3::new(2.0 * along as f64, strip as f64, 3.0) + noise.vector() * 0.1
            })
            .collect()
    }

    fn pairs_of(points: &[DVec3], sigma: f64, noise: &mut Noise) -> Vec<Pair> {
        (points.iter())
            .map(|&source| Pair {
                source,
                target: truth().apply(source) + noise.vector() * sigma,
                accuracy: None,
            })
            .collect()
    }

    #[test]
    fn exact_positions_give_the_exact_similarity() {
        let mut noise = Noise(SplitMix(1));
        for count in [3, 4, 7, 100] {
            let mut points = flight(count, &mut noise);
            points[2].y += 3.0;
            let found = fit(&pairs_of(&points, 0.0, &mut noise)).unwrap();
            assert_eq!(found.count(), count);
            assert!((found.similarity.scale / 12.5 - 1.0).abs() < 1e-9);
            assert!(found.rms < 1e-8 && found.scale_error < 1e-9, "{found:?}");
            let far = DVec3::new(4.0, 3.0, -8.0);
            let off = found.similarity.apply(far).distance(truth().apply(far));
            assert!(off < 1e-7, "{off}");
        }
    }

    /// Many flights with known noise: the scales scatter as the closed form
    /// sigma / sqrt(sum |q|^2) says, the stated errors agree with it, and the 95 % interval holds the
    /// truth in 95 of 100.
    #[test]
    fn the_standard_error_is_true() {
        let mut noise = Noise(SplitMix(2));
        let points = flight(30, &mut noise);
        let mean = points.iter().sum::<DVec3>() / 30.0;
        let spread: f64 = points.iter().map(|p| (*p - mean).length_squared()).sum();
        let sigma = 1.5;
        let closed_form = sigma / spread.sqrt() / 12.5;
        let trials = 500;
        let (mut squares, mut stated, mut held, mut used) = (0.0, 0.0, 0, 0);
        for _ in 0..trials {
            let found = fit(&pairs_of(&points, sigma, &mut noise)).unwrap();
            let error = found.similarity.scale / 12.5 - 1.0;
            squares += error * error;
            stated += found.scale_error / f64::from(trials);
            held += i32::from(error.abs() < found.scale_interval);
            used += found.count();
        }
        let scatter = (squares / f64::from(trials)).sqrt();
        // 500 trials tell a standard deviation to 3 %.
        assert!(
            (scatter / closed_form - 1.0).abs() < 0.12,
            "{scatter} {closed_form}"
        );
        assert!(
            (stated / closed_form - 1.0).abs() < 0.05,
            "{stated} {closed_form}"
        );
        let share = f64::from(held) / f64::from(trials);
        assert!((0.92..0.975).contains(&share), "{share}");
        assert!(used > 30 * 500 * 98 / 100, "{used}");
    }

    /// Few pairs, as control points are: the interval holds the truth in 95 of 100, and good pairs are hardly ever left out; the
    /// spread of five tells little of a sixth.
    #[test]
    fn few_pairs_are_not_taken_for_wrong() {
        let mut noise = Noise(SplitMix(9));
        // Around a place, as control points are laid out.
        let around = |count: u32, noise: &mut Noise| -> Vec<DVec3> {
            let places =
                (0..count).map(|i| std::f64::consts::TAU * f64::from(i) / f64::from(count));
            let places = places.map(|angle| DVec3::new(4.0 * angle.cos(), 2.0 * angle.sin(), 0.0));
            places.map(|place| place + noise.vector() * 0.1).collect()
        };
        for count in [4, 5, 6, 8, 10] {
            let points = around(count, &mut noise);
            let trials = 1000;
            let (mut held, mut left_out) = (0, 0);
            for _ in 0..trials {
                let found = fit(&pairs_of(&points, 0.05, &mut noise)).unwrap();
                let error = found.similarity.scale / 12.5 - 1.0;
                held += i32::from(error.abs() < found.scale_interval);
                left_out += i32::from(found.count() < points.len());
            }
            let share = f64::from(held) / f64::from(trials);
            assert!((0.93..0.97).contains(&share), "{count}: {share}");
            assert!(left_out < 20, "{count}: {left_out}");
        }
        // Exact but for a millimetre in 60 metres, as lists are written: nobody marks or surveys that.
        for count in [5, 8, 20] {
            let points = around(count, &mut noise);
            let mut pairs = pairs_of(&points, 0.0, &mut noise);
            pairs[0].target += DVec3::new(1e-3, 5e-4, 5e-4);
            assert_eq!(fit(&pairs).unwrap().count(), pairs.len());
            // Half a metre is found.
            pairs[0].target += DVec3::new(0.5, 0.0, 0.0);
            assert_eq!(fit(&pairs).unwrap().count(), pairs.len() - 1);
        }
    }

    /// A corner far from all others is off as far as they let it be, which is more than their own noise; a wrong one is off by more.
    #[test]
    fn a_corner_far_from_all_others_stays() {
        let mut noise = Noise(SplitMix(10));
        for (count, accuracy) in [(5, None), (8, None), (8, Some(0.03)), (20, None)] {
            let trials = 1500;
            let (mut far_left_out, mut held, mut scatter) = (0, 0, 0.0);
            for trial in 0..trials {
                let mut points: Vec<DVec3> = (0..count)
                    .map(|_| noise.vector() * DVec3::new(1.0, 1.0, 0.1))
                    .collect();
                points.push(DVec3::new(25.0, 10.0, 0.5));
                let mut pairs = pairs_of(&points, 0.03, &mut noise);
                for pair in &mut pairs {
                    pair.accuracy = accuracy;
                }
                let found = fit(&pairs).unwrap();
                far_left_out += i32::from(!found.used[points.len() - 1]);
                let error: f64 = found.similarity.scale / 12.5 - 1.0;
                held += i32::from(error.abs() < found.scale_interval);
                scatter += error * error / f64::from(trials);
                // 60 metres in 340, where the others let it be half a metre to five.
                if trial % 10 == 0 {
                    pairs[points.len() - 1].target += DVec3::new(24.0, 48.0, 30.0);
                    let found = fit(&pairs).unwrap();
                    assert!(!found.used[points.len() - 1], "{count}");
                }
            }
            assert!(far_left_out < 8, "{count}: {far_left_out} of {trials}");
            let share = f64::from(held) / f64::from(trials);
            assert!((0.92..0.965).contains(&share), "{count}: {share}");
            // It tells the scale: without it, it is told to 0.03 / 12.5 / √(2 n), five times worse.
            assert!(scatter.sqrt() < 1.5e-4, "{count}: {}", scatter.sqrt());
        }
    }

    /// A position without a fix (0, 0, 0) or a digit too many, thousands of kilometres away, hides neither itself nor a smaller blunder.
    #[test]
    fn what_is_wrong_without_measure_hides_nothing() {
        let mut noise = Noise(SplitMix(11));
        for far in [2e4, 1e6, 5e6] {
            for trial in 0..20 {
                let points = flight(20, &mut noise);
                let mut pairs = pairs_of(&points, 0.03, &mut noise);
                pairs[3].target.y -= far;
                pairs[11].target.x += 0.6;
                // Marked in a wrong photo, too.
                pairs[17].source += noise.vector() * 1e3;
                let found = fit(&pairs).unwrap();
                let wrong = [3, 11, 17].map(|place| found.used[place]);
                assert_eq!(wrong, [false; 3], "{far}, {trial}");
                assert!(found.count() >= 15, "{}", found.count());
                assert!((found.similarity.scale / 12.5 - 1.0).abs() < 1e-3);
            }
        }
    }

    /// Heights three times as noisy as positions: the scale of a level flight does not suffer.
    #[test]
    fn noise_that_differs_by_direction() {
        let mut noise = Noise(SplitMix(3));
        let points = flight(50, &mut noise);
        let level = Similarity::new(12.5, DMat3::IDENTITY, DVec3::ZERO);
        let (mut squares, mut stated) = (0.0, 0.0);
        for _ in 0..300 {
            let pairs: Vec<Pair> = (points.iter())
                .map(|&source| Pair {
                    source,
                    target: level.apply(source) + noise.vector() * DVec3::new(0.5, 0.5, 1.5),
                    accuracy: None,
                })
                .collect();
            let found = fit(&pairs).unwrap();
            squares += (found.similarity.scale / 12.5 - 1.0).powi(2) / 300.0;
            stated += found.scale_error / 300.0;
        }
        let scatter = squares.sqrt();
        assert!((stated / scatter - 1.0).abs() < 0.2, "{stated} {scatter}");
    }

    #[test]
    fn a_third_of_the_positions_may_be_wrong() {
        let mut noise = Noise(SplitMix(4));
        for count in [10, 40, 200] {
            let points = flight(count, &mut noise);
            let mut pairs = pairs_of(&points, 0.5, &mut noise);
            let wrong = count * 3 / 10;
            for pair in pairs.iter_mut().take(wrong) {
                // All by the same 60 m: they agree with each other.
                pair.target += DVec3::new(60.0, 5.0, 8.0) + noise.vector();
            }
            let found = fit(&pairs).unwrap();
            assert!(found.used[..wrong].iter().all(|used| !used), "{count}");
            let kept = found.used[wrong..].iter().filter(|used| **used).count();
            assert!(kept * 10 >= (count - wrong) * 9, "{kept} of {count}");
            assert!((found.similarity.scale / 12.5 - 1.0).abs() < 4.0 * found.scale_error);
        }
    }

    /// Four corners of a square of which one is typed 20 too high do not lie on a line: the fit says what they do.
    #[test]
    fn a_wrong_number_is_no_line() {
        let source = [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)]
            .map(|(x, y)| DVec3::new(x, y, 0.0));
        let pairs = |off: f64| -> Vec<Pair> {
            let targets = source.iter().enumerate();
            let targets = targets.map(|(index, source)| Pair {
                source: *source,
                target: *source * 2.0 + DVec3::Z * if index == 3 { off } else { 0.0 },
                accuracy: None,
            });
            targets.collect()
        };
        assert!(fit(&pairs(0.0)).is_ok());
        let fault = fit(&pairs(120.0)).unwrap_err();
        assert!(
            fault.what.contains("are not of the shape") && !fault.what.contains("on a line"),
            "{fault}"
        );
    }

    /// Two groups of photos far apart and not on a line together.
    #[test]
    fn two_clusters() {
        let mut noise = Noise(SplitMix(5));
        let points: Vec<DVec3> = (0..40)
            .map(|i| DVec3::X * if i % 2 == 0 { 0.0 } else { 200.0 } + noise.vector())
            .collect();
        let found = fit(&pairs_of(&points, 0.2, &mut noise)).unwrap();
        assert!(found.count() >= 38);
        assert!((found.similarity.scale / 12.5 - 1.0).abs() < 4.0 * found.scale_error);
    }

    #[test]
    fn a_line_is_refused() {
        let mut noise = Noise(SplitMix(6));
        for (sideways, sigma) in [(0.0, 0.0), (0.0, 0.5), (0.002, 0.5)] {
            let points: Vec<DVec3> = (0..30)
                .map(|i| {
                    DVec3::new(f64::from(i), 0.5 * f64::from(i), 0.1) + noise.vector() * sideways
                })
                .collect();
            let fault = fit(&pairs_of(&points, sigma, &mut noise)).unwrap_err();
            assert!(fault.what.contains("on a line"), "{fault}");
        }
        // The same strip from an exact receiver: its wobble is enough.
        let points: Vec<DVec3> = (0..30)
            .map(|i| DVec3::new(f64::from(i), 0.5 * f64::from(i), 0.1) + noise.vector() * 0.1)
            .collect();
        assert!(fit(&pairs_of(&points, 0.02, &mut noise)).is_ok());
    }

    #[test]
    fn accuracies_weigh_and_forgive() {
        let mut noise = Noise(SplitMix(7));
        let points = flight(20, &mut noise);
        let mut pairs = pairs_of(&points, 0.01, &mut noise);
        for pair in &mut pairs {
            pair.accuracy = Some(0.01);
        }
        // A poor receiver on the second half says so: used, with little weight.
        for pair in &mut pairs[10..] {
            pair.target += noise.vector() * 5.0;
            pair.accuracy = Some(5.0);
        }
        let found = fit(&pairs).unwrap();
        assert!(found.count() >= 18, "{found:?}");
        let best: f64 = found.residuals[..10]
            .iter()
            .map(|r| r.length())
            .fold(0.0, f64::max);
        assert!(best < 0.05, "{best}");
    }

    #[test]
    fn what_says_nothing_is_refused() {
        let mut noise = Noise(SplitMix(8));
        let points = flight(20, &mut noise);
        let mut pairs = pairs_of(&points, 0.0, &mut noise);
        assert!(fit(&pairs[..2]).unwrap_err().what.contains("too few"));
        for pair in &mut pairs {
            pair.target = noise.vector() * 100.0;
        }
        assert!(fit(&pairs).is_err());
        pairs[0].target = DVec3::NAN;
        assert!(fit(&pairs).unwrap_err().what.contains("finite"));
        let same = vec![
            Pair {
                source: DVec3::X,
                target: DVec3::Y,
                accuracy: None
            };
            5
        ];
        assert!(fit(&same).is_err());
    }
}
