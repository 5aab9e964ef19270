//! The cameras of the Middlebury multi-view stereo data sets, `*_par.txt`, from the README beside them
//! (vision.middlebury.edu/mview/data).
//!
//! ```text
//! <count of photos>
//! name k11 k12 k13 k21 k22 k23 k31 k32 k33 r11 ... r33 t1 t2 t3
//! ```
//!
//! P = K [R t]: R and t are `camera_from_world` with camera axes x right, y down, z forward; "the image
//! origin is top-left". Each photo has a camera of its own. There is no
//! distortion and no image size: that is taken from the photos beside the file. Which point of the
//! first pixel is the origin is not said; K is taken as it is.

use std::collections::HashSet;

use crate::camera::{Camera, Distortion};
use crate::fault::Fault;
use crate::packages::reconstruction::{ImageUnit, Origin, PosedPhoto, Reconstruction, Sizes};
use crate::poses::rounded_rotation::{from_row_major, pose_from_camera_from_world};
use crate::text::fields::{Fields, shown};
use glam::DVec3;

const REMEDY: &str = "each line is a name and 21 numbers: K, R, t";

/// Reads the cameras, whose sizes [`Reconstruction::set_sizes`] has to be told.
///
/// # Errors
/// With the line of what is not as the format says.
pub(crate) fn read(text: &str) -> Result<Reconstruction, Fault> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty());
    let Some((line, first)) = lines.next() else {
        return Err(Fault::new("it is empty", REMEDY));
    };
    let count: u64 = Fields::new(line, first, REMEDY).whole("the count of photos")?;
    let mut found = Reconstruction {
        package: "middlebury",
        sizes: Sizes::Unknown {
            unit: ImageUnit::Pixel,
            principal_points_from: Origin::Corner,
        },
        ..Reconstruction::default()
    };
    let mut names = HashSet::new();
    let mut read = 0;
    for (line, text) in lines {
        let photo = read_photo(line, text, &mut found.cameras)?;
        if !names.insert(photo.name.clone()) {
            let what = format!("the photo '{}' is there twice", photo.name);
            return Err(Fault::at(line, what, REMEDY));
        }
        found.photos.push(photo);
        read += 1;
    }
    if read != count || read == 0 {
        let what = format!("it announces {count} photos and holds {read}");
        return Err(Fault::at(line, what, "copy the whole file"));
    }
    Ok(found)
}

fn read_photo(line: u64, text: &str, cameras: &mut Vec<Camera>) -> Result<PosedPhoto, Fault> {
    let mut fields = Fields::new(line, text, REMEDY);
    let name = fields.word("the photo's name")?.to_owned();
    let mut matrix = |name: &str| -> Result<[f64; 9], Fault> {
        let mut matrix = [0.0; 9];
        for entry in &mut matrix {
            *entry = fields.number(name)?;
        }
        Ok(matrix)
    };
    let (k, r) = (matrix("an entry of K")?, matrix("an entry of R")?);
    let translation: DVec3 = fields.triple("an entry of t")?;
    if !fields.rest().is_empty() {
        let rest = shown(fields.rest());
        return Err(fields.fault(format!("'{rest}' where the line should end")));
    }
    let [fx, skew, cx, below, fy, cy, a, b, one] = k;
    if [below, a, b] != [0.0; 3] || one == 0.0 {
        return Err(fields.fault("K is not [fx skew cx, 0 fy cy, 0 0 1]"));
    }
    let camera = Camera {
        name: name.clone(),
        width: 0,
        height: 0,
        fx: fx / one,
        fy: fy / one,
        cx: cx / one,
        cy: cy / one,
        skew: skew / one,
        distortion: Distortion::None,
    };
    let with_size = Camera {
        width: 1,
        height: 1,
        ..camera.clone()
    };
    with_size
        .validate()
        .map_err(|e| fields.fault(e.to_string()))?;
    let pose = pose_from_camera_from_world(from_row_major(r), translation);
    cameras.push(camera);
    Ok(PosedPhoto {
        name,
        camera: cameras.len() - 1,
        pose: pose.map_err(|e| fields.fault(format!("R: {e}")))?,
    })
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec2};

    use super::*;
    use fragscale_test_data::shared_data;

    /// Looks along world x with the image's right to world -y, from (5, 6, 7).
    const ONE: &str = "1\r\na.png 100 0.5 320 0 101 240 0 0 1 0 -1 0 0 0 -1 1 0 0 6 7 -5\r\n";

    #[test]
    fn rows_are_camera_from_world() {
        let found = read(ONE).unwrap();
        let pose = found.photos[0].pose;
        assert_eq!(
            pose.rotation,
            DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X)
        );
        assert_eq!(pose.center, DVec3::new(5.0, 6.0, 7.0));
        let camera = &found.cameras[0];
        assert_eq!((camera.fx, camera.skew, camera.cx), (100.0, 0.5, 320.0));
        assert_eq!(
            (camera.fy, camera.cy, camera.name.as_str()),
            (101.0, 240.0, "a.png")
        );
        let mut sized = found;
        sized.set_sizes(|_| Some((640, 480)));
        assert_eq!(sized.cameras[0].cx, 320.0);
    }

    #[test]
    fn what_is_wrong_is_placed() {
        for (from, to, line, named) in [
            ("1\r\n", "x\r\n", 1, "count"),
            ("1\r\n", "2\r\n", 1, "announces 2 photos and holds 1"),
            ("1\r\n", "99999999999999999999\r\n", 1, "count"),
            ("0 0 1 0 -1", "0 0 0 0 -1", 2, "K is not"),
            ("100 0.5", "-100 0.5", 2, "fx"),
            ("100 0.5", "nan 0.5", 2, "K is 'nan'"),
            ("1 0 0 6", "1 1 0 6", 2, "R: "),
            (" -5", "", 2, "t should be"),
            (" -5", " -5 6", 2, "should end"),
        ] {
            assert!(ONE.contains(from), "{from}");
            let fault = read(&ONE.replacen(from, to, 1)).unwrap_err();
            assert_eq!(fault.line, Some(line), "{to}");
            assert!(fault.what.contains(named), "{to}: {fault}");
        }
        let twice = format!("{}{}", ONE.replacen('1', "2", 1), &ONE[3..]);
        assert!(read(&twice).unwrap_err().what.contains("twice"));
        assert!(read("").is_err() && read("0\n").is_err());
        for cut in 0..ONE.trim_end().len() - 1 {
            assert!(read(&ONE[..cut]).is_err(), "cut at {cut}");
        }
    }

    /// The published bounding box is seen by every camera around its middle; the README of the data
    /// says that the object is partly outside in some.
    #[test]
    fn the_dinosaur_is_in_view() {
        let Some(file) = shared_data("middlebury-dino/dinoSR_par.txt") else {
            return;
        };
        let mut found = read(&std::fs::read_to_string(file).unwrap()).unwrap();
        found.set_sizes(|_| Some((640, 480)));
        assert_eq!(found.photos.len(), 16);
        let low = DVec3::new(-0.061_897, -0.018_874, -0.057_845);
        let high = DVec3::new(0.010_897, 0.068_227, 0.015_495);
        for photo in &found.photos {
            let camera = &found.cameras[photo.camera];
            let middle = photo.pose.camera_from_world((low + high) / 2.0);
            let pixel = camera.pixel_undistorted(middle).unwrap();
            assert!(
                (pixel - DVec2::new(320.0, 240.0)).length() < 120.0,
                "{pixel}"
            );
            // On a ring of 0.6 to 0.7 m around it.
            assert!((0.5..0.8).contains(&photo.pose.center.length()));
        }
    }
}
