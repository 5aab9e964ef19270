//! Photos of a rough floor that is known: rays meet it in closed form step by step, so nothing of the code under test makes them.

use glam::{DVec2, DVec3};
use image::{Rgb, RgbImage};

use super::*;
use crate::camera::Distortion;
use crate::jobs::Progress;
use crate::picture::for_comparing;
use crate::scale::{ImageKind, ScaleField};
use crate::surface::{Cloud, Surface};

/// Half the floor's width, metres.
const HALF: f64 = 14.0;

fn camera() -> Camera {
    Camera {
        name: String::new(),
        width: 480,
        height: 360,
        fx: 400.0,
        fy: 400.0,
        cx: 240.0,
        cy: 180.0,
        skew: 0.0,
        distortion: Distortion::None,
    }
}

fn height(x: f64, y: f64) -> f64 {
    0.3 * (1.1 * x).sin() * (0.9 * y).cos() + 0.15 * (2.3 * x + 1.7 * y).sin()
}

/// Brightness of cells of a quarter of a metre, each its own, without steps between them.
fn shade(x: f64, y: f64) -> f64 {
    let cell = |i: f64, j: f64| {
        let mixed = ((i * 127.1 + j * 311.7).sin() * 43_758.545_3).fract().abs();
        40.0 + 180.0 * mixed
    };
    let (u, v) = (x * 4.0, y * 4.0);
    let (i, j) = (u.floor(), v.floor());
    let (s, t) = (u - i, v - j);
    let above = cell(i, j) * (1.0 - s) + cell(i + 1.0, j) * s;
    let below = cell(i, j + 1.0) * (1.0 - s) + cell(i + 1.0, j + 1.0) * s;
    above * (1.0 - t) + below * t
}

/// The photo of the floor.
fn photo(pose: &Pose) -> RgbImage {
    let camera = camera();
    RgbImage::from_fn(camera.width, camera.height, |column, row| {
        let pixel = DVec2::new(f64::from(column), f64::from(row)) + 0.5;
        let d = pose.rotation * camera.direction_undistorted(pixel);
        // Fixed-point steps along a steep ray: the floor's slope is below a half.
        let mut t = -pose.center.z / d.z;
        for _ in 0..40 {
            let p = pose.center + d * t;
            t = (height(p.x, p.y) - pose.center.z) / d.z;
        }
        let p = pose.center + d * t;
        Rgb([shade(p.x, p.y).round() as u8; 3])
    })
}

/// The floor as points, moved up.
fn floor(up: f64) -> Surface {
    let side = 180_i32;
    let points = (0..side * side).map(|at| {
        let place = |k: i32| (f64::from(k) + 0.5) / f64::from(side) * 2.0 * HALF - HALF;
        let (x, y) = (place(at % side), place(at / side));
        DVec3::new(x, y, height(x, y) + up)
    });
    Surface::new(Cloud {
        points: points.collect(),
        ..Cloud::default()
    })
    .unwrap()
}

/// Two photos from 10 m, 3 m apart, one of them turned upside down.
fn poses() -> [Pose; 2] {
    [
        Pose::from_tilt_pan(DVec3::new(-1.5, 0.0, 10.0), [90.0, 0.0]),
        Pose::from_tilt_pan(DVec3::new(1.5, 0.4, 10.0), [85.0, 180.0]),
    ]
}

fn small(photo: &RgbImage, camera: &Camera) -> SmallPhoto {
    SmallPhoto::of(&for_comparing(photo, camera).unwrap(), camera)
}

/// All patches of a photo on a surface.
fn patches(surface: &Surface, sighted: &Sighted<'_>) -> Patches {
    let (grid, image) = (Patches::grid(sighted.photo), ImageKind::Undistorted);
    let progress = Progress::default();
    let field = ScaleField::compute(
        sighted.camera,
        sighted.pose,
        image,
        grid,
        surface,
        &progress,
    );
    Patches::of(sighted.photo, &field.unwrap())
}

/// What the two see of a surface, their cameras being taken for others.
fn sight(surface: &Surface, photos: &[RgbImage; 2], camera: &Camera) -> [Look; 2] {
    let poses = poses();
    let small = photos.each_ref().map(|photo| small(photo, camera));
    let sighted = [0, 1].map(|at| Sighted {
        photo: &small[at],
        camera,
        pose: &poses[at],
    });
    [0, 1].map(|at| {
        let patches = patches(surface, &sighted[at]);
        let count = patches.patches.len();
        assert!(count > 500, "{count}");
        seen_at(&patches, &sighted[1 - at])
    })
}

