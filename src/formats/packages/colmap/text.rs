//! COLMAP's text model, from COLMAP's documentation ("Output Format") and
//! `src/colmap/scene/reconstruction_io_text.cc` (read at 5d968cf38, August 2026).
//!
//! Lines that are empty or start with `#` are skipped, except where noted. Fields are separated by
//! white space.
//!
//! ```text
//! cameras.txt   CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]          one line a camera
//! images.txt    IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME   two lines an image
//!               (X Y POINT3D_ID)[]
//! points3D.txt  POINT3D_ID X Y Z R G B ERROR (IMAGE_ID POINT2D_IDX)[]   one line a point
//! ```
//!
//! - QW..TZ is `camera_from_world`: x right, y down, z forward; the centre is `-R^T T`.
//! - An image's second line follows at once and may be empty; of the last image it may be missing.
//!   POINT3D_ID is -1 where the measured point belongs to no 3D point (or 2^64 - 1, which is the
//!   same number in COLMAP's binary files).
//! - NAME is written as it is, so it may hold spaces; COLMAP itself then reads its first word only,
//!   fragscale the rest of the line.
//! - X, Y count from the outer corner of the top-left pixel. ERROR and the tracks are not needed:
//!   the images' second lines say the same.

use crate::camera::Camera;
use crate::fault::Fault;

use super::models::Model;
use super::{Image, Point, pose};
use crate::text::fields::{Fields, shown};

const EXPORT: &str =
    "export the model again (colmap model_converter --output_type TXT, or BIN, which is exact)";

/// The lines of a text with their numbers from 1, without a byte order mark.
fn lines(text: &str) -> impl Iterator<Item = (u64, &str)> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    (1..).zip(text.lines())
}

/// Whether a line says nothing.
fn is_idle(line: &str) -> bool {
    let line = line.trim_start();
    line.is_empty() || line.starts_with('#')
}

/// The cameras of `cameras.txt` with their ids, in the file's order.
///
/// # Errors
/// A line that is no camera of COLMAP's, or a lens that fragscale does not know.
pub(super) fn read_cameras(text: &str) -> Result<Vec<(u32, Camera)>, Fault> {
    let mut cameras = Vec::new();
    for (number, line) in lines(text).filter(|(_, line)| !is_idle(line)) {
        let mut fields = Fields::new(number, line, EXPORT);
        let here = |fault: Fault| Fault {
            line: Some(number),
            ..fault
        };
        let id = fields.whole("the CAMERA_ID")?;
        let model = Model::by_name(fields.word("the MODEL")?).map_err(here)?;
        let size = [fields.whole("the WIDTH")?, fields.whole("the HEIGHT")?];
        let mut parameters = Vec::new();
        while !fields.rest().is_empty() {
            parameters.push(fields.number("a parameter")?);
        }
        let camera = model.camera(id, size, &parameters).map_err(here)?;
        cameras.push((id, camera));
    }
    Ok(cameras)
}

/// The images of `images.txt`, in the file's order, each with the measured points that belong to
/// a 3D point.
///
/// # Errors
/// A line that is not what the format says.
pub(super) fn read_images(text: &str) -> Result<Vec<Image>, Fault> {
    let mut images = Vec::new();
    let mut lines = lines(text);
    while let Some((number, line)) = lines.next() {
        if is_idle(line) {
            continue;
        }
        let mut fields = Fields::new(number, line, EXPORT);
        let id = fields.whole("the IMAGE_ID")?;
        let mut quaternion = [0.0; 4];
        for (part, name) in quaternion.iter_mut().zip(["QW", "QX", "QY", "QZ"]) {
            *part = fields.number(name)?;
        }
        let translation = fields.triple("the translation TX TY TZ")?;
        let camera = fields.whole("the CAMERA_ID")?;
        let name = fields.rest().to_owned();
        if name.is_empty() {
            return Err(fields.fault("the image has no NAME"));
        }
        let pose = pose(quaternion, translation).map_err(|e| fields.fault(e))?;
        let mut observed = Vec::new();
        if let Some((number, line)) = lines.next() {
            let mut fields = Fields::new(number, line, POINTS);
            while !fields.rest().is_empty() {
                let pixel = fields.pair("a measured X Y")?;
                if let Some(point) = point_id(&mut fields)? {
                    observed.push((point, pixel));
                }
            }
        }
        images.push(Image {
            id,
            line: Some(number),
            camera,
            name,
            pose,
            observed,
        });
    }
    Ok(images)
}

