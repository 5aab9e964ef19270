mod pixels;
mod surfaces;

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::*;
use crate::camera::{Brown, Camera, Distortion, Pose};
use crate::jobs::Progress;
use crate::scale::{FieldGrid, Ground, GroundFinder, ImageKind, PoseErrors};
use crate::split_mix::SplitMix;
use crate::surface::Cloud;

pub(super) fn camera(distortion: Distortion) -> Camera {
    Camera {
        name: String::new(),
        width: 1280,
        height: 720,
        fx: 1000.0,
        fy: 1000.0,
        cx: 640.0,
        cy: 360.0,
        skew: 0.0,
        distortion,
    }
}

/// 9000 random points on 40 by 40 around the middle, at `height(x, y, uniform)`.
fn surface(height: impl Fn(f64, f64, f64) -> f64) -> Surface {
    surface_of(9000, height)
}

/// So many of them; none where the height is no number.
fn surface_of(count: usize, height: impl Fn(f64, f64, f64) -> f64) -> Surface {
    let mut random = SplitMix(5);
    let mut uniform = move || random.unit();
    let points = (0..count).map(|_| {
        let (x, y) = ((uniform() - 0.5) * 40.0, (uniform() - 0.5) * 40.0);
        DVec3::new(x, y, height(x, y, uniform()))
    });
    let points = points.filter(|point| point.is_finite());
    Surface::new(Cloud {
        points: points.collect(),
        ..Cloud::default()
    })
    .unwrap()
}

pub(super) fn nadir(height: f64) -> Pose {
    Pose {
        center: DVec3::new(0.0, 0.0, height),
        rotation: DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)),
    }
}

struct Computed {
    fitted: FittedScale,
    scale: PhotoScale,
    uncertainty: Option<Uncertainty>,
}

fn compute(
    surface: &Surface,
    camera: &Camera,
    pose: &Pose,
    image: ImageKind,
    errors: StatedErrors,
) -> Computed {
    let grid = FieldGrid::of_fit(camera);
    let progress = Progress::default();
    let field = ScaleField::compute(camera, pose, image, grid, surface, &progress).unwrap();
    let fitted = FittedScale::of(&field).unwrap();
    let mut ground = GroundFinder::new(Ground::Auto, surface);
    let mut caster = surface.caster().unwrap();
    let scale = PhotoScale::compute(camera, pose, image, &mut ground, &mut caster).unwrap();
    let photo = UncertainPhoto {
        field: &field,
        fitted: Some(&fitted),
        scale: &scale,
        errors,
    };
    let uncertainty = Uncertainty::compute(&photo, surface);
    Computed {
        fitted,
        scale,
        uncertainty,
    }
}

fn assert_near(found: f64, expected: f64, share: f64) {
    assert!(
        (found / expected - 1.0).abs() <= share,
        "{found} is not {expected}"
    );
}

/// A height of 10 that is off by 8 says nothing: the scale lies anywhere above zero.
#[test]
fn no_scale_is_below_zero() {
    let surface = surface(|_, _, _| 0.0);
    let (camera, pose) = (camera(Distortion::None), nadir(10.0));
    let errors = StatedErrors {
        pose: PoseErrors {
            position: Some(DVec3::new(0.0, 0.0, 8.0)),
            angle: None,
        },
        ..StatedErrors::default()
    };
    let image = ImageKind::Undistorted;
    let found = compute(&surface, &camera, &pose, image, errors);
    let top = found.uncertainty.unwrap().fitted_top.unwrap();
    assert_eq!(top.low, 0.0);
    assert!(top.high > 200.0, "{top:?}");
}

