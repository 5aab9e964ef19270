//! Open3D's trajectory `.log`, as its Redwood data sets have it (redwood-data.org/indoor/fileformat.html,
//! `cpp/open3d/io/file_format/FileLOG.cpp`).
//!
//! ```text
//! <id> <id> <number>       one or three numbers; the first is the frame's
//! <4x4 matrix>             four lines of four, row-major: world_from_camera
//! ```
//!
//! Camera axes are x right, y down, z forward. There are no intrinsics and no names, so it serves as
//! the poses of a flight.toml; the photos are called by their number from 0 in the order of the file.

use glam::{DMat3, DVec3};

use super::NUMBERED;
use crate::camera::Pose;
use crate::fault::Fault;
use crate::poses::poses_csv::{PoseLine, PosesFile};
use crate::poses::rounded_rotation::{from_row_major, rounded_rotation};
use crate::scale::PoseErrors;
use crate::text::fields::Fields;

const WRITE: &str = "write the trajectory again with Open3D";

/// Whether a text that begins so is a trajectory: whole numbers, then the four lines of a 4x4, of which
/// the last is 0 0 0 1. (A cloud may begin with the count of its points as well.)
pub(crate) fn is_log(start: &str) -> bool {
    let mut lines = start.lines().filter(|line| !line.trim().is_empty());
    let numbers = |line: &str| -> Option<Vec<f64>> {
        line.split_whitespace()
            .map(|word| word.parse().ok())
            .collect()
    };
    let is_id = |word: &str| word.parse::<i64>().is_ok();
    let is_head = |head: &str| {
        matches!(head.split_whitespace().count(), 1 | 3) && head.split_whitespace().all(is_id)
    };
    if !lines.next().is_some_and(is_head) {
        return false;
    }
    let rows: Vec<_> = lines.take(4).map(numbers).collect();
    match rows.as_slice() {
        [Some(a), Some(b), Some(c), Some(last)] => {
            [a, b, c].iter().all(|row| row.len() == 4) && last == &[0.0, 0.0, 0.0, 1.0]
        }
        _ => false,
    }
}

/// Reads the poses.
///
/// # Errors
/// With the line: what is no number, no rotation, or breaks off.
pub(crate) fn read_log(text: &str) -> Result<PosesFile, Fault> {
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty());
    let mut poses = Vec::new();
    let mut ids_differ = false;
    while let Some((line, head)) = lines.next() {
        let mut fields = Fields::new(line, head, WRITE);
        let id: i64 = fields.whole("the number of the frame")?;
        ids_differ |= usize::try_from(id) != Ok(poses.len());
        let mut matrix = [[0.0; 4]; 4];
        for row in &mut matrix {
            let Some((number, text)) = lines.next() else {
                let what = "the file ends within the matrix that begins here";
                return Err(Fault::at(line, what, WRITE));
            };
            let mut fields = Fields::new(number, text, WRITE);
            for entry in row {
                *entry = fields.number("an entry of the matrix")?;
            }
            if !fields.rest().is_empty() {
                return Err(fields.fault("a row of the matrix has more than four numbers"));
            }
        }
        let [[a, b, c, x], [d, e, f, y], [g, h, i, z], last] = matrix;
        if last != [0.0, 0.0, 0.0, 1.0] {
            return Err(Fault::at(
                line,
                "the last row of its matrix is not 0 0 0 1",
                WRITE,
            ));
        }
        let rotation: DMat3 = from_row_major([a, b, c, d, e, f, g, h, i]);
        let rotation =
            rounded_rotation(rotation).map_err(|e| Fault::at(line, e.to_string(), WRITE))?;
        poses.push(PoseLine {
            photo: poses.len().to_string(),
            camera: None,
            pose: Pose {
                rotation,
                center: DVec3::new(x, y, z),
            },
            errors: PoseErrors::default(),
            line,
        });
    }
    if poses.is_empty() {
        return Err(Fault::new("it holds no pose", WRITE));
    }
    let mut warnings = vec![NUMBERED.to_owned()];
    if ids_differ {
        warnings.push("the frames' own numbers are others than that".to_owned());
    }
    Ok(PosesFile {
        lines: poses,
        warnings,
        ..PosesFile::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = "0 0 1\n0 0 1 5\n-1 0 0 6\n0 -1 0 7\n0 0 0 1\n\r\n1 1 2\r\n1 0 0 0\r\n0 1 0 0\r\n0 0 1 0\r\n0 -0 0 1\r\n";

    #[test]
    fn matrices_are_row_major_world_from_camera() {
        assert!(is_log(TWO));
        let found = read_log(TWO).unwrap();
        let [first, second] = &found.lines[..] else {
            panic!("two poses")
        };
        assert_eq!(first.pose.center, DVec3::new(5.0, 6.0, 7.0));
        assert_eq!(
            first.pose.rotation,
            DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X)
        );
        assert_eq!((second.photo.as_str(), second.line), ("1", 7));
        assert_eq!(found.warnings.len(), 1);
        let warnings = read_log(&TWO.replacen("1 1 2", "7", 1)).unwrap().warnings;
        assert!(warnings[1].contains("others"), "{warnings:?}");
    }

    #[test]
    fn what_is_wrong_is_placed() {
        for (from, to, line) in [
            ("0 0 1\n", "a 0 1\n", 1),
            ("-1 0 0 6", "-1 0 0", 3),
            ("-1 0 0 6", "-1 0 0 6 7", 3),
            ("-1 0 0 6", "-1 0 inf 6", 3),
            ("-1 0 0 6", "-1 0.1 0 6", 1),
            ("-1 0 0 6", "1 0 0 6", 1),
            ("0 -0 0 1", "0 0 0 2", 7),
            ("0 -0 0 1\r\n", "", 7),
        ] {
            assert!(TWO.contains(from), "{from}");
            assert_eq!(
                read_log(&TWO.replacen(from, to, 1)).unwrap_err().line,
                Some(line),
                "{to}"
            );
        }
        assert!(read_log("").is_err());
        for text in [
            "",
            "1 2\n1 2 3 4",
            "0 0 1\n1 2 3",
            "a\n1 2 3 4",
            "# Bundle file v0.3\n1 2 3 4",
        ] {
            assert!(!is_log(text), "{text}");
        }
        for cut in 0..TWO.len() {
            let _ = read_log(&TWO[..cut]);
        }
    }
}
