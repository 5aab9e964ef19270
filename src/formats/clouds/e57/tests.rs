//! Real scans and written ones, damage.

use std::fs;
use std::io::Cursor;

use e57::{E57Writer, Quaternion, Record, RecordDataType, RecordName, RecordValue, Translation};
use fragscale_test_data::shared_data;

use super::*;
use crate::geometry::Bounds;

fn read_bytes(bytes: &[u8]) -> Result<CloudFile, Fault> {
    read(Cursor::new(bytes.to_vec()), &Progress::default())
}

fn shared(name: &str) -> Option<Vec<u8>> {
    Some(fs::read(shared_data("e57")?.join(name)).unwrap())
}

#[test]
fn real_scans() {
    let Some(bunny) = shared("bunnyFloat.e57") else {
        return;
    };
    let file = read_bytes(&bunny).unwrap();
    assert_eq!(file.cloud.points.len(), 30_571);
    assert!(file.cloud.colors.is_empty());
    let tiny = read_bytes(&shared("tinyCartesianFloatRgb.e57").unwrap()).unwrap();
    assert_eq!(tiny.cloud.points.len(), 2090);
    assert_eq!(tiny.cloud.colors.len(), 2090);
    let fault = read_bytes(&shared("corrupt_crc.e57").unwrap()).unwrap_err();
    assert!(fault.what.contains("checksum"), "{fault}");
    let fault = read_bytes(&shared("empty_pc.e57").unwrap()).unwrap_err();
    assert_eq!(fault.what, "it has no points");
}

/// The fields of a scan, the values of its points, its pose.
type Scan = (Vec<Record>, Vec<Vec<RecordValue>>, Option<Transform>);

/// A file of scans.
fn written(scans: &[Scan]) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = E57Writer::new(&mut bytes, "file").unwrap();
    writer.set_coordinate_metadata(Some("PROJCS[\"x\"]".to_owned()));
    for (index, (prototype, values, pose)) in scans.iter().enumerate() {
        let mut scan = writer
            .add_pointcloud(&format!("scan {index}"), prototype.clone())
            .unwrap();
        scan.set_transform(pose.clone());
        for point in values {
            scan.add_point(point.clone()).unwrap();
        }
        scan.finalize().unwrap();
    }
    writer.finalize().unwrap();
    drop(writer);
    bytes.into_inner()
}

fn double(name: RecordName) -> Record {
    Record {
        name,
        data_type: RecordDataType::F64,
    }
}

fn state(name: RecordName) -> Record {
    Record {
        name,
        data_type: RecordDataType::Integer { min: 0, max: 2 },
    }
}

fn scans() -> Vec<u8> {
    let cartesian = vec![
        double(RecordName::CartesianX),
        double(RecordName::CartesianY),
        double(RecordName::CartesianZ),
        state(RecordName::CartesianInvalidState),
        Record::COLOR_RED_U8,
        Record::COLOR_GREEN_U8,
        Record::COLOR_BLUE_U8,
    ];
    let point = |x, y, z, state, color: [i64; 3]| {
        let mut values: Vec<_> = [x, y, z].map(RecordValue::Double).into();
        values.push(RecordValue::Integer(state));
        values.extend(color.map(RecordValue::Integer));
        values
    };
    let half = std::f64::consts::FRAC_1_SQRT_2;
    // A quarter turn about z: x becomes y.
    let pose = Transform {
        rotation: Quaternion {
            w: half,
            x: 0.0,
            y: 0.0,
            z: half,
        },
        translation: Translation {
            x: 500_000.0,
            y: 5_000_000.0,
            z: 100.0,
        },
    };
    let spherical = vec![
        double(RecordName::SphericalRange),
        double(RecordName::SphericalAzimuth),
        double(RecordName::SphericalElevation),
    ];
    let third = std::f64::consts::FRAC_PI_6;
    written(&[
        (
            cartesian,
            vec![
                point(1.0, 2.0, 3.0, 0, [255, 128, 0]),
                point(9.0, 9.0, 9.0, 2, [1, 1, 1]),
                point(f64::NAN, 0.0, 0.0, 0, [1, 1, 1]),
            ],
            Some(pose),
        ),
        (
            spherical,
            vec![[2.0, 0.0, third].map(RecordValue::Double).into()],
            None,
        ),
    ])
}

