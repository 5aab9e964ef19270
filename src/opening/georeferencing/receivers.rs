//! Where the photos' own receivers put them: what a reconstruction is placed by where nothing else is given, and a check
//! of the list that is.

use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};

use super::list_world::ListWorld;
use super::photo_names::PhotoNames;
use super::{Georeferenced, Known, KnownKind};
use crate::fault::first_names;
use crate::files::FileError;
use crate::formats::photos::photo_folder::PhotoFolder;
use crate::formats::poses::position_list::{
    NamedPosition, PositionList, positions_of_files, positions_of_photos,
};
use crate::formats::{MeasuredPosition, Reconstruction};
use crate::geometry::median;
use crate::georeference::Pair;
use crate::numbers::significant_digits;

/// Metres. A receiver without corrections is right to a tenth of this under open sky, and still to it beside a face;
/// zones of UTM, datums and swapped columns put a place further off, by kilometres mostly.
const FURTHER_THAN_A_RECEIVER: f64 = 100.0;

/// Positions with the file or folder that they are of: those that the package kept, else those in the photos themselves.
pub(super) fn positions(
    model: &Path,
    reconstruction: &Reconstruction,
    photos: &PhotoFolder<'_>,
) -> Result<Option<(PathBuf, PositionList)>, FileError> {
    if let Some(kept) = kept(model, reconstruction) {
        return Ok(Some(kept));
    }
    let Some(folder) = photos.folder else {
        return Ok(None);
    };
    let named = reconstruction.photos.iter().map(|photo| &photo.name);
    let found = named.filter_map(|name| Some((name.clone(), photos.find(name)?)));
    let found: Vec<(String, PathBuf)> = match photos.is_looked_through() {
        true => found.collect(),
        false => Vec::new(),
    };
    let list = match found.is_empty() {
        true => positions_of_photos(folder)?,
        false => positions_of_files(folder, &found)?,
    };
    Ok(Some((folder.to_owned(), list)))
}

/// Those that the package kept.
pub(super) fn kept(
    model: &Path,
    reconstruction: &Reconstruction,
) -> Option<(PathBuf, PositionList)> {
    let measured = &reconstruction.measured_positions;
    let of_photo = |measured: &MeasuredPosition| {
        let place = measured.position;
        NamedPosition {
            name: measured.photo.clone(),
            position: DVec3::new(place.longitude, place.latitude, place.height),
            accuracy: None,
            looks: None,
        }
    };
    let list = || PositionList {
        crs: Some("EPSG:4326".to_owned()),
        positions: measured.iter().map(of_photo).collect(),
        warnings: Vec::new(),
    };
    (!measured.is_empty()).then(|| (model.to_owned(), list()))
}

/// What photos may be whose receivers say that they are sure, and contradict the others: the only sign of a photo of another focal
/// length than its file states, which bends the model so that all scales are wrong.
pub(super) fn sure_but_not_used(known: &[Known], fit: &Georeferenced) -> Option<String> {
    let both = known.iter().zip(&fit.positions);
    let sure = both.filter(|(known, position)| {
        let accuracy = known.pair.accuracy.map(|own| own * fit.unit.metres());
        position.kind == KnownKind::Photo
            && !position.used
            && accuracy.is_some_and(|own| own <= Pair::SURE_OF_RECEIVERS)
    });
    let names: Vec<&str> = sure.map(|(known, _)| known.name.as_str()).collect();
    (!names.is_empty()).then(|| {
        format!(
            "the receivers of these photos say that they are sure ({}): if they are, the photos were zoomed, cropped or stabilised, which their files do not \
             say; where they have no lens of their own they bend the others, and all scales are wrong: reconstruct once without them, and compare",
            first_names(&names)
        )
    })
}

/// That a list brings the photos to another place than their own receivers say they were at; `None` in a
/// local world.
pub(super) fn elsewhere(
    reconstruction: &Reconstruction,
    receivers: &PositionList,
    world: &ListWorld,
    fit: &Georeferenced,
) -> Option<String> {
    let crs = world.name()?;
    let of_receivers = world.with_list(receivers.crs.as_deref(), None).ok()?;
    let listed: Vec<&str> = (receivers.positions.iter())
        .map(|position| position.name.as_str())
        .collect();
    let names = PhotoNames::new(
        reconstruction
            .photos
            .iter()
            .map(|photo| photo.name.as_str()),
        &listed,
    );
    let unit = world.unit().metres();
    let off = |position: &NamedPosition| {
        let photo = reconstruction.photos.get(names.find(&position.name)?)?;
        let placed = fit.similarity.apply(photo.pose.center);
        let stated = of_receivers.of(position.position);
        // Heights count from whatever each likes.
        let metres =
            stated.map(|stated| DVec2::distance(stated.truncate(), placed.truncate()) * unit);
        // What has no place in the system at all is far off.
        Some((metres.unwrap_or(f64::INFINITY), position.position))
    };
    let off: Vec<(f64, DVec3)> = receivers.positions.iter().filter_map(off).collect();
    let metres = median(&mut off.iter().map(|(metres, _)| *metres).collect::<Vec<f64>>())?;
    let (_, place) = off.first()?;
    (metres > FURTHER_THAN_A_RECEIVER).then(|| {
        let far = match metres {
            metres if metres.is_infinite() => "somewhere else".to_owned(),
            metres if metres < 1000.0 => format!("{metres:.0} m away"),
            metres => format!("{} km away", significant_digits(metres / 1000.0, 3)),
        };
        format!(
            "the photos come to lie {far} from where their own receivers put them (latitude {:.4}, longitude {:.4}): the known positions are in \
             another coordinate system than {crs}, or of another place",
            place.y, place.x
        )
    })
}
