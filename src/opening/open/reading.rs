//! The first step: flight.toml with its cameras and poses, or the reconstruction that stands for both.

use std::path::Path;

use super::source::{Named, Source, name_of};
use super::{FlightReconstruction, OpenOptions};
use super::{cameras, image_points};
use crate::fault::Fault;
use crate::files::{FileError, read_text};
use crate::flight::{CameraEntry, FlightFile, FlightSettings, Photo, PhotoSource};
use crate::flight_poses::{self, PhotosToPose};
use crate::formats::missions::no_flight_but_mission;
use crate::formats::packages::ros;
use crate::formats::tables::size_distributions::no_flight_but_sizes;
use crate::formats::{Kind, Package, PoseLine, Reconstruction, Sizes, detect, read_project};
use crate::geodesy::Crs;
use crate::geometry::Similarity;
use crate::georeferencing::{control_file, read_control};
use crate::jobs::Progress;
use crate::scale::PoseErrors;
use crate::world::WorldFrame;

/// What `path` names, without its surface.
///
/// # Errors
/// With the file and the place in it; where it holds no flight.
pub(super) fn read(
    path: &Path,
    options: &OpenOptions,
    progress: &Progress,
) -> Result<Source, FileError> {
    let kind = detect(path)?;
    match &kind {
        Kind::Flight(file) => of_file(file, options, progress),
        Kind::Reconstruction(..) => of_reconstruction(path, options, progress),
        Kind::SizeDistributions => Err(FileError::new(path, no_flight_but_sizes())),
        Kind::Mission => Err(FileError::new(path, no_flight_but_mission())),
        Kind::Cloud(_) if options.may_lack_photos => Ok(of_cloud(path, options)),
        Kind::Cloud(_) | Kind::Camera | Kind::Poses | Kind::Trajectory(_) => Err(FileError::new(
            path,
            Fault::new(
                format!("it holds {}, not a flight", kind.in_words()),
                "name it in a flight.toml and open that",
            ),
        )),
    }
}

/// A flight.toml and what it names.
fn of_file(path: &Path, options: &OpenOptions, progress: &Progress) -> Result<Source, FileError> {
    let at_file = |fault| FileError::new(path, fault);
    let text = read_text(path)?;
    let file = FlightFile::parse(&text).map_err(at_file)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut source = Source::new(path, file.settings(), options);
    source.name = file.name.clone().unwrap_or_else(|| name_of(path));
    source.named_crs = file
        .crs()
        .map(Crs::understand)
        .transpose()
        .map_err(|fault| {
            at_file(Fault::new(
                format!("world.crs: {}", fault.what),
                fault.remedy,
            ))
        })?;
    let apart = source.named_crs.as_ref().and_then(Crs::heights_apart);
    let apart = apart.map(|what| {
        format!(
            "world.crs: {what}: heights are taken in the unit of x and y, as all lengths of the world, but those whose unit their own file states"
        )
    });
    source.warn(path, apart.as_slice());
    source.inputs.push(path.to_owned());
    let file_in = |name: Option<&str>| name.map(|name| folder.join(name));
    source.surface = source.surface.or(file_in(file.surface()));
    if let (None, Some(folder)) = (&source.photo_folder, file_in(file.photo_folder())) {
        source.photo_folder = Some(folder);
        source.photo_folder_named = Named::InFlight;
    }
    source.unit_is_stated = file.unit().is_some();
    source.topic = source.topic.or(file.topic().map(str::to_owned));
    match file.photo_source() {
        PhotoSource::Poses(name) => {
            let names = cameras::read_tables(&mut source, path, folder, &file.cameras)?;
            let topic = source.topic.clone();
            let photos = PhotosToPose {
                flight_folder: folder,
                cameras: &file.cameras,
                folder: source.photo_folder.clone(),
                topic: topic.as_deref(),
            };
            add_poses(&mut source, &folder.join(name), &photos, &names, progress)?;
        }
        PhotoSource::Reconstruction(name, transform) => {
            let path = folder.join(name);
            let mut reconstruction = read_reconstruction(&mut source, &path, progress)?;
            let moved = transform.map(|_| "a transform in its flight.toml".to_owned());
            let named = || Some(format!("{} in its flight.toml", file.crs()?));
            source.reconstruction = Some(FlightReconstruction {
                path: path.clone(),
                in_world: moved.or_else(named).or(reconstruction.crs.clone()),
            });
            if let Some(matrix) = transform {
                let similarity = Similarity::from_row_major(&matrix).map_err(|error| {
                    at_file(Fault::new(
                        format!("photos.transform: {error}"),
                        "give a row-major similarity from the package's frame to the world",
                    ))
                })?;
                reconstruction.transform(&similarity);
                // Now it is in the world, whatever that is called.
                reconstruction.crs = None;
                reconstruction.preferred_crs = None;
                reconstruction.enu_origin = None;
                reconstruction.unit = None;
                // The scale is no longer the package's.
                reconstruction.errors.world_scale = None;
                source.package_surface_to_world = Some(similarity);
            }
            take_reconstruction(&mut source, &path, reconstruction, &file.cameras).map_err(
                |error| {
                    if error.file == path {
                        at_file(error.fault)
                    } else {
                        error
                    }
                },
            )?;
        }
        PhotoSource::None if options.may_lack_photos => {}
        PhotoSource::None => {
            let what = "it plans a flight over a surface, and has no photos yet";
            return Err(at_file(Fault::new(what, "name the flight's photos in it")));
        }
    }
    source.flight_file = Some(file);
    take_control(&mut source, path)?;
    Ok(source)
}

