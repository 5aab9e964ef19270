//! Which flights a season has, and what is done with them.
//!
//! ```text
//! file     SEASON.toml
//! pattern  paths with * and ?
//! once     a flight that is found in several ways
//! below    the flights below a folder
//! naming   what the results of each are called
//! ```

mod below;
mod file;
mod naming;
mod once;
mod pattern;

use std::path::{Path, PathBuf};

use crate::asked::{Asked, Step};
use crate::fault::{Fault, first_names};
use crate::files::{FileError, read_text};
use crate::flight::Date;
use crate::numbers::counted;

use below::is_results_folder;
pub(crate) use naming::results_folder;
use once::Once;

/// A season: where its flights are, and what is done with them.
#[derive(Debug, Clone, PartialEq)]
pub struct Season {
    /// For people.
    pub name: String,
    /// The steps.
    pub asked: Asked,
    /// The folder of the results, where the season says it.
    pub to: Option<PathBuf>,
    /// In their order.
    sources: Vec<Source>,
    /// That its file names a reference and leaves out psd, which would hold sizes against it.
    reference_waits: Option<String>,
}

/// Where flights are: one, those below a folder, or those that a pattern matches.
#[derive(Debug, Clone, PartialEq, Default)]
struct Source {
    /// The line of SEASON.toml that names it.
    line: Option<u64>,
    path: PathBuf,
    /// Whether flights arrive below it: there may be none yet.
    is_watched: bool,
    /// Of the blast.
    name: Option<String>,
    date: Option<Date>,
    surface: Option<PathBuf>,
    photos: Option<PathBuf>,
    reference: Option<PathBuf>,
}

/// A flight of a season.
#[derive(Debug, Clone, PartialEq)]
pub struct SeasonFlight {
    /// What its blast is called.
    pub blast: String,
    /// When it was flown, where the season says so.
    pub date: Option<Date>,
    /// The flight, as every command takes it.
    pub path: PathBuf,
    /// `--surface`.
    pub surface: Option<PathBuf>,
    /// `--photo-folder`.
    pub photos: Option<PathBuf>,
    /// The table that its fragments are held against.
    pub reference: Option<PathBuf>,
    /// The name of the folder of its results.
    pub results: String,
}

/// The flights of a season as they are now.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Found {
    /// In the order of the season, and below a folder by name.
    pub flights: Vec<SeasonFlight>,
    /// What to know, a sentence each.
    pub notes: Vec<String>,
}

impl Season {
    /// Whether a file is a SEASON.toml: a TOML that is no flight.
    pub fn is_season(path: &Path) -> bool {
        let is_toml = path.extension().is_some_and(|ending| ending == "toml");
        if !is_toml
            || !path.is_file()
            || path
                .file_name()
                .is_some_and(|name| name == naming::FLIGHT_FILE)
        {
            return false;
        }
        let text = read_text(path).unwrap_or_default();
        let table = toml::de::DeTable::parse(&text).ok();
        let has = |key: &str| {
            let mut keys = table.iter().flat_map(|table| table.get_ref().iter());
            keys.any(|(name, _)| {
                let name: &str = name.get_ref();
                name == key
            })
        };
        !has("world") && !has("photos")
    }