fn elsewhere(sight: PairSight) -> f64 {
    match sight {
        PairSight::Elsewhere(seen) => seen.factor,
        other => panic!("{other:?}"),
    }
}

/// Ten metres above a surface that is drawn h too high it is 10 / (10 - h) times as far away in truth.
#[test]
fn a_surface_that_lies_elsewhere_is_seen_where_it_is() {
    let photos = poses().each_ref().map(photo);
    for up in [-1.0, -0.4, 0.4, 1.5] {
        let [first, second] = sight(&floor(up), &photos, &camera());
        let factor = elsewhere(PairSight::of(first, second));
        assert!(
            (factor / (10.0 / (10.0 - up)) - 1.0).abs() < 0.006,
            "{up}: {factor}"
        );
    }
}

#[test]
fn a_right_surface_is_seen_where_it_is() {
    let photos = poses().each_ref().map(photo);
    let [first, second] = sight(&floor(0.0), &photos, &camera());
    let PairSight::There(off) = PairSight::of(first, second) else {
        panic!("{first:?} {second:?}");
    };
    assert!(off < 0.002, "{off}");
    assert!(
        matches!(first, Look::At(seen) if seen.here > 0.8 && seen.share == 1.0),
        "{first:?}"
    );
    // Half a percent is not worth a word; one and a half confirm nothing, and are not clear with so little parallax.
    let [first, second] = sight(&floor(0.05), &photos, &camera());
    assert!(
        matches!(PairSight::of(first, second), PairSight::There(off) if (off - 0.005).abs() < 0.003)
    );
    let [first, second] = sight(&floor(0.15), &photos, &camera());
    assert_eq!(PairSight::of(first, second), PairSight::Unclear);
}

/// Of the floor a part was dug away since, to another depth everywhere: what is left is where it was, the rest is somewhere else.
#[test]
fn a_surface_that_is_right_in_a_part_confirms_nothing() {
    let photos = poses().each_ref().map(photo);
    let side = 180_i32;
    let dug = |from: f64| {
        let points = (0..side * side).map(|at| {
            let place = |k: i32| (f64::from(k) + 0.5) / f64::from(side) * 2.0 * HALF - HALF;
            let (x, y) = (place(at % side), place(at / side));
            let up = if x > from { 2.0 + 0.3 * y } else { 0.0 };
            DVec3::new(x, y, height(x, y) + up)
        });
        let surface = Surface::new(Cloud {
            points: points.collect(),
            ..Cloud::default()
        });
        let [first, second] = sight(&surface.unwrap(), &photos, &camera());
        PairSight::of(first, second)
    };
    let three_quarters = dug(-2.3);
    assert!(
        !matches!(three_quarters, PairSight::There(_)),
        "{three_quarters:?}"
    );
    assert!(matches!(dug(3.5), PairSight::There(_)));
}

/// A pit of a metre's depth in a sixth of the floor, or a heap: what is left matches well, and so does the pit, a metre lower.
#[test]
fn a_small_part_that_lies_elsewhere_is_seen() {
    let photos = poses().each_ref().map(photo);
    let side = 180_i32;
    for up in [-1.0, 1.0] {
        let points = (0..side * side).map(|at| {
            let place = |k: i32| (f64::from(k) + 0.5) / f64::from(side) * 2.0 * HALF - HALF;
            let (x, y) = (place(at % side), place(at / side));
            let is_dug = (x - 0.5).abs() < 2.2 && (y - 1.0).abs() < 2.2;
            let up = if is_dug { up } else { 0.0 };
            DVec3::new(x, y, height(x, y) + up)
        });
        let surface = Surface::new(Cloud {
            points: points.collect(),
            ..Cloud::default()
        });
        let [first, second] = sight(&surface.unwrap(), &photos, &camera());
        let PairSight::Partly(share) = PairSight::of(first, second) else {
            panic!("{first:?} {second:?}");
        };
        assert!(share > 0.6, "{share}");
        for look in [first, second] {
            let Look::At(seen) = look else {
                panic!("{look:?}");
            };
            let factor = seen.part_elsewhere.unwrap();
            assert!(
                (factor / (10.0 / (10.0 - up)) - 1.0).abs() < 0.02,
                "{up}: {factor}"
            );
        }
    }
}

