//! COLMAP's binary model, from `src/colmap/scene/reconstruction_io_binary.cc` and
//! `src/colmap/util/types.h` (read at 5d968cf38, August 2026). Everything is little-endian and
//! packed; `name` is bytes up to a zero.
//!
//! ```text
//! cameras.bin   u64 count, then each: u32 CAMERA_ID, i32 model, u64 width, u64 height,
//!               f64 parameters (as many as the model has)
//! images.bin    u64 count, then each: u32 IMAGE_ID, f64 QW QX QY QZ TX TY TZ, u32 CAMERA_ID, name,
//!               u64 count of points, then each: f64 X Y, u64 POINT3D_ID (2^64 - 1 for none)
//! points3D.bin  u64 count, then each: u64 POINT3D_ID, f64 X Y Z, u8 R G B, f64 ERROR,
//!               u64 track length, then each: u32 IMAGE_ID, u32 POINT2D_IDX
//! ```
//!
//! The meanings are those of the text model (`text.rs`). Counts are believed only as far as
//! the file has bytes for them, and nothing is allocated by a count. Bytes after the last record
//! are an error: a count that is too low would leave out photos without a word.

use glam::{DVec2, DVec3};

use crate::camera::Camera;
use crate::fault::Fault;

use super::models::Model;
use super::{Image, Point, pose};

const DAMAGED: &str = "the file is damaged or cut off: copy it, or export the model, again";

/// The least bytes of a record: a camera without parameters, an image with an empty name and no
/// points, a point without a track, an observation, a track element.
const CAMERA_BYTES: u64 = 24;
const IMAGE_BYTES: u64 = 73;
const POINT_BYTES: u64 = 51;
const OBSERVATION_BYTES: u64 = 24;
const TRACK_BYTES: u64 = 8;

/// What is left of a file, and which of its records is being read.
struct Records<'a> {
    rest: &'a [u8],
    kind: &'static str,
    count: u64,
    ordinal: u64,
}

impl<'a> Records<'a> {
    /// The records of a file that starts with their count.
    fn new(bytes: &'a [u8], kind: &'static str, least_bytes: u64) -> Result<Self, Fault> {
        let mut records = Self {
            rest: bytes,
            kind,
            count: 0,
            ordinal: 0,
        };
        records.count = records.count(least_bytes, "records")?;
        Ok(records)
    }

    /// Goes on to the next record; false after the last one.
    fn advance(&mut self) -> Result<bool, Fault> {
        if self.ordinal < self.count {
            self.ordinal += 1;
            return Ok(true);
        }
        if self.rest.is_empty() {
            return Ok(false);
        }
        let (left, count, kind) = (self.rest.len(), self.count, self.kind);
        let what = format!("{left} bytes are left over after the last {kind} (of {count})");
        Err(Fault::new(what, DAMAGED))
    }

    fn fault(&self, what: &str) -> Fault {
        let kind = self.kind;
        let place = match self.ordinal {
            0 => format!("the count of {kind}s"),
            ordinal => format!("{kind} {ordinal}"),
        };
        Fault::new(format!("{place}: {what}"), DAMAGED)
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let (taken, rest) = self
            .rest
            .split_first_chunk()
            .ok_or_else(|| self.fault("the file ends inside it"))?;
        self.rest = rest;
        Ok(*taken)
    }

    fn u32(&mut self) -> Result<u32, Fault> {
        Ok(u32::from_le_bytes(self.take()?))
    }

    fn u64(&mut self) -> Result<u64, Fault> {
        Ok(u64::from_le_bytes(self.take()?))
    }

    /// A finite number.
    fn number(&mut self, name: &str) -> Result<f64, Fault> {
        let number = f64::from_le_bytes(self.take()?);
        if number.is_finite() {
            return Ok(number);
        }
        Err(self.fault(&format!("{name} is {number}, not finite")))
    }

    fn triple(&mut self, name: &str) -> Result<DVec3, Fault> {
        Ok(DVec3::new(
            self.number(name)?,
            self.number(name)?,
            self.number(name)?,
        ))
    }

