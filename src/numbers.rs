//! Numbers for people: so many digits as they read and type, and round lengths.

/// Half a 95 % interval in standard deviations of a normal distribution.
pub const TO_95_PERCENT: f64 = 1.959_963_984_540_054;

/// Half an interval below this share of its value is none.
const NO_WIDTH: f64 = 1e-6;

/// "1 flight", "3 flights": how many there are of what `one` names.
pub fn counted(count: usize, one: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {one}{ending}")
}

/// A number with at least so many significant digits, without an exponent, for people to read and
/// type.
pub fn significant_digits(number: f64, digits: u8) -> String {
    // It has none.
    if number == 0.0 {
        return "0".to_owned();
    }
    let exponent = number.abs().log10().floor();
    let decimals = (f64::from(digits) - 1.0 - exponent).clamp(0.0, 12.0);
    let decimals = if decimals.is_nan() { 0.0 } else { decimals };
    format!("{number:.*}", decimals as usize)
}

/// A number with so many digits as its interval allows, and how sure it is: "19.9 ± 0.4", or
/// "19.9 (19.2 to 20.3)" where its two sides are not alike. Both have as many decimals as half the
/// interval's width allows: two digits of it where it begins with 1 to 3.5, else one. Five digits and nothing beside them where the interval
/// has no width, or a millionth of the value: that is rounding, and twelve digits of it are no use to anybody.
pub fn with_interval(value: f64, low: f64, high: f64) -> String {
    let Some(decimals) = decimals_allowed(value, low, high) else {
        return significant_digits(value, 5);
    };
    let text = |number: f64| with_decimals(number, decimals);
    let last = 10_f64.powi(-decimals);
    let [down, up] = [value - low, high - value].map(|side| (side / last).round());
    if (up - down).abs() <= 1.0 && up.max(down) > 0.0 {
        format!("{} ± {}", text(value), text(up.max(down) * last))
    } else {
        format!("{} ({} to {})", text(value), text(low), text(high))
    }
}

/// A number with its interval of which the ends that are printed hold the true ones: rounded away from the number, with two digits of half
/// the width. "± 40" where both sides are alike, else "82 (46 to 131)".
pub fn within_interval(value: f64, low: f64, high: f64) -> String {
    let Some(half) = half_width(value, low, high) else {
        return significant_digits(value, 5);
    };
    let decimals = decimals_for(half, 2);
    let text = |number: f64| with_decimals(number, decimals);
    let last = 10_f64.powi(-decimals);
    let near = (value / last).round();
    // What a multiple of the last digit is off by is no end inside.
    let (down, up) = ((low / last + 1e-6).floor(), (high / last - 1e-6).ceil());
    match (near - down - (up - near)).abs() <= 1.0 && up > near && near > down {
        true => format!(
            "{} ± {}",
            text(value),
            text((up - near).max(near - down) * last)
        ),
        false => format!(
            "{} ({} to {})",
            text(value),
            text(down * last),
            text(up * last)
        ),
    }
}

/// A number with so many digits as its interval allows, alone; four where the interval has no width.
pub fn as_its_interval_allows(value: f64, low: f64, high: f64) -> String {
    match decimals_allowed(value, low, high) {
        Some(decimals) => with_decimals(value, decimals),
        None => significant_digits(value, 4),
    }
}

/// How many decimals half the interval's width allows; `None` where it has no width.
fn decimals_allowed(value: f64, low: f64, high: f64) -> Option<i32> {
    half_width(value, low, high).map(decimals_of)
}

/// Half the width of an interval; `None` where it has none.
fn half_width(value: f64, low: f64, high: f64) -> Option<f64> {
    let half = (high - low) / 2.0;
    let has_width = half > NO_WIDTH * value.abs() && half.is_finite() && value.is_finite();
    has_width.then_some(half)
}

/// How far the farther end of an interval is from its number, in percent of it, such as "2 %": what stands behind a "±" holds on both sides.
/// `None` where it has no width, or a millionth of the number.
pub fn interval_percent(value: f64, low: f64, high: f64) -> Option<String> {
    let percent = farther_percent(value, low, high);
    let is_some = is_width(percent) && percent.is_finite();
    // One digit, two of what begins with 1: nobody reads more from a percentage.
    let digits = if leading(percent) < 1.95 { 2 } else { 1 };
    let decimals = decimals_for(percent, digits).max(0);
    is_some.then(|| format!("{} %", with_decimals(percent, decimals)))
}

/// How far the farther end of an interval is from its number, in percent of it.
pub fn farther_percent(value: f64, low: f64, high: f64) -> f64 {
    let farther = (high - value).max(value - low);
    // Of a number outside its interval, too, nothing is known better than by half its width.
    (farther.max((high - low) / 2.0) / value * 100.0).abs()
}

/// Down to which decimal place a deviation says something: two digits of it below 3.55, one above, so that
/// rounding the number to that place moves it by little of its deviation (Particle Data Group, Review of
/// Particle Physics, introduction, section 5.3). Negative for tens and hundreds.
fn decimals_of(deviation: f64) -> i32 {
    decimals_for(deviation, if leading(deviation) < 3.55 { 2 } else { 1 })
}

/// A number between 1 and 10 with the same digits.
fn leading(number: f64) -> f64 {
    number / 10_f64.powf(number.log10().floor())
}

/// Down to which decimal place a number has so many digits.
fn decimals_for(number: f64, digits: i32) -> i32 {
    let exponent = number.log10().floor().clamp(-12.0, 12.0) as i32;
    digits - 1 - exponent
}

