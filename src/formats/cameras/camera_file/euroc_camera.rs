//! Cameras of the ASL dataset format (EuRoC, TUM-VI): `cam0/sensor.yaml`.
//!
//! Written from Burri et al., "The EuRoC micro aerial vehicle datasets" (2016), its files, and
//! Kalibr's wiki ("Supported models"), whose models these are:
//!
//! ```text
//! sensor_type: camera
//! T_BS:                       the pose of the sensor in the body (its IMU): body_from_camera
//!   cols: 4
//!   rows: 4
//!   data: [16 numbers by rows]
//! resolution: [752, 480]      or {width: 752, height: 480}
//! camera_model: pinhole       others are refused
//! intrinsics: [fu, fv, cu, cv]
//! distortion_model: radial-tangential
//! distortion_coefficients: [k1, k2, p1, p2]
//! ```
//!
//! `radial-tangential` (Kalibr's radtan) is OpenCV's k1 k2 p1 p2, `equidistant` its fish-eye. Kalibr
//! counts pixels from the centre of the top-left one, so cx and cy gain 0.5.

use glam::DVec3;

use super::opencv_camera::Matrix;
use super::yaml_tree::{Entry, Node, quoted};
use crate::camera::{Camera, Distortion, Pose};
use crate::fault::Fault;

/// Whether the tree is a sensor of this format.
pub(super) fn is_sensor(tree: &Node) -> bool {
    tree.get("intrinsics").is_some() && tree.get("resolution").is_some()
}

/// A camera from the tree of its sensor.yaml.
pub(super) fn from_tree(tree: &Node) -> Result<Camera, Fault> {
    if let Some(model) = tree.get("camera_model") {
        let name = model.node.text("camera_model")?;
        if !name.eq_ignore_ascii_case("pinhole") {
            let what = format!(
                "fragscale has no model for the camera_model {}",
                quoted(name)
            );
            return Err(Fault::at(model.line, what, "calibrate it as pinhole"));
        }
    }
    let resolution = required(tree, "resolution")?;
    let pixels = match (resolution.node.get("width"), resolution.node.get("height")) {
        (Some(width), Some(height)) => {
            vec![width.node.number("width")?, height.node.number("height")?]
        }
        _ => resolution.node.numbers("resolution")?,
    };
    let size = |value: f64| {
        let whole = value.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(&value);
        // Whole and in range: the cast is exact.
        whole.then_some(value as u32)
    };
    let (Some(width), Some(height)) = (
        pixels.first().copied().and_then(size),
        pixels.get(1).copied().and_then(size),
    ) else {
        let what = "resolution is not a width and a height";
        return Err(Fault::at(resolution.line, what, "write it as [752, 480]"));
    };
    let intrinsics = required(tree, "intrinsics")?;
    let [fx, fy, cx, cy] = intrinsics.node.numbers("intrinsics")?[..] else {
        let what = "intrinsics are not four numbers";
        return Err(Fault::at(
            intrinsics.line,
            what,
            "write fu, fv, cu, cv there",
        ));
    };
    let camera = Camera {
        name: String::new(),
        width,
        height,
        fx,
        fy,
        cx: cx + 0.5,
        cy: cy + 0.5,
        skew: 0.0,
        distortion: lens(tree)?,
    };
    camera.validate().map_err(|error| {
        let what = format!("intrinsics belong to no camera: {error}");
        Fault::at(intrinsics.line, what, "copy them from the calibration")
    })?;
    Ok(camera)
}

fn lens(tree: &Node) -> Result<Distortion, Fault> {
    let Some(model) = tree.get("distortion_model") else {
        return Err(Fault::new(
            "there is no distortion_model beside intrinsics",
            "write it as the calibration wrote it, or none",
        ));
    };
    let name = model.node.text("distortion_model")?;
    if name.eq_ignore_ascii_case("none") {
        return Ok(Distortion::None);
    }
    let coefficients = Matrix::read(required(tree, "distortion_coefficients")?)?;
    match name.to_ascii_lowercase().as_str() {
        "radial-tangential" | "radial_tangential" | "radtan" => coefficients.brown(name, &[4]),
        "equidistant" => coefficients.fisheye(name),
        _ => Err(Fault::at(
            model.line,
            format!(
                "fragscale has no model for the distortion_model {}",
                quoted(name)
            ),
            "calibrate it as radial-tangential or equidistant",
        )),
    }
}

/// Where the camera sits on the body: `body_from_camera`, of T_BS; `None` where the file says
/// nothing.
///
/// # Errors
/// Where T_BS is there and no rigid motion.
pub(super) fn body_from_camera(tree: &Node) -> Result<Option<Pose>, Fault> {
    let Some(entry) = tree.get("T_BS") else {
        return Ok(None);
    };
    let fault = |what: String| Fault::at(entry.line, what, "copy T_BS from the calibration");
    let matrix = Matrix::read(entry)?;
    let [a, b, c, x, d, e, f, y, g, h, i, z, 0.0, 0.0, 0.0, 1.0] = *matrix.values() else {
        return Err(fault(
            "T_BS is no 4x4 matrix with 0 0 0 1 in its last row".to_owned(),
        ));
    };
    Pose::from_row_major(DVec3::new(x, y, z), [a, b, c, d, e, f, g, h, i])
        .map(Some)
        .map_err(|error| fault(format!("T_BS: {error}")))
}

