//! One-way analysis of variance.
//!
//! Two passes, compensated. The first takes the mean of all values, and all are counted from there:
//! what they have in common (the constant leading digits of NIST's SmLs sets) is gone without a
//! rounding. The second takes the means of the groups and sums squares of the differences from them,
//! corrected for the rounding of the mean: Chan, Golub and LeVeque, "Algorithms for computing the
//! sample variance", The American Statistician 37 (1983) 242-247, equation 1.7. Every sum is
//! Neumaier's (`compensated`).
//!
//! What remains is the input: 1000000000000.4 (SmLs07) as a double is off by 2e-5, which moves its F
//! by 4e-5 of itself; of the doubles the table is right to about 13 digits.

mod compensated;
mod f_distribution;
mod repeatability;

pub use repeatability::{Repeatability, repeatability};

use crate::fault::Fault;
use compensated::compensated_sum;
use f_distribution::{MOST, critical_value, lower_tail, upper_tail};

/// The probability of an F as small or smaller, below which a note is made.
const STRANGELY_SMALL: f64 = 0.001;

/// One source of variation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variation {
    /// Degrees of freedom.
    pub degrees_of_freedom: usize,
    /// In the square of the values' unit.
    pub sum_of_squares: f64,
    /// Sum of squares per degree of freedom.
    pub mean_square: f64,
}

impl Variation {
    fn new(degrees_of_freedom: usize, sum_of_squares: f64) -> Self {
        Self {
            degrees_of_freedom,
            sum_of_squares,
            mean_square: sum_of_squares / degrees_of_freedom as f64,
        }
    }
}

/// A table of a one-way analysis of variance.
#[derive(Debug, Clone, PartialEq)]
pub struct Anova {
    /// Between the groups (trials).
    pub between: Variation,
    /// Within the groups: the residual.
    pub within: Variation,
    /// About the mean of all values.
    pub total: Variation,
    /// Mean square between over mean square within; `None` where nothing varies within.
    pub f: Option<f64>,
    /// Probability of such an F or a larger one if the groups do not differ; 0 where nothing varies
    /// within but the groups differ, `None` where nothing varies at all.
    pub p: Option<f64>,
    /// Share of the sum of squares that lies between the groups; `None` where nothing varies.
    pub r_squared: Option<f64>,
    /// Root of the mean square within, in the values' unit.
    pub residual_standard_deviation: f64,
    /// The level of significance (0.05).
    pub level: f64,
    /// The F that is exceeded with the probability `level` if the groups do not differ.
    pub critical_f: f64,
    /// What to know before trusting it, one sentence each.
    pub notes: Vec<String>,
}

impl Anova {
    /// Of groups of values in one unit.
    ///
    /// # Errors
    ///
    /// Fewer than two groups, an empty group, a value that is not finite, no more values than groups,
    /// values whose squares are too large for a double, groups or
    /// values by the hundred thousand, a level that is not between 0 and 1.
    pub fn of_groups<G: AsRef<[f64]>>(groups: &[G], level: f64) -> Result<Self, Fault> {
        let groups: Vec<&[f64]> = groups.iter().map(AsRef::as_ref).collect();
        let remedy = "give two or more values of two or more groups";
        if groups.len() < 2 {
            let what = match groups.len() {
                0 => "there is no group",
                _ => "there is one group only",
            };
            return Err(Fault::new(what, remedy));
        }
        if groups.iter().any(|group| group.is_empty()) {
            return Err(Fault::new("a group has no value", remedy));
        }
        if let Some(bad) = groups.concat().iter().find(|value| !value.is_finite()) {
            let what = format!("the value {bad} is not finite");
            return Err(Fault::new(what, "give numbers"));
        }
        let count: usize = groups.iter().map(|group| group.len()).sum();
        if count == groups.len() {
            let what =
                "every group has one value only, so nothing shows how values vary within one";
            return Err(Fault::new(what, remedy));
        }
        let pivot = mean(groups.iter().copied().flatten().copied());
        // Differences of neighbours are exact.
        let groups: Vec<Vec<f64>> = groups
            .iter()
            .map(|group| group.iter().map(|value| value - pivot).collect())
            .collect();
        let all = mean(groups.iter().flatten().copied());
        let means: Vec<f64> = groups
            .iter()
            .map(|group| mean(group.iter().copied()))
            .collect();
        let between = compensated_sum(
            groups
                .iter()
                .zip(&means)
                .map(|(group, mean)| group.len() as f64 * (mean - all) * (mean - all)),
        );
        let within = compensated_sum(
            groups
                .iter()
                .zip(&means)
                .map(|(group, mean)| squares_about(group, *mean)),
        );
        Self::of_sums(
            (groups.len() - 1, between),
            (count - groups.len(), within),
            level,
        )
    }

