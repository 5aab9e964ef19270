//! Cameras of ROS: the YAML of `camera_calibration`, and echoes of `sensor_msgs/CameraInfo`.
//!
//! Written from ROS's `camera_calibration_parsers` (parse_yml.cpp), `CameraInfo.msg` and REP 104:
//!
//! | | camera_calibration | `rostopic echo` | `ros2 topic echo` |
//! |---|---|---|---|
//! | size | `image_width`, `image_height` | `width`, `height` | the same |
//! | K, 3x3 | `camera_matrix`: `rows`, `cols`, `data` | `K` | `k` |
//! | model | `distortion_model`; plumb_bob if left out | the same | the same |
//! | coefficients | `distortion_coefficients`: like K | `D` | `d` |
//! | name | `camera_name` | | |
//!
//! | model | coefficients | fragscale's |
//! |---|---|---|
//! | `plumb_bob` | k1 k2 p1 p2, k3 if there, or none: no distortion | brown |
//! | `rational_polynomial` | k1 k2 p1 p2 k3 k4 k5 k6, more only if 0 | brown |
//! | `equidistant`, `fisheye` | k1 k2 k3 k4 | fisheye |
//! | empty | none, or zeros | none |
//!
//! An echo is a stream of documents with `---` between them; the first one is read. K and D are
//! those of the raw image at full resolution: the rectification R and P are not used, and binning,
//! which shrinks the photo, is what the photo's own size tells. A region of interest crops it, so
//! that its pixels are not K's: refused unless it is the whole image (all zeros stand for that).

use crate::camera::Camera;
use crate::fault::Fault;

use super::opencv_camera::{self, Matrix};
use super::yaml_tree::{Entry, Node, quoted};

/// What to do about a file that is of no known kind.
pub(super) const WHICH_FILES: &str = "give a ROS camera_calibration YAML, an echo of camera_info \
    or an OpenCV FileStorage, or write the camera inline in flight.toml";

/// Reads the camera of a `camera_calibration` YAML or of an echoed `CameraInfo`.
///
/// # Errors
/// Where the text is none, or what it says is no camera that fragscale can model.
#[cfg(test)]
pub(super) fn read(text: &str) -> Result<Camera, Fault> {
    from_tree(&super::yaml_tree::first_document(text)?)
}

/// A camera from the tree of its file.
pub(super) fn from_tree(tree: &Node) -> Result<Camera, Fault> {
    tree.entries("the file", WHICH_FILES)?;
    let (width, height, k, d, default_model) = if tree.get("camera_matrix").is_some() {
        (
            "image_width",
            "image_height",
            "camera_matrix",
            "distortion_coefficients",
            "plumb_bob",
        )
    } else if tree.get("K").is_some() {
        ("width", "height", "K", "D", "")
    } else if tree.get("k").is_some() {
        ("width", "height", "k", "d", "")
    } else {
        let what = "there is no camera matrix (camera_matrix, K or k)";
        return Err(Fault::new(what, WHICH_FILES));
    };
    let required = |key: &str| -> Result<&Entry, Fault> {
        let missing = || {
            let what = format!("there is no {key} beside {k}");
            Fault::new(what, format!("write {key} as the calibration wrote it"))
        };
        tree.get(key).ok_or_else(missing)
    };
    let size = (
        required(width)?.node.whole(width)?,
        required(height)?.node.whole(height)?,
    );
    refuse_crop(tree, size)?;
    let k = Matrix::read(required(k)?)?;
    let d_entry = required(d)?;
    let d = Matrix::read(d_entry)?;
    let distortion = match tree.get("distortion_model") {
        Some(entry) => d.lens(entry.node.text("distortion_model")?, entry.line)?,
        None => d.lens(default_model, d_entry.line)?,
    };
    let name = match tree.get("camera_name") {
        Some(entry) => entry.node.text("camera_name")?,
        None => "",
    };
    opencv_camera::camera(name, size, &k, distortion)
}

