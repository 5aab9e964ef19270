//! Cameras in OpenCV's FileStorage, as YAML, JSON or XML.
//!
//! Written from OpenCV's `persistence_yml.cpp`, `persistence_json.cpp` and `persistence_xml.cpp`
//! (modules/core/src), and from what its programs store: `samples/cpp/calibration.cpp`, the
//! tutorial's `camera_calibration.cpp`, `apps/interactive-calibration`, `samples/cpp/
//! stereo_calib.cpp`, and scripts of the Python tutorial. A matrix is
//!
//! ```text
//! camera_matrix: !!opencv-matrix       <camera_matrix type_id="opencv-matrix">
//!    rows: 3                             <rows>3</rows>
//!    cols: 3                             <cols>3</cols>
//!    dt: d                               <dt>d</dt>
//!    data: [ 535.9, 0., ... ]            <data>535.9 0. ...</data></camera_matrix>
//! ```
//!
//! and in JSON a mapping with `"type_id": "opencv-matrix"`. Nobody agrees on the keys, so they are
//! compared without case and underscores:
//!
//! | what | keys |
//! |---|---|
//! | K | `camera_matrix`, `Camera_Matrix`, `cameraMatrix`, `K`, `M1`, `mtx` |
//! | coefficients | `distortion_coefficients`, `Distortion_Coefficients`, `dist_coeffs`, `distCoeffs`, `D`, `D1`, `dist` |
//! | size | `image_width` and `image_height`, `image_Width` and `image_Height`; or both in one list: `cameraResolution`, `image_size`, `img_size` |
//! | lens | `fisheye_model`: 1 is cv::fisheye's, 0 or none the other; or `distortion_model` as in ROS |
//! | name | `camera_name` |
//!
//! Without `distortion_model` the count of the coefficients tells the model (`opencv_camera.rs`);
//! note that only `fisheye_model` sets four coefficients of cv::fisheye apart from k1 k2 p1 p2. Two
//! keys for the same thing, and a stereo pair (`M1` and `M2`), are refused: which one is meant?

use crate::camera::Camera;
use crate::fault::Fault;

use super::opencv_camera::{self, Matrix};
use super::opencv_xml;
use super::ros_camera::WHICH_FILES;
use super::yaml_tree::{Entry, Node, quoted};

const K_KEYS: &[&str] = &["cameramatrix", "k", "m1", "mtx"];
const D_KEYS: &[&str] = &["distortioncoefficients", "distcoeffs", "d", "d1", "dist"];
const SIZE_KEYS: &[&str] = &["cameraresolution", "imagesize", "imgsize"];
const SECOND_KEYS: &[&str] = &["m2", "d2"];

/// What to do about a file without a size.
const SIZE_REMEDY: &str = "write the camera inline in flight.toml, with width and height and \
    pixel_origin = \"center\", or add image_width and image_height to the file";

/// Reads the camera of a YAML (or JSON) FileStorage.
///
/// # Errors
/// Where the text is none, or what it says is no camera that fragscale can model.
#[cfg(test)]
pub(super) fn read_yaml(text: &str) -> Result<Camera, Fault> {
    from_tree(&super::yaml_tree::first_document(text)?)
}

/// Reads the camera of an XML FileStorage.
///
/// # Errors
/// Where the text is none, or what it says is no camera that fragscale can model.
pub(super) fn read_xml(text: &str) -> Result<Camera, Fault> {
    from_tree(&opencv_xml::tree(text)?)
}

/// Whether a tree holds a matrix as OpenCV writes it.
pub(super) fn has_matrix(tree: &Node) -> bool {
    let entries = tree.entries("", "").unwrap_or_default();
    entries.iter().any(|entry| {
        let type_id = entry.node.get("type_id");
        let type_id = type_id.and_then(|entry| entry.node.text("").ok());
        entry.node.tag.as_deref().or(type_id) == Some("opencv-matrix")
    })
}

