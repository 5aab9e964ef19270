//! Cameras of a Meshroom scene: the entries of `intrinsics`.
//!
//! Written from AliceVision's `sfmDataIO/jsonIO.cpp` (`loadIntrinsic`) and `camera/`
//! (`IntrinsicScaleOffset.cpp`: the focal lengths, `cameraCommon.hpp`: the names of the types,
//! `Distortion*.cpp` and `Equidistant.cpp`: the formulas).
//!
//! With s = width / sensorWidth pixels per mm (sensorWidth is 36 where it is left out):
//!
//! | version | focal lengths |
//! |---|---|
//! | below 1.2.0 | fx = fy = pxFocalLength |
//! | 1.2.0, 1.2.1 | (fx, fy) = pxFocalLength |
//! | 1.2.2 to 1.2.4 | fx = s focalLength, fy = fx / pixelRatio |
//! | 1.2.5 to 1.2.10 | fx = s focalLength, fy = fx pixelRatio |
//! | since 1.2.11 | fy = s focalLength, fx = fy / pixelRatio |
//!
//! principalPoint counts from the top-left corner below 1.2.1, from the middle of the image since.
//!
//! Below 1.2.8 `type` names projection and lens in one, since then `type` is pinhole or equidistant,
//! and the lens is `distortionType`. distortionParams take the ideal point to the distorted one:
//!
//! | type, distortionType | parameters | ours |
//! |---|---|---|
//! | pinhole, none | | none |
//! | radial1, radialk1 | k1 | brown k1 |
//! | radial3, radialk3 | k1 k2 k3 | brown k1 k2 k3 |
//! | radialk3pt | k1 k2 k3 | the same, focal lengths divided by 1 + k1 + k2 + k3 |
//! | brown | k1 k2 k3 t1 t2 | brown k1 k2 k3, p1 = t1, p2 = t2 |
//! | fisheye4, fisheye | k1 k2 k3 k4 | fisheye |
//! | equidistant | as the radial ones above; equidistant_r3 is radialk3pt | fisheye |
//!
//! An equidistant camera sees the angle theta at the radius g theta before its lens and the scale
//! fx, g = 2 fx sensorWidth / (max(width, height) min(sensorWidth, sensorHeight)): fragscale's
//! focal lengths are g fx, g fy, its coefficients k1 g2, k2 g4, k3 g6.
//!
//! `undistortionType` (3DEqualizer's models, which take the distorted point to the ideal one) and
//! fisheye1 (the field-of-view model) have no counterpart here.

use serde::Deserialize;

use super::Version;
use super::loose::{Id, Number, Numbers};
use crate::camera::{Brown, Camera, Distortion, Fisheye};

/// An entry of `intrinsics`.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct RawIntrinsic {
    pub(super) intrinsic_id: Id,
    #[serde(rename = "type")]
    kind: Option<String>,
    distortion_type: Option<String>,
    undistortion_type: Option<String>,
    width: Option<Number>,
    height: Option<Number>,
    sensor_width: Option<Number>,
    sensor_height: Option<Number>,
    px_focal_length: Option<Numbers>,
    focal_length: Option<Number>,
    pixel_ratio: Option<Number>,
    principal_point: Option<Numbers>,
    distortion_params: Option<Numbers>,
}

impl RawIntrinsic {
    /// The camera, named by its id, with a remark where there is one.
    ///
    /// # Errors
    /// Why it cannot be used, in words.
    pub(super) fn camera(&self, version: Version) -> Result<(Camera, Option<String>), String> {
        let (w, h) = (size(self.width, "width")?, size(self.height, "height")?);
        let (width, height) = (f64::from(w), f64::from(h));
        let (fx, fy) = self.focal_lengths(version, width)?;
        let [mut cx, mut cy] = match self.principal_point.as_ref().map(|p| p.0.as_slice()) {
            Some(&[x, y]) => [x, y],
            Some(_) => return Err("its principalPoint is not two numbers".to_owned()),
            None => return Err("it has no principalPoint".to_owned()),
        };
        if version >= Version([1, 2, 1]) {
            cx += width / 2.0;
            cy += height / 2.0;
        }
        let lens = self.lens(fx, width.max(height))?;
        let camera = Camera {
            name: self.intrinsic_id.0.clone(),
            width: w,
            height: h,
            fx: fx * lens.scale,
            fy: fy * lens.scale,
            cx,
            cy,
            skew: 0.0,
            distortion: lens.distortion,
        };
        camera.validate().map_err(|e| e.to_string())?;
        Ok((camera, lens.remark))
    }

