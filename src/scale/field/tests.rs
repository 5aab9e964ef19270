use glam::{DMat3, DVec2};
use proptest::prelude::*;

use super::*;
use crate::camera::{Brown, Distortion, Fisheye};
use crate::geometry::Ray;
use crate::scale::FittedScale;
use crate::split_mix::SplitMix;
use crate::surface::{Caster, Cloud};

fn camera(distortion: Distortion) -> Camera {
    Camera {
        name: String::new(),
        width: 1280,
        height: 720,
        fx: 1000.0,
        fy: 990.0,
        cx: 645.0,
        cy: 352.0,
        skew: 1.5,
        distortion,
    }
}

fn lenses() -> [Distortion; 3] {
    [
        Distortion::None,
        Distortion::Brown(Brown::new([
            -0.08, 0.03, 0.0005, -0.0004, 0.0, 0.0, 0.0, 0.0,
        ])),
        Distortion::Fisheye(Fisheye::new([-0.02, 0.006, 0.0, 0.0])),
    ]
}

/// A rough pile of random points on `size` by `size` around the middle, in UTM coordinates.
fn pile(seed: u64, count: u32, size: f64) -> Cloud {
    let mut random = SplitMix(seed);
    let mut uniform = move || random.unit();
    let point = |_| {
        let (x, y) = ((uniform() - 0.5) * size, (uniform() - 0.5) * size);
        let z = 100.0 + (x * 0.9).sin() + (y * 1.3).cos() + uniform() * 0.7;
        DVec3::new(500_000.0 + x, 5_000_000.0 + y, z)
    };
    Cloud {
        points: (0..count).map(point).collect(),
        ..Cloud::default()
    }
}

/// The same as a mesh: with an overhanging sheet above a part of it.
fn with_a_roof(cloud: Cloud) -> Surface {
    let surface = Surface::new(cloud).unwrap();
    let mut points: Vec<DVec3> = surface.vertices().collect();
    let mut triangles = surface.triangles().unwrap();
    let first = u32::try_from(points.len()).unwrap();
    let corner = |x: f64, y: f64, z: f64| DVec3::new(500_000.0 + x, 5_000_000.0 + y, z);
    points.extend([
        corner(-4.0, -3.0, 104.0),
        corner(4.0, -3.0, 105.0),
        corner(0.0, 4.0, 103.5),
    ]);
    triangles.push([first, first + 1, first + 2]);
    Surface::new(Cloud {
        points,
        triangles,
        ..Cloud::default()
    })
    .unwrap()
}

/// UTM northings are rounded to 1e-9 m, and triangles that are met at a slant make ten times that of it, along the axis as anywhere.
const APART: f64 = 2e-8;

/// Each pixel's ray is cast at the surface by itself.
fn assert_field_is_that_of_rays(field: &ScaleField, caster: &mut Caster<'_>) -> usize {
    let (camera, pose) = (field.camera(), field.pose());
    let mut met = 0;
    for row in 0..field.grid.rows {
        for column in 0..field.grid.columns {
            let pixel = field.grid.pixel(camera, column, row);
            let direction = field.image().direction(camera, pixel).unwrap();
            let ray = Ray {
                origin: pose.center,
                direction: (pose.rotation * direction).normalize(),
            };
            let hit = caster.cast(&ray);
            let found = field.at(column, row);
            assert_eq!(hit.is_some(), found.is_some(), "{pixel}");
            let (Some(hit), Some(found)) = (hit, found) else {
                continue;
            };
            met += 1;
            let off = (hit.point - found.point).length();
            assert!(off < APART, "{pixel}: {off:e} apart");
            let depth = (pose.camera_from_world(hit.point).z - found.depth).abs();
            assert!(depth < APART, "{pixel}: {depth:e} apart in depth");
            assert_eq!(field.scale_at(column, row), Some(found.scale));
        }
    }
    met
}

