//! Photos whose scales are known in closed form.

use super::*;
use crate::camera::{Brown, Distortion};
use crate::surface::{Cloud, Surface};

fn camera() -> Camera {
    Camera {
        name: String::new(),
        width: 1280,
        height: 720,
        fx: 1000.0,
        fy: 1000.0,
        cx: 640.0,
        cy: 360.0,
        skew: 0.0,
        distortion: Distortion::None,
    }
}

/// A square of `half` to either side of the origin on a plane.
fn plane(half: f64, z: impl Fn(f64, f64) -> f64) -> Surface {
    let steps = 41;
    let at = |i: i32| half * (2.0 * f64::from(i) / f64::from(steps - 1) - 1.0);
    let points = (0..steps)
        .flat_map(|i| (0..steps).map(move |j| (at(i), at(j))))
        .map(|(x, y)| DVec3::new(x, y, z(x, y)))
        .collect();
    Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap()
}

fn compute(
    surface: &Surface,
    camera: &Camera,
    pose: &Pose,
    image: ImageKind,
    ground: Ground,
) -> PhotoScale {
    let mut caster = surface.caster().unwrap();
    let mut finder = GroundFinder::new(ground, surface);
    PhotoScale::compute(camera, pose, image, &mut finder, &mut caster).unwrap()
}

fn nadir(height: f64) -> Pose {
    Pose::from_tilt_pan(DVec3::new(0.0, 0.0, height), [90.0, 0.0])
}

fn assert_close(scale: Option<f64>, expected: f64) {
    let scale = scale.unwrap();
    assert!(
        (scale / expected - 1.0).abs() < 1e-12,
        "{scale} is not {expected}"
    );
}

/// Straight down on a level plane the scale is f / Z on every edge.
#[test]
fn nadir_over_a_level_plane() {
    let surface = plane(20.0, |_, _| 2.0);
    let photo = compute(
        &surface,
        &camera(),
        &nadir(12.0),
        ImageKind::Undistorted,
        Ground::Auto,
    );
    for scale in [
        photo.scale.top,
        photo.scale.right,
        photo.scale.bottom,
        photo.scale.left,
    ] {
        assert_close(scale, 100.0);
    }
    assert_eq!(photo.corners_on_surface(), 4);
    assert_eq!(photo.ground, None);
    assert!(photo.notes("m").is_empty());
    let top_left = photo.corners[0].point().unwrap();
    assert!((top_left - DVec3::new(-6.4, 3.6, 2.0)).length() < 1e-12);
}

/// Tilted by 60 degrees below the horizon, at height h over a level plane: the ray of row v comes
/// down at the angle 60 - atan((cy - v)/f), its depth along the axis is Z, and an edge parallel to
/// the horizon has the scale f / Z.
#[test]
fn oblique_over_a_level_plane() {
    let surface = plane(100.0, |_, _| 0.0);
    let pose = Pose::from_tilt_pan(DVec3::new(0.0, 0.0, 10.0), [60.0, 25.0]);
    let photo = compute(
        &surface,
        &camera(),
        &pose,
        ImageKind::Undistorted,
        Ground::Auto,
    );
    let (sin, cos) = 60_f64.to_radians().sin_cos();
    let depth = |v: f64| 10.0 / (sin + cos * (v - 360.0) / 1000.0);
    assert_close(photo.scale.top, 1000.0 / depth(0.0));
    assert_close(photo.scale.bottom, 1000.0 / depth(720.0));
    assert_close(photo.scale.left, photo.scale.right.unwrap());
}

