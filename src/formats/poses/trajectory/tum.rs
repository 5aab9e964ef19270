//! The trajectory format of the TUM RGB-D benchmark.
//!
//! Written from "File Formats" of the benchmark's page (cvg.cit.tum.de/data/datasets/rgbd-dataset/
//! file_formats) and its `associate.py`, which takes commas and tabs for spaces, and from evo's wiki:
//!
//! ```text
//! # comment
//! timestamp tx ty tz qx qy qz qw      seconds (or, from ORB-SLAM3, nanoseconds); metres
//! ```
//!
//! The pose is that of the "optical center of the color camera with respect to the world origin":
//! `world_from_camera`. The page is about a Kinect whose axes are right, down, forward; the format
//! itself says nothing of axes, and odometry programs write bodies into it too. The camera's optical
//! frame is assumed, and said.

use std::io::BufRead;

use glam::DVec3;

use super::TrajectoryPose;
use super::stamp::Stamp;
use crate::camera::Pose;
use crate::fault::Fault;
use crate::text::fields::{Fields, shown};
use crate::text::text_lines::TextLines;

const REMEDY: &str = "write each line as: timestamp tx ty tz qx qy qz qw";

/// How far a quaternion's length may be from 1 where a file is to be recognised by it: four decimals
/// make it 1e-4.
const UNIT: f64 = 1e-3;

/// Whether all lines are a time and a pose.
pub(super) fn looks_like(lines: &[&str]) -> bool {
    let mut before = None;
    !lines.is_empty()
        && lines.iter().all(|line| {
            let words: Vec<&str> = words(line).collect();
            let [stamp, x, y, z, quaternion @ ..] = &words[..] else {
                return false;
            };
            let is_finite = |word: &&str| word.parse().is_ok_and(f64::is_finite);
            let Some(stamp) = Stamp::parse(stamp) else {
                return false;
            };
            let increases = before.replace(stamp).is_none_or(|before| before < stamp);
            increases
                && [x, y, z].into_iter().all(is_finite)
                && quaternion.len() == 4
                && (length(quaternion) - 1.0).abs() < UNIT
        })
}

fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| c.is_whitespace() || c == ',')
        .filter(|word| !word.is_empty())
}

/// NaN where a word is no number.
fn length(words: &[&str]) -> f64 {
    let squares = words
        .iter()
        .map(|word| word.parse::<f64>().map_or(f64::NAN, |q| q * q));
    squares.sum::<f64>().sqrt()
}

pub(super) fn read(mut lines: TextLines<impl BufRead>) -> Result<Vec<TrajectoryPose>, Fault> {
    let mut poses = Vec::new();
    loop {
        let number = lines.line() + 1;
        let Some(line) = lines.next_line()? else {
            break;
        };
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let text = line.replace(',', " ");
        poses.push(pose(Fields::new(number, &text, REMEDY))?);
    }
    Ok(poses)
}

fn pose(mut fields: Fields<'_>) -> Result<TrajectoryPose, Fault> {
    let word = fields.word("the timestamp")?;
    let Some(key) = Stamp::parse(word) else {
        return Err(fields.fault(format!("the timestamp is '{}', not a time", shown(word))));
    };
    let center: DVec3 = fields.triple("the position")?;
    let mut quaternion = [0.0; 4];
    for (q, name) in quaternion.iter_mut().zip(["qx", "qy", "qz", "qw"]) {
        *q = fields.number(name)?;
    }
    if !fields.rest().is_empty() {
        return Err(fields.fault(format!("'{}' stands behind qw", shown(fields.rest()))));
    }
    let pose = Pose::from_quaternion(center, quaternion)
        .map_err(|error| fields.fault(error.to_string()))?;
    let name = if word.contains(['e', 'E']) {
        key.to_string()
    } else {
        word.to_owned()
    };
    Ok(TrajectoryPose { name, key, pose })
}