#[test]
fn every_pixel_is_where_its_ray_meets() {
    for (seed, distortion) in (1..).zip(lenses()) {
        let cloud = pile(seed, 9000, 30.0);
        let surfaces = [Surface::new(cloud.clone()).unwrap(), with_a_roof(cloud)];
        for surface in &surfaces {
            let mut caster = surface.caster().unwrap();
            // From above, obliquely over the edge of the pile, and from among the rocks, where triangles
            // lie beside and behind the camera.
            for (center, tilt) in [
                (DVec3::new(1.0, -2.0, 112.0), 83.0),
                (DVec3::new(-9.0, -9.0, 108.0), 35.0),
                (DVec3::new(0.5, -14.0, 103.0), 8.0),
            ] {
                let center = center + DVec3::new(500_000.0, 5_000_000.0, 0.0);
                let pose = Pose::from_tilt_pan(center, [tilt, 21.0]);
                let camera = camera(distortion);
                for image in [ImageKind::Undistorted, ImageKind::AsShot] {
                    let grid = FieldGrid::of_fit(&camera);
                    let progress = Progress::default();
                    let field =
                        ScaleField::compute(&camera, &pose, image, grid, surface, &progress);
                    let met = assert_field_is_that_of_rays(&field.unwrap(), &mut caster);
                    assert!(met > 200, "only {met} rays met");
                }
            }
        }
    }
}

/// Holes stay holes.
#[test]
fn long_triangles_are_left_out() {
    let surface = Surface::new(pile(4, 3000, 30.0)).unwrap();
    let surface = surface.with_max_edge(Some(1.0)).unwrap();
    let mut caster = surface.caster().unwrap();
    let camera = camera(Distortion::None);
    let center = DVec3::new(500_001.0, 5_000_000.0, 113.0);
    let pose = Pose::from_tilt_pan(center, [80.0, 0.0]);
    let grid = FieldGrid::of_fit(&camera);
    let image = ImageKind::Undistorted;
    let field = ScaleField::compute(&camera, &pose, image, grid, &surface, &Progress::default());
    let met = assert_field_is_that_of_rays(&field.unwrap(), &mut caster);
    assert!(met < grid.len() && met > grid.len() / 4, "{met}");
}

/// Rays exactly through vertices and along edges of a lattice meet it, also at its rim.
#[test]
fn edges_vertices_and_the_rim_belong_to_the_surface() {
    let points = (0..=64).flat_map(|x| {
        (0..=36).map(move |y| DVec3::new(f64::from(x) * 0.2 - 6.4, f64::from(y) * 0.2 - 3.6, 0.0))
    });
    let surface = Surface::new(Cloud {
        points: points.collect(),
        ..Cloud::default()
    })
    .unwrap();
    let camera = Camera {
        fx: 1000.0,
        fy: 1000.0,
        cx: 640.0,
        cy: 360.0,
        skew: 0.0,
        ..camera(Distortion::None)
    };
    let pose = Pose::from_tilt_pan(DVec3::new(0.0, 0.0, 10.0), [90.0, 0.0]);
    // 128 columns over 64 cells: every second pixel in the middle of a cell's quarter.
    for (columns, rows) in [(64, 36), (128, 72), (320, 180)] {
        let grid = FieldGrid { columns, rows };
        let image = ImageKind::Undistorted;
        let field =
            ScaleField::compute(&camera, &pose, image, grid, &surface, &Progress::default());
        let field = field.unwrap();
        for row in 0..rows {
            for column in 0..columns {
                let scale = field.scale_at(column, row).unwrap();
                assert!((scale - 100.0).abs() < 1e-9, "{scale}");
            }
        }
    }
}

