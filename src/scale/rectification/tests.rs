use glam::{DMat3, DVec3};

use super::*;
use crate::camera::{Brown, Distortion};
use crate::scale::{FieldGrid, ImageKind};
use crate::surface::Cloud;

const MIDDLE: DVec3 = DVec3::new(500_000.0, 5_000_000.0, 100.0);

fn camera(distortion: Distortion) -> Camera {
    Camera {
        name: String::new(),
        width: 640,
        height: 480,
        fx: 500.0,
        fy: 490.0,
        cx: 322.0,
        cy: 238.0,
        skew: 0.7,
        distortion,
    }
}

fn lens() -> Distortion {
    Distortion::Brown(Brown::new([
        -0.12, 0.04, 0.001, -0.0008, 0.0, 0.0, 0.0, 0.0,
    ]))
}

/// A square of the plane through MIDDLE with this normal, as a mesh: it may stand upright.
fn plane(normal: DVec3) -> Surface {
    let normal = normal.normalize();
    let (a, b) = normal.any_orthonormal_pair();
    let corner = |x: f64, y: f64| MIDDLE + a * x + b * y;
    mesh(
        [(-60.0, -60.0), (60.0, -60.0), (60.0, 60.0), (-60.0, 60.0)]
            .map(|(x, y)| corner(x, y))
            .to_vec(),
        vec![[0, 1, 2], [0, 2, 3]],
    )
}

