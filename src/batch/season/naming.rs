//! What a blast and the folder of its results are called, where nobody says it.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use super::SeasonFlight;
use crate::fault::Fault;
use crate::files::FileError;

/// The file whose folder is meant.
pub(super) const FLIGHT_FILE: &str = "flight.toml";

/// What a path means: of a flight.toml its folder, which is empty where the path has no other.
pub(super) fn meant(path: &Path) -> &Path {
    match path.file_name() {
        Some(name) if name == FLIGHT_FILE => path.parent().unwrap_or(path),
        _ => path,
    }
}

/// What a path is called: the last name of what it means.
pub(super) fn name_of(path: &Path) -> String {
    let path = meant(path);
    // "." and ".." have names of their own.
    let real = match path.file_name() {
        Some(_) => path.to_owned(),
        None => fs::canonicalize(path).unwrap_or_else(|_| path.to_owned()),
    };
    let name = match real.is_dir() {
        true => real.file_name(),
        false => real.file_stem(),
    };
    let name = name.unwrap_or_default().to_string_lossy().into_owned();
    match name.is_empty() {
        true => "flight".to_owned(),
        false => name,
    }
}

/// What a flight is called that was found below a folder: the way to it. So it keeps its name whatever comes beside it.
pub(super) fn below(root: &Path, flight: &Path) -> String {
    let inside = meant(flight);
    let inside = inside.strip_prefix(root).unwrap_or(Path::new(""));
    let mut parts: Vec<String> = inside
        .parent()
        .into_iter()
        .flatten()
        .map(|part| part.to_string_lossy().into_owned())
        .collect();
    parts.push(name_of(flight));
    parts.join("-")
}

/// A name as a folder's: without what systems do not take, and none of the season's own.
pub(crate) fn results_folder(name: &str) -> String {
    let safe = name.trim().chars().map(|c| match c {
        '/' | '\\' | ':' | '*' | '?' | '"' | '<' | '>' | '|' => '_',
        c if c.is_control() => '_',
        c => c,
    });
    let safe: String = safe.take(120).collect();
    // Windows takes no dot and no blank at the end; one at the beginning hides.
    let safe = safe.trim_end_matches(['.', ' ']);
    match safe.is_empty() || safe.starts_with('.') || safe.starts_with("season.") {
        true => format!("_{safe}"),
        false => safe.to_owned(),
    }
}

/// Refuses two flights whose results would go into one folder; systems that do not know small letters from large ones
/// among them.
pub(super) fn refuse_twins(flights: &[SeasonFlight]) -> Result<(), FileError> {
    let mut known: HashMap<String, &Path> = HashMap::new();
    for flight in flights {
        if let Some(first) = known.insert(flight.results.to_lowercase(), &flight.path) {
            let (name, first) = (&flight.results, first.display());
            let what =
                format!("its results would go into the folder '{name}', as those of {first}");
            let remedy = "give both names of their own in a SEASON.toml ([[flight]] name)";
            return Err(FileError::new(&flight.path, Fault::new(what, remedy)));
        }
    }
    Ok(())
}
