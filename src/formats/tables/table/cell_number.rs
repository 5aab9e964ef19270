//! The number in a cell as people write it, and what stands behind it.

use std::borrow::Cow;

/// What stands between thousands that stand apart: blanks, of which Excel's do not break or are narrow, and the apostrophe of Swiss.
const BETWEEN_THOUSANDS: [char; 6] = [' ', '\u{a0}', '\u{202f}', '\u{2009}', '\'', '’'];

/// A cell's number, with all its points and commas but nothing between thousands, and what follows it. Only one whose thousands stood
/// apart is owned.
pub(super) fn number_text(cell: &str) -> (Cow<'_, str>, &str) {
    match thousands_apart(cell) {
        Some((number, rest)) => (Cow::Owned(number), rest),
        None => {
            let (number, rest) = split_number(cell);
            (Cow::Borrowed(number), rest)
        }
    }
}

/// A number whose thousands stand apart as Excel writes them in French and Swiss, "1 450,5" and "1'450", and what follows it, in
/// which there are no more digits. `None` of any other cell.
fn thousands_apart(cell: &str) -> Option<(String, &str)> {
    let digits = |from: usize| {
        let rest = cell.get(from..).unwrap_or_default();
        rest.bytes().take_while(u8::is_ascii_digit).count()
    };
    let sign = usize::from(cell.starts_with(['-', '+']));
    let first = digits(sign);
    if !(1..=3).contains(&first) || cell.get(sign..)?.starts_with('0') {
        return None;
    }
    let mut end = sign + first;
    let between = cell.get(end..)?.chars().next()?;
    if !BETWEEN_THOUSANDS.contains(&between) {
        return None;
    }
    while cell.get(end..)?.starts_with(between) && digits(end + between.len_utf8()) == 3 {
        end += between.len_utf8() + 3;
    }
    if end == sign + first {
        return None;
    }
    if cell.get(end..)?.starts_with(['.', ',']) && digits(end + 1) > 0 {
        end += 1 + digits(end + 1);
    }
    let (number, rest) = cell.split_at_checked(end)?;
    // Feet and inches may stand behind it, and else no sign of a number that goes on.
    let signs = ['.', ',', '/', '\'', '’'];
    let goes_on = rest.starts_with(signs) && !matches!(rest, "'" | "''")
        || rest.contains(|c: char| c.is_ascii_digit());
    (!goes_on).then(|| (number.replace(between, ""), rest))
}

/// A name's number, whose decimal sign may be a comma, whether its thousands stand apart, and what follows it; `None` where it begins
/// with no finite number.
pub(crate) fn number_and_unit(name: &str) -> Option<(f64, bool, &str)> {
    let (number, rest) = number_text(name);
    let stands_apart = matches!(number, Cow::Owned(_));
    let number = number.replace(',', ".").parse::<f64>().ok()?;
    number.is_finite().then_some((number, stands_apart, rest))
}

/// What one of the last digit shown of a cell's number is: 0.1 of "12.3", 1 of "58". `None` where it is no plain number.
pub(super) fn last_digit(cell: &str) -> Option<f64> {
    let (number, _) = number_text(cell);
    let (whole, decimals) = number.rsplit_once(['.', ',']).unwrap_or((&*number, ""));
    let is_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    let is_plain = is_digits(whole.trim_start_matches(['-', '+'])) && is_digits(decimals);
    let places = i32::try_from(decimals.len()).ok()?;
    (is_plain && !number.is_empty()).then(|| 10_f64.powi(-places))
}

/// A cell's number, with all its points and commas, and what follows it.
pub(crate) fn split_number(cell: &str) -> (&str, &str) {
    let bytes = cell.as_bytes();
    let run = |from: usize, is: &dyn Fn(u8) -> bool| {
        let rest = bytes.get(from..).unwrap_or_default();
        from + rest.iter().take_while(|&&b| is(b)).count()
    };
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let mut end = run(sign, &|b| b.is_ascii_digit() || b == b'.' || b == b',');
    if end > sign && matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let digits = end + 1 + sign;
        let exponent = run(digits, &|b| b.is_ascii_digit());
        if exponent > digits {
            end = exponent;
        }
    }
    cell.split_at_checked(end).unwrap_or((cell, ""))
}

