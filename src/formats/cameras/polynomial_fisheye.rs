//! The fish-eye that Pix4D and Bentley share, as far as it is OpenCV's (Pix4D's article 202559089;
//! Bentley's `FisheyeFocalMatrix` and `FisheyeDistortion`):
//!
//! ```text
//! theta = 2/pi arctan(sqrt(x2 + y2) / z)      rho = p0 + p1 theta + p2 theta2 + p3 theta3 + ...
//! (u, v) = [c d; e f] rho (x, y) / sqrt(x2 + y2) + (cx, cy)
//! ```
//!
//! OpenCV's has odd powers of the angle alone. Where the polynomial is such, the two are one; else
//! OpenCV's is fitted to it over the image, and the fit is taken where it is off by half a pixel at
//! most. How far it is off is for the reader to say.

use std::f64::consts::FRAC_2_PI;

use glam::{DMat2, DVec2};
use nalgebra::{DMatrix, DVector};

use crate::camera::{Camera, Distortion, Fisheye};

/// How far the fit may be off, in pixels.
const MOST_OFF_PX: f64 = 0.5;

/// In how many angles the two curves are compared.
const SAMPLES: usize = 400;

/// Turns the affine matrix `c d e f` and the polynomial `p0 p1 ...` into focal lengths, skew and
/// distortion; the rest is taken from `camera`. Also tells by how many pixels the lens is off, where
/// it had to be fitted.
///
/// # Errors
/// In words, what OpenCV's fish-eye cannot say.
pub(crate) fn with_lens(
    camera: Camera,
    affine: [f64; 4],
    polynomial: &[f64],
) -> Result<(Camera, Option<f64>), String> {
    let [c, d, e, f] = affine;
    let coefficient = |power: usize| polynomial.get(power).copied().unwrap_or(0.0);
    let p1 = coefficient(1);
    let finite = polynomial.iter().chain(&affine).all(|n| n.is_finite());
    if !finite || p1 <= 0.0 || c <= 0.0 || f <= 0.0 {
        return Err("its fish-eye calibration is impossible".to_owned());
    }
    if e != 0.0 {
        return Err(format!(
            "its fish-eye's affine matrix has {e} in the lower left, not 0"
        ));
    }
    let mut odd_ones = (0..polynomial.len()).filter(|power| power % 2 == 0 || *power > 9);
    let even = odd_ones.find(|power| coefficient(*power) != 0.0);
    let (odd, off) = match even {
        None => ([1, 3, 5, 7, 9].map(coefficient), None),
        Some(power) => {
            let (odd, off) = fitted(&camera, affine, polynomial)
                .filter(|(_, off)| *off <= MOST_OFF_PX)
                .ok_or_else(|| {
                    let value = coefficient(power);
                    format!(
                        "its fish-eye polynomial has p{power} = {value}, and no polynomial of odd \
                         powers comes within {MOST_OFF_PX} px of it"
                    )
                })?;
            (odd, Some(off))
        }
    };
    let [unit, k1, k2, k3, k4] = in_radians(odd);
    let camera = Camera {
        fx: c * unit,
        fy: f * unit,
        // x is sheared by the y that fy stretches.
        skew: d * unit,
        distortion: Distortion::Fisheye(Fisheye::new([k1, k2, k3, k4].map(|k| k / unit))),
        ..camera
    };
    Ok((camera, off))
}

/// The coefficients of odd powers of theta as those of powers of the angle in radians.
fn in_radians(odd: [f64; 5]) -> [f64; 5] {
    let mut scale = FRAC_2_PI;
    odd.map(|coefficient| {
        let scaled = coefficient * scale;
        scale *= FRAC_2_PI * FRAC_2_PI;
        scaled
    })
}