    /// Of (degrees of freedom, sum of squares) between and within groups, as tables publish them.
    ///
    /// # Errors
    ///
    /// No degree of freedom or too many, a sum of squares that is no number from 0 up, a level that is not between
    /// 0 and 1.
    pub fn of_sums(between: (usize, f64), within: (usize, f64), level: f64) -> Result<Self, Fault> {
        if !(level > 0.0 && level < 1.0) {
            let what = format!("a level of significance of {level}");
            return Err(Fault::new(
                what,
                "give a level between 0 and 1, such as 0.05",
            ));
        }
        for (source, (degrees, sum)) in [("between", between), ("within", within)] {
            if degrees == 0 {
                let what = format!("no degree of freedom {source} the groups");
                return Err(Fault::new(what, "give 1 or more"));
            }
            if !(sum.is_finite() && sum >= 0.0) {
                let what = format!("a sum of squares of {sum} {source} the groups");
                return Err(Fault::new(what, "give a finite number from 0 up"));
            }
        }
        let degrees = [between.0, within.0];
        if let Some(most) = (MOST.iter().zip(degrees)).find(|(most, degrees)| degrees > *most) {
            let what = format!("{} degrees of freedom", most.1);
            return Err(Fault::new(what, format!("give {} or fewer", most.0)));
        }
        let total = Variation::new(between.0.saturating_add(within.0), between.1 + within.1);
        let (between, within) = (
            Variation::new(between.0, between.1),
            Variation::new(within.0, within.1),
        );
        let mut notes = Vec::new();
        let f = (within.sum_of_squares > 0.0)
            .then(|| between.mean_square / within.mean_square)
            .filter(|f| f.is_finite());
        let p = match f {
            Some(f) => upper_tail(degrees, f),
            None => (between.sum_of_squares > 0.0).then_some(0.0),
        };
        if f.is_none() {
            notes.push(
                match p {
                    None => "all values are the same: there is no F",
                    Some(_) => {
                        "values do not vary within the groups, which differ: F is without bound"
                    }
                }
                .to_owned(),
            );
        }
        let by_chance = f.and_then(|f| lower_tail(degrees, f));
        if let (Some(f), Some(chance)) = (f, by_chance.filter(|chance| *chance < STRANGELY_SMALL)) {
            notes.push(format!(
                "F = {f:.2e} is smaller than chance makes it (probability {chance:.1e}): values of a \
                 group differ for a reason that all groups share, such as several sizes or \
                 percentiles in one group, and what differs between groups drowns in that; look at \
                 each size on its own"
            ));
        }
        let Some(critical_f) = critical_value(degrees, level) else {
            let what = format!("F({}, {}) cannot be computed", degrees[0], degrees[1]);
            return Err(Fault::new(what, "give fewer degrees of freedom"));
        };
        Ok(Self {
            between,
            within,
            f,
            p,
            r_squared: (total.sum_of_squares > 0.0)
                .then(|| between.sum_of_squares / total.sum_of_squares),
            residual_standard_deviation: within.mean_square.sqrt(),
            total,
            level,
            critical_f,
            notes,
        })
    }

    /// Whether the groups differ at the level; `None` where nothing varies at all.
    pub fn differs(&self) -> Option<bool> {
        self.p.map(|p| p < self.level)
    }

    /// The verdict, where `groups` is their name in the plural: "trials do not differ at the 5 % level".
    pub fn verdict(&self, groups: &str) -> String {
        // The product may end in ...0001; seven digits are what a level has.
        let percent = (self.level * 1e9).round() / 1e7;
        match self.differs() {
            Some(true) => format!("{groups} differ at the {percent} % level"),
            Some(false) => format!("{groups} do not differ at the {percent} % level"),
            None => format!("{groups} do not differ at all: all values are the same"),
        }
    }
}

/// The mean of values; exactly the value where all are the same.
fn mean(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let first = values.clone().next().unwrap_or(0.0);
    if values.clone().all(|value| value == first) {
        return first;
    }
    let count = values.clone().count() as f64;
    let mean = compensated_sum(values.clone()) / count;
    if mean.is_finite() {
        mean
    } else {
        // As a sum of shares it does not overflow where the mean does not.
        compensated_sum(values.map(|value| value / count))
    }
}

/// The sum of squared differences from the mean, corrected for the rounding of the mean.
fn squares_about(values: &[f64], mean: f64) -> f64 {
    let squares = compensated_sum(values.iter().map(|value| (value - mean) * (value - mean)));
    let rest = compensated_sum(values.iter().map(|value| value - mean));
    (squares - rest * rest / values.len() as f64).max(0.0)
}