/// A pile that ends within the photo, whose corners are taken on the ground: nobody knows how far that is from
/// what they would have met.
#[test]
fn corners_on_the_ground_have_no_errors() {
    let surface = surface(|x, y, uniform| match x.abs() < 5.6 && y.abs() < 3.2 {
        true => 0.01 * uniform,
        false => f64::NAN,
    });
    let (camera, pose) = (camera(Distortion::None), nadir(10.0));
    let errors = StatedErrors {
        focal: Some(0.5),
        world_scale: Some(0.1),
        ..StatedErrors::default()
    };
    let image = ImageKind::Undistorted;
    let found = compute(&surface, &camera, &pose, image, errors);
    assert!(found.scale.scale.top.is_some());
    let uncertainty = found.uncertainty.unwrap();
    assert_eq!((uncertainty.top, uncertainty.left), (None, None));
    assert_eq!(uncertainty.corner_parts_percent, [None; 4]);
    assert!(uncertainty.fitted_top.is_some());
}

/// From 10 straight down onto a level plane the scale is f / Z: a height that is off by 0.1 (the
/// standard deviation) is 1 %, a focal length or a world off by 0.5 % is that. Turned by w about its x
/// axis the photo's scale changes by the share w·y at y above its middle: here 0.36.
#[test]
fn over_a_level_plane_all_parts_are_known() {
    let surface = surface(|_, _, _| 0.0);
    let (camera, pose) = (camera(Distortion::None), nadir(10.0));
    let image = ImageKind::Undistorted;
    let parts = |errors: StatedErrors| {
        let found = compute(&surface, &camera, &pose, image, errors);
        let uncertainty = found.uncertainty.unwrap();
        let top = uncertainty.top.unwrap().standard_error / found.scale.scale.top.unwrap();
        let line = uncertainty.fitted_top.unwrap().standard_error / found.fitted.top;
        (top * 100.0, line * 100.0, uncertainty)
    };
    let position = |z: f64| StatedErrors {
        pose: PoseErrors {
            position: Some(DVec3::new(0.3, 0.2, z)),
            angle: None,
        },
        ..StatedErrors::default()
    };
    // Draws tell what is linear (up to 1 % of 1 %), and the ends of its interval nearly; derivatives are exact.
    let (top, line, uncertainty) = parts(position(0.1));
    assert_near(top, 1.0, 0.003);
    assert_near(line, 1.0, 1e-6);
    let [pose_part, lens, surface_part, world] = uncertainty.parts_percent(ScalePair::Fitted);
    assert_near(pose_part.unwrap(), 1.0, 1e-6);
    assert_eq!((lens, world), (None, None));
    // The plane predicts its points.
    assert!(surface_part.unwrap() < 1e-6);
    let not_counted: Vec<_> = uncertainty.not_counted(ScalePair::Fitted).collect();
    assert_eq!(not_counted, [ErrorSource::Lens, ErrorSource::World]);
    assert_near(uncertainty.corner_parts_percent[0].unwrap(), 1.0, 0.003);
    let of_corners = uncertainty.top.unwrap();
    assert!((of_corners.low - 98.08).abs() < 0.05, "{of_corners:?}");
    assert!((of_corners.high - 102.0).abs() < 0.05, "{of_corners:?}");
    let interval = uncertainty.fitted_top.unwrap();
    assert_near(interval.low, 100.0 - 1.959_964, 1e-6);
    assert_near(interval.high, 100.0 + 1.959_964, 1e-6);

    let (top, line, _) = parts(StatedErrors {
        focal: Some(0.5),
        ..StatedErrors::default()
    });
    assert_near(top, 0.5, 0.003);
    assert_near(line, 0.5, 1e-5);
    let (top, line, _) = parts(StatedErrors {
        world_scale: Some(0.5),
        ..StatedErrors::default()
    });
    assert_near(top, 0.5, 0.003);
    assert_near(line, 0.5, 1e-9);
    let (_, line, _) = parts(StatedErrors {
        pose: PoseErrors {
            position: None,
            angle: Some(DVec3::new(1.0, 0.0, 0.0)),
        },
        ..StatedErrors::default()
    });
    assert_near(line, 0.36 * 1_f64.to_radians() * 100.0, 1e-6);
    // An error of a surface point along its ray: the corners' rays are 1.2389 times as long as deep, and
    // of an edge's two ends each has half a part.
    let (top, _, _) = parts(StatedErrors {
        surface: Some(0.1),
        ..StatedErrors::default()
    });
    let ray = (1.0_f64 + 0.64 * 0.64 + 0.36 * 0.36).sqrt();
    assert_near(top, 0.1 / (10.0 * ray) / 2_f64.sqrt() * 100.0, 0.003);
}

