//! Trajectories: the poses of one moving camera or body, over time or frame by frame.
//!
//! | | a line | moves | key |
//! |---|---|---|---|
//! | TUM (`tum.rs`) | `t tx ty tz qx qy qz qw` | a camera, as is assumed | seconds |
//! | EuRoC (`euroc.rs`) | `t, p x y z, q w x y z, ...` | the body (its IMU) | nanoseconds |
//! | KITTI (`kitti.rs`) | 12 numbers, a 3x4 matrix by rows | a camera | the line's number, from 0 |
//!
//! All three write `world_from_moving` in the frame of whoever made the file, in metres. They are
//! told from clouds by their content: TUM by quaternions of length 1 and increasing stamps on every
//! line looked at, KITTI by its rotations, EuRoC by its header.
//!
//! A trajectory names no photos. A flight takes it as `[photos] poses` beside `folder`: every image
//! file there whose name is a time (seconds, or nanoseconds without a point: `1305031102.175304.png`,
//! `1403715273262142976.png`) gets its pose by `track.rs`; with KITTI the name is the line's number
//! (`000000.png`).

mod euroc;
mod kitti;
mod photos;
mod stamp;
mod track;
mod tum;

use std::cmp::Ordering;
use std::io::BufRead;

pub use photos::PosedFiles;
pub(crate) use photos::{pose_photos, stamp_of};
pub(crate) use stamp::Stamp;
pub(crate) use track::{NoPose, Track};

use crate::camera::Pose;
use crate::fault::Fault;
use crate::text::text_lines::TextLines;

/// A format of trajectories.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrajectoryFormat {
    /// Of the TUM RGB-D benchmark.
    Tum,
    /// Of the EuRoC MAV dataset: the ground truth's data.csv.
    Euroc,
    /// Of KITTI's odometry benchmark.
    Kitti,
}

impl TrajectoryFormat {
    /// Whether the poses are those of a body that cameras are mounted on, not of a camera.
    pub fn is_of_body(self) -> bool {
        self == Self::Euroc
    }

    /// What its poses leave open, for people.
    pub fn caveat(self) -> &'static str {
        match self {
            Self::Tum => {
                "a TUM trajectory does not say which axes move: they are taken for a camera's (x right, y down, z forward)"
            }
            Self::Euroc => {
                "these are poses of the body (its IMU), not of a camera; a flight needs the camera's sensor.yaml, whose T_BS leads from one to the other"
            }
            Self::Kitti => {
                "the world of KITTI poses is the first camera (y down, z forward) unless somebody turned it; fragscale needs z up"
            }
        }
    }
}

/// A pose of a trajectory.
#[derive(Debug, Clone, PartialEq)]
pub struct TrajectoryPose {
    /// Its stamp as the file writes it (an exponent written out), or for KITTI the line's number,
    /// from 0, with six digits.
    pub name: String,
    /// The time, or for KITTI the line's number.
    key: Stamp,
    /// In the trajectory's frame.
    pub pose: Pose,
}

/// A trajectory as its file has it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// What wrote it.
    pub format: TrajectoryFormat,
    /// In the file's order.
    pub poses: Vec<TrajectoryPose>,
    /// What is wrong with the file's order, one sentence each.
    pub warnings: Vec<String>,
}

impl Trajectory {
    /// Gives every image file that is named by a time, or for KITTI by a number, its pose.
    ///
    /// # Errors
    /// Where no file gets one.
    pub fn pose_files(&self, files: &[String]) -> Result<PosedFiles, Fault> {
        match self.format {
            TrajectoryFormat::Kitti => photos::pose_numbered(files, &self.poses),
            TrajectoryFormat::Tum | TrajectoryFormat::Euroc => {
                let track = Track::new(self.poses.iter().map(|p| (p.key, p.pose)).collect());
                pose_photos(files, track.span(), |stamp| track.at(stamp))
            }
        }
    }
}

/// Recognises a trajectory by the first bytes of its file, at most 4096; `whole` says that they are
/// all of it, so that the last line is not cut off.
pub fn recognise(start: &str, whole: bool, name: &str) -> Option<TrajectoryFormat> {
    let complete = match start.rfind('\n') {
        Some(end) if !whole => start.get(..end)?,
        _ => start,
    };
    if euroc::is_header(complete.lines().next()?) {
        return Some(TrajectoryFormat::Euroc);
    }
    let lines: Vec<&str> = complete
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .collect();
    // One line proves little.
    let few = lines.len() < 2;
    if kitti::looks_like(&lines) {
        return Some(TrajectoryFormat::Kitti);
    }
    let says_so = name.ends_with(".tum") || complete.contains("timestamp tx ty tz qx qy qz qw");
    if says_so || (!few && tum::looks_like(&lines)) {
        return Some(TrajectoryFormat::Tum);
    }
    None
}

/// Reads a trajectory.
///
/// # Errors
/// With the line of what is wrong.
pub fn read(format: TrajectoryFormat, input: impl BufRead) -> Result<Trajectory, Fault> {
    let lines = TextLines::new(input);
    let poses = match format {
        TrajectoryFormat::Tum => tum::read(lines),
        TrajectoryFormat::Euroc => euroc::read(lines),
        TrajectoryFormat::Kitti => kitti::read(lines),
    }?;
    if poses.is_empty() {
        return Err(Fault::new("it has no poses", "give a line for each pose"));
    }
    Ok(Trajectory {
        format,
        warnings: disorder(&poses),
        poses,
    })
}

/// Counts stamps that go back or stand twice.
fn disorder(poses: &[TrajectoryPose]) -> Vec<String> {
    let (mut back, mut twice) = (0_usize, 0_usize);
    for (before, after) in poses.iter().zip(poses.iter().skip(1)) {
        match before.key.cmp(&after.key) {
            Ordering::Less => {}
            Ordering::Equal => twice += 1,
            Ordering::Greater => back += 1,
        }
    }
    let mut warnings = Vec::new();
    if back > 0 {
        warnings.push(format!(
            "{back} stamps are older than the one in front of them; the poses are sorted by time where photos take them"
        ));
    }
    if twice > 0 {
        warnings.push(format!(
            "{twice} stamps stand twice in a row; photos take the first pose of each"
        ));
    }
    warnings
}

#[cfg(test)]
mod tests;