fn mesh(points: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Surface {
    Surface::new(Cloud {
        points,
        triangles,
        ..Cloud::default()
    })
    .unwrap()
}

fn field(camera: &Camera, pose: &Pose, surface: &Surface) -> ScaleField {
    let (grid, image) = (FieldGrid::of_fit(camera), ImageKind::AsShot);
    ScaleField::compute(camera, pose, image, grid, surface, &Progress::default()).unwrap()
}

fn rectified(
    camera: &Camera,
    pose: &Pose,
    surface: &Surface,
    onto: Onto,
    asked: Option<f64>,
) -> Result<Rectification, Fault> {
    let size = PixelSize {
        asked,
        round_in: 0.01,
    };
    let field = field(camera, pose, surface);
    Rectification::new(&field, onto, size, surface, &Progress::default())
}

/// A slope and an upright wall, from where nothing is square: the plane found is that plane, its axes are
/// square to each other, its picture is seen from the camera's side with the photo's right to the right,
/// and what it takes for a place's source is where the camera shows that place.
#[test]
fn the_plane_is_found_and_seen_squarely() {
    for (normal, center, tilt, pan) in [
        (
            DVec3::new(0.1, -0.4, 1.0),
            DVec3::new(2.0, -6.0, 14.0),
            65.0,
            10.0,
        ),
        // A bench face that looks south, seen from the south.
        (
            DVec3::new(0.05, -1.0, 0.1),
            DVec3::new(1.0, -15.0, 2.0),
            5.0,
            -8.0,
        ),
    ] {
        let camera = camera(lens());
        let pose = Pose::from_tilt_pan(MIDDLE + center, [tilt, pan]);
        let surface = plane(normal);
        let found = rectified(&camera, &pose, &surface, Onto::FittedPlane, None).unwrap();
        let frame = found.raster.frame;
        let normal = normal.normalize();
        assert!((frame.normal() - normal).length() < 1e-9, "{frame:?}");
        assert!(normal.dot(frame.origin - MIDDLE).abs() < 1e-8);
        assert!(found.off_plane.unwrap() < 1e-8 && !found.is_cut);
        assert!(frame.right.dot(frame.down).abs() < 1e-12);
        assert!((frame.right.length() - 1.0).abs() < 1e-12);
        assert!(frame.right.dot(pose.rotation.x_axis) > 0.9);
        assert!(frame.down.dot(pose.rotation.y_axis) > 0.3);
        let raster = found.raster;
        let (mut shown, mut furthest) = (0, [f64::INFINITY, f64::NEG_INFINITY]);
        for row in (0..raster.rows).step_by(7) {
            for column in (0..raster.columns).step_by(7) {
                let place = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let point = raster.corner + place * raster.pixel;
                let point = frame.origin + frame.right * point.x + frame.down * point.y;
                let known = camera.pixel_as_shot(pose.camera_from_world(point)).unwrap();
                let source = found.source(place);
                assert_eq!(source.is_some(), camera.contains(known));
                if let Some(source) = source {
                    assert!((source - known).length() < 1e-9);
                    furthest = [furthest[0].min(known.x), furthest[1].max(known.x)];
                    shown += 1;
                }
            }
        }
        // All of the photo is in the picture, which is not much larger.
        assert!(furthest[0] < 10.0 && furthest[1] > 630.0, "{furthest:?}");
        let all = raster.rows.div_ceil(7) * raster.columns.div_ceil(7);
        assert!(shown * 2 > all, "{shown} of {all}");
    }
}

/// Straight down from 10 m at f = 500 a pixel covers 2 cm; at 490 it covers more, so 2 cm is the finest.
/// From 13 m it covers 2.6 cm, which is nearer to 2 than to 5.
#[test]
fn the_pixel_is_what_the_photo_shows_rounded() {
    let surface = plane(DVec3::Z);
    let camera = Camera {
        skew: 0.0,
        ..camera(Distortion::None)
    };
    for (height, pixel) in [
        (10.0, 0.02),
        (13.0, 0.02),
        (17.0, 0.05),
        (6.0, 0.01),
        (26.0, 0.05),
    ] {
        let pose = Pose::from_tilt_pan(MIDDLE + DVec3::Z * height, [90.0, 0.0]);
        for onto in [Onto::FittedPlane, Onto::HorizontalPlane, Onto::Surface] {
            let found = rectified(&camera, &pose, &surface, onto, None).unwrap();
            assert!(
                (found.raster.pixel - pixel).abs() < 1e-15,
                "{height}: {onto:?}"
            );
        }
        let asked = rectified(&camera, &pose, &surface, Onto::FittedPlane, Some(0.03)).unwrap();
        assert_eq!(asked.raster.pixel, 0.03);
        // 640 px of height / 500 m, in pixels of 3 cm.
        let columns = 640.0 * height / 500.0 / 0.03;
        assert!((f64::from(asked.raster.columns) - columns).abs() <= 2.0);
    }
}

/// Map coordinates: the corner of the picture is a whole number of pixels from the world's origin, and
/// north is up.
#[test]
fn a_horizontal_picture_lies_on_the_map() {
    let camera = camera(lens());
    let pose = Pose::from_tilt_pan(MIDDLE + DVec3::new(3.0, -4.0, 12.0), [70.0, 130.0]);
    let surface = plane(DVec3::new(0.1, 0.1, 1.0));
    for onto in [Onto::HorizontalPlane, Onto::Surface] {
        let raster = rectified(&camera, &pose, &surface, onto, Some(0.05))
            .unwrap()
            .raster;
        let first = raster.world_from_picture(DVec2::ZERO);
        for along in [first.x, first.y] {
            assert!(
                (along / 0.05 - (along / 0.05).round()).abs() < 1e-5,
                "{along}"
            );
        }
        let east = raster.world_from_picture(DVec2::X) - first;
        let south = raster.world_from_picture(DVec2::Y) - first;
        assert!((east - DVec3::X * 0.05).length() < 1e-8);
        assert!((south + DVec3::Y * 0.05).length() < 1e-8);
    }
}

#[test]
fn what_cannot_be_seen_squarely_is_refused() {
    let camera = camera(Distortion::None);
    let onto = Onto::HorizontalPlane;
    let refused = |pose: Pose, surface: &Surface, onto, pixel| -> String {
        rectified(&camera, &pose, surface, onto, pixel)
            .unwrap_err()
            .to_string()
    };
    let floor = plane(DVec3::Z);
    // The lower edge of the image, 26 degrees below its middle, looks 3 degrees below the horizon.
    let low = MIDDLE + DVec3::new(0.0, -59.0, 0.5);
    let low = Pose::from_tilt_pan(low, [-23.0, 0.0]);
    for onto in [Onto::FittedPlane, Onto::HorizontalPlane] {
        let said = refused(low, &floor, onto, None);
        assert!(said.contains("looks along the plane"), "{said}");
    }
    // A face from below its middle.
    let face = plane(DVec3::new(0.0, -1.0, 0.2));
    let below = Pose::from_tilt_pan(MIDDLE + DVec3::new(0.0, -20.0, -8.0), [-30.0, 0.0]);
    let said = refused(below, &face, onto, None);
    assert!(
        said.contains("from below") && said.contains("--plane fit"),
        "{said}"
    );
    assert!(rectified(&camera, &below, &face, Onto::FittedPlane, None).is_ok());
    let high = Pose::from_tilt_pan(MIDDLE + DVec3::Z * 20.0, [90.0, 0.0]);
    let said = refused(high, &floor, onto, Some(0.001));
    assert!(said.contains("more than 200 million"), "{said}");
    assert!(refused(high, &floor, onto, Some(-1.0)).contains("no positive length"));
    let away = Pose::from_tilt_pan(MIDDLE + DVec3::Z * 20.0, [-90.0, 0.0]);
    assert!(refused(away, &floor, onto, None).contains("too little"));
}

/// Over the horizon of a floor: the picture ends, and that is known.
#[test]
fn rays_near_the_horizon_do_not_blow_the_picture_up() {
    let camera = camera(Distortion::None);
    // A heap of 4 m on a floor, seen so that rays over its top meet the mean plane far away.
    let mut points = Vec::new();
    for x in -20..=20 {
        for y in -20..=20 {
            let (x, y) = (f64::from(x), f64::from(y));
            let z = (6.0 - 0.4 * x.hypot(y)).max(0.0);
            points.push(MIDDLE + DVec3::new(x, y, z));
        }
    }
    let surface = Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap();
    let pose = Pose::from_tilt_pan(MIDDLE + DVec3::new(0.0, -18.0, 7.0), [22.0, 0.0]);
    let onto = Onto::HorizontalPlane;
    let found = rectified(&camera, &pose, &surface, onto, Some(0.05)).unwrap();
    assert!(found.is_cut);
    assert!(f64::from(found.raster.rows) * 0.05 < 80.0);
}

/// A box of 3 x 3 x 2 m on a floor, as a mesh with upright walls, from the south: its roof is seen at its
/// own height, and of the floor behind it what the roof's far edge hides is empty: from 10 m south and 8 m
/// up the shadow of an edge 2 m up and 11.5 m away ends 8/6 * 11.5 = 15.33 m away, 3.83 m behind.
#[test]
fn the_surface_from_above_knows_what_is_hidden() {
    let camera = camera(lens());
    let mut points = Vec::new();
    for (half, z) in [(30.0, 0.0), (1.5, 0.0), (1.5, 2.0)] {
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            points.push(MIDDLE + DVec3::new(x * half, y * half, z));
        }
    }
    let mut triangles = vec![[8, 9, 10], [8, 10, 11]];
    for i in 0..4 {
        let next = (i + 1) % 4;
        // The floor around the box, and its walls.
        triangles.extend([[i, next, 4 + next], [i, 4 + next, 4 + i]]);
        triangles.extend([[4 + i, 4 + next, 8 + next], [4 + i, 8 + next, 8 + i]]);
    }
    let surface = mesh(points, triangles);
    let center = MIDDLE + DVec3::new(0.0, -10.0, 8.0);
    let pose = Pose::from_tilt_pan(center, [35.0, 0.0]);
    let found = rectified(&camera, &pose, &surface, Onto::Surface, Some(0.05)).unwrap();
    let raster = found.raster;
    let at = |x: f64, y: f64| {
        let off = DVec2::new(500_000.0 + x, -(5_000_000.0 + y)) - raster.corner;
        let place = (off / raster.pixel).floor() + 0.5;
        let world = raster.world_from_picture(place);
        found.source(place).map(|source| (source, world))
    };
    let (mut roof, mut floor, mut hidden) = (0, 0, 0);
    for step_x in -20..=20 {
        for step_y in -20..=80 {
            let (x, y) = (f64::from(step_x) * 0.07, f64::from(step_y) * 0.07);
            let is_roof = y < 1.4 && y > -1.4;
            let is_hidden = y > 1.6 && y < 5.33 - 0.15;
            let is_floor = y > 5.33 + 0.15;
            match at(x, y) {
                Some((source, world)) => {
                    assert!(is_roof || is_floor || !is_hidden, "{x}, {y} is hidden");
                    if is_roof || is_floor {
                        let z = if is_roof { 102.0 } else { 100.0 };
                        let point = pose.camera_from_world(world.with_z(z));
                        let known = camera.pixel_as_shot(point).unwrap();
                        assert!((source - known).length() < 1e-6, "{x}, {y}");
                        roof += u32::from(is_roof);
                        floor += u32::from(is_floor);
                    }
                }
                None => {
                    assert!(!is_roof && !is_floor, "{x}, {y} is seen");
                    hidden += u32::from(is_hidden);
                }
            }
        }
    }
    assert!(
        roof > 1000 && floor > 50 && hidden > 1000,
        "{roof} {floor} {hidden}"
    );
}

/// A rough slope without any overhang from straight above has no holes: creases hide nothing.
#[test]
fn creases_are_seen() {
    let camera = camera(lens());
    let mut points = Vec::new();
    for x in -30..=30 {
        for y in -30..=30 {
            let z = if (x + y) % 2 == 0 { 0.25 } else { 0.0 };
            points.push(MIDDLE + DVec3::new(f64::from(x) * 0.5, f64::from(y) * 0.5, z));
        }
    }
    let surface = Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap();
    let pose = Pose {
        center: MIDDLE + DVec3::Z * 16.0,
        rotation: DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)),
    };
    let found = rectified(&camera, &pose, &surface, Onto::Surface, None).unwrap();
    let raster = found.raster;
    let (mut seen, mut empty) = (0, 0);
    for row in raster.rows / 8..raster.rows * 7 / 8 {
        for column in raster.columns / 8..raster.columns * 7 / 8 {
            let place = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
            match found.source(place) {
                Some(_) => seen += 1,
                None => empty += 1,
            }
        }
    }
    assert!(seen > 50_000 && empty == 0, "{seen} {empty}");
}
