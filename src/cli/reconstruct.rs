//! `fragscale reconstruct`: photos become a flight.

use std::path::PathBuf;

use clap::Args;

use super::Answer;
use crate::jobs::Progress;
use crate::reconstruct::{Embedded, Request, left_out, reconstruct, summary};

#[derive(Debug, Args)]
pub(super) struct ReconstructArguments {
    /// The folder of the photos.
    photos: PathBuf,
    /// The folder to make, with a flight.toml; new or empty, or one of a run that was interrupted, which
    /// goes on.
    #[arg(long, value_name = "DIR")]
    to: PathBuf,
    /// The coordinate system of the world: EPSG:n, WKT or a PROJ text; without it the zone of UTM that
    /// the photos lie in.
    #[arg(long, value_name = "CRS", allow_hyphen_values = true)]
    crs: Option<String>,
}

pub(super) fn run(arguments: &ReconstructArguments, progress: &Progress) -> Result<Answer, String> {
    let request = Request {
        photos: arguments.photos.clone(),
        to: arguments.to.clone(),
        crs: arguments.crs.clone(),
    };
    let made = reconstruct(&request, &Embedded, progress).map_err(|error| error.to_string())?;
    let mut warnings = left_out(&made.left_out, made.photos);
    warnings.extend(made.warnings.iter().cloned());
    let lines = summary(&made).into_iter().map(|line| line + "\n");
    Ok(Answer::new(lines.collect::<String>(), warnings))
}
