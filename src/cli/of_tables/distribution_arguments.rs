//! The arguments that `psd fit` and `psd compare` have in common: the files with their columns, the
//! function, what is written.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::cli::OutputUnit;
use crate::cli::outputs::AnswerArguments;
use crate::formats::{DistributionColumns, FileError, read_size_distributions};
use crate::fragmentation::{DistributionSet, Model, Weighting};

/// The columns of every table of size distributions.
#[derive(Debug, Args)]
pub(super) struct ColumnArguments {
    /// The column of sizes, where its name does not say so.
    #[arg(long, value_name = "COLUMN")]
    pub(super) size: Option<String>,
    /// The column of cumulative percent passing.
    #[arg(long, value_name = "COLUMN")]
    passing: Option<String>,
    /// The unit of sizes, where a table does not state it.
    #[arg(long = "size-unit", alias = "unit", value_enum)]
    unit: Option<OutputUnit>,
}

impl ColumnArguments {
    /// With these columns named alone.
    pub(super) fn columns(&self) -> DistributionColumns {
        DistributionColumns {
            size: self.size.clone(),
            passing: self.passing.clone(),
            unit: self.unit.map(Into::into),
            ..DistributionColumns::default()
        }
    }
}

/// The function, the percentiles, and what is written.
#[derive(Debug, Args)]
pub(super) struct FittingArguments {
    /// The function that is fitted: to each curve, or to each method's mean curve.
    #[arg(long, value_parser = models(), default_value = "swebrec")]
    pub(super) model: Model,
    /// Percents passing whose sizes are given or compared.
    #[arg(
        long,
        value_name = "PERCENT,...",
        value_delimiter = ',',
        value_parser = percent,
        default_value = "10,20,50,80,90"
    )]
    pub(super) percentiles: Vec<f64>,
    #[command(flatten)]
    pub(super) answer: AnswerArguments,
    /// Draw the distributions with the functions into this file, .svg or .png; may be given more than
    /// once.
    #[arg(long, value_name = "FILE")]
    pub(super) figure: Vec<PathBuf>,
}

/// The models by their keys, each explained by its name.
fn models() -> impl TypedValueParser<Value = Model> {
    let keys = Model::ALL.map(|model| PossibleValue::new(model.key()).help(model.name()));
    PossibleValuesParser::new(keys).map(|key| {
        let model = Model::ALL.into_iter().find(|model| model.key() == key);
        model.unwrap_or_default()
    })
}

fn percent(text: &str) -> Result<f64, String> {
    let percent = text.trim().parse().map_err(|e| format!("{e}"))?;
    if percent > 0.0 && percent < 100.0 {
        return Ok(percent);
    }
    Err("give percents between 0 and 100".to_owned())
}

/// Files of size distributions of several methods.
#[derive(Debug, Args)]
pub(super) struct DistributionArguments {
    /// Tables of cumulative percent passing by size, as CSV. Curves without a method are called after
    /// their file; so is a trial without a name whose method was in a file before. NAME=FILE calls a file's method NAME,
    /// whatever it says itself: so two files of one method are held against each other.
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    #[command(flatten)]
    columns: ColumnArguments,
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
}

/// That a method is in another folder's file of the same name, too: a program's, and of another blast as like as not.
fn merged_with_another(
    file: &Path,
    set: &DistributionSet,
    read: &[(&Path, String, DistributionSet)],
) -> Option<String> {
    let methods = |set: &DistributionSet| -> BTreeSet<String> {
        let of_curves = set.curves.iter().map(|curve| curve.labels.method.clone());
        of_curves.collect()
    };
    let of_now = methods(set);
    let alike = read
        .iter()
        .filter(|(other, ..)| other.file_name() == file.file_name());
    let (other, method) = alike.into_iter().find_map(|(_, name, of)| {
        let shared = methods(of).intersection(&of_now).next().cloned();
        Some((name, shared?))
    })?;
    Some(format!(
        "'{method}' is in {other}, too: both are taken for one method and merged; to compare them call them apart (A={other} B={})",
        file.display()
    ))
}

impl DistributionArguments {
    /// The curves of all files in the unit of the first, with what was mended; `merging` is by what they are to be merged.
    pub(super) fn read(
        &self,
        merging: Weighting,
    ) -> Result<(DistributionSet, Vec<String>), String> {
        let columns = DistributionColumns {
            method: self.method.clone(),
            trial: self.trial.clone(),
            photo: self.photo.clone(),
            weight: self.weight.clone(),
            merging,
            ..self.columns.columns()
        };
        let mut read: Vec<(&Path, String, DistributionSet)> = Vec::new();
        let mut warnings = Vec::new();
        for (named, file) in self.named() {
            let (mut set, mut found) =
                read_size_distributions(file, &columns).map_err(|error| error.to_string())?;
            if let Some(method) = named {
                (set.call_method(method))
                    .map_err(|fault| FileError::new(file, fault).to_string())?;
            }
            let stem = file.file_stem().unwrap_or_default().to_string_lossy();
            set.name_method(&stem);
            let others = read.iter().map(|(_, name, set)| (name.as_str(), set));
            let renamed = set
                .set_apart(&stem, &others.collect::<Vec<_>>())
                .map_err(|fault| FileError::new(file, fault).to_string())?;
            found.extend(renamed);
            let name = file.display().to_string();
            if named.is_none() {
                found.extend(merged_with_another(file, &set, &read));
            }
            warnings.extend(found.iter().map(|warning| format!("{name}: {warning}")));
            read.push((file, name, set));
        }
        let Some((first, _, set)) = read.first() else {
            // The command line asks for one or more.
            return Err("no file is named; name one".to_owned());
        };
        let joined = DistributionSet::joined(set.unit, read.iter().map(|(_, _, set)| set))
            .map_err(|fault| FileError::new(first, fault).to_string())?;
        Ok((joined, warnings))
    }

    /// The files, and what each one's method is to be called. Where a file has such a name, that is the file.
    fn named(&self) -> impl Iterator<Item = (Option<&str>, &Path)> {
        self.files.iter().map(|text| {
            let parts = text.to_str().and_then(|text| text.split_once('='));
            match parts.filter(|(name, _)| !name.trim().is_empty() && !text.exists()) {
                Some((name, file)) => (Some(name.trim()), Path::new(file)),
                None => (None, text.as_path()),
            }
        })
    }

    /// The files.
    pub(super) fn files(&self) -> impl Iterator<Item = &Path> {
        self.named().map(|(_, file)| file)
    }

    /// The names of the files.
    pub(super) fn names(&self) -> Vec<String> {
        let names = self.files().map(|file| file.display().to_string());
        names.collect()
    }
}