    /// Reads a SEASON.toml.
    ///
    /// # Errors
    /// With the line, where it cannot be used.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let text = read_text(path)?;
        file::parse(&text, path).map_err(|fault| FileError::new(path, fault))
    }

    /// Of flights, and folders above flights.
    ///
    /// # Errors
    /// Where one is not there: of a season's file a blast may be missing, and fails alone; what was typed now is mistyped.
    pub fn of_folders(paths: &[PathBuf], asked: Asked) -> Result<Self, FileError> {
        let is_there = |path: &Path| path.exists() || pattern::is_pattern(&path.to_string_lossy());
        if let Some(missing) = paths.iter().find(|path| !is_there(path)) {
            let fault = Fault::new("there is no such file or folder", "name one that is there");
            return Err(FileError::new(missing, fault));
        }
        let names = paths.iter().map(|path| naming::name_of(path));
        Ok(Self {
            name: match paths {
                [] => "Season".to_owned(),
                _ => first_names(names),
            },
            asked,
            to: None,
            sources: paths
                .iter()
                .map(|path| Source {
                    path: path.clone(),
                    ..Source::default()
                })
                .collect(),
            reference_waits: None,
        })
    }

    /// One more folder, below which flights arrive.
    pub fn watch(&mut self, path: &Path) {
        self.sources.retain(|source| source.path != path);
        self.sources.push(Source {
            path: path.to_owned(),
            is_watched: true,
            ..Source::default()
        });
    }

    /// The files and folders that it names.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.sources.iter().map(|source| source.path.as_path())
    }

    /// The flights that are there now. Results in `to` and those of other seasons are none.
    ///
    /// # Errors
    /// Where two would have the same folder of results, or one name is given to several.
    pub fn flights(&self, to: &Path) -> Result<Found, FileError> {
        let mut found = Found::default();
        let mut without: Vec<PathBuf> = Vec::new();
        let mut photos_alone: Vec<PathBuf> = Vec::new();
        let mut passed_over: Vec<PathBuf> = Vec::new();
        let mut once = Once::default();
        for source in &self.sources {
            let matches = pattern::matches(&source.path);
            if matches.is_empty() {
                let path = source.path.display();
                found.notes.push(format!("{path}: nothing is called so"));
            }
            let mut of_source = Vec::new();
            // What fits a pattern may lie beside the flights, and nobody named it.
            let by_pattern = pattern::stands_for_others(&source.path);
            for path in matches {
                if by_pattern && path.is_file() && !below::is_flight_file(&path) {
                    passed_over.push(path);
                    continue;
                }
                let below = below::flights(&path, to);
                // What is named fails by itself, and says why.
                let has_none = below.flights.is_empty();
                let fails = has_none && !source.is_watched && !by_pattern;
                if has_none && by_pattern && below.photos_alone.is_empty() {
                    without.push(path.clone());
                }
                let is_other = |folder: &PathBuf| !fails || *folder != path;
                without.extend(below.without.into_iter().filter(is_other));
                photos_alone.extend(below.photos_alone.into_iter().filter(is_other));
                let flights = match fails && !is_season_of(&path, to) {
                    true => vec![path.clone()],
                    false => below.flights,
                };
                let root = match by_pattern {
                    true => pattern::fixed_part(&source.path),
                    false => path,
                };
                of_source.extend(flights.into_iter().map(|flight| (root.clone(), flight)));
            }
            let many = of_source.len() > 1;
            if many && let Some(name) = &source.name {
                let what = format!("'{name}' would be the name of {} flights", of_source.len());
                let fault = Fault {
                    line: source.line,
                    ..Fault::new(what, "name one flight, or leave the name out")
                };
                return Err(FileError::new(&source.path, fault));
            }
            for (root, flight) in of_source {
                let blast = match &source.name {
                    Some(name) => name.clone(),
                    None => naming::below(&root, &flight),
                };
                let is_named = flight == source.path;
                let flight = SeasonFlight {
                    results: results_folder(&blast),
                    blast,
                    date: source.date,
                    path: flight,
                    surface: source.surface.clone(),
                    photos: source.photos.clone(),
                    reference: source.reference.clone(),
                };
                once.add(flight, is_named)?;
            }
        }
        found.flights = once.flights();
        let renamed = (found.flights.iter()).filter(|flight| flight.results != flight.blast);
        found.notes.extend(renamed.map(|flight| {
            let (blast, results) = (&flight.blast, &flight.results);
            format!("the results of '{blast}' go into the folder '{results}'")
        }));
        let said = [
            (passed_over, "file", ["is no flight", "are no flights"]),
            (without, "folder", ["holds no flight", "hold no flight"]),
            (
                photos_alone,
                "folder",
                [
                    "holds photos alone, without a cloud, and is no flight",
                    "hold photos alone, without a cloud, and are no flights",
                ],
            ),
        ];
        for (folders, what, [of_one, of_many]) in said {
            let names = folders.iter().map(|folder| folder.display().to_string());
            let names = first_names(names);
            let of_all = match folders.len() {
                0 => continue,
                1 => of_one,
                _ => of_many,
            };
            let count = counted(folders.len(), what);
            found.notes.push(format!("{count} {of_all}: {names}"));
        }
        found.notes.extend(self.without_reference(&found.flights));
        let is_left_out = !self.asked.has(Step::Psd);
        let waits = self.reference_waits.iter().filter(|_| is_left_out);
        found.notes.extend(waits.cloned());
        naming::refuse_twins(&found.flights)?;
        Ok(found)
    }

    /// That psd is passed over, and for whom: nobody says what their sizes are held against.
    fn without_reference(&self, flights: &[SeasonFlight]) -> Option<String> {
        if !self.asked.has(Step::Psd) || self.asked.names_reference() {
            return None;
        }
        let without = flights.iter().filter(|flight| flight.reference.is_none());
        let names: Vec<&str> = without.map(|flight| flight.blast.as_str()).collect();
        let of = match names.len() {
            0 => return None,
            count if count == flights.len() => "all flights".to_owned(),
            count => {
                let of = format!("{count} of {} flights", flights.len());
                format!("{of} ({})", first_names(names))
            }
        };
        Some(format!(
            "psd is passed over for {of}: no reference is named for them (in SEASON.toml as reference of [psd] or of a \
             [[flight]], or on the command line: --set psd.reference=FILE)"
        ))
    }
}

/// Whether all that lies in a folder are the results: it is no flight.
fn is_season_of(path: &Path, to: &Path) -> bool {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    is_results_folder(path) || real(path).is_some() && real(path) == real(to)
}

#[cfg(test)]
mod tests;
