//! The lines of a table's text as its fields, whatever separates them.

use csv::StringRecord;

use super::Row;
use crate::fault::Fault;

/// More lines than anyone measures.
const MOST_ROWS: usize = 500_000;

/// Whether a line holds data or names: not empty, no comment, and not what tells Excel the separator. "#4" is a sieve's name.
fn counts(line: &&str) -> bool {
    let comment = line.strip_prefix('#');
    let comment = comment.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()));
    let of_excel = line.trim().trim_matches('"').to_lowercase();
    let of_excel = of_excel.strip_prefix("sep=");
    let of_excel = of_excel.is_some_and(|rest| rest.chars().count() <= 1);
    !line.trim().is_empty() && !comment && !of_excel
}

/// The text with empty lines in place of those that do not count, so that lines keep their numbers.
pub(super) fn without_comments(text: &str) -> String {
    let lines = text
        .lines()
        .flat_map(|line| [if counts(&line) { line } else { "" }, "\n"]);
    lines.collect()
}

/// The separator of the header and the line behind it; `None` for blanks.
pub(super) fn separator(text: &str) -> Option<char> {
    let mut lines = text.lines().filter(counts);
    let (header, next) = (lines.next()?, lines.next());
    let holds = |line: &str, separator: char| {
        // A quotation mark counts at the beginning of a field; elsewhere it is inches.
        let (mut quoted, mut begins) = (false, true);
        line.chars().any(|c| {
            quoted = if quoted { c != '"' } else { begins && c == '"' };
            begins = !quoted && (c == separator || begins && c == ' ');
            !quoted && c == separator
        })
    };
    let separators = ['\t', ';', ','];
    let in_both = |&c: &char| holds(header, c) && next.is_none_or(|next| holds(next, c));
    let found = separators.into_iter().find(in_both);
    found.or_else(|| separators.into_iter().find(|&c| holds(header, c)))
}

/// The records of a table with a separator.
pub(super) fn separated_records(text: &str, separator: char) -> Result<Vec<Row>, Fault> {
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(separator as u8)
        .flexible(true)
        .trim(csv::Trim::All)
        .has_headers(false)
        .from_reader(text.as_bytes());
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| {
            let line = error.position().map_or(1, csv::Position::line);
            let what = format!("it is not a table ({error})");
            Fault::at(line, what, "check its quotes")
        })?;
        if record.iter().all(str::is_empty) {
            continue;
        }
        let line = line_of(text, &record, str::is_empty);
        let cells = without_spaced_quotes(record);
        push(&mut rows, Row { line, cells })?;
    }
    Ok(rows)
}

/// The records of a table whose fields stand between blanks. In its header two blanks or more separate
/// names where there are such; else what stands in brackets belongs to the name before it.
pub(super) fn blank_records(text: &str) -> Result<Vec<Row>, Fault> {
    let mut rows: Vec<Row> = Vec::new();
    for (line, number) in text.lines().zip(1..) {
        if !counts(&line) {
            continue;
        }
        let cells: StringRecord = match rows.is_empty() {
            true => names_between_blanks(line).into_iter().collect(),
            false => line.split_whitespace().collect(),
        };
        push(
            &mut rows,
            Row {
                line: number,
                cells,
            },
        )?;
    }
    Ok(rows)
}

fn names_between_blanks(header: &str) -> Vec<String> {
    let header = header.trim();
    if header.contains("  ") {
        let names = header.split("  ").map(str::trim);
        return names
            .filter(|name| !name.is_empty())
            .map(str::to_owned)
            .collect();
    }
    let mut names: Vec<String> = Vec::new();
    for word in header.split_whitespace() {
        match names.last_mut() {
            Some(name) if word.starts_with(['(', '[']) => {
                name.push(' ');
                name.push_str(word);
            }
            _ => names.push(word.to_owned()),
        }
    }
    names
}

fn push(rows: &mut Vec<Row>, row: Row) -> Result<(), Fault> {
    if rows.len() > MOST_ROWS {
        let what = format!("it has over {MOST_ROWS} lines");
        return Err(Fault::at(row.line, what, "give the table alone"));
    }
    rows.push(row);
    Ok(())
}

/// Quotes count for the csv crate only right behind a comma, but people put spaces there.
fn without_spaced_quotes(record: StringRecord) -> StringRecord {
    if !record.iter().any(|field| field.starts_with('"')) {
        return record;
    }
    let position = record.position().cloned();
    let bare = |field: &str| {
        let inner = field
            .strip_prefix('"')
            .and_then(|field| field.strip_suffix('"'));
        inner.map_or_else(|| field.to_owned(), |inner| inner.replace("\"\"", "\""))
    };
    let mut record: StringRecord = record.iter().map(bare).collect();
    record.set_position(position);
    record
}

/// The line, from 1, on which a record begins. The csv crate places it where its search began: in
/// front of the lines that it `skips`.
fn line_of(text: &str, record: &StringRecord, skips: impl Fn(&str) -> bool) -> u64 {
    let Some(position) = record.position() else {
        return 1;
    };
    let begin = usize::try_from(position.byte()).unwrap_or(usize::MAX);
    let rest = text.get(begin..).unwrap_or_default();
    let skipped = rest.lines().take_while(|line| skips(line));
    position.line() + skipped.count() as u64
}
