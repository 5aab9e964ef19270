//! The YAML of ROS's `camera_calibration` ("ost.yaml"), from `camera_calibration_parsers`
//! (parse_yml.cpp) and `sensor_msgs/CameraInfo.msg`.
//!
//! | fragscale's lens | `distortion_model` | coefficients |
//! |---|---|---|
//! | none | `plumb_bob` | five zeros |
//! | brown, k4 k5 k6 all 0 | `plumb_bob` | k1 k2 p1 p2 k3 |
//! | brown | `rational_polynomial` | k1 k2 p1 p2 k3 k4 k5 k6 |
//! | fisheye | `equidistant` | k1 k2 k3 k4 |
//!
//! ROS counts pixels from the centre of the first one: cx and cy are half a pixel less than ours.
//! A skew stands in K. The rectification is that of one camera alone: the identity, and P = [K 0].

use crate::camera::{Camera, Distortion};

/// The camera as a ROS calibration. Numbers read back to the same f64.
///
/// # Errors
/// Where it is no camera, its lens is one that ROS has no model for, or its name does not fit a line.
pub fn ost_yaml(camera: &Camera) -> Result<String, String> {
    camera.validate().map_err(|error| error.to_string())?;
    let name = &camera.name;
    if name.contains(char::is_control) {
        return Err(format!("the camera name {name:?} has a control character"));
    }
    let (model, coefficients) = match &camera.distortion {
        Distortion::None => ("plumb_bob", vec![0.0; 5]),
        Distortion::Brown(lens) => {
            let [k1, k2, p1, p2, k3, rest @ ..] = lens.coefficients();
            if rest == [0.0; 3] {
                ("plumb_bob", vec![k1, k2, p1, p2, k3])
            } else {
                ("rational_polynomial", lens.coefficients().to_vec())
            }
        }
        Distortion::Fisheye(lens) => ("equidistant", lens.coefficients().to_vec()),
        other @ (Distortion::VisualSfm(_) | Distortion::Agisoft(_)) => {
            return Err(format!("ROS has no model for the lens '{}'", other.name()));
        }
    };
    let Camera {
        fx,
        fy,
        skew,
        width,
        height,
        ..
    } = camera;
    let (cx, cy) = (camera.cx - 0.5, camera.cy - 0.5);
    let matrix = |key: &str, rows: usize, numbers: &[f64]| {
        let cols = numbers.len() / rows;
        // Display, not Debug: YAML takes 1e-7 for a word.
        let data: Vec<String> = numbers.iter().map(f64::to_string).collect();
        let data = data.join(", ");
        format!("{key}:\n  rows: {rows}\n  cols: {cols}\n  data: [{data}]\n")
    };
    let quoted = name.replace('\'', "''");
    let mut text =
        format!("image_width: {width}\nimage_height: {height}\ncamera_name: '{quoted}'\n");
    let k = [*fx, *skew, cx, 0.0, *fy, cy, 0.0, 0.0, 1.0];
    text += &matrix("camera_matrix", 3, &k);
    text += &format!("distortion_model: {model}\n");
    text += &matrix("distortion_coefficients", 1, &coefficients);
    let r = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    text += &matrix("rectification_matrix", 3, &r);
    let p = [*fx, *skew, cx, 0.0, 0.0, *fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0];
    text += &matrix("projection_matrix", 3, &p);
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Brown, Fisheye, VisualSfm};
    use crate::formats::read_camera;
    use fragscale_test_data::written;

    fn camera(distortion: Distortion) -> Camera {
        Camera {
            name: "drone's eye".to_owned(),
            width: 1280,
            height: 720,
            fx: 1000.0 / 3.0,
            fy: 990.1,
            cx: 640.123_456_789,
            cy: 359.7,
            skew: -0.25,
            distortion,
        }
    }

    /// Half a pixel less and half a pixel more is exact from a quarter pixel on.
    #[test]
    fn reads_back_exactly() {
        let gentle = Brown::new([0.1, -0.2, 1e-7, -0.0003, 0.05, 0.0, 0.0, 0.0]);
        let rational = Brown::new([0.1, -0.2, 1e-7, -0.0003, 0.05, 1e-9, 0.0, 0.2]);
        let fisheye = Fisheye::new([-0.01, 0.02, -0.003, 1.0 / 3.0]);
        for (lens, model, count) in [
            (Distortion::Brown(gentle), "plumb_bob", 5),
            (Distortion::Brown(rational), "rational_polynomial", 8),
            (Distortion::Fisheye(fisheye), "equidistant", 4),
        ] {
            let camera = camera(lens);
            let text = ost_yaml(&camera).unwrap();
            assert_eq!(ost_yaml(&camera).unwrap(), text);
            assert!(text.contains(&format!("distortion_model: {model}\n")));
            assert!(text.contains(&format!("rows: 1\n  cols: {count}\n")));
            let (_folder, path) = written("ost.yaml", text);
            assert_eq!(read_camera(&path).unwrap(), camera);
        }
    }

    #[test]
    fn a_pinhole_is_a_lens_of_zeros() {
        let camera = camera(Distortion::None);
        let (_folder, path) = written("ost.yaml", ost_yaml(&camera).unwrap());
        let expected = Camera {
            distortion: Distortion::Brown(Brown::new([0.0; 8])),
            ..camera
        };
        assert_eq!(read_camera(&path).unwrap(), expected);
    }

    #[test]
    fn what_ros_cannot_say_is_refused() {
        let bundler = camera(Distortion::VisualSfm(VisualSfm { k: 0.1 }));
        assert!(ost_yaml(&bundler).unwrap_err().contains("visualsfm"));
        let mut flat = camera(Distortion::None);
        flat.fx = 0.0;
        assert!(ost_yaml(&flat).unwrap_err().contains("focal length"));
        let mut lines = camera(Distortion::None);
        lines.name = "a\nb".to_owned();
        assert!(ost_yaml(&lines).is_err());
    }
}
