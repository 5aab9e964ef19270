//! A reconstruction in a frame of its own is brought to the world: by the positions that receivers
//! measured for its photos, by ground control points, or, in scale alone, by known distances.
//!
//! The world is a projected coordinate system in metres or feet: the one that is asked for, else the
//! one that the positions are in, else the zone of UTM that they lie in. One unit of its grid is taken
//! for one unit of length: in UTM that is true to 0.04 % at the zone's middle and 0.1 % at its edges.

mod against_points;
mod control_file;
mod distances;
mod flight_text;
mod georeferenced;
mod known;
mod list_world;
mod marks;
mod model_errors;
mod of_flight;
mod photo_names;
mod receivers;
mod request;
mod turned_over;

pub use self::control_file::{control_file, control_text, read_control};
pub use self::flight_text::flight_text_of;
pub use self::georeferenced::{Georeferenced, KnownKind, LengthResidual, PositionResidual};
pub use self::of_flight::{BehindFlight, behind_flight};
pub use self::request::{GeoreferenceRequest, KnownDistance, KnownEnds};

use std::path::{Path, PathBuf};

use glam::DVec3;

use self::against_points::against_points;
use self::georeferenced::percent;
use self::known::{Known, by_positions, exchanged, of_photos};
use self::list_world::ListWorld;
use self::marks::MarkedPoint;
use self::request::chosen_by_size;
use self::turned_over::turned_over;
use crate::fault::{Fault, first_names};
use crate::files::FileError;
use crate::flight::Flight;
use crate::formats::photos::photo_folder::PhotoFolder;
use crate::formats::poses::position_list::{read_control_points, read_positions};
use crate::formats::{PosedPhoto, Reconstruction, Sizes, read_project};
use crate::jobs::Progress;
use crate::numbers::TO_95_PERCENT;

/// Surveyed points that a place in the world needs.
const LEAST_SURVEYED: usize = 3;

/// Brings the reconstruction in a file or folder to the world.
///
/// # Errors
/// With the file that is to blame: lists that cannot be read, photos that do not match, positions that
/// are too few, on a line, or do not agree.
pub fn georeference(
    path: &Path,
    request: &GeoreferenceRequest,
    progress: &Progress,
) -> Result<Georeferenced, FileError> {
    progress.stage(format!("reading {}", path.display()));
    let project = read_project(path, progress)?;
    let is_given = request.photos.is_some();
    let request = GeoreferenceRequest {
        photos: request.photos.clone().or(project.photos),
        photos_are_packages: !is_given || request.photos_are_packages,
        ..request.clone()
    };
    let photos = request.photo_folder(&project.reconstruction);
    if let Some(folder) = photos.folder.filter(|_| is_given) {
        let named = project.reconstruction.photos.iter();
        let names: Vec<&str> = named.map(|photo| photo.name.as_str()).collect();
        let checked = photos.check(&names);
        checked.map_err(|fault| FileError::new(folder, fault))?;
    }
    let at = |fault| FileError::new(path, fault);
    if let Some(crs) = &project.reconstruction.crs {
        let crs = crs.split(['[', ',']).next().unwrap_or_default();
        return Err(at(Fault::new(
            format!("the reconstruction is in the world already ({crs})"),
            "open it as it is",
        )));
    }
    progress.stage("fitting");
    let mut result = with_photos(path, (&project.reconstruction, &photos), &request)?;
    let (model, placed) = (project.reconstruction, &result.similarity);
    result.warnings.extend(chosen_by_size(&photos));
    let found = model_errors::of_model(model, &photos, placed, progress).map_err(at)?;
    result.take_errors(found);
    Ok(result)
}

/// The same of a reconstruction in a frame of its own that was read from `path`.
///
/// # Errors
/// Likewise.
pub fn georeference_model(
    path: &Path,
    reconstruction: &Reconstruction,
    request: &GeoreferenceRequest,
) -> Result<Georeferenced, FileError> {
    let photos = request.photo_folder(reconstruction);
    with_photos(path, (reconstruction, &photos), request)
}