    /// A count of things of at least `least_bytes` each, for which the file has room.
    fn count(&mut self, least_bytes: u64, things: &str) -> Result<u64, Fault> {
        let count = self.u64()?;
        let room = self.rest.len() as u64 / least_bytes;
        if count <= room {
            return Ok(count);
        }
        let what = format!("it claims {count} {things}, the rest of the file holds {room} at most");
        Err(self.fault(&what))
    }

    /// Text up to a zero byte.
    fn name(&mut self) -> Result<String, Fault> {
        let end = self.rest.iter().position(|&byte| byte == 0);
        let (name, rest) = end
            .and_then(|end| self.rest.split_at_checked(end))
            .ok_or_else(|| self.fault("its name does not end before the file does"))?;
        let name = std::str::from_utf8(name)
            .map_err(|_| self.fault("its name is not UTF-8"))?
            .to_owned();
        self.rest = rest;
        self.take::<1>()?;
        Ok(name)
    }
}

/// The cameras of `cameras.bin` with their ids, in the file's order.
///
/// # Errors
/// Bytes that are not what the format says, or a lens that fragscale does not know.
pub(super) fn read_cameras(bytes: &[u8]) -> Result<Vec<(u32, Camera)>, Fault> {
    let mut records = Records::new(bytes, "camera", CAMERA_BYTES)?;
    let mut cameras = Vec::new();
    while records.advance()? {
        let id = records.u32()?;
        let model = Model::by_id(i32::from_le_bytes(records.take()?))
            .map_err(|fault| records.fault(&fault.what))?;
        let size = [records.u64()?, records.u64()?];
        let mut parameters = Vec::new();
        for _ in 0..model.parameters() {
            parameters.push(records.number("a parameter")?);
        }
        cameras.push((id, model.camera(id, size, &parameters)?));
    }
    Ok(cameras)
}

/// The images of `images.bin`, in the file's order, each with the measured points that belong to
/// a 3D point.
///
/// # Errors
/// Bytes that are not what the format says.
pub(super) fn read_images(bytes: &[u8]) -> Result<Vec<Image>, Fault> {
    let mut records = Records::new(bytes, "image", IMAGE_BYTES)?;
    let mut images = Vec::new();
    while records.advance()? {
        let id = records.u32()?;
        let mut quaternion = [0.0; 4];
        for (part, name) in quaternion.iter_mut().zip(["QW", "QX", "QY", "QZ"]) {
            *part = records.number(name)?;
        }
        let translation = records.triple("its translation")?;
        let camera = records.u32()?;
        let name = records.name()?;
        if name.is_empty() {
            return Err(records.fault("it has no name"));
        }
        let pose = pose(quaternion, translation).map_err(|e| records.fault(&e))?;
        let mut observed = Vec::new();
        for _ in 0..records.count(OBSERVATION_BYTES, "measured points")? {
            let (x, y) = (
                records.number("a measured X")?,
                records.number("a measured Y")?,
            );
            let point = records.u64()?;
            if point != u64::MAX {
                observed.push((point, DVec2::new(x, y)));
            }
        }
        images.push(Image {
            id,
            line: None,
            camera,
            name,
            pose,
            observed,
        });
    }
    Ok(images)
}

