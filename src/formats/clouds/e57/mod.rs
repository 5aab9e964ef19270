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

mod layout;

use std::io::{Read, Seek, SeekFrom};

use e57::{E57Reader, Transform};
use glam::{DMat3, DQuat, DVec3};

use self::layout::Layout;
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

#[cfg(test)]
mod tests;
