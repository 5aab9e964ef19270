//! COLMAP's camera models, from `src/colmap/sensor/models.h` (read at 5d968cf38, August 2026):
//! ids and parameter orders.
//!
//! | id | name | parameters | here |
//! |---|---|---|---|
//! | 0 | SIMPLE_PINHOLE | f cx cy | none |
//! | 1 | PINHOLE | fx fy cx cy | none |
//! | 2 | SIMPLE_RADIAL | f cx cy k | brown |
//! | 3 | RADIAL | f cx cy k1 k2 | brown |
//! | 4 | OPENCV | fx fy cx cy k1 k2 p1 p2 | brown |
//! | 5 | OPENCV_FISHEYE | fx fy cx cy k1 k2 k3 k4 | fisheye |
//! | 6 | FULL_OPENCV | fx fy cx cy k1 k2 p1 p2 k3 k4 k5 k6 | brown |
//! | 7 | FOV | fx fy cx cy omega | refused |
//! | 8 | SIMPLE_RADIAL_FISHEYE | f cx cy k | fisheye |
//! | 9 | RADIAL_FISHEYE | f cx cy k1 k2 | fisheye |
//! | 10 | THIN_PRISM_FISHEYE | fx fy cx cy k1 k2 p1 p2 k3 k4 sx1 sy1 | fisheye, if p and s are 0 |
//! | 11 | RAD_TAN_THIN_PRISM_FISHEYE | fx fy cx cy k0..k5 p0 p1 s0..s3 | fisheye, if k4, k5, p and s are 0 |
//! | 12 | SIMPLE_DIVISION | f cx cy k | refused |
//! | 13 | DIVISION | fx fy cx cy k | refused |
//! | 14 | SIMPLE_FISHEYE | f cx cy | fisheye |
//! | 15 | FISHEYE | fx fy cx cy | fisheye |
//! | 16 | EUCM | fx fy cx cy alpha beta | refused |
//! | 17 | EQUIRECTANGULAR | w h | refused |
//!
//! All distortions act on the projected point, in focal lengths. The tangential terms are OpenCV's,
//! `du = 2 p1 u v + p2 (r2 + 2 u2)`, and the fish-eye polynomials take the angle as OpenCV's do
//! (`theta (1 + k1 theta2 + ...)`), so both map term by term. Pixels count from the outer corner of
//! the top-left pixel, as fragscale's do.

use crate::camera::{Brown, Camera, Distortion, Fisheye};
use crate::fault::Fault;

const UNDISTORT: &str = "undistort the images in COLMAP first (colmap image_undistorter) and give \
                         the model that it writes";
const PANORAMA: &str = "a panorama has no image scale: render perspective images from it first";
const EXPORT: &str = "export the model from COLMAP again";

/// A camera model of COLMAP.
#[derive(Debug)]
pub(super) struct Model {
    name: &'static str,
    /// One focal length for both axes, or two.
    focal_lengths: usize,
    /// How many coefficients follow the principal point.
    coefficients: usize,
    lens: Lens,
}