/// Over a plane n·X = h in camera axes the field is f (n·d) / h: linear in the pixel, so the line is the
/// field itself where it does not change sideways, and its plane in every case.
#[test]
fn the_fit_of_a_plane_is_exact() {
    let corners = [
        (-400.0, -400.0),
        (400.0, -400.0),
        (400.0, 400.0),
        (-400.0, 400.0),
    ];
    for (pan, sideways) in [(0.0, false), (30.0, true)] {
        let slope = 0.2;
        let points = corners.map(|(x, y)| DVec3::new(x, y, slope * y)).to_vec();
        let surface = Surface::new(Cloud {
            points,
            ..Cloud::default()
        })
        .unwrap();
        let camera = Camera {
            skew: 0.0,
            ..camera(Distortion::None)
        };
        let pose = Pose::from_tilt_pan(DVec3::new(3.0, 1.0, 20.0), [60.0, pan]);
        let grid = FieldGrid::of_fit(&camera);
        let image = ImageKind::Undistorted;
        let field =
            ScaleField::compute(&camera, &pose, image, grid, &surface, &Progress::default());
        let fitted = FittedScale::of(&field.unwrap()).unwrap();
        // The plane z = slope y: (0, -slope, 1)·X = 0.
        let normal = pose.rotation.transpose() * DVec3::new(0.0, -slope, 1.0);
        let h = -DVec3::new(0.0, -slope, 1.0).dot(pose.center);
        let at = |u: f64, v: f64| {
            let d = camera.direction_undistorted(DVec2::new(u, v));
            (camera.fx * camera.fy).sqrt() * normal.dot(d) / h
        };
        // The line is the plane's at the middle of the image.
        assert!((fitted.top / at(640.0, 0.0) - 1.0).abs() < 1e-12);
        assert!((fitted.bottom / at(640.0, 720.0) - 1.0).abs() < 1e-12);
        let change = (at(1280.0, 360.0) - at(0.0, 360.0)) / at(640.0, 360.0) * 100.0;
        assert!((fitted.left_right_percent - change).abs() < 1e-9);
        assert_eq!(fitted.covered, 1.0);
        if sideways {
            assert!(fitted.rms_percent > 0.1 && fitted.worst_percent > fitted.rms_percent);
        } else {
            assert!(fitted.worst_percent < 1e-10);
        }
    }
}

/// A cliff under one half of the photo: depths 10 and 8, so scales s and 1.25 s in halves of the rows.
#[test]
fn the_fit_of_a_step_is_known() {
    let step = |y: f64| if y > 0.0 { 2.0 } else { 0.0 };
    let points = [-50.0, -1e-7, 1e-7, 50.0].into_iter();
    let points = points.flat_map(|y| [-50.0, 50.0].map(|x| DVec3::new(x, y, step(y))));
    let surface = Surface::new(Cloud {
        points: points.collect(),
        ..Cloud::default()
    })
    .unwrap();
    let camera = Camera {
        width: 640,
        height: 640,
        fx: 640.0,
        fy: 640.0,
        cx: 320.0,
        cy: 320.0,
        skew: 0.0,
        ..camera(Distortion::None)
    };
    let pose = Pose::from_tilt_pan(DVec3::new(0.0, 0.0, 10.0), [90.0, 0.0]);
    let grid = FieldGrid::of_fit(&camera);
    assert_eq!((grid.columns, grid.rows), (64, 64));
    let image = ImageKind::Undistorted;
    let field = ScaleField::compute(&camera, &pose, image, grid, &surface, &Progress::default());
    let fitted = FittedScale::of(&field.unwrap()).unwrap();
    // The slope of a step of d over n even rows is 1.5 d n² / (n² - 1): here of d = -16.
    let slope = -1.5 * 16.0 * 4096.0 / 4095.0;
    assert!(
        (fitted.top - (72.0 - slope / 2.0)).abs() < 1e-9,
        "{fitted:?}"
    );
    assert!((fitted.bottom - (72.0 + slope / 2.0)).abs() < 1e-9);
    let row = 31.5 / 64.0 - 0.5;
    // Nearest to the step the line is off most, by what is worst of the two sides.
    let off = [(72.0 + slope * row) / 80.0, (72.0 - slope * row) / 64.0];
    let worst = off.map(|off| (off - 1.0).abs() * 100.0);
    assert!(
        (fitted.worst_percent - worst[0].max(worst[1])).abs() < 1e-7,
        "{fitted:?}"
    );
}

