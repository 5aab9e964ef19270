//! The folder that comes out: `flight.toml` and what it names, `report.html`, and `reconstruction/` with COLMAP's
//! text files. While the work goes on it has `unfinished/`, which a second run goes on with.

mod flight_files;
mod folder;
mod made_of;
mod proposed;
mod report;
mod work_folder;

pub(crate) use self::folder::{Folder, folder};
pub use self::proposed::{check_new_folder, may_be_made, name_of, proposed_folder};
pub use self::work_folder::{empty_work, lock_work};

use std::fs;
use std::io;

use self::flight_files::{FlightOf, SOURCE, flight_files};
use self::folder::FLIGHT;
use self::report::{ReportOf, report};
use crate::card::Card;
use crate::dense_cloud::dense_cloud;
use crate::engine::{Sparse, Workplace};
use crate::exports::ply;
use crate::fault::Fault;
use crate::files::FileError;
use crate::formats::read_project;
use crate::jobs::Progress;
use crate::opening::{GeoreferenceRequest, flight_text_of, georeference_model, path_from};
use crate::photo_set::{LeftOut, PhotoSet};
use crate::{DensePoints, Reconstructed, Request};

const REPORT: &str = "report.html";

fn cannot(what: &str, error: &io::Error) -> Fault {
    let what = format!("the folder cannot {what} ({error})");
    Fault::new(what, "choose a folder that may be written to")
}

/// Writes what was found, makes its cloud dense where that is asked, brings it to the world, and takes the
/// unfinished work away. `sparse` is what an engine of that name found, `goes_on` whether in a run before.
///
/// # Errors
/// Where the folder cannot be written or a photo not be read, or the work was cancelled.
pub(crate) fn write(
    request: &Request,
    folder: &mut Folder,
    photos: &PhotoSet,
    (engine, mut sparse, goes_on): (String, Sparse, bool),
    progress: &Progress,
) -> Result<Reconstructed, FileError> {
    let flight = folder.path.join(FLIGHT);
    let at = |error: &io::Error| FileError::new(&folder.path, cannot("be written", error));
    // Those that could not be read stand with the model, too; of a model that is read again they are there already.
    let mut left_out = photos.left_out.clone();
    let is_new = |of: &LeftOut| photos.left_out.iter().all(|it| it.photo != of.photo);
    left_out.extend(sparse.left_out.into_iter().filter(is_new));
    sparse.left_out = left_out;
    let model = folder.write_model(&sparse)?;
    let read = read_project(&model, progress)?.reconstruction;
    let mut warnings = photos.warnings.clone();
    let dense = match &request.dense {
        None => None,
        Some(options) => {
            let place = Workplace {
                folder: &folder.work,
                card: request.card.as_ref(),
            };
            let found = dense_cloud(&read, photos, options, &place, goes_on, progress);
            let (dense, said) = found.map_err(|fault| FileError::new(&request.photos, fault))?;
            warnings.extend(said);
            dense
        }
    };
    progress.stage("fitting");
    let known = GeoreferenceRequest {
        photos: Some(request.photos.clone()),
        crs: request.crs.clone(),
        ..GeoreferenceRequest::default()
    };
    let placed = georeference_model(&model, &read, &known);
    let mut dense_points = dense.as_ref().map(|dense| DensePoints {
        count: dense.cloud.points.len(),
        deviation: dense.deviation,
    });
    let name = name_of(&request.photos);
    let here = fs::canonicalize(&folder.path).map_err(|error| at(&error))?;
    // flight.toml is the last: with it the folder is a flight.
    let (placed, model, sure, mut files) = match placed {
        Ok(placed) => {
            progress.stage("finding how sure the poses are");
            if let Some(dense) = &mut dense_points {
                dense.deviation *= placed.similarity.scale;
            }
            warnings.extend(placed.warnings.iter().cloned());
            let to_photos = path_from(&here, &request.photos);
            let of = |to_photos: String| {
                let of = FlightOf {
                    name: &name,
                    folder: &to_photos,
                    placed: &placed,
                    photos,
                };
                flight_files(&of, read, dense, progress)
            };
            let made = to_photos
                .and_then(of)
                .map_err(|fault| FileError::new(&folder.path, fault))?;
            warnings.extend(made.warnings);
            (Some(placed), made.model, made.sure, made.files)
        }
        Err(error) => {
            warnings.push(format!(
                "the model has no unit and no place in the world: {}; up is {}",
                error.fault,
                match photos.photos.iter().any(|photo| photo.gimbal.is_some()) {
                    true => "where the gimbals' angles say",
                    false => "taken to be across the points, towards the cameras",
                }
            ));
            let photos = Some(request.photos.as_path());
            let mut files = Vec::new();
            // In the model's frame, as the poses are.
            if let Some(dense) = dense {
                let bytes = ply(&dense.cloud, SOURCE).map_err(|error| {
                    let fault = Fault::new(error, "report this");
                    FileError::new(&folder.path, fault)
                })?;
                files.push(("pile.ply", bytes));
            }
            let surface = files.first().map(|(name, _)| here.join(name));
            let surface = surface.as_deref();
            let text = flight_text_of(None, Some(&name), &flight, &model, photos, surface)?;
            files.push((FLIGHT, text.into_bytes()));
            (None, read, None, files)
        }
    };
    for (_, text) in files.iter_mut().filter(|(name, _)| *name == FLIGHT) {
        *text = folder.flight_text(std::mem::take(text))?;
    }
    let computed_on = match request.card.as_ref().map(Card::said) {
        None => None,
        Some(Ok(said)) => Some(said),
        Some(Err(said)) => {
            warnings.push(said);
            None
        }
    };
    let made = Reconstructed {
        flight,
        registered: model.photos.len(),
        photos: photos.count,
        left_out: sparse.left_out,
        points: model.cloud.points.len(),
        dense: dense_points,
        reprojection_px: model.median_reprojection_px(),
        world: placed,
        computed_on,
        warnings,
    };
    let report = report(&ReportOf {
        name: &name,
        engine: &engine,
        made: &made,
        model: &model,
        photos,
        sure: sure.as_ref(),
    });
    folder.write(&folder.path.join(REPORT), report.as_bytes())?;
    for (name, bytes) in &files {
        folder.write(&folder.path.join(name), bytes)?;
    }
    folder.throw_work_away();
    Ok(made)
}
