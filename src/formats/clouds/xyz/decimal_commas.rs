//! Decimal commas in lines of numbers: where they can be told, and where a comma may be either.

use crate::fault::Fault;
use crate::text::fields::shown;

/// Whether the commas of a line separate the places behind a decimal sign from those before it: twice as many numbers as there
/// are names, or six whole ones of which every other begins with a zero that a whole number would not.
pub(super) fn are_decimal_commas(line: &str, names: Option<usize>) -> bool {
    let fields: Vec<&str> = line.split(',').map(str::trim).collect();
    let is_whole = |field: &&str| {
        let digits = field.strip_prefix('-').unwrap_or(field);
        !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
    };
    if !fields.iter().all(is_whole) {
        return false;
    }
    if let Some(names) = names {
        return fields.len() == 2 * names;
    }
    let behind = fields.iter().skip(1).step_by(2);
    fields.len() == 6
        && behind
            .into_iter()
            .any(|part| part.len() > 1 && part.starts_with('0'))
}

/// A line between commas that has commas in quotes, too, as a spreadsheet writes decimal commas: with points in their
/// place, and without the quotes. `None` of other lines.
pub(super) fn decimal_commas_in_quotes(line: &str) -> Option<String> {
    let mut is_quoted = false;
    let mut has_comma = false;
    let plain = line.chars().filter_map(|sign| {
        is_quoted ^= sign == '"';
        match sign {
            '"' => None,
            ',' if is_quoted => {
                has_comma = true;
                Some('.')
            }
            _ => Some(sign),
        }
    });
    if !line.contains('"') || line.contains(';') {
        return None;
    }
    let plain: String = plain.collect();
    has_comma.then_some(plain)
}

/// That a line has them where they cannot be read.
pub(super) fn decimal_commas(line: u64, text: &str, between: &str) -> Fault {
    let text = shown(text);
    Fault::at(
        line,
        format!("'{text}' may be numbers with decimal commas between {between}"),
        "write decimal points, or semicolons between the numbers",
    )
}

/// Whether these are three numbers or more between blanks or tabs, and one or more have a decimal comma.
pub(super) fn between_blanks_are_decimal_commas(text: &str) -> bool {
    let is_number = |word: &str| {
        let parts: Vec<&str> = word.split(',').collect();
        parts.len() <= 2 && parts.concat().parse::<f64>().is_ok() && !word.contains('.')
    };
    let words: Vec<&str> = text.split_whitespace().collect();
    words.len() >= 3 && words.iter().all(|word| is_number(word)) && text.contains(',')
}
