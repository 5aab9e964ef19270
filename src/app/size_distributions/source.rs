//! What came from one file or one pasted table.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::fault::Fault;
use crate::fragmentation::DistributionSet;
use crate::units::LengthUnit;

/// Size distributions that were added together.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The file's name, or "Pasted table 1".
    pub name: String,
    /// The file.
    pub path: Option<PathBuf>,
    /// As read.
    pub set: DistributionSet,
    /// What was noticed while reading.
    pub warnings: Vec<String>,
    /// What it was made of, where it is of a photo's fragments.
    pub fragments: Option<OfFragments>,
}

/// What a curve of fragments was made of: when it is another one, so is the curve.
#[derive(Debug, Clone, PartialEq)]
pub struct OfFragments {
    /// The flight's file.
    pub flight: PathBuf,
    /// By its place in the flight.
    pub photo: usize,
    /// Of its outlines.
    pub revision: u64,
    /// Of the world's lengths.
    pub unit: LengthUnit,
}

impl Source {
    /// What a file holds. Curves without a method are called after their file.
    pub fn of_file(path: &Path, set: DistributionSet, warnings: Vec<String>) -> Self {
        let name = |part: Option<&std::ffi::OsStr>| {
            part.map_or_else(String::new, |part| part.to_string_lossy().into_owned())
        };
        let stem = name(path.file_stem());
        let mut set = set;
        set.name_method(&stem);
        Self {
            name: name(path.file_name()),
            path: Some(path.to_owned()),
            set,
            warnings,
            fragments: None,
        }
    }

    /// Whether it is in no file but a table that is written of it.
    pub fn is_pasted(&self) -> bool {
        self.path.is_none() && self.fragments.is_none()
    }

    /// Makes its curves differ in their labels from those of `others`: where a trial has no name, it
    /// is called after this source, and that is said.
    ///
    /// # Errors
    /// Where curves with the same labels are there already.
    pub fn set_apart(&mut self, others: &[Arc<Self>]) -> Result<(), Fault> {
        let others: Vec<_> = others.iter().map(|o| (o.name.as_str(), &o.set)).collect();
        let stem = self.path.as_deref().and_then(Path::file_stem);
        let stem = stem.map_or_else(
            || self.name.clone(),
            |stem| stem.to_string_lossy().into_owned(),
        );
        let said = self.set.set_apart(&stem, &others)?;
        self.warnings.extend(said);
        Ok(())
    }
}