/// Over a crest and in a trough, where a plane says nothing of what falls away on both sides: the derivatives are
/// those of fields that are computed again, in steps larger than the triangles.
#[test]
fn over_a_crest_derivatives_are_those_of_fields_computed_again() {
    for bend in [-0.04, 0.03] {
        let surface = surface(|x, y, _| bend * y * y + 0.01 * x * y + 0.1 * x);
        let (camera, image) = (camera(Distortion::None), ImageKind::Undistorted);
        let pose = Pose::from_tilt_pan(DVec3::new(0.5, -0.4, 12.0), [83.0, 10.0]);
        let fit = |pose: &Pose| {
            let errors = StatedErrors::default();
            compute(&surface, &camera, pose, image, errors).fitted
        };
        let at = fit(&pose);
        let by = |ahead: Pose, behind: Pose, step: f64| {
            let (ahead, behind) = (fit(&ahead), fit(&behind));
            [
                (ahead.top - behind.top) / (2.0 * step * at.top),
                (ahead.bottom - behind.bottom) / (2.0 * step * at.bottom),
            ]
        };
        let part = |errors: PoseErrors| {
            let errors = StatedErrors {
                pose: errors,
                ..StatedErrors::default()
            };
            let found = compute(&surface, &camera, &pose, image, errors);
            let found = found.uncertainty.unwrap();
            let [top, bottom] = [found.fitted_top, found.fitted_bottom].map(Option::unwrap);
            [
                top.standard_error / at.top,
                bottom.standard_error / at.bottom,
            ]
        };
        // What the surface has in it, which no stated error changes.
        let surface_part = part(PoseErrors::default());
        for axis in DVec3::AXES {
            let step = 0.3;
            let moved = |way: f64| Pose {
                center: pose.center + axis * way,
                ..pose
            };
            let turned = |angle: f64| Pose {
                rotation: pose.rotation * DMat3::from_axis_angle(axis, angle),
                ..pose
            };
            let cases = [
                (
                    by(moved(step), moved(-step), step),
                    PoseErrors {
                        position: Some(axis),
                        angle: None,
                    },
                ),
                (
                    by(turned(step / 12.0), turned(-step / 12.0), step / 12.0),
                    PoseErrors {
                        position: None,
                        angle: Some(axis * 1_f64.to_degrees()),
                    },
                ),
            ];
            for (expected, errors) in cases {
                for ((found, surface), expected) in
                    part(errors).into_iter().zip(surface_part).zip(expected)
                {
                    let of_pose = (found * found - surface * surface).max(0.0).sqrt();
                    assert!(
                        (of_pose - expected.abs()).abs() < 0.05 * expected.abs() + 0.003,
                        "{bend} {axis} {of_pose} {expected}"
                    );
                }
            }
        }
    }
}