/// The points of `points3D.bin`, in the file's order.
///
/// # Errors
/// Bytes that are not what the format says.
pub(super) fn read_points(bytes: &[u8]) -> Result<Vec<Point>, Fault> {
    let mut records = Records::new(bytes, "point", POINT_BYTES)?;
    let mut points = Vec::new();
    while records.advance()? {
        points.push(Point {
            id: records.u64()?,
            position: records.triple("its position")?,
            color: records.take()?,
        });
        // ERROR, then the track; both are told by the images too.
        records.take::<8>()?;
        for _ in 0..records.count(TRACK_BYTES, "track elements")? {
            records.take::<8>()?;
        }
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use glam::DMat3;
    use proptest::prelude::*;

    use super::*;

    /// Bytes of a file, one number after the other.
    #[derive(Default, Clone)]
    struct File(Vec<u8>);

    impl File {
        fn u32(mut self, value: u32) -> Self {
            self.0.extend(value.to_le_bytes());
            self
        }
        fn u64(mut self, value: u64) -> Self {
            self.0.extend(value.to_le_bytes());
            self
        }
        fn f64(mut self, values: &[f64]) -> Self {
            self.0.extend(values.iter().flat_map(|v| v.to_le_bytes()));
            self
        }
        fn bytes(mut self, bytes: &[u8]) -> Self {
            self.0.extend(bytes);
            self
        }
    }

    fn camera(model: u32) -> File {
        File::default().u64(1).u32(3).u32(model).u64(4000).u64(3000)
    }

    fn cameras() -> Vec<u8> {
        let second = File::default().u32(8).u32(4).u64(10).u64(20);
        let mut file = camera(1).f64(&[900.0, 910.0, 2000.5, 1500.25]);
        file.0[0] = 2;
        let lens = [5.0, 5.0, 5.0, 10.0, 0.1, 0.2, 0.3, 0.4];
        file.bytes(&second.f64(&lens).0).0
    }

    fn image(id: u32, quaternion: [f64; 4], name: &[u8]) -> File {
        let pose = File::default().u32(id).f64(&quaternion);
        pose.f64(&[1.0, 2.0, 3.0]).u32(3).bytes(name)
    }

    const QUARTER: [f64; 4] = [1.0, 0.0, 0.0, 1.0];

    fn images() -> Vec<u8> {
        let first = image(4, QUARTER, b"first photo.jpg\0").u64(2);
        let seen = first.f64(&[10.5, 20.25]).u64(77);
        let all = seen.f64(&[1.0, 2.0]).u64(u64::MAX);
        let second = image(2, [1.0, 0.0, 0.0, 0.0], b"b.jpg\0").u64(0);
        File::default().u64(2).bytes(&all.0).bytes(&second.0).0
    }

    fn points() -> Vec<u8> {
        let first = File::default().u64(2).u64(77).f64(&[1.0, 2.5, -30.0]);
        let track = first.bytes(&[255, 0, 128]).f64(&[0.5]).u64(1).u32(4).u32(0);
        let second = track.u64(5).f64(&[0.0; 3]).bytes(&[1, 2, 3]);
        second.f64(&[f64::NAN]).u64(0).0
    }

    #[test]
    fn the_three_files_are_read() {
        let read = read_cameras(&cameras()).unwrap();
        assert_eq!((read[0].0, read[0].1.name.as_str()), (3, "3"));
        assert_eq!(
            (read[0].1.width, read[0].1.fy, read[0].1.cy),
            (4000, 910.0, 1500.25)
        );
        assert_eq!(read[1].1.distortion.name(), "brown");

        // R = [0 -1 0; 1 0 0; 0 0 1], so the centre is -R^T (1, 2, 3) = (-2, 1, -3).
        let read = read_images(&images()).unwrap();
        assert_eq!((read[0].id, read[0].camera), (4, 3));
        assert_eq!(read[0].name, "first photo.jpg");
        assert!((read[0].pose.center - DVec3::new(-2.0, 1.0, -3.0)).length() < 1e-15);
        let world_from_camera = DMat3::from_cols(DVec3::NEG_Y, DVec3::X, DVec3::Z);
        assert!(read[0].pose.rotation.abs_diff_eq(world_from_camera, 1e-15));
        assert_eq!(read[0].observed, [(77, DVec2::new(10.5, 20.25))]);
        assert_eq!(read[1].pose.center, DVec3::new(-1.0, -2.0, -3.0));

        let read = read_points(&points()).unwrap();
        assert_eq!((read[0].id, read[0].color), (77, [255, 0, 128]));
        assert_eq!(read[0].position, DVec3::new(1.0, 2.5, -30.0));
        assert_eq!(read[1].id, 5);
    }

    #[test]
    fn cut_off_anywhere_is_an_error() {
        let (cameras, images, points) = (cameras(), images(), points());
        for end in 0..cameras.len() {
            assert!(read_cameras(&cameras[..end]).is_err(), "{end}");
        }
        for end in 0..images.len() {
            assert!(read_images(&images[..end]).is_err(), "{end}");
        }
        for end in 0..points.len() {
            assert!(read_points(&points[..end]).is_err(), "{end}");
        }
        for mut file in [cameras, images, points] {
            file.push(0);
            assert!(read_cameras(&file).is_err());
            assert!(read_images(&file).is_err());
            assert!(read_points(&file).is_err());
        }
    }

    #[test]
    fn lying_counts_are_named() {
        let fault = |bytes: &[u8]| read_images(bytes).unwrap_err().to_string();
        for count in [3, 4_000_000_000, 1 << 60, u64::MAX] {
            let mut file = images();
            file[..8].copy_from_slice(&count.to_le_bytes());
            assert!(read_images(&file).is_err());
            let mut file = cameras();
            file[..8].copy_from_slice(&count.to_le_bytes());
            assert!(read_cameras(&file).is_err());
            let mut file = points();
            file[..8].copy_from_slice(&count.to_le_bytes());
            assert!(read_points(&file).is_err());
        }
        let one = File::default().u64(1);
        let many = one.bytes(&image(1, QUARTER, b"a\0").u64(1 << 60).0).0;
        assert!(fault(&many).starts_with("image 1: it claims 1152921504606846976 measured"));
        let endless = File::default()
            .u64(1)
            .bytes(&image(1, QUARTER, &[b'a'; 5000]).0);
        assert!(fault(&endless.0).starts_with("image 1: its name does not end"));
        let track = File::default().u64(1).u64(1).f64(&[0.0; 3]);
        let track = track.bytes(&[0; 3]).f64(&[0.0]).u64(1 << 61).0;
        let fault = read_points(&track).unwrap_err().to_string();
        assert!(fault.starts_with("point 1: it claims"), "{fault}");
        // Fewer than there are.
        let mut file = images();
        file[0] = 1;
        assert!(read_images(&file).unwrap_err().what.contains("left over"));
    }

    #[test]
    fn impossible_values_are_refused() {
        let refused = |image: File| {
            let file = File::default().u64(1).bytes(&image.u64(0).0).0;
            let what = read_images(&file).unwrap_err().what;
            assert!(what.starts_with("image 1: "), "{what}");
        };
        refused(image(1, [0.0; 4], b"a\0"));
        refused(image(1, [f64::NAN; 4], b"a\0"));
        refused(image(1, [1e200; 4], b"a\0"));
        refused(image(1, QUARTER, b"\0"));
        refused(image(1, QUARTER, b"\xff\xfe\0"));
        for model in [u32::MAX, 18, 7] {
            assert!(read_cameras(&camera(model).f64(&[1.0; 5]).0).is_err());
        }
        for bad in [f64::NAN, f64::NEG_INFINITY, 0.0] {
            assert!(read_cameras(&camera(0).f64(&[bad, 1.0, 1.0]).0).is_err());
        }
        let what = read_cameras(&camera(99).0).unwrap_err().what;
        assert_eq!(what, "camera 1: COLMAP has no camera model number 99");
    }

    fn read_all(bytes: &[u8]) {
        let _ = read_cameras(bytes);
        let _ = read_images(bytes);
        let _ = read_points(bytes);
    }

    proptest! {
        #[test]
        fn no_bytes_panic(count in 0..3_u64, bytes: Vec<u8>) {
            read_all(&bytes);
            read_all(&[&count.to_le_bytes(), &bytes[..]].concat());
        }

        #[test]
        fn no_mutated_file_panics(which in 0..3_usize, at in 0..400_usize, put: Vec<u8>) {
            let mut bytes = [cameras(), images(), points()][which].clone();
            let at = at % bytes.len();
            let end = (at + put.len()).min(bytes.len());
            bytes.splice(at..end, put);
            read_all(&bytes);
        }
    }
}
