//! A flight that control points brought to the world: poses and surface are moved together.

use super::OpenOptions;
use super::framing::Framed;
use super::source::Source;
use crate::fault::Fault;
use crate::files::FileError;
use crate::flight::moved_errors;
use crate::geodesy::Crs;
use crate::world::WorldFrame;

/// Moves them, where the settings say so.
///
/// # Errors
/// Where the numbers are no similarity, or the coordinate system that they lead to is not understood.
pub(super) fn place(
    source: &mut Source,
    framed: &mut Framed,
    options: &OpenOptions,
) -> Result<(), FileError> {
    let settings = options.settings.as_ref().unwrap_or(&source.settings);
    let Some(placed) = settings.placed.clone() else {
        return Ok(());
    };
    let at_file = |what: String| {
        let fault = Fault::new(format!("world.placed: {what}"), "place the flight anew");
        FileError::new(&source.file, fault)
    };
    let by = placed.similarity();
    let by = by.ok_or_else(|| at_file("its numbers are no similarity".to_owned()))?;
    if let Some(crs) = &placed.crs {
        let crs = Crs::understand(crs).map_err(|fault| at_file(fault.what))?;
        framed.world = WorldFrame::Named(crs);
    }
    for photo in &mut source.photos {
        photo.pose.center = by.apply(photo.pose.center);
        photo.pose.rotation = by.rotation * photo.pose.rotation;
        photo.errors = moved_errors(photo.errors, &by);
        photo.package_errors = moved_errors(photo.package_errors, &by);
    }
    for point in &mut framed.cloud.cloud.points {
        *point = by.apply(*point);
    }
    framed.cloud.rounding *= by.scale;
    framed.cloud.facts = None;
    framed.is_placed = true;
    if let Some(moving) = &mut source.moving {
        moving.placed = Some(by);
    }
    let errors = &mut source.package_errors;
    errors.pose = moved_errors(errors.pose, &by);
    errors.surface = errors.surface.map(|deviation| deviation * by.scale);
    // The scale is no longer the package's.
    errors.world_scale = None;
    if let Some(reconstruction) = &mut source.reconstruction {
        reconstruction.in_world = Some("by control points or scale bars".to_owned());
    }
    Ok(())
}