#[test]
fn half_a_photo_is_the_least() {
    let camera = Camera {
        skew: 0.0,
        cx: 640.0,
        cy: 360.0,
        ..camera(Distortion::None)
    };
    let fit = |edge: f64| {
        let points = [(-90.0, -90.0), (edge, -90.0), (edge, 90.0), (-90.0, 90.0)];
        let points = points.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let surface = Surface::new(Cloud {
            points,
            ..Cloud::default()
        })
        .unwrap();
        let pose = Pose::from_tilt_pan(DVec3::new(0.0, 0.0, 10.0), [90.0, 0.0]);
        let grid = FieldGrid::of_fit(&camera);
        let image = ImageKind::Undistorted;
        let field =
            ScaleField::compute(&camera, &pose, image, grid, &surface, &Progress::default());
        FittedScale::of(&field.unwrap())
    };
    assert_eq!(fit(0.001).unwrap().covered, 0.5);
    assert_eq!(fit(-0.2), None);
    assert_eq!(fit(-80.0), None);
}

/// A bench in the lower quarter of the photo, ten times as near as its floor: s = 1 above, 10 below. The best line through that is
/// 10.125 v - 1.8125 of v from 0 to 1, by hand: below 0 at the top, and no scale.
#[test]
fn a_line_below_zero_is_no_scale() {
    let camera = camera(Distortion::None);
    let fit = |bench: f64| {
        let half = 0.5 * f64::from(camera.height) / camera.fy;
        let points = [
            (-0.5 * half, bench),
            (-90.0, bench),
            (-0.49 * half, 0.0),
            (90.0, 0.0),
        ];
        let points = points
            .iter()
            .flat_map(|&(y, z)| [-90.0, 90.0].map(|x| DVec3::new(x, y, z)));
        let surface = Surface::new(Cloud {
            points: points.collect(),
            ..Cloud::default()
        })
        .unwrap();
        let pose = Pose::from_tilt_pan(DVec3::new(0.0, 0.0, 10.0), [90.0, 0.0]);
        let grid = FieldGrid::of_fit(&camera);
        let image = ImageKind::Undistorted;
        let field =
            ScaleField::compute(&camera, &pose, image, grid, &surface, &Progress::default());
        FittedScale::of(&field.unwrap())
    };
    assert_eq!(fit(9.0), None);
    // Half as high it is one: s = 1 and 20 / 11.
    assert!(fit(4.5).is_some_and(|line| line.top > 0.0 && line.bottom > line.top));
}

/// The contract's round(64·H/W), halves up, at least 2.
#[test]
fn rows_of_the_grid() {
    let rows = |width, height| {
        let camera = Camera {
            width,
            height,
            ..camera(Distortion::None)
        };
        FieldGrid::of_fit(&camera).rows
    };
    assert_eq!(rows(1280, 720), 36);
    assert_eq!(rows(4000, 3000), 48);
    assert_eq!(rows(128, 5), 3);
    assert_eq!(rows(128, 3), 2);
    assert_eq!(rows(10_000, 1), 2);
    assert_eq!(rows(3000, 4000), 85);
}

