//! A point from its marks in photos: first the point nearest to all rays (linear), then the one with
//! the least squared distances in pixels (Gauss and Newton).

use glam::{DMat3, DVec2, DVec3};

use crate::fault::Fault;

/// The rays must open at least that far, in radians: one degree. Below, the depth is noise.
const LEAST_ANGLE: f64 = 0.017_453_292_519_943_3;

/// A mark in a photo, as a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// The camera centre.
    pub origin: DVec3,
    /// Towards the marked point; of any length.
    pub direction: DVec3,
    /// The mark, in the photo as shot.
    pub pixel: DVec2,
}

/// A triangulated point.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangulated {
    /// In the frame of the sights.
    pub point: DVec3,
    /// How far from each mark the point projects, in pixels.
    pub residuals_px: Vec<f64>,
    /// The covariance of the point where each mark is off by a pixel (standard deviation, along columns and rows).
    pub covariance: DMat3,
}

impl Triangulated {
    /// The root of the mean squared residual, in pixels.
    pub fn rms_px(&self) -> f64 {
        let squares: f64 = self.residuals_px.iter().map(|r| r * r).sum();
        (squares / self.residuals_px.len().max(1) as f64).sqrt()
    }
}

/// Triangulates. `project` gives the pixel of a point in the photo of a sight (by its index), in the
/// photo as shot; `None` where the photo cannot show it.
///
/// # Errors
/// Fewer than two sights, rays that are nearly parallel, a point behind a camera.
pub fn triangulate(
    sights: &[Sight],
    project: impl Fn(usize, DVec3) -> Option<DVec2>,
) -> Result<Triangulated, Fault> {
    if sights.len() < 2 {
        let what = format!("it is marked in {} photos that have a pose", sights.len());
        return Err(Fault::new(what, "mark it in two at least"));
    }
    let directions: Vec<DVec3> = sights
        .iter()
        .map(|s| s.direction.normalize_or_zero())
        .collect();
    let opening = |a: &DVec3, b: &DVec3| a.cross(*b).length().atan2(a.dot(*b));
    let widest = (directions.iter())
        .flat_map(|a| directions.iter().map(move |b| opening(a, b)))
        .fold(0.0, f64::max);
    // Largest of numbers that are not NaN.
    if widest < LEAST_ANGLE {
        return Err(Fault::new(
            format!("its rays open by {:.2} degrees only", widest.to_degrees()),
            "mark it in photos from farther apart",
        ));
    }
    let behind = || {
        Fault::new(
            "its rays do not meet in front of the cameras",
            "check its marks",
        )
    };
    let mut point = nearest_to_all(sights, &directions).ok_or_else(behind)?;
    let offsets = |point: DVec3| -> Option<Vec<DVec2>> {
        (sights.iter().enumerate())
            .map(|(index, sight)| Some(project(index, point)? - sight.pixel))
            .collect()
    };
    let squares = |offsets: &[DVec2]| offsets.iter().map(|o| o.length_squared()).sum::<f64>();
    let mut off = offsets(point).ok_or_else(behind)?;
    // Columns of the Jacobian by central differences.
    let step = 1e-6 * point.distance(sights[0].origin);
    let columns = |point: DVec3| -> Option<[Vec<DVec2>; 3]> {
        let column = |axis: DVec3| -> Option<Vec<DVec2>> {
            let (up, down) = (offsets(point + axis * step)?, offsets(point - axis * step)?);
            let pairs = up.iter().zip(&down);
            Some(pairs.map(|(a, b)| (*a - *b) / (2.0 * step)).collect())
        };
        Some([column(DVec3::X)?, column(DVec3::Y)?, column(DVec3::Z)?])
    };
    let dot = |a: &[DVec2], b: &[DVec2]| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>();
    let normal = |columns: &[Vec<DVec2>; 3]| {
        let [x, y, z] = columns;
        let row = |a: &[DVec2]| DVec3::new(dot(a, x), dot(a, y), dot(a, z));
        DMat3::from_cols(row(x), row(y), row(z))
    };
    for _ in 0..20 {
        let Some(columns) = columns(point) else {
            break;
        };
        let gradient = columns.each_ref().map(|column| dot(column, &off));
        let next = point - normal(&columns).inverse() * DVec3::from(gradient);
        if !next.is_finite() {
            break;
        }
        let Some(next_off) = offsets(next) else {
            break;
        };
        if squares(&next_off) >= squares(&off) {
            break;
        }
        (point, off) = (next, next_off);
    }
    let covariance = columns(point).map(|columns| normal(&columns).inverse());
    Ok(Triangulated {
        point,
        residuals_px: off.iter().map(|o| o.length()).collect(),
        covariance: covariance.filter(|of| of.is_finite()).ok_or_else(behind)?,
    })
}

