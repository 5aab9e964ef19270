//! distributions.csv: the size distributions that an image analysis of the photos would give if it
//! outlined every visible fragment rightly, beside the sieve's: one scale for the whole photo, from the
//! sphere in it, against a scale for each row, from the true corner points.
//!
//! What it is: of each undistorted photo, every fragment that does not touch the border, with all of its
//! visible pixels. Its sieve size is the diameter of the circle of as many pixels times a shape factor,
//! that of the bodies' own shadows: by Cauchy's formula the mean shadow of a convex body is a quarter of
//! its surface. Shares of the visible area are taken for shares of the volume (Delesse 1847), as they are
//! on a cut through rock. The share of the fines, which no photo shows, is the true one. Neither factor
//! knows a scale, so what differs between the two methods is their scales alone.
//!
//! What it is not: Split-Desktop's result. Nothing is corrected for what other fragments hide, for the
//! way fragments come to rest, or for the tilt of the surface along the photo's columns; no outline is
//! wrong.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::Write as _;

use glam::DVec2;
use rayon::prelude::*;

use super::scene::Sphere;
use super::scene::fragment::Body;
use crate::camera::{Camera, Pose};

/// Where the pixels of a photo as shot lie in the undistorted one, row by row from the top left.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PixelPlaces {
    width: usize,
    height: usize,
    /// The row of its middle and its area there, pixels; not a number where no line of sight is known.
    places: Vec<(f64, f64)>,
}

impl PixelPlaces {
    pub(super) fn new(camera: &Camera) -> Self {
        let (width, height) = (camera.width as usize, camera.height as usize);
        let row_of_corners = |row: usize| -> Vec<DVec2> {
            let corner = |column: usize| {
                let direction = camera
                    .direction_as_shot(DVec2::new(column as f64, row as f64))
                    .ok()?;
                camera.pixel_undistorted(direction)
            };
            (0..=width)
                .map(|column| corner(column).unwrap_or(DVec2::NAN))
                .collect()
        };
        let corners: Vec<Vec<DVec2>> = (0..=height).into_par_iter().map(row_of_corners).collect();
        let mut places = Vec::with_capacity(width * height);
        for (above, below) in corners.iter().zip(corners.iter().skip(1)) {
            for (left, right) in above.iter().zip(below).zip(above.iter().zip(below).skip(1)) {
                let ((a, d), (b, c)) = (left, right);
                // Half the cross product of the diagonals.
                let area = 0.5 * (c - a).perp_dot(d - b).abs();
                places.push((0.25 * (a.y + b.y + c.y + d.y), area));
            }
        }
        Self {
            width,
            height,
            places,
        }
    }
}

/// Sieve size over the diameter of the circle as large as the mean shadow, over these bodies (of sieve
/// size 1). The mean shadow of a convex body is a quarter of its surface, so that diameter is
/// sqrt(surface / pi).
pub(super) fn shape_factor(bodies: &[Body]) -> f64 {
    let factors = bodies.iter().map(|body| 1.0 / (body.surface() / PI).sqrt());
    factors.sum::<f64>() / bodies.len().max(1) as f64
}

/// What an outlined photo shows.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outlined {
    /// The photo's file name.
    pub(super) photo: String,
    /// Of each fragment the mean row of its pixels and their area, both in the undistorted photo.
    pub(super) fragments: Vec<(f64, f64)>,
}

impl Outlined {
    /// The fragments of a label image (see `photo::Photo`), row by row from the top left.
    pub(super) fn new(photo: &str, labels: &[u16], pixels: &PixelPlaces) -> Self {
        // Sum of the rows times areas, of the areas, whether it is whole.
        let mut found: BTreeMap<u16, (f64, f64, bool)> = BTreeMap::new();
        for (index, (&label, (row_there, area))) in labels.iter().zip(&pixels.places).enumerate() {
            let (row, column) = (index / pixels.width, index % pixels.width);
            let inside = row > 0
                && column > 0
                && row + 1 < pixels.height
                && column + 1 < pixels.width
                && area.is_finite();
            let (rows, sum, whole) = found.entry(label).or_insert((0.0, 0.0, true));
            *rows += row_there * area;
            *sum += area;
            *whole &= inside;
        }
        let whole = found
            .into_iter()
            .filter(|&(label, (.., whole))| label != 0 && whole);
        Self {
            photo: photo.to_owned(),
            fragments: whole
                .map(|(_, (rows, area, _))| (rows / area, area))
                .collect(),
        }
    }

