//! Photos under names that COLMAP's lists and texts can hold: a blank ends a name there.

use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::cannot_write;
use crate::fault::Fault;
use crate::files::{self, Inputs, Kind};
use crate::photo_set::PhotoSet;

/// What COLMAP calls the photos, and where it finds them.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Called {
    /// Of each photo.
    pub(super) names: Vec<String>,
    /// They lie in it.
    pub(super) folder: PathBuf,
}

impl Called {
    /// As they are, in their own folder; where a name has blanks, all of them in one beside the database, without blanks: hard
    /// links, copies on a disk of another kind.
    ///
    /// # Errors
    /// Where they can be neither linked nor copied.
    pub(super) fn of(photos: &PhotoSet, work: &Path) -> Result<Self, Fault> {
        let own: Vec<String> = photos.photos.iter().map(|of| of.name.clone()).collect();
        let has_blank = |name: &String| name.contains(char::is_whitespace);
        if !own.iter().any(has_blank) {
            // Names may begin with a folder's.
            let above = photos.photos.first().and_then(|photo| {
                photo
                    .path
                    .ancestors()
                    .nth(1 + photo.name.matches('/').count())
            });
            let folder = above.unwrap_or_else(|| Path::new(".")).to_owned();
            return Ok(Self { names: own, folder });
        }
        let folder = work.join("photos");
        fs::create_dir_all(&folder).map_err(|error| cannot_write(&folder, &error))?;
        // All lie in one folder then.
        let is_kept = |name: &String| !has_blank(name) && !name.contains('/');
        let mut taken: HashSet<String> = own.iter().filter(|name| is_kept(name)).cloned().collect();
        let names = own.into_iter().map(|name| match is_kept(&name) {
            true => name,
            false => {
                let mut name = name.replace(|c: char| c.is_whitespace() || c == '/', "_");
                while !taken.insert(name.clone()) {
                    name.insert(0, '_');
                }
                name
            }
        });
        let names: Vec<String> = names.collect();
        // What is not there is not asked for either.
        let there = photos.photos.iter().zip(&names);
        for (photo, name) in there.filter(|(photo, _)| photo.path.is_file()) {
            let link = folder.join(name);
            // Of a run that was cut off.
            let _ = fs::remove_file(&link);
            if fs::hard_link(&photo.path, &link).is_err() {
                let bytes = fs::read(&photo.path).map_err(|error| cannot_write(&link, &error))?;
                files::write(&link, &bytes, Kind::Result, &Inputs::default(), true)?;
            }
        }
        Ok(Self { names, folder })
    }
}