/// The derivatives are those of fields that are computed again, also obliquely and through a lens.
#[test]
fn derivatives_are_those_of_fields_computed_again() {
    let lens = Distortion::Brown(Brown::new([
        -0.06, 0.02, 0.0004, -0.0003, 0.0, 0.0, 0.0, 0.0,
    ]));
    let surface = surface(|x, y, _| 0.1 * x - 0.05 * y);
    for (image, tilt) in [
        (ImageKind::Undistorted, 60.0),
        (ImageKind::AsShot, 75.0),
        (ImageKind::AsShot, 88.0),
    ] {
        let camera = camera(lens);
        let pose = Pose::from_tilt_pan(DVec3::new(1.0, -3.0, 9.0), [tilt, 20.0]);
        let fit = |pose: &Pose, camera: &Camera| {
            let found = compute(&surface, camera, pose, image, StatedErrors::default());
            (found.fitted.top, found.fitted.bottom)
        };
        let (top, bottom) = fit(&pose, &camera);
        let step = 1e-5;
        let change = |moved: Pose, camera: &Camera| {
            let (t, b) = fit(&moved, camera);
            ((t / top - 1.0) / step, (b / bottom - 1.0) / step)
        };
        let moved = |way: DVec3| {
            let center = pose.center + way * step;
            change(Pose { center, ..pose }, &camera)
        };
        let turned = |axis: DVec3| {
            let turn = DMat3::from_quat(DQuat::from_scaled_axis(axis * step));
            let rotation = pose.rotation * turn;
            change(Pose { rotation, ..pose }, &camera)
        };
        let stated = |errors: StatedErrors| {
            let found = compute(&surface, &camera, &pose, image, errors);
            let uncertainty = found.uncertainty.unwrap();
            let part = |interval: Option<Interval>| interval.unwrap().standard_error;
            (
                part(uncertainty.fitted_top) / top,
                part(uncertainty.fitted_bottom) / bottom,
            )
        };
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let expected = moved(axis);
            let found = stated(StatedErrors {
                pose: PoseErrors {
                    position: Some(axis * 0.01),
                    angle: None,
                },
                ..StatedErrors::default()
            });
            assert!(
                (found.0 - 0.01 * expected.0.abs()).abs() < 3e-6,
                "{found:?} {expected:?}"
            );
            assert!(
                (found.1 - 0.01 * expected.1.abs()).abs() < 3e-6,
                "{found:?} {expected:?}"
            );
            let expected = turned(axis);
            let found = stated(StatedErrors {
                pose: PoseErrors {
                    position: None,
                    angle: Some(axis * 0.01_f64.to_degrees()),
                },
                ..StatedErrors::default()
            });
            assert!(
                (found.0 - 0.01 * expected.0.abs()).abs() < 3e-5,
                "{found:?} {expected:?}"
            );
            assert!(
                (found.1 - 0.01 * expected.1.abs()).abs() < 3e-5,
                "{found:?} {expected:?}"
            );
        }
        let longer = Camera {
            fx: camera.fx * (1.0 + step),
            fy: camera.fy * (1.0 + step),
            ..camera.clone()
        };
        let expected = change(pose, &longer);
        let found = stated(StatedErrors {
            focal: Some(1.0),
            ..StatedErrors::default()
        });
        assert!(
            (found.0 - 0.01 * expected.0.abs()).abs() < 3e-6,
            "{found:?} {expected:?}"
        );
        assert!(
            (found.1 - 0.01 * expected.1.abs()).abs() < 3e-6,
            "{found:?} {expected:?}"
        );
    }
}

/// Points on a plane with independent noise s: left out, a point of a random triangulation lies
/// s·sqrt(1 + sum of squared weights) off, the mean sum near a half.
#[test]
fn noise_of_the_points_is_found() {
    // No more than clouds have by themselves (0.45 % of the depth).
    let noise = 0.04;
    // A uniform number of that standard deviation.
    let surface = surface(|_, _, u| (u - 0.5) * noise * 12_f64.sqrt());
    let (camera, pose) = (camera(Distortion::None), nadir(10.0));
    let image = ImageKind::Undistorted;
    let found = compute(&surface, &camera, &pose, image, StatedErrors::default());
    let uncertainty = found.uncertainty.unwrap();
    let share = |interval: Option<Interval>, scale: f64| {
        let interval = interval.unwrap();
        assert!(interval.low <= scale && scale <= interval.high);
        interval.standard_error / scale
    };
    // At either end that times sqrt(1.5) of 10; the mean of two has 0.707 of it.
    let expected = noise / 10.0 * 1.5_f64.sqrt() / 2_f64.sqrt();
    assert_near(
        share(uncertainty.top, found.scale.scale.top.unwrap()),
        expected,
        0.2,
    );
    assert_near(
        share(uncertainty.left, found.scale.scale.left.unwrap()),
        expected * 1.4,
        0.6,
    );
    // Hundreds of points say far more than two.
    assert!(share(uncertainty.fitted_top, found.fitted.top) < expected / 4.0);
}

