//! `fragscale mission`: what a mission of any ground station says, and the same for another one.

use std::fmt::Write;
use std::path::PathBuf;

use clap::Args;

use crate::cli::Answer;
use crate::cli::outputs::Force;
use crate::cli::planning::plan::drone_values;
use crate::cli::planning::stated::StatedArguments;
use crate::exports::{MissionFormat, write_missions};
use crate::fault::one_line;
use crate::files::Inputs;
use crate::formats::{FileError, MissionFile, read_mission};
use crate::plan::{Drone, Height, Mission};

#[derive(Debug, Args)]
pub(in crate::cli) struct MissionArguments {
    /// A mission: DJI's .kmz or its folder, .plan, .waypoints, Litchi's .csv, or a .geojson of fragscale.
    file: PathBuf,
    /// Write it for another ground station, by the ending: .kmz, .plan, .waypoints, .csv (Litchi), .kml,
    /// .geojson. More stops than it takes become several files.
    #[arg(long, value_name = "FILE")]
    to: Option<PathBuf>,
    /// The drone that flies it, where the file does not say it: DJI's files need one.
    #[arg(long, value_name = "NAME", value_parser = drone_values())]
    drone: Option<String>,
    #[command(flatten)]
    stated: StatedArguments,
    #[command(flatten)]
    force: Force,
}

pub(in crate::cli) fn mission(arguments: &MissionArguments) -> Result<Answer, String> {
    let MissionFile {
        mut mission,
        format,
        notes: mut warnings,
    } = read_mission(&arguments.file).map_err(|e| e.to_string())?;
    if let Some(drone) = arguments.drone.as_deref().and_then(Drone::named) {
        if let Some(to) = &arguments.to {
            MissionFormat::of(to)
                .and_then(|format| format.check_drone(Some(&drone)))
                .map_err(|fault| FileError::new(to, fault).to_string())?;
        }
        mission.drone = drone.codes;
    }
    warnings.extend(arguments.stated.apply(&mut mission)?);
    let mut text = told(&mission, format);
    if let Some(to) = &arguments.to {
        let inputs = Inputs::of([&arguments.file]);
        let written = write_missions(
            &[(String::new(), mission)],
            to,
            &inputs,
            arguments.force.force,
        );
        let written = written.map_err(|e| e.to_string())?;
        for file in &written.files {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "written: {}", file.display());
        }
        warnings.extend(written.notes);
    }
    Ok(Answer::new(text, warnings))
}

/// What a mission says, in lines.
fn told(mission: &Mission, format: &str) -> String {
    let photos = mission.stops.iter().filter(|stop| stop.photo.is_some());
    let mut text = format!(
        "{}: {format}, {} stops, {} photos\n",
        one_line(&mission.name),
        mission.stops.len(),
        photos.count()
    );
    if let Some(at) = &mission.take_off {
        let elevation = at
            .elevation
            .map(|height| format!(", {}", height_in_words(height)));
        let elevation = elevation.unwrap_or_default();
        let _ = writeln!(
            text,
            "take-off: {:.7}, {:.7}{elevation}",
            at.latitude, at.longitude
        );
    }
    if let Some(height) = mission.safe_height {
        let _ = writeln!(text, "climbs to: {height:.2} m above it first");
    }
    if let Some(height) = mission.return_height {
        let _ = writeln!(text, "comes home at: {height:.2} m above it");
    }
    if let Some(speed) = mission.speed {
        let _ = writeln!(text, "speed: {speed} m/s");
    }
    let finish = mission.finish.in_words();
    let _ = writeln!(text, "at the end: {finish}");
    if let Some(lost) = mission.lost_signal {
        let _ = writeln!(text, "where the radio is lost: {}", lost.in_words());
    }
    for ((stop, pitch), number) in mission.stops.iter().zip(mission.gimbal_pitches()).zip(1..) {
        let _ = write!(
            text,
            "{number}  {:.7}, {:.7}  {}",
            stop.latitude,
            stop.longitude,
            height_in_words(stop.height)
        );
        if let Some(heading) = stop.heading {
            let _ = write!(text, "  heading {heading:.1}");
        }
        if let Some(pitch) = pitch {
            let _ = write!(text, "  gimbal {pitch:.1}");
        }
        if stop.settle > 0.0 {
            let _ = write!(text, "  waits {:.1} s", stop.settle);
        }
        if let Some(photo) = &stop.photo {
            let name = photo
                .name
                .as_deref()
                .map(|name| format!(" {}", one_line(name)));
            let _ = write!(text, "  photo{}", name.unwrap_or_default());
        }
        text.push('\n');
    }
    text
}

fn height_in_words(height: Height) -> String {
    format!("{:.2} m above {}", height.metres, height.above.in_words())
}
