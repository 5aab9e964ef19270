//! The image files that a trajectory's poses belong to, by their names.

use std::collections::HashMap;

use super::TrajectoryPose;
use super::stamp::Stamp;
use super::track::NoPose;
use crate::camera::Pose;
use crate::fault::Fault;
use crate::files::stem;

/// Image files with their poses, and what became of the others.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PosedFiles {
    /// File name and pose, in the files' order.
    pub photos: Vec<(String, Pose)>,
    /// Files without a pose, counted.
    pub warnings: Vec<String>,
}

/// The time that a file is named by: digits, perhaps with a point.
pub(crate) fn stamp_of(file: &str) -> Option<Stamp> {
    let stem = stem(file);
    let is_plain = stem.bytes().all(|b| b.is_ascii_digit() || b == b'.');
    Stamp::parse(stem).filter(|_| is_plain)
}

/// Gives every file that is named by a time its pose. `span` is what the poses cover, for the fault.
///
/// # Errors
/// Where no file gets one.
pub(crate) fn pose_photos(
    files: &[String],
    span: Option<(Stamp, Stamp)>,
    pose_at: impl Fn(Stamp) -> Result<Pose, NoPose>,
) -> Result<PosedFiles, Fault> {
    let mut posed = PosedFiles::default();
    let (mut unnamed, mut without) = (Vec::new(), Vec::new());
    for file in files {
        match stamp_of(file).map(&pose_at) {
            None => unnamed.push(file.as_str()),
            Some(Ok(pose)) => posed.photos.push((file.clone(), pose)),
            Some(Err(reason)) => without.push((file.as_str(), reason)),
        }
    }
    let count = files.len();
    if posed.photos.is_empty() {
        let covers = span.map_or_else(
            || "nothing".to_owned(),
            |(first, last)| format!("{first} s to {last} s"),
        );
        let what = match (without.first(), unnamed.first()) {
            (Some((file, reason)), _) => {
                format!(
                    "none of {count} image files has a pose ('{file}': {reason}); the poses cover {covers}"
                )
            }
            (None, Some(file)) => {
                format!(
                    "none of {count} image files is named by a time ('{file}'); the poses cover {covers}"
                )
            }
            (None, None) => "there are no image files to give poses to".to_owned(),
        };
        return Err(Fault::new(
            what,
            "name as [photos] folder the image files of this recording, called by their stamps as 1305031102.175304.png or 1403715273262142976.png",
        ));
    }
    if let Some(file) = unnamed.first() {
        posed.warnings.push(format!(
            "{} of {count} image files are not named by a time ('{file}') and are left out",
            unnamed.len()
        ));
    }
    if let Some((file, reason)) = without.first() {
        posed.warnings.push(format!(
            "{} of {count} image files have no pose and are left out: '{file}', for one: {reason}",
            without.len()
        ));
    }
    Ok(posed)
}

/// Gives every file that is named by a number the pose of that number.
///
/// # Errors
/// Where no file gets one.
pub(super) fn pose_numbered(
    files: &[String],
    poses: &[TrajectoryPose],
) -> Result<PosedFiles, Fault> {
    let mut posed = PosedFiles::default();
    let mut taken: HashMap<usize, &str> = HashMap::new();
    let mut without = Vec::new();
    for file in files {
        let stem = stem(file);
        let is_plain = !stem.is_empty() && stem.bytes().all(|b| b.is_ascii_digit());
        let index = stem.parse::<usize>().ok().filter(|_| is_plain);
        let Some((index, pose)) = index.and_then(|index| Some((index, poses.get(index)?))) else {
            without.push(file.as_str());
            continue;
        };
        if let Some(other) = taken.insert(index, file) {
            return Err(Fault::new(
                format!(
                    "'{other}' and '{file}' are both the photo of line {}",
                    index + 1
                ),
                "keep one of the two in the folder",
            ));
        }
        posed.photos.push((file.clone(), pose.pose));
    }
    let count = files.len();
    let Some(file) = without.first() else {
        if count == 0 {
            return Err(Fault::new(
                "there are no image files to give poses to",
                "name their folder as [photos] folder",
            ));
        }
        return Ok(posed);
    };
    let rule = format!(
        "named by its line, 000000 to {:06}",
        poses.len().saturating_sub(1)
    );
    if posed.photos.is_empty() {
        return Err(Fault::new(
            format!("none of {count} image files is {rule} ('{file}')"),
            "name as [photos] folder the image files of this sequence, called 000000.png and so on",
        ));
    }
    posed.warnings.push(format!(
        "{} of {count} image files are not {rule} ('{file}') and are left out",
        without.len()
    ));
    Ok(posed)
}
