//! OpenCV's camera as ROS and OpenCV both write it: a 3x3 matrix and a vector of coefficients.
//!
//! Written from the OpenCV documentation, "Camera Calibration and 3D Reconstruction" and "Fisheye
//! camera model", from ROS REP 104 and from `sensor_msgs/CameraInfo.msg`:
//!
//! ```text
//!     | fx  s cx |     pixel = K (x', y', 1), (x', y') the distorted point of the plane z = 1
//! K = |  0 fy cy |     row by row; (0, 0) is the CENTRE of the top-left pixel, so fragscale's
//!     |  0  0  1 |     cx and cy are greater by 0.5
//!
//! k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tx ty]]]]     4, 5, 8, 12 or 14 of them: brown
//! k1 k2 k3 k4                                           of cv::fisheye: fisheye
//! ```
//!
//! The thin prism s1..s4 and the tilted sensor tx, ty are not modelled: they must be 0. No
//! coefficients at all stand for zeros, in OpenCV's functions as in ROS's.
//!
//! A matrix is a mapping of rows, cols and data (in OpenCV's files with dt, the type of its
//! numbers), or, in ROS messages, a bare list.

use crate::camera::{Brown, Camera, CameraError, Distortion, Fisheye};
use crate::fault::Fault;

use super::yaml_tree::{Entry, Value, quoted};

/// What to do about a lens that fragscale has no model for.
const OTHER_LENS: &str = "calibrate it as plumb_bob, rational_polynomial or equidistant, or \
    undistort the photos and write the camera inline in flight.toml with distortion = \"none\"";

/// What to do about a matrix of the wrong size.
const WHOLE_MATRIX: &str = "copy the whole matrix from the calibration";

/// The numbers of a matrix, row by row.
pub(super) struct Matrix<'a> {
    /// The key that it stands under.
    key: &'a str,
    line: u64,
    /// Rows and columns, where the file says them.
    shape: Option<(u32, u32)>,
    values: Vec<f64>,
}

impl<'a> Matrix<'a> {
    /// Reads a mapping of rows, cols and data, or a list.
    ///
    /// # Errors
    /// Where a number is not finite, or their count is not that of rows and cols.
    pub(super) fn read(entry: &'a Entry) -> Result<Self, Fault> {
        let Entry { key, line, node } = entry;
        let remedy = "write rows, cols and data there";
        let matrix = |shape, values| Self {
            key,
            line: *line,
            shape,
            values,
        };
        if matches!(node.value, Value::Sequence(_)) {
            return Ok(matrix(None, node.numbers(key)?));
        }
        node.entries(key, remedy)?;
        let part = |name: &str| {
            let missing = || Fault::at(*line, format!("{key} has no {name}"), remedy);
            node.get(name).map(|part| &part.node).ok_or_else(missing)
        };
        let values = part("data")?.numbers(key)?;
        let rows = part("rows")?.whole(&format!("{key}: rows"))?;
        let cols = part("cols")?.whole(&format!("{key}: cols"))?;
        if u64::from(rows) * u64::from(cols) != values.len() as u64 {
            let count = values.len();
            let what = format!("{key} is {rows} x {cols} and has {count} numbers");
            return Err(Fault::at(*line, what, WHOLE_MATRIX));
        }
        Ok(matrix(Some((rows, cols)), values))
    }

    /// The numbers of a message, which have no place in a text.
    pub(super) fn of_message(key: &'a str, values: &[f64]) -> Self {
        Self {
            key,
            line: 0,
            shape: None,
            values: values.to_vec(),
        }
    }

    /// Its numbers.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    fn fault(&self, what: impl std::fmt::Display, remedy: &str) -> Fault {
        Fault::at(self.line, format!("{} {what}", self.key), remedy)
    }

    fn wrong_count(&self, model: &str, wanted: &str) -> Fault {
        let count = self.values.len();
        let what = format!("has {count} coefficients, {model} has {wanted}");
        self.fault(what, "copy all coefficients from the calibration")
    }

    /// The numbers of OpenCV's rational model; none where there is no coefficient.
    ///
    /// # Errors
    /// Where their count is none of `counts`, or there are some beyond k6 that are not 0.
    pub(super) fn brown(&self, model: &str, counts: &[usize]) -> Result<Distortion, Fault> {
        if self.values.is_empty() {
            return Ok(Distortion::None);
        }
        if !counts.contains(&self.values.len()) {
            let mut wanted: Vec<String> = counts.iter().map(ToString::to_string).collect();
            let last = wanted.pop().unwrap_or_default();
            let wanted = match wanted.as_slice() {
                [] => last,
                first => format!("{} or {last}", first.join(", ")),
            };
            return Err(self.wrong_count(model, &wanted));
        }
        let beyond = self.values.iter().enumerate().skip(8);
        if let Some((index, value)) = beyond.into_iter().find(|(_, value)| **value != 0.0) {
            let place = index + 1;
            let what = format!(
                "has {value} in place {place}: a thin prism (s1..s4) or a tilted sensor (tx, ty), \
                 which fragscale has no model for"
            );
            let remedy = "calibrate without CALIB_THIN_PRISM_MODEL and CALIB_TILTED_MODEL";
            return Err(self.fault(what, remedy));
        }
        let mut all = [0.0; 8];
        for (to, from) in all.iter_mut().zip(&self.values) {
            *to = *from;
        }
        Ok(Distortion::Brown(Brown::new(all)))
    }

    /// The numbers of OpenCV's fish-eye model.
    ///
    /// # Errors
    /// Where they are not 4.
    pub(super) fn fisheye(&self, model: &str) -> Result<Distortion, Fault> {
        let four = <[f64; 4]>::try_from(self.values.as_slice());
        four.map(|four| Distortion::Fisheye(Fisheye::new(four)))
            .map_err(|_| self.wrong_count(model, "4"))
    }

    /// The numbers of a model that is named as in ROS, at its line.
    ///
    /// # Errors
    /// Where it is not known here, or the count is not that of the model.
    pub(super) fn lens(&self, model: &str, line: u64) -> Result<Distortion, Fault> {
        match model.to_ascii_lowercase().as_str() {
            "plumb_bob" => self.brown("plumb_bob", &[4, 5]),
            "rational_polynomial" => self.brown("rational_polynomial", &[8, 12, 14]),
            name @ ("equidistant" | "fisheye") => self.fisheye(name),
            "" | "~" | "null" | "none" if self.values.iter().all(|&value| value == 0.0) => {
                Ok(Distortion::None)
            }
            "" | "~" | "null" | "none" => Err(Fault::at(
                line,
                format!("distortion_model is empty and {} is not 0", self.key),
                "write there which model the coefficients are of, such as plumb_bob",
            )),
            _ => Err(Fault::at(
                line,
                format!(
                    "fragscale has no model for the distortion_model {}",
                    quoted(model)
                ),
                OTHER_LENS,
            )),
        }
    }
}

