//! Numbers for people.

/// A number with this many significant digits, without an exponent where it is of everyday size.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return value.to_string();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    // The exponent after rounding: 9.9996 has two digits before the point with four digits.
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let exponent: i32 = scientific
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse().ok())
        .unwrap_or(0);
    if !(-6..=9).contains(&exponent) {
        return scientific;
    }
    let digits = i32::try_from(digits).unwrap_or(i32::MAX);
    let decimals = usize::try_from(digits - 1 - exponent).unwrap_or(0);
    format!("{value:.decimals$}")
}

/// A number that may be missing.
pub fn or_dash(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| significant(value, digits))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_counted_from_the_first_that_is_not_zero() {
        for (value, digits, shown) in [
            (25.634_21, 4, "25.63"),
            (9.9996, 4, "10.00"),
            (0.001_234_5, 3, "0.00123"),
            (123_456.7, 4, "123457"),
            (-2.0, 3, "-2.00"),
            (0.0, 4, "0"),
            (1e-9, 2, "1.0e-9"),
        ] {
            assert_eq!(significant(value, digits), shown);
        }
        assert_eq!(or_dash(None, 3), "–");
    }
}
