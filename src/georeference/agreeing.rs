//! Which of many pairs of positions agree on a similarity, of which some may be wrong.
//!
//! Three pairs make a similarity. Of many minimal samples of three (all, or random ones of a fixed seed) the best ten
//! are drawn together on the half of the pairs that fits best (the concentration steps of Rousseeuw &
//! Van Driessen, "A fast algorithm for the minimum covariance determinant estimator", 1999), and the
//! one whose better half has the least of largest residuals wins (least quantile of squares, Rousseeuw
//! 1984): nearly half of the pairs may be wrong, of four none. The spread of the good ones follows
//! from that residual, and then from all that agree. Pairs farther off
//! than 99.9 % of good ones would be are outliers, of a spread that few pairs tell by Fisher's F; where accuracies
//! are stated, no pair is one within its accuracy, and none is that is less off than anybody marks or surveys: a
//! ten-thousandth of the extent, which moves the scale by no more.
//!
//! A pair that had no part in a similarity is off by its own noise and by what the similarity has there, which grows with the distance from those that
//! made it. With q the target from the weighted mean of those pairs, W the sum of their weights, S that of w |q|² and M that
//! of w (|q|² I - q qᵀ), the covariance of where the similarity has it is, for noise of variance 1 / w,
//!
//! ```text
//! C = J N⁻¹ Jᵀ = I / W + q qᵀ / S + [q] M⁻¹ [q]ᵀ,   [q] v = q × v
//! ```
//!
//! (translation, scale and rotation do not mix), and its residual r has I / w + C: it counts as far off as √(rᵀ (I / w + C)⁻¹ r). Without that a
//! corner far from all others, which tells the scale best, was left out for being off as far as the others let it be.

use glam::{DMat3, DVec3};

use super::student::length_999;
use super::umeyama::similarity_of;
use crate::fault::Fault;
use crate::geometry::Similarity;
use crate::split_mix::SplitMix;

/// Of good residuals' lengths in space, 99.9 % are below this many standard deviations (of one
/// coordinate): the root of the quantile of chi squared with three degrees of freedom. A tighter cut
/// would take good ones away and with them the honesty of the standard error.
const LENGTH_999: f64 = 4.033_142;
/// Pairs that are off by so much of how far they reach from their middle may be good, however well the others fit.
const LEAST_OFF: f64 = 1e-4;
/// And half are below this many.
const LENGTH_50: f64 = 1.538_172;
/// As many minimal samples are tried at most.
const MOST_SAMPLES: usize = 500;
/// As many of them are drawn together.
const FINALISTS: usize = 10;

pub(super) fn on_a_line() -> Fault {
    Fault::new(
        "the known positions lie on a line, so that the rotation about it is not determined",
        "add positions beside it, such as ground control points or a crossing strip",
    )
}

/// A source, its target and the pair's weight.
pub(super) type Weighted = (DVec3, DVec3, f64);

/// Which of the pairs agree on one similarity, in order; targets count from their middle. Where accuracies are stated a weight is their
/// inverse square, and residuals count in them.
///
/// # Errors
/// Pairs on a line, or less than half of them that agree.
pub(super) fn agreeing(
    pairs: &[Weighted],
    accuracies_are_stated: bool,
) -> Result<Vec<usize>, Fault> {
    let problem = Problem {
        pairs,
        least_spread: if accuracies_are_stated { 1.0 } else { 0.0 },
    };
    let best = problem.most_agreed_on().ok_or_else(on_a_line)?;
    problem.inliers(&best)
}

/// The similarity of those at these indices.
pub(super) fn of_indices(pairs: &[Weighted], indices: &[usize]) -> Option<Similarity> {
    let chosen = indices.iter().filter_map(|&index| pairs.get(index));
    similarity_of(&chosen.copied().collect::<Vec<_>>())
}

struct Problem<'a> {
    pairs: &'a [Weighted],
    /// Standard deviations that are stated are no smaller.
    least_spread: f64,
}

