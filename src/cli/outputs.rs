//! Where the answers of commands go: standard output or a file, which is written by one rule
//! (`files::overwrite`), looked at before the work begins and again when it is written.

use std::borrow::Cow;
use std::fmt::Display;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use crate::exports::write_missions;
use crate::fault::Fault;
use crate::files::{self, Inputs, Kind};
use crate::formats::FileError;
use crate::plan::Mission;

/// `--force`.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct Force {
    /// Replace files that fragscale did not write. Files that are read are never written over.
    #[arg(long)]
    pub(super) force: bool,
}

/// `-o` of a command whose answer goes to standard output without it.
#[derive(Debug, Clone, Args)]
pub(super) struct OutputArguments {
    /// Write to this file instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    force: Force,
}

impl OutputArguments {
    /// The outputs of a command that reads these files or folders.
    pub(super) fn outputs<P: AsRef<Path>>(
        &self,
        inputs: impl IntoIterator<Item = P>,
    ) -> Result<Outputs<'_>, String> {
        Outputs::new(self.force, inputs).answer(self.output.as_deref())
    }

    /// The same of a command whose answer is text for people: no program would read that in a .json.
    pub(super) fn outputs_of_text<P: AsRef<Path>>(
        &self,
        inputs: impl IntoIterator<Item = P>,
    ) -> Result<Outputs<'_>, String> {
        match self.ending() {
            Some((file, ending)) if is_another(&ending) || is_numbers(&ending) => {
                let (written, remedy) = ("text for people", "end the name in .txt");
                Err(ends_otherwise(file, &ending, written, remedy))
            }
            _ => self.outputs(inputs),
        }
    }

    /// The file, and how its name ends.
    fn ending(&self) -> Option<(&Path, Cow<'_, str>)> {
        let file = self.output.as_deref()?;
        Some((file, file.extension()?.to_string_lossy()))
    }
}

/// Whether a file that ends so holds numbers for programs.
fn is_numbers(ending: &str) -> bool {
    ["csv", "json"].contains(&ending.to_lowercase().as_str())
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum AnswerFormat {
    Table,
    Csv,
    Json,
}

/// How and where the answer of a command goes that is a table for people, CSV or JSON.
#[derive(Debug, Clone, Args)]
pub(super) struct AnswerArguments {
    /// How to write it; without it as the output's name ends, else as a table.
    #[arg(long, value_enum)]
    format: Option<AnswerFormat>,
    #[command(flatten)]
    output: OutputArguments,
}

impl AnswerArguments {
    /// The outputs of a command that reads these files or folders.
    pub(super) fn outputs<P: AsRef<Path>>(
        &self,
        inputs: impl IntoIterator<Item = P>,
    ) -> Result<Outputs<'_>, String> {
        match self.output.ending() {
            Some((file, ending)) if self.format.is_none() && is_another(&ending) => {
                let written = "CSV, JSON or a table for people";
                let remedy = "end the name in .csv, .json or .txt (the table), or say --format";
                Err(ends_otherwise(file, &ending, written, remedy))
            }
            _ => self.output.outputs(inputs),
        }
    }

    /// Whether it is CSV, in which notes have no place.
    pub(super) fn is_csv(&self) -> bool {
        matches!(self.format(), AnswerFormat::Csv)
    }

    /// The chosen format, or what the file's name says: a table in a .csv is a table that no program reads.
    fn format(&self) -> AnswerFormat {
        let file = self.output.output.as_deref();
        let ending = file.and_then(Path::extension).unwrap_or_default();
        let by_name = match ending.to_string_lossy().to_lowercase().as_str() {
            "csv" => AnswerFormat::Csv,
            "json" => AnswerFormat::Json,
            _ => AnswerFormat::Table,
        };
        self.format.unwrap_or(by_name)
    }

    /// What a report says in that format.
    pub(super) fn text<T, C: Display, J: Display>(
        &self,
        report: &T,
        table: fn(&T) -> String,
        csv: fn(&T) -> Result<String, C>,
        json: fn(&T) -> Result<String, J>,
    ) -> Result<String, String> {
        match self.format() {
            AnswerFormat::Table => Ok(table(report)),
            AnswerFormat::Csv => csv(report).map_err(|e| e.to_string()),
            AnswerFormat::Json => json(report).map_err(|e| e.to_string()),
        }
    }

    /// Delivers it; what is left is for standard output. Who writes into a file of numbers sees the table besides.
    pub(super) fn deliver<T, C: Display, J: Display>(
        &self,
        outputs: &Outputs<'_>,
        report: &T,
        table: fn(&T) -> String,
        csv: fn(&T) -> Result<String, C>,
        json: fn(&T) -> Result<String, J>,
    ) -> Result<String, String> {
        let left = outputs.deliver(self.text(report, table, csv, json)?)?;
        let is_table = matches!(self.format(), AnswerFormat::Table);
        Ok(match outputs.has_file() && !is_table {
            true => table(report),
            false => left,
        })
    }
}