fn required<'a>(tree: &'a Node, key: &str) -> Result<&'a Entry, Fault> {
    tree.get(key).ok_or_else(|| {
        let what = format!("there is no {key}, as a camera's sensor.yaml has it");
        Fault::new(what, "give the sensor.yaml of a camera")
    })
}

#[cfg(test)]
mod tests {
    use glam::DMat3;

    use super::*;
    use crate::camera::{Brown, Fisheye};
    use crate::cameras::camera_file::yaml_tree::first_document;

    /// EuRoC's cam0.
    const CAM0: &str = "#Default initialization for all cameras\nsensor_type: camera\n\
        comment: VI-Sensor cam0 (MT9M034)\nT_BS:\n  cols: 4\n  rows: 4\n  \
        data: [0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,\n         \
        0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,\n        \
        -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,\n         \
        0.0, 0.0, 0.0, 1.0]\nrate_hz: 20\nresolution: [752, 480]\ncamera_model: pinhole\n\
        intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv\n\
        distortion_model: radial-tangential\n\
        distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]\n";

    fn camera(text: &str) -> Result<Camera, Fault> {
        from_tree(&first_document(text).unwrap())
    }

    fn mount(text: &str) -> Result<Option<Pose>, Fault> {
        body_from_camera(&first_document(text).unwrap())
    }

    #[test]
    fn cam0_of_euroc() {
        let tree = first_document(CAM0).unwrap();
        assert!(is_sensor(&tree));
        let camera = camera(CAM0).unwrap();
        assert_eq!((camera.width, camera.height), (752, 480));
        assert_eq!((camera.fx, camera.fy), (458.654, 457.296));
        assert_eq!((camera.cx, camera.cy), (367.715, 248.875));
        let lens = Brown::new([
            -0.28340811,
            0.07395907,
            0.00019359,
            1.76187114e-05,
            0.0,
            0.0,
            0.0,
            0.0,
        ]);
        assert_eq!(camera.distortion, Distortion::Brown(lens));
        let mount = mount(CAM0).unwrap().unwrap();
        assert_eq!(
            mount.center,
            DVec3::new(-0.0216401454975, -0.064676986768, 0.00981073058949)
        );
        // The image's right is the body's y, its down the body's -x.
        let about = DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z);
        assert!(mount.rotation.abs_diff_eq(about, 0.03));
        let fisheye = CAM0.replace("radial-tangential", "equidistant");
        let four = [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05];
        assert_eq!(
            super::from_tree(&first_document(&fisheye).unwrap())
                .unwrap()
                .distortion,
            Distortion::Fisheye(Fisheye::new(four))
        );
    }

    #[test]
    fn other_programs_spellings_are_the_same_camera() {
        let expected = camera(CAM0).unwrap();
        for (from, to) in [
            ("#Default", "%YAML:1.0\n#Default"),
            ("[752, 480]", "\n  width: 752\n  height: 480"),
            ("radial-tangential", "radial_tangential"),
        ] {
            let text = CAM0.replacen(from, to, 1);
            let found = crate::cameras::camera_file::read(&text);
            assert_eq!(found.as_ref(), Ok(&expected), "{to}");
        }
    }

    #[test]
    fn what_is_no_camera_is_refused() {
        for (from, to, expected) in [
            ("pinhole", "omni", "no model for the camera_model 'omni'"),
            (
                "radial-tangential",
                "fov",
                "no model for the distortion_model 'fov'",
            ),
            ("458.654, ", "", "intrinsics are not four numbers"),
            ("458.654", "-1", "the focal length fx is -1 px"),
            (
                "[752, 480]",
                "[752.5, 480]",
                "resolution is not a width and a height",
            ),
            (
                "[752, 480]",
                "[752]",
                "resolution is not a width and a height",
            ),
            (
                ", 1.76187114e-05",
                "",
                "3 coefficients, radial-tangential has 4",
            ),
        ] {
            let fault = camera(&CAM0.replacen(from, to, 1)).unwrap_err();
            assert!(fault.what.contains(expected), "{fault}");
            assert!(fault.line.is_some(), "{fault}");
        }
        let skewed = mount(&CAM0.replacen("0.0148655429818", "0.5", 1)).unwrap_err();
        assert!(
            skewed.what.contains("T_BS: the matrix is no rotation"),
            "{skewed}"
        );
        let short =
            mount(&CAM0.replacen("0.0, 0.0, 0.0, 1.0", "0.0, 0.0, 0.0, 2.0", 1)).unwrap_err();
        assert_eq!(short.line, Some(4));
        assert_eq!(mount("resolution: [1, 1]"), Ok(None));
    }
}