/// Refuses a region of interest that is not the whole image.
fn refuse_crop(tree: &Node, size: (u32, u32)) -> Result<(), Fault> {
    let Some(roi) = tree.get("roi") else {
        return Ok(());
    };
    let side = |key: &str| {
        let part = roi.node.get(key);
        part.map_or(Ok(0), |part| part.node.whole(&format!("roi: {key}")))
    };
    let region = [
        side("x_offset")?,
        side("y_offset")?,
        side("width")?,
        side("height")?,
    ];
    whole_image(region, size).map_err(|fault| Fault {
        line: Some(roi.line),
        ..fault
    })
}

/// Refuses a region of interest (x, y, width, height) that is not the whole image.
fn whole_image(region: [u32; 4], size: (u32, u32)) -> Result<(), Fault> {
    let [x, y, width, height] = region;
    if (x, y) == (0, 0) && ((width, height) == (0, 0) || (width, height) == size) {
        return Ok(());
    }
    let place = quoted(&format!("{width} x {height} at {x}, {y}"));
    Err(Fault::new(
        format!("the region of interest {place} is a crop: K is not that of its photos"),
        "record without a region of interest, or write the crop's own camera inline",
    ))
}

/// The camera of a `CameraInfo` message: its size, its region of interest (x, y, width, height), K, the
/// model's name and D.
///
/// # Errors
/// Where it is no camera that fragscale can model.
pub(crate) fn of_message(
    size: (u32, u32),
    region: [u32; 4],
    k: &[f64],
    model: &str,
    d: &[f64],
) -> Result<Camera, Fault> {
    whole_image(region, size)?;
    let lens = Matrix::of_message("D", d).lens(model, 0);
    let camera =
        lens.and_then(|lens| opencv_camera::camera("", size, &Matrix::of_message("K", k), lens));
    // A message has no lines.
    camera.map_err(|fault| Fault {
        line: None,
        ..fault
    })
}

#[cfg(test)]
mod tests {
    use crate::camera::{Brown, Distortion, Fisheye};

    use super::*;

    /// A calibration of a 64 x 48 image.
    fn calibration(model: &str, d: &str) -> String {
        let count = d.split(',').filter(|part| !part.trim().is_empty()).count();
        format!(
            "image_width: 64\nimage_height: 48\ncamera_name: nose\ncamera_matrix:\n  rows: 3\n  \
             cols: 3\n  data: [50.5, 0.25, 31.5, 0, 51., 23.5, 0, 0, 1]\ndistortion_model: \
             {model}\ndistortion_coefficients:\n  rows: 1\n  cols: {count}\n  data: [{d}]\n"
        )
    }

    fn what(text: &str) -> (Option<u64>, String) {
        let fault = read(text).unwrap_err();
        (fault.line, fault.what)
    }

    #[test]
    fn a_calibration_file() {
        let text = calibration("plumb_bob", "1e-1, -0.2, .3, 4., 5");
        let expected = Camera {
            name: "nose".into(),
            width: 64,
            height: 48,
            fx: 50.5,
            fy: 51.0,
            cx: 32.0,
            cy: 24.0,
            skew: 0.25,
            distortion: Distortion::Brown(Brown::new([0.1, -0.2, 0.3, 4.0, 5.0, 0.0, 0.0, 0.0])),
        };
        assert_eq!(read(&text), Ok(expected.clone()));
        assert_eq!(read(&text.replace('\n', "\r\n")), Ok(expected.clone()));
        // ROS's own reader takes plumb_bob where the model is left out.
        let silent = text.replace("distortion_model: plumb_bob\n", "");
        assert_eq!(read(&silent), Ok(expected.clone()));
        let block = text.replace(
            "[1e-1, -0.2, .3, 4., 5]",
            "\n  - 1e-1\n  - -0.2\n  - .3\n  - 4.\n  - 5",
        );
        assert_eq!(read(&block), Ok(expected));
    }