#[test]
fn scans_are_joined_in_the_files_frame() {
    let file = read_bytes(&scans()).unwrap();
    let expected = [
        DVec3::new(499_998.0, 5_000_001.0, 103.0),
        DVec3::new(3.0_f64.sqrt(), 0.0, 1.0),
    ];
    assert_eq!(file.cloud.points.len(), 2);
    for (point, expected) in file.cloud.points.iter().zip(expected) {
        assert!((*point - expected).length() < 1e-9, "{point}");
    }
    assert_eq!(file.cloud.colors, [[255, 128, 0], [128, 128, 128]]);
    assert_eq!(file.crs.as_deref(), Some("PROJCS[\"x\"]"));
    assert_eq!(
        file.warnings,
        ["2 of 4 points are marked invalid by the scanner and left out"]
    );
}

/// Makes the checksums of all pages right: CRC-32C, bit by bit.
fn with_checksums(mut bytes: Vec<u8>) -> Vec<u8> {
    for page in bytes.as_chunks_mut::<1024>().0 {
        let (data, end) = page.split_at_mut(1020);
        let mut crc = u32::MAX;
        for byte in data {
            crc ^= u32::from(*byte);
            for _ in 0..8 {
                crc = (crc >> 1) ^ if crc & 1 == 1 { 0x82f6_3b78 } else { 0 };
            }
        }
        end.copy_from_slice(&(!crc).to_be_bytes());
    }
    bytes
}

/// The bytes with one text in place of another of the same length.
fn replaced(mut bytes: Vec<u8>, from: &str, to: &str) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let places: Vec<usize> = (0..bytes.len())
        .filter(|&at| bytes[at..].starts_with(from.as_bytes()))
        .collect();
    assert!(!places.is_empty(), "no '{from}'");
    for at in places {
        bytes[at..at + to.len()].copy_from_slice(to.as_bytes());
    }
    with_checksums(bytes)
}

#[test]
fn points_without_end_are_refused() {
    // Fields whose values are all equal take no bytes, so that any number of points fits.
    let field = |name| Record {
        name,
        data_type: RecordDataType::Integer { min: 4, max: 5 },
    };
    let prototype = vec![
        field(RecordName::CartesianX),
        field(RecordName::CartesianY),
        field(RecordName::CartesianZ),
    ];
    let point = vec![RecordValue::Integer(4); 3];
    let bytes = written(&[(prototype, vec![point], None)]);
    assert_eq!(
        read_bytes(&bytes).unwrap().cloud.points,
        [DVec3::splat(4.0)]
    );
    let constant = replaced(bytes.clone(), "maximum=\"5\"", "maximum=\"4\"");
    let fault = read_bytes(&constant).unwrap_err();
    assert!(
        fault.what.contains("all its points are the same"),
        "{fault}"
    );
    let lying = replaced(bytes, "recordCount=\"1\"", "recordCount=\"9\"");
    assert!(read_bytes(&lying).is_err());
}

#[test]
fn truncation_and_damage_are_errors() {
    let whole = scans();
    for end in (0..whole.len()).step_by(97) {
        assert!(read_bytes(&whole[..end]).is_err(), "cut at {end}");
    }
    // Behind the header's page everything is under a checksum.
    for at in (48..whole.len()).step_by(13) {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x10;
        // Some pages are never read.
        if let Ok(file) = read_bytes(&bytes) {
            assert_eq!(file, read_bytes(&whole).unwrap());
        }
    }
}

#[test]
fn f32_far_from_zero_is_said() {
    let single = |name| Record {
        name,
        data_type: RecordDataType::F32,
    };
    let prototype = vec![
        single(RecordName::CartesianX),
        single(RecordName::CartesianY),
        single(RecordName::CartesianZ),
    ];
    let point = |x: f32| [x, 5.0e6, 0.0].map(RecordValue::Single).into();
    let bytes = written(&[(prototype, vec![point(0.0), point(100.0)], None)]);
    let file = read_bytes(&bytes).unwrap();
    assert!(
        file.warnings[0].contains("rounds them"),
        "{:?}",
        file.warnings
    );
    assert_eq!(Bounds::of(&file.cloud.points).unwrap().size().x, 100.0);
}