/// What a model's coefficients mean here.
#[derive(Debug, Clone, Copy)]
enum Lens {
    Pinhole,
    Brown,
    Fisheye,
    /// THIN_PRISM_FISHEYE: k1 k2 p1 p2 k3 k4 sx1 sy1.
    ThinPrism,
    /// RAD_TAN_THIN_PRISM_FISHEYE: k0..k5 p0 p1 s0..s3.
    RadTan,
    /// No such lens here; the remedy.
    Refused(&'static str),
}

/// By id.
const MODELS: [Model; 18] = [
    model("SIMPLE_PINHOLE", 1, 0, Lens::Pinhole),
    model("PINHOLE", 2, 0, Lens::Pinhole),
    model("SIMPLE_RADIAL", 1, 1, Lens::Brown),
    model("RADIAL", 1, 2, Lens::Brown),
    model("OPENCV", 2, 4, Lens::Brown),
    model("OPENCV_FISHEYE", 2, 4, Lens::Fisheye),
    model("FULL_OPENCV", 2, 8, Lens::Brown),
    model("FOV", 2, 1, Lens::Refused(UNDISTORT)),
    model("SIMPLE_RADIAL_FISHEYE", 1, 1, Lens::Fisheye),
    model("RADIAL_FISHEYE", 1, 2, Lens::Fisheye),
    model("THIN_PRISM_FISHEYE", 2, 8, Lens::ThinPrism),
    model("RAD_TAN_THIN_PRISM_FISHEYE", 2, 12, Lens::RadTan),
    model("SIMPLE_DIVISION", 1, 1, Lens::Refused(UNDISTORT)),
    model("DIVISION", 2, 1, Lens::Refused(UNDISTORT)),
    model("SIMPLE_FISHEYE", 1, 0, Lens::Fisheye),
    model("FISHEYE", 2, 0, Lens::Fisheye),
    model("EUCM", 2, 2, Lens::Refused(UNDISTORT)),
    model("EQUIRECTANGULAR", 0, 0, Lens::Refused(PANORAMA)),
];

const fn model(name: &'static str, focal_lengths: usize, coefficients: usize, lens: Lens) -> Model {
    Model {
        name,
        focal_lengths,
        coefficients,
        lens,
    }
}

impl Model {
    /// The model of a name in `cameras.txt`.
    ///
    /// # Errors
    /// Where COLMAP has no such model.
    pub(super) fn by_name(name: &str) -> Result<&'static Self, Fault> {
        MODELS.iter().find(|m| m.name == name).ok_or_else(|| {
            let shown = crate::text::fields::shown(name);
            Fault::new(format!("'{shown}' is no camera model of COLMAP"), EXPORT)
        })
    }

    /// The model of a number in `cameras.bin`.
    ///
    /// # Errors
    /// Where COLMAP has no such model.
    pub(super) fn by_id(id: i32) -> Result<&'static Self, Fault> {
        usize::try_from(id)
            .ok()
            .and_then(|index| MODELS.get(index))
            .ok_or_else(|| {
                let what = format!("COLMAP has no camera model number {id}");
                Fault::new(what, EXPORT)
            })
    }

    /// How many parameters the model has.
    pub(super) fn parameters(&self) -> usize {
        self.focal_lengths + 2 + self.coefficients
    }

    /// The camera with COLMAP's id `id`, which is its name here; `parameters` in COLMAP's order,
    /// sizes and lengths in pixels.
    ///
    /// # Errors
    /// Where the model has no counterpart here, the count of parameters is another one, or the
    /// numbers are not those of a camera.
    pub(super) fn camera(
        &self,
        id: u32,
        [width, height]: [u64; 2],
        parameters: &[f64],
    ) -> Result<Camera, Fault> {
        let name = self.name;
        if let Lens::Refused(remedy) = self.lens {
            return Err(self.refused(id, "", remedy));
        }
        let (fx, fy, cx, cy, coefficients) = match (self.focal_lengths, parameters) {
            _ if parameters.len() != self.parameters() => None,
            (1, &[f, cx, cy, ref rest @ ..]) => Some((f, f, cx, cy, rest)),
            (_, &[fx, fy, cx, cy, ref rest @ ..]) => Some((fx, fy, cx, cy, rest)),
            _ => None,
        }
        .ok_or_else(|| {
            let (has, needs) = (parameters.len(), self.parameters());
            let what =
                format!("camera id {id} has {has} parameters, where the model {name} has {needs}");
            Fault::new(what, EXPORT)
        })?;
        let size = |pixels: u64, side: &str| {
            u32::try_from(pixels).map_err(|_| {
                let what = format!("camera id {id} claims a {side} of {pixels} pixels");
                Fault::new(what, EXPORT)
            })
        };
        let camera = Camera {
            name: id.to_string(),
            width: size(width, "width")?,
            height: size(height, "height")?,
            fx,
            fy,
            cx,
            cy,
            skew: 0.0,
            distortion: self.distortion(id, coefficients)?,
        };
        camera
            .validate()
            .map_err(|e| Fault::new(format!("camera id {id}: {e}"), EXPORT))?;
        Ok(camera)
    }

    fn distortion(&self, id: u32, coefficients: &[f64]) -> Result<Distortion, Fault> {
        let fisheye = |k: &[f64], extra: &[f64]| {
            if extra.iter().any(|&e| e != 0.0) {
                let why = " with prism, tangential or further radial terms";
                return Err(self.refused(id, why, UNDISTORT));
            }
            Ok(Distortion::Fisheye(Fisheye::new(filled(k))))
        };
        match (self.lens, coefficients) {
            (Lens::Pinhole, _) => Ok(Distortion::None),
            (Lens::Brown, k) => Ok(Distortion::Brown(Brown::new(filled(k)))),
            (Lens::ThinPrism, &[k1, k2, p1, p2, k3, k4, sx1, sy1]) => {
                fisheye(&[k1, k2, k3, k4], &[p1, p2, sx1, sy1])
            }
            (Lens::RadTan, &[k0, k1, k2, k3, ref extra @ ..]) => fisheye(&[k0, k1, k2, k3], extra),
            (Lens::Fisheye | Lens::ThinPrism | Lens::RadTan, k) => fisheye(k, &[]),
            (Lens::Refused(remedy), _) => Err(self.refused(id, "", remedy)),
        }
    }

    fn refused(&self, id: u32, why: &str, remedy: &str) -> Fault {
        let name = self.name;
        let what = format!(
            "camera id {id} has COLMAP's lens model {name}{why}, which fragscale does not know"
        );
        Fault::new(what, remedy)
    }
}

