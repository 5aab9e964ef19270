//! The surface's file, with its z up.

use super::source::Source;
use super::turned_mesh::{lies_before_photos, turn_back};
use super::{OnSample, OpenOptions, SurfaceSample};
use crate::files::FileError;
use crate::formats::{CloudFile, read_cloud, read_cloud_sample};
use crate::in_part::{InPart, Moving};
use crate::jobs::Progress;
use crate::surface::{Cloud, UpAxis, doubtful_up};

/// Reads it; `None` where the reconstruction's own points are the surface.
///
/// # Errors
/// With the file and the place in it.
pub(super) fn read(
    source: &mut Source,
    options: &OpenOptions,
    mut part: Option<&mut InPart>,
    on_sample: Option<OnSample<'_>>,
    progress: &Progress,
) -> Result<Option<CloudFile>, FileError> {
    if options.surface.is_some() {
        // What is said of the flight's own file does not hold for another.
        source.settings.surface_up = options.surface_up.unwrap_or(UpAxis::Z);
    }
    let settings = options.settings.as_ref().unwrap_or(&source.settings);
    let up = settings.surface_up;
    let Some(path) = source.surface.clone() else {
        if up != UpAxis::Z {
            let said = format!(
                "the axis that is up ({}) was not taken: it is for a surface in a file of its own, and the reconstruction's points stand as its poses do",
                up.name()
            );
            let file = source.file.clone();
            source.warn(&file, &[said]);
        }
        return Ok(None);
    };
    if let Some(on_sample) = on_sample
        && let Some((mut sample, of)) = read_cloud_sample(&path, progress)
    {
        for point in &mut sample.cloud.points {
            *point = up.to_z_up(*point);
        }
        let cloud = sample.cloud;
        on_sample(SurfaceSample { cloud, of }, progress);
    }
    let thinning = settings.surface.thinning.is_some();
    let photos = source.photos.len();
    let stand_in = match &mut part {
        Some(part) => part.stand_in(&path, photos, thinning)?,
        None => None,
    };
    source.moving = stand_in.is_some().then(|| Moving {
        up,
        ..Moving::default()
    });
    let mut file = match stand_in {
        Some(file) => file,
        None => {
            let mut file = read_cloud(&path, progress)?;
            let points = file.cloud.points.len() as u64;
            file.warnings
                .extend(part.and_then(|part| part.exceeded(points)));
            file
        }
    };
    for point in &mut file.cloud.points {
        *point = up.to_z_up(*point);
    }
    if up != UpAxis::Z {
        file.facts = None;
    } else if let Some((said, doubt)) = turn_back(&mut file.cloud, source) {
        file.facts = None;
        file.warnings.push(said);
        source.doubts.extend(doubt);
    }
    // The package's own cloud is in the frame of its poses, unless it says otherwise.
    if let Some(similarity) = &source.package_surface_to_world
        && source.surface_is_packages
        && file.crs.is_none()
        && !file.geographic
    {
        for point in &mut file.cloud.points {
            *point = similarity.apply(*point);
        }
        file.facts = None;
        if let Some(moving) = &mut source.moving {
            moving.package = Some(*similarity);
        }
    }
    // In a frame of its own nothing says which way is up, and a mesh that meets its photos is not to be turned.
    let meets_photos = |mesh: &Cloud| {
        source.reconstruction.is_some()
            && source.poses_frame.is_as_it_is()
            && lies_before_photos(mesh, source)
    };
    if let Some((axis, along_axis, along_z)) = doubtful_up(&file.cloud)
        && !meets_photos(&file.cloud)
    {
        let (along_axis, along_z) = (100.0 * along_axis, 100.0 * along_z);
        source.doubtful_up = Some(axis);
        let axis = axis.name();
        file.warnings.push(format!(
            "seen along {axis}, {along_axis:.0} % of its area faces one way, along z {along_z:.0} %: where {axis} is up in the file, write up = \"{axis}\" below [surface] in a flight.toml, or --up {axis} behind the command (a steep wall looks the same)"
        ));
    }
    source.warn(&path, &file.warnings);
    source.inputs.push(path);
    Ok(Some(file))
}
