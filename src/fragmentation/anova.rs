//! One-way analysis of variance.

use super::DistributionSet;
use crate::fault::Fault;

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
    /// Probability of such an F or a larger one if the groups do not differ.
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
    /// values that are all the same, a level that is not between 0 and 1.
    pub fn of_groups<G: AsRef<[f64]>>(groups: &[G], level: f64) -> Result<Self, Fault> {
        let _ = (groups, level);
        Err(Fault::new("nothing is analysed yet", "wait"))
    }

    /// Of published (degrees of freedom, sum of squares) between and within groups.
    ///
    /// # Errors
    ///
    /// No degree of freedom, a sum of squares that is no number from 0 up, both 0, a level that is not
    /// between 0 and 1.
    pub fn of_sums(between: (usize, f64), within: (usize, f64), level: f64) -> Result<Self, Fault> {
        let _ = (between, within, level);
        Err(Fault::new("nothing is analysed yet", "wait"))
    }

    /// Whether the groups differ at the level; `None` without an F.
    pub fn differs(&self) -> Option<bool> {
        Some(self.f? > self.critical_f)
    }

    /// The verdict, where `groups` is their name in the plural: "trials do not differ at the 5 % level".
    pub fn verdict(&self, groups: &str) -> String {
        let _ = groups;
        String::new()
    }
}

/// Whether a method gives the same distribution in every trial.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeatability {
    /// The method.
    pub method: String,
    /// The trials: the groups.
    pub trials: Vec<String>,
    /// Percent passing of one size, where trials have several photos; an error says why a size has no
    /// table. Empty with one curve a trial. Sizes in the set's unit.
    pub per_size: Vec<(f64, Result<Anova, Fault>)>,
    /// All values of a trial in one group, as in the paper's Tables II and III.
    pub pooled: Anova,
}

/// Analyses the trials of a method: are they alike? The values are percents passing at `sizes` (the
/// sizes of the method's curves that all of them know, where it is empty).
///
/// # Errors
///
/// No such method, one trial only, no size that all curves know, what [`Anova::of_groups`] refuses.
pub fn repeatability(
    set: &DistributionSet,
    method: &str,
    sizes: &[f64],
    level: f64,
) -> Result<Repeatability, Fault> {
    let _ = (set, method, sizes, level);
    Err(Fault::new("nothing is analysed yet", "wait"))
}