/// The photo that sees less of it counts.
#[test]
fn how_much_matches_decides() {
    let at = |share: f64| {
        Look::At(SeenAt {
            factor: 1.001,
            there: 0.5,
            here: 0.5,
            is_elsewhere: false,
            share,
            part_elsewhere: None,
        })
    };
    let of = |first: f64, second: f64| PairSight::of(at(first), at(second));
    assert!(matches!(of(0.6, 1.0), PairSight::There(_)));
    assert_eq!(of(1.0, 0.5), PairSight::Unclear);
    assert_eq!(of(0.25, 0.9), PairSight::Partly(0.25));
}

/// Looked at through a longer lens than it was taken with, the same parallax is that of rock farther away.
#[test]
fn a_wrong_focal_length_is_a_wrong_distance() {
    let photos = poses().each_ref().map(photo);
    let mut longer = camera();
    (longer.fx, longer.fy) = (440.0, 440.0);
    let [first, second] = sight(&floor(0.0), &photos, &longer);
    let factor = elsewhere(PairSight::of(first, second));
    assert!((factor - 1.1).abs() < 0.03, "{factor}");
}

/// A close one, half beside what the other shows, shows an eighth of it: that way round there are few patches, and what the other way round
/// is like nothing is not excused by them.
#[test]
fn few_patches_that_are_like_nothing_excuse_nothing() {
    let camera = camera();
    let poses = [
        Pose::from_tilt_pan(DVec3::new(-1.5, 0.0, 10.0), [90.0, 0.0]),
        Pose::from_tilt_pan(DVec3::new(4.5, 0.4, 5.0), [90.0, 0.0]),
    ];
    let away = Pose::from_tilt_pan(DVec3::new(103.0, 50.0, 5.0), [90.0, 0.0]);
    let surface = floor(0.0);
    let of = |close: &Pose| {
        let photos = [photo(&poses[0]), photo(close)];
        let small = photos.each_ref().map(|photo| small(photo, &camera));
        let sighted = [0, 1].map(|at| Sighted {
            photo: &small[at],
            camera: &camera,
            pose: &poses[at],
        });
        [0, 1].map(|at| seen_at(&patches(&surface, &sighted[at]), &sighted[1 - at]))
    };
    let [wide, close] = of(&poses[1]);
    let right = PairSight::of(wide, close);
    assert!(matches!(right, PairSight::There(_)), "{wide:?} {close:?}");
    let [wide, _] = of(&away);
    assert_eq!(wide, Look::FewNowhere);
    for (first, second, wanted) in [
        (wide, Look::Nowhere, PairSight::Nowhere),
        (Look::Nowhere, wide, PairSight::Nowhere),
        // Few both ways round say nothing, nor do many that are like nothing beside some that may be.
        (wide, wide, PairSight::Unclear),
        (Look::Nowhere, Look::Unclear, PairSight::Unclear),
    ] {
        assert_eq!(PairSight::of(first, second), wanted);
    }
}

#[test]
fn other_photos_tell_nothing() {
    let [first, _] = poses().each_ref().map(photo);
    // Of another place.
    let away = Pose::from_tilt_pan(DVec3::new(103.0, 50.0, 10.0), [90.0, 0.0]);
    let [a, b] = sight(&floor(0.0), &[first.clone(), photo(&away)], &camera());
    assert_eq!(PairSight::of(a, b), PairSight::Nowhere, "{a:?} {b:?}");
    assert_eq!(PairSight::of(a, Look::Unclear), PairSight::Unclear);
    // Of one colour.
    let gray = RgbImage::from_pixel(480, 360, Rgb([90; 3]));
    let of_first = small(&first, &camera());
    let plain = small(&gray, &camera());
    let (camera, poses) = (camera(), poses());
    let of = |photo, pose| Sighted {
        photo,
        camera: &camera,
        pose,
    };
    let surface = floor(0.0);
    let its_patches = patches(&surface, &of(&of_first, &poses[0]));
    assert_eq!(seen_at(&its_patches, &of(&plain, &poses[1])), Look::Unclear);
    assert!(patches(&surface, &of(&plain, &poses[1])).patches.is_empty());
    // From one place there is no parallax.
    assert_eq!(
        seen_at(&its_patches, &of(&of_first, &poses[0])),
        Look::Unclear
    );
    // The size of another camera.
    assert!(for_comparing(&RgbImage::new(48, 36), &camera).is_none());
}