/// The camera of a size, its matrix K and its lens.
///
/// # Errors
/// Where K is no camera matrix, or the size is 0.
pub(super) fn camera(
    name: &str,
    (width, height): (u32, u32),
    k: &Matrix<'_>,
    distortion: Distortion,
) -> Result<Camera, Fault> {
    if let Some((rows, cols)) = k.shape.filter(|shape| *shape != (3, 3)) {
        let what = format!("is {rows} x {cols}; a camera matrix is 3 x 3");
        return Err(k.fault(what, WHOLE_MATRIX));
    }
    let [fx, skew, cx, k3, fy, cy, k6, k7, k8] = k.values[..] else {
        let what = format!("has {} numbers; a camera matrix has 9", k.values.len());
        return Err(k.fault(what, WHOLE_MATRIX));
    };
    let camera = Camera {
        name: name.to_owned(),
        width,
        height,
        fx,
        fy,
        cx: cx + 0.5,
        cy: cy + 0.5,
        skew,
        distortion,
    };
    camera.validate().map_err(|error| {
        let remedy = match error {
            CameraError::Size(..) => "write the size of the photos that were calibrated",
            _ => "zeros stand for a camera that was not calibrated: calibrate it",
        };
        k.fault(format!("belongs to no camera: {error}"), remedy)
    })?;
    // The places that must hold 0 and 1: after the focal lengths, whose message says more.
    for (index, value, wanted) in [(3, k3, 0.0), (6, k6, 0.0), (7, k7, 0.0), (8, k8, 1.0)] {
        if value != wanted {
            let what = format!("has {value} where a camera matrix has {wanted} (number {index})");
            let remedy = "write K row by row: fx, skew, cx, 0, fy, cy, 0, 0, 1";
            return Err(k.fault(what, remedy));
        }
    }
    Ok(camera)
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::cameras::camera_file::yaml_tree::{Node, first_document};

    fn tree(text: &str) -> Node {
        first_document(text).unwrap()
    }

    /// OpenCV's formula (its documentation, section of the header) by hand, at r2 = 0.05.
    #[test]
    fn a_point_lies_half_a_pixel_beyond_opencvs() {
        let tree =
            tree("\n[{K: [500, 2, 320, 0, 400, 240, 0, 0, 1]}, {D: [-0.2, 0.5, 0.01, 0.02, 2]}]");
        let Value::Sequence(parts) = &tree.value else {
            panic!("{tree:?}");
        };
        let k = Matrix::read(parts[0].get("K").unwrap()).unwrap();
        let d = Matrix::read(parts[1].get("D").unwrap()).unwrap();
        let lens = d.lens("plumb_bob", 2).unwrap();
        let camera = camera("", (640, 480), &k, lens).unwrap();
        let radial = 1.0 - 0.2 * 0.05 + 0.5 * 0.0025 + 2.0 * 0.000_125;
        let x = 0.2 * radial + 2.0 * 0.01 * -0.02 + 0.02 * (0.05 + 0.08);
        let y = -0.1 * radial + 0.01 * (0.05 + 0.02) + 2.0 * 0.02 * -0.02;
        let opencv = DVec2::new(500.0 * x + 2.0 * y + 320.0, 400.0 * y + 240.0);
        let pixel = camera.pixel_as_shot(DVec3::new(0.2, -0.1, 1.0)).unwrap();
        assert!((pixel - opencv - DVec2::splat(0.5)).length() < 1e-12);
        assert_eq!(camera.skew, 2.0);
    }

    #[test]
    fn a_matrix_has_as_many_numbers_as_it_says() {
        let what = |text: &str| {
            let tree = tree(text);
            let fault = Matrix::read(tree.get("D").unwrap()).err().unwrap();
            (fault.line, fault.what)
        };
        assert_eq!(
            what("\nD: {rows: 1, cols: 5, data: [1, 2]}"),
            (Some(2), "D is 1 x 5 and has 2 numbers".into())
        );
        assert_eq!(what("D: {rows: 1, data: [1]}").1, "D has no cols");
        assert_eq!(
            what("D: {rows: -1, cols: 1, data: []}").1,
            "D: rows is '-1', not a whole number from 0 on"
        );
        assert_eq!(what("D: 5").1, "D is '5', not keys with values");
    }
}
