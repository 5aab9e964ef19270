//! Camera models of OpenSfM (`camera_models.json`, the `cameras` of `reconstruction.json`) and of
//! OpenDroneMap (`cameras.json`).
//!
//! Written from OpenSfM's documentation ("Geometric Models") and source: `opensfm/io.py`
//! (`camera_from_json`: the keys and which of them may be missing), `opensfm/src/geometry/`
//! (`camera_projections_functions.h`, `camera_distortions_functions.h`,
//! `transformations_functions.h`: the formulas).
//!
//! A file is an object, name -> model. Lengths are normalised by s = max(width, height), with the
//! origin in the middle of the image: with px counting pixel centres, x = (px + 0.5 - w/2) / s. In
//! fragscale's pixels, which start at the outer corner, that is u = s x + w/2, so
//!
//! ```text
//! fx = s focal_x    fy = s focal_y    cx = w/2 + s c_x    cy = h/2 + s c_y
//! ```
//!
//! | projection_type | keys; `focal`s are required, the others 0 if left out | ours |
//! |---|---|---|
//! | perspective (also if left out) | focal k1 k2 | brown k1 k2 |
//! | simple_radial | focal_x focal_y c_x c_y k1 | brown k1 |
//! | radial | focal_x focal_y c_x c_y k1 k2 | brown k1 k2 |
//! | brown | focal_x focal_y c_x c_y k1 k2 k3 p1 p2 | brown k1 k2 p1 p2 k3 |
//! | fisheye | focal k1 k2 | fisheye k1 k2 |
//! | fisheye_opencv | focal_x focal_y c_x c_y k1 k2 k3 k4 | fisheye k1 k2 k3 k4 |
//! | fisheye62 | the same and k5 k6 p1 p2 | as fisheye_opencv, where those are 0 |
//! | fisheye624 | the same and s0 s1 s2 s3 | as fisheye_opencv, where those are 0 |
//! | dual | focal k1 k2 transition (0.5 if left out) | as perspective where transition is 1, as fisheye where it is 0 |
//!
//! OpenSfM keeps its brown coefficients in the order k1 k2 k3 p1 p2, but names them in JSON; its
//! tangential term is 2 p1 x y + p2 (r2 + 2 x2), 2 p2 x y + p1 (r2 + 2 y2), which is OpenCV's. It
//! holds focal_y as focal_x times an aspect ratio, which its JSON does not show. Its fish-eyes take
//! theta = atan2(r, z) and distort by 1 + k1 theta2 + k2 theta4 ..., which is OpenCV's.
//! dual projects to `transition` times the perspective point plus the rest times the fish-eye's.
//! `*_prior` keys are the values before the adjustment. What else these types can hold and the
//! panoramas (`spherical`, `equirectangular`) have no counterpart here.

use serde::Deserialize;

use crate::camera::{Brown, Camera, Distortion, Fisheye};
use crate::fault::Fault;
use crate::text::json::Object;

/// A model as the JSON has it.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
pub(crate) struct CameraModel {
    projection_type: Option<String>,
    width: Option<f64>,
    height: Option<f64>,
    focal: Option<f64>,
    focal_x: Option<f64>,
    focal_y: Option<f64>,
    c_x: Option<f64>,
    c_y: Option<f64>,
    k1: Option<f64>,
    k2: Option<f64>,
    k3: Option<f64>,
    k4: Option<f64>,
    k5: Option<f64>,
    k6: Option<f64>,
    p1: Option<f64>,
    p2: Option<f64>,
    s0: Option<f64>,
    s1: Option<f64>,
    s2: Option<f64>,
    s3: Option<f64>,
    transition: Option<f64>,
}

/// The cameras of a `camera_models.json` or `cameras.json`, in the file's order, each named as in
/// the file.
///
/// # Errors
/// Where it is no JSON of that shape, or a camera cannot be used, naming it.
pub(crate) fn read(json: &[u8]) -> Result<Vec<Camera>, Fault> {
    let models: Object<CameraModel> = crate::text::json::parse(json)?;
    let cameras = models.0.into_iter();
    cameras.map(|(id, model)| model.camera(&id)).collect()
}

/// Turns models into cameras. One that cannot be used is an error where a photo needs it
/// (`is_used`, by name), else it is left out with a warning.
pub(crate) fn usable_cameras(
    models: &Object<CameraModel>,
    is_used: impl Fn(&str) -> bool,
    warnings: &mut Vec<String>,
) -> Result<Vec<Camera>, Fault> {
    let mut cameras = Vec::with_capacity(models.0.len());
    for (id, model) in &models.0 {
        match model.camera(id) {
            Ok(camera) => cameras.push(camera),
            Err(fault) if is_used(id) => return Err(fault),
            Err(fault) => {
                warnings.push(format!("{}; no photo uses it, it is left out", fault.what))
            }
        }
    }
    Ok(cameras)
}

