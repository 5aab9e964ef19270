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

use std::io::{BufRead, Read};

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType,
    ScalarType,
};

use crate::clouds::cloud_file::{CloudFile, first_not_finite};
use crate::fault::Fault;
use crate::jobs::Progress;
use crate::text::fields::shown;

/// More bytes than any header has.
const LONGEST_HEADER: u64 = 1 << 20;

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

fn read_header<R: BufRead>(mut input: R) -> Result<(Header, Elements<R>), Fault> {
    let (header, lines) = plain_header(&mut input)?;
    let header = Parser::<Skipped>::new()
        .read_header(&mut Reader::new(header.as_bytes()))
        .map_err(|error| header_fault(&error, &header))?;
    if (header.version.major, header.version.minor) != (1, 0) {
        let (major, minor) = (header.version.major, header.version.minor);
        return Err(Fault::new(
            format!("it is PLY of version {major}.{minor}; only 1.0 is known"),
            "export version 1.0",
        ));
    }
    let elements = Elements {
        encoding: header.encoding,
        line: lines,
        input,
        text: String::new(),
    };
    Ok((header, elements))
}

/// The elements behind the header.
struct Elements<R> {
    encoding: Encoding,
    input: R,
    /// Number of the line last read, for ascii.
    line: u64,
    text: String,
}

impl<R: BufRead> Elements<R> {
    fn read_all<E: PropertyAccess>(
        &mut self,
        element: &ElementDef,
        progress: &Progress,
        mut take: impl FnMut(E) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        // Elements without properties take no bytes: their number is nobody's matter.
        if element.properties.is_empty() {
            return Ok(());
        }
        let parser = Parser::<E>::new();
        for index in 0..element.count {
            if index % 65_536 == 0 {
                progress.advance(index as u64, element.count as u64)?;
            }
            let read = match self.encoding {
                Encoding::Ascii => {
                    self.next_text_line(element, index)?;
                    parser.read_ascii_element(&self.text, element)
                }
                Encoding::BinaryBigEndian => {
                    parser.read_big_endian_element(&mut self.input, element)
                }
                Encoding::BinaryLittleEndian => {
                    parser.read_little_endian_element(&mut self.input, element)
                }
            };
            let read = read.map_err(|e| match self.encoding {
                Encoding::Ascii => {
                    let (name, text) = (&element.name, self.text.trim());
                    let what = format!("{name} {index} is not what the header promises: '{text}'");
                    Fault::at(self.line, what, "export the file again")
                }
                _ if e.kind() == std::io::ErrorKind::UnexpectedEof => cut_off(element, index),
                _ => Fault::new(
                    format!("{} {index}: {e}", element.name),
                    "export the file again",
                ),
            })?;
            take(read).map_err(|fault| match self.encoding {
                Encoding::Ascii => Fault {
                    line: Some(self.line),
                    ..fault
                },
                _ => fault,
            })?;
        }
        Ok(())
    }

    /// What follows the elements shows that a binary header does not belong to them. Behind text it
    /// is left out, with a warning.
    fn left_out(&mut self) -> Result<Option<String>, Fault> {
        let rest = self.input.fill_buf().map_err(|e| {
            Fault::new(
                format!("it cannot be read to its end ({e})"),
                "check the disk",
            )
        })?;
        if rest.iter().all(u8::is_ascii_whitespace) {
            return Ok(None);
        }
        let what = "it goes on behind the elements that its header promises";
        match self.encoding {
            Encoding::Ascii => Ok(Some(format!("{what}; what follows is left out"))),
            _ => Err(Fault::new(what, "export the file again")),
        }
    }

    fn next_text_line(&mut self, element: &ElementDef, index: usize) -> Result<(), Fault> {
        loop {
            self.text.clear();
            self.line += 1;
            let read = self.input.read_line(&mut self.text).map_err(|e| {
                Fault::at(
                    self.line,
                    format!("it cannot be read as text ({e})"),
                    "export the file again",
                )
            })?;
            if read == 0 {
                return Err(cut_off(element, index));
            }
            if !self.text.trim().is_empty() {
                return Ok(());
            }
        }
    }
}

fn cut_off(element: &ElementDef, index: usize) -> Fault {
    let (name, count) = (&element.name, element.count);
    Fault::new(
        format!(
            "the file ends after {index} of the {count} {name} elements that its header promises"
        ),
        "copy or export it again",
    )
}

