//! How sure the scale of one pixel is.

use super::*;

/// Over a level plane 10 below, the camera straight down, the scale at a pixel is f / Z: a height off by
/// 0.1 is 1 %, focal length and world are their shares; turned by w about x (y) it changes by the share
/// w·y (w·x) of the pixel's ray (x, y, 1); 0.1 along a ray of the length r is 0.1 / (10 r).
#[test]
fn a_pixel_over_a_plane_is_known() {
    let surface = surface(|_, _, _| 0.0);
    let (camera, pose) = (camera(Distortion::None), nadir(10.0));
    let grid = FieldGrid {
        columns: 8,
        rows: 4,
    };
    let image = ImageKind::Undistorted;
    let progress = Progress::default();
    let field = ScaleField::compute(&camera, &pose, image, grid, &surface, &progress).unwrap();
    let pose_errors = |position: Option<DVec3>, angle: Option<DVec3>| StatedErrors {
        pose: PoseErrors { position, angle },
        ..StatedErrors::default()
    };
    for (column, row) in [(0, 0), (7, 1), (4, 3)] {
        let (x, y) = (
            ((f64::from(column) + 0.5) * 160.0 - 640.0) / 1000.0,
            ((f64::from(row) + 0.5) * 180.0 - 360.0) / 1000.0,
        );
        let share = |errors: StatedErrors| {
            let errors = PixelErrors::new(&field, &errors, &surface).unwrap();
            let interval = errors.at(&field, column, row).unwrap();
            let half = (interval.high - interval.low) / 2.0 / 1.959_963_985;
            assert_near(half, interval.standard_error, 1e-6);
            interval.standard_error / 100.0
        };
        let degree = 1_f64.to_radians();
        let height = pose_errors(Some(DVec3::new(0.3, 0.2, 0.1)), None);
        assert_near(share(height), 0.01, 1e-6);
        let about = |axis: DVec3| pose_errors(None, Some(axis));
        assert_near(share(about(DVec3::X)), degree * y.abs(), 1e-6);
        assert_near(share(about(DVec3::Y)), degree * x.abs(), 1e-6);
        let focal = StatedErrors {
            focal: Some(0.5),
            ..StatedErrors::default()
        };
        assert_near(share(focal), 0.005, 1e-5);
        let world = StatedErrors {
            world_scale: Some(0.5),
            ..StatedErrors::default()
        };
        assert_near(share(world), 0.005, 1e-6);
        let along = StatedErrors {
            surface: Some(0.1),
            ..StatedErrors::default()
        };
        let ray = (1.0 + x * x + y * y).sqrt();
        assert_near(share(along), 0.1 / (10.0 * ray), 1e-6);
    }
    // Beside the surface there is no scale.
    let away = Pose {
        center: DVec3::new(18.0, 0.0, 10.0),
        ..pose
    };
    let field = ScaleField::compute(&camera, &away, image, grid, &surface, &progress).unwrap();
    let errors = PixelErrors::new(&field, &StatedErrors::default(), &surface).unwrap();
    assert!(errors.at(&field, 0, 1).is_some());
    assert_eq!(errors.at(&field, 7, 1), None);
}

/// One half of a plane has noise, the other none: a pixel is as sure as what is around it. A point with
/// noise s is predicted to s·sqrt(1.5).
#[test]
fn a_pixel_is_as_rough_as_what_is_around_it() {
    let noise = 0.05;
    let surface = surface(|x, _, u| match x < 0.0 {
        true => (u - 0.5) * noise * 12_f64.sqrt(),
        false => 0.0,
    });
    let (camera, pose) = (camera(Distortion::None), nadir(10.0));
    let (grid, image) = (FieldGrid::of_fit(&camera), ImageKind::Undistorted);
    let progress = Progress::default();
    let field = ScaleField::compute(&camera, &pose, image, grid, &surface, &progress).unwrap();
    let errors = PixelErrors::new(&field, &StatedErrors::default(), &surface).unwrap();
    let places = [(8, 10), (20, 18), (12, 30)];
    let mean = places.map(|(column, row)| {
        let interval = errors.at(&field, column, row).unwrap();
        let scale = field.scale_at(column, row).unwrap();
        assert!(interval.low <= scale && scale <= interval.high);
        interval.standard_error / 100.0 / 3.0
    });
    assert_near(mean.iter().sum(), noise / 10.0 * 1.5_f64.sqrt(), 0.35);
}
