//! Many size distributions in one unit, each with what it is of.

use std::fmt;

use super::SizeDistribution;
use crate::units::LengthUnit;

/// What a distribution is of. A label that is not known is empty.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Labels {
    /// How it was measured: "sieve", "point cloud", "scale object".
    pub method: String,
    /// Which repetition of the measurement.
    pub trial: String,
    /// Which photo.
    pub photo: String,
}

impl Labels {
    /// As the beginning of a sentence about the distribution: "sieve / 1: ", or nothing.
    pub(super) fn in_front(&self) -> String {
        match self.to_string() {
            name if name.is_empty() => name,
            name => format!("{name}: "),
        }
    }
}

impl fmt::Display for Labels {
    /// Those that are known, separated by " / ".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = [&self.method, &self.trial, &self.photo];
        let known: Vec<&str> = known
            .into_iter()
            .map(String::as_str)
            .filter(|label| !label.is_empty())
            .collect();
        f.write_str(&known.join(" / "))
    }
}

/// A distribution with what it is of.
#[derive(Debug, Clone, PartialEq)]
pub struct LabelledDistribution {
    /// What it is of.
    pub labels: Labels,
    /// Area or mass that it stands for, where the input says so.
    pub weight: Option<f64>,
    /// The points; sizes in the set's unit.
    pub distribution: SizeDistribution,
}

/// Size distributions in one unit.
#[derive(Debug, Clone, PartialEq)]
pub struct DistributionSet {
    /// The unit of all sizes.
    pub unit: LengthUnit,
    /// In the order of the input; no two have the same labels.
    pub curves: Vec<LabelledDistribution>,
}