/// Reads the camera of a FileStorage, whatever it was written in.
pub(super) fn from_tree(tree: &Node) -> Result<Camera, Fault> {
    let entries = tree.entries("the file", WHICH_FILES)?;
    if let Some(second) = find(entries, SECOND_KEYS)? {
        return Err(Fault::at(
            second.line,
            format!("{} is of a second camera", quoted(&second.key)),
            "copy one camera into a file of its own, as camera_matrix and distortion_coefficients",
        ));
    }
    let k = find(entries, K_KEYS)?.ok_or_else(|| {
        let what = "there is no camera matrix (camera_matrix, cameraMatrix, K, M1 or mtx)";
        Fault::new(what, WHICH_FILES)
    })?;
    let d = find(entries, D_KEYS)?.ok_or_else(|| {
        let what = format!("there are no distortion_coefficients beside {}", k.key);
        Fault::new(what, "add them, with zeros where the lens has none")
    })?;
    let size = size(entries)?;
    let (k, coefficients) = (Matrix::read(k)?, Matrix::read(d)?);
    let model = find(entries, &["distortionmodel"])?;
    let distortion = match (is_fisheye(entries)?, model) {
        (Some(line), Some(model)) => {
            let what = format!("both fisheye_model and {}", model.key);
            return Err(Fault::at(line, what, "remove the wrong one"));
        }
        (Some(_), None) => coefficients.fisheye("the fish-eye model")?,
        (None, Some(model)) => coefficients.lens(model.node.text(&model.key)?, model.line)?,
        (None, None) => coefficients.brown("OpenCV's model", &[4, 5, 8, 12, 14])?,
    };
    let name = match find(entries, &["cameraname"])? {
        Some(entry) => entry.node.text(&entry.key)?,
        None => "",
    };
    opencv_camera::camera(name, size, &k, distortion)
}

/// The only entry whose key is one of these, compared without case and underscores.
fn find<'a>(entries: &'a [Entry], keys: &[&str]) -> Result<Option<&'a Entry>, Fault> {
    let same = |entry: &&Entry| {
        let plain = entry.key.replace('_', "").to_ascii_lowercase();
        keys.contains(&plain.as_str())
    };
    let mut found = entries.iter().filter(same);
    let first = found.next();
    match (first, found.next()) {
        (Some(first), Some(second)) => Err(Fault::at(
            second.line,
            format!("both {} and {}", quoted(&first.key), quoted(&second.key)),
            "remove the wrong one",
        )),
        _ => Ok(first),
    }
}

/// Width and height.
fn size(entries: &[Entry]) -> Result<(u32, u32), Fault> {
    let width = find(entries, &["imagewidth"])?;
    let height = find(entries, &["imageheight"])?;
    let whole = |entry: &Entry| entry.node.whole(&entry.key);
    let pair = match (width, height) {
        (Some(width), Some(height)) => Some((whole(width)?, whole(height)?)),
        _ => None,
    };
    let both = match find(entries, SIZE_KEYS)? {
        Some(entry) => {
            let numbers = Matrix::read(entry)?;
            let [width, height] = numbers.values() else {
                let what = format!("{} is not a width and a height", entry.key);
                return Err(Fault::at(entry.line, what, "write both in brackets"));
            };
            let whole = |value: f64| {
                let fits = value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value);
                // Exact: a whole number in the range of u32.
                fits.then_some(value as u32).ok_or_else(|| {
                    let what = format!("{} has {value}, not a whole number of pixels", entry.key);
                    Fault::at(entry.line, what, "write whole numbers there")
                })
            };
            Some((whole(*width)?, whole(*height)?, entry))
        }
        None => None,
    };
    match (pair, both) {
        (Some(size), None) => Ok(size),
        (None, Some((width, height, _))) => Ok((width, height)),
        (Some(size), Some((width, height, _))) if size == (width, height) => Ok(size),
        (Some((w, h)), Some((width, height, entry))) => {
            let key = &entry.key;
            let what =
                format!("{key} is {width} x {height}, image_width and image_height {w} x {h}");
            Err(Fault::at(entry.line, what, "remove the wrong one"))
        }
        (None, None) => Err(Fault::new("the file has no image size", SIZE_REMEDY)),
    }
}

