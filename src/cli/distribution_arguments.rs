//! The arguments of every command that reads size distributions: the files and their columns.

use std::path::PathBuf;

use clap::Args;

use super::OutputUnit;
use crate::formats::{DistributionColumns, FileError, read_size_distributions};
use crate::fragmentation::DistributionSet;

#[derive(Debug, Args)]
pub(super) struct DistributionArguments {
    /// Tables of cumulative percent passing by size, as CSV. Curves without a method are called after
    /// their file.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The column of sizes, where its name does not say so.
    #[arg(long, value_name = "COLUMN")]
    size: Option<String>,
    /// The column of cumulative percent passing.
    #[arg(long, value_name = "COLUMN")]
    passing: Option<String>,
    /// The column that says how it was measured.
    #[arg(long, value_name = "COLUMN")]
    method: Option<String>,
    /// The column of trials: repetitions of a measurement.
    #[arg(long, value_name = "COLUMN")]
    trial: Option<String>,
    /// The column of photos.
    #[arg(long, value_name = "COLUMN")]
    photo: Option<String>,
    /// The column of areas or masses.
    #[arg(long, value_name = "COLUMN")]
    weight: Option<String>,
    /// The unit of sizes, where a table does not state it.
    #[arg(long = "size-unit", alias = "unit", value_enum)]
    unit: Option<OutputUnit>,
}

impl DistributionArguments {
    /// The curves of all files in the unit of the first, with what was mended.
    pub(super) fn read(&self) -> Result<(DistributionSet, Vec<String>), String> {
        let columns = DistributionColumns {
            size: self.size.clone(),
            passing: self.passing.clone(),
            method: self.method.clone(),
            trial: self.trial.clone(),
            photo: self.photo.clone(),
            weight: self.weight.clone(),
            unit: self.unit.map(Into::into),
        };
        let mut joined: Option<DistributionSet> = None;
        let mut warnings = Vec::new();
        for file in &self.files {
            let (mut set, found) =
                read_size_distributions(file, &columns).map_err(|error| error.to_string())?;
            let found = found.into_iter();
            warnings.extend(found.map(|warning| format!("{}: {warning}", file.display())));
            let name = file.file_stem().unwrap_or_default();
            set.name_method(&name.to_string_lossy());
            match &mut joined {
                None => joined = Some(set),
                Some(joined) => joined
                    .join(&set)
                    .map_err(|fault| FileError::new(file, fault).to_string())?,
            }
        }
        // The command line asks for one or more.
        let joined = joined.ok_or_else(|| "no file is named; name one".to_owned())?;
        Ok((joined, warnings))
    }

    /// The files.
    pub(super) fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// The names of the files.
    pub(super) fn names(&self) -> Vec<String> {
        let names = self.files.iter().map(|file| file.display().to_string());
        names.collect()
    }
}
