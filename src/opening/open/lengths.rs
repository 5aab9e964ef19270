//! The last word on the world, once poses and surface are where they stay: whether lengths in its system
//! are lengths on the ground, and in which unit they are.

use super::framing::Framed;
use super::source::Source;
use crate::fault::Fault;
use crate::files::FileError;
use crate::flight::WorldSystem;
use crate::units::LengthUnit;
use crate::world::WorldFrame;

/// Tells the unit of the world, and what speaks against its lengths.
///
/// # Errors
/// Where lengths of its system are none there, and where flight.toml says another unit of poses and surface
/// that were brought to it.
pub(super) fn tell(source: &mut Source, framed: &Framed) -> Result<(), FileError> {
    let surface_file = source.surface_file();
    let at_surface = |fault| FileError::new(&surface_file, fault);
    let point = framed.cloud.cloud.points.first().copied();
    let doubt = point
        .map(|point| framed.world.check_lengths(point))
        .transpose();
    let doubt = doubt.map_err(at_surface)?.flatten();
    source.warn(&surface_file, doubt.as_slice());
    take_unit(source, framed)
}

/// The system of the world, where it is understood.
pub(super) fn system_of(framed: &Framed) -> Option<WorldSystem> {
    let WorldFrame::Named(crs) = &framed.world else {
        return None;
    };
    Some(WorldSystem {
        name: crs.name().to_owned(),
        unit_metres: crs.unit_metres(),
    })
}

/// The unit of the world: what flight.toml says, if the world's system does not say another one.
fn take_unit(source: &mut Source, framed: &Framed) -> Result<(), FileError> {
    let world = &framed.world;
    let path = source.file.clone();
    let at_poses = |fault| FileError::new(&path, fault);
    let unit = world.unit().map_err(at_poses)?;
    let Some(unit) = unit.filter(|_| !is_of_surface_alone(source, world)) else {
        // Control points may have made the world larger.
        let package = source.package_unit.filter(|_| !framed.is_placed);
        take_package_unit(source, package);
        return Ok(());
    };
    let stated = source.settings.unit;
    if !source.unit_is_stated {
        source.settings.unit = unit;
        source.settings.unit_known = true;
    } else if unit != stated && framed.poses_are_told {
        let what = format!(
            "the world is {}, which counts in {unit}, not {stated}",
            world.in_words()
        );
        let remedy = format!("write world.unit = \"{unit}\"");
        return Err(at_poses(Fault::new(what, remedy)));
    }
    Ok(())
}

/// Whether the world is a local frame that the surface's file alone names: a model in a frame of its own need not be in it, and
/// counts in no unit by it.
fn is_of_surface_alone(source: &Source, world: &WorldFrame) -> bool {
    let model = source.reconstruction.as_ref();
    let is_in_own_frame = model.is_some_and(|model| model.in_world.is_none());
    is_in_own_frame && world.is_as_it_is() && matches!(source.poses_frame, WorldFrame::AsIs(None))
}

/// The unit of a world without a coordinate system: what flight.toml says, else the package.
fn take_package_unit(source: &mut Source, package: Option<LengthUnit>) {
    let settings = &mut source.settings;
    match (source.unit_is_stated, package) {
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
