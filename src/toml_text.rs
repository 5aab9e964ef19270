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
