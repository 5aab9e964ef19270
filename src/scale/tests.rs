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

fn look(surface: &Surface, camera: &Camera, pose: &Pose) -> (PhotoScale, ViewFacts) {
    let mut caster = surface.caster().unwrap();
    let mut finder = GroundFinder::new(Ground::Auto, surface);
    let image = ImageKind::Undistorted;
    let scale = PhotoScale::compute(camera, pose, image, &mut finder, &mut caster).unwrap();
    let view = ViewFacts::compute(
        camera,
        pose,
        image,
        &scale,
        &mut finder,
        &mut caster,
        &crate::jobs::Progress::default(),
    )
    .unwrap();
    (scale, view)
}

/// From 10 over a level plane: the image is 12.8 by 7.2, the corner rays run (6.4, 3.6) outward on
/// 10 down.
#[test]
fn a_view_straight_down() {
    let (_, view) = look(&plane(20.0, |_, _| 2.0), &camera(), &nadir(12.0));
    assert!((view.tilt - 90.0).abs() < 1e-6);
    assert!((view.height.unwrap() - 10.0).abs() < 1e-12);
    assert!(!view.height_is_above_ground);
    let angle = 10_f64.atan2(6.4_f64.hypot(3.6)).to_degrees();
    assert!((view.flattest_corner.unwrap() - angle).abs() < 1e-9);
    assert!((view.footprint_size.unwrap() - 10.0).abs() < 1e-12);
    assert!(view.plane_distance.unwrap() < 1e-12);
    for edge in view.triangle_edges {
        assert!((edge.unwrap() - 2_f64.sqrt()).abs() < 1e-12);
    }
}

/// Over a level plane the whole footprint is the image under the homography of the plane. With the
/// tilt t and the pan p the camera's axes are right = (cos p, -sin p, 0), forward = (cos t sin p,
/// cos t cos p, -sin t) and down = (-sin t sin p, -sin t cos p, -cos t), and a pixel's ray of the
/// depth d = h / (sin t + y cos t) ends at d (forward + x right + y down).
#[test]
fn an_oblique_footprint_is_the_planes_homography() {
    let (tilt, pan, height) = (55_f64, 25_f64, 10.0);
    let surface = plane(60.0, |_, _| 0.0);
    let center = DVec3::new(1.0, -2.0, height);
    let pose = Pose::from_tilt_pan(center, [tilt, pan]);
    let (scale, view) = look(&surface, &camera(), &pose);
    let ((st, ct), (sp, cp)) = (tilt.to_radians().sin_cos(), pan.to_radians().sin_cos());
    let right = DVec3::new(cp, -sp, 0.0);
    let forward = DVec3::new(ct * sp, ct * cp, -st);
    let down = DVec3::new(-st * sp, -st * cp, -ct);
    let footprint = &view.footprint;
    let detail = FootprintDetail::default();
    assert_eq!(footprint.outline.len(), 4 * detail.per_edge as usize);
    let cells = (detail.columns + 1) * (detail.rows + 1);
    assert_eq!(footprint.grid.len(), cells as usize);
    for sample in footprint.outline.iter().chain(&footprint.grid) {
        let (x, y) = (
            (sample.pixel.x - 640.0) / 1000.0,
            (sample.pixel.y - 360.0) / 1000.0,
        );
        let depth = height / (st + y * ct);
        let expected = center + (forward + right * x + down * y) * depth;
        assert!((sample.point().unwrap() - expected).length() < 1e-11);
        assert!(sample.outcome.is_on_surface());
    }
    // The outline runs through the corners in their order.
    for (corner, sample) in scale
        .corners
        .iter()
        .zip(footprint.outline.iter().step_by(32))
    {
        assert_eq!(corner.pixel, sample.pixel);
        assert!((corner.point().unwrap() - sample.point().unwrap()).length() < 1e-12);
    }
    assert!((view.tilt - tilt).abs() < 1e-9);
    assert!((view.height.unwrap() - height).abs() < 1e-12);
    assert!(view.plane_distance.unwrap() < 1e-12);
    // The top corners look flattest.
    let sine = (st - 0.36 * ct) / (1.0 + 0.64_f64.powi(2) + 0.36_f64.powi(2)).sqrt();
    assert!((view.flattest_corner.unwrap() - sine.asin().to_degrees()).abs() < 1e-9);
}

