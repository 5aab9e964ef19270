//! Spheres whose true outlines are known: the points where tangents touch lie on a circle.

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::camera::{Brown, Distortion};

fn camera(distortion: Distortion) -> Camera {
    Camera {
        name: String::new(),
        width: 1280,
        height: 720,
        fx: 1012.5,
        fy: 1011.25,
        cx: 637.25,
        cy: 361.75,
        skew: 0.0,
        distortion,
    }
}

fn brown() -> Distortion {
    Distortion::Brown(Brown::new([
        -0.062, 0.031, 0.0004, -0.0003, -0.006, 0.0, 0.0, 0.0,
    ]))
}

/// The circle on a sphere where the tangents from the camera touch it, in pixels as shot.
fn true_outline(camera: &Camera, center: DVec3, radius: f64, turns: &[f64]) -> Vec<DVec2> {
    let share = radius * radius / center.length_squared();
    let middle = center * (1.0 - share);
    let (along, across) = center.normalize().any_orthonormal_pair();
    let touching = radius * (1.0 - share).sqrt();
    let point = |turn: &f64| {
        let point = middle + (along * turn.cos() + across * turn.sin()) * touching;
        camera.pixel_as_shot(point).unwrap()
    };
    turns.iter().map(point).collect()
}

fn around(points: u32) -> Vec<f64> {
    let turn = |point: u32| std::f64::consts::TAU * f64::from(point) / f64::from(points);
    (0..points).map(turn).collect()
}

/// Numbers that look like noise, the same in every run: Knuth's generator, Box and Muller's shape.
struct Noise(u64);

impl Noise {
    fn even(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        let (radius, turn) = (self.even(), self.even());
        (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * turn).cos()
    }
}

/// A circle of radius f tan(half angle) px, with sin(half angle) = R/d.
#[test]
fn on_the_axis_the_outline_is_a_circle() {
    let camera = Camera {
        fy: 1012.5,
        ..camera(Distortion::None)
    };
    // 3 / 5 and the tangent 3 / 4.
    let pixels = 1012.5 * 0.75;
    let point = |turn: f64| DVec2::new(637.25, 361.75) + DVec2::from_angle(turn) * pixels;
    for points in [3, 4, 17] {
        let outline: Vec<DVec2> = around(points).into_iter().map(point).collect();
        let sphere = Sphere::fit(&camera, &outline, 6.0).unwrap();
        assert!((sphere.center - DVec3::Z * 5.0).length() < 1e-12);
        assert!(sphere.rms < 1e-9);
        assert_eq!(sphere.relative_error.is_none(), points == 3);
        assert!((sphere.arc - (360.0 - 360.0 / f64::from(points))).abs() < 1e-9);
        let drawn = sphere.outline(&camera, ImageKind::AsShot, 2.0, 7);
        for pixel in drawn {
            let radius = (pixel - DVec2::new(637.25, 361.75)).length();
            assert!((radius - pixels - 2.0).abs() < 1e-9);
        }
    }
}

/// Off the axis the outline is an ellipse whose middle is not the picture of the centre: taking the
/// one for the other would move the sphere by more than a hundred times what is asked here.
#[test]
fn off_the_axis_and_through_a_lens_the_centre_is_found() {
    let camera = camera(brown());
    for (center, radius) in [
        (DVec3::new(0.21, -0.12, 0.45), 0.03),
        (DVec3::new(-30.0, 16.0, 60.0), 0.15),
        (DVec3::new(-4.0, -2.0, 9.0), 2.0),
    ] {
        let outline = true_outline(&camera, center, radius, &around(9));
        let sphere = Sphere::fit(&camera, &outline, 2.0 * radius).unwrap();
        let off = (sphere.center - center).length() / center.length();
        assert!(off < 1e-9, "{off}");
        assert!(sphere.rms < 1e-8, "{}", sphere.rms);
        // Where it is drawn, it was seen.
        let drawn = sphere.outline(&camera, ImageKind::AsShot, 0.0, 4000);
        for pixel in outline {
            let nearest = drawn.iter().map(|drawn| (*drawn - pixel).length());
            assert!(nearest.fold(f64::INFINITY, f64::min) < 1.0);
        }
    }
    let (center, radius) = (DVec3::new(-4.0, -2.0, 9.0), 2.0);
    let outline = true_outline(&camera, center, radius, &around(64));
    let mean = outline.iter().sum::<DVec2>() / 64.0;
    let off = (camera.pixel_as_shot(center).unwrap() - mean).length();
    assert!(off > 10.0, "the middle of the outline is {off} px off");
}

