//! `fragscale reconstruct`: photos become a flight.

use std::path::PathBuf;

use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};

use crate::cli::Answer;
use crate::jobs::Progress;
use crate::reconstruct::{Card, EngineName, Quality, Request, left_out, reconstruct, summary};

#[derive(Debug, Args)]
pub(in crate::cli) struct ReconstructArguments {
    /// The folder of the photos.
    photos: PathBuf,
    /// The folder to make, with a flight.toml; new or empty, or one of a run that was interrupted, which
    /// goes on. In a finished one the same photos' cloud is made anew, from the same poses.
    #[arg(long, value_name = "DIR")]
    to: PathBuf,
    /// The coordinate system of the world: EPSG:n, WKT or a PROJ text; without it the zone of UTM that
    /// the photos lie in.
    #[arg(long, value_name = "CRS", allow_hyphen_values = true)]
    crs: Option<String>,
    /// The calibration of the photos' camera, which is kept; without it the lens is found from the photos.
    #[arg(long, value_name = "FILE")]
    camera: Option<PathBuf>,
    /// What finds the poses.
    #[arg(long, value_enum, default_value_t)]
    engine: PosesEngine,
    /// How much time the cloud may take.
    #[arg(long, value_enum, default_value_t)]
    quality: CloudQuality,
    /// Let the processor do all, also where there is a graphics card.
    #[arg(long)]
    no_gpu: bool,
}

impl ReconstructArguments {
    /// What stays of it where it is interrupted.
    pub(in crate::cli) fn kept(&self) -> String {
        let to = self.to.display();
        format!("what is done lies in {to}: the same command goes on with it")
    }
}

/// A quality as a word of the command line.
#[derive(Debug, Clone, Copy, Default)]
struct CloudQuality(Quality);

impl ValueEnum for CloudQuality {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [CloudQuality; 3] = [
            CloudQuality(Quality::Fast),
            CloudQuality(Quality::Normal),
            CloudQuality(Quality::Best),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.as_str()).help(self.0.explained()))
    }
}

/// An engine as a word of the command line.
#[derive(Debug, Clone, Copy, Default)]
struct PosesEngine(EngineName);

impl ValueEnum for PosesEngine {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [PosesEngine; 2] = [
            PosesEngine(EngineName::Embedded),
            PosesEngine(EngineName::Colmap),
        ];
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(PossibleValue::new(self.0.as_str()).help(self.0.explained()))
    }
}

pub(in crate::cli) fn run(
    arguments: &ReconstructArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    let request = Request {
        photos: arguments.photos.clone(),
        to: arguments.to.clone(),
        crs: arguments.crs.clone(),
        camera: arguments.camera.clone(),
        dense: arguments.quality.0.dense(),
        card: (!arguments.no_gpu).then(Card::found).flatten(),
    };
    let engine = arguments.engine.0.engine();
    let engine = engine.map_err(|fault| fault.to_string())?;
    let made = reconstruct(&request, &*engine, progress).map_err(|error| error.to_string())?;
    let mut warnings = left_out(&made.left_out, made.photos);
    warnings.extend(made.warnings.iter().cloned());
    let lines = summary(&made).into_iter().map(|line| line + "\n");
    Ok(Answer::new(lines.collect::<String>(), warnings))
}
