//! The INTRINSICS of the file and of its frames, and the cameras that they are.

use std::f64::consts::PI;

use serde::Deserialize;

use crate::camera::{Brown, Camera, Distortion, Fisheye};

/// The widest field of view that a lens without a fish-eye's projection is believed, degrees: the widest that are made see about 130
/// across their longer side.
const WIDEST: f64 = 150.0;

#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
pub(super) struct RawIntrinsics {
    camera_model: Option<String>,
    is_fisheye: Option<bool>,
    pub(super) w: Option<f64>,
    pub(super) h: Option<f64>,
    fl_x: Option<f64>,
    fl_y: Option<f64>,
    cx: Option<f64>,
    cy: Option<f64>,
    camera_angle_x: Option<f64>,
    camera_angle_y: Option<f64>,
    ftheta_p0: Option<f64>,
    latlong: Option<bool>,
    equirectangular: Option<bool>,
    k1: Option<f64>,
    k2: Option<f64>,
    k3: Option<f64>,
    k4: Option<f64>,
    p1: Option<f64>,
    p2: Option<f64>,
}

/// How much of the world a pinhole sees across this many pixels, radians.
fn field_of_view(pixels: f64, focal: f64) -> f64 {
    2.0 * (pixels / 2.0 / focal).atan()
}

/// Whether an angle is that of another lens.
fn is_another(field_of_view: f64, angle: f64) -> bool {
    (field_of_view - angle).abs() > 0.05 * field_of_view
}

impl RawIntrinsics {
    /// These, and the file's where they say nothing.
    pub(super) fn or(self, file: &Self) -> Self {
        // An angle is another word for a focal length: the frame's stands before the file's length.
        let own_x = self.fl_x.is_some() || self.camera_angle_x.is_some();
        let own_y = own_x || self.fl_y.is_some() || self.camera_angle_y.is_some();
        Self {
            camera_model: self.camera_model.or_else(|| file.camera_model.clone()),
            is_fisheye: self.is_fisheye.or(file.is_fisheye),
            w: self.w.or(file.w),
            h: self.h.or(file.h),
            fl_x: self.fl_x.or(file.fl_x.filter(|_| !own_x)),
            fl_y: self.fl_y.or(file.fl_y.filter(|_| !own_y)),
            cx: self.cx.or(file.cx),
            cy: self.cy.or(file.cy),
            camera_angle_x: self
                .camera_angle_x
                .or(file.camera_angle_x.filter(|_| !own_x)),
            camera_angle_y: self
                .camera_angle_y
                .or(file.camera_angle_y.filter(|_| !own_y)),
            ftheta_p0: self.ftheta_p0.or(file.ftheta_p0),
            latlong: self.latlong.or(file.latlong),
            equirectangular: self.equirectangular.or(file.equirectangular),
            k1: self.k1.or(file.k1),
            k2: self.k2.or(file.k2),
            k3: self.k3.or(file.k3),
            k4: self.k4.or(file.k4),
            p1: self.p1.or(file.p1),
            p2: self.p2.or(file.p2),
        }
    }

    /// Whether the lens is a fish-eye; `None` for a model that fragscale does not have.
    fn is_fisheye(&self) -> Option<bool> {
        match self.camera_model.as_deref() {
            None => Some(self.is_fisheye.unwrap_or(false)),
            Some("OPENCV_FISHEYE") => Some(true),
            Some("OPENCV" | "PINHOLE" | "SIMPLE_PINHOLE" | "SIMPLE_RADIAL" | "RADIAL") => {
                Some(self.is_fisheye.unwrap_or(false))
            }
            Some(_) => None,
        }
    }

    pub(super) fn unsupported_model(&self) -> Option<String> {
        let panorama = self.latlong == Some(true) || self.equirectangular == Some(true);
        if panorama || self.ftheta_p0.is_some() {
            let model = if panorama { "a panorama" } else { "F-theta" };
            return Some(model.to_owned());
        }
        match self.is_fisheye() {
            Some(false) if self.k4.unwrap_or(0.0) != 0.0 => {
                Some("a perspective one with k4".into())
            }
            Some(_) => None,
            None => self.camera_model.clone(),
        }
    }

