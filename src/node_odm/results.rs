//! What a node sent becomes a flight: OpenDroneMap's project below `DIR/odm`, and a `flight.toml` that names it, its
//! cloud and the photos where they are.

use std::collections::HashSet;
use std::path::Path;

use crate::fault::{Fault, first_names};
use crate::files::FileError;
use crate::flight::{FlightFile, FlightSettings};
use crate::formats::{Project, read_project};
use crate::jobs::Progress;
use crate::opening::flight_text_of;
use crate::place::{LOG, Place};
use crate::reconstruct::{Reconstructed, name_of};
use crate::sent::Sent;
use crate::units::LengthUnit;

/// Puts what was unpacked in its place, as a flight of `photos`.
///
/// # Errors
/// Where it cannot be read or written; nothing has changed then.
pub(crate) fn flight(
    place: &Place,
    sent: &Sent,
    photos: &Path,
    progress: &Progress,
) -> Result<Reconstructed, FileError> {
    let unpacked = place.file("odm");
    progress.stage("reading the results");
    let project = read_project(&unpacked, progress).map_err(|error| in_results(&error))?;
    let mut warnings = project.reconstruction.warnings.clone();
    let strangers = strangers_in(&project, sent);
    if !strangers.is_empty() {
        warnings.push(format!(
            "{} of the {} photos in the node's results were not sent ({}): their scales are for nothing that is here",
            strangers.len(),
            project.reconstruction.photos.len(),
            first_names(&strangers)
        ));
    }
    let strangers = strangers.len();
    // Names what is read where it will be.
    let model = place.to.join("odm");
    let surface = project
        .surface
        .as_ref()
        .and_then(|surface| surface.strip_prefix(&unpacked).ok());
    let surface = surface.map(|surface| model.join(surface));
    if surface.is_none() && project.reconstruction.cloud.points.is_empty() {
        let what = "the node's results hold no points, neither a dense cloud nor sparse ones";
        let remedy = "look at what the node says of the task, and start it once more";
        return Err(FileError::new(&unpacked, Fault::new(what, remedy)));
    }
    if surface.is_none() {
        warnings.push(
            "the node sent no dense cloud: the sparse one is the surface; the node's messages may say why".to_owned(),
        );
    }
    place.put(&[("odm", "odm"), (LOG, "node_log.txt")])?;
    let flight = place.to.join("flight.toml");
    let name = name_of(photos);
    let text = flight_text_of(
        None,
        Some(&name),
        &flight,
        &model,
        Some(photos),
        surface.as_deref(),
    )?;
    let text = match project.reconstruction.crs.is_some() {
        true => in_metres(text),
        false => text,
    };
    // The last: with it the folder is a flight.
    place.write_flight(&flight, text.as_bytes())?;
    let model = project.reconstruction;
    Ok(Reconstructed {
        flight,
        registered: model.photos.len() - strangers,
        photos: sent.set.count,
        left_out: sent.set.left_out.clone(),
        points: model.cloud.points.len(),
        dense: None,
        reprojection_px: model
            .solved_reprojection_px
            .or_else(|| model.median_reprojection_px()),
        world: None,
        computed_on: None,
        warnings,
    })
}

/// The photos in the results that were not sent.
fn strangers_in(project: &Project, sent: &Sent) -> Vec<String> {
    let photos = sent.set.photos.iter();
    let ours: HashSet<&str> = photos.map(|photo| photo.name.as_str()).collect();
    let placed = project.reconstruction.photos.iter();
    let names = placed.map(|photo| &photo.name);
    names
        .filter(|name| !ours.contains(name.as_str()))
        .cloned()
        .collect()
}

/// The text of a flight whose unit is known: OpenDroneMap works in UTM, whatever it is given.
fn in_metres(text: String) -> String {
    let Ok(file) = FlightFile::parse(&text) else {
        return text;
    };
    let settings = FlightSettings {
        unit: LengthUnit::Metre,
        unit_known: true,
        ..file.settings()
    };
    FlightFile::text_with_settings(&text, &settings).unwrap_or(text)
}

/// Results that are none.
fn in_results(error: &FileError) -> FileError {
    let what = format!("the node's results cannot be read: {}", error.fault.what);
    let remedy = "look at what the node says of the task, and start it once more";
    FileError::new(&error.file, Fault::new(what, remedy))
}