/// A roof z = 2 - |x| between level floors, seen from 10 above the floor. The ray of the column at
/// X = (u - cx) / f comes down on x = X (10 - z): on the roof at |x| = 8 |X| / (1 - |X|), which is
/// less than 2 for |X| < 0.2. The 17 columns of the grid lie at multiples of 0.08.
#[test]
fn a_roof_between_the_corners() {
    let surface = plane(20.0, |x, _| (2.0 - x.abs()).max(0.0));
    let (_, view) = look(&surface, &camera(), &nadir(10.0));
    let z = |column: f64| 2.0 - 8.0 * column / (1.0 - column);
    let squares = z(0.0).powi(2) + 2.0 * z(0.08).powi(2) + 2.0 * z(0.16).powi(2);
    let expected = (squares / 17.0).sqrt();
    assert!((view.plane_distance.unwrap() - expected).abs() < 1e-12);
    // The ridge is 2 above the floor.
    assert!((view.height.unwrap() - 8.0).abs() < 1e-12);
}

/// A saddle through four corners that are not on one plane: z = x y / 23.04 is +1 and -1 at the
/// corners (±6.4, ±3.6) seen from far above, so their plane is z = 0.
#[test]
fn the_plane_of_four_corners_lies_between_them() {
    let corners = [(-6.4, 3.6), (6.4, 3.6), (6.4, -3.6), (-6.4, -3.6)];
    let corners = corners.map(|(x, y): (f64, f64)| DVec3::new(x, y, x * y / 23.04));
    let (middle, normal) = footprint::plane_through(&corners).unwrap();
    assert!(middle.length() < 1e-15);
    assert!((normal.z.abs() - 1.0).abs() < 1e-15);
    for corner in corners {
        assert!(((corner - middle).dot(normal).abs() - 1.0).abs() < 1e-12);
    }
    assert_eq!(footprint::plane_through(&corners[..2]), None);
    assert_eq!(footprint::plane_through(&[DVec3::X; 4]), None);
}

/// A hole of 6 by 6 around the top left corner point (-6.4, 3.6), in a lattice of 1.
#[test]
fn a_hole_under_a_corner_shows_in_its_triangle() {
    let whole = plane(20.0, |_, _| 0.0);
    let points = whole
        .vertices()
        .filter(|p| (p.x + 6.4).abs() > 3.0 || (p.y - 3.6).abs() > 3.0)
        .collect();
    let surface = Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap();
    let (_, view) = look(&surface, &camera(), &nadir(10.0));
    let edges = view.triangle_edges.map(Option::unwrap);
    // The rim points are 7 apart: x = -10 and -3, y = 0 and 7; no triangle reaches beyond a diagonal.
    assert!((7.0..=98_f64.sqrt()).contains(&edges[0]), "{edges:?}");
    for edge in &edges[1..] {
        assert!((edge - 2_f64.sqrt()).abs() < 1e-12);
    }
    // Taken for a hole, the corner falls to the ground, and the view says nothing of a triangle.
    let holed = surface.with_max_edge(Some(2.0)).unwrap();
    let (scale, view) = look(&holed, &camera(), &nadir(10.0));
    assert_eq!(scale.corners_on_surface(), 3);
    assert_eq!(view.triangle_edges[0], None);
}

/// Beside the surface the height is that above the ground.
#[test]
fn without_a_surface_below_the_height_is_above_the_ground() {
    let surface = plane(5.0, |_, _| 2.0);
    let pose = Pose::from_tilt_pan(DVec3::new(0.0, -20.0, 12.0), [30.0, 0.0]);
    let (_, view) = look(&surface, &camera(), &pose);
    assert!(view.height_is_above_ground);
    assert!((view.height.unwrap() - 10.0).abs() < 1e-12);
}
