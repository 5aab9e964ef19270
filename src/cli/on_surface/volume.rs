//! `fragscale volume`: area and volume inside a polygon.

use std::path::PathBuf;

use clap::Args;

use super::places::places;
use crate::cli::Answer;
use crate::cli::flight_arguments::{FlightArguments, open_cloud};
use crate::cli::outputs::NamedAnswerArguments;
use crate::exports::{self, MeasuredUnit, VolumeReport};
use crate::fault::Fault;
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::opening::Opened;
use crate::survey::{self, Base, Polygon};

#[derive(Debug, Args)]
pub(in crate::cli) struct VolumeArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// The polygon's corners in the world, or a file with one a line.
    #[arg(long, value_name = "X,Y;X,Y…|FILE", allow_hyphen_values = true)]
    polygon: String,
    /// What the volume is over: an elevation; "rim", the plane that is nearest to the surface along the
    /// polygon's sides; or the file of another surface in the same world.
    #[arg(
        long,
        value_name = "HEIGHT|rim|FILE",
        default_value = "rim",
        allow_hyphen_values = true
    )]
    base: BaseArgument,
    #[command(flatten)]
    answer: NamedAnswerArguments,
}

#[derive(Debug, Clone)]
enum BaseArgument {
    Height(f64),
    Rim,
    File(PathBuf),
}

impl From<&str> for BaseArgument {
    fn from(text: &str) -> Self {
        match (text, text.parse()) {
            ("rim", _) => Self::Rim,
            (_, Ok(height)) => Self::Height(height),
            _ => Self::File(text.into()),
        }
    }
}

pub(in crate::cli) fn volume(
    arguments: &VolumeArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    let base_file = match &arguments.base {
        BaseArgument::File(path) => Some(path),
        _ => None,
    };
    let inputs = arguments.flight.files().chain(base_file);
    let mut outputs = arguments.answer.output.outputs(inputs)?;
    let (corners, mut warnings) = places(&arguments.polygon)?;
    let polygon = Polygon::new(&corners).map_err(|error| format!("polygon: {error}"))?;
    let opened = arguments.flight.open_to_measure(progress)?;
    outputs.read(&opened.read)?;
    let other = match base_file {
        Some(path) => {
            let other = open_cloud(path, progress)?;
            outputs.read(&other.read)?;
            warnings.extend(in_one_world(&opened, &other)?);
            warnings.extend(other.all_warnings());
            Some(other)
        }
        None => None,
    };
    let parts = opened.flight.parts();
    let base = match (&arguments.base, &other) {
        (BaseArgument::Height(height), _) => Base::Height(*height),
        (_, Some(other)) => Base::Surface(&other.flight.parts().surface),
        _ => Base::Rim,
    };
    progress.stage("measuring");
    let volume = survey::volume(&parts.surface, &polygon, base).map_err(|e| e.to_string())?;
    if volume.covered <= 0.0 {
        let what = "the polygon lies beside the surface, or over a hole of it";
        let remedy = "give corners in its coordinates; 'fragscale info' shows its bounds";
        let fault = Fault::new(what, remedy);
        return Err(FileError::new(&arguments.flight.flight, fault).to_string());
    }
    let base = base_file.map(|path| path.display().to_string());
    let report = VolumeReport {
        flight: &parts.name,
        unit: MeasuredUnit::of(parts),
        volume: &volume,
        base: base.as_deref(),
    };
    warnings.extend(exports::volume_warning(&volume));
    let text = arguments.answer.deliver(
        &outputs,
        &report,
        exports::volume_table,
        exports::volume_csv,
        exports::volume_json,
    )?;
    warnings.extend(opened.all_warnings());
    Ok(Answer::new(text, warnings))
}

/// Refuses two surfaces that say of themselves that they lie in different worlds; warns where one of them
/// does not say.
fn in_one_world(one: &Opened, other: &Opened) -> Result<Option<String>, String> {
    let path = other.origin.file().to_owned();
    let refused = |what: String, remedy: &str| {
        Err(FileError::new(&path, Fault::new(what, remedy)).to_string())
    };
    let parts = [&one.flight, &other.flight].map(|flight| flight.parts());
    if parts.iter().all(|parts| parts.unit_known) && parts[0].unit != parts[1].unit {
        let what = format!(
            "it is in {}, the flight in {}",
            parts[1].unit, parts[0].unit
        );
        return refused(what, "give both in the same unit");
    }
    match (&one.crs, &other.crs) {
        (Some(one), Some(other)) if one != other => {
            let what = format!("its coordinate system is {other}, the flight's {one}");
            refused(what, "give both in the same coordinate system")
        }
        (Some(_), None) | (None, Some(_)) => Ok(Some(format!(
            "{}: taken to be in the flight's coordinate system: only one of the two states its own",
            path.display()
        ))),
        _ => Ok(None),
    }
}
