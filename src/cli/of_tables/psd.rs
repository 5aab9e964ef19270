//! `fragscale psd`: what is done with size distributions.

use clap::Subcommand;

use super::psd_compare::{self, CompareArguments};
use super::psd_fit::{self, FitArguments};
use crate::cli::Answer;
use crate::jobs::Progress;

#[derive(Debug, Subcommand)]
pub(in crate::cli) enum PsdCommand {
    /// Fit a function to each curve: parameters with standard errors, percentiles with bands.
    Fit(FitArguments),
    /// Hold methods against a reference: percent errors, norms, shifts, the figure and the report.
    Compare(CompareArguments),
}

pub(in crate::cli) fn psd(command: &PsdCommand, progress: &Progress) -> Result<Answer, String> {
    match command {
        PsdCommand::Fit(arguments) => psd_fit::fit(arguments, progress),
        PsdCommand::Compare(arguments) => psd_compare::compare(arguments, progress),
    }
}
