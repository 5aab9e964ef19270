//! A point from its marks in photos, and which mark is probably wrong.

use glam::{DMat3, DVec2, DVec3};

use crate::camera::{Camera, Pose};
use crate::fault::Fault;
use crate::georeference::{Sight, Triangulated, triangulate};

/// Marks that fit worse, in pixels (root mean square), are pointed out.
pub const POOR_PX: f64 = 10.0;

/// Below that, in pixels, no mark is called wrong: nobody marks a blurred edge closer.
const CLOSE_PX: f64 = 3.0;

/// A mark is called wrong where the others fit so many times better without it.
const CLEARLY: f64 = 3.0;

/// A mark with the photo that it is in.
#[derive(Debug, Clone, Copy)]
pub struct MarkedView<'a> {
    /// Of the photo.
    pub camera: &'a Camera,
    /// Of the photo.
    pub pose: &'a Pose,
    /// The mark, in the photo as shot.
    pub pixel: DVec2,
}

/// A point that was found from its marks.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// In the frame of the poses.
    pub point: DVec3,
    /// How far from each mark the point projects, in pixels, in the order of the marks; `None` where the lens
    /// shows nothing at a mark.
    pub residuals_px: Vec<Option<f64>>,
    /// The covariance of the point where each mark is off by a pixel (standard deviation, along columns and rows).
    pub covariance: DMat3,
    /// The mark, by its place, without which the others agree: it is probably on another thing.
    pub suspect: Option<usize>,
}

impl Located {
    /// The root of the mean squared residual, in pixels.
    pub fn rms_px(&self) -> f64 {
        let known: Vec<f64> = self.residuals_px.iter().copied().flatten().collect();
        let squares: f64 = known.iter().map(|residual| residual * residual).sum();
        (squares / known.len().max(1) as f64).sqrt()
    }
}

/// Finds a point from its marks: linear, then by least squares on pixels.
///
/// # Errors
/// Fewer than two marks, rays that are nearly parallel, a point behind a camera.
pub fn locate(views: &[MarkedView<'_>]) -> Result<Located, Fault> {
    let direction = |view: &MarkedView<'_>| view.camera.direction_as_shot(view.pixel).ok();
    let places: Vec<(usize, DVec3)> = (views.iter().enumerate())
        .filter_map(|(place, view)| Some((place, direction(view)?)))
        .collect();
    let all = of_some(views, &places)?;
    let mut residuals_px = vec![None; views.len()];
    for ((place, _), residual) in places.iter().zip(&all.residuals_px) {
        residuals_px[*place] = Some(*residual);
    }
    Ok(Located {
        point: all.point,
        residuals_px,
        covariance: all.covariance,
        suspect: suspect(views, &places, all.rms_px()),
    })
}

/// The same from some of the marks, with their directions in camera axes.
fn of_some(views: &[MarkedView<'_>], some: &[(usize, DVec3)]) -> Result<Triangulated, Fault> {
    let view = |place: usize| views.get(place);
    let sights: Vec<Sight> = (some.iter())
        .filter_map(|(place, direction)| {
            let view = view(*place)?;
            Some(Sight {
                origin: view.pose.center,
                direction: view.pose.rotation * *direction,
                pixel: view.pixel,
            })
        })
        .collect();
    triangulate(&sights, |index, point| {
        let view = view(some.get(index)?.0)?;
        view.camera
            .pixel_as_shot(view.pose.camera_from_world(point))
    })
}

/// The one mark without which all others agree much better than with it, and better than without any other.
fn suspect(views: &[MarkedView<'_>], places: &[(usize, DVec3)], rms_px: f64) -> Option<usize> {
    if places.len() < 3 || rms_px < CLOSE_PX {
        return None;
    }
    let without = |left_out: usize| {
        let mut others = places.to_vec();
        others.remove(left_out);
        of_some(views, &others).map_or(f64::INFINITY, |found| found.rms_px())
    };
    let mut found: Vec<(f64, usize)> = (0..places.len())
        .filter_map(|left_out| Some((without(left_out), places.get(left_out)?.0)))
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(best, mark), (second, _), ..] = found[..] else {
        return None;
    };
    let is_clear = best * CLEARLY < rms_px && best * CLEARLY < second;
    is_clear.then_some(mark)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::test_camera::{brown, camera};

    /// Five photos over a point, from different sides.
    fn poses() -> Vec<Pose> {
        let down = DMat3::from_cols(DVec3::X, -DVec3::Y, -DVec3::Z);
        [
            (-12.0, 0.0),
            (0.0, -9.0),
            (11.0, 1.0),
            (2.0, 13.0),
            (-7.0, 8.0),
        ]
        .into_iter()
        .map(|(x, y)| Pose {
            rotation: down * DMat3::from_rotation_x(0.01 * y) * DMat3::from_rotation_y(0.01 * x),
            center: DVec3::new(500_000.0 + x, 5_000_000.0 + y, 60.0 + 0.1 * x),
        })
        .collect()
    }

    const TRUTH: DVec3 = DVec3::new(500_001.5, 5_000_002.25, 3.5);

    /// The fourth mark is 50 px off: it is named, and no other one.
    #[test]
    fn a_mark_on_another_thing_is_named() {
        let (camera, poses) = (camera(brown()), poses());
        let mut views: Vec<MarkedView<'_>> = (poses.iter())
            .map(|pose| MarkedView {
                camera: &camera,
                pose,
                pixel: camera.pixel_as_shot(pose.camera_from_world(TRUTH)).unwrap(),
            })
            .collect();
        let exact = locate(&views).unwrap();
        assert!(exact.point.distance(TRUTH) < 1e-6 && exact.rms_px() < 1e-4);
        assert_eq!(exact.suspect, None);
        for wrong in 0..views.len() {
            for off in [DVec2::new(50.0, 0.0), DVec2::new(-30.0, 40.0)] {
                views[wrong].pixel += off;
                let found = locate(&views).unwrap();
                assert_eq!(found.suspect, Some(wrong), "{found:?}");
                let largest = (found.residuals_px.iter().flatten()).fold(0.0_f64, |a, b| a.max(*b));
                assert_eq!(found.residuals_px[wrong], Some(largest));
                assert!(largest > 20.0, "{largest}");
                views[wrong].pixel -= off;
            }
        }
        // Noise of a pixel is nobody's fault.
        for (view, off) in views.iter_mut().zip([1.0, -1.0, 0.5, -0.5, 1.0]) {
            view.pixel += DVec2::new(off, -off);
        }
        assert_eq!(locate(&views).unwrap().suspect, None);
    }

    #[test]
    fn one_mark_is_too_few() {
        let (camera, poses) = (camera(brown()), poses());
        let view = MarkedView {
            camera: &camera,
            pose: &poses[0],
            pixel: DVec2::new(100.0, 100.0),
        };
        assert!(locate(&[view]).unwrap_err().what.contains("1 photos"));
    }
}
