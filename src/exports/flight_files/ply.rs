//! PLY, binary little endian (Greg Turk, "The PLY Polygon File Format", 1994): coordinates as
//! doubles, so that they read back to the last bit; `red green blue` as uchar where the cloud has
//! colours; faces as `list uchar uint vertex_indices` where it has triangles.

use crate::fault::one_line;
use crate::surface::Cloud;

/// The cloud as a PLY file. The comment is folded to one line; an empty one is left out.
///
/// # Errors
/// Where there is not one colour a point (or none at all), or a triangle names no point.
pub fn ply(cloud: &Cloud, comment: &str) -> Result<Vec<u8>, String> {
    let Cloud {
        points,
        colors,
        triangles,
    } = cloud;
    let count = points.len();
    if !colors.is_empty() && colors.len() != count {
        return Err(format!("{} colours for {count} points", colors.len()));
    }
    if let Some(corner) = triangles.iter().flatten().find(|&&c| c as usize >= count) {
        return Err(format!("a triangle names point {corner} of {count}"));
    }
    let mut header = String::from("ply\nformat binary_little_endian 1.0\n");
    let comment = one_line(comment);
    if !comment.is_empty() {
        header += &format!("comment {comment}\n");
    }
    header += &format!("element vertex {count}\n");
    for axis in ["x", "y", "z"] {
        header += &format!("property double {axis}\n");
    }
    if !colors.is_empty() {
        for channel in ["red", "green", "blue"] {
            header += &format!("property uchar {channel}\n");
        }
    }
    if !triangles.is_empty() {
        let faces = triangles.len();
        header += &format!("element face {faces}\nproperty list uchar uint vertex_indices\n");
    }
    header += "end_header\n";

    let mut bytes = header.into_bytes();
    bytes.reserve(count * 27 + triangles.len() * 13);
    let mut colors = colors.iter();
    for point in points {
        for coordinate in point.to_array() {
            bytes.extend(coordinate.to_le_bytes());
        }
        bytes.extend(colors.next().into_iter().flatten());
    }
    for triangle in triangles {
        bytes.push(3);
        for corner in triangle {
            bytes.extend(corner.to_le_bytes());
        }
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::jobs::Progress;
    use fragscale_formats::{CloudFile, read_cloud};
    use fragscale_test_data::written;

    fn cloud(colors: bool, faces: bool) -> Cloud {
        Cloud {
            points: vec![
                DVec3::new(500_000.123_456_789, 5_000_000.1, -0.0),
                DVec3::new(1.0 / 3.0, f64::MIN_POSITIVE, 1e300),
                DVec3::new(2.0, 3.0, 4.0),
            ],
            colors: if colors {
                vec![[0, 127, 255], [1, 2, 3], [10, 13, 32]]
            } else {
                Vec::new()
            },
            triangles: if faces { vec![[2, 0, 1]] } else { Vec::new() },
        }
    }

    #[test]
    fn reads_back_to_the_last_bit() {
        for (colors, faces) in [(false, false), (true, false), (false, true), (true, true)] {
            let cloud = cloud(colors, faces);
            let bytes = ply(&cloud, "two\nlines of Größe").unwrap();
            assert_eq!(ply(&cloud, "two\nlines of Größe").unwrap(), bytes);
            let (_folder, path) = written("a.ply", bytes);
            let file = read_cloud(&path, &Progress::default()).unwrap();
            let expected = CloudFile {
                cloud,
                ..CloudFile::default()
            };
            assert_eq!(file, expected);
        }
        assert!(ply(&Cloud::default(), "").is_ok());
    }

    #[test]
    fn parts_that_do_not_fit_are_refused() {
        let mut one_color = cloud(true, true);
        one_color.colors.truncate(1);
        assert_eq!(ply(&one_color, "").unwrap_err(), "1 colours for 3 points");
        let mut lost = cloud(false, true);
        lost.triangles.push([0, 1, 3]);
        assert_eq!(ply(&lost, "").unwrap_err(), "a triangle names point 3 of 3");
    }
}
