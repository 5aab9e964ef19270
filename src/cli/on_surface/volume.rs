//! `fragscale volume`: area and volume inside a polygon.

use std::path::PathBuf;

use clap::Args;

use super::places::{ON_EARTH_REMEDY, beside};
use crate::cli::Answer;
use crate::cli::flight_arguments::FlightArguments;
use crate::cli::outputs::AnswerArguments;
use crate::exports::{self, MeasuredUnit, VolumeReport};
use crate::fault::Fault;
use crate::formats::FileError;
use crate::geodesy::Crs;
use crate::jobs::Progress;
use crate::opening::{Areas, StatedWorld, volume_base};
use crate::survey::{self, Base, SurveyError, Volume};

#[derive(Debug, Args)]
pub(in crate::cli) struct VolumeArguments {
    #[command(flatten)]
    flight: FlightArguments,
    /// The polygon's corners in the world, or a file with one a line; or a polygon of a map, as GeoJSON or KML.
    #[arg(long, value_name = "X,Y;X,Y…|FILE", allow_hyphen_values = true)]
    polygon: String,
    /// What the volume is over: an elevation; "rim", the plane that is nearest to the surface along the
    /// polygon's sides; or the file of another surface, which is brought to the flight's coordinate system.
    #[arg(
        long,
        value_name = "HEIGHT|rim|FILE",
        default_value = "rim",
        allow_hyphen_values = true
    )]
    base: BaseArgument,
    #[command(flatten)]
    answer: AnswerArguments,
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
    if let Some(base) = base_file.filter(|path| !path.exists()) {
        let what = "it is no elevation, not 'rim', and there is no such file";
        let remedy =
            "give an elevation as a number with a point, such as 2800.5, in the world's unit";
        return Err(FileError::new(base, Fault::new(what, remedy)).to_string());
    }
    // Of a polygon that is typed there is no file.
    let polygon_file = PathBuf::from(&arguments.polygon);
    let inputs = arguments.flight.files().chain(base_file);
    let inputs = inputs.chain([&polygon_file]);
    let mut outputs = arguments.answer.outputs(inputs)?;
    let polygon = Areas::read(&arguments.polygon)?;
    let opened = arguments.flight.open_to_measure(progress)?;
    outputs.read(&opened.read)?;
    let crs = || arguments.flight.crs_of(None, &opened, ON_EARTH_REMEDY);
    let (polygon, mut warnings) = polygon.one_in_world("polygon", crs)?;
    let (other, other_heights) = match base_file {
        Some(path) => {
            let parts = opened.flight.parts();
            let world = StatedWorld {
                crs: opened.crs.as_deref(),
                unit: parts.unit_known.then_some(parts.unit),
                around: parts.surface.bounds(),
            };
            let other = volume_base(path, &world, progress).map_err(|e| e.to_string())?;
            outputs.read(&other.read)?;
            warnings.extend(other.warnings);
            (Some(other.surface), other.other_heights)
        }
        None => (None, None),
    };
    let parts = opened.flight.parts();
    let base = match (&arguments.base, &other) {
        (BaseArgument::Height(height), _) => Base::Height(*height),
        (_, Some(other)) => Base::Surface(other),
        _ => Base::Rim,
    };
    progress.stage("measuring");
    let over = |base| survey::volume(&parts.surface, &polygon, base);
    let is_beside = |volume: &Volume| volume.covered <= 0.0 && volume.bodies == 0.0;
    let volume = match over(base) {
        // Where all of it lies beside the surface that is said: no other base would help.
        Err(error @ SurveyError::RimNotCovered(..)) => {
            let all = over(Base::Height(0.0)).ok();
            all.filter(is_beside).ok_or(error)
        }
        measured => measured,
    };
    let volume = volume.map_err(|e| e.to_string())?;
    if is_beside(&volume) {
        // Over the other surface alone, if it is not the polygon that lies beside the flight's.
        if let Some(base) = base_file
            && over(Base::Rim).is_ok_and(|own| own.covered > 0.0)
        {
            let what = "it lies beside the polygon, or has a hole there";
            let remedy = "give a surface of the same place, in the same coordinates";
            return Err(FileError::new(base, Fault::new(what, remedy)).to_string());
        }
        let world = opened
            .crs
            .as_deref()
            .and_then(|crs| Crs::understand(crs).ok());
        let fault = beside(&polygon, &parts.surface.bounds(), world.as_ref());
        return Err(arguments.flight.wrong(fault));
    }
    let base = base_file.map(|path| path.display().to_string());
    let report = VolumeReport {
        flight: &parts.name,
        unit: MeasuredUnit::of(parts),
        volume: &volume,
        base: base.as_deref(),
        other_heights: other_heights.as_ref(),
    };
    warnings.extend(exports::volume_warnings(&volume));
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