/// The given coefficients, then zeros.
fn filled<const N: usize>(given: &[f64]) -> [f64; N] {
    let mut all = [0.0; N];
    for (to, from) in all.iter_mut().zip(given) {
        *to = *from;
    }
    all
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn camera(name: &str, parameters: &[f64]) -> Result<Camera, Fault> {
        Model::by_name(name)?.camera(7, [4000, 3000], parameters)
    }

    /// The names and numbers of the enumeration in COLMAP's `models.h`.
    #[test]
    fn ids_are_colmaps() {
        for (id, name, parameters) in [
            (0, "SIMPLE_PINHOLE", 3),
            (1, "PINHOLE", 4),
            (2, "SIMPLE_RADIAL", 4),
            (3, "RADIAL", 5),
            (4, "OPENCV", 8),
            (5, "OPENCV_FISHEYE", 8),
            (6, "FULL_OPENCV", 12),
            (7, "FOV", 5),
            (8, "SIMPLE_RADIAL_FISHEYE", 4),
            (9, "RADIAL_FISHEYE", 5),
            (10, "THIN_PRISM_FISHEYE", 12),
            (11, "RAD_TAN_THIN_PRISM_FISHEYE", 16),
            (12, "SIMPLE_DIVISION", 4),
            (13, "DIVISION", 5),
            (14, "SIMPLE_FISHEYE", 3),
            (15, "FISHEYE", 4),
            (16, "EUCM", 6),
            (17, "EQUIRECTANGULAR", 2),
        ] {
            let model = Model::by_id(id).unwrap();
            assert_eq!(model.name, name);
            assert_eq!(model.parameters(), parameters, "{name}");
        }
        for id in [-1, 18, i32::MAX, i32::MIN] {
            assert!(Model::by_id(id).is_err());
        }
        assert!(Model::by_name("opencv").is_err());
    }

    #[test]
    fn every_model_that_has_a_counterpart_maps() {
        let brown = |k| Distortion::Brown(Brown::new(k));
        let fisheye = |k| Distortion::Fisheye(Fisheye::new(k));
        let (f, c) = ([900.0, 910.0], [2001.5, 1502.5]);
        let two = |k: &[f64]| [&f, &c, k].concat();
        let one = |k: &[f64]| [&f[..1], &c, k].concat();
        for (name, parameters, fy, distortion) in [
            ("SIMPLE_PINHOLE", one(&[]), f[0], Distortion::None),
            ("PINHOLE", two(&[]), f[1], Distortion::None),
            (
                "SIMPLE_RADIAL",
                one(&[0.1]),
                f[0],
                brown([0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            ),
            (
                "RADIAL",
                one(&[0.1, 0.2]),
                f[0],
                brown([0.1, 0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            ),
            (
                "OPENCV",
                two(&[0.1, 0.2, 0.3, 0.4]),
                f[1],
                brown([0.1, 0.2, 0.3, 0.4, 0.0, 0.0, 0.0, 0.0]),
            ),
            (
                "FULL_OPENCV",
                two(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]),
                f[1],
                brown([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]),
            ),
            ("SIMPLE_FISHEYE", one(&[]), f[0], fisheye([0.0; 4])),
            ("FISHEYE", two(&[]), f[1], fisheye([0.0; 4])),
            (
                "SIMPLE_RADIAL_FISHEYE",
                one(&[0.1]),
                f[0],
                fisheye([0.1, 0.0, 0.0, 0.0]),
            ),
            (
                "RADIAL_FISHEYE",
                one(&[0.1, 0.2]),
                f[0],
                fisheye([0.1, 0.2, 0.0, 0.0]),
            ),
            (
                "OPENCV_FISHEYE",
                two(&[0.1, 0.2, 0.3, 0.4]),
                f[1],
                fisheye([0.1, 0.2, 0.3, 0.4]),
            ),
            (
                "THIN_PRISM_FISHEYE",
                two(&[0.1, 0.2, 0.0, 0.0, 0.3, 0.4, 0.0, 0.0]),
                f[1],
                fisheye([0.1, 0.2, 0.3, 0.4]),
            ),
            (
                "RAD_TAN_THIN_PRISM_FISHEYE",
                two(&[0.1, 0.2, 0.3, 0.4, 0.0, 0.0, 0.0, -0.0, 0.0, 0.0, 0.0, 0.0]),
                f[1],
                fisheye([0.1, 0.2, 0.3, 0.4]),
            ),
        ] {
            let expected = Camera {
                name: "7".to_owned(),
                width: 4000,
                height: 3000,
                fx: f[0],
                fy,
                cx: c[0],
                cy: c[1],
                skew: 0.0,
                distortion,
            };
            assert_eq!(camera(name, &parameters), Ok(expected), "{name}");
            let (short, long) = (&parameters[1..], [&parameters[..], &[0.0]].concat());
            assert!(camera(name, short).is_err(), "{name}");
            assert!(camera(name, &long).is_err(), "{name}");
        }
    }

    /// f = 1000, k = 0.1, the point (0.3, 0.4, 1): r2 = 0.25, so the factor is 1.025.
    #[test]
    fn a_known_pixel() {
        let camera = camera("SIMPLE_RADIAL", &[1000.0, 2000.0, 1500.0, 0.1]).unwrap();
        let pixel = camera.pixel_as_shot(DVec3::new(0.3, 0.4, 1.0)).unwrap();
        assert!((pixel.x - 2307.5).abs() < 1e-9 && (pixel.y - 1910.0).abs() < 1e-9);
    }

    #[test]
    fn other_models_are_refused_by_name() {
        for name in ["FOV", "SIMPLE_DIVISION", "DIVISION", "EUCM"] {
            let fault = camera(name, &[1.0; 5]).unwrap_err().to_string();
            assert!(fault.contains(name) && fault.contains("image_undistorter"));
        }
        let fault = camera("EQUIRECTANGULAR", &[1.0; 2]).unwrap_err();
        assert!(fault.to_string().contains("perspective"), "{fault}");
        for (name, extra) in [
            ("THIN_PRISM_FISHEYE", [2, 3, 6, 7].as_slice()),
            ("RAD_TAN_THIN_PRISM_FISHEYE", &[4, 5, 6, 7, 8, 9, 10, 11]),
        ] {
            for &index in extra {
                let count = Model::by_name(name).unwrap().parameters();
                let mut parameters = vec![0.0; count];
                parameters[0] = 900.0;
                parameters[1] = 900.0;
                parameters[4 + index] = 1e-9;
                let fault = camera(name, &parameters).unwrap_err().to_string();
                assert!(fault.contains(name) && fault.contains("image_undistorter"));
            }
        }
    }

    #[test]
    fn impossible_cameras_are_refused() {
        for bad in [
            [0.0, 1.0, 1.0],
            [-5.0, 1.0, 1.0],
            [f64::NAN, 1.0, 1.0],
            [1.0, 1.0, f64::INFINITY],
        ] {
            assert!(camera("SIMPLE_PINHOLE", &bad).is_err());
        }
        let pinhole = Model::by_id(0).unwrap();
        for size in [[0, 3000], [4000, 0], [1 << 32, 3000], [4000, u64::MAX]] {
            assert!(pinhole.camera(1, size, &[1.0; 3]).is_err());
        }
    }
}