impl Problem<'_> {
    /// The residuals' lengths, in accuracies where those are stated.
    fn distances(&self, similarity: &Similarity) -> Vec<f64> {
        (self.pairs.iter())
            .map(|(p, q, w)| q.distance(similarity.apply(*p)) * w.sqrt())
            .collect()
    }

    /// The same for the pairs that made it; of the others in what both their noise and the similarity's makes of it.
    fn distances_of_those_that_did_not_make(
        &self,
        similarity: &Similarity,
        made: &[usize],
    ) -> Vec<f64> {
        let of_pairs = made.iter().filter_map(|&index| self.pairs.get(index));
        let noise = SimilarityNoise::of(&of_pairs.copied().collect::<Vec<_>>());
        let mut had_no_part = vec![true; self.pairs.len()];
        for &index in made {
            had_no_part[index] = false;
        }
        let mut distances = self.distances(similarity);
        for ((pair, distance), alone) in self.pairs.iter().zip(&mut distances).zip(had_no_part) {
            if alone {
                *distance = noise.standardized(similarity.apply(pair.0), pair.1, pair.2);
            }
        }
        distances
    }

    /// The size of the half that lets most pairs be wrong (Rousseeuw & Leroy 1987), where three pairs
    /// make a similarity: all of four, seven of ten, 52 of 100.
    fn half(&self) -> usize {
        usize::midpoint(self.pairs.len(), 4).min(self.pairs.len())
    }

    /// The largest distance in the better half.
    fn of_better_half(&self, distances: &[f64]) -> f64 {
        let mut sorted = distances.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted
            .get(self.half() - 1)
            .copied()
            .unwrap_or(f64::INFINITY)
    }

    /// The similarity with the least residual of the better half.
    fn most_agreed_on(&self) -> Option<Similarity> {
        let score = |similarity: &Similarity| self.of_better_half(&self.distances(similarity));
        let mut found: Vec<(f64, Similarity)> = minimal_samples(self.pairs.len())
            .filter_map(|three| of_indices(self.pairs, &three))
            .map(|similarity| (score(&similarity), similarity))
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found.truncate(FINALISTS);
        let mut drawn_together: Vec<(f64, Similarity)> = (found.iter())
            .map(|(_, similarity)| self.concentrated(similarity))
            .map(|similarity| (score(&similarity), similarity))
            .collect();
        drawn_together.append(&mut found);
        let best = drawn_together
            .into_iter()
            .min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, similarity)| similarity)
    }

    /// Fits the better half again and again.
    fn concentrated(&self, start: &Similarity) -> Similarity {
        let mut similarity = *start;
        for _ in 0..10 {
            match of_indices(self.pairs, &self.better_half(&similarity)) {
                Some(next) => similarity = next,
                None => break,
            }
        }
        similarity
    }

    /// Which are in the better half.
    fn better_half(&self, similarity: &Similarity) -> Vec<usize> {
        let distances = self.distances(similarity);
        let mut order: Vec<usize> = (0..distances.len()).collect();
        order.sort_by(|&a, &b| distances[a].total_cmp(&distances[b]));
        order.truncate(self.half());
        order
    }

    /// Nobody marks or surveys better: no pair with such a residual is wrong. Of how far those reach that made a similarity, for a wrong
    /// one may be on the other side of the Earth.
    fn least(&self, made: &[usize]) -> f64 {
        let targets = || {
            made.iter()
                .filter_map(|&index| self.pairs.get(index))
                .map(|pair| pair.1)
        };
        let middle = targets().sum::<DVec3>() / made.len() as f64;
        LEAST_OFF
            * targets()
                .map(|target| target.distance(middle))
                .fold(0.0, f64::max)
    }

    /// The pairs that agree with a similarity, and with the one that they then make together.
    fn inliers(&self, best: &Similarity) -> Result<Vec<usize>, Fault> {
        let count = self.pairs.len();
        let middle = self.of_better_half(&self.distances(best));
        let half = self.better_half(best);
        let distances = self.distances_of_those_that_did_not_make(best, &half);
        // Few pairs fit too well: the correction of Rousseeuw & Leroy 1987 (p. 202).
        let correction = match count {
            3 => f64::INFINITY,
            _ => 1.0 + 5.0 / (count - 3) as f64,
        };
        let first = (middle / LENGTH_50 * correction).max(self.least_spread);
        let within = |distances: &[f64], far: f64, made: &[usize]| -> Vec<usize> {
            let least = self.least(made);
            let near = |index: &usize| {
                let weight = self.pairs.get(*index).map_or(1.0, |pair| pair.2);
                let limit = far.max(least * weight.sqrt());
                distances.get(*index).is_some_and(|d| *d <= limit)
            };
            (0..count).filter(near).collect()
        };
        let mut used = within(&distances, LENGTH_999 * first, &half);
        for _ in 0..20 {
            if used.len() < 3 {
                break;
            }
            let similarity = of_indices(self.pairs, &used).ok_or_else(on_a_line)?;
            let distances = self.distances_of_those_that_did_not_make(&similarity, &used);
            // The best of many minimal samples fits better than the noise is; all together tell it.
            let squares: f64 = used
                .iter()
                .filter_map(|i| distances.get(*i))
                .map(|d| d * d)
                .sum();
            let free = 3 * used.len() - 7;
            let spread = (squares / free as f64).sqrt();
            // What is known beforehand is not estimated from few.
            let far = (length_999(free) * spread).max(LENGTH_999 * first);
            let next = within(&distances, far, &used);
            if next == used {
                break;
            }
            used = next;
        }
        if used.len() < 3 || used.len() * 2 < count {
            return Err(Fault::new(
                format!(
                    "only {} of {count} known positions agree with each other",
                    used.len()
                ),
                "check that they are those of these photos",
            ));
        }
        Ok(used)
    }
}

