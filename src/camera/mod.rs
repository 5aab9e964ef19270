//! Cameras: intrinsics, distortion, poses; pixel -> ray, point -> pixel.

mod agisoft;
mod branch;
mod brown;
mod distortion;
mod fisheye;
mod growing;
mod not_invertible;
mod polynomial;
mod pose;
mod strange;
mod visualsfm;

use glam::{DVec2, DVec3};

pub use agisoft::{Agisoft, AgisoftProjection};
pub use brown::Brown;
pub use distortion::Distortion;
pub use fisheye::Fisheye;
pub use not_invertible::NotInvertible;
pub use pose::{HALF_TURN_ABOUT_X, NotRotation, Pose};
pub use visualsfm::VisualSfm;

/// How far, in pixels, an inverse of the distortion may be off when mapped forward again.
const INVERSE_TOLERANCE_PX: f64 = 1e-9;

/// Intrinsics and distortion of one device, for one image size. Pixels are continuous, (0, 0) at
/// the outer corner of the top-left pixel.
///
/// ```text
/// u = fx x + skew y + cx        v = fy y + cy
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    /// The name that poses call it by; may be empty where there is only one.
    pub name: String,
    /// Image width in pixels.
    pub width: u32,
    /// Image height in pixels.
    pub height: u32,
    /// Focal length in pixel widths.
    pub fx: f64,
    /// Focal length in pixel heights.
    pub fy: f64,
    /// Principal point, pixels from the left edge.
    pub cx: f64,
    /// Principal point, pixels from the top edge.
    pub cy: f64,
    /// In pixels.
    pub skew: f64,
    /// The lens.
    pub distortion: Distortion,
}

/// Intrinsics that no camera has.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// A number is NaN or infinite.
    #[error("{0} is {1}, not a finite number")]
    NotFinite(&'static str, f64),
    /// fx or fy is not positive.
    #[error("the focal length {0} is {1} px; it must be positive")]
    FocalLength(&'static str, f64),
    /// No pixels.
    #[error("the image size is {0} x {1}; both must be positive")]
    Size(u32, u32),
    /// The photo files have another aspect ratio.
    #[error(
        "the photo is {photo_width} x {photo_height}, its camera is for {width} x {height}: another shape"
    )]
    Shape {
        /// Width of the photo file.
        photo_width: u32,
        /// Height of the photo file.
        photo_height: u32,
        /// Width of the camera.
        width: u32,
        /// Height of the camera.
        height: u32,
    },
}

impl Camera {
    /// Checks that the numbers are those of a camera.
    ///
    /// # Errors
    /// The first one that is not.
    pub fn validate(&self) -> Result<(), CameraError> {
        if self.width == 0 || self.height == 0 {
            return Err(CameraError::Size(self.width, self.height));
        }
        for (name, value) in [
            ("fx", self.fx),
            ("fy", self.fy),
            ("cx", self.cx),
            ("cy", self.cy),
            ("the skew", self.skew),
        ] {
            if !value.is_finite() {
                return Err(CameraError::NotFinite(name, value));
            }
        }
        for value in self.distortion.coefficients() {
            if !value.is_finite() {
                return Err(CameraError::NotFinite("a distortion coefficient", value));
            }
        }
        for (name, value) in [("fx", self.fx), ("fy", self.fy)] {
            if value <= 0.0 {
                return Err(CameraError::FocalLength(name, value));
            }
        }
        Ok(())
    }

    /// The same camera for photos of another size of the same shape.
    ///
    /// Packages often solve on reduced photos, whose sides were rounded to whole pixels: the shapes
    /// are the same where the aspect ratios agree within one pixel of the smaller image.
    ///
    /// # Errors
    /// Where the shape is another one.
    pub fn rescaled(&self, width: u32, height: u32) -> Result<Self, CameraError> {
        let (w, h) = (f64::from(self.width), f64::from(self.height));
        let (x, y) = (f64::from(width) / w, f64::from(height) / h);
        // How far the other height is from the one that the width implies, in both images' pixels.
        let off = (h * x - f64::from(height)).abs();
        if off.min(off / x) > 1.0 {
            return Err(CameraError::Shape {
                photo_width: width,
                photo_height: height,
                width: self.width,
                height: self.height,
            });
        }
        Ok(Self {
            name: self.name.clone(),
            width,
            height,
            fx: self.fx * x,
            fy: self.fy * y,
            cx: self.cx * x,
            cy: self.cy * y,
            skew: self.skew * x,
            distortion: self.distortion,
        })
    }

    /// The direction (camera axes, z = 1) of a pixel of the undistorted image: K^-1 (u, v, 1).
    pub fn direction_undistorted(&self, pixel: DVec2) -> DVec3 {
        self.plane_from_pixel(pixel).extend(1.0)
    }

