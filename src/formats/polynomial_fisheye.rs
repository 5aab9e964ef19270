//! The fish-eye that Pix4D and Bentley share, as far as it is OpenCV's (Pix4D's article 202559089;
//! Bentley's `FisheyeFocalMatrix` and `FisheyeDistortion`):
//!
//! ```text
//! theta = 2/pi arctan(sqrt(x2 + y2) / z)      rho = p0 + p1 theta + p2 theta2 + p3 theta3 + ...
//! (u, v) = [c d; e f] rho (x, y) / sqrt(x2 + y2) + (cx, cy)
//! ```
//!
//! OpenCV's has odd powers alone: where an even coefficient is not 0, the curves differ, and such a
//! lens is refused rather than bent.

use std::f64::consts::FRAC_2_PI;

use crate::camera::{Camera, Distortion, Fisheye};

/// Turns the affine matrix `c d e f` and the polynomial `p0 p1 ...` into focal lengths, skew and
/// distortion; the rest is taken from `camera`.
///
/// # Errors
/// In words, what OpenCV's fish-eye cannot say.
pub(super) fn with_lens(
    camera: Camera,
    [c, d, e, f]: [f64; 4],
    polynomial: &[f64],
) -> Result<Camera, String> {
    let coefficient = |power: usize| polynomial.get(power).copied().unwrap_or(0.0);
    let p1 = coefficient(1);
    let finite = polynomial
        .iter()
        .chain(&[c, d, e, f])
        .all(|n| n.is_finite());
    if !finite || p1 <= 0.0 || c <= 0.0 || f <= 0.0 {
        return Err("its fish-eye calibration is impossible".to_owned());
    }
    if e != 0.0 {
        return Err(format!(
            "its fish-eye's affine matrix has {e} in the lower left, not 0"
        ));
    }
    for power in (0..polynomial.len()).filter(|power| power % 2 == 0 || *power > 9) {
        if coefficient(power) != 0.0 {
            return Err(format!(
                "its fish-eye polynomial has p{power} = {}, and only odd powers up to 9 can be read",
                coefficient(power)
            ));
        }
    }
    let unit = FRAC_2_PI * p1;
    let k = [3, 5, 7, 9].map(|power: u8| {
        coefficient(usize::from(power)) / p1 * FRAC_2_PI.powi(i32::from(power) - 1)
    });
    Ok(Camera {
        fx: c * unit,
        fy: f * unit,
        // x is sheared by the y that fy stretches.
        skew: d * unit,
        distortion: Distortion::Fisheye(Fisheye::new(k)),
        ..camera
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn camera() -> Camera {
        Camera {
            name: String::new(),
            width: 1280,
            height: 960,
            fx: 1.0,
            fy: 1.0,
            cx: 640.0,
            cy: 480.0,
            skew: 0.0,
            distortion: Distortion::None,
        }
    }

    #[test]
    fn projects_as_the_article_says() {
        let affine = [1674.33, 2.5, 0.0, 1670.0];
        let polynomial = [0.0, 1.0, 0.0, -0.161_096];
        let lens = with_lens(camera(), affine, &polynomial).unwrap();
        let point = DVec3::new(0.3, -0.7, 1.1);
        let radius = point.truncate().length();
        let theta = FRAC_2_PI * (radius / point.z).atan();
        let rho = theta - 0.161_096 * theta.powi(3);
        let (x, y) = (rho * point.x / radius, rho * point.y / radius);
        let expected = glam::DVec2::new(1674.33 * x + 2.5 * y + 640.0, 1670.0 * y + 480.0);
        let found = lens.pixel_as_shot(point).unwrap();
        assert!((found - expected).length() < 1e-9, "{found} {expected}");
    }

    #[test]
    fn what_opencv_cannot_say_is_refused() {
        let refused =
            |affine, polynomial: &[f64]| with_lens(camera(), affine, polynomial).unwrap_err();
        let plain = [1000.0, 0.0, 0.0, 1000.0];
        // The example of Pix4D's OPF specification.
        assert!(refused(plain, &[0.0, 1.0, 0.0152646, -0.161096]).contains("p2 = 0.0152646"));
        assert!(refused([1000.0, 0.0, 1.0, 1000.0], &[0.0, 1.0]).contains("lower left"));
        assert!(refused(plain, &[]).contains("impossible"));
        assert!(refused(plain, &[0.0, f64::NAN]).contains("impossible"));
    }
}