impl CameraModel {
    /// The lens, and whether the model has one focal length and no principal point; `None` where
    /// fragscale has no such lens.
    fn lens(&self) -> Option<(Distortion, bool)> {
        let or_zero = |value: Option<f64>| value.unwrap_or(0.0);
        let [k1, k2, k3, k4] = [self.k1, self.k2, self.k3, self.k4].map(or_zero);
        let [p1, p2] = [self.p1, self.p2].map(or_zero);
        let brown =
            |k2, p1, p2, k3| Distortion::Brown(Brown::new([k1, k2, p1, p2, k3, 0.0, 0.0, 0.0]));
        let fisheye = |k3, k4| Distortion::Fisheye(Fisheye::new([k1, k2, k3, k4]));
        let beyond_opencv = [
            self.k5, self.k6, self.p1, self.p2, self.s0, self.s1, self.s2, self.s3,
        ];
        Some(match self.projection() {
            "perspective" => (brown(k2, 0.0, 0.0, 0.0), true),
            "simple_radial" => (brown(0.0, 0.0, 0.0, 0.0), false),
            "radial" => (brown(k2, 0.0, 0.0, 0.0), false),
            "brown" => (brown(k2, p1, p2, k3), false),
            "fisheye" => (fisheye(0.0, 0.0), true),
            "fisheye_opencv" => (fisheye(k3, k4), false),
            "fisheye62" | "fisheye624" if beyond_opencv.map(or_zero) == [0.0; 8] => {
                (fisheye(k3, k4), false)
            }
            "dual" if self.transition == Some(1.0) => (brown(k2, 0.0, 0.0, 0.0), true),
            "dual" if self.transition == Some(0.0) => (fisheye(0.0, 0.0), true),
            _ => return None,
        })
    }

    fn projection(&self) -> &str {
        self.projection_type.as_deref().unwrap_or("perspective")
    }

    /// Why fragscale cannot use the model named `id`, where it has no such lens.
    pub(super) fn unsupported(&self, id: &str) -> Option<Fault> {
        match self.lens() {
            Some(_) => None,
            None => Some(unsupported(id, self.projection())),
        }
    }

    /// The camera of this model, named `id`.
    pub(super) fn camera(&self, id: &str) -> Result<Camera, Fault> {
        let projection = self.projection();
        let (distortion, one_focal) = self.lens().ok_or_else(|| unsupported(id, projection))?;
        let or_zero = |value: Option<f64>| value.unwrap_or(0.0);
        let required = |value: Option<f64>, key: &str| {
            value.ok_or_else(|| {
                Fault::new(
                    format!("camera \"{id}\" ({projection}) has no `{key}`"),
                    "export it again, or add the number",
                )
            })
        };
        let pixels = |value: Option<f64>, key: &str| {
            let count = required(value, key)?;
            if count.fract() != 0.0 || !(1.0..=f64::from(u32::MAX)).contains(&count) {
                return Err(Fault::new(
                    format!("camera \"{id}\": the {key} is {count}, not a number of pixels"),
                    "give the size of the images that the reconstruction was made from",
                ));
            }
            Ok(count)
        };
        let (width, height) = (pixels(self.width, "width")?, pixels(self.height, "height")?);
        let size = width.max(height);
        let (focal_x, focal_y, c_x, c_y) = if one_focal {
            let focal = required(self.focal, "focal")?;
            (focal, focal, 0.0, 0.0)
        } else {
            (
                required(self.focal_x, "focal_x")?,
                required(self.focal_y, "focal_y")?,
                or_zero(self.c_x),
                or_zero(self.c_y),
            )
        };
        let camera = Camera {
            name: id.to_owned(),
            // Whole numbers within the range, checked above.
            width: width as u32,
            height: height as u32,
            fx: size * focal_x,
            fy: size * focal_y,
            cx: width / 2.0 + size * c_x,
            cy: height / 2.0 + size * c_y,
            skew: 0.0,
            distortion,
        };
        camera.validate().map_err(|e| {
            Fault::new(
                format!("camera \"{id}\": {e}"),
                "correct the number, or export it again",
            )
        })?;
        Ok(camera)
    }
}