    /// The direction (camera axes, not normalised) of a pixel of the photo as shot. Projecting it
    /// again is off by at most 1e-9 px.
    ///
    /// # Errors
    /// Where the distortion has no inverse at that pixel.
    pub fn direction_as_shot(&self, pixel: DVec2) -> Result<DVec3, NotInvertible> {
        let tolerance = INVERSE_TOLERANCE_PX / (self.fx + self.skew.abs()).max(self.fy);
        self.distortion
            .direction_from_distorted(self.plane_from_pixel(pixel), tolerance)
    }

    /// The pixel of a point in camera axes in the undistorted image (also outside its edges), or
    /// `None` where the point is not in front of the camera.
    pub fn pixel_undistorted(&self, point: DVec3) -> Option<DVec2> {
        (point.z > 0.0).then(|| self.pixel_from_plane(point.truncate() / point.z))
    }

    /// The pixel of a point in camera axes in the photo as shot (also outside its edges), or `None`
    /// where the lens does not see it.
    pub fn pixel_as_shot(&self, point: DVec3) -> Option<DVec2> {
        self.distortion
            .distorted_from_direction(point)
            .map(|plane| self.pixel_from_plane(plane))
    }

    /// How much larger a small area is in the photo as shot than in the undistorted image: |det J|, J the
    /// derivative of distorted by undistorted pixel at a direction in camera axes. `None` where the lens
    /// does not see it, or where the lens folds back.
    ///
    /// By central differences of the fourth order; good to about 1e-10.
    pub fn lens_area(&self, direction: DVec3) -> Option<f64> {
        if self.distortion == Distortion::None {
            return (direction.z > 0.0).then_some(1.0);
        }
        let ideal = (direction.z > 0.0).then(|| direction.truncate() / direction.z)?;
        let step = 1e-3 * ideal.length().max(1e-1);
        // K takes both images' planes to pixels, so it has no part in the determinant.
        let at = |offset: DVec2| {
            let direction = (ideal + offset).extend(1.0);
            self.distortion.distorted_from_direction(direction)
        };
        let along = |axis: DVec2| {
            let far = at(axis * (2.0 * step))? - at(axis * (-2.0 * step))?;
            let near = at(axis * step)? - at(axis * -step)?;
            Some((near * 8.0 - far) / (12.0 * step))
        };
        let area = along(DVec2::X)?.perp_dot(along(DVec2::Y)?).abs();
        (area > 0.0 && area.is_finite()).then_some(area)
    }

    /// Whether a pixel lies within the image, edges included.
    pub fn contains(&self, pixel: DVec2) -> bool {
        (0.0..=f64::from(self.width)).contains(&pixel.x)
            && (0.0..=f64::from(self.height)).contains(&pixel.y)
    }

    fn plane_from_pixel(&self, pixel: DVec2) -> DVec2 {
        let y = (pixel.y - self.cy) / self.fy;
        DVec2::new((pixel.x - self.cx - self.skew * y) / self.fx, y)
    }

