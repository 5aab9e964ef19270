//! Numbers for people: so many digits as they read and type, and round lengths.

/// A number with at least so many significant digits, without an exponent, for people to read and
/// type.
pub fn significant_digits(number: f64, digits: u8) -> String {
    let exponent = number.abs().log10().floor();
    let decimals = (f64::from(digits) - 1.0 - exponent).clamp(0.0, 12.0);
    let decimals = if decimals.is_nan() { 0.0 } else { decimals };
    format!("{number:.*}", decimals as usize)
}

/// The largest of 1, 2 and 5 times a power of ten that is no larger than `most`, without the noise of
/// the power; `None` where there is none.
pub fn round_down(most: f64) -> Option<f64> {
    if !most.is_finite() || most <= 0.0 {
        return None;
    }
    let exponent = most.log10().floor();
    // One power below as well: the logarithm may round up at a power of ten.
    let candidates = [exponent - 1.0, exponent].map(|e| [1.0, 2.0, 5.0].map(|digit| (digit, e)));
    let (digit, exponent) = candidates
        .into_iter()
        .flatten()
        .rfind(|(digit, e)| digit * 10_f64.powf(*e) <= most * (1.0 + 1e-12))?;
    // What its text says is rounded once.
    format!("{digit}e{exponent}").parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_round_and_fit() {
        let text = |most| round_down(most).unwrap().to_string();
        assert_eq!(text(99.99), "50");
        assert_eq!(text(100.0), "100");
        assert_eq!(text(1000.0), "1000");
        assert_eq!(text(4321.0), "2000");
        assert_eq!(text(9.99), "5");
        assert_eq!(text(0.001), "0.001");
        assert_eq!(text(4.9), "2");
        assert_eq!(text(0.26), "0.2");
        for step in 0..4000 {
            let most = 10_f64.powf(f64::from(step) / 250.0 - 8.0);
            let length = round_down(most).unwrap();
            assert!(length <= most * 1.000_001 && length * 2.5 > most * 0.999_999);
        }
        assert!(round_down(0.0).is_none() && round_down(f64::INFINITY).is_none());
        assert!(round_down(-1.0).is_none() && round_down(f64::NAN).is_none());
    }

    #[test]
    fn numbers_have_their_digits() {
        for (number, text) in [
            (25.6, "25.60"),
            (0.025_634, "0.02563"),
            (1234.5, "1234"),
            (98_765.4, "98765"),
            (1.0, "1.000"),
        ] {
            assert_eq!(significant_digits(number, 4), text);
        }
    }
}
