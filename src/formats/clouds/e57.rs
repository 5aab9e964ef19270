//! E57: ASTM E2807, "3D Imaging Data Exchange", with the e57 crate.
//!
//! - A file holds any number of scans; each has points in its own frame and a pose (a quaternion and
//!   a translation) that brings them into the file's frame. All scans are joined there.
//! - A point is Cartesian (x, y, z) or spherical (range, azimuth from +x towards +y, elevation from
//!   the xy plane, radians), or both: then the Cartesian one counts where it is valid.
//!   `cartesianInvalidState` and `sphericalInvalidState` are 0 for a valid point, 1 for a mere
//!   direction, 2 for nothing: those and NaN are left out and counted.
//! - Colours run from the limits in `colorLimits`, or else those of the type of the field; floats
//!   without limits run from 0 to 1.
//! - Lengths are metres. `coordinateMetadata` is a coordinate system as WKT.
//! - Every page of 1024 bytes has a checksum.
//!
//! The raw points are taken: the crate's simple reader gives up where a packet completes no point.

use std::io::{Read, Seek, SeekFrom};

use e57::{E57Reader, PointCloud, Record, RecordDataType, RecordName, RecordValue, Transform};
use glam::{DMat3, DQuat, DVec3};

use crate::clouds::cloud_file::{CloudFile, Rounded};
use crate::fault::Fault;
use crate::jobs::Progress;

const REMEDY: &str = "copy or export it again";

/// Reads an E57 file.
///
/// # Errors
/// Where it is no such file, is damaged or cut off, or has no valid point.
pub(crate) fn read(mut input: impl Read + Seek, progress: &Progress) -> Result<CloudFile, Fault> {
    check_header(&mut input)?;
    let mut reader = E57Reader::new(input).map_err(|e| broken(&e))?;
    let mut file = CloudFile::default();
    if let Some(crs) = reader.coordinate_metadata() {
        let crs = crs.to_owned();
        file.set_crs(&crs);
    }
    let scans = reader.pointclouds();
    let total = scans
        .iter()
        .fold(0_u64, |sum, scan| sum.saturating_add(scan.records));
    let mut done = 0;
    let mut left_out = 0_u64;
    for (index, scan) in scans.iter().enumerate() {
        let layout = Layout::of(scan).map_err(|fault| Fault {
            what: format!("scan {index} (counted from 0): {}", fault.what),
            ..fault
        })?;
        let first = file.cloud.points.len();
        if scan.records == 0 {
            continue;
        }
        let points = reader.pointcloud_raw(scan).map_err(|e| broken(&e))?;
        for values in points {
            let values = values.map_err(|e| broken(&e))?;
            match layout.position(&values) {
                Some(point) => file.push(point, layout.color(&values)),
                None => left_out += 1,
            }
            done += 1;
            if done % 65_536 == 0 {
                progress.advance(done, total)?;
            }
        }
        let rounded = file.cloud.points.get(first..).and_then(Rounded::of);
        if let Some(rounded) = rounded.filter(|_| layout.floats) {
            file.take_rounded(rounded, format!("scan {index}: {rounded}"));
        }
        let points = file.cloud.points.get_mut(first..).unwrap_or_default();
        if let Some(pose) = &scan.transform {
            let (rotation, translation) = pose_of(pose)?;
            for point in points {
                *point = rotation * *point + translation;
            }
        }
    }
    if left_out > 0 {
        file.warnings.push(format!(
            "{left_out} of {done} points are marked invalid by the scanner and left out"
        ));
    }
    if file.cloud.points.iter().any(|point| !point.is_finite()) {
        return Err(Fault::new("the pose of a scan is not finite", REMEDY));
    }
    file.expect_points()?;
    Ok(file)
}