    fn focal_lengths(&self, version: Version, width: f64) -> Result<(f64, f64), String> {
        if version < Version([1, 2, 2]) {
            return match self.px_focal_length.as_ref().map(|f| f.0.as_slice()) {
                Some(&[f]) => Ok((f, f)),
                Some(&[fx, fy]) => Ok((fx, fy)),
                _ => Err("it has no pxFocalLength".to_owned()),
            };
        }
        let focal = self.focal_length.ok_or("it has no focalLength")?.0;
        let ratio = self.pixel_ratio.map_or(1.0, |ratio| ratio.0);
        let f = focal * width / self.sensor_width()?;
        Ok(if version < Version([1, 2, 5]) {
            (f, f / ratio)
        } else if version < Version([1, 2, 11]) {
            (f, f * ratio)
        } else {
            (f / ratio, f)
        })
    }

    fn sensor_width(&self) -> Result<f64, String> {
        let width = self.sensor_width.map_or(36.0, |width| width.0);
        if width <= 0.0 {
            return Err(format!("its sensorWidth is {width} mm"));
        }
        Ok(width)
    }

    /// The lens behind a focal length fx in pixels; `longer` is the image's longer side.
    fn lens(&self, fx: f64, longer: f64) -> Result<Lens, String> {
        let kind = self
            .kind
            .as_deref()
            .ok_or("it has no type")?
            .to_ascii_lowercase();
        let of = |name: &Option<String>| name.as_deref().unwrap_or("none").to_ascii_lowercase();
        let undistortion = of(&self.undistortion_type);
        if undistortion != "none" {
            return Err(format!(
                "fragscale does not have its undistortionType \"{undistortion}\""
            ));
        }
        let (is_equidistant, model) = match (kind.as_str(), &self.distortion_type) {
            ("equidistant", model) => (true, of(model)),
            ("equidistant_r3", _) => (true, "radialk3pt".to_owned()),
            ("pinhole", model) => (false, of(model)),
            ("radial1", _) => (false, "radialk1".to_owned()),
            ("radial3", _) => (false, "radialk3".to_owned()),
            ("fisheye4", _) => (false, "fisheye".to_owned()),
            (other, _) => (false, other.to_owned()),
        };
        let coefficients = self.coefficients(match model.as_str() {
            "none" => 0,
            "radialk1" | "fisheye1" => 1,
            "radialk3" | "radialk3pt" => 3,
            "fisheye" => 4,
            "brown" => 5,
            _ => return Err(format!("fragscale does not have its type \"{model}\"")),
        })?;
        let [k1, k2, k3, k4, k5] = coefficients;
        let unity = match model.as_str() {
            "radialk3pt" => 1.0 + k1 + k2 + k3,
            _ => 1.0,
        };
        let (distortion, scale) = match model.as_str() {
            "none" | "radialk1" | "radialk3" | "radialk3pt" if is_equidistant => {
                let g = self.equidistant_scale(fx, longer)?;
                let g2 = g * g;
                let lens = Fisheye::new([k1 * g2, k2 * g2 * g2, k3 * g2 * g2 * g2, 0.0]);
                (Distortion::Fisheye(lens), g)
            }
            _ if is_equidistant => {
                return Err(format!(
                    "fragscale does not have an equidistant \"{model}\""
                ));
            }
            "none" => (Distortion::None, 1.0),
            "fisheye1" if k1 == 0.0 => (Distortion::None, 1.0),
            "fisheye" => (Distortion::Fisheye(Fisheye::new([k1, k2, k3, k4])), 1.0),
            "brown" => (brown([k1, k2, k4, k5, k3]), 1.0),
            "radialk1" | "radialk3" | "radialk3pt" => (brown([k1, k2, 0.0, 0.0, k3]), 1.0),
            _ => return Err(format!("fragscale does not have its lens \"{model}\"")),
        };
        let remark = (unity != 1.0).then(|| {
            format!("its focal lengths are divided by {unity}, the sum that its lens radialk3pt is divided by")
        });
        Ok(Lens {
            distortion,
            scale: scale / unity,
            remark,
        })
    }

    /// The coefficients, of which there must be `count`, or none, which stands for zeros.
    fn coefficients(&self, count: usize) -> Result<[f64; 5], String> {
        let given = self
            .distortion_params
            .as_ref()
            .map_or(&[][..], |params| &params.0);
        let mut coefficients = [0.0; 5];
        if count == 0 || given.is_empty() {
            return Ok(coefficients);
        }
        if given.len() != count {
            return Err(format!(
                "it has {} distortionParams, its lens takes {count}",
                given.len()
            ));
        }
        for (coefficient, given) in coefficients.iter_mut().zip(given) {
            *coefficient = *given;
        }
        Ok(coefficients)
    }

