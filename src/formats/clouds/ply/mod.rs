//! PLY, the Stanford polygon format: "The PLY Polygon File Format", Greg Turk (1994), with the type
//! names that later programs added (int8 ... float64).
//!
//! - A text header names elements, each with a count and its properties in order; then come the
//!   elements as ascii, or binary in either byte order.
//! - `vertex` has x, y, z of any number type; colours are red, green, blue (or r, g, b, or with
//!   `diffuse_` in front) as 8-bit or 16-bit integers, or as floats from 0 to 1. Properties come in
//!   any order (OpenDroneMap's filtered cloud has red, blue, green) and are found by name; others
//!   are passed over.
//! - `face` has the list `vertex_indices` or `vertex_index`; polygons become fans.
//!
//! Header and elements are parsed by ply-rs-bw, one element at a time, so that a header that claims
//! too much costs nothing.

mod elements;
mod face;
mod header;
mod vertex;

use std::io::BufRead;

use ply_rs_bw::ply::PropertyAccess;

use self::elements::Skipped;
use self::face::Face;
use self::header::read_header;
use self::vertex::{Vertex, VertexLayout};
use crate::clouds::cloud_file::{CloudFile, first_not_finite};
use crate::fault::Fault;
use crate::jobs::Progress;

pub(crate) use self::vertex::number;

/// Reads a PLY file.
///
/// # Errors
/// Where it is no PLY file, is cut off, has no vertices with x, y, z, or a coordinate that is not finite (NaN
/// marks missing points where there are no faces).
pub(crate) fn read(input: impl BufRead, progress: &Progress) -> Result<CloudFile, Fault> {
    let (header, mut input) = read_header(input)?;
    let mut file = CloudFile::default();
    let mut has_vertices = false;
    let mut faces = header.elements.iter().filter(|(name, _)| *name == "face");
    let has_faces = faces.any(|(_, element)| element.count > 0);
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => {
                let layout = VertexLayout::of(element)?;
                has_vertices = true;
                input.read_all(element, progress, |vertex: Vertex| {
                    file.cloud.points.push(vertex.position);
                    if layout.colors {
                        file.cloud.colors.push(vertex.color);
                    }
                    Ok(())
                })?;
                if !has_faces {
                    file.leave_out_missing();
                    file.expect_points()?;
                }
                if let Some(index) = first_not_finite(&file.cloud.points) {
                    return Err(Fault::new(
                        format!(
                            "vertex {index} (counted from 0) has a coordinate that is not a finite number"
                        ),
                        "remove such vertices before exporting",
                    ));
                }
                if layout.floats {
                    file.warn_if_rounded();
                }
            }
            "face" => {
                input.read_all(element, progress, |face: Face| {
                    file.cloud.add_polygon(&face.corners?);
                    Ok(())
                })?;
            }
            "tristrips" => {
                return Err(Fault::new(
                    "its faces are triangle strips",
                    "export plain faces",
                ));
            }
            _ => input.read_all(element, progress, |_: Skipped| Ok(()))?,
        }
    }
    file.warnings.extend(input.left_out()?);
    if !has_vertices {
        return Err(Fault::new("it has no vertex element", "export points"));
    }
    // Here and not with each face: faces may stand before the vertices.
    let count = file.cloud.points.len();
    let mut corners = file.cloud.triangles.iter().flatten();
    if let Some(corner) = corners.find(|&&corner| corner as usize >= count) {
        return Err(Fault::new(
            format!("a face names vertex {corner}, but there are {count}, counted from 0"),
            "export the mesh again",
        ));
    }
    Ok(file)
}

/// Reads records of another kind than points: what their vertices hold.
///
/// # Errors
/// As [`read`], and those of `take`.
pub(crate) fn read_vertices<E: PropertyAccess>(
    input: impl BufRead,
    mut take: impl FnMut(E) -> Result<(), Fault>,
) -> Result<(), Fault> {
    let (header, mut input) = read_header(input)?;
    let progress = Progress::default();
    for (name, element) in &header.elements {
        match name.as_str() {
            "vertex" => input.read_all(element, &progress, &mut take)?,
            _ => input.read_all(element, &progress, |_: Skipped| Ok(()))?,
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