/// Reads the header's lines, each with single spaces between its words, and their number. Comments
/// lose their words, which may be of any encoding.
fn plain_header(input: &mut impl BufRead) -> Result<(String, u64), Fault> {
    let mut bounded = input.by_ref().take(LONGEST_HEADER);
    let mut plain = String::new();
    let mut line = Vec::new();
    for lines in 0.. {
        line.clear();
        let read = bounded.read_until(b'\n', &mut line).map_err(|e| {
            Fault::new(format!("its header cannot be read ({e})"), "check the disk")
        })?;
        if read == 0 {
            return Ok((plain, lines));
        }
        let text = String::from_utf8_lossy(&line);
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        match words.first() {
            Some(&"comment" | &"obj_info") => plain.push_str("comment -"),
            _ => plain.push_str(&words.join(" ")),
        }
        plain.push('\n');
        if words == ["end_header"] {
            return Ok((plain, lines + 1));
        }
    }
    Ok((plain, 0))
}

fn header_fault(error: &ParseError, header: &str) -> Fault {
    let remedy = "check that it is a PLY file, and export it again";
    let number = error.line().unwrap_or(1).max(1);
    match header.lines().nth(number - 1) {
        Some(line) => {
            let what = format!("its header does not go on as PLY at '{}'", shown(line));
            Fault::at(number as u64, what, remedy)
        }
        None => Fault::at(number as u64, "its header ends before end_header", remedy),
    }
}

/// What the properties of `vertex` say.
struct VertexLayout {
    colors: bool,
    /// Whether the coordinates are 32-bit floats.
    floats: bool,
}

impl VertexLayout {
    fn of(element: &ElementDef) -> Result<Self, Fault> {
        let mut axes = [None, None, None];
        let mut channels = [false; 3];
        for (name, property) in &element.properties {
            if let Some(axis) = axis(name) {
                axes[axis] = Some(&property.data_type);
            } else if let Some(channel) = channel(name) {
                channels[channel] = true;
            }
        }
        for (axis, name) in axes.iter().zip(["x", "y", "z"]) {
            if !matches!(axis, Some(PropertyType::Scalar(_))) {
                return Err(Fault::new(
                    format!("its vertices have no property {name}"),
                    "export points with x, y and z",
                ));
            }
        }
        let float = PropertyType::Scalar(ScalarType::Float);
        Ok(Self {
            colors: channels == [true; 3],
            floats: axes.contains(&Some(&float)),
        })
    }
}

fn axis(name: &str) -> Option<usize> {
    ["x", "y", "z"]
        .iter()
        .position(|axis| name.eq_ignore_ascii_case(axis))
}

fn channel(name: &str) -> Option<usize> {
    let name = name.strip_prefix("diffuse_").unwrap_or(name);
    let is = |long: &str, short: &str| {
        name.eq_ignore_ascii_case(long) || name.eq_ignore_ascii_case(short)
    };
    [("red", "r"), ("green", "g"), ("blue", "b")]
        .iter()
        .position(|(long, short)| is(long, short))
}

/// The number of a scalar property.
pub(crate) fn number(property: &Property) -> Option<f64> {
    Some(match *property {
        Property::Char(v) => f64::from(v),
        Property::UChar(v) => f64::from(v),
        Property::Short(v) => f64::from(v),
        Property::UShort(v) => f64::from(v),
        Property::Int(v) => f64::from(v),
        Property::UInt(v) => f64::from(v),
        Property::Float(v) => f64::from(v),
        Property::Double(v) => v,
        _ => return None,
    })
}

struct Vertex {
    position: DVec3,
    color: [u8; 3],
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self {
            position: DVec3::ZERO,
            color: [0; 3],
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if let Some(axis) = axis(name) {
            let Some(number) = number(&property) else {
                return PropertyAccessResult::UnsupportedType;
            };
            self.position[axis] = number;
        } else if let Some(channel) = channel(name) {
            // `as` saturates.
            self.color[channel] = match property {
                Property::UChar(v) => v,
                Property::Char(v) => v as u8,
                Property::UShort(v) => (v >> 8) as u8,
                Property::Short(v) => v.clamp(0, 255) as u8,
                Property::Int(v) => v.clamp(0, 255) as u8,
                Property::UInt(v) => v.min(255) as u8,
                Property::Float(v) => (v * 255.0).round() as u8,
                Property::Double(v) => (v * 255.0).round() as u8,
                _ => return PropertyAccessResult::UnsupportedType,
            };
        } else {
            return PropertyAccessResult::Ignored;
        }
        PropertyAccessResult::Set
    }
}

struct Face {
    corners: Result<Vec<u32>, Fault>,
}