    fn equidistant_scale(&self, fx: f64, longer: f64) -> Result<f64, String> {
        let width = self.sensor_width()?;
        let height = self.sensor_height.map_or(24.0, |height| height.0);
        let shorter = width.min(height);
        if shorter <= 0.0 {
            return Err(format!("its sensorHeight is {height} mm"));
        }
        Ok(2.0 * fx * width / longer / shorter)
    }
}

/// A lens, and what the focal lengths are to be multiplied by.
struct Lens {
    distortion: Distortion,
    scale: f64,
    remark: Option<String>,
}

fn brown([k1, k2, p1, p2, k3]: [f64; 5]) -> Distortion {
    Distortion::Brown(Brown::new([k1, k2, p1, p2, k3, 0.0, 0.0, 0.0]))
}

fn size(number: Option<Number>, name: &str) -> Result<u32, String> {
    let Some(Number(count)) = number else {
        return Err(format!("it has no {name}"));
    };
    if count.fract() != 0.0 || !(1.0..=f64::from(u32::MAX)).contains(&count) {
        return Err(format!("its {name} is {count}, not a number of pixels"));
    }
    // A whole number within the range, checked above.
    Ok(count as u32)
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;
    use crate::text::json::parse;

    fn of(version: [u32; 3], fields: &str) -> Result<(Camera, Option<String>), String> {
        let json = format!(
            r#"{{"intrinsicId": "5", "width": "4000", "height": "2000", "sensorWidth": "36",
                "sensorHeight": "24", {fields}}}"#
        );
        parse::<RawIntrinsic>(json.as_bytes())
            .unwrap()
            .camera(Version(version))
    }

    /// The same camera, fx = 1000, fy = 2000, principal point (1980, 1016), as each version writes it.
    #[test]
    fn every_version_says_the_same() {
        for (version, fields) in [
            (
                [1, 2, 0],
                r#""pxFocalLength": ["1000", "2000"], "principalPoint": ["1980", "1016"]"#,
            ),
            (
                [1, 2, 1],
                r#""pxFocalLength": [1000, 2000], "principalPoint": [-20, 16]"#,
            ),
            (
                [1, 2, 4],
                r#""focalLength": "9", "pixelRatio": "0.5", "principalPoint": ["-20", "16"]"#,
            ),
            (
                [1, 2, 5],
                r#""focalLength": "9", "pixelRatio": "2", "principalPoint": ["-20", "16"]"#,
            ),
            (
                [1, 2, 10],
                r#""focalLength": "9", "pixelRatio": "2", "principalPoint": ["-20", "16"]"#,
            ),
            (
                [1, 2, 11],
                r#""focalLength": "18", "pixelRatio": "2", "principalPoint": ["-20", "16"]"#,
            ),
        ] {
            let (camera, remark) =
                of(version, &format!("{fields}, \"type\": \"pinhole\"")).unwrap();
            assert_eq!((camera.fx, camera.fy), (1000.0, 2000.0), "{version:?}");
            assert_eq!((camera.cx, camera.cy), (1980.0, 1016.0), "{version:?}");
            assert_eq!((camera.distortion, remark), (Distortion::None, None));
        }
        let old = r#""type": "pinhole", "pxFocalLength": "1500", "principalPoint": [2000, 1000]"#;
        let (camera, _) = of([1, 0, 0], old).unwrap();
        assert_eq!((camera.fx, camera.fy, camera.cx), (1500.0, 1500.0, 2000.0));
    }

    fn lens(types: &str, params: &str) -> Result<(Camera, Option<String>), String> {
        let fields = format!(
            r#""focalLength": 18, "principalPoint": [0, 0], {types}, "distortionParams": {params}"#
        );
        of([1, 2, 11], &fields)
    }

    #[test]
    fn lenses_distort_as_their_formulas_say() {
        let (x, y) = (0.5, 0.25);
        let r2: f64 = x * x + y * y;
        let radial = 1.0 + 0.1 * r2 + 0.02 * r2 * r2 + 0.003 * r2 * r2 * r2;
        let (r, theta) = (r2.sqrt(), r2.sqrt().atan());
        let t2 = theta * theta;
        let fisheye =
            theta / r * (1.0 + 0.1 * t2 + 0.02 * t2 * t2 + 0.003 * t2.powi(3) + 4e-4 * t2.powi(4));
        let tangential = DVec2::new(
            0.02 * (r2 + 2.0 * x * x) + 2.0 * 0.01 * x * y,
            0.01 * (r2 + 2.0 * y * y) + 2.0 * 0.02 * x * y,
        );
        let plane = DVec2::new(x, y);
        for (types, params, expected) in [
            (
                r#""type": "pinhole", "distortionType": "none""#,
                "\"\"",
                plane,
            ),
            (
                r#""type": "Pinhole", "distortionType": "radialk1""#,
                "[0.1]",
                plane * (1.0 + 0.1 * r2),
            ),
            (
                r#""type": "radial1""#,
                r#"["0.1"]"#,
                plane * (1.0 + 0.1 * r2),
            ),
            (r#""type": "radial3""#, "[0.1, 0.02, 0.003]", plane * radial),
            (r#""type": "radial3""#, "\"\"", plane),
            (
                r#""type": "pinhole", "distortionType": "radialk3pt""#,
                "[0.1, 0.02, 0.003]",
                plane * radial / 1.123,
            ),
            (
                r#""type": "brown""#,
                "[0.1, 0.02, 0.003, 0.01, 0.02]",
                plane * radial + tangential,
            ),
            (
                r#""type": "fisheye4""#,
                "[0.1, 0.02, 0.003, 0.0004]",
                plane * fisheye,
            ),
        ] {
            let (camera, remark) = lens(types, params).unwrap();
            let pixel = camera.pixel_as_shot(DVec3::new(x, y, 1.0)).unwrap();
            let expected = DVec2::new(2000.0, 1000.0) + expected * 2000.0;
            assert!(
                (pixel - expected).length() < 1e-9,
                "{types}: {pixel} is not {expected}"
            );
            assert_eq!(remark.is_some(), types.contains("radialk3pt"));
        }
    }

    /// `Equidistant::project` with fx = 2000 px of 4000, on 36 x 24 mm: 18 mm, so a view of 24 / 18
    /// radians, whose half is at radius 1.
    #[test]
    fn equidistant_cameras_are_fish_eyes() {
        let theta = 0.4_f64;
        let point = DVec3::new(0.0, theta.sin(), theta.cos());
        let radius = theta / (0.5 * 24.0 / 18.0);
        let r2 = radius * radius;
        let radial = 1.0 + 0.1 * r2 + 0.02 * r2 * r2 + 0.003 * r2 * r2 * r2;
        for (types, params, factor) in [
            (
                r#""type": "equidistant", "distortionType": "none""#,
                "\"\"",
                1.0,
            ),
            (
                r#""type": "equidistant", "distortionType": "radialk3""#,
                "[0.1, 0.02, 0.003]",
                radial,
            ),
            (
                r#""type": "equidistant_r3""#,
                "[0.1, 0.02, 0.003]",
                radial / 1.123,
            ),
        ] {
            let (camera, _) = lens(types, params).unwrap();
            let pixel = camera.pixel_as_shot(point).unwrap();
            let expected = DVec2::new(2000.0, 1000.0 + 2000.0 * radius * factor);
            assert!(
                (pixel - expected).length() < 1e-9,
                "{types}: {pixel} is not {expected}"
            );
        }
    }

    #[test]
    fn what_cannot_be_used_says_why() {
        for (types, params, named) in [
            (r#""type": "3deanamorphic4""#, "[]", "3deanamorphic4"),
            (
                r#""type": "pinhole", "undistortionType": "3declassicld""#,
                "[]",
                "3declassicld",
            ),
            (r#""type": "fisheye1""#, "[0.9]", "fisheye1"),
            (
                r#""type": "equidistant", "distortionType": "brown""#,
                "[]",
                "equidistant",
            ),
            (r#""type": "radial3""#, "[0.1]", "takes 3"),
            (r#""distortionType": "none""#, "[]", "no type"),
        ] {
            let why = lens(types, params).unwrap_err();
            assert!(why.contains(named), "{types}: {why}");
        }
        for (fields, named) in [
            (r#""principalPoint": [0, 0]"#, "no focalLength"),
            (r#""focalLength": 18"#, "no principalPoint"),
            (r#""focalLength": 18, "principalPoint": [0]"#, "two numbers"),
            (
                r#""focalLength": -1, "principalPoint": [0, 0]"#,
                "focal length",
            ),
            (
                r#""focalLength": 18, "pixelRatio": 0, "principalPoint": [0, 0]"#,
                "fx",
            ),
        ] {
            let why = of([1, 2, 11], &format!("\"type\": \"pinhole\", {fields}")).unwrap_err();
            assert!(why.contains(named), "{fields}: {why}");
        }
    }
}