#[cfg(test)]
#[allow(clippy::expect_used, reason = "in a test a panic is the report")]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64, relative: f64) {
        assert!(
            (found / expected - 1.0).abs() < relative,
            "{found} instead of {expected}"
        );
    }

    /// scipy.stats.f_oneway([1, 2, 4, 5], [2, 3, 7], [6, 6]) and the sums by hand: means 3, 4, 6 about
    /// 4 with squares 4 + 0 + 8 = 12; within 10 + 14 + 0 = 24.
    #[test]
    fn groups_of_different_sizes() {
        let groups = [
            vec![1.0, 2.0, 4.0, 5.0],
            vec![2.0, 3.0, 7.0],
            vec![6.0, 6.0],
        ];
        let table = Anova::of_groups(&groups, 0.05).expect("a table");
        near(table.between.sum_of_squares, 12.0, 1e-15);
        near(table.within.sum_of_squares, 24.0, 1e-15);
        assert_eq!(table.between.degrees_of_freedom, 2);
        assert_eq!(table.within.degrees_of_freedom, 6);
        assert_eq!(table.total.degrees_of_freedom, 8);
        near(table.f.expect("an F"), 1.5, 1e-14);
        // With 2 degrees of freedom between: (1 + 2 f / 6)^-3.
        near(table.p.expect("a p"), 1.5_f64.powi(-3), 1e-13);
        near(table.r_squared.expect("a share"), 1.0 / 3.0, 1e-14);
        near(table.residual_standard_deviation, 2.0, 1e-15);
        assert_eq!(
            table.verdict("trials"),
            "trials do not differ at the 5 % level"
        );
    }

    /// The paper's Tables II and III: mean squares and F as printed there.
    #[test]
    fn the_papers_tables() {
        for (sums, mean_squares, f) in [
            ([1.9, 1255.3], [0.21, 62.76], "0.003"),
            ([8.6, 1170.0], [0.96, 58.50], "0.016"),
        ] {
            let table = Anova::of_sums((9, sums[0]), (20, sums[1]), 0.05).expect("a table");
            for (source, printed) in [table.between, table.within].iter().zip(mean_squares) {
                // 1255.3 / 20 is 62.765.
                assert!((source.mean_square - printed).abs() < 0.0051);
            }
            assert_eq!(format!("{:.3}", table.f.expect("an F")), f);
            assert_eq!(format!("{:.2}", table.critical_f), "2.39");
            assert!(table.p.expect("a p") > 0.99);
            assert_eq!(table.differs(), Some(false));
            // So small an F does not come by chance: every trial holds the same several sizes.
            assert!(
                table
                    .notes
                    .iter()
                    .any(|note| note.contains("each size on its own"))
            );
        }
    }

    /// Replicates and trials without anything in common make no note, and a real difference is found.
    #[test]
    fn a_difference_is_found() {
        let table =
            Anova::of_groups(&[[10.0, 11.0, 12.0], [20.0, 21.0, 22.0]], 0.01).expect("a table");
        near(table.f.expect("an F"), 150.0, 1e-14);
        assert_eq!(table.verdict("photos"), "photos differ at the 1 % level");
        assert!(table.notes.is_empty());
    }

    #[test]
    fn what_does_not_vary_is_said() {
        let apart = Anova::of_groups(&[[0.1, 0.1, 0.1], [0.7, 0.7, 0.7]], 0.05).expect("a table");
        assert_eq!((apart.f, apart.p), (None, Some(0.0)));
        assert_eq!(apart.within.sum_of_squares, 0.0);
        assert_eq!(apart.differs(), Some(true));
        assert!(
            apart.notes[0].contains("without bound"),
            "{:?}",
            apart.notes
        );
        let same = Anova::of_groups(&[[0.1; 3], [0.1; 3]], 0.05).expect("a table");
        assert_eq!((same.f, same.p, same.r_squared), (None, None, None));
        assert_eq!(same.differs(), None);
        assert!(same.notes[0].contains("all values are the same"));
    }

    #[test]
    fn refuses_in_a_sentence() {
        let of = |groups: &[Vec<f64>]| Anova::of_groups(groups, 0.05);
        let refused = [
            (of(&[]), "no group"),
            (of(&[vec![1.0, 2.0]]), "one group only"),
            (of(&[vec![1.0, 2.0], vec![]]), "a group has no value"),
            (of(&[vec![1.0], vec![2.0]]), "one value only"),
            (of(&[vec![1.0, f64::NAN], vec![2.0]]), "NaN is not finite"),
            (
                of(&[vec![1e300, -1e300], vec![2.0]]),
                "a sum of squares of inf",
            ),
            (
                Anova::of_sums((9, 1.0), (20, 1.0), 5.0),
                "of significance of 5",
            ),
            (
                Anova::of_sums((0, 1.0), (20, 1.0), 0.05),
                "no degree of freedom between",
            ),
            (Anova::of_sums((9, 1.0), (20, -1.0), 0.05), "of -1 within"),
            (
                Anova::of_sums((9, 1.0), (usize::MAX, 1.0), 0.05),
                "degrees of freedom; give 1000000 or fewer",
            ),
        ];
        for (result, sentence) in refused {
            let fault = result.expect_err(sentence).to_string();
            assert!(fault.contains(sentence), "{fault}");
        }
    }

    /// A shift of all values by a whole number changes nothing; without the first pass it would.
    #[test]
    fn what_all_values_share_does_not_matter() {
        let values = [[0.25, 0.5, 0.75], [0.5, 0.75, 1.25]];
        let far = values.map(|group| group.map(|value| value + 1e14));
        let [f, far] = [values, far].map(|groups| {
            let table = Anova::of_groups(&groups, 0.05).expect("a table");
            table.f.expect("an F")
        });
        near(far, f, 1e-13);
    }
}
