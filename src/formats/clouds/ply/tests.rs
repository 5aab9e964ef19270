//! Clouds and meshes as programs write them, what is left out, what is refused.

use glam::DVec3;
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
    let fault = |from: &str, to: &str| read_bytes(ASCII.replace(from, to).as_bytes()).unwrap_err();
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