/// The point with the least sum of squared distances from the rays' lines.
fn nearest_to_all(sights: &[Sight], directions: &[DVec3]) -> Option<DVec3> {
    // From the first camera: coordinates of the Earth would eat the digits.
    let origin = sights.first()?.origin;
    let (mut matrix, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for (sight, d) in sights.iter().zip(directions) {
        let across = DMat3::IDENTITY - DMat3::from_cols(*d * d.x, *d * d.y, *d * d.z);
        matrix += across;
        right += across * (sight.origin - origin);
    }
    let point = matrix.inverse() * right;
    point.is_finite().then_some(point + origin)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CENTERS: [DVec3; 3] = [
        DVec3::new(500_000.0, 5_000_000.0, 100.0),
        DVec3::new(500_020.0, 5_000_001.0, 101.0),
        DVec3::new(500_010.0, 5_000_025.0, 99.0),
    ];

    /// A camera that looks straight down, 1000 px focal length.
    fn down(index: usize, point: DVec3) -> Option<DVec2> {
        let p = point - CENTERS[index];
        (p.z < 0.0).then(|| DVec2::new(p.x, -p.y) * 1000.0 / -p.z)
    }

    fn sight(index: usize, pixel: DVec2) -> Sight {
        Sight {
            origin: CENTERS[index],
            direction: DVec3::new(pixel.x, -pixel.y, -1000.0),
            pixel,
        }
    }

    #[test]
    fn exact_marks_give_the_point() {
        let truth = DVec3::new(500_004.25, 5_000_009.5, 12.75);
        let sights: Vec<Sight> = (0..3).map(|i| sight(i, down(i, truth).unwrap())).collect();
        for count in [2, 3] {
            let found = triangulate(&sights[..count], down).unwrap();
            assert!(found.point.distance(truth) < 1e-6, "{}", found.point);
            assert!(found.rms_px() < 1e-4);
        }
    }

    /// Two cameras level with each other, marks a pixel apart across the base: the gap cannot be
    /// closed, and halves of it remain in either photo.
    #[test]
    fn the_gap_of_two_rays_remains() {
        let centers = [DVec3::ZERO, DVec3::X * 20.0];
        let project = |index: usize, point: DVec3| {
            let p: DVec3 = point - centers[index];
            (p.z < 0.0).then(|| DVec2::new(p.x, -p.y) * 1000.0 / -p.z)
        };
        let pixels = [DVec2::new(100.0, 0.5), DVec2::new(-100.0, -0.5)];
        let sights = [0, 1].map(|i| Sight {
            origin: centers[i],
            direction: DVec3::new(pixels[i].x, -pixels[i].y, -1000.0),
            pixel: pixels[i],
        });
        let found = triangulate(&sights, project).unwrap();
        assert!(
            found.point.distance(DVec3::new(10.0, 0.0, -100.0)) < 1e-3,
            "{}",
            found.point
        );
        assert!((found.residuals_px[0] - 0.5).abs() < 1e-6);
        assert!((found.rms_px() - 0.5).abs() < 1e-6);
        // A pixel is 0.1 there, and two photos show it: 0.1² / 2 across. Along the view a pixel of either is
        // 100² / (1000 · 10) = 1.
        let expected = DMat3::from_diagonal(DVec3::new(0.005, 0.005, 0.5));
        assert!(
            found.covariance.abs_diff_eq(expected, 1e-4),
            "{}",
            found.covariance
        );
    }

    #[test]
    fn what_cannot_be_triangulated() {
        let truth = DVec3::new(500_004.25, 5_000_009.5, 12.75);
        let one = sight(0, down(0, truth).unwrap());
        assert!(
            triangulate(&[one], down)
                .unwrap_err()
                .what
                .contains("1 photos")
        );
        assert!(
            triangulate(&[one, one], down)
                .unwrap_err()
                .what
                .contains("0.00 degrees")
        );
        // Rays that part: they meet above the cameras.
        let parting = [
            sight(0, DVec2::new(-300.0, 0.0)),
            sight(1, DVec2::new(300.0, 0.0)),
        ];
        assert!(
            triangulate(&parting, down)
                .unwrap_err()
                .what
                .contains("in front")
        );
    }
}
