//! Sizes and percents of the report's tables.

use crate::html_page::NONE;
use crate::size_distributions::text_table::{significant, trimmed};

/// A size as it was measured, without the noise of its conversion.
pub(super) fn measured(size: f64) -> String {
    trimmed(size, 6)
}

/// With four significant digits.
pub(super) fn number(value: f64) -> String {
    match value.is_finite() {
        true => significant(value, 4).replace('-', "\u{2212}"),
        false => NONE.to_owned(),
    }
}
