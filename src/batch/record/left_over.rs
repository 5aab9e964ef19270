//! What lies beside a record: results of earlier runs, unfinished files, the word that the flight failed.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::NAME;
use super::place::Place;
use crate::files::{self, FAILED_MARK, FileError, Inputs, Kind, cannot_be, sha256_of_bytes};

/// Where it is said that the flight failed.
const FAILED: &str = "failed.txt";

/// Takes away what is in the folder of a flight's results and was not written now: results that earlier runs wrote for
/// steps or photos that are not there any more. `before` are those that are known from the record; others are known by
/// their marks. Files of others stay. Returns how many were taken away, by the file or the folder (with a slash) beside the record that
/// they were or lay in; the word that the flight failed does not count.
///
/// # Errors
/// Where the folder cannot be listed, or a file not removed.
pub fn remove_what_is_left(
    to: &Path,
    written: &[PathBuf],
    before: &BTreeMap<String, String>,
) -> Result<BTreeMap<String, usize>, FileError> {
    let place = Place::of(to)?;
    let written = place.below(written);
    let mut taken_away = BTreeMap::new();
    for (name, path) in files_below(&place.to)? {
        let is_result = || {
            let bytes = files::read_bytes(&path).unwrap_or_default();
            files::is_own_result(&bytes) || before.get(&name) == Some(&sha256_of_bytes(&bytes))
        };
        let stays = name == NAME || written.contains(&name);
        if !stays && is_result() {
            remove(&path)?;
            if name != FAILED {
                let kind = name.split_inclusive('/').next().unwrap_or(&name);
                *taken_away.entry(kind.to_owned()).or_insert(0) += 1;
            }
            // Folders that are empty now go, too; one that is not, stays.
            let mut folder = path.parent();
            while let Some(empty) = folder.filter(|folder| *folder != place.to) {
                if fs::remove_dir(empty).is_err() {
                    break;
                }
                folder = empty.parent();
            }
        }
    }
    Ok(taken_away)
}

/// Says in the folder of a flight's results, where there is one, that the flight failed: what stands there may be of files
/// that are not so any more. It stays, for hours of outlining go on from it; the flight's next success takes the word away.
///
/// # Errors
/// Where it cannot be written.
pub(crate) fn write_failed(to: &Path, error: &str) -> Result<(), FileError> {
    if !to.is_dir() {
        return Ok(());
    }
    let path = to.join(FAILED);
    let text = format!(
        "{FAILED_MARK}\n{error}\nResults beside this file may be of an earlier run, of other files than now.\n"
    );
    files::write(
        &path,
        text.as_bytes(),
        Kind::Result,
        &Inputs::default(),
        false,
    )
    .map_err(|fault| FileError::new(&path, fault))
}

/// Takes away what a killed process had not finished.
///
/// # Errors
/// Where the folder cannot be listed, or a file not removed.
pub fn remove_unfinished_below(to: &Path) -> Result<(), FileError> {
    for (_, path) in files_below(to)? {
        if files::is_unfinished(&path) {
            remove(&path)?;
        }
    }
    Ok(())
}

fn remove(path: &Path) -> Result<(), FileError> {
    fs::remove_file(path).map_err(|error| FileError::new(path, cannot_be("removed", &error)))
}

/// The files below a folder: their paths from it, with slashes, and in full. Links to folders are not followed.
fn files_below(folder: &Path) -> Result<Vec<(String, PathBuf)>, FileError> {
    let mut found = Vec::new();
    let mut waiting = vec![(String::new(), folder.to_owned())];
    while let Some((before, folder)) = waiting.pop() {
        let entries = match fs::read_dir(&folder) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
            entries => entries
                .map_err(|error| FileError::new(&folder, files::unreadable_folder(&error)))?,
        };
        for entry in entries.flatten() {
            let name = format!("{before}{}", entry.file_name().to_string_lossy());
            match entry.file_type() {
                Ok(kind) if kind.is_dir() => waiting.push((name + "/", entry.path())),
                _ => found.push((name, entry.path())),
            }
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Record;
    use crate::record::tests::flight;

    #[test]
    fn what_is_left_goes_and_files_of_others_stay() {
        let flight = flight();
        flight.record();
        let before = Record::begin(&flight.told.to).unwrap();
        let to = &flight.told.to;
        for (name, text) in [
            (".fragscale-abc.part", "half"),
            (
                "old/1_labels.csv",
                "photo,percent_passing,size_cm,low_cm,high_cm\n",
            ),
            ("notes.txt", "mine"),
        ] {
            fs::create_dir_all(to.join(name).parent().unwrap()).unwrap();
            fs::write(to.join(name), text).unwrap();
        }
        remove_unfinished_below(to).unwrap();
        write_failed(to, "it failed").unwrap();
        let taken_away = remove_what_is_left(to, &[to.join("scales.csv")], &before).unwrap();
        let kinds: Vec<(&str, usize)> = taken_away.iter().map(|(k, n)| (k.as_str(), *n)).collect();
        assert_eq!(kinds, [("maps/", 1), ("old/", 1)]);
        let names: Vec<String> = files_below(to)
            .unwrap()
            .into_iter()
            .map(|(name, _)| name)
            .collect();
        // The map was ours by the record of before; its folder and the other one are gone, too.
        assert_eq!(names, ["flight.json", "notes.txt", "scales.csv"]);
        assert!(!to.join("maps").exists() && !to.join("old").exists());
    }
}
