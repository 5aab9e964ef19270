//! `fragscale effort`: the time that steps took, with totals and averages.

use std::path::PathBuf;

use clap::Args;

use crate::cli::Answer;
use crate::cli::outputs::AnswerArguments;
use crate::exports;
use crate::formats::read_effort_table;

#[derive(Debug, Args)]
pub(in crate::cli) struct EffortArguments {
    /// A table as CSV: columns step, method or trial, and time; or the steps first and a column of
    /// times for each method or trial. Times are in minutes (others as "90 s", "0:01:30" or by the
    /// column's name, "time_s"); "1:30" is minutes and seconds, in a column "time (h)" hours and minutes.
    file: PathBuf,
    #[command(flatten)]
    answer: AnswerArguments,
}

pub(in crate::cli) fn effort(arguments: &EffortArguments) -> Result<Answer, String> {
    let outputs = arguments.answer.outputs([&arguments.file])?;
    let (effort, warnings) = read_effort_table(&arguments.file).map_err(|e| e.to_string())?;
    let text = arguments.answer.text(
        &effort,
        exports::effort_text,
        exports::effort_csv,
        exports::effort_json,
    )?;
    let text = outputs.deliver(text)?;
    Ok(Answer::new(text, warnings))
}