/// The odd polynomial nearest to the given one over the image, and by how many pixels it is off at
/// most. `None` where the image's size is not known, or the lens does not reach its corners.
fn fitted(camera: &Camera, [c, d, _, f]: [f64; 4], polynomial: &[f64]) -> Option<([f64; 5], f64)> {
    let size = DVec2::new(f64::from(camera.width), f64::from(camera.height));
    if size.min_element() <= 0.0 {
        return None;
    }
    let plane_from_pixel = DMat2::from_cols(DVec2::new(c, 0.0), DVec2::new(d, f)).inverse();
    let center = DVec2::new(camera.cx, camera.cy);
    let reach = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE]
        .map(|corner| (plane_from_pixel * (corner * size - center)).length())
        .into_iter()
        .fold(0.0, f64::max);
    let rho = |theta: f64| polynomial.iter().rev().fold(0.0, |sum, p| sum * theta + p);
    // theta is 2 straight behind the camera.
    let largest = (1..=2000)
        .map(|step| f64::from(step) / 1000.0)
        .find(|&theta| rho(theta) >= reach)?;
    #[expect(clippy::cast_precision_loss, reason = "a few hundred")]
    let angle = |row: usize| (row + 1) as f64 / SAMPLES as f64;
    let powers = [1, 3, 5, 7, 9];
    let matrix = DMatrix::from_fn(SAMPLES, 5, |row, column| angle(row).powi(powers[column]));
    let wanted = DVector::from_fn(SAMPLES, |row, _| rho(angle(row) * largest));
    let solved = matrix.clone().svd(true, true).solve(&wanted, 1e-12).ok()?;
    let off = (&matrix * &solved - &wanted).amax() * c.max(f);
    let mut odd = [0.0; 5];
    for ((place, value), power) in odd.iter_mut().zip(solved.iter()).zip(powers) {
        *place = value / largest.powi(power);
    }
    (off.is_finite() && odd[0] > 0.0).then_some((odd, off))
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
        let (lens, off) = with_lens(camera(), affine, &polynomial).unwrap();
        assert_eq!(off, None);
        let point = DVec3::new(0.3, -0.7, 1.1);
        let radius = point.truncate().length();
        let theta = FRAC_2_PI * (radius / point.z).atan();
        let rho = theta - 0.161_096 * theta.powi(3);
        let (x, y) = (rho * point.x / radius, rho * point.y / radius);
        let expected = glam::DVec2::new(1674.33 * x + 2.5 * y + 640.0, 1670.0 * y + 480.0);
        let found = lens.pixel_as_shot(point).unwrap();
        assert!((found - expected).length() < 1e-9, "{found} {expected}");
    }

    /// The example of Pix4D's OPF specification: a Parrot Sequoia.
    #[test]
    fn even_powers_are_fitted_and_the_error_is_told() {
        let polynomial = [0.0, 1.0, 0.015_264_6, -0.161_096];
        let affine = [1_676.296_432, 0.0, 0.0, 1_676.296_432];
        let (lens, off) = with_lens(camera(), affine, &polynomial).unwrap();
        let off = off.unwrap();
        assert!(off > 0.0 && off < 0.2, "{off}");
        let mut worst: f64 = 0.0;
        for step in 0..100 {
            // Out to the corner, 800 px from the middle.
            let point = DVec3::new(0.8, 0.6, 0.0) * f64::from(step) * 0.01 + DVec3::Z;
            let radius = point.truncate().length().max(1e-12);
            let theta = FRAC_2_PI * radius.atan();
            let rho = theta + 0.015_264_6 * theta.powi(2) - 0.161_096 * theta.powi(3);
            let expected =
                point.truncate() / radius * rho * affine[0] + glam::DVec2::new(640.0, 480.0);
            if expected.x > 1280.0 || expected.y > 960.0 {
                break;
            }
            worst = worst.max((lens.pixel_as_shot(point).unwrap() - expected).length());
        }
        assert!(worst > 0.5 * off && worst < 1.01 * off, "{worst} {off}");
    }

    #[test]
    fn what_opencv_cannot_say_is_refused() {
        let refused =
            |affine, polynomial: &[f64]| with_lens(camera(), affine, polynomial).unwrap_err();
        let plain = [1000.0, 0.0, 0.0, 1000.0];
        assert!(refused(plain, &[0.01, 1.0]).contains("p0 = 0.01"));
        assert!(refused(plain, &[0.0, 1.0, 0.9]).contains("p2 = 0.9"));
        assert!(refused([1000.0, 0.0, 1.0, 1000.0], &[0.0, 1.0]).contains("lower left"));
        assert!(refused(plain, &[]).contains("impossible"));
        assert!(refused(plain, &[0.0, f64::NAN]).contains("impossible"));
        // It does not reach the corners.
        assert!(refused(plain, &[0.0, 1.0, -1.0]).contains("p2 = -1"));
        let mut unsized_camera = camera();
        unsized_camera.width = 0;
        assert!(with_lens(unsized_camera, plain, &[0.0, 1.0, 0.01]).is_err());
    }
}