/// What is written into a file whose name ends otherwise than that says.
pub(super) fn ends_otherwise(file: &Path, ending: &str, written: &str, remedy: &str) -> String {
    let what = format!("{written} is written here, and nothing as .{ending}");
    FileError::new(file, Fault::new(what, remedy)).to_string()
}

/// Whether a program that a file's ending calls would find what it does not read.
fn is_another(ending: &str) -> bool {
    let ending = ending.to_lowercase();
    let others = ["xlsx", "xls", "ods", "tsv", "xml", "html", "pdf", "geojson"];
    others.contains(&ending.as_str())
}

/// The files that a command writes.
#[derive(Debug)]
pub(super) struct Outputs<'a> {
    force: bool,
    inputs: Inputs,
    /// Where the answer goes; `None` is standard output.
    answer: Option<&'a Path>,
    all: Vec<(&'a Path, Kind)>,
}

impl<'a> Outputs<'a> {
    /// None yet, of a command that reads these files or folders.
    pub(super) fn new<P: AsRef<Path>>(
        Force { force }: Force,
        inputs: impl IntoIterator<Item = P>,
    ) -> Self {
        Self {
            force,
            inputs: Inputs::of(inputs),
            answer: None,
            all: Vec::new(),
        }
    }

    fn answer(mut self, path: Option<&'a Path>) -> Result<Self, String> {
        self.answer = path;
        match path {
            Some(path) => self.and(path, Kind::Result),
            None => Ok(self),
        }
    }

    /// One more file. An error where it may not be written, or is one of the others.
    pub(super) fn and(mut self, path: &'a Path, kind: Kind) -> Result<Self, String> {
        files::has_folder(path).map_err(|fault| FileError::new(path, fault).to_string())?;
        self.check(path, kind)?;
        let place = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let twice = |other: &Path| place(other) == place(path) || files::is_same_file(other, path);
        if self.all.iter().any(|(other, _)| twice(other)) && !is_device(path) {
            let fault = Fault::new("two results would go into it", "name a file for each");
            return Err(FileError::new(path, fault).to_string());
        }
        self.all.push((path, kind));
        Ok(self)
    }

    /// More that was read. An error where an output is among it.
    pub(super) fn read(&mut self, inputs: &Inputs) -> Result<(), String> {
        self.inputs.extend(inputs);
        let mut all = self.all.iter();
        all.try_for_each(|(path, kind)| self.check(path, *kind))
    }

    /// Whether all of these results may be written. For a folder of them, whose names are known when the
    /// flight is open, and differ.
    pub(super) fn check_all<'p>(
        &self,
        mut paths: impl Iterator<Item = &'p Path>,
    ) -> Result<(), String> {
        paths.try_for_each(|path| self.check(path, Kind::Result))
    }

    /// The folder that results go into; made where it is not there.
    pub(super) fn make_folder(&self, folder: &Path) -> Result<(), String> {
        files::make_folder(folder).map_err(|error| error.to_string())
    }

    /// Whether the answer goes into a file.
    pub(super) fn has_file(&self) -> bool {
        self.answer.is_some()
    }

    fn check(&self, path: &Path, kind: Kind) -> Result<(), String> {
        files::may_write(path, kind, &self.inputs, self.force)
            .map_err(|fault| FileError::new(path, fault).to_string())
    }

    /// Writes a file whole or not at all.
    pub(super) fn write(&self, path: &Path, bytes: &[u8], kind: Kind) -> Result<(), String> {
        files::write(path, bytes, kind, &self.inputs, self.force)
            .map_err(|fault| FileError::new(path, fault).to_string())
    }

    /// Writes missions for the ground station that the file's ending names. What the pilot must know, one sentence
    /// each.
    pub(super) fn write_missions(
        &self,
        missions: &[(String, Mission)],
        path: &Path,
    ) -> Result<Vec<String>, String> {
        let written = write_missions(missions, path, &self.inputs, self.force);
        Ok(written.map_err(|error| error.to_string())?.notes)
    }

    /// Writes the answer where it goes; what is left is for standard output.
    pub(super) fn deliver(&self, text: String) -> Result<String, String> {
        match self.answer {
            None => Ok(text),
            Some(path) => {
                self.write(path, text.as_bytes(), Kind::Result)?;
                Ok(String::new())
            }
        }
    }
}

/// Whether one result after the other can go into it.
fn is_device(path: &Path) -> bool {
    path.metadata().is_ok_and(|metadata| !metadata.is_file())
}
