//! `fragscale reconstruct`: photos become a flight.

use std::path::PathBuf;

use clap::Args;

use super::Answer;
use crate::fault::first_names;
use crate::jobs::Progress;
use crate::reconstruct::{Embedded, LeftOut, Reconstructed, Request, reconstruct};

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
    Ok(Answer::new(summary(&made), warnings))
}

fn summary(made: &Reconstructed) -> String {
    let mut text = format!(
        "{}: {} of {} photos, {} points",
        made.flight.display(),
        made.registered,
        made.photos,
        made.points
    );
    if let Some(px) = made.reprojection_px {
        text += &format!(", median reprojection error {px:.2} px");
    }
    text.push('\n');
    if let Some(world) = &made.world {
        let crs = world.crs.as_deref().unwrap_or("local");
        text += &format!("world: {crs}, in {}", world.unit);
        if let Some(rms) = world.rms {
            text += &format!("; photos' own positions fit to {rms:.3} {}", world.unit);
        }
        text.push('\n');
    }
    text
}

/// A sentence a reason.
fn left_out(photos: &[LeftOut], all: usize) -> Vec<String> {
    let mut reasons: Vec<(&str, Vec<String>)> = Vec::new();
    for LeftOut { photo, why } in photos {
        match reasons.iter_mut().find(|(reason, _)| reason == why) {
            Some((_, names)) => names.push(photo.clone()),
            None => reasons.push((why, vec![photo.clone()])),
        }
    }
    let sentence = |(why, names): (&str, Vec<String>)| {
        let count = names.len();
        format!(
            "{count} of {all} photos left out: {why} ({})",
            first_names(&names)
        )
    };
    reasons.into_iter().map(sentence).collect()
}
