//! distributions.csv: the size distributions that an image analysis of the photos would give if it
//! outlined every visible fragment rightly, beside the sieve's: one scale for the whole photo, from the
//! sphere in it, against a scale for each row, from the true corner points.
//!
//! What it is: of each photo as shot, every fragment that does not touch the photo's border, with all of
//! its visible pixels; its size is the diameter of the circle of as many pixels, and its mass goes with
//! the cube of that. The share of the fines, which no photo shows, is the true one.
//!
//! What it is not: Split-Desktop's result. Nothing is corrected for what other fragments hide, for the
//! shape (a sieve lets a fragment of larger diameter pass), for the fragments that lie deeper, or for
//! the tilt of the surface along the photo's columns; no outline is wrong.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::DVec3;

use super::scene::Sphere;
use crate::camera::{Camera, Pose};

/// What an outlined photo shows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outlined {
    /// The photo's file name.
    pub(super) photo: String,
    /// Of each fragment the mean row of its pixels (the middle of the first row is 0.5) and their count.
    pub(super) fragments: Vec<(f64, f64)>,
}

impl Outlined {
    /// The fragments of a label image (see `photo::Photo`), row by row from the top left.
    pub(super) fn new(photo: &str, labels: &[u16], width: u32, height: u32) -> Self {
        let (width, height) = (width as usize, height as usize);
        // Sum of the rows, count, whether it is whole.
        let mut found: BTreeMap<u16, (f64, f64, bool)> = BTreeMap::new();
        for (row, line) in labels.chunks(width.max(1)).enumerate() {
            for (column, &label) in line.iter().enumerate() {
                let inside = row > 0 && column > 0 && row + 1 < height && column + 1 < width;
                let (rows, count, whole) = found.entry(label).or_insert((0.0, 0.0, true));
                *rows += row as f64 + 0.5;
                *count += 1.0;
                *whole &= inside;
            }
        }
        let whole = found
            .into_iter()
            .filter(|&(label, (.., whole))| label != 0 && whole);
        Self {
            photo: photo.to_owned(),
            fragments: whole
                .map(|(_, (rows, count, _))| (rows / count, count))
                .collect(),
        }
    }

    /// The diameters of the fragments, in the unit that the scale is in pixels per.
    fn diameters(&self, scale: Scale) -> Vec<f64> {
        let diameter = |&(row, pixels): &(f64, f64)| {
            (4.0 * pixels / std::f64::consts::PI).sqrt() / scale.at(row)
        };
        self.fragments.iter().map(diameter).collect()
    }
}

/// The scale of a photo, pixels per unit, at its top and its bottom; between them it is linear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    pub(super) top: f64,
    pub(super) bottom: f64,
    /// The photo's height.
    pub(super) rows: f64,
}

impl Scale {
    fn at(self, row: f64) -> f64 {
        self.top + (self.bottom - self.top) * row / self.rows
    }

    /// The area that a photo of that width shows, in squares of the unit: the integral of 1 / scale
    /// squared over its pixels.
    fn area(self, width: f64) -> f64 {
        width * self.rows / (self.top * self.bottom)
    }
}

/// The scale that a sphere gives: the width of its image, as shot, over its diameter. `None` where it is
/// not all in the picture.
pub(super) fn sphere_scale(camera: &Camera, pose: &Pose, sphere: &Sphere) -> Option<f64> {
    let center = pose.camera_from_world(sphere.center);
    let direction = center.try_normalize()?;
    // Its outline is where lines of sight touch it.
    let sine = sphere.radius / center.length();
    let aside = direction.cross(DVec3::Y).try_normalize()?;
    let edge = |side: f64| {
        let sight = direction * (1.0 - sine * sine).sqrt() + aside * (side * sine);
        camera
            .pixel_as_shot(sight)
            .filter(|pixel| camera.contains(*pixel))
    };
    Some(edge(1.0)?.distance(edge(-1.0)?) / (2.0 * sphere.radius))
}

/// A photo's fragments with the scale of one method, pixels per metre.
#[derive(Debug, Clone, Copy)]
pub(super) struct Analysis<'a> {
    pub(super) method: &'a str,
    pub(super) photo: &'a Outlined,
    pub(super) scale: Scale,
}