/// The control points beside a flight.toml, where there are any.
fn take_control(source: &mut Source, flight_file: &Path) -> Result<(), FileError> {
    let path = control_file(flight_file);
    if !path.is_file() {
        return Ok(());
    }
    let photos: Vec<&str> = source
        .photos
        .iter()
        .map(|photo| photo.name.as_str())
        .collect();
    let (list, warnings) = read_control(&path, &photos)?;
    source.settings.control = list;
    source.warn(&path, &warnings);
    source.inputs.push(path);
    Ok(())
}

/// A cloud or mesh that is opened itself, without photos.
fn of_cloud(path: &Path, options: &OpenOptions) -> Source {
    let mut source = Source::new(path, FlightSettings::default(), options);
    source.unit_is_stated = false;
    source.surface = Some(path.to_owned());
    source
}

/// A reconstruction that is opened itself.
fn of_reconstruction(
    path: &Path,
    options: &OpenOptions,
    progress: &Progress,
) -> Result<Source, FileError> {
    // In a unit that nobody has said yet.
    let mut source = Source::new(path, FlightSettings::default(), options);
    source.unit_is_stated = false;
    let reconstruction = read_reconstruction(&mut source, path, progress)?;
    source.reconstruction = Some(FlightReconstruction {
        path: path.to_owned(),
        in_world: reconstruction.crs.clone(),
    });
    if source.photo_folder.is_none() && !reconstruction.sizes.are_known() {
        // Packages name photos relative to their own file; a folder has them in it.
        source.photo_folder = match path.is_dir() {
            true => Some(path.to_owned()),
            false => path.parent().map(Path::to_owned),
        };
    }
    take_reconstruction(&mut source, path, reconstruction, &[])?;
    Ok(source)
}

fn read_reconstruction(
    source: &mut Source,
    path: &Path,
    progress: &Progress,
) -> Result<Reconstruction, FileError> {
    progress.stage(format!("reading {}", path.display()));
    source.inputs.push(path.to_owned());
    let project = match &source.topic {
        None => read_project(path, progress)?,
        Some(topic) => match detect(path)? {
            Kind::Reconstruction(Package::Ros, recording) => {
                ros::read_with_topic(&recording, topic, progress)?
            }
            _ => {
                let fault = flight_poses::topic_without_recording(topic);
                return Err(FileError::new(path, fault));
            }
        },
    };
    if source.surface.is_none() {
        source.surface_is_packages = project.surface.is_some();
        source.surface = project.surface;
        source.warn(path, project.surface_note.as_slice());
        source.surface_note = project.surface_note;
    }
    source.photo_folder = source.photo_folder.take().or(project.photos);
    Ok(project.reconstruction)
}