    /// The circle's diameter and the area of each fragment, in the unit that the scale is in pixels per
    /// and its square.
    fn measured(&self, scale: Scale) -> Vec<(f64, f64)> {
        let measure = |&(row, pixels): &(f64, f64)| {
            let area = pixels / scale.at(row).powi(2);
            ((4.0 * area / PI).sqrt(), area)
        };
        self.fragments.iter().map(measure).collect()
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

/// The scale that a sphere gives, as the scale-object method has it without its mistakes: of the plane
/// through its centre parallel to the image, the focal length over the centre's depth. `None` where the
/// photo does not show all of it.
pub(super) fn sphere_scale(camera: &Camera, pose: &Pose, sphere: &Sphere) -> Option<f64> {
    let center = pose.camera_from_world(sphere.center);
    let direction = center.try_normalize()?;
    let (right, up) = direction.any_orthonormal_pair();
    // Its outline is where lines of sight touch it.
    let sine = sphere.radius / center.length();
    let on_outline = |step: u32| {
        let aside = DVec2::from_angle(f64::from(step) * PI / 16.0);
        let aside = right * aside.x + up * aside.y;
        camera.pixel_as_shot(direction * (1.0 - sine * sine).sqrt() + aside * sine)
    };
    let shown = |pixel: Option<DVec2>| pixel.is_some_and(|pixel| camera.contains(pixel));
    let whole = (0..32).map(on_outline).all(shown);
    (whole && center.z > 0.0).then(|| camera.fx / center.z)
}

/// A photo's fragments with the scale of one method, pixels per metre.
#[derive(Debug, Clone, Copy)]
pub(super) struct Analysis<'a> {
    pub(super) method: &'a str,
    /// The row of the flight that the photo is of.
    pub(super) trial: u32,
    pub(super) photo: &'a Outlined,
    pub(super) scale: Scale,
}

/// What all analyses share.
#[derive(Debug, Clone, Copy)]
pub(super) struct Material<'a> {
    /// The sieve's openings in mm and the percent that passes.
    pub(super) reference: &'a [(f64, f64)],
    /// Openings in mm, ascending, above the fines: the analyses are given at them up to the first that
    /// all passes.
    pub(super) openings: &'a [f64],
    /// The share of the fines, 0 to 1.
    pub(super) fines: f64,
    /// See [`shape_factor`].
    pub(super) shape_factor: f64,
    /// The photos' width.
    pub(super) width: f64,
}

