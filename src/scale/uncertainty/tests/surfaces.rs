//! Surfaces that end beside a photo, that stand on end, or that show few points.

use super::*;

/// A square of 16 by 16, of which the photo shows 12.8 by 7.2: a position that is off by 4 takes corners over its rim too often to say
/// how sure they are, which is not that nobody states it.
#[test]
fn corners_that_leave_the_surface_are_not_sure() {
    let surface = surface(|x, y, _| match x.abs().max(y.abs()) < 8.0 {
        true => 0.0,
        false => f64::NAN,
    });
    let (camera, pose) = (camera(Distortion::None), nadir(10.0));
    for (off, leaves) in [(0.1, false), (4.0, true)] {
        let errors = StatedErrors {
            pose: PoseErrors {
                position: Some(DVec3::new(off, off, 0.0)),
                angle: None,
            },
            ..StatedErrors::default()
        };
        let found = compute(&surface, &camera, &pose, ImageKind::Undistorted, errors);
        let sure = found.uncertainty.unwrap();
        assert_eq!((sure.leaves_surface, sure.top.is_none()), (leaves, leaves));
        let not_counted: Vec<_> = sure.not_counted(ScalePair::Corners).collect();
        assert_eq!(not_counted, [ErrorSource::Lens, ErrorSource::World]);
        let words = sure.not_counted_in_words(ScalePair::Corners);
        assert_eq!(words, ["the angles of poses", "lens", "world"]);
        // The best line is by derivatives, and says how unsure it is.
        assert!(sure.fitted_top.is_some());
    }
}

/// Hills over a square of 30 by 30, no four points of which lie on a circle.
fn hills() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let height = |x: f64, y: f64| 0.4 * (1.7 * x).sin() * (1.3 * y).cos();
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..61_u32 {
        for j in 0..61_u32 {
            let (x, y) = (f64::from(i) * 0.5 - 15.0, f64::from(j) * 0.5 - 15.0);
            let (x, y) = (x + 0.1 * (3.1 * x * y).sin(), y + 0.1 * (2.3 * x + y).cos());
            points.push(DVec3::new(x, y, height(x, y)));
            if i < 60 && j < 60 {
                let at = 61 * i + j;
                triangles.extend([[at, at + 61, at + 62], [at, at + 62, at + 1]]);
            }
        }
    }
    (points, triangles)
}

/// Hills as a mesh on level ground seen from above, and the same as a wall seen from its front: the surface is as unsure. A bend
/// aside changes the rays by rounding.
#[test]
fn a_wall_is_as_sure_as_the_ground() {
    let (points, triangles) = hills();
    let camera = camera(Distortion::None);
    let found = |turn: DMat3| {
        let turned = Surface::new(Cloud {
            points: points.iter().map(|point| turn * *point).collect(),
            triangles: triangles.clone(),
            ..Cloud::default()
        });
        let ground = nadir(10.0);
        let pose = Pose {
            center: turn * ground.center,
            rotation: turn * ground.rotation,
        };
        let errors = StatedErrors::default();
        let image = ImageKind::Undistorted;
        let found = compute(&turned.unwrap(), &camera, &pose, image, errors);
        let sure = found.uncertainty.unwrap();
        let top = sure.fitted_top.unwrap();
        [
            sure.line_parts_percent[2].unwrap(),
            sure.corner_parts_percent[2].unwrap(),
            top.low,
            top.high,
        ]
    };
    let ground = found(DMat3::IDENTITY);
    assert!(ground[0] > 0.05, "{ground:?}");
    for turn in [
        DMat3::from_rotation_x(std::f64::consts::FRAC_PI_2),
        DMat3::from_rotation_y(-std::f64::consts::FRAC_PI_2),
        DMat3::from_rotation_x(std::f64::consts::PI),
    ] {
        let wall = found(turn);
        // Points at a piece's edge belong to the piece that surrounds them; its mean way is not quite the ground's.
        for ((wall, ground), share) in wall.iter().zip(ground).zip([0.05, 0.2, 0.002, 0.002]) {
            assert_near(*wall, ground, share);
        }
    }
}

/// A mesh whose faces stand in any order, each with corners of its own (STL, or one with a texture), is as sure as the same welded.
#[test]
fn a_mesh_is_as_sure_however_its_file_lists_it() {
    let (points, triangles) = hills();
    let mut apart = Cloud::default();
    // 1999 and the number of faces have no common divisor.
    for place in 0..triangles.len() {
        let face = triangles[place * 1999 % triangles.len()];
        let first = 3 * place as u32;
        apart
            .points
            .extend(face.map(|corner| points[corner as usize]));
        apart.triangles.push([first, first + 1, first + 2]);
    }
    let welded = Cloud {
        points,
        triangles,
        ..Cloud::default()
    };
    let (camera, pose) = (camera(Distortion::None), nadir(10.0));
    let ends = [welded, apart].map(|cloud| {
        let mesh = Surface::new(cloud).unwrap();
        let (image, errors) = (ImageKind::Undistorted, StatedErrors::default());
        let sure = compute(&mesh, &camera, &pose, image, errors).uncertainty;
        let sure = sure.unwrap();
        [sure.fitted_top.unwrap(), sure.top.unwrap()].map(|ends| ends.high - ends.low)
    });
    let [welded, apart] = ends;
    for (welded, apart) in welded.into_iter().zip(apart) {
        assert!(welded > 0.0);
        // The points come in another order, and so other draws.
        assert_near(apart, welded, 0.05);
    }
}

/// A mesh of four points shows nothing of what lies between points; an error that is stated of each counts all the same: one
/// of 1 at 10 away is 10 %, and where all of them are off by that, so are both ends of the line, and by no more.
#[test]
fn what_is_stated_of_the_surface_counts_where_few_points_are_seen() {
    let corners = [(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)];
    let mesh = Surface::new(Cloud {
        points: corners.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Cloud::default()
    });
    let errors = StatedErrors {
        surface: Some(1.0),
        ..StatedErrors::default()
    };
    let (camera, pose) = (camera(Distortion::None), nadir(10.0));
    let image = ImageKind::Undistorted;
    let mesh = mesh.unwrap();
    let found = compute(&mesh, &camera, &pose, image, errors);
    let sure = found.uncertainty.unwrap();
    assert_near(sure.line_parts_percent[2].unwrap(), 10.0, 1e-9);
    // Two independent ends of an edge, each 10 % nearer or farther along its ray.
    assert!(sure.corner_parts_percent[2].unwrap() > 3.0, "{sure:?}");
    let not_counted: Vec<_> = sure.not_counted(ScalePair::Fitted).collect();
    let expected = [ErrorSource::Pose, ErrorSource::Lens, ErrorSource::World];
    assert_eq!(not_counted, expected);
    // So does a pixel, along its ray (x, y, 1).
    let (grid, progress) = (FieldGrid::of_fit(&camera), Progress::default());
    let field = ScaleField::compute(&camera, &pose, image, grid, &mesh, &progress).unwrap();
    let pixels = PixelErrors::new(&field, &errors, &mesh).unwrap();
    let at = (grid.columns / 4, grid.rows / 4);
    let ray = field.direction_at(at.0, at.1).unwrap();
    let share = pixels.at(&field, at.0, at.1).unwrap().standard_error / 100.0;
    assert_near(share, 0.1 / (ray / ray.z).length(), 1e-6);
}