/// With half a pixel of noise nine in ten spheres are within the standard error times the quantile
/// of Student's t for nine degrees of freedom, 1.833 (any table of t).
#[test]
fn the_standard_error_covers_what_noise_does() {
    let camera = camera(brown());
    let mut noise = Noise(7);
    for (center, radius, of) in [
        (DVec3::new(0.21, -0.12, 0.45), 0.03, 360.0_f64),
        (DVec3::new(-0.1, 0.05, 0.42), 0.03, 200.0),
    ] {
        let turns: Vec<f64> = (0..12)
            .map(|i| f64::from(i) * of.to_radians() / 12.0)
            .collect();
        let outline = true_outline(&camera, center, radius, &turns);
        let (mut inside, mut bias, mut errors) = (0, 0.0, 0.0);
        let trials = 2000;
        for _ in 0..trials {
            let noisy: Vec<DVec2> = outline
                .iter()
                .map(|pixel| *pixel + DVec2::new(noise.normal(), noise.normal()) * 0.5)
                .collect();
            let sphere = Sphere::fit(&camera, &noisy, 2.0 * radius).unwrap();
            let error = sphere.relative_error.unwrap();
            let off = sphere.center.z / center.z - 1.0;
            inside += i32::from(off.abs() <= 1.833 * error);
            bias += off / f64::from(trials);
            errors += error / f64::from(trials);
        }
        // 0.9 with a standard deviation of 0.0067 over 2000 trials.
        let share = f64::from(inside) / f64::from(trials);
        assert!((share - 0.9).abs() < 0.027, "{share}");
        assert!(bias.abs() < 0.3 * errors, "{bias} beside {errors}");
    }
}

/// With points on a short arc the same noise says less, and the standard error says so.
#[test]
fn a_short_arc_is_said() {
    let camera = camera(brown());
    let (center, radius) = (DVec3::new(0.1, 0.05, 0.42), 0.03);
    let fitted = |of: f64| {
        let mut noise = Noise(3);
        let turns: Vec<f64> = (0..12)
            .map(|i| f64::from(i) * of.to_radians() / 11.0)
            .collect();
        let mut outline = true_outline(&camera, center, radius, &turns);
        for pixel in &mut outline {
            *pixel += DVec2::new(noise.normal(), noise.normal()) * 0.5;
        }
        Sphere::fit(&camera, &outline, 2.0 * radius)
    };
    let (whole, short) = (fitted(330.0).unwrap(), fitted(90.0).unwrap());
    assert!((short.arc - 90.0).abs() < 10.0, "{}", short.arc);
    let (good, bad) = (whole.relative_error.unwrap(), short.relative_error.unwrap());
    assert!(bad > 4.0 * good, "{bad} beside {good}");
}

#[test]
fn what_is_no_outline_is_refused() {
    let camera = camera(brown());
    let refused = |outline: &[[f64; 2]]| {
        let outline: Vec<DVec2> = outline.iter().map(|&p| DVec2::from_array(p)).collect();
        Sphere::fit(&camera, &outline, 0.06).unwrap_err().what
    };
    assert_eq!(
        refused(&[[1.0, 2.0], [3.0, 4.0]]),
        "the outline has 2 points"
    );
    let line = [
        [100.0, 100.0],
        [200.0, 150.0],
        [300.0, 200.0],
        [400.0, 250.0],
    ];
    assert_eq!(refused(&line), "the points lie on a line");
    assert_eq!(refused(&[[9.0, 9.0]; 5]), "the points lie on a line");
    // Two rows of points: the outline of nothing round.
    let zigzag: Vec<[f64; 2]> = (0..8)
        .map(|i| {
            [
                100.0 + 100.0 * f64::from(i),
                300.0 + 60.0 * f64::from(i % 2),
            ]
        })
        .collect();
    assert_eq!(refused(&zigzag), "the points are no outline of a sphere");
    let circle = true_outline(&camera, DVec3::Z, 0.1, &around(8));
    for diameter in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Sphere::fit(&camera, &circle, diameter).is_err());
    }
    assert!(Sphere::fit(&camera, &[DVec2::NAN; 4], 1.0).is_err());
}

proptest! {
    /// However the sphere lies in front of the camera.
    #[test]
    fn the_true_outline_gives_the_sphere_back(
        u in 60.0..1220.0_f64,
        v in 60.0..660.0_f64,
        distance in 0.1..1e4_f64,
        share in 0.004..0.4_f64,
        first in 0.0..6.0_f64,
        points in 3..40_u32,
    ) {
        let camera = camera(brown());
        let center = camera.direction_as_shot(DVec2::new(u, v)).unwrap().normalize() * distance;
        let turns: Vec<f64> = around(points).into_iter().map(|turn| turn + first).collect();
        let outline = true_outline(&camera, center, share * distance, &turns);
        let sphere = Sphere::fit(&camera, &outline, 2.0 * share * distance).unwrap();
        let off = (sphere.center - center).length() / distance;
        prop_assert!(off < 1e-8 / share, "{off}");
        // The order of the points does not matter, nor does the unit.
        let mut turned = outline.clone();
        turned.reverse();
        turned.rotate_left(1);
        let again = Sphere::fit(&camera, &turned, 200.0 * share * distance).unwrap();
        prop_assert!((again.center / 100.0 - sphere.center).length() / distance < 1e-9 / share);
    }

    /// No outline panics or gives a sphere that is not there.
    #[test]
    fn any_points_give_a_sphere_or_a_fault(
        points in prop::collection::vec((-100.0..1400.0_f64, -100.0..900.0_f64), 0..12),
    ) {
        let outline: Vec<DVec2> = points.into_iter().map(|(u, v)| DVec2::new(u, v)).collect();
        if let Ok(sphere) = Sphere::fit(&camera(brown()), &outline, 1.0) {
            prop_assert!(sphere.center.is_finite() && sphere.center.z > 0.0);
            prop_assert!(sphere.rms >= 0.0 && (0.0..=360.0).contains(&sphere.arc));
            prop_assert!(sphere.center.length() > sphere.radius);
        }
    }
}
