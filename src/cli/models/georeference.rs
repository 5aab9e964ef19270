//! `fragscale georeference`: a reconstruction in a frame of its own is brought to the world, and
//! written as a flight.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde_json::{Value, json};

use crate::cli::Answer;
use crate::cli::outputs::{Force, Outputs};
use crate::fault::Fault;
use crate::files::{Inputs, Kind, Recording};
use crate::formats::FileError;
use crate::jobs::Progress;
use crate::numbers::to_digits;
use crate::opening::{self, GeoreferenceRequest, Georeferenced, KnownDistance, KnownKind};

#[derive(Debug, Args)]
pub(in crate::cli) struct GeoreferenceArguments {
    /// A reconstruction in a frame of its own: an NVM file, a COLMAP folder, ...; or a flight that was made of one.
    reconstruction: PathBuf,
    /// The folder of the photos: their own positions, where no list is given, and their sizes.
    #[arg(long, value_name = "FOLDER")]
    photos: Option<PathBuf>,
    /// A list of the photos' positions: CSV, OpenDroneMap's geo.txt, DJI's .MRK.
    #[arg(long, value_name = "FILE")]
    positions: Option<PathBuf>,
    /// Ground control points with their marks in photos: OpenDroneMap's gcp_list.txt, or the list with scale bars that
    /// the window saves beside a flight.
    #[arg(long, value_name = "FILE")]
    gcp: Option<PathBuf>,
    /// A known distance in metres between two points of the reconstruction,
    /// "x1,y1,z1 x2,y2,z2 12.5", or between two control points, "name1 name2 12.5"; gives the scale, and the photos' positions
    /// the place, where there are any. May be repeated.
    #[arg(long, value_name = "POINTS", allow_hyphen_values = true)]
    distance: Vec<KnownDistance>,
    /// With --distance: turn the plane of the reconstruction's points level, instead of being placed by positions.
    #[arg(long)]
    level: bool,
    /// The coordinate system of the world, and of lists that state none ("local" in the first line of OpenDroneMap's, or a table
    /// without one): EPSG:n, WKT or a PROJ text; without it that of the list, or the zone of UTM that the positions lie in.
    #[arg(long, value_name = "CRS", allow_hyphen_values = true)]
    crs: Option<String>,
    /// How to write the residuals.
    #[arg(long, value_enum, default_value = "table")]
    format: GeoreferenceFormat,
    /// Write the flight to this flight.toml.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    force: Force,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum GeoreferenceFormat {
    Table,
    Json,
}

pub(in crate::cli) fn georeference(
    arguments: &GeoreferenceArguments,
    progress: &Progress,
) -> Result<Answer, String> {
    let behind = opening::behind_flight(&arguments.reconstruction);
    let behind = behind.as_ref();
    let of_flight = behind.and_then(|behind| behind.photos.as_ref());
    let photos = arguments.photos.as_ref().or(of_flight);
    let request = GeoreferenceRequest {
        photos: photos.cloned(),
        photos_are_packages: false,
        positions: arguments.positions.clone(),
        control_points: arguments.gcp.clone(),
        marked: None,
        distances: arguments.distance.clone(),
        crs: arguments.crs.clone(),
        level: arguments.level,
    };
    let path = behind.map_or(&arguments.reconstruction, |behind| &behind.reconstruction);
    let named = [
        Some(path),
        request.positions.as_ref(),
        request.control_points.as_ref(),
    ];
    let mut outputs = Outputs::new(arguments.force, named.into_iter().flatten());
    if let Some(target) = &arguments.output {
        let ending = target.extension();
        if ending.is_none_or(|ending| ending != "toml") {
            let fault = Fault::new("a flight file ends in .toml", "give it such a name");
            return Err(FileError::new(target, fault).to_string());
        }
        outputs = outputs.and(target, Kind::Flight)?;
    }
    let recording = Recording::start();
    let mut result =
        opening::georeference(path, &request, progress).map_err(|error| error.to_string())?;
    if result.positions.is_empty() && behind.is_some_and(|behind| behind.has_place) {
        result.warnings.push(
            "the flight has a place, which known distances alone do not keep here: add positions or surveyed points, or apply the \
             scale bars in the window (Control points…), where it stays"
                .to_owned(),
        );
    }
    outputs.read(&Inputs::default().with_opened(&recording.files()))?;
    if let Some(target) = &arguments.output {
        let name = behind.and_then(|behind| behind.name.as_deref());
        let photos = photos.map(PathBuf::as_path);
        let text = opening::flight_text_of(Some(&result), name, target, path, photos, None)
            .map_err(|error| error.to_string())?;
        outputs.write(target, text.as_bytes(), Kind::Flight)?;
    }
    let text = match arguments.format {
        GeoreferenceFormat::Table => table(&result),
        GeoreferenceFormat::Json => format!("{}\n", value(&result)),
    };
    Ok(Answer::new(text, result.warnings))
}