/// The text of distributions.csv. `reference` are the sieve's openings in mm and the percent that
/// passes. The analyses are given at `openings` in mm, ascending, up to the first that all passes; they
/// lie above the fines, of which the share 0 to 1 is given.
pub(super) fn distributions_csv(
    reference: &[(f64, f64)],
    openings: &[f64],
    fines: f64,
    width: f64,
    analyses: &[Analysis<'_>],
) -> String {
    let mut text = String::from(
        "# Simulated: what an image analysis gives that outlines every visible fragment of a photo rightly,\n\
         # with the scale of each row (point cloud) or of the sphere in the photo (scale object).\n\
         # size: diameter of the circle of as many pixels; mass: its cube; the share of fines is the true\n\
         # one. area: what the photo shows, m2. Nothing corrects for hidden parts, shape or depth: it is\n\
         # no result of Split-Desktop. sieve: as in reference.csv. The diameters come out larger than a sieve's\n\
         # sizes, so a smaller scale error may lie farther from the sieve: compare the methods' sizes.\n\
         method,photo,size_mm,percent_passing,area\n",
    );
    for (size, percent) in reference {
        let _ = writeln!(text, "sieve,,{size},{percent},");
    }
    for analysis in analyses {
        let diameters = analysis.photo.diameters(analysis.scale);
        let total: f64 = diameters.iter().map(|d| d.powi(3)).sum();
        if total <= 0.0 {
            continue;
        }
        for size in openings {
            let passed = diameters.iter().filter(|d| **d * 1000.0 <= *size);
            let share = passed.map(|d| d.powi(3)).sum::<f64>() / total;
            let percent = 100.0 * (fines + (1.0 - fines) * share);
            let _ = writeln!(
                text,
                "{},{},{size},{percent:.4},{:.4}",
                analysis.method,
                analysis.photo.photo,
                analysis.scale.area(width)
            );
            if share >= 1.0 {
                break;
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 8 x 5 pixels: fragment 1 has 1 pixel, fragment 2 has 4, fragment 3 touches the border. Areas of
    /// 1 and 4 are diameters of 1 and 2 and masses of 1 and 8: a sieve in between passes 1 / 9.
    #[test]
    fn two_fragments_by_hand() {
        let labels = [
            [0, 0, 0, 0, 0, 0, 0, 3],
            [0, 1, 0, 2, 2, 0, 0, 3],
            [0, 0, 0, 2, 2, 0, 3, 3],
            [0, 0, 0, 0, 0, 0, 0, 0],
            [0, 0, 0, 0, 0, 0, 0, 0],
        ];
        let outlined = Outlined::new("a.jpg", &labels.concat(), 8, 5);
        assert_eq!(outlined.fragments, [(1.5, 1.0), (2.0, 4.0)]);
        // 1000 pixels per metre: a millimetre a pixel.
        let scale = Scale {
            top: 1000.0,
            bottom: 1000.0,
            rows: 5.0,
        };
        let diameters = outlined.diameters(scale);
        let one = (4.0 / std::f64::consts::PI).sqrt() / 1000.0;
        assert!((diameters[0] - one).abs() < 1e-15 && (diameters[1] - 2.0 * one).abs() < 1e-15);
        let analysis = Analysis {
            method: "point cloud",
            photo: &outlined,
            scale,
        };
        let reference = [
            (0.5, 5.0),
            (1.0, 10.0),
            (2.0, 55.0),
            (4.0, 99.0),
            (8.0, 100.0),
        ];
        let text = distributions_csv(&reference, &[1.0, 2.0, 4.0, 8.0], 0.1, 8.0, &[analysis]);
        let lines: Vec<&str> = text
            .lines()
            .filter(|line| line.starts_with("point"))
            .collect();
        // 0.1 + 0.9 / 9 is 0.2; 8 x 5 mm2 is 0.00004 m2.
        assert_eq!(
            lines,
            [
                "point cloud,a.jpg,1,10.0000,0.0000",
                "point cloud,a.jpg,2,20.0000,0.0000",
                "point cloud,a.jpg,4,100.0000,0.0000"
            ]
        );
        assert!(text.contains("\nsieve,,8,100,\n"), "{text}");
    }

    /// The integral of W / (a + (b - a) v / H)^2 over v from 0 to H is W H / (a b); here by 100 000 rows.
    #[test]
    fn the_area_is_the_sum_over_rows() {
        let scale = Scale {
            top: 900.0,
            bottom: 1300.0,
            rows: 700.0,
        };
        let step = 700.0 / 100_000.0;
        let rows = (0..100_000).map(|i| (f64::from(i) + 0.5) * step);
        let sum: f64 = rows.map(|row| 1200.0 * step / scale.at(row).powi(2)).sum();
        assert!((scale.area(1200.0) / sum - 1.0).abs() < 1e-9);
    }

    /// On the axis of a camera without distortion a sphere of radius R at distance c has a half width of
    /// f R / sqrt(c2 - R2).
    #[test]
    fn a_sphere_on_the_axis() {
        let camera = Camera {
            name: String::new(),
            width: 1000,
            height: 1000,
            fx: 1000.0,
            fy: 1000.0,
            cx: 500.0,
            cy: 500.0,
            skew: 0.0,
            distortion: crate::camera::Distortion::None,
        };
        let pose = Pose::from_tilt_pan(DVec3::ZERO, [90.0, 0.0]);
        let sphere = |x: f64| Sphere {
            center: DVec3::new(x, 0.0, -2.0),
            radius: 0.1,
        };
        let scale = sphere_scale(&camera, &pose, &sphere(0.0)).unwrap();
        let wanted = 1000.0 / (4.0_f64 - 0.01).sqrt();
        assert!((scale - wanted).abs() < 1e-9, "{scale} {wanted}");
        assert!(sphere_scale(&camera, &pose, &sphere(0.95)).is_none());
    }
}
