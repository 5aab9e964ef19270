//! `*_calibrated_external_camera_parameters.txt`, `*_offset.xyz` and `*_pmatrix.txt`: one line a
//! photo, or one line alone.

use glam::{DMat3, DVec3};

use crate::camera::Pose;
use crate::fault::Fault;
use crate::text::fields::Fields;

const EXPORT: &str = "let Pix4D write its params folder again (Process > Reoptimize)";

/// Reads `imageName X Y Z Omega Phi Kappa`: name and pose in the world, in the file's order.
///
/// # Errors
/// With the line that is not of that form.
pub(super) fn read_poses(text: &str) -> Result<Vec<(String, Pose)>, Fault> {
    let mut photos = Vec::new();
    let mut lines = numbered(text).peekable();
    // Some versions add columns of standard deviations behind the angles.
    let header = lines.next_if(|(_, line)| line.trim_start().starts_with("imageName"));
    let columns = header.map_or(6, |(_, line)| line.split_whitespace().count() - 1);
    if columns < 6 {
        let what = "its header has fewer columns than imageName X Y Z Omega Phi Kappa";
        return Err(Fault::at(1, what, EXPORT));
    }
    for (line, text) in lines {
        let (name, numbers) = split_name(line, text, columns)?;
        let mut fields = Fields::new(line, numbers, EXPORT);
        let center = fields.triple("X Y Z")?;
        let angles = fields.triple("Omega Phi Kappa")?;
        let pose = Pose::from_omega_phi_kappa(center, angles.to_array());
        photos.push((name.to_owned(), pose));
    }
    if photos.is_empty() {
        return Err(Fault::new("it holds no photo", EXPORT));
    }
    Ok(photos)
}

/// Reads the one line of `*_offset.xyz`.
///
/// # Errors
/// Where it is not three numbers.
pub(super) fn read_offset(text: &str) -> Result<DVec3, Fault> {
    let (line, text) = numbered(text)
        .next()
        .ok_or_else(|| Fault::new("it is empty", EXPORT))?;
    Fields::new(line, text, EXPORT).triple("the offset")
}

/// The 3x4 matrix that takes world coordinates, less the offset, to undistorted pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ProjectionMatrix {
    left: DMat3,
    last: DVec3,
}

impl ProjectionMatrix {
    /// The undistorted pixel of a point.
    pub(super) fn pixel(&self, point: DVec3) -> glam::DVec2 {
        let p = self.left * point + self.last;
        p.truncate() / p.z
    }
}

/// Reads `*_pmatrix.txt`: a name and twelve numbers, row-major, a photo.
///
/// # Errors
/// With the line that is not of that form.
pub(super) fn read_matrices(text: &str) -> Result<Vec<(String, ProjectionMatrix)>, Fault> {
    numbered(text)
        .map(|(line, text)| {
            let (name, numbers) = split_name(line, text, 12)?;
            let mut fields = Fields::new(line, numbers, EXPORT);
            let mut rows = [DVec3::ZERO; 3];
            let mut last = DVec3::ZERO;
            for (index, row) in rows.iter_mut().enumerate() {
                *row = fields.triple("the matrix")?;
                last[index] = fields.number("the matrix")?;
            }
            let [x, y, z] = rows;
            let left = DMat3::from_cols(x, y, z).transpose();
            Ok((name.to_owned(), ProjectionMatrix { left, last }))
        })
        .collect()
}

fn numbered(text: &str) -> impl Iterator<Item = (u64, &str)> {
    (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty())
}

/// The name, which may have spaces, in front of `count` fields.
fn split_name(line: u64, text: &str, count: usize) -> Result<(&str, &str), Fault> {
    let text = text.trim();
    let mut name = text;
    for _ in 0..count {
        name = name
            .rsplit_once(char::is_whitespace)
            .map(|(before, _)| before.trim_end())
            .ok_or_else(|| {
                let what =
                    format!("a line is a photo's name and {count} numbers, this one is shorter");
                Fault::at(line, what, EXPORT)
            })?;
    }
    Ok((name, text.get(name.len()..).unwrap_or_default()))
}