    fn pixel_from_plane(&self, plane: DVec2) -> DVec2 {
        DVec2::new(
            self.fx * plane.x + self.skew * plane.y + self.cx,
            self.fy * plane.y + self.cy,
        )
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn camera(distortion: Distortion) -> Camera {
        Camera {
            name: String::new(),
            width: 1280,
            height: 720,
            fx: 1000.0,
            fy: 990.0,
            cx: 645.5,
            cy: 350.25,
            skew: 3.0,
            distortion,
        }
    }

    #[test]
    fn pixel_of_a_known_point() {
        let camera = camera(Distortion::None);
        let pixel = camera
            .pixel_undistorted(DVec3::new(0.2, -0.1, 2.0))
            .unwrap();
        assert!((pixel - DVec2::new(645.5 + 100.0 - 0.15, 350.25 - 49.5)).length() < 1e-12);
        assert_eq!(camera.pixel_undistorted(DVec3::new(0.2, -0.1, 0.0)), None);
    }

    #[test]
    fn rescaling_keeps_the_directions() {
        let small = camera(Distortion::None);
        let large = small.rescaled(5120, 2880).unwrap();
        assert_eq!((large.fx, large.cy, large.skew), (4000.0, 1401.0, 12.0));
        let corner = DVec2::new(1280.0, 720.0);
        assert_eq!(
            small.direction_undistorted(corner),
            large.direction_undistorted(corner * 4.0)
        );
        // 1281 x 721 rounds the same shape, 4:3 is another one.
        assert!(small.rescaled(427, 240).is_ok());
        assert!(small.rescaled(4000, 3000).is_err());
        assert!(small.rescaled(720, 1280).is_err());
    }

    #[test]
    fn impossible_intrinsics_are_refused() {
        let good = camera(Distortion::None);
        assert_eq!(good.validate(), Ok(()));
        let zero = Camera {
            fx: 0.0,
            ..good.clone()
        };
        assert_eq!(zero.validate(), Err(CameraError::FocalLength("fx", 0.0)));
        assert!(
            Camera {
                cy: f64::NAN,
                ..good.clone()
            }
            .validate()
            .is_err()
        );
        assert!(
            Camera {
                width: 0,
                ..good.clone()
            }
            .validate()
            .is_err()
        );
        let lens = Distortion::VisualSfm(VisualSfm { k: f64::INFINITY });
        assert!(
            Camera {
                distortion: lens,
                ..good
            }
            .validate()
            .is_err()
        );
    }

    /// Lenses from gentle to folding inside the image.
    fn lens() -> impl Strategy<Value = Distortion> {
        let small = || -0.05..0.05_f64;
        let brown = (
            -0.4..0.4_f64,
            -0.2..0.2_f64,
            small(),
            small(),
            small(),
            small(),
            small(),
            small(),
        )
            .prop_map(|(k1, k2, p1, p2, k3, k4, k5, k6)| {
                Distortion::Brown(Brown::new([k1, k2, p1 * 0.1, p2 * 0.1, k3, k4, k5, k6]))
            });
        let fisheye = (-0.3..0.3_f64, small(), small(), small())
            .prop_map(|(a, b, c, d)| Distortion::Fisheye(Fisheye::new([a, b, c, d])));
        let visualsfm = (-0.4..0.4_f64).prop_map(|k| Distortion::VisualSfm(VisualSfm { k }));
        let projection = prop_oneof![
            Just(AgisoftProjection::Frame),
            Just(AgisoftProjection::EquidistantFisheye),
            Just(AgisoftProjection::EquisolidFisheye),
        ];
        let numbers = || [-0.3..0.3_f64, small(), small(), small()];
        let agisoft =
            (projection, numbers(), numbers()).prop_map(|(projection, k, [p, q, r, s])| {
                let p = [p * 0.01, q * 0.1, r * 10.0, s * 10.0];
                Distortion::Agisoft(Agisoft::new(projection, k, p))
            });
        prop_oneof![Just(Distortion::None), brown, fisheye, visualsfm, agisoft]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// 1e-9 px is the contract's bound on the inverse; a pixel without an inverse says so.
        #[test]
        fn pixel_to_ray_to_pixel(lens in lens(), u in -200.0..1500.0_f64, v in -200.0..900.0_f64) {
            let camera = camera(lens);
            let pixel = DVec2::new(u, v);
            if let Ok(direction) = camera.direction_as_shot(pixel) {
                let back = camera.pixel_as_shot(direction).unwrap();
                prop_assert!((back - pixel).length() <= 1.01e-9, "{pixel} came back as {back}");
            }
        }

        /// What the lens sees, it sees at a pixel whose ray leads back. Close to the fold one pixel
        /// spans many directions, so the comparison is made in pixels.
        #[test]
        fn point_to_pixel_to_ray(lens in lens(), x in -1.5..1.5_f64, y in -1.5..1.5_f64) {
            let camera = camera(lens);
            let point = DVec3::new(x, y, 1.0) * 7.0;
            if let Some(pixel) = camera.pixel_as_shot(point)
                && let Ok(direction) = camera.direction_as_shot(pixel)
            {
                let again = camera.pixel_as_shot(direction).unwrap();
                prop_assert!((again - pixel).length() <= 1.01e-9);
                let gap = direction.normalize().angle_between(point.normalize());
                let step = camera.pixel_as_shot(direction + point * 1e-9);
                let steep = step.is_none_or(|s| (s - again).length() < 1e-10);
                // Tangential terms as large as these may fold the image twice on the way outward: what lies behind both
                // is at a pixel that the middle's branch has, too.
                let toward = |share: u32| DVec3::new(x, y, 0.0) * f64::from(share) / 64.0 + DVec3::Z;
                let folded = (1..64).any(|share| camera.pixel_as_shot(toward(share)).is_none());
                prop_assert!(gap < 1e-6 || steep || folded, "{gap} rad between {point} and {direction}");
            }
        }

        #[test]
        fn undistorted_there_and_back(u in -1e4..1e4_f64, v in -1e4..1e4_f64) {
            let camera = camera(Distortion::None);
            let pixel = DVec2::new(u, v);
            let back = camera.pixel_undistorted(camera.direction_undistorted(pixel) * 5.0);
            prop_assert!((back.unwrap() - pixel).length() < 1e-10);
        }
    }
}