    /// What to say where the focal length and the angle beside it, which is only for information, are
    /// of different lenses: often a focal length of another image size. One in millimetres is refused by that angle; without it,
    /// it is named.
    pub(super) fn contradiction(&self, camera: &Camera) -> Option<String> {
        let fl_x = self.fl_x?;
        let own = field_of_view(f64::from(camera.width), fl_x);
        let seen = format!(
            "camera '{}': fl_x {fl_x} px is a field of view of {:.1} degrees",
            camera.name,
            own.to_degrees()
        );
        match self.camera_angle_x {
            Some(angle) => is_another(own, angle).then(|| {
                let angle = angle.to_degrees();
                format!("{seen}, but camera_angle_x says {angle:.1}; fl_x is taken")
            }),
            None => self
                .is_too_wide(own)
                .then(|| format!("{seen}; if it is in millimetres, no scale is right")),
        }
    }

    /// Refuses a focal length that cannot be in pixels, as the angle beside it tells.
    fn check_focal(&self, width: f64, fx: f64) -> Result<(), String> {
        let own = field_of_view(width, fx);
        let angle = self.camera_angle_x.filter(|_| self.fl_x.is_some());
        match angle.filter(|angle| self.is_too_wide(own) && is_another(own, *angle)) {
            Some(angle) => Err(format!(
                "fl_x {fx} px is a field of view of {:.1} degrees, but camera_angle_x says {:.1}: fl_x counts in pixels, and this looks like millimetres",
                own.to_degrees(),
                angle.to_degrees()
            )),
            None => Ok(()),
        }
    }

    /// Whether no such lens has this field of view, radians.
    fn is_too_wide(&self, field_of_view: f64) -> bool {
        self.is_fisheye() == Some(false) && field_of_view.to_degrees() > WIDEST
    }

    pub(super) fn camera(&self, name: String) -> Result<Camera, String> {
        let size = |value: Option<f64>, name: &str| {
            let count = value.unwrap_or(0.0);
            let is_size = count.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(&count);
            is_size
                .then_some(count as u32)
                .ok_or_else(|| format!("{name} is {count}, not a number of pixels"))
        };
        let (width, height) = (size(self.w, "w")?, size(self.h, "h")?);
        let (w, h) = (f64::from(width), f64::from(height));
        let of_angle = |side: f64, angle: f64| {
            let is_angle = angle > 0.0 && angle < PI;
            is_angle
                .then(|| side / 2.0 / (angle / 2.0).tan())
                .ok_or_else(|| format!("the field of view is {angle} radians"))
        };
        let fx = match (self.fl_x, self.camera_angle_x) {
            (Some(fx), _) => fx,
            (None, Some(angle)) => of_angle(w, angle)?,
            (None, None) => return Err("it has neither fl_x nor camera_angle_x".to_owned()),
        };
        self.check_focal(w, fx)?;
        let fy = match (self.fl_y, self.camera_angle_y) {
            (Some(fy), _) => fy,
            // Beside a focal length the angle is only for information.
            (None, Some(angle)) if self.fl_x.is_none() => of_angle(h, angle)?,
            (None, _) => fx,
        };
        let or_zero = |value: Option<f64>| value.unwrap_or(0.0);
        let [k1, k2, k3, k4] = [self.k1, self.k2, self.k3, self.k4].map(or_zero);
        let [p1, p2] = [self.p1, self.p2].map(or_zero);
        let distortion = if self.is_fisheye() == Some(true) {
            Distortion::Fisheye(Fisheye::new([k1, k2, k3, k4]))
        } else if [self.k1, self.k2, self.k3, self.p1, self.p2] == [None; 5] {
            Distortion::None
        } else {
            Distortion::Brown(Brown::new([k1, k2, p1, p2, k3, 0.0, 0.0, 0.0]))
        };
        let camera = Camera {
            name,
            width,
            height,
            fx,
            fy,
            cx: self.cx.unwrap_or(w / 2.0),
            cy: self.cy.unwrap_or(h / 2.0),
            skew: 0.0,
            distortion,
        };
        camera.validate().map_err(|e| e.to_string())?;
        Ok(camera)
    }
}