fn unsupported(id: &str, projection: &str) -> Fault {
    let what = format!("camera \"{id}\" has the projection type \"{projection}\"");
    match projection {
        "spherical" | "equirectangular" => Fault::new(
            format!("{what}: a panorama has no corners to measure between"),
            "use photos of a frame camera",
        ),
        "dual" | "fisheye62" | "fisheye624" => Fault::new(
            format!("{what}, which fragscale does not have"),
            "reconstruct with perspective, brown, radial, fisheye or fisheye_opencv \
             (OpenDroneMap: --camera-lens)",
        ),
        _ => Fault::new(
            format!("{what}, which is not one of OpenSfM's"),
            "check the spelling, or export it again",
        ),
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};
    use proptest::prelude::*;

    use super::*;

    fn one(model: &str) -> Result<Camera, Fault> {
        let json = format!("{{\"c\": {{\"width\": 400, \"height\": 200, {model}}}}}");
        Ok(read(json.as_bytes())?.remove(0))
    }

    #[test]
    fn perspective_is_the_default_and_centred() {
        let camera = one("\"focal\": 0.5, \"k1\": 0.25").unwrap();
        assert_eq!(
            (camera.name.as_str(), camera.width, camera.height),
            ("c", 400, 200)
        );
        assert_eq!((camera.fx, camera.fy, camera.skew), (200.0, 200.0, 0.0));
        assert_eq!((camera.cx, camera.cy), (200.0, 100.0));
        assert_eq!(camera.distortion.name(), "brown");
        // u = f (1 + k1 r2) x with r2 = 0.25.
        let pixel = camera.pixel_as_shot(DVec3::new(1.0, 0.0, 2.0)).unwrap();
        assert!((pixel - DVec2::new(200.0 + 200.0 * 0.5 * 1.0625, 100.0)).length() < 1e-12);
    }

    #[test]
    fn a_portrait_image_is_normalised_by_its_height() {
        let json = br#"{"p": {"projection_type": "radial", "width": 200, "height": 400.0,
            "focal_x": 0.5, "focal_y": 0.25, "c_x": 0.125, "c_y": -0.0625, "k1": 0.5, "k2": 0.25}}"#;
        let camera = read(json).unwrap().remove(0);
        assert_eq!((camera.fx, camera.fy), (200.0, 100.0));
        assert_eq!((camera.cx, camera.cy), (100.0 + 50.0, 200.0 - 25.0));
        assert_eq!(
            camera.distortion.coefficients()[..5],
            [0.5, 0.25, 0.0, 0.0, 0.0]
        );
    }

    /// OpenSfM's own formula, worked by hand at x = 0.5, y = 0.25 (r2 = 0.3125).
    #[test]
    fn brown_matches_the_documented_formula() {
        let camera = one(
            "\"projection_type\": \"brown\", \"focal_x\": 1, \"focal_y\": 1, \"c_x\": 0.01, \
             \"k1\": 0.1, \"k2\": 0.2, \"k3\": 0.3, \"p1\": 0.01, \"p2\": 0.02",
        )
        .unwrap();
        let (x, y, r2) = (0.5, 0.25, 0.3125_f64);
        let radial = 1.0 + 0.1 * r2 + 0.2 * r2 * r2 + 0.3 * r2 * r2 * r2;
        let tx = 2.0 * 0.01 * x * y + 0.02 * (r2 + 2.0 * x * x);
        let ty = 2.0 * 0.02 * x * y + 0.01 * (r2 + 2.0 * y * y);
        let expected = DVec2::new(
            200.0 + 400.0 * (radial * x + tx + 0.01),
            100.0 + 400.0 * (radial * y + ty),
        );
        let pixel = camera.pixel_as_shot(DVec3::new(x, y, 1.0)).unwrap();
        assert!(
            (pixel - expected).length() < 1e-10,
            "{pixel} is not {expected}"
        );
    }

    #[test]
    fn fisheyes_are_equidistant() {
        let theta = 0.6_f64;
        let point = DVec3::new(0.0, theta.sin(), theta.cos());
        let t2 = theta * theta;
        let fisheye = one(
            "\"projection_type\": \"fisheye\", \"focal\": 0.5, \"k1\": 0.1, \
             \"k2\": 0.02, \"k3\": 9",
        )
        .unwrap();
        let v = 100.0 + 200.0 * theta * (1.0 + 0.1 * t2 + 0.02 * t2 * t2);
        let pixel = fisheye.pixel_as_shot(point).unwrap();
        assert!((pixel - DVec2::new(200.0, v)).length() < 1e-10);
        let opencv = one(
            "\"projection_type\": \"fisheye_opencv\", \"focal_x\": 0.5, \"focal_y\": 0.25, \
             \"c_y\": 0.125, \"k1\": 0.1, \"k2\": 0.02, \"k3\": 0.003, \"k4\": 0.0004",
        )
        .unwrap();
        assert_eq!(opencv.distortion.coefficients(), [0.1, 0.02, 0.003, 0.0004]);
        assert_eq!(
            (opencv.fx, opencv.fy, opencv.cx, opencv.cy),
            (200.0, 100.0, 200.0, 150.0)
        );
    }

    #[test]
    fn simple_radial_has_one_coefficient() {
        let camera = one(
            "\"projection_type\": \"simple_radial\", \"focal_x\": 0.5, \"focal_y\": 0.5, \
             \"k1\": 0.5, \"k2\": 0.25",
        )
        .unwrap();
        assert_eq!(camera.distortion.coefficients()[..2], [0.5, 0.0]);
    }

    #[test]
    fn larger_models_are_used_where_they_say_no_more_than_ours() {
        let fisheye = "\"projection_type\": \"fisheye624\", \"focal_x\": 0.5, \"focal_y\": 0.5, \
             \"k1\": 0.1, \"k4\": 0.0004, \"k5\": 0, \"p1\": 0.0, \"s3\": 0";
        let camera = one(fisheye).unwrap();
        assert_eq!(camera.distortion.name(), "fisheye");
        assert_eq!(camera.distortion.coefficients(), [0.1, 0.0, 0.0, 0.0004]);
        for more in ["\"k5\": 1e-9", "\"p1\": -1e-9", "\"s3\": 1"] {
            let zero = &more[..5];
            let model = fisheye.replace(&format!("{zero} 0.0"), more);
            let model = model.replace(&format!("{zero} 0"), more);
            assert!(model.contains(more) && one(&model).is_err(), "{model}");
        }
        let dual = |transition: &str| {
            one(&format!(
                "\"projection_type\": \"dual\", \"focal\": 0.5, \"k1\": 0.1{transition}"
            ))
        };
        let name = |camera: Camera| camera.distortion.name();
        assert_eq!(dual(", \"transition\": 1").map(name), Ok("brown"));
        assert_eq!(dual(", \"transition\": 0.0").map(name), Ok("fisheye"));
        assert!(dual(", \"transition\": 0.5").is_err() && dual("").is_err());
    }

    #[test]
    fn what_cannot_be_used_is_named() {
        for other in [
            "dual",
            "fisheye62",
            "fisheye624",
            "spherical",
            "equirectangular",
            "pinhole",
        ] {
            let fault = one(&format!(
                "\"projection_type\": \"{other}\", \"focal\": 1, \"k5\": 1"
            ))
            .unwrap_err();
            assert!(
                fault.what.contains(other) && fault.what.contains("\"c\""),
                "{fault}"
            );
        }
        for (model, named) in [
            ("\"k1\": 0", "focal"),
            ("\"projection_type\": \"brown\", \"focal_x\": 1", "focal_y"),
            ("\"focal\": 0", "fx"),
            ("\"focal\": -1", "fx"),
            ("\"focal\": 1e308", "fx"),
            ("\"focal\": \"1\"", "string"),
            ("\"focal\": NaN", "expected value"),
        ] {
            let fault = one(model).unwrap_err();
            assert!(fault.what.contains(named), "{model}: {fault}");
        }
        for size in ["0", "-400", "400.5", "1e10", "null"] {
            let json = format!("{{\"c\": {{\"focal\": 1, \"height\": 9, \"width\": {size}}}}}");
            let fault = read(json.as_bytes()).unwrap_err();
            assert!(fault.what.contains("width"), "{size}: {fault}");
        }
    }

    #[test]
    fn an_unused_model_only_warns() {
        let json = br#"{"bad": {"projection_type": "dual"},
                        "good": {"focal": 1, "width": 2, "height": 2}}"#;
        let models: Object<CameraModel> = crate::text::json::parse(json).unwrap();
        let mut warnings = Vec::new();
        let cameras = usable_cameras(&models, |id| id == "good", &mut warnings).unwrap();
        assert_eq!((cameras.len(), warnings.len()), (1, 1));
        assert!(usable_cameras(&models, |id| id == "bad", &mut warnings).is_err());
        assert!(read(json).is_err());
    }

    proptest! {
        #[test]
        fn damaged_models_never_panic(at in 0_usize..200, byte: u8, cut in 0_usize..200) {
            let mut json = br#"{"c": {"projection_type": "brown", "width": 400, "height": 200,
                "focal_x": 0.5, "focal_y": 0.5, "c_x": 0.1, "k1": 0.1, "p1": 0.01}}"#.to_vec();
            let place = at % json.len();
            json[place] = byte;
            let _ = read(&json);
            json.truncate(cut);
            let _ = read(&json);
        }
    }
}
