//! The ground truth of the EuRoC MAV dataset: `state_groundtruth_estimate0/data.csv`, and others of
//! the ASL format (`vicon0`, TUM-VI's `mocap0`).
//!
//! Written from Burri et al., "The EuRoC micro aerial vehicle datasets" (2016), and the header that
//! each file carries:
//!
//! ```text
//! #timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], ...
//! 1403715524907143168,0.515356,1.996773,0.971104,0.161996,0.789985,-0.205376,0.554528,...
//! ```
//!
//! Whole nanoseconds; p and q are the position and the rotation of the sensor S in the reference R:
//! `world_from_body`, the body being the IMU. Velocities and biases behind them are passed over. The
//! columns are found by the beginning and the end of their names, so that they may come in any order.
//!
//! A camera's place on the body is `T_BS` of its own `sensor.yaml` (see `camera_file`), which the
//! flight names as its camera.

use std::io::BufRead;

use glam::DVec3;

use super::TrajectoryPose;
use super::stamp::Stamp;
use crate::camera::Pose;
use crate::fault::Fault;
use crate::text::fields::shown;
use crate::text::text_lines::TextLines;

/// Whether a line is the header of a file of positions.
pub(super) fn is_header(line: &str) -> bool {
    let names: Vec<&str> = names(line).collect();
    let first = names.first().is_some_and(|name| {
        let name = name.trim_start_matches(['#', ' ']);
        name.eq_ignore_ascii_case("timestamp")
    });
    first && column(&names, "p_", "_x").is_some()
}

/// The names of a header's columns, without their units.
fn names(header: &str) -> impl Iterator<Item = &str> {
    header
        .split(',')
        .map(|name| name.split('[').next().unwrap_or_default().trim())
}

fn column(names: &[&str], begin: &str, end: &str) -> Option<usize> {
    names
        .iter()
        .position(|name| name.starts_with(begin) && name.ends_with(end))
}

pub(super) fn read(mut lines: TextLines<impl BufRead>) -> Result<Vec<TrajectoryPose>, Fault> {
    let header = lines.next_line()?.unwrap_or_default();
    let names: Vec<&str> = names(header).collect();
    let find = |begin: &str, axis: &str| {
        column(&names, begin, axis).ok_or_else(|| {
            Fault::at(
                1,
                format!("there is no column {begin}...{axis}"),
                "give a trajectory of poses, such as state_groundtruth_estimate0/data.csv",
            )
        })
    };
    let columns = [
        find("p_", "_x")?,
        find("p_", "_y")?,
        find("p_", "_z")?,
        find("q_", "_x")?,
        find("q_", "_y")?,
        find("q_", "_z")?,
        find("q_", "_w")?,
    ];
    let mut poses = Vec::new();
    loop {
        let number = lines.line() + 1;
        let Some(line) = lines.next_line()? else {
            break;
        };
        if !line.trim().is_empty() && !line.starts_with('#') {
            poses.push(pose(number, line, &columns)?);
        }
    }
    Ok(poses)
}

fn pose(line: u64, text: &str, columns: &[usize; 7]) -> Result<TrajectoryPose, Fault> {
    let fault = |what: String| Fault::at(line, what, "correct or remove the line");
    let words: Vec<&str> = text.split(',').map(str::trim).collect();
    let stamp = words.first().copied().unwrap_or_default();
    // In this format a stamp counts nanoseconds, however small it is.
    let key = stamp.parse().map(Stamp).map_err(|_| {
        fault(format!(
            "the timestamp '{}' is no whole number of nanoseconds",
            shown(stamp)
        ))
    })?;
    let mut values = [0.0; 7];
    for (value, &column) in values.iter_mut().zip(columns) {
        let word = words.get(column).copied().unwrap_or_default();
        *value = word
            .parse()
            .ok()
            .filter(|n: &f64| n.is_finite())
            .ok_or_else(|| {
                let place = column + 1;
                fault(format!(
                    "column {place}: '{}' is not a finite number",
                    shown(word)
                ))
            })?;
    }
    let [x, y, z, quaternion @ ..] = values;
    let pose = Pose::from_quaternion(DVec3::new(x, y, z), quaternion)
        .map_err(|error| fault(error.to_string()))?;
    Ok(TrajectoryPose {
        name: stamp.to_owned(),
        key,
        pose,
    })
}
