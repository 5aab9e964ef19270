//! A camera in a file of its own. Which kind it is, the content tells:
//!
//! - XML whose root is `<calibration>`: Agisoft's.
//! - Other XML, beginning with `<`: an OpenCV FileStorage.
//! - YAML or JSON with an `opencv-matrix` in it: the same.
//! - Other YAML (and JSON, which is YAML) with `intrinsics` and `resolution`: EuRoC's sensor.yaml, which
//!   programs that read it with OpenCV (Kimera-VIO) begin with `%YAML:`.
//! - Other YAML that begins with `%YAML:`: an OpenCV FileStorage.
//! - YAML with `focal_len`: Orthority.
//! - Other YAML (and JSON): ROS.

mod euroc_camera;
mod opencv_camera;
mod opencv_storage;
mod opencv_xml;
mod orthority_camera;
mod ros_camera;
mod yaml_tree;

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::packages::metashape;

pub(crate) use ros_camera::of_message as of_camera_info;

/// Reads a camera from the text of a calibration file.
///
/// The camera is valid ([`Camera::validate`]); its pixels count as fragscale's do.
///
/// # Errors
/// Where the file is of no known kind, or what it says is no camera that fragscale can model.
pub(crate) fn read(text: &str) -> Result<Camera, Fault> {
    if metashape::is_calibration(text) {
        return metashape::read_calibration(text);
    }
    if text.trim_start().starts_with('<') {
        return opencv_storage::read_xml(text);
    }
    let tree = yaml_tree::first_document(text)?;
    if opencv_storage::has_matrix(&tree) {
        opencv_storage::from_tree(&tree)
    } else if euroc_camera::is_sensor(&tree) {
        euroc_camera::from_tree(&tree)
    } else if yaml_tree::has_opencv_directive(text) {
        opencv_storage::from_tree(&tree)
    } else if let Some(cameras) = orthority_camera::cameras(&tree) {
        orthority_camera::from_tree(&cameras)
    } else {
        ros_camera::from_tree(&tree)
    }
}

