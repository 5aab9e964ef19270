//! STL: "StereoLithography Interface Specification", 3D Systems (1989), and what is made of it.
//!
//! - Binary: 80 bytes of anything, the number of triangles as u32, then for each 50 bytes,
//!   little-endian: a normal and three corners as f32, and two bytes that some programs colour with.
//!   A file whose length fits this is binary, even where it begins with "solid".
//! - ASCII: `solid`, then `facet normal`, `outer loop`, three times `vertex x y z`, `endloop`,
//!   `endfacet`, and `endsolid`; several solids may follow each other. Upper and lower case are one.
//!
//! Corners with the same coordinates become one vertex. Normals follow from the corners and are
//! passed over. By hand and not with stl_io, which reads text as f32: UTM coordinates lose decimetres.

use std::collections::HashMap;
use std::io::{BufRead, Read};

use glam::DVec3;

use crate::clouds::cloud_file::CloudFile;
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::text::fields::{Fields, shown};
use crate::text::text_lines::TextLines;

const REMEDY: &str = "copy or export it again";

/// The bytes before the triangles of a binary file.
const HEADER: usize = 84;

/// Of a triangle in a binary file, in bytes.
const TRIANGLE: u64 = 50;

/// Reads an STL file of `size` bytes.
///
/// # Errors
/// Where it is no such file, is cut off, has no triangle, or a coordinate is not finite.
pub(crate) fn read(
    mut input: impl BufRead,
    size: u64,
    progress: &Progress,
) -> Result<CloudFile, Fault> {
    let mut start = Vec::new();
    input
        .by_ref()
        .take(HEADER as u64)
        .read_to_end(&mut start)
        .map_err(|e| Fault::new(format!("it cannot be read ({e})"), "check the disk"))?;
    let room = size.saturating_sub(HEADER as u64) / TRIANGLE;
    let count = start
        .get(80..)
        .and_then(|bytes| bytes.first_chunk::<4>())
        .map(|bytes| u64::from(u32::from_le_bytes(*bytes)));
    let fits = count.is_some_and(|count| HEADER as u64 + count * TRIANGLE == size);
    let mut mesh = Corners::default();
    let is_text = start
        .trim_ascii_start()
        .get(..5)
        .is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    if is_text && !fits {
        read_ascii(start.chain(input), size, &mut mesh, progress)?;
    } else {
        let Some(count) = count else {
            return Err(Fault::new("it is too short for an STL file", REMEDY));
        };
        if count > room {
            return Err(Fault::new(
                format!("its header promises {count} triangles, but there is room for {room}"),
                REMEDY,
            ));
        }
        read_binary(input, count, &mut mesh, progress)?;
        if count < room {
            mesh.file.warnings.push(format!(
                "it goes on behind the {count} triangles that its header promises"
            ));
        }
        mesh.file.warn_if_rounded();
    }
    if mesh.file.cloud.triangles.is_empty() {
        return Err(Fault::new("it has no triangles", "export a mesh"));
    }
    Ok(mesh.file)
}

/// Triangles whose equal corners become one vertex.
#[derive(Default)]
struct Corners {
    file: CloudFile,
    known: HashMap<[u64; 3], u32>,
}

impl Corners {
    fn add(&mut self, corners: [DVec3; 3]) -> Result<(), Fault> {
        let mut triangle = [0; 3];
        for (index, corner) in triangle.iter_mut().zip(corners) {
            // Adding 0 makes -0 the 0 that it equals.
            let key = (corner + DVec3::ZERO).to_array().map(f64::to_bits);
            let points = &mut self.file.cloud.points;
            *index = match self.known.get(&key) {
                Some(known) => *known,
                None => {
                    let new = u32::try_from(points.len()).map_err(|_| {
                        Fault::new("it has over 4 294 967 295 vertices", "reduce the mesh")
                    })?;
                    points.push(corner);
                    self.known.insert(key, new);
                    new
                }
            };
        }
        self.file.cloud.triangles.push(triangle);
        Ok(())
    }
}