/// The line of `fisheye_model`, where it says yes.
fn is_fisheye(entries: &[Entry]) -> Result<Option<u64>, Fault> {
    let Some(entry) = find(entries, &["fisheyemodel"])? else {
        return Ok(None);
    };
    match entry.node.text(&entry.key)?.to_ascii_lowercase().as_str() {
        "1" | "true" => Ok(Some(entry.line)),
        "0" | "false" => Ok(None),
        other => {
            let what = format!("{} is {}, not 0 or 1", entry.key, quoted(other));
            Err(Fault::at(entry.line, what, "write 0 or 1 there"))
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::camera::{Brown, Distortion, Fisheye};

    use super::*;

    /// As the tutorial's camera_calibration.cpp writes it.
    fn yaml(before: &str, d: &str) -> String {
        let rows = d.split(',').filter(|part| !part.trim().is_empty()).count();
        format!(
            "%YAML:1.0\n---\ncalibration_time: \"Mon 06 Jul 2020 11:12:13 AM\"\nimage_width: 64\n\
             image_height: 48\n# flags: +fix_k3\nflags: 6144\n{before}camera_matrix: \
             !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 5.05e+01, 0., \
             3.15e+01, 0., 51., 2.35e+01, 0.,\n       0., 1. ]\ndistortion_coefficients: \
             !!opencv-matrix\n   rows: {rows}\n   cols: 1\n   dt: d\n   data: [ {d} ]\n\
             avg_reprojection_error: 3.9e-01\n"
        )
    }

    fn xml(d: &str) -> String {
        let rows = d.split_whitespace().count();
        format!(
            "<?xml version=\"1.0\"?>\n<opencv_storage>\n<calibrationDate>\"Mon 06 Jul 2020\"\
             </calibrationDate>\n<framesCount>12</framesCount>\n<!-- <a> -->\n<cameraResolution>\n  \
             64 48</cameraResolution>\n<cameraMatrix type_id=\"opencv-matrix\">\n  <rows>3</rows>\n  \
             <cols>3</cols>\n  <dt>d</dt>\n  <data>\n    5.05e+01 0. 3.15e+01 0. 51. 2.35e+01 0.\n    \
             0. 1.</data></cameraMatrix>\n<dist_coeffs type_id=\"opencv-matrix\">\n  \
             <rows>{rows}</rows>\n  <cols>1</cols>\n  <dt>d</dt>\n  <data>\n    {d}</data>\
             </dist_coeffs>\n</opencv_storage>\n"
        )
    }

    fn camera(distortion: Distortion) -> Camera {
        Camera {
            name: String::new(),
            width: 64,
            height: 48,
            fx: 50.5,
            fy: 51.0,
            cx: 32.0,
            cy: 24.0,
            skew: 0.0,
            distortion,
        }
    }

    fn brown(coefficients: [f64; 8]) -> Distortion {
        Distortion::Brown(Brown::new(coefficients))
    }

    const FIVE: [f64; 8] = [1.0, 2.0, 3.0, 4.0, 5.0, 0.0, 0.0, 0.0];

    fn what(result: Result<Camera, Fault>) -> (Option<u64>, String) {
        let fault = result.unwrap_err();
        (fault.line, fault.what)
    }

    #[test]
    fn the_same_camera_in_every_style() {
        let expected = camera(brown(FIVE));
        let text = yaml("", "1., 2., 3., 4., 5.");
        assert_eq!(read_yaml(&text), Ok(expected.clone()));
        assert_eq!(read_yaml(&text.replace('\n', "\r\n")), Ok(expected.clone()));
        // OpenCV 2 writes no "---".
        assert_eq!(
            read_yaml(&text.replacen("---\n", "", 1)),
            Ok(expected.clone())
        );
        let text = xml("1. 2. 3. 4. 5.");
        assert_eq!(read_xml(&text), Ok(expected.clone()));
        assert_eq!(read_xml(&text.replace('\n', "\r\n")), Ok(expected.clone()));
        let json = r#"{
    "image_width": 64,
    "image_height": 48,
    "camera_matrix": {
        "type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d",
        "data": [ 50.5, 0.0, 31.5, 0.0, 51.0, 23.5, 0.0,
            0.0, 1.0 ]
    },
    "distortion_coefficients": { "type_id": "opencv-matrix",
        "rows": 1, "cols": 5, "dt": "d", "data":[1.0,2.0,3.0,4.0,5.0]}
}"#;
        assert_eq!(read_yaml(json), Ok(expected.clone()));
        assert_eq!(read_yaml(&json.replace("    ", "\t")), Ok(expected));
    }

    #[test]
    fn every_name_of_every_key() {
        let expected = camera(brown(FIVE));
        let text = yaml("", "1., 2., 3., 4., 5.");
        for key in ["Camera_Matrix", "cameraMatrix", "K", "M1", "mtx"] {
            let text = text.replace("camera_matrix", key);
            assert_eq!(read_yaml(&text), Ok(expected.clone()), "{key}");
        }
        for key in [
            "Distortion_Coefficients",
            "dist_coeffs",
            "distCoeffs",
            "D",
            "D1",
            "dist",
        ] {
            let text = text.replace("distortion_coefficients", key);
            assert_eq!(read_yaml(&text), Ok(expected.clone()), "{key}");
        }
        let shouted = text
            .replace("image_w", "image_W")
            .replace("image_h", "image_H");
        assert_eq!(read_yaml(&shouted), Ok(expected.clone()));
        for line in [
            "cameraResolution: [ 64, 48 ]",
            "image_size: [64, 48]",
            "img_size: {rows: 2, cols: 1, data: [64., 48.]}",
        ] {
            let text = text.replace("image_width: 64\nimage_height: 48", line);
            assert_eq!(read_yaml(&text), Ok(expected.clone()), "{line}");
        }
        let named = text.replace("flags: 6144", "camera_name: \"nose cone\"");
        assert_eq!(read_yaml(&named).unwrap().name, "nose cone");
        let named = xml("1. 2. 3. 4. 5.").replace(
            "<framesCount>12</framesCount>",
            "<camera_name>\"nose cone\"</camera_name>",
        );
        assert_eq!(read_xml(&named).unwrap().name, "nose cone");
    }

    #[test]
    fn every_model() {
        let lens = |before, d| read_yaml(&yaml(before, d)).map(|camera| camera.distortion);
        let four = brown([1.0, 2.0, 3.0, 4.0, 0.0, 0.0, 0.0, 0.0]);
        let eight = brown([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
        let fisheye = Distortion::Fisheye(Fisheye::new([1.0, 2.0, 3.0, 4.0]));
        assert_eq!(lens("", "1., 2., 3., 4."), Ok(four));
        assert_eq!(lens("fisheye_model: 0\n", "1., 2., 3., 4."), Ok(four));
        assert_eq!(lens("fisheye_model: 1\n", "1., 2., 3., 4."), Ok(fisheye));
        assert_eq!(
            lens("distortion_model: equidistant\n", "1., 2., 3., 4."),
            Ok(fisheye)
        );
        assert_eq!(lens("", "1, 2, 3, 4, 5, 6, 7, 8"), Ok(eight));
        assert_eq!(
            lens("", "1, 2, 3, 4, 5, 6, 7, 8, 0., 0., 0., 0."),
            Ok(eight)
        );
        assert_eq!(
            lens("", "1, 2, 3, 4, 5, 6, 7, 8, 0., 0., 0., 0., 0., 0."),
            Ok(eight)
        );
        let d = "1. 2. 3. 4.";
        assert_eq!(read_xml(&xml(d)), Ok(camera(four)));
        let text = xml(d).replace("<framesCount>12<", "<fisheye_model>1<");
        let text = text.replace("</framesCount>", "</fisheye_model>");
        assert_eq!(read_xml(&text), Ok(camera(fisheye)));
        // An empty cv::Mat: OpenCV's functions take it for zeros.
        let empty = yaml("", "").replace("rows: 0\n   cols: 1", "rows: 0\n   cols: 0");
        assert_eq!(read_yaml(&empty), Ok(camera(Distortion::None)));
    }

    #[test]
    fn lenses_without_a_model_are_refused() {
        let lens = |before, d| what(read_yaml(&yaml(before, d)));
        assert_eq!(
            lens("", "1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 0, 0.01, 0"),
            (
                Some(14),
                "distortion_coefficients has 0.01 in place 13: a thin prism (s1..s4) or a tilted \
                 sensor (tx, ty), which fragscale has no model for"
                    .into()
            )
        );
        assert_eq!(
            lens("", "1, 2, 3").1,
            "distortion_coefficients has 3 coefficients, OpenCV's model has 4, 5, 8, 12 or 14"
        );
        assert_eq!(
            lens("fisheye_model: 1\n", "1, 2, 3, 4, 5").1,
            "distortion_coefficients has 5 coefficients, the fish-eye model has 4"
        );
        assert_eq!(
            lens("fisheye_model: 2\n", "1, 2, 3, 4"),
            (Some(8), "fisheye_model is '2', not 0 or 1".into())
        );
        assert_eq!(
            lens(
                "fisheye_model: 1\ndistortion_model: plumb_bob\n",
                "1, 2, 3, 4"
            ),
            (Some(8), "both fisheye_model and distortion_model".into())
        );
    }

    #[test]
    fn a_file_without_a_size_says_what_to_do() {
        let text = yaml("", "1, 2, 3, 4, 5").replace("image_width: 64\n", "");
        let fault = read_yaml(&text).unwrap_err();
        assert_eq!(fault.what, "the file has no image size");
        assert!(fault.remedy.contains("flight.toml, with width and height"));
        let text = xml("1 2 3 4 5");
        for (from, to, expected) in [
            (
                "64 48",
                "64",
                "cameraResolution is '64', not keys with values",
            ),
            (
                "64 48",
                "64 48 3",
                "cameraResolution is not a width and a height",
            ),
            (
                "64 48",
                "64.5 48",
                "cameraResolution has 64.5, not a whole number of pixels",
            ),
            (
                "64 48",
                "64 -48",
                "cameraResolution has -48, not a whole number of pixels",
            ),
        ] {
            assert_eq!(
                what(read_xml(&text.replace(from, to))),
                (Some(6), expected.into())
            );
        }
        let two = yaml("image_size: [48, 64]\n", "1, 2, 3, 4, 5");
        assert_eq!(
            what(read_yaml(&two)),
            (
                Some(8),
                "image_size is 48 x 64, image_width and image_height 64 x 48".into()
            )
        );
    }

    #[test]
    fn two_candidates_are_refused() {
        let k = "{rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}";
        let one = |line: &str| what(read_yaml(&yaml(&format!("{line}: {k}\n"), "1, 2, 3, 4")));
        assert_eq!(one("K"), (Some(9), "both 'K' and 'camera_matrix'".into()));
        assert_eq!(one("M2"), (Some(8), "'M2' is of a second camera".into()));
        assert_eq!(
            one("camera_matrix"),
            (Some(9), "the key 'camera_matrix' stands twice".into())
        );
        let doubled = xml("1 2 3 4").replace("framesCount", "cameraResolution");
        assert_eq!(
            what(read_xml(&doubled)),
            (Some(6), "the key 'cameraResolution' stands twice".into())
        );
    }

    #[test]
    fn what_is_no_camera_is_refused() {
        let (y, x) = (yaml("", "1., 2., 3., 4., 5."), xml("1. 2. 3. 4. 5."));
        let short = y.replace("       0., 1. ]", "       1. ]");
        assert_eq!(
            what(read_yaml(&short)),
            (Some(8), "camera_matrix is 3 x 3 and has 8 numbers".into())
        );
        let base64 = y.replace("data: [ 1., 2., 3., 4., 5. ]", "data: \"$base64$AAAA\"");
        assert_eq!(
            what(read_yaml(&base64)).1,
            "distortion_coefficients is '$base64$AAAA', not a list of numbers"
        );
        let no_k = y.replace("camera_matrix", "matrix");
        assert!(
            what(read_yaml(&no_k))
                .1
                .starts_with("there is no camera matrix")
        );
        let no_d = x.replace("dist_coeffs", "coeffs");
        assert_eq!(
            what(read_xml(&no_d)).1,
            "there are no distortion_coefficients beside cameraMatrix"
        );
    }
}