pub(super) fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

/// What is not sure of a similarity that weighted pairs made (the module's header).
struct SimilarityNoise {
    middle: DVec3,
    /// W and S.
    weight: f64,
    spread: f64,
    /// M⁻¹.
    turns: DMat3,
}

impl SimilarityNoise {
    fn of(pairs: &[Weighted]) -> Self {
        let weight: f64 = pairs.iter().map(|pair| pair.2).sum();
        let middle = pairs.iter().map(|pair| pair.1 * pair.2).sum::<DVec3>() / weight;
        let (mut spread, mut outer_products) = (0.0, DMat3::ZERO);
        for (_, target, w) in pairs {
            let q = *target - middle;
            spread += w * q.length_squared();
            outer_products += outer(q) * *w;
        }
        Self {
            middle,
            weight,
            spread,
            turns: (DMat3::from_diagonal(DVec3::splat(spread)) - outer_products).inverse(),
        }
    }

    /// How far a target is off where the similarity has it, in standard deviations of a coordinate, of a pair that had no part in it.
    /// Either of both may be wrong, and is not where it would excuse that.
    fn standardized(&self, has_it: DVec3, target: DVec3, weight: f64) -> f64 {
        let residual = target - has_it;
        let (a, b) = (has_it - self.middle, target - self.middle);
        let q = if a.length_squared() < b.length_squared() {
            a
        } else {
            b
        };
        let along = outer(q) * self.spread.recip();
        // [q]
        let across = DMat3::from_cols(q.cross(DVec3::X), q.cross(DVec3::Y), q.cross(DVec3::Z));
        let turned = across * self.turns * across.transpose();
        let own = DMat3::from_diagonal(DVec3::splat(weight.recip() + self.weight.recip()));
        let squared = residual.dot((own + along + turned).inverse() * residual);
        // Pairs on a line say nothing of what lies beside it.
        match squared.is_finite() {
            true => squared.max(0.0).sqrt(),
            false => residual.length() * weight.sqrt(),
        }
    }
}

/// Minimal samples, three indices each: all of them where they are few, else random ones, always the same.
fn minimal_samples(count: usize) -> Box<dyn Iterator<Item = [usize; 3]>> {
    if count * (count - 1) * (count - 2) / 6 <= MOST_SAMPLES {
        return Box::new((0..count).flat_map(move |a| {
            (a + 1..count).flat_map(move |b| (b + 1..count).map(move |c| [a, b, c]))
        }));
    }
    let mut random = SplitMix(20_170_601);
    let mut index = move || (random.next() % count as u64) as usize;
    let three = move || [index(), index(), index()];
    Box::new(
        std::iter::repeat_with(three)
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .take(MOST_SAMPLES),
    )
}