fn take_reconstruction(
    source: &mut Source,
    path: &Path,
    mut reconstruction: Reconstruction,
    entries: &[CameraEntry],
) -> Result<(), FileError> {
    let at = |fault| FileError::new(path, fault);
    source.warn(path, &reconstruction.warnings);
    let (crs, origin) = (reconstruction.crs.as_deref(), reconstruction.enu_origin);
    let mut said = Vec::new();
    source.poses_frame = WorldFrame::of_poses(crs, origin, &mut said).map_err(at)?;
    source.warn(path, &said);
    let preferred = reconstruction.preferred_crs.as_deref();
    // One that is not understood cannot be a target; nothing else depends on it.
    source.preferred_crs = preferred.and_then(|crs| Crs::understand(crs).ok());
    let sizes = reconstruction.sizes;
    cameras::take_sizes(source, path, &mut reconstruction, entries)?;
    source.photo_doubts = match source.poses_frame.has_lengths() {
        true => image_points::doubts(&reconstruction, sizes),
        // Poses in degrees are none to project with.
        false => Vec::new(),
    };
    let photos = reconstruction.photos.iter();
    let named = photos.map(|photo| {
        // The size that the package solved on is none beside it.
        let camera = reconstruction.cameras.get(photo.camera)?;
        let solved_on = (camera.width, camera.height);
        let named = reconstruction.named_size(photo);
        named.filter(|size| *size != solved_on)
    });
    source.named_sizes = named.collect();
    source.may_turn_meshes = reconstruction.may_turn_meshes;
    source.may_be_reduced = reconstruction.sizes == Sizes::PerhapsReduced;
    source.package_unit = reconstruction.unit;
    source.cameras = reconstruction.cameras;
    source.package_errors = reconstruction.errors;
    source.pose_errors = reconstruction.pose_errors;
    source.photos = reconstruction
        .photos
        .into_iter()
        .map(|photo| Photo {
            name: photo.name,
            camera: photo.camera,
            pose: photo.pose,
            trouble: None,
            errors: PoseErrors::default(),
            // As soon as it is in the world (framing.rs).
            package_errors: PoseErrors::default(),
        })
        .collect();
    source.reconstruction_cloud.cloud = reconstruction.cloud;
    Ok(())
}

fn add_poses(
    source: &mut Source,
    path: &Path,
    photos: &PhotosToPose<'_>,
    cameras: &[Option<String>],
    progress: &Progress,
) -> Result<(), FileError> {
    let mut poses = flight_poses::read(path, photos, progress)?;
    source.poses_frame = WorldFrame::of_poses(poses.crs.as_deref(), None, &mut poses.warnings)
        .map_err(|fault| FileError::new(path, fault))?;
    source.warn(path, &poses.warnings);
    source.doubts.append(&mut poses.doubts);
    source.inputs.push(path.to_owned());
    for line in poses.lines {
        let camera = camera_of(&line, cameras).map_err(|fault| FileError::new(path, fault))?;
        source.photos.push(Photo {
            name: line.photo,
            camera,
            pose: line.pose,
            trouble: None,
            errors: line.errors,
            package_errors: PoseErrors::default(),
        });
    }
    Ok(())
}

/// Which camera a pose belongs to.
fn camera_of(line: &PoseLine, names: &[Option<String>]) -> Result<usize, Fault> {
    let known = || {
        let names: Vec<_> = names.iter().flatten().map(String::as_str).collect();
        names.join(", ")
    };
    match (&line.camera, names) {
        (None, [_]) | (Some(_), [None]) => Ok(0),
        (None, _) => Err(Fault::at(
            line.line,
            "column camera: the flight has several cameras, and this photo names none",
            format!("name one of {}", known()),
        )),
        (Some(name), names) => names
            .iter()
            .position(|known| known.as_ref() == Some(name))
            .ok_or_else(|| {
                Fault::at(
                    line.line,
                    format!("column camera: there is no camera '{name}'"),
                    format!("name one of {}", known()),
                )
            }),
    }
}