/// The crate allocates the length of the XML part as the header claims it.
fn check_header(input: &mut (impl Read + Seek)) -> Result<(), Fault> {
    let unreadable = |e: std::io::Error| broken(&e);
    let size = input.seek(SeekFrom::End(0)).map_err(unreadable)?;
    input.seek(SeekFrom::Start(32)).map_err(unreadable)?;
    let mut length = [0; 8];
    input.read_exact(&mut length).map_err(unreadable)?;
    input.rewind().map_err(unreadable)?;
    if u64::from_le_bytes(length) > size {
        return Err(Fault::new(
            "its header promises more XML than the file is long",
            REMEDY,
        ));
    }
    Ok(())
}

fn broken(error: &dyn std::error::Error) -> Fault {
    // The crate's errors hide their reason (a checksum, an early end) in their source.
    let reason = error
        .source()
        .map_or(String::new(), |source| format!(": {source}"));
    Fault::new(
        format!("it cannot be read as E57 ({error}{reason})"),
        REMEDY,
    )
}

fn pose_of(pose: &Transform) -> Result<(DMat3, DVec3), Fault> {
    let (q, t) = (&pose.rotation, &pose.translation);
    let rotation = DQuat::from_xyzw(q.x, q.y, q.z, q.w);
    let length = rotation.length();
    if !(length > 1e-6 && length.is_finite()) {
        return Err(Fault::new(
            format!("a scan's pose has a quaternion of length {length}"),
            REMEDY,
        ));
    }
    Ok((
        DMat3::from_quat(rotation.normalize()),
        DVec3::new(t.x, t.y, t.z),
    ))
}

/// A field's place among a point's values, and its type.
#[derive(Debug, Clone)]
struct Field {
    place: usize,
    kind: RecordDataType,
}

impl Field {
    fn find(prototype: &[Record], name: &RecordName) -> Option<Self> {
        let place = prototype.iter().position(|record| record.name == *name)?;
        let kind = prototype.get(place)?.data_type.clone();
        Some(Self { place, kind })
    }

    fn value(&self, values: &[RecordValue]) -> Option<f64> {
        values.get(self.place)?.to_f64(&self.kind).ok()
    }
}

/// A colour channel with the values that are black and full.
#[derive(Debug)]
struct Channel {
    field: Field,
    min: f64,
    max: f64,
}

impl Channel {
    fn new(field: Field, limits: Option<(&RecordValue, &RecordValue)>) -> Self {
        let of_limits = limits.and_then(|(min, max)| {
            let number = |value: &RecordValue| value.to_f64(&field.kind).ok();
            Some((number(min)?, number(max)?))
        });
        let of_kind = || match field.kind {
            RecordDataType::Single {
                min: Some(min),
                max: Some(max),
            } => (f64::from(min), f64::from(max)),
            RecordDataType::Double {
                min: Some(min),
                max: Some(max),
            } => (min, max),
            RecordDataType::Integer { min, max } => (min as f64, max as f64),
            RecordDataType::ScaledInteger {
                min,
                max,
                scale,
                offset,
            } => (min as f64 * scale + offset, max as f64 * scale + offset),
            _ => (0.0, 1.0),
        };
        let (min, max) = of_limits
            .filter(|(min, max)| max > min)
            .unwrap_or_else(of_kind);
        Self { field, min, max }
    }

    fn value(&self, values: &[RecordValue]) -> Option<u8> {
        let fraction = (self.field.value(values)? - self.min) / (self.max - self.min);
        // `as` saturates; limits that are equal give 0.
        Some((fraction * 255.0).round() as u8)
    }
}

/// Which values of a point are what.
#[derive(Debug)]
struct Layout {
    cartesian: Option<[Field; 3]>,
    cartesian_state: Option<Field>,
    spherical: Option<[Field; 3]>,
    spherical_state: Option<Field>,
    color: Option<[Channel; 3]>,
    color_state: Option<Field>,
    /// Whether the coordinates are 32-bit floats.
    floats: bool,
}