/// The text of distributions.csv.
pub(super) fn distributions_csv(material: &Material<'_>, analyses: &[Analysis<'_>]) -> String {
    let mut text = format!(
        "# Simulated: what an image analysis gives that outlines every visible fragment of a photo rightly,\n\
         # with the scale of each row (point cloud) or of the sphere in the photo (scale object). It is no\n\
         # result of Split-Desktop. size: {:.3} times the diameter of the circle of as many pixels, as the\n\
         # bodies' mean shadows have it; share: of the visible area; the share of fines is the true one;\n\
         # nothing corrects for hidden parts. trial: row of the flight; area: what the photo shows, m2.\n\
         # sieve: as in reference.csv.\n\
         method,trial,photo,size_mm,percent_passing,area\n",
        material.shape_factor
    );
    for (size, percent) in material.reference {
        let _ = writeln!(text, "sieve,,,{size},{percent},");
    }
    for analysis in analyses {
        let fragments = analysis.photo.measured(analysis.scale);
        let total: f64 = fragments.iter().map(|(_, area)| area).sum();
        if total <= 0.0 {
            continue;
        }
        for opening in material.openings {
            let passes =
                |(diameter, _): &&(f64, f64)| diameter * material.shape_factor * 1000.0 <= *opening;
            let passed = fragments.iter().filter(passes);
            let share = passed.map(|(_, area)| area).sum::<f64>() / total;
            let percent = 100.0 * (material.fines + (1.0 - material.fines) * share);
            let _ = writeln!(
                text,
                "{},{},{},{opening},{percent:.4},{:.4}",
                analysis.method,
                analysis.trial,
                analysis.photo.photo,
                analysis.scale.area(material.width)
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
    use crate::camera::{Brown, Distortion};
    use glam::DVec3;

    fn camera(width: u32, height: u32, distortion: Distortion) -> Camera {
        Camera {
            name: String::new(),
            width,
            height,
            fx: f64::from(width),
            fy: f64::from(width),
            cx: f64::from(width) / 2.0,
            cy: f64::from(height) / 2.0,
            skew: 0.0,
            distortion,
        }
    }

    /// Of 8 x 5 pixels: fragment 1 has 1 pixel, fragment 2 has 4, fragment 3 touches the border. Areas of
    /// 1 and 4 are diameters of 1 and 2: a sieve in between passes 1 / 5.
    #[test]
    fn two_fragments_by_hand() {
        let labels = [
            [0, 0, 0, 0, 0, 0, 0, 3],
            [0, 1, 0, 2, 2, 0, 0, 3],
            [0, 0, 0, 2, 2, 0, 3, 3],
            [0, 0, 0, 0, 0, 0, 0, 0],
            [0, 0, 0, 0, 0, 0, 0, 0],
        ];
        let pixels = PixelPlaces::new(&camera(8, 5, Distortion::None));
        let outlined = Outlined::new("a.jpg", &labels.concat(), &pixels);
        let wanted = [(1.5, 1.0), (2.0, 4.0)];
        for (found, wanted) in outlined.fragments.iter().zip(wanted) {
            assert!((found.0 - wanted.0).abs() < 1e-12 && (found.1 - wanted.1).abs() < 1e-12);
        }
        assert_eq!(outlined.fragments.len(), 2);
        // 1000 pixels per metre: a millimetre a pixel.
        let scale = Scale {
            top: 1000.0,
            bottom: 1000.0,
            rows: 5.0,
        };
        let analysis = Analysis {
            method: "point cloud",
            trial: 2,
            photo: &outlined,
            scale,
        };
        // Circles of 1.128 and 2.257 mm, of sieve sizes 0.903 and 1.805 mm.
        let material = Material {
            reference: &[(0.5, 5.0), (8.0, 100.0)],
            openings: &[0.9, 1.0, 1.8, 1.81, 4.0],
            fines: 0.1,
            shape_factor: 0.8,
            width: 8.0,
        };
        let text = distributions_csv(&material, &[analysis]);
        let lines: Vec<&str> = text
            .lines()
            .filter(|line| line.starts_with("point"))
            .collect();
        // 0.1 + 0.9 / 5 is 0.28; 8 x 5 mm2 is 0.00004 m2.
        assert_eq!(
            lines,
            [
                "point cloud,2,a.jpg,0.9,10.0000,0.0000",
                "point cloud,2,a.jpg,1,28.0000,0.0000",
                "point cloud,2,a.jpg,1.8,28.0000,0.0000",
                "point cloud,2,a.jpg,1.81,100.0000,0.0000",
            ]
        );
        assert!(text.contains("\nsieve,,,8,100,\n"), "{text}");
    }

    /// With r' = r (1 + k r2), in focal lengths, the area at the middle stays and at r it is
    /// 1 / ((1 + k r2) (1 + 3 k r2)) of the distorted one.
    #[test]
    fn areas_are_of_the_undistorted_photo() {
        let k = -0.1;
        let lens = Brown::new([k, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let pixels = PixelPlaces::new(&camera(1000, 1000, Distortion::Brown(lens)));
        let at = |row: usize, column: usize| pixels.places[row * 1000 + column];
        assert!((at(500, 500).1 - 1.0).abs() < 1e-5);
        // The pixel whose middle is 0.3995 focal lengths to the right of the axis.
        let distorted = 0.3995;
        let mut ideal: f64 = distorted;
        for _ in 0..60 {
            ideal = distorted / (1.0 + k * ideal * ideal);
        }
        let wanted = 1.0 / ((1.0 + k * ideal * ideal) * (1.0 + 3.0 * k * ideal * ideal));
        let found = at(500, 899).1;
        assert!((found / wanted - 1.0).abs() < 1e-5, "{found} {wanted}");
    }

    /// A cube of side 1 passes the sieve of 1; its surface is 6, its mean shadow 1.5.
    #[test]
    fn the_shape_factor_of_cubes() {
        let signs = [-0.5, 0.5];
        let corners: Vec<DVec3> = (0..8)
            .map(|i: usize| DVec3::new(signs[i & 1], signs[i >> 1 & 1], signs[i >> 2]))
            .collect();
        let cube = Body::from_points(&corners).unwrap();
        let wanted = 1.0 / (4.0_f64 * 1.5 / PI).sqrt();
        assert!((shape_factor(&[cube.clone(), cube]) - wanted).abs() < 1e-4);
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

    /// In its plane a ball is as large as it is: f over the depth, wherever it stands.
    #[test]
    fn a_sphere_beside_the_axis() {
        let camera = camera(1000, 1000, Distortion::None);
        let pose = Pose::from_tilt_pan(DVec3::ZERO, [90.0, 0.0]);
        let sphere = |x: f64| Sphere {
            center: DVec3::new(x, 0.0, -2.0),
            radius: 0.1,
        };
        for x in [0.0, 0.8] {
            let scale = sphere_scale(&camera, &pose, &sphere(x)).unwrap();
            assert!((scale - 500.0).abs() < 1e-9, "{scale}");
        }
        assert!(sphere_scale(&camera, &pose, &sphere(0.95)).is_none());
    }
}
