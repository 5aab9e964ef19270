//! Reading files and pasted tables of size distributions: the work of a job.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::source::Source;
use super::{Page, PasteForm, ResultTab};
use crate::command::Command;
use crate::formats::{self, DistributionColumns, Kind, without_options};
use crate::jobs::Progress;
use crate::state::{LogLine, Severity, State};
use crate::tasks::Task;

impl Task {
    /// Reading size distributions.
    pub const READ_DISTRIBUTIONS: Self = Self::new("Reading");
}

/// What was read, or why not in a line.
#[derive(Debug)]
enum Read {
    /// What was named or dropped.
    Files {
        /// Of each file of size distributions.
        sources: Vec<Result<Source, String>>,
        /// What was dropped with them, or alone, and is something of a flight.
        of_flight: Vec<PathBuf>,
    },
    /// The table of the small window.
    Pasted(Result<Source, String>),
}

/// Whether a file may hold a table by its name.
fn is_table(path: &Path) -> bool {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    matches!(extension.as_deref(), Some("csv" | "tsv" | "txt"))
}

fn source(path: &Path) -> Result<Source, String> {
    let read = formats::read_size_distributions(path, &DistributionColumns::default());
    let (set, warnings) = read.map_err(|error| without_options(&error.to_string()))?;
    Ok(Source::of_file(path, set, in_the_window(&warnings)))
}

/// What is said, without options of the command.
fn in_the_window(said: &[String]) -> Vec<String> {
    said.iter().map(|said| without_options(said)).collect()
}

fn pasted(form: &PasteForm, number: usize) -> Result<Source, String> {
    let columns = DistributionColumns {
        unit: Some(form.unit),
        ..DistributionColumns::default()
    };
    let name = format!("Pasted table {number}");
    let read = formats::size_distributions(&form.table, &columns);
    let (set, warnings) = read.map_err(|fault| {
        let line = fault
            .line
            .map_or_else(String::new, |line| format!(", line {line}"));
        format!("{name}{line}: {}", without_options(&fault.to_string()))
    })?;
    let mut source = Source {
        name,
        path: None,
        set,
        warnings: in_the_window(&warnings),
        fragments: None,
    };
    let typed = |text: &str, other: &str| match text.trim() {
        "" => other.to_owned(),
        text => text.to_owned(),
    };
    source
        .set
        .name_method(&typed(&form.method, &format!("pasted {number}")));
    let trial = typed(&form.trial, "");
    for curve in &mut source.set.curves {
        if curve.labels.trial.is_empty() {
            curve.labels.trial.clone_from(&trial);
        }
    }
    Ok(source)
}

impl State {
    /// Whether there may be size distributions in what was dropped, so that it is looked at first.
    pub(crate) fn may_be_distributions(&self, paths: &[PathBuf]) -> bool {
        paths.iter().any(|path| is_table(path))
    }

    /// Reads the size distributions in what was dropped; the rest is something of a flight. Tables that
    /// are dropped on their page are taken for what the page shows.
    pub(crate) fn read_dropped(&mut self, paths: Vec<PathBuf>) {
        let here = self.page == Page::SizeDistributions && paths.iter().all(|path| is_table(path));
        if let [path] = paths.as_slice()
            && here
            && self.distributions.tab == ResultTab::Effort
        {
            self.read_effort(path.clone());
            return;
        }
        if self.is_busy(Task::READ_DISTRIBUTIONS) {
            return;
        }
        let work = move |progress: &Progress| {
            progress.stage("reading size distributions");
            let holds = |path: &PathBuf| {
                is_table(path) && matches!(formats::detect(path), Ok(Kind::SizeDistributions))
            };
            let (tables, of_flight): (Vec<_>, Vec<_>) =
                paths.into_iter().partition(|path| here || holds(path));
            Read::Files {
                sources: tables.iter().map(|path| source(path)).collect(),
                of_flight,
            }
        };
        self.start(Task::READ_DISTRIBUTIONS, work, Self::take_distributions);
    }

    /// Reads files.
    pub(super) fn read_distributions(&mut self, paths: Vec<PathBuf>) {
        if self.is_busy(Task::READ_DISTRIBUTIONS) {
            return;
        }
        self.asking = None;
        let work = move |progress: &Progress| {
            progress.stage("reading size distributions");
            Read::Files {
                sources: paths.iter().map(|path| source(path)).collect(),
                of_flight: Vec::new(),
            }
        };
        self.start(Task::READ_DISTRIBUTIONS, work, Self::take_distributions);
    }

    /// Reads the table in the small window.
    pub(super) fn read_pasted(&mut self) {
        if self.is_busy(Task::READ_DISTRIBUTIONS) {
            return;
        }
        let form = self.distributions.paste.clone();
        let number = self.distributions.pasted + 1;
        let work = move |_: &Progress| Read::Pasted(pasted(&form, number));
        self.start(Task::READ_DISTRIBUTIONS, work, Self::take_distributions);
    }

    /// The sieve curve that lies beside the flight on the screen.
    pub fn known_fragments(&self) -> Option<PathBuf> {
        let open = self.open.as_ref()?;
        let folder = open.files.origin.flight_file()?.parent()?;
        Some(folder.join("reference.csv"))
    }

    /// Takes what was read.
    fn take_distributions(&mut self, read: Read) {
        match read {
            Read::Files { sources, of_flight } => {
                if !sources.is_empty() {
                    self.page = Page::SizeDistributions;
                }
                if sources.iter().any(Result::is_ok) {
                    self.mended(Task::READ_DISTRIBUTIONS);
                }
                for source in sources {
                    match source {
                        Ok(source) => {
                            self.add_source(source);
                        }
                        Err(why) => self.say_until_mended(Task::READ_DISTRIBUTIONS, &why),
                    }
                }
                if !of_flight.is_empty() {
                    self.apply(Command::DropFlight(of_flight));
                }
            }
            Read::Pasted(Err(why)) => {
                self.say_until_mended(Task::READ_DISTRIBUTIONS, &why);
                self.distributions.paste.refused = Some(why);
            }
            Read::Pasted(Ok(source)) => {
                let name = source.name.clone();
                if self.add_source(source) {
                    self.asking = None;
                    let unit = self.distributions.paste.unit;
                    self.distributions.pasted += 1;
                    // What was wrong with it before is mended; the log keeps it.
                    let is_it = |notice: &mut LogLine| notice.text.starts_with(&name);
                    self.notice.take_if(is_it);
                    self.distributions.paste = PasteForm {
                        unit,
                        ..PasteForm::default()
                    };
                }
            }
        }
    }

    /// Adds a curve that the window made itself.
    pub(crate) fn take_distribution(&mut self, source: Source) {
        self.add_source(source);
    }

    /// Adds curves; false where their labels are there already.
    fn add_source(&mut self, mut source: Source) -> bool {
        let mut edit = self.distributions.history.now().clone();
        let name = source.name.clone();
        edit.sources.retain(|other| !source.replaces(other));
        if let Err(fault) = source.set_apart(&edit.sources) {
            self.say(Severity::Error, &format!("{name}: {fault}"));
            return false;
        }
        for warning in &source.warnings {
            self.say(Severity::Warning, &format!("{name}: {warning}"));
        }
        let count = source.set.curves.len();
        if edit.sources.is_empty() {
            edit.settings.unit = source.set.unit;
        }
        edit.sources.push(Arc::new(source));
        self.edit_distributions(edit);
        let curves = if count == 1 { "curve" } else { "curves" };
        self.say(Severity::Note, &format!("{name}: {count} {curves}"));
        true
    }
}