/// A line a known position, then what follows from them.
fn table(result: &Georeferenced) -> String {
    let mut text = String::new();
    let unit = result.unit;
    if !result.positions.is_empty() {
        let names = result.positions.iter().map(|p| p.name.chars().count());
        let width = names.max().unwrap_or_default().max(8);
        text += &format!(
            "{:width$} {:>10} {:>10} {:>10} {:>10}\n",
            "position",
            format!("dE {unit}"),
            format!("dN {unit}"),
            format!("dU {unit}"),
            format!("length {unit}"),
        );
        for position in &result.positions {
            let number = |number| result.residual_in_words(number);
            let [east, north, up] = position.residual.to_array().map(number);
            let length = number(position.residual.length());
            let used = if position.used { "used" } else { "not used" };
            let marks =
                (position.marks_px).map_or_else(String::new, |px| format!(", marks {px:.2} px"));
            text += &format!(
                "{:width$} {east:>10} {north:>10} {up:>10} {length:>10}  {used}{marks}\n",
                position.name,
            );
        }
    }
    for length in &result.lengths {
        text += &format!(
            "{}: {:.4} m known, {:.4} m fitted\n",
            length.name, length.known, length.fitted
        );
    }
    if let Some(used) = result.used_in_words("positions") {
        text += &format!("{used}\n");
    }
    text += &format!(
        "scale: {} {unit} to one of the reconstruction's units",
        // The file has them all.
        to_digits(result.similarity.scale, 9)
    );
    text += &format!(", {}\n", result.scale_error_in_words());
    if let Some(degrees) = result.rotation_error_degrees {
        text += &format!("least sure rotation: ± {degrees:.3} degrees (standard error)\n");
    }
    if let Some(errors) = result.errors_in_words() {
        text += &format!("poses: {errors}\n");
    }
    let crs = result
        .crs
        .as_deref()
        .unwrap_or("local, no coordinate system");
    text += &format!("world: {crs}, in {unit}\n");
    if let Some(heights) = &result.heights {
        text += &format!("heights count from: {heights}\n");
    }
    text
}

fn value(result: &Georeferenced) -> Value {
    let positions = result.positions.iter().map(|position| {
        let [east, north, up] = position.residual.to_array();
        json!({
            "name": position.name,
            "kind": match position.kind {
                KnownKind::Photo => "photo",
                KnownKind::ControlPoint => "control point",
            },
            "east": east,
            "north": north,
            "up": up,
            "length": position.residual.length(),
            "used": position.used,
            "marks_px": position.marks_px,
        })
    });
    let lengths = result.lengths.iter().map(
        |length| json!({ "name": length.name, "known_m": length.known, "fitted_m": length.fitted }),
    );
    json!({
        "transform": result.similarity.to_row_major(),
        "crs": result.crs,
        "unit": result.unit.symbol(),
        "heights": result.heights,
        "scale": result.similarity.scale,
        "scale_standard_error": result.scale_error,
        "scale_interval_95": result.scale_interval,
        "rotation_standard_error_degrees": result.rotation_error_degrees,
        "position_standard_error": result.errors.pose.position.map(|axes| axes.to_array()),
        "angle_standard_error_degrees": result.errors.pose.angle.map(|axes| axes.to_array()),
        "focal_standard_error_percent": result.errors.focal,
        "rms": result.rms,
        "positions": positions.collect::<Vec<_>>(),
        "distances": lengths.collect::<Vec<_>>(),
        "warnings": result.warnings,
    })
}
