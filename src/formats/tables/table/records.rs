//! The lines of a table's text as its fields, whatever separates them.

use csv::StringRecord;

use super::Row;
use crate::fault::Fault;

/// More lines than anyone measures.
const MOST_ROWS: usize = 500_000;

/// Whether a line holds data or names: not empty, no comment, and not what tells Excel the separator. "#4" is a sieve's name.
fn counts(line: &str) -> bool {
    let comment = line.strip_prefix('#');
    let comment = comment.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()));
    let of_excel = line.trim().trim_matches('"').to_lowercase();
    let of_excel = of_excel.strip_prefix("sep=");
    let of_excel = of_excel.is_some_and(|rest| rest.chars().count() <= 1);
    !line.trim().is_empty() && !comment && !of_excel
}

/// How many lines a cell in quotes may have.
const MOST_BREAKS: usize = 10;

/// What may stand between fields, by what is looked for first.
const SEPARATORS: [char; 3] = ['\t', ';', ','];

/// Walks through a line, whose first field may be in quotes from an earlier line on, and shows what is outside of quotes. Whether a
/// field is in quotes at its end. A quotation mark counts at the beginning of a field; elsewhere it is inches.
fn in_quotes_behind(
    line: &str,
    mut quoted: bool,
    is_separator: impl Fn(char) -> bool,
    mut outside: impl FnMut(char),
) -> bool {
    let mut begins = !quoted;
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        if quoted {
            // Two of them are one inside of the field.
            quoted = c != '"' || chars.next_if_eq(&'"').is_some();
            continue;
        }
        quoted = begins && c == '"';
        begins = !quoted && (is_separator(c) || begins && c == ' ');
        if !quoted {
            outside(c);
        }
    }
    quoted
}

/// How many of the lines behind a line belong to it, because a cell in quotes goes on there, as Excel wraps names of columns. Quotes
/// that do not end soon are something else.
fn lines_in_quotes(line: &str, behind: &[&str]) -> usize {
    let goes_on = |line: &str, quoted: bool| {
        in_quotes_behind(line, quoted, |c| SEPARATORS.contains(&c), |_| {})
    };
    let mut quoted = goes_on(line, false);
    let mut count = 0;
    for &next in behind.iter().take(MOST_BREAKS) {
        if !quoted {
            break;
        }
        quoted = goes_on(next, true);
        count += 1;
    }
    if quoted { 0 } else { count }
}

/// A line and those that belong to it, with a blank in place of each break.
fn joined(line: &str, more: &[&str]) -> String {
    let mut whole = line.to_owned();
    for next in more {
        whole.truncate(whole.trim_end().len());
        whole.push(' ');
        whole.push_str(next.trim_start());
    }
    whole
}

/// Whether a line that would be a comment names columns, of which the first is called #: it has as many names as the line below it
/// has cells, which begins with a number.
fn names_columns(line: &str, below: &[&str]) -> bool {
    let begins = line
        .strip_prefix('#')
        .is_some_and(|rest| rest.trim_start_matches(' ').starts_with(SEPARATORS));
    let Some(&next) = below.iter().find(|line| counts(line)).filter(|_| begins) else {
        return false;
    };
    let cells = |line: &str, separator| {
        let rows = separated_records(line, separator).unwrap_or_default();
        rows.into_iter().next().map(|row| row.cells)
    };
    SEPARATORS.into_iter().any(|separator| {
        let (Some(names), Some(row)) = (cells(line, separator), cells(next, separator)) else {
            return false;
        };
        let is_number = |cell: &str| cell.starts_with(|c: char| c.is_ascii_digit());
        let has_letter = |name: &str| name.contains(char::is_alphabetic);
        names.len() > 1
            && names.len() == row.len()
            && names.get(0) == Some("#")
            && names.iter().all(|name| !name.is_empty())
            && names.iter().any(has_letter)
            && row.get(0).is_some_and(is_number)
    })
}

/// The text with empty lines in place of those that do not count and behind those that are joined, so that lines keep their numbers.
pub(super) fn counted_lines(text: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let mut rest = &lines[..];
    let mut kept = String::with_capacity(text.len() + 1);
    let mut is_first = true;
    while let Some((line, behind)) = rest.split_first() {
        let more = lines_in_quotes(line, behind);
        let (more, below) = behind.split_at(more);
        let whole = joined(line, more);
        let is_counted = counts(line) || is_first && names_columns(&whole, below);
        rest = if is_counted { below } else { behind };
        let count = if is_counted { more.len() } else { 0 };
        if is_counted {
            is_first = false;
            kept.push_str(&whole);
        }
        kept.extend(std::iter::repeat_n('\n', 1 + count));
    }
    kept
}

/// The separator of the header and the line behind it, among lines that count; `None` for blanks.
pub(super) fn separator(text: &str) -> Option<char> {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let (header, next) = (lines.next()?, lines.next());
    let holds = |line: &str, separator: char| {
        let mut is_there = false;
        in_quotes_behind(
            line,
            false,
            |c| c == separator,
            |c| is_there |= c == separator,
        );
        is_there
    };
    let in_both = |&c: &char| holds(header, c) && next.is_none_or(|next| holds(next, c));
    let found = SEPARATORS.into_iter().find(in_both);
    found.or_else(|| SEPARATORS.into_iter().find(|&c| holds(header, c)))
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
        if line.trim().is_empty() {
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