/// A fixed ground, far below the surface, for the corners beyond its rim.
#[test]
fn corners_off_the_surface_fall_to_the_ground() {
    // Wide enough for the image's height (3.6 m to either side), not for its width.
    let surface = plane(4.0, |_, _| 0.0);
    let photo = compute(
        &surface,
        &camera(),
        &nadir(10.0),
        ImageKind::Undistorted,
        Ground::At(-10.0),
    );
    assert_eq!(photo.corners_on_surface(), 0);
    assert_eq!(photo.ground, Some(-10.0));
    assert_close(photo.scale.top, 50.0);
    assert_eq!(
        photo.notes("m"),
        [
            "top_left, top_right, bottom_right, bottom_left: off the surface, taken on the ground at z = -10.000 m"
        ]
    );
    // Found by itself, it is the surface's own level.
    let photo = compute(
        &surface,
        &camera(),
        &nadir(10.0),
        ImageKind::Undistorted,
        Ground::Auto,
    );
    assert_eq!(photo.ground, Some(0.0));
    assert_close(photo.scale.top, 100.0);
}

/// The ground is the median of what the photo shows, not of the whole surface.
#[test]
fn the_ground_is_that_under_the_photo() {
    let surface = plane(50.0, |x, _| 0.1 * x);
    let pose = Pose::from_tilt_pan(DVec3::new(20.0, 0.0, 40.0), [90.0, 0.0]);
    let ground = GroundFinder::new(Ground::Auto, &surface)
        .under(&camera(), &pose)
        .unwrap();
    assert!((ground - 2.0).abs() < 0.3, "{ground}");
    // Looking away from it, it is the median of all.
    let away = Pose::from_tilt_pan(DVec3::new(20.0, 0.0, 140.0), [-90.0, 0.0]);
    let ground = GroundFinder::new(Ground::Auto, &surface)
        .under(&camera(), &away)
        .unwrap();
    assert_eq!(ground, 0.0);
}

/// Above the horizon there is neither surface nor ground.
#[test]
fn a_corner_in_the_sky_has_no_point() {
    let surface = plane(50.0, |_, _| 0.0);
    let pose = Pose::from_tilt_pan(DVec3::new(0.0, 0.0, 5.0), [10.0, 0.0]);
    let photo = compute(
        &surface,
        &camera(),
        &pose,
        ImageKind::Undistorted,
        Ground::Auto,
    );
    assert_eq!(photo.corners[0].outcome, CornerOutcome::Nowhere);
    assert_eq!(photo.corners[0].point(), None);
    assert_eq!(photo.scale.top, None);
    assert_eq!(photo.scale.left, None);
    assert!(photo.scale.bottom.is_some());
    let notes = photo.notes("m");
    assert!(
        notes[0].starts_with("top_left, top_right: no point"),
        "{notes:?}"
    );
}

/// Pure barrel distortion k: the corner at the distorted radius rd comes from the ideal radius r
/// with r + k r^3 = rd; straight down the corners' distance is 2 r Z cos along each axis.
#[test]
fn as_shot_goes_through_the_lens() {
    let k = -0.1;
    let mut camera = camera();
    camera.distortion = Distortion::Brown(Brown::new([k, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    let surface = plane(30.0, |_, _| 0.0);
    let photo = compute(
        &surface,
        &camera,
        &nadir(10.0),
        ImageKind::AsShot,
        Ground::Auto,
    );
    let distorted = 0.64_f64.hypot(0.36);
    let mut r = distorted;
    for _ in 0..200 {
        r = distorted - k * r.powi(3);
    }
    assert_close(photo.scale.top, 100.0 * distorted / r);
    let undistorted = compute(
        &surface,
        &camera,
        &nadir(10.0),
        ImageKind::Undistorted,
        Ground::Auto,
    );
    assert_close(undistorted.scale.top, 100.0);
}

/// Where the lens folds back before the corner there is no ray, and the photo says so.
#[test]
fn a_corner_beyond_the_fold_has_no_ray() {
    let mut camera = camera();
    camera.distortion = Distortion::Brown(Brown::new([-0.9, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    let surface = plane(30.0, |_, _| 0.0);
    let photo = compute(
        &surface,
        &camera,
        &nadir(10.0),
        ImageKind::AsShot,
        Ground::Auto,
    );
    assert!(
        photo
            .corners
            .iter()
            .all(|c| matches!(c.outcome, CornerOutcome::NoRay(_)))
    );
    assert_eq!(photo.scale, EdgeScales::default());
    assert_eq!(photo.ground, None);
    assert_eq!(photo.notes("m").len(), 4);
}