    #[test]
    fn every_model() {
        let lens = |model, d| read(&calibration(model, d)).map(|camera| camera.distortion);
        let brown = |c| Ok(Distortion::Brown(Brown::new(c)));
        assert_eq!(
            lens("plumb_bob", "1, 2, 3, 4"),
            brown([1.0, 2.0, 3.0, 4.0, 0.0, 0.0, 0.0, 0.0])
        );
        assert_eq!(lens("plumb_bob", ""), Ok(Distortion::None));
        assert_eq!(lens("plumb_bob", "0, 0, 0, 0, 0"), brown([0.0; 8]));
        let eight = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
        for d in [
            "1, 2, 3, 4, 5, 6, 7, 8",
            "1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 0",
            "1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 0, 0, -0.0",
        ] {
            assert_eq!(lens("rational_polynomial", d), brown(eight), "{d}");
        }
        for model in ["equidistant", "fisheye", "\"Equidistant\""] {
            let fisheye = Distortion::Fisheye(Fisheye::new([1.0, 2.0, 3.0, 4.0]));
            assert_eq!(lens(model, "1, 2, 3, 4"), Ok(fisheye));
        }
        for (model, d) in [("''", ""), ("\"\"", "0, 0, 0, 0, 0"), ("", "0")] {
            assert_eq!(lens(model, d), Ok(Distortion::None), "{model} {d}");
        }
    }

    #[test]
    fn lenses_without_a_model_are_refused_by_name() {
        let lens = |model, d| what(&calibration(model, d));
        assert_eq!(
            lens("thin_prism_fisheye", "1, 2, 3, 4"),
            (
                Some(8),
                "fragscale has no model for the distortion_model 'thin_prism_fisheye'".into()
            )
        );
        assert_eq!(
            lens("''", "1, 2, 3, 4, 5"),
            (
                Some(8),
                "distortion_model is empty and distortion_coefficients is not 0".into()
            )
        );
        assert_eq!(
            lens("plumb_bob", "1, 2, 3, 4, 5, 6, 7, 8"),
            (
                Some(9),
                "distortion_coefficients has 8 coefficients, plumb_bob has 4 or 5".into()
            )
        );
        assert_eq!(
            lens("rational_polynomial", "1, 2, 3, 4, 5").1,
            "distortion_coefficients has 5 coefficients, rational_polynomial has 8, 12 or 14"
        );
        assert_eq!(
            lens("equidistant", "1, 2, 3, 4, 5").1,
            "distortion_coefficients has 5 coefficients, equidistant has 4"
        );
        assert!(lens("equidistant", "").1.ends_with("equidistant has 4"));
        let prism = lens("rational_polynomial", "1, 2, 3, 4, 5, 6, 7, 8, 0, .5, 0, 0");
        assert!(prism.1.contains("has 0.5 in place 10: a thin prism"));
    }

    const ECHO: &str = "header: \n  seq: 7\n  stamp: \n    secs: 1\n    nsecs:         2\n  \
        frame_id: \"nose\"\nheight: 48\nwidth: 64\ndistortion_model: \"plumb_bob\"\n\
        D: [0.1, -0.2, 0.3, 4.0, 5.0]\nK: [50.5, 0.25, 31.5, 0.0, 51.0, 23.5, 0.0, 0.0, 1.0]\n\
        R: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\n\
        P: [9.0, 0.0, 9.0, 0.0, 0.0, 9.0, 9.0, 0.0, 0.0, 0.0, 1.0, 0.0]\nbinning_x: 0\n\
        binning_y: 0\nroi: \n  x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0\n  \
        do_rectify: False\n---\nheader: \n  seq: 8\n  stam";

