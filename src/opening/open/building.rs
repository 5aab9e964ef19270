//! The last step: the surface is triangulated, and all becomes a flight.

use std::sync::Arc;

use super::framing::Framed;
use super::lengths;
use super::source::Source;
use super::{OpenOptions, Opened};
use crate::evidence::look_up;
use crate::fault::{Fault, Lacking};
use crate::files::{FileError, Inputs};
use crate::flight::{AsRead, Flight, FlightParts};
use crate::formats::CloudFile;
use crate::in_part::InPart;
use crate::jobs::Progress;
use crate::origin::FlightOrigin;
use crate::photo_files::{PhotoFile, without_pose};
use crate::surface::Surface;

/// Builds the flight.
///
/// # Errors
/// Where there are no points, or they make no surface; as [`Flight::new`].
pub(super) fn build(
    mut source: Source,
    framed: Framed,
    photo_files: Vec<PhotoFile>,
    options: &OpenOptions,
    part: Option<&mut InPart>,
    progress: &Progress,
) -> Result<Opened, FileError> {
    let as_read = AsRead {
        doubts: std::mem::take(&mut source.doubts),
        of_photos: std::mem::take(&mut source.photo_doubts),
        rounding: framed.cloud.rounding,
        system: lengths::system_of(&framed),
    };
    let Framed { cloud, world, .. } = framed;
    let surface_file = source.surface_file();
    let at_surface = |fault| FileError::new(&surface_file, fault);
    let origin = FlightOrigin {
        path: source.file.clone(),
        is_flight_file: source.flight_file.is_some(),
        name: source.name.clone(),
        is_changed: options.surface.is_some() || options.photos.is_some(),
        photo_folder: source.photo_folder.clone(),
        surface: source.surface.clone(),
        is_surface: source.photos.is_empty() && options.may_lack_photos,
    };
    if cloud.cloud.points.is_empty() {
        let looked = source.surface_note.map(|note| format!(": {note}"));
        let looked = looked.unwrap_or_default();
        return Err(at_surface(Fault::new(
            format!("it has no 3D points to make a surface of{looked}"),
            "add its cloud or mesh: drop it on the window, or name it with --surface or as [surface] file in a flight.toml",
        )
        .for_want_of(Lacking::Surface)));
    }
    let settings = options.settings.clone().unwrap_or(source.settings);
    if settings.surface.thinning.is_some() && !cloud.cloud.triangles.is_empty() {
        let file = surface_file.display();
        source.warnings.push(format!(
            "{file}: it has faces, so it is used as it is and not thinned"
        ));
    }
    let surface = match (part, &source.moving) {
        (Some(part), Some(moving)) => {
            let (photos, cameras) = (&source.photos, &source.cameras);
            let (image, max_edge) = (settings.image, settings.surface.max_edge);
            part.surface(moving, photos, cameras, image, max_edge, progress)
                .map_err(at_surface)?
        }
        _ => {
            progress.stage("building the surface");
            let CloudFile { cloud, facts, .. } = cloud;
            let surface = Surface::with_facts(cloud, &settings.surface, facts.as_ref());
            surface.map_err(|error| {
                let remedy = match settings.surface.thinning {
                    Some(_) => "check the surface file, or thin less",
                    None => "check the surface file",
                };
                at_surface(Fault::new(error.to_string(), remedy))
            })?
        }
    };
    let parts = FlightParts {
        name: source.name,
        unit: settings.unit,
        unit_known: settings.unit_known,
        ground: settings.ground,
        image: settings.image,
        pair: settings.pair,
        errors: settings.errors,
        package_errors: source.package_errors,
        surface: Arc::new(surface),
        cameras: source.cameras,
        photos: source.photos,
        as_read,
    };
    let flight = match origin.is_surface {
        true => Flight::perhaps_without_photos(parts),
        false => Flight::new(parts),
    };
    let flight = flight.map_err(|fault| FileError::new(&source.file, fault))?;
    let file = source.file.display();
    let looked_up = look_up(&flight, &photo_files);
    let mut without_photo = flight.objects_without_photo(&settings.scale_objects);
    without_photo.extend(flight.decisions_without_photo(&settings.decisions));
    source.warnings.extend(
        without_photo
            .into_iter()
            .map(|warning| format!("{file}: {warning}")),
    );
    Ok(Opened {
        flight: Arc::new(flight),
        warnings: source.warnings,
        without_pose: without_pose(&photo_files),
        photo_files,
        looked_up,
        doubtful_up: source.doubtful_up,
        crs: world.crs().map(str::to_owned),
        settings,
        file: source.flight_file.map(|file| (source.file, file)),
        origin,
        reconstruction: source.reconstruction,
        inputs: source.inputs,
        read: Inputs::default(),
    })
}