/// A number in which points, or commas, may part thousands, three digits each, without them, and which of both they are: "1250,5" of
/// "1.250,5", "1234567" of "1,234,567". `None` of any other.
pub(super) fn without_separators(number: &str) -> Option<(char, String)> {
    let digits = number.trim_start_matches(['+', '-']);
    let separator = digits.chars().find(|c| ['.', ','].contains(c))?;
    let (whole, decimals) = match digits.split_once(other_sign(separator)) {
        Some((whole, decimals)) => (whole, Some(decimals)),
        None => (digits, None),
    };
    let are_digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let (first, groups) = whole.split_once(separator)?;
    let are_thousands = are_digits(first)
        && first.len() <= 3
        && !first.starts_with('0')
        && groups
            .split(separator)
            .all(|group| group.len() == 3 && are_digits(group))
        && decimals.is_none_or(are_digits);
    are_thousands.then(|| (separator, number.replace(separator, "")))
}

/// What is decimal where this parts thousands.
pub(super) fn other_sign(separator: char) -> char {
    match separator {
        '.' => ',',
        _ => '.',
    }
}

/// Whether the one comma or point of a number may separate thousands: one to three digits in front, of
/// which the first is no 0, and three behind.
pub fn may_be_thousands(number: &str) -> bool {
    let number = number.trim_start_matches(['+', '-']);
    let Some((whole, rest)) = number.split_once([',', '.']) else {
        return false;
    };
    let digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
    (1..=3).contains(&whole.len())
        && !whole.starts_with('0')
        && digits(whole)
        && rest.len() == 3
        && digits(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_and_what_is_behind_them() {
        for (cell, number, rest) in [
            ("1 200 mm", "1200", " mm"),
            ("1'200", "1200", ""),
            ("1’200.5 in.", "1200.5", " in."),
            ("-12 000,25\u{a0}µm", "-12000,25", "\u{a0}µm"),
            ("1\u{202f}234\u{202f}567", "1234567", ""),
            ("2 500 %", "2500", " %"),
            ("1 200'", "1200", "'"),
        ] {
            let (found, behind) = number_text(cell);
            assert_eq!((&*found, behind), (number, rest), "{cell}");
            assert!(matches!(found, Cow::Owned(_)), "{cell}");
        }
        for (cell, number) in [
            ("1 1/2", "1"),
            ("1 125/1000", "1"),
            ("1 20", "1"),
            ("0 200", "0"),
            ("1 200 mm 2", "1"),
            ("1450 mm", "1450"),
            ("12.5 mm", "12.5"),
        ] {
            let (found, _) = number_text(cell);
            assert_eq!(found, Cow::Borrowed(number), "{cell}");
            assert!(matches!(found, Cow::Borrowed(_)), "{cell}");
        }
        assert_eq!(number_and_unit("1 200,5 mm"), Some((1200.5, true, " mm")));
        assert_eq!(number_and_unit("12 mm"), Some((12.0, false, " mm")));
        assert_eq!(number_and_unit("photo 1 200"), None);
    }

    #[test]
    fn thousands_that_a_sign_parts() {
        for (number, wanted) in [
            ("1.250,0", Some(('.', "1250,0"))),
            ("-1,250.75", Some((',', "-1250.75"))),
            ("12.345.678", Some(('.', "12345678"))),
            ("1.000", Some(('.', "1000"))),
            ("1.25,0", None),
            ("1.250,", None),
            ("1,5.250", None),
            ("0.250", None),
            ("1250.000", None),
            ("1.250,0,5", None),
            ("1.250.50", None),
            ("1,250e3", None),
            ("1250", None),
        ] {
            let wanted = wanted.map(|(sign, text)| (sign, text.to_owned()));
            assert_eq!(without_separators(number), wanted, "{number}");
        }
    }

    #[test]
    fn the_last_digit_that_is_shown() {
        for (cell, wanted) in [
            ("58", Some(1.0)),
            ("58.0", Some(0.1)),
            ("1 058,25 g", Some(0.01)),
            ("5e1", None),
            ("", None),
            ("total", None),
        ] {
            let found = last_digit(cell);
            let is_it = match (found, wanted) {
                (Some(found), Some(wanted)) => (found / wanted - 1.0_f64).abs() < 1e-12,
                (found, wanted) => found == wanted,
            };
            assert!(is_it, "{cell}: {found:?}");
        }
    }
}
