//! `fragscale anova`: a one-way analysis of variance, of values in a table or of published sums of
//! squares.

use std::path::PathBuf;

use clap::Args;

use crate::cli::Answer;
use crate::cli::outputs::AnswerArguments;
use crate::exports::{self, AnovaReport};
use crate::fault::Fault;
use crate::formats::{FileError, read_grouped_values};
use crate::fragmentation::{Anova, SIGNIFICANCE};

#[derive(Debug, Args)]
pub(in crate::cli) struct AnovaArguments {
    /// A table as CSV with one value a line.
    #[arg(required_unless_present = "between")]
    file: Option<PathBuf>,
    /// The column that says which group a value is of: the trial.
    #[arg(long, value_name = "COLUMN", required_unless_present = "between")]
    group: Option<String>,
    /// The column of the values.
    #[arg(long, value_name = "COLUMN", required_unless_present = "between")]
    value: Option<String>,
    /// Add a table for each value of this column: the size.
    #[arg(long, value_name = "COLUMN", requires = "file")]
    by: Option<String>,
    /// Take only the lines that have this text in this column: one method of several. Trials of
    /// different methods are not of one group.
    #[arg(long, value_name = "COLUMN=TEXT", value_parser = only, requires = "file")]
    only: Option<(String, String)>,
    /// Published degrees of freedom and sum of squares between the groups, instead of a file.
    #[arg(
        long,
        value_name = "DF,SS",
        value_parser = published,
        requires = "within",
        conflicts_with_all = ["file", "group", "value"]
    )]
    between: Option<(usize, f64)>,
    /// The same within the groups: the residual.
    #[arg(long, value_name = "DF,SS", value_parser = published, requires = "between")]
    within: Option<(usize, f64)>,
    /// The level of significance.
    #[arg(long, default_value_t = SIGNIFICANCE)]
    level: f64,
    #[command(flatten)]
    answer: AnswerArguments,
}

/// "9,1.9"
fn published(text: &str) -> Result<(usize, f64), String> {
    let parts = text.split_once(',');
    let read = parts
        .and_then(|(degrees, sum)| Some((degrees.trim().parse().ok()?, sum.trim().parse().ok()?)));
    read.ok_or_else(|| "give degrees of freedom and sum of squares, such as 9,1.9".to_owned())
}

/// "method=point cloud"
fn only(text: &str) -> Result<(String, String), String> {
    let parts = text.split_once('=');
    let named = parts.filter(|(column, text)| !column.trim().is_empty() && !text.trim().is_empty());
    named
        .map(|(column, text)| (column.trim().to_owned(), text.trim().to_owned()))
        .ok_or_else(|| "give a column and its text, such as 'method=point cloud'".to_owned())
}

pub(in crate::cli) fn anova(arguments: &AnovaArguments) -> Result<Answer, String> {
    let outputs = arguments.answer.outputs(&arguments.file)?;
    let (report, warnings) = report(arguments)?;
    let text = arguments.answer.text(
        &report,
        exports::anova_table,
        exports::anova_csv,
        exports::anova_json,
    )?;
    let text = outputs.deliver(text)?;
    Ok(Answer::new(text, warnings))
}

fn report(arguments: &AnovaArguments) -> Result<(AnovaReport, Vec<String>), String> {
    let level = arguments.level;
    let (path, group, value) = match (&arguments.file, &arguments.group, &arguments.value) {
        (Some(path), Some(group), Some(value)) => (path, group, value),
        _ => {
            let (Some(between), Some(within)) = (arguments.between, arguments.within) else {
                // The command line has been checked for this.
                return Err(Fault::new("there is no value", "name a file").to_string());
            };
            let table = Anova::of_sums(between, within, level).map_err(|e| e.to_string())?;
            return Ok((AnovaReport::new("between", "the groups", table), Vec::new()));
        }
    };
    let by = arguments.by.as_deref();
    let only = arguments.only.as_ref();
    let only = only.map(|(column, text)| (column.as_str(), text.as_str()));
    let found = read_grouped_values(path, group, value, by, only).map_err(|e| e.to_string())?;
    let pooled = Anova::of_groups(&found.all.values, level)
        .map_err(|fault| FileError::new(path, fault).to_string())?;
    let tables = found.by.into_iter();
    let report = AnovaReport {
        by: arguments.by.clone(),
        per: tables
            .map(|(value, groups)| (value, Anova::of_groups(&groups.values, level)))
            .collect(),
        ..AnovaReport::new(group, format!("the groups of '{group}'"), pooled)
    };
    Ok((report, found.warnings))
}
