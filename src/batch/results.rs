//! The folder of a season's results: whose it is, and its tables.

use std::fs::File;
use std::path::Path;

use crate::exports::{self, SeasonReport, SeasonRow};
use crate::fault::Fault;
use crate::files::{self, FileError, Inputs, Kind, cannot_be};
use crate::flight::Date;
use crate::record;
use crate::units::LengthUnit;

/// Whoever works in the folder holds it; and by it the folder is known.
pub(crate) const LOCK: &str = "season.lock";

/// The folder of a season's results, held by this process: no other one works in it.
#[derive(Debug)]
pub struct ResultsFolder {
    /// The system takes it away with the process, however that ends.
    _lock: File,
}

impl ResultsFolder {
    /// Makes or opens it.
    ///
    /// # Errors
    /// Where it holds something else, another process works in it, or it cannot be made.
    pub fn open(to: &Path) -> Result<Self, FileError> {
        files::make_folder(to)?;
        let path = to.join(LOCK);
        let cannot = |error: std::io::Error| FileError::new(&path, cannot_be("made", &error));
        let mut entries = to
            .read_dir()
            .map_err(|error| FileError::new(to, files::unreadable_folder(&error)))?;
        if !path.is_file() && entries.next().is_some() {
            let what = "it is not empty, and holds no results of a season";
            let remedy = "choose a new folder, or one of an earlier batch";
            return Err(FileError::new(to, Fault::new(what, remedy)));
        }
        match files::lock(&path).map_err(cannot)? {
            Some(lock) => Ok(Self { _lock: lock }),
            None => {
                let what = "another batch is at work in it";
                let fault = Fault::new(what, "wait for its end, or choose another folder");
                Err(FileError::new(to, fault))
            }
        }
    }
}

/// What is to be said of the results in a folder, one sentence each.
pub fn notes_on_results(to: &Path, rows: &[SeasonRow]) -> Vec<String> {
    let of_days = rows.iter().filter_map(of_another_day);
    of_other_flights(to, rows)
        .into_iter()
        .chain(of_days)
        .collect()
}

/// That a blast is called by another day than it stands at: cameras' clocks go wrong.
fn of_another_day(row: &SeasonRow) -> Option<String> {
    let date = row.date?;
    let bytes = row.blast.as_bytes();
    let named: Date = bytes
        .windows(10)
        .find_map(|part| std::str::from_utf8(part).ok()?.parse().ok())?;
    (named != date).then(|| {
        format!(
            "{}: it stands at {date}, as the clock of its camera or the season's file says; where that is wrong, give its date in \
             the season's file",
            row.blast
        )
    })
}

/// That results of other flights lie in the folder: of one that was renamed or taken away, or of another season's.
fn of_other_flights(to: &Path, rows: &[SeasonRow]) -> Option<String> {
    let is_other = |name: &String| {
        to.join(name).join(record::NAME).is_file() && rows.iter().all(|row| row.results != *name)
    };
    let names = to.read_dir().ok()?.flatten();
    let names = names.map(|entry| entry.file_name().to_string_lossy().into_owned());
    let mut others: Vec<String> = names.filter(is_other).collect();
    others.sort();
    (!others.is_empty()).then(|| {
        format!(
            "results of flights that are none of these stay in {}: {}",
            to.display(),
            others.join(", ")
        )
    })
}

/// Writes the tables of a season, `season.csv`, `season.html` and `season.jsonl`, into the folder of its results, and
/// returns the table for people. Flights with a date come in its order, the others after them.
///
/// # Errors
/// Where one cannot be written, or stands there from others.
pub fn write_results(
    to: &Path,
    name: &str,
    unit: LengthUnit,
    rows: Vec<SeasonRow>,
    mut notes: Vec<String>,
    force: bool,
) -> Result<String, FileError> {
    notes.extend(notes_on_results(to, &rows));
    let mut report = SeasonReport {
        name,
        unit,
        rows,
        notes,
    };
    // Stable: blasts of a day keep their order.
    report
        .rows
        .sort_by_key(|row| (row.date.is_none(), row.date));
    let memory = |error: String| FileError::new(to, Fault::new(error, "close other programs"));
    let csv = exports::season_csv(&report).map_err(|error| memory(error.to_string()))?;
    let lines = exports::season_json_lines(&report).map_err(|error| memory(error.to_string()))?;
    let page = exports::season_page(&report);
    let nothing = Inputs::default();
    for (file, text) in [
        ("season.csv", csv),
        ("season.jsonl", lines),
        ("season.html", page),
    ] {
        let path = to.join(file);
        files::write(&path, text.as_bytes(), Kind::Result, &nothing, force)
            .map_err(|fault| FileError::new(&path, fault))?;
    }
    Ok(exports::season_table(&report))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_blast_of_another_day_is_named() {
        let row = |blast: &str, date: Option<&str>| SeasonRow {
            blast: blast.to_owned(),
            date: date.map(|date| date.parse().unwrap()),
            flight: String::new(),
            results: String::new(),
            findings: None,
            error: None,
        };
        let said = of_another_day(&row("pit 2026-05-08 north", Some("2013-03-04"))).unwrap();
        assert!(said.contains("stands at 2013-03-04"), "{said}");
        assert_eq!(of_another_day(&row("2026-05-08", Some("2026-05-08"))), None);
        assert_eq!(of_another_day(&row("2026-05-08", None)), None);
        assert_eq!(of_another_day(&row("Süd 7", Some("2013-03-04"))), None);
    }
}
