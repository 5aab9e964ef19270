//! What the numbers of a column show of its points and commas.

use super::cell_number::{may_be_thousands, number_text, other_sign, without_separators};

/// What the numbers of a column show of its points and commas.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct ColumnSigns {
    /// As of the table, of this column alone.
    pub(super) decimal_comma: bool,
    pub(super) decimal_point: bool,
    /// Whether there are whole numbers of 100 or more.
    pub(super) hundreds: bool,
}

impl ColumnSigns {
    /// Looks for a comma or point that can only be decimal, and for hundreds.
    pub(super) fn look_at(&mut self, cell: &str) {
        let (number, _) = number_text(cell);
        self.hundreds |= number.parse::<u32>().is_ok_and(|number| number >= 100);
        let signs = [',', '.'].map(|sign| number.matches(sign).count());
        if signs[0] + signs[1] == 1 && !may_be_thousands(&number) {
            self.decimal_comma |= signs[0] == 1;
            self.decimal_point |= signs[1] == 1;
        }
        // Behind thousands: "1.250,0".
        if signs[0] > 0
            && signs[1] > 0
            && let Some((separator, _)) = without_separators(&number)
        {
            let decimal = other_sign(separator);
            self.decimal_comma |= decimal == ',';
            self.decimal_point |= decimal == '.';
        }
    }

    /// Whether its own numbers say that this sign parts thousands: another column may be written otherwise.
    pub(super) fn are_parted_by(self, separator: char) -> bool {
        let is_other_decimal = match separator {
            '.' => self.decimal_comma,
            _ => self.decimal_point,
        };
        is_other_decimal || self.hundreds
    }
}
