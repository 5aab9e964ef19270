//! Scale objects on planes, where every number is known.

use super::*;
use crate::camera::{Brown, Distortion};
use crate::scale::PhotoScale;
use crate::scale::{Ground, GroundFinder};
use crate::surface::{Cloud, Surface};

fn camera(distortion: Distortion) -> Camera {
    Camera {
        name: String::new(),
        width: 1200,
        height: 800,
        fx: 1000.0,
        fy: 1000.0,
        cx: 600.0,
        cy: 400.0,
        skew: 0.0,
        distortion,
    }
}

/// A plane that rises by `slope` to the north, on [-50, 50]².
fn plane(slope: f64) -> Surface {
    let corners = [(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)];
    let points = corners.map(|(x, y)| DVec3::new(x, y, slope * y)).to_vec();
    Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap()
}

fn compare(traced: &Traced, surface: &Surface, camera: &Camera) -> PlaceScale {
    let pose = Pose::from_tilt_pan(DVec3::new(0.0, 0.0, 10.0), [90.0, 0.0]);
    let mut caster = surface.caster().unwrap();
    let mut ground = GroundFinder::new(Ground::Auto, surface);
    let image = ImageKind::Undistorted;
    let scale = PhotoScale::compute(camera, &pose, image, &mut ground, &mut caster).unwrap();
    let pair = [scale.scale.top, scale.scale.bottom];
    traced.place(camera, &pose, image, pair, &mut caster)
}

/// From 10 above, 100 px are 1.
#[test]
fn a_bar_on_level_ground() {
    let camera = camera(Distortion::None);
    let ends = [DVec2::new(350.0, 200.0), DVec2::new(650.0, 600.0)];
    // 500 px, so 5 long; what is said to be 4 is too long by a quarter.
    let bar = Traced::new(&camera, ScaleObjectKind::Bar, 4.0, &ends).unwrap();
    let scale = bar.scale(&camera, ImageKind::Undistorted).unwrap();
    assert!((scale - 125.0).abs() < 1e-9);
    let place = compare(&bar, &plane(0.0), &camera);
    assert!((place.length_on_surface.unwrap() - 5.0).abs() < 1e-9);
    assert!((place.between_edges.unwrap() - 100.0).abs() < 1e-9);
    assert!((place.on_surface.unwrap() - 100.0).abs() < 1e-9);
    assert!((place.around.unwrap() - 100.0).abs() < 1e-9);
    let region = bar.region(&camera, ImageKind::Undistorted, 5.0);
    assert_eq!(region.len(), 4);
    // 510 px long and 2 * (30 + 5) px wide.
    let (long, wide) = (region[1] - region[0], region[2] - region[1]);
    assert!((long.length() - 510.0).abs() < 1e-9 && (wide.length() - 70.0).abs() < 1e-9);
}

/// On a slope of 3 in 4 a bar up the slope is longer than it looks; its true length is known.
#[test]
fn a_bar_up_a_slope() {
    let camera = camera(Distortion::None);
    // At y = -4 and 4 the ground is at -3 and 3: 13 and 7 below the camera.
    let row = |y: f64, depth: f64| DVec2::new(600.0, 400.0 - 1000.0 * y / depth);
    let ends = [row(-4.0, 13.0), row(4.0, 7.0)];
    let bar = Traced::new(&camera, ScaleObjectKind::Bar, 10.0, &ends).unwrap();
    let place = compare(&bar, &plane(0.75), &camera);
    assert!((place.length_on_surface.unwrap() - 10.0).abs() < 1e-9);
    let middle = bar.middle(&camera, ImageKind::Undistorted).unwrap();
    // The ray at row v meets z = 3/4 y where the depth is 10 - 3/4 y and y = (400 - v) / 1000 depth.
    let rise = (400.0 - middle.y) / 1000.0;
    let depth = 10.0 / (1.0 + 0.75 * rise);
    assert!((place.on_surface.unwrap() - 1000.0 / depth).abs() < 1e-9);
    // The corner points' depths are 10 / (1 + 3/4 * 0.4) at the top and 10 / (1 - 3/4 * 0.4).
    let share = middle.y / 800.0;
    let edges = 130.0 * (1.0 - share) + 70.0 * share;
    assert!((place.between_edges.unwrap() - edges).abs() < 1e-9);
}

#[test]
fn a_sphere_beside_the_ground_under_it() {
    let camera = camera(Distortion::None);
    // A ball of 2 that lies on the level ground, 9 below the camera: the focal length over 9.
    let center = DVec3::new(2.0, -1.0, 9.0);
    let sphere = Sphere {
        center,
        radius: 1.0,
        rms: 0.0,
        relative_error: None,
        arc: 270.0,
    };
    let outline = sphere.outline(&camera, ImageKind::AsShot, 0.0, 8);
    let traced = Traced::new(&camera, ScaleObjectKind::Sphere, 2.0, &outline).unwrap();
    let scale = traced.scale(&camera, ImageKind::Undistorted).unwrap();
    assert!((scale - 1000.0 / 9.0).abs() < 1e-9);
    let middle = traced.middle(&camera, ImageKind::Undistorted).unwrap();
    assert!((middle - DVec2::new(600.0 + 2000.0 / 9.0, 400.0 - 1000.0 / 9.0)).length() < 1e-9);
    let place = compare(&traced, &plane(0.0), &camera);
    assert!((place.on_surface.unwrap() - 100.0).abs() < 1e-9);
    assert!((place.around.unwrap() - 100.0).abs() < 1e-9);
    assert_eq!(place.length_on_surface, None);
}

/// With one coefficient x' = x + k x³ along the axis, whose change is 1 + 3 k x²: that is how much
/// larger the photo as shot shows things there.
#[test]
fn the_photo_as_shot_has_the_scale_of_its_lens() {
    let k = -0.2;
    let lens = Distortion::Brown(Brown::new([k, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    let camera = camera(lens);
    let at = |x: f64| scale_along_rows(&camera, ImageKind::AsShot, DVec3::new(x, 0.0, 1.0) * 7.0);
    for x in [0.0, 0.2, -0.5] {
        let expected = 1000.0 / 7.0 * (1.0 + 3.0 * k * x * x);
        assert!((at(x).unwrap() / expected - 1.0).abs() < 1e-8);
    }
    assert_eq!(at(f64::NAN), None);
    assert_eq!(
        scale_along_rows(&camera, ImageKind::Undistorted, DVec3::NEG_Z),
        None
    );
}

#[test]
fn what_is_no_bar_is_refused() {
    let camera = camera(Distortion::None);
    let bar = |size: f64, ends: &[DVec2]| Traced::new(&camera, ScaleObjectKind::Bar, size, ends);
    assert!(bar(1.0, &[DVec2::ZERO, DVec2::ONE]).is_ok());
    for ends in [
        &[DVec2::ONE; 2][..],
        &[DVec2::ONE],
        &[],
        &[DVec2::X, DVec2::Y, DVec2::ONE],
    ] {
        assert!(bar(1.0, ends).is_err());
    }
    for size in [0.0, -1.0, f64::NAN] {
        assert!(bar(size, &[DVec2::ZERO, DVec2::ONE]).is_err());
    }
}
