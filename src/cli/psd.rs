//! `fragscale psd`: what is done with size distributions.

use std::path::PathBuf;

use clap::Subcommand;

use super::Answer;
use super::psd_compare::{self, CompareArguments};
use super::psd_fit::{self, FitArguments};
use crate::jobs::Progress;

#[derive(Debug, Subcommand)]
pub(super) enum PsdCommand {
    /// Fit a function to each curve: parameters with standard errors, percentiles with bands.
    Fit(FitArguments),
    /// Hold methods against a reference: percent errors, norms, shifts, the figure and the report.
    Compare(CompareArguments),
}

impl PsdCommand {
    /// Where the answer goes.
    pub(super) fn output(&self) -> Option<PathBuf> {
        match self {
            Self::Fit(arguments) => arguments.output.clone(),
            Self::Compare(arguments) => arguments.output.clone(),
        }
    }
}

pub(super) fn psd(command: &PsdCommand, progress: &Progress) -> Result<Answer, String> {
    match command {
        PsdCommand::Fit(arguments) => psd_fit::fit(arguments),
        PsdCommand::Compare(arguments) => psd_compare::compare(arguments, progress),
    }
}
