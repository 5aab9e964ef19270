//! TOML that people write: a misspelt key is named with its nearest known neighbour, and whatever is wrong with a
//! value with its line.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::fault::Fault;

/// Every table with the keys that it may have; the one without a name is the file itself.
pub type KnownKeys = [(&'static str, &'static [&'static str])];

/// Refuses keys that are not `known`, in the file and in its tables.
///
/// # Errors
/// With the line of the first that is not.
pub fn refuse_unknown_keys(
    all_known: &KnownKeys,
    text: &str,
    root: &DeTable<'_>,
) -> Result<(), Fault> {
    refuse_in(all_known, text, "", root)
}

/// The same in `table`, whose name is empty for the whole file.
fn refuse_in(
    all_known: &KnownKeys,
    text: &str,
    table_name: &str,
    table: &DeTable<'_>,
) -> Result<(), Fault> {
    let Some((_, known)) = all_known.iter().find(|(name, _)| *name == table_name) else {
        return Ok(());
    };
    for (key, value) in table.iter() {
        let name: &str = key.get_ref();
        if !known.contains(&name) {
            let place = if table_name.is_empty() {
                String::new()
            } else {
                format!(" in [{table_name}]")
            };
            return Err(Fault::at(
                line_of(text, key.span().start),
                format!("unknown key '{name}'{place}"),
                match nearest(name, known) {
                    Some(known) => format!("did you mean '{known}'?"),
                    None => format!("known keys are {}", known.join(", ")),
                },
            ));
        }
        if table_name.is_empty() {
            for inner in tables_in(value) {
                refuse_in(all_known, text, name, inner)?;
            }
        }
    }
    Ok(())
}

/// A table, or the tables of an array of tables.
fn tables_in<'a>(value: &'a Spanned<DeValue<'a>>) -> Vec<&'a DeTable<'a>> {
    match value.get_ref() {
        DeValue::Table(table) => vec![table],
        DeValue::Array(array) => array.iter().flat_map(tables_in).collect(),
        _ => Vec::new(),
    }
}

/// The fault of a TOML text that does not hold what it must, with its line.
pub fn toml_fault(text: &str, error: &toml::de::Error, remedy: &str) -> Fault {
    let line = error.span().map_or(1, |span| line_of(text, span.start));
    Fault::at(line, in_plain_words(error.message()), remedy)
}

/// What serde says of a value, without the names of Rust's types: an engineer knows numbers, texts and lists.
fn in_plain_words(message: &str) -> String {
    let kinds = [
        ("floating point ", "the number "),
        ("integer ", "the number "),
        ("string ", "the text "),
        ("boolean ", "the word "),
        ("sequence", "a list"),
        ("map", "a table"),
    ];
    let wants = [
        (
            &["u8", "u16", "u32", "u64", "usize"][..],
            "a whole number of 0 or more",
        ),
        (&["i8", "i16", "i32", "i64", "isize"][..], "a whole number"),
        (&["f32", "f64"][..], "a number"),
        (&["a boolean"][..], "true or false"),
        (&["a string"][..], "a text"),
        (&["a sequence"][..], "a list"),
    ];
    let said = ["invalid type: ", "invalid value: "]
        .iter()
        .find_map(|start| message.strip_prefix(start)?.rsplit_once(", expected "));
    let Some((found, wanted)) = said else {
        return message.to_owned();
    };
    let found = kinds.iter().find_map(|(kind, word)| {
        let rest = found.strip_prefix(kind)?;
        Some(format!("{word}{}", rest.replace('`', "")))
    });
    let wanted_words = wants.iter().find(|(types, _)| types.contains(&wanted));
    let wanted_words = wanted_words.map_or(wanted, |(_, words)| words);
    match found {
        Some(found) => format!("{found} stands where {wanted_words} is expected"),
        None => message.to_owned(),
    }
}

fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    known
        .iter()
        .map(|known| (strsim::damerau_levenshtein(name, known), *known))
        .min()
        .filter(|(distance, known)| *distance <= 1 + known.len() / 2)
        .map(|(_, known)| known)
}

/// The line, from 1, of a byte of the text.
pub fn line_of(text: &str, byte: usize) -> u64 {
    let before = text.as_bytes().get(..byte).unwrap_or_default();
    1 + before.iter().filter(|&&b| b == b'\n').count() as u64
}

/// The line of a key, or of its table, or 1.
pub fn key_line(text: &str, table: &str, key: &str) -> u64 {
    let line = |root: &DeTable<'_>| {
        if table.is_empty() {
            return line_in(text, root, key);
        }
        let lines = tables_called(root, table).into_iter();
        let inner = lines.filter_map(|table| line_in(text, table, key)).next();
        inner.or_else(|| line_in(text, root, table))
    };
    let root = DeTable::parse(text).ok();
    root.and_then(|root| line(root.get_ref())).unwrap_or(1)
}

/// The same of one of several tables of that name, counted from 0.
pub fn nth_key_line(text: &str, table: &str, number: usize, key: &str) -> u64 {
    let line = |root: &DeTable<'_>| line_in(text, tables_called(root, table).get(number)?, key);
    let root = DeTable::parse(text).ok();
    let line = root.and_then(|root| line(root.get_ref()));
    line.unwrap_or_else(|| key_line(text, "", table))
}

/// The tables of this name.
fn tables_called<'a>(root: &'a DeTable<'a>, name: &str) -> Vec<&'a DeTable<'a>> {
    let named = root.iter().filter(|(key, _)| key.get_ref() as &str == name);
    named.flat_map(|(_, value)| tables_in(value)).collect()
}

/// The line of a key of this table.
fn line_in(text: &str, table: &DeTable<'_>, key: &str) -> Option<u64> {
    table
        .iter()
        .find(|(name, _)| name.get_ref() as &str == key)
        .map(|(name, _)| line_of(text, name.span().start))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, serde::Deserialize)]
    #[allow(dead_code, reason = "only whether it can be read matters")]
    struct Known {
        count: Option<usize>,
        size: Option<f64>,
        names: Option<Vec<String>>,
        on: Option<bool>,
        pair: Option<[f64; 2]>,
    }

    #[test]
    fn values_of_another_kind_are_told_in_plain_words() {
        for (text, line, wanted) in [
            (
                "size = 1\ncount = 1.5",
                2,
                "the number 1.5 stands where a whole number of 0 or more is expected",
            ),
            (
                "count = -1",
                1,
                "the number -1 stands where a whole number of 0 or more is expected",
            ),
            (
                "count = \"a\"",
                1,
                "the text \"a\" stands where a whole number of 0 or more is expected",
            ),
            (
                "size = \"2 m\"",
                1,
                "the text \"2 m\" stands where a number is expected",
            ),
            (
                "names = 3",
                1,
                "the number 3 stands where a list is expected",
            ),
            (
                "names = [true]",
                1,
                "the word true stands where a text is expected",
            ),
            (
                "on = [1]",
                1,
                "a list stands where true or false is expected",
            ),
            (
                "pair = 1",
                1,
                "the number 1 stands where an array of length 2 is expected",
            ),
        ] {
            let error = toml::from_str::<Known>(text).unwrap_err();
            let fault = toml_fault(text, &error, "correct it");
            assert_eq!(
                (fault.line, fault.what.as_str()),
                (Some(line), wanted),
                "{text}"
            );
        }
        for other in [
            "missing field `a`",
            "invalid length 3, expected an array of length 2",
        ] {
            assert_eq!(in_plain_words(other), other);
        }
    }
}
