//! What was mended in numbers, to be said.

use crate::text::fields::shown;

/// What was mended in numbers, to be said.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct NumberRepairs {
    decimal_commas: usize,
    first_line: u64,
    /// How many had thousands that stand apart; of the first the line, and as what it was read.
    apart: usize,
    first_apart: (u64, String),
    /// The same of those whose thousands were parted by points or commas.
    parted: usize,
    first_parted: (u64, String),
}

impl NumberRepairs {
    /// One sentence for each kind of repair.
    pub fn warnings(&self) -> Vec<String> {
        let numbers = |count: usize| if count == 1 { "number" } else { "numbers" };
        let commas = (self.decimal_commas > 0).then(|| {
            format!(
                "decimal commas are read as decimal points ({} {}, first on line {})",
                self.decimal_commas,
                numbers(self.decimal_commas),
                self.first_line
            )
        });
        let apart = (self.apart > 0).then(|| {
            let (line, how) = &self.first_apart;
            format!(
                "thousands that stand apart are read as one number: {how} ({} {}, first on line {line})",
                self.apart,
                numbers(self.apart)
            )
        });
        let parted = (self.parted > 0).then(|| {
            let (line, how) = &self.first_parted;
            format!(
                "points or commas between thousands are left out, for the table's decimal sign is the other one: {how} ({} {}, \
                 first on line {line})",
                self.parted,
                numbers(self.parted)
            )
        });
        commas.into_iter().chain(apart).chain(parted).collect()
    }

    /// Whether some number had a decimal comma.
    pub(crate) fn has_decimal_commas(&self) -> bool {
        self.decimal_commas > 0
    }

    /// Notes a decimal comma on this line.
    pub(crate) fn decimal_comma(&mut self, line: u64) {
        if self.decimal_commas == 0 {
            self.first_line = line;
        }
        self.decimal_commas += 1;
    }

    /// Notes a cell, or the name of a column, on this line whose thousands stand apart, and what was read.
    pub(crate) fn thousands_apart(&mut self, line: u64, cell: &str, number: f64) {
        if self.apart == 0 {
            self.first_apart = (line, format!("'{}' as {number}", shown(cell)));
        }
        self.apart += 1;
    }

    /// Notes a cell on this line whose thousands were parted by points or commas, and what was read.
    pub(super) fn thousands_parted(&mut self, line: u64, cell: &str, number: f64) {
        if self.parted == 0 {
            self.first_parted = (line, format!("'{}' as {number}", shown(cell)));
        }
        self.parted += 1;
    }
}
