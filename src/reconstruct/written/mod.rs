//! The folder that comes out: `flight.toml` and what it names, `report.html`, and `reconstruction/` with COLMAP's
//! text files. While the work goes on it has `unfinished/`, which a second run goes on with.

mod flight_files;
mod folder;
mod proposed;
mod report;

pub(crate) use self::folder::{Folder, folder};
pub use self::proposed::{may_be_made, proposed_folder};

use std::fs;
use std::io;
use std::path::PathBuf;

use self::flight_files::{FlightOf, SOURCE, flight_files};
use self::folder::FLIGHT;
use self::proposed::name_of;
use self::report::{ReportOf, report};
use crate::dense_cloud::{DenseCloud, dense_cloud};
use crate::engine::Sparse;
use crate::exports::ply;
use crate::fault::Fault;
use crate::files::FileError;
use crate::formats::read_project;
use crate::jobs::Progress;
use crate::opening::{GeoreferenceRequest, flight_text_of, georeference_model, path_from};
use crate::photo_set::PhotoSet;
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
    folder: &Folder,
    photos: &PhotoSet,
    (engine, sparse, goes_on): (String, Sparse, bool),
    progress: &Progress,
) -> Result<Reconstructed, FileError> {
    let flight = folder.path.join(FLIGHT);
    let at = |error: &io::Error| FileError::new(&folder.path, cannot("be written", error));
    let model = folder.write_model(&sparse)?;
    let read = read_project(&model, progress)?.reconstruction;
    let mut warnings = Vec::new();
    let dense = match &request.dense {
        None => None,
        Some(options) => {
            let found = dense_cloud(&read, photos, options, &folder.work, goes_on, progress);
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
    // flight.toml is the last: with it the folder is a flight.
    let (placed, model, sure, files) = match placed {
        Ok(placed) => {
            progress.stage("finding how sure the poses are");
            if let Some(dense) = &mut dense_points {
                dense.deviation *= placed.similarity.scale;
            }
            warnings.extend(placed.warnings.iter().cloned());
            let here = fs::canonicalize(&folder.path).map_err(|error| at(&error))?;
            let to_photos = path_from(&here, &request.photos);
            let of = |to_photos: String| {
                let of = FlightOf {
                    name: &name,
                    folder: &to_photos,
                    placed: &placed,
                    photos,
                };
                flight_files(&of, read, dense)
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
            let surface = dense
                .map(|dense| write_in_its_frame(folder, &dense))
                .transpose()?;
            let surface = surface.as_deref();
            let text = flight_text_of(None, Some(&name), &flight, &model, photos, surface)?;
            (None, read, None, vec![(FLIGHT, text.into_bytes())])
        }
    };
    for (_, text) in files.iter().filter(|(name, _)| *name == FLIGHT) {
        folder.is_of_its_world(text)?;
    }
    let mut left_out = photos.left_out.clone();
    left_out.extend(sparse.left_out);
    let made = Reconstructed {
        flight,
        registered: model.photos.len(),
        photos: photos.count,
        left_out,
        points: model.cloud.points.len(),
        dense: dense_points,
        reprojection_px: model.median_reprojection_px(),
        world: placed,
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
        match *name {
            FLIGHT => folder.write_flight(bytes, made.dense.is_some())?,
            name => folder.write(&folder.path.join(name), bytes)?,
        }
    }
    // The flight is whole: what is left over harms nobody.
    let _ = fs::remove_dir_all(&folder.work);
    Ok(made)
}

/// Writes the dense cloud of a model that has no place in the world, in the model's frame.
fn write_in_its_frame(folder: &Folder, dense: &DenseCloud) -> Result<PathBuf, FileError> {
    let path = folder.path.join("pile.ply");
    let bytes = ply(&dense.cloud, SOURCE).map_err(|error| {
        let fault = Fault::new(error, "report this");
        FileError::new(&path, fault)
    })?;
    folder.write(&path, &bytes)?;
    Ok(path)
}
