//! Columns of sizes that a percent passes.

use super::names::{take_unit_of_size, without_passing};
use super::size_unit::SizeUnit;
use super::vocabulary::{says_retained, words};
use crate::tables::table::split_number;

/// A column of sizes that a percent passes: "D50", "P80 (mm)", "x50", "d(0.5)", "Dv10", "50 % passing (cm)".
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PercentileColumn {
    /// The number as it is called: of 0 to 100, neither included at 0; where a set is of shares, of 0 to 1.
    pub(super) percent: f64,
    pub(super) unit: Option<SizeUnit>,
    /// What the columns of one set have in common: the letter and what follows the number.
    pub(super) set: String,
}

impl PercentileColumn {
    pub(super) fn of(name: &str) -> Option<Self> {
        let name = name.trim().to_lowercase();
        Self::by_letter(&name).or_else(|| Self::by_percent(&name))
    }

    /// "D50", "Dx (10)", "d(v, 0.5)": a letter in front, and that it is by volume.
    fn by_letter(name: &str) -> Option<Self> {
        let letter = name.chars().next().filter(|c| "dpxkf".contains(*c))?;
        let separators = [' ', '_', '(', '['];
        let rest = name.get(1..)?.trim_start_matches(separators);
        let rest = match rest.strip_prefix(['v', 'x']) {
            Some(rest) => rest.trim_start_matches([' ', '_', '(', '[', ',']),
            None => rest,
        };
        let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.');
        let (number, suffix) = rest.split_at_checked(digits.unwrap_or(rest.len()))?;
        // D[4,3] and D[3,2] are means.
        match suffix.trim_start().starts_with(',') {
            true => None,
            false => Self::with(letter, number, suffix),
        }
    }

    /// "50 % passing (cm)", "50%".
    fn by_percent(name: &str) -> Option<Self> {
        let (number, rest) = split_number(name);
        let suffix = rest.trim_start().strip_prefix('%')?;
        let found = Self::with('%', &number.replace(',', "."), suffix)?;
        // Anything else that it may be of: what is retained, moisture.
        let left = without_passing(&found.set);
        (left.is_empty() && !says_retained(suffix)).then_some(found)
    }

    fn with(letter: char, number: &str, suffix: &str) -> Option<Self> {
        let percent: f64 = number.parse().ok()?;
        if !(percent > 0.0 && percent <= 100.0) {
            return None;
        }
        let mut words = words(suffix);
        let unit = take_unit_of_size(suffix, &mut words);
        Some(Self {
            percent,
            unit,
            set: format!("{letter} {}", words.join(" ")),
        })
    }

    /// Whether its sizes are logarithms, on geologists' psi or phi scale.
    pub(super) fn is_logarithm(&self) -> bool {
        self.set
            .split(' ')
            .any(|word| matches!(word, "psi" | "phi"))
    }
}

/// What the numbers of a set of percentiles are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PercentsOfSet {
    Percents,
    /// "d(0.1)", "d(0.5)", "d(0.9)", as Malvern's instruments write them.
    Shares,
    /// All at most 1, and none from a half on.
    Either,
}

impl PercentsOfSet {
    pub(super) fn of(percents: impl Iterator<Item = f64> + Clone) -> Self {
        let most = percents.clone().fold(0.0, f64::max);
        match most {
            // D1 is a percentile that people give; a share of 1 is the top size, beside others.
            1.0 if percents.clone().any(|percent| percent.fract() != 0.0) => Self::Shares,
            0.5..1.0 => Self::Shares,
            0.0..0.5 => Self::Either,
            _ => Self::Percents,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_percentiles() {
        for (name, percent, set) in [
            ("D50", 50.0, "d "),
            ("F80 (cm)", 80.0, "f "),
            ("Dv10", 10.0, "d "),
            ("Dx (10) (μm)", 10.0, "d "),
            ("d(0.5)", 0.5, "d "),
            ("D(v, 0.9)", 0.9, "d "),
            ("D50_psi", 50.0, "d psi"),
            ("50%", 50.0, "% "),
            ("80 % passing (in)", 80.0, "% passing"),
        ] {
            let found = PercentileColumn::of(name);
            let found = found.map(|of| (of.percent, of.set));
            assert_eq!(found, Some((percent, set.to_owned())), "{name}");
        }
        for name in [
            "D[4,3]",
            "D [3, 2]",
            "10 % retained",
            "5 % moisture",
            "depth",
            "0%",
        ] {
            assert_eq!(PercentileColumn::of(name), None, "{name}");
        }
    }

    #[test]
    fn shares_and_percents() {
        for (percents, wanted) in [
            (vec![10.0, 50.0, 90.0], PercentsOfSet::Percents),
            (vec![0.1, 0.5, 0.9], PercentsOfSet::Shares),
            (vec![0.5, 1.0], PercentsOfSet::Shares),
            (vec![0.1, 1.0, 5.0], PercentsOfSet::Percents),
            (vec![0.1, 0.2], PercentsOfSet::Either),
        ] {
            assert_eq!(
                PercentsOfSet::of(percents.iter().copied()),
                wanted,
                "{percents:?}"
            );
        }
    }
}