/// |det J| of pure radial distortion r -> r (1 + k r²): (1 + 3 k r²)(1 + k r²).
#[test]
fn the_lens_factor_is_that_of_the_formula() {
    let k = -0.09;
    let lens = Distortion::Brown(Brown::new([k, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    let camera = camera(lens);
    for ideal in [DVec2::ZERO, DVec2::new(0.3, -0.1), DVec2::new(-0.6, 0.35)] {
        let squared = ideal.length_squared();
        let expected = (1.0 + 3.0 * k * squared) * (1.0 + k * squared);
        let area = camera.lens_area(ideal.extend(1.0) * 3.0).unwrap();
        assert!((area / expected - 1.0).abs() < 1e-10, "{area} {expected}");
    }
    assert_eq!(camera.lens_area(DVec3::new(0.1, 0.1, -1.0)), None);
}

#[test]
fn a_cancelled_field_says_so() {
    let surface = Surface::new(pile(1, 3000, 30.0)).unwrap();
    let camera = camera(Distortion::None);
    let center = DVec3::new(500_000.0, 5_000_000.0, 112.0);
    let pose = Pose {
        center,
        rotation: DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)),
    };
    let progress = Progress::default();
    progress.cancel();
    let grid = FieldGrid::of_pixels(&camera);
    let image = ImageKind::Undistorted;
    let field = ScaleField::compute(&camera, &pose, image, grid, &surface, &progress);
    assert_eq!(field, Err(FieldError::Cancelled));
}

/// Single rays in any direction, beside and behind the camera too, meet what a caster meets.
#[test]
fn single_rays_meet_what_a_caster_meets() {
    let surface = Surface::new(pile(3, 3000, 40.0)).unwrap();
    let mut random = SplitMix(8);
    let mut uniform = move || random.unit() - 0.5;
    let mut met = [0; 2];
    for tilt in [85.0, 40.0, 5.0] {
        let center = DVec3::new(500_000.0 + uniform(), 5_000_000.0 + uniform(), 108.0);
        let pose = Pose::from_tilt_pan(center, [tilt, 30.0]);
        let mut directions: Vec<Option<DVec3>> = (0..300)
            .map(|_| DVec3::new(uniform(), uniform(), uniform()).try_normalize())
            .collect();
        directions.push(None);
        let mut caster = surface.caster().unwrap();
        let hits = meet_rays(&directions, &pose, &mut caster, &Progress::default()).unwrap();
        assert_eq!(hits.len(), directions.len());
        for (hit, direction) in hits.iter().zip(directions) {
            let Some(direction) = direction else {
                assert!(hit.is_none());
                continue;
            };
            let ray = Ray {
                origin: pose.center,
                direction: pose.rotation * direction,
            };
            let expected = caster.cast(&ray);
            assert_eq!(hit.is_some(), expected.is_some(), "{direction}");
            if let (Some(hit), Some(expected)) = (hit, expected) {
                met[usize::from(direction.z <= 0.0)] += 1;
                assert!((hit.point - expected.point).length() < 2e-8, "{direction}");
                assert!((hit.distance - expected.t).abs() < 2e-8, "{direction}");
                assert!((hit.longest_edge - expected.longest_edge).abs() < 1e-8);
            }
        }
    }
    assert!(met[0] > 100 && met[1] > 20, "{met:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Any pose near or in the pile, both images.
    #[test]
    fn any_pose_sees_what_its_rays_meet(
        seed in 0..1000_u64,
        (x, y, z) in (-14.0..14.0_f64, -14.0..14.0_f64, 98.0..125.0_f64),
        (tilt, pan) in (-40.0..90.0_f64, 0.0..360.0_f64),
        lens in 0..3_usize,
    ) {
        let surface = Surface::new(pile(seed, 800, 28.0)).unwrap();
        let mut caster = surface.caster().unwrap();
        let center = DVec3::new(500_000.0 + x, 5_000_000.0 + y, z);
        let pose = Pose::from_tilt_pan(center, [tilt, pan]);
        let camera = camera(lenses()[lens]);
        for image in [ImageKind::Undistorted, ImageKind::AsShot] {
            let grid = FieldGrid { columns: 40, rows: 23 };
            let field = ScaleField::compute(&camera, &pose, image, grid, &surface, &Progress::default());
            assert_field_is_that_of_rays(&field.unwrap(), &mut caster);
        }
    }
}
