//! A day of the calendar. The core has no clock: whoever decides something says on which day.

use std::fmt;
use std::str::FromStr;

/// A day of the Gregorian calendar, printed and read as ISO 8601 writes it: 2026-11-22.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Date {
    year: u16,
    month: u8,
    day: u8,
}

impl Date {
    /// The day, where the calendar has it; years of four digits.
    pub fn new(year: u16, month: u8, day: u8) -> Option<Self> {
        let is_leap =
            year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
        let days = match month {
            2 => 28 + u8::from(is_leap),
            4 | 6 | 9 | 11 => 30,
            1..=12 => 31,
            _ => return None,
        };
        ((1..=days).contains(&day) && year <= 9999).then_some(Self { year, month, day })
    }
}

impl fmt::Display for Date {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04}-{:02}-{:02}", self.year, self.month, self.day)
    }
}

impl FromStr for Date {
    type Err = String;

    /// # Errors
    /// Where it is not a day of the calendar, as "is '2026-02-30', no day of the calendar".
    fn from_str(text: &str) -> Result<Self, String> {
        let date = || {
            let (year, rest) = text.split_once('-')?;
            let (month, day) = rest.split_once('-')?;
            let number = |part: &str, digits: usize| {
                let right = part.len() == digits && part.bytes().all(|b| b.is_ascii_digit());
                right.then(|| part.parse::<u16>().ok())?
            };
            let [month, day] = [number(month, 2)?, number(day, 2)?];
            Self::new(
                number(year, 4)?,
                month.try_into().ok()?,
                day.try_into().ok()?,
            )
        };
        date().ok_or_else(|| format!("is '{text}', no day of the calendar"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1900 was no leap year, 2000 was one (papal bull Inter gravissimas, 1582).
    #[test]
    fn days_of_the_calendar_alone() {
        for good in ["2026-11-22", "2024-02-29", "2000-02-29", "0001-01-01"] {
            let date: Date = good.parse().unwrap();
            assert_eq!(date.to_string(), good);
        }
        for bad in [
            "2026-02-30",
            "1900-02-29",
            "2026-13-01",
            "2026-00-01",
            "2026-04-31",
            "2026-1-1",
            "22.11.2026",
            "2026-11-22-1",
            "+026-11-22",
            "today",
            "",
        ] {
            let refused = bad.parse::<Date>().unwrap_err();
            assert_eq!(refused, format!("is '{bad}', no day of the calendar"));
        }
    }
}
