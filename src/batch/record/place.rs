//! Paths and names as a record has them: from the folder of the results.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::Named;
use crate::files::{self, FileError, cannot_be, sha256_of_bytes};
use crate::opening::path_from;
use crate::told::FlightTold;

/// Where paths are counted from.
pub(super) struct Place {
    /// The folder of the results, from the root with links followed.
    pub(super) to: PathBuf,
}

impl Place {
    pub(super) fn of(to: &Path) -> Result<Self, FileError> {
        let to =
            fs::canonicalize(to).map_err(|error| FileError::new(to, cannot_be("read", &error)))?;
        Ok(Self { to })
    }

    /// Of these files those below the folder, by their paths from it with slashes.
    pub(super) fn below(&self, paths: &[PathBuf]) -> BTreeSet<String> {
        let real = paths.iter().filter_map(|path| fs::canonicalize(path).ok());
        let inside = real.filter_map(|path| {
            let inside = path.strip_prefix(&self.to).ok()?;
            Some(inside.to_string_lossy().replace('\\', "/"))
        });
        inside.collect()
    }

    /// A path as the record has it.
    pub(super) fn name(&self, path: &Path) -> Result<String, FileError> {
        path_from(&self.to, path).map_err(|fault| FileError::new(path, fault))
    }

    pub(super) fn named(&self, told: &FlightTold) -> Result<Named, FileError> {
        let maybe =
            |path: &Option<PathBuf>| path.as_deref().map(|path| self.name(path)).transpose();
        Ok(Named {
            flight: self.name(&told.flight)?,
            surface: maybe(&told.surface)?,
            photos: maybe(&told.photos)?,
            reference: maybe(&told.reference)?,
            asked: told.asked.clone(),
        })
    }

    /// A checksum of the names in a folder, and in those in it where outlines are saved. What lies in the folder of
    /// the results, or is it, does not count; nor do hidden files, which systems put anywhere.
    pub(super) fn names_in(&self, folder: &Path) -> Result<String, FileError> {
        let mut names = BTreeSet::new();
        let entries = |folder: &Path| {
            fs::read_dir(folder)
                .map_err(|error| FileError::new(folder, files::unreadable_folder(&error)))
        };
        for entry in entries(folder)?.flatten() {
            let path = entry.path();
            let name = entry.file_name().to_string_lossy().into_owned();
            if name.starts_with('.') || self.to.starts_with(fs::canonicalize(&path).unwrap_or(path))
            {
                continue;
            }
            names.insert(name);
        }
        let outlines = folder.join("fragments");
        if outlines.is_dir()
            && !self
                .to
                .starts_with(fs::canonicalize(&outlines).unwrap_or_default())
        {
            let inside = entries(&outlines)?.flatten();
            names.extend(inside.map(|entry| format!("/{}", entry.file_name().to_string_lossy())));
        }
        let all: Vec<String> = names.into_iter().collect();
        Ok(sha256_of_bytes(all.join("\n").as_bytes()))
    }
}