impl PropertyAccess for Face {
    fn new() -> Self {
        Self {
            corners: Ok(Vec::new()),
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if name != "vertex_indices" && name != "vertex_index" {
            return PropertyAccessResult::Ignored;
        }
        fn indices<T: TryInto<u32> + Copy + std::fmt::Display>(
            list: Vec<T>,
        ) -> Result<Vec<u32>, Fault> {
            list.into_iter()
                .map(|i| {
                    i.try_into().map_err(|_| {
                        Fault::new(format!("a face names vertex {i}"), "export the mesh again")
                    })
                })
                .collect()
        }
        self.corners = match property {
            Property::ListChar(list) => indices(list),
            Property::ListUChar(list) => indices(list),
            Property::ListShort(list) => indices(list),
            Property::ListUShort(list) => indices(list),
            Property::ListInt(list) => indices(list),
            Property::ListUInt(list) => indices(list),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// An element that nobody asked for.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn read_bytes(bytes: &[u8]) -> Result<CloudFile, Fault> {
        read(bytes, &Progress::default())
    }

    const ASCII: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement camera 1\nproperty float f\n\
        element vertex 4\nproperty uchar blue\nproperty double z\nproperty float x\nproperty uchar red\n\
        property int y\nproperty uchar green\nproperty list uchar float extra\nelement face 1\n\
        property float quality\nproperty list uchar int vertex_indices\nend_header\n7.5\n\
        3 0.125 1 1 10 2 2 9 9\n3 500000.123456 2 1 11 2 0\n3 0 3 1 12 2 0\n3 -1e3 4 1 13 2 0\n\
        0.5 4 0 1 2 3\n";

    #[test]
    fn any_order_of_properties_and_elements() {
        let file = read_bytes(ASCII.as_bytes()).unwrap();
        assert_eq!(file.cloud.points[0], DVec3::new(1.0, 10.0, 0.125));
        assert_eq!(file.cloud.points[1], DVec3::new(2.0, 11.0, 500_000.123_456));
        assert_eq!(file.cloud.colors, [[1, 2, 3]; 4]);
        assert_eq!(file.cloud.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(read_bytes(ASCII.replace('\n', "\r\n").as_bytes()), Ok(file));
    }

    /// A vertex with a double and a list, then faces, in the byte order asked for.
    fn binary(big: bool) -> Vec<u8> {
        let order = if big { "big" } else { "little" };
        let mut bytes = format!(
            "ply\nformat binary_{order}_endian 1.0\nelement vertex 3\nproperty double x\n\
             property double y\nproperty float z\nproperty ushort red\nproperty ushort green\n\
             property ushort blue\nelement face 1\nproperty list uint uint vertex_index\nend_header\n"
        )
        .into_bytes();
        let mut put = |little: &[u8]| {
            if big {
                bytes.extend(little.iter().rev());
            } else {
                bytes.extend(little);
            }
        };
        for (x, y, z) in [
            (500_000.123_456, 5_000_000.654_321, 1.5),
            (0.1, 0.2, 0.0),
            (1.0, 7.0, -2.0),
        ] {
            put(&f64::to_le_bytes(x));
            put(&f64::to_le_bytes(y));
            put(&f32::to_le_bytes(z));
            for channel in [256_u16, 512, 65_535] {
                put(&channel.to_le_bytes());
            }
        }
        for number in [3_u32, 2, 1, 0] {
            put(&number.to_le_bytes());
        }
        bytes
    }

    #[test]
    fn both_byte_orders() {
        let little = read_bytes(&binary(false)).unwrap();
        assert_eq!(
            little.cloud.points[0],
            DVec3::new(500_000.123_456, 5_000_000.654_321, 1.5)
        );
        assert_eq!(little.cloud.colors[0], [1, 2, 255]);
        assert_eq!(little.cloud.triangles, [[2, 1, 0]]);
        assert_eq!(read_bytes(&binary(true)), Ok(little));
    }

    #[test]
    fn truncation_is_an_error_everywhere() {
        for whole in [binary(false), binary(true), ASCII.as_bytes().to_vec()] {
            // The last line break may be missing.
            for end in 0..whole.len() - 2 {
                assert!(read_bytes(&whole[..end]).is_err(), "cut at {end}");
            }
        }
    }

    #[test]
    fn a_header_that_promises_too_little() {
        let fewer = ASCII.replace("element face 1", "element face 0");
        let file = read_bytes(fewer.as_bytes()).unwrap();
        assert_eq!(
            (file.cloud.points.len(), file.cloud.triangles.len()),
            (4, 0)
        );
        assert!(
            file.warnings.concat().contains("goes on"),
            "{:?}",
            file.warnings
        );
        let whole = read_bytes(format!("{ASCII}\r\n\n").as_bytes()).unwrap();
        assert_eq!(whole, read_bytes(ASCII.as_bytes()).unwrap());
        for big in [false, true] {
            let more = [binary(big), vec![1]].concat();
            assert!(read_bytes(&more).unwrap_err().what.contains("goes on"));
        }
    }

    /// As other programs write headers: spaces around the words, comments in Latin-1 or without words.
    #[test]
    fn loose_headers_are_read() {
        let (header, rest) = ASCII.split_once("end_header").unwrap();
        let mut loose = Vec::new();
        for line in header.trim_end().lines() {
            loose.extend_from_slice(format!(" {} \n", line.trim().replace(' ', " \t")).as_bytes());
        }
        loose.extend_from_slice(b"comment\ncomment Cr\xe9\xe9\nobj_info\n end_header");
        loose.extend_from_slice(rest.as_bytes());
        assert_eq!(
            read_bytes(&loose).unwrap().cloud,
            read_bytes(ASCII.as_bytes()).unwrap().cloud
        );
        let wrong = ASCII.replace("property int y", "property real y");
        let fault = read_bytes(wrong.as_bytes()).unwrap_err();
        assert!(fault.what.ends_with("at 'property real y'"), "{fault}");
        let line = wrong.lines().position(|line| line == "property real y");
        assert_eq!(fault.line, line.map(|line| line as u64 + 1));
    }

    /// Organised clouds mark missing points with NaN; a face needs all of its vertices.
    #[test]
    fn missing_points_of_a_cloud_are_left_out() {
        let ply = |faces: u32| {
            let header = format!(
                "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                 property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n\
                 element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
            );
            let mut bytes = header.into_bytes();
            for (x, red) in [(1.0_f32, 10), (f32::NAN, 20), (3.0, 30)] {
                for value in [x, 2.0, 3.0] {
                    bytes.extend(value.to_le_bytes());
                }
                bytes.extend([red, 0, 0]);
            }
            for _ in 0..faces {
                bytes.push(3);
                bytes.extend([0_i32, 1, 2].map(i32::to_le_bytes).concat());
            }
            bytes
        };
        let file = read_bytes(&ply(0)).unwrap();
        let expected = [1.0, 3.0].map(|x| DVec3::new(x, 2.0, 3.0));
        assert_eq!(file.cloud.points, expected);
        assert_eq!(file.cloud.colors, [[10, 0, 0], [30, 0, 0]]);
        assert!(file.warnings[0].starts_with("1 of 3 points are not finite"));
        let refused = read_bytes(&ply(1)).unwrap_err();
        assert!(refused.what.starts_with("vertex 1 (counted from 0) has"));
    }

    #[test]
    fn lying_counts_cost_nothing() {
        let vertices = ASCII.replace("vertex 4", "vertex 4000000000");
        assert!(read_bytes(vertices.as_bytes()).is_err());
        let mut bytes = binary(false);
        let list = bytes.len() - 16;
        bytes[list..list + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(read_bytes(&bytes).unwrap_err().what.contains("ends after"));
    }

    #[test]
    fn mistakes_are_placed() {
        let fault =
            |from: &str, to: &str| read_bytes(ASCII.replace(from, to).as_bytes()).unwrap_err();
        let not_finite = fault("-1e3", "1e999");
        assert!(
            not_finite.what.starts_with("vertex 3 (counted from 0) has"),
            "{not_finite}"
        );
        assert_eq!(fault("-1e3", "nan").line, Some(22));
        assert_eq!(fault("-1e3", "deep").line, Some(22));
        assert!(fault("0 1 2 3", "0 1 2 4").what.contains("names vertex 4"));
        assert_eq!(fault("0 1 2 3", "0 1 2 -1").line, Some(23));
        assert!(
            fault("property double z\n", "")
                .what
                .contains("no property z")
        );
        assert!(
            fault("element vertex 4", "element point 4")
                .what
                .contains("no vertex")
        );
        assert_eq!(fault("ply\n", "plx\n").line, Some(1));
        assert!(read_bytes(b"").is_err());
        assert!(read_bytes(&[0xff; 100]).is_err());
    }

    #[test]
    fn floats_with_utm_coordinates_are_warned_of() {
        let text = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n\
            property float z\nend_header\n500000 5000000 1\n500010 5000010 2\n";
        let file = read_bytes(text.as_bytes()).unwrap();
        assert!(
            file.warnings[0].contains("32-bit floats"),
            "{:?}",
            file.warnings
        );
        assert!(read_bytes(ASCII.as_bytes()).unwrap().warnings.is_empty());
    }

    proptest! {
        #[test]
        fn no_damage_panics(at in 0..200_usize, byte in any::<u8>(), big in any::<bool>()) {
            for mut bytes in [binary(big), ASCII.as_bytes().to_vec()] {
                let at = at % bytes.len();
                bytes[at] = byte;
                let _ = read_bytes(&bytes);
            }
        }
    }
}