impl Layout {
    fn of(scan: &PointCloud) -> Result<Self, Fault> {
        let find = |name| Field::find(&scan.prototype, &name);
        let three = |names: [RecordName; 3]| {
            let [a, b, c] = names.map(find);
            Some([a?, b?, c?])
        };
        let cartesian = three([
            RecordName::CartesianX,
            RecordName::CartesianY,
            RecordName::CartesianZ,
        ]);
        let spherical = three([
            RecordName::SphericalRange,
            RecordName::SphericalAzimuth,
            RecordName::SphericalElevation,
        ]);
        if cartesian.is_none() && spherical.is_none() {
            return Err(Fault::new(
                "its points have no x, y, z and no range, azimuth, elevation",
                "export points",
            ));
        }
        // Fields whose values are all equal take no bytes: of such fields alone the crate would make
        // points without end.
        let takes_bytes = |record: &Record| match record.data_type {
            RecordDataType::Integer { min, max }
            | RecordDataType::ScaledInteger { min, max, .. } => max > min,
            RecordDataType::Single { .. } | RecordDataType::Double { .. } => true,
        };
        if !scan.prototype.iter().any(takes_bytes) {
            return Err(Fault::new("all its points are the same", "export it again"));
        }
        let limits = scan.color_limits.as_ref();
        let color = three([
            RecordName::ColorRed,
            RecordName::ColorGreen,
            RecordName::ColorBlue,
        ])
        .map(|[red, green, blue]| {
            let of =
                |min: &Option<RecordValue>, max: &Option<RecordValue>| min.clone().zip(max.clone());
            let channel = |field, limits: Option<(RecordValue, RecordValue)>| {
                Channel::new(field, limits.as_ref().map(|(min, max)| (min, max)))
            };
            [
                channel(red, limits.and_then(|l| of(&l.red_min, &l.red_max))),
                channel(green, limits.and_then(|l| of(&l.green_min, &l.green_max))),
                channel(blue, limits.and_then(|l| of(&l.blue_min, &l.blue_max))),
            ]
        });
        let floats = cartesian.as_ref().is_some_and(|axes| {
            axes.iter()
                .any(|axis| matches!(axis.kind, RecordDataType::Single { .. }))
        });
        Ok(Self {
            cartesian,
            cartesian_state: find(RecordName::CartesianInvalidState),
            spherical,
            spherical_state: find(RecordName::SphericalInvalidState),
            color,
            color_state: find(RecordName::IsColorInvalid),
            floats,
        })
    }

    fn position(&self, values: &[RecordValue]) -> Option<DVec3> {
        let triple = |fields: &Option<[Field; 3]>, state: &Option<Field>| {
            let [a, b, c] = fields.as_ref()?;
            if let Some(state) = state
                && state.value(values)? != 0.0
            {
                return None;
            }
            let triple = DVec3::new(a.value(values)?, b.value(values)?, c.value(values)?);
            triple.is_finite().then_some(triple)
        };
        triple(&self.cartesian, &self.cartesian_state).or_else(|| {
            let of_sphere = triple(&self.spherical, &self.spherical_state)?;
            let [range, azimuth, elevation] = of_sphere.to_array();
            let direction = DVec3::new(
                elevation.cos() * azimuth.cos(),
                elevation.cos() * azimuth.sin(),
                elevation.sin(),
            );
            Some(range * direction)
        })
    }

    fn color(&self, values: &[RecordValue]) -> Option<[u8; 3]> {
        if let Some(state) = &self.color_state
            && state.value(values)? != 0.0
        {
            return None;
        }
        let [red, green, blue] = self.color.as_ref()?;
        Some([
            red.value(values)?,
            green.value(values)?,
            blue.value(values)?,
        ])
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::Cursor;

    use e57::{E57Writer, Quaternion, Translation};

    use super::*;
    use crate::geometry::Bounds;
    use fragscale_test_data::shared_data;

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
}