/// Stones of 1.5 by 1.5, 1 high, like eggs in a carton, and no points in the lowest third of the height between them: the line over the cloud
/// is too large, and the interval holds that of the whole surface, however many points there are.
#[test]
fn what_is_dark_between_stones_is_in_the_interval() {
    let stones = |x: f64, y: f64| {
        let wave = |at: f64| (std::f64::consts::TAU * at / 1.5).cos();
        0.25 * (wave(x) + wave(y))
    };
    let (camera, pose) = (camera(Distortion::None), nadir(20.0));
    let image = ImageKind::Undistorted;
    let of = |surface: &Surface| compute(surface, &camera, &pose, image, StatedErrors::default());
    let truth = of(&surface_of(400_000, |x, y, _| stones(x, y))).fitted;
    for count in [9_000, 30_000, 200_000] {
        let lit = surface_of(count, |x, y, _| match stones(x, y) {
            dark if dark < -0.17 => f64::NAN,
            height => height,
        });
        let found = of(&lit);
        let uncertainty = found.uncertainty.unwrap();
        let ends = [
            (uncertainty.fitted_top, found.fitted.top, truth.top),
            (uncertainty.fitted_bottom, found.fitted.bottom, truth.bottom),
        ];
        for (interval, scale, truth) in ends {
            let interval = interval.unwrap();
            // As wide as what is missing, two and a half times, and no wider: a guess of everything would hold it, too.
            assert!(interval.high - interval.low < 0.017 * truth, "{interval:?}");
            assert!(scale > truth * 1.001, "{count}: {scale} over {truth}");
            assert!(
                interval.low <= truth && truth <= interval.high,
                "{count}: {interval:?} of {truth}"
            );
        }
    }
}

/// A corner over a step of 2 in the depth of 10, which many of the points around it lie beyond.
#[test]
fn a_rim_widens_the_corners_interval() {
    // The top left corner point is (-6.4, 3.6).
    let surface = surface(|x, y, u| match x < -3.0 && y > 0.5 && u < 0.5 {
        true => 2.0,
        false => 0.0,
    });
    let (camera, pose) = (camera(Distortion::None), nadir(10.0));
    let image = ImageKind::Undistorted;
    let found = compute(&surface, &camera, &pose, image, StatedErrors::default());
    let uncertainty = found.uncertainty.unwrap();
    let width = |interval: Option<Interval>| {
        let interval = interval.unwrap();
        interval.high - interval.low
    };
    assert!(width(uncertainty.top) > 5.0, "{uncertainty:?}");
    assert!(width(uncertainty.right) < 0.1, "{uncertainty:?}");
}

/// The same on every run; nothing is said of an edge that hangs on the ground.
#[test]
fn intervals_repeat_and_need_the_surface() {
    let rough = surface(|x, y, u| (x * 2.0).sin() * 0.2 + (y * 3.0).cos() * 0.2 + u * 0.1);
    let camera = camera(Distortion::None);
    let errors = StatedErrors {
        pose: PoseErrors {
            position: Some(DVec3::splat(0.05)),
            angle: Some(DVec3::splat(0.2)),
        },
        focal: Some(0.1),
        surface: Some(0.01),
        world_scale: Some(0.1),
    };
    let image = ImageKind::Undistorted;
    let [first, again] = [(); 2].map(|()| compute(&rough, &camera, &nadir(10.0), image, errors));
    assert!(first.uncertainty.is_some());
    assert_eq!(first.uncertainty, again.uncertainty);
    assert_eq!(
        first
            .uncertainty
            .unwrap()
            .not_counted(ScalePair::Corners)
            .count(),
        0
    );
    // Moved over the rim: the right half of the photo sees nothing.
    let pose = Pose {
        center: DVec3::new(17.0, 0.0, 10.0),
        ..nadir(10.0)
    };
    let found = compute(&rough, &camera, &pose, image, errors);
    let uncertainty = found.uncertainty.unwrap();
    assert!(found.scale.scale.top.is_some(), "by the ground");
    assert_eq!((uncertainty.top, uncertainty.right), (None, None));
    assert!(uncertainty.left.is_some() && uncertainty.fitted_top.is_some());
    let pixel = DVec2::new(1280.0, 0.0);
    assert_eq!(found.scale.corners[1].pixel, pixel);
}

