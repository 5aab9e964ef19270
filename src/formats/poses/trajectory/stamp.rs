//! The time of a recording: whole nanoseconds, because 1403715273.262142976 s has more digits than
//! an f64 keeps.

use std::fmt;

/// From this number on a stamp without a unit counts nanoseconds, not seconds: as seconds it would be
/// three million years, as nanoseconds since 1970 it is a day.
const LEAST_NANOSECONDS: f64 = 1e14;

/// How many digits a stamp may have: more than any clock writes.
const MOST_DIGITS: usize = 60;

/// A point in time, in nanoseconds from the recording's own zero (mostly 1970).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Stamp(pub(crate) i64);

impl Stamp {
    /// Reads a decimal number: seconds below 1e14, else nanoseconds; rounded to the nanosecond.
    /// `None` where it is no such number, or negative, or beyond the year 2262.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let value: f64 = text.parse().ok()?;
        if !value.is_finite() {
            return None;
        }
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
            None => (text, 0),
        };
        let mantissa = mantissa.strip_prefix('+').unwrap_or(mantissa);
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let mut digits = format!("{whole}{fraction}");
        if digits.len() > MOST_DIGITS || !digits.bytes().all(|b| b.is_ascii_digit()) {
            return None;
        }
        let unit = if value < LEAST_NANOSECONDS { 9 } else { 0 };
        // Within 60 digits and the range of i64 the shift is a small number.
        let shift = exponent
            .checked_add(unit)?
            .checked_sub(i32::try_from(fraction.len()).ok()?)?;
        if shift >= 0 {
            let zeros = usize::try_from(shift).ok().filter(|&n| n <= MOST_DIGITS)?;
            digits.extend(std::iter::repeat_n('0', zeros));
            return digits.parse().ok().map(Self);
        }
        let cut = usize::try_from(shift.unsigned_abs()).ok()?;
        let Some(kept) = digits.len().checked_sub(cut) else {
            return Some(Self(0));
        };
        let (whole, rest) = digits.split_at_checked(kept)?;
        let nanoseconds: i64 = if whole.is_empty() {
            0
        } else {
            whole.parse().ok()?
        };
        let up = rest.starts_with(|c: char| c >= '5');
        nanoseconds.checked_add(i64::from(up)).map(Self)
    }

    /// How many nanoseconds the two are apart.
    pub(crate) fn apart(self, other: Self) -> u64 {
        self.0.abs_diff(other.0)
    }
}

/// Seconds, with as many decimals as there are.
impl fmt::Display for Stamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.0 < 0 { "-" } else { "" };
        let (seconds, rest) = (
            self.0.unsigned_abs() / 1_000_000_000,
            self.0.unsigned_abs() % 1_000_000_000,
        );
        if rest == 0 {
            return write!(f, "{sign}{seconds}");
        }
        let decimals = format!("{rest:09}");
        write!(f, "{sign}{seconds}.{}", decimals.trim_end_matches('0'))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_digit_is_lost() {
        for (text, nanoseconds) in [
            ("1305031098.6659", 1_305_031_098_665_900_000),
            ("1403715273262142976", 1_403_715_273_262_142_976),
            ("1403715273262142976.000000", 1_403_715_273_262_142_976),
            ("1.403715529112143517e+09", 1_403_715_529_112_143_517),
            ("1.403715273262142976E18", 1_403_715_273_262_142_976),
            ("0", 0),
            (".5", 500_000_000),
            ("7.", 7_000_000_000),
            ("0.0000000005", 1),
            ("0.00000000049", 0),
            ("1e-30", 0),
            ("1e-2147483648", 0),
            ("+2e0", 2_000_000_000),
        ] {
            assert_eq!(Stamp::parse(text), Some(Stamp(nanoseconds)), "{text}");
        }
    }

    #[test]
    fn what_is_no_stamp() {
        for text in [
            "", ".", "-1", "nan", "inf", "1e999", "1e30", "9.3e18", "1.2.3", "0x10", "1,5", "e9",
            "--", "1e", "IMG_1",
        ] {
            assert_eq!(Stamp::parse(text), None, "{text}");
        }
        assert_eq!(Stamp::parse(&"1".repeat(61)), None);
    }

    #[test]
    fn printed_as_seconds() {
        assert_eq!(
            Stamp(1_305_031_098_665_900_000).to_string(),
            "1305031098.6659"
        );
        assert_eq!(Stamp(-1_500_000_000).to_string(), "-1.5");
        assert_eq!(Stamp(i64::MIN).to_string(), "-9223372036.854775808");
        assert_eq!(Stamp(2_000_000_000).to_string(), "2");
    }
}