/// The same with the folder of its photos, in which a disk may have to be looked through: once.
fn with_photos(
    path: &Path,
    (reconstruction, photos): (&Reconstruction, &PhotoFolder<'_>),
    request: &GeoreferenceRequest,
) -> Result<Georeferenced, FileError> {
    let mut warnings = reconstruction.warnings.clone();
    let points = match (&request.marked, &request.control_points) {
        (Some(marked), _) => Some(marked.clone()),
        (None, Some(list)) => {
            let read = read_control_points(list)?;
            let said = read.warnings.iter();
            warnings.extend(said.map(|w| format!("{}: {w}", list.display())));
            Some(read.list)
        }
        (None, None) => None,
    };
    let mut marked: Vec<MarkedPoint> = Vec::new();
    let mut bars: Vec<KnownDistance> = Vec::new();
    if let Some(points) = &points {
        let list = request.control_points.as_deref().unwrap_or(path);
        marked = marks::triangulated(reconstruction, points, photos, &mut warnings)
            .map_err(|fault| FileError::new(list, fault))?;
        bars = distances::of_bars(&points.bars, &marked, &mut warnings);
    }
    let surveyed = marked.iter().filter(|p| p.position.is_some()).count();
    // Surveyed points tell the length better than a distance between two.
    let distances = match surveyed < LEAST_SURVEYED {
        true if request.distances.is_empty() => &bars,
        _ => &request.distances,
    };
    if !request.distances.is_empty() && surveyed >= LEAST_SURVEYED {
        warnings.push("the known distance decides alone, and the surveyed control points are not used: leave --distance out to be placed by them".to_owned());
        if let Some(points) = &points {
            let named = ("known distance", request.distances.as_slice());
            warnings.extend(against_points(named, points, &marked, request));
        }
    }
    if surveyed > 0 && surveyed < LEAST_SURVEYED && !bars.is_empty() {
        let points = if surveyed == 1 {
            "1 surveyed point is"
        } else {
            "2 surveyed points are"
        };
        warnings.push(format!("{points} too few to be placed by, and not used"));
    }
    // Where the marks are the window's the flight stays in its frame, or where it is.
    let stays = reconstruction.crs.is_some() || request.level || request.marked.is_some();
    let positions = match (&request.positions, &points) {
        (Some(list), _) => Some((list.clone(), read_positions(list)?)),
        _ if !distances.is_empty() && (stays || surveyed >= LEAST_SURVEYED) => None,
        // Photos that say nothing are no fault here.
        _ if !distances.is_empty() => receivers::positions(path, reconstruction, photos)
            .ok()
            .flatten(),
        (None, None) => receivers::positions(path, reconstruction, photos)?,
        // Nobody asked for the photos' own: those that the package kept are compared, where the points' world has a place on
        // the Earth.
        (None, Some(points)) => (points.crs.as_ref().or(request.crs.as_ref()))
            .and_then(|_| receivers::kept(path, reconstruction)),
    };
    if !distances.is_empty() && positions.is_none() {
        return distances::by_distances(reconstruction, request, distances, &marked, warnings)
            .map_err(|fault| FileError::new(path, fault));
    }
    // With distances the positions place it.
    let points = points.filter(|_| distances.is_empty());
    let listed = request.control_points.as_ref();
    let blamed = (listed.filter(|_| points.is_some()))
        .or(positions.as_ref().map(|(list, _)| list))
        .map_or(path, PathBuf::as_path);
    let blame = |fault| FileError::new(blamed, fault);
    if let Some((list, positions)) = &positions {
        warnings.extend(
            positions
                .warnings
                .iter()
                .map(|w| format!("{}: {w}", list.display())),
        );
    }
    if points.is_none() && positions.is_none() {
        return Err(FileError::new(
            path,
            Fault::new(
                "nothing is known of its place in the world",
                "give photos with positions in them (--photos), a list of positions (--positions), control points (--gcp) or a known distance (--distance)",
            ),
        ));
    }
    let stated = match &points {
        Some(points) => points.crs.as_deref(),
        None => positions.as_ref().and_then(|(_, list)| list.crs.as_deref()),
    };
    let all: Vec<DVec3> = match (&points, &positions) {
        (Some(points), _) => points.points.iter().filter_map(|p| p.position).collect(),
        (None, Some((_, list))) => list.positions.iter().map(|p| p.position).collect(),
        (None, None) => Vec::new(),
    };
    let world =
        ListWorld::new(request.crs.as_deref(), stated, &all, &mut warnings).map_err(blame)?;
    let mut known: Vec<Known> = Vec::new();
    if points.is_some() {
        for point in &marked {
            known.extend(Known::of_point(point, &world).map_err(blame)?);
        }
    }
    if let Some((list, positions)) = &positions {
        let at_list = |fault| FileError::new(list, fault);
        // A list of its own may be in a system of its own.
        let world = world
            .with_list(positions.crs.as_deref(), request.crs.as_deref())
            .map_err(at_list)?;
        let photos =
            of_photos(reconstruction, positions, &world, &mut warnings).map_err(at_list)?;
        known.extend(photos);
    }
    let own = (positions.as_ref()).filter(|_| points.is_none() && request.positions.is_none());
    let placed = by_positions(&known, points.is_some()).and_then(|placed| {
        let turned = own
            .and_then(|(_, own)| turned_over::by_receivers(&reconstruction.photos, own, &placed));
        turned.map_or(Ok(placed), Err)
    });
    let mut result = match placed {
        // Nobody asked to be placed by the photos' own.
        Err(fault) if !distances.is_empty() && request.positions.is_none() => {
            warnings.push(format!(
                "the photos' own positions do not place it: {fault}"
            ));
            let request = GeoreferenceRequest {
                crs: None,
                ..request.clone()
            };
            return distances::by_distances(reconstruction, &request, distances, &marked, warnings)
                .map_err(|fault| FileError::new(path, fault));
        }
        fitted => fitted.map_err(blame)?,
    };
    if points.is_some() && positions.is_some() {
        warnings
            .push("the control points decide; the photos' positions are only compared".to_owned());
    }
    if request.level {
        warnings.push("--level is for distances: the known positions say where up is".to_owned());
    }
    result.heights = Some(world.heights().to_owned());
    result.crs = world.name().map(str::to_owned);
    result.unit = world.unit();
    if distances.is_empty() {
        distances::compare(&mut result, ("scale bar", &bars), &marked)
    } else {
        distances::lengthen(&mut result, &known, distances, &marked)
    }
    .map_err(|fault| FileError::new(path, fault))?;
    warnings.append(&mut result.warnings);
    let far = result
        .positions
        .iter()
        .filter(|p| !p.used && (p.kind == KnownKind::ControlPoint) == points.is_some());
    let outliers: Vec<&str> = far.map(|position| position.name.as_str()).collect();
    if !outliers.is_empty() {
        let do_not = match outliers.len() {
            1 => "1 known position does not agree with the others and was",
            count => &format!("{count} known positions do not agree with the others and were"),
        };
        let names = first_names(&outliers);
        warnings.push(format!("{do_not} left out of the fit: {names}"));
        warnings.extend(receivers::sure_but_not_used(&known, &result));
    }
    let contradiction = marks::contradiction(&marked, &result);
    if let Some(degrees) = result
        .rotation_error_degrees
        .filter(|degrees| *degrees > 1.0 && contradiction.is_none())
    {
        warnings.push(format!(
            "the positions hold the least sure rotation to {degrees:.1} degrees only: they lie nearly on a line, or close together for how \
             well they are known"
        ));
    }
    if contradiction.is_some() {
        let points: Vec<&Known> = (known.iter())
            .filter(|known| known.kind == KnownKind::ControlPoint)
            .collect();
        warnings.extend(exchanged(&points).map(|[one, other]| {
            format!(
                "'{one}' and '{other}' look exchanged: with each other's coordinates all points fit"
            )
        }));
    }
    warnings.extend(contradiction);
    warnings.extend(turned_over(&marked, &reconstruction.photos, &result));
    // In a local world there is nothing to compare, and no photo is looked into.
    if result.crs.is_some() && (points.is_some() || request.positions.is_some()) {
        let own = receivers::positions(path, reconstruction, photos);
        // Photos that say nothing are no fault here: a list was given.
        let own = own.ok().flatten();
        warnings.extend(
            own.and_then(|(_, own)| receivers::elsewhere(reconstruction, &own, &world, &result)),
        );
    }
    if result.used() == 3 {
        warnings.push("three known positions check each other hardly at all".to_owned());
    }
    result.warnings = warnings;
    Ok(result)
}

/// The same of a flight by its control points, in the frame of its poses: what [`GeoreferenceRequest::crs`] asks for
/// is the flight's own system, where it has one. `file` is blamed.
///
/// # Errors
/// Likewise.
pub fn georeference_flight(
    file: &Path,
    flight: &Flight,
    request: &GeoreferenceRequest,
) -> Result<Georeferenced, FileError> {
    let parts = flight.parts();
    let photos = parts.photos.iter().map(|photo| PosedPhoto {
        name: photo.name.clone(),
        camera: photo.camera,
        pose: photo.pose,
    });
    let mut reconstruction = Reconstruction {
        cameras: parts.cameras.clone(),
        photos: photos.collect(),
        sizes: Sizes::Known,
        crs: request.crs.clone(),
        unit: parts.unit_known.then_some(parts.unit),
        ..Reconstruction::default()
    };
    if request.level {
        reconstruction.cloud.points = parts.surface.vertices().collect();
    }
    let found = georeference_model(file, &reconstruction, request)?;
    let stated = (parts.errors.world_scale).map(|percent| percent / 100.0 * TO_95_PERCENT);
    match (stated, found.scale_interval) {
        (Some(stated), Some(bars))
            if parts.unit_known && found.positions.is_empty() && stated < bars =>
        {
            Err(FileError::new(
                file,
                Fault::new(
                    format!(
                        "the flight's length is known to ± {} (95 %), and these scale bars tell it to ± {} only",
                        percent(stated),
                        percent(bars)
                    ),
                    "mark their ends in more photos or sharper, or measure longer ones",
                ),
            ))
        }
        _ => Ok(found),
    }
}

#[cfg(test)]
mod tests;