/// A level plane with a gap, over which one point high above carries long triangles to the rim, as over what
/// no photo saw. The plane's scale is fx / Z all over; the line that rests on the bridge is off it by more
/// than the points say, and the interval says so. The same triangles read from a file are what they are.
#[test]
fn a_bridge_counts_in_the_interval() {
    let mut random = SplitMix(9);
    let mut uniform = move || random.unit();
    let mut points: Vec<DVec3> = (0..12_000)
        .map(|_| {
            DVec3::new(
                (uniform() - 0.5) * 40.0,
                (uniform() - 0.5) * 40.0,
                0.02 * uniform(),
            )
        })
        .filter(|point| point.truncate().distance(DVec2::new(2.0, -3.0)) > 3.0)
        .collect();
    points.push(DVec3::new(2.0, -3.0, 2.0));
    let cloud = Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap();
    let (camera, pose) = (camera(Distortion::None), nadir(20.0));
    let truth = 1000.0 / (20.0 - 0.01);
    let holds = |surface: &Surface| {
        let errors = StatedErrors::default();
        let found = compute(surface, &camera, &pose, ImageKind::Undistorted, errors);
        let sure = found.uncertainty.unwrap();
        let ends = [sure.fitted_top.unwrap(), sure.fitted_bottom.unwrap()];
        assert!((found.fitted.bottom / truth - 1.0).abs() > 0.003);
        ends.map(|end| end.low <= truth && truth <= end.high)
    };
    assert_eq!(holds(&cloud), [true; 2]);
    assert!(!holds(&cloud.to_mesh().unwrap())[1]);
}

/// A terrace 6 high of which no photo saw the foot: triangles go from its rim to where the floor has points, 8 farther on, and
/// the photo's right corners lie on them. There the true depth is 20, the floor's, and a pixel shows fx / 20.
#[test]
fn a_corner_on_a_bridge_may_lie_as_deep_as_the_floor() {
    let mut random = SplitMix(9);
    let mut uniform = move || random.unit();
    let points: Vec<DVec3> = (0..20_000)
        .map(|_| {
            let (x, y) = ((uniform() - 0.5) * 50.0, (uniform() - 0.5) * 30.0);
            let height = if x < 0.0 { 6.0 } else { 0.0 };
            DVec3::new(x, y, height + 0.02 * uniform())
        })
        .filter(|point| point.x < 0.0 || point.x > 8.0)
        .collect();
    let cloud = Surface::new(Cloud {
        points,
        ..Cloud::default()
    })
    .unwrap();
    let camera = camera(Distortion::None);
    let pose = Pose {
        center: DVec3::new(-6.5, 0.0, 20.0),
        ..nadir(20.0)
    };
    let truth = 1000.0 / 20.0;
    let holds = |surface: &Surface| {
        let (image, errors) = (ImageKind::Undistorted, StatedErrors::default());
        let found = compute(surface, &camera, &pose, image, errors);
        let scale = found.scale.scale.right.unwrap();
        assert!(scale > 1.1 * truth, "{scale}");
        let right = found.uncertainty.unwrap().right.unwrap();
        let grid = FieldGrid::of_pixels(&camera);
        let progress = Progress::default();
        let field = ScaleField::compute(&camera, &pose, image, grid, surface, &progress).unwrap();
        let pixels = PixelErrors::new(&field, &errors, surface).unwrap();
        let at_corner = pixels.at(&field, 1279, 0).unwrap();
        // What lies on the terrace is as sure as it was: 14 below the camera, to a centimetre.
        let on_top = pixels.at(&field, 300, 360).unwrap();
        let of_top = 1000.0 / (14.0 - 0.01);
        assert!(on_top.low < of_top && of_top < on_top.high && on_top.width_percent() < 0.5);
        [right, at_corner].map(|end| end.low <= truth && truth <= end.high)
    };
    assert_eq!(holds(&cloud), [true; 2]);
    assert_eq!(holds(&cloud.to_mesh().unwrap()), [false; 2]);
}