    #[test]
    fn an_echo_of_either_ros() {
        let file = calibration("plumb_bob", "0.1, -0.2, 0.3, 4, 5").replace(": nose", ": ''");
        let expected = read(&file).unwrap();
        assert_eq!(read(ECHO), Ok(expected.clone()));
        let ros2 = "header:\n  stamp:\n    sec: 1\n    nanosec: 2\n  frame_id: nose\nheight: 48\n\
            width: 64\ndistortion_model: plumb_bob\nd:\n- 0.1\n- -0.2\n- 0.3\n- 4.0\n- 5.0\nk:\n\
            - 50.5\n- 0.25\n- 31.5\n- 0.0\n- 51.0\n- 23.5\n- 0.0\n- 0.0\n- 1.0\nr:\n- 1.0\n---\n";
        assert_eq!(read(ros2), Ok(expected));
        let none = ECHO.replace("plumb_bob", "");
        assert!(read(&none).is_err());
        let none = none.replace("[0.1, -0.2, 0.3, 4.0, 5.0]", "[]");
        assert_eq!(read(&none).unwrap().distortion, Distortion::None);
    }

    #[test]
    fn a_crop_is_refused() {
        let whole = ECHO.replace("  height: 0\n  width: 0\n", "  height: 48\n  width: 64\n");
        assert!(read(&whole).is_ok());
        for crop in [
            whole.replace("  width: 64", "  width: 32"),
            ECHO.replace("x_offset: 0", "x_offset: 4"),
        ] {
            let (line, what) = what(&crop);
            assert_eq!(line, Some(16));
            assert!(
                what.ends_with("is a crop: K is not that of its photos"),
                "{what}"
            );
        }
    }

    #[test]
    fn what_is_no_camera_is_refused() {
        let good = calibration("plumb_bob", "1, 2, 3, 4, 5");
        for (from, to, line, expected) in [
            (
                "50.5",
                "0",
                Some(4),
                "camera_matrix belongs to no camera: the focal length fx is 0 px; it must be positive",
            ),
            (
                "51.",
                ".NaN",
                Some(7),
                "camera_matrix[4] is '.NaN', not a finite number",
            ),
            (
                "23.5",
                "-.inf",
                Some(7),
                "camera_matrix[5] is '-.inf', not a finite number",
            ),
            (
                "31.5, 0,",
                "31.5, 2,",
                Some(4),
                "camera_matrix has 2 where a camera matrix has 0 (number 3)",
            ),
            (
                "0, 0, 1]",
                "0, 0, 2]",
                Some(4),
                "camera_matrix has 2 where a camera matrix has 1 (number 8)",
            ),
            (
                "50.5, 0.25",
                "50.5",
                Some(4),
                "camera_matrix is 3 x 3 and has 8 numbers",
            ),
            (
                "rows: 3\n  cols: 3",
                "rows: 1\n  cols: 9",
                Some(4),
                "camera_matrix is 1 x 9; a camera matrix is 3 x 3",
            ),
            ("  rows: 3\n", "", Some(4), "camera_matrix has no rows"),
            (
                "cols: 5",
                "cols: 4294967295",
                Some(9),
                "distortion_coefficients is 1 x 4294967295 and has 5 numbers",
            ),
            (
                "width: 64",
                "width: -64",
                Some(1),
                "image_width is '-64', not a whole number from 0 on",
            ),
            (
                "width: 64",
                "width: 0",
                Some(4),
                "camera_matrix belongs to no camera: the image size is 0 x 48; both must be positive",
            ),
            (
                "image_width: 64\n",
                "",
                None,
                "there is no image_width beside camera_matrix",
            ),
            (
                "camera_matrix",
                "matrix",
                None,
                "there is no camera matrix (camera_matrix, K or k)",
            ),
        ] {
            let bad = good.replacen(from, to, 1);
            assert_ne!(bad, good);
            assert_eq!(what(&bad), (line, expected.to_owned()), "{from} -> {to}");
        }
        let nine = ECHO.replace("K: [50.5,", "K: [");
        assert_eq!(what(&nine).1, "K has 8 numbers; a camera matrix has 9");
        assert_eq!(
            what("just words").1,
            "the file is 'just words', not keys with values"
        );
    }
}
