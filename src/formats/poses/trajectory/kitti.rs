//! The poses of KITTI's odometry benchmark: `poses/00.txt`.
//!
//! Written from the benchmark's devkit (readme.txt, "Format of the Evaluation"):
//!
//! ```text
//! r11 r12 r13 tx r21 r22 r23 ty r31 r32 r33 tz      the upper three rows of a 4x4 matrix
//! ```
//!
//! One line a frame, without a stamp: line n (from 0) is the photo `00000n.png`. The matrix takes
//! the (left, grey) camera's axes, x right, y down, z forward, to those of the first frame; so the
//! world's y points down unless somebody turned it. The matrices carry 7 digits at best: they are
//! made orthonormal. The devkit's `times.txt` is not needed.

use std::io::BufRead;

use glam::{DMat3, DQuat, DVec3};

use super::TrajectoryPose;
use super::stamp::Stamp;
use crate::camera::Pose;
use crate::fault::Fault;
use crate::text::fields::Fields;
use crate::text::text_lines::TextLines;

const REMEDY: &str = "write the 12 numbers of a 3x4 pose by rows on each line";

/// How far the products of the matrix's columns may be from those of a rotation's: files with three
/// decimals exist.
const ORTHONORMAL: f64 = 1e-3;

/// Whether all lines are 3x4 matrices with a rotation.
pub(super) fn looks_like(lines: &[&str]) -> bool {
    !lines.is_empty() && lines.iter().all(|line| pose(0, line).is_ok())
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
        let index = poses.len();
        poses.push(TrajectoryPose {
            name: format!("{index:06}"),
            // A file has fewer lines than bytes.
            key: Stamp(i64::try_from(index).unwrap_or(i64::MAX)),
            pose: pose(number, line)?,
        });
    }
    Ok(poses)
}

fn pose(line: u64, text: &str) -> Result<Pose, Fault> {
    let mut fields = Fields::new(line, text, REMEDY);
    let mut rows = [[0.0; 4]; 3];
    for number in rows.as_flattened_mut() {
        *number = fields.number("one of the 12 numbers")?;
    }
    if !fields.rest().is_empty() {
        return Err(fields.fault("there are more than 12 numbers"));
    }
    let [x, y, z] = rows.map(|[x, y, z, _]| DVec3::new(x, y, z));
    let given = DMat3::from_cols(x, y, z).transpose();
    let product = (given.transpose() * given - DMat3::IDENTITY).to_cols_array();
    let worst = product.iter().fold(0.0, |worst: f64, d| worst.max(d.abs()));
    if worst.is_nan() || worst > ORTHONORMAL || given.determinant() < 0.0 {
        return Err(fields.fault(format!(
            "its 3x3 part is no rotation (off by {worst:.1e}, determinant {:.3})",
            given.determinant()
        )));
    }
    Ok(Pose {
        rotation: DMat3::from_quat(DQuat::from_mat3(&given).normalize()),
        center: DVec3::from_array(rows.map(|[.., t]| t)),
    })
}