const POINTS: &str = "the line after an image's holds its points as X Y POINT3D_ID, and is left \
                      empty where there are none: export the model again";

/// The next field as a POINT3D_ID, `None` for "no point".
fn point_id(fields: &mut Fields<'_>) -> Result<Option<u64>, Fault> {
    let word = fields.word("a POINT3D_ID")?;
    match word.parse::<u64>() {
        Ok(id) => Ok(Some(id).filter(|&id| id != u64::MAX)),
        Err(_) if word == "-1" => Ok(None),
        Err(_) => Err(fields.fault(format!("'{}' is no POINT3D_ID", shown(word)))),
    }
}

/// The points of `points3D.txt`, in the file's order.
///
/// # Errors
/// A line that is not what the format says.
pub(super) fn read_points(text: &str) -> Result<Vec<Point>, Fault> {
    let mut points = Vec::new();
    for (number, line) in lines(text).filter(|(_, line)| !is_idle(line)) {
        let mut fields = Fields::new(number, line, EXPORT);
        points.push(Point {
            id: fields.whole("the POINT3D_ID")?,
            position: fields.triple("the position X Y Z")?,
            color: fields.color()?,
        });
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec2, DVec3};
    use proptest::prelude::*;

    use super::*;

    const CAMERAS: &str =
        "# a comment\n\n1 PINHOLE 4000 3000 900 910 2000.5 1500.25\n 9 SIMPLE_FISHEYE 10 20 5 5 10";
    const IMAGES: &str = "# IMAGE_ID ...\n\
        4 0.70710678118654752 0 0 0.70710678118654752 1 2 3 9 first photo.jpg\n\
        10.5 20.25 77 1 2 -1 3 4 18446744073709551615 30 40 5\n\
        # between\n\
        2 -3 0 0 0 0 0 0 1 sub/b.jpg\n\
        \n\
        3 1 0 0 0 0 0 0 1 c.jpg";
    const POINTS_3D: &str = "77 1 2.5 -3e1 255 0 128 0.5 4 0\n5 0 0 0 1 2 3 -1\n\n";

    #[test]
    fn cameras_are_read() {
        let cameras = read_cameras(CAMERAS).unwrap();
        let ids: Vec<u32> = cameras.iter().map(|(id, _)| *id).collect();
        assert_eq!(ids, [1, 9]);
        let first = &cameras[0].1;
        assert_eq!((first.width, first.height), (4000, 3000));
        assert_eq!(
            (first.fx, first.fy, first.cx, first.cy),
            (900.0, 910.0, 2000.5, 1500.25)
        );
        assert_eq!(cameras[1].1.distortion.name(), "fisheye");
    }

    /// The quaternion turns by 90 degrees about z, so R = [0 -1 0; 1 0 0; 0 0 1] and the centre is
    /// -R^T (1, 2, 3) = (-2, 1, -3).
    #[test]
    fn images_are_read() {
        let images = read_images(IMAGES).unwrap();
        assert_eq!(images.len(), 3);
        let first = &images[0];
        assert_eq!(
            (first.id, first.camera, first.line, first.name.as_str()),
            (4, 9, Some(2), "first photo.jpg")
        );
        let center = DVec3::new(-2.0, 1.0, -3.0);
        assert!((first.pose.center - center).length() < 1e-15);
        let world_from_camera = DMat3::from_cols(DVec3::NEG_Y, DVec3::X, DVec3::Z);
        assert!(first.pose.rotation.abs_diff_eq(world_from_camera, 1e-15));
        assert_eq!(
            first.observed,
            [(77, DVec2::new(10.5, 20.25)), (5, DVec2::new(30.0, 40.0))]
        );
        // A quaternion of another length and sign is the same rotation.
        assert_eq!(images[1].pose.rotation, DMat3::IDENTITY);
        assert_eq!(images[1].name, "sub/b.jpg");
        assert!(images[1].observed.is_empty() && images[2].observed.is_empty());
    }

    #[test]
    fn points_are_read() {
        let points = read_points(POINTS_3D).unwrap();
        assert_eq!((points[0].id, points[0].color), (77, [255, 0, 128]));
        assert_eq!(points[0].position, DVec3::new(1.0, 2.5, -30.0));
        assert_eq!(points.len(), 2);
    }

    #[test]
    fn windows_line_ends_and_a_mark_change_nothing() {
        let windows = |text: &str| format!("\u{feff}{}", text.replace('\n', "\r\n"));
        assert_eq!(read_cameras(&windows(CAMERAS)), read_cameras(CAMERAS));
        assert_eq!(read_images(&windows(IMAGES)), read_images(IMAGES));
        assert_eq!(read_points(&windows(POINTS_3D)), read_points(POINTS_3D));
    }

    #[test]
    fn faults_name_their_line() {
        for (text, line) in [
            ("\nx PINHOLE 1 1 1 1 1 1", 2),
            ("1 PINHOLD 1 1 1 1 1 1", 1),
            ("1 PINHOLE 1 1 1 1 1", 1),
            ("1 PINHOLE 1 1 1 1 1 nan", 1),
            ("1 PINHOLE 1.5 1 1 1 1 1", 1),
            ("1 PINHOLE 1 -1 1 1 1 1", 1),
            ("1 PINHOLE 1 1 0 1 1 1", 1),
            ("# \n1 FOV 1 1 1 1 1 1 1", 2),
            ("1", 1),
        ] {
            assert_eq!(read_cameras(text).unwrap_err().line, Some(line), "{text}");
        }
        for (text, line) in [
            ("1 1 0 0 0 0 0 0 1", 1),
            ("1 1 0 0 0 0 0 0 -1 a", 1),
            ("1 0 0 0 0 0 0 0 1 a", 1),
            ("1 1 0 0 inf 0 0 0 1 a", 1),
            ("1 1e200 0 0 0 0 0 0 1 a", 1),
            ("1 0.9238795 0 0 0.3826834 1.7e308 1.7e308 0 1 a", 1),
            ("1 1 0 0 0 0 0 0 1 a\n1 2 3 4", 2),
            ("1 1 0 0 0 0 0 0 1 a\n1 2 -2", 2),
            ("1 1 0 0 0 0 0 0 1 a\n1 2 3.5", 2),
            // The empty second line was lost.
            ("1 1 0 0 0 0 0 0 1 a\n2 1 0 0 0 0 0 0 1 b", 2),
        ] {
            assert_eq!(read_images(text).unwrap_err().line, Some(line), "{text}");
        }
        for (text, line) in [
            ("1 0 0 0 1 2", 1),
            ("1 0 0 0 1 2 256 0", 1),
            ("\n\n-1 0 0 0 1 2 3 0", 3),
            ("1 0 0 1e400 1 2 3 0", 1),
        ] {
            assert_eq!(read_points(text).unwrap_err().line, Some(line), "{text}");
        }
    }

    fn read_all(text: &str) {
        let _ = read_cameras(text);
        let _ = read_images(text);
        let _ = read_points(text);
    }

    proptest! {
        #[test]
        fn no_text_panics(text in "\\PC*") {
            read_all(&text);
        }

        #[test]
        fn no_mutated_file_panics(
            which in 0..3_usize,
            at in 0..400_usize,
            put in prop_oneof!["\\PC{0,3}", "[0-9 \n.eE#-]{0,4}"],
        ) {
            let text = [CAMERAS, IMAGES, POINTS_3D][which];
            let mut chars: Vec<char> = text.chars().collect();
            let at = at % chars.len();
            chars.splice(at..=at, put.chars());
            read_all(&chars.into_iter().collect::<String>());
        }
    }
}
