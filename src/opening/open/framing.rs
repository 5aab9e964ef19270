//! One frame: poses and surface are brought to the world's coordinate system, and its unit is told.

use std::path::Path;

use glam::DVec3;

use super::source::Source;
use crate::fault::Fault;
use crate::files::FileError;
use crate::formats::{CloudFile, PoseCovariance};
use crate::jobs::Progress;
use crate::world::{Known, WorldFrame, place_of_flight, taken_to_be_in};

/// The surface in the world.
pub(super) struct Framed {
    pub(super) cloud: CloudFile,
    pub(super) world: WorldFrame,
}

/// Brings the poses and the surface (that of `file`, or the reconstruction's own points) to the
/// flight's world.
///
/// # Errors
/// Where no world can be chosen, or something has no place in it.
pub(super) fn bring_to_world(
    source: &mut Source,
    file: Option<CloudFile>,
    progress: &Progress,
) -> Result<Framed, FileError> {
    let surface_file = source.surface_file();
    let surface_file = surface_file.as_path();
    let at_surface = |fault| FileError::new(surface_file, fault);
    let path = source.file.clone();
    let at_poses = |fault| FileError::new(&path, fault);
    let mut said = Vec::new();
    let surface = file
        .as_ref()
        .map(|file| WorldFrame::of_cloud(file, &mut said));
    let surface = surface.transpose().map_err(at_surface)?;
    source.warn(surface_file, &said);
    let centers = source.photos.iter().map(|photo| photo.pose.center);
    let first_point = file.as_ref().and_then(|file| file.cloud.points.first());
    let middle = centers.sum::<DVec3>() / source.photos.len().max(1) as f64;
    let on_surface = first_point.copied().unwrap_or_default();
    let known = Known {
        named: source.named_crs.clone(),
        place: place_of_flight(&source.poses_frame, middle, surface.as_ref(), on_surface),
        surface: surface.clone(),
        poses: source.poses_frame.clone(),
        preferred: source.preferred_crs.clone(),
    };
    let world = known.world().map_err(|error| at_poses(error.into()))?;
    let of_poses = source.poses_frame.to(&world);
    let (mut cloud, of_points) = match (file, &surface) {
        (Some(file), Some(frame)) => (file, frame.to(&world)),
        _ => (std::mem::take(&mut source.reconstruction_cloud), of_poses),
    };
    if !of_poses.is_none() || !of_points.is_none() {
        progress.stage("bringing poses and surface to one coordinate system");
    }
    let nothing = std::iter::repeat(PoseCovariance::default());
    let stated = std::mem::take(&mut source.pose_errors);
    for (photo, stated) in source
        .photos
        .iter_mut()
        .zip(stated.into_iter().chain(nothing))
    {
        let moved = of_poses.pose(&photo.name, &photo.pose).map_err(at_poses)?;
        let stated = stated.moved(&of_poses.differences(&photo.pose, &moved));
        photo.pose = moved;
        photo.package_errors = stated.errors();
    }
    of_points
        .points(&mut cloud.cloud.points)
        .map_err(at_surface)?;
    if !of_points.is_none() {
        cloud.facts = None;
    }
    if let (Some(moving), Some(frame)) = (&mut source.moving, &surface) {
        moving.frames = Some((frame.clone(), world.clone()));
    }
    let middle = cloud.cloud.points.first().copied();
    let doubt = middle.map(|point| world.check_lengths(point)).transpose();
    let doubt = doubt.map_err(at_surface)?.flatten();
    let poses_moved = of_poses.in_words("the poses");
    let points_moved = of_points.in_words("the points");
    source.warn(surface_file, doubt.as_slice());
    source.warn(&path, poses_moved.as_slice());
    match surface {
        Some(WorldFrame::AsIs(_)) if !source.poses_frame.is_as_it_is() => {
            let centers = source.photos.iter().map(|photo| photo.pose.center);
            let centers: Vec<DVec3> = centers.collect();
            let said = taken_to_be_in(&world, &cloud.cloud.points, &centers);
            // A package's own surface is in its package's frame, as long as that stays.
            let said = match (said, source.surface_is_packages) {
                (Err(fault), true) => Some(fault.what),
                (Ok(_), true) if poses_moved.is_none() => None,
                (said, _) => Some(said.map_err(at_surface)?),
            };
            source.warn(surface_file, said.as_slice());
        }
        Some(_) => source.warn(surface_file, points_moved.as_slice()),
        None => {}
    }
    let is_in_world = poses_moved.is_some() || !source.poses_frame.is_as_it_is();
    take_unit(source, &world, surface_file, is_in_world)?;
    Ok(Framed { cloud, world })
}

/// The unit of the world: what flight.toml says, if the world's system does not say another one.
fn take_unit(
    source: &mut Source,
    world: &WorldFrame,
    surface_file: &Path,
    is_in_world: bool,
) -> Result<(), FileError> {
    let path = source.file.clone();
    let at_poses = |fault| FileError::new(&path, fault);
    let Some(unit) = world.unit().map_err(at_poses)? else {
        take_package_unit(source);
        return Ok(());
    };
    let stated = source.settings.unit;
    if !source.unit_is_stated {
        source.settings.unit = unit;
        source.settings.unit_known = true;
    } else if unit != stated {
        let what = format!(
            "the world is {}, which counts in {unit}, not {stated}",
            world.in_words()
        );
        if is_in_world {
            let remedy = format!("write world.unit = \"{unit}\"");
            return Err(at_poses(Fault::new(what, remedy)));
        }
        source.warn(surface_file, &[what]);
    }
    Ok(())
}

/// The unit of a world without a coordinate system: what flight.toml says, else the package.
fn take_package_unit(source: &mut Source) {
    let settings = &mut source.settings;
    match (source.unit_is_stated, source.package_unit) {
        (false, unit) => {
            settings.unit = unit.unwrap_or(settings.unit);
            settings.unit_known = unit.is_some();
        }
        (true, Some(unit)) if unit != settings.unit => {
            let path = source.file.clone();
            let stated = settings.unit;
            let what = format!("world.unit is {stated}, but the package counts in {unit}");
            source.warn(&path, &[what]);
        }
        (true, _) => {}
    }
}
