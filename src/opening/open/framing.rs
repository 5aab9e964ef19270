//! One frame: poses and surface are brought to the world's coordinate system.

use glam::DVec3;

use super::source::Source;
use crate::fault::Fault;
use crate::files::FileError;
use crate::flight::Doubt;
use crate::formats::{CloudFile, PoseCovariance};
use crate::jobs::Progress;
use crate::world::{Known, Way, WorldFrame, not_on_its_map, place_of_flight, taken_to_be_in};

/// The surface in the world.
pub(super) struct Framed {
    pub(super) cloud: CloudFile,
    pub(super) world: WorldFrame,
    /// Whether the poses are in the world's system by what their files say.
    pub(super) poses_are_told: bool,
    /// Whether control points brought both elsewhere.
    pub(super) is_placed: bool,
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
    let mut surface = surface.transpose().map_err(at_surface)?;
    source.warn(surface_file, &said);
    let centers = source.photos.iter().map(|photo| photo.pose.center);
    let first_point = file.as_ref().and_then(|file| file.cloud.points.first());
    let middle = centers.sum::<DVec3>() / source.photos.len().max(1) as f64;
    let on_surface = first_point.copied().unwrap_or_default();
    // Who names the world's system answers for it, and poses that have a place show what is far from it.
    if source.named_crs.is_none() && source.poses_frame.is_as_it_is() {
        let own = surface
            .as_ref()
            .and_then(|frame| not_on_its_map(frame, on_surface));
        if let Some(own) = own {
            source.warn(surface_file, &[own]);
            surface = Some(WorldFrame::AsIs(None));
        }
    }
    let known = Known {
        named: source.named_crs.clone(),
        place: place_of_flight(&source.poses_frame, middle, surface.as_ref(), on_surface),
        surface: surface.clone(),
        poses: source.poses_frame.clone(),
        preferred: source.preferred_crs.clone(),
    };
    let world = known.world().map_err(|error| at_poses(error.into()))?;
    let of_poses = source.poses_frame.to(&world);
    // What is taken to be in a system has its heights in the unit that they have there.
    let is_taken =
        surface.as_ref().is_some_and(WorldFrame::is_as_it_is) && !source.poses_frame.is_as_it_is();
    // A file that states the poses' map and no heights has them as the poses do, whatever unit that is.
    let has_poses_heights = surface.as_ref().is_some_and(|surface| {
        !surface.states_heights() && source.poses_frame.is_same_map_with_heights(surface)
    });
    let points_frame = match (is_taken, has_poses_heights) {
        (true, _) => Some(world.clone()),
        (false, true) => Some(source.poses_frame.clone()),
        (false, false) => surface.clone(),
    };
    let (mut cloud, of_points) = match (file, &points_frame) {
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
    cloud.rounding = moved_rounding(&cloud, &of_points).map_err(at_surface)?;
    of_points
        .points(&mut cloud.cloud.points)
        .map_err(at_surface)?;
    if !of_points.is_none() {
        cloud.facts = None;
    }
    if let (Some(moving), Some(frame)) = (&mut source.moving, &points_frame) {
        moving.frames = Some((frame.clone(), world.clone()));
    }
    let poses_moved = of_poses.in_words("the poses");
    let points_moved = of_points.in_words("the points");
    source.warn(&path, poses_moved.as_slice());
    if let Some([poses, surface]) = other_heights(source, surface.as_ref(), &world) {
        let doubt = Doubt::OtherHeights { poses, surface };
        source.warn(&path, &[doubt.to_string()]);
        source.doubts.push(doubt);
    }
    match surface {
        Some(own) if is_taken => {
            let centers = source.photos.iter().map(|photo| photo.pose.center);
            let centers: Vec<DVec3> = centers.collect();
            let said = taken_to_be_in(&own, &world, &cloud.cloud.points, &centers);
            // A package's own surface is in its package's frame, as long as that stays.
            let said = match (said, source.surface_is_packages) {
                (Err(fault), true) => Some(fault.what),
                (Ok(_), true) if poses_moved.is_none() => None,
                (said, _) => Some(said.map_err(at_surface)?),
            };
            source.warn(surface_file, said.as_slice());
            source.warn(surface_file, points_moved.as_slice());
        }
        Some(_) => {
            if has_poses_heights {
                let frame = source.poses_frame.in_words();
                let said =
                    format!("it says nothing of heights, which are taken to be those of {frame}");
                source.warn(surface_file, &[said]);
            }
            source.warn(surface_file, points_moved.as_slice());
        }
        None => {}
    }
    let poses_are_told = poses_moved.is_some() || !source.poses_frame.is_as_it_is();
    Ok(Framed {
        cloud,
        world,
        poses_are_told,
        is_placed: false,
    })
}

/// What the poses' heights and the surface's count from, where one counts from the ellipsoid and the other does not. A file
/// that states a map's system, or none, mostly says nothing of heights: then it is in the system that its package works in,
/// or else in the world's, with its heights.
fn other_heights(
    source: &Source,
    surface: Option<&WorldFrame>,
    world: &WorldFrame,
) -> Option<[String; 2]> {
    let surface = surface?;
    if surface.states_heights() {
        return source.poses_frame.other_heights(surface);
    }
    // The package's own is in its own frame.
    if source.surface_is_packages {
        return None;
    }
    let preferred = source.preferred_crs.clone().map(WorldFrame::Named);
    let preferred = preferred.filter(WorldFrame::states_heights);
    let taken = preferred.as_ref().unwrap_or(world);
    let [poses, surface] = source.poses_frame.other_heights(taken)?;
    Some([
        poses,
        format!("{surface} (of {}; its file does not say)", taken.in_words()),
    ])
}

/// How far the points of a cloud are rounded once they are moved: degrees become metres.
fn moved_rounding(cloud: &CloudFile, way: &Way) -> Result<f64, Fault> {
    let Some(&point) = cloud.cloud.points.first().filter(|_| cloud.rounding > 0.0) else {
        return Ok(0.0);
    };
    let mut ends = [point, point + DVec3::new(0.0, cloud.rounding, 0.0)];
    way.points(&mut ends)?;
    Ok(ends[0].distance(ends[1]))
}