/// Where a camera's file says that it sits on the body that carries it: `body_from_camera`. `None`
/// where it says nothing; only a EuRoC sensor.yaml does.
///
/// # Errors
/// Where what it says is no rigid motion.
pub(crate) fn read_mount(text: &str) -> Result<Option<Pose>, Fault> {
    if text.trim_start().starts_with('<') {
        return Ok(None);
    }
    euroc_camera::body_from_camera(&yaml_tree::first_document(text)?)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::camera::{Brown, Distortion};
    use crate::read_text;
    use crate::text_from_bytes;
    use fragscale_test_data::shared_data;

    const ROS: &str = "image_width: 64\nimage_height: 48\ncamera_name: nose\ncamera_matrix:\n  \
        rows: 3\n  cols: 3\n  data: [50.5, 0, 31.5, 0, 51., 23.5, 0, 0, 1]\n\
        distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  \
        data: [.1, .2, .3, .4, .5]\n";
    const ECHO: &str = "header:\n  frame_id: nose\nheight: 48\nwidth: 64\n\
        distortion_model: plumb_bob\nd:\n- .1\n- .2\n- .3\n- .4\n- .5\n\
        k: [50.5, 0, 31.5, 0, 51., 23.5, 0, 0, 1]\nroi:\n  x_offset: 0\n  width: 0\n---\n";
    const YAML: &str = "%YAML:1.0\n---\nimage_width: 64\nimage_height: 48\nfisheye_model: 0\n\
        camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   \
        data: [ 50.5, 0., 31.5, 0., 51., 23.5, 0.,\n       0., 1. ]\n\
        distortion_coefficients: !!opencv-matrix\n   rows: 5\n   cols: 1\n   dt: d\n   \
        data: [ .1, .2, .3, .4, .5 ]\n";
    const XML: &str = "<?xml version=\"1.0\"?>\n<opencv_storage>\n\
        <cameraResolution>\n  64 48</cameraResolution>\n\
        <cameraMatrix type_id=\"opencv-matrix\">\n  <rows>3</rows>\n  <cols>3</cols>\n  \
        <dt>d</dt>\n  <data>\n    50.5 0. 31.5 0. 51. 23.5 0. 0. 1.</data></cameraMatrix>\n\
        <dist_coeffs type_id=\"opencv-matrix\">\n  <rows>1</rows>\n  <cols>5</cols>\n  \
        <dt>d</dt>\n  <data>\n    .1 .2 .3 .4 .5</data></dist_coeffs>\n</opencv_storage>\n";
    const JSON: &str = "{\n  \"image_width\": 64, \"image_height\": 48,\n  \"camera_matrix\": { \
        \"type_id\": \"opencv-matrix\", \"rows\": 3, \"cols\": 3, \"dt\": \"d\",\n    \
        \"data\": [ 50.5, 0, 31.5, 0, 51.0, 23.5, 0, 0, 1 ] },\n  \"distortion_coefficients\": { \
        \"type_id\": \"opencv-matrix\", \"rows\": 1, \"cols\": 5,\n    \
        \"data\": [ 0.1, 0.2, 0.3, 0.4, 0.5 ] }\n}\n";
    const SAMPLES: [&str; 5] = [ROS, ECHO, YAML, XML, JSON];

    fn read_with_all(text: &str) {
        let _ = read(text);
        let _ = ros_camera::read(text);
        let _ = opencv_storage::read_yaml(text);
        let _ = opencv_storage::read_xml(text);
    }

    #[test]
    fn the_content_tells_the_kind() {
        for sample in SAMPLES {
            let camera = read(sample).unwrap();
            assert_eq!((camera.width, camera.height), (64, 48));
            assert_eq!((camera.fx, camera.fy), (50.5, 51.0));
            assert_eq!((camera.cx, camera.cy), (32.0, 24.0));
            let lens = Brown::new([0.1, 0.2, 0.3, 0.4, 0.5, 0.0, 0.0, 0.0]);
            assert_eq!(camera.distortion, Distortion::Brown(lens));
            let windows = format!("\u{feff}{}", sample.replace('\n', "\r\n"));
            let text = text_from_bytes(windows.as_bytes()).unwrap();
            assert_eq!(read(text), Ok(camera), "{text}");
        }
        // OpenCV's tags without OpenCV's first line.
        let tagged = YAML.strip_prefix("%YAML:1.0\n---\n").unwrap();
        assert_eq!(read(tagged), read(YAML));
        assert_eq!(read("\n").unwrap_err().what, "the file is empty");
        assert!(read("x,y,z\n1,2,3\n").is_err());
        assert!(read("[1, 2]").is_err());
    }

    #[test]
    fn no_focal_length_is_a_fault_with_a_remedy() {
        for sample in SAMPLES {
            for zero in ["0", "-50.5", "1e-999"] {
                let fault = read(&sample.replacen("50.5", zero, 1)).unwrap_err();
                assert!(fault.what.contains("the focal length fx is"), "{fault}");
                assert!(fault.line.is_some() && fault.remedy.contains("calibrate"));
            }
            for bad in [".nan", ".inf", "nan", "inf", "1e999", "fifty"] {
                let fault = read(&sample.replacen("50.5", bad, 1)).unwrap_err();
                let expected = format!("[0] is '{bad}', not a finite number");
                assert!(fault.what.ends_with(&expected), "{fault}");
                assert!(fault.line.is_some());
            }
        }
    }

    #[test]
    fn every_truncation_is_read_or_refused() {
        for sample in SAMPLES {
            for end in 0..=sample.len() {
                if let Some(text) = sample.get(..end) {
                    read_with_all(text);
                }
            }
        }
    }

    #[test]
    fn bombs_are_refused_at_once() {
        for unit in [
            "[",
            "{",
            "{a: ",
            "{\"a\":",
            "- ",
            "? ",
            "&a ",
            "!!a ",
            "<a>",
            "<opencv_storage>",
        ] {
            assert!(read(&unit.repeat(100_000)).is_err(), "{unit}");
        }
        assert!(read("a: &a [1]\nb: &b [*a, *a]\n").is_err());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn any_text_is_read_or_refused(text in any::<String>()) {
            read_with_all(&text);
        }

        /// One byte changed, or a piece put elsewhere.
        #[test]
        fn any_damage_is_read_or_refused(
            sample in 0..SAMPLES.len(),
            from in any::<prop::sample::Index>(),
            length in 0..12_usize,
            to in any::<prop::sample::Index>(),
            with in prop::option::of(any::<u8>()),
        ) {
            let mut bytes = SAMPLES[sample].as_bytes().to_vec();
            let from = from.index(bytes.len());
            if let Some(byte) = with {
                bytes[from] = byte;
            } else {
                let end = (from + length).min(bytes.len());
                let piece: Vec<u8> = bytes.drain(from..end).collect();
                let to = to.index(bytes.len() + 1);
                bytes.splice(to..to, piece);
            }
            if let Ok(text) = text_from_bytes(&bytes) {
                read_with_all(text);
                if let Ok(camera) = read(text) {
                    prop_assert_eq!(camera.validate(), Ok(()));
                }
            }
        }
    }

    fn shared(file: &str) -> Option<String> {
        Some(read_text(&shared_data(file)?).unwrap())
    }

    /// The numbers are those that the files show; the half pixel is contract section 1.
    #[test]
    fn the_bebop_of_a_ros_driver() {
        let Some(text) = shared("ros-camera-yaml/bebop2_camera_calib.yaml") else {
            return;
        };
        let lens = [
            0.009430, -0.001107, -0.011436, -0.002274, 0.0, 0.0, 0.0, 0.0,
        ];
        let expected = Camera {
            name: "bebop2_front".into(),
            width: 640,
            height: 368,
            fx: 395.006308,
            fy: 404.392711,
            cx: 314.697857 + 0.5,
            cy: 174.704342 + 0.5,
            skew: 0.0,
            distortion: Distortion::Brown(Brown::new(lens)),
        };
        assert_eq!(read(&text), Ok(expected));
    }

    #[test]
    fn the_4k_camera_of_a_ros_driver() {
        let Some(text) = shared("ros-camera-yaml/ost_uvc_camera_4k.yaml") else {
            return;
        };
        let camera = read(&text).unwrap();
        assert_eq!((camera.width, camera.height), (3840, 2160));
        assert_eq!(camera.fy, 3264.979131);
        assert_eq!(camera.cy, 1081.111452 + 0.5);
    }

    #[test]
    #[expect(clippy::excessive_precision, reason = "digit by digit as in the file")]
    fn the_left_camera_of_opencv() {
        let Some(text) = shared("opencv-chessboard-left/left_intrinsics.yml") else {
            return;
        };
        let lens = Brown::new([
            -0.26637260909660682,
            -0.038588898922304653,
            0.0017831947042852964,
            -0.00028122100441115472,
            0.23839153080878486,
            0.0,
            0.0,
            0.0,
        ]);
        let expected = Camera {
            name: String::new(),
            width: 640,
            height: 480,
            fx: 535.91573396163199,
            fy: 535.91573396163199,
            cx: 342.28315473308373 + 0.5,
            cy: 235.57082909788173 + 0.5,
            skew: 0.0,
            distortion: Distortion::Brown(lens),
        };
        assert_eq!(read(&text), Ok(expected));
    }
}