/// A number rounded to so many decimals; to tens and hundreds where these are negative.
fn with_decimals(number: f64, decimals: i32) -> String {
    let power = 10_f64.powi(-decimals);
    let rounded = if decimals < 0 {
        (number / power).round() * power
    } else {
        number
    };
    format!("{rounded:.*}", usize::try_from(decimals).unwrap_or(0))
}

/// Whether so many percent of a number are more than what rounding leaves.
pub fn is_width(percent: f64) -> bool {
    percent > 100.0 * NO_WIDTH
}

/// A relative standard error in percent, with the four digits that such a number can have.
pub fn stated_percent(relative: f64) -> f64 {
    four_digits(100.0 * relative)
}

/// A number rounded to four digits: more is no standard error known.
pub fn four_digits(number: f64) -> f64 {
    to_digits(number, 4)
}

/// A number rounded to so many digits, one at least.
pub fn to_digits(number: f64, digits: usize) -> f64 {
    let decimals = digits.saturating_sub(1);
    format!("{number:.decimals$e}").parse().unwrap_or(number)
}

/// A value and the limit that it passed, with as many decimals as tell them apart, at least `decimals`.
pub fn apart(value: f64, limit: f64, decimals: usize) -> (String, String) {
    let at = |decimals: usize| (format!("{value:.decimals$}"), format!("{limit:.decimals$}"));
    (decimals..decimals + 6)
        .map(at)
        .find(|(value, limit)| value != limit)
        .unwrap_or_else(|| at(17))
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

/// Of 1, 2 and 5 times a power of ten the one nearest to a number, by their ratio; `None` where there is
/// none.
pub fn round_near(number: f64) -> Option<f64> {
    let below = round_down(number)?;
    let above = round_down(below * 2.6)?;
    Some(match number / below > above / number {
        true => above,
        false => below,
    })
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

    /// Answers by the Particle Data Group's rule, by hand.
    #[test]
    fn numbers_have_the_digits_that_their_intervals_allow() {
        for (value, low, high, text) in [
            (19.9132, 19.5132, 20.3132, "19.9 ± 0.4"),
            (19.9132, 19.2, 20.3, "19.9 (19.2 to 20.3)"),
            (19.9132, 19.79, 20.03, "19.91 ± 0.12"),
            (1991.32, 1953.0, 2030.0, "1990 ± 40"),
            (0.199_132, 0.1951, 0.2031, "0.199 ± 0.004"),
            // The sides differ by less than a last digit: the wider one is stated.
            (25.0, 24.56, 25.35, "25.0 ± 0.4"),
            (20.735, 18.7, 22.8, "20.7 ± 2.1"),
            (25.0, 21.45, 28.55, "25 ± 4"),
            (25.0, 21.46, 28.54, "25.0 ± 3.5"),
            // The number itself is outside.
            (20.0, 20.5, 22.5, "20.0 (20.5 to 22.5)"),
            (19.9132, 19.9132, 19.9132, "19.913"),
            (19.9132, f64::NAN, 20.0, "19.913"),
            (19.9132, 19.913_199, 19.913_201, "19.913"),
            (25.0, 24.01, 25.99, "25.0 ± 1.0"),
        ] {
            assert_eq!(with_interval(value, low, high), text);
            let alone = as_its_interval_allows(value, low, high);
            let first = text.split(' ').next();
            match text.contains(' ') {
                true => assert_eq!(Some(alone.as_str()), first),
                false => assert_eq!(alone, "19.91"),
            }
        }
    }

    /// Of a finder's season: 80 ± 50 was printed of the first, though nothing below 46 was meant. By hand.
    #[test]
    fn printed_ends_hold_the_true_ones() {
        for (value, low, high, text) in [
            (81.798, 46.285, 130.36, "82 (46 to 131)"),
            (64.177, 40.904, 95.576, "64 (40 to 96)"),
            (20.735, 18.7, 22.8, "20.7 ± 2.1"),
            (19.9132, 19.5132, 20.3132, "19.91 ± 0.41"),
            (100.0, 90.0, 110.0, "100 ± 10"),
            (1991.32, 1503.0, 2530.0, "1990 (1500 to 2530)"),
            (20.0, 20.5, 22.5, "20.0 (20.5 to 22.5)"),
            (19.9132, 19.9132, 19.9132, "19.913"),
        ] {
            assert_eq!(within_interval(value, low, high), text);
        }
    }

    #[test]
    fn intervals_are_told_in_percent() {
        let percent = |half: f64| interval_percent(20.0, 20.0 - half, 20.0 + half);
        for (half, text) in [
            (0.4, "2 %"),
            (0.06, "0.3 %"),
            (0.32, "1.6 %"),
            (5.0, "25 %"),
            (0.58, "3 %"),
        ] {
            assert_eq!(percent(half).as_deref(), Some(text), "{half}");
        }
        assert_eq!(percent(0.0), None);
        // What rounding leaves of a cloud without errors.
        assert_eq!(percent(1e-5), None);
        assert_eq!(interval_percent(0.0, -1.0, 1.0), None);
    }

    /// Half-way between 1 and 2 is sqrt 2, between 2 and 5 sqrt 10, between 5 and 10 sqrt 50.
    #[test]
    fn the_nearest_is_nearest_by_ratio() {
        for (number, near) in [
            (1.0, 1.0),
            (1.41, 1.0),
            (1.42, 2.0),
            (3.16, 2.0),
            (3.17, 5.0),
            (0.0707, 0.05),
            (0.0708, 0.1),
            (998.0, 1000.0),
        ] {
            assert_eq!(round_near(number), Some(near), "{number}");
        }
        assert_eq!(round_near(f64::NAN), None);
    }

    #[test]
    fn one_alone_is_not_many() {
        let texts = [0, 1, 2].map(|count| counted(count, "other place"));
        assert_eq!(texts, ["0 other places", "1 other place", "2 other places"]);
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
