//! What a node sent becomes a flight: OpenDroneMap's project below `DIR/odm`, and a `flight.toml` that names it, its
//! cloud and the photos where they are.

use std::collections::HashSet;
use std::path::Path;

use crate::client::unwritten;
use crate::fault::{Fault, first_names};
use crate::files::FileError;
use crate::flight::{FlightFile, FlightSettings};
use crate::formats::{Project, read_cloud, read_project};
use crate::jobs::Progress;
use crate::opening::flight_text_of;
use crate::place::{LOG, ODM, Place};
use crate::reconstruct::{Reconstructed, name_of};
use crate::sent::Sent;
use crate::trouble::Trouble;
use crate::units::LengthUnit;

/// Puts what was unpacked in its place, as a flight of `photos`, once all of it that a flight is made of has been read:
/// after that the node throws its own away.
///
/// # Errors
/// [`Trouble::Worthless`] where it cannot be read, places none of the photos, or holds no point; where it cannot be
/// written the file here. Nothing has changed then.
pub(crate) fn flight(
    place: &Place,
    sent: &Sent,
    photos: &Path,
    progress: &Progress,
) -> Result<Reconstructed, Trouble> {
    let unpacked = place.file(ODM);
    progress.stage("reading the results");
    let told_back = sent.names.tell_back(&unpacked);
    told_back.map_err(|error| Trouble::Here(unwritten(&unpacked, &error)))?;
    let unread = |error: FileError| in_results(&error, &unpacked);
    let project = read_project(&unpacked, progress).map_err(unread)?;
    let mut warnings = project.reconstruction.warnings.clone();
    warnings.retain(|warning| !is_of_course(warning));
    let strangers = strangers_in(&project, sent);
    if !strangers.is_empty() {
        warnings.push(format!(
            "{} of the {} photos in the node's results were not sent ({}): their scales are for nothing that is here",
            strangers.len(),
            project.reconstruction.photos.len(),
            first_names(&strangers)
        ));
    }
    let registered = project.reconstruction.photos.len() - strangers.len();
    if registered == 0 {
        return Err(worthless(
            "the node's results place none of the photos".to_owned(),
        ));
    }
    let points = match &project.surface {
        Some(surface) => {
            let cloud = read_cloud(surface, progress).map_err(unread)?.cloud;
            cloud.points.len()
        }
        None => project.reconstruction.cloud.points.len(),
    };
    if points == 0 {
        let what = match &project.surface {
            Some(surface) => format!(
                "the node's cloud holds no point ({})",
                inside(surface, &unpacked)
            ),
            None => "the node's results hold no points, neither a dense cloud nor sparse ones"
                .to_owned(),
        };
        return Err(worthless(what));
    }
    // Names what is read where it will be.
    let model = place.to.join("odm");
    let surface = project
        .surface
        .as_ref()
        .and_then(|surface| surface.strip_prefix(&unpacked).ok());
    let surface = surface.map(|surface| model.join(surface));
    if surface.is_none() {
        warnings.push(
            "the node sent no dense cloud: the sparse one is the surface; the node's messages may say why".to_owned(),
        );
    }
    let put = place.put(&[(ODM, "odm"), (LOG, "node_log.txt")]);
    put.map_err(Trouble::Here)?;
    let flight = place.to.join("flight.toml");
    let name = name_of(photos);
    let text = flight_text_of(
        None,
        Some(&name),
        &flight,
        &model,
        Some(photos),
        surface.as_deref(),
    );
    let text = text.map_err(Trouble::Here)?;
    let text = match project.reconstruction.crs.is_some() {
        true => in_metres(text),
        false => text,
    };
    // The last: with it the folder is a flight.
    let written = place.write_flight(&flight, text.as_bytes());
    written.map_err(Trouble::Here)?;
    let model = project.reconstruction;
    Ok(Reconstructed {
        flight,
        registered,
        photos: sent.set.count,
        left_out: sent.set.left_out.clone(),
        points,
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

/// Results that cannot be read.
fn in_results(error: &FileError, unpacked: &Path) -> Trouble {
    let mut file = inside(&error.file, unpacked);
    if !file.is_empty() {
        file += ": ";
    }
    worthless(format!(
        "the node's results cannot be read: {file}{}",
        error.fault.what
    ))
}

/// Results that are none.
fn worthless(what: String) -> Trouble {
    Trouble::Worthless(Fault::new(what, "look at what the node says of the task"))
}

/// A file of the results, as OpenDroneMap calls it.
fn inside(file: &Path, unpacked: &Path) -> String {
    let name = file.strip_prefix(unpacked).unwrap_or(file);
    name.to_string_lossy().replace('\\', "/")
}

/// What is said of a folder that somebody opens who may have meant another reconstruction in it. Here there is one.
fn is_of_course(warning: &str) -> bool {
    warning.starts_with("an OpenDroneMap project is taken; ")
}