fn read_binary(
    mut input: impl Read,
    count: u64,
    mesh: &mut Corners,
    progress: &Progress,
) -> Result<(), Fault> {
    let mut bytes = [0; TRIANGLE as usize];
    for index in 0..count {
        if index % 65_536 == 0 {
            progress.advance(index, count)?;
        }
        input.read_exact(&mut bytes).map_err(|e| {
            let what = format!("it ends after {index} of {count} triangles ({e})");
            Fault::new(what, REMEDY)
        })?;
        let mut corners = [DVec3::ZERO; 3];
        let (_, numbers) = bytes.split_at(12);
        let mut numbers = numbers.chunks_exact(4);
        for number in corners.iter_mut().flat_map(AsMut::<[f64; 3]>::as_mut) {
            let four = numbers.next().and_then(|four| four.first_chunk::<4>());
            *number = four.map_or(0.0, |four| f64::from(f32::from_le_bytes(*four)));
        }
        if !corners.iter().all(|corner| corner.is_finite()) {
            return Err(Fault::new(
                format!(
                    "triangle {index} (counted from 0) has a coordinate that is not a finite number"
                ),
                REMEDY,
            ));
        }
        mesh.add(corners)?;
    }
    Ok(())
}

fn read_ascii(
    input: impl BufRead,
    size: u64,
    mesh: &mut Corners,
    progress: &Progress,
) -> Result<(), Fault> {
    let mut lines = TextLines::new(input);
    let mut corners: Vec<DVec3> = Vec::new();
    let mut open = false;
    loop {
        if lines.line().is_multiple_of(65_536) {
            progress.advance(lines.bytes(), size)?;
        }
        let number = lines.line() + 1;
        let Some(line) = lines.next_line()? else {
            break;
        };
        let mut fields = Fields::new(number, line, REMEDY);
        if fields.rest().is_empty() {
            continue;
        }
        let word = fields.word("a keyword")?;
        match word.to_ascii_lowercase().as_str() {
            "vertex" => {
                if corners.len() == 3 {
                    return Err(fields.fault("a facet has more than three corners"));
                }
                corners.push(fields.triple("a coordinate")?);
            }
            "endloop" => {
                let [a, b, c] = corners[..] else {
                    let what = format!("a facet has {} corners", corners.len());
                    return Err(fields.fault(what));
                };
                mesh.add([a, b, c])?;
                corners.clear();
            }
            "solid" => open = true,
            "endsolid" => open = false,
            "facet" | "outer" | "endfacet" => {}
            _ => {
                let word = shown(word);
                return Err(fields.fault(format!("'{word}' does not belong into an STL file")));
            }
        }
    }
    if !corners.is_empty() {
        return Err(lines.fault("it ends inside a facet", REMEDY));
    }
    if open {
        mesh.file
            .warnings
            .push("it has no endsolid line, as if it were cut off".to_owned());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use proptest::prelude::*;

    use super::*;
    use fragscale_test_data::shared_data;

    fn read_bytes(bytes: &[u8]) -> Result<CloudFile, Fault> {
        read(bytes, bytes.len() as u64, &Progress::default())
    }

    /// Two triangles of a square, in a file that begins with `header`.
    fn binary(header: &[u8]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, 0);
        bytes.extend(2_u32.to_le_bytes());
        for triangle in [
            [[0.0_f32, 0.0, 1.0], [2.0, -0.0, 1.0], [2.0, 2.0, 1.0]],
            [[-0.0, 0.0, 1.0], [2.0, 2.0, 1.0], [0.0, 2.0, 1.5]],
        ] {
            bytes.extend([0; 12]);
            bytes.extend(triangle.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
            bytes.extend([0x1f, 0x80]);
        }
        bytes
    }

    const ASCII: &str = "solid a name\nfacet normal 0 0 1\n outer loop\n  vertex 500000.125 0 1\n  \
                         vertex 500002 0 1\n  VERTEX 500002 2.0e0 1\n endloop\nendfacet\n\
                         facet normal 0 0 1\nouter loop\nvertex 500000.125 0 1\nvertex 500002 2 1\n\
                         vertex 500000 2 1\nendloop\nendfacet\nendsolid a name\n";

    #[test]
    fn equal_corners_are_one_vertex() {
        for header in [&b"exported"[..], b"solid but binary"] {
            let cloud = read_bytes(&binary(header)).unwrap().cloud;
            assert_eq!(cloud.points.len(), 4);
            assert_eq!(cloud.triangles, [[0, 1, 2], [0, 2, 3]]);
            assert_eq!(cloud.points[3], DVec3::new(0.0, 2.0, 1.5));
        }
        for text in [ASCII.to_owned(), ASCII.replace('\n', "\r\n")] {
            let file = read_bytes(text.as_bytes()).unwrap();
            assert_eq!(file.cloud.triangles, [[0, 1, 2], [0, 2, 3]]);
            assert_eq!(file.cloud.points[0], DVec3::new(500_000.125, 0.0, 1.0));
            assert_eq!(file.warnings, Vec::<String>::new());
        }
    }

    #[test]
    fn truncation_is_an_error() {
        let whole = binary(b"x");
        for end in 0..whole.len() {
            assert!(read_bytes(&whole[..end]).is_err(), "cut at {end}");
        }
        for end in 0..ASCII.len() - 30 {
            if let Ok(file) = read_bytes(&ASCII.as_bytes()[..end]) {
                assert!(file.warnings[0].contains("endsolid"), "cut at {end}");
            }
        }
        let mut longer = binary(b"x");
        longer.extend([0; 60]);
        assert!(read_bytes(&longer).unwrap().warnings[0].contains("goes on"));
    }

    #[test]
    fn what_cannot_be_is_refused() {
        for (from, to, line) in [
            ("vertex 500002 0 1", "vertex 500002 0", 5),
            ("vertex 500002 0 1", "vertex 500002 0 inf", 5),
            ("vertex 500002 0 1", "", 7),
            (" outer loop", "vertex 1 2 3", 6),
            ("endfacet", "endfacets", 8),
        ] {
            let fault = read_bytes(ASCII.replacen(from, to, 1).as_bytes()).unwrap_err();
            assert_eq!(fault.line, Some(line), "{to}: {fault}");
        }
        assert!(read_bytes(b"solid x\nendsolid x\n").is_err());
        let mut bytes = binary(b"x");
        bytes[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(
            read_bytes(&bytes)
                .unwrap_err()
                .what
                .contains("not a finite")
        );
    }

    #[test]
    fn a_real_quarry() {
        let Some(folder) = shared_data("authume-quarry-terrain/Geometries/STL") else {
            return;
        };
        let (mut faces, mut top, mut bottom) = (0, f64::MIN, f64::MAX);
        let mut area = 0.0;
        for name in ["DTM_Blue_zone.stl", "DTM_Gray_zone.stl", "DTM_Red_zone.stl"] {
            let cloud = read_bytes(&fs::read(folder.join(name)).unwrap())
                .unwrap()
                .cloud;
            faces += cloud.triangles.len();
            for triangle in &cloud.triangles {
                let [a, b, c] = triangle.map(|corner| cloud.points[corner as usize]);
                // y is up in these files.
                area += (b - a).cross(c - a).y.abs() / 2.0;
                for corner in [a, b, c] {
                    top = top.max(corner.y);
                    bottom = bottom.min(corner.y);
                }
            }
        }
        // The README's numbers.
        assert_eq!(faces, 9001);
        assert!((area - 21_465.0).abs() < 1.0, "{area}");
        assert!((153.0..154.0).contains(&bottom) && (213.0..214.5).contains(&top));
    }

    proptest! {
        #[test]
        fn no_damage_panics(at in 0..184_usize, byte in any::<u8>(), text in 0..380_usize) {
            let mut bytes = binary(b"solid x");
            bytes[at] = byte;
            let _ = read_bytes(&bytes);
            let mut bytes = ASCII.as_bytes().to_vec();
            let text = text % bytes.len();
            bytes[text] = byte;
            let _ = read_bytes(&bytes);
        }
    }
}
